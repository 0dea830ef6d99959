// From when on a loop does what no arm can do, and how to say so.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/tick/row.h"

namespace limpid {

// Watches rows in turn. A row is wild when a joint turns faster than 1e3 rad/s, is asked for more
// than 1e4 N m, or device and proxy are 10 rad apart; a loop that got there may come back, and
// has after ten rows that are not. At a thousand times that, or at something that is no number, it
// is lost: unstable since the first wild row of those from which it did not come back.
class DivergenceWatch {
 public:
  explicit DivergenceWatch(const RowLayout& layout) : layout_(layout) {}

  void add(std::span<const double> row);

  bool wild() const { return !why_.empty(); }  // a row was, and it has not come back
  bool lost() const { return lost_; }
  // Of the first of those rows; only while wild().
  std::uint64_t since_row() const { return since_row_; }
  double since() const { return since_; }          // [s]
  const std::string& why() const { return why_; }  // in words, of the first of them

 private:
  RowLayout layout_;
  std::uint64_t rows_ = 0, since_row_ = 0, wild_row_ = 0;  // wild_row_: the last one
  double since_ = 0;
  bool lost_ = false;
  std::string why_;
};

}  // namespace limpid
