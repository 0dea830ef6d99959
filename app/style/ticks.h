// Round numbers along an axis, and numbers as text.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace limpid {

// Ticks at number * step for first <= number <= last.
struct Ticks {
  double step = 1;
  std::int64_t first = 0;
  std::int64_t last = -1;

  double at(std::int64_t number) const { return static_cast<double>(number) * step; }
};

// Returns the smallest 1, 2 or 5 times a power of ten that divides `span` into at most `at_most`
// parts.
double nice_step(double span, int at_most);

// Returns ticks inside [low, high], at most `at_most` + 1 of them; low < high.
Ticks nice_ticks(double low, double high, int at_most);

// Returns the same for seconds: from ten seconds on, steps that divide minutes and hours.
Ticks time_ticks(double low, double high, int at_most);

// Returns the places of ticks on a logarithmic axis: 1, 2 and 5 of every decade, or only 1 if there
// are many decades.
std::vector<double> log_ticks(double low, double high);

// Returns the number of digits after the point that tell multiples of `step` apart.
int decimals_of(double step);

// Returns the power of ten, a multiple of 3, by which the labels of an axis are divided to keep
// them short; 0 if plain numbers are fine.
int common_exponent(double low, double high);

// Returns "×10⁻⁶"; empty for 0.
std::string exponent_text(int exponent);

// Returns a label "E_c [J]" for numbers that are divided by a power of ten: "E_c [mJ]" where the
// unit has a prefix for it, "E_c [J] ×10⁻⁹" otherwise.
std::string scaled_label(const std::string& label, int exponent);

// Writes a number with the typographic minus and never as minus zero.
std::string fixed_text(double value, int decimals);

// Labels a tick divided by 10^exponent.
std::string tick_text(double value, double step, int exponent);

// Writes "12.5 s", or "2:05.5" and "1:02:05" when `clock` is set; `step` decides about the digits.
std::string time_text(double seconds, double step, bool clock);

// Writes three significant digits, plainly where that is short: "0.035", "12.3", "1.20e-05".
std::string three_digits(double value);

}  // namespace limpid
