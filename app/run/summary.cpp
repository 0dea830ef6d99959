#include "app/run/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace limpid {
namespace {

auto vector(std::span<const double> values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

void Summary::add(std::span<const double> row) {
  const auto at = [&](Column c) { return layout_.in(row, c); };
  ++rows_;
  time_ = at(Column::time)[0];
  const double error =
      (vector(at(Column::device_position)) - vector(at(Column::proxy_position))).norm();
  const double contact = vector(at(Column::contact_torque)).norm();
  largest_error_ = std::max(largest_error_, error);
  if (contact >= largest_contact_) memorable_.assign(row.begin(), row.end());
  largest_contact_ = std::max(largest_contact_, contact);
  in_contact_ += contact > 0 ? 1 : 0;
  human_square_sum_ += vector(layout_.human_torque(row)).squaredNorm();
  energy_total_ = at(Column::energy_total)[0];
  energy_commanded_ = at(Column::energy_commanded)[0];
  highest_total_ = std::max(highest_total_, energy_total_);
}

std::string Summary::text() const {
  const auto rows = static_cast<double>(std::max<std::uint64_t>(rows_, 1));
  return fmt::format(
      "ticks                    {}\n"
      "in contact               {:.0f} %\n"
      "largest |x_E|            {:.3f} mrad\n"
      "largest |f2|             {:.4f} N m\n"
      "rms human torque         {:.4f} N m\n"
      "E_c total                {:.3f} mJ (highest {:.3f} mJ)\n"
      "E_c commanded            {:.3f} mJ\n",
      rows_, 100 * static_cast<double>(in_contact_) / rows, 1e3 * largest_error_, largest_contact_,
      std::sqrt(human_square_sum_ / rows), 1e3 * energy_total_, 1e3 * highest_total_,
      1e3 * energy_commanded_);
}

}  // namespace limpid
