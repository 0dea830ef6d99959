// The 3D view, drawn frame by frame. Skipped where EGL gives no context.
#include "app/desktop/view/view_panel.h"

#include "app/desktop/base/first_steps.h"
#include "tests/app/desktop/view/a_view.h"
#include "tests/support/meshes.h"

namespace limpid {
namespace {

// The row is the same in every frame, as in paused playback, after a motion.
TEST_F(AView, IsNotDrawnAgainWhileARowStandsStill) {
  for (const double time : {0.0, 0.1, 0.2}) {
    layout_.in(std::span(row_), Column::time)[0] = time;
    layout_.in(std::span(row_), Column::device_position)[0] = time;
    draw();
    EXPECT_FALSE(differs(settings_)) << time;
  }
}

TEST_F(AView, IsDrawnAgainForEachOfItsSwitches) {
  draw();
  EXPECT_FALSE(differs(settings_)) << "nothing has moved";
  using Switch = bool Settings::*;
  for (const Switch one : {&Settings::show_ghost, &Settings::show_trail, &Settings::show_forces,
                           &Settings::show_grid, &Settings::show_joints}) {
    Settings other = settings_;
    other.*one = !(other.*one);
    EXPECT_TRUE(differs(other));
  }
  Settings other = settings_;
  other.theme = other.theme == Theme::dark ? Theme::light : Theme::dark;
  EXPECT_TRUE(differs(other));
}

TEST_F(AView, PullsTheArmFromNearItsTipAndTurnsElsewhere) {
  draw();
  const Eigen::Vector2d at_tip = seen(tip()), aside = at_tip + Eigen::Vector2d(0, -60);
  const Vec3 eye = camera_.eye();
  point(at_tip + Eigen::Vector2d(20, 10));
  press(0, true);
  EXPECT_TRUE(controls_.grab);
  EXPECT_TRUE(controls_.goal.isApprox(tip(), 1e-6)) << "nothing has moved yet";
  point(at_tip + Eigen::Vector2d(30, 10));
  EXPECT_NEAR((seen(controls_.goal) - at_tip).x(), 10, 1e-3);
  EXPECT_EQ(camera_.eye(), eye);
  press(0, false);
  EXPECT_FALSE(controls_.grab);

  point(aside);
  press(0, true);
  EXPECT_FALSE(controls_.grab);
  point(aside + Eigen::Vector2d(30, 0));
  EXPECT_TRUE(asked_.turned);
  EXPECT_NE(camera_.eye(), eye);
  press(0, false);
  EXPECT_FALSE(asked_.clicked) << "it has turned the camera";
}

TEST_F(AView, NamesWhatTheMouseRestsOnWithItsMassUnlessThatIsItsName) {
  SceneDocument document;
  for (const char* name : {"die", "50 g"}) {
    Object ball{name, pose_at(tip() + Vec3(0, name[0] == 'd' ? -0.1 : -0.16, 0)), Sphere{0.01}};
    ball.body.emplace();
    ball.body->mass = 0.05;
    document.scene.add(ball);
  }
  objects_ = document.scene;
  open(document);
  point({5, 5});
  const auto named_at = [&](const Vec3& place) {
    point(seen(place));
    for (int k = 0; k < 40; ++k) draw();
    std::string said;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.window.starts_with("##Tooltip")) said += each.text;
    }
    return said;
  };
  EXPECT_EQ(named_at(tip() + Vec3(0, -0.1, 0)), "die, 50 g");
  EXPECT_EQ(named_at(tip() + Vec3(0, -0.16, 0)), "50 g");
}

TEST_F(AView, PullsABodyWithCtrl) {
  draw();
  const Vec3 point = tip() + Vec3(0, 0.03, 0.02);
  const Eigen::Vector2d at = seen(point);
  const Vec3 eye = camera_.eye();
  under_ = BodyPull{2, {0.01, 0, 0}, point};
  point_at_body(at);
  EXPECT_EQ(controls_.pull.body, 2);
  EXPECT_FALSE(controls_.grab);
  EXPECT_LT((controls_.pull.target - point).norm(), 1e-6) << "nothing has moved yet";
  this->point(at + Eigen::Vector2d(15, -10));
  EXPECT_LT((seen(controls_.pull.target) - at - Eigen::Vector2d(15, -10)).norm(), 1e-3);
  EXPECT_EQ(controls_.pull.point, Vec3(0.01, 0, 0));
  EXPECT_EQ(camera_.eye(), eye);
  show_modifiers(false, false, false);
  draw();
  EXPECT_EQ(controls_.pull.body, 2) << "as long as the button is down";
  press(0, false);
  EXPECT_EQ(controls_.pull, BodyPull{});
  EXPECT_FALSE(asked_.clicked);
}

// A block before the tip, and beside it in the picture.
TEST_F(AView, DragsTheHandOntoWhatTheMouseComesTo) {
  draw();
  const Vec3 middle = tip() - 0.04 * camera_.forward() - 0.1 * camera_.right();
  objects_.add({.name = "block", .pose = pose_at(middle), .shape = Sphere{0.008}});
  const Eigen::Vector2d at = seen(tip()), block = seen(middle);
  ASSERT_GT((block - at).norm(), 60) << "out of the mouse's reach at first";
  const auto depth = [&](const Vec3& point) { return (point - tip()).dot(camera_.forward()); };
  point(at);
  press(0, true);
  point(at + Eigen::Vector2d(10, 0));
  EXPECT_NEAR(depth(controls_.goal), 0, 1e-6) << "nothing is there";
  point(block);
  for (int i = 0; i < 60; ++i) draw();
  EXPECT_NEAR(depth(controls_.goal), depth(middle), 1e-3) << "in the middle of what is thin";
  EXPECT_LT((seen(controls_.goal) - block).norm(), 1) << "under the mouse as ever";

  // Nothing that is pushed away is followed.
  objects_.objects[0].pose.translation() += 0.02 * camera_.forward();
  for (int i = 0; i < 60; ++i) draw();
  EXPECT_NEAR(depth(controls_.goal), depth(middle), 1e-3);
  press(0, false);
}

TEST_F(AView, KeepsTheDepthWithShift) {
  draw();
  const Vec3 middle = tip() - 0.04 * camera_.forward() - 0.1 * camera_.right();
  objects_.add({.name = "block", .pose = pose_at(middle), .shape = Sphere{0.008}});
  point(seen(tip()));
  press(0, true);
  show_modifiers(false, true, false);
  for (int i = 0; i < 60; ++i) point(seen(middle));
  EXPECT_NEAR((controls_.goal - tip()).dot(camera_.forward()), 0, 1e-6);
  show_modifiers(false, false, false);
  press(0, false);
}

TEST_F(AView, DoesNotJumpToWhatIsBehindTheTipAtFirst) {
  draw();
  objects_.add(
      {.name = "wall", .pose = pose_at(tip() + 0.2 * camera_.forward()), .shape = Sphere{0.08}});
  point(seen(tip()));
  press(0, true);
  for (int i = 0; i < 20; ++i) point(seen(tip()) + Eigen::Vector2d(0.2 * i, 0));
  EXPECT_NEAR((controls_.goal - tip()).dot(camera_.forward()), 0, 1e-6);
  press(0, false);
}

TEST_F(AView, StopsPullingWhenTheSceneHasChanged) {
  draw();
  under_ = BodyPull{0, Vec3::Zero(), tip()};
  point_at_body(seen(tip()));
  ASSERT_EQ(controls_.pull.body, 0);
  controls_.pull = {};
  point(seen(tip()) + Eigen::Vector2d(20, 0));
  EXPECT_EQ(controls_.pull, BodyPull{});
  press(0, false);
  show_modifiers(false, false, false);
}

TEST_F(AView, TurnsWithCtrlWhereNoBodyIs) {
  draw();
  const Eigen::Vector2d aside = seen(tip()) + Eigen::Vector2d(0, -60);
  const Vec3 eye = camera_.eye();
  point_at_body(aside);
  point(aside + Eigen::Vector2d(30, 0));
  EXPECT_EQ(controls_.pull, BodyPull{});
  EXPECT_NE(camera_.eye(), eye);
  press(0, false);
  show_modifiers(false, false, false);
}

TEST_F(AView, SaysWhereSomebodyClicked) {
  draw();
  const Eigen::Vector2d aside = (seen(tip()) + Eigen::Vector2d(3, -60)).array().round();
  for (const int button : {0, 1}) {
    point(aside);
    press(button, true);
    EXPECT_FALSE(asked_.clicked || asked_.asked) << "a drag may come of it";
    point(aside + Eigen::Vector2d(2, 0));
    press(button, false);
    const auto& ray = button == 0 ? asked_.clicked : asked_.asked;
    ASSERT_TRUE(ray) << button;
    EXPECT_TRUE(ray->direction.isApprox(camera_.ray(aside).direction, 1e-5));
    draw();
    EXPECT_FALSE(asked_.clicked || asked_.asked) << "once";
  }
  EXPECT_FALSE(controls_.grab);
}

TEST_F(AView, LeavesTheHandWhereItIsWhenItIsLookedAtOtherwise) {
  draw();
  const Eigen::Vector2d at = seen(tip());
  point(at);
  press(0, true);
  point(at + Eigen::Vector2d(15, 10));
  const Vec3 goal = controls_.goal;
  rect_ = {{60, 20}, {400, 300}};  // a panel has appeared
  draw();
  EXPECT_TRUE(controls_.goal.isApprox(goal, 1e-9));
  camera_.look(Camera::View::side);
  camera_.finish();
  draw();
  EXPECT_TRUE(controls_.goal.isApprox(goal, 1e-9));
  point(at + Eigen::Vector2d(25, 10));
  EXPECT_FALSE(controls_.goal.isApprox(goal, 1e-6)) << "it goes on from there";
}

TEST_F(AView, LeavesTheMouseToWhoHasTakenIt) {
  taken_ = true;
  point(seen(tip()));
  press(0, true);
  point(seen(tip()) + Eigen::Vector2d(30, 0));
  press(0, false);
  EXPECT_FALSE(controls_.grab);
  EXPECT_FALSE(asked_.turned || asked_.clicked);
}

// Shift ends a move in depth that has begun, also when it is let go again.
TEST_F(AView, EndsAMoveInDepthWithShift) {
  draw();
  const Vec3 middle = tip() - 0.04 * camera_.forward() - 0.1 * camera_.right();
  objects_.add({.name = "block", .pose = pose_at(middle), .shape = Sphere{0.008}});
  const auto depth = [&] { return (controls_.goal - tip()).dot(camera_.forward()); };
  point(seen(tip()));
  press(0, true);
  point(seen(middle));
  draw();
  const double begun = depth();
  ASSERT_LT(begun, -1e-4);
  ASSERT_GT(begun, -0.03) << "it is on its way";
  show_modifiers(false, true, false);
  draw();
  const double held = depth();
  show_modifiers(false, false, false);
  for (int i = 0; i < 60; ++i) draw();
  EXPECT_NEAR(depth(), held, 1e-6);
  press(0, false);
}

// Once the mouse has moved, the hand takes an object's depth also where it was at the beginning.
TEST_F(AView, TakesADepthWhereTheDragBeganOnceTheMouseHasMoved) {
  draw();
  const Eigen::Vector2d at = seen(tip());
  point(at);
  press(0, true);
  point(at + Eigen::Vector2d(60, 0));
  const Vec3 middle = tip() + 0.05 * camera_.forward();
  objects_.add({.name = "ball", .pose = pose_at(middle), .shape = Sphere{0.008}});
  for (int i = 0; i < 60; ++i) point(at);
  EXPECT_NEAR((controls_.goal - tip()).dot(camera_.forward()), 0.05, 2e-3);
  press(0, false);
}

// The wheel moves the plane in which the hand is dragged, and ends a move in depth.
TEST_F(AView, PushesTheHandWithTheWheel) {
  draw();
  const auto depth = [&] { return (controls_.goal - tip()).dot(camera_.forward()); };
  point(seen(tip()));
  press(0, true);
  const double distance = camera_.distance();
  ImGui::GetIO().MouseWheel = 1;
  draw();
  ImGui::GetIO().MouseWheel = 0;
  draw();
  const double one = depth();
  EXPECT_GT(one, 1e-4) << "away from the eye";
  ImGui::GetIO().MouseWheel = -2;
  draw();
  ImGui::GetIO().MouseWheel = 0;
  draw();
  EXPECT_NEAR(depth(), -one, 1e-6);
  EXPECT_EQ(camera_.distance(), distance) << "it does not zoom meanwhile";
  press(0, false);
}

TEST(ScenesToTouch, TellATaskWithTheMouse) {
  for (const char* scene : {"table.toml", "obstacles.toml", "proximal.toml"}) {
    EXPECT_TRUE(test::omni_document(scene).about.starts_with("Drag the tip")) << scene;
  }
}

TEST_F(AView, TellsTheTaskAndTheNextStepUntilSomethingIsTouched) {
  rect_ = {{0, 0}, {800, 600}};
  SceneDocument document;
  document.about = "Ring the bell.";
  open(document);
  draw();
  EXPECT_TRUE(says("Ring the bell.")) << "from the start";
  EXPECT_TRUE(says("Drag the tip of the arm"));
  EXPECT_FALSE(says("Turn the wheel")) << "one step at a time";
  note_done(settings_, FirstStep::pull);
  draw();
  EXPECT_TRUE(says("Ring the bell."));
  EXPECT_FALSE(says("Drag the tip of the arm"));
  EXPECT_TRUE(says("Turn the wheel"));
  layout_.in(std::span(row_), Column::contact_force)[2] = 1;
  draw();
  EXPECT_FALSE(says("Ring the bell."));
  EXPECT_TRUE(says("Turn the wheel"));
}

TEST_F(AView, TellsNoHintThatTheTaskTells) {
  rect_ = {{0, 0}, {800, 600}};
  SceneDocument document;
  document.about = "Drag the tip down onto the table.";
  open(document);
  draw();
  EXPECT_TRUE(says("Drag the tip down onto the table."));
  EXPECT_FALSE(says("Drag the tip of the arm"));
}

// A ball of triangles whose middle is not its object's place.
TEST_F(AView, TellsHintsBesideAMesh) {
  rect_ = {{0, 0}, {800, 600}};
  draw();
  ASSERT_TRUE(panel_.hinted());
  const ImVec2 low = panel_.hinted()->min, high = panel_.hinted()->max;
  const ImVec2 middle{(low.x + high.x) / 2, (low.y + high.y) / 2};
  const Vec3 aside(3, 0, 0);
  Object ball =
      test::obstacle(test::icosphere(1).mapped([&](const Vec3& v) -> Vec3 { return v + aside; }));
  test::mesh_of(ball).unit = 0.1;
  ball.pose.translation() = camera_.plane_drag({middle.x, middle.y}, tip()) - 0.1 * aside;
  selected_ = ball;
  draw();
  ASSERT_TRUE(panel_.hinted());
  EXPECT_FALSE(panel_.hinted()->contains(middle));
}

TEST_F(AView, KeepsNoticesOffTheLens) {
  rect_ = {{0, 0}, {800, 600}};
  layout_.in(std::span(row_), Column::proxy_position)[0] += 0.02;
  settings_.show_lens = false;
  draw();
  const std::size_t without = panel_.crowd_with_signs().kept_free.size();
  settings_.show_lens = true;
  draw();
  const std::vector<ScreenRect> kept = panel_.crowd_with_signs().kept_free;
  ASSERT_EQ(kept.size(), without + 1);
  EXPECT_GT(kept.back().width(), 64);
  EXPECT_EQ(kept.back().width(), kept.back().height());
  EXPECT_FALSE(kept.back().contains(
      {static_cast<float>(seen(tip()).x()), static_cast<float>(seen(tip()).y())}));
}

}  // namespace
}  // namespace limpid
