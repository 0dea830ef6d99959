// Friction and damping of surfaces, under every coupling law and through a link: against Coulomb's
// law, the damper's law and the balance of energy, computed from the rows alone.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/dynamics/arm.h"
#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

using test::Rows;

constexpr double kTableStiffness = 300;  // [N/m]
const Vec3 kOnTable(0.19, 0, -0.04);

struct Case {
  std::string name;
  Parameters p;
};

// All laws; laws that know a link also with a delay of 3 ms each way.
std::vector<Case> laws() {
  std::vector<Case> cases;
  for (std::uint8_t i = 0; i < kLaws; ++i) {
    Parameters p;
    p.kind = static_cast<CouplingKind>(i);
    cases.push_back({kLawKeys[i], p});
    if (p.kind != CouplingKind::standard && p.kind != CouplingKind::tank) continue;
    p.link_delay = 3;
    cases.push_back({std::string(kLawKeys[i]) + " through a link", p});
  }
  return cases;
}

void add_plane(Scene& scene, const Vec3& normal, const Material& material) {
  scene.objects.emplace_back();
  scene.objects.back().shape.emplace<Plane>(Plane{normal});
  scene.objects.back().pose = pose_at(kOnTable);
  scene.objects.back().material = material;
}

Scene rough_table(double damping, double friction_static, double friction_kinetic) {
  Scene scene;
  add_plane(scene, Vec3::UnitZ(), {kTableStiffness, damping, friction_static, friction_kinetic});
  return scene;
}

Rows rows_of(const Parameters& p, const Scene& scene, double seconds,
             const std::function<Vec3(double)>& hand) {
  const ArmDescription arm = test::omni();
  Rig rig(arm, scene);
  rig.start(p, rest_at(arm, hand(0)));
  Rows rows(rig.layout());
  const auto ticks = static_cast<std::size_t>(seconds / p.tick);
  for (std::size_t k = 0; k < ticks; ++k) {
    rig.step(p, {{hand(static_cast<double>(k) * p.tick), 1}}, rows.add());
  }
  return rows;
}

Vec3 proxy_tip(const Rows& rows, std::size_t k) {
  static const Arm<3> arm(test::omni());
  return arm.tip_at(rows.vec(k, Column::proxy_position));
}

// Path 12 mm down in half a second, then at 25 mm/s along y.
Vec3 down_and_along(double t) {
  const double down = std::min(1.0, 2 * t), along = std::max(0.0, t - 1);
  return kOnTable + Vec3(0, 0.025 * along, 0.005 - 0.017 * down);
}

TEST(Surfaces, SlipWithTheirKineticFrictionAgainstTheMotionUnderEveryLaw) {
  for (const Case& c : laws()) {
    SCOPED_TRACE(c.name);
    const Rows rows = rows_of(c.p, rough_table(0, 0.6, 0.4), 3, down_and_along);
    double moved = 0;
    for (std::size_t k = 2000; k + 1 < rows.size(); ++k) {
      const Vec3 f = rows.force(k), v = proxy_tip(rows, k + 1) - proxy_tip(rows, k);
      ASSERT_GT(f.z(), 0.2) << k;
      ASSERT_NEAR(f.head<2>().norm(), 0.4 * f.z(), 1e-6 * f.z()) << k;
      ASSERT_LT(f.head<2>().dot(v.head<2>()), 0) << k;
      moved += v.y();
    }
    EXPECT_NEAR(moved, 0.025, 0.002);
  }
}

TEST(Surfaces, HoldAHandThatPullsWithLessThanTheirStaticFrictionUnderEveryLaw) {
  // The hand stays 1 mm to the side.
  const auto lean = [](double t) { return down_and_along(std::min(t, 1.04)); };
  for (const Case& c : laws()) {
    SCOPED_TRACE(c.name);
    const Rows rows = rows_of(c.p, rough_table(0, 1, 1), 4, lean);
    const std::size_t last = rows.size() - 1;
    const Vec3 f = rows.force(last);
    EXPECT_LT(f.y(), -0.02);
    EXPECT_LT(f.head<2>().norm(), 0.9 * f.z());
    const Vec3 crept = proxy_tip(rows, last) - proxy_tip(rows, last - 1000);
    EXPECT_LT(crept.norm(), 1e-5);
  }
}

// F (d' - d) = change of K d^2 / 2 + B (d' - d)^2 / T, the depth d before and d' after a tick.
TEST(Surfaces, DampWhatIsPressedInAndLetOutUnderEveryLaw) {
  constexpr double kDamping = 4;  // [N s/m]
  const auto hand = [](double t) {
    return Vec3(kOnTable + Vec3(0, 0, -0.01 + 0.004 * std::cos(12 * t)));
  };
  for (const Case& c : laws()) {
    SCOPED_TRACE(c.name);
    const Rows damped = rows_of(c.p, rough_table(kDamping, 0, 0), 2, hand);
    double most = 0;
    for (std::size_t k = 500; k + 1 < damped.size(); ++k) {
      const double d = kOnTable.z() - proxy_tip(damped, k).z();
      const double after = kOnTable.z() - proxy_tip(damped, k + 1).z();
      ASSERT_GT(std::min(d, after), 0) << k;
      const double damper = kDamping * (after - d) / c.p.tick;
      // The predictive law's walls have their own damper in addition.
      const double F = damped.force(k).z() - kTableStiffness * (d + after) / 2;
      if (c.p.kind == CouplingKind::predictive) {
        ASSERT_GE(F * damper, damper * damper - 1e-6) << k;
      } else {
        ASSERT_NEAR(F, damper, 1e-4) << k;
      }
      most = std::max(most, std::abs(damper));
    }
    EXPECT_GT(most, 0.02);
  }
}

struct SurfaceBooks {
  double most_gain = 0, lost = 0;  // most in a tick, and the total loss [J]
  int touched = 0;
  double unsettled = 0;  // ticks for which the proxy stood still
};
SurfaceBooks books(const Rows& rows) {
  SurfaceBooks b;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const double gain = rows.at(k, Column::contact_gain) - rows.at(k - 1, Column::contact_gain);
    b.most_gain = std::max(b.most_gain, gain);
    b.lost -= gain;
    b.touched += rows.touches(k).empty() ? 0 : 1;
    b.unsettled = rows.at(k, Column::unsettled);
  }
  return b;
}

TEST(Surfaces, ThatRubAndDampGiveNoEnergyUnderAnyLaw) {
  const auto hand = [](double t) {  // pressed with varying force, let go, and led to and fro
    return Vec3(kOnTable + Vec3(0.01 * std::sin(9 * t), 0.01 * std::sin(14 * t),
                                0.005 - 0.02 * std::min(1.0, 4 * t) + 0.012 * std::sin(23 * t)));
  };
  for (const Case& c : laws()) {
    SCOPED_TRACE(c.name);
    const SurfaceBooks b = books(rows_of(c.p, rough_table(2, 0.7, 0.5), 5, hand));
    EXPECT_LE(b.most_gain, 1e-9);
    EXPECT_EQ(b.unsettled, 0);
    EXPECT_GT(b.lost, 1e-3);
    EXPECT_GT(b.touched, 1000);
    EXPECT_LT(b.touched, 4990);
  }
}

// A single contact without friction, in a scene with friction elsewhere.
TEST(Surfaces, ThatAreSmoothBesideRoughOnesPushAsEver) {
  for (const Case& c : laws()) {
    SCOPED_TRACE(c.name);
    Scene scene;
    add_plane(scene, Vec3::UnitZ(), {kTableStiffness, 0, 0, 0});
    const Rows smooth = rows_of(c.p, scene, 2, down_and_along);
    add_plane(scene, -Vec3::UnitX(), {kTableStiffness, 0, 0.5, 0.5});
    scene.objects.back().pose = pose_at(kOnTable + Vec3(1, 0, 0));  // far behind
    const Rows beside = rows_of(c.p, scene, 2, down_and_along);
    const std::size_t last = smooth.size() - 1;
    EXPECT_EQ(beside.at(last, Column::unsettled), 0);
    EXPECT_GT(smooth.force(last).z(), 0.5);
    EXPECT_NEAR(beside.force(last).z(), smooth.force(last).z(), 0.01);
  }
}

TEST(Surfaces, ThatMakeEdgesAndCornersGiveNoEnergyEither) {
  test::Random random(7);
  for (int round = 0; round < 12; ++round) {
    Scene scene;
    for (int i = 0; i < 1 + round % 3; ++i) {
      const Vec3 normal(random.between(-1, 1), random.between(-1, 1), random.between(0.2, 1));
      const double stiffness = std::pow(10, random.between(2, 3.7));
      const double damping = random.between(0, 5), friction = random.between(0, 1.2);
      add_plane(scene, normal.normalized(),
                {stiffness, damping, friction, friction * random.between(0.3, 1)});
    }
    const Vec3 sway(random.between(-0.01, 0.01), random.between(-0.01, 0.01), 0.01);
    const Vec3 often(random.between(3, 20), random.between(3, 20), random.between(3, 20));
    const auto hand = [&](double t) {
      const Vec3 swung = sway.cwiseProduct(Vec3((often * t).array().sin()));
      return Vec3(kOnTable + Vec3(0, 0, 0.04 - 0.055 * std::min(1.0, 2 * t)) + swung);
    };
    for (const Case& c : laws()) {
      SCOPED_TRACE(testing::Message() << c.name << ", corner " << round);
      const SurfaceBooks b = books(rows_of(c.p, scene, 2, hand));
      EXPECT_LE(b.most_gain, 1e-9);
      EXPECT_EQ(b.unsettled, 0);
      EXPECT_GT(b.touched, 300);
    }
  }
}

}  // namespace
}  // namespace limpid
