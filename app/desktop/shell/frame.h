// Frame of the window: all of its parts, each in its place.
#pragma once

#include <array>
#include <functional>
#include <utility>

#include "app/desktop/coupling/chatter.h"
#include "app/desktop/coupling/coupling_panel.h"
#include "app/desktop/plots/range_panel.h"
#include "app/desktop/shell/desktop.h"
#include "app/desktop/shell/dialogs.h"
#include "app/desktop/shell/layout.h"
#include "app/desktop/shell/menu.h"
#include "app/desktop/shell/sections.h"
#include "app/desktop/view/over_view.h"
#include "app/desktop/view/view_panel.h"

namespace limpid {

// Size of the window in ImGui's coordinates, and of its picture in pixels.
struct FrameSize {
  int width = 0, height = 0, pixels_x = 0, pixels_y = 0;
};

class Frame {
 public:
  // Runs commands of the parts by `act`.
  Frame(Desktop& desktop, std::function<FrameSize()> size, Act act)
      : desktop_(desktop),
        size_(std::move(size)),
        act_(std::move(act)),
        sections_(desktop),
        dialogs_(desktop) {}

  void draw();
  // Returns whether the picture has changed since draw(), even if nobody touched the window.
  bool differs();
  void drop_pictures() {  // before the OpenGL context goes
    dialogs_.drop_pictures();
    files_.drop_pictures();
  }

 private:
  void draw_blind();
  Layout lay_out();
  void follow_led_panel(const Layout& at);
  ViewScene view_scene();
  ScreenRect signs_box(ScreenRect view);
  void draw_view(ScreenRect rect);
  // Returns the frames of the scene's moving objects.
  static std::vector<Pose> bodies_of(const Stage& stage, std::span<const double> row);
  // Draws handles of the selected object; returns whether the mouse belongs to them.
  bool draw_handles(const ViewScene& scene, ScreenRect rect);
  void select_under(const Ray& ray, const ViewScene& scene);
  void draw_coupling(ScreenRect rect);
  bool chatters(std::size_t lane);
  void draw_played(PlayedSession& session, const CouplingReading& reading,
                   const CouplingSituation& now);
  void draw_plot_row(ScreenRect rect, ScreenRect view);
  void save_plot(const ScreenRect& box, const std::filesystem::path& file);
  void draw_splitters(const Layout& at);
  void draw_fold_tabs(const Layout& at);

  Desktop& desktop_;
  std::function<FrameSize()> size_;
  Act act_;
  WindowLayout layout_;
  FileMenus files_;
  ViewPanel view_;
  YourTurn your_turn_;
  NoticeSigns notices_;
  std::array<PlayedChatter, kMostLanes> played_chatter_;
  const Stage* chatter_of_ = nullptr;
  RangePanel figures_;
  Sections sections_;
  Dialogs dialogs_;
  std::uint64_t seen_of_sweep_ = 0;  // revision of the sweep drawn last
  ScreenRect below_banners_{};       // part of the view that is free for notices
};

}  // namespace limpid
