// From recorded rows to numbers and curves.
#pragma once

#include <functional>

#include "app/experiments/experiment.h"

namespace limpid {

// A trial in the built-in arm's world: `scene` and `hand` name files of assets/ without folder.
RunPlan plan_of(const std::string& scene, const std::string& hand, const Parameters& parameters);

// Ticks that the plan's hand lasts.
std::uint64_t rows_of(const RunPlan& plan);

Eigen::VectorXd vector_at(const Session& session, std::size_t k, Column column);
// x1 - x2 at row k [rad].
Eigen::VectorXd coordination_error(const Session& session, std::size_t k);

// A curve over time, at most `most` points: evenly thinned.
Series over_time(const Session& session, const std::string& label, const std::string& color,
                 Series::Style style, const std::function<double(std::size_t k)>& value,
                 std::size_t most = 2000);

// Root mean square over the rows [from, to) of a vector column's norm.
double rms_norm(const Session& session, Column column, std::size_t from, std::size_t to);

// Least-squares slope of y on x through the origin.
double slope_through_origin(const std::vector<FigurePoint>& points);

}  // namespace limpid
