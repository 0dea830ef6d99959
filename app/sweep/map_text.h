// A sweep's map in letters, filling in.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "app/sweep/sweep_table.h"

namespace limpid {

// The last two axes of a grid, the last one upwards, the mean over all others; of the first measure
// (or the figure's) in shades from its lowest to its highest value so far, of a boundary too. Dots
// where nothing is yet. Safe from several threads.
class MapText {
 public:
  MapText(const SweepPlan& plan, const std::vector<SweepColumn>& columns);

  // Of consecutive rows from `first` on.
  void take(const SweepRows& rows, std::uint64_t first, const std::vector<double>& values);
  std::vector<std::string> lines() const;  // none without such axes

 private:
  struct Side {
    std::size_t axis = 0, count = 0, cells = 0;
    std::size_t cell(std::size_t place) const { return place * cells / count; }
  };
  Side side(std::size_t axis, std::size_t most) const;
  std::string row_label(std::size_t row) const;

  const SweepPlan& plan_;
  std::size_t columns_, column_ = 0;
  std::string name_;
  std::vector<Side> sides_;  // across, up
  std::vector<double> sum_, count_;
  mutable std::mutex mutex_;
};

}  // namespace limpid
