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

bool Summary::add(std::span<const double> row) {
  const auto at = [&](Column c) { return layout_.in(row, c); };
  time_ = at(Column::time)[0];
  const bool was_wild = watch_.wild();
  watch_.add(row);
  if (watch_.wild() && !was_wild) stable_ = all_;
  Totals& t = all_;
  ++t.rows;
  const double error =
      (vector(at(Column::device_position)) - vector(at(Column::proxy_position))).norm();
  const double contact = vector(at(Column::contact_torque)).norm();
  t.largest_error = std::max(t.largest_error, error);
  const bool memorable = contact >= t.largest_contact;
  if (memorable) t.memorable.assign(row.begin(), row.end());
  t.largest_contact = std::max(t.largest_contact, contact);
  t.in_contact += contact > 0 ? 1 : 0;
  t.human_square_sum += vector(layout_.human_torque(row)).squaredNorm();
  t.energy_total = at(Column::energy_total)[0];
  t.energy_commanded = at(Column::energy_commanded)[0];
  t.highest_total = std::max(t.highest_total, t.energy_total);
  return memorable;
}

std::string Summary::text() const {
  const Totals& t = totals();
  std::string text = fmt::format("ticks                    {}\n", all_.rows);
  if (watch_.lost()) {
    text += fmt::format(
        "unstable                 from t = {:.3f} s on: {}\n"
        "before that\n",
        watch_.since(), watch_.why());
  }
  return text + fmt::format(
                    "in contact               {:.0f} %\n"
                    "largest |x_E|            {:.3f} {}\n"
                    "largest |f2|             {:.4f} {}\n"
                    "rms human torque         {:.4f} {}\n"
                    "E_c total                {:.3f} mJ (highest {:.3f} mJ)\n"
                    "E_c commanded            {:.3f} mJ\n",
                    100 * t.share_in_contact(), 1e3 * units_.angles * t.largest_error,
                    units_.milliangle, units_.torques * t.largest_contact, units_.torque,
                    units_.torques * t.human_rms(), units_.torque, 1e3 * t.energy_total,
                    1e3 * t.highest_total, 1e3 * t.energy_commanded);
}

std::vector<Summary::Number> Summary::numbers() const {
  const Totals& t = totals();
  return {{"in contact", "%", 100 * t.share_in_contact()},
          {"largest |x_E|", units_.milliangle, 1e3 * units_.angles * t.largest_error},
          {"largest |f2|", units_.torque, units_.torques * t.largest_contact},
          {"rms human torque", units_.torque, units_.torques * t.human_rms()},
          {"E_c total", "mJ", 1e3 * t.energy_total},
          {"E_c total, highest", "mJ", 1e3 * t.highest_total}};
}

std::string Summary::beside(const Summary& first, const std::string& name, const Summary& second,
                            const std::string& other) {
  std::string text = fmt::format("{:<24} {:>16} {:>16} {:>10}\n", "", name, other, "ratio");
  const std::vector<Number> a = first.numbers(), b = second.numbers();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool comparable = std::abs(a[i].value) > 1e-9;
    text +=
        fmt::format("{:<24} {:>16.4f} {:>16.4f} {:>10} {}\n", a[i].what, a[i].value, b[i].value,
                    comparable ? fmt::format("{:.3g}", b[i].value / a[i].value) : "-", a[i].unit);
  }
  for (const auto* run : {&first, &second}) {
    if (!run->watch_.lost()) continue;
    text += fmt::format("{} is unstable from t = {:.3f} s on: {}\n", run == &first ? name : other,
                        run->watch_.since(), run->watch_.why());
  }
  return text;
}

}  // namespace limpid
