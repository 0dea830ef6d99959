// Meshes of several shapes under a tapping hand in the predictive coupling.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/mesh_runs.h"
#include "tests/support/taps.h"

namespace limpid {
namespace {

using test::Felt;
using test::kTip;
using test::Spot;
using test::Taps;
using test::with_mesh;

const Vec3 kAt(0.2, 0, -0.04);
constexpr double kRadius = 0.03;  // of ball and bowl [m]

struct Tapped {
  const char* name;
  Scene scene;
  Spot spot;
  bool slips = false;  // a soft grip slides off
};

Tapped ball(double wall) {
  const Vec3 middle = kAt - kRadius * Vec3::UnitZ();
  const auto triangles = test::icosphere(6).mapped([](const Vec3& p) { return Vec3(kRadius * p); });
  return {"ball",
          with_mesh(triangles, middle, wall),
          {kAt + kTip * Vec3::UnitZ(), Vec3::UnitZ(),
           [=](const Vec3& tip) { return kRadius + kTip - (tip - middle).norm(); }}};
}

Tapped bowl(double wall) {
  const Vec3 middle = kAt + kRadius * Vec3::UnitZ();
  const auto triangles = test::height_field(60, 0.04, [](double x, double y) {
    return kRadius - std::sqrt(kRadius * kRadius - x * x - y * y);
  });
  return {"bowl",
          with_mesh(triangles, kAt, wall),
          {kAt + kTip * Vec3::UnitZ(), Vec3::UnitZ(),
           [=](const Vec3& tip) { return (tip - middle).norm() + kTip - kRadius; }}};
}

// Two faces meet in a crease: the tip rests on both, and beneath it is pulled back to the crease.
Tapped valley(double slope, double wall) {
  const auto triangles =
      test::height_field(8, 0.1, [=](double x, double) { return slope * std::abs(x); });
  return {"valley", with_mesh(triangles, kAt, wall),
          test::flat_spot(kAt + kTip * std::hypot(1, slope) * Vec3::UnitZ(), Vec3::UnitZ())};
}

// A box that stands on its edge.
Tapped edge(double wall) {
  constexpr double kSize = 0.04;
  Scene scene = with_mesh(test::box(Vec3::Constant(kSize), 2), Vec3::Zero(), wall);
  Pose& pose = scene.objects[0].pose;
  pose.linear() = Eigen::AngleAxisd(std::numbers::pi / 4, Vec3::UnitY()).toRotationMatrix();
  pose.translation() = kAt - kSize / std::numbers::sqrt2 * Vec3::UnitZ();
  const auto depth = [](const Vec3& tip) {
    return kTip - std::hypot(tip.x() - kAt.x(), tip.z() - kAt.z());
  };
  return {"edge", scene, {kAt + kTip * Vec3::UnitZ(), Vec3::UnitZ(), depth}, true};
}

Tapped sheet(double side, double wall) {
  const Vec3 out = side * Vec3::UnitZ();
  return {side > 0 ? "sheet" : "sheet from below", with_mesh(test::sheet(7, 0.1), kAt, wall),
          test::flat_spot(kAt + kTip * out, out)};
}

std::vector<Tapped> shapes(double wall) {
  return {ball(wall), bowl(wall),     valley(1, wall), valley(0.3, wall),
          edge(wall), sheet(1, wall), sheet(-1, wall)};
}

class MeshTaps : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(EncoderSteps, MeshTaps, testing::Values(0, 1e-4));

TEST_P(MeshTaps, AreFeltAsTheyAreSetAndGiveTheHandNoEnergy) {
  const double step = GetParam();
  for (const double wall : {600.0, 2000.0, 5000.0}) {
    for (const Tapped& shape : shapes(wall)) {
      for (const double mass : {0.0, 0.2}) {
        for (const double grip : {300.0, 3000.0}) {
          Parameters p;
          p.kind = CouplingKind::predictive;
          p.eta = 0.3;
          p.torque_limit = 100;
          p.encoder_step = step;
          p.hand_mass_at_tip = mass;
          p.hand_stiffness = grip;
          Taps taps;
          taps.wall = wall;
          taps.press = wall < 1000 ? 2 : 4;  // in by less than the tip's radius
          const Felt felt = taps.felt(test::omni(), shape.scene, shape.spot, p);
          SCOPED_TRACE(testing::Message() << shape.name << ", " << wall << " N/m, hand " << mass
                                          << " kg, grip " << grip << " N/m");
          EXPECT_LE(felt.port, 0.05e-3);
          EXPECT_LE(felt.energy, step > 0 ? 4e-3 : 0.05e-3);
          EXPECT_LE(felt.chatter, step > 0 ? 20e-3 : mass > 0 ? 4e-3 : 0.1e-3);
          const bool stays = !shape.slips || grip > 1000;
          EXPECT_TRUE(!stays || std::abs(felt.stiffness - 1) <= 0.01) << felt.stiffness;
        }
      }
    }
  }
}

}  // namespace
}  // namespace limpid
