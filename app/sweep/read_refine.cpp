#include "app/sweep/read_refine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/sweep/measure_point.h"

namespace limpid {
namespace {

constexpr std::uint64_t kDeepest = 10;
constexpr std::size_t kMostAxes = 4;
constexpr double kMostNumbers = 9e15;  // that a double tells apart
constexpr Range kAnyBound{-1e300, 1e300};

// Whether there are values between its values.
bool may_be_finer(const SweepAxis& axis) {
  const ParameterInfo* info = find_parameter(axis.key);
  const bool whole = info && std::holds_alternative<int Parameters::*>(info->field);
  return axis.spread == Spread::grid && axis.words.empty() && !whole && axis.values.size() > 1 &&
         std::ranges::adjacent_find(axis.values, std::greater_equal{}) == axis.values.end();
}

std::vector<std::size_t> read_axes(const TomlTable& table, const SweepPlan& plan) {
  std::vector<std::size_t> axes;
  const std::vector<std::string> names = table.texts("axes");
  for (std::size_t a = 0; a < plan.axes.size(); ++a) {
    const bool named = std::ranges::find(names, plan.axes[a].name) != names.end();
    if (names.empty() ? may_be_finer(plan.axes[a]) : named) axes.push_back(a);
    if (named && !may_be_finer(plan.axes[a])) {
      table.refuse("axes", plan.axes[a].name + " has no values in between; a grid's axes of " +
                               "numbers that are not whole, increasing");
    }
  }
  const bool all = names.empty() || axes.size() == names.size();
  if (!all || axes.empty() || axes.size() > kMostAxes) {
    table.refuse("axes", fmt::format("the names of 1 to {} axes", kMostAxes));
  }
  return axes;
}

void read_condition(const TomlTable& table, const SweepPlan& plan, SweepRefine& refine) {
  const std::vector<SweepColumn> columns = measured_columns(plan);
  const std::string name = table.text("measure").value_or(columns.front().name);
  const auto column = std::ranges::find(columns, name, &SweepColumn::name);
  if (column == columns.end()) table.refuse("measure", "one that is measured");
  refine.column = static_cast<std::size_t>(column - columns.begin());
  refine.above = table.number("above", kAnyBound);
  refine.below = table.number("below", kAnyBound);
  refine.tolerance = table.number("tolerance", {0, 1e300, true});
  const bool limit = refine.above || refine.below;
  if (limit && refine.tolerance) table.refuse("tolerance", "nothing beside above or below");
  if (column->unit != "yes/no" && !limit && !refine.tolerance) table.refuse_missing("tolerance");
}

// Halved `depth` times.
void make_finer(SweepAxis& axis, std::uint64_t depth) {
  for (std::uint64_t i = 0; i < depth; ++i) {
    std::vector<double> finer{axis.values.front()};
    for (std::size_t k = 1; k < axis.values.size(); ++k) {
      const double low = axis.values[k - 1], high = axis.values[k];
      finer.push_back(axis.logarithmic ? std::sqrt(low * high) : (low + high) / 2);
      finer.push_back(high);
    }
    axis.values = std::move(finer);
  }
}

}  // namespace

void read_refine(const TomlTable& table, SweepPlan& plan) {
  table.allow_only({"axes", "depth", "measure", "above", "below", "tolerance"});
  if (plan.samples > 1) table.refuse("axes", "nothing: sampled axes have no cells");
  SweepRefine refine;
  refine.axes = read_axes(table, plan);
  refine.depth = table.need(table.count("depth", 1, kDeepest), "depth");
  read_condition(table, plan, refine);
  double numbers = static_cast<double>(plan.points());
  for (std::size_t i = 0; i < refine.axes.size(); ++i) {
    numbers *= std::exp2(static_cast<double>(refine.depth));
  }
  if (numbers > kMostNumbers) table.refuse("depth", "less, or fewer axes: too many points");
  for (const std::size_t a : refine.axes) make_finer(plan.axes[a], refine.depth);
  plan.refine = std::move(refine);
}

}  // namespace limpid
