// `limpid serve`: the live loop without a window, led by programs.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <thread>

#include "app/base/folders.h"
#include "app/base/input_end.h"
#include "app/base/interrupt.h"
#include "app/cli/commands.h"
#include "app/cli/live_bench.h"
#include "app/cli/options.h"
#include "app/cli/still_picture.h"
#include "app/live/rtkit.h"
#include "app/remote/served_session.h"
#include "app/run/own_world.h"
#include "devices/files/scene/scene_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

// Time between two turns. Short enough for clients that wait for an answer; long enough that
// requests take no time from the loop. Requests shorten it to kShortestTurn at least.
constexpr auto kTurn = 5ms, kShortestTurn = 2ms;

struct ServeOptions {
  std::string name = "control";
  InputOptions input;
  std::optional<std::string> device;
  bool until_eof = false;
};

// Path of a file that a client names: its own, or one that came with the program.
std::string file_of(const std::string& named, const char* key, const char* kind) {
  if (named.empty() || fs::path(named).is_absolute()) return named;
  if (const auto own = shipped_file(named, {kind})) return *own;
  const std::string hint = shipped_hint(named, {kind});
  throw UsageError(fmt::format(
      "open: {}: there is no file \"{}\"{} allowed: a path that begins with /, or one of {}", key,
      named.substr(0, 100), hint.empty() ? ";" : hint, fmt::join(shipped_names(kind), ", ")));
}

// Worlds that clients open, each a change to the one before.
class Worlds {
 public:
  explicit Worlds(InputOptions input) : input_(std::move(input)) {}

  ServedSession::World first() const { return world_of(input_); }

  // Puts a device in the arm's place; from now on scenes are read for `arm`.
  void read_for(const ArmDescription& arm) { of_device_ = arm; }

  ServedSession::World operator()(const OpenRequest& asked, const Parameters& now) {
    InputOptions next = input_;
    if (!asked.session.empty()) {
      next.hand = file_of(asked.session, "session", "sessions");
      next.scene.clear();
      next.device.clear();
      next.tip.clear();
    }
    if (!asked.arm.empty()) {
      next.device = file_of(asked.arm, "arm", "devices");
      next.tip = asked.tip;
      if (asked.session.empty()) next.hand.clear();
    }
    if (!asked.scene.empty()) next.scene = file_of(asked.scene, "scene", "scenes");
    if (!asked.hand.empty()) next.hand = file_of(asked.hand, "hand", "hands");
    if (of_device_) {
      ServedSession::World world;
      world.plan.arm = *of_device_;
      world.plan.document = read_scene(next.scene, world.plan.arm);
      world.plan.models = build_meshes(world.plan.document);
      return world;
    }
    ServedSession::World world = world_of(next);
    const bool same_arm = asked.arm.empty() && asked.session.empty();
    if (same_arm) world.plan.parameters = now;
    input_ = next;
    return world;
  }

 private:
  static ServedSession::World world_of(const InputOptions& input) {
    return {make_plan(input), !input.hand.empty()};
  }

  InputOptions input_;
  std::optional<ArmDescription> of_device_;
};

// A device in the arm's place, with its arm, its world and its limits.
struct RealDevice {
  RealDevice(const std::string& id, const InputOptions& input, ServedSession::World& world) {
    if (!input.hand.empty())
      throw UsageError("--hand: not together with --live: your own hand moves the device");
    DeviceHub hub(device_store_file(), by_rtkit());
    device = open_device(id, hub, "");
    const DeviceTraits& traits = device->traits();
    if (!traits.pushes) throw UsageError(traits.name + ": has no motors");
    RunPlan& plan = world.plan;
    plan.arm = arm_of_device(traits, hub, input);
    const fs::path scene = input.scene.empty() ? scene_of_device(plan.arm) : fs::path(input.scene);
    plan.document = read_scene(scene, plan.arm);
    plan.models = build_meshes(plan.document);
    const DeviceNotes& notes = hub.notes(hub.in_use());
    Parameters usual = make_parameters(input, plan.arm);
    notes.compensation.give(usual);
    plan.parameters = make_parameters(input, usual);
    limits = notes.limits;
  }

  std::unique_ptr<Device> device;
  SafetyLimits limits;
};

int serve(const ServeOptions& options) {
  catch_interrupts();
  auto worlds = std::make_shared<Worlds>(options.input);
  ServedSession::World world;
  std::optional<RealDevice> real;
  if (options.device) {
    real.emplace(*options.device, options.input, world);
    worlds->read_for(world.plan.arm);
  } else {
    world = worlds->first();
    const double chosen = make_parameters(options.input).tick;
    if (const std::string wrong = refused_tick(world.plan, chosen); !wrong.empty()) {
      throw UsageError(fmt::format("--hand {}: {}; --set loop.tick={} replaces the tick",
                                   options.input.hand, wrong, Parameters{}.tick));
    }
  }
  const fs::path socket = control_path(options.name);
  ServedSession session(std::move(world), real ? std::move(real->device) : nullptr,
                        real ? real->limits : SafetyLimits{},
                        {.open = [worlds](const OpenRequest& asked,
                                          const Parameters& now) { return (*worlds)(asked, now); },
                         .draw = [](const fs::path& png, const RunPlan& plan,
                                    std::span<const double> row) { save_picture(png, plan, row); },
                         .folder = user_data_dir() / "sessions",
                         .ask = by_rtkit()});
  if (!session.realtime()) yield_to_haptics();
  Remote remote(socket, session.host(), [&session] { session.cut(); });
  fmt::print("limpid listens on {}\n", socket.string());
  std::fflush(stdout);
  while (!interrupted && !(options.until_eof && input_has_ended())) {
    const auto began = std::chrono::steady_clock::now();
    session.turn(remote);
    remote.turn();
    std::this_thread::sleep_until(began + kShortestTurn);
    remote.wait_until(began + kTurn);
  }
  return 0;
}

}  // namespace

Command declare_serve(CLI::App& app) {
  auto* command = app.add_subcommand(
      "serve", "the live loop without a window; other programs control it over a socket");
  auto options = std::make_shared<ServeOptions>();
  command
      ->add_option("NAME", options->name,
                   "the name of the socket $XDG_RUNTIME_DIR/limpid/NAME.control; default: control")
      ->type_name("");
  options->input.add_world(*command);
  command
      ->add_option("--hand", options->input.hand,
                   "the path of the virtual arm's hand, or a recorded session; default: nobody "
                   "holds the arm")
      ->transform(or_shipped({"hands", "sessions"}), "", "")
      ->type_name("FILE.csv|FILE.h5");
  command
      ->add_option_function<std::string>(
          "--live", [options](const std::string& id) { options->device = id; },
          "use a real device with your hand: the device's id, as `limpid devices` lists it; "
          "default: the device in use. Only the device's second button arms the force")
      ->type_name("[ID]")
      ->expected(0, 1);
  command->add_flag("--until-eof", options->until_eof,
                    "end when standard input ends: standard input ends with the calling program");
  options->input.add_parameters(*command);
  command->footer(
      "Each line is one JSON object, and so is each answer: {\"id\": 1, \"do\": \"set\", "
      "\"values\": {\"coupling.eta\": 0.5}};\n{\"do\": \"hello\"} lists all commands. The Python "
      "package limpid uses this protocol. Only the user who\nstarts the program can connect. No "
      "program can arm a real device, or raise a limit, through the socket;\nthe command cut is "
      "always accepted.\n\n" +
      parameter_help());
  return [options] {
    try {
      return serve(*options);
    } catch (const ListenError& e) {
      throw UsageError(e.what());
    }
  };
}

}  // namespace limpid
