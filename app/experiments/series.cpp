#include "app/experiments/series.h"

#include <algorithm>
#include <cmath>

#include "app/base/assets.h"
#include "devices/files/arm/urdf_file.h"
#include "devices/files/scene/scene_file.h"

namespace limpid {

RunPlan plan_of(const std::string& scene, const std::string& hand, const Parameters& parameters) {
  RunPlan plan;
  plan.arm = read_urdf(default_device());
  plan.document = read_scene(data_dir() / "assets/scenes" / (scene + ".toml"), plan.arm);
  plan.hand = read_hand(data_dir() / "assets/hands" / (hand + ".csv"));
  plan.hand.source = "assets/hands/" + hand + ".csv";
  plan.parameters = parameters;
  plan.rows = rows_of(plan);
  return plan;
}

std::uint64_t rows_of(const RunPlan& plan) {
  return static_cast<std::uint64_t>(std::llround(plan.hand.duration() / plan.parameters.tick));
}

Eigen::VectorXd vector_at(const Session& session, std::size_t k, Column column) {
  const auto values = session.at(k, column);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Eigen::VectorXd coordination_error(const Session& session, std::size_t k) {
  return vector_at(session, k, Column::device_position) -
         vector_at(session, k, Column::proxy_position);
}

Series over_time(const Session& session, const std::string& label, const std::string& color,
                 Series::Style style, const std::function<double(std::size_t k)>& value,
                 std::size_t most) {
  Series series{label, color, style, {}};
  const std::size_t step = std::max<std::size_t>(1, session.size() / most);
  for (std::size_t k = 0; k < session.size(); k += step) {
    series.points.push_back({session.at(k, Column::time)[0], value(k)});
  }
  return series;
}

double rms_norm(const Session& session, Column column, std::size_t from, std::size_t to) {
  double sum = 0;
  for (std::size_t k = from; k < to; ++k) sum += vector_at(session, k, column).squaredNorm();
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, to - from)));
}

double slope_through_origin(const std::vector<FigurePoint>& points) {
  double xy = 0, xx = 0;
  for (const FigurePoint& p : points) {
    xy += p.x * p.y;
    xx += p.x * p.x;
  }
  return xx > 0 ? xy / xx : 0;
}

}  // namespace limpid
