// The library's loops against the loop that the program has, and against closed forms.
#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <numeric>

#include "app/library/limpid/limpid.h"
#include "app/run/fitted_gains.h"
#include "devices/files/session/session.h"
#include "devices/files/session/session_units.h"
#include "devices/files/urdf_file.h"
#include "devices/simulated/rig.h"
#include "tests/app/library/slide.h"
#include "tests/support/temp_dir.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

using test::rest;
using test::slide;
using test::slide_at_wall;
using testing::HasSubstr;

// A device that gives readings as they are written down, and remembers its torque.
class Written final : public Device {
 public:
  explicit Written(int dof) {
    traits_.dof = dof;
    traits_.guarded = false;
  }
  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override {
    ++next.count;
    newest = next;
    return true;
  }
  void write(std::span<const double> given) noexcept override {
    torque.assign(given.begin(), given.end());
  }
  void stop() noexcept override {}

  DeviceReading next;
  std::vector<double> torque;

 private:
  DeviceTraits traits_;
};

LoopOptions table(const char* law, double eta) {
  LoopOptions options;
  options.scene = "table.toml";
  options.settings = {std::string("coupling.kind=") + law, fmt::format("coupling.eta={}", eta)};
  options.motors = Motors::simulated;
  return options;
}

// A slow path of the arm's joints into the table and along it [rad].
std::array<double, 3> joints_at(const Eigen::VectorXd& rest, double t) {
  return {rest[0] + 0.05 * std::sin(3 * t), rest[1] + 0.2 * std::sin(2 * t),
          rest[2] + 0.1 * std::sin(2.3 * t)};
}

bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

// Compares a rig's row and the library's, but for what the clock says. Where nothing touches, the
// library has no place, as files have none.
void expect_same_rows(const RowLayout& layout, std::span<const double> rig,
                      std::span<const double> b) {
  std::vector<double> copy(rig.begin(), rig.end());
  const std::span<const double> a = copy;
  file_points(layout.in(std::span(copy), Column::contact_point),
              layout.in(a, Column::contact_force));
  ASSERT_EQ(a.size(), b.size());
  for (const ColumnInfo& each : kColumnInfo) {
    if (each.column == Column::compute || each.column == Column::wake_latency) continue;
    const auto x = layout.in(a, each.column), y = layout.in(b, each.column);
    for (std::size_t i = 0; i < x.size(); ++i) {
      ASSERT_TRUE(same(x[i], y[i])) << each.path << " " << i << ": " << x[i] << " and " << y[i];
    }
  }
}

TEST(DeviceLoop, GivesTheRowsAndTorquesOfTheProgramsLoop) {
  for (const char* law : {"standard", "proposed", "predictive", "direct", "eba"}) {
    SCOPED_TRACE(law);
    const ArmDescription arm = test::omni();
    const Scene scene = test::omni_document("table.toml").scene;
    const Eigen::VectorXd rest = rest_pose(arm), zero = Eigen::VectorXd::Zero(3);
    Parameters p = fitted(arm);
    set_parameter(p, "coupling.kind", std::string(law));
    p.eta = 0.7;
    Written device(3);
    Rig rig(arm, scene, &device);
    rig.start(p, {rest, zero, rest, zero, zero});
    const auto at_first = joints_at(rest, 0);
    DeviceLoop loop(table(law, 0.7), at_first);
    std::vector<double> row(static_cast<std::size_t>(rig.layout().stride()));
    double pressed = 0;
    for (int k = 0; k < 3000; ++k) {
      const auto x = joints_at(rest, 1e-3 * k);
      std::ranges::copy(x, device.next.x.begin());
      rig.step(p, {{rig.tip(), 1}}, row);
      DeviceLoop::Reading reading;
      reading.position = x;
      const auto torque = loop.tick(reading);
      ASSERT_THAT(std::vector(torque.begin(), torque.end()),
                  testing::ElementsAreArray(device.torque));
      expect_same_rows(rig.layout(), row, loop.row());
      pressed = std::max(pressed, std::abs(rig.layout().in(std::span<const double>(row),
                                                           Column::contact_torque)[1]));
    }
    EXPECT_GT(pressed, 0.01) << "the wall is felt";
  }
}

TEST(SimulatedLoop, StepsAndRunsGiveTheRowsOfTheProgramsRun) {
  RunPlan plan = test::plan("pucks.toml", "touch.csv", 2);
  plan.parameters = fitted(plan.arm);
  plan.parameters.kind = CouplingKind::predictive;
  const test::Rows rows = test::rows_of(plan);
  LoopOptions options = table("predictive", plan.parameters.eta);
  options.scene = "pucks.toml";
  SimulatedLoop loop(options);
  const Vec3 first = plan.hand.sample(0, 1e-3);
  loop.start({first.x(), first.y(), first.z()});
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Vec3 at = plan.hand.sample(k, 1e-3);
    SimulatedLoop::Hand hand;
    hand.target = {at.x(), at.y(), at.z()};
    loop.step(hand);
    ASSERT_NO_FATAL_FAILURE(expect_same_rows(plan.layout(), rows.row(k), loop.row())) << k;
  }

  std::vector<double> path;
  for (std::size_t i = 0; i < plan.hand.time.size(); ++i) {
    const Vec3& at = plan.hand.position[i];
    path.insert(path.end(), {plan.hand.time[i], at.x(), at.y(), at.z()});
  }
  std::size_t k = 0;
  const auto end = loop.run(path, 2, [&](std::span<const double> row) {
    expect_same_rows(plan.layout(), rows.row(k++), row);
    return !testing::Test::HasFatalFailure();
  });
  EXPECT_EQ(end.rows, rows.size());
  EXPECT_FALSE(end.diverged);
  EXPECT_TRUE(end.warnings.empty());
}

// The proposed law shakes far below eta_min in a stiff hand without damping; `limpid run` warns,
// too.
TEST(SimulatedLoop, WarnsOfARunThatGivesEnergyOrMovesAsNoHandDoes) {
  LoopOptions options = table("proposed", 0.05);
  options.settings.insert(options.settings.end(), {"hand.stiffness=3000", "hand.damping=0"});
  const SimulatedLoop loop(options);
  const std::vector<double> path{0, 0.19, 0, 0, 1, 0.19, 0, -0.05, 4, 0.19, 0, -0.05};
  const auto end = loop.run(path, 0, [](std::span<const double>) { return true; });
  ASSERT_FALSE(end.warnings.empty());
  EXPECT_NE(end.warnings[0].find("not passive"), std::string::npos) << end.warnings[0];
}

TEST(SimulatedLoop, DerivesTipsAndTheTotalForceFromARow) {
  SimulatedLoop turns(table("predictive", 0.5)), slides(slide());
  for (SimulatedLoop* const loop : {&turns, &slides}) {
    const bool slide = loop == &slides;
    SimulatedLoop::Hand hand;
    hand.target = loop->tip();
    std::array<double, 15> before{};
    double pressed = 0;  // [N]
    for (int k = 0; k < 600; ++k) {
      hand.target[slide ? 0 : 2] += slide ? 1e-4 : -1e-4;
      const auto derived = loop->derived(loop->step(hand));
      const auto force = loop->row("/contact/force");
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(derived[6 + i], loop->proxy_tip()[i], 1e-15);
        const double mean = 0.5 * (derived[3 + i] + before[3 + i]);
        EXPECT_NEAR(mean, (derived[i] - before[i]) / 1e-3, k > 0 ? 2e-3 : 1e9) << k;
        EXPECT_NEAR(derived[12 + i], force[i] + force[3 + i] + force[6 + i] + force[9 + i], 1e-12);
      }
      before = derived;
      pressed = std::abs(derived[slide ? 12 : 14]);
    }
    EXPECT_GT(pressed, 0.1);
  }
  EXPECT_EQ(slides.derived_columns().at(1).path, "/device/tip_velocity");
  EXPECT_TRUE(std::isnan(turns.derived({})[0]));
}

TEST(Loops, SayNothingThatTheyDoNotKnowBeforeTheFirstTick) {
  LoopOptions options;
  options.arm = "omni.urdf";
  const std::array<double, 3> x{0.1, -0.78, 1.57};
  DeviceLoop device(options, x);
  SimulatedLoop simulated({});
  simulated.start(device.tip());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(simulated.tip()[i], device.tip()[i], 1e-6);
    EXPECT_EQ(device.proxy_tip()[i], device.tip()[i]);
  }
  EXPECT_GT(device.tip()[0], 0.1);
  for (int k = 0; k < 20; ++k) simulated.step({device.tip()});
  EXPECT_GT(simulated.time(), 0);
  simulated.start(device.tip());
  for (const Loop* loop : {static_cast<Loop*>(&device), static_cast<Loop*>(&simulated)}) {
    EXPECT_EQ(loop->time(), 0);
    EXPECT_EQ(loop->energy().controller, 0);
    for (const double each : loop->row()) EXPECT_TRUE(std::isnan(each));
  }
}

// A hand that is not a number lets go; a reading that is none moves nothing.
TEST(Loops, GoOnAfterNumbersThatAreNotFinite) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  SimulatedLoop loop({});
  EXPECT_THROW(loop.start({kNone, 0, 0}), LoopError);
  SimulatedLoop::Hand hand;
  hand.target = loop.tip();
  const std::array<double, 3> torque{0, kNone, 0};
  for (int k = 0; k < 100; ++k) {
    SimulatedLoop::Hand wrong = hand;
    if (k % 3 == 0) wrong.target[1] = kNone;
    if (k % 3 == 1) wrong.torque = torque;
    if (k % 3 == 2) wrong.grip = kNone;
    loop.step(wrong);
    loop.step(hand);
  }
  EXPECT_FALSE(loop.diverged());
  EXPECT_NEAR(loop.tip()[0], hand.target[0], 1e-3);

  std::array<double, 1> x{-0.01};
  DeviceLoop device(slide(), x);
  DeviceLoop::Reading reading;
  reading.position = x;
  for (int k = 0; k < 10; ++k) device.tick(reading);
  x[0] = kNone;
  EXPECT_EQ(device.tick(reading)[0], 0);
  x[0] = 0.005;
  for (int k = 0; k < 1000; ++k) device.tick(reading);
  EXPECT_FALSE(device.diverged());
  EXPECT_NEAR(device.tick(reading)[0], -2.5, 0.1) << "500 N/m at 5 mm";
}

// Pressed by far more than the tip's limit, slowly, the motors hold the limit: it is no debt.
TEST(DeviceLoop, HoldsTheTipsLimitHoweverDeepItIsPressed) {
  constexpr double kLink = 0.2;  // [m]
  ArmModel arm;
  arm.joints.resize(3);
  for (std::size_t i = 0; i < 3; ++i) {
    ArmJoint& joint = arm.joints[i];
    joint.name = fmt::format("j{}", i);
    joint.axis = i == 0 ? Point3{0, 0, 1} : Point3{0, 1, 0};
    joint.mass = 0.1;
    joint.center = {i == 0 ? 0 : kLink / 2, 0, 0};
    joint.inertia = {4e-4, 0, 0, 4e-4, 0, 4e-4};
    joint.effort = 3;
    joint.damping = 0.002;
  }
  arm.joints[2].position = arm.tip = {kLink, 0, 0};
  for (const double most : {3.0, 10.0}) {
    for (const double friction : {0.0, 0.4}) {
      LoopOptions options;
      options.arm_text = urdf_text(arm);
      options.scene_text =
          SceneBuilder()
              .plane("wall", {0.27, 0, 0}, {-1, 0, 0}, {1000, 0, friction, friction})
              .text();
      options.settings = {"coupling.kind=predictive"};
      options.limits.tip_force = most;
      std::array<double, 3> x{0, -0.9, 1.8};
      DeviceLoop loop(options, x);
      loop.arm();
      std::span<const double> torque;
      for (int k = 0; k < 4000; ++k) {
        const double part = std::clamp((k - 600) / 3000.0, 0.0, 1.0);
        x = {1e-7 * (k % 3), -0.9 + 0.2 * part, 1.8 - 0.4 * part};
        DeviceLoop::Reading reading;
        reading.position = x;
        reading.elapsed = 1e-3;
        torque = loop.tick(reading);
        ASSERT_GT(k < 700 ? 1 : loop.energy().reserve, 1e-3) << k << ", " << most << " N";
      }
      EXPECT_EQ(loop.force_text(), "motors at the tip's limit");
      const double upper = x[1], lower = x[1] + x[2];
      const double out = kLink * (std::cos(upper) + std::cos(lower));
      const double down = -kLink * (std::sin(upper) + std::sin(lower));
      const double elbow_x = -kLink * std::sin(lower), elbow_z = -kLink * std::cos(lower);
      const double det = down * elbow_z + out * elbow_x;
      const double Fx = (torque[1] * elbow_z + out * torque[2]) / det;
      const double Fz = (down * torque[2] - elbow_x * torque[1]) / det;
      EXPECT_NEAR(std::hypot(Fx, Fz), most, 0.01 * most);
    }
  }
}

TEST(SimulatedLoop, HasTheUnitsOfJointsThatSlide) {
  const SimulatedLoop loop(slide());
  std::map<std::string, std::string> units;
  for (const RowColumn& column : loop.columns()) units[column.path] = column.unit;
  EXPECT_EQ(units["/device/position"], "m");
  EXPECT_EQ(units["/hand/torque"], "N");
}

TEST(DeviceLoop, TakesMetresAndGivesNewtonsOfASlide) {
  std::array<double, 1> x{-0.01};
  DeviceLoop loop(slide(), x);
  DeviceLoop::Reading reading;
  reading.position = x;
  EXPECT_NEAR(loop.tick(reading)[0], 0, 1e-12) << "the wall is 1 cm away";
  double force = 0;
  for (int k = 0; k < 4000; ++k) {
    x[0] = std::min(0.004, x[0] + 1e-5);
    force = loop.tick(reading)[0];
  }
  EXPECT_NEAR(force, -500 * 0.004, 1e-6) << "a spring 4 mm deep";
  EXPECT_DOUBLE_EQ(loop.row("/device/position")[0], 0.004);
  EXPECT_NEAR(loop.row("/device/commanded_torque")[0], -2, 1e-6);
  EXPECT_NEAR(loop.tip()[0], 0.004, 1e-15);
}

TEST(DeviceLoop, MovesRealMotorsOnlyWhenArmedAndFadesIn) {
  LoopOptions options = slide();
  options.motors = Motors::real;
  options.limits.tip_force = 3;
  const std::array<double, 1> x{0.004};
  DeviceLoop loop(options, x);
  EXPECT_EQ(rest(loop, x, 1), 0) << "nobody armed it";
  EXPECT_THAT(loop.force_text(), HasSubstr("not armed"));
  loop.arm();
  rest(loop, x, 0.1);
  EXPECT_TRUE(loop.armed());
  EXPECT_GT(loop.force_share(), 0.1);
  EXPECT_LT(loop.force_share(), 0.4) << "it takes half a second";
  EXPECT_NEAR(rest(loop, x, 1), -2, 0.01);
  EXPECT_EQ(loop.force_text(), "");
  loop.cut();
  EXPECT_EQ(rest(loop, x, 0.001), 0) << "at once";
  EXPECT_FALSE(loop.armed());
}

TEST(DeviceLoop, KeepsToTheLimitAtTheTip) {
  LoopOptions options = slide();
  options.motors = Motors::real;
  options.limits.tip_force = 1;
  const std::array<double, 1> x{0.004};
  DeviceLoop loop(options, x);
  loop.arm();
  EXPECT_NEAR(rest(loop, x, 2), -1, 1e-6) << "the wall would give 2 N";
  EXPECT_EQ(loop.force_text(), "motors at the tip's limit");
}

TEST(DeviceLoop, SaysThatAMotorGivesAllItCan) {
  std::array<double, 1> x{0.004};
  DeviceLoop loop(slide(), x);
  rest(loop, x, 0.5);
  EXPECT_EQ(loop.force_text(), "") << "2 of 8 N";
  for (; x[0] < 0.02; x[0] += 1e-5) rest(loop, x, 1e-3);
  EXPECT_NEAR(rest(loop, x, 0.5), -8, 1e-9);
  EXPECT_EQ(loop.force_text(), "motors at their limit");
}

// Real motors of so much effort [N], an arm of so much damping [N s/m].
LoopOptions before_wall(double effort, double damping, double stiffness, const char* law) {
  LoopOptions options = slide_at_wall(effort, damping, 0.25, stiffness);
  options.settings = {std::string("coupling.kind=") + law, "model.delay_most=0"};
  return options;
}

// A hand that goes where it wants, and what the motors give it beyond what the arm's damping takes.
class Leading {
 public:
  Leading(DeviceLoop& loop, double x, double damping) : loop_(loop), x_(x), b_(damping) {}

  void tick(double x, int periods = 1) {
    const double d = x - x_, T = periods * 1e-3;
    given_ += force_ * d - b_ * d * d / T;
    x_ = x;
    DeviceLoop::Reading reading;
    reading.position = std::span(&x_, 1);
    reading.hand = holds;
    reading.elapsed = T;
    force_ = loop_.tick(reading)[0];
  }
  void go(double to, double speed) {
    const double step = speed * 1e-3;
    while (std::abs(x_ - to) > step) tick(x_ + (to > x_ ? step : -step));
    tick(to);
  }
  // Trembles as hands do.
  void rest(double seconds) {
    const double at = x_;
    for (int k = 0; k < std::lround(1e3 * seconds); ++k) tick(at + 1e-6 * (k % 2));
    tick(at);
  }
  double force() const { return force_; }
  double given() const { return given_; }  // [J]
  double at() const { return x_; }

  bool holds = true;

 private:
  DeviceLoop& loop_;
  double x_, b_, force_ = 0, given_ = 0;
};

// Goes into a wall without force and out of it with force, again and again. Nobody has pressed the
// wall, so it has nothing to give but what the account begins with.
TEST(DeviceLoop, GivesNothingOfAWallThatWasEnteredWithoutForce) {
  for (const bool by_switch : {true, false}) {
    DeviceLoop loop(before_wall(10, 0.5, 2000, "predictive"), std::array{-0.002});
    loop.arm();
    Leading hand(loop, -0.002, 0.5);
    hand.rest(1);
    for (int round = 0; round < 4; ++round) {
      hand.holds = !by_switch;
      if (!by_switch) loop.cut();
      hand.tick(hand.at());
      hand.go(0.004, 0.02);
      hand.holds = true;
      if (!by_switch) loop.arm();
      hand.rest(0.48);  // shorter than what forgives
      hand.go(-0.002, 0.02);
      const int armed = by_switch ? 1 : 2 + round;
      EXPECT_LT(hand.given(), 5.2e-3 * armed) << by_switch << " " << round;
    }
  }
}

TEST(DeviceLoop, GivesNoMoreThanItsAccountWhereItBeginsInAWall) {
  for (const auto& [deep, stiffness] : {std::pair(0.005, 2000.0), {0.02, 10000.0}}) {
    for (const Motors motors : {Motors::simulated, Motors::real}) {
      LoopOptions options = before_wall(10, 0.5, stiffness, "predictive");
      options.motors = motors;
      DeviceLoop loop(options, std::array{deep});
      loop.arm();
      Leading hand(loop, deep, 0.5);
      hand.rest(0.48);
      hand.go(-0.002, 0.02);
      EXPECT_LT(hand.given(), 5.2e-3) << deep;
    }
  }
}

// Torque that goes on after the hand has left the wall would be energy that nobody counted.
TEST(DeviceLoop, LetsGoOfAHandThatLeavesAWallAtOnce) {
  for (const double speed : {0.2, 0.5, 1.0}) {
    DeviceLoop loop(before_wall(9, 0.1, 3000, "predictive"), std::array{-0.001});
    loop.arm();
    Leading hand(loop, -0.001, 0.1);
    hand.rest(1.2);
    hand.go(0.003, 0.02);
    hand.rest(0.1);
    const double pressed = hand.force();
    EXPECT_NEAR(pressed, -9, 0.1);
    hand.go(-0.03, speed);
    // The work of the tick in which it leaves comes before any answer.
    EXPECT_LT(hand.given(), 5e-3 + 9 * speed * 1e-3) << speed;
    hand.go(-0.001, 0.1);
    hand.rest(0.3);
    hand.go(0.003, 0.02);
    hand.rest(0.1);
    EXPECT_LT(hand.force(), 0.9 * pressed) << speed << ": the wall is there again";
  }
}

// A tick of each touch comes 2 to 5 ms late, which is no stall. The hand moves as it gains most.
TEST(DeviceLoop, KeepsEnergyBoundedWhereTicksAreLate) {
  for (const int late : {2, 5}) {
    for (const Motors motors : {Motors::simulated, Motors::real}) {
      LoopOptions options = before_wall(20, 1, 1500, "eba");
      options.motors = motors;
      DeviceLoop loop(options, std::array{-0.001});
      loop.arm();
      Leading hand(loop, -0.001, 1);
      hand.rest(1.2);
      std::array<double, 2> halves{};
      for (int round = 0; round < 60; ++round) {
        hand.go(0.002, 0.02);
        hand.rest(0.05);
        for (int periods = late; hand.at() > -0.0001; periods = 1) {
          const double wanted = hand.force() < 0 ? hand.force() / 2 : -0.02;
          hand.tick(std::max(hand.at() + std::max(wanted, -2.0) * 1e-3 * periods, -0.0001),
                    periods);
        }
        hand.go(-0.001, 0.02);
        halves[round < 30 ? 0 : 1] = hand.given();
      }
      EXPECT_LT(halves[1], 6e-3) << late;
      EXPECT_LT(halves[1] - halves[0], 1e-3) << late << ": it does not add up";
    }
  }
}

// Energy that nobody knows to be lost is not lent to the law.
TEST(DeviceLoop, MakesUpNoDamping) {
  LoopOptions options = slide();
  const std::string known = "damping=\"0.5\"";
  options.arm_text.replace(options.arm_text.find(known), known.size(), "damping=\"0\"");
  const DeviceLoop loop(options, std::array{0.0});
  EXPECT_TRUE(std::isnan(loop.get("device.damping")));
  EXPECT_THAT(loop.notes(), testing::Contains(HasSubstr("have no damping")));
  const SimulatedLoop simulated(options);
  EXPECT_GT(simulated.get("device.damping"), 0);
}

// A spring of the wall's k and the coupling's k_vc in a row: the proxy is where both hold as much.
TEST(DeviceLoop, TellsWhereTheProxysTipIs) {
  LoopOptions options = slide();
  options.motors = Motors::simulated;
  options.settings = {"coupling.kind=standard"};
  const std::array<double, 1> x{0.01};
  DeviceLoop loop(options, std::array{-0.01});
  EXPECT_EQ(loop.proxy_tip(), loop.tip());
  DeviceLoop::Reading reading;
  reading.position = x;
  std::span<const double> torque;
  for (int k = 0; k < 5000; ++k) torque = loop.tick(reading);
  EXPECT_NEAR(loop.tip()[0], 0.01, 1e-12);
  EXPECT_NEAR(loop.proxy_tip()[0], -torque[0] / 500, 1e-5);
  EXPECT_NEAR(loop.proxy_tip()[0], loop.row("/proxy/position")[0], 1e-9);
}

TEST(DeviceLoop, RecordsWhatItsRowsWere) {
  const test::TempDir dir;
  const auto file = (dir / "own.h5").string();
  std::array<double, 1> x{-0.01};
  DeviceLoop loop(slide(), x);
  loop.record(file);
  std::vector<double> forces;
  DeviceLoop::Reading reading;
  reading.position = x;
  for (int k = 0; k < 2000; ++k) {
    if (k == 700) loop.set("coupling.eta", 0.5);
    x[0] += 1e-5;
    forces.push_back(loop.tick(reading)[0]);
  }
  EXPECT_EQ(loop.finish_recording(), 0u);
  const Session session = read_session(file);
  ASSERT_EQ(session.size(), forces.size());
  for (std::size_t k = 0; k < forces.size(); ++k) {
    ASSERT_NEAR(session.at(k, Column::commanded_torque)[0], forces[k] * kSlideUnit, 1e-12);
  }
  ASSERT_EQ(session.changes.size(), 1u);
  EXPECT_EQ(session.changes[0].row, 700u);
  EXPECT_EQ(session.changes[0].setting, "coupling.eta = 0.5");
  EXPECT_THROW(loop.record(file), LoopError) << "it is there";
  EXPECT_THROW(loop.finish_recording(), LoopError);
}

TEST(SimulatedLoop, MovesABallThatWasBuilt) {
  SceneBuilder scene;
  scene.ball("ball", {0.19, 0, 0.2}, 0.01, 0.02);
  LoopOptions options;
  options.scene_text = scene.text();
  SimulatedLoop loop(options);
  const Point3 tip = loop.tip();
  SimulatedLoop::Hand hand;
  hand.target = tip;
  for (int k = 0; k < 100; ++k) loop.step(hand);
  // The row has the state at its beginning, after 99 ticks of 1 ms.
  const double t = 0.099;
  EXPECT_NEAR(loop.row("/objects/pose")[2], 0.2 - 0.5 * 9.81 * t * t, 9.81 * t * 1e-3);
}

TEST(Loops, KnowTheirColumnsAndSettings) {
  const DeviceLoop loop(slide(), std::array{0.0});
  std::size_t numbers = 0;
  for (const RowColumn& each : loop.columns()) {
    EXPECT_EQ(each.offset, numbers) << each.path;
    numbers += each.width;
    EXPECT_FALSE(each.what.empty());
    const auto product =
        std::accumulate(each.shape.begin(), each.shape.end(), std::size_t{1}, std::multiplies<>());
    EXPECT_EQ(product, each.width) << each.path;
  }
  EXPECT_EQ(numbers, loop.row().size());
  const auto all = setting_list();
  const auto kind = std::ranges::find(all, "coupling.kind", &SettingInfo::key);
  ASSERT_NE(kind, all.end());
  EXPECT_THAT(kind->words, testing::Contains("predictive"));
  EXPECT_NE(library_version(), "");
}

TEST(Loops, TellTheShapeOfEachColumn) {
  SceneBuilder scene;
  scene.ball("a", {0.19, 0, 0.2}, 0.01, 0.02).ball("b", {0.19, 0, 0.3}, 0.01, 0.02);
  LoopOptions options = slide();
  options.scene_text = scene.text();
  const DeviceLoop loop(options, std::array{0.0});
  std::map<std::string, std::vector<std::size_t>> shapes;
  for (const auto* all : {&loop.columns(), &loop.derived_columns()}) {
    for (const RowColumn& each : *all) shapes[each.path] = each.shape;
  }
  using Shape = std::vector<std::size_t>;
  EXPECT_EQ(shapes.at("/time"), Shape{});
  EXPECT_EQ(shapes.at("/energy/objects"), Shape{});
  EXPECT_EQ(shapes.at("/device/position"), Shape{1}) << "also of a single joint";
  EXPECT_EQ(shapes.at("/hand/pull_point"), Shape{3});
  EXPECT_EQ(shapes.at("/device/tip"), Shape{3});
  EXPECT_EQ(shapes.at("/device/orientation"), Shape{4});
  EXPECT_EQ(shapes.at("/contact/force"), (Shape{4, 3}));
  EXPECT_EQ(shapes.at("/objects/pose"), (Shape{2, 7}));
  EXPECT_EQ(shapes.at("/objects/velocity"), (Shape{2, 6}));
}

TEST(ArmModel, IsTheArmThatItsTextSays) {
  ArmModel model;
  for (int i = 0; i < 3; ++i) {
    ArmJoint joint;
    joint.name = fmt::format("joint {}", i);
    joint.position = {0.01 * i, 0.02, 0.13};
    joint.rpy = {0.3, -0.2 * i, 0.1};
    joint.axis = i == 1 ? Point3{0, 2, 0} : Point3{0, 0, 1};
    joint.effort = 1 + i;
    joint.damping = 0.003;
    joint.friction = 0.001 * i;
    joint.mass = 0.1 + 0.01 * i;
    joint.center = {0.001, 0.002, 0.03};
    joint.inertia = {1e-4, 1e-5, 2e-5, 2e-4, 3e-5, 3e-4};
    model.joints.push_back(joint);
  }
  model.tip = {0, 0, 0.1};
  const ArmDescription arm = parse_urdf(urdf_text(model), "text", {});
  ASSERT_EQ(arm.dof(), 3);
  EXPECT_EQ(arm.joints[2].effort, 3);
  EXPECT_EQ(arm.joints[2].friction, 0.002);
  EXPECT_EQ(arm.links[1].mass, 0.11);
  EXPECT_LT((arm.joints[1].axis - Vec3::UnitY()).norm(), 1e-15);
  EXPECT_LT((arm.joints[1].origin.translation() - Vec3(0.01, 0.02, 0.13)).norm(), 1e-15);
  // Roll, pitch and yaw about fixed axes, written out.
  const Mat3 turned =
      (Eigen::AngleAxisd(0.1, Vec3::UnitZ()) * Eigen::AngleAxisd(-0.2, Vec3::UnitY()) *
       Eigen::AngleAxisd(0.3, Vec3::UnitX()))
          .toRotationMatrix();
  EXPECT_LT((arm.joints[1].origin.linear() - turned).norm(), 1e-9);
  EXPECT_EQ(arm.links[0].inertia(0, 1), 1e-5);
  EXPECT_EQ(arm.links[0].inertia(1, 2), 3e-5);
  EXPECT_LT((arm.tip.translation() - Vec3(0, 0, 0.1)).norm(), 1e-15);
}

}  // namespace
}  // namespace limpid
