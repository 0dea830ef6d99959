// Laws that take over from one another while the hand presses: none returns what another one owes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

using test::Random;

// A hand that goes slowly into a wall and out again, while laws take turns.
struct Turns {
  std::vector<CouplingKind> laws;
  double every;  // [s]
  double wall;   // [N/m]
  double depth;  // of the hand's target [m]
  double pace;   // of the hand [rad/s]; 0: it holds still
  Parameters p;

  // Most energy that the hand was given since the start [J].
  double given(double seconds) const {
    const ArmDescription arm = test::omni();
    const Vec3 start(0.19, 0, 0);
    Scene scene;
    scene.add({"", pose_at(start - Vec3(0, 0, 0.002)), Plane{Vec3::UnitZ()}, {wall}});
    Rig rig(arm, scene);
    rig.start(p, rest_at(arm, start));
    test::Rows rows(rig.layout());
    Parameters now = p;
    double most = 0;
    for (std::size_t k = 0; static_cast<double>(k) * p.tick < seconds; ++k) {
      const double t = static_cast<double>(k) * p.tick;
      now.kind = laws[static_cast<std::size_t>(t / every) % laws.size()];
      const double way = pace > 0 ? (1 - std::cos(pace * t)) / 2 : std::min(1.0, t);
      rig.step(now, {{start - depth * way * Vec3::UnitZ(), 1}}, rows.add());
      most = std::max(most, rows.at(k, Column::energy_port));
    }
    EXPECT_FALSE(rig.diverged());
    return most;
  }
};

TEST(Switches, GiveAHandThatHoldsStillNoMoreThanTheAccountsStartWith) {
  constexpr auto kStandard = CouplingKind::standard, kPredictive = CouplingKind::predictive,
                 kTank = CouplingKind::tank;
  for (const std::vector<CouplingKind>& laws : {std::vector{kPredictive, kTank},
                                                {kStandard, kTank},
                                                {kStandard, kPredictive},
                                                {kTank, kStandard, kPredictive}}) {
    Parameters p;
    p.hand_stiffness = 300;
    p.hand_damping = 2;
    EXPECT_LE((Turns{laws, 0.25, 2000, 0.02, 0, p}.given(16)), p.energy) << name(laws[0]);
  }
}

// For up to 0.2 s after a switch the torque changes slowly, whatever the account asks for: 1 mJ
// more.
TEST(Switches, BetweenLawsWithAnAccountGiveAHandThatMovesNoMore) {
  for (unsigned seed = 1; seed <= 80; ++seed) {
    Random random(seed);
    Turns turns{{CouplingKind::tank, CouplingKind::predictive},
                random.log_between(0.02, 0.5),
                random.log_between(200, 5000),
                random.between(0.005, 0.03),
                random.one_of({0.0, 1.0}) * random.log_between(0.5, 8),
                {}};
    turns.p.hand_stiffness = random.log_between(50, 1000);
    turns.p.hand_damping = random.one_of({0.0, 2.0});
    turns.p.eta = random.log_between(0.2, 5);
    EXPECT_LE(turns.given(6), turns.p.energy + 0.001) << "seed " << seed;
  }
}

}  // namespace
}  // namespace limpid
