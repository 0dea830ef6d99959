// The predictive coupling on arms of one to seven joints.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/dynamics/inverse_kinematics.h"
#include "core/math/eigen.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"
#include "tests/support/taps.h"

namespace limpid {
namespace {

using test::Felt;
using test::Rows;
using test::Spot;
using test::Taps;

std::vector<ArmDescription> arms() {
  std::vector<ArmDescription> out;
  for (const int dof : {1, 2, 6, 7}) out.push_back(test::random_arm(dof, 1));
  for (const char* file : {"planar2.urdf", "joystick.urdf"}) {
    out.push_back(read_urdf(test::assets_dir() / "devices" / file));
  }
  return out;
}

// A start at rest in the middle of the range; arms of few joints do not reach every place.
RigStart in_the_middle(const ArmDescription& arm) {
  const Eigen::VectorXd x = rest_pose(arm), zero = Eigen::VectorXd::Zero(arm.dof());
  return {x, zero, x, zero, zero, Arm<kAnyDof>(arm).tip_at(x), true};
}

// Direction in which the tip moves most easily.
Vec3 easiest(const ArmDescription& description, const RigStart& start) {
  const Arm<kAnyDof> arm(description);
  Arm<kAnyDof>::Frames f;
  arm.frames(start.x1, f);
  Jacobian<kAnyDof> J;
  arm.point_jacobian(f, arm.dof() - 1, start.target, J);
  return symmetric_eigen(J * J.transpose()).vectors.col(2);
}

TEST(PredictiveArms, FeelWallsAsTheyAreSetAndWithoutEnergy) {
  for (const ArmDescription& arm : arms()) {
    const RigStart start = in_the_middle(arm);
    Taps taps;
    taps.above = arm.dof() < 3 ? 0.005 : 0.02;  // arms of few joints stay near the line
    const Vec3 out = easiest(arm, start);
    const Spot spot = test::flat_spot(start.target - taps.above * out, out);
    for (const double wall : {600.0, 5000.0}) {
      taps.wall = wall;
      Scene scene;
      scene.add({"", pose_at(spot.place), Plane{out}, {wall}});
      for (const double eta : {1.0, 0.3}) {
        for (const double mass : {0.0, 0.2}) {
          Parameters p;
          p.kind = CouplingKind::predictive;
          p.eta = eta;
          p.torque_limit = 100;
          p.hand_stiffness = wall < 1000 ? 3000 : 300;
          p.hand_mass_at_tip = mass;
          const Felt felt = taps.felt(arm, scene, spot, p, start);
          SCOPED_TRACE(testing::Message() << arm.name << ", " << arm.dof() << " joints, " << wall
                                          << " N/m, eta " << eta << ", hand " << mass << " kg");
          EXPECT_LE(felt.energy, 0.05e-3);
          EXPECT_LE(felt.port, 0.05e-3);
          EXPECT_NEAR(felt.stiffness, 1, 0.01);
          EXPECT_LE(felt.chatter, mass > 0 ? 10e-3 : 0.1e-3);  // a mass rings on the wall
        }
      }
    }
  }
}

TEST(PredictiveArms, GiveNoEnergyInFreeMotionAndComeToRestWhereTheHandDoes) {
  for (const ArmDescription& arm : arms()) {
    const RigStart start = in_the_middle(arm);
    for (const bool light : {true, false}) {
      Parameters p;
      p.kind = CouplingKind::predictive;
      p.hand_stiffness = 3000;
      p.hand_damping = 0;
      p.torque_limit = 100;
      Rig rig(arm, Scene{});
      rig.start(p, start);
      Rows rows(rig.layout());
      test::Random random(5);
      double moving = 0, later = 0;  // fastest joint speed [rad/s]
      for (std::size_t k = 0; k < 5000; ++k) {
        const double t = static_cast<double>(k) * p.tick;
        const double swing = 0.01 * std::min(1.0, 4 * t) * std::clamp(4 * (2 - t), 0.0, 1.0);
        const Vec3 hand(std::sin(9 * t), std::sin(6 * t), std::sin(14 * t));
        p.eta = light ? random.between(0.1, 1) : 5;
        rig.step(p, {{start.target + swing * hand, 1}}, rows.add());
        const double speed = rows.vec(k, Column::device_velocity).norm();
        if (t < 2) moving = std::max(moving, speed);
        if (t > 4.5) later = std::max(later, speed);
        ASSERT_LE(rows.at(k, Column::energy_total), 1e-6) << arm.name << ' ' << arm.dof();
        ASSERT_LE(rows.at(k, Column::energy_port), 1e-6) << arm.name << ' ' << arm.dof();
      }
      // Joints that the hand does not hold by the tip are damped like the others.
      EXPECT_GT(moving, 0.5) << arm.name << ' ' << arm.dof();
      EXPECT_LT(later, 1e-3) << arm.name << ' ' << arm.dof();
    }
  }
}

// The links are so light that their motion dies out within a tick, which the predictor's rule takes
// for oscillation.
TEST(PredictiveArms, GiveNoEnergyWhereLinksAreLight) {
  for (const int dof : {5, 8, 15}) {
    ArmDescription arm = test::random_arm(dof, 3);
    for (Joint& joint : arm.joints) joint.damping = 0.012;
    for (Link& link : arm.links) {
      link.mass *= 0.03;
      link.inertia *= 0.03;
    }
    Parameters p;
    p.kind = CouplingKind::predictive;
    const RigStart start = in_the_middle(arm);
    Rig rig(arm, Scene{});
    rig.start(p, start);
    Rows rows(rig.layout());
    for (int k = 0; k < 8000 && !rig.diverged(); ++k) {
      const double t = k * p.tick;
      const Vec3 moved(0, 0.01 * std::sin(5 * t), 0.01 * std::sin(7 * t));
      rig.step(p, {{start.target + moved, 1}}, rows.add());
    }
    SCOPED_TRACE(testing::Message() << dof << " joints");
    EXPECT_FALSE(rig.diverged());
    double most = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      most = std::max(most, rows.at(k, Column::energy_total));
    }
    EXPECT_LE(most, 0.05e-3);
  }
}

}  // namespace
}  // namespace limpid
