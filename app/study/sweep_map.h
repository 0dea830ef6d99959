// Where the values of an axis stand in a map, and what they are called.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/study/figure.h"
#include "app/study/sweep_plan.h"
#include "app/study/sweep_table.h"

namespace limpid {

// From half a step before to half a step after each value; words stand at 0, 1, ...
class AxisCells {
 public:
  explicit AxisCells(const SweepAxis& axis);
  std::pair<double, double> around(double x) const;
  std::pair<double, double> all() const {
    return {around(values_.front()).first, around(values_.back()).second};
  }

 private:
  double between(double a, double b) const;
  // As far on the other side of x as half the way to its neighbour.
  double beyond(double x, double neighbour) const;

  bool log_;
  std::vector<double> values_;  // increasing
};

// The axis with that name; without a name the next grid axis of several numbers besides `other`.
std::optional<std::size_t> axis_called(const SweepPlan& plan, const std::string& name,
                                       std::optional<std::size_t> other);

// Where its value at `place` stands.
double axis_at(const SweepAxis& axis, std::size_t place);

// "stiffness [N/m]"; a yes or no has no unit.
std::string label_of(const std::string& name, const std::string& unit);
// "0.45", or the word.
std::string value_text(const SweepAxis& axis, std::size_t place);

// A part of a sweep's table over one or two of its axes, as the window shows it.
struct MapChoice {
  std::size_t column = 0, x = 0;
  std::optional<std::size_t> y;    // none: the column over x; so always of a boundary
  std::vector<std::size_t> place;  // on each axis; those of x, y and sampled ones do not count

  friend bool operator==(const MapChoice&, const MapChoice&) = default;
};
// What the plan's figure shows, and the first of all else.
MapChoice first_choice(const SweepPlan& plan, const SweepTable& table);
// One that the plan has: x and y are two axes.
MapChoice mended(const SweepPlan& plan, MapChoice choice);

// A point, or as many as differ in repeats and samples alone.
struct MapSpot {
  FigureCell cell;  // around x and y; its value: the mean, not a number where none is done
  double x = 0, y = 0;
  std::uint64_t point = 0;  // its number; of several, the first one's
  std::uint64_t count = 0;  // done

  bool there() const { return count > 0; }
};

struct SweepMap {
  MapChoice choice;
  enum class Kind : std::uint8_t { cells, dots, curve } kind = Kind::cells;
  std::vector<MapSpot> spots;  // of cells: column by column, upwards
  std::size_t rows = 1;        // of cells: in each column
  std::pair<double, double> x_range, y_range, value_range;
  bool yes_no = false;      // one point a spot, that is a yes or a no
  bool log_values = false;  // positive ones over many decades
  // Of a yes/no map where it changes; of theory; of a boundary the highest change.
  std::vector<Series> lines;
};

// Not for the window's thread: theory takes its time.
SweepMap make_map(const OpenedSweep& sweep, const MapChoice& choice);

// What theory says of a map over eta, without simulating.

// How a line of kTheories is called in figures.
std::string theory_label(const std::string& line);

// The smallest eta for the run's arm where its hand begins, in its grip: `pr` (25), `routh` of the
// locked system, `routh_compliant` with the proxy on the coupling's spring.
double eta_limit(const std::string& line, const RunPlan& run);

// That line along x, whose settings a point has otherwise. The plan needs its worlds.
Series theory_line(const SweepPlan& plan, std::uint64_t point, const SweepAxis& x,
                   const std::string& line);

}  // namespace limpid
