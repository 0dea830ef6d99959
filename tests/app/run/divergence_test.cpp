#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "app/run/summary.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

using test::plan;
using test::Rows;
using testing::HasSubstr;
using testing::Not;

const RowLayout kLayout(3);
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// A row at rest, with at most one number set.
std::vector<double> row(double time, Column column = Column::kind, int joint = 0,
                        double value = 0) {
  std::vector<double> values(static_cast<std::size_t>(kLayout.stride()), 0);
  kLayout.in(std::span(values), Column::time)[0] = time;
  kLayout.in(std::span(values), column)[static_cast<std::size_t>(joint)] = value;
  return values;
}

DivergenceWatch after(std::initializer_list<std::vector<double>> rows) {
  DivergenceWatch watch(kLayout);
  for (const auto& values : rows) watch.add(values);
  return watch;
}

// A watch after a wild row, so many calm ones, and growing wild ones.
DivergenceWatch swinging(int calm) {
  DivergenceWatch watch(kLayout);
  watch.add(row(0));
  watch.add(row(0.1, Column::device_velocity, 2, 1001));
  for (int i = 0; i < calm; ++i) watch.add(row(0.2));
  watch.add(row(0.3, Column::proxy_velocity, 1, -1e5));
  watch.add(row(0.4, Column::device_velocity, 2, 2e3));
  watch.add(row(0.5, Column::proxy_velocity, 1, 1.1e6));
  return watch;
}

TEST(Divergence, BeginsWithTheFirstWildRowOfThoseThatLeadToIt) {
  const auto watch = swinging(10);
  EXPECT_TRUE(watch.lost());
  EXPECT_EQ(watch.since(), 0.3);
  EXPECT_EQ(watch.since_row(), 12u);
  EXPECT_EQ(watch.why(), "the speed of the proxy's joint 2 became larger than 1000 rad/s");
}

TEST(Divergence, ThatSwingsThroughSmallValuesBeganBefore) {
  for (const int calm : {0, 1, 9}) {
    const auto watch = swinging(calm);
    EXPECT_TRUE(watch.lost()) << calm;
    EXPECT_EQ(watch.since(), 0.1) << calm;
    EXPECT_EQ(watch.why(), "the speed of the device's joint 3 became larger than 1000 rad/s")
        << calm;
  }
}

TEST(Divergence, IsForgottenOnceTheLoopHasComeBack) {
  DivergenceWatch watch(kLayout);
  watch.add(row(0, Column::device_velocity, 2, 1001));
  for (int i = 0; i < 9; ++i) watch.add(row(0.1));
  EXPECT_TRUE(watch.wild());
  watch.add(row(0.1));
  EXPECT_FALSE(watch.wild());
}

TEST(Divergence, SaysWhatGrewAndInWhichJoint) {
  const auto why = [](Column column, int joint, double value) {
    return after({row(0, column, joint, value)}).why();
  };
  EXPECT_EQ(why(Column::device_velocity, 0, 1001),
            "the speed of the device's joint 1 became larger than 1000 rad/s");
  EXPECT_EQ(why(Column::commanded_torque, 2, -10001),
            "the torque commanded to joint 3 became larger than 10000 N m");
  EXPECT_EQ(why(Column::proxy_position, 1, 10.1),
            "the distance between device and proxy in joint 2 became larger than 10 rad");
  EXPECT_EQ(why(Column::commanded_torque, 2, kNan),
            "the torque commanded to joint 3 is not finite");
  EXPECT_EQ(why(Column::device_velocity, 1, -kInfinite),
            "the speed of the device's joint 2 is not finite");
  for (const auto& [column, most] : {std::pair(Column::device_velocity, 999.0),
                                     {Column::proxy_velocity, -999.0},
                                     {Column::commanded_torque, 9999.0},
                                     {Column::proxy_position, -9.9},
                                     {Column::device_position, 9.9}}) {
    EXPECT_EQ(why(column, 1, most), "") << static_cast<int>(column);
  }
}

TEST(Divergence, IsAThousandTimesWhatIsWildOrNoNumber) {
  const auto lost = [](Column column, double value) {
    return after({row(0, column, 1, value)}).lost();
  };
  for (const Column c : {Column::device_velocity, Column::proxy_velocity}) {
    EXPECT_FALSE(lost(c, 0.99e6));
    EXPECT_TRUE(lost(c, -1.01e6));
  }
  EXPECT_FALSE(lost(Column::commanded_torque, -0.99e7));
  EXPECT_TRUE(lost(Column::commanded_torque, 1.01e7));
  EXPECT_FALSE(lost(Column::proxy_position, 0.99e4));
  EXPECT_TRUE(lost(Column::device_position, 1.01e4));
  EXPECT_TRUE(lost(Column::commanded_torque, kNan));
  EXPECT_TRUE(lost(Column::commanded_torque, kInfinite));
}

TEST(Divergence, IsNotTakenBack) {
  const auto watch = after({row(0.1, Column::commanded_torque, 0, kNan), row(0.2)});
  EXPECT_TRUE(watch.lost());
  EXPECT_TRUE(watch.wild());
  EXPECT_EQ(watch.since(), 0.1);
}

TEST(Summary, OfALoopThatBecameUnstableIsOfWhatItDidBefore) {
  Summary summary(kLayout);
  summary.add(row(0, Column::proxy_position, 0, 0.002));
  summary.add(row(0.001, Column::contact_torque, 1, 0.4));
  const auto wild = [](double time, double speed) {
    auto values = row(time, Column::proxy_velocity, 0, speed);
    kLayout.in(std::span(values), Column::proxy_position)[0] = 1e24;
    kLayout.in(std::span(values), Column::contact_torque)[0] = 1e9;
    kLayout.in(std::span(values), Column::hand_torque)[0] = kNan;
    return values;
  };
  summary.add(wild(0.002, 3e3));
  summary.add(wild(0.003, 1e9));
  const std::string text = summary.text();
  EXPECT_THAT(text, HasSubstr("ticks                    4\n"));
  EXPECT_THAT(text, HasSubstr("unstable                 since t = 0.002 s: the distance between"));
  EXPECT_THAT(text, HasSubstr("largest |x_E|            2.000 mrad\n"));
  EXPECT_THAT(text, HasSubstr("largest |f2|             0.4000 N m\n"));
  EXPECT_THAT(text, HasSubstr("in contact               50 %\n"));
  EXPECT_THAT(text, Not(HasSubstr("nan")));
  EXPECT_EQ(summary.time(), 0.003);
  EXPECT_EQ(kLayout.in(summary.memorable(), Column::time)[0], 0.001);
}

TEST(Summary, OfALoopThatCameBackCountsAllOfIt) {
  Summary summary(kLayout);
  summary.add(row(0));
  summary.add(row(0.001, Column::proxy_position, 0, 20));
  summary.add(row(0.002));
  EXPECT_THAT(summary.text(), HasSubstr("largest |x_E|            20000.000 mrad\n"));
  EXPECT_THAT(summary.text(), Not(HasSubstr("unstable")));
}

TEST(Summary, IsTheLargestTheMeanAndTheLastOfWhatTheRowsSay) {
  Summary summary(kLayout);
  const double errors[] = {0.3, 0.5, 0.1}, torques[] = {0.2, 0.6, 0.3}, totals[] = {-1, 2, 0.5};
  for (int k = 0; k < 3; ++k) {
    auto values = row(0.001 * k, Column::contact_torque, 2, k == 0 ? 0 : -0.1 * k);
    const auto put = [&](Column c, int joint, double value) {
      kLayout.in(std::span(values), c)[static_cast<std::size_t>(joint)] = value;
    };
    put(Column::device_position, 0, errors[k]);
    put(Column::proxy_position, 1, errors[k]);
    put(Column::hand_torque, 1, torques[k]);
    put(Column::energy_total, 0, totals[k]);
    put(Column::energy_commanded, 0, -totals[k]);
    put(Column::torque_governor, 0, 1);
    summary.add(values);
  }
  EXPECT_EQ(summary.text(),
            "ticks                    3\n"
            "in contact               67 %\n"
            "largest |x_E|            707.107 mrad\n"
            "largest |f2|             0.2000 N m\n"
            "rms human torque         0.4041 N m\n"
            "E_c total                500.000 mJ (highest 2000.000 mJ)\n"
            "E_c commanded            -500.000 mJ\n");
}

TEST(Simulate, SaysSinceWhenAndWhyALoopIsUnstable) {
  RunPlan p = plan("free.toml", "free.csv", 8);
  p.parameters.k_vc = 1e4;
  p.parameters.tick = 0.01;
  p.parameters.torque_limit = 1e4;
  p.rows = 20000;
  Rows rows(kLayout);
  const RunEnd end = simulate(p, {}, [&](std::span<const double> one, LaneChanges) {
    rows.add(one);
    return true;
  });
  ASSERT_TRUE(end.diverged);
  EXPECT_FALSE(end.why.empty());
  EXPECT_EQ(rows.size(), end.rows);
  const auto since = static_cast<std::size_t>(std::llround(end.diverged_at / 0.01));
  ASSERT_GT(since, 0u);
  ASSERT_LT(since, rows.size());
  // Up to that row every velocity is credible.
  for (std::size_t k = 0; k < since; ++k) {
    for (const Column c : {Column::device_velocity, Column::proxy_velocity}) {
      ASSERT_LE(rows.vec(k, c).cwiseAbs().maxCoeff(), 1e3) << k;
    }
  }
  Session session;
  session.rows.assign(rows.row(0).begin(), rows.row(0).end());
  for (std::size_t k = 1; k < rows.size(); ++k) {
    session.rows.insert(session.rows.end(), rows.row(k).begin(), rows.row(k).end());
  }
  const RunEnd again = end_of(session);
  EXPECT_EQ(again.rows, end.rows);
  EXPECT_TRUE(again.diverged);
  EXPECT_EQ(again.diverged_at, end.diverged_at);
  EXPECT_EQ(again.why, end.why);
}

TEST(Simulate, OfAStableLoopSaysNothingOfThat) {
  const RunPlan p = plan("table.toml", "touch.csv", 0.2);
  const RunEnd end = simulate(p, {}, [](std::span<const double>, LaneChanges) { return true; });
  EXPECT_FALSE(end.diverged);
  EXPECT_TRUE(end.why.empty());
}

}  // namespace
}  // namespace limpid
