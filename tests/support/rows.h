// Rows of the trace, kept together and read as vectors.
#pragma once

#include <algorithm>
#include <cstring>
#include <span>
#include <vector>

#include "core/math/sizes.h"
#include "core/tick/row.h"

namespace limpid::test {

class Rows {
 public:
  explicit Rows(const RowLayout& layout) : layout_(layout) {}

  // Adds a row at the end, to be filled.
  std::span<double> add() {
    all_.resize(all_.size() + stride());
    return std::span(all_).last(stride());
  }
  void add(std::span<const double> row) { all_.insert(all_.end(), row.begin(), row.end()); }

  std::size_t size() const { return all_.size() / stride(); }
  std::span<const double> row(std::size_t k) const {
    return std::span(all_).subspan(k * stride(), stride());
  }
  double at(std::size_t k, Column c) const { return layout_.in(row(k), c)[0]; }
  Eigen::VectorXd vec(std::size_t k, Column c) const {
    return Eigen::Map<const Eigen::VectorXd>(layout_.in(row(k), c).data(), layout_.width(c));
  }
  struct Touch {
    Vec3 point, force;
  };
  // Places and forces of the proxy's contacts.
  std::vector<Touch> touches(std::size_t k) const {
    const Eigen::VectorXd points = vec(k, Column::contact_point);
    const Eigen::VectorXd forces = vec(k, Column::contact_force);
    std::vector<Touch> out;
    for (Eigen::Index i = 0; i < forces.size(); i += 3) {
      const Vec3 force = forces.segment<3>(i);
      if (!force.isZero(0)) out.push_back({points.segment<3>(i), force});
    }
    return out;
  }
  // Sum of their forces [N].
  Vec3 force(std::size_t k) const {
    Vec3 all = Vec3::Zero();
    for (const Touch& touch : touches(k)) all += touch.force;
    return all;
  }
  const RowLayout& layout() const { return layout_; }

 private:
  std::size_t stride() const { return static_cast<std::size_t>(layout_.stride()); }

  RowLayout layout_;
  std::vector<double> all_;
};

// Number of doubles whose bits differ in two rows; timing is left out, as it is no part of the
// motion.
inline int differences(const RowLayout& layout, std::span<const double> a,
                       std::span<const double> b) {
  int count = 0;
  const auto end = static_cast<std::size_t>(layout.offset(Column::wake_latency));
  for (std::size_t i = 0; i < end; ++i) {
    count += std::memcmp(&a[i], &b[i], sizeof(double)) == 0 ? 0 : 1;
  }
  return count;
}

// Whether two rows of numbers have the same bits, those that are no numbers included.
inline bool same_numbers(std::span<const double> a, std::span<const double> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

// Index of the first row that differs between the two, or -1.
inline long first_difference(const Rows& a, const Rows& b) {
  if (a.size() != b.size()) return static_cast<long>(std::min(a.size(), b.size()));
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (differences(a.layout(), a.row(k), b.row(k)) > 0) return static_cast<long>(k);
  }
  return -1;
}

}  // namespace limpid::test
