#include "app/sweep/measures.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "app/run/analysis.h"
#include "app/sweep/measure_point.h"
#include "tests/app/sweep/plans.h"
#include "tests/support/built_in.h"
#include "tests/support/objects.h"

namespace limpid {
namespace {

// Values that a plan measures at a point, by name.
class Measures : public testing::Test {
 protected:
  void read(const std::string& text) { plan_ = test::sweep_plan(dir_, text); }
  double measured(std::uint64_t point, const std::string& name) {
    const auto values = measure_point(plan_, point, stop_);
    const auto columns = measured_columns(plan_);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (columns[c].name == name) return (*values)[c];
    }
    ADD_FAILURE() << name;
    return 0;
  }
  test::TempDir dir_;
  SweepPlan plan_;
  std::atomic<bool> stop_{false};
};

// Angles of an arm that slides are metres, torques are newtons. k_vc stands for 100 times as
// many newtons per metre, so that the same compliance holds: x_E/f2 = 1/k_vc.
TEST_F(Measures, AreInMetresAndNewtonsOfAnArmThatSlides) {
  read(R"(device = "omega.urdf"
hand = { tap = 2 }
measure = ["error_largest", "error_slope", "contact_largest", "human_rms", "felt_damping", "wall"]
set = ["coupling.kind = standard"]
axis = [{ key = "coupling.k_vc", values = [5] }]
)");
  std::map<std::string, std::string> units;
  for (const SweepColumn& each : measured_columns(plan_)) units[each.name] = each.unit;
  EXPECT_EQ(units["error_largest"], "m");
  EXPECT_EQ(units["error_slope"], "m/N");
  EXPECT_EQ(units["contact_largest"], "N");
  EXPECT_EQ(units["human_rms"], "N");
  EXPECT_EQ(units["felt_damping"], "N s/m");
  EXPECT_EQ(units["wall"], "N/m");
  EXPECT_NEAR(measured(0, "error_slope"), 1 / 500.0, 0.05 / 500);
  EXPECT_GT(measured(0, "contact_largest"), 1) << "a press of 2 N";
  EXPECT_LT(measured(0, "contact_largest"), 10);
}

TEST_F(Measures, OfArmsThatSlideAndTurnNameBothUnits) {
  read(R"(hand = { tap = 2 }
measure = ["human_rms"]
axis = [{ key = "device", values = ["omega.urdf", "omni.urdf"] }]
)");
  const std::string unit = measured_columns(plan_)[0].unit;
  EXPECT_TRUE(unit == "N or N m" || unit == "N m or N") << unit;
}

// (1) at rest: k_vc x_E = f2.
TEST_F(Measures, ErrorOverContactOfTheStandardCouplingIsItsCompliance) {
  read(R"(hand = "touch.csv"
seconds = 4
measure = ["error_slope"]
set = ["coupling.kind = standard"]
axis = [{ key = "coupling.k_vc", values = [5, 10, 20] }]
)");
  for (std::uint64_t i = 0; i < 3; ++i) {
    const double compliance = 1 / plan_.axes[0].values[i];
    EXPECT_NEAR(measured(i, "error_slope"), compliance, 0.02 * compliance);
  }
}

// A wall behind the spring of the standard coupling: the stiffness is 1 / (1 + K lever^2 / k_vc) of
// its own.
TEST_F(Measures, WallThatIsTappedIsFeltThroughTheCouplingsSpring) {
  read(R"(hand = { tap = 1 }
seconds = 2
measure = ["wall", "wall_felt", "wall_rattle"]
set = ["coupling.kind = standard"]
axis = [{ key = "scene.stiffness", values = [100, 400] }]
)");
  const RunPlan run = run_of(plan_, 0);
  const Vec3 n = test::shape<Plane>(run.document.scene).normal;
  const Eigen::MatrixXd J = arm_at(run.arm, rest_pose(run.arm)).J;
  const double lever2 = (J.transpose() * n).squaredNorm();
  for (std::uint64_t i = 0; i < 2; ++i) {
    const double wall = plan_.axes[0].values[i];
    EXPECT_EQ(measured(i, "wall"), wall);
    EXPECT_NEAR(measured(i, "wall_felt"), 1 / (1 + wall * lever2 / Parameters{}.k_vc), 0.02);
    EXPECT_LT(measured(i, "wall_rattle"), 0.05);
  }
}

TEST_F(Measures, OfAWallAreNoneWhereThereIsNoneOrMoreThanOne) {
  read(R"(scene = "free.toml"
hand = "free.csv"
seconds = 0.1
measure = ["wall", "wall_felt", "wall_rattle", "rate_hardness", "ripple"]
axis = [{ key = "coupling.eta", values = [1] }]
)");
  for (const char* name : {"wall", "wall_felt", "wall_rattle", "rate_hardness", "ripple"}) {
    EXPECT_TRUE(std::isnan(measured(0, name))) << name;
  }
}

// Within its band the predictive law shows eta times the arm's own inertia.
TEST_F(Measures, InertiaFeltInFreeMotionIsEta) {
  read(R"(scene = "free.toml"
hand = "free.csv"
measure = ["felt_inertia", "felt_stiffness"]
set = ["coupling.kind = predictive"]
axis = [{ key = "coupling.eta", values = [0.5, 1, 3] }]
)");
  for (std::uint64_t i = 0; i < 3; ++i) {
    const double eta = plan_.axes[0].values[i];
    EXPECT_NEAR(measured(i, "felt_inertia"), eta, 0.02 * eta);
    EXPECT_TRUE(std::isnan(measured(i, "felt_stiffness"))) << "nothing was touched";
  }
}

// Damping under the proposed law: eta (b_d + b_v), plus k_vc T/2 for the lag of (1) behind (2).
TEST_F(Measures, DampingFeltInFreeMotionIsThatOfDeviceAndProxy) {
  read(R"(scene = "free.toml"
hand = "free.csv"
measure = ["felt_damping"]
axis = [{ key = "coupling.eta", values = [0.7, 1, 2] }]
)");
  const Parameters p;
  const double b = test::omni().joints[0].damping + p.b_v + p.k_vc * p.tick / 2;
  for (std::uint64_t i = 0; i < 3; ++i) {
    const double eta = plan_.axes[0].values[i];
    EXPECT_NEAR(measured(i, "felt_damping"), eta * b, 0.02 * eta * b);
  }
}

// The wall behind the coupling's spring, from the tip: 1/K = 1/K_wall + n'JJ'n / k_vc. A rough wall
// would hold the tip across n as well.
TEST_F(Measures, StiffnessFeltIsTheWallBehindTheSpring) {
  std::ofstream(dir_ / "smooth.toml")
      << "[[plane]]\nname = \"table top\"\npoint = [0.2, 0.0, -0.04]\nnormal = [0.0, 0.0, 1.0]\n"
         "stiffness = 600\n";
  std::ofstream(dir_ / "press.csv")
      << "time_s,x_m,y_m,z_m\n0,0.19,0,-0.0395\n3,0.19,0,-0.0435\n6,0.19,0,-0.0395\n";
  read(R"(scene = "smooth.toml"
hand = "press.csv"
measure = ["felt_stiffness"]
set = ["hand.stiffness = 1000"]
axis = [{ key = "coupling.kind", values = ["standard", "predictive"] },
        { key = "scene.stiffness", values = [300, 600] }]
)");
  const RunPlan run = run_of(plan_, 0);
  const Vec3 pressed(0.19, 0, -0.041);
  const ArmAt arm = arm_at(run.arm, rest_at(run.arm, pressed).x1);
  const double spring = (arm.J * arm.J.transpose())(2, 2) / run.parameters.k_vc;
  for (const std::uint64_t wall : {0, 1}) {
    const double K = plan_.axes[1].values[wall], in_series = 1 / (1 / K + spring);
    EXPECT_NEAR(measured(wall, "felt_stiffness"), in_series, 0.05 * in_series);
    EXPECT_NEAR(measured(2 + wall, "felt_stiffness"), K, 0.05 * K);
  }
}

// Rows that are made by hand: `fill` sets some of their numbers, the rest stays 0. The arm rests.
RunMeter metered(
    std::uint64_t rows, int bodies,
    const std::function<void(std::uint64_t, const RowLayout&, std::span<double>)>& fill,
    std::uint64_t planned = 0) {
  const ArmDescription omni = test::omni();
  const RowLayout layout(omni.dof(), bodies);
  RunMeter meter(omni, 0.001, planned > 0 ? planned : rows, false, nullptr, bodies);
  std::vector<double> row(static_cast<std::size_t>(layout.stride()));
  for (std::uint64_t k = 0; k < rows; ++k) {
    std::ranges::fill(row, 0);
    layout.in(std::span(row), Column::time)[0] = 0.001 * static_cast<double>(k);
    fill(k, layout, row);
    meter.add(row);
  }
  return meter;
}

// Energies over the rows, by a part of the run from 0 to 1 [J].
RunMeter with_energies(int bodies, const std::function<double(double)>& port,
                       const std::function<double(double)>& to_objects,
                       const std::function<double(double)>& gain) {
  constexpr std::uint64_t kRows = 200;
  return metered(kRows, bodies,
                 [&](std::uint64_t k, const RowLayout& layout, std::span<double> row) {
                   const double part = static_cast<double>(k) / kRows;
                   layout.in(row, Column::energy_port)[0] = port(part);
                   layout.in(row, Column::energy_commanded)[0] = 2 * port(part);
                   if (bodies == 0) return;
                   layout.in(row, Column::energy_to_objects)[0] = to_objects(part);
                   layout.in(row, Column::objects_gain)[0] = gain(part);
                 });
}

double peak_at_the_third(double part) { return 0.03 - std::abs(part - 0.3); }
double nothing(double) { return 0; }

TEST(RunMeter, TakesTheHighestEnergiesNotTheLast) {
  const RunMeter peak = with_energies(0, peak_at_the_third, nothing, nothing);
  EXPECT_NEAR(peak.highest_port(), 0.03, 1e-12);
  EXPECT_NEAR(peak.highest_commanded(), 0.06, 1e-12);
  EXPECT_NEAR(peak.highest_beyond(), 0.03, 1e-12) << "without bodies all is beyond";
  const RunMeter below = with_energies(
      0, [](double part) { return -1 - part; }, nothing, nothing);
  EXPECT_EQ(below.highest_port(), 0) << "nothing was given";
  EXPECT_EQ(below.highest_commanded(), 0);
}

TEST(RunMeter, CountsWhatTheHandGetsBeyondWhatBodiesGave) {
  // Bodies give 0.5 J of what the hand gets; 0.02 J at a third of the run come from nowhere.
  const RunMeter meter = with_energies(
      2, [](double part) { return 0.5 * part + std::max(0.0, peak_at_the_third(part) - 0.01); },
      [](double part) { return -0.5 * part; },
      [](double part) { return peak_at_the_third(part) / 3; });
  EXPECT_NEAR(meter.highest_beyond(), 0.02, 1e-12);
  EXPECT_NEAR(meter.bodies_gain(), 0.01, 1e-12);
  EXPECT_GT(meter.highest_port(), 0.49);
}

TEST(RunMeter, TakesTheLongestWayOfAnyBody) {
  const RunMeter meter = metered(100, 2, [](std::uint64_t k, const RowLayout& layout, auto row) {
    const auto pose = layout.in(row, Column::body_pose);
    const Vec3 way = k == 40 ? Vec3(0.003, -0.004, 0.012) : Vec3(Vec3::Zero());
    for (int i = 0; i < 3; ++i) {
      pose[static_cast<std::size_t>(i)] = 0.1 * i + 0.001;
      pose[kPoseNumbers + static_cast<std::size_t>(i)] = 0.2 - 0.1 * i + way[i];
    }
  });
  EXPECT_NEAR(meter.bodies_moved(), 0.013, 1e-12) << "there and back";
  const RunMeter none = metered(100, 0, [](auto, const RowLayout&, auto) {});
  EXPECT_TRUE(std::isnan(none.bodies_moved()));
  EXPECT_TRUE(std::isnan(none.bodies_gain()));
}

// Whether the measure takes a speed over the run, by its part from 0 to 1, to die away.
bool dies(const std::function<double(double)>& speed, std::uint64_t rows = 200,
          std::uint64_t planned = 200) {
  return metered(
             rows, 0,
             [&](std::uint64_t k, const RowLayout& layout, std::span<double> row) {
               const double part = (static_cast<double>(k) + 0.5) / static_cast<double>(planned);
               layout.in(row, Column::device_velocity)[1] = speed(part);
             },
             planned)
      .dies_away();
}

TEST(RunMeter, SaysThatAMotionDiesAwayWhereItDoes) {
  EXPECT_TRUE(dies([](double part) { return std::exp(-5 * part); }));
  EXPECT_FALSE(dies([](double part) { return std::exp(2 * part); }));
  EXPECT_FALSE(dies([](double) { return 0.3; }));
  EXPECT_FALSE(dies([](double part) { return part < 0.9 ? std::exp(-9 * part) : 0.5; }))
      << "less than at first, and more than in the middle";
  EXPECT_TRUE(dies([](double part) {
    return part < 0.2 ? 1.0 : part < 0.9 ? 1e-9 : 1e-8;
  })) << "nothing is left of it, whatever that does";
  EXPECT_FALSE(dies([](double part) { return std::exp(-5 * part); }, 199)) << "it ended early";
}

// A tip that trembles at 80 Hz about a joint has an rms speed of r A w / sqrt 2. At 2 Hz it does
// not count.
TEST_F(Measures, ChatterIsTheFastPartOfTheTipsSpeed) {
  const ArmDescription omni = test::omni();
  const RowLayout layout(omni.dof());
  const Arm<kAnyDof> arm(omni);
  constexpr double T = 0.001, A = 1e-4;
  constexpr std::uint64_t rows = 4000;
  const Eigen::VectorXd x0 = rest_pose(omni);
  const double r = std::hypot(arm.tip_at(x0).x(), arm.tip_at(x0).y());
  for (const double f : {80.0, 2.0}) {
    const double w = 2 * std::numbers::pi * f;
    RunMeter meter(omni, T, rows, true);
    std::vector<double> row(static_cast<std::size_t>(layout.stride()));
    for (std::uint64_t k = 0; k < rows; ++k) {
      Eigen::VectorXd x = x0;
      x[0] += A * std::sin(w * T * static_cast<double>(k));
      std::ranges::copy(x, layout.in(std::span(row), Column::device_position).begin());
      std::ranges::copy(x, layout.in(std::span(row), Column::proxy_position).begin());
      meter.add(row);
    }
    // Speed by differences falls short of the true one by sin(wT/2) / (wT/2).
    const double expected = r * A * w / std::sqrt(2) * std::sin(w * T / 2) / (w * T / 2);
    EXPECT_NEAR(meter.chatter(), f > 20 ? expected : 0, 0.01 * expected) << f;
  }
}

// A tip that goes straight into a wall, and motors that push along its normal as `force` says [N].
// Depth and time are those of the row.
struct Pushed {
  double rate_hardness, ripple;
};
Pushed pushed_into_a_wall(double T, double speed, double seconds,
                          const std::function<double(double depth, double t)>& force) {
  const ArmDescription omni = test::omni();
  const RowLayout layout(omni.dof());
  const Arm<kAnyDof> arm(omni);
  Eigen::VectorXd x = rest_pose(omni);
  const Vec3 start = arm.tip_at(x), out = Vec3(1, 2, -1).normalized();
  constexpr double kAway = 0.0031;  // [m]
  const Object wall{"", pose_at(start - kAway * out), Plane{out}, {500}};
  const auto rows = static_cast<std::uint64_t>(std::llround(seconds / T));
  HardnessMeter meter(omni, wall, T, rows / 2);
  std::vector<double> row(static_cast<std::size_t>(layout.stride()));
  for (std::uint64_t k = 0; k < rows; ++k) {
    const double t = static_cast<double>(k) * T, way = std::min(speed * t, kAway + 0.004);
    x = rest_at(omni, start - way * out).x1;
    const Eigen::VectorXd tau =
        arm_at(omni, x).J.transpose() * (force(way - kAway, t) * out + Vec3(2, -1, 0) * 0.3);
    std::ranges::copy(x, layout.in(std::span(row), Column::device_position).begin());
    std::ranges::copy(tau, layout.in(std::span(row), Column::motor_torque).begin());
    meter.add(layout, row);
  }
  return {meter.rate_hardness(), meter.ripple()};
}

// A spring K is K; behind a lag of t_l only 1 - t_l/W of it, W the initial time; a damper b gives
// at once what counts as b/W.
TEST(Hardness, IsTheRateOfTheForceOverTheSpeed) {
  for (const double T : {0.001, 0.0005}) {
    for (const double speed : {0.05, 0.2}) {
      const auto measured = [&](const std::function<double(double, double)>& force) {
        return pushed_into_a_wall(T, speed, 0.4, force).rate_hardness;
      };
      EXPECT_NEAR(measured([](double d, double) { return 700 * std::max(0.0, d); }), 700, 1);
      const double lag = 0.002, W = HardnessMeter::kInitial;
      // The first row at or after W is up to a tick later.
      EXPECT_NEAR(measured([&](double d, double) { return 700 * std::max(0.0, d - lag * speed); }),
                  700 * (1 - lag / W), 700 * T / W * lag / W + 1);
      EXPECT_NEAR(measured([&](double d, double) { return d > 0 ? 3 * speed : 0; }), 3 / W,
                  3 / W * T / W + 1);
      EXPECT_NEAR(measured([](double d, double) { return 1.5 + 700 * std::max(0.0, d); }), 700, 1)
          << "what motors gave before does not count";
    }
  }
}

TEST(Hardness, IsNoneWithoutAFirstContact) {
  EXPECT_TRUE(std::isnan(
      pushed_into_a_wall(0.001, 0.001, 0.4, [](double, double) { return 1; }).rate_hardness));
}

// A sine of amplitude A has an rms of A/sqrt 2, whatever force it is about.
TEST(Ripple, IsTheRmsOfTheForceAboutItsMean) {
  for (const double mean : {0.0, 3.0}) {
    const Pushed found = pushed_into_a_wall(0.001, 0.1, 0.8, [&](double, double t) {
      return mean + (t > 0.35 ? 0.2 * std::sin(2 * std::numbers::pi * 50 * t) : 5);
    });
    EXPECT_NEAR(found.ripple, 0.2 / std::sqrt(2), 1e-3);
  }
}

// A wall on the device itself: K less what a light tip is slowed within the initial time; the
// spring of the standard law in a row with it is softer, and eba shows no more than it can pay.
TEST_F(Measures, HardnessOfLawsThatRenderTheSameWall) {
  read(R"(hand = { tap = 1 }
seconds = 2
measure = ["rate_hardness", "ripple"]
axis = [{ key = "coupling.kind", values = ["direct", "standard", "eba"] },
        { key = "scene.stiffness", values = [400, 3000] }]
)");
  EXPECT_NEAR(measured(0, "rate_hardness"), 400, 0.2 * 400);
  EXPECT_GT(measured(0, "rate_hardness"), 1.5 * measured(2, "rate_hardness"));
  EXPECT_LT(measured(5, "rate_hardness"), 700) << "2 b_d/T at the tip is 500 N/m";
  EXPECT_LT(measured(0, "ripple"), 0.01);
}

TEST_F(Measures, OfALoopThatDivergedSayWhen) {
  read(R"(scene = "free.toml"
hand = { at = [0.19, 0, 0], jump = [1e-4, 1e-4, 1e-4] }
seconds = 3
set = ["hand.damping = 0", "hand.stiffness = 3000", "device.torque_limit = 1000"]
measure = ["diverged", "diverged_at", "seconds", "stable", "passive", "energy_highest"]
axis = [{ key = "coupling.eta", values = [0.1, 1] }]
)");
  EXPECT_EQ(measured(0, "diverged"), 1);
  EXPECT_LT(measured(0, "diverged_at"), measured(0, "seconds"));
  EXPECT_LT(measured(0, "seconds"), 3);
  EXPECT_EQ(measured(0, "stable") + measured(0, "passive"), 0);
  EXPECT_EQ(measured(1, "diverged"), 0);
  EXPECT_TRUE(std::isnan(measured(1, "diverged_at")));
  EXPECT_NEAR(measured(1, "seconds"), 3, 1e-9);
  EXPECT_EQ(measured(1, "stable"), 1);
}

// The paper's E_c counts no damping of the device; by (25) it stays below zero from eta_min on.
TEST_F(Measures, OfThePapersEnergyHaveItsHighestValue) {
  read(R"(hand = "circle.csv"
set = ["coupling.kind = \"proposed\""]
measure = ["commanded_highest", "energy_commanded", "energy_highest"]
axis = [{ key = "coupling.eta", values = [0.4, 1] }]
)");
  EXPECT_GT(measured(0, "commanded_highest"), 1e-4);
  EXPECT_LT(measured(1, "commanded_highest"), 1e-6);
  for (const std::uint64_t i : {0, 1}) {
    EXPECT_GE(measured(i, "commanded_highest"), measured(i, "energy_commanded"));
    EXPECT_GE(measured(i, "commanded_highest"), measured(i, "energy_highest"));
  }
}

TEST_F(Measures, StopRulesEndARunEarly) {
  read(R"(hand = "touch.csv"
seconds = 4
measure = ["contact_largest", "seconds"]
stop = [{ measure = "contact_largest", above = 0.05, after = 1.5 }]
)");
  EXPECT_GE(measured(0, "seconds"), 1.5);
  EXPECT_LT(measured(0, "seconds"), 4);
  EXPECT_GT(measured(0, "contact_largest"), 0.05);
}

}  // namespace
}  // namespace limpid
