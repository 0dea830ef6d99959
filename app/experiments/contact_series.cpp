#include "app/experiments/contact_series.h"

#include <fmt/format.h>

#include <algorithm>

namespace limpid {
namespace {

constexpr double kTouching = 1e-6;        // |f2| above this is contact [N m]
constexpr std::size_t kScatterStep = 12;  // rows a dot

// |x_E| against |f2| at every `step`th row in contact, both in SI.
std::vector<FigurePoint> in_contact(const Session& s, std::size_t step) {
  std::vector<FigurePoint> points;
  for (std::size_t k = 0; k < s.size(); k += step) {
    const double f2 = contact_torque(s, k);
    if (f2 > kTouching) points.push_back({f2, coordination_error(s, k).norm()});
  }
  return points;
}

}  // namespace

double contact_torque(const Session& s, std::size_t k) {
  return vector_at(s, k, Column::contact_torque).norm();
}

double contact_slope(const Session& s) { return slope_through_origin(in_contact(s, 1)); }

int lasting_contacts(const Session& s) {
  constexpr std::size_t kLasting = 100;  // rows
  int count = 0;
  std::size_t run = 0, pause = kLasting;
  for (std::size_t k = 0; k < s.size(); ++k) {
    if (contact_torque(s, k) > kTouching) {
      if (++run == kLasting && pause >= kLasting) ++count;
      if (run == kLasting) pause = 0;
    } else {
      run = 0;
      ++pause;
    }
  }
  return count;
}

Series error_over_time(const Session& s, const std::string& label, const char* color) {
  return over_time(s, label, color, Series::Style::line,
                   [&](auto k) { return 1e3 * coordination_error(s, k).norm(); });
}

void add_contact_scatter(FigurePanel& panel, const Session& s, const std::string& label,
                         const char* color) {
  Series dots{"", color, Series::Style::points, in_contact(s, kScatterStep)};
  double reach = 0;
  for (FigurePoint& p : dots.points) {
    reach = std::max(reach, p.x);
    p.y *= 1e3;
  }
  const double rise = contact_slope(s);
  panel.series.push_back(std::move(dots));
  panel.series.push_back({fmt::format("{}: {:.3g} mrad/(N m)", label, 1e3 * rise),
                          color,
                          Series::Style::line,
                          {{0, 0}, {reach, 1e3 * rise * reach}}});
}

}  // namespace limpid
