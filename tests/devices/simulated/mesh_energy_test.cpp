// Energy given and taken by meshes in the whole loop.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/dynamics/arm.h"
#include "core/dynamics/inverse_kinematics.h"
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

class MeshEnergy : public testing::TestWithParam<CouplingKind> {
 protected:
  static Parameters parameters() {
    Parameters p;
    p.kind = GetParam();
    return p;
  }
};
INSTANTIATE_TEST_SUITE_P(Couplings, MeshEnergy,
                         testing::Values(CouplingKind::standard, CouplingKind::proposed,
                                         CouplingKind::predictive));

// Bound of the error of the contacts' work in a tick while the same planes push: forces act along
// straight lines, while joints move the proxy along arcs.
double bend(const ArmDescription& arm, const Rows& rows, std::size_t k, double stiffness) {
  const double turn =
      (rows.vec(k, Column::proxy_position) - rows.vec(k - 1, Column::proxy_position)).lpNorm<1>();
  const double force = std::sqrt(
      2 * stiffness *
      std::max(rows.at(k, Column::contact_potential), rows.at(k - 1, Column::contact_potential)));
  return 0.5 * force * reach(arm) * turn * turn;
}

// Positions of the proxy's tip [m].
std::vector<Vec3> proxy_tips(const ArmDescription& description, const Rows& rows) {
  const Arm<3> arm(description);
  Arm<3>::Frames f;
  std::vector<Vec3> tips;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    arm.frames(rows.vec(k, Column::proxy_position), f);
    tips.push_back(arm.tip(f));
  }
  return tips;
}

// Damping of every contact in the predictive coupling: 0.2 m_n/T, the tip's mass at most 12.5 g [N
// s/m].
constexpr double kDamper = 2.5;

TEST_P(MeshEnergy, KeepsItsEnergyWhileTheSamePlanesPush) {
  const Triangles groove =
      test::height_field(8, 0.3, [](double x, double) { return 0.5 * std::abs(x); });
  const ArmDescription arm = test::omni();
  for (const bool flat : {true, false}) {
    const Scene scene = flat ? with_mesh(test::sheet(7, 0.5), Vec3(kHome.x(), 0, kTop))
                             : with_mesh(groove, Vec3(kHome.x(), 0, kTop - 0.005));
    const Path path = [&](double t) {  // along the groove, with varying depth
      Vec3 at = stroke(kTop - 0.008, 0)(t);
      const double u = std::max(0.0, t - 0.5);
      return Vec3(at + Vec3(0, 0.02 * std::sin(7 * u), 1e-3 * std::sin(31 * u)));
    };
    const Rows rows = run(scene, parameters(), path, 3);
    const std::vector<Vec3> tips = proxy_tips(arm, rows);
    double stored = 0;
    for (std::size_t k = 1000; k < rows.size(); ++k) {
      ASSERT_GT(rows.at(k, Column::contact_potential), 0);
      stored = std::max(stored, rows.at(k, Column::contact_potential));
      const double gain = rows.at(k, Column::contact_gain) - rows.at(k - 1, Column::contact_gain);
      const double rounding = bend(arm, rows, k, 600) + 1e-12 * stored;
      const double way = (tips[k] - tips[k - 1]).norm();
      const double damped =
          GetParam() == CouplingKind::predictive ? kDamper * way * way / parameters().tick : 0;
      ASSERT_LE(gain, rounding) << k;
      ASSERT_GE(gain, -rounding - damped) << k;
    }
    EXPECT_GT(stored, 1e-4);
  }
}

TEST_P(MeshEnergy, GivesNoMoreEnergyThanOfOneStepWhereItIsMadeBrokenAndSlidOver) {
  const ArmDescription arm = test::omni();
  const Path path = [](double t) {  // up and down throughout
    return Vec3(stroke(kTop, 0.03)(t) + Vec3(0, 0, 0.004 * std::sin(11 * t)));
  };
  for (const double stiffness : {600.0, 3000.0}) {
    const Scene scene = with_mesh(landscape(), Vec3(kHome.x(), 0, kTop - 0.004), stiffness);
    const Rows rows = run(scene, parameters(), path, 8);
    const std::vector<Vec3> tips = proxy_tips(arm, rows);
    int made = 0;
    for (std::size_t k = 2; k < rows.size(); ++k) {
      // Error of a spring met within a step of length s: K s^2 / 2; on a surface of curvature 1/r
      // that pushes with K d: K d s^2 / r.
      const double s = std::max((tips[k] - tips[k - 1]).norm(), (tips[k - 1] - tips[k - 2]).norm());
      const double U = std::max(rows.at(k, Column::contact_potential),
                                rows.at(k - 1, Column::contact_potential));
      const double depth = std::sqrt(2 * U / stiffness);
      const double step = stiffness * s * s * (0.5 + depth / kTip) + bend(arm, rows, k, stiffness);
      const double gain = rows.at(k, Column::contact_gain) - rows.at(k - 1, Column::contact_gain);
      ASSERT_LE(gain, step + 1e-12) << k << " s " << s << " d " << depth;
      made += rows.at(k - 1, Column::contact_potential) == 0 &&
              rows.at(k, Column::contact_potential) > 0;
    }
    EXPECT_GT(made, 10);
    // In total the mesh takes more energy than it gives.
    EXPECT_LT(rows.at(rows.size() - 1, Column::contact_gain), 0);
  }
}

TEST_P(MeshEnergy, IsLostOverHillsOnlyByALittleOfWhatIsStored) {
  // The hand presses throughout, over hill after hill and back.
  const Path path = [](double t) {
    const double u = std::max(0.0, t - 0.5);
    return Vec3(stroke(kTop - 0.008, 0)(t) +
                Vec3(0.02 * std::sin(3 * u), 0.01 * std::sin(2 * u), 0));
  };
  const Triangles hills = test::height_field(
      150, 0.2, [](double x, double y) { return 0.002 * std::sin(120 * x) * std::cos(100 * y); });
  const Rows rows = run(with_mesh(hills, Vec3(kHome.x(), 0, kTop)), parameters(), path, 5);
  double stored = 0;
  for (std::size_t k = 1000; k < rows.size(); ++k) {
    ASSERT_GT(rows.at(k, Column::contact_potential), 0) << k;
    stored = std::max(stored, rows.at(k, Column::contact_potential));
  }
  const double gained =
      rows.at(rows.size() - 1, Column::contact_gain) - rows.at(1000, Column::contact_gain);
  EXPECT_GT(stored, 1e-4);
  EXPECT_LT(gained, 0);
  EXPECT_GT(gained, -0.075 * stored);
}

bool produces_energy(const Rows& rows) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (rows.at(k, Column::energy_total) > 1e-4) return true;
  }
  return false;
}

TEST_P(MeshEnergy, IsStableWhereAPlaneAsStiffIs) {
  const Path path = stroke(kTop - 0.004, 0.03);
  int stable = 0;
  for (const double eta : {0.6, 1.0, 2.0}) {
    for (const double stiffness : {600.0, 1500.0, 3000.0}) {
      Scene plane;
      plane.tip_radius = kTip;
      plane.add({"", pose_at(Vec3(0, 0, kTop)), Plane{Vec3::UnitZ()}, stiffness});
      Parameters p = parameters();
      p.eta = eta;
      if (produces_energy(run(plane, p, path, 4))) continue;
      ++stable;
      const Scene scene = with_mesh(landscape(), Vec3(kHome.x(), 0, kTop), stiffness);
      const Rows rows = run(scene, p, path, 4);
      EXPECT_FALSE(produces_energy(rows)) << eta << ' ' << stiffness;
      EXPECT_GT(largest(rows, Column::contact_torque), 0.1);
    }
  }
  EXPECT_GE(stable, 6);
}

}  // namespace
}  // namespace limpid
