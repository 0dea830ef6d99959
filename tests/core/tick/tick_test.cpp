// The tick: its rows against the paper's equations written out from the rows alone.
#include "core/tick/tick.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/tick/as_taken.h"
#include "tests/support/random_arm.h"
#include "tests/support/rows.h"
#include "tests/support/wisher.h"

namespace limpid {
namespace {

using test::Random;
using test::random_arm;
using test::Rows;

// Path of a device that is led whatever its motors do.
Eigen::VectorXd led(int n, std::size_t k, double T) {
  Eigen::VectorXd x(n);
  const double t = static_cast<double>(k) * T;
  for (int i = 0; i < n; ++i) x[i] = 0.4 + 0.3 * i + 0.25 * std::sin((3 + 0.7 * i) * t + i);
  return x;
}

Rows run(const ArmDescription& arm, const Scene& scene, const Parameters& p, std::size_t ticks) {
  const int n = arm.dof();
  Tick<kAnyDof> tick(arm, scene);
  tick.start(p, Start<kAnyDof>::at_rest(led(n, 0, p.tick)));
  Rows rows(tick.layout());
  for (std::size_t k = 0; k < ticks; ++k) {
    const Vec<kAnyDof> x = led(n, k, p.tick);
    tick.run(p, {x, x, Vec<kAnyDof>::Zero(n)}, ForceRequest::as_it_is, rows.add());
  }
  return rows;
}

// A stop that the first joint meets on its way.
Scene stop() {
  Scene scene;
  scene.add({.shape = JointStop{0, 0.5, 1}, .material = {20}});
  return scene;
}

struct Model {
  Eigen::MatrixXd M, C;
};
Model model(const ArmDescription& description, const Eigen::VectorXd& x, const Eigen::VectorXd& v,
            double factor) {
  const Arm<kAnyDof> arm(description);
  Arm<kAnyDof>::Frames f;
  Mat<kAnyDof> M, C;
  arm.frames(x, f);
  arm.inertia_coriolis(f, v, M, C);
  return {factor * M, factor * C};
}

class TickOfJoints : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Arms, TickOfJoints, testing::Values(1, 2, 3, 7));

TEST_P(TickOfJoints, CouplesByOneAndTwoOrFourteenAndFifteen) {
  const int n = GetParam();
  const ArmDescription arm = random_arm(n, 120);
  for (const CouplingKind kind : {CouplingKind::standard, CouplingKind::proposed}) {
    Parameters p;
    p.kind = kind;
    p.eta = 0.7;
    p.inertia_ratio = 0.02;
    p.inertia_error = 1.3;
    p.torque_limit = 100;
    const double T = p.tick;
    const Rows rows = run(arm, stop(), p, 1500);
    int touched = 0;
    for (std::size_t k = 2; k + 1 < rows.size(); ++k) {
      const Eigen::VectorXd x1 = rows.vec(k, Column::measured_position);
      const Eigen::VectorXd v1 = (x1 - rows.vec(k - 1, Column::measured_position)) / T;
      const Eigen::VectorXd x2 = rows.vec(k, Column::proxy_position);
      const Eigen::VectorXd next2 = rows.vec(k + 1, Column::proxy_position);
      const Eigen::VectorXd vbar2 = (next2 - x2) / T, xbar2 = (next2 + x2) / 2;
      const Eigen::VectorXd last2 = (x2 - rows.vec(k - 1, Column::proxy_position)) / T;
      const Eigen::VectorXd f2 = rows.vec(k, Column::contact_torque);
      touched += f2.norm() > 0 ? 1 : 0;
      Eigen::VectorXd tau1 = -p.b_vc * (v1 - last2) - p.k_vc * (x1 - x2);
      Eigen::VectorXd tau2 = -p.b_v * vbar2 - p.b_vc * (vbar2 - v1) - p.k_vc * (xbar2 - x1);
      if (kind == CouplingKind::proposed) {
        const Eigen::VectorXd vm = rows.vec(k, Column::measured_velocity);
        const Eigen::VectorXd v2 = rows.vec(k, Column::proxy_velocity);
        const Model one = model(arm, x1, vm, p.inertia_error);
        const Model two = model(arm, x2, v2, p.inertia_ratio);
        const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n);
        const Eigen::MatrixXd M_L = one.M + two.M;
        const Eigen::MatrixXd phi = M_L.inverse() * two.M;
        const Eigen::VectorXd v_L = M_L.inverse() * (one.M * vm + two.M * v2), v_E = vm - v2;
        const Eigen::MatrixXd C_EL = phi.transpose() * one.C + (phi.transpose() - I) * two.C;
        const Eigen::MatrixXd C_LE = -C_EL.transpose();
        const Eigen::VectorXd f = rows.vec(k, Column::hand_torque_estimate) + f2;
        const Eigen::MatrixXd scale = (1 - p.eta) / p.eta * I - phi.transpose() / p.eta;
        tau1 += C_EL * v_L + (I - phi.transpose()) * C_LE * v_E + scale * f + f2;
        tau2 += -C_EL * v_L + phi.transpose() * C_LE * v_E + phi.transpose() / p.eta * f - f2;
      }
      ASSERT_LT((rows.vec(k, Column::commanded_torque) - tau1).norm(), 1e-10 * (1 + tau1.norm()))
          << "tick " << k;
      ASSERT_LT((rows.vec(k, Column::proxy_torque) - tau2).norm(), 1e-8 * (1 + tau2.norm()))
          << "tick " << k;
    }
    EXPECT_GT(touched, 200);
  }
}

TEST_P(TickOfJoints, KeepsTheEnergyBooksOfTheContract) {
  const int n = GetParam();
  const ArmDescription arm = random_arm(n, 121);
  Parameters p;
  p.damping = 0.02;
  const Rows rows = run(arm, stop(), p, 1000);
  double total = 0, commanded = 0;
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    ASSERT_NEAR(rows.at(k, Column::energy_total), total, 1e-12);
    ASSERT_NEAR(rows.at(k, Column::energy_commanded), commanded, 1e-12);
    const auto moved = [&](Column c) {
      return Eigen::VectorXd(rows.vec(k + 1, c) - rows.vec(k, c));
    };
    const Eigen::VectorXd dx1 = moved(Column::device_position), dx2 = moved(Column::proxy_position);
    const Eigen::VectorXd tau2 = rows.vec(k, Column::proxy_torque);
    const double work = rows.vec(k, Column::motor_torque).dot(dx1) + tau2.dot(dx2);
    commanded += work;
    total += work - 0.02 / p.tick * dx1.dot(dx1);
    const double gained = rows.at(k + 1, Column::proxy_kinetic) - rows.at(k, Column::proxy_kinetic);
    const double given = (tau2 + rows.vec(k, Column::contact_torque)).dot(dx2);
    ASSERT_NEAR(gained, given, 1e-14 + 1e-10 * rows.at(k, Column::proxy_kinetic)) << k;
  }
}

TEST(Tick, ClampsTheCommandToTheArmsOwnLimitOrTheOneThatIsSet) {
  const ArmDescription arm = random_arm(3, 122);
  Parameters p;
  p.k_vc = 1000;
  for (const double limit : {kFromArm, 0.2}) {
    p.torque_limit = limit;
    const Rows rows = run(arm, stop(), p, 800);
    int clamped = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const Eigen::VectorXd command = rows.vec(k, Column::commanded_torque);
      const Eigen::VectorXd motor = rows.vec(k, Column::motor_torque);
      for (int i = 0; i < 3; ++i) {
        const double most =
            std::isnan(limit) ? arm.joints[static_cast<std::size_t>(i)].effort : limit;
        ASSERT_EQ(motor[i], std::clamp(command[i], -most, most));
        clamped += motor[i] != command[i] ? 1 : 0;
      }
    }
    EXPECT_GT(clamped, 10);
  }
}

TEST(Tick, SwitchesTheCouplingWithoutAJumpOfTheMotors) {
  const ArmDescription arm = random_arm(3, 123);
  Parameters p;
  Tick<3> tick(arm, stop());
  tick.start(p, Start<3>::at_rest(led(3, 0, p.tick)));
  Rows rows(tick.layout());
  bool slewed = false;
  for (std::size_t k = 0; k < 1500; ++k) {
    p.kind = static_cast<CouplingKind>(k / 300 % kLaws);
    const Vec<3> x = led(3, k, p.tick);
    tick.run(p, {x, x, Vec<3>::Zero()}, ForceRequest::as_it_is, rows.add());
    if (k == 0 || tick.steady()) continue;
    slewed = true;
    const Eigen::VectorXd jump =
        rows.vec(k, Column::motor_torque) - rows.vec(k - 1, Column::motor_torque);
    for (int i = 0; i < 3; ++i) {
      const double limit = arm.joints[static_cast<std::size_t>(i)].effort;
      ASSERT_LE(std::abs(jump[i]), limit * p.tick / 0.1 * (1 + 1e-9)) << "tick " << k;
    }
  }
  EXPECT_TRUE(slewed);
}

TEST(Tick, GivesNoTorqueWhileForceIsOffAndSaysSo) {
  const ArmDescription arm = random_arm(3, 124);
  const Parameters p;
  Tick<3> tick(arm, stop());
  test::Wisher wisher(true);
  tick.start(p, Start<3>::at_rest(led(3, 0, p.tick)));
  Rows rows(tick.layout());
  for (std::size_t k = 0; k < 300; ++k) {
    const Vec<3> x = led(3, k, p.tick);
    const bool force = k < 100 || k >= 200;
    const Vec<3> tau = tick.run(p, {x, x, Vec<3>::Zero()}, wisher.at(force), rows.add());
    ASSERT_EQ(rows.at(k, Column::force_wanted), force ? 1 : 0);
    ASSERT_EQ(tau, rows.vec(k, Column::motor_torque));
    if (!force) {
      ASSERT_EQ(tau.norm(), 0);
      ASSERT_GT(rows.vec(k, Column::commanded_torque).norm(), 0);
    }
  }
}

TEST(Tick, CutsTheForceForGoodWhenTheLoopIsNoLongerFinite) {
  const ArmDescription arm = random_arm(3, 125);
  const Parameters p;
  Tick<3> tick(arm, stop());
  tick.start(p, Start<3>::at_rest(led(3, 0, p.tick)));
  Rows rows(tick.layout());
  for (std::size_t k = 0; k < 100; ++k) {
    Vec<3> x = led(3, k, p.tick);
    if (k == 50) x[1] = std::numeric_limits<double>::quiet_NaN();
    const Vec<3> tau = tick.run(p, {x, x, Vec<3>::Zero()}, ForceRequest::as_it_is, rows.add());
    ASSERT_EQ(tick.diverged(), k >= 50);
    ASSERT_TRUE(tau.allFinite());
    if (k >= 50) {
      ASSERT_EQ(tau.norm(), 0);
    }
  }
  // A new start clears the divergence.
  tick.start(p, Start<3>::at_rest(led(3, 0, p.tick)));
  EXPECT_FALSE(tick.diverged());
  const Vec<3> x = led(3, 0, p.tick);
  tick.run(p, {x, x, Vec<3>::Zero()}, ForceRequest::as_it_is, rows.add());
  EXPECT_FALSE(tick.diverged());
}

class TickOfALaw : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Laws, TickOfALaw, testing::Range(std::size_t{0}, std::size_t{kLaws}),
                         [](const auto& law) { return std::string(kLawKeys[law.param]); });

// A start elsewhere knows neither the way there nor torques that are still on their way.
TEST_P(TickOfALaw, BeginsAnewAsIfItHadNeverRun) {
  const ArmDescription arm = random_arm(3, 132);
  Parameters p;
  p.kind = static_cast<CouplingKind>(GetParam());
  p.delay = 2;
  Scene scene;
  scene.add({.shape = JointStop{0, 0.1, 1}, .material = {20}});  // held off all the time
  const auto run_from = [&](Tick<3>& tick, std::size_t first) {
    tick.start(p, Start<3>::at_rest(led(3, first, p.tick)));
    Rows rows(tick.layout());
    for (std::size_t k = first; k < first + 100; ++k) {
      const Vec<3> x = led(3, k, p.tick);
      tick.run(p, {x, x, Vec<3>::Zero()}, ForceRequest::as_it_is, rows.add());
    }
    return rows;
  };
  Tick<3> used(arm, scene);
  run_from(used, 0);
  for (const std::size_t first : {300, 500, 700, 900, 1100, 1300}) {
    Tick<3> fresh(arm, scene);
    const Rows again = run_from(used, first), once = run_from(fresh, first);
    for (std::size_t k = 0; k < once.size(); ++k) {
      for (std::size_t i = 0; i < once.row(k).size(); ++i) {
        const double a = again.row(k)[i], b = once.row(k)[i];
        ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << k << ", " << i;
      }
    }
  }
}

TEST(Tick, OfThreeJointsIsTheSameWithFixedAndWithAnySize) {
  const ArmDescription arm = random_arm(3, 126);
  const Parameters p;
  Tick<3> fixed(arm, stop());
  Tick<kAnyDof> any(arm, stop());
  fixed.start(p, Start<3>::at_rest(led(3, 0, p.tick)));
  any.start(p, Start<kAnyDof>::at_rest(led(3, 0, p.tick)));
  Rows a(fixed.layout()), b(any.layout());
  for (std::size_t k = 0; k < 500; ++k) {
    const Vec<3> x = led(3, k, p.tick);
    fixed.run(p, {x, x, Vec<3>::Zero()}, ForceRequest::as_it_is, a.add());
    any.run(p, {x, x, Vec<kAnyDof>::Zero(3)}, ForceRequest::as_it_is, b.add());
    for (std::size_t i = 0; i < a.row(k).size(); ++i) {
      ASSERT_NEAR(a.row(k)[i], b.row(k)[i], 1e-7 * (1 + std::abs(a.row(k)[i]))) << k << ", " << i;
    }
  }
}

// First order, implicit, 50 Hz: v += g (raw - v), g = T w / (1 + T w).
TEST(Tick, WritesTheVelocityThatTheObserverUsed) {
  const ArmDescription arm = random_arm(3, 127);
  Parameters p;
  p.velocity = VelocitySource::lowpass;
  const Rows rows = run(arm, stop(), p, 400);
  const double w = 2 * 3.14159265358979323846 * 50;
  const double g = p.tick * w / (1 + p.tick * w);
  Eigen::VectorXd v = Eigen::VectorXd::Zero(3);
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const Eigen::VectorXd raw =
        (rows.vec(k, Column::measured_position) - rows.vec(k - 1, Column::measured_position)) /
        p.tick;
    v += g * (raw - v);
    ASSERT_LT((rows.vec(k, Column::measured_velocity) - v).norm(), 1e-10) << k;
  }
}

// Energy that the stop has stored at the start was not gained.
TEST(Tick, CountsWhatContactsGainFromWhereItStarts) {
  const ArmDescription arm = random_arm(3, 128);
  const Parameters p;
  Scene scene;
  scene.add({.shape = JointStop{0, led(3, 0, p.tick)[0] - 0.2, 1}, .material = {20}});
  const Rows rows = run(arm, scene, p, 600);
  EXPECT_EQ(rows.at(0, Column::contact_gain), 0);
  EXPECT_NEAR(rows.at(0, Column::contact_potential), 0.5 * 20 * 0.04, 0.02);
  double work = 0;
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    const double stored =
        rows.at(k, Column::contact_potential) - rows.at(0, Column::contact_potential);
    ASSERT_NEAR(rows.at(k, Column::contact_gain), work + stored, 1e-12) << k;
    ASSERT_NEAR(rows.at(k, Column::contact_gain), 0, 1e-9) << k;
    work += rows.vec(k, Column::contact_torque)
                .dot(rows.vec(k + 1, Column::proxy_position) - rows.vec(k, Column::proxy_position));
  }
}

TEST(Tick, TakesNewSettingsInFromTheTickTheyAreGivenAt) {
  const ArmDescription arm = random_arm(3, 129);
  Parameters p;
  p.damping = 0.02;
  Tick<kAnyDof> tick(arm, stop());
  tick.start(p, Start<kAnyDof>::at_rest(led(3, 0, p.tick)));
  Rows rows(tick.layout());
  const auto damping = [](std::size_t k) { return k < 300 ? 0.02 : k < 301 ? 0.4 : 0.05; };
  const auto ratio = [](std::size_t k) { return k < 250 ? 1e-4 : 3e-2; };
  for (std::size_t k = 0; k < 600; ++k) {
    p.damping = damping(k);
    p.inertia_ratio = ratio(k);
    const Vec<kAnyDof> x = led(3, k, p.tick);
    tick.run(p, {x, x, Vec<kAnyDof>::Zero(3)}, ForceRequest::as_it_is, rows.add());
  }
  double lost = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double own = rows.at(k, Column::energy_commanded) - rows.at(k, Column::energy_total);
    ASSERT_NEAR(own, lost, 1e-12) << k;
    const Eigen::VectorXd x2 = rows.vec(k, Column::proxy_position);
    const Eigen::VectorXd v2 = rows.vec(k, Column::proxy_velocity);
    const Model two = model(arm, x2, v2, ratio(k));
    ASSERT_NEAR(rows.at(k, Column::proxy_kinetic), 0.5 * v2.dot(two.M * v2),
                1e-9 * (1e-9 + v2.dot(two.M * v2)))
        << k;
    if (k + 1 == rows.size()) break;
    const Eigen::VectorXd dx = led(3, k + 1, p.tick) - led(3, k, p.tick);
    lost += damping(k) / p.tick * dx.dot(dx);
  }
}

// A damping that the arm lacks would be taken for the hand's force: f1_hat = f1 + (b_set - b) v.
TEST(Tick, BelievesNoMoreDampingOfARealArmThanItsFileHas) {
  const ArmDescription arm = random_arm(3, 131);
  const auto estimates = [&](double damping, bool guarded) {
    Parameters p;
    p.kind = CouplingKind::standard;
    p.damping = damping;
    Tick<3> tick(arm, stop());
    tick.start(p, Start<3>::at_rest(led(3, 0, p.tick)));
    Rows rows(tick.layout());
    for (std::size_t k = 0; k < 400; ++k) {
      const Vec<3> x = led(3, k, p.tick);
      tick.run(p, {x, x, Vec<3>::Zero(), {.guarded = guarded}}, ForceRequest::cut, rows.add());
    }
    return Eigen::VectorXd(rows.vec(399, Column::hand_torque_estimate));
  };
  ASSERT_GT(arm.joints.front().damping, 0);
  EXPECT_NE(estimates(5, false), estimates(kFromArm, false));
  EXPECT_EQ(estimates(5, true), estimates(kFromArm, true));
  EXPECT_NE(estimates(0, true), estimates(kFromArm, true)) << "less may be tried";
}

// The rows of a real arm follow from the settings that the loop reports to take, and from these
// alone.
TEST(Tick, TakesTheSettingsOfARealArmAsTheFunctionSaysThatAllOthersAsk) {
  const ArmDescription arm = random_arm(3, 133);
  const auto rows_of = [&](const Parameters& p) {
    Tick<3> tick(arm, stop());
    tick.start(p, Start<3>::at_rest(led(3, 0, p.tick)));
    Rows rows(tick.layout());
    for (std::size_t k = 0; k < 300; ++k) {
      const Vec<3> x = led(3, k, p.tick);
      tick.run(p, {x, x, Vec<3>::Zero(), {.guarded = true}}, ForceRequest::arm, rows.add());
    }
    return Eigen::VectorXd(rows.vec(299, Column::commanded_torque));
  };
  Parameters set;
  set.damping = 5;
  set.torque_limit = 1e3;
  set.friction = 0.5;
  set.friction_share = 0.7;
  set.device_delay = 3;
  EXPECT_EQ(rows_of(set), rows_of(as_taken(set, RealDevice::of(arm, 0))));
  set.damping = 1e-4;
  set.torque_limit = 1e-3;
  EXPECT_EQ(rows_of(set), rows_of(as_taken(set, RealDevice::of(arm, 0))));
}

// Law, observer and contacts begin anew there, at the present positions.
TEST(Tick, LeadsTheTorqueOfARealArmOnWhereARecordingBegins) {
  const ArmDescription arm = random_arm(3, 132);
  constexpr std::size_t kBefore = 600;
  const auto jump = [&](bool guarded) {
    Parameters p;
    p.kind = CouplingKind::standard;
    p.k_vc = 1;
    Tick<3> tick(arm, Scene{});
    tick.start(p, Start<3>::at_rest(led(3, 0, p.tick)));
    Rows rows(tick.layout());
    for (std::size_t k = 0; k <= kBefore; ++k) {
      const Vec<3> x = led(3, k, p.tick);
      if (k == kBefore) {
        Start<3> here = Start<3>::at_rest(x);
        here.x2 = x - Vec<3>::Constant(0.05);  // the spring's torque jumps
        tick.restart_here(p, here);
      }
      tick.run(p, {x, x, Vec<3>::Zero(), {.guarded = guarded}}, ForceRequest::as_it_is, rows.add());
    }
    const Eigen::VectorXd change =
        rows.vec(kBefore, Column::motor_torque) - rows.vec(kBefore - 1, Column::motor_torque);
    double largest = 0;
    for (int i = 0; i < 3; ++i) {
      largest =
          std::max(largest, std::abs(change[i]) / arm.joints[static_cast<std::size_t>(i)].effort);
    }
    return largest / Parameters{}.tick;
  };
  EXPECT_LE(jump(true), 1 / 0.1 * (1 + 1e-9));
  EXPECT_GT(jump(false), 4 / 0.1) << "rows of a virtual arm follow from where they begin";
}

// The bound ignores settings meant for the virtual arm.
TEST(Tick, GivesARealArmNoMoreThanItsOwnLimitNorFaster) {
  const ArmDescription arm = random_arm(3, 130);
  for (const double setting : {100.0, 0.3, kFromArm}) {
    Parameters p;
    p.kind = CouplingKind::standard;
    p.k_vc = 500;
    p.torque_limit = setting;
    Tick<3> tick(arm, stop());
    tick.start(p, Start<3>::at_rest(led(3, 0, p.tick)));
    Rows rows(tick.layout());
    for (std::size_t k = 0; k < 1500; ++k) {
      const Vec<3> x = led(3, k, p.tick);
      tick.run(p, {x, x, Vec<3>::Zero(), {.guarded = true}}, ForceRequest::as_it_is, rows.add());
    }
    Eigen::VectorXd largest = Eigen::VectorXd::Zero(3), fastest = Eigen::VectorXd::Zero(3);
    for (std::size_t k = 1; k < rows.size(); ++k) {
      const Eigen::VectorXd now = rows.vec(k, Column::motor_torque);
      const Eigen::VectorXd before = rows.vec(k - 1, Column::motor_torque);
      largest = largest.cwiseMax(now.cwiseAbs());
      fastest = fastest.cwiseMax(now.cwiseAbs() - before.cwiseAbs());
    }
    for (int i = 0; i < 3; ++i) {
      const double effort = arm.joints[static_cast<std::size_t>(i)].effort;
      const double limit = std::isnan(setting) ? effort : std::min(effort, setting);
      EXPECT_LE(largest[i], limit) << setting;
      EXPECT_LE(fastest[i], limit * p.tick / 0.02 * (1 + 1e-9)) << setting;
    }
    EXPECT_GT(largest.maxCoeff(), 0.25) << setting;
    EXPECT_GT(fastest.maxCoeff(), 0.2 * p.tick / 0.02) << setting;
  }
}

}  // namespace
}  // namespace limpid
