// Time of a frame of 1280 x 720 with models of many sizes, at each level of quality. render_bench
// [FOLDER] also writes the pictures.
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <numbers>

#include "render/gl/offscreen.h"
#include "render/model/simplify.h"
#include "render/scene_view.h"

namespace limpid {
namespace {

constexpr int kWidth = 1280, kHeight = 720, kFrames = 15;

// A ball of 6 cm with dimples, of about `triangles` triangles.
std::shared_ptr<const Model> dimpled_ball(std::size_t triangles) {
  const auto rows = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(triangles) / 4));
  const std::uint32_t columns = 2 * rows;
  auto model = std::make_shared<Model>();
  for (std::uint32_t r = 0; r <= rows; ++r)
    for (std::uint32_t c = 0; c <= columns; ++c) {
      const double theta = std::numbers::pi * r / rows, phi = 2 * std::numbers::pi * c / columns;
      const Vec3 out(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                     std::cos(theta));
      Vertex v;
      v.position =
          (0.06 * (1 + 0.03 * std::sin(14 * theta) * std::sin(14 * phi)) * out).cast<float>();
      v.normal = out.cast<float>();
      v.color = Eigen::Vector3f(0.75f, 0.62f, 0.45f);
      model->vertices.push_back(v);
    }
  for (std::uint32_t r = 0; r < rows; ++r)
    for (std::uint32_t c = 0; c < columns; ++c) {
      const std::uint32_t a = r * (columns + 1) + c, b = a + columns + 1;
      model->indices.insert(model->indices.end(), {a, b, b + 1, a, b + 1, a + 1});
    }
  model->parts.push_back({0, static_cast<std::uint32_t>(model->indices.size()), {}});
  add_coarse(*model);
  return model;
}

ArmDescription two_links() {
  ArmDescription arm;
  arm.joints.resize(2);
  arm.links.resize(2);
  for (Joint& joint : arm.joints) joint.axis = Vec3::UnitY();
  arm.joints[1].origin.translation() = Vec3(0.15, 0, 0);
  arm.tip.translation() = Vec3(0.15, 0, 0);
  return arm;
}

struct FrameTime {
  double wall, processor;  // [ms], `processor` over all threads
};

double median(std::vector<double> times) {
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return *middle;
}

// Moves the second link, so that every frame is another picture.
FrameTime median_frame(SceneView& view, ViewState state, const Camera& camera) {
  std::vector<double> wall, processor;
  const Pose straight = state.proxy.links[1];
  for (int i = 0; i <= kFrames; ++i) {
    state.proxy.links[1] = straight * Eigen::AngleAxisd(0.02 * i, Vec3::UnitY());
    state.proxy.tip = state.proxy.links[1] * Vec3(0.15, 0, 0);
    state.device.links[1] = straight * Eigen::AngleAxisd(0.02 * i + 0.05, Vec3::UnitY());
    state.device.tip = state.device.links[1] * Vec3(0.15, 0, 0);
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t begin = std::clock();
    view.draw(state, camera, 0, 0, kWidth, kHeight);
    glFinish();
    if (i == 0) continue;  // the first frame also prepares
    wall.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
            .count());
    processor.push_back(1000.0 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return {median(wall), median(processor)};
}

void run(const char* folder) {
  const OffscreenContext context(kWidth, kHeight);
  fmt::print("{}\n", reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
  const ArmDescription arm = two_links();
  Scene scene;
  scene.add({"table", pose_at(Vec3(0, 0, -0.1)), Plane{Vec3::UnitZ()}, 600});
  SceneView view(std::string(LIMPID_SOURCE_DIR) + "/shaders", arm, scene, {});
  Camera camera;
  camera.resize(kWidth, kHeight);
  ViewState state;
  state.proxy.links = {Pose::Identity(), arm.joints[1].origin};
  state.device = state.proxy;
  for (const std::size_t triangles : {0, 50'000, 1'000'000}) {
    const auto model = dimpled_ball(std::max<std::size_t>(triangles, 100));
    Pose pose = Pose::Identity();
    pose.translation() = Vec3(0.22, 0, -0.04);
    if (triangles > 0) view.set_meshes(std::vector<MeshPicture>{{model, pose, 1, false}});
    camera.reset(view.bounds());
    camera.finish();
    fmt::print("{:8} triangles ({} coarse), ms a frame (of the processor):", triangles,
               model->coarse.size() / 3);
    for (int level = 0; level <= Quality::kLowest; ++level) {
      view.set_quality(Quality::level(level));
      const FrameTime time = median_frame(view, state, camera);
      fmt::print("  level {} {:.1f} ({:.1f})", level, time.wall, time.processor);
      std::fflush(stdout);
      if (folder)
        write_png(fmt::format("{}/{}_{}.png", folder, triangles, level), kWidth, kHeight,
                  read_rgba(kWidth, kHeight));
    }
    fmt::print("\n");
  }
}

}  // namespace
}  // namespace limpid

int main(int argc, char** argv) {
  limpid::run(argc > 1 ? argv[1] : nullptr);
  return 0;
}
