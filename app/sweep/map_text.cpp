#include "app/sweep/map_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/sweep/axis_cells.h"

namespace limpid {
namespace {

constexpr std::size_t kMostAcross = 60, kMostUp = 20;
constexpr const char* kShades[] = {"░░", "▒▒", "▓▓", "██"};

}  // namespace

MapText::MapText(const SweepPlan& plan, const std::vector<SweepColumn>& columns)
    : plan_(plan), columns_(columns.size()) {
  const auto shown = std::ranges::find(columns, plan.figure.measure, &SweepColumn::name);
  if (shown != columns.end()) column_ = static_cast<std::size_t>(shown - columns.begin());
  name_ = columns[column_].name;
  for (std::size_t a = plan.axes.size(); a-- > 0 && sides_.size() < 2;) {
    const SweepAxis& axis = plan.axes[a];
    if (axis.spread != Spread::grid || axis.values.size() < 2) continue;
    sides_.insert(sides_.begin(), side(a, sides_.empty() ? kMostUp : kMostAcross));
  }
  if (sides_.size() == 2) {
    sum_.assign(sides_[0].cells * sides_[1].cells, 0);
    count_ = sum_;
  }
}

MapText::Side MapText::side(std::size_t axis, std::size_t most) const {
  const std::size_t count = plan_.axes[axis].values.size();
  return {axis, count, std::min(count, most)};
}

void MapText::take(const SweepRows& rows, std::uint64_t first, const std::vector<double>& values) {
  if (sum_.empty()) return;
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i * columns_ < values.size(); ++i) {
    const double value = values[i * columns_ + column_];
    if (!std::isfinite(value)) continue;
    const SweepPoint point = point_of(plan_, rows.point(first + i));
    const std::size_t x = sides_[0].cell(point.place[sides_[0].axis]);
    const std::size_t y = sides_[1].cell(point.place[sides_[1].axis]);
    sum_[y * sides_[0].cells + x] += value;
    ++count_[y * sides_[0].cells + x];
  }
}

std::string MapText::row_label(std::size_t row) const {
  const Side& up = sides_[1];
  return value_text(plan_.axes[up.axis], row * up.count / up.cells);
}

std::vector<std::string> MapText::lines() const {
  if (sum_.empty()) return {};
  const std::lock_guard lock(mutex_);
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (std::size_t i = 0; i < sum_.size(); ++i) {
    if (count_[i] == 0) continue;
    low = std::min(low, sum_[i] / count_[i]);
    high = std::max(high, sum_[i] / count_[i]);
  }
  const SweepAxis &across = plan_.axes[sides_[0].axis], &up = plan_.axes[sides_[1].axis];
  std::vector<std::string> lines{
      fmt::format("{} {} {:.3g} to {} {:.3g}", name_, kShades[0], low, kShades[3], high)};
  if (!(low <= high)) lines[0] = name_;
  for (std::size_t row = sides_[1].cells; row-- > 0;) {
    std::string line = fmt::format("{:>10.10} ", row_label(row));
    for (std::size_t x = 0; x < sides_[0].cells; ++x) {
      const std::size_t i = row * sides_[0].cells + x;
      const double part = high > low ? (sum_[i] / count_[i] - low) / (high - low) : 1;
      line += count_[i] > 0 ? kShades[std::min<std::size_t>(3, static_cast<std::size_t>(4 * part))]
                            : "··";
    }
    lines.push_back(line);
  }
  lines.push_back(fmt::format("{:>10.10} {} {} to {}", up.name, across.name, value_text(across, 0),
                              value_text(across, sides_[0].count - 1)));
  return lines;
}

}  // namespace limpid
