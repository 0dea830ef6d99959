// What is asked about scenes: files to add and to save to, what to do with unsaved changes, and how
// loading goes on.
#pragma once

#include "app/desktop/gallery.h"
#include "app/desktop/path_dialog.h"
#include "app/plot/plot_frame.h"

namespace limpid {

class SceneDialogs {
 public:
  void draw(Workbench& bench, const ScreenRect& view);
  void drop_pictures() { gallery_.drop_pictures(); }

 private:
  void draw_paths(Workbench& bench);

  Gallery gallery_;
  PathDialog add_{{.title = "Add model", .action = "Add", .extensions = {".glb", ".gltf"}}};
  PathDialog save_{
      {.title = "Save scene as", .action = "Save", .extensions = {".toml"}, .new_file = true}};
  std::filesystem::path last_folder_;  // that a model came from
};

}  // namespace limpid
