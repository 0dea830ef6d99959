// Properties of the predictive coupling in the full nonlinear loop.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/touch/contacts.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"
#include "tests/support/table.h"
#include "tests/support/taps.h"

namespace limpid {
namespace {

using test::Felt;
using test::kTable;
using test::Rows;
using test::table;
using test::Taps;

Parameters predictive(double eta) {
  Parameters p;
  p.kind = CouplingKind::predictive;
  p.eta = eta;
  p.torque_limit = 100;  // strong motors
  return p;
}

Felt tapped(const Taps& taps, const Parameters& p) {
  return taps.felt(test::omni(), table({taps.wall}), test::flat_spot(kTable, Vec3::UnitZ()), p);
}

TEST(PredictiveTaps, OfStiffWallsAreFeltAsTheyAreSetAndWithoutEnergy) {
  for (const double wall : {600.0, 2000.0, 5000.0, 10000.0}) {
    for (const double eta : {1.0, 0.6, 0.3}) {
      for (const double grip : {300.0, 3000.0}) {
        for (const double mass : {0.0, 0.2}) {
          Parameters p = predictive(eta);
          p.hand_stiffness = grip;
          p.hand_mass_at_tip = mass;
          const Felt felt = tapped({.wall = wall}, p);
          SCOPED_TRACE(testing::Message() << wall << " N/m, eta " << eta << ", grip " << grip
                                          << " N/m, hand " << mass << " kg");
          EXPECT_LE(felt.energy, 0.05e-3);
          EXPECT_LE(felt.port, 0.05e-3);
          EXPECT_NEAR(felt.stiffness, 1, 0.01);
          EXPECT_LE(felt.chatter, mass > 0 ? 4e-3 : 0.1e-3);  // a heavy hand rings on the wall
        }
      }
    }
  }
}

// In a heavy hand the observer's lag turns feedforward of the hand's torque into a spring that
// swings, if it is not held back.
TEST(PredictiveTaps, WithAHeavyProxyInAHeavyHandGiveNoEnergy) {
  for (const double ratio : {0.3, 0.5, 1.0}) {
    for (const double eta : {1.0, 0.5}) {
      for (const double mass : {0.0, 0.05, 0.2, 1.0}) {
        for (const double alpha : {0.035, 0.2}) {
          Parameters p = predictive(eta);
          p.inertia_ratio = ratio;
          p.hand_mass_at_tip = mass;
          p.alpha = alpha;
          const Felt felt = tapped({.wall = 600}, p);
          SCOPED_TRACE(testing::Message() << "M2/M1 " << ratio << ", eta " << eta << ", hand "
                                          << mass << " kg, alpha " << alpha);
          EXPECT_LE(felt.energy, 0.05e-3);
          EXPECT_LE(felt.port, 0.05e-3);
        }
      }
    }
  }
}

// Mass that the law adds to a device beside a heavy proxy makes the two swing against each other,
// if it is not bounded by the device's own.
TEST(PredictiveTaps, WithAHeavyProxyAndAddedMassGiveNoEnergy) {
  for (const double ratio : {0.25, 0.35, 0.5, 1.0, 3.0}) {
    for (const double eta : {2.0, 3.0, 5.0}) {
      for (const double mass : {0.0, 0.05, 0.1}) {
        Parameters p = predictive(eta);
        p.inertia_ratio = ratio;
        p.hand_mass_at_tip = mass;
        const Felt felt = tapped({.wall = 600}, p);
        SCOPED_TRACE(testing::Message()
                     << "M2/M1 " << ratio << ", eta " << eta << ", hand " << mass << " kg");
        EXPECT_LE(felt.energy, 0.05e-3);
        EXPECT_LE(felt.port, 0.05e-3);
      }
    }
  }
}

TEST(PredictiveTaps, ThroughAnEncoderGiveTheHandNoEnergy) {
  for (const double wall : {600.0, 2000.0, 5000.0}) {
    for (const double eta : {1.0, 0.3}) {
      for (const double grip : {300.0, 3000.0}) {
        for (const double mass : {0.0, 0.2}) {
          Parameters p = predictive(eta);
          p.encoder_step = 1e-4;
          p.hand_stiffness = grip;
          p.hand_mass_at_tip = mass;
          const Felt felt = tapped({.wall = wall}, p);
          SCOPED_TRACE(testing::Message() << wall << " N/m, eta " << eta << ", grip " << grip
                                          << " N/m, hand " << mass << " kg");
          EXPECT_LE(felt.port, 0.05e-3);
          EXPECT_LE(felt.energy, 4e-3);
          EXPECT_NEAR(felt.stiffness, 1, 0.01);
          EXPECT_LE(felt.chatter, 20e-3);
        }
      }
    }
  }
}

TEST(PredictiveTaps, BeyondTheMotorsLimitGiveNoEnergyAndDoNotBuzz) {
  constexpr double kLimit = 0.4;  // [N m]
  for (const double wall : {600.0, 5000.0}) {
    for (const double eta : {1.0, 0.6, 0.3}) {
      for (const double mass : {0.0, 0.2}) {
        Parameters p = predictive(eta);
        p.torque_limit = kLimit;
        p.hand_mass_at_tip = mass;
        const Felt felt = tapped({.wall = wall, .press = 8}, p);
        SCOPED_TRACE(testing::Message() << wall << " N/m, eta " << eta << ", hand " << mass);
        EXPECT_LE(felt.energy, 0.05e-3);
        EXPECT_LE(felt.port, 0.05e-3);
        EXPECT_GT(felt.torque, kLimit);  // the hand pushed that far
        // The proxy rests where the wall's force equals the motor's; with a light hand it barely
        // overshoots.
        if (mass == 0) {
          EXPECT_LE(felt.torque, 1.3 * kLimit);
          EXPECT_LE(felt.chatter, 0.1e-3);
        }
      }
    }
  }
}

TEST(PredictiveCoupling, KnowsOfTheDeviceWhatItsEncodersSay) {
  const ArmDescription arm = test::omni();
  Parameters p = predictive(0.3);
  p.encoder_step = 1e-3;
  p.hand_stiffness = p.hand_damping = 0;
  RigStart start = rest_at(arm, kTable);
  start.x1 = start.x2 = (start.x1 / p.encoder_step).array().round().matrix() * p.encoder_step;
  const auto first = [&](double part) {
    RigStart within = start;
    within.x1.array() += part * p.encoder_step;
    Rig rig(arm, table({600}));
    rig.start(p, within);
    Rows rows(rig.layout());
    rig.step(p, {{kTable, 1}}, rows.add());
    return rows;
  };
  const Rows middle = first(0), aside = first(0.4);
  for (const Column c : {Column::measured_position, Column::commanded_torque, Column::proxy_torque,
                         Column::contact_torque, Column::energy_ledger}) {
    EXPECT_EQ(middle.vec(0, c), aside.vec(0, c)) << static_cast<int>(c);
  }
}

// The first `planes` of a corner: a floor, a wall ahead, a wall to the left.
Scene corner(int planes, const Material& material) {
  Scene scene;
  for (const Vec3& out : {Vec3(Vec3::UnitZ()), Vec3(-Vec3::UnitX()), Vec3(-Vec3::UnitY())}) {
    if (planes-- > 0) scene.add({"", pose_at(kTable), Plane{out}, material});
  }
  return scene;
}

struct CornerPress {
  double energy = 0, port = 0;  // highest [J]
  double gain = -1;             // most energy given by pressed contacts in a tick [J]
  std::size_t touched = 0;      // most planes touched at a time
};

// Rows of a hand that presses into the corner and circles there.
CornerPress press_into(const Scene& scene, const Parameters& p) {
  const ArmDescription arm = test::omni();
  Rig rig(arm, scene);
  const auto hand = [](double t) {
    const double in = std::min(1.0, 2 * t), turn = 2 * std::numbers::pi * 1.5 * t;
    return Vec3(kTable + Vec3(-0.02, -0.02, 0.02) + in * Vec3(0.033, 0.033, -0.033) +
                0.008 * in * Vec3(std::sin(turn), std::cos(turn), std::sin(1.3 * turn)));
  };
  rig.start(p, rest_at(arm, hand(0)));
  Rows rows(rig.layout());
  CornerPress pressed;
  for (std::size_t k = 0; k < 4000; ++k) {
    rig.step(p, {{hand(static_cast<double>(k) * p.tick), 1}}, rows.add());
    pressed.energy = std::max(pressed.energy, rows.at(k, Column::energy_total));
    pressed.port = std::max(pressed.port, rows.at(k, Column::energy_port));
    pressed.touched = std::max(pressed.touched, rows.touches(k).size());
    if (k == 0 || rows.touches(k - 1).empty()) continue;
    pressed.gain = std::max(
        pressed.gain, rows.at(k, Column::contact_gain) - rows.at(k - 1, Column::contact_gain));
  }
  return pressed;
}

TEST(PredictiveContacts, InAnEdgeAndACornerGiveNoEnergy) {
  for (const std::size_t planes : {2u, 3u}) {
    for (const double friction : {0.0, 0.5}) {
      for (const double eta : {1.0, 0.3}) {
        for (const double mass : {0.0, 0.2}) {
          Parameters p = predictive(eta);
          p.hand_mass_at_tip = mass;
          const Scene scene = corner(static_cast<int>(planes), {3000, 0, friction, friction});
          const CornerPress pressed = press_into(scene, p);
          SCOPED_TRACE(testing::Message() << planes << " planes, friction " << friction << ", eta "
                                          << eta << ", hand " << mass << " kg");
          EXPECT_EQ(pressed.touched, planes);
          EXPECT_LE(pressed.energy, 0.05e-3);
          EXPECT_LE(pressed.port, 0.05e-3);
          EXPECT_LE(pressed.gain, 1e-7);
        }
      }
    }
  }
}

TEST(PredictiveFriction, NeverGivesEnergyInATick) {
  constexpr double kFriction = 0.5, kWall = 3000;
  const ArmDescription description = test::omni();
  const Arm<3> arm(description);
  const auto hand = [](double t) {  // pressed with varying force and led to and fro
    return Vec3(kTable + Vec3(0.01 * std::sin(9 * t), 0.01 * std::sin(14 * t),
                              0.005 - 0.02 * std::min(1.0, 4 * t) + 0.005 * std::sin(23 * t)));
  };
  for (const double mass : {0.0, 0.2}) {
    Parameters p = predictive(0.5);
    p.hand_mass_at_tip = mass;
    Rig rig(description, table({kWall, 0, kFriction, kFriction}));
    rig.start(p, rest_at(description, hand(0)));
    Rows rows(rig.layout());
    for (std::size_t k = 0; k < 5000; ++k) {
      rig.step(p, {{hand(static_cast<double>(k) * p.tick), 1}}, rows.add());
    }
    const auto tip = [&](std::size_t k) { return arm.tip_at(rows.vec(k, Column::proxy_position)); };
    // Friction force across the table in the tick, and its limit by the push [N].
    const auto across = [&](std::size_t k, double& limit) {
      const Vec3 force = rows.force(k);
      limit = kFriction * force.z();
      return Vec3(force.x(), force.y(), 0);
    };
    // Energy in the spring that stands for friction [J].
    const auto stretched = [](const Vec3& force) {
      return force.squaredNorm() / (2 * friction_stiffness({kWall}));
    };
    int slips = 0, sticks = 0;
    double limit = 0, work = 0;
    Vec3 before = across(0, limit);
    for (std::size_t k = 1; k + 1 < rows.size(); ++k) {
      const Vec3 force = across(k, limit);
      ASSERT_LE(force.norm(), limit + 1e-9) << k;
      slips += limit > 0 && force.norm() > (1 - 1e-6) * limit;
      sticks += force.norm() < 0.9 * limit;
      const double gain = force.dot(tip(k + 1) - tip(k)) + stretched(force) - stretched(before);
      ASSERT_LE(gain, 1e-7) << k;
      work += force.dot(tip(k + 1) - tip(k));
      before = force;
    }
    EXPECT_GT(slips, 100);
    EXPECT_GT(sticks, 100);
    EXPECT_LT(work, -1e-3);
  }
}

TEST(PredictiveInertia, MayChangeAtAnyTimeInFreeMotion) {
  const ArmDescription arm = test::omni();
  test::Random random(7);
  const auto hand = [](double t) {
    return Vec3(Vec3(0.19, 0, 0) +
                Vec3(0.02 * std::sin(9 * t), 0.03 * std::sin(6 * t), 0.02 * std::sin(14 * t)));
  };
  const std::function<double(double)> etas[] = {
      [](double t) { return std::fmod(3 * t, 1) < 0.5 ? 0.1 : 1; },
      [](double t) { return std::fmod(20 * t, 1) < 0.5 ? 0.3 : 1; },
      [](double t) { return std::fmod(37 * t, 1) < 0.5 ? 0.1 : 0.9; },
      [](double t) { return 0.55 + 0.45 * std::sin(5 * t); },
      [&](double) { return random.between(0.1, 1); },
  };
  for (const auto& eta : etas) {
    Parameters p = predictive(1);
    p.hand_stiffness = 3000;
    p.hand_damping = 0;
    Rig rig(arm, Scene{});
    rig.start(p, rest_at(arm, hand(0)));
    Rows rows(rig.layout());
    for (std::size_t k = 0; k < 5000; ++k) {
      const double t = static_cast<double>(k) * p.tick;
      p.eta = eta(t);
      rig.step(p, {{hand(t), 1}}, rows.add());
      ASSERT_LE(rows.at(k, Column::energy_total), 1e-6) << k;
    }
    EXPECT_LT(rows.at(rows.size() - 1, Column::energy_total), -1e-3);
    EXPECT_FALSE(rig.diverged());
  }
}

// Result of a hand that moves the base joint by a quarter of a millimetre at 3 Hz.
struct Swung {
  double inertia = 0;   // effective inertia at that frequency [kg m^2]
  double reserve = 1;   // lowest, once it swings evenly [J]
  double governor = 1;  // lowest share of damping that may be cancelled [-]
};

Swung swung(double eta, double encoder_step) {
  constexpr double kOmega = 2 * std::numbers::pi * 3;
  constexpr std::size_t kTicks = 2000, kFirst = 2000;  // six periods
  const ArmDescription arm = test::omni();
  const auto hand = [](double t) { return Vec3(0.19, 0.25e-3 * std::sin(kOmega * t), 0.02); };
  Parameters p = predictive(eta);
  p.hand_stiffness = 1000;
  p.hand_damping = 2;
  p.encoder_step = encoder_step;
  Rig rig(arm, Scene{});
  rig.start(p, rest_at(arm, hand(0)));
  Rows rows(rig.layout());
  for (std::size_t k = 0; k < kFirst + kTicks; ++k) {
    rig.step(p, {{hand(static_cast<double>(k) * p.tick), 1}}, rows.add());
  }
  Swung out;
  std::complex<double> torque, velocity;
  for (std::size_t k = kFirst; k < rows.size(); ++k) {
    const std::complex<double> wave = std::polar(1.0, -kOmega * static_cast<double>(k) * p.tick);
    torque += rows.vec(k, Column::hand_torque)[0] * wave;
    velocity += rows.vec(k, Column::device_velocity)[0] * wave;
    out.reserve = std::min(out.reserve, rows.at(k, Column::energy_ledger));
    out.governor = std::min(out.governor, rows.at(k, Column::damping_governor));
  }
  out.inertia = (torque / velocity).imag() / kOmega;
  return out;
}

// A step of the reading is no energy: no motion did that work.
TEST(PredictiveInertia, IsFeltThroughAnEncoderAsWithoutOne) {
  for (const double eta : {5.0, 3.0, 0.6}) {
    const Swung exact = swung(eta, 0), read = swung(eta, 1e-4);
    SCOPED_TRACE(eta);
    EXPECT_GT(exact.inertia, 0);
    EXPECT_NEAR(read.inertia / exact.inertia, 1, 0.08);
    EXPECT_GT(read.reserve, 4.5e-3);
    EXPECT_GT(read.governor, 0.99);
  }
}

}  // namespace
}  // namespace limpid
