// What theory says of a map over eta, without simulating.
#pragma once

#include <string>

#include "app/figure/figure.h"
#include "app/sweep/sweep_plan.h"

namespace limpid {

// How a line of kTheories is called in figures.
std::string theory_label(const std::string& line);

// The smallest eta for the run's arm where its hand begins, in its grip: `pr` (25), `routh` of the
// locked system, `routh_compliant` with the proxy on the coupling's spring.
double eta_limit(const std::string& line, const RunPlan& run);

// That line along x, whose settings a point has otherwise. The plan needs its worlds.
Series theory_line(const SweepPlan& plan, std::uint64_t point, const SweepAxis& x,
                   const std::string& line);

}  // namespace limpid
