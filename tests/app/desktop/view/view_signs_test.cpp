// Signs and words of the 3D view over its picture, and a mouse that turns and holds.
#include <map>
#include <string>
#include <utility>

#include "app/desktop/base/first_steps.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "tests/app/desktop/view/a_view.h"
#include "tests/support/drawn_ink.h"

namespace limpid {
namespace {

// Returns the distance of a place from a stroke between two others [px].
double apart_from_stroke(const Eigen::Vector2d& at, const Eigen::Vector2d& a,
                         const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double part = std::clamp((at - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (at - a - part * along).norm();
}

TEST_F(AView, TellsWhetherAContactSlipsUnlessNothingMoves) {
  rect_ = {{0, 0}, {800, 600}};
  SceneDocument document;
  document.scene.add({"floor", pose_at(tip()), Plane{}, {600, 0, 0.5, 0.4}});
  open(document);
  const auto touch = [&](double along, double speed) {
    const auto put = [&](Column c, const Vec3& value) {
      std::ranges::copy(value, layout_.in(std::span(row_), c).begin());
    };
    put(Column::contact_point, tip());
    put(Column::contact_force, {along, 0, 1});
    layout_.in(std::span(row_), Column::proxy_velocity)[1] = speed;
    layout_.in(std::span(row_), Column::time)[0] += 0.01;
    draw();
    return says("friction cone: slips") ? 1 : says("friction cone: sticks") ? -1 : 0;
  };
  EXPECT_EQ(touch(0.6, 0.01), 1);
  EXPECT_EQ(touch(0.6, -0.01), 1) << "in either direction";
  EXPECT_EQ(touch(0.6, 0), -1) << "nothing moves";
  EXPECT_EQ(touch(0.6, 1e-4), -1) << "that is no motion";
  EXPECT_EQ(touch(0.1, 0.01), -1) << "it holds";
  settings_.show_forces = false;
  EXPECT_EQ(touch(0.6, 0.01), 0);
  blind_ = true;
  settings_.show_forces = true;
  EXPECT_EQ(touch(0.6, 0.01), 0);
}

// Lengths along the far edge of the floor, but not over the arm.
TEST_F(AView, WritesLengthsWhereTheyAreAndNotOverTheArm) {
  rect_ = {{0, 0}, {1000, 700}};
  settings_.show_lens = false;
  using Labels = std::map<int, test::DrawnText>;  // by its length [cm]
  const auto labels = [&] {
    Labels all;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (!each.text.ends_with(" cm") || each.text.find("force") != std::string::npos) continue;
      const bool minus = each.text[0] < '0' || each.text[0] > '9';
      const std::size_t digits = each.text.find_first_of("0123456789");
      all[(minus ? -1 : 1) * std::stoi(each.text.substr(digits))] = each;
    }
    return all;
  };
  draw();
  const Labels first = labels();
  ASSERT_FALSE(first.empty());
  const Bounds grid = stage_->picture.grid();
  for (const auto& [cm, label] : first) {
    EXPECT_EQ(cm % 10, 0);
    const Eigen::Vector2d at = seen(Vec3(0.01 * cm, grid.max().y(), grid.max().z()));
    EXPECT_NEAR(label.min.x, at.x(), 3) << cm;
    EXPECT_NEAR(label.middle().y, at.y() + 6, 5) << cm;
  }
  // Poses in which nothing but the last link, from its joint to the tip, lies over a label.
  const Eigen::VectorXd rest = rest_pose(test::omni());
  bool found = false;
  for (int i = 0; i < 15 * 15 * 15 && !found; ++i) {
    const Vec3 turn(i % 15 - 7, i / 15 % 15 - 7, i / 225 - 7);
    const Eigen::VectorXd x = rest + 0.2 * turn;
    const ArmPose arm = stage_->rows().pose(std::span(x.data(), 3));
    for (const auto& [cm, label] : first) {
      const Eigen::Vector2d middle(label.middle().x, label.middle().y);
      double others = 1e9;
      for (std::size_t k = 0; k + 1 < arm.links.size(); ++k) {
        others = std::min(others, apart_from_stroke(middle, seen(arm.links[k].translation()),
                                                    seen(arm.links[k + 1].translation())));
      }
      const double last =
          apart_from_stroke(middle, seen(arm.links.back().translation()), seen(arm.tip));
      if (last > 20 || others < label.max.x - label.min.x + 30) continue;
      for (const Column c : {Column::device_position, Column::proxy_position}) {
        std::ranges::copy(x, layout_.in(std::span(row_), c).begin());
      }
      draw();
      EXPECT_FALSE(labels().contains(cm)) << cm;
      found = true;
      break;
    }
  }
  EXPECT_TRUE(found) << "no pose hides a label";
  settings_.show_grid = false;
  draw();
  EXPECT_TRUE(labels().empty());
}

TEST_F(AView, HasAPictureFromEightPixelsOn) {
  settings_.show_lens = false;
  draw();
  for (const auto& [wide, high] : {std::pair(7.f, 300.f), {300.f, 7.f}}) {
    rect_ = {{0, 0}, {wide, high}};
    draw();
    EXPECT_EQ(camera_.width(), 400);
  }
  for (const auto& [wide, high] : {std::pair(8.f, 300.f), {300.f, 8.f}}) {
    rect_ = {{0, 0}, {wide, high}};
    draw();
    EXPECT_EQ(camera_.width(), static_cast<double>(wide));
    EXPECT_EQ(camera_.height(), static_cast<double>(high));
  }
}

TEST_F(AView, TurnsMovesAndZoomsByButtonsAndWheel) {
  draw();
  const Eigen::Vector2d aside = seen(tip()) + Eigen::Vector2d(0, -60);
  const auto drag = [&](int button, bool shift) {
    point(aside);
    show_modifiers(false, shift, false);
    press(button, true);
    point(aside + Eigen::Vector2d(20, 10));
    point(aside + Eigen::Vector2d(40, 20));
    EXPECT_TRUE(asked_.turned);
    press(button, false);
    show_modifiers(false, false, false);
    draw();
    EXPECT_FALSE(asked_.turned || asked_.clicked || asked_.asked);
  };
  struct Kind {
    int button;
    bool shift, pans;
  };
  for (const Kind& kind :
       {Kind{0, false, false}, {1, false, false}, {1, true, true}, {2, false, true}}) {
    const Vec3 forward = camera_.forward(), target = camera_.target();
    drag(kind.button, kind.shift);
    EXPECT_EQ(camera_.target() != target, kind.pans) << kind.button;
    EXPECT_EQ(camera_.forward() != forward, !kind.pans) << kind.button;
  }
  const double distance = camera_.distance();
  point({5, 290});
  ImGui::GetIO().MouseWheel = 1;
  draw();
  EXPECT_TRUE(asked_.turned);
  EXPECT_LT(camera_.distance(), distance);
  ImGui::GetIO().MouseWheel = 0;
  draw();
  EXPECT_FALSE(asked_.turned);
  point({500, 500});
  ImGui::GetIO().MouseWheel = 1;
  draw();
  EXPECT_FALSE(asked_.turned) << "the mouse is elsewhere";
  ImGui::GetIO().MouseWheel = 0;
  EXPECT_FALSE(controls_.grab);
}

TEST_F(AView, HoldsTheHandWhereItIsLetGoIfThatIsWanted) {
  settings_.hold_on_release = true;
  draw();
  const Eigen::Vector2d at = seen(tip());
  const auto pull = [&](const Eigen::Vector2d& by) {
    point(at);
    press(0, true);
    EXPECT_TRUE(controls_.grab);
    point(at + by);
    press(0, false);
  };
  EXPECT_FALSE(done(settings_, FirstStep::pull) || settings_.hint_seen);
  pull({20, 0});
  EXPECT_TRUE(done(settings_, FirstStep::pull) && settings_.hint_seen);
  EXPECT_TRUE(controls_.grab);
  const Vec3 goal = controls_.goal;
  EXPECT_NEAR((seen(goal) - at).x(), 20, 1e-3);
  pull({5, 0});
  EXPECT_NEAR((seen(controls_.goal) - seen(goal)).x(), 5, 1e-3) << "it goes on from there";
  settings_.hold_on_release = false;
  pull({5, 0});
  EXPECT_FALSE(controls_.grab);
  recorded_ = true;
  point(at);
  press(0, true);
  EXPECT_FALSE(controls_.grab) << "a recording's arm is nobody's";
  press(0, false);
  draw();
  EXPECT_FALSE(asked_.clicked);
}

// A line leads from the tip down to what is below, while the tip is dragged.
TEST_F(AView, ShowsHowFarItIsDownWhileTheHandIsDragged) {
  rect_ = {{0, 0}, {800, 600}};
  settings_.show_lens = settings_.show_grid = false;
  below_ = 0.08;
  draw();
  const ImU32 hand = colour(ink(current_palette(), Ink::hand)) & 0x00ffffff;
  const Vec3 middle = tip() - Vec3(0, 0, 0.045);
  const auto drawn = [&](const Vec3& at) {
    const Eigen::Vector2d place = seen(at);
    return test::inked({static_cast<float>(place.x()), static_cast<float>(place.y())},
                       [&](ImU32 each) { return (each & 0x00ffffff) == hand; });
  };
  EXPECT_FALSE(drawn(middle));
  point(seen(tip()));
  EXPECT_FALSE(drawn(middle)) << "it is not dragged yet";
  press(0, true);
  draw();
  EXPECT_TRUE(drawn(middle));
  EXPECT_FALSE(drawn(tip() - Vec3(0, 0, 0.13))) << "below what is there";
  below_.reset();
  draw();
  EXPECT_FALSE(drawn(middle)) << "nothing is below";
  press(0, false);
}

TEST_F(AView, NamesRunsSideBySideAndLeavesHintsToASingleOne) {
  rect_ = {{0, 0}, {1000, 600}};
  const auto place = [](const char* text) {
    float x = -1;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.text == text) x = each.middle().x;
    }
    return x;
  };
  draw();
  EXPECT_TRUE(panel_.hinted());
  EXPECT_EQ(place("left run"), -1);
  EXPECT_FALSE(differs(settings_));
  twin_ = true;
  draw();
  EXPECT_NEAR(place("left run"), 250, 10);
  EXPECT_NEAR(place("right run"), 750, 10);
  EXPECT_FALSE(panel_.hinted());
  EXPECT_NEAR(camera_.width(), 500, 2);
  EXPECT_FALSE(differs(settings_));
  Settings other = settings_;
  other.show_joints = !other.show_joints;
  EXPECT_TRUE(differs(other));
  overlaid_ = true;
  draw();
  for (const char* name : {"left run", "right run"}) {
    EXPECT_GT(place(name), 0) << name;
    EXPECT_LT(place(name), 200) << name << " is in the legend";
  }
  EXPECT_EQ(camera_.width(), 1000);
  twin_ = overlaid_ = false;
  for (bool* each : {&asked_below_, &recorded_, &settings_.your_turn}) {
    *each = true;
    draw();
    EXPECT_FALSE(panel_.hinted());
    *each = false;
    draw();
    EXPECT_TRUE(panel_.hinted());
  }
  told_ = "Two couplings in one hand.";
  draw();
  EXPECT_TRUE(says("Two couplings in one hand."));
  blind_ = true;
  draw();
  EXPECT_FALSE(says("Two couplings") || says("device (ghost)"));
}

}  // namespace
}  // namespace limpid
