#include "app/style/ticks.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <vector>

namespace limpid {
namespace {

TEST(Ticks, StepIsOneTwoOrFiveTimesAPowerOfTen) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-9, 9);
  for (int i = 0; i < 2000; ++i) {
    const double step = nice_step(std::pow(10.0, exponent(random)), 5);
    const double mantissa = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
    const bool nice = std::abs(mantissa - 1) < 1e-9 || std::abs(mantissa - 2) < 1e-9 ||
                      std::abs(mantissa - 5) < 1e-9;
    EXPECT_TRUE(nice) << step;
  }
}

TEST(Ticks, LieInsideAndAreNotTooMany) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-50, 50);
  std::uniform_real_distribution<double> exponent(-6, 4);
  for (int i = 0; i < 2000; ++i) {
    const double low = place(random);
    const double high = low + std::pow(10.0, exponent(random));
    const Ticks ticks = nice_ticks(low, high, 6);
    const auto count = ticks.last - ticks.first + 1;
    EXPECT_GE(count, 2);
    EXPECT_LE(count, 7);
    EXPECT_GE(ticks.at(ticks.first), low - 1e-6 * ticks.step);
    EXPECT_LE(ticks.at(ticks.last), high + 1e-6 * ticks.step);
  }
}

TEST(Ticks, EndsThatAreTicksAreKeptInSpiteOfRounding) {
  const Ticks ticks = nice_ticks(-0.3, 0.3, 6);
  EXPECT_DOUBLE_EQ(ticks.step, 0.1);
  EXPECT_EQ(ticks.first, -3);
  EXPECT_EQ(ticks.last, 3);
}

TEST(Ticks, LongTimesAreDividedAsAClockIs) {
  EXPECT_DOUBLE_EQ(time_ticks(0, 60, 6).step, 10);
  EXPECT_DOUBLE_EQ(time_ticks(0, 150, 6).step, 30);
  EXPECT_DOUBLE_EQ(time_ticks(0, 3600, 6).step, 600);
  EXPECT_DOUBLE_EQ(time_ticks(0, 20000, 6).step, 3600);
  EXPECT_DOUBLE_EQ(time_ticks(0, 10, 5).step, 2);
}

TEST(Ticks, LabelsHaveTheDigitsThatTellThemApart) {
  EXPECT_EQ(tick_text(0.25, 0.05, 0), "0.25");
  EXPECT_EQ(tick_text(-2, 1, 0), "\u22122");
  EXPECT_EQ(tick_text(0.5, 0.1, 0), "0.5");
  EXPECT_EQ(tick_text(2e-5, 1e-5, -6), "20");
}

TEST(Ticks, ZeroHasNoSign) {
  EXPECT_EQ(fixed_text(-0.0001, 2), "0.00");
  EXPECT_EQ(fixed_text(-0.0, 0), "0");
}

TEST(Ticks, SmallAndLargeAxesShareAPowerOfTen) {
  EXPECT_EQ(common_exponent(-10, 10), 0);
  EXPECT_EQ(common_exponent(0, 0), 0);
  EXPECT_EQ(common_exponent(-2e-5, 1e-5), -6);
  EXPECT_EQ(common_exponent(0, 25000), 3);
  EXPECT_EQ(exponent_text(-6), "×10⁻⁶");
  EXPECT_EQ(exponent_text(0), "");
  EXPECT_EQ(scaled_label("E_c [J]", 0), "E_c [J]");
  EXPECT_EQ(scaled_label("E_c [J]", -3), "E_c [mJ]");
  EXPECT_EQ(scaled_label("stiffness [N/m]", 3), "stiffness [kN/m]");
  EXPECT_EQ(scaled_label("time [s]", -6), "time [µs]");
  EXPECT_EQ(scaled_label("mass [kg]", -3), "mass [kg] ×10⁻³") << "kg has a prefix already";
  EXPECT_EQ(scaled_label("share [%]", 3), "share [%] ×10³");
  EXPECT_EQ(scaled_label("ticks", 3), "ticks ×10³");
  EXPECT_EQ(scaled_label("E_c [J]", -9), "E_c [J] ×10⁻⁹");
}

TEST(Ticks, TimesReadAsSecondsOrAsAClock) {
  EXPECT_EQ(time_text(12.5, 0.5, false), "12.5 s");
  EXPECT_EQ(time_text(125.5, 0.5, true), "2:05.5");
  EXPECT_EQ(time_text(3725, 10, true), "1:02:05");
  EXPECT_EQ(time_text(59.96, 0.1, true), "1:00.0");
  EXPECT_EQ(time_text(-65, 5, true), "\u22121:05");
}

TEST(Ticks, ThreeDigitsArePlainWhereThatIsShort) {
  EXPECT_EQ(three_digits(0.035), "0.0350");
  EXPECT_EQ(three_digits(10), "10.0");
  EXPECT_EQ(three_digits(0.6), "0.600");
  EXPECT_EQ(three_digits(300), "300");
  EXPECT_EQ(three_digits(0), "0");
  EXPECT_EQ(three_digits(1e-6), "1.00e-06");
}

TEST(LogTicks, AreBetweenPowersOfTenWhereThereAreFew) {
  EXPECT_THAT(log_ticks(0.2, 10), testing::Pointwise(testing::DoubleNear(1e-12),
                                                     std::vector{0.2, 0.5, 1.0, 2.0, 5.0, 10.0}));
  EXPECT_THAT(log_ticks(0.3, 400),
              testing::Pointwise(testing::DoubleNear(1e-9), std::vector{1.0, 10.0, 100.0}));
}

}  // namespace
}  // namespace limpid
