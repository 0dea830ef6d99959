// Elementary functions by sums, products and quotients alone, in the order written: IEEE 754
// defines each to the last bit. The series are Taylor's, as long as round-off asks for.
#include "core/math/elementary.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace limpid {
namespace {

__extension__ using Wide = unsigned __int128;

// Rest of an angle after whole quarter turns: high + low, from -pi/4 to pi/4.
struct Rest {
  int quarters;  // modulo 4
  double high, low;
};

// a + b without loss: the sum, and its rounding error.
struct Sum {
  Sum(double a, double b) : high(a + b) {
    const double b_taken = high - a;
    low = (a - (high - b_taken)) + (b - b_taken);
  }
  double high, low;
};

constexpr double kNearTurns = 0x1p20;  // [rad]

// Rest by Cody and Waite: pi/2 in parts of 33 bits, whose products with the number of quarter turns
// are exact, and a last part that completes it to 2^-157.
Rest near_rest(double x) {
  constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;
  constexpr double kFirst = 0x1.921fb544p+0, kSecond = 0x1.0b4611a6p-34;
  constexpr double kThird = 0x1.3198a2ep-69, kFourth = 0x1.b839a252049c1p-104;
  const int quarters = static_cast<int>(x * kTwoOverPi + (x < 0 ? -0.5 : 0.5));
  const double n = quarters;
  const Sum second(x - n * kFirst, -n * kSecond);
  const Sum third(second.high, -n * kThird);
  const double rest = (second.low + third.low) - n * kFourth;
  const double high = third.high + rest;
  return {quarters & 3, high, (third.high - high) + rest};
}

// Rest by Payne and Hanek: only those binary digits of 2/pi matter whose products with x are not
// whole turns. x = m 2^e; 192 digits are taken, beginning with the one that counts half turns.
Rest far_rest(double x) {
  constexpr std::array<std::uint64_t, 20> kTwoOverPi{0,
                                                     0xa2f9836e4e441529,
                                                     0xfc2757d1f534ddc0,
                                                     0xdb6295993c439041,
                                                     0xfe5163abdebbc561,
                                                     0xb7246e3a424dd2e0,
                                                     0x06492eea09d1921c,
                                                     0xfe1deb1cb129a73e,
                                                     0xe88235f52ebb4484,
                                                     0xe99c7026b45f7e41,
                                                     0x3991d639835339f4,
                                                     0x9c845f8bbdf9283b,
                                                     0x1ff897ffde05980f,
                                                     0xef2f118b5a0a6d1f,
                                                     0x6d367ecf27cb09b7,
                                                     0x4f463f669e5fea2d,
                                                     0x7527bac7ebe5f17b,
                                                     0x3d0739f78a5292ea,
                                                     0x6bfb5fb11f8d5d08,
                                                     0x56033046fc7b6bab};
  constexpr Wide kHalfPi = Wide{0xc90fdaa22168c234} << 64 | 0xc4c6628b80dc1cd1;  // times 2^127
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const int e = static_cast<int>(bits >> 52 & 0x7ff) - 1075;
  const std::uint64_t m = (bits & 0xfffffffffffff) | 0x10000000000000;

  const auto first = static_cast<std::size_t>(64 + e - 2);  // digit; before it: whole turns
  const auto digits = [&](std::size_t word) {
    const std::size_t at = first / 64 + word, shift = first % 64;
    return shift == 0 ? kTwoOverPi[at]
                      : kTwoOverPi[at] << shift | kTwoOverPi[at + 1] >> (64 - shift);
  };
  const Wide p2 = Wide{m} * digits(2);
  const Wide p1 = Wide{m} * digits(1) + (p2 >> 64);
  const std::uint64_t p0 = m * digits(0) + static_cast<std::uint64_t>(p1 >> 64);

  // Two digits of quarter turns, then the fraction of a quarter turn, taken from the nearer side.
  int quarters = static_cast<int>(p0 >> 62);
  const auto l1 = static_cast<std::uint64_t>(p1), l2 = static_cast<std::uint64_t>(p2);
  Wide upper = Wide{p0 << 2 | l1 >> 62} << 64 | (l1 << 2 | l2 >> 62);
  std::uint64_t lower = l2 << 2;
  const bool beyond = upper >> 127 != 0;
  if (beyond) {
    ++quarters;
    lower = ~lower + 1;
    upper = ~upper + (lower == 0 ? 1 : 0);
  }
  int shift = 0;
  for (; upper >> 127 == 0 && shift < 128; ++shift) {
    upper = upper << 1 | lower >> 63;
    lower <<= 1;
  }

  // Upper half of the product with pi/2.
  const auto upper_half = [](Wide a, Wide b) {
    const Wide kLow = ~std::uint64_t{0};
    const Wide a1 = a >> 64, a0 = a & kLow, b1 = b >> 64, b0 = b & kLow;
    const Wide middle = a1 * b0 + ((a0 * b0) >> 64);
    return a1 * b1 + (middle >> 64) + ((a0 * b1 + (middle & kLow)) >> 64);
  };
  const Wide rest = upper_half(upper, kHalfPi);
  const auto r1 = static_cast<std::uint64_t>(rest >> 64), r0 = static_cast<std::uint64_t>(rest);
  const double sign = beyond != std::signbit(x) ? -1 : 1;
  const double high = static_cast<double>(r1 & ~std::uint64_t{0x7ff});
  const double low = static_cast<double>(r1 & 0x7ff) + static_cast<double>(r0) * 0x1p-64;
  return {(std::signbit(x) ? -quarters : quarters) & 3, sign * std::ldexp(high, -63 - shift),
          sign * std::ldexp(low, -63 - shift)};
}

SineCosine of_rest(double high, double low) {
  const double z = high * high;
  const double s =
      -1. / 6 +
      z * (1. / 120 +
           z * (-1. / 5040 +
                z * (1. / 362880 + z * (-1. / 39916800 + z * (1. / 6227020800 +
                                                              z * (-1. / 1307674368000 +
                                                                   z * (1. / 355687428096000)))))));
  const double c =
      1. / 24 +
      z * (-1. / 720 +
           z * (1. / 40320 +
                z * (-1. / 3628800 +
                     z * (1. / 479001600 + z * (-1. / 87178291200 + z * (1. / 20922789888000))))));
  const double half = 0.5 * z, most = 1 - half;
  return {high + (low * most + high * z * s),
          most + (((1 - most) - half) + (z * z * c - high * low))};
}

// Longer numbers, whose sums, products and quotients the processor rounds exactly, too.
using Long = long double;
constexpr Long kLn2 = 0x0.b17217f7d1cf79abc9e3b39803f2f6afp0L;

Long long_logarithm(double x) {
  int exponent = 0;
  Long m = std::frexp(x, &exponent);
  if (m < 0.70710678118654752440L) {
    m *= 2;
    --exponent;
  }
  // 2 artanh s
  const Long s = (m - 1) / (m + 1), z = s * s;
  Long sum = 0;
  for (int k = 31; k >= 3; k -= 2) sum = (1 / static_cast<Long>(k) + sum) * z;
  return static_cast<Long>(exponent) * kLn2 + 2 * (s + s * sum);
}

}  // namespace

SineCosine sine_cosine(double x) {
  constexpr double kQuarterPi = 0.78539816339744831, kStraight = 0x1p-27;
  const double size = std::abs(x);
  if (size < kStraight) return {x, 1};
  if (size <= kQuarterPi) return of_rest(x, 0);
  if (!std::isfinite(x)) return {x - x, x - x};
  const Rest rest = size < kNearTurns ? near_rest(x) : far_rest(x);
  const auto [s, c] = of_rest(rest.high, rest.low);
  switch (rest.quarters) {
    case 0: return {s, c};
    case 1: return {c, -s};
    case 2: return {-s, -c};
    default: return {-c, s};
  }
}

double exponential(double x) {
  constexpr double kPerLn2 = 0x1.71547652b82fep+0;
  constexpr double kHigh = 0x1.62e42feep-1, kLow = 0x1.a39ef35793c76p-33;  // ln 2
  if (std::isnan(x)) return x;
  if (x > 710) return std::numeric_limits<double>::infinity();
  if (x < -746) return 0;
  const int n = static_cast<int>(x * kPerLn2 + (x < 0 ? -0.5 : 0.5));
  const double high = x - n * kHigh, low = n * kLow;
  const double r = high - low, rest = (high - r) - low;
  // (e^r - 1 - r) / r^2
  const double e =
      1. / 2 +
      r * (1. / 6 +
           r * (1. / 24 +
                r * (1. / 120 +
                     r * (1. / 720 +
                          r * (1. / 5040 + r * (1. / 40320 +
                                                r * (1. / 362880 +
                                                     r * (1. / 3628800 +
                                                          r * (1. / 39916800 +
                                                               r * (1. / 479001600 +
                                                                    r * (1. / 6227020800)))))))))));
  return std::ldexp(1 + (r + (rest + r * r * e)), n);
}

double logarithm(double x) { return static_cast<double>(long_logarithm(x)); }

double power(double x, double y) {
  constexpr Long kMost = 12000;  // limit of the exponent: far beyond doubles
  const Long t = static_cast<Long>(y) * long_logarithm(x);
  if (t > kMost) return std::numeric_limits<double>::infinity();
  if (t < -kMost) return 0;
  const Long n = std::floor(t / kLn2 + 0.5L);
  const Long r = t - n * kLn2;
  Long e = 1;
  for (int k = 20; k >= 1; --k) e = 1 + e * r / static_cast<Long>(k);
  return static_cast<double>(std::ldexp(e, static_cast<int>(n)));
}

}  // namespace limpid
