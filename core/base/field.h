// Fields: values that people set, each described once for files, programs, widgets and sweeps.
//
// A table of fields stands beside the struct whose members they are. Its readers take the whole
// table: set_value() and value_of() for settings and JSON, devices/files/field_file.h for TOML,
// app/style/sliders.h for widgets, app/sweep/body_axis.h for axes of sweeps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

#include "core/math/sizes.h"

namespace limpid {

// Numbers that are allowed.
struct Range {
  double minimum = 0;
  double maximum = 0;
  bool exclusive_minimum = false;
  const char* unit = "-";  // "-" for none

  bool has_unit() const { return unit[0] != '-'; }
  // The least number that people set.
  double least() const { return exclusive_minimum ? minimum + 1e-6 : minimum; }
  bool holds(double x) const {
    return (exclusive_minimum ? x > minimum : x >= minimum) && x <= maximum;
  }
  // The allowed number nearest to x; `otherwise` if x is no number.
  double hold(double x, double otherwise) const {
    if (std::isnan(x)) return otherwise;
    const double least =
        exclusive_minimum ? std::max(minimum, std::numeric_limits<double>::min()) : minimum;
    return std::clamp(x, least, maximum);
  }
};

// Ends of a slider; without a width there is none, and a number is dragged or typed.
struct SliderRange {
  double minimum = 0;
  double maximum = 0;
  bool logarithmic = false;
};

// A member with a few words as values: an enumeration's 0, 1, ...
template <class Owner>
struct Choice {
  std::span<const char* const> words;
  std::uint8_t (*get)(const Owner&);
  void (*set)(Owner&, std::uint8_t);
};

template <class Owner, auto member>
constexpr Choice<Owner> choice(std::span<const char* const> words) {
  return {words, [](const Owner& o) { return static_cast<std::uint8_t>(o.*member); },
          [](Owner& o, std::uint8_t i) {
            o.*member = static_cast<std::remove_reference_t<decltype(o.*member)>>(i);
          }};
}

// Description of a field, whatever it is a member of. As a range: the numbers allowed, of a choice
// the places of its words.
struct FieldInfo : Range {
  enum class Kind : std::uint8_t { number, whole, flag, text, vector, vector_if, choice };

  const char* key = "";      // in files and programs: "coupling.eta"
  const char* label = "";    // in few letters, as in the mark of a plot
  const char* caption = "";  // beside its widget
  const char* meaning = "";  // one or two sentences for people
  Kind kind = Kind::number;
  double slider_minimum = 0, slider_maximum = 0;
  bool logarithmic = false;                 // whether the slider is
  bool live = true;                         // may change while the loop runs
  bool needed = false;                      // a file must have it
  std::span<const char* const> words = {};  // of a choice

  bool is_number() const { return kind == Kind::number || kind == Kind::whole; }
};

template <class Owner>
struct Field : FieldInfo {
  using Member = std::variant<double Owner::*, int Owner::*, bool Owner::*, std::string Owner::*,
                              Vec3 Owner::*, std::optional<Vec3> Owner::*,
                              Choice<Owner>>;  // in the order of Kind
  struct Traits {
    bool needed = false;                   // a file must have it
    bool (*when)(const Owner&) = nullptr;  // whether an owner has the field; null: every one has
  };

  Member member = {};
  bool (*when)(const Owner&) = nullptr;

  constexpr Field() = default;
  // Describes a setting. Range and unit of a flag or a choice: that of its numbers.
  template <class M>
  constexpr Field(const char* of_key, const char* of_label, const char* of_caption, M of_owner,
                  const char* of_unit, double least, double most, double slider_least,
                  double slider_most, bool log_slider, bool is_live, const char* of_meaning)
      : FieldInfo{{least, most, false, of_unit},
                  of_key,
                  of_label,
                  of_caption,
                  of_meaning,
                  static_cast<Kind>(Member(of_owner).index()),
                  slider_least,
                  slider_most,
                  log_slider,
                  is_live},
        member(of_owner) {
    if (kind == Kind::choice) words = std::get<Choice<Owner>>(member).words;
  }
  // Describes a member of something else.
  template <class M>
  constexpr Field(const char* of_key, const char* of_caption, M of_owner, Range allowed,
                  const char* of_meaning, SliderRange slider = {}, Traits traits = {})
      : Field(of_key, of_caption, of_caption, of_owner, allowed.unit, allowed.minimum,
              allowed.maximum, slider.minimum, slider.maximum, slider.logarithmic, true,
              of_meaning) {
    exclusive_minimum = allowed.exclusive_minimum;
    needed = traits.needed;
    when = traits.when;
  }

  bool of(const Owner& o) const { return when == nullptr || when(o); }
};

// Joins tables of parts that one owner inherits.
template <class Owner, std::size_t... Size>
constexpr auto joined(const std::array<Field<Owner>, Size>&... parts) {
  std::array<Field<Owner>, (Size + ...)> all{};
  std::size_t at = 0;
  ((std::copy(parts.begin(), parts.end(), all.begin() + at), at += Size), ...);
  return all;
}

// A field's value as files and programs give it.
using FieldValue = std::variant<bool, std::int64_t, double, std::string, Vec3>;

// Thrown if a value is not allowed; what() names the key, the value found and what is allowed.
struct FieldError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A value as files have it, shortest: a whole double has no point.
std::string field_text(const FieldValue& value);

namespace detail {

// A number that the field allows. Errors: FieldError.
double allowed_number(const FieldInfo& info, const FieldValue& value);
// The place of a word among the field's. Errors: FieldError.
std::uint8_t allowed_word(const FieldInfo& info, const FieldValue& value);
[[noreturn]] void refuse_kind(const FieldInfo& info, const FieldValue& value);

}  // namespace detail

// Calls use(member) with the owner's own member, or the choice.
template <class Owner, class O, class Use>
decltype(auto) with_member(const Field<Owner>& field, O& owner, Use&& use) {
  return std::visit(
      [&]<class M>(const M& member) -> decltype(auto) {
        if constexpr (std::is_member_object_pointer_v<M>) {
          return use(owner.*member);
        } else {
          return use(member);
        }
      },
      field.member);
}

// Returns a field's value; nothing where it is left open, by NaN or without a vector.
template <class Owner>
std::optional<FieldValue> value_of(const Field<Owner>& field, const Owner& owner) {
  return with_member(field, owner, [&]<class T>(const T& x) -> std::optional<FieldValue> {
    if constexpr (std::is_same_v<T, Choice<Owner>>) {
      return std::string(x.words[x.get(owner)]);
    } else if constexpr (std::is_same_v<T, double>) {
      return std::isnan(x) ? std::nullopt : std::optional<FieldValue>(x);
    } else if constexpr (std::is_same_v<T, int>) {
      return std::int64_t{x};
    } else if constexpr (std::is_same_v<T, std::optional<Vec3>>) {
      return x ? std::optional<FieldValue>(*x) : std::nullopt;
    } else {
      return x;
    }
  });
}

// Sets a field. Errors, after which the owner is as it was: FieldError.
template <class Owner>
void set_value(const Field<Owner>& field, Owner& owner, const FieldValue& value) {
  with_member(field, owner, [&]<class T>(T& x) {
    if constexpr (std::is_same_v<T, const Choice<Owner>>) {
      x.set(owner, detail::allowed_word(field, value));
    } else if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
      x = static_cast<T>(detail::allowed_number(field, value));
    } else {
      using Held = std::conditional_t<std::is_same_v<T, std::optional<Vec3>>, Vec3, T>;
      const auto* held = std::get_if<Held>(&value);
      if (held == nullptr) detail::refuse_kind(field, value);
      if constexpr (std::is_same_v<Held, Vec3>) {
        for (const double each : *held) detail::allowed_number(field, each);
      }
      x = *held;
    }
  });
}

// A field as a number: a choice by its place, a flag as 0 or 1; NaN for all else.
template <class Owner>
double number_of(const Field<Owner>& field, const Owner& owner) {
  return with_member(field, owner, [&]<class T>(const T& x) -> double {
    if constexpr (std::is_same_v<T, Choice<Owner>>) {
      return x.get(owner);
    } else if constexpr (std::is_arithmetic_v<T>) {
      return static_cast<double>(x);
    } else {
      return std::numeric_limits<double>::quiet_NaN();
    }
  });
}

// Inverse of number_of(); clamps to the allowed range, NaN stays.
template <class Owner>
void set_number(const Field<Owner>& field, Owner& owner, double number) {
  const double inside = field.hold(number, number);
  with_member(field, owner, [&]<class T>(T& x) {
    if constexpr (std::is_same_v<T, const Choice<Owner>>) {
      x.set(owner, static_cast<std::uint8_t>(std::round(inside)));
    } else if constexpr (std::is_same_v<T, double>) {
      x = inside;
    } else if constexpr (std::is_same_v<T, int>) {
      x = static_cast<int>(std::round(inside));
    } else if constexpr (std::is_same_v<T, bool>) {
      x = std::round(inside) != 0;
    }
  });
}

// Holds an owner as below. Never inlined: GCC would take `usual` for uninitialized.
template <class Table, class Owner>
[[gnu::noinline]] void hold_fields(const Table& fields, Owner& owner, const Owner& usual) {
  for (const Field<Owner>& field : fields) {
    std::visit(
        [&]<class M>(const M& member) {
          if constexpr (std::is_member_object_pointer_v<M>) {
            auto& x = owner.*member;
            using T = std::remove_reference_t<decltype(x)>;
            if (!field.of(owner)) {
              x = usual.*member;
            } else if constexpr (std::is_same_v<T, double>) {  // NOLINT(bugprone-branch-clone)
              x = field.hold(x, usual.*member);
            } else if constexpr (std::is_same_v<T, Vec3>) {
              for (int i = 0; i < 3; ++i) x[i] = field.hold(x[i], (usual.*member)[i]);
            } else if constexpr (std::is_same_v<T, std::optional<Vec3>>) {
              if (x && x->hasNaN()) x.reset();
              if (x) *x = x->unaryExpr([&](double each) { return field.hold(each, each); });
            }
          }
        },
        field.member);
  }
}

// Holds an owner within what its fields allow. A number that is none becomes the usual one, as does
// a field that this owner does not have.
template <class Table, class Owner>
void hold_fields(const Table& fields, Owner& owner) {
  const Owner usual{};
  hold_fields(fields, owner, usual);
}

// The entry of a table with this key; null if there is none.
template <class Table>
auto find_field(const Table& fields, std::string_view key) -> decltype(&*std::begin(fields)) {
  for (const auto& each : fields) {
    if (key == each.key) return &each;
  }
  return nullptr;
}

}  // namespace limpid
