#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <future>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <thread>

#include "app/base/interrupt.h"
#include "app/cli/commands.h"
#include "app/cli/live_bench.h"
#include "app/cli/options.h"
#include "app/cli/out_folder.h"
#include "app/cli/progress.h"
#include "app/device/device_hub.h"
#include "app/experiments/identification.h"
#include "app/experiments/identify_report.h"
#include "app/run/fitted_gains.h"
#include "app/run/rehearsal.h"
#include "devices/identify/unlike_device.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

void print(const Identification& identification) {
  const Identified& found = identification.found;
  fmt::print("{:<14}", "joint");
  for (const FindingInfo& info : kFindings) {
    fmt::print(" {:>22}", fmt::format("{} [{}]", info.label, info.unit));
  }
  fmt::print(" {:>10} {:>9}\n", "inertia was", "missed");
  for (std::size_t j = 0; j < found.joints.size(); ++j) {
    const JointFinding& joint = found.joints[j];
    fmt::print("{:<14}", found.arm.joints[j].name);
    for (const FindingInfo& info : kFindings) {
      fmt::print(" {:>22}", text_of(joint.*info.field, info.per_unit));
    }
    fmt::print(" {:>11.3f} {:>7.1f} %\n", identification.inertia_in_file[j] / 1e-3,
               100 * joint.residual / joint.torque);
  }
  fmt::print("delay          {} ms from a reading to the torque computed from it\n",
             text_of(found.delay, 1e-3));
  const ReadingTimes& timing = identification.bare.timing;
  if (timing.rate > 0) {
    fmt::print(
        "readings       {:.0f} per second; time between two readings: median {:.2f} ms, 99th "
        "percentile {:.2f} ms, longest {:.2f} ms\n",
        timing.rate, 1e3 * timing.p50, 1e3 * timing.p99, 1e3 * timing.most);
  }
  if (identification.torque_scale) {
    fmt::print("motors         give {} times the commanded torque\n",
               text_of(*identification.torque_scale, 1));
  }
}

void print_drift(const Findings& last, const Identification& now) {
  const std::vector<Drift> all = drift(last, now);
  if (all.empty()) return;
  const auto certain = std::ranges::count_if(all, &Drift::certain);
  fmt::print("since {}: {}\n", last.when,
             certain == 0 ? "nothing has changed" : "these values have changed");
  for (const Drift& d : all) {
    if (!d.certain) continue;
    fmt::print("  {:<30} {} -> {} {}\n", d.what, text_of(d.before, 1), text_of(d.now, 1), d.unit);
  }
}

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

nlohmann::ordered_json rehearse_and_print(const ArmDescription& truth, const Unlikeness& bench,
                                          const ArmDescription& guess,
                                          const ArmDescription& found) {
  nlohmann::ordered_json json{
      {"eta", kEta}, {"delay", 1e-3 * bench.delay}, {"encoder_step", bench.encoder_step}};
  fmt::print("\nused in a coupling with eta {}: delay {} ms, encoder step {:.2g} rad\n", kEta,
             bench.delay, bench.encoder_step);
  fmt::print("{:<24} {:>20} {:>16} {:>18} {:>16} {:>10}\n", "", "drift [mrad/(N m)]",
             "hand off [%]", "friction [mN m]", "weight [mN m]", "E_c [mJ]");
  for (const CouplingKind kind : {CouplingKind::proposed, CouplingKind::predictive}) {
    for (const bool after : {false, true}) {
      const ArmDescription& believed = after ? found : guess;
      const Rehearsal r =
          rehearse(truth, bench, believed, suited(believed, kind, bench.encoder_step));
      const char* const when = after ? "identified" : "as in file";
      fmt::print("{:<11} {:<12} {:>20.2f} {:>16.0f} {:>18.1f} {:>16.1f} {:>10.2f}{}\n", name(kind),
                 when, 1e3 * r.slope, 100 * r.off, 1e3 * r.friction, 1e3 * r.weight, 1e3 * r.energy,
                 r.force ? "" : "   the force was held back");
      json[name(kind)][after ? "identified" : "file"] = as_json(r);
    }
  }
  fmt::print(
      "hand off: deviation of the hand's torque in free motion from the torque that eta promises, "
      "in % of the promised torque\n");
  return json;
}

constexpr const char* kSimulated = "simulated";

struct IdentifyOptions {
  std::string device;  // id; empty: the one in use, or the only one
  InputOptions input;  // the arm that the device is taken for
  std::string out;
  std::string gravity = "0,0,-9.81";
  unsigned seed = 1;
  bool yes = false, forget = false, force = false;
  IdentifyRequest order;
};

Vec3 gravity_of(const std::string& text) {
  if (text == "none") return Vec3::Zero();
  Vec3 g;
  int end = 0;
  const bool three = std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &g.x(), &g.y(), &g.z(), &end) == 3;
  if (three && end == static_cast<int>(text.size()) && g.allFinite() && g.norm() < 30) return g;
  throw UsageError(
      fmt::format("--gravity {}: needed: none, or X,Y,Z in m/s^2 in the frame of the arm's base, "
                  "for example 0,0,-9.81",
                  text));
}

void ask() {
  if (isatty(STDIN_FILENO) == 0) {
    throw UsageError(
        "a person must allow the device to move, but there is no terminal to ask in; needed: "
        "--yes, or a terminal");
  }
  const auto wait = [] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    return !interrupted;
  };
  if (!await_enter("Enter begins, Ctrl-C ends: ", wait)) throw UsageError("not begun");
}

void ask_to_begin(const IdentifyOptions& options, const Device& device) {
  const IdentifyRequest& order = options.order;
  fmt::print(
      "{} will move by itself for about {:.0f} s, through {:.0f} % of its range.\nClear the space "
      "around the device and let go of the device. Ctrl-C stops the motion at\nonce. Holding the "
      "device stops the motion as well.\n",
      device.traits().name, Excitation(order.guess, device.traits(), order.plan).duration(),
      100 * order.plan.range);
  if (!options.yes) ask();
}

IdentifyRun watched(const std::function<IdentifyRun(IdentifyProgress&)>& run) {
  catch_interrupts();
  IdentifyProgress motion;
  Progress progress({.title = "identify", .whole = 100, .unit = "", .rate = "% per second"});
  std::future<IdentifyRun> result = std::async(std::launch::async, [&] { return run(motion); });
  while (result.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) {
    motion.see();
    if (interrupted) motion.cancel = true;
    progress.at(100 * motion.time / motion.duration);
  }
  return result.get();
}

// Saves the hub with `in_use` as the device in use again.
void save(DeviceHub& hub, const std::string& in_use) {
  hub.use(in_use);
  if (const std::string wrong = hub.save(); !wrong.empty()) throw std::runtime_error(wrong);
}

int forget(const IdentifyOptions& options) {
  DeviceHub hub(device_store_file(), {});
  const std::string in_use = hub.in_use();
  if (!options.device.empty()) hub.use(options.device);
  if (!hub.refusal().empty()) throw UsageError(hub.refusal());
  hub.forget_arm();
  save(hub, in_use);
  fmt::print("forgotten\n");
  return 0;
}

int write_arm(const IdentifyOptions& options, const Identification& done,
              const std::optional<Findings>& last, const std::string& more) {
  const fs::path out = options.out;
  const std::string wrong = write_identification(done, last, out, more);
  fmt::print("arm: {}\nreport: {}\n", (out / "identified.urdf").string(),
             (out / "report.html").string());
  if (!wrong.empty()) fmt::print(stderr, "limpid: no pictures: {}\n", wrong);
  return wrong.empty() ? 0 : 1;
}

// Moves the device, with the load or without.
using Move = std::function<IdentifyRun(bool with_load, IdentifyProgress&)>;

void ask_for_load(const IdentifyOptions& options) {
  fmt::print(
      "Now fix the mass of {:g} kg to the tip, firmly and close to the tip. Then let go of the "
      "device.\n",
      options.order.load);
  ask();
}

// Says how to stay within the limits.
const char* remedy(ExcitationEnd end, bool simulated) {
  if (end != ExcitationEnd::limit) return "";
  return simulated ? "; try a smaller --range or --torque, or another --seed"
                   : "; try a smaller --range or --torque";
}

// Moves the device, and again with the load, and writes each motion however it ended. False if one
// ended early.
bool moved(const IdentifyOptions& options, const Move& mover, IdentifyRun& bare,
           IdentifyRun& with_load) {
  const auto move = [&](bool load, IdentifyRun& run, const char* file) {
    run = watched([&](IdentifyProgress& motion) { return mover(load, motion); });
    write_motion(run, fs::path(options.out) / file);
    if (run.end == ExcitationEnd::complete) return true;
    fmt::print(stderr, "limpid: ended: {}{}; {} contains the motion up to that time\n",
               explain(run, options.order), remedy(run.end, options.device == kSimulated),
               (fs::path(options.out) / file).string());
    return false;
  };
  if (!move(false, bare, kMotionFile)) return false;
  if (options.order.load == 0) return true;
  if (options.device != kSimulated) ask_for_load(options);
  return move(true, with_load, kLoadedMotionFile);
}

// Identifies a random simulated device, and rates the result.
int identify_simulated(IdentifyOptions& options) {
  IdentifyRequest& order = options.order;
  if (order.masses_right) {
    throw UsageError(
        "--masses-right: the masses of the simulated device differ from those in the arm's file");
  }
  order.seed = options.seed;
  SimulatedBench bench = simulated_bench(order, options.seed);
  const auto move = [&](bool with_load, IdentifyProgress& motion) {
    return move_simulated(bench, order, with_load, motion);
  };
  IdentifyRun bare, with_load;
  if (!moved(options, move, bare, with_load)) return 1;
  const Identification done =
      identification(bench.name, order, std::move(bare), std::move(with_load));
  print(done);
  if (done.torque_scale) {
    fmt::print("{:<15}{:.3f} is the true value, drawn at random\n", "",
               bench.unlikeness.torque_scale);
  }
  bench.unlikeness.torque_scale = 1;  // the identified torques include it
  const ordered_json rehearsal{{"rehearsal", rehearse_and_print(bench.truth, bench.unlikeness,
                                                                order.guess, done.found.arm)}};
  return write_arm(options, done, {}, rehearsal.dump());
}

OutFolder out_folder(const IdentifyOptions& options, const std::string& device) {
  const auto name = [](const char* file) { return fs::path(file).stem().string(); };
  return {options.out,
          "limpid identify " + device,
          {"report", "identified", name(kMotionFile), name(kLoadedMotionFile)},
          options.force};
}

int identify_device(IdentifyOptions options) {
  if (options.forget) return forget(options);
  if (options.out.empty()) throw UsageError("--out is required");
  IdentifyRequest& order = options.order;
  order.fit.gravity = gravity_of(options.gravity);
  order.guess = arm_of(options.input);
  if (options.device == kSimulated) {
    claim_out(out_folder(options, kSimulated));
    return identify_simulated(options);
  }
  if (options.yes && order.load > 0) {
    throw UsageError(
        "--yes: not together with --load: a person must be asked to fix the load to the tip");
  }
  DeviceHub hub(device_store_file(), {});
  const std::string in_use = hub.in_use();
  const std::unique_ptr<Device> device =
      open_device(options.device, hub,
                  fmt::format(", and \"{}\" tries the command without a device", kSimulated));
  claim_out(out_folder(options, hub.in_use()));
  order.plan = within(order.plan, hub.notes(hub.in_use()).limits);
  // A named arm wins over the one identified before.
  order.guess = options.input.device.empty() ? arm_of_device(device->traits(), hub, options.input)
                                             : narrowed(order.guess, device->traits());
  const auto move = [&](bool, IdentifyProgress& motion) {
    return run_identification(*device, order.guess, order.plan, motion, {});
  };
  ask_to_begin(options, *device);
  IdentifyRun bare, with_load;
  if (!moved(options, move, bare, with_load)) return 1;
  const std::string name = device->traits().name;
  const Identification done = identification(name, order, std::move(bare), std::move(with_load));
  print(done);
  const std::optional<Findings> last = read_findings(hub.remembered_report());
  if (last) print_drift(*last, done);
  const int status = write_arm(options, done, last, {});
  if (const std::string wrong = hub.remember(profile_of(done)); !wrong.empty()) {
    throw std::runtime_error(wrong);
  }
  save(hub, in_use);
  fmt::print("stored: {} uses this arm from now on; --forget removes the arm\n", name);
  return status;
}

}  // namespace

Command declare_identify(CLI::App& app) {
  auto* command = app.add_subcommand(
      "identify", "moves a device and finds the device's inertia, friction, weight and delay");
  auto options = std::make_shared<IdentifyOptions>();
  command->add_option(
      "DEVICE", options->device,
      fmt::format("the device's id, as `limpid devices` lists it, or \"{}\": a simulated device "
                  "whose values differ from its file, drawn by --seed; default: the device in use",
                  kSimulated));
  options->input.add_arm(*command);
  command
      ->add_option("--out", options->out,
                   "REQUIRED, except with --forget: the folder for report.html, identified.urdf, "
                   ".json, .svg and motion.csv")
      ->type_name("DIR");
  command->add_option("--gravity", options->gravity,
                      "none, or X,Y,Z [m/s^2] in the frame of the arm's base");
  command
      ->add_option("--range", options->order.plan.range,
                   "share of each joint's range that the motion uses")
      ->check(CLI::Range(0.05, 0.9));
  command
      ->add_option("--torque", options->order.plan.torque,
                   "share of the motors' torque limits that the motion uses")
      ->check(CLI::Range(0.05, 1.0));
  auto* load = command
                   ->add_option("--load", options->order.load,
                                "mass that you will fix to the tip for a second motion; this "
                                "motion shows the motors' true torque [kg]")
                   ->check(CLI::Range(kLeastLoad, kMostLoad));
  command
      ->add_flag("--masses-right", options->order.masses_right,
                 "the masses in the arm's file are right: Limpid finds the motors' true torque "
                 "from these masses")
      ->excludes(load);
  add_force(*command, options->force);
  require_whole_number(
      command->add_option("--seed", options->seed, "the seed of the simulated device"));
  command->add_flag("--yes", options->yes, "begin without asking");
  command->add_flag("--forget", options->forget, "forget the identified arm of the device");
  command->footer(
      "Nobody may hold the device during the motion. The motion ends at once on Ctrl-C, when "
      "something holds the\ndevice, when the device sends no readings, and at every safety limit. "
      "The result is a URDF:\nlimpid --device OUT/identified.urdf");
  return [options] { return identify_device(*options); };
}

}  // namespace limpid
