// Faults of a run that must be reported.
#include "app/run/run_watch.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "app/run/recorder.h"
#include "app/run/replay.h"
#include "devices/files/session/hdf5_reading.h"
#include "tests/app/run/recorded.h"
#include "tests/support/random_arm.h"
#include "tests/support/temp_dir.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Rows of the built-in arm at rest, with energies set by the test.
class Watched {
 public:
  explicit Watched(const Parameters& p = {}) : watch(test::omni(), layout, p) { go_to(0, 1); }

  // Moves E_c evenly to `energy` [J] in so many ticks, with a motor's torque of `torque` [N m].
  void go_to(double energy, int count, double torque = 0) {
    const double from = energy_;
    for (int i = 1; i <= count; ++i) {
      energy_ = from + (energy - from) * i / count;
      std::vector<double> row(static_cast<std::size_t>(layout.stride()), 0.0);
      layout.in(std::span(row), Column::time)[0] = 0.001 * static_cast<double>(rows);
      layout.in(std::span(row), Column::energy_total)[0] = energy_;
      layout.in(std::span(row), Column::energy_port)[0] = given;
      layout.in(std::span(row), Column::contact_gain)[0] = from_contacts;
      layout.in(std::span(row), Column::motor_torque)[0] = torque;
      layout.in(std::span(row), Column::commanded_torque)[0] = torque;
      layout.in(std::span(row), Column::device_velocity)[0] = speed;
      watch.add(row);
      ++rows;
    }
  }

  RowLayout layout{3};
  RunWatch watch;
  std::uint64_t rows = 0;
  double speed = 0;          // speed of the first joint [rad/s]
  double given = 0;          // to the hand [J]
  double from_contacts = 0;  // [J]

 private:
  double energy_ = 0;  // [J]
};

TEST(RunWatch, SaysHowMuchEnergyTheCouplingGaveAndSinceWhen) {
  Watched run;
  run.go_to(-0.2, 100);
  EXPECT_THAT(run.watch.warnings(), IsEmpty());
  run.go_to(15, 1520);
  const auto warnings = run.watch.warnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("15 J"));
  EXPECT_THAT(warnings[0], HasSubstr("not passive (proposed, eta 1)"));
  // E_c rises by 10 mJ a tick, from -0.2 J in row 100: above 1 mJ in row 121.
  EXPECT_THAT(warnings[0], HasSubstr("t = 0.121 s"));
}

TEST(RunWatch, TakesAMillijouleForNoise) {
  Watched run;
  run.go_to(0.9e-3, 100);
  EXPECT_THAT(run.watch.warnings(), IsEmpty());
}

// Energy bounding promises nothing of E_c, which the device's damping takes up.
TEST(RunWatch, JudgesALawOfThePortByWhatTheHandIsGiven) {
  Parameters p;
  p.kind = CouplingKind::eba;
  Watched run(p);
  run.go_to(0.05, 100);
  EXPECT_THAT(run.watch.warnings(), IsEmpty());
  run.given = 0.003;
  run.go_to(0.05, 1);
  EXPECT_THAT(run.watch.warnings(),
              ElementsAre("the hand was given 3 mJ, above the limit since t = 0.101 s: this run is "
                          "not passive (eba)"));

  // A law that follows is not blamed for what came before, and is for its own.
  Watched changed(p);
  Parameters standard;
  standard.kind = CouplingKind::standard;
  changed.watch.change(101, standard);
  changed.go_to(0.05, 1000);
  EXPECT_THAT(changed.watch.warnings(), testing::Contains(HasSubstr("E_c rose to 45 mJ")));
  EXPECT_THAT(changed.watch.warnings(), testing::Contains(HasSubstr("(standard)")));
}

TEST(RunWatch, SaysWhatContactsGaveByThemselves) {
  Watched run;
  run.from_contacts = 4.9e-3;
  run.go_to(0, 10);
  EXPECT_THAT(run.watch.warnings(), IsEmpty());
  run.from_contacts = 19e-3;
  run.go_to(0, 10);
  run.from_contacts = 2e-3;
  run.go_to(0, 10);
  EXPECT_THAT(
      run.watch.warnings(),
      ElementsAre("contacts gave 19 mJ by themselves, above the limit since t = 0.011 s, as "
                  "corners of surfaces whose stiffness differs do (proposed, eta 1)"));
}

// A floor and a ramp of very different stiffness, and a tip that circles deep below their edge.
TEST(RunWatch, HearsACornerOfSurfacesWhoseStiffnessDiffers) {
  RunPlan plan = test::plan("free.toml", "free.csv", 4);
  const Vec3 edge(0.19, 0, -0.03);
  std::vector<double> times;
  std::vector<Vec3> places;
  for (int k = 0; k <= 4000; ++k) {
    const double t = 1e-3 * k, angle = 2 * M_PI * 1.5 * std::max(0.0, t - 0.5);
    times.push_back(t);
    places.push_back(edge + 0.01 * Vec3(0, std::sin(angle), 0.3 - std::cos(angle)) +
                     Vec3(0, 0, 0.02 * std::max(0.0, 1 - 2 * t)));
  }
  plan.hand = hand_through(times, places, "circles");
  for (const double ramps : {203.0, 1420.0}) {
    Scene& scene = plan.document.scene;
    scene = {};
    scene.tip_radius = 0.003;
    scene.add({.pose = pose_at(edge), .shape = Plane{}, .material = {.stiffness = 1420}});
    Object ramp{.shape = Box{Vec3(0.1, 0.1, 0.1)}, .material = {.stiffness = ramps}};
    ramp.pose.linear() = Eigen::AngleAxisd(-1.19, Vec3::UnitX()).matrix();
    ramp.pose.translation() = edge + ramp.pose.linear() * Vec3(0, -0.05, -0.05);
    scene.add(ramp);
    RunWatch watch(plan.arm, plan.layout(), plan.parameters);
    simulate(plan, {}, [&](std::span<const double> row, LaneChanges) {
      watch.add(row);
      return true;
    });
    const auto said = testing::Contains(HasSubstr("contacts gave "));
    if (ramps == 1420) {
      EXPECT_THAT(watch.cautions(), testing::Not(said));
    } else {
      EXPECT_THAT(watch.cautions(), said);
    }
  }
}

TEST(RunWatch, CountsFromTheFirstRowOfARecording) {
  RunPlan plan = test::plan("free.toml", "free.csv", 0.2);
  RunWatch watch(plan.arm, plan.layout(), plan.parameters);
  simulate(plan, {}, [&](std::span<const double> row, LaneChanges) {
    std::vector<double> later(row.begin(), row.end());
    plan.layout().in(std::span(later), Column::energy_total)[0] += 0.5;
    watch.add(later);
    return true;
  });
  EXPECT_THAT(watch.warnings(), IsEmpty());
}

TEST(RunWatch, LetsALedgerGiveWhatItHas) {
  Parameters p;
  p.kind = CouplingKind::predictive;
  Watched run(p);
  run.go_to(5e-3, 100);
  EXPECT_THAT(run.watch.warnings(), IsEmpty());
  run.go_to(7e-3, 100);
  ASSERT_EQ(run.watch.warnings().size(), 1u);
  EXPECT_THAT(run.watch.warnings()[0], HasSubstr("7 mJ, more than the 5 mJ"));
  p.kind = CouplingKind::tank;
  p.tank_energy = 0.05;
  Watched tanks(p);
  tanks.go_to(0.05, 100);
  EXPECT_THAT(tanks.watch.warnings(), IsEmpty());
}

TEST(RunWatch, ExcusesASwitchForThreeTenthsOfASecond) {
  Watched run;
  run.go_to(-0.01, 100);
  run.watch.change(101, Parameters{});
  run.go_to(0.3, 200);
  run.go_to(0.3, 1000);
  EXPECT_THAT(run.watch.warnings(), IsEmpty());
  run.go_to(0.4, 100);
  EXPECT_EQ(run.watch.warnings().size(), 1u);
}

TEST(RunWatch, ExcusesAMotorAtItsLimitUnlessTheLawIsKnownNotToBePassive) {
  const double limit = test::omni().joints[0].effort;
  Watched passive;
  passive.go_to(0.1, 100, limit);
  EXPECT_THAT(passive.watch.warnings(), IsEmpty());
  Parameters p;
  p.eta = 0.05;
  Watched not_passive(p);
  not_passive.go_to(0.1, 100, limit);
  EXPECT_EQ(not_passive.watch.warnings().size(), 1u);
}

TEST(RunWatch, SaysThatTheTipIsFasterThanAnyHand) {
  const auto run_at = [](double tip_speed) {
    // The first joint turns about the vertical: the tip's lever is its distance from that axis.
    const ArmDescription arm = test::omni();
    const Arm<kAnyDof> chain(arm);
    Arm<kAnyDof>::Frames f;
    chain.frames(Eigen::Vector3d::Zero(), f);
    Watched run;
    run.speed = tip_speed / chain.tip(f).head<2>().norm();
    run.go_to(0, 10);
    return run.watch.warnings();
  };
  EXPECT_THAT(run_at(9.9), IsEmpty());
  EXPECT_THAT(run_at(17), ElementsAre(HasSubstr("the tip reached 17 m/s")));
}

// Only rows in which joints are fast enough for it are looked at closely.
TEST(RunWatch, MissesNoFastTipOfAnyArm) {
  std::mt19937 random(3);
  const auto between = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  for (unsigned seed = 0; seed < 60; ++seed) {
    const auto slides = static_cast<Slides>(seed % 3);
    const ArmDescription arm = test::random_arm(1 + static_cast<int>(seed % 7), seed, slides);
    const RowLayout layout(arm.dof());
    const DerivedColumns tips(arm);
    for (const double speed : {9.99, 10.01}) {
      std::vector<double> row(static_cast<std::size_t>(layout.stride()), 0.0);
      const auto x = layout.in(std::span(row), Column::device_position);
      const auto v = layout.in(std::span(row), Column::device_velocity);
      for (std::size_t i = 0; i < x.size(); ++i) {
        x[i] = between(-1, 1);
        v[i] = between(-1, 1);
      }
      const double before = tips.of(DerivedColumns::from(layout, row))[1].norm();
      for (double& each : v) each *= speed / before;
      RunWatch watch(arm, layout, {});
      watch.add(row);
      EXPECT_EQ(watch.cautions().size(), speed > RunWatch::kFastestTip ? 1u : 0u) << seed;
    }
  }
}

std::vector<std::string> warnings_of_run(const RunPlan& plan) {
  RunWatch watch(plan.arm, plan.layout(), plan.parameters);
  simulate(plan, {}, [&](std::span<const double> row, LaneChanges) {
    watch.add(row);
    return true;
  });
  return watch.warnings();
}

TEST(RunWatch, SaysNothingOfTheShippedHandUnderAnyLaw) {
  RunPlan plan = test::plan("table.toml", "touch.csv", 4);
  for (std::size_t law = 0; law < kLaws; ++law) {
    plan.parameters.kind = static_cast<CouplingKind>(law);
    EXPECT_THAT(warnings_of_run(plan), IsEmpty()) << kLawKeys[law];
  }
}

// A recording that begins while the hand presses has a stretched spring, whose energy comes back
// when the hand lifts. The standard law is passive nevertheless.
TEST(RunWatch, LetsARunThatBeginsWithAStretchedSpringGiveItBack) {
  RunPlan plan = test::plan("table.toml", "touch.csv", 2);
  plan.parameters.kind = CouplingKind::standard;
  plan.hand = hand_through({0, 0.5, 1.5, 1.53, 2},
                           {Vec3(0.19, 0, 0), Vec3(0.19, 0, -0.1), Vec3(0.19, 0, -0.1),
                            Vec3(0.19, 0, 0.05), Vec3(0.19, 0, 0.05)},
                           "lifted at once");
  const RowLayout layout = plan.layout();
  std::vector<std::vector<double>> rows;
  simulate(plan, {}, [&](std::span<const double> row, LaneChanges) {
    rows.emplace_back(row.begin(), row.end());
    return true;
  });
  const auto held = [&](const std::vector<double>& row) { return spring_energy(layout, row); };
  const auto stretched = std::ranges::max_element(rows, {}, held);
  const auto energy = [&](const std::vector<double>& row) {
    return layout.in(std::span(row), Column::energy_total)[0];
  };
  RunWatch watch(plan.arm, layout, plan.parameters);
  double given = 0;  // since the spring was stretched [J]
  for (auto row = stretched; row != rows.end(); ++row) {
    watch.add(*row);
    given = std::max(given, energy(*row) - energy(*stretched));
  }
  EXPECT_GT(given, 2 * kGivenEnergy) << "the spring gives too little to tell";
  EXPECT_LT(given, held(*stretched) + kGivenEnergy);
  EXPECT_THAT(watch.warnings(), IsEmpty());
}

// While the motors give less than they are asked for, or nothing, the work of the difference is not
// the coupling's fault. What is beyond this work is.
TEST(RunWatch, ExcusesTheWorkThatMotorsWithhold) {
  const RowLayout layout(3);
  for (const double share : {0.0, 0.6}) {
    for (const double work : {1.0, 0.5}) {  // of E_c, done by the torque that is missing
      RunWatch watch(test::omni(), layout, {});
      std::vector<double> row(static_cast<std::size_t>(layout.stride()), 0.0);
      for (int i = 0; i < 500; ++i) {
        layout.in(std::span(row), Column::time)[0] = 1e-3 * i;
        layout.in(std::span(row), Column::energy_total)[0] = 1e-4 * i;
        layout.in(std::span(row), Column::commanded_torque)[1] = -0.1;
        layout.in(std::span(row), Column::motor_torque)[1] = -share * 0.1;
        layout.in(std::span(row), Column::device_position)[1] = work * 1e-3 * i / (1 - share);
        watch.add(row);
      }
      EXPECT_EQ(watch.warnings().empty(), work == 1) << share << " " << work;
    }
  }
}

// Far below eta_min, in a stiff undamped grip, the loop gives energy without end.
TEST(RunWatch, SaysThatALoopFarBelowEtaMinIsNotPassive) {
  RunPlan plan = test::plan("table.toml", "touch.csv", 4);
  plan.parameters.eta = 0.05;
  plan.parameters.hand_stiffness = 3000;
  plan.parameters.hand_damping = 0;
  const auto warnings = warnings_of_run(plan);
  ASSERT_FALSE(warnings.empty());
  EXPECT_THAT(warnings[0], HasSubstr("this run is not passive"));
}

TEST(RunWatch, LeavesItsWordsInTheRecording) {
  const test::TempDir dir;
  RunPlan plan = test::plan("table.toml", "touch.csv", 2);
  plan.parameters.eta = 0.05;
  plan.parameters.hand_stiffness = 3000;
  plan.parameters.hand_damping = 0;
  const auto file = dir / "a.h5";
  {
    Recorder recorder(file, session_info(plan), plan.parameters, false, Recorder::kWaitingRoom);
    simulate(plan, {},
             [&](std::span<const double> row, LaneChanges) { return recorder.push_waiting(row); });
    recorder.finish();
  }
  const auto words = warnings_of(read_session(file), file.string());
  EXPECT_EQ(words, warnings_of_run(plan));
  EXPECT_EQ(hdf5::read_text(hdf5::open_to_read(file).get(), "warnings", file),
            warnings_text(words));
}

// The first motor gives all that it can for a hundred ticks.
TEST(RunWatch, SaysWhatShareOfTheEnergyIsTheCouplingsOwn) {
  Parameters p;
  p.kind = CouplingKind::predictive;
  Watched run(p);
  run.go_to(0.1, 100, test::omni().joints[0].effort);
  run.go_to(0.12, 16);
  EXPECT_NEAR(run.watch.at_limit(), 0.1, 1e-12) << "a hundred ticks of 1 ms";
  // The limit's share ends with row 100. Then E_c rises by 1.25 mJ a tick; 5 mJ may be given, and
  // 1 mJ is noise.
  EXPECT_THAT(
      run.watch.warnings(),
      ElementsAre("the coupling by itself gave 20 mJ (E_c rose to 0.12 J, with changes of "
                  "settings, motors at their limit and force held back), more than the 5 mJ "
                  "that the energy account allows, above the limit since t = 0.105 s: this "
                  "run is not passive (predictive, eta 1)"));
}

TEST(RunWatch, NamesTheSettingsUnderWhichTheLimitWasPassed) {
  Watched run;
  run.go_to(-0.1, 10);
  Parameters p;
  p.kind = CouplingKind::standard;
  run.watch.change(11, p);
  run.go_to(-0.1, 400);
  run.go_to(0.2, 240);
  p.eta = 7;
  run.watch.change(1000, p);
  run.go_to(0.2, 400);
  EXPECT_THAT(run.watch.warnings(),
              ElementsAre("E_c rose to 0.2 J, above the limit since t = 0.491 s: this run is not "
                          "passive (standard)"));
}

TEST(RunWatch, SaysFirstThatALoopIsUnstable) {
  Watched run;
  run.go_to(15, 100);
  run.speed = 2e6;
  run.go_to(15, 1);
  const auto warnings = run.watch.warnings();
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0],
            "unstable since t = 0.101 s: the speed of the device's joint 1 became larger than 1000 "
            "rad/s");
  EXPECT_EQ(run.watch.cautions(), std::vector{warnings[1]});
}

TEST(RunWatch, TellsTimeAtTheLimitOfEachLane) {
  EXPECT_EQ(at_limit_text({}), "");
  EXPECT_EQ(at_limit_text(std::vector{0.0}), "");
  EXPECT_EQ(at_limit_text(std::vector{0.25}),
            "motors at their limit    0.25 s; in this time device and proxy may drift apart\n");
  EXPECT_EQ(at_limit_text(std::vector{1.5, 0.0, 0.125}),
            "motors at their limit    1.5 s in the first run; in this time device and proxy may "
            "drift apart\n"
            "motors at their limit    0.125 s in the third run; in this time device and proxy may "
            "drift apart\n");
  std::vector<std::string> all;
  add_warnings({"a", "b"}, kMainLane, all);
  add_warnings({"c"}, kTwinLane, all);
  EXPECT_THAT(all, ElementsAre("a", "b", "the second run: c"));
  EXPECT_EQ(warnings_text(all), "a\nb\nthe second run: c");
}

// A recording is watched in pieces, under the settings of each lane and their changes.
TEST(RunWatch, WatchesEachLaneOfARecordingUnderItsSettings) {
  const test::TempDir dir;
  RunPlan plan = test::plan("table.toml", "touch.csv", 2);
  plan.parameters.kind = CouplingKind::standard;
  plan.beside.push_back({plan.parameters, {{700, "device.torque_limit = 0.03"}}});
  plan.beside[0].parameters.torque_limit = 0.02;
  const Session session = test::recorded(plan, dir / "a.h5");
  SessionWatch watch(session, "a.h5");
  std::vector<double> wanted(2);
  const auto limit = [&](std::size_t lane, std::size_t k) {
    return lane == 0 ? plan.arm.joints[0].effort : k < 700 ? 0.02 : 0.03;
  };
  const auto stride = static_cast<std::size_t>(session.layout.stride());
  for (std::size_t k = 0; k < session.size(); k += 500) {
    std::vector<std::span<const double>> piece;
    for (std::size_t lane = 0; lane < 2; ++lane) {
      piece.push_back(std::span(session.lane(lane).rows).subspan(k * stride, 500 * stride));
    }
    watch.take(piece);
  }
  for (std::size_t lane = 0; lane < 2; ++lane) {
    for (std::size_t k = 0; k < session.size(); ++k) {
      const auto torque = session.lane(lane).at(k, Column::motor_torque);
      const double most = limit(lane, k) * (1 - 1e-9);
      const bool at =
          std::ranges::any_of(torque, [&](double each) { return std::abs(each) >= most; });
      wanted[lane] += at ? 1e-3 : 0;
    }
  }
  EXPECT_EQ(wanted[0], 0);
  EXPECT_GT(wanted[1], 0);
  ASSERT_EQ(watch.at_limit().size(), 2u);
  EXPECT_NEAR(watch.at_limit()[0], wanted[0], 1e-9);
  EXPECT_NEAR(watch.at_limit()[1], wanted[1], 1e-9);
}

}  // namespace
}  // namespace limpid
