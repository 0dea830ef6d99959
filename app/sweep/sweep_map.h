// A part of a sweep's table over one or two of its axes, as the window shows it.
#pragma once

#include "app/figure/figure.h"
#include "app/sweep/open_table.h"

namespace limpid {

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
  bool inferred = false;    // from the points around it, where the map was not refined

  bool there() const { return count > 0 || inferred; }
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

}  // namespace limpid
