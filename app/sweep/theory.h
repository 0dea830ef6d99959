// What theory says of a map over eta, without simulating.
#pragma once

#include <string>

#include "app/run/simulate.h"

namespace limpid {

// How a line of kTheories is called in figures.
std::string theory_label(const std::string& line);

// The smallest eta for the run's arm where its hand begins, in its grip: `pr` (25), `routh` of the
// locked system, `routh_compliant` with the proxy on the coupling's spring.
double eta_limit(const std::string& line, const RunPlan& run);

}  // namespace limpid
