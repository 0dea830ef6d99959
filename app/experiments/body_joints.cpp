// Bodies on joints and free bodies that turn: pendulums, tops, chains, drawers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/experiments/body_bench.h"
#include "app/experiments/signals.h"

namespace limpid {
namespace {

constexpr double kRodMass = 0.05, kRodLength = 0.1;  // [kg, m]
constexpr double kGained = 1e-6;                     // energy that may come or go [J]
const Vec3 kRod(0.01, 0.01, kRodLength);             // [m]

// A rod that hangs on a joint at its upper end, which is at `top`, swung out about y.
Object rod(const std::string& name, const Vec3& top, double angle, BodyJoint::Kind kind) {
  Pose pose = turned_at(Vec3::Zero(), angle, Vec3::UnitY());
  pose.translation() = top + pose.linear() * Vec3(0, 0, -kRodLength / 2);
  Object object = moving(name, Box{kRod}, kRodMass, pose);
  BodyJoint& joint = object.body->joint.emplace();
  joint.kind = kind;
  joint.axis = Vec3::UnitY();
  joint.point = {0, 0, kRodLength / 2};
  return object;
}

// Mean period of the first body's swings about its joint at the origin, over `seconds` [s].
double measured_period(BodyBench& bench, double seconds) {
  const auto angle = [&] {
    const Vec3& c = bench.world().center(0);
    return std::atan2(-c.x(), -c.z());
  };
  double first = std::numeric_limits<double>::quiet_NaN(), last = first, before = angle(),
         time = bench.time();
  int periods = -1;
  bench.run(seconds, [&] {
    const double now = angle();
    if (before < 0 && now >= 0) {
      last = time + (bench.time() - time) * before / (before - now);
      if (++periods == 0) first = last;
    }
    before = now;
    time = bench.time();
  });
  return (last - first) / periods;
}

void add_pendulum(double tick, BodyJoint::Kind kind, double amplitude, BodyFindings& found) {
  const Vec3 moments = box_moments(kRodMass, kRod);
  const double to_center = kRodLength / 2, I = moments.y() + kRodMass * to_center * to_center;
  Scene scene;
  scene.add(rod("rod", Vec3::Zero(), amplitude, kind));
  BodyBench bench(scene, tick);
  const bool ball = kind == BodyJoint::Kind::ball;
  const std::string which = fmt::format("pendulum on a {}, amplitude {} rad, {}",
                                        ball ? "ball joint" : "hinge", amplitude, tick_text(tick));
  const std::string of = "A rod of 10 x 10 x 100 mm and 50 g";
  const double before = bench.energy(0, moments);
  Series curve{fmt::format("swings on a {}, {} rad", ball ? "ball joint" : "hinge", amplitude),
               kFamilyInk[(ball ? 2 : 0) + (amplitude > 1 ? 1 : 0)],
               Series::Style::line,
               {{0, 0}}};
  const auto note = [&] {
    curve.points.push_back({bench.time(), 1e3 * (bench.energy(0, moments) - before)});
  };
  const double period = measured_period(bench, 10);
  note();
  for (int i = 0; i < 50; ++i) {
    bench.run(1);
    note();
  }
  found.claims.push_back(
      {.group = "swing",
       .what = which + ": period",
       .unit = "s",
       .expected = pendulum_period(kRodMass, to_center, I, amplitude),
       .measured = period,
       .limit = 0.1,
       .conditions = "Theory: 4 K(sin(a / 2)) sqrt(I / (m g l)), with the elliptic integral K. " +
                     of + ", released at rest; mean of the periods in 10 s."});
  found.claims.push_back(
      {.group = "swing",
       .what = which + ": energy after a minute",
       .unit = "J",
       .expected = 0,
       .measured = bench.energy(0, moments) - before,
       .limit = kGained,
       .relative = false,
       .conditions = fmt::format(
           "Change of the pendulum's energy. {}. The energy of the swing is {:.3g} mJ.", of,
           1e3 * kRodMass * kStandardGravity * to_center * (1 - std::cos(amplitude)))});
  found.curves.push_back(curve);
}

BodyFindings pendulums(double tick) {
  BodyFindings found;
  for (const auto kind : {BodyJoint::Kind::hinge, BodyJoint::Kind::ball}) {
    for (const double amplitude : {0.1, 2.5}) add_pendulum(tick, kind, amplitude, found);
  }
  return found;
}

// A disc on the end of a light rod whose other end is on a ball joint, its axis level.
void add_top(double tick, double spin, BodyFindings& found) {
  constexpr double kMass = 0.2, kDisc = 0.04, kThick = 0.01, kArm = 0.05;  // [kg, m, m, m]
  Object disc = moving("top", Cylinder{kDisc, kThick}, kMass,
                       turned_at({kArm, 0, 0}, radians(90), Vec3::UnitY()));
  BodyJoint& joint = disc.body->joint.emplace();
  joint.kind = BodyJoint::Kind::ball;
  joint.point = {0, 0, -kArm};
  Scene scene;
  scene.add(disc);
  BodyBench bench(scene, tick);
  const Vec3 moments = cylinder_moments(kMass, kDisc, kThick);
  const double rate = precession(kMass, kArm, moments.z(), spin);
  bench.set_going(0, Vec3(0, rate * kArm, 0), Vec3(spin, 0, rate));
  const double energy = bench.energy(0, moments), start = bench.time();
  const auto heading = [&] {
    return std::atan2(bench.world().center(0).y(), bench.world().center(0).x());
  };
  double turned = 0, before = heading();
  bench.run(2, [&] {
    const double now = heading();
    turned += std::remainder(now - before, radians(360));
    before = now;
  });
  const std::string which = fmt::format("spinning top with {} rad/s, {}", spin, tick_text(tick));
  const std::string of =
      "A disc of 200 g, 40 mm radius and 10 mm thickness spins on a ball joint 50 mm away. Its "
      "axis is horizontal. The run lasts two seconds.";
  found.claims.push_back({.group = "top",
                          .what = which + ": precession",
                          .unit = "rad/s",
                          .expected = rate,
                          .measured = turned / (bench.time() - start),
                          .limit = 2,
                          .conditions = "Theory: m g l / (I w). " + of});
  found.claims.push_back(
      {.group = "top",
       .what = which + ": energy",
       .unit = "J",
       .expected = 0,
       .measured = bench.energy(0, moments) - energy,
       .limit = kGained,
       .relative = false,
       .conditions =
           fmt::format("Change of the energy, which is {:.3g} J at the start. {}", energy, of)});
}

BodyFindings tops(double tick) {
  BodyFindings found;
  for (const double spin : {100.0, 300.0}) add_top(tick, spin, found);
  return found;
}

// A slab thrown with a spin close to that about its middle axis, x.
void add_tumbling(double tick, double spin, BodyFindings& found) {
  constexpr double kMass = 0.05;      // [kg]
  const Vec3 size(0.03, 0.05, 0.01);  // [m]
  constexpr int kTurns = 5;
  Scene scene;
  scene.gravity.setZero();
  scene.add(moving("slab", Box{size}, kMass, pose_at(Vec3::Zero())));
  BodyBench bench(scene, tick);
  bench.set_going(0, Vec3::Zero(), spin * Vec3(1, 0.01, 0.01));
  const Vec3 moments = box_moments(kMass, size);
  const double energy = bench.energy(0, moments), start = bench.time();
  const Vec3 momentum = bench.angular_momentum(0, moments);
  FreeSpin right(moments, bench.own_spin(0), tick / 100);
  double expected = right.turned_over(kTurns, 20), measured = std::nan("");
  double before = bench.own_spin(0).x(), time = start;
  int turns = 0;
  bench.run(10, [&] {
    const double now = bench.own_spin(0).x();
    if (before * now < 0 && ++turns == kTurns) {
      measured = time - start + (bench.time() - time) * before / (before - now);
    }
    before = now;
    time = bench.time();
  });
  const std::string which = fmt::format("slab tumbles with {} rad/s, {}", spin, tick_text(tick));
  const std::string of =
      "A slab of 30 x 50 x 10 mm and 50 g, without weight, spins about its axis of middle inertia, "
      "and with a hundredth of that speed about both other axes";
  found.claims.push_back(
      {.group = "spin",
       .what = which + ": time of the fifth flip",
       .unit = "s",
       .expected = expected,
       .measured = measured,
       .limit = 0.5,
       .conditions =
           of + ". Theory: Euler's equations, solved in steps of a hundredth of the tick."});
  found.claims.push_back({.group = "spin",
                          .what = which + ": energy after ten seconds",
                          .unit = "mJ",
                          .expected = 1e3 * energy,
                          .measured = 1e3 * bench.energy(0, moments),
                          .limit = 1e-4,
                          .conditions = of + "."});
  found.claims.push_back(
      {.group = "spin",
       .what = which + ": angular momentum after ten seconds",
       .unit = "of its start value",
       .expected = 0,
       .measured = (bench.angular_momentum(0, moments) - momentum).norm() / momentum.norm(),
       .limit = 0.005,
       .relative = false,
       .conditions =
           of + ". Deviation of the vector in world coordinates, in size and direction."});
}

BodyFindings tumbles(double tick) {
  BodyFindings found;
  for (const double spin : {12.0, 60.0}) add_tumbling(tick, spin, found);
  return found;
}

// Three rods, each hinged to the one above.
BodyFindings chains(double tick) {
  const double angle = radians(60);
  const Vec3 along =
      turned_at(Vec3::Zero(), angle, Vec3::UnitY()).linear() * Vec3(0, 0, -kRodLength);
  Scene scene;
  for (int i = 0; i < 3; ++i) {
    scene.add(rod(fmt::format("rod {}", i + 1), i * along, angle, BodyJoint::Kind::hinge));
    if (i > 0) scene.objects.back().body->joint->to = fmt::format("rod {}", i);
  }
  BodyBench bench(scene, tick);
  const Vec3 moments = box_moments(kRodMass, kRod);
  const auto energy = [&] {
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += bench.energy(i, moments);
    return sum;
  };
  const double before = energy();
  double most = 0;
  bench.run(10, [&] { most = worse(most, energy() - before); });
  const std::string of = fmt::format(
      "Three rods of 10 x 10 x 100 mm and 50 g, each hinged to the next, are released in a "
      "straight line, 60 degrees away from hanging, with an energy of {:.3g} mJ. The run lasts ten "
      "seconds.",
      1e3 * kRodMass * kStandardGravity * kRodLength * 4.5 * (1 - std::cos(angle)));
  return {{{.group = "chain",
            .what = "chain of three links, largest energy gained, " + tick_text(tick),
            .unit = "J",
            .expected = 0,
            .measured = most,
            .limit = kGained,
            .relative = false,
            .conditions = of},
           {.group = "chain",
            .what = "chain of three links, change of energy at the end, " + tick_text(tick),
            .unit = "J",
            .expected = 0,
            .measured = energy() - before,
            .limit = kGained,
            .relative = false,
            .conditions = "Change of the energy. " + of}}};
}

// 125 g on a slider, 3.4 g hinged to them, 240 g hinged to these with stops: light between heavy.
constexpr const char* kLightBetweenHeavy = R"(title = "Chain"
about = "Light between heavy."
[[body]]
name = "b0"
box = [0.04264, 0.02435, 0.03443]
mass = 0.12549469392498983
position = [1.0, 0.0, 1.0]
rotation = [-0.7812220142313686, 0.012222156985917998, 0.6072387667414054]
[body.joint]
kind = "slider"
axis = [-0.4754135603981045, -0.07623195220885502, -0.8764534420333031]
limits = [-0.03, 0.03]
[[body]]
name = "b1"
cylinder = [0.012, 0.02336]
mass = 0.0033534708050340922
position = [0.9823741908676382, -0.029447593730238933, 1.0363616566719442]
rotation = [-0.8754865882723537, 0.28396939582947844, 0.891846557298509]
[body.joint]
kind = "hinge"
to = "b0"
axis = [-0.5494379896688505, 0.7885965776552598, 0.27610384499145246]
point = [0.008812904566180894, 0.014723796865119466, -0.018180828335972104]
detent = { force = 0.0011942873253371475, period = 0.5 }
[[body]]
name = "b2"
cylinder = [0.012, 0.04233]
mass = 0.24034607945130435
position = [0.9644170797699007, 0.01488268204633332, 1.050934535954933]
rotation = [-0.18202211773605614, -0.6227919756711793, -0.3931377963267557]
[body.joint]
kind = "hinge"
to = "b1"
axis = [0.31105477114006236, -0.8703636894485756, 0.38172238268205694]
point = [0.008978555548868807, -0.022165137888286127, -0.007286439641494344]
limits = [-0.5, 0.5]
stop_restitution = 0.5
)";

constexpr const char* kFlipper = R"(title = "Flipper"
about = "10 mg against a stop."
[[body]]
name = "flipper"
box = [0.071, 0.018, 0.005]
mass = 1e-5
position = [0.5, 0.5, 0.0]
[body.joint]
kind = "hinge"
axis = [0.0, 0.0, 1.0]
point = [-0.03, 0.0, 0.0]
limits = [-0.5, 0.5]
spring = 0.05
rest = 1.0
)";

// Most energy that the bodies of a scene's text have beyond what they had at first, by their own
// books; infinite numbers are passed over [J].
double most_gained(const std::string& text, double tick, double seconds) {
  const HandPath nobody = hand_path("nobody", 1e-3, 0.01, [](double) { return Vec3(0.18, 0, 0); });
  BodyBench bench(plan_in(built_in_arm().description, text, nobody, {}).document.scene, tick);
  double most = 0;
  bench.run(seconds, [&] {
    const double gain = bench.world().gain();
    if (std::isfinite(gain)) most = std::max(most, gain);
  });
  return most;
}

BodyFindings joints_with_stops(double tick) {
  return {
      {{.group = "chain",
        .what =
            "light link between heavy links at a stop, largest energy gained, " + tick_text(tick),
        .unit = "J",
        .expected = 0,
        .measured = most_gained(kLightBetweenHeavy, tick, 1),
        .limit = kGained,
        .relative = false,
        .conditions =
            "A link of 125 g on a slider, a link of 3.4 g hinged to the first, and a link of 240 g "
            "hinged to the second. All joints have stops. The run lasts one second."},
       {.group = "chain",
        .what = "flipper of 10 mg at its stop, largest energy gained, " + tick_text(tick),
        .unit = "J",
        .expected = 0,
        .measured = most_gained(kFlipper, tick, 1),
        .limit = kGained,
        .relative = false,
        .conditions = "A spring of 0.05 N m/rad presses the hinge against a stop. The run lasts "
                      "one second."}}};
}

// A body on a level slider along x.
Scene drawer(double mass, double damping) {
  Object box = moving("drawer", Box{{0.1, 0.1, 0.05}}, mass, pose_at(Vec3::Zero()));
  BodyJoint& joint = box.body->joint.emplace();
  joint.axis = Vec3::UnitX();
  joint.damping = damping;
  Scene scene;
  scene.add(box);
  return scene;
}

BodyFindings drawers(double tick) {
  constexpr double kMass = 0.5, kDamping = 2;  // [kg, N s/m]
  BodyFindings found;
  BodyBench bench(drawer(kMass, kDamping), tick);
  bench.set_going(0, Vec3(0.5, 0, 0), Vec3::Zero());
  const double speed = bench.world().speed(0).x(), place = bench.world().center(0).x();
  for (const double seconds : {0.25, 0.75}) {
    bench.run(seconds);
    const double time = seconds == 0.25 ? 0.25 : 1;
    found.claims.push_back({.group = "drawer",
                            .what = fmt::format("drawer with a damper, distance after {} s, {}",
                                                time, tick_text(tick)),
                            .unit = "mm",
                            .expected = 1e3 * braked_way(kMass, kDamping, speed, time),
                            .measured = 1e3 * (bench.world().center(0).x() - place),
                            .limit = 0.5,
                            .conditions = "Theory: v m / c (1 - exp(-c t / m)). A drawer of 500 g "
                                          "with a damper of 2 N s/m starts at 0.5 m/s."});
  }
  constexpr double kSoft = 300, kSpring = 10, kRest = 0.02;  // [N s/m, N/m, m]
  Scene soft = drawer(kMass, kSoft);
  soft.objects.back().body->joint->force.spring = kSpring;
  soft.objects.back().body->joint->force.rest = kRest;
  BodyBench closing(soft, tick);
  closing.run(60);
  found.claims.push_back(
      {.group = "drawer",
       .what = "drawer that closes softly, distance after a minute, " + tick_text(tick),
       .unit = "mm",
       .expected = 1e3 * drawn_way(kMass, kSoft, kSpring, kRest, 60),
       .measured = 1e3 * closing.world().center(0).x(),
       .limit = 0.5,
       .conditions = "A drawer of 500 g starts 20 mm from the rest position. It has a spring of 10 "
                     "N/m and a damper of 300 N s/m."});
  return found;
}

}  // namespace

std::vector<BodyCase> cases_with_joints() {
  return {{pendulums}, {tops}, {tumbles}, {chains}, {joints_with_stops}, {drawers}};
}

}  // namespace limpid
