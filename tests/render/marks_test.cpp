// Signs of a picture: their presence, places and directions.
#include "render/marks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "render/gl/line_batch.h"
#include "render/lit_pass.h"
#include "tests/support/faultless_context.h"

namespace limpid {
namespace {

using MarkShape = SolidMark::Shape;

Vec3 vec(const glm::vec4& v) { return {v.x, v.y, v.z}; }
Vec3 at(const glm::mat4& place) { return vec(place[3]); }
// Length and direction of a unit shape's z.
Vec3 along(const glm::mat4& place) { return vec(place[2]); }
double across(const glm::mat4& place) { return vec(place[0]).norm(); }

void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_LT((a - b).norm(), 1e-6) << a.transpose() << " and " << b.transpose();
}

// Expects an arrow: a tube and a cone in line, from the point on along the force, 2 cm/N.
void expect_arrow(const SolidMark& tube, const SolidMark& cone, const Vec3& from,
                  const Vec3& force) {
  EXPECT_EQ(tube.shape, MarkShape::tube);
  EXPECT_EQ(cone.shape, MarkShape::cone);
  expect_near(at(tube.place), from);
  expect_near(at(tube.place) + along(tube.place), at(cone.place));
  expect_near(at(cone.place) + along(cone.place), from + 0.02 * force);
  expect_near(along(tube.place).normalized(), force.normalized());
  EXPECT_GT(across(cone.place), 2 * across(tube.place)) << "a head";
}

const Vec3 kPoint(0.1, -0.2, 0.3), kForce(1, 2, -2);  // 3 N

// The pen's point is at the tip; its body goes from there against its own x, wherever it is turned.
TEST(Marks, AreAPenAtTheTipsOfDeviceAndProxy) {
  ViewState state;
  state.tool = Eigen::AngleAxisd(1.1, Vec3(1, 2, 2).normalized()).toRotationMatrix();
  EXPECT_TRUE(collect_marks(state, Camera(), 1).solids.empty()) << "no arm";
  state.device.links = state.proxy.links = {Pose::Identity()};
  state.proxy.tip = kPoint;
  state.device.tip = 2 * kPoint;
  const Marks marks = collect_marks(state, Camera(), 1);
  ASSERT_EQ(marks.solids.size(), 6u);
  const Vec3 x = state.tool->col(0), z = state.tool->col(2);
  for (const std::size_t arm : {0u, 1u}) {
    const SolidMark &cone = marks.solids[3 * arm], &tube = marks.solids[3 * arm + 1],
                    &button = marks.solids[3 * arm + 2];
    const Vec3 tip = arm == 0 ? kPoint : Vec3(2 * kPoint);
    EXPECT_EQ(cone.shape, MarkShape::cone);
    expect_near(at(cone.place) + along(cone.place), tip);
    expect_near(along(cone.place).normalized(), x);
    EXPECT_EQ(tube.shape, MarkShape::tube);
    expect_near(at(tube.place), at(cone.place));
    expect_near(at(tube.place) + along(tube.place), tip - kPenLength * x);
    EXPECT_EQ(button.shape, MarkShape::ball);
    const Vec3 off = at(button.place) - tip;
    EXPECT_LT(off.dot(x), 0);
    expect_near(off - off.dot(x) * x, across(tube.place) * z);
    EXPECT_EQ(tube.color, arm == 0 ? palette::kProxy : palette::kDevice);
  }
  state.show_ghost = false;
  EXPECT_EQ(collect_marks(state, Camera(), 1).solids.size(), 3u);
  state.tool->setConstant(std::nan(""));
  EXPECT_TRUE(collect_marks(state, Camera(), 1).solids.empty());
}

TEST(Marks, AreAnArrowAPatchAndAConeForEachContact) {
  ViewState state;
  const Vec3 normal(0.6, 0.8, 0);
  state.contacts = {{kPoint, kForce, 0.125, normal, 0.5, true}, {2 * kPoint, kForce, 1}};
  const Marks marks = collect_marks(state, Camera(), 1);
  ASSERT_EQ(marks.solids.size(), 4u);
  expect_arrow(marks.solids[0], marks.solids[1], kPoint, kForce);
  expect_arrow(marks.solids[2], marks.solids[3], 2 * kPoint, kForce);
  EXPECT_EQ(marks.solids[0].color, palette::kContact);
  ASSERT_EQ(marks.glass.size(), 1u) << "without friction there is no cone";
  EXPECT_EQ(marks.glass[0].color, palette::kSlips);
  // The cone's tip is at the point: it opens along the normal, as long as the force along it.
  const double reach = 0.02 * kForce.dot(normal);
  expect_near(at(marks.glass[0].place), kPoint + reach * normal);
  expect_near(at(marks.glass[0].place) + along(marks.glass[0].place), kPoint);
  EXPECT_NEAR(across(marks.glass[0].place), 0.5 * reach, 1e-6);
  ASSERT_EQ(marks.flashes.size(), 2u);
  expect_near(at(marks.flashes[0].place), kPoint);
  expect_near(along(marks.flashes[0].place).normalized(), normal);
  expect_near(along(marks.flashes[1].place).normalized(), kForce.normalized());
}

// A flash fades within a quarter of a second while its ring grows.
TEST(Marks, FlashForAQuarterOfASecond) {
  const auto pulse = [](double age) {
    ViewState state;
    state.contacts = {{kPoint, kForce, age}};
    return collect_marks(state, Camera(), 1).flashes.at(0).pulse;
  };
  EXPECT_FLOAT_EQ(pulse(0).x, 1);
  EXPECT_FLOAT_EQ(pulse(0.125).x, 0.5);
  EXPECT_FLOAT_EQ(pulse(0.25).x, 0);
  EXPECT_FLOAT_EQ(pulse(9).x, 0);
  EXPECT_LT(pulse(0).y, pulse(0.1).y);
  EXPECT_LT(pulse(0.1).y, pulse(0.25).y);
  EXPECT_FLOAT_EQ(pulse(9).y, pulse(0.25).y);
}

TEST(Marks, CoverMoreWhereItIsPressedHarder) {
  const auto radius = [](double newtons) {
    ViewState state;
    state.contacts = {{kPoint, newtons * Vec3::UnitZ(), 1}};
    return across(collect_marks(state, Camera(), 1).flashes.at(0).place);
  };
  EXPECT_LT(radius(0.5), radius(2));
  EXPECT_LT(radius(2), radius(8));
  EXPECT_LT(radius(1000), 3 * radius(0.01));
}

TEST(Marks, OfATwinAreItsOwn) {
  ViewState state;
  state.device.tip = Vec3(0.5, 0, 0);
  state.hand_force = Vec3(0, 3, 0);
  state.beside = {{{}, {}, Vec3(0, 0, 2), {{kPoint, kForce, 1}}, {}}};
  state.beside[0].device.tip = Vec3(-0.5, 0, 0);
  const Marks marks = collect_marks(state, Camera(), 1);
  ASSERT_EQ(marks.solids.size(), 6u);
  expect_arrow(marks.solids[0], marks.solids[1], kPoint, kForce);
  expect_arrow(marks.solids[2], marks.solids[3], Vec3(-0.5, 0, 0), Vec3(0, 0, 2));
  expect_arrow(marks.solids[4], marks.solids[5], Vec3(0.5, 0, 0), Vec3(0, 3, 0));
  EXPECT_EQ(marks.solids[0].color, palette::of_lane(palette::kContact, 1, state.theme));
  EXPECT_EQ(marks.solids[2].color, palette::of_lane(palette::kHand, 1, state.theme));
  EXPECT_EQ(marks.solids[4].color, palette::kHand);
  EXPECT_EQ(marks.flashes.size(), 1u);
  state.show_forces = false;
  const Marks without = collect_marks(state, Camera(), 1);
  EXPECT_TRUE(without.solids.empty());
  EXPECT_EQ(without.flashes.size(), 1u) << "where it touches is seen all the same";
}

TEST(Marks, LeaveOutWhatIsNoForceOrNoPlace) {
  ViewState state;
  const Vec3 none = Vec3::Constant(std::nan(""));
  state.contacts = {{none, kForce}, {kPoint, Vec3::Zero()}, {kPoint, none}};
  state.hand_force = Vec3(0.019, 0, 0);  // arrows begin at 0.02 N
  state.show_hand = true;
  state.hand_target = none;
  Marks marks = collect_marks(state, Camera(), 1);
  EXPECT_TRUE(marks.solids.empty());
  EXPECT_TRUE(marks.glass.empty());
  EXPECT_TRUE(marks.flashes.empty());
  state.hand_force = Vec3(0.021, 0, 0);
  state.hand_target = kPoint;
  marks = collect_marks(state, Camera(), 1);
  ASSERT_EQ(marks.solids.size(), 3u);
  EXPECT_EQ(marks.solids[0].shape, MarkShape::ball);
  expect_near(at(marks.solids[0].place), kPoint);
}

// Balls, heads and patches have the same size in pixels at any distance; arrows' lengths are the
// world's.
TEST(Marks, StayAsLargeInPixels) {
  ViewState state;
  state.show_hand = true;
  state.contacts = {{kPoint, kForce, 1}};
  Camera far;
  far.resize(1000, 800);
  Camera near = far;
  near.zoom(7, {500, 400});
  const double closer = near.meters_per_pixel(near.target()) / far.meters_per_pixel(far.target());
  ASSERT_LT(closer, 0.6);
  const Marks a = collect_marks(state, far, 1), b = collect_marks(state, near, 1),
              fine = collect_marks(state, far, 2);
  EXPECT_NEAR(across(b.solids[0].place) / across(a.solids[0].place), closer, 1e-5);
  EXPECT_NEAR(across(fine.solids[0].place) / across(a.solids[0].place), 2, 1e-5);
  EXPECT_NEAR(across(b.flashes[0].place) / across(a.flashes[0].place), closer, 1e-5);
  for (const Marks* marks : {&a, &b, &fine}) {
    expect_arrow(marks->solids[1], marks->solids[2], kPoint, kForce);
  }
}

// The shade is dark on the surface, and nothing from 6 cm above it on.
TEST(Marks, ShadeASurfaceUnderATipThatIsNear) {
  ViewState state;
  const auto shades = [&](double height) {
    state.shade = ContactShade{kPoint, Vec3::UnitX(), height};
    return collect_marks(state, Camera(), 1).shades;
  };
  ASSERT_EQ(shades(0).size(), 1u);
  expect_near(at(shades(0)[0]), kPoint);
  expect_near(along(shades(0)[0]), Vec3::UnitX());
  expect_near(along(shades(0.03)[0]), 0.5 * Vec3::UnitX());
  expect_near(along(shades(-0.01)[0]), Vec3::UnitX());
  EXPECT_NEAR(across(shades(0.03)[0]) / across(shades(0)[0]), 1.3, 1e-5);
  EXPECT_TRUE(shades(0.06).empty());
}

ArmPose arm_at(double x) {
  ArmPose arm;
  for (int i = 0; i < 2; ++i) {
    Pose pose = Pose::Identity();
    pose.translation() = Vec3(x, 0, 0.1 * i);
    arm.links.push_back(pose);
  }
  arm.tip = Vec3(x, 0, 0.2);
  return arm;
}

// Each arm other than the proxy, from back to front, in its own colour.
TEST(Ghosts, AreReRunTwinAndDevice) {
  ViewState state;
  state.proxy = arm_at(0);
  state.device = arm_at(0.1);
  state.rerun = arm_at(0.2);
  state.beside = {{arm_at(0.4), arm_at(0.3), Vec3::Zero(), {}, {}}};
  const auto ghosts = ghosts_of(state, 1e-3);
  ASSERT_EQ(ghosts.size(), 4u);
  const std::array<double, 4> places{0.2, 0.3, 0.4, 0.1};
  const std::array<palette::Rgb, 4> colors{
      palette::kRerun, palette::of_lane(palette::kProxy, 1, state.theme),
      palette::of_lane(palette::kDevice, 1, state.theme), palette::kDevice};
  for (std::size_t i = 0; i < 4; ++i) {
    ASSERT_EQ(ghosts[i].links.size(), 2u);
    EXPECT_NEAR(ghosts[i].links[0][3][0], places[i], 1e-6);
    EXPECT_EQ(ghosts[i].color, colors[i]);
    EXPECT_THAT(ghosts[i].outline, testing::ElementsAre(1, 1));
  }
  state.show_ghost = false;
  EXPECT_EQ(ghosts_of(state, 1e-3).size(), 2u) << "the devices are the ghosts that can be hidden";
}

// Shades of all runs can be told apart on both themes.
TEST(Ghosts, OfEachRunHaveAShadeOfTheirOwn) {
  for (const Theme theme : {Theme::dark, Theme::light}) {
    for (const palette::Rgb& color : {palette::kProxy, palette::kDevice, palette::kHand}) {
      for (std::size_t a = 0; a < kMostLanes; ++a) {
        for (std::size_t b = 0; b < a; ++b) {
          const palette::Rgb x = palette::of_lane(color, a, theme);
          const palette::Rgb y = palette::of_lane(color, b, theme);
          float apart = 0;
          for (std::size_t i = 0; i < 3; ++i) apart += std::abs(x[i] - y[i]);
          EXPECT_GT(apart, 0.3f) << a << " and " << b;
        }
      }
    }
  }
}

// The outline appears between one and four pixels of distance. A twin's arm is compared with the
// first run's.
TEST(Ghosts, HaveAnOutlineWhereTheyAreBesideTheirLikes) {
  ViewState state;
  state.proxy = arm_at(0);
  state.device = arm_at(0.0025);
  state.beside = {{arm_at(0.0025), arm_at(0.5), Vec3::Zero(), {}, {}}};
  const auto ghosts = ghosts_of(state, 1e-3);
  ASSERT_EQ(ghosts.size(), 3u);
  EXPECT_THAT(ghosts[0].outline, testing::ElementsAre(1, 1)) << "twin's proxy";
  EXPECT_THAT(ghosts[1].outline, testing::ElementsAre(0, 0)) << "twin's device";
  EXPECT_THAT(ghosts[2].outline, testing::Each(testing::FloatNear(0.5f, 1e-4f)));
  state.device = state.proxy;
  state.device.tip += Vec3(0, 0, 0.01);  // only the last link, at its end
  EXPECT_THAT(ghosts_of(state, 1e-3)[2].outline, testing::ElementsAre(0, 1));
}

TEST(Ghosts, OfAPoseThatIsNoNumberAreNotDrawn) {
  ViewState state;
  state.proxy = arm_at(0);
  state.device = arm_at(0.1);
  state.device.links[1].translation().z() = std::nan("");
  const auto ghosts = ghosts_of(state, 1e-3);
  ASSERT_EQ(ghosts.size(), 1u);
  EXPECT_TRUE(ghosts[0].links.empty());
}

// A trail grows from nothing at its old end to strong at its new one, without a gap; only an
// unknown place leaves one.
TEST(Trails, FadeTowardsWhereTheTipWas) {
  ViewState state;
  state.show_ghost = false;
  const double unknown = std::nan("");
  state.proxy.trail = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, Vec3::Constant(unknown),
                       {4, 0, 0}, {5, 0, 0}};
  const test::FaultlessContext context(8, 8);  // a batch owns names of OpenGL
  LineBatch batch;
  add_trails(state, batch);
  const auto& lines = batch.lines();
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0].to, lines[1].from);
  EXPECT_EQ(lines[2].to, glm::vec3(5, 0, 0));
  EXPECT_EQ(lines[0].color_from.a, 0);
  for (const auto& line : lines) {
    EXPECT_GT(line.color_to.a, line.color_from.a);
    EXPECT_EQ(line.width, lines[0].width);
    EXPECT_GE(line.width, 2) << "two pixels are seen, four hide the tip";
    EXPECT_LT(line.width, 4);
  }
}

// The proxy's dot and trail are lighter on a dark ground, so that they are seen there.
TEST(LinesOfAPicture, SuitTheGround) {
  const test::FaultlessContext context(16, 16);
  ViewState state;
  state.show_error = true;
  state.device.links = state.proxy.links = {Pose::Identity()};
  state.device.tip = Vec3(0.1, 0, 0);
  state.proxy.tip = Vec3(0.2, 0, 0);
  const auto light_of = [](const glm::vec4& c) { return c.r + c.g + c.b; };
  const auto lines_in = [&](Theme theme) {
    LineBatch lines;
    state.theme = theme;
    add_lines_on_top(state, lines);
    return lines.lines();
  };
  const auto dark = lines_in(Theme::dark), light = lines_in(Theme::light);
  ASSERT_EQ(dark.size(), light.size());
  ASSERT_EQ(dark.size(), 6u) << "the error with its edge, and two dots with theirs";
  EXPECT_GT(light_of(dark.back().color_from), light_of(light.back().color_from)) << "the proxy's";
  EXPECT_EQ(light.back().color_from.a, 1);
  for (const auto& [on, bright] : {std::pair(&dark, true), std::pair(&light, false)}) {
    EXPECT_EQ(light_of((*on)[1].color_from) > 1.5f, bright) << "the error, against the ground";
    EXPECT_EQ(light_of((*on)[0].color_from) < 1.5f, bright) << "its edge, against the error";
  }
}

// Without a like to be beside a ghost is outlined as a whole.
TEST(Ghosts, HaveAnOutlineWhereTheirLikesAreNotDrawn) {
  ViewState state;
  state.device = arm_at(0.1);
  const auto ghosts = ghosts_of(state, 1e-3);
  ASSERT_EQ(ghosts.size(), 1u);
  EXPECT_THAT(ghosts[0].outline, testing::ElementsAre(1, 1));
}

// The light's picture is the sphere around the box: its rim is the edge of the map.
TEST(AShadowMap, CoversTheSphereAroundABox) {
  const test::FaultlessContext context(8, 8);
  ShadowMap map(512);
  const Bounds box(Vec3(-0.3, 0.1, -0.2), Vec3(0.5, 0.4, 0.6));
  const glm::vec3 to_light = glm::normalize(glm::vec3(-0.3f, -0.55f, 1));
  map.aim(box, to_light);
  const glm::vec3 middle(box.center().x(), box.center().y(), box.center().z());
  const float radius = 0.5f * static_cast<float>(box.diagonal().norm());
  EXPECT_NEAR(map.texel(), 2 * radius / 512, 1e-7);
  const glm::vec3 across = glm::normalize(glm::cross(to_light, glm::vec3(0, 1, 0)));
  for (const glm::vec3& side : {across, glm::cross(to_light, across)}) {
    const glm::vec4 rim = map.clip() * glm::vec4(middle + radius * side, 1);
    EXPECT_NEAR(glm::length(glm::vec2(rim)), 1, 1e-5);
    EXPECT_LT(std::abs(rim.z), 1);
  }
  const glm::vec4 near = map.clip() * glm::vec4(middle + radius * to_light, 1),
                  far = map.clip() * glm::vec4(middle - radius * to_light, 1);
  EXPECT_LT(near.z, far.z) << "what is nearer to the light is before";
  EXPECT_GT(near.z, -1);
  EXPECT_LT(far.z, 1);
  for (const glm::vec4& corner : {glm::vec4(-1, -1, -1, 1), glm::vec4(1, 1, 1, 1)}) {
    const glm::vec4 looked = map.lookup() * glm::inverse(map.clip()) * corner;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(looked[i], corner[i] < 0 ? 0 : 1, 1e-4);
  }
}

// Lines at multiples of 5 cm in both directions, from edge to edge, fainter towards the edges;
// those at multiples of 10 cm are stronger.
TEST(TheGrid, HasALineEachFiveCentimetres) {
  const test::FaultlessContext context(8, 8);
  LineBatch batch;
  const Bounds area(Vec3(-0.22, 0.03, -0.1), Vec3(0.18, 0.23, -0.1));
  add_grid(area, Theme::dark, batch);
  std::map<int, std::vector<LineBatch::Line>> across, along;  // by multiples of 5 cm
  for (const LineBatch::Line& line : batch.lines()) {
    EXPECT_NEAR(line.from.z, -0.1, 1e-3);
    EXPECT_NEAR(line.to.z, line.from.z, 1e-6);
    const bool upright = std::abs(line.from.x - line.to.x) < 1e-6;
    const float at = (upright ? line.from.x : line.from.y) / 0.05f;
    EXPECT_NEAR(at, std::round(at), 1e-4);
    (upright ? across : along)[static_cast<int>(std::lround(at))].push_back(line);
  }
  const auto numbers = [](const auto& lines) {
    std::vector<int> all;
    for (const auto& [number, pieces] : lines) all.push_back(number);
    return all;
  };
  EXPECT_THAT(numbers(across), testing::ElementsAre(-4, -3, -2, -1, 0, 1, 2, 3));
  EXPECT_THAT(numbers(along), testing::ElementsAre(1, 2, 3, 4));
  for (const auto& [number, pieces] : across) {
    EXPECT_NEAR(pieces.front().from.y, 0.03, 1e-6);
    EXPECT_NEAR(pieces.back().to.y, 0.23, 1e-6);
    for (std::size_t i = 1; i < pieces.size(); ++i) EXPECT_EQ(pieces[i].from, pieces[i - 1].to);
    for (const LineBatch::Line& piece : pieces) {
      EXPECT_LE(piece.color_from.a, 0.201f);
      EXPECT_EQ(piece.color_from.r, 1) << "white on dark";
    }
    EXPECT_LT(pieces.front().color_from.a, pieces[pieces.size() / 2].color_from.a);
    EXPECT_LT(pieces.back().color_to.a, pieces[pieces.size() / 2].color_from.a);
  }
  const auto strength = [&](int number) {
    const auto& pieces = across.at(number);
    return pieces[pieces.size() / 2].color_from.a;
  };
  EXPECT_GT(strength(0), 2 * strength(-1));
  EXPECT_GT(strength(0), strength(-4)) << "fainter near the edge";
  LineBatch light;
  add_grid(area, Theme::light, light);
  EXPECT_EQ(light.lines().at(0).color_from.r, 0) << "black on light";
  LineBatch wide;
  add_grid(Bounds(Vec3(-50, -50, 0), Vec3(50, 50, 0)), Theme::dark, wide);
  EXPECT_LT(wide.lines().size(), 2000u) << "not thousands of lines";
}

// Bodies of a re-run and of each further run are ghosts where they are apart from the first one's.
TEST(Ghosts, OfBodiesAreThoseThatAreApart) {
  const auto at = [](double x) {
    Pose pose = Pose::Identity();
    pose.translation().x() = x;
    return pose;
  };
  ViewState state;
  state.bodies = {at(0), at(1)};
  const std::vector<Pose> starts{at(0), at(1)};
  EXPECT_TRUE(body_ghosts(state, starts, 1e-3).empty());
  state.rerun_bodies = {at(0), at(1.5)};
  state.beside.resize(2);
  state.beside[0].bodies = {at(0.2), at(1)};
  state.beside[1].bodies = {at(0), at(1)};
  const auto ghosts = body_ghosts(state, starts, 1e-3);
  ASSERT_EQ(ghosts.size(), 3u);
  EXPECT_EQ(ghosts[0].color, palette::kRerun);
  EXPECT_EQ(ghosts[1].color, palette::of_lane(palette::kProxy, 1, state.theme));
  EXPECT_EQ(ghosts[2].color, palette::of_lane(palette::kProxy, 2, state.theme));
  const bool shown[3][2] = {{false, true}, {true, false}, {false, false}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (int body = 0; body < 2; ++body) {
      EXPECT_EQ(ghosts[i].has(body), shown[i][body]) << i << ", " << body;
    }
  }
  EXPECT_NEAR(ghosts[0].links.at(1)[3][0], 1.5, 1e-6);
}

}  // namespace
}  // namespace limpid
