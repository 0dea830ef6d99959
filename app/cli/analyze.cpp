#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "app/cli/commands.h"
#include "app/cli/options.h"
#include "app/run/analysis.h"

namespace limpid {
namespace {

struct AnalyzeOptions {
  InputOptions input;
  std::optional<double> band, mass;
  bool json = false;
};

void print(const Analysis& a, const Parameters& p) {
  const auto list = [](const std::vector<double>& values) {
    return fmt::format("{:.4g}", fmt::join(values, ", "));
  };
  fmt::print("observer bandwidth w_f     {} rad/s\n", list(a.w_f));
  fmt::print("locked system w_c          {} rad/s\n", list(a.w_c));
  fmt::print("damping b = b_d + b_v      {:.4g} N m s/rad\n", a.b);
  fmt::print("eta_min, all frequencies   {:.4f}   eta {:.4g} is {}\n", a.eta_min, p.eta,
             a.passive ? "passive" : "NOT passive");
  if (a.eta_min_band) fmt::print("eta_min, the band alone    {:.4f}\n", *a.eta_min_band);
  fmt::print("eta_min, in this grip      {:.4f}   (Routh; below it the loop is unstable)\n",
             a.eta_min_grip);
  fmt::print("condition (3)              {}   margins: device {:.4g}, proxy {:.4g} N m s/rad\n",
             a.condition3.holds ? "holds" : "BROKEN", a.condition3.device_margin,
             a.condition3.proxy_margin);
}

int analyze_command(const AnalyzeOptions& options) {
  const Parameters p = make_parameters(options.input);
  ArmDescription arm;
  SceneDocument document;
  read_world(options.input, arm, document);
  const std::optional<double> w_b =
      options.band ? std::optional(2 * std::numbers::pi * *options.band) : std::nullopt;
  const Analysis a =
      options.mass ? analyze(*options.mass, arm, p, w_b) : analyze(arm, rest_pose(arm), p, w_b);
  if (!options.json) {
    print(a, p);
    return 0;
  }
  nlohmann::ordered_json json{{"w_f", a.w_f}, {"w_c", a.w_c}, {"b", a.b}, {"eta_min", a.eta_min}};
  if (a.eta_min_band) json["eta_min_band"] = *a.eta_min_band;
  json["eta_min_grip"] = a.eta_min_grip;
  json["condition3"] = {{"device_margin", a.condition3.device_margin},
                        {"proxy_margin", a.condition3.proxy_margin},
                        {"holds", a.condition3.holds}};
  json["passive"] = a.passive;
  fmt::print("{}\n", json.dump(2));
  return 0;
}

}  // namespace

Command declare_analyze(CLI::App& app) {
  auto* command =
      app.add_subcommand("analyze", "eta_min and stability of a setting, without simulating");
  auto options = std::make_shared<AnalyzeOptions>();
  options->input.add_world(*command);
  options->input.add_parameters(*command);
  auto* band =
      command->add_option("--band", options->band, "the human's bandwidth, for eta_min within it")
          ->type_name("HZ");
  auto* mass = command
                   ->add_option("--mass", options->mass,
                                "a scalar inertia in place of the arm's at its rest pose")
                   ->type_name("KG_M2");
  require_above_zero(band, 1e6, "Hz");
  require_above_zero(mass, 1e6, "kg m^2");
  command->add_flag("--json", options->json, "one JSON object on standard output");
  command->footer(parameter_help());
  return [options] { return analyze_command(*options); };
}

}  // namespace limpid
