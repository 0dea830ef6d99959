#include "app/study/sweep_rows.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace limpid {

SweepRows::SweepRows(const SweepPlan& plan) : plan_(&plan) {
  if (!plan.refine) {
    ends_.push_back(plan.points());
    return;
  }
  complete_ = false;
  const std::size_t coarse = step(0);
  std::vector<std::uint64_t> points;
  for (std::uint64_t n = 0; n < coarse_points(plan); ++n) {
    Places place(plan.axes.size());
    std::uint64_t left = n;
    for (std::size_t a = plan.axes.size(); a-- > 0;) {
      const std::size_t each = refined(a) ? coarse : 1;
      const std::size_t count = (plan.axes[a].values.size() - 1) / each + 1;
      place[a] = left % count * each;
      left /= count;
    }
    points.push_back(number(place));
    bool cell = true;
    for (const std::size_t a : plan.refine->axes) {
      cell = cell && place[a] + coarse < plan.axes[a].values.size();
    }
    if (cell) cells_.try_emplace({points.back(), 0});
  }
  add_round(points);
}

std::optional<std::uint64_t> SweepRows::row_of(std::uint64_t point) const {
  if (points_.empty()) return point < size() ? std::optional(point) : std::nullopt;
  const auto found = rows_.find(point);
  return found == rows_.end() ? std::nullopt : std::optional(found->second);
}

std::uint64_t SweepRows::blocks_of_last() const {
  return (size() - begin_of_last() + plan_->block - 1) / plan_->block;
}

SweepBlock SweepRows::block(std::uint64_t number) const {
  std::uint64_t before = 0;
  for (std::size_t r = 0; r + 1 < ends_.size(); ++r) {
    const std::uint64_t rows = ends_[r + 1] - ends_[r];
    const std::uint64_t here = (rows + plan_->block - 1) / plan_->block;
    if (number < before + here) {
      const std::uint64_t first = ends_[r] + (number - before) * plan_->block;
      return {number, first, std::min(plan_->block, ends_[r + 1] - first)};
    }
    before += here;
  }
  return {number, size(), 0};
}

std::uint64_t SweepRows::round(std::uint64_t row) const {
  return static_cast<std::uint64_t>(std::ranges::upper_bound(ends_, row) - ends_.begin() - 1);
}

std::size_t SweepRows::step(std::uint64_t level) const {
  return std::size_t{1} << (plan_->refine->depth - level);
}

bool SweepRows::refined(std::size_t axis) const {
  return std::ranges::find(plan_->refine->axes, axis) != plan_->refine->axes.end();
}

std::uint64_t SweepRows::number(const Places& place) const {
  return number_of(*plan_, place, 0, 0);
}

void SweepRows::add_round(const std::vector<std::uint64_t>& points) {
  if (ends_.size() > 1) first_block_ += blocks_of_last();
  for (const std::uint64_t point : points) {
    const std::uint64_t row = points_.size();
    for (std::uint64_t r = 0; r < plan_->repeats; ++r) {
      rows_[point + r] = points_.size();
      points_.push_back(point + r);
    }
    put_into_cells(point_of(*plan_, point).place, row);
  }
  ends_.push_back(points_.size());
}

template <class Take>
void SweepRows::each_of(const Places& from, std::size_t step, std::size_t count,
                        const Take& take) const {
  const std::vector<std::size_t>& axes = plan_->refine->axes;
  std::vector<std::size_t> at(axes.size(), 0);
  while (true) {
    Places place = from;
    for (std::size_t i = 0; i < axes.size(); ++i) place[axes[i]] += at[i] * step;
    take(place);
    std::size_t i = 0;
    while (i < axes.size() && ++at[i] == count) at[i++] = 0;
    if (i == axes.size()) return;
  }
}

// Bit i of `side`: whether the cell lies below the place on the i-th of the refined axes.
std::optional<SweepRows::CellKey> SweepRows::cell_at(const Places& place,
                                                     std::uint64_t side) const {
  const std::vector<std::size_t>& axes = plan_->refine->axes;
  for (std::uint64_t level = 0; level <= plan_->refine->depth; ++level) {
    const std::size_t wide = step(level);
    Places origin = place;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      std::size_t& at = origin[axes[i]];
      if ((side >> i & 1) != 0) {
        if (at == 0) return std::nullopt;
        --at;
      }
      at -= at % wide;
    }
    const CellKey key{number(origin), level};
    if (cells_.contains(key)) return key;
  }
  return std::nullopt;
}

void SweepRows::put_into_cells(const Places& place, std::uint64_t row) {
  for (std::uint64_t side = 0; side < std::uint64_t{1} << plan_->refine->axes.size(); ++side) {
    const auto key = cell_at(place, side);
    if (!key) continue;
    Cell& cell = cells_.at(*key);
    if (std::ranges::find(cell.rows, row) == cell.rows.end()) cell.rows.push_back(row);
    cell.fresh = true;
  }
}

// Whether the value changes in the cell, in any of the repeats.
bool SweepRows::changes(const Cell& cell, const Value& value) const {
  const SweepRefine& refine = *plan_->refine;
  for (std::uint64_t r = 0; r < plan_->repeats; ++r) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    bool none = false;
    for (const std::uint64_t row : cell.rows) {
      double x = value(row + r);
      if (!refine.tolerance) x = refine.met(x) ? 1 : 0;
      none = none || std::isnan(x);
      low = std::fmin(low, x);
      high = std::fmax(high, x);
    }
    if ((none && low <= high) || high - low > refine.tolerance.value_or(0)) return true;
  }
  return false;
}

std::vector<std::uint64_t> SweepRows::split(const CellKey& key) {
  const Cell parent = std::move(cells_.extract(key).mapped());
  const Places from = point_of(*plan_, key.origin).place;
  const std::size_t half = step(key.level + 1);
  std::vector<std::uint64_t> lacking;
  each_of(from, half, 3, [&](const Places& place) {
    if (const std::uint64_t point = number(place); !rows_.contains(point)) lacking.push_back(point);
  });
  each_of(from, half, 2, [&](const Places& origin) {
    Cell& child = cells_[{number(origin), key.level + 1}];
    for (const std::uint64_t row : parent.rows) {
      const Places place = point_of(*plan_, points_[row]).place;
      const bool inside = std::ranges::all_of(plan_->refine->axes, [&](std::size_t a) {
        return place[a] >= origin[a] && place[a] <= origin[a] + half;
      });
      if (inside) child.rows.push_back(row);
    }
  });
  return lacking;
}

bool SweepRows::grow(const Value& value) {
  if (complete_) return false;
  std::set<std::uint64_t> points;
  // A division whose points are all there already is refined further at once.
  bool divided = true;
  while (divided && points.empty()) {
    std::vector<CellKey> changed;
    for (auto& [key, cell] : cells_) {
      if (!std::exchange(cell.fresh, false) || key.level == plan_->refine->depth) continue;
      if (changes(cell, value)) changed.push_back(key);
    }
    for (const CellKey& key : changed) {
      const auto lacking = split(key);
      points.insert(lacking.begin(), lacking.end());
    }
    divided = !changed.empty();
  }
  complete_ = points.empty();
  if (complete_) return false;
  add_round({points.begin(), points.end()});
  return true;
}

std::vector<SweepRows::Corner> SweepRows::around(const std::vector<std::size_t>& place,
                                                 std::uint64_t repeat) const {
  if (!plan_->refine) return {};
  const std::vector<std::size_t>& axes = plan_->refine->axes;
  std::uint64_t side = 0;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (place[axes[i]] + 1 == plan_->axes[axes[i]].values.size()) side |= std::uint64_t{1} << i;
  }
  const auto key = cell_at(place, side);
  if (!key) return {};
  const Places from = point_of(*plan_, key->origin).place;
  const std::size_t wide = step(key->level);
  std::vector<Corner> corners;
  each_of(from, wide, 2, [&](const Places& corner) {
    double weight = 1;
    for (const std::size_t a : axes) {
      const double part = static_cast<double>(place[a] - from[a]) / static_cast<double>(wide);
      weight *= corner[a] > from[a] ? part : 1 - part;
    }
    const auto row = row_of(number(corner) + repeat);
    if (weight > 0 && row) corners.push_back({*row, weight});
  });
  return corners;
}

}  // namespace limpid
