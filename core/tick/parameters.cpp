#include "core/tick/parameters.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

namespace limpid {
namespace {

using P = Parameters;

constexpr auto kController = ControllerSettings::settings<P>();
constexpr auto kTable = joined(kController, LoopSettings::settings<P>(),
                               HandSettings::settings<P>(), DeviceSettings::settings<P>());

std::string number(double x) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), x).ptr;
  return {text.data(), end};
}

std::string found(const ParameterValue& value) {
  struct {
    std::string operator()(bool x) const { return x ? "true" : "false"; }
    std::string operator()(std::int64_t x) const { return std::to_string(x); }
    std::string operator()(double x) const { return number(x); }
    std::string operator()(const std::string& x) const { return '"' + x + '"'; }
  } show;
  return std::visit(show, value);
}

[[noreturn]] void refuse(const ParameterInfo& info, const ParameterValue& value,
                         const std::string& allowed) {
  throw ParameterError(std::string(info.key) + ": " + found(value) +
                       " is not allowed; allowed: " + allowed);
}

std::string range(const ParameterInfo& info, const char* what) {
  std::string text =
      std::string(what) + " from " + number(info.minimum) + " to " + number(info.maximum);
  return std::strcmp(info.unit, "-") == 0 ? text : text + " " + info.unit;
}

double number_in_range(const ParameterInfo& info, const ParameterValue& value, const char* what) {
  double x = std::numeric_limits<double>::quiet_NaN();
  if (const auto* d = std::get_if<double>(&value)) x = *d;
  if (const auto* i = std::get_if<std::int64_t>(&value)) x = static_cast<double>(*i);
  if (!(x >= info.minimum && x <= info.maximum)) refuse(info, value, range(info, what));
  return x;
}

std::uint8_t choose(const ParameterInfo& info, const ParameterValue& value,
                    std::span<const char* const> words) {
  std::string allowed;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (const auto* text = std::get_if<std::string>(&value); text && *text == words[i]) {
      return static_cast<std::uint8_t>(i);
    }
    allowed += (i ? ", " : "") + std::string(words[i]);
  }
  refuse(info, value, allowed);
}

// Assigns a value of the field's own type.
struct Assign {
  Parameters& p;
  const ParameterInfo& info;
  const ParameterValue& value;

  void operator()(double P::*field) const { p.*field = number_in_range(info, value, "a number"); }
  void operator()(int P::*field) const {
    const double x = number_in_range(info, value, "a whole number");
    if (x != std::floor(x)) refuse(info, value, range(info, "a whole number"));
    p.*field = static_cast<int>(x);
  }
  void operator()(bool P::*field) const {
    if (!std::holds_alternative<bool>(value)) refuse(info, value, "true, false");
    p.*field = std::get<bool>(value);
  }
  void operator()(const Choice<P>& choice) const {
    choice.set(p, choose(info, value, choice.words));
  }
};

struct Text {
  const Parameters& p;

  std::string operator()(double P::*field) const {
    if (std::isnan(p.*field)) return {};
    std::string text = number(p.*field);
    return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
  }
  std::string operator()(int P::*field) const { return std::to_string(p.*field); }
  std::string operator()(bool P::*field) const { return p.*field ? "true" : "false"; }
  std::string operator()(const Choice<P>& choice) const {
    return '"' + std::string(choice.words[choice.get(p)]) + '"';
  }
};

}  // namespace

int most_delay(const Parameters& p, std::optional<double> identified, bool real) {
  constexpr double kUsual = 3;  // for a device of unknown delay [ticks]
  double most = p.delay_most;
  if (std::isnan(most) && !real) most = p.device_delay;
  if (std::isnan(most)) most = identified ? *identified / p.tick + 1 : kUsual;
  return std::clamp(static_cast<int>(std::ceil(most)), p.delay, kMostDelay);
}

std::span<const ParameterInfo> parameter_table() { return kTable; }

const ParameterInfo* find_parameter(std::string_view key) {
  for (const ParameterInfo& info : kTable) {
    if (key == info.key) return &info;
  }
  return nullptr;
}

bool of_controller(const ParameterInfo& info) {
  const std::string_view key = info.key;
  return std::ranges::any_of(kController, [key](const auto& own) { return key == own.key; });
}

void set_parameter(Parameters& p, std::string_view key, const ParameterValue& value) {
  const ParameterInfo* info = find_parameter(key);
  if (info == nullptr) {
    throw ParameterError(std::string(key) + ": no such key; `limpid run --help` lists them");
  }
  std::visit(Assign{p, *info, value}, info->field);
}

double parameter_number(const Parameters& p, const ParameterInfo& info) {
  struct {
    const P& p;
    double operator()(double P::*field) const { return p.*field; }
    double operator()(int P::*field) const { return p.*field; }
    double operator()(bool P::*field) const { return p.*field ? 1 : 0; }
    double operator()(const Choice<P>& choice) const { return choice.get(p); }
  } number{p};
  return std::visit(number, info.field);
}

void set_parameter_number(Parameters& p, const ParameterInfo& info, double number) {
  struct {
    P& p;
    double x;
    void operator()(double P::*field) const { p.*field = x; }
    void operator()(int P::*field) const { p.*field = static_cast<int>(std::round(x)); }
    void operator()(bool P::*field) const { p.*field = std::round(x) != 0; }
    void operator()(const Choice<P>& choice) const {
      choice.set(p, static_cast<std::uint8_t>(std::round(x)));
    }
  } set{p, std::clamp(number, info.minimum, info.maximum)};  // kFromArm passes
  std::visit(set, info.field);
}

std::string parameter_text(const Parameters& p, const ParameterInfo& info) {
  return std::visit(Text{p}, info.field);
}

bool operator==(const Parameters& a, const Parameters& b) {
  // Values left to the arm are NaN, and count as equal.
  const auto same = [&](auto field) {
    if constexpr (std::is_same_v<decltype(field), Choice<P>>) {
      return field.get(a) == field.get(b);
    } else if constexpr (std::is_same_v<decltype(field), double P::*>) {
      return a.*field == b.*field || (std::isnan(a.*field) && std::isnan(b.*field));
    } else {
      return a.*field == b.*field;
    }
  };
  for (const ParameterInfo& info : kTable) {
    if (!std::visit(same, info.field)) return false;
  }
  return true;
}

}  // namespace limpid
