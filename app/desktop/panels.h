// The parts of the window. Each draws itself from the workbench, inside the rectangle it is given.
#pragma once

#include <imgui.h>

#include "app/desktop/analysis_panel.h"
#include "app/desktop/scene_panel.h"
#include "app/desktop/window.h"
#include "app/desktop/workbench.h"
#include "app/plot/plot_frame.h"

namespace limpid {

// A panel's frame without a title bar; pairs with ImGui::End().
void begin_panel(const char* name, const ScreenRect& rect);
// A small heading inside a panel.
void heading(const char* text);
// A label in the muted colour and a value; red with a tooltip when `broken` is not empty.
void read_out(const char* label, const std::string& value, const std::string& broken = {},
              const char* help = nullptr);
void tooltip(const char* text);
// A bar filled to `part`, 0 to 1, with a text on it; `width` [px], 0: all there is. Without a text
// it says the part.
void progress_bar(double part, float width, std::string text = {});

void draw_menu_bar(Workbench& bench, Window& window);
void draw_coupling_panel(Workbench& bench, const ScreenRect& rect);
void draw_plots(Workbench& bench, Window& window, const ScreenRect& rect);
void draw_transport(Workbench& bench, const ScreenRect& rect);
// What is there to read.
void draw_dialogs(Workbench& bench);
void draw_notices(Workbench& bench, const ScreenRect& view);

// Asks for a recording to open.
class SessionDialog {
 public:
  void draw(Workbench& bench);

 private:
  bool was_shown_ = false;
  std::string typed_, complaint_;
};

// Scene, hand, device, analysis and timing.
class SidePanel {
 public:
  void draw(Workbench& bench, const ScreenRect& rect, double frame_time);

 private:
  ScenePanel scene_;
  AnalysisPanel analysis_;
};

// The 3D view: the picture under ImGui, and what the mouse does in it.
class ViewPanel {
 public:
  void draw(Workbench& bench, const Window& window, const ScreenRect& rect);

 private:
  void handle_mouse(Workbench& bench, const ScreenRect& rect);
  void drag_hand(Workbench& bench, const Eigen::Vector2d& pixel);
  void draw_labels(Workbench& bench, const ScreenRect& rect) const;

  bool dragging_ = false;
  Vec3 anchor_ = Vec3::Zero();  // the point that is dragged, without depth [m]
  Vec3 offset_ = Vec3::Zero();  // from the mouse's point to it [m]
};

}  // namespace limpid
