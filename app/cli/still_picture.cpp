#include "app/cli/still_picture.h"

#include "app/base/folders.h"
#include "app/desktop/base/row_view.h"
#include "render/gl/offscreen.h"
#include "render/scene_view.h"

namespace limpid {

void save_picture(const std::filesystem::path& png, const RunPlan& plan,
                  std::span<const double> row, std::span<const double> twin) {
  constexpr int kWidth = 1280, kHeight = 800;
  const OffscreenContext context(kWidth, kHeight);
  SceneView picture(data_dir() / "shaders", plan.arm, plan.document.scene,
                    visual_pictures(plan.document));
  picture.set_quality(Quality::level(0));  // best quality, as time does not matter
  picture.set_meshes(mesh_pictures(plan.document.scene, plan.models));
  const RowLayout layout = plan.layout();
  const RowView rows(plan.arm, plan.document.scene);
  ViewState view = rows.view(layout, row);
  if (!twin.empty()) {
    view.rerun = rows.pose(layout.in(twin, Column::proxy_position));
    view.other_bodies = rows.bodies(layout, twin);
  }
  ViewMemory().update(view, rows.contacts(layout, row), 0);
  Camera camera;
  camera.resize(kWidth, kHeight);
  camera.reset(picture.bounds());
  camera.finish();
  picture.draw(view, camera, 0, 0, kWidth, kHeight);
  write_png(png, kWidth, kHeight, read_rgba(kWidth, kHeight));
}

}  // namespace limpid
