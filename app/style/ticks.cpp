#include "app/style/ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace limpid {
namespace {

constexpr double kRounding = 1e-9;  // of a step: ends that miss a tick by rounding still have it

Ticks ticks_inside(double low, double high, double step) {
  return {step, static_cast<std::int64_t>(std::ceil(low / step - kRounding)),
          static_cast<std::int64_t>(std::floor(high / step + kRounding))};
}

}  // namespace

double nice_step(double span, int at_most) {
  const double least = span / std::max(at_most, 1);
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= least * (1 - kRounding)) return factor * decade;
  }
  return 10 * decade;
}

Ticks nice_ticks(double low, double high, int at_most) {
  return ticks_inside(low, high, nice_step(high - low, at_most));
}

Ticks time_ticks(double low, double high, int at_most) {
  constexpr std::array kClockSteps{10.0,  20.0,  30.0,   60.0,   120.0,
                                   300.0, 600.0, 1200.0, 1800.0, 3600.0};
  const double least = (high - low) / std::max(at_most, 1);
  if (least <= 5) return nice_ticks(low, high, at_most);
  const auto step = std::ranges::find_if(kClockSteps, [&](double s) { return s >= least; });
  return ticks_inside(low, high,
                      step != kClockSteps.end() ? *step : 3600 * nice_step(least / 3600, 1));
}

std::vector<double> log_ticks(double low, double high) {
  std::vector<double> all;
  const bool few = high / low < 300;
  for (double decade = std::pow(10, std::floor(std::log10(low))); decade <= high; decade *= 10) {
    for (const double part : {1.0, 2.0, 5.0}) {
      const double value = part * decade;
      if ((part > 1 && !few) || value < low * 0.999 || value > high * 1.001) continue;
      all.push_back(value);
    }
  }
  return all;
}

int decimals_of(double step) {
  return std::max(0, -static_cast<int>(std::floor(std::log10(step) + kRounding)));
}

int common_exponent(double low, double high) {
  const double largest = std::max(std::abs(low), std::abs(high));
  if (largest == 0 || (largest >= 0.05 && largest < 10000)) return 0;
  return 3 * static_cast<int>(std::floor(std::log10(largest) / 3));
}

std::string exponent_text(int exponent) {
  constexpr std::array kRaised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  if (exponent == 0) return "";
  std::string text = exponent < 0 ? "×10⁻" : "×10";
  for (const char digit : std::to_string(std::abs(exponent))) {
    text += kRaised[static_cast<std::size_t>(digit - '0')];
  }
  return text;
}

std::string scaled_label(const std::string& label, int exponent) {
  if (exponent == 0) return label;
  const std::size_t unit = label.rfind('[') + 1;  // 0: no unit
  // These begin with a symbol that takes prefixes: J, J/s, N, N m, N/m, rad, s, W.
  const bool plain = unit > 0 && std::string_view("JNWrs").find(label[unit]) != std::string::npos;
  const char* const prefix = exponent == -6   ? "µ"
                             : exponent == -3 ? "m"
                             : exponent == 3  ? "k"
                             : exponent == 6  ? "M"
                                              : nullptr;
  if (!plain || prefix == nullptr) return label + " " + exponent_text(exponent);
  return std::string(label).insert(unit, prefix);
}

std::string fixed_text(double value, int decimals) {
  const std::string digits = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool zero = digits.find_first_not_of("0.") == std::string::npos;
  return value < 0 && !zero ? "\u2212" + digits : digits;
}

std::string tick_text(double value, double step, int exponent) {
  const double unit = std::pow(10.0, exponent);
  return fixed_text(value / unit, decimals_of(step / unit));
}

std::string time_text(double seconds, double step, bool clock) {
  const int decimals = decimals_of(step);
  if (!clock) return fixed_text(seconds, decimals) + " s";
  // The number is rounded first, so that 59.96 s does not become 0:60.0.
  const double parts = std::pow(10.0, decimals);
  const double whole = std::round(std::abs(seconds) * parts) / parts;
  const auto minutes = static_cast<int>(whole / 60);
  const double rest = std::max(0.0, whole - 60.0 * minutes);
  const int width = decimals == 0 ? 2 : 3 + decimals;
  const char* sign = seconds < 0 && whole > 0 ? "\u2212" : "";
  if (minutes < 60) return fmt::format("{}{}:{:0{}.{}f}", sign, minutes, rest, width, decimals);
  return fmt::format("{}{}:{:02}:{:0{}.{}f}", sign, minutes / 60, minutes % 60, rest, width,
                     decimals);
}

std::string three_digits(double value) {
  const double size = std::abs(value);
  if (size == 0) return "0";
  if (size < 1e-4 || size >= 1e6) return fmt::format("{:.2e}", value);
  const int before = static_cast<int>(std::floor(std::log10(size) + 1e-12));
  return fmt::format("{:.{}f}", value, std::max(0, 2 - before));
}

}  // namespace limpid
