// Cost of a device's own forces in a coupling, and the benefit of compensating them.
#include "app/run/rehearsal.h"

#include <gtest/gtest.h>

#include "app/run/fitted_gains.h"
#include "tests/support/built_in.h"

namespace limpid {
namespace {

struct Bench {
  ArmDescription file = test::omni(), truth = unlike(file, 4, 0.03);
  Unlikeness bench = drawn_bench(file, 4, Vec3(0, 0, -9.81));
  ArmDescription known = truth;  // the result of a perfect identification

  Bench() {
    known.delay = 1e-3 * bench.delay;
    for (std::size_t j = 0; j < known.joints.size(); ++j) {
      known.joints[j].spring = bench.spring[static_cast<Eigen::Index>(j)];
      known.joints[j].offset = bench.offset[static_cast<Eigen::Index>(j)];
    }
  }
  Rehearsal with(const ArmDescription& believed, CouplingKind kind) const {
    Parameters p = fitted(believed);
    p.kind = kind;
    p.eta = 0.7;
    p.encoder_step = bench.encoder_step;
    static_cast<CompensationSettings&>(p) = suggested_compensation(believed);
    return rehearse(truth, bench, believed, p);
  }
};

TEST(Rehearsal, FeelsNothingOfAnArmThatHasNothing) {
  const ArmDescription arm = test::omni();
  Parameters p;
  p.kind = CouplingKind::standard;
  const Rehearsal r = rehearse(arm, {}, arm, p);
  EXPECT_TRUE(r.force);
  EXPECT_NEAR(r.slope, 1 / p.k_vc, 2e-3) << "the standard coupling's spring";
  EXPECT_NEAR(r.friction, 0, 1e-4);
  EXPECT_NEAR(r.weight, 0, 1e-4);
  EXPECT_LE(r.energy, 1e-5);
}

TEST(Rehearsal, FeelsTheWeightAndFrictionThatThereIs) {
  ArmDescription arm = test::omni();
  for (Joint& joint : arm.joints) joint.friction = 0.01;
  Unlikeness bench;
  bench.offset = Eigen::Vector3d::Constant(0.05);
  bench.spring = Eigen::Vector3d::Zero();
  Parameters p;
  p.kind = CouplingKind::standard;
  const Rehearsal r = rehearse(arm, bench, arm, p);
  EXPECT_NEAR(r.friction, 0.01, 1e-3);
  EXPECT_NEAR(r.weight, 0.05, 2e-3);
}

TEST(Rehearsal, IsBetterWithWhatWasFoundOfTheDevice) {
  const Bench device;
  for (const auto kind : {CouplingKind::proposed, CouplingKind::predictive}) {
    const Rehearsal before = device.with(device.file, kind),
                    after = device.with(device.known, kind);
    EXPECT_TRUE(after.force);
    EXPECT_LT(after.off, before.off / 3) << name(kind);
    EXPECT_LT(after.weight, 0.02 * before.weight) << name(kind);
    EXPECT_LT(after.friction, 0.7 * before.friction) << name(kind);
    EXPECT_LT(after.energy, 1e-3) << name(kind);
    EXPECT_LT(after.slope, 0.003) << name(kind);
  }
}

}  // namespace
}  // namespace limpid
