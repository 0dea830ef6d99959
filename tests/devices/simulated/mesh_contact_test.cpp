// The whole loop against meshes: compared with planes, boxes and balls; repetition and exchange.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/support/mesh_runs.h"

namespace limpid {
namespace {

using test::kHome;
using test::kTip;
using test::kTop;
using test::landscape;
using test::largest;
using test::Path;
using test::Rows;
using test::run;
using test::stroke;
using test::Triangles;
using test::with_mesh;

double largest_difference(const Rows& a, const Rows& b, Column c) {
  double largest = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    largest = std::max(largest, (a.vec(k, c) - b.vec(k, c)).norm());
  }
  return largest;
}

class MeshInEveryCoupling : public testing::TestWithParam<CouplingKind> {
 protected:
  static Parameters parameters() {
    Parameters p;
    p.kind = GetParam();
    // Disables the second predictor: between equally good ones the smallest difference decides.
    p.hand_mass = 0;
    return p;
  }
};
INSTANTIATE_TEST_SUITE_P(Couplings, MeshInEveryCoupling,
                         testing::Values(CouplingKind::standard, CouplingKind::proposed,
                                         CouplingKind::predictive));

TEST_P(MeshInEveryCoupling, ThatIsFlatIsFeltAsAPlane) {
  Scene plane;
  plane.tip_radius = kTip;
  plane.add({"", pose_at(Vec3(0, 0, kTop)), Plane{Vec3::UnitZ()}, 600});
  // A mesh finds the moment of contact to a thousandth of the tick: so much of the damper's force,
  // 2.5 N s/m at 0.1 m/s and 0.2 m from the joints.
  const double bound = GetParam() == CouplingKind::predictive ? 5e-5 : 1e-10;
  for (const int cells : {1, 37}) {
    const Scene mesh = with_mesh(test::sheet(cells, 0.5), Vec3(0.2, 0.01, kTop));
    const Path path = stroke(kTop - 0.003, 0.02);
    const Rows a = run(plane, parameters(), path, 3), b = run(mesh, parameters(), path, 3);
    EXPECT_GT(largest(a, Column::contact_torque), 0.1);
    for (const Column c : {Column::contact_torque, Column::proxy_position, Column::motor_torque,
                           Column::contact_potential, Column::contact_gain}) {
      EXPECT_LT(largest_difference(a, b, c), bound) << static_cast<int>(c);
    }
  }
}

TEST_P(MeshInEveryCoupling, OfABoxIsFeltAsThatBox) {
  Scene box;
  box.tip_radius = kTip;
  const Vec3 size(0.05, 0.04, 0.06), at(kHome.x(), 0, kTop - 0.03);
  box.add({"", pose_at(at), Box{size}});
  const Scene mesh = with_mesh(test::box(size, 3), at);
  const Path path = stroke(kTop + 0.0025, 0.035);  // across the edges, in by less than the tip
  const Rows a = run(box, parameters(), path, 4), b = run(mesh, parameters(), path, 4);
  const double most = largest(a, Column::contact_torque);
  EXPECT_GT(most, 0.04);
  EXPECT_LT(largest_difference(a, b, Column::contact_torque), 0.03 * most);
  EXPECT_LT(largest_difference(a, b, Column::proxy_position), 1e-3);
}

TEST_P(MeshInEveryCoupling, OfABallIsFeltAsThatBall) {
  constexpr double kRadius = 0.03;
  Scene ball;
  ball.tip_radius = kTip;
  ball.add({"", pose_at(Vec3(kHome.x(), 0, kTop - kRadius)), Sphere{kRadius}, 600});
  const Triangles fine =
      test::icosphere(6).mapped([&](const Vec3& p) { return Vec3(kRadius * p); });
  const Scene mesh = with_mesh(fine, ball.objects[0].pose.translation());
  const Path path = stroke(kTop + 0.002, 0.01);
  const Rows a = run(ball, parameters(), path, 4), b = run(mesh, parameters(), path, 4);
  const double most = largest(a, Column::contact_torque);
  EXPECT_GT(most, 0.04);
  // Facets of half a millimetre, tilted by up to a hundredth.
  EXPECT_LT(largest_difference(a, b, Column::contact_torque), 0.03 * most);
}

const Vec3 kBody(0.18, 0, -0.1);  // middle of the body
constexpr double kBodySize = 0.05, kBump = 0.1;

Scene link_over_a_body() {
  Scene scene = with_mesh(
      test::bumpy_body(5, kBump).mapped([](const Vec3& p) { return Vec3(kBodySize * p); }), kBody);
  const ArmDescription arm = test::omni();
  scene.probes.push_back({"link", 2, Vec3::Zero(), arm.tip.translation(), 0.006});
  return scene;
}

// Distance of a point outside of the body that the mesh approximates, along its radius [m].
double outside(const Vec3& p) {
  const Vec3 from = p - kBody;
  return from.norm() - kBodySize * test::bumpy_radius(from.normalized(), kBump);
}

// Outward normal of that body.
Vec3 normal_of_body(const Vec3& p) {
  constexpr double h = 1e-6;
  Vec3 slope;
  for (int i = 0; i < 3; ++i) {
    slope[i] = outside(p + h * Vec3::Unit(i)) - outside(p - h * Vec3::Unit(i));
  }
  return slope.normalized();
}

TEST(MeshContact, IsMadeByCapsulesInSeveralPlacesAtOnce) {
  const ArmDescription arm = test::omni();
  Rig rig(arm, link_over_a_body());
  const Parameters p;
  const Path path = stroke(-0.07, 0.01);
  rig.start(p, rest_at(arm, path(0)));
  Rows rows(rig.layout());
  std::size_t most = 0;
  for (int k = 0; k < 3000; ++k) {
    rig.step(p, {{path(1e-3 * k), 1}}, rows.add());
    const auto touches = rows.touches(rows.size() - 1);
    most = std::max(most, touches.size());
    for (const Rows::Touch& touch : touches) {
      ASSERT_TRUE(touch.force.allFinite());
      // The point lies on the surface, with facets a millimetre across; the force is straight out
      // of it.
      EXPECT_NEAR(outside(touch.point), 0, 1e-4);
      EXPECT_GT(touch.force.dot(normal_of_body(touch.point)), 0.99 * touch.force.norm());
    }
  }
  EXPECT_GE(most, 2u);
  EXPECT_FALSE(rig.diverged());
}

TEST_P(MeshInEveryCoupling, IsRepeatedToTheLastBit) {
  const ArmDescription arm = test::omni();
  const Scene scene = link_over_a_body();
  const Path path = stroke(-0.06, 0.02);
  const Parameters p = parameters();
  Rig first(arm, scene);
  first.start(p, rest_at(arm, path(0)));
  Rows before(first.layout());
  int k = 0;
  for (; k < 900 || !first.steady(); ++k) {
    first.step(p, {{path(1e-3 * k), 1}}, before.add());
  }
  // A recording begins in the middle of the contact, and is run again from its first row.
  RigStart present = rest_at(arm, path(0));
  first.present(present);
  present.target = path(1e-3 * k);
  first.start(p, present);
  Rig second(arm, scene);
  Rows recorded(first.layout()), again(first.layout());
  for (int i = 0; i < 1500; ++i) {
    const RigInput input{{path(1e-3 * (k + i)), 1}};
    first.step(p, input, recorded.add());
    if (i == 0) second.start(p, start_of(first.layout(), recorded.row(0)));
    second.step(p, input, again.add());
  }
  EXPECT_GT(recorded.vec(0, Column::contact_torque).norm(), 0.01);
  EXPECT_EQ(test::first_difference(recorded, again), -1);
}

TEST_P(MeshInEveryCoupling, GoesOnWhenTheWorldIsExchangedForTheSame) {
  const ArmDescription arm = test::omni();
  // The mesh is open: it has a side to forget.
  const Scene scene = with_mesh(landscape(), Vec3(kHome.x(), 0, kTop));
  const Path path = stroke(kTop - 0.01, 0.02);
  const Parameters p = parameters();
  Rig left(arm, scene), right(arm, scene);
  TouchWorld same(arm, scene);
  left.start(p, rest_at(arm, path(0)));
  right.start(p, rest_at(arm, path(0)));
  Rows a(left.layout()), b(left.layout());
  for (int k = 0; k < 2500; ++k) {
    if (k == 1200) right.exchange(same);
    const RigInput input{{path(1e-3 * k), 1}};
    left.step(p, input, a.add());
    right.step(p, input, b.add());
  }
  EXPECT_GT(a.vec(1200, Column::contact_torque).norm(), 0.1);
  EXPECT_EQ(test::first_difference(a, b), -1);
}

TEST_P(MeshInEveryCoupling, GetsToAnotherStiffnessWithoutAJump) {
  const ArmDescription arm = test::omni();
  const Path path = stroke(kTop - 0.004, 0);
  const Parameters p = parameters();
  Scene scene = with_mesh(test::sheet(5, 0.2), Vec3(kHome.x(), 0, kTop), 600);
  Rig rig(arm, scene);
  scene.objects[0].material.stiffness = 1200;
  TouchWorld stiffer(arm, scene);
  rig.start(p, rest_at(arm, path(0)));
  Rows rows(rig.layout());
  for (int k = 0; k < 2000; ++k) {
    if (k == 1200) rig.exchange(stiffer);
    rig.step(p, {{path(1e-3 * k), 1}}, rows.add());
  }
  // The torque rises to its limit in a tenth of a second.
  for (int joint = 0; joint < 3; ++joint) {
    const double limit = arm.joints[static_cast<std::size_t>(joint)].effort;
    const double jump =
        rows.vec(1200, Column::motor_torque)[joint] - rows.vec(1199, Column::motor_torque)[joint];
    EXPECT_LE(std::abs(jump), limit * p.tick / 0.1 * (1 + 1e-12));
  }
  EXPECT_GT(rows.vec(1999, Column::contact_torque).norm(),
            1.05 * rows.vec(1199, Column::contact_torque).norm());
}

}  // namespace
}  // namespace limpid
