// Points of a sweep, in the order of its table's rows.
#pragma once

#include <functional>
#include <unordered_map>

#include "app/study/sweep_plan.h"

namespace limpid {

// Consecutive rows that are written, and lost, together.
struct SweepBlock {
  std::uint64_t number = 0, first = 0, size = 0;
};

// All points of a grid. If the plan refines: the coarse grid, then, round by round, the middles of
// cells across which the map changes. A round follows only from the values of earlier rounds; its
// points are in the order of their numbers.
class SweepRows {
 public:
  explicit SweepRows(const SweepPlan& plan);  // must outlive this

  std::uint64_t size() const { return ends_.back(); }
  std::uint64_t point(std::uint64_t row) const { return points_.empty() ? row : points_[row]; }
  std::optional<std::uint64_t> row_of(std::uint64_t point) const;

  // No block has points of two rounds.
  std::uint64_t blocks() const { return first_block_ + blocks_of_last(); }
  std::uint64_t first_block() const { return first_block_; }  // of the last round
  SweepBlock block(std::uint64_t number) const;
  std::uint64_t round(std::uint64_t row) const;
  std::uint64_t rounds() const { return ends_.size() - 1; }  // rounds known
  // First row of the last round.
  std::uint64_t begin_of_last() const { return ends_[ends_.size() - 2]; }

  // Adds the next round; false if there never will be one. `value` gives the refined column of
  // every row so far.
  using Value = std::function<double(std::uint64_t row)>;
  bool grow(const Value& value);
  bool complete() const { return complete_; }

  // Substitute for a place without a row: the corners of its cell with their weights. Empty if
  // there is no cell.
  struct Corner {
    std::uint64_t row;
    double weight;
  };
  std::vector<Corner> around(const std::vector<std::size_t>& place, std::uint64_t repeat) const;

 private:
  using Places = std::vector<std::size_t>;
  // An undivided box of the grid: its lowest corner and how often it was halved.
  struct CellKey {
    std::uint64_t origin;
    std::uint64_t level;
    bool operator==(const CellKey&) const = default;
  };
  struct CellHash {
    std::size_t operator()(const CellKey& k) const {
      return std::hash<std::uint64_t>()(k.origin * 16 + k.level);
    }
  };
  struct Cell {
    std::vector<std::uint64_t> rows;  // of the points inside and on the edges
    bool fresh = true;                // points came since it was last checked
  };
  using Cells = std::unordered_map<CellKey, Cell, CellHash>;

  std::uint64_t blocks_of_last() const;
  std::size_t step(std::uint64_t level) const;  // width of a cell, in places
  bool refined(std::size_t axis) const;
  std::uint64_t number(const Places& place) const;
  void add_round(const std::vector<std::uint64_t>& points);
  // Calls `take` with every place of a lattice over the refined axes: from `from`, `count` steps
  // along each.
  template <class Take>
  void each_of(const Places& from, std::size_t step, std::size_t count, const Take& take) const;
  std::optional<CellKey> cell_at(const Places& place, std::uint64_t side) const;
  void put_into_cells(const Places& place, std::uint64_t row);
  bool changes(const Cell& cell, const Value& value) const;
  std::vector<std::uint64_t> split(const CellKey& key);  // returns the points that are missing

  const SweepPlan* plan_;
  std::vector<std::uint64_t> points_;                      // of each row; empty: its number
  std::unordered_map<std::uint64_t, std::uint64_t> rows_;  // the other way round
  std::vector<std::uint64_t> ends_{0};                     // where each round begins, and the end
  std::uint64_t first_block_ = 0;
  bool complete_ = true;
  Cells cells_;
};

}  // namespace limpid
