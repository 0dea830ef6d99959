// The picture of an arm and of what is put beside it, seen from the side, and its colours. Skipped
// where EGL gives no context.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/gl/offscreen.h"
#include "render/mesh_shapes.h"
#include "render/scene_view.h"
#include "tests/render/two_links.h"
#include "tests/support/computer.h"
#include "tests/support/faultless_context.h"

namespace limpid::test {

using Colour = Eigen::Vector3i;

inline int apart(const Colour& a, const Colour& b) { return (a - b).cwiseAbs().maxCoeff(); }

// Seen from the side: x to the right, z up, and what has the smaller y is nearer to the eye.
class SideView : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_offscreen_pictures()) GTEST_SKIP() << "no EGL here";
    context_.emplace(kWidth, kHeight);
    show(Scene{});
    camera_.resize(kWidth, kHeight);
    camera_.look(Camera::View::side);
    camera_.frame(Bounds(Vec3(-0.1, -0.1, -0.3), Vec3(0.4, 0.1, 0.3)));
    camera_.finish();
  }
  void show(const Scene& scene) {
    view_.emplace(std::string(LIMPID_SOURCE_DIR) + "/shaders", arm_, scene,
                  std::vector<VisualPicture>{});
    view_->set_quality({.msaa = 4, .shadow_size = 0, .soft = false});
  }
  static ViewState nothing() {
    ViewState state;
    state.show_grid = state.show_error = false;
    return state;
  }
  std::vector<unsigned char> picture(const ViewState& state) {
    view_->draw(state, camera_, 0, 0, kWidth, kHeight);
    return read_rgba(kWidth, kHeight);
  }
  static Colour at(const std::vector<unsigned char>& rgba, int x, int y) {
    const auto i = 4 * static_cast<std::size_t>(y * kWidth + x);
    return {rgba[i], rgba[i + 1], rgba[i + 2]};
  }
  Colour in_picture(const std::vector<unsigned char>& rgba, const Vec3& point) const {
    const Eigen::Vector2i pixel = camera_.project(point).value().cast<int>();
    return at(rgba, pixel.x(), pixel.y());
  }
  Colour seen(const ViewState& state, const Vec3& point) {
    return in_picture(picture(state), point);
  }
  static std::shared_ptr<const Model> block(const Vec3& size, const Paint& paint = {},
                                            const std::function<void(Model&)>& change = {}) {
    Model model = make_box(size, 0.001, paint);
    if (change) change(model);
    return std::make_shared<const Model>(std::move(model));
  }
  void put(std::vector<MeshPicture> meshes) { view_->set_meshes(meshes); }

  const ArmDescription arm_ = two_links();
  std::optional<FaultlessContext> context_;
  std::optional<SceneView> view_;
  Camera camera_;
};

}  // namespace limpid::test
