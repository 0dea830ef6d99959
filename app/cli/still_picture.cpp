#include "app/cli/still_picture.h"

#include "app/base/folders.h"
#include "app/stage/row_view.h"
#include "render/gl/offscreen.h"
#include "render/scene_view.h"

namespace limpid {

void save_picture(const std::filesystem::path& png, const RunPlan& plan,
                  std::span<const double> rows) {
  constexpr int kWidth = 1280, kHeight = 800;
  const OffscreenContext context(kWidth, kHeight);
  SceneView picture(data_dir() / "shaders", plan.arm, plan.document.scene,
                    visual_pictures(plan.document));
  picture.set_quality(Quality::level(0));  // best quality, as time does not matter
  picture.set_meshes(mesh_pictures(plan.document.scene, plan.models));
  const RowLayout layout = plan.layout();
  const RowView reader(plan.arm, plan.document.scene);
  const auto stride = static_cast<std::size_t>(layout.stride());
  const auto view_of = [&](std::size_t lane) {
    const std::span<const double> row = rows.subspan(lane * stride, stride);
    ViewState view = reader.view(layout, row);
    ViewMemory().update(view, reader.contacts(layout, row), 0);
    return view;
  };
  ViewState view = view_of(kMainLane);
  for (std::size_t lane = 1; lane < rows.size() / stride; ++lane) lay_over(view, view_of(lane));
  Camera camera;
  camera.resize(kWidth, kHeight);
  camera.reset(picture.bounds());
  camera.finish();
  picture.draw(view, camera, 0, 0, kWidth, kHeight);
  write_png(png, kWidth, kHeight, read_rgba(kWidth, kHeight));
}

}  // namespace limpid
