#include "core/base/field.h"

#include <charconv>

#include "core/base/nearest_word.h"

namespace limpid {
namespace {

std::string number_text(double x) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), x).ptr;
  return {text.data(), end};
}

[[noreturn]] void refuse(const FieldInfo& info, const FieldValue& value,
                         const std::string& allowed) {
  throw FieldError(std::string(info.key) + ": " + field_text(value) +
                   " is not allowed; allowed: " + allowed);
}

std::string allowed_range(const FieldInfo& info) {
  std::string text = info.kind == FieldInfo::Kind::whole ? "a whole number" : "a number";
  text += (info.exclusive_minimum ? " above " : " from ") + number_text(info.minimum) + " to " +
          number_text(info.maximum);
  return info.has_unit() ? text + " " + info.unit : text;
}

}  // namespace

std::string field_text(const FieldValue& value) {
  struct {
    std::string operator()(bool x) const { return x ? "true" : "false"; }
    std::string operator()(std::int64_t x) const { return std::to_string(x); }
    std::string operator()(double x) const { return number_text(x); }
    std::string operator()(const std::string& x) const { return '"' + x + '"'; }
    std::string operator()(const Vec3& x) const {
      return "[" + number_text(x[0]) + ", " + number_text(x[1]) + ", " + number_text(x[2]) + "]";
    }
  } text;
  return std::visit(text, value);
}

namespace detail {

double allowed_number(const FieldInfo& info, const FieldValue& value) {
  double x = std::numeric_limits<double>::quiet_NaN();
  if (const auto* d = std::get_if<double>(&value)) x = *d;
  if (const auto* i = std::get_if<std::int64_t>(&value)) x = static_cast<double>(*i);
  const bool whole = info.kind != FieldInfo::Kind::whole || x == std::floor(x);
  if (!info.holds(x) || !whole) refuse(info, value, allowed_range(info));
  return x;
}

std::uint8_t allowed_word(const FieldInfo& info, const FieldValue& value) {
  const auto* text = std::get_if<std::string>(&value);
  const std::string_view word = text ? *text : std::string_view();
  for (std::size_t i = 0; i < info.words.size(); ++i) {
    if (word == info.words[i]) return static_cast<std::uint8_t>(i);
  }
  refuse(info, value, allowed_for(word, {info.words.begin(), info.words.end()}));
}

void refuse_kind(const FieldInfo& info, const FieldValue& value) {
  switch (info.kind) {
    case FieldInfo::Kind::flag: refuse(info, value, "true, false");
    case FieldInfo::Kind::text: refuse(info, value, "text");
    default: refuse(info, value, "three numbers");
  }
}

}  // namespace detail

}  // namespace limpid
