// Settings that people can change, described once for the command line, configuration files,
// sliders, tooltips and help. Whatever has settings describes them beside itself.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <variant>

namespace limpid {

// One of a few words: an enumeration's 0, 1, ...
template <class Owner>
struct Choice {
  std::span<const char* const> words;
  std::uint8_t (*get)(const Owner&);
  void (*set)(Owner&, std::uint8_t);
};

template <class Owner, auto field>
constexpr Choice<Owner> choice(std::span<const char* const> words) {
  return {words, [](const Owner& o) { return static_cast<std::uint8_t>(o.*field); },
          [](Owner& o, std::uint8_t i) {
            o.*field = static_cast<std::remove_reference_t<decltype(o.*field)>>(i);
          }};
}

// One key. Owner: the class with all settings, which inherits the parts that laws bring along.
template <class Owner>
struct Setting {
  using Field = std::variant<double Owner::*, int Owner::*, bool Owner::*, Choice<Owner>>;
  const char* key;    // "coupling.eta"
  const char* label;  // short, for a slider
  Field field;
  const char* unit;  // "-" for none
  double minimum;    // allowed
  double maximum;
  double slider_minimum;  // the part of it worth a slider
  double slider_maximum;
  bool logarithmic;     // the slider
  bool live;            // may change while the loop runs
  const char* meaning;  // one or two sentences with the equation's number
};

// The descriptions of several owners, one after another.
template <class P, std::size_t... Size>
constexpr auto joined(const std::array<Setting<P>, Size>&... parts) {
  std::array<Setting<P>, (Size + ...)> all{};
  std::size_t at = 0;
  ((std::copy(parts.begin(), parts.end(), all.begin() + at), at += Size), ...);
  return all;
}

}  // namespace limpid
