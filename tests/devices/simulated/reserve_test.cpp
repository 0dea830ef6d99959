// The hand's energy reserve of a real device, under laws that account for it: only arming the force
// fills it up again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/fake_device.h"
#include "tests/support/random_arm.h"
#include "tests/support/rows.h"
#include "tests/support/wisher.h"

namespace limpid {
namespace {

constexpr double kE0 = 0.005;  // [J]

// A device in a wall, shaken faster than any law expects until little reserve is left.
class Reserve : public testing::TestWithParam<CouplingKind> {
 public:
  Reserve() : rig(arm, wall(), &device), rows(rig.layout()) {
    p.kind = GetParam();
    rig.start(p, rest_at(arm, Vec3(0.2, 0, -0.04)));
    armed = true;
    step(600);
    shakes = true;
    for (int k = 0; k < 20'000 && !(left() < 0.6 * kE0); ++k) step();
    shakes = false;
  }
  static Scene wall() {
    Scene scene;
    scene.add({"", pose_at(Vec3(0.2, 0, -0.04)), Plane{Vec3::UnitZ()}, {2000}});
    return scene;
  }
  void step(int ticks = 1) {
    for (int i = 0; i < ticks; ++i) {
      ++device.reading.count;
      const Vec3 shake = random.point(shakes ? 1e-3 : 1e-7);
      const Eigen::Vector3d x = x0 + Vec3(0, deep, deep) + shake;
      for (std::size_t j = 0; j < 3; ++j) {
        device.reading.x[j] = x[static_cast<Eigen::Index>(j)] + jump;
      }
      input.hand = {rig.tip(), 1};
      input.force = wisher.at(armed);
      rig.step(p, input, rows.add());
    }
  }
  double left() const {
    return rows.size() == 0 ? kE0 : rows.at(rows.size() - 1, Column::energy_ledger);
  }
  // Energy in the spring, and in all, as the last tick began [J].
  double in_spring() const {
    const Eigen::ArrayXd apart = rows.vec(rows.size() - 1, Column::measured_position) -
                                 rows.vec(rows.size() - 1, Column::proxy_position);
    double sum = 0;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double limit = arm.joints[static_cast<std::size_t>(i)].effort;
      const double a = std::abs(apart[i]), bent = std::min(a, limit / p.k_vc);
      sum += p.k_vc * bent * bent / 2 + limit * (a - bent);
    }
    return sum;
  }
  double stored() const {
    return in_spring() + rows.at(rows.size() - 1, Column::proxy_kinetic) +
           rows.at(rows.size() - 1, Column::contact_potential);
  }
  // Energy that nobody put in while there was no force. The tank's spring returns what its tank
  // has.
  double owed() const { return stored() - (GetParam() == CouplingKind::tank ? in_spring() : 0); }
  double torque() const { return rows.vec(rows.size() - 1, Column::motor_torque).norm(); }

  const ArmDescription arm = test::omni();
  const Eigen::Vector3d x0 = rest_at(arm, Vec3(0.2, 0, -0.04)).x1;
  test::FakeDevice device{3};
  Parameters p;
  Rig rig;
  test::Rows rows;
  test::Wisher wisher;
  RigInput input;
  bool armed = false;
  test::Random random{73};
  bool shakes = false;
  double jump = 0;     // of all joints [rad]
  double deep = 0.02;  // of the device in the wall [rad]
};
INSTANTIATE_TEST_SUITE_P(Laws, Reserve,
                         testing::Values(CouplingKind::predictive, CouplingKind::tank),
                         [](const auto& of) { return std::string(name(of.param)); });

TEST_P(Reserve, IsNotFilledWithoutForceAndIsFullOnceForceIsArmedAnew) {
  using Change = std::function<void(Reserve&, bool)>;
  const std::vector<std::pair<const char*, Change>> reasons{
      {"a stall, the reading before it",
       [](Reserve& r, bool on) {
         r.input.dt = on ? 0.008 : 0;
         r.input.periods = on ? 8 : 1;
         r.device.reading.age = on ? 0.006 : 0;
       }},
      {"an open hand switch", [](Reserve& r, bool on) { r.device.reading.hand = !on; }},
      {"unplugged", [](Reserve& r, bool on) { r.rig.plug(on ? nullptr : &r.device); }},
      {"a fault", [](Reserve& r, bool on) { r.device.reading.fault = on; }},
      {"too fast", [](Reserve& r, bool on) { r.jump += on ? 0.1 : -0.1; }},
      {"too far", [](Reserve& r, bool on) { r.rig.limit({.range = on ? 0.1 : 1}); }},
      {"a wrong reading", [](Reserve& r, bool on) { r.jump = on ? 7 : 0; }},
  };
  ASSERT_LT(left(), 0.6 * kE0);
  for (const auto& [what, change] : reasons) {
    SCOPED_TRACE(what);
    change(*this, true);
    step();
    ASSERT_EQ(torque(), 0);
    EXPECT_LT(left(), 0.7 * kE0);
    step(3);
    change(*this, false);
    step();
    EXPECT_LT(left(), 0.7 * kE0) << "as it goes on";
  }
  // After any trip, force is switched off and on again.
  armed = false;
  step(100);
  EXPECT_LT(left(), 0.7 * kE0) << "not yet";
  armed = true;
  step(2);
  EXPECT_LT(left(), kE0 - owed() + 1e-4) << "in the wall, which nobody has pressed";
  armed = false;
  step();
  deep = -0.01;
  step(300);
  armed = true;
  step(2);
  EXPECT_NEAR(left(), kE0, 2e-5) << "out of the wall";
}

// Any law may be in force when the device is armed.
TEST_P(Reserve, IsFullForALawThatTakesOverAfterForceWasArmedAnew) {
  ASSERT_LT(left(), 0.6 * kE0);
  const CouplingKind kind = p.kind;
  p.kind = CouplingKind::standard;
  step(10);
  armed = false;
  step(10);
  armed = true;
  step(10);
  p.kind = kind;
  step(2);
  const double stored_only = kE0 - owed();
  EXPECT_NEAR(left(), stored_only, 0.2 * kE0);
}

// A device that hardly moves is given nothing. So what is left grows only by what is stored no
// more, and tanks begin with no more than that and what they pay for, the spring.
TEST_P(Reserve, OfALawThatTakesOverIsWhatWasLeft) {
  ASSERT_LT(left(), 0.6 * kE0);
  const CouplingKind kind = p.kind;
  p.kind = CouplingKind::standard;
  step(5);  // after the last shake
  const double at_first = left() + stored();
  step(10);
  EXPECT_LT(left() + stored(), at_first + 1e-4);
  const double before = left(), spring = in_spring();
  p.kind = kind;
  step();
  const double of_tanks = kind == CouplingKind::tank ? spring : 0;
  EXPECT_LT(left(), std::min(before, kE0) + of_tanks + 1e-4);
}

TEST_P(Reserve, IsNotFilledByWhoArmsWhatIsArmed) {
  const double before = left();
  ASSERT_LT(before, 0.6 * kE0);
  input.force = ForceRequest::arm;
  rig.step(p, input, rows.add());
  rig.step(p, input, rows.add());
  EXPECT_NEAR(left(), before, 2e-4);
}

}  // namespace
}  // namespace limpid
