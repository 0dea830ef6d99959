// Bodies that slide, roll, bounce, hit each other, tip over, or rest.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/experiments/body_bench.h"

namespace limpid {
namespace {

constexpr double kRadius = 0.02, kLength = 0.04;  // of what rolls [m]
constexpr double kRollingMass = 0.05;             // [kg]
constexpr double kRollingFriction = 0.9;          // friction under what rolls [-]
constexpr double kDriftLimit = 0.1;               // [mm]
constexpr double kEdge = 0.03;                    // of cubes that rest [m]
constexpr double kCubeMass = 0.05;                // [kg]

void rub(Object& object, double friction) {
  object.material.friction_static = object.material.friction_kinetic = friction;
}

// Downhill on ground(slope).
Vec3 downhill(double slope) { return {std::cos(slope), 0, -std::sin(slope)}; }
Vec3 uphill_normal(double slope) { return {std::sin(slope), 0, std::cos(slope)}; }

// Mean acceleration of the first body downhill, from one time to another [m/s^2].
double acceleration(BodyBench& bench, double slope, double from, double to) {
  bench.run(from);
  const double before = bench.world().speed(0).dot(downhill(slope));
  bench.run(to - from);
  return (bench.world().speed(0).dot(downhill(slope)) - before) / (to - from);
}

// A flat block on a slope.
Scene block_on(double slope, double friction) {
  const Vec3 size(0.04, 0.04, 0.01);
  Scene scene;
  scene.add(ground(slope, friction));
  scene.add(moving("block", Box{size}, 0.1,
                   turned_at(size.z() / 2 * uphill_normal(slope), slope, Vec3::UnitY())));
  return scene;
}

BodyFindings slides(double tick) {
  BodyFindings found;
  const std::string size = "a block of 40 x 40 x 10 mm and 100 g";
  struct {
    double degrees, friction;
  } constexpr kSlopes[] = {{15, 0.2}, {30, 0.2}, {30, 0.5}, {45, 0.5}};
  for (const auto& [degrees, friction] : kSlopes) {
    const double slope = radians(degrees);
    BodyBench bench(block_on(slope, friction), tick);
    found.claims.push_back(
        {.group = "slide",
         .what = fmt::format("block slides on a slope of {} degrees, friction {}, {}", degrees,
                             friction, tick_text(tick)),
         .unit = "m/s^2",
         .expected = sliding(slope, friction),
         .measured = acceleration(bench, slope, 0.2, 0.8),
         .limit = 2,
         .conditions = fmt::format(
             "Theory: g (sin(slope) - mu cos(slope)), for {}, measured from 0.2 to 0.8 s.", size)});
  }
  const double friction = 0.5, slope = 0.99 * std::atan(friction);
  BodyBench bench(block_on(slope, friction), tick);
  bench.keep_awake();
  bench.run(0.5);
  const Vec3 before = bench.world().center(0);
  bench.run(5);
  found.claims.push_back(
      {.group = "slide",
       .what = "block rests on a slope of 0.99 of the friction angle, " + tick_text(tick),
       .unit = "mm",
       .expected = 0,
       .measured = 1e3 * (bench.world().center(0) - before).norm(),
       .limit = kDriftLimit,
       .relative = false,
       .conditions = fmt::format("Friction {}, {}, computed even at rest. The error is the "
                                 "block's displacement from 0.5 to 5.5 s.",
                                 friction, size)});
  return found;
}

// A round body that rolls, its axis along y.
struct Roller {
  const char* name;
  Shape shape;
  double moment;  // about its axis [kg m^2]
  double limit;   // [%]
  const char* ink;
};

std::vector<Roller> rollers() {
  const double m = kRollingMass, r = kRadius, l = kLength;
  return {{"ball", Sphere{r}, ball_moments(m, r).z(), 2, kFamilyInk[0]},
          {"cylinder", Cylinder{r, l}, cylinder_moments(m, r, l).z(), 1, kFamilyInk[1]},
          {"capsule", Capsule{r, l}, capsule_moments(m, r, l).z(), 2, kFamilyInk[2]}};
}

Scene roller_on(double slope, const Roller& roller) {
  Pose pose = turned_at(kRadius * uphill_normal(slope), slope, Vec3::UnitY());
  pose.rotate(Eigen::AngleAxisd(radians(90), Vec3::UnitX()));
  Scene scene;
  scene.add(ground(slope, kRollingFriction));
  scene.add(moving(roller.name, roller.shape, kRollingMass, pose));
  return scene;
}

BodyFindings rolls(double tick) {
  BodyFindings found;
  for (const Roller& roller : rollers()) {
    for (const double degrees : {5.0, 15.0, 30.0}) {
      const double slope = radians(degrees);
      BodyBench bench(roller_on(slope, roller), tick);
      found.claims.push_back(
          {.group = "roll",
           .what = fmt::format("{} rolls on a slope of {} degrees, {}", roller.name, degrees,
                               tick_text(tick)),
           .unit = "m/s^2",
           .expected = rolling(slope, kRollingMass, kRadius, roller.moment),
           .measured = acceleration(bench, slope, 0.2, 1),
           .limit = roller.limit,
           .conditions = fmt::format("Theory: g sin(slope) / (1 + I / (m r^2)); radius {} mm, {} "
                                     "g, friction {}, measured from 0.2 to 1 s.",
                                     1e3 * kRadius, 1e3 * kRollingMass, kRollingFriction)});
    }
    // The way at 20 degrees, for the figure.
    const double slope = radians(20);
    BodyBench bench(roller_on(slope, roller), tick);
    const Vec3 start = bench.world().center(0);
    Series way{roller.name, roller.ink, Series::Style::line, {{0, 0}}};
    for (int i = 1; i <= 100; ++i) {
      bench.run(0.01);
      way.points.push_back({bench.time(), (bench.world().center(0) - start).dot(downhill(slope))});
    }
    found.curves.push_back(way);
    Series right{"", roller.ink, Series::Style::dashed, {}};
    const double a = rolling(slope, kRollingMass, kRadius, roller.moment);
    for (int i = 0; i <= 20; ++i) {
      const double t = i / 20.0;
      right.points.push_back({t, a * t * t / 2});
    }
    found.curves.push_back(right);
  }
  return found;
}

// Speed at which a ball leaves the ground, over that at which it came.
double rebound(double mass, double restitution, double tick) {
  constexpr double kBall = 0.01, kHeight = 0.2;  // [m]
  Scene scene;
  scene.add(ground(0, 0));
  scene.add(moving("ball", Sphere{kBall}, mass, pose_at({0, 0, kBall + kHeight})));
  scene.objects.back().body->restitution = restitution;
  BodyBench bench(scene, tick);
  double down = 0, up = 0;
  bench.run(0.35, [&] {
    const double v = bench.world().speed(0).z();
    down = std::max(down, -v);
    up = std::max(up, v);
  });
  return up / down;
}

BodyFindings bounces(double tick) {
  BodyFindings found;
  for (const double mass : {1e-6, 0.001, 0.1, 1.0}) {
    for (const double restitution : {0.0, 0.3, 0.7, 1.0}) {
      found.claims.push_back({.group = "bounce",
                              .what = fmt::format("ball of {} g bounces, restitution {}, {}",
                                                  1e3 * mass, restitution, tick_text(tick)),
                              .unit = "of the impact speed",
                              .expected = restitution,
                              .measured = rebound(mass, restitution, tick),
                              .limit = restitution == 0 ? 0.02 : 0.03,
                              .relative = false,
                              .conditions = "A ball of 10 mm radius falls 20 cm onto a plane, with "
                                            "a contact of 20,000 N/m and no friction."});
    }
  }
  return found;
}

struct Meeting {
  double mass;         // of the right ball [kg]
  double restitution;  // [-]
};

// Two balls before a wall: the left one comes with 1 m/s, the right one rests.
void add_meeting(double tick, const Meeting& of, BodyFindings& found) {
  constexpr double kBall = 0.01, kLeft = 0.05;  // [m], [kg]
  Scene scene;
  scene.gravity.setZero();
  Object wall = ground(0, 0);
  wall.shape = Plane{-Vec3::UnitX()};
  wall.pose = pose_at({0.15, 0, 0});
  scene.add(wall);
  for (const auto& [name, mass, x] : {std::tuple("left", kLeft, 0.0), {"right", of.mass, 0.05}}) {
    scene.add(moving(name, Sphere{kBall}, mass, pose_at({x, 0, 0})));
    scene.objects.back().body->restitution = of.restitution;
  }
  BodyBench bench(scene, tick);
  bench.set_going(0, Vec3::UnitX(), Vec3::Zero());
  const auto speed = [&](int body) { return bench.world().speed(body).x(); };
  const BallsAndWall before{{kLeft, of.mass}, {speed(0), speed(1)}, of.restitution};
  bench.run(0.055);  // they have met, and the wall is not reached
  const BallsAndWall met{{kLeft, of.mass}, {speed(0), speed(1)}, of.restitution};
  bench.run(2.5);
  const BallsAndWall end{{kLeft, of.mass}, {speed(0), speed(1)}, of.restitution};
  BallsAndWall right = before;
  right.meet_to_the_end();
  const std::string which = fmt::format("50 g hit {} g, restitution {}, {}", 1e3 * of.mass,
                                        of.restitution, tick_text(tick));
  const std::string conditions =
      "Two balls of 10 mm radius and a wall are in line. The left ball moves at 1 m/s towards the "
      "right ball. There is no weight and no friction.";
  found.claims.push_back({.group = "hit",
                          .what = which + ": momentum after the balls met",
                          .unit = "N s",
                          .expected = before.momentum(),
                          .measured = met.momentum(),
                          .limit = 1e-6,
                          .conditions = conditions});
  for (const int side : {0, 1}) {
    found.claims.push_back({.group = "hit",
                            .what = fmt::format("{}: speed of the {} ball after all impacts", which,
                                                side == 0 ? "left" : "right"),
                            .unit = "m/s",
                            .expected = right.speed[static_cast<std::size_t>(side)],
                            .measured = end.speed[static_cast<std::size_t>(side)],
                            .limit = 0.03,
                            .relative = false,
                            .conditions = conditions});
  }
  found.claims.push_back({.group = "hit",
                          .what = which + ": energy after all impacts",
                          .unit = "mJ",
                          .expected = 1e3 * right.energy(),
                          .measured = 1e3 * end.energy(),
                          .limit = 1.5,
                          .relative = false,
                          .conditions = conditions});
}

BodyFindings meets(double tick) {
  BodyFindings found;
  for (const Meeting& of : {Meeting{0.05, 1}, {0.05, 0.7}, {0.1, 1}, {0.1, 0.7}}) {
    add_meeting(tick, of, found);
  }
  return found;
}

BodyFindings tips_over(double tick) {
  const Vec3 size(0.02, 0.02, 0.04);
  const auto tips = [&](double slope) {
    Scene scene;
    scene.add(ground(slope, 1.5));
    scene.add(moving("block", Box{size}, kCubeMass,
                     turned_at(size.z() / 2 * uphill_normal(slope), slope, Vec3::UnitY())));
    scene.objects.back().body->contact_stiffness = 1e6;
    BodyBench bench(scene, tick);
    bench.keep_awake();
    bench.run(1.5);
    return bench.world().pose(0).linear().col(2).dot(uphill_normal(slope)) < std::cos(0.2);
  };
  double stands = radians(20), falls = radians(33);
  for (int i = 0; i < 9; ++i) {
    const double middle = (stands + falls) / 2;
    (tips(middle) ? falls : stands) = middle;
  }
  const double degree = radians(1);
  return {{{.group = "tip",
            .what = "smallest slope at which a block tips over, " + tick_text(tick),
            .unit = "degrees",
            .expected = tipping(size.x(), size.z()) / degree,
            .measured = (stands + falls) / 2 / degree,
            .limit = 1,
            .conditions =
                "Theory: the slope is atan(width / height). A block of 20 x 20 x 40 mm and 50 g, "
                "friction 1.5, is placed at rest on the slope, on contacts of 1e6 N/m. The block "
                "tips over if it falls within 1.5 s. On softer contacts the block rocks and tips "
                "over at a smaller slope."}}};
}

// Cubes one on the other.
Scene tower(int cubes) {
  Scene scene;
  scene.add(ground(0, 0.5));
  for (int i = 0; i < cubes; ++i) {
    scene.add(moving(fmt::format("cube {}", i + 1), Box{Vec3::Constant(kEdge)}, kCubeMass,
                     pose_at({0, 0, kEdge * (i + 0.5)})));
    rub(scene.objects.back(), 0.5);
  }
  return scene;
}

// Farthest that a body of the scene gets from its place after a second [mm].
double drift(const Scene& scene, double tick, double seconds) {
  BodyBench bench(scene, tick);
  bench.keep_awake();
  bench.run(1);
  std::vector<Vec3> places;
  for (int i = 0; i < bench.world().count(); ++i) places.push_back(bench.world().center(i));
  double most = 0;
  bench.run(seconds, [&] {
    for (int i = 0; i < bench.world().count(); ++i) {
      const Vec3& place = places[static_cast<std::size_t>(i)];
      most = worse(most, (bench.world().center(i) - place).norm());
    }
  });
  return 1e3 * most;
}

BodyFindings rests(double tick) {
  const std::string cubes =
      fmt::format("Cubes of {} mm and {} g, friction 0.5, computed even at rest.", 1e3 * kEdge,
                  1e3 * kCubeMass);
  return {{{.group = "rest",
            .what = "a cube rests for ten minutes, " + tick_text(tick),
            .unit = "mm",
            .expected = 0,
            .measured = drift(tower(1), tick, 600),
            .limit = kDriftLimit,
            .relative = false,
            .conditions = cubes}}};
}

BodyFindings stands(double tick) {
  const std::string cubes =
      fmt::format("Cubes of {} mm and {} g, friction 0.5, computed even at rest.", 1e3 * kEdge,
                  1e3 * kCubeMass);
  return {{{.group = "rest",
            .what = "a stack of five cubes rests for a minute, " + tick_text(tick),
            .unit = "mm",
            .expected = 0,
            .measured = drift(tower(5), tick, 60),
            .limit = kDriftLimit,
            .relative = false,
            .conditions = cubes}}};
}

BodyFindings grain_rests(double tick) {
  Scene scene;
  scene.add(ground(0, 0.5));
  scene.add(moving("grain", Box{Vec3::Constant(0.002)}, 1e-5, pose_at({0, 0, 0.001})));
  BodyBench bench(scene, tick);
  bench.run(2);
  double most = 0;
  bench.run(1, [&] { most = worse(most, bench.world().spin(0).norm()); });
  return {{{.group = "rest",
            .what = "spin of a resting cube of 10 mg (should be 0), " + tick_text(tick),
            .unit = "rad/s",
            .expected = 0,
            .measured = most,
            .limit = 0.02,
            .relative = false,
            .conditions =
                "A cube of 2 mm lies on a plane. Its fastest spin is measured from 2 to 3 s."}}};
}

BodyFindings falls_slowly(double tick) {
  Scene scene;
  scene.gravity = {0, 0, -0.001};
  scene.add(moving("ball", Sphere{0.01}, 0.05, pose_at(Vec3::Zero())));
  BodyBench bench(scene, tick);
  bench.run(10);
  return {{{.group = "rest",
            .what = "ball falls under a gravity of 0.001 m/s^2, " + tick_text(tick),
            .unit = "mm",
            .expected = 50,
            .measured = -1e3 * bench.world().center(0).z(),
            .limit = 2,
            .conditions =
                "Theory: g t^2 / 2 with g = 0.001 m/s^2, after 10 s. The ball touches nothing."}}};
}

// Speed at which a row of dominoes falls; there is no closed form for it.
BodyFindings dominoes(double tick) {
  const Vec3 size(0.008, 0.024, 0.048);
  constexpr double kApart = 0.024;  // from middle to middle [m]
  constexpr int kFirst = 4, kLast = 14, kAll = 18;
  Scene scene;
  scene.add(ground(0, 0.5));
  for (int i = 0; i < kAll; ++i) {
    scene.add(moving(fmt::format("domino {}", i + 1), Box{size}, 0.012,
                     pose_at({kApart * i, 0, size.z() / 2})));
    rub(scene.objects.back(), 0.2);
  }
  BodyBench bench(scene, tick);
  bench.run(0.1);
  const Vec3 spin(0, 4, 0);
  bench.set_going(0, spin.cross(Vec3(-size.x() / 2, 0, size.z() / 2)), spin);
  double first = std::numeric_limits<double>::quiet_NaN(), last = first;
  const auto leans = [&](int i) { return bench.world().pose(i).linear()(2, 2) < std::cos(0.2); };
  bench.run(2, [&] {
    if (std::isnan(first) && leans(kFirst)) first = bench.time();
    if (std::isnan(last) && leans(kLast)) last = bench.time();
  });
  return {{{.group = "",
            .what = "dominoes fall, " + tick_text(tick),
            .unit = "m/s",
            .expected = {},
            .measured = (kLast - kFirst) * kApart / (last - first),
            .limit = 0,
            .conditions = "Dominoes of 8 x 24 x 48 mm and 12 g, 24 mm from middle to middle, "
                          "friction 0.2 among dominoes and 0.5 with the ground. The speed is "
                          "measured from the fifth to the fifteenth domino.",
            .unjudged = "No closed form is known for the speed of dominoes."}}};
}

}  // namespace

std::vector<BodyCase> cases_with_contacts() {
  return {{slides},       {rolls},         {bounces},     {meets},        {tips_over},
          {rests, false}, {stands, false}, {grain_rests}, {falls_slowly}, {dominoes}};
}

}  // namespace limpid
