// Elementary functions against the library's in long double, which has eleven bits more.
#include "core/math/elementary.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>

namespace limpid {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Difference in units of the wanted number's last place as a double.
double places(double found, long double wanted) {
  const auto rounded = static_cast<double>(wanted);
  const double size = std::abs(rounded);
  const double place = std::nextafter(size, kInfinity) - size;
  return static_cast<double>(std::abs(static_cast<long double>(found) - wanted) /
                             static_cast<long double>(place));
}

class Elementary : public testing::Test {
 protected:
  double between(double low, double high) {
    return std::uniform_real_distribution(low, high)(random_);
  }
  // A number of either sign whose exponent is evenly distributed.
  double of_any_size(int least, int most) {
    const double x = std::ldexp(between(1, 2), std::uniform_int_distribution(least, most)(random_));
    return between(-1, 1) < 0 ? -x : x;
  }
  void expect_sine_and_cosine(double x, double most = 0.9) {
    const auto [s, c] = sine_cosine(x);
    const auto wanted = static_cast<long double>(x);
    EXPECT_LT(places(s, std::sin(wanted)), most) << std::hexfloat << x;
    EXPECT_LT(places(c, std::cos(wanted)), most) << std::hexfloat << x;
  }
  std::mt19937_64 random_{17};
};

TEST_F(Elementary, SinesAndCosinesAreWithinAPlaceForAnglesOfJoints) {
  for (int i = 0; i < 300000; ++i) expect_sine_and_cosine(between(-10, 10));
}

TEST_F(Elementary, SinesAndCosinesAreWithinAPlaceForAnglesOfAnySize) {
  for (int i = 0; i < 300000; ++i) expect_sine_and_cosine(of_any_size(-60, 1023));
  for (int i = 0; i < 300000; ++i) expect_sine_and_cosine(of_any_size(-2, 25));
  expect_sine_and_cosine(std::numeric_limits<double>::max());
  for (const double edge : {0x1p20, 0x1p-27, std::numbers::pi / 4}) {
    expect_sine_and_cosine(std::nextafter(edge, 0));
    expect_sine_and_cosine(edge);
    expect_sine_and_cosine(std::nextafter(edge, kInfinity));
  }
}

TEST_F(Elementary, SinesAndCosinesAreWithinAPlaceBesideEveryQuarterTurn) {
  const auto beside = [&](double quarters) {
    const auto at = static_cast<double>(static_cast<long double>(quarters) *
                                        1.57079632679489661923132169163975144L);
    double below = at, above = at;
    for (int i = 0; i < 5; ++i) {
      expect_sine_and_cosine(below);
      expect_sine_and_cosine(-above);
      below = std::nextafter(below, 0);
      above = std::nextafter(above, kInfinity);
    }
  };
  for (int n = 1; n <= 20000; ++n) beside(n);
  for (int i = 0; i < 50000; ++i) beside(std::floor(std::abs(of_any_size(14, 60))));
  // The double that is nearest to a multiple of pi/2 for its size (Muller, Elementary Functions).
  expect_sine_and_cosine(std::ldexp(6381956970095103.0, 797));
}

TEST(SineCosine, HoldToTheirValuesWhereTheseAreKnown) {
  EXPECT_EQ(sine(0), 0);
  EXPECT_TRUE(std::signbit(sine(-0.0)));
  EXPECT_EQ(cosine(0), 1);
  EXPECT_EQ(sine(5e-324), 5e-324);
  EXPECT_DOUBLE_EQ(sine(std::numbers::pi / 6), 0.5);
  EXPECT_DOUBLE_EQ(cosine(std::numbers::pi / 3), 0.5);
  EXPECT_EQ(sine(std::numbers::pi / 2), 1);
  EXPECT_EQ(cosine(std::numbers::pi), -1);
  for (const double odd : {kInfinity, -kInfinity, std::nan("")}) {
    EXPECT_TRUE(std::isnan(sine(odd)));
    EXPECT_TRUE(std::isnan(cosine(odd)));
  }
}

TEST_F(Elementary, SineIsOddAndCosineEvenToTheLastBit) {
  for (int i = 0; i < 10000; ++i) {
    const double x = of_any_size(-30, 100);
    EXPECT_EQ(sine(-x), -sine(x)) << x;
    EXPECT_EQ(cosine(-x), cosine(x)) << x;
  }
}

TEST_F(Elementary, ExponentialIsWithinAPlace) {
  const auto expect = [](double x) {
    EXPECT_LT(places(exponential(x), std::exp(static_cast<long double>(x))), 0.95) << x;
  };
  for (int i = 0; i < 300000; ++i) expect(between(-1, 1));
  for (int i = 0; i < 300000; ++i) expect(between(-708, 709.7));
  for (int i = 0; i < 100000; ++i) expect(of_any_size(-60, 8));
  EXPECT_EQ(exponential(0), 1);
  EXPECT_EQ(exponential(710), kInfinity);
  EXPECT_EQ(exponential(kInfinity), kInfinity);
  EXPECT_EQ(exponential(-kInfinity), 0);
  EXPECT_EQ(exponential(-746), 0);
  EXPECT_EQ(exponential(-745), 5e-324);
  EXPECT_TRUE(std::isnan(exponential(std::nan(""))));
}

TEST_F(Elementary, LogarithmIsWithinAPlace) {
  const auto expect = [](double x) {
    EXPECT_LT(places(logarithm(x), std::log(static_cast<long double>(x))), 0.6) << x;
  };
  for (int i = 0; i < 100000; ++i) expect(between(0.5, 2));
  for (int i = 0; i < 100000; ++i) expect(std::abs(of_any_size(-1074, 1023)));
  double below = 1, above = 1;
  for (int i = 0; i < 100; ++i) {
    expect(below = std::nextafter(below, 0));
    expect(above = std::nextafter(above, 2));
  }
  EXPECT_EQ(logarithm(1), 0);
}

TEST_F(Elementary, PowerIsWithinAPlaceAndWithinTwoWhereItIsVeryLargeOrSmall) {
  for (int i = 0; i < 200000; ++i) {
    const double x = std::abs(of_any_size(-30, 30)), y = between(-20, 20);
    const long double wanted = std::pow(static_cast<long double>(x), static_cast<long double>(y));
    if (wanted < 1e-300L || wanted > 1e300L) continue;
    const bool usual = wanted > 1e-15L && wanted < 1e15L;
    EXPECT_LT(places(power(x, y), wanted), usual ? 0.6 : 2.0) << x << ' ' << y;
  }
}

TEST(Power, OfTenIsWhatIsWrittenSo) {
  double wanted = 1;
  for (int n = 0; n <= 22; ++n, wanted *= 10) {
    EXPECT_EQ(power(10, n), wanted);
    EXPECT_EQ(power(wanted, 1), wanted);
    EXPECT_EQ(power(wanted * wanted, 0.5), wanted);
  }
  EXPECT_EQ(power(10, -1), 0.1);
  EXPECT_EQ(power(10, -6), 1e-6);
  EXPECT_EQ(power(3, 0), 1);
  EXPECT_EQ(power(10, 400), kInfinity);
  EXPECT_EQ(power(10, -400), 0);
}

}  // namespace
}  // namespace limpid
