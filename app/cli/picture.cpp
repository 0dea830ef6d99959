#include "app/cli/picture.h"

#include "app/assets.h"
#include "app/run/scene_meshes.h"
#include "app/view/row_view.h"
#include "render/offscreen.h"
#include "render/scene_view.h"

namespace limpid {
namespace {

void draw_meshes(Scene scene, SceneView& picture) {
  const MeshModels models = build_meshes(scene);
  std::vector<MeshPicture> meshes;
  for (std::size_t i = 0; i < models.size(); ++i) {
    meshes.push_back({models[i], scene.meshes[i].pose, scene.meshes[i].scale});
  }
  picture.set_meshes(meshes);
}

}  // namespace

void save_picture(const std::filesystem::path& png, const ArmDescription& arm, const Scene& scene,
                  std::span<const double> row) {
  constexpr int kWidth = 1280, kHeight = 800;
  const OffscreenContext context(kWidth, kHeight);
  SceneView picture(data_dir() / "shaders", arm, scene);
  picture.set_quality(Quality::level(0));  // there is time
  draw_meshes(scene, picture);
  const RowLayout layout(arm.dof());
  const RowView rows(arm);
  ViewState view = rows.view(layout, row);
  const Vec3 force = rows.tip_force(layout.in(row, Column::proxy_position),
                                    layout.in(row, Column::contact_torque));
  const ContactForce contact{view.proxy.tip, force, force.stableNormalized()};
  ViewMemory().update(view, {&contact, 1}, 0);
  Camera camera;
  camera.resize(kWidth, kHeight);
  camera.reset(picture.bounds());
  camera.finish();
  picture.draw(view, camera, 0, 0, kWidth, kHeight);
  write_png(png, kWidth, kHeight, read_rgba(kWidth, kHeight));
}

}  // namespace limpid
