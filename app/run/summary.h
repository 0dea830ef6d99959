// What a run or a recording amounts to, in a few lines.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/loop/row.h"

namespace limpid {

class Summary {
 public:
  explicit Summary(const RowLayout& layout) : layout_(layout) {}

  void add(std::span<const double> row);
  double time() const { return time_; }  // of the last row [s]
  // The row of the strongest contact; the last one of a run without any.
  std::span<const double> memorable() const { return memorable_; }
  std::string text() const;

 private:
  RowLayout layout_;
  std::uint64_t rows_ = 0;
  double time_ = 0;
  double largest_error_ = 0;                                            // |x_E| [rad]
  double largest_contact_ = 0;                                          // |f2| [N m]
  double human_square_sum_ = 0;                                         // of |f1| [N^2 m^2]
  double energy_total_ = 0, energy_commanded_ = 0, highest_total_ = 0;  // [J]
  std::uint64_t in_contact_ = 0;
  std::vector<double> memorable_;
};

}  // namespace limpid
