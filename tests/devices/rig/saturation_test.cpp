// Motors at their limit while the tip is between walls: what the predictive law promises there, in
// runs that nobody chose.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/dynamics/arm.h"
#include "devices/rig/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

using test::Random;
using test::Rows;

// A hand presses the tip into the corner of a few planes, harder than the motors bear, and then
// rubs along it.
struct Corner {
  ArmDescription arm;
  Scene scene;
  Parameters p;
  RigStart start;
  Vec3 out, along;          // of the first plane
  double press, rise, way;  // [N, s, m]
  double limit;             // of each motor [N m]

  Vec3 hand(double t) const {
    const double in = std::clamp((t - 0.02) / rise, 0.0, 1.0);
    const double rubs = t > 0.4 ? 0.01 * std::sin(2 * std::numbers::pi * 5 * (t - 0.4)) : 0;
    return start.target - in * way * out + rubs * along;
  }
};

// Uniform in the logarithm.
double log_between(Random& random, double low, double high) {
  return std::exp(random.between(std::log(low), std::log(high)));
}

double one_of(Random& random, std::initializer_list<double> values) {
  const double at = random.between(0, static_cast<double>(values.size()) - 1e-9);
  return values.begin()[static_cast<std::size_t>(at)];
}

struct Width {
  std::initializer_list<int> dofs{3};
  int planes = 3;      // at most
  double grip = 3000;  // stiffest [N/m]
  std::initializer_list<double> friction{0, 0.3, 0.5, 1};
  std::initializer_list<double> masses{0, 0.02, 0.1};  // of the hand [kg]
  bool eta = false;                                    // other than 1
};

Corner random_corner(unsigned seed, const Width& width) {
  constexpr double kAway = 0.008;  // of the start from the planes [m]
  Random random(seed);
  Corner c;
  const std::size_t which =
      static_cast<std::size_t>(random.between(0, static_cast<double>(width.dofs.size()) - 1e-9));
  const int dof = width.dofs.begin()[which];
  c.arm = dof == 3 ? test::omni() : test::random_arm(dof, seed);
  c.limit = log_between(random, 0.1, 0.6);
  c.p.kind = CouplingKind::predictive;
  c.p.torque_limit = c.limit;
  c.p.eta = width.eta ? log_between(random, 0.2, 5) : 1;
  c.p.hand_stiffness = log_between(random, 100, width.grip);
  c.p.hand_damping = 1;
  c.p.hand_mass_at_tip = one_of(random, width.masses);
  c.out = random.direction();
  const Arm<kAnyDof> arm(c.arm);
  if (dof == 3) {
    c.start = rest_at(c.arm, Vec3(0.13, 0, 0) + random.point(0.02));
  } else {
    const Eigen::VectorXd x = random.vector(dof, 0.6);
    Arm<kAnyDof>::Frames f;
    arm.frames(x, f);
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(dof);
    c.start.x1 = c.start.x2 = x;
    c.start.v1 = c.start.v2 = c.start.f1_hat = zero;
    c.start.target = arm.tip(f);
  }
  c.along = c.out.unitOrthogonal();
  const double stiffness = log_between(random, 300, 10'000);
  const double friction = one_of(random, width.friction);
  const int planes = 1 + static_cast<int>(random.between(0, width.planes - 1e-9));
  for (int i = 0; i < planes; ++i) {
    Vec3 normal = c.out;
    while (i > 0) {
      normal = (c.out + random.between(0.05, 1) * random.direction()).normalized();
      if (normal.dot(c.out) > 0.3) break;
    }
    const double K = i > 0 && random.between(0, 1) < 0.5 ? stiffness / 3 : stiffness;
    c.scene.planes.push_back(
        {"", c.start.target - kAway * c.out, normal, {K, 0, friction, friction}});
  }
  c.press = random.between(1, 5);
  c.rise = random.between(0.02, 0.2);
  c.way = kAway + c.press / c.p.hand_stiffness + c.press / stiffness;
  return c;
}

struct Outcome {
  double energy = 0;   // highest E_c, from torques and positions [J]
  double torque = 0;   // largest of the contacts on a joint, by the motor's limit [-]
  double jump = 0;     // farthest that the proxy's joints go in a tick [rad]
  double reserve = 1;  // least [J]
  double port = 0;     // most that the hand is given [J]
  int limited = 0;     // ticks with a motor at its limit
  int unsettled = 0;   // ticks without a solution
  int ticks = 0;
};

Outcome run(const Corner& c) {
  Rig rig(c.arm, c.scene);
  rig.start(c.p, c.start);
  Rows rows(rig.layout());
  const std::size_t count = 900;
  for (std::size_t k = 0; k <= count; ++k) {
    rig.step(c.p, {{c.hand(static_cast<double>(k) * c.p.tick), 1}}, rows.add());
  }
  Outcome outcome;
  double energy = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::VectorXd dx1 =
        rows.vec(k + 1, Column::device_position) - rows.vec(k, Column::device_position);
    const Eigen::VectorXd dx2 =
        rows.vec(k + 1, Column::proxy_position) - rows.vec(k, Column::proxy_position);
    const Eigen::VectorXd tau1 = rows.vec(k, Column::motor_torque);
    energy += tau1.dot(dx1) + rows.vec(k, Column::proxy_torque).dot(dx2);
    for (Eigen::Index i = 0; i < dx1.size(); ++i) {
      energy -= c.arm.joints[static_cast<std::size_t>(i)].damping * dx1[i] * dx1[i] / c.p.tick;
    }
    outcome.energy = std::max(outcome.energy, energy);
    outcome.torque = std::max(outcome.torque,
                              rows.vec(k, Column::contact_torque).cwiseAbs().maxCoeff() / c.limit);
    outcome.jump = std::max(outcome.jump, dx2.cwiseAbs().maxCoeff());
    outcome.reserve = std::min(outcome.reserve, rows.at(k, Column::energy_ledger));
    outcome.port = std::max(outcome.port, rows.at(k, Column::energy_port));
    outcome.limited += (tau1.cwiseAbs().array() >= c.limit).any();
  }
  outcome.unsettled = static_cast<int>(rows.at(count, Column::unsettled));
  outcome.ticks = static_cast<int>(count);
  return outcome;
}

struct Worst {
  Outcome of;  // the worst of each
  int over_energy = 0, over_torque = 0, over_jump = 0, below = 0, limited_runs = 0;

  void add(unsigned seed, const Outcome& o) {
    const auto tell = [&](const char* what, double value) {
      std::printf("seed %u: %s %.4g\n", seed, what, value);
    };
    if (o.energy > 0.05e-3) ++over_energy, tell("E_c [mJ]", 1e3 * o.energy);
    if (o.torque > 1.3) ++over_torque, tell("f2 over the limit", o.torque);
    if (o.jump > 0.01) ++over_jump, tell("proxy [mrad]", 1e3 * o.jump);
    if (o.reserve < 0) ++below, tell("reserve [mJ]", 1e3 * o.reserve);
    limited_runs += o.limited > 0;
    of.energy = std::max(of.energy, o.energy);
    of.torque = std::max(of.torque, o.torque);
    of.jump = std::max(of.jump, o.jump);
    of.reserve = std::min(of.reserve, o.reserve);
    of.port = std::max(of.port, o.port);
    of.limited += o.limited;
    of.unsettled += o.unsettled;
    of.ticks += o.ticks;
  }
  void print() const {
    std::printf(
        "E_c %.4f mJ, f2 %.3f limits, proxy %.2f mrad a tick, reserve %.2f mJ, port %.4f mJ; %d of "
        "%d ticks limited, %d without a solution\n",
        1e3 * of.energy, of.torque, 1e3 * of.jump, 1e3 * of.reserve, 1e3 * of.port, of.limited,
        of.ticks, of.unsettled);
  }
};

TEST(MotorsAtTheirLimit, BetweenWallsGiveNoEnergyAndLetTheProxyNotJump) {
  Worst worst;
  for (unsigned seed = 0; seed < 300; ++seed) worst.add(seed, run(random_corner(seed, {})));
  worst.print();
  EXPECT_GT(worst.limited_runs, 150);
  EXPECT_EQ(worst.over_energy, 0);
  EXPECT_EQ(worst.over_torque, 0);
  EXPECT_EQ(worst.over_jump, 0);
  EXPECT_EQ(worst.below, 0);
  EXPECT_LE(worst.of.port, 0.05e-3);
  EXPECT_LE(worst.of.unsettled, 1e-4 * worst.of.limited);
}

// Other arms, more walls, more friction, other eta.
TEST(MotorsAtTheirLimit, OfOtherArmsInMoreWallsGiveNoEnergyEither) {
  Worst worst;
  const Width wide{.dofs = {3, 7, 12},
                   .planes = 6,
                   .grip = 10'000,
                   .friction = {0, 0.3, 0.7, 1.5},
                   .masses = {0, 0.1, 0.5},
                   .eta = true};
  for (unsigned seed = 1000; seed < 1150; ++seed) worst.add(seed, run(random_corner(seed, wide)));
  worst.print();
  EXPECT_GT(worst.limited_runs, 50);
  EXPECT_EQ(worst.over_energy, 0);
  EXPECT_LE(worst.of.torque, 1.6);
  EXPECT_EQ(worst.over_jump, 0);
  EXPECT_EQ(worst.below, 0);
  EXPECT_LE(worst.of.port, 0.05e-3);
}

}  // namespace
}  // namespace limpid
