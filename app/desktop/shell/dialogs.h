// What opens over the window.
#pragma once

#include <filesystem>

#include "app/desktop/base/action.h"
#include "app/desktop/panels/experiments_panel.h"
#include "app/desktop/panels/gallery.h"
#include "app/desktop/panels/identify_dialog.h"
#include "app/desktop/panels/named_dialog.h"
#include "app/desktop/panels/plot_chooser.h"
#include "app/desktop/panels/session_dialog.h"
#include "app/desktop/panels/tip_question.h"
#include "app/desktop/panels/video_dialog.h"
#include "app/desktop/shell/desktop.h"
#include "app/desktop/widgets/path_dialog.h"

namespace limpid {

class Dialogs {
 public:
  explicit Dialogs(Desktop& desktop) : desktop_(desktop), experiments_(desktop.notices()) {}

  void draw_reading();  // help and the like
  void draw_experiments();
  void draw_sweep();
  // Those about scenes and files, which are modal.
  void draw_scenes(const Act& act);
  void draw_sessions();
  void draw_named();  // layouts and presets
  void draw_identify();
  // What a plot shows; `room`: of the view, above the plots.
  void draw_plot_chooser(ScreenRect room);
  void drop_pictures() {  // before the OpenGL context goes
    gallery_.drop_pictures();
    session_.drop_pictures();
    experiments_.drop_pictures();
  }

 private:
  // Draws one, which closes itself by clearing what says that it is open.
  template <class Draw>
  auto draw(Dialog which, Draw&& draw_it);
  void draw_paths();
  void draw_list(Dialog which, NamedDialog& dialog, NamedTexts& texts);

  Desktop& desktop_;
  Gallery gallery_;
  SessionDialog session_;
  VideoDialog video_;
  ExperimentsPanel experiments_;
  PathDialog add_{{.title = "Add model",
                   .action = "Add",
                   .extensions = {".glb", ".gltf", ".stl", ".obj", ".ply", ".dae"}}};
  PathDialog arm_{{.title = "Open arm", .action = "Open", .extensions = {".urdf", ".xacro"}}};
  TipQuestion tip_;
  IdentifyDialog identify_;
  PathDialog save_{
      {.title = "Save scene as", .action = "Save", .extensions = {".toml"}, .new_file = true}};
  PlotChooser chooser_;
  NamedDialog layouts_{{.title = "Layouts",
                        .what = "layout",
                        .help = "Which plots and panels the window shows, by name."}};
  NamedDialog presets_{{.title = "Presets",
                        .what = "preset",
                        .help = "Coupling and gains by name; of a twin those that the sliders "
                                "set. Ctrl+Z brings back what was before."}};
  std::filesystem::path last_folder_;  // that a model or an arm came from
};

}  // namespace limpid
