// Identification of devices behind their protocol, in simulated time, and its benefit: with the
// identified parameters a coupling keeps its promises better.
#include <gtest/gtest.h>

#include <numbers>

#include "app/run/analysis.h"
#include "app/run/fitted_gains.h"
#include "tests/vm/simulated_identification.h"

namespace limpid::test {
namespace {

using namespace std::chrono_literals;

constexpr double kEta = 0.7;
const Vec3 kDown(0, 0, -9.81);

struct Trial {
  unsigned seed;
  int bits;
  Time lag;
};

struct SimulatedIdentify : testing::TestWithParam<Trial> {
  const UnlikeStick stick{GetParam().seed, GetParam().bits, GetParam().lag};
};
INSTANTIATE_TEST_SUITE_P(Sticks, SimulatedIdentify,
                         testing::Values(Trial{1, 16, 1ms}, Trial{2, 10, 1ms}, Trial{3, 16, 4ms},
                                         Trial{4, 10, 4ms}, Trial{5, 10, 2ms}, Trial{6, 10, 3ms}));

TEST_P(SimulatedIdentify, FindsWhatTheStickIs) {
  SimulatedIdentification run(stick);
  run.run();
  ASSERT_EQ(run.motion.end(), ExcitationEnd::complete)
      << explain(run.motion.end()) << ", " << explain(run.motion.objection()) << " after "
      << run.motion.time() << " s, joint " << run.motion.joint();
  stick.expect_found(identify(run.arm, run.record(), {.gravity = kDown}), 1.05e-3);
  EXPECT_TRUE(run.model->violations().empty()) << run.model->violations()[0];
  EXPECT_LE(run.model->forces().largest(), ExcitationPlan{}.torque * kEffort * (1 + 1e-6));
}

struct Felt {
  double inertia = 0;  // felt inertia over the stick's own
  double off =
      0;  // relative error of the hand's torque in free motion from the one that eta promises
  double slope = 0;   // slope of the coordination error against the contact torque [rad/(N m)]
  double energy = 0;  // highest E_c [J]
  bool force = true;  // force was on all along
};

// A hand on the stick, beside the stick's own spring.
class Hand {
 public:
  static constexpr double kStiffness = 2, kDamping = 0.02;  // [N m/rad, N m s/rad]

  Hand(SprungHand& axes, const UnlikeStick& stick, double (*path)(int, double)) : axes_(axes) {
    for (int i = 0; i < 2; ++i) {
      AxisPhysics& axis = axes.axis(i);
      spring_[i] = stick.axes[static_cast<std::size_t>(i)].stiffness;
      axis.stiffness = spring_[i] + kStiffness;
      axis.damping = kDamping;
      axis.path = [i, path, share = kStiffness / axis.stiffness](double t) {
        return share * path(i, t);
      };
    }
  }
  double torque(int i, double t) const {
    const AxisPhysics& axis = axes_.axis(i);
    const double x = axes_.position(i), speed = (axis.path(t + 1e-4) - axis.path(t)) / 1e-4;
    return axis.stiffness * (axis.path(t) - x) + axis.damping * (speed - axes_.velocity(i)) +
           spring_[i] * x;
  }

 private:
  SprungHand& axes_;
  double spring_[2]{};
};

double resting_then(double t, double amplitude, double angle) {
  return amplitude * std::clamp(t - 1.5, 0.0, 1.0) * std::sin(angle);
}
double swinging(int axis, double t) {
  constexpr double kTwoPi = 2 * std::numbers::pi;
  return resting_then(t, 0.12, kTwoPi * (axis == 0 ? 1.3 : 1.7) * t) +
         resting_then(t, 0.05, kTwoPi * (axis == 0 ? 4.1 : 3.3) * t);
}
double leaning(int axis, double t) {
  return axis == 0 ? 0.3 * std::clamp((t - 1.5) / 3, 0.0, 1.0) : 0;
}

// Gains for readings that are `delay` [s] old, whatever the arm's file knows of it.
Parameters suited(const ArmDescription& arm, double resolution, double delay) {
  Parameters p = fitted(arm, {}, delay);
  p.kind = CouplingKind::proposed;
  p.eta = kEta;
  p.encoder_step = resolution;
  p.velocity = VelocitySource::adaptive;
  static_cast<CompensationSettings&>(p) = suggested_compensation(arm);
  return p;
}

// Fit of the hand's torque in free motion: inertia and damping as parts of the stick's own,
// friction, and for each axis a spring and a push.
class FreeMotion {
 public:
  // b_v: of each axis [N m s/rad].
  void add(const UnlikeStick& stick, const SprungHand& axes, const Hand& hand, double t,
           const Eigen::VectorXd& b_v) {
    for (int i = 0; i < 2; ++i) {
      const AxisPhysics& axis = stick.axes[static_cast<std::size_t>(i)];
      const double v = axes.velocity(i), a = (v - before_[i]) / 1e-3, x = axes.position(i);
      const double torque = hand.torque(i, t);
      const double mean = 0.5 * (torque + torque_[i]);  // as the acceleration's, over the tick
      before_[i] = v, torque_[i] = torque;
      if (t < 3 || std::abs(v) < 0.05) continue;
      const double inertia = axis.inertia * a, damping = (axis.friction + b_v[i]) * v;
      const double first = i == 0 ? 1 : 0;
      Eigen::Vector<double, 7> row;
      row << inertia, damping, v > 0 ? 1 : -1, first * x, (1 - first) * x, first, 1 - first;
      A_ += row * row.transpose();
      b_ += row * mean;
      const double promised = kEta * (inertia + damping);
      missed_ += (mean - promised) * (mean - promised);
      whole_ += promised * promised;
    }
  }
  double inertia() const { return A_.ldlt().solve(b_)[0]; }
  double off() const { return std::sqrt(missed_ / whole_); }

 private:
  double before_[2]{}, torque_[2]{}, missed_ = 0, whole_ = 0;
  Eigen::Matrix<double, 7, 7> A_ = Eigen::Matrix<double, 7, 7>::Zero();
  Eigen::Vector<double, 7> b_ = Eigen::Vector<double, 7>::Zero();
};

// delay: what the gains reckon with [s].
Felt felt_on(const UnlikeStick& stick, const ArmDescription& believed, double delay) {
  Felt out;
  for (const bool pressing : {false, true}) {
    Scene scene;
    if (pressing) scene.add({.name = "stop", .shape = JointStop{0, 0.1, 1}, .material = {2}});
    SimulatedDesk<RawDeviceModel> desk(believed, scene, stick.made(),
                                       suited(believed, stick.layout.resolution, delay));
    const Hand hand(desk.model->hand(), stick, pressing ? leaning : swinging);
    desk.armed = true;
    const Parameters& p = desk.parameters;
    const Eigen::VectorXd b_v = p.b_v * gain_weights(p, device_damping(believed, p));
    FreeMotion motion;
    double ef = 0, ff = 0;
    for (int ms = 1; ms <= 5000; ++ms) {
      desk.run(1);
      const std::size_t k = desk.row.size() - 1;
      // A stick that leans on the stop stands still under its friction: then nothing shows that its
      // readings are alive, and its force fades.
      const ForceState why = desk.rig.force_state();
      const bool still = pressing && why == ForceState::frozen;
      if (ms > 1000) out.force = out.force && (why == ForceState::on || still);
      if (!pressing) motion.add(stick, desk.model->hand(), hand, 1e-3 * (ms - 1), b_v);
      out.energy = std::max(out.energy, desk.row.at(k, Column::energy_total) -
                                            desk.row.at(k, Column::energy_compensation));
      const double f = desk.row.vec(k, Column::contact_torque).norm();
      ef +=
          f * (desk.row.vec(k, Column::measured_position) - desk.row.vec(k, Column::proxy_position))
                  .norm();
      ff += f * f;
    }
    if (pressing) {
      out.slope = ef / ff;
    } else {
      out.off = motion.off();
      out.inertia = motion.inertia();
    }
  }
  return out;
}

TEST_P(SimulatedIdentify, BringsTheCouplingNearerToItsPromise) {
  SimulatedIdentification run(stick);
  run.run();
  const Identified found = identify(run.arm, run.record(), {.gravity = kDown});
  ASSERT_TRUE(found.arm.delay);
  const Felt before = felt_on(stick, run.arm, *found.arm.delay);
  const Felt after = felt_on(stick, found.arm, *found.arm.delay);
  std::printf(
      "| %2d bits, lag %lld ms | inertia felt %.2f -> %.2f | hand off %.0f -> %.0f %% | slope %.2f "
      "-> "
      "%.2f mrad/(N m) | E_c %.2f -> %.2f mJ |\n",
      GetParam().bits, static_cast<long long>(GetParam().lag / 1ms), before.inertia, after.inertia,
      100 * before.off, 100 * after.off, 1e3 * before.slope, 1e3 * after.slope, 1e3 * before.energy,
      1e3 * after.energy);
  EXPECT_TRUE(after.force);
  // The rest is not the inertia's alone: friction that is compensated late is felt in part.
  EXPECT_LT(after.off, 0.95 * before.off);
  EXPECT_NEAR(after.slope, before.slope, 0.1 * before.slope);
  EXPECT_LT(after.energy, 1e-4);
}

}  // namespace
}  // namespace limpid::test
