// What is drawn anew from frame to frame, and that nothing is missing then. Skipped where EGL gives
// no context.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "render/gl/offscreen.h"
#include "render/marks.h"
#include "render/scene_view.h"

namespace limpid {
namespace {

constexpr int kWidth = 320, kHeight = 200;

ArmDescription two_links() {
  ArmDescription arm;
  arm.joints.resize(2);
  arm.links.resize(2);
  for (Joint& joint : arm.joints) joint.axis = Vec3::UnitY();
  arm.joints[1].origin.translation() = Vec3(0.2, 0, 0);
  arm.tip.translation() = Vec3(0.2, 0, 0);
  return arm;
}

ArmPose pose_of(const ArmDescription& arm, double first, double second) {
  Pose a = arm.joints[0].origin;
  a.rotate(Eigen::AngleAxisd(first, Vec3::UnitY()));
  Pose b = a * arm.joints[1].origin;
  b.rotate(Eigen::AngleAxisd(second, Vec3::UnitY()));
  return {{a, b}, b * Vec3(arm.tip.translation()), {}};
}

Scene table() {
  Scene scene;
  scene.add({"table", pose_at(Vec3(0, 0, -0.12)), Plane{Vec3::UnitZ()}});
  scene.add({"ball", pose_at(Vec3(0.3, 0.1, -0.06)), Sphere{0.05}});
  return scene;
}

class SteadyPicture : public testing::Test {
 protected:
  void SetUp() override {
    try {
      context_.emplace(kWidth, kHeight);
    } catch (const std::runtime_error& error) {
      GTEST_SKIP() << error.what();
    }
    view_.emplace(std::string(LIMPID_SOURCE_DIR) + "/shaders", arm_, table(),
                  std::vector<VisualPicture>{});
    camera_.resize(kWidth, kHeight);
    camera_.reset(view_->bounds());
    camera_.finish();
    move(0);
  }

  // A moment of a motion in which everything shows up by turns.
  void move(int step) {
    const double t = 0.9 * step;
    state_.proxy = pose_of(arm_, 0.9 * std::sin(t), 0.5 * std::cos(2 * t));
    state_.device = pose_of(arm_, 0.9 * std::sin(t) + 0.05, 0.5 * std::cos(2 * t) + 0.1);
    state_.show_ghost = step % 5 != 4;
    state_.contacts.clear();
    if (step % 3 == 0)
      state_.contacts = {
          {state_.proxy.tip, Vec3(0.1 * step, 0, 1), 0.05 * step, Vec3::UnitZ(), 0.5}};
    state_.shade.reset();
    if (step % 2 == 0) state_.shade = ContactShade{state_.proxy.tip - Vec3(0, 0, 0.02)};
    state_.show_hand = step % 4 == 1;
    state_.hand_target = state_.device.tip + Vec3(0.05, 0, 0.05);
  }

  bool draw() { return view_->draw(state_, camera_, 0, 0, kWidth, kHeight); }
  std::vector<unsigned char> pixels() { return read_rgba(kWidth, kHeight); }

  ArmDescription arm_ = two_links();
  std::optional<OffscreenContext> context_;
  std::optional<SceneView> view_;
  Camera camera_;
  ViewState state_;
};

TEST_F(SteadyPicture, IsNotDrawnAgainWhereNothingHasChanged) {
  EXPECT_TRUE(draw());
  const auto before = pixels();
  EXPECT_FALSE(draw());
  EXPECT_EQ(pixels(), before);
  EXPECT_FALSE(view_->differs(state_, camera_));
  state_.proxy.links[1].translation().x() += 1e-7;  // far below a pixel
  EXPECT_FALSE(draw());
  state_.proxy.links[1].translation().x() += 0.01;
  EXPECT_TRUE(view_->differs(state_, camera_));
  EXPECT_TRUE(draw());
  EXPECT_NE(pixels(), before);
}

TEST_F(SteadyPicture, CreepsAlongHoweverSmallTheSteps) {
  draw();
  int drawn = 0;
  for (int i = 0; i < 100; ++i) {
    state_.proxy.tip.x() += 1e-4;
    drawn += draw();
  }
  EXPECT_GE(drawn, 2);
  EXPECT_LT(drawn, 100);
}

TEST_F(SteadyPicture, IsDrawnAgainForCameraThemeQualityAndScene) {
  draw();
  camera_.orbit(5, 0);
  EXPECT_TRUE(draw());
  state_.theme = Theme::light;
  EXPECT_TRUE(draw());
  state_.show_grid = false;
  EXPECT_TRUE(draw());
  view_->set_quality(Quality::level(3));
  EXPECT_TRUE(draw());
  view_->set_scene({}, {});
  EXPECT_TRUE(draw());
  EXPECT_FALSE(draw());
}

// Frame by frame only parts are drawn: the whole must be what a fresh view draws at once.
TEST_F(SteadyPicture, IsTheSameDrawnInPartsOrAtOnce) {
  for (const int level : {0, 2, 3, 4, 5}) {
    view_->set_quality(Quality::level(level));
    for (int step = 0; step < 12; ++step) {
      move(step);
      draw();
      const auto in_parts = pixels();
      view_->set_quality(Quality::level(level));  // forgets what was there
      draw();
      const auto at_once = pixels();
      int wrong = 0;
      for (std::size_t i = 0; i < at_once.size(); ++i)
        wrong += std::abs(int{at_once[i]} - int{in_parts[i]}) > 2;
      ASSERT_LT(wrong, 12) << "level " << level << ", step " << step;
      move(step + 1);
      draw();  // the next one begins from a picture drawn in parts
    }
  }
}

// Lines and marks as wide as on the finest screens: what they leave is wiped off as well.
TEST_F(SteadyPicture, IsTheSameInPartsHoweverWideItsLines) {
  view_->set_quality(Quality::level(2));
  view_->set_pixel_scale(6);
  state_.show_joints = true;
  for (int step = 0; step < 8; ++step) {
    move(step);
    state_.proxy = pose_of(arm_, -0.6, 0.4);  // rests: the lines alone move
    state_.contacts.clear();
    state_.shade.reset();
    draw();
    const auto in_parts = pixels();
    view_->set_quality(Quality::level(2));  // forgets what was there
    draw();
    const auto at_once = pixels();
    int wrong = 0;
    for (std::size_t i = 0; i < at_once.size(); ++i)
      wrong += std::abs(int{at_once[i]} - int{in_parts[i]}) > 2;
    ASSERT_LT(wrong, 12) << "step " << step;
  }
}

TEST(FrictionCone, HasTheHalfAngleOfItsCoefficient) {
  ViewState state;
  const Vec3 normal = Vec3(0.3, -0.2, 0.9).normalized();
  state.contacts = {{Vec3(0.1, 0.2, 0.3), 3 * normal, 1, normal, 0.7}};
  const Marks marks = collect_marks(state, Camera(), 1);
  ASSERT_EQ(marks.glass.size(), 1u);
  const glm::mat4& cone = marks.glass[0].place;  // of radius and height 1, its tip at z = 1
  const glm::vec3 tip = cone * glm::vec4(0, 0, 1, 1), base = cone * glm::vec4(0, 0, 0, 1);
  const glm::vec3 rim = cone * glm::vec4(1, 0, 0, 1);
  EXPECT_NEAR(glm::length(tip - glm::vec3(0.1f, 0.2f, 0.3f)), 0, 1e-6);
  EXPECT_NEAR(glm::length(rim - base) / glm::length(base - tip), 0.7, 1e-5);
  const glm::vec3 axis = glm::normalize(base - tip);
  EXPECT_NEAR(axis.x * normal.x() + axis.y * normal.y() + axis.z * normal.z(), 1, 1e-6);
  state.contacts[0].friction = 0;
  EXPECT_TRUE(collect_marks(state, Camera(), 1).glass.empty());
}

TEST(Magnified, ShowsAPointInTheMiddleAndSoManyTimesAsLarge) {
  Camera camera;
  camera.resize(900, 500);
  camera.orbit(40, -13);
  const Vec3 point(0.11, -0.07, 0.05);
  const Camera lens = camera.magnified(point, 5, 200, 200);
  EXPECT_NEAR((*lens.project(point) - Eigen::Vector2d(100, 100)).norm(), 0, 1e-6);
  EXPECT_NEAR(camera.meters_per_pixel(point) / lens.meters_per_pixel(point), 5, 1e-9);
  EXPECT_NEAR((camera.eye() - lens.eye()).norm(), 0, 1e-9);
}

}  // namespace
}  // namespace limpid
