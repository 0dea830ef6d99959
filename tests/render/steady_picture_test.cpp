// Partial drawing from frame to frame, compared with complete pictures. Skipped where EGL gives no
// context.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "render/gl/offscreen.h"
#include "render/marks.h"
#include "render/mesh_shapes.h"
#include "render/scene_view.h"
#include "tests/render/two_links.h"
#include "tests/support/computer.h"
#include "tests/support/faultless_context.h"

namespace limpid {
namespace {

using test::kHeight;
using test::kWidth;
using test::pose_of;

Scene table() {
  Scene scene;
  scene.add({"table", pose_at(Vec3(0, 0, -0.12)), Plane{Vec3::UnitZ()}});
  scene.add({"ball", pose_at(Vec3(0.3, 0.1, -0.06)), Sphere{0.05}});
  return scene;
}

class SteadyPicture : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::has_offscreen_pictures()) GTEST_SKIP() << "no EGL here";
    context_.emplace(kWidth, kHeight);
    view_.emplace(std::string(LIMPID_SOURCE_DIR) + "/shaders", arm_, table(),
                  std::vector<VisualPicture>{});
    camera_.resize(kWidth, kHeight);
    camera_.reset(view_->bounds());
    camera_.finish();
    move(0);
  }

  // A moment of a motion in which all parts of the picture appear in turn.
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
  // Number of bytes of the next picture, drawn in parts, that differ from a fresh view's.
  int wrong_in_parts(int level) {
    draw();
    const auto in_parts = pixels();
    view_->set_quality(Quality::level(level));  // forgets the picture
    draw();
    const auto at_once = pixels();
    int wrong = 0;
    for (std::size_t i = 0; i < at_once.size(); ++i)
      wrong += std::abs(int{at_once[i]} - int{in_parts[i]}) > 2;
    return wrong;
  }

  ArmDescription arm_ = test::two_links();
  std::optional<test::FaultlessContext> context_;
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
  state_.proxy.links[1].translation().x() += 1e-7;  // much less than a pixel
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

// Each frame draws only parts: the whole must equal a fresh view's picture.
TEST_F(SteadyPicture, IsTheSameDrawnInPartsOrAtOnce) {
  for (const int level : {0, 2, 3, 4, 5}) {
    view_->set_quality(Quality::level(level));
    for (int step = 0; step < 12; ++step) {
      move(step);
      ASSERT_LT(wrong_in_parts(level), 12) << "level " << level << ", step " << step;
      move(step + 1);
      draw();  // the next picture begins from one drawn in parts
    }
  }
}

// A cube and a bar of two parts that move over the table, and a moving model.
class MovingObjects : public SteadyPicture {
 protected:
  void SetUp() override {
    SteadyPicture::SetUp();
    if (!view_) return;
    Scene scene = table();
    scene.add({.name = "cube",
               .pose = pose_at(Vec3(0.2, 0.1, -0.1)),
               .shape = Box{Vec3::Constant(0.04)},
               .body = Body{},
               .parts = {{pose_at(Vec3(0, 0, 0.04)), Sphere{0.02}}}});
    scene.add({.name = "model", .pose = pose_at(kModel), .shape = Mesh{}, .body = Body{}});
    view_->set_scene(scene, {});
    view_->set_meshes(std::vector<MeshPicture>{
        {std::make_shared<const Model>(make_box(Vec3::Constant(0.05), 0.005, {})), Pose::Identity(),
         1, false, 1}});
    state_.proxy = pose_of(arm_, -0.6, 0.4);
    state_.device = state_.proxy;
    state_.contacts.clear();
    state_.shade.reset();
    move_bodies(0);
  }
  void move_bodies(int step) {
    Pose cube = pose_at(Vec3(0.2 + 0.02 * step, 0.1, -0.1));
    cube.rotate(Eigen::AngleAxisd(0.3 * step, Vec3::UnitZ()));
    state_.bodies = {cube, pose_at(kModel + Vec3(0, 0.01 * step, 0.01 * (step % 3)))};
  }
  // Looks from above at the objects alone.
  void look_at_shadows() {
    state_.proxy.links.clear();
    state_.device.links.clear();
    state_.show_error = state_.show_grid = state_.show_trail = false;
    camera_.look(Camera::View::top);
    camera_.frame(view_->bounds());
    camera_.finish();
  }
  int light(const Vec3& place) {
    const Eigen::Vector2i pixel = camera_.project(place).value().cast<int>();
    const auto at = 4 * static_cast<std::size_t>(pixel.y() * kWidth + pixel.x());
    return int{pixels()[at]};
  }
  const Vec3 kModel{0.1, -0.1, -0.08};
  // The light comes from (-0.30, -0.55, 1): the shadow of a cube a decimetre above the table is
  // moved so far.
  const Vec3 kCube{0.2, -0.15, -0.02}, kShadow = kCube + Vec3(0.03, 0.055, -0.1);
  const Vec3 kAway{0.1, 0, 0};
};

TEST_F(MovingObjects, AreNotDrawnAgainWhileTheySleep) {
  EXPECT_TRUE(draw());
  const auto before = pixels();
  move_bodies(0);
  EXPECT_FALSE(view_->differs(state_, camera_));
  EXPECT_FALSE(draw());
  move_bodies(1);
  EXPECT_TRUE(draw());
  EXPECT_NE(pixels(), before);
  move_bodies(0);
  EXPECT_TRUE(draw());
  EXPECT_EQ(pixels(), before);
}

// Objects have shadows, and objects of further runs and of a re-run are beside them.
TEST_F(MovingObjects, AreTheSameDrawnInPartsOrAtOnce) {
  for (const int level : {0, 2, 4}) {
    view_->set_quality(Quality::level(level));
    for (int step = 0; step < 6; ++step) {
      move_bodies(step);
      state_.rerun_bodies.clear();
      state_.beside.clear();
      std::vector<Pose> apart = state_.bodies;
      apart[0].translation().y() -= 0.03;
      if (step == 3) state_.rerun_bodies = apart;
      if (step > 3) {
        state_.beside.resize(kMostLanes - 1);
        for (OtherRun& run : state_.beside) {
          run.bodies = apart;
          apart[0].translation().y() -= 0.02;
        }
      }
      ASSERT_LT(wrong_in_parts(level), 12) << "level " << level << ", step " << step;
      move_bodies(step + 1);
      draw();  // the next picture begins from one drawn in parts
    }
  }
}

TEST_F(MovingObjects, TakeTheirShadowsWithThem) {
  view_->set_quality(Quality::level(0));
  look_at_shadows();
  state_.bodies[0] = pose_at(kCube);
  draw();
  const int dark = light(kShadow), open = light(kShadow + kAway);
  state_.bodies[0] = pose_at(kCube + kAway);
  draw();
  EXPECT_LT(dark + 10, light(kShadow));
  EXPECT_LT(light(kShadow + kAway) + 10, open);
}

TEST_F(MovingObjects, HaveShadowsWhereTheQualityHasThem) {
  look_at_shadows();
  state_.bodies[0] = pose_at(kCube);
  for (const int texels : {0, 2048, 0, 512}) {
    view_->set_quality({.msaa = 1, .shadow_size = texels, .soft = false});
    draw();
    const int darker = light(kShadow + kAway) - light(kShadow);
    if (texels > 0) {
      EXPECT_GT(darker, 10) << texels;
    } else {
      EXPECT_NEAR(darker, 0, 2);
    }
  }
}

// Without a pose in the row, or with one that is not a number, an object is at its place in the
// scene.
TEST_F(MovingObjects, AreWhereTheSceneHasThemUntilARowSaysMore) {
  state_.bodies.clear();
  draw();
  const auto as_in_scene = pixels();
  move_bodies(0);
  draw();
  EXPECT_EQ(pixels(), as_in_scene);
  state_.bodies[0].translation().x() = std::nan("");
  draw();
  EXPECT_EQ(pixels(), as_in_scene);
}

// Lines and marks are as wide as on the finest screens: their remains are wiped off as well.
TEST_F(SteadyPicture, IsTheSameInPartsHoweverWideItsLines) {
  view_->set_quality(Quality::level(2));
  view_->set_pixel_scale(6);
  state_.show_joints = true;
  for (int step = 0; step < 8; ++step) {
    move(step);
    state_.proxy = pose_of(arm_, -0.6, 0.4);  // at rest: only the lines move
    state_.contacts.clear();
    state_.shade.reset();
    draw();
    const auto in_parts = pixels();
    view_->set_quality(Quality::level(2));  // forgets the picture
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
  const glm::mat4& cone = marks.glass[0].place;  // radius and height 1, tip at z = 1
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
