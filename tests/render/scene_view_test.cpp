// The picture of a scene, read back from its pixels. Skipped where EGL gives no context.
#include "render/scene_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>

#include "render/gl/offscreen.h"
#include "render/mesh_shapes.h"
#include "render/theme.h"
#include "tests/render/two_links.h"
#include "tests/support/computer.h"
#include "tests/support/faultless_context.h"

namespace limpid {
namespace {

using test::kHeight;
using test::kWidth;
using test::pose_of;

const std::filesystem::path kRoot = LIMPID_SOURCE_DIR;
const std::vector<VisualPicture> kNoVisuals, kMissing{{"/nowhere/table.glb", Pose::Identity(), 1}};

class Picture : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::has_offscreen_pictures()) GTEST_SKIP() << "no EGL here";
    context_.emplace(kWidth, kHeight);
    view_.emplace(kRoot / "shaders", arm_, Scene{}, kNoVisuals);
    camera_.resize(kWidth, kHeight);
    camera_.look(Camera::View::side);
    camera_.frame(Bounds(Vec3(-0.1, -0.1, -0.3), Vec3(0.4, 0.1, 0.3)));
    camera_.finish();
    state_.show_grid = false;
    state_.show_error = false;
  }

  // Red, green and blue of the pixel where a point of the world appears.
  Eigen::Vector3i seen_at(const Vec3& point) {
    view_->draw(state_, camera_, 0, 0, kWidth, kHeight);
    const auto rgba = read_rgba(kWidth, kHeight);
    const Eigen::Vector2i pixel = camera_.project(point).value().cast<int>();
    const auto at = 4 * static_cast<std::size_t>(pixel.y() * kWidth + pixel.x());
    return {rgba[at], rgba[at + 1], rgba[at + 2]};
  }

  ArmDescription arm_ = test::two_links();
  std::optional<test::FaultlessContext> context_;
  std::optional<SceneView> view_;
  Camera camera_;
  ViewState state_;
};

const Vec3 kMiddleOfSecondLink(0.3, 0, 0);

bool orange(const Eigen::Vector3i& c) { return c[0] > c[1] + 15 && c[1] > c[2] + 15; }
bool blue(const Eigen::Vector3i& c) { return c[2] > c[1] + 15 && c[1] > c[0] + 5; }

TEST_F(Picture, ShowsTheDeviceInOrange) {
  state_.device = pose_of(arm_, 0, 0);
  EXPECT_TRUE(orange(seen_at(kMiddleOfSecondLink)));
  state_.show_ghost = false;
  EXPECT_FALSE(orange(seen_at(kMiddleOfSecondLink)));
}

TEST_F(Picture, ShowsTheProxyInBlueInBothThemes) {
  state_.proxy = pose_of(arm_, 0, 0);
  EXPECT_TRUE(blue(seen_at(kMiddleOfSecondLink)));
  state_.theme = Theme::light;
  EXPECT_TRUE(blue(seen_at(kMiddleOfSecondLink)));
}

TEST_F(Picture, LetsTheProxyHideAGhostAtTheSamePlace) {
  state_.device = state_.proxy = pose_of(arm_, 0, 0);
  EXPECT_TRUE(blue(seen_at(kMiddleOfSecondLink)));
}

TEST_F(Picture, ShowsASecondRunInPalerColoursOverTheFirst) {
  const ArmPose elsewhere = pose_of(arm_, -0.7, 0);
  const Vec3 middle = elsewhere.links[1] * Vec3(0.1, 0, 0);
  state_.device = pose_of(arm_, 0, 0);
  const auto warmth = [&](const Vec3& point) {
    const Eigen::Vector3i seen = seen_at(point);
    return seen[0] - seen[2];
  };
  const int nothing = warmth(middle), first = warmth(kMiddleOfSecondLink);
  state_.beside.assign(1, {});
  state_.beside[0].device = elsewhere;
  EXPECT_GT(warmth(middle), nothing + 10);
  EXPECT_LT(warmth(middle), first - 10);
  state_.beside[0] = {};
  state_.beside[0].proxy = elsewhere;
  const Eigen::Vector3i proxy = seen_at(middle);
  EXPECT_GT(proxy[2], proxy[0]) << "as blue as a proxy is";
  EXPECT_FALSE(view_->differs(state_, camera_));
  state_.beside[0].proxy = pose_of(arm_, -0.8, 0);
  EXPECT_TRUE(view_->differs(state_, camera_)) << "it has moved";
}

TEST_F(Picture, ShowsEachJointsAxisInItsColour) {
  camera_.look(Camera::View::top);
  camera_.finish();
  state_.proxy = pose_of(arm_, 0, 0);
  state_.show_joints = true;
  for (const Theme theme : {Theme::dark, Theme::light}) {
    state_.theme = theme;
    for (std::size_t joint = 0; joint < 2; ++joint) {
      const Eigen::Vector3i seen = seen_at(Vec3(0.2 * static_cast<double>(joint), 0.014, 0));
      const unsigned wanted = joint_colours(theme)[joint];
      const Eigen::Vector3i colour(wanted >> 16, wanted >> 8 & 255, wanted & 255);
      EXPECT_LT((seen - colour).cwiseAbs().maxCoeff(), 12) << joint << ": " << seen.transpose();
    }
  }
}

TEST_F(Picture, ShowsAGhostInsideOfWhatItTouches) {
  Scene scene;
  scene.add({"", pose_at(kMiddleOfSecondLink), Box{Vec3(0.12, 0.15, 0.12)}});
  view_.emplace(kRoot / "shaders", arm_, scene, kNoVisuals);
  const Eigen::Vector3i without = seen_at(kMiddleOfSecondLink);
  state_.device = pose_of(arm_, 0, 0);
  const Eigen::Vector3i with = seen_at(kMiddleOfSecondLink);
  EXPECT_GT(with[0] - with[2], without[0] - without[2] + 15);
}

TEST_F(Picture, DrawsAForceTwoCentimetresLongPerNewton) {
  camera_.frame(Bounds(Vec3(0.22, -0.05, -0.02), Vec3(0.38, 0.05, 0.13)));
  camera_.finish();
  state_.contacts.push_back({Vec3(0.3, 0, 0), Vec3(0, 0, 5), 1});
  const auto red = [&](double z) {
    const Eigen::Vector3i c = seen_at(Vec3(0.3, 0, z));
    return c[0] > c[1] + 60;
  };
  EXPECT_TRUE(red(0.05));
  EXPECT_TRUE(red(0.095));
  EXPECT_FALSE(red(0.103));
}

TEST_F(Picture, ShowsTheProxyWithEveryQuality) {
  state_.proxy = pose_of(arm_, 0, 0);
  for (const Quality& quality : {Quality{4, 2048, true}, Quality{1, 512, false},
                                 Quality{1, 0, false}, Quality{64, 256, true}}) {
    view_->set_quality(quality);
    EXPECT_TRUE(blue(seen_at(kMiddleOfSecondLink)));
  }
}

TEST_F(Picture, StaysInsideOfItsRectangle) {
  view_->draw(state_, camera_, 0, 0, kWidth, kHeight);
  const auto before = read_rgba(kWidth, kHeight);
  state_.theme = Theme::light;
  view_->draw(state_, camera_, 100, 50, 60, 40);
  const auto after = read_rgba(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool inside = x >= 100 && x < 160 && y >= kHeight - 90 && y < kHeight - 50;
      const auto at = 4 * static_cast<std::size_t>(y * kWidth + x);
      ASSERT_EQ(inside, before[at] != after[at]) << x << ", " << y;
    }
}

TEST_F(Picture, LeavesOutAnArmWhosePosesAreNotFinite) {
  const Eigen::Vector3i empty = seen_at(kMiddleOfSecondLink);
  state_.proxy = pose_of(arm_, std::nan(""), 0);
  EXPECT_EQ(seen_at(kMiddleOfSecondLink), empty);
}

TEST_F(Picture, NamesFileAndLineOfABrokenShader) {
  const auto copy = std::filesystem::path(testing::TempDir()) / "broken_shaders";
  std::filesystem::remove_all(copy);
  std::filesystem::copy(kRoot / "shaders", copy);
  std::ofstream(copy / "ghost.frag") << "out vec4 color;\nvoid main() { color = nonsense; }\n";
  try {
    SceneView broken(copy, arm_, Scene{}, kNoVisuals);
    FAIL() << "a broken shader was accepted";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("ghost.frag:2"), std::string::npos) << error.what();
  }
}

TEST_F(Picture, NamesTheModelThatIsMissing) {
  EXPECT_THROW(SceneView(kRoot / "shaders", arm_, Scene{}, kMissing), std::runtime_error);
}

std::shared_ptr<const Model> patch_of(const Eigen::Vector3f& color) {
  auto model = std::make_shared<Model>(make_box(Vec3(0.1, 0.1, 0.1), 0.01, {color}));
  return model;
}

bool is_green(const Eigen::Vector3i& c) { return c[1] > c[0] + 25 && c[1] > c[2] + 25; }

TEST_F(Picture, ShowsMeshesWhereTheyAre) {
  const auto model = patch_of({0.05f, 0.6f, 0.05f});
  const Vec3 there(0.1, 0, 0.15), elsewhere(0.3, 0, -0.15);
  view_->set_meshes(std::vector<MeshPicture>{{model, pose_at(there), 1, false}});
  EXPECT_TRUE(is_green(seen_at(there)));
  EXPECT_FALSE(is_green(seen_at(elsewhere)));
  view_->set_meshes(std::vector<MeshPicture>{{model, pose_at(elsewhere), 0.5, true}});
  EXPECT_FALSE(is_green(seen_at(there)));
  EXPECT_TRUE(is_green(seen_at(elsewhere)));
  EXPECT_FALSE(is_green(seen_at(elsewhere + Vec3(0.04, 0, 0))));
  view_->set_meshes({});
  EXPECT_FALSE(is_green(seen_at(elsewhere)));
}

TEST_F(Picture, OutlinesAHighlightedMesh) {
  const auto model = patch_of({0.05f, 0.6f, 0.05f});
  const Vec3 there(0.1, 0, 0.15);
  camera_.look(Camera::View::side);
  const auto bright_pixels = [&](bool highlighted) {
    view_->set_meshes(std::vector<MeshPicture>{{model, pose_at(there), 1, highlighted}});
    view_->draw(state_, camera_, 0, 0, kWidth, kHeight);
    const auto rgba = read_rgba(kWidth, kHeight);
    int count = 0;
    for (std::size_t i = 0; i < rgba.size(); i += 4)
      count += rgba[i] > 200 && rgba[i + 1] > 200 && rgba[i + 2] > 200;
    return count;
  };
  EXPECT_GT(bright_pixels(true), bright_pixels(false) + 50);
}

TEST_F(Picture, ShowsTheTextureOfAMesh) {
  Model model = make_box(Vec3(0.1, 0.1, 0.1), 0.01, {{1, 1, 1}});
  model.images.push_back({1, 1, {20, 200, 20, 255}});
  model.parts[0].material.color = 0;
  const Vec3 there(0.1, 0, 0.15);
  const auto shared = std::make_shared<const Model>(std::move(model));
  view_->set_meshes(std::vector<MeshPicture>{{shared, pose_at(there), 1, false}});
  EXPECT_TRUE(is_green(seen_at(there)));
}

TEST_F(Picture, LetsTheBackgroundThroughWhereAMeshIsCutOut) {
  const Vec3 there(0.1, 0, 0.15);
  const Eigen::Vector3i empty = seen_at(there);
  Model model = make_box(Vec3(0.1, 0.1, 0.1), 0.01, {{0.05f, 0.6f, 0.05f}});
  for (Vertex& v : model.vertices) v.opacity = 0.3f;
  model.parts[0].material.alpha = Finish::Alpha::mask;
  state_.show_grid = false;
  view_->set_quality({.msaa = 1, .shadow_size = 0, .soft = false});
  const auto shared = std::make_shared<const Model>(std::move(model));
  view_->set_meshes(std::vector<MeshPicture>{{shared, pose_at(there), 1, false}});
  EXPECT_LE((seen_at(there) - empty).cwiseAbs().maxCoeff(), 2);
}

TEST_F(Picture, FramesMeshesWithinReachOnly) {
  const auto model = patch_of({1, 1, 1});
  const Bounds before = view_->bounds();
  view_->set_meshes(std::vector<MeshPicture>{{model, pose_at(Vec3(20, 0, 0)), 1, false}});
  EXPECT_TRUE(view_->bounds().isApprox(before));
  const Vec3 below(0.2, 0, before.min().z() - 0.04);
  view_->set_meshes(std::vector<MeshPicture>{{model, pose_at(below), 1, false}});
  EXPECT_TRUE(view_->bounds().contains(Vec3(below)));
}

TEST_F(Picture, LeavesOutMeshesThatCannotBeDrawn) {
  const auto model = patch_of({0.05f, 0.6f, 0.05f});
  const Eigen::Vector3i empty = seen_at(Vec3(0.1, 0, 0.15));
  view_->set_meshes(std::vector<MeshPicture>{{nullptr, pose_at(Vec3(0.1, 0, 0.15)), 1, false},
                                             {model, pose_at(Vec3(std::nan(""), 0, 0)), 1, true},
                                             {model, pose_at(Vec3(0.1, 0, 0.15)), 0, false},
                                             {std::make_shared<Model>(), Pose::Identity()}});
  EXPECT_EQ(seen_at(Vec3(0.1, 0, 0.15)), empty);
}

TEST_F(Picture, ExchangesTheSceneAndKeepsTheRest) {
  state_.proxy = pose_of(arm_, 0, 0);
  const Vec3 there(0.1, 0, 0.15);
  const Eigen::Vector3i empty = seen_at(there);
  Scene scene;
  scene.add({"", pose_at(there), Box{}});
  view_->set_scene(scene, kNoVisuals);
  EXPECT_GT((seen_at(there) - empty).cwiseAbs().maxCoeff(), 15);
  EXPECT_TRUE(blue(seen_at(kMiddleOfSecondLink)));
  EXPECT_THROW(view_->set_scene({}, kMissing), std::runtime_error);
  EXPECT_GT((seen_at(there) - empty).cwiseAbs().maxCoeff(), 15);
  view_->set_scene({}, kNoVisuals);
  EXPECT_LE((seen_at(there) - empty).cwiseAbs().maxCoeff(), 2);
}

TEST_F(Picture, LaysTheContactPatchOnTheSurface) {
  camera_.look(Camera::View::top);
  camera_.frame(Bounds(Vec3(0.25, -0.05, -0.02), Vec3(0.35, 0.05, 0.02)));
  camera_.finish();
  state_.show_forces = false;
  const auto red_pixels = [&](const Vec3& normal, double force) {
    state_.contacts = {{Vec3(0.3, 0, 0), Vec3(force, 0, 0), 1, normal}};
    view_->draw(state_, camera_, 0, 0, kWidth, kHeight);
    const auto rgba = read_rgba(kWidth, kHeight);
    int count = 0;
    for (std::size_t i = 0; i < rgba.size(); i += 4) count += rgba[i] > rgba[i + 2] + 30;
    return count;
  };
  EXPECT_GT(red_pixels(Vec3::UnitZ(), 1), 5 * red_pixels(Vec3::UnitX(), 1));
  EXPECT_GT(red_pixels(Vec3::UnitZ(), 5), 2 * red_pixels(Vec3::UnitZ(), 0.5));
}

TEST_F(Picture, FillsItsRectangleAtHalfTheResolution) {
  state_.proxy = pose_of(arm_, 0, 0);
  view_->set_quality(Quality::level(Quality::kLowest));
  EXPECT_TRUE(blue(seen_at(kMiddleOfSecondLink)));
  EXPECT_TRUE(blue(seen_at(Vec3(0.05, 0, 0))));
}

}  // namespace
}  // namespace limpid
