// One frame of the window: all of its parts, each in its place.
#pragma once

#include <utility>

#include "app/desktop/panels/coupling_panel.h"
#include "app/desktop/panels/range_panel.h"
#include "app/desktop/panels/view_panel.h"
#include "app/desktop/shell/desktop.h"
#include "app/desktop/shell/dialogs.h"
#include "app/desktop/shell/layout.h"
#include "app/desktop/shell/menu.h"
#include "app/desktop/shell/sections.h"
#include "app/desktop/shell/window.h"

namespace limpid {

class Frame {
 public:
  // `act` carries out what is asked for in the parts.
  Frame(Desktop& desktop, Window& window, Act act)
      : desktop_(desktop),
        window_(window),
        act_(std::move(act)),
        sections_(desktop),
        dialogs_(desktop) {}

  void draw();
  // Whether the picture has changed since then, without anybody having touched the window.
  bool differs();
  void drop_pictures() {  // before the OpenGL context goes
    dialogs_.drop_pictures();
    files_.drop_pictures();
  }

 private:
  void draw_blind();
  Layout lay_out();
  ViewScene view_scene();
  ScreenRect signs_box(ScreenRect view);
  void draw_view(ScreenRect rect);
  // Where the scene's objects that move are.
  static std::vector<Pose> bodies_of(const Stage& stage, std::span<const double> row);
  // On the selected object; true while the mouse is theirs.
  bool draw_handles(const ViewScene& scene, ScreenRect rect);
  void select_under(const Ray& ray, const ViewScene& scene);
  void draw_coupling(ScreenRect rect);
  void draw_played(PlayedSession& session, const CouplingReading& reading,
                   const CouplingSituation& now);
  void draw_plot_row(ScreenRect rect, ScreenRect view);
  void save_plot(const ScreenRect& box, const std::filesystem::path& file);
  void draw_splitters(const Layout& at);
  void draw_fold_tabs(const Layout& at);

  // The parts of the window that remember something themselves.
  Desktop& desktop_;
  Window& window_;
  Act act_;
  WindowLayout layout_;
  FileMenus files_;
  ViewPanel view_;
  RangePanel figures_;
  Sections sections_;
  Dialogs dialogs_;
  std::uint64_t seen_of_sweep_ = 0;  // its revision
  ScreenRect below_banners_{};       // what notices leave free
};

}  // namespace limpid
