// Readings, settings and files that cannot be, as callers of the library may give them.
#include <gmock/gmock.h>

#include <fstream>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include "tests/app/library/slide.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using test::armed;
using test::refusal;
using test::rest;
using test::slide;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// Positions are a view: those of a vector that nobody keeps would be gone before the tick.
template <class T>
constexpr bool kTaken = std::is_assignable_v<decltype(DeviceLoop::Reading::position)&, T>&&
    std::is_assignable_v<decltype(SimulatedLoop::Hand::torque)&, T>;
static_assert(!kTaken<std::vector<double>> && !kTaken<std::array<double, 3>>);
static_assert(kTaken<std::vector<double>&> && kTaken<const std::array<double, 3>&>);
static_assert(kTaken<std::span<double>> && kTaken<std::span<const double>>);

TEST(DeviceLoop, TripsOnReadingsThatCannotBe) {
  const std::array<double, 1> x{0.004};
  for (const double wrong : {1e6, std::nan(""), 0.15}) {  // 15 cm within a tick, within the range
    SCOPED_TRACE(wrong);
    DeviceLoop loop = armed();
    const std::array<double, 1> there{wrong};
    DeviceLoop::Reading reading;
    reading.position = there;
    reading.elapsed = 1e-3;
    EXPECT_EQ(loop.tick(reading)[0], 0);
    EXPECT_EQ(rest(loop, x, 1), 0) << "it does not come back by itself";
    EXPECT_NE(loop.force_text(), "");
    loop.arm();
    EXPECT_LT(rest(loop, x, 1), -1);
  }
}

TEST(DeviceLoop, SaysThatForceFadesWhereReadingsStandStill) {
  DeviceLoop loop = armed();
  const std::array<double, 1> x{0.004};
  DeviceLoop::Reading reading;
  reading.position = x;
  reading.elapsed = 1e-3;
  for (int k = 0; k < 450; ++k) loop.tick(reading);
  EXPECT_GT(loop.force_share(), 0);
  EXPECT_LT(loop.force_share(), 1);
  EXPECT_THAT(loop.force_text(), StartsWith("force held back: "));
  for (int k = 0; k < 300; ++k) loop.tick(reading);
  EXPECT_EQ(loop.force_share(), 0);
  EXPECT_THAT(loop.force_text(), StartsWith("force off: "));
}

TEST(DeviceLoop, EndsForceWithoutFreshReadingsHandOrHealth) {
  const std::array<double, 1> x{0.004};
  const auto after = [&](auto change) {
    DeviceLoop loop = armed();
    DeviceLoop::Reading reading;
    reading.position = x;
    reading.elapsed = 1e-3;
    change(reading);
    double torque = 0;
    for (int k = 0; k < 7; ++k) torque = loop.tick(reading)[0];
    return std::pair(torque, loop.force_text());
  };
  EXPECT_EQ(after([](auto& r) { r.fresh = false; }).first, 0) << "7 ms old";
  EXPECT_EQ(after([](auto& r) { r.hand = false; }).first, 0);
  EXPECT_EQ(after([](auto& r) { r.fault = true; }).first, 0);
  const auto [torque, why] = after([](auto& r) { r.position = {}; });
  EXPECT_EQ(torque, 0);
  EXPECT_NE(why, "");
  // A stall: 7 ticks of a fade of 0.5 s later there is at most a hundredth.
  EXPECT_NEAR(after([](auto& r) { r.elapsed = 0.006; }).first, 0, 0.02);
}

TEST(DeviceLoop, SaysThatAReadingHasAnotherNumberOfJoints) {
  for (const Motors motors : {Motors::real, Motors::simulated}) {
    LoopOptions options = slide();
    options.motors = motors;
    DeviceLoop loop(options, std::array{0.004});
    DeviceLoop::Reading reading;
    const std::array<double, 1> one{0.004};
    loop.arm();
    rest(loop, one, 1);
    const std::array<double, 2> two{0.004, 0};
    reading.position = two;
    EXPECT_EQ(loop.tick(reading)[0], 0);
    EXPECT_THAT(loop.force_text(), HasSubstr("a reading has 2 positions; needed: 1"));
    rest(loop, one, 0.01);
    if (motors == Motors::real) {
      EXPECT_THAT(loop.force_text(), HasSubstr("a reading has 2 positions")) << "why it tripped";
      loop.arm();
      rest(loop, one, 1);
    }
    EXPECT_EQ(loop.force_text(), "");
  }
}

TEST(DeviceLoop, SaysAStartOutsideOfTheRangeAndRefusesOneFarOutside) {
  // The slide goes from -0.2 to 0.2 m.
  const DeviceLoop near(slide(), std::array{0.21});
  EXPECT_THAT(near.notes(), testing::Contains(HasSubstr("joint 1 begins at 0.21")));
  const DeviceLoop inside(slide(), std::array{0.19});
  EXPECT_THAT(inside.notes(), testing::Not(testing::Contains(HasSubstr("begins at"))));
  try {
    const DeviceLoop far(slide(), std::array{-0.25});
    FAIL();
  } catch (const LoopError& error) {
    EXPECT_STREQ(error.what(),
                 "position: joint 1 has -0.25; needed: in the arm's range of -0.2 to 0.2 m, or "
                 "outside it by at most a tenth of the range");
  }
}

TEST(DeviceLoop, RefusesSettingsOfTheSimulatedHandAndArm) {
  LoopOptions options = slide();
  options.settings.emplace_back("hand.stiffness=300");
  EXPECT_THROW(DeviceLoop(options, std::array{0.0}), LoopError);
  EXPECT_NO_THROW(SimulatedLoop{options});
  DeviceLoop loop(slide(), std::array{0.0});
  EXPECT_THROW(loop.set("hand.damping=5"), LoopError);
  EXPECT_THROW(loop.set("hand.damping", 5), LoopError);
  EXPECT_THROW(loop.set("plant.cogging=0.01"), LoopError);
}

TEST(DeviceLoop, RefusesSettingsThatItsDeviceDoesNotTake) {
  const auto refused = [](Motors motors, const std::string& setting) {
    LoopOptions options = slide();
    options.motors = motors;
    DeviceLoop loop(options, std::array{0.0});
    options.settings.push_back(setting);
    const std::string making = refusal([&] { DeviceLoop(options, std::array{0.0}); });
    EXPECT_EQ(making, refusal([&] { loop.set(setting); }));
    return making;
  };
  for (const Motors motors : {Motors::real, Motors::simulated}) {
    for (const char* const setting :
         {"device.substeps=3", "device.gravity=true", "device.springs=true"}) {
      EXPECT_THAT(refused(motors, setting), HasSubstr("belongs to the simulated arm")) << setting;
    }
  }
  EXPECT_THAT(refused(Motors::real, "device.delay=2"), HasSubstr("model.delay tells the law"));
  EXPECT_THAT(refused(Motors::real, "device.friction=0.01"), HasSubstr("stands in the arm's file"));
  EXPECT_EQ(refused(Motors::simulated, "device.delay=2"), "nothing");
  EXPECT_EQ(refused(Motors::simulated, "device.friction=0.01"), "nothing");
}

TEST(Loops, SayWhatIsNotAllowed) {
  const auto making = [](auto change) {
    LoopOptions options = slide();
    change(options);
    return refusal([&] { DeviceLoop(options, std::array{0.0}); });
  };
  EXPECT_THAT(making([](auto& o) { o.settings = {"coupling.etta=1"}; }),
              HasSubstr("coupling.etta"));
  EXPECT_THAT(making([](auto& o) { o.settings = {"coupling.eta=-1"}; }), HasSubstr("allowed"));
  EXPECT_THAT(making([](auto& o) { o.limits.tip_force = 11; }),
              AllOf(HasSubstr("tip_force: 11"), HasSubstr("0.1 to 10 N")));
  EXPECT_THAT(making([](auto& o) { o.period = 1; }),
              HasSubstr("period: 1 s is not allowed; allowed: 1e-05"));
  EXPECT_THAT(making([](auto& o) {
                o.period = 0.006;
                o.motors = Motors::real;
              }),
              HasSubstr("real motors; allowed: at most 0.004 s"));
  EXPECT_THAT(making([](auto& o) { o.settings = {"loop.tick=0.002"}; }), HasSubstr("period"));
  const test::TempDir dir;
  for (const char* tick : {"0.002", "0.001"}) {
    std::ofstream(dir / "own.toml") << "[loop]\ntick = " << tick << '\n';
    const auto with_period = [&](double period) {
      return making([&](auto& o) {
        o.config = (dir / "own.toml").string();
        o.period = period;
      });
    };
    EXPECT_EQ(with_period(std::stod(tick)), "nothing");
    EXPECT_THAT(with_period(0.0005), AllOf(HasSubstr("own.toml: loop.tick: "), HasSubstr(tick),
                                           HasSubstr("`period`, 0.0005")));
  }
  EXPECT_THAT(making([](auto& o) { o.scene_text += "[[ball]]\n"; }), HasSubstr("scene_text:"));
  EXPECT_THAT(making([](auto& o) { o.scene = "table.toml"; }), HasSubstr("both given"));
  EXPECT_THAT(making([](auto& o) {
                o.scene_text = "";
                o.scene = "tabel.toml";
              }),
              HasSubstr("did you mean table.toml"));
  EXPECT_THAT(making([](auto& o) { o.arm_text = "<robot/>"; }), HasSubstr("arm_text"));
  EXPECT_THAT(refusal([] { DeviceLoop(slide(), std::array{0.0, 0.0}); }), HasSubstr("needed: 1"));
  EXPECT_THAT(refusal([] { DeviceLoop(slide(), std::array{std::nan("")}); }), HasSubstr("finite"));

  EXPECT_THAT(refusal([] {
                DeviceLoop(LoopOptions{}, std::array{0.0, 0.6, -1.1});
              }),
              HasSubstr("arm: is missing"))
      << "real motors are nobody's default arm";

  DeviceLoop loop(slide(), std::array{0.0});
  EXPECT_THAT(refusal([&] { loop.set("loop.tick", 0.002); }), HasSubstr("cannot change"));
  EXPECT_THAT(refusal([&] { loop.set("loop.tick=0.002"); }), HasSubstr("cannot change"));
  EXPECT_THAT(refusal([&] { loop.set("coupling.eta", 1e9); }), HasSubstr("allowed"));
  EXPECT_THAT(refusal([&] { (void)loop.row("/device/positon"); }),
              HasSubstr("no such column; did you mean /device/position?"));
  EXPECT_THAT(refusal([&] { loop.set("model.gravity", 0.5); }), HasSubstr("allowed: 0 or 1"));
  EXPECT_THAT(refusal([&] { loop.record(std::string(300, 'x') + ".h5"); }),
              AllOf(HasSubstr("xxx"), HasSubstr("303 bytes")));
  loop.set("coupling.kind=standard");
  EXPECT_EQ(loop.get("coupling.kind"), 0);
}

TEST(Loops, TakeAllSettingsOrNone) {
  DeviceLoop loop(slide(), std::array{0.0});
  const double before = loop.get("coupling.k_vc");
  const std::vector<std::string> wrong{"coupling.k_vc=0.25", "coupling.eta=-1"};
  EXPECT_THAT(refusal([&] { loop.set(wrong); }), HasSubstr("coupling.eta"));
  EXPECT_EQ(loop.get("coupling.k_vc"), before);
  const std::vector<std::string> right{"coupling.k_vc=0.25", "coupling.eta=0.75"};
  loop.set(right);
  EXPECT_EQ(loop.get("coupling.k_vc"), 0.25);
  EXPECT_EQ(loop.get("coupling.eta"), 0.75);
}

TEST(Loops, RefuseToRecordInTheWordsOfTheLibrary) {
  const test::TempDir dir;
  const auto file = dir / "left.h5";
  std::ofstream(dir / "left.h5.part") << "of a program that ended";
  DeviceLoop loop(slide(), std::array{0.0});
  const std::string said = refusal([&] { loop.record(file.string()); });
  EXPECT_THAT(said, HasSubstr("limpid recover"));
  EXPECT_THAT(said, AllOf(HasSubstr("`replace` overwrites"), Not(HasSubstr("--force"))));
}

TEST(Loops, RefuseToRecordIntoAFileOfAnotherKind) {
  const test::TempDir dir;
  std::ofstream(dir / "there.csv") << "a table";
  DeviceLoop loop(slide(), std::array{0.0});
  for (const char* name : {"a.csv", "a", "a.hdf5", "there.csv"}) {
    EXPECT_THAT(refusal([&] { loop.record((dir / name).string()); }),
                AllOf(HasSubstr(name), HasSubstr("allowed: a name that ends in .h5")));
  }
  EXPECT_THAT(refusal([&] { loop.finish_recording(); }), HasSubstr("nothing is being recorded"));
}

TEST(DeviceLoop, LooksAtNoPositionsThatAreNotFresh) {
  DeviceLoop loop = armed();
  DeviceLoop::Reading reading;
  reading.elapsed = 1e-3;
  reading.fresh = false;
  for (int k = 0; k < 3; ++k) EXPECT_LT(loop.tick(reading)[0], -1) << "they are as they were";
  EXPECT_EQ(loop.force_text(), "");
  for (int k = 0; k < 4; ++k) loop.tick(reading);
  EXPECT_EQ(loop.tick(reading)[0], 0) << "8 ms old";
  const std::array<double, 1> x{0.004};
  LoopOptions real = slide();
  real.motors = Motors::real;
  DeviceLoop begins(real, x);
  begins.tick(reading);
  EXPECT_THAT(begins.force_text(), HasSubstr("has 0 positions")) << "the first has to be there";
}

TEST(DeviceLoop, TakesEachReadingOfASimulationForFresh) {
  DeviceLoop loop(slide(), std::array{0.0});
  DeviceLoop::Reading reading;
  reading.fresh = false;
  for (const double x : {0.001, 0.002, 0.003}) {
    const std::array<double, 1> there{x};
    reading.position = there;
    loop.tick(reading);
    EXPECT_DOUBLE_EQ(loop.row("/device/position")[0], x);
  }
}

TEST(DeviceLoop, TakesATimeThatCannotBeForAFault) {
  for (const double elapsed : {std::nan(""), -1e-3, std::numeric_limits<double>::infinity()}) {
    SCOPED_TRACE(elapsed);
    const std::array<double, 1> x{0.004};
    DeviceLoop loop = armed();
    DeviceLoop::Reading reading;
    reading.position = x;
    reading.elapsed = elapsed;
    EXPECT_EQ(loop.tick(reading)[0], 0);
    EXPECT_EQ(rest(loop, x, 1), 0);
    DeviceLoop simulated(slide(), x);
    rest(simulated, x, 0.1);
    EXPECT_EQ(simulated.tick(reading)[0], 0);
    EXPECT_EQ(simulated.force_text(), "force off: a reading's time is wrong");
    EXPECT_LT(rest(simulated, x, 0.01), -1);
    EXPECT_EQ(simulated.force_text(), "");
  }
}

TEST(DeviceLoop, SaysThatAReadingOfASimulationIsNotFinite) {
  DeviceLoop loop(slide(), std::array{0.004});
  rest(loop, std::array{0.004}, 0.1);
  DeviceLoop::Reading reading;
  const std::array<double, 1> wrong{std::nan("")};
  reading.position = wrong;
  EXPECT_EQ(loop.tick(reading)[0], 0);
  EXPECT_EQ(loop.force_text(), "force off: a reading is not finite");
  EXPECT_EQ(loop.force_share(), 0);
}

// Runs a loop of a period of 1 ms whose ticks come after `elapsed` [s]; 0: as fast as it goes.
// Returns the largest share of the force that its motors had, and the text at the end.
std::pair<double, std::string> paced(DeviceLoop& loop, double elapsed, double seconds) {
  DeviceLoop::Reading reading;
  reading.elapsed = elapsed;
  double most = 0;
  for (int k = 0; k < std::lround(1e3 * seconds); ++k) {
    const std::array<double, 1> x{k % 2 * 1e-6};
    reading.position = x;
    loop.tick(reading);
    most = std::max(most, loop.force_share());
  }
  return {most, loop.force_text()};
}

TEST(DeviceLoop, SaysThatTicksComeAtAnotherPaceThanThePeriod) {
  LoopOptions options = slide();
  options.motors = Motors::real;
  DeviceLoop loop(options, std::array{0.0});
  loop.arm();
  EXPECT_THAT(paced(loop, 1.4e-3, 2).second, HasSubstr("every 1.4 ms, not every 1 ms"));
}

// The law counts whole periods, the limit of speed the time itself.
TEST(DeviceLoop, JudgesSpeedByTheTimeThatPassedWhateverThePace) {
  for (const double elapsed : {1e-3, 1.2e-3, 1.5e-3, 1.6e-3, 2.4e-3, 2.6e-3}) {
    for (const double speed : {0.095, 0.125}) {  // of a limit of 0.1 m/s
      LoopOptions options = slide();
      options.motors = Motors::real;
      options.limits.tip_speed = 0.1;
      options.limits.joint_speed = 15;
      DeviceLoop loop(options, std::array{-0.04});
      loop.arm();
      DeviceLoop::Reading reading;
      reading.elapsed = elapsed;
      std::array<double, 1> x{-0.04};
      reading.position = x;
      for (int k = 0; k < 1500; ++k) {
        x[0] = -0.04 + k % 2 * 1e-6;
        loop.tick(reading);
      }
      ASSERT_EQ(loop.force_share(), 1) << elapsed;
      double least = 1;
      for (; x[0] < 0.03; x[0] += speed * elapsed) {
        loop.tick(reading);
        least = std::min(least, loop.force_share());
      }
      EXPECT_EQ(least<0.99, speed> 0.1) << elapsed << " s, " << speed << " m/s";
    }
  }
}

// Speeds would be judged too small, and energy forgotten too fast.
TEST(DeviceLoop, TripsWhereTicksComeFasterThanThePeriod) {
  LoopOptions options = slide();
  options.motors = Motors::real;
  for (const double elapsed : {0.0, 1e-4, 5e-4, 8e-4}) {
    DeviceLoop loop(options, std::array{0.0});
    loop.arm();
    const auto [most, why] = paced(loop, elapsed, 1.5);
    if (elapsed < 8e-4) {
      EXPECT_LT(most, 1) << elapsed << " s: before all of it is there";
    }
    EXPECT_EQ(loop.force_share(), 0);
    EXPECT_THAT(why, AllOf(StartsWith("force off: ticks come"), HasSubstr("not every 1 ms")));
    const auto [later, still] = paced(loop, 1e-3, 2);
    EXPECT_EQ(later, 0) << "until it is armed again";
    EXPECT_EQ(still, why) << "the pace at which it tripped";
    loop.arm();
    EXPECT_EQ(paced(loop, 1e-3, 1).first, 1);
    EXPECT_EQ(loop.force_text(), "");
  }
  DeviceLoop late(options, std::array{0.0});
  late.arm();
  paced(late, 1e-3, 2);
  EXPECT_THAT(paced(late, 5e-4, 0.5).second, HasSubstr("every 0.5 ms"))
      << "the pace of the ticks that tripped, without those before them";
  DeviceLoop slightly(options, std::array{0.0});
  slightly.arm();
  EXPECT_EQ(paced(slightly, 0.95e-3, 5).first, 1);
  EXPECT_EQ(slightly.force_text(), "");
}

TEST(DeviceLoop, CountsMotorsThatAreNotSimulatedAsReal) {
  LoopOptions options = slide();
  options.motors = static_cast<Motors>(7);
  DeviceLoop loop(options, std::array{0.004});
  EXPECT_EQ(rest(loop, std::array{0.004}, 1), 0) << "nobody armed it";
}

TEST(SimulatedLoop, SaysWhatIsWrongWithAPath) {
  const SimulatedLoop loop{LoopOptions{}};
  const Point3 at = loop.tip();
  const auto run = [&](std::vector<double> path, double duration = 0) {
    return refusal([&] { loop.run(path, duration, [](std::span<const double>) { return true; }); });
  };
  const auto row = [&](double t) { return std::vector<double>{t, at[0], at[1], at[2]}; };
  const auto rows = [&](std::initializer_list<double> times) {
    std::vector<double> all;
    for (const double t : times) {
      const auto one = row(t);
      all.insert(all.end(), one.begin(), one.end());
    }
    return all;
  };
  EXPECT_EQ(run(rows({0, 0.01})), "nothing");
  EXPECT_EQ(run(row(0)), "path: has 4 numbers; needed: at least two rows of time [s], x, y, z [m]");
  EXPECT_THAT(run({0, 0, 0, 0, 1, 0, 0}), StartsWith("path: has 7 numbers; "));
  EXPECT_EQ(run(rows({5, 6, 6})), "path: row 3: time 6 follows time 6; needed: a later time");
  std::vector<double> wrong = rows({0, 1});
  wrong[5] = std::nan("");
  EXPECT_EQ(run(wrong), "path: row 2: is not finite");
  for (const double none : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(run(rows({0, 0.01}), none), StartsWith("duration: "));
  }
  EXPECT_THAT(refusal([&] { loop.run(rows({0, 1}), 0, {}); }), HasSubstr("take: is empty"));
  std::vector<double> far = rows({0, 1});
  far[5] = 5;
  EXPECT_NE(run(far), "nothing") << "out of reach";
  // The run has a row for each tick of the path, from its own beginning; or those asked for.
  const auto count = [&](double duration) {
    return loop.run(rows({5, 5.02}), duration, [](std::span<const double>) { return true; }).rows;
  };
  EXPECT_EQ(count(0), 20u);
  EXPECT_EQ(count(0.05), 50u);
  int taken = 0;
  EXPECT_EQ(loop.run(rows({0, 1}), 0, [&](std::span<const double>) { return ++taken < 7; }).rows,
            7u);
}

TEST(DeviceLoop, TakesEachOfItsLimits) {
  const auto refused = [](auto change) {
    LoopOptions options = slide();
    change(options.limits);
    return refusal([&] { DeviceLoop(options, std::array{0.0}); });
  };
  EXPECT_EQ(refused([](LoopLimits&) {}), "nothing");
  EXPECT_THAT(refused([](LoopLimits& of) { of.joint_speed = -1; }), HasSubstr("joint_speed: -1"));
  EXPECT_THAT(refused([](LoopLimits& of) { of.tip_speed = -1; }), HasSubstr("tip_speed: -1"));
  EXPECT_THAT(refused([](LoopLimits& of) { of.tip_force = -1; }), HasSubstr("tip_force: -1"));
  EXPECT_THAT(refused([](LoopLimits& of) { of.energy = -1; }), HasSubstr("energy: -1"));
  EXPECT_THAT(refused([](LoopLimits& of) { of.range = -1; }), HasSubstr("range: -1"));
}

TEST(Loops, SayWhyTheLawIsNotPassive) {
  LoopOptions options;
  options.settings = {"coupling.kind=proposed", "coupling.eta=0.1"};
  SimulatedLoop loop(options);
  EXPECT_THAT(loop.not_passive_text(), HasSubstr("eta is below eta_min"));
  loop.set("coupling.eta", 0.9);
  EXPECT_EQ(loop.not_passive_text(), "");
  loop.set("coupling.k_vc", 1000);
  EXPECT_THAT(loop.not_passive_text(), HasSubstr("condition (3)"));
}

TEST(SimulatedLoop, LetsThroughWhatItsCallerThrows) {
  SimulatedLoop loop{LoopOptions{}};
  const Point3 at = loop.tip();
  const std::array<double, 8> path{0, at[0], at[1], at[2], 1, at[0], at[1], at[2]};
  const auto run = [&](auto thrown) {
    loop.run(path, 0, [&](std::span<const double>) -> bool { throw thrown; });
  };
  EXPECT_THROW(run(7), int);
  EXPECT_THROW(run(std::out_of_range("the caller's")), std::out_of_range);
}

TEST(ArmModel, RefusesNumbersThatAreNotFinite) {
  const auto refused = [](auto change) {
    ArmModel arm;
    arm.joints.resize(2);
    arm.joints[0].name = "a";
    arm.joints[1].name = "b";
    arm.joints[1].mass = 0.1;
    EXPECT_NE(urdf_text(arm), "");
    change(arm);
    return refusal([&] { (void)urdf_text(arm); });
  };
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refused([&](auto& arm) { arm.joints[1].upper = nan; }),
              HasSubstr("joint 'b': upper: nan is not allowed"));
  EXPECT_THAT(refused([&](auto& arm) { arm.joints[0].lower = -inf; }), HasSubstr("'a': lower"));
  EXPECT_THAT(refused([&](auto& arm) { arm.joints[0].inertia[2] = nan; }), HasSubstr("inertia"));
  EXPECT_THAT(refused([&](auto& arm) { arm.tip[1] = inf; }), HasSubstr("arm: tip: inf"));
  using Spoil = std::function<void(ArmJoint&)>;
  for (const auto& [what, spoil] : std::vector<std::pair<const char*, Spoil>>{
           {"position", [&](ArmJoint& of) { of.position[2] = nan; }},
           {"rpy", [&](ArmJoint& of) { of.rpy[0] = inf; }},
           {"axis", [&](ArmJoint& of) { of.axis[1] = nan; }},
           {"lower", [&](ArmJoint& of) { of.lower = nan; }},
           {"upper", [&](ArmJoint& of) { of.upper = inf; }},
           {"effort", [&](ArmJoint& of) { of.effort = inf; }},
           {"damping", [&](ArmJoint& of) { of.damping = nan; }},
           {"friction", [&](ArmJoint& of) { of.friction = inf; }},
           {"mass", [&](ArmJoint& of) { of.mass = nan; }},
           {"center", [&](ArmJoint& of) { of.center[0] = inf; }},
           {"inertia", [&](ArmJoint& of) { of.inertia[5] = nan; }}}) {
    EXPECT_THAT(refused([&](ArmModel& arm) { spoil(arm.joints[1]); }),
                AllOf(StartsWith(std::string("arm: joint 'b': ") + what + ": "),
                      testing::EndsWith("is not allowed; allowed: a finite number")));
  }
  for (const double none : {0.0, -1.0}) {
    EXPECT_THAT(refused([&](ArmModel& arm) { arm.joints[0].effort = none; }),
                AllOf(StartsWith("arm: joint 'a': effort "), HasSubstr("allowed: above 0")));
  }
  EXPECT_EQ(refused([&](ArmModel& arm) { arm.joints[0].effort = nan; }), "nothing")
      << "Limpid chooses it";
}

}  // namespace
}  // namespace limpid
