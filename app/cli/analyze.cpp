#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "app/cli/commands.h"
#include "app/cli/in_hands_text.h"
#include "app/cli/measured_text.h"
#include "app/cli/options.h"
#include "app/run/analysis.h"
#include "app/run/fitted_gains.h"
#include "app/run/provenance.h"
#include "app/run/replay.h"
#include "app/run/tip_limits.h"
#include "app/run/wall_trial.h"
#include "devices/files/session/session_units.h"

namespace limpid {
namespace {

struct AnalyzeOptions {
  InputOptions input;
  std::optional<double> band, mass;
  std::vector<double> grip;  // from, to [N/m]; empty: none
  std::string grip_of;       // session in which the grip was measured; empty: none
  bool json = false, all = false, no_trial = false;
};

// Unit of an arm's dampers, and how many make one of the settings'.
struct DamperUnit {
  const char* name = "N m s/rad";
  double many = 1;
};

DamperUnit damper_unit(const ArmDescription& arm) {
  if (!arm.only_slides()) return {};
  const NormUnits units = norm_units(slides_of(arm));
  return {"N s/m", units.torques / units.angles};
}

void print(const Analysis& a, const ArmDescription& arm, const Parameters& p) {
  const DamperUnit unit = damper_unit(arm);
  const auto list = [](const std::vector<double>& values) {
    return fmt::format("{:.4g}", fmt::join(values, ", "));
  };
  fmt::print("computed from              {}\n", basis_text(arm, p));
  if (const std::string filed = readings_text(arm, p); !filed.empty()) {
    fmt::print("readings                   {}; --readings takes the values of the arm's file\n",
               filed);
  }
  fmt::print("observer bandwidth w_f     {} rad/s\n", list(a.w_f));
  fmt::print("locked system w_c          {} rad/s\n", list(a.w_c));
  fmt::print("damping b = b_d + b_v      {:.4g} {}\n", unit.many * a.b, unit.name);
  const Passivity known = passivity(a, p);
  fmt::print("{:<27}{}: {}\n", fmt::format("{}, eta {:.4g}", name(p.kind), p.eta),
             !known.passive   ? "not known to be passive"
             : *known.passive ? "passive"
                              : "NOT passive",
             known.by);
  fmt::print("eta_min, all frequencies   {:.4f}   equation (25), for the proposed law only\n",
             a.eta_min);
  if (a.eta_min_band) fmt::print("eta_min, in the band       {:.4f}\n", *a.eta_min_band);
  fmt::print(
      "eta_min, in this grip      {:.4f}   (Routh; below this eta the proposed law is unstable)\n",
      a.eta_min_grip);
  fmt::print(
      "eta_min, coupling's spring {:.4f}   (as above, with k_vc and b_vc between device and "
      "proxy)\n",
      a.eta_min_compliant);
  if (a.condition3.known) {
    fmt::print("condition (3)              {}   margins: device {:.4g}, proxy {:.4g} {}\n",
               a.condition3.holds ? "is met" : "BROKEN", unit.many * a.condition3.device_margin,
               unit.many * a.condition3.proxy_margin, unit.name);
  } else {
    fmt::print(
        "condition (3)              no limit is known because packets are lost (link.loss)\n");
  }
  if (!p.linked()) return;
  const std::string old =
      a.condition3.known
          ? fmt::format("packets up to {:.4g} ms old in each direction, as in condition (3)",
                        1e3 * a.link)
          : "packets are lost, so the newest packet that arrived may have any age";
  fmt::print("link                       {}; {}\n", old, info(p.kind).through_link);
}

constexpr double kFelt[] = {0.5, 1, 2, 5, 10, 20};  // [Hz]

void print(const WallTrial& trial) {
  if (trial.held > 0) {
    fmt::print("  held in simulated presses {:>6.0f} N/m", trial.held);
  } else {
    fmt::print("  held in simulated presses   none   ");
  }
  fmt::print("  {}\n", trial.fault.empty() ? "tapped and pressed slowly in three grips"
                                           : "not held: " + trial.fault);
}

void print(const TipLimits& tip, const std::optional<WallTrial>& trial, const Parameters& p,
           bool all) {
  const std::vector<CouplingKind> told = laws_told(p.kind, all);
  fmt::print(
      "\nat the tip: mass {:.3g} g, own damping {:.3g} N s/m; mass {:.3g} g if a hand moves the "
      "tip\n",
      1e3 * tip.tip.mass, tip.tip.damping, 1e3 * tip.tip.led);
  for (const CouplingKind kind : told) {
    const TipWall& wall = tip.wall(kind);
    fmt::print("stiffest wall, {:<11} {:>6.0f} N/m  {}\n", name(kind), wall.stiffness, wall.bound);
    if (trial && kind == p.kind) print(*trial);
  }
  fmt::print(
      "stiffest wall, in any hand {:>6.0f} N/m  a wall that is a simple spring is passive up to "
      "b_d/(T/2 + delay) (Colgate and Schenkel)\n",
      tip.every_hand);
  if (tip.scene > 0) fmt::print("stiffest in the scene      {:>6.0f} N/m\n", tip.scene);
  if (const std::string less = less_added_text(tip, p); !less.empty()) {
    fmt::print("eta, predictive            {}\n", less);
  }
  fmt::print("\nfelt in free motion     ");
  for (const CouplingKind kind : told) fmt::print(" {:>20}", name(kind));
  fmt::print("\n");
  for (const double f : kFelt) {
    fmt::print("{:>10} Hz              ", f);
    for (const CouplingKind kind : told) {
      const FeltAtTip felt = felt_at_tip(kind, p, tip, f);
      fmt::print(" {:>8.2f} g {:>5.2f} N s/m", 1e3 * felt.mass, felt.damping);
    }
    fmt::print("\n");
  }
}

nlohmann::ordered_json as_json(const TipLimits& tip, const std::optional<WallTrial>& trial,
                               const Parameters& p) {
  nlohmann::ordered_json json{
      {"mass", tip.tip.mass},        {"led_mass", tip.tip.led},
      {"damping", tip.tip.damping},  {"every_hand", tip.every_hand},
      {"scene", tip.scene},          {"least_damping", tip.felt.least_damping(p.eta, p.band)},
      {"frequency", kFelt},          {"eta_felt", tip.added.eta},
      {"delay_most", tip.delay_most}};
  for (std::uint8_t i = 0; i < kLaws; ++i) {
    nlohmann::ordered_json law{{"wall", tip.walls[i].stiffness}, {"bound", tip.walls[i].bound}};
    for (const double f : kFelt) {
      const FeltAtTip felt = felt_at_tip(static_cast<CouplingKind>(i), p, tip, f);
      law["felt_mass"].push_back(felt.mass);
      law["felt_damping"].push_back(felt.damping);
    }
    json[kLawKeys[i]] = law;
  }
  if (trial) {
    json["trial"] = {{"wall", trial->named}, {"held", trial->held}, {"fault", trial->fault}};
  }
  return json;
}

// Units of the numbers above, by their keys; numbers without an entry have no unit.
nlohmann::ordered_json units(const char* damper) {
  return {{"w_f", "rad/s"},
          {"w_c", "rad/s"},
          {"b", damper},
          {"delay", "s"},
          {"link", "s"},
          {"condition3.device_margin", damper},
          {"condition3.proxy_margin", damper},
          {"tip.mass", "kg"},
          {"tip.led_mass", "kg"},
          {"tip.damping", "N s/m"},
          {"tip.every_hand", "N/m"},
          {"tip.scene", "N/m"},
          {"tip.least_damping", "N s/m"},
          {"tip.frequency", "Hz"},
          {"tip.delay_most", "ticks"},
          {"tip.trial.wall", "N/m"},
          {"tip.trial.held", "N/m"},
          {"tip.LAW.wall", "N/m"},
          {"tip.LAW.felt_mass", "kg"},
          {"tip.LAW.felt_damping", "N s/m"}};
}

// Arm, pose and settings to analyze.
struct Analyzed {
  ArmDescription arm;
  SceneDocument document;
  Parameters p;
  Eigen::VectorXd pose;
  std::optional<MeasuredHand> hand;
};

// Takes them from a session in which the grip was measured, with that grip.
Analyzed of_session(const AnalyzeOptions& options) {
  const Session session = read_session(options.grip_of);
  const Parameters p = make_parameters(options.input, session_parameters(session, options.grip_of));
  RunPlan plan = replay(session, options.grip_of, p);
  Analyzed all{std::move(plan.arm), std::move(plan.document), p, {}, {}};
  all.hand = judged(all.arm, p, all.document.scene, recorded_grip(session, options.grip_of));
  const Grip& grip = all.hand->grip;
  if (!grip.measured) {
    throw FileError(fmt::format("{}: {}", options.grip_of, grip.unknown));
  }
  all.pose = grip.pose;
  if (grip.known()) all.p = with_grip(p, grip);
  return all;
}

Analyzed analyzed(const AnalyzeOptions& options) {
  if (!options.grip_of.empty()) return of_session(options);
  Analyzed all;
  read_world(options.input, all.arm, all.document);
  all.p = make_parameters(options.input, all.arm);
  all.pose = rest_pose(all.arm);
  return all;
}

std::optional<InHands> judged_in_hands(const AnalyzeOptions& options, const Analyzed& of,
                                       const Analysis& a, const std::optional<TipLimits>& tip) {
  if (of.hand) return of.hand->hands;
  if (options.grip.empty() || !tip) return std::nullopt;
  const HandRange range{options.grip[0], options.grip[1]};
  if (range.to < range.from) {
    throw UsageError(fmt::format("--grip {} {}: the second number is less than the first",
                                 range.from, range.to));
  }
  return in_hands(of.arm, of.pose, of.p, a, *tip, range);
}

int analyze_command(const AnalyzeOptions& options) {
  const Analyzed of = analyzed(options);
  const ArmDescription& arm = of.arm;
  const Parameters& p = of.p;
  const std::optional<double> w_b =
      options.band ? std::optional(2 * std::numbers::pi * *options.band) : std::nullopt;
  const Analysis a =
      options.mass ? analyze(*options.mass, arm, p, w_b) : analyze(arm, of.pose, p, w_b);
  const std::string still = still_tip(arm);
  const std::optional<TipLimits> tip =
      still.empty() ? std::optional(tip_limits(arm, of.pose, p, of.document.scene)) : std::nullopt;
  std::optional<WallTrial> trial;
  if (tip && tip->wall(p.kind).stiffness > 0 && !options.mass && !options.no_trial) {
    trial = try_wall(arm, of.pose, p, tip->wall(p.kind).stiffness);
  }
  const std::optional<InHands> hands = judged_in_hands(options, of, a, tip);
  if (!options.json) {
    if (of.hand) print_measured(*of.hand);
    if (of.hand && !of.hand->grip.known()) {
      fmt::print("the hand below             {:.4g} N/m, as in the session's settings\n",
                 p.hand_stiffness);
    }
    print(a, arm, p);
    if (options.mass) return 0;
    if (tip) print(*tip, trial, p, options.all);
    if (hands) print_in_hands(*hands, laws_told(p.kind, options.all));
    if (!tip) fmt::print("\n{}\n", still);
    return 0;
  }
  if (!tip && !options.mass) fmt::print(stderr, "limpid: warning: {}\n", still);
  const DamperUnit unit = damper_unit(arm);
  nlohmann::ordered_json json{{"provenance", provenance(settings_digest(p), std::nullopt)},
                              {"w_f", a.w_f},
                              {"w_c", a.w_c},
                              {"b", unit.many * a.b},
                              {"eta_min", a.eta_min}};
  if (a.eta_min_band) json["eta_min_band"] = *a.eta_min_band;
  json["eta_min_grip"] = a.eta_min_grip;
  json["eta_min_compliant"] = a.eta_min_compliant;
  json["condition3"] = {{"device_margin", unit.many * a.condition3.device_margin},
                        {"proxy_margin", unit.many * a.condition3.proxy_margin},
                        {"known", a.condition3.known},
                        {"holds", a.condition3.holds}};
  const Passivity known = passivity(a, p);
  json["coupling"] = name(p.kind);
  json["eta"] = p.eta;
  json["passive"] = nullptr;
  if (known.passive) json["passive"] = *known.passive;
  json["passive_by"] = known.by;
  json["delay"] = a.delay;
  json["link"] = a.link;
  json["measured"] = a.measured;
  if (!options.mass) json["tip"] = tip ? as_json(*tip, trial, p) : nlohmann::ordered_json(nullptr);
  json["units"] = units(unit.name);
  if (of.hand) {
    json["measured_grip"] = measured_json(*of.hand);
    json["units"].update(measured_units());
  }
  if (!options.grip.empty() || of.hand) {
    json["grip"] = hands ? in_hands_json(*hands) : nlohmann::ordered_json(nullptr);
    if (hands) json["units"].update(in_hands_units());
  }
  fmt::print("{}\n", json.dump(2));
  return 0;
}

}  // namespace

Command declare_analyze(CLI::App& app) {
  auto* command = app.add_subcommand("analyze",
                                     "computes eta_min, the stiffest stable wall, and the inertia "
                                     "and damping felt, for each law");
  auto options = std::make_shared<AnalyzeOptions>();
  options->input.add_world(*command);
  options->input.add_readings(*command);
  options->input.add_parameters(*command);
  auto* band = command
                   ->add_option("--band", options->band,
                                "highest frequency of the hand's motion; eta_min is computed for "
                                "motions up to this frequency")
                   ->type_name("HZ");
  auto* mass =
      command
          ->add_option("--mass", options->mass,
                       "a scalar inertia in place of the arm's inertia in the rest pose; "
                       "hand.stiffness and hand.damping then have the units N m/rad and N m s/rad")
          ->type_name("KG_M2");
  auto* grip =
      command
          ->add_option("--grip", options->grip,
                       "a range of hand stiffness, with hand.damping and hand.mass: shows walls "
                       "that are stable in all these hands, walls that are passive in every hand, "
                       "bounds from publications, and Llewellyn's criterion")
          ->type_name("FROM TO")
          ->expected(2)
          ->excludes(mass);
  command
      ->add_option(
          "--grip-of", options->grip_of,
          "a session in which the grip was measured (`limpid run --measure-grip`, or the window's "
          "Hand section): shows stiffness, damping and mass of that hand with bounds, and eta_min "
          "and stable walls in that hand; device, scene and settings come from the session")
      ->transform(or_shipped({"sessions"}), "", "")
      ->type_name("SESSION.h5")
      ->excludes(mass)
      ->excludes(grip)
      ->excludes("--device")
      ->excludes("--tip")
      ->excludes("--scene")
      ->excludes("--readings");
  require_above_zero(band, 1e6, "Hz");
  require_above_zero(grip, 1e6, "N/m");
  require_above_zero(mass, 1e6, "kg m^2");
  command->add_flag(
      "--all", options->all,
      "also print the laws that are only for comparison; JSON always contains these laws");
  command->add_flag("--no-trial", options->no_trial,
                    "do not simulate presses on the wall named for the chosen law");
  command->add_flag("--json", options->json, "one JSON object on standard output");
  command->footer(parameter_help());
  return [options] { return analyze_command(*options); };
}

}  // namespace limpid
