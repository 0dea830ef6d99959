#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <future>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/base/interrupt.h"
#include "app/cli/commands.h"
#include "app/cli/live_bench.h"
#include "app/cli/options.h"
#include "app/cli/out_folder.h"
#include "app/cli/progress.h"
#include "app/cli/rehearsal_table.h"
#include "app/device/device_hub.h"
#include "app/device/identify_run.h"
#include "app/device/urdf_writer.h"
#include "app/run/analysis.h"
#include "devices/files/atomic_file.h"
#include "devices/identify/fit.h"
#include "devices/identify/unlike_device.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* kSimulated = "simulated";

struct IdentifyOptions {
  std::string device;  // id; empty: the one in use, or the only one
  InputOptions input;  // the arm that it is taken for
  std::string out;
  std::string gravity = "0,0,-9.81";
  unsigned seed = 1;
  bool yes = false, forget = false;
  ExcitationPlan plan;
};

Vec3 gravity_of(const std::string& text) {
  if (text == "none") return Vec3::Zero();
  Vec3 g;
  int end = 0;
  const bool three = std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &g.x(), &g.y(), &g.z(), &end) == 3;
  if (three && end == static_cast<int>(text.size()) && g.allFinite() && g.norm() < 30) return g;
  throw UsageError(
      fmt::format("--gravity {}: needed: none, or X,Y,Z in m/s^2 in the frame of the "
                  "arm's base, as 0,0,-9.81",
                  text));
}

void ask_to_begin(const IdentifyOptions& options, const Device& device, double seconds) {
  fmt::print(
      "{} will move by itself for about {:.0f} s, through {:.0f} % of its range.\n"
      "Clear the space around it and let go of it; Ctrl-C stops it at once, and so does\n"
      "holding on to it.\n",
      device.traits().name, seconds, 100 * options.plan.range);
  if (options.yes) return;
  if (isatty(STDIN_FILENO) == 0) {
    throw UsageError("nobody can be asked whether it may move; needed: --yes, or a terminal");
  }
  fmt::print("Enter begins: ");
  std::fflush(stdout);
  std::string line;
  if (!std::getline(std::cin, line)) throw UsageError("not begun");
}

IdentifyRun watched(const std::function<IdentifyRun(IdentifyTalk&)>& run) {
  catch_interrupts();
  IdentifyTalk talk;
  Progress progress({.title = "identify", .whole = 100, .unit = "", .rate = "% a second"});
  std::future<IdentifyRun> result = std::async(std::launch::async, [&] { return run(talk); });
  while (result.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) {
    talk.see();
    if (interrupted) talk.cancel = true;
    progress.at(100 * talk.time / talk.duration);
  }
  return result.get();
}

ordered_json as_json(const Found& found) {
  return {{"value", found.value}, {"deviation", found.deviation}};
}

ordered_json as_json(const Identified& found, const IdentifyRun& run, const std::string& device) {
  ordered_json joints = ordered_json::array();
  for (std::size_t j = 0; j < found.joints.size(); ++j) {
    const JointFinding& joint = found.joints[j];
    joints.push_back({{"name", found.arm.joints[j].name},
                      {"middle", found.middle[static_cast<Eigen::Index>(j)]},
                      {"inertia", as_json(joint.inertia)},
                      {"weight", as_json(joint.gravity)},
                      {"viscous", as_json(joint.viscous)},
                      {"coulomb", as_json(joint.coulomb)},
                      {"offset", as_json(joint.offset)},
                      {"spring", as_json(joint.spring)},
                      {"residual", joint.residual},
                      {"torque", joint.torque},
                      {"samples", joint.samples}});
  }
  ordered_json json{{"device", device},
                    {"arm", found.arm.name},
                    {"seconds", run.record.T * static_cast<double>(run.record.rows())},
                    {"delay", as_json(found.delay)},
                    {"joints", joints}};
  if (run.timing.rate > 0) {
    json["readings"] = {{"rate", run.timing.rate},
                        {"interval_p50", run.timing.p50},
                        {"interval_p99", run.timing.p99},
                        {"interval_max", run.timing.most}};
  }
  return json;
}

void print(const Identified& found, const ArmDescription& guess, const IdentifyRun& run) {
  fmt::print("{:<14} {:>22} {:>10} {:>20} {:>22} {:>22} {:>20} {:>9}\n", "joint", "inertia [g m^2]",
             "was", "weight [mN m]", "friction [mN m]", "viscous [mN m s/rad]", "spring [N m/rad]",
             "missed");
  const auto pair = [](const Found& f, double unit) {
    return fmt::format("{:.3f} +- {:.3f}", f.value / unit, f.deviation / unit);
  };
  const Eigen::MatrixXd M = arm_at(guess, found.middle).M;
  for (std::size_t j = 0; j < found.joints.size(); ++j) {
    const JointFinding& joint = found.joints[j];
    const auto i = static_cast<Eigen::Index>(j);
    fmt::print("{:<14} {:>22} {:>10.3f} {:>20} {:>22} {:>22} {:>20} {:>7.1f} %\n",
               found.arm.joints[j].name, pair(joint.inertia, 1e-3), M(i, i) / 1e-3,
               pair(joint.gravity, 1e-3), pair(joint.coulomb, 1e-3), pair(joint.viscous, 1e-3),
               pair(joint.spring, 1), 100 * joint.residual / joint.torque);
  }
  fmt::print("delay          {:.2f} +- {:.2f} ms from a reading to the torque that answers it\n",
             1e3 * found.delay.value, 1e3 * found.delay.deviation);
  if (run.timing.rate > 0) {
    fmt::print(
        "readings       {:.0f} a second; between two: {:.2f} ms in the middle, {:.2f} ms at "
        "99 %, {:.2f} ms at most\n",
        run.timing.rate, 1e3 * run.timing.p50, 1e3 * run.timing.p99, 1e3 * run.timing.most);
  }
}

std::string csv_of(const MotionRecord& record) {
  std::string text = "time";
  for (Eigen::Index j = 1; j <= record.joints(); ++j) text += fmt::format(",x{}", j);
  for (Eigen::Index j = 1; j <= record.joints(); ++j) text += fmt::format(",torque{}", j);
  text += '\n';
  for (Eigen::Index i = 0; i < record.rows(); ++i) {
    text += fmt::format("{:.3f}", static_cast<double>(i) * record.T);
    for (Eigen::Index j = 0; j < record.joints(); ++j)
      text += fmt::format(",{:.9g}", record.x(i, j));
    for (Eigen::Index j = 0; j < record.joints(); ++j) {
      text += fmt::format(",{:.9g}", record.torque(i, j));
    }
    text += '\n';
  }
  return text;
}

void write(const fs::path& file, const std::string& text) {
  const std::string wrong = try_write_atomically(file, text);
  if (!wrong.empty()) throw std::runtime_error(wrong);
}

// With the device in use that was before.
void save(DeviceHub& hub, const std::string& in_use) {
  hub.use(in_use);
  if (const std::string wrong = hub.save(); !wrong.empty()) throw std::runtime_error(wrong);
}

int forget(const IdentifyOptions& options) {
  DeviceHub hub(device_book_file(), {});
  const std::string in_use = hub.in_use();
  if (!options.device.empty()) hub.use(options.device);
  hub.forget_arm();
  save(hub, in_use);
  fmt::print("forgotten\n");
  return 0;
}

int identify_device(IdentifyOptions options) {
  if (options.forget) return forget(options);
  if (options.out.empty()) throw UsageError("--out is required");
  prepare_out(options.out);
  const Vec3 gravity = gravity_of(options.gravity);
  ArmDescription guess;
  SceneDocument scene;
  read_world(options.input, guess, scene);
  DeviceHub hub(device_book_file(), {});
  const std::string in_use = hub.in_use();
  const bool simulated = options.device == kSimulated;
  const ArmDescription truth = unlike(guess, options.seed, 0.03);
  const Unlikeness bench = drawn_bench(guess, options.seed, gravity);
  std::unique_ptr<Device> device;
  if (simulated) {
    device = std::make_unique<UnlikeDevice>(truth, bench);
  } else {
    device = open_device(options.device, hub,
                         fmt::format(", and \"{}\" tries it without one", kSimulated));
    options.plan = within(options.plan, hub.notes(hub.in_use()).limits);
    if (options.input.device.empty()) guess = hub.arm_for(device->traits(), guess);
  }
  const double seconds = Excitation(guess, device->traits(), options.plan).duration();
  if (!simulated) ask_to_begin(options, *device, seconds);
  IdentifyRun run = watched([&](IdentifyTalk& talk) {
    return simulated ? simulate_identification(*device, guess, options.plan, talk)
                     : run_identification(*device, guess, options.plan, talk, {});
  });
  const fs::path out = options.out;
  write(out / "motion.csv", csv_of(run.record));
  if (run.end != ExcitationEnd::complete) {
    fmt::print(stderr, "limpid: ended: {}{}{}; {} holds the motion until then\n", explain(run.end),
               run.end == ExcitationEnd::held
                   ? fmt::format(" ({})", guess.joints[static_cast<std::size_t>(run.joint)].name)
                   : "",
               run.objection != ForceState::on ? fmt::format(" ({})", explain(run.objection)) : "",
               (out / "motion.csv").string());
    return 1;
  }
  const Identified found = identify(guess, run.record, {.gravity = gravity});
  const std::string name = device->traits().name;
  ordered_json json = as_json(found, run, name);
  const std::string urdf =
      urdf_text(found.arm, fmt::format("identified by limpid on {}, from {}", name, guess.name));
  write(out / "identified.urdf", urdf);
  print(found, guess, run);
  if (simulated) json["rehearsal"] = rehearse_and_print(truth, bench, guess, found.arm);
  write(out / "identified.json", json.dump(2) + "\n");
  fmt::print("arm: {}\n", (out / "identified.urdf").string());
  if (simulated) return 0;
  if (const std::string wrong = hub.remember_arm(urdf, found.delay.value); !wrong.empty()) {
    throw std::runtime_error(wrong);
  }
  save(hub, in_use);
  fmt::print("remembered: {} is this arm from now on; --forget ends that\n", name);
  return 0;
}

}  // namespace

Command declare_identify(CLI::App& app) {
  auto* command = app.add_subcommand(
      "identify", "moves a device by itself and finds its inertia, friction, weight and delay");
  auto options = std::make_shared<IdentifyOptions>();
  command->add_option("DEVICE", options->device,
                      fmt::format("its id, as `limpid devices` lists it, or \"{}\": one that is "
                                  "unlike its file, drawn by --seed; default: the one in use",
                                  kSimulated));
  options->input.add_world(*command);
  command->add_option("--out", options->out, "folder for identified.urdf, .json and motion.csv")
      ->type_name("DIR");
  command->add_option("--gravity", options->gravity,
                      "none, or X,Y,Z [m/s^2] in the frame of the arm's base");
  command->add_option("--range", options->plan.range, "part of each joint's range that is used")
      ->check(CLI::Range(0.05, 0.9));
  command->add_option("--torque", options->plan.torque, "part of the motors' limits that is used")
      ->check(CLI::Range(0.05, 1.0));
  require_whole_number(command->add_option("--seed", options->seed, "of the simulated device"));
  command->add_flag("--yes", options->yes, "begin without asking");
  command->add_flag("--forget", options->forget, "take the device for its file's arm again");
  command->footer(
      "The device is held by nobody meanwhile. It ends at once on Ctrl-C, when something holds it, "
      "when it\nfalls silent, and at every limit of safety. The URDF holds what was found: "
      "limpid --device OUT/identified.urdf");
  return [options] { return identify_device(*options); };
}

}  // namespace limpid
