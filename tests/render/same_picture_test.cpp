// Changes that alone make a picture another one, and changes that do not.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "render/damage.h"

namespace limpid {
namespace {

constexpr double kTolerance = 1e-4;  // [m]

ArmPose arm() {
  Pose first = Pose::Identity(), second = Pose::Identity();
  second.translate(Vec3(0.2, 0, 0)).rotate(Eigen::AngleAxisd(0.3, Vec3::UnitX()));
  return {{first, second}, Vec3(0.4, 0.1, 0), {Vec3(0.3, 0, 0), Vec3(0.4, 0, 0)}};
}

ViewState everything() {
  ViewState state;
  state.device = state.proxy = arm();
  state.rerun = arm();
  state.beside.assign(
      2, {arm(), arm(), Vec3(1, 0, 0), {{.force = Vec3(0, 1, 0)}}, {Pose::Identity()}});
  state.show_hand = true;
  state.contacts = {{Vec3(0.1, 0, 0), Vec3(0, 0, 2), 1, Vec3::UnitZ(), 0.5, false}};
  state.shade = ContactShade{};
  return state;
}

using Change = std::function<void(ViewState&)>;

void expect_another(const char* what, const Change& change) {
  const ViewState before = everything();
  ViewState after = before;
  change(after);
  EXPECT_FALSE(same_picture(before, after, kTolerance)) << what;
  EXPECT_FALSE(same_picture(after, before, kTolerance)) << what;
}

void expect_the_same(const char* what, const Change& change) {
  const ViewState before = everything();
  ViewState after = before;
  change(after);
  EXPECT_TRUE(same_picture(before, after, kTolerance)) << what;
  EXPECT_TRUE(same_picture(after, before, kTolerance)) << what;
}

const Vec3 kFar(2e-4, 0, 0), kNear(0.5e-4, 0, 0);

TEST(SamePicture, IsAnotherWhereAnythingAloneIsFurtherOffThanTheTolerance) {
  expect_the_same("nothing", [](ViewState&) {});
  const std::pair<const char*, std::function<Vec3&(ViewState&)>> places[] = {
      {"tip", [](ViewState& s) -> Vec3& { return s.proxy.tip; }},
      {"ghost", [](ViewState& s) -> Vec3& { return s.device.tip; }},
      {"trail", [](ViewState& s) -> Vec3& { return s.proxy.trail[0]; }},
      {"re-run", [](ViewState& s) -> Vec3& { return s.rerun->tip; }},
      {"twin's proxy", [](ViewState& s) -> Vec3& { return s.beside[0].proxy.tip; }},
      {"twin's device", [](ViewState& s) -> Vec3& { return s.beside[0].device.tip; }},
      {"twin's contact", [](ViewState& s) -> Vec3& { return s.beside[0].contacts[0].position; }},
      {"hand", [](ViewState& s) -> Vec3& { return s.hand_target; }},
      {"contact", [](ViewState& s) -> Vec3& { return s.contacts[0].position; }},
      {"shade", [](ViewState& s) -> Vec3& { return s.shade->position; }}};
  for (const auto& each : places) {
    expect_another(each.first, [&](ViewState& s) { each.second(s) += kFar; });
    expect_the_same(each.first, [&](ViewState& s) { each.second(s) += kNear; });
    expect_another(each.first, [&](ViewState& s) { each.second(s).y() = std::nan(""); });
  }
}

// A pen is 12 cm long: a turn of 1 mrad moves its end by 0.12 mm.
TEST(SamePicture, IsAnotherWhereTheToolIsTurned) {
  const auto turned = [](double angle) {
    return Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix();
  };
  expect_another("a tool", [&](ViewState& s) { s.tool = turned(0); });
  ViewState before = everything(), after = before;
  before.tool = turned(0.3);
  after.tool = turned(0.302);
  EXPECT_FALSE(same_picture(before, after, kTolerance));
  after.tool = turned(0.3001);
  EXPECT_TRUE(same_picture(before, after, kTolerance));
}

// Arrows have 2 cm per newton.
TEST(SamePicture, IsAnotherWhereAnArrowIsLonger) {
  const std::pair<const char*, std::function<Vec3&(ViewState&)>> forces[] = {
      {"contact", [](ViewState& s) -> Vec3& { return s.contacts[0].force; }},
      {"hand", [](ViewState& s) -> Vec3& { return s.hand_force; }},
      {"twin's hand", [](ViewState& s) -> Vec3& { return s.beside[0].hand_force; }},
      {"twin's contact", [](ViewState& s) -> Vec3& { return s.beside[0].contacts[0].force; }}};
  for (const auto& each : forces) {
    expect_another(each.first, [&](ViewState& s) { each.second(s).x() += 0.006; });
    expect_the_same(each.first, [&](ViewState& s) { each.second(s).x() += 0.004; });
  }
}

TEST(SamePicture, IsAnotherWhereALinkIsTurned) {
  const auto turn = [](double angle) {
    return
        [angle](ViewState& s) { s.proxy.links[1].rotate(Eigen::AngleAxisd(angle, Vec3::UnitZ())); };
  };
  expect_another("by 1 mrad: 0.3 mm at 0.3 m", turn(1e-3));
  expect_the_same("by 0.1 mrad", turn(1e-4));
  expect_another("moved", [](ViewState& s) { s.proxy.links[1].translation() += kFar; });
}

TEST(SamePicture, IsAnotherWhereAContactIsAnother) {
  expect_another("slips", [](ViewState& s) { s.contacts[0].slips = true; });
  expect_another("cone", [](ViewState& s) { s.contacts[0].friction = 0.6; });
  expect_another("normal",
                 [](ViewState& s) { s.contacts[0].normal = Vec3(0, 0.1, 1).normalized(); });
  expect_another("one more", [](ViewState& s) { s.contacts.push_back(s.contacts[0]); });
  expect_another("none", [](ViewState& s) { s.contacts.clear(); });
  expect_another("flash", [](ViewState& s) { s.contacts[0].age = 0.1; });
  expect_the_same("it has been there long", [](ViewState& s) { s.contacts[0].age = 7; });
  expect_another("height", [](ViewState& s) { s.shade->height = 2e-4; });
  expect_another("no shade", [](ViewState& s) { s.shade.reset(); });
  expect_another("one run less", [](ViewState& s) { s.beside.pop_back(); });
  expect_another("its bodies", [](ViewState& s) { s.beside[1].bodies[0].translation() = kFar; });
  expect_another("no re-run", [](ViewState& s) { s.rerun.reset(); });
}

TEST(SamePicture, IsAnotherWhereASwitchIs) {
  const std::pair<const char*, bool ViewState::*> switches[] = {
      {"hand", &ViewState::show_hand},   {"grip", &ViewState::hand_grips},
      {"ghost", &ViewState::show_ghost}, {"error", &ViewState::show_error},
      {"trail", &ViewState::show_trail}, {"forces", &ViewState::show_forces},
      {"grid", &ViewState::show_grid},   {"joints", &ViewState::show_joints}};
  for (const auto& each : switches) {
    expect_another(each.first, [&](ViewState& s) { s.*each.second = !(s.*each.second); });
  }
  expect_another("theme", [](ViewState& s) { s.theme = Theme::light; });
}

// A trail has a point for each frame: that of a tip at rest may have any number.
TEST(SamePicture, IsTheSameWhateverTheTrailOfATipAtRest) {
  ViewState before = everything();
  before.proxy.trail = {before.proxy.tip, before.proxy.tip};
  ViewState after = before;
  after.proxy.trail.push_back(after.proxy.tip);
  EXPECT_TRUE(same_picture(before, after, kTolerance));
  after.proxy.trail[0] += kFar;
  EXPECT_FALSE(same_picture(before, after, kTolerance));
}

// A hidden hand's place has no effect.
TEST(SamePicture, IsTheSameWhereverAHandIsThatNobodySees) {
  ViewState before = everything();
  before.show_hand = false;
  ViewState after = before;
  after.hand_target += kFar;
  EXPECT_TRUE(same_picture(before, after, kTolerance));
}

}  // namespace
}  // namespace limpid
