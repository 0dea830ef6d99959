// Maps of a sweep's table for the window, and lines of theory over eta.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/plot/figure.h"
#include "app/sweep/sweep_plan.h"
#include "app/sweep/sweep_table.h"

namespace limpid {

// Cells of an axis: from half a step before each value to half a step after it; words stand at 0,
// 1, ...
class AxisCells {
 public:
  explicit AxisCells(const SweepAxis& axis);
  std::pair<double, double> around(double x) const;
  std::pair<double, double> all() const {
    return {around(values_.front()).first, around(values_.back()).second};
  }

 private:
  double between(double a, double b) const;
  // Edge of the cell of x on the side away from its neighbour.
  double beyond(double x, double neighbour) const;

  bool log_;
  std::vector<double> values_;  // increasing
};

// The axis called `name`; without a name the next grid axis of several numbers besides `other`.
std::optional<std::size_t> axis_called(const SweepPlan& plan, const std::string& name,
                                       std::optional<std::size_t> other);

// Coordinate of the axis' value at `place`.
double axis_at(const SweepAxis& axis, std::size_t place);

// "stiffness [N/m]"; a yes or no has no unit.
std::string label_of(const std::string& name, const std::string& unit);
// "0.45", or the word.
std::string value_text(const SweepAxis& axis, std::size_t place);

// A part of a sweep's table over one or two of its axes, as the window shows it.
struct MapChoice {
  std::size_t column = 0, x = 0;
  std::optional<std::size_t> y;    // none, as always for a boundary: the column over x
  std::vector<std::size_t> place;  // on each axis; unused for x, y and sampled axes

  friend bool operator==(const MapChoice&, const MapChoice&) = default;
};
// The choice of the plan's figure, with the first place of all other axes.
MapChoice first_choice(const SweepPlan& plan, const SweepTable& table);
// `choice` with whatever the plan lacks replaced: x and y are two different axes.
MapChoice mended(const SweepPlan& plan, MapChoice choice);

// Spot of a map: a point, or all points that differ only in repeat and sample.
struct MapSpot {
  FigureCell cell;  // around x and y; its value is the mean, NaN if no point is done
  double x = 0, y = 0;
  std::uint64_t point = 0;  // number of the first point
  std::uint64_t count = 0;  // points done

  bool there() const { return count > 0; }
};

struct SweepMap {
  MapChoice choice;
  enum class Kind : std::uint8_t { cells, dots, curve } kind = Kind::cells;
  std::vector<MapSpot> spots;  // of cells: column by column, upwards
  std::size_t rows = 1;        // of cells: in each column
  std::pair<double, double> x_range, y_range, value_range;
  bool yes_no = false;      // every spot is one point, a yes or a no
  bool log_values = false;  // values are positive and span many decades
  // Edges of a yes/no map, lines of theory, and the highest change of a boundary.
  std::vector<Series> lines;
};

// Draws `choice` of the table. Too slow for the window's thread: theory takes time.
SweepMap make_map(const OpenedSweep& sweep, const MapChoice& choice);

// Name in figures of a line of kTheories.
std::string theory_label(const std::string& line);

// Smallest stable eta for the run's arm where its hand begins, in its grip. `line`: `pr` (25),
// `routh` of the locked system, `routh_compliant` with the proxy on the coupling's spring.
double eta_limit(const std::string& line, const RunPlan& run);

// A line of theory along x, with all other settings of `point`. The plan needs its worlds.
Series theory_line(const SweepPlan& plan, std::uint64_t point, const SweepAxis& x,
                   const std::string& line);
// The plan's lines of theory where x is eta itself: each upright over `heights` at its limit;
// without those beyond the axis, and none over another x.
std::vector<Series> upright_theory(const SweepPlan& plan, std::uint64_t point, const SweepAxis& x,
                                   std::pair<double, double> heights);

}  // namespace limpid
