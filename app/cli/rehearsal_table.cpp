#include "app/cli/rehearsal_table.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/run/fitted_gains.h"
#include "app/run/rehearsal.h"

namespace limpid {
namespace {

constexpr double kEta = 0.7;  // above eta_min of the fitted gains, 0.59

Parameters suited(const ArmDescription& arm, CouplingKind kind, double encoder_step) {
  Parameters p = fitted(arm);
  p.kind = kind;
  p.eta = kEta;
  p.encoder_step = encoder_step;
  p.velocity = VelocitySource::adaptive;
  static_cast<CompensationSettings&>(p) = suggested_compensation(arm);
  return p;
}

nlohmann::ordered_json as_json(const Rehearsal& r) {
  return {{"slope", r.slope},   {"off", r.off},       {"friction", r.friction},
          {"weight", r.weight}, {"energy", r.energy}, {"force", r.force}};
}

}  // namespace

nlohmann::ordered_json rehearse_and_print(const ArmDescription& truth, const Unlikeness& bench,
                                          const ArmDescription& guess,
                                          const ArmDescription& found) {
  nlohmann::ordered_json json{
      {"eta", kEta}, {"delay", 1e-3 * bench.delay}, {"encoder_step", bench.encoder_step}};
  fmt::print("\nin a coupling, eta {}: delay {} ms, encoder step {:.2g} rad\n", kEta, bench.delay,
             bench.encoder_step);
  fmt::print("{:<24} {:>20} {:>16} {:>18} {:>16} {:>10}\n", "", "drift [mrad/(N m)]",
             "hand off [%]", "friction [mN m]", "weight [mN m]", "E_c [mJ]");
  for (const CouplingKind kind : {CouplingKind::proposed, CouplingKind::predictive}) {
    for (const bool after : {false, true}) {
      const ArmDescription& believed = after ? found : guess;
      const Rehearsal r =
          rehearse(truth, bench, believed, suited(believed, kind, bench.encoder_step));
      const char* const when = after ? "identified" : "as its file";
      fmt::print("{:<11} {:<12} {:>20.2f} {:>16.0f} {:>18.1f} {:>16.1f} {:>10.2f}{}\n", name(kind),
                 when, 1e3 * r.slope, 100 * r.off, 1e3 * r.friction, 1e3 * r.weight, 1e3 * r.energy,
                 r.force ? "" : "   the force was held back");
      json[name(kind)][after ? "identified" : "file"] = as_json(r);
    }
  }
  fmt::print("hand off: its torque in free motion off the one that eta promises, of it\n");
  return json;
}

}  // namespace limpid
