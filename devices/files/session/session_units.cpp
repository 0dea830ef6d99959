#include "devices/files/session/session_units.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string_view>

#include "core/dynamics/arm_description.h"

namespace limpid {
namespace {

// Exact, unlike 0.1: dividing by it rounds once.
constexpr double kUnitsPerMetre = 10;
static_assert(kSlideUnit * kUnitsPerMetre == 1);

double scaled_up(bool effort, double x) { return effort ? x * kUnitsPerMetre : x / kUnitsPerMetre; }
double scaled_back(bool effort, double x) { return scaled_up(!effort, x); }

std::string_view unit_of_slide(std::string_view unit_of_turn) {
  if (unit_of_turn == "rad") return "m";
  if (unit_of_turn == "rad/s") return "m/s";
  if (unit_of_turn == "N m") return "N";
  return unit_of_turn;
}

// Calls `work` with each contact's three numbers.
template <class Work>
void each_contact(std::span<double> points, std::span<const double> forces, const Work& work) {
  for (std::size_t i = 0; i < points.size(); i += 3) {
    work(points.subspan(i, 3), forces.subspan(i, 3));
  }
}

bool zero(std::span<const double> v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }
// Returns whether a point was never set: a zero with a sign was computed.
bool never_set(std::span<const double> v) {
  const auto bits = [&](std::size_t i) { return std::bit_cast<std::uint64_t>(v[i]); };
  return (bits(0) | bits(1) | bits(2)) == 0;
}

}  // namespace

std::vector<bool> slides_of(const ArmDescription& arm) {
  std::vector<bool> slides;
  for (std::size_t i = 0; i < arm.joints.size(); ++i) slides.push_back(arm.slides(i));
  return slides;
}

SessionUnits::SessionUnits(const RowLayout& layout, const std::vector<bool>& slides)
    : layout_(layout), slides_(slides) {
  slides_.resize(static_cast<std::size_t>(layout.dof()), false);
  for (const ColumnInfo& column : kColumnInfo) {
    if (column.width != ColumnWidth::dof || unit_of_slide(column.unit) == column.unit) continue;
    for (int joint = 0; joint < layout.dof(); ++joint) {
      if (!slides_[static_cast<std::size_t>(joint)]) continue;
      scaled_.push_back({column.column, joint, column.unit == std::string_view("N m")});
    }
  }
}

std::vector<std::string> SessionUnits::units(const ColumnInfo& column) const {
  if (column.width == ColumnWidth::poses) return {"m", "m", "m", "-", "-", "-", "-"};
  if (column.width == ColumnWidth::velocities) {
    return {"m/s", "m/s", "m/s", "rad/s", "rad/s", "rad/s"};
  }
  if (column.width != ColumnWidth::dof || scaled_.empty()) return {column.unit};
  std::vector<std::string> units;
  for (const bool slide : slides_) {
    units.emplace_back(slide ? unit_of_slide(column.unit) : column.unit);
  }
  return units;
}

SessionUnits::Filed SessionUnits::filed(const Scaled& scaled, double x) {
  const double value = scaled_up(scaled.effort, x);
  const double back = scaled_back(scaled.effort, value);
  const auto apart = std::bit_cast<std::int64_t>(x) - std::bit_cast<std::int64_t>(back);
  // Numbers farther apart fit into no double of the other unit.
  const bool close = std::abs(apart) <= std::numeric_limits<std::int8_t>::max();
  return {value, static_cast<std::int8_t>(close ? apart : 0)};
}

std::optional<double> SessionUnits::unfiled(const Scaled& scaled, const Filed& filed) {
  const double back = unfiled(scaled, filed.value);
  if (filed.rounding == 0 && std::isnan(back)) return back;
  const double x = std::bit_cast<double>(std::bit_cast<std::int64_t>(back) + filed.rounding);
  return scaled_up(scaled.effort, x) == filed.value ? std::optional(x) : std::nullopt;
}

double SessionUnits::unfiled(const Scaled& scaled, double value) {
  return scaled_back(scaled.effort, value);
}

NormUnits norm_units(const std::vector<bool>& slides) {
  const auto sliding = std::ranges::count(slides, true);
  if (sliding == 0) return {"rad", "mrad", "N m"};
  if (sliding == std::ssize(slides)) return {"m", "mm", "N", kSlideUnit, kUnitsPerMetre};
  return {"rad or dm", "mrad or 0.1 mm", "N m or daN"};
}

void file_points(std::span<double> points, std::span<const double> forces) {
  each_contact(points, forces, [](std::span<double> point, std::span<const double> force) {
    if (!never_set(point) || !zero(force)) return;
    std::ranges::fill(point, std::numeric_limits<double>::quiet_NaN());
  });
}

void unfile_points(std::span<double> points, std::span<const double> forces) {
  each_contact(points, forces, [](std::span<double> point, std::span<const double> force) {
    if (std::isnan(point[0]) && zero(force)) std::ranges::fill(point, 0.0);
  });
}

}  // namespace limpid
