// Unusual uses of bodies that no scene was made for.
#include <gtest/gtest.h>

#include <cmath>

#include "core/tick/parameters.h"
#include "devices/simulated/rig.h"
#include "tests/support/body_scenes.h"
#include "tests/support/meshes.h"
#include "tests/support/rows.h"

namespace limpid::test {
namespace {

struct Books {
  double energy = 0;  // highest E_c [J]
  double beyond = 0;  // most energy to the hand beyond what bodies gave [J]
  double gain = 0;    // most energy that the bodies' world made [J]
  void see(const Rows& rows, std::size_t k) {
    energy = std::max(energy, rows.at(k, Column::energy_total));
    beyond =
        std::max(beyond, rows.at(k, Column::energy_port) + rows.at(k, Column::energy_to_objects));
    gain = std::max(gain, rows.at(k, Column::objects_gain));
  }
};

Parameters default_predictive() {
  Parameters p;
  p.kind = CouplingKind::predictive;
  return p;
}

// The test changes everything that the panel can change while the tip pushes: stiffness, mass and
// shape of touched and other objects; objects come and go.
TEST(BodyLimits, SceneEditsWhileTouchingGiveNothingAndNeverJump) {
  const ArmDescription arm = omni();
  const BodyKind kind;
  Scene scene;
  scene.tip_radius = 0.004;
  scene.add(floor_below(-0.03));
  scene.add(cube("pushed", Vec3::Constant(0.03), {0.18, 0.03, -0.015}, kind));
  scene.add(cube("beside", Vec3::Constant(0.02), {0.23, 0.03, -0.02}, kind));
  const Parameters p = default_predictive();
  Rig rig(arm, scene);
  const auto hand = [](std::size_t k) {
    return Vec3(0.18, -0.01 + 2e-5 * std::min(static_cast<double>(k), 2500.0), -0.017);
  };
  rig.start(p, rest_at(arm, hand(0)));
  Rows rows(rig.layout());
  std::vector<std::unique_ptr<TouchWorld>> worlds;
  const auto edit = [&](int step) {
    Object& pushed = scene.objects[1];
    Object& beside = scene.objects[2];
    if (step % 6 == 0) pushed.material.stiffness *= step % 12 == 0 ? 2 : 0.5;
    if (step % 6 == 1) beside.body->mass *= 1.1;
    if (step % 6 == 2) pushed.body->contact_stiffness *= step % 12 == 2 ? 2 : 0.5;
    if (step % 6 == 3) pushed.body->mass = step % 12 == 3 ? 0.08 : 0.05;  // the body begins anew
    if (step % 6 == 4) beside.parts.push_back({pose_at({0, 0, 0.02}), Sphere{0.01}});
    if (step % 6 == 5) beside.parts.clear();
    worlds.push_back(std::make_unique<TouchWorld>(arm, scene));
    rig.exchange(*worlds.back());
  };
  Books books;
  int touched = 0;
  for (std::size_t k = 0; k < 4000; ++k) {
    if (k >= 1000 && k % 150 == 0) edit(static_cast<int>(k / 150));
    rig.step(p, {{hand(k), 1}}, rows.add());
    ASSERT_FALSE(rig.diverged()) << k;
    books.see(rows, k);
    touched += !rows.vec(k, Column::contact_torque).isZero(0);
    if (k == 0) continue;
    for (int joint = 0; joint < 3; ++joint) {
      const double limit = arm.joints[static_cast<std::size_t>(joint)].effort;
      ASSERT_LE(std::abs(rows.vec(k, Column::motor_torque)[joint] -
                         rows.vec(k - 1, Column::motor_torque)[joint]),
                0.2 * limit)
          << k;
    }
  }
  EXPECT_GT(touched, 1000);
  EXPECT_LT(books.gain, 1e-6);
  EXPECT_LT(books.energy, 5e-5);
  EXPECT_LT(books.beyond, 1e-3);
}

// The hand presses a body between the tip and the table as hard as it can, and lets go.
TEST(BodyLimits, ABodyIsPressedOntoTheTableAndGivesNothing) {
  const ArmDescription arm = omni();
  for (const double stiffness : {600.0, 2000.0, 5000.0}) {
    for (const double mass : {0.005, 0.05, 0.5}) {
      Scene scene;
      scene.tip_radius = 0.004;
      scene.add(floor_below(-0.04));
      scene.add(cube("block", {0.03, 0.03, 0.02}, {0.18, 0, -0.03}, {mass, stiffness, 0.5}));
      Parameters p = default_predictive();
      p.hand_stiffness = 600;
      Rig rig(arm, scene);
      const auto hand = [](std::size_t k) {
        return Vec3(0.18, 0,
                    -0.01 - 0.01 * std::sin(M_PI * std::min(static_cast<double>(k) / 2000, 1.0)));
      };
      rig.start(p, rest_at(arm, hand(0)));
      Rows rows(rig.layout());
      Books books;
      double hardest = 0, lowest = 0;
      for (std::size_t k = 0; k < 2500; ++k) {
        rig.step(p, {{hand(k), 1}}, rows.add());
        books.see(rows, k);
        hardest = std::max(hardest, rows.vec(k, Column::contact_force).head<3>().norm());
        lowest = std::min(lowest, rows.vec(k, Column::body_pose)[2]);
      }
      EXPECT_GT(hardest, 1) << stiffness << " " << mass;
      EXPECT_GT(lowest, -0.031) << stiffness << " " << mass;
      EXPECT_NEAR(rows.vec(2499, Column::body_pose)[2], -0.03, 2e-4) << stiffness << " " << mass;
      EXPECT_LT(books.gain, 1e-6) << stiffness << " " << mass;
      EXPECT_LT(books.energy, 5e-5) << stiffness << " " << mass;
      EXPECT_LT(books.beyond, 5e-5) << stiffness << " " << mass;
    }
  }
}

// A ring of a hundred thousand triangles: the tip touches the model, the table its hull.
TEST(BodyLimits, ALargeModelFallsIsPushedAndGivesNothing) {
  const ArmDescription arm = omni();
  Scene scene;
  scene.tip_radius = 0.004;
  scene.add(floor_below(-0.04));
  Object ring = obstacle(torus(320, 160, 0.02, 0.006), 1000);
  ASSERT_GT(mesh_of(ring).triangles->triangles(), 100000u);
  ring.name = "ring";
  ring.pose = pose_at({0.18, 0.03, -0.02});
  ring.body = Body{};
  ring.body->mass = 0.03;
  scene.add(ring);
  const Parameters p = default_predictive();
  Rig rig(arm, scene);
  const auto hand = [](std::size_t k) {
    return Vec3(0.18, -0.01 + 2e-5 * std::clamp(static_cast<double>(k) - 500, 0.0, 1500.0), -0.033);
  };
  rig.start(p, rest_at(arm, hand(0)));
  Rows rows(rig.layout());
  Books books;
  for (std::size_t k = 0; k < 2500; ++k) {
    rig.step(p, {{hand(k), 1}}, rows.add());
    books.see(rows, k);
  }
  const Eigen::VectorXd pose = rows.vec(2499, Column::body_pose);
  EXPECT_GT(pose[1], 0.035);
  EXPECT_NEAR(pose[2], -0.034, 3e-4);
  EXPECT_LT(books.gain, 1e-6);
  EXPECT_LT(books.energy, 5e-5);
  EXPECT_LT(books.beyond, 5e-5);
}

}  // namespace
}  // namespace limpid::test
