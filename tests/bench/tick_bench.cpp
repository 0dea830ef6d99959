// How long one tick of 1 ms takes: the controller alone, with the virtual arm, and a whole run that
// is recorded. Medians and p99 are the program's, p99.9 and longest the machine's.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string_view>

#include "app/base/assets.h"
#include "app/run/recorder.h"
#include "app/run/simulate.h"
#include "devices/files/arm/urdf_file.h"
#include "devices/files/config/config_file.h"
#include "devices/files/scene/scene_file.h"
#include "devices/virtual_arm.h"
#include "tests/bench/bench_arm.h"
#include "tests/bench/mujoco_step.h"
#include "tests/bench/sample_times.h"

namespace limpid::bench {
namespace {

constexpr int kTicks = 20000;

constexpr const char* kHelp =
    "usage: tick_bench [--callgrind [TICKS [JOINTS [COUPLING]]]]\n"
    "\n"
    "Prints a table of times. With --callgrind it only runs TICKS (1000) ticks of the controller\n"
    "and the virtual arm in contact, of JOINTS (3) joints under COUPLING (proposed), for counting\n"
    "instructions:\n"
    "\n"
    "  valgrind --tool=callgrind --toggle-collect='limpid::Tick<*>::run(*' tick_bench --callgrind\n"
    "  valgrind --tool=callgrind --toggle-collect='limpid::VirtualArm<*>::live(*' \\\n"
    "      tick_bench --callgrind\n"
    "\n"
    "and divide what it collected by TICKS.\n";

// A controller and an arm whose hand circles slowly with the tip pressed against a plane.
template <int N>
class Pressed {
 public:
  Pressed(const ArmDescription& arm, const Eigen::VectorXd& x, const Parameters& p = {})
      : p_(p),
        tip_(tip_of(arm, x)),
        tick_(arm, plane_over(tip_)),
        arm_(arm),
        row_(static_cast<std::size_t>(tick_.layout().stride())) {
    tick_.start(p_, Start<N>::at_rest(x));
    arm_.place(x, Vec<N>::Zero(x.size()), tip_);
  }

  const Vec<N>& control() {
    const Reading<N> reading = arm_.read(p_.encoder_step);
    return tick_.run(p_, reading, ForceWish::as_it_is, row_);
  }
  void live(const Vec<N>& torque) {
    const double angle = 1e-3 * k_++;
    arm_.live(p_, torque, {tip_ + 0.01 * Vec3(std::cos(angle) - 1, std::sin(angle), -0.1), 1});
  }
  bool touches() const { return !tick_.proxy().f().isZero(0); }
  bool diverged() const { return tick_.diverged(); }

 private:
  Parameters p_;
  Vec3 tip_;
  Tick<N> tick_;
  VirtualArm<N> arm_;
  std::vector<double> row_;
  int k_ = 0;
};

struct TickTimes {
  SampleTimes control{kTicks}, live{kTicks};
};

template <int N>
TickTimes time_ticks(const ArmDescription& arm, const Eigen::VectorXd& x) {
  Pressed<N> pressed(arm, x);
  TickTimes times;
  int touching = 0;
  const Vec<N>* torque = nullptr;
  for (int k = 0; k < kTicks; ++k) {
    times.control.time([&] { torque = &pressed.control(); });
    times.live.time([&] { pressed.live(*torque); });
    touching += pressed.touches();
  }
  if (touching < kTicks * 9 / 10 || pressed.diverged()) {
    fmt::print("  (touched in {:.0f} % of the ticks{})\n", 100.0 * touching / kTicks,
               pressed.diverged() ? ", went unstable" : "");
  }
  return times;
}

void print_chain(int joints) {
  const ArmDescription arm = chain(joints);
  const Eigen::VectorXd x = bent(arm);
  const auto mujoco = mujoco_steps(arm, plane_over(tip_of(arm, x)), x, kTicks);
  const SampleTimes* yardstick = mujoco ? &*mujoco : nullptr;
  const TickTimes ours = joints == 3 ? time_ticks<3>(arm, x) : time_ticks<kAnyDof>(arm, x);
  const std::string n = fmt::format("n = {}: ", joints);
  if (mujoco) fmt::print("{}", table_line(n + "mj_step", *mujoco, nullptr));
  fmt::print("{}", table_line(n + "controller", ours.control, yardstick));
  fmt::print("{}", table_line(n + "virtual arm, 20 substeps", ours.live, yardstick));
}

RunPlan touching_the_table() {
  RunPlan plan;
  plan.arm = read_urdf(default_device());
  plan.document = read_scene(default_scene(), plan.arm);
  plan.hand = read_hand(default_hand());
  plan.rows = 60000;
  return plan;
}

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

// Of the calling thread alone [s].
double processor_time() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

template <class Work>
void report(const char* what, const RunPlan& plan, Work&& work) {
  const auto rows = static_cast<double>(plan.rows);
  const auto began = Clock::now();
  const double processor = processor_time();
  work();
  const double took = Seconds(Clock::now() - began).count();
  fmt::print("{:<34}{:>9.2f} us a tick ({:.2f} of its thread), {:.0f} times real time\n", what,
             1e6 * took / rows, 1e6 * (processor_time() - processor) / rows,
             rows * plan.parameters.tick / took);
}

// The whole of `limpid run --record`.
void print_recorded_run() {
  const RunPlan plan = touching_the_table();
  SessionInfo info;
  info.tick = plan.parameters.tick;
  info.dof = plan.arm.dof();
  info.config = config_text(plan.parameters);
  info.device_urdf = plan.arm.urdf;
  info.scene = plan.document.toml;
  const std::filesystem::path out = std::filesystem::temp_directory_path() / "limpid_tick_bench.h5";

  std::vector<double> rows(plan.rows * static_cast<std::size_t>(RowLayout(info.dof).stride()));
  report("headless run", plan, [&] {
    auto next = rows.begin();
    simulate(plan, {}, [&](std::span<const double> row, const Parameters*) {
      next = std::ranges::copy(row, next).out;
      return true;
    });
  });
  report("headless run, recorded", plan, [&] {
    Recorder recorder(out, info, plan.parameters, true, Recorder::kWaitingRoom);
    simulate(plan, {}, [&](std::span<const double> row, const Parameters*) {
      return recorder.push_waiting(row);
    });
    recorder.finish();
  });
  report("writing the file alone", plan, [&] {
    SessionWriter writer(out, info, true);
    writer.append(rows);
    writer.close();
  });
  std::filesystem::remove(out);
}

template <int N>
int count(int ticks, int joints, const Parameters& p) {
  const ArmDescription arm = chain(joints);
  Pressed<N> pressed(arm, bent(arm), p);
  for (int k = 0; k < ticks; ++k) pressed.live(pressed.control());
  fmt::print("{} ticks, {}touching at the end\n", ticks, pressed.touches() ? "" : "not ");
  return 0;
}

void print_table() {
  fmt::print("{}", table_head());
  for (const int joints : {3, 7, 15, 30}) print_chain(joints);
  const RunPlan plan = touching_the_table();
  const Eigen::VectorXd x = rest_pose(plan.arm);
  const TickTimes omni = time_ticks<3>(plan.arm, x);
  fmt::print("{}", table_line("built-in arm: controller", omni.control, nullptr));
  fmt::print("{}", table_line("       virtual arm, 20 substeps", omni.live, nullptr));
  print_recorded_run();
}

int main_of(int argc, char** argv) {
  if (argc == 1) {
    print_table();
    return 0;
  }
  const std::string_view option = argv[1];
  if (option == "--callgrind") {
    const int ticks = argc > 2 ? std::max(1, std::atoi(argv[2])) : 1000;
    const int joints = argc > 3 ? std::clamp(std::atoi(argv[3]), 1, kMaxDof) : 3;
    Parameters p;
    if (argc > 4) set_parameter(p, "coupling.kind", std::string(argv[4]));
    return joints == 3 ? count<3>(ticks, joints, p) : count<kAnyDof>(ticks, joints, p);
  }
  fmt::print("{}", kHelp);
  return option == "--help" ? 0 : 2;
}

}  // namespace
}  // namespace limpid::bench

int main(int argc, char** argv) { return limpid::bench::main_of(argc, argv); }
