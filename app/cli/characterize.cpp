#include "app/experiments/characterize.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "app/base/interrupt.h"
#include "app/cli/commands.h"
#include "app/cli/live_bench.h"
#include "app/cli/options.h"
#include "app/cli/out_folder.h"
#include "app/cli/outcome_text.h"
#include "app/cli/progress.h"
#include "app/live/device_look.h"
#include "app/live/rtkit.h"
#include "app/run/analysis.h"
#include "app/run/fitted_gains.h"
#include "app/run/provenance.h"
#include "app/run/tip_limits.h"
#include "core/realtime/realtime.h"
#include "devices/files/session/session_units.h"

namespace limpid {
namespace {

constexpr int kUsualDelay = 1;  // of a device of which nothing is known [ticks]

struct CharacterizeOptions {
  InputOptions input;                 // `device`: the arm's file
  std::optional<std::string> device;  // id of a real one
  std::string out;
  bool force = false;
};

// Whether these options set a number, whatever it was before. `one`, `other`: two values of it.
template <class Settings, class V>
bool sets(const InputOptions& options, V Settings::*number, V one, V other) {
  Parameters p, q;
  p.*number = one;
  q.*number = other;
  return make_parameters(options, p).*number == make_parameters(options, q).*number;
}

// An arm, and how much of it is known.
struct Source {
  ArmDescription arm;
  std::string name;
  std::string from;  // of inertia, damping and friction, for people
  bool arm_assumed = false;
  std::optional<double> encoder_step;  // that the device names; empty: no device [rad]
};

Source of_file(const CharacterizeOptions& options) {
  Source source;
  source.arm = arm_of(options.input);
  source.name = source.arm.name;
  source.from = source.arm.delay ? "the arm's file, identified on a device" : "the arm's file";
  return source;
}

// Chooses the device. One that is not connected has no encoders to read; the arm that is remembered
// for it can be named in its place.
void choose_plugged_in(const std::string& id, DeviceHub& hub) {
  try {
    choose_device(id, hub, "");
  } catch (const UsageError& error) {
    const DeviceNotes& notes = hub.notes(hub.in_use());
    if (hub.present() != nullptr || hub.in_use().empty()) throw;
    const std::string arm = !notes.arm.empty()               ? notes.arm
                            : notes.taken_for == kBuiltInArm ? std::string()
                                                             : notes.taken_for;
    throw UsageError(fmt::format(
        "{}. Plug the device in: a connected device reports the encoder steps itself.{}",
        error.what(),
        arm.empty()
            ? std::string()
            : fmt::format(
                  " Without the device: limpid characterize {} --set device.encoder_step=STEP",
                  arm)));
  }
}

// Reads what the device says of itself. It gets no force.
Source of_device(const CharacterizeOptions& options) {
  DeviceHub hub(device_store_file(), by_rtkit());
  choose_plugged_in(*options.device, hub);
  const FoundDevice& found = *hub.present();
  if (found.kind->leads_hand) {
    throw UsageError(found.place.id +
                     ": this device only moves the hand of the virtual arm and gives no force");
  }
  const OnlyLooked device(hub.open_to_look(), std::make_shared<DeviceSeen>());
  std::optional<ArmDescription> named;
  if (!options.input.device.empty()) named = arm_of(options.input);
  TakenArm taken = hub.arm_for(device.traits(), named ? &*named : nullptr);
  return {.arm = std::move(taken.arm),
          .name = device.traits().name,
          .from = taken.why,
          .arm_assumed = !taken.known,
          .encoder_step = encoder_step_of(device.traits())};
}

KnownNumber encoder_number(const Source& source, const InputOptions& input, Parameters& p) {
  const char* const unit = norm_units(slides_of(source.arm)).angle;
  KnownNumber number{"encoder_step", "step of the encoders", unit, 0, {}};
  if (sets(input, &DeviceSettings::encoder_step, 0.01, 0.02)) {
    number.from = "set";
  } else if (source.encoder_step.value_or(0) > 0) {
    p.encoder_step = *source.encoder_step;
    number.from = "reported by the device";
  } else if (source.arm.encoder_step > 0) {
    p.encoder_step = source.arm.encoder_step;
    number.from = "the arm's file";
  } else {
    number.assumed = true;
    number.from = source.encoder_step
                      ? "exact encoders: the device reports no step"
                      : "exact encoders; --set device.encoder_step=STEP sets a step";
  }
  return number;
}

KnownNumber delay_number(const Source& source, const InputOptions& input, Parameters& p) {
  KnownNumber number{"delay",
                     "delay from a reading to the torque computed from it, without the tick",
                     "ms",
                     0,
                     {}};
  if (sets(input, &DeviceSettings::device_delay, 1, 2)) {
    number.from = "set";
    return number;
  }
  if (source.arm.delay) {
    p.device_delay =
        static_cast<int>(std::min<long>(kMostDelay, std::lround(*source.arm.delay / p.tick)));
    number.from =
        fmt::format("identified as {:.2f} ms, rounded to whole ticks", 1e3 * *source.arm.delay);
  } else if (source.arm.assumed_delay > 0) {
    p.device_delay = with_readings_of(source.arm, p).device_delay;
    number.assumed = true;
    number.from = "assumed in the arm's file; limpid identify measures the delay";
  } else if (source.encoder_step) {
    p.device_delay = kUsualDelay;
    number.assumed = true;
    number.from =
        "one tick is assumed, as the delay was never measured; limpid identify measures the delay";
  } else {
    number.assumed = true;
    number.from = "no delay; --set device.delay=TICKS sets a delay";
  }
  p.delay = p.device_delay;
  return number;
}

KnownNumber damping_number(const Source& source, const InputOptions& input, const Parameters& p) {
  KnownNumber number{"damping",         "device's own damping at the tip", "N s/m", 0, source.from,
                     source.arm_assumed};
  if (sets(input, &DeviceSettings::damping, 1.0, 2.0)) {
    number.from = "set";
    number.assumed = false;
    return number;
  }
  if (!std::isnan(p.damping)) {
    number.assumed = true;
    number.from =
        "the arm's file gives no damping; with this value the arm comes to rest as quickly as the "
        "built-in arm";
  }
  return number;
}

KnownNumber friction_number(const Source& source, const InputOptions& input, double friction) {
  KnownNumber number{"friction", "friction at the tip", "N",
                     friction,   source.from,           source.arm_assumed};
  if (sets(input, &DeviceSettings::friction, 1.0, 2.0)) {
    number.from = "set";
    number.assumed = false;
  } else if (friction <= 0 && !source.arm.delay) {
    number.assumed = true;
    number.from = "no friction: the arm's file gives none";
  }
  return number;
}

Characterized subject_of(const CharacterizeOptions& options) {
  const InputOptions& input = options.input;
  Source source = options.device ? of_device(options) : of_file(options);
  const ArmDescription& arm = source.arm;
  if (const std::string still = still_tip(arm); !still.empty()) throw UsageError(still);
  const Parameters asked = make_parameters(input);
  Parameters read = asked;
  KnownNumber encoder = encoder_number(source, input, read);
  KnownNumber delay = delay_number(source, input, read);
  // Gains reckon with the delay.
  Parameters base = fitted(arm, asked, asked.tick * read.device_delay);
  base.encoder_step = read.encoder_step;
  base.device_delay = read.device_delay;
  base.delay = read.delay;
  Characterized subject;
  subject.name = source.name;
  KnownNumber mass{"mass", "mass at the tip", "g", 0, source.from, source.arm_assumed};
  KnownNumber damping = damping_number(source, input, base);
  const Parameters p = make_parameters(input, base);
  const TipLimits tip = tip_limits(arm, rest_pose(arm), p, {});
  mass.value = 1e3 * tip.tip.mass;
  damping.value = tip.tip.damping;
  encoder.value = p.encoder_step * norm_units(slides_of(arm)).angles;
  delay.value = 1e3 * p.tick * p.device_delay;
  const KnownNumber friction = friction_number(
      source, input, friction_at_tip(arm_at(arm, rest_pose(arm)).J, device_friction(arm, p)));
  subject.numbers = {mass, damping, friction, encoder, delay};
  subject.at = {std::move(source.arm), p};
  return subject;
}

void print_table(const Characterized& subject, const Characterization& found) {
  fmt::print("{}\n", found.outcome.figure.title);
  for (const KnownNumber& number : subject.numbers) {
    fmt::print("  {:<52} {:>8.4g} {:<6} {}{}\n", number.what, number.value, number.unit,
               number.assumed ? "ASSUMED: " : "", number.from);
  }
  fmt::print("\n{:<12} {:>16} {:>12} {:>24} {:>12} {:>22}\n", "law", "stiffest [N/m]", "analyze",
             fmt::format("{} N/m felt as", kCommonWall), "given [mJ]", "felt at 2 Hz");
  for (const LawRendered& law : found.laws) {
    const auto [least, most] = law.felt();
    const FeltMotion* const free = at_frequency(law.free, 2);
    fmt::print("{:<12} {:>16} {:>12.0f} {:>24} {:>12} {:>22}\n", info(law.kind).key,
               wall_text(law.wall), law.named,
               most > 0 ? fmt::format("{:.0f} to {:.0f}", least, most) : "none", given_text(law),
               free == nullptr
                   ? "unstable"
                   : fmt::format("{:.1f} g, {:.2f} N s/m", 1e3 * free->inertia, free->damping));
  }
  const auto friction = std::ranges::find(subject.numbers, "friction", &KnownNumber::key);
  if (friction != subject.numbers.end() && friction->value > 0) {
    fmt::print(
        "The arm's friction resists the hand with {:.2g} N. The measured stiffness, mass and "
        "damping contain this friction, so they can be negative, or several times the values of "
        "`limpid analyze`.\n",
        friction->value);
  }
  fmt::print("\n");
}

// Refuses what would have no effect: all laws are measured, in hands of the bench's own.
void refuse_what_is_fixed(const InputOptions& input) {
  const auto refuse = [](const char* what) {
    throw UsageError(
        fmt::format("{}: cannot be chosen here: characterize measures every law, with simulated "
                    "hands that are always the same",
                    what));
  };
  if (input.coupling) refuse("--coupling");
  if (sets(input, &ControllerSettings::kind, CouplingKind::standard, CouplingKind::tank)) {
    refuse("coupling.kind");
  }
  if (sets(input, &HandSettings::hand_stiffness, 1.0, 2.0)) refuse("hand.stiffness");
  if (sets(input, &HandSettings::hand_damping, 1.0, 2.0)) refuse("hand.damping");
}

int run_characterize(const CharacterizeOptions& options) {
  if (!options.device && options.input.device.empty()) {
    throw UsageError("needed: an arm's file, or --device for a device that is plugged in");
  }
  refuse_what_is_fixed(options.input);
  const Characterized subject = subject_of(options);
  claim_out({options.out,
             "limpid characterize " + subject.name,
             {"report", kCharacterize},
             options.force});
  catch_interrupts();
  keep_what_is_freed();
  TrialRunner::Options lab_options;
  lab_options.dir = options.out;
  lab_options.stop = &interrupted;
  Characterization found;
  try {
    Progress progress({.title = "characterize", .whole = 100, .unit = "", .rate = "% per second"});
    lab_options.progress = [&](double part) { progress.at(100 * part); };
    TrialRunner lab("characterize", lab_options);
    found = characterize(lab, subject);
  } catch (const Cancelled&) {
    fmt::print(stderr, "limpid: stopped; no results were written\n");
    return 1;
  }
  found.outcome.figure.made_by = provenance(settings_digest(subject.at.parameters), std::nullopt);
  try {
    write_characterization(subject, found, options.out);
  } catch (const FileError& error) {  // of the results, not of the input
    throw std::runtime_error(error.what());
  }
  print_table(subject, found);
  print_outcome(subject.name, found.outcome);
  std::vector<std::string> failed;
  note_failures(subject.name, found.outcome, failed);
  return finish_report(options.out, failed);
}

}  // namespace

Command declare_characterize(CLI::App& app) {
  auto* command = app.add_subcommand(
      "characterize",
      "reports which walls, mass and damping an arm, or a device's arm, can render with each law");
  auto options = std::make_shared<CharacterizeOptions>();
  command->add_option("ARM", options->input.device, "the arm's file")
      ->transform(or_shipped({"devices"}), "", "")
      ->type_name("FILE.urdf");
  command
      ->add_option_function<std::string>(
          "--device", [options](const std::string& id) { options->device = id; },
          "the id of a real device, as `limpid devices` lists it: the report uses that device's "
          "arm (identified or chosen), encoders, delay and friction. The device gets no force")
      ->type_name("DEVICE");
  command->add_option("--tip", options->input.tip, "the link of the arm that the hand holds")
      ->type_name("LINK");
  command->add_option("--out", options->out, "the folder for report.html and characterize.json")
      ->required()
      ->type_name("DIR");
  add_force(*command, options->force);
  options->input.add_parameters(*command);
  command->footer(
      "For each law the report shows the stiffest wall that feels as stiff as it is set and does "
      "not vibrate,\nthe energy given to the hand, and mass and damping felt in free motion, next "
      "to the values that\n`limpid analyze` computes. All numbers come from the virtual arm of "
      "that file: a real device may differ.\nThe report says which numbers are measured, set and "
      "assumed. Exit status 1: a promise was not kept, or\nthe command was stopped.\n\n" +
      parameter_help());
  return [options] { return run_characterize(*options); };
}

}  // namespace limpid
