#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <limits>
#include <optional>

#include "app/base/version.h"
#include "app/library/caller_device.h"
#include "app/library/limpid/limpid.h"
#include "app/library/plan.h"
#include "app/run/analysis.h"
#include "app/run/motor_limits.h"
#include "app/run/reach_check.h"
#include "app/run/recorder.h"
#include "app/run/replay.h"
#include "app/run/run_watch.h"
#include "core/dynamics/torque_limits.h"
#include "core/tick/as_taken.h"
#include "core/tick/force_asked.h"
#include "devices/files/atomic_file.h"
#include "devices/files/session/derived_columns.h"
#include "devices/files/session/session.h"
#include "devices/files/session/session_units.h"
#include "devices/simulated/rig.h"

namespace limpid {
namespace {

using Clock = std::chrono::steady_clock;

Point3 point3(const Vec3& at) { return {at.x(), at.y(), at.z()}; }

double seconds_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

constexpr double kLongestPeriod = 0.004;  // of a loop with real motors [s]

// Whatever is not told to be a simulation moves real motors.
LoopArm arm_of(const LoopOptions& options) {
  return options.motors == Motors::simulated ? LoopArm::callers : LoopArm::real;
}

bool finite_number(double x) { return std::isfinite(x); }

// Returns the units of a column's parts as a text, once if all are the same.
std::string said(const std::vector<std::string>& units) {
  const bool alike = std::ranges::all_of(units, [&](const auto& unit) { return unit == units[0]; });
  return alike ? units[0] : fmt::format("{}", fmt::join(units, ", "));
}

// Returns the shape that a column's numbers have in a row.
std::vector<std::size_t> shape_of(ColumnWidth width, const RowLayout& layout) {
  const auto joints = static_cast<std::size_t>(layout.dof());
  const auto bodies = static_cast<std::size_t>(layout.bodies());
  switch (width) {
    case ColumnWidth::one:
    case ColumnWidth::if_bodies: return {};
    case ColumnWidth::three:
    case ColumnWidth::three_if_bodies: return {3};
    case ColumnWidth::four: return {4};
    case ColumnWidth::dof: return {joints};
    case ColumnWidth::contacts: return {kRowContacts, 3};
    case ColumnWidth::poses: return {bodies, kPoseNumbers};
    case ColumnWidth::velocities: return {bodies, kVelocityNumbers};
  }
  return {};
}

// Calls `work`; whatever it throws becomes the library's own error.
template <class Work>
auto as_library(const Work& work) {
  try {
    return work();
  } catch (const LoopError&) {
    throw;
  } catch (const std::exception& e) {
    throw LoopError(e.what());
  }
}

// Calls `work`, which writes a file; its errors name the library's word in place of the option of
// the command line.
template <class Work>
void as_recording(const Work& work) {
  constexpr std::string_view kOption = "--force";
  try {
    as_library(work);
  } catch (const LoopError& e) {
    std::string text = e.what();
    for (std::size_t at = 0; (at = text.find(kOption, at)) != std::string::npos;) {
      text.replace(at, kOption.size(), "`replace`");
    }
    throw LoopError(text);
  }
}

// Says a joint that is outside of its range, and refuses one that is far outside: such a position
// is of another device, or has another unit.
void compare_range(const ArmDescription& arm, std::size_t joint, double x,
                   std::vector<std::string>& notes) {
  const Joint& of = arm.joints[joint];
  if (x >= of.lower && x <= of.upper) return;
  const double unit = arm.slides(joint) ? kSlideUnit : 1;
  const std::string range = fmt::format("{:.4g} to {:.4g} {}", of.lower * unit, of.upper * unit,
                                        arm.slides(joint) ? "m" : "rad");
  constexpr double kBeyond = 0.1;  // part of the range
  const double room = kBeyond * (of.upper - of.lower);
  if (x < of.lower - room || x > of.upper + room) {
    throw LoopError(
        fmt::format("position: joint {} has {:.4g}; needed: in the arm's range of {}, or outside "
                    "it by at most a tenth of the range",
                    joint + 1, x * unit, range));
  }
  notes.push_back(fmt::format("joint {} begins at {:.4g}, outside of its range of {}", joint + 1,
                              x * unit, range));
}

RigStart start_at(const ArmDescription& arm, std::span<const double> position,
                  std::vector<std::string>& notes) {
  if (position.size() != arm.joints.size()) {
    throw LoopError(fmt::format("position: has {} numbers; needed: {}, one per joint",
                                position.size(), arm.joints.size()));
  }
  Eigen::VectorXd x(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) {
    const auto joint = static_cast<std::size_t>(i);
    if (!std::isfinite(position[joint])) {
      throw LoopError(fmt::format("position: joint {} has {}; needed: a finite number", i + 1,
                                  position[joint]));
    }
    x[i] = position[joint] / (arm.slides(joint) ? kSlideUnit : 1);
    compare_range(arm, joint, x[i], notes);
  }
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(arm.dof());
  RigStart start{x, zero, x, zero, zero};
  start.owed = true;
  return start;
}

}  // namespace

LoopError::~LoopError() = default;

struct Loop::State {
  static constexpr std::uint64_t kMeasured = 500;  // ticks
  // Ticks may come faster than the period says by this part of it. Those of real motors that come
  // faster add up, and trip them from kMostLead on: their speeds are judged too small.
  static constexpr double kFaster = 0.1;
  static constexpr double kMostLead = 0.05;  // [s]

  State(LibraryPlan read, const LoopOptions& options, LoopArm of);

  void begin(const RigStart& start);
  void step(const RigInput& input) noexcept;
  void follow_recorder(const Vec3& target) noexcept;
  // Returns the settings as the loop takes them.
  Parameters taken() const noexcept {
    return real ? as_taken(plan.parameters, RealDevice::of(plan.arm, 0)) : plan.parameters;
  }
  Vec3 tip() const noexcept { return ticks == 0 ? first_tip : rig->tip(); }
  void measure(double elapsed) noexcept {
    measured = std::min(measured + 1, kMeasured);
    const double share = 1 / static_cast<double>(measured);
    mean_period += share * (elapsed - mean_period);
    lead = std::clamp(lead + (1 - kFaster) * plan.parameters.tick - elapsed, 0.0, 2 * kMostLead);
    early_ticks = lead > 0 ? early_ticks + 1 : 0;
    early_time = lead > 0 ? early_time + elapsed : 0;
  }
  std::string pace_text(double pace) const {
    return fmt::format("ticks come every {:.2g} ms, not every {:.2g} ms as `period` says",
                       1e3 * pace, 1e3 * plan.parameters.tick);
  }
  bool at_motor_limit() const;  // after a tick, as at_tip_limit()
  bool at_tip_limit() const;
  void in_si(std::span<const double> of_rig, std::span<double> into) const noexcept;
  void tell_recorder() const noexcept {
    if (recording) recorder->changed(taken());
  }

  RunPlan plan;  // its parameters are the loop's present ones
  Arm<kAnyDof> kinematics;
  std::vector<std::string> notes;
  std::optional<CallerDevice> device;  // of a DeviceLoop
  std::optional<Rig> rig;
  LoopArm arm;
  bool real;                  // motors of a device with a person's hand on it
  double most_tip_force = 0;  // of real motors [N]
  RowLayout layout;
  SessionUnits units;
  DerivedColumns derived;
  std::vector<RowColumn> columns, derived_columns;
  std::vector<double> row;     // as the rig has it
  std::vector<double> row_si;  // as everybody has it
  RigStart scratch;            // with room for all that the rig has
  std::uint64_t ticks = 0;
  bool lost = false;  // was unstable since the begin
  Clock::time_point before{};
  Vec3 first_tip = Vec3::Zero();  // of the device before the first tick [m]
  double mean_period = 0;  // time between ticks as measured, over about kMeasured of them [s]
  std::uint64_t measured = 0;
  double lead = 0;                // time by which the ticks are ahead of the clock [s]
  std::uint64_t early_ticks = 0;  // those since they were not ahead of it
  double early_time = 0;          // time that these took [s]
  double early_pace = 0;          // their mean when they tripped the force [s]; 0: they did not
  // Positions and one more of the reading that was not one a joint; 0 once force may be back.
  std::size_t wrong_count = 0;
  const char* refused = nullptr;  // what is wrong with a reading of simulated motors
  ForceAsked force;
  std::unique_ptr<Recorder> recorder;
  bool recording = false;  // the recorder gets rows
};

Loop::State::State(LibraryPlan read, const LoopOptions& options, LoopArm of)
    : plan(std::move(read.plan)),
      kinematics(plan.arm),
      notes(std::move(read.notes)),
      arm(of),
      real(of == LoopArm::real),
      most_tip_force(options.limits.tip_force),
      layout(plan.layout()),
      units(layout, slides_of(plan.arm)),
      derived(plan.arm),
      row(static_cast<std::size_t>(layout.stride()), kGuessed),
      row_si(row) {
  plan.hand.source = "library";
  for (const ColumnInfo& each : kColumnInfo) {
    if (!layout.has(each.column)) continue;
    columns.push_back({each.path, said(units.units(each)), each.what,
                       static_cast<std::size_t>(layout.offset(each.column)),
                       static_cast<std::size_t>(layout.width(each.column)),
                       shape_of(each.width, layout)});
  }
  for (const DerivedInfo& each : kDerivedInfo) {
    derived_columns.push_back(
        {each.path, each.unit, each.what, 3 * derived_columns.size(), 3, {3}});
  }
}

void Loop::State::begin(const RigStart& start) {
  rig->start(plan.parameters, start);
  rig->present(scratch);
  first_tip = kinematics.tip_at(start.x1);
  std::ranges::fill(row, kGuessed);
  std::ranges::fill(row_si, kGuessed);
  ticks = 0;
  lost = false;
}

// Takes up a recording. It restarts the rig where it stands, so that its first row determines all
// later ones.
void Loop::State::follow_recorder(const Vec3& target) noexcept {
  if (!recorder || recording || !rig->steady()) return;
  recording = true;
  if (ticks == 0) return;
  rig->restart_here(plan.parameters, scratch, target);
  recorder->changed(taken());
  recorder->begins(scratch.world);
}

void Loop::State::step(const RigInput& input) noexcept {
  const auto began = Clock::now();
  follow_recorder(input.hand.target);
  rig->step(plan.parameters, input, row);
  layout.in(std::span(row), Column::wake_latency)[0] = 0;
  layout.in(std::span(row), Column::compute)[0] = seconds_between(began, Clock::now());
  ++ticks;
  lost = lost || rig->diverged();
  if (recording && real) recorder->push(row);
  if (recording && !real) recorder->push_waiting(row);
  in_si(row, row_si);
}

// Part of a limit that counts as the limit: a hand that trembles takes torques off it and onto it.
constexpr double kNearly = 0.999;

bool Loop::State::at_motor_limit() const {
  std::vector<MotorLimit> limits = motor_limits(plan.arm, taken());
  for (MotorLimit& each : limits) {
    each.peak *= kNearly;
    each.continuous *= kNearly;
  }
  return any_at_limit(layout, row, limits);
}

bool Loop::State::at_tip_limit() const {
  if (!real) return false;
  const auto of = [this](Column column) {
    return Eigen::Map<const Vec<kAnyDof>>(layout.in(std::span<const double>(row), column).data(),
                                          plan.arm.dof());
  };
  Arm<kAnyDof>::Frames frames;
  kinematics.frames(of(Column::device_position), frames);
  Jacobian<kAnyDof> J(3, plan.arm.dof());
  kinematics.point_jacobian(frames, plan.arm.dof() - 1, kinematics.tip(frames), J);
  return tip_force<kAnyDof>(of(Column::motor_torque), J) > kNearly * most_tip_force;
}

void Loop::State::in_si(std::span<const double> of_rig, std::span<double> into) const noexcept {
  std::copy_n(of_rig.data(), of_rig.size(), into.data());
  for (const SessionUnits::Scaled& each : units.scaled()) {
    double& x = layout.in(into, each.column)[static_cast<std::size_t>(each.part)];
    x = SessionUnits::filed(each, x).value;
  }
  file_points(layout.in(into, Column::contact_point), layout.in(of_rig, Column::contact_force));
}

Loop::Loop(std::unique_ptr<State> state) : state_(std::move(state)) {}
Loop::~Loop() = default;
Loop::Loop(Loop&&) noexcept = default;
Loop& Loop::operator=(Loop&&) noexcept = default;

std::size_t Loop::joints() const { return state_->plan.arm.joints.size(); }
double Loop::period() const { return state_->plan.parameters.tick; }
const std::vector<std::string>& Loop::notes() const { return state_->notes; }

void Loop::set(const std::string& key_value) { set(std::span(&key_value, 1)); }

void Loop::set(std::span<const std::string> key_values) {
  as_library([&] {
    Parameters changed = state_->plan.parameters;
    for (const std::string& each : key_values) set_live(changed, each, state_->arm);
    state_->plan.parameters = changed;
  });
  state_->tell_recorder();
}

void Loop::set(std::string_view key, double value) {
  as_library([&] { set_live(state_->plan.parameters, key, value, state_->arm); });
  state_->tell_recorder();
}

double Loop::get(std::string_view key) const {
  return as_library([&] { return parameter_number(state_->plan.parameters, setting_named(key)); });
}

const std::vector<RowColumn>& Loop::columns() const { return state_->columns; }
std::span<const double> Loop::row() const noexcept { return state_->row_si; }

std::span<const double> Loop::row(std::string_view path) const {
  for (const RowColumn& each : state_->columns) {
    if (each.path == path) return row().subspan(each.offset, each.width);
  }
  std::vector<std::string> paths;
  for (const RowColumn& each : state_->columns) paths.push_back(each.path);
  throw LoopError(fmt::format("{}: no such column; {}", path, meant_or(path, paths, "columns()")));
}

const std::vector<RowColumn>& Loop::derived_columns() const { return state_->derived_columns; }

std::array<double, 15> Loop::derived(std::span<const double> row) const noexcept {
  const RowLayout& layout = state_->layout;
  if (row.size() != static_cast<std::size_t>(layout.stride())) {
    std::array<double, 15> unknown;
    unknown.fill(kGuessed);
    return unknown;
  }
  // Slides count as in the rig.
  std::array<double, std::size_t{4} * kMaxDof> joints;
  std::array<std::span<const double>, 4> of_rig;
  constexpr std::array from{Column::device_position, Column::device_velocity,
                            Column::proxy_position, Column::proxy_velocity};
  const ArmDescription& arm = state_->plan.arm;
  const std::size_t n = arm.joints.size();
  for (std::size_t column = 0; column < from.size(); ++column) {
    const auto x = layout.in(row, from[column]);
    const auto into = std::span(joints).subspan(column * n, n);
    for (std::size_t i = 0; i < n; ++i) into[i] = x[i] / (arm.slides(i) ? kSlideUnit : 1);
    of_rig[column] = into;
  }
  std::array<double, 15> all;
  auto to = all.begin();
  for (const Vec3& each : state_->derived.of(
           {of_rig[0], of_rig[1], of_rig[2], of_rig[3], layout.in(row, Column::contact_force)})) {
    to = std::ranges::copy(each, to).out;
  }
  return all;
}

double Loop::time() const noexcept {
  if (state_->ticks == 0) return 0;
  return state_->layout.in(std::span<const double>(state_->row), Column::time)[0];
}

Point3 Loop::tip() const noexcept { return point3(state_->tip()); }

Point3 Loop::proxy_tip() const noexcept {
  const State& s = *state_;
  if (s.ticks == 0) return tip();
  const auto x = s.layout.in(std::span<const double>(s.row), Column::proxy_position);
  return point3(s.kinematics.tip_at(Eigen::Map<const Vec<kAnyDof>>(x.data(), s.plan.arm.dof())));
}

LoopEnergy Loop::energy() const noexcept {
  if (state_->ticks == 0) return {};
  const auto value = [&](Column c) {
    return state_->layout.in(std::span<const double>(state_->row), c)[0];
  };
  return {value(Column::energy_total), value(Column::energy_commanded), value(Column::energy_port),
          value(Column::energy_ledger)};
}

bool Loop::diverged() const noexcept { return state_->lost; }

Point3 Loop::contact_force() const noexcept {
  if (state_->ticks == 0) return {};
  const auto all = derived(row());
  return {all[3 * kTotalForce], all[3 * kTotalForce + 1], all[3 * kTotalForce + 2]};
}

std::string Loop::not_passive_text() const {
  const RunPlan& plan = state_->plan;
  const Parameters p = state_->taken();
  const Passivity judged = passivity(analyze(plan.arm, rest_pose(plan.arm), p, {}), p);
  return judged.passive == false ? judged.by : std::string();
}

void Loop::record(const std::string& file, bool replace) {
  State& s = *state_;
  if (s.recorder) throw LoopError(file + ": " + s.recorder->out().string() + " is being recorded");
  as_library([&] { check_ending(file, kSessionEnding); });
  std::error_code unknown;
  if (!replace && std::filesystem::exists(file, unknown)) {
    throw LoopError(file + ": exists already, and `replace` is not set");
  }
  as_recording([&] {
    RunPlan recorded = s.plan;
    recorded.parameters = s.taken();
    s.recorder =
        std::make_unique<Recorder>(file, session_info(recorded), recorded.parameters, replace,
                                   s.real ? Recorder::kLiveRoom : Recorder::kWaitingRoom);
  });
}

std::uint64_t Loop::finish_recording() {
  State& s = *state_;
  if (!s.recorder) throw LoopError("finish_recording: nothing is being recorded");
  const std::unique_ptr<Recorder> recorder = std::move(s.recorder);
  s.recording = false;
  as_recording([&] { recorder->finish(); });
  return recorder->dropped();
}

DeviceLoop::DeviceLoop(const LoopOptions& options, std::span<const double> position)
    : Loop(as_library([&] {
        // A device is no arm that happens to be the default.
        const LoopArm arm = arm_of(options);
        const bool real = arm == LoopArm::real;
        if (real && options.arm.empty() && options.arm_text.empty()) {
          throw LoopError(
              "arm: is missing; a device with real motors needs an arm file made for it");
        }
        if (real && options.period > kLongestPeriod) {
          throw LoopError(
              fmt::format("period: {} s is not allowed with real motors; allowed: at most {} s, "
                          "because force ends if no reading is fresh for 5 ms",
                          options.period, kLongestPeriod));
        }
        auto state = std::make_unique<State>(read_plan(options, arm), options, arm);
        state->device.emplace(state->plan.arm, real);
        state->rig.emplace(state->plan.arm, state->plan.document.scene, &*state->device);
        state->rig->limit(limits_of(options.limits));
        state->begin(start_at(state->plan.arm, position, state->notes));
        return state;
      })) {}

std::span<const double> DeviceLoop::tick(const Reading& reading) noexcept {
  State& s = *state_;
  const auto now = Clock::now();
  const double T = s.plan.parameters.tick;
  const bool timed = std::isfinite(reading.elapsed) && reading.elapsed >= 0;
  double elapsed = timed ? reading.elapsed : 0;
  if (elapsed == 0 && s.real && s.ticks > 0) elapsed = seconds_between(s.before, now);
  if (elapsed > 0 && s.ticks > 0) s.measure(elapsed);
  s.before = now;
  const bool fresh = reading.fresh || !s.real;
  const bool whole = s.device->whole(reading.position, fresh);
  if (!whole) s.wrong_count = reading.position.size() + 1;
  const bool finite = std::ranges::all_of(reading.position, finite_number);
  if (!s.real) {
    s.refused = !finite ? "a reading is not finite" : timed ? nullptr : "a reading's time is wrong";
  }
  const bool wrong = !whole || s.refused != nullptr;
  if (wrong) s.device->stop();
  if (wrong && !s.real) return s.device->torque();  // a simulated device cannot trip
  const double passed = elapsed > 0 ? elapsed : T;
  const bool early = s.real && s.lead > State::kMostLead;
  s.device->take(reading.position, fresh, reading.hand, reading.fault || !timed || early, passed);
  RigInput input{{s.tip(), 1}, s.force.take()};
  constexpr double kMostPeriods = 1e6;
  input.periods = static_cast<int>(std::clamp(std::round(passed / T), 1.0, kMostPeriods));
  input.dt = elapsed;
  s.step(input);
  if (whole && s.rig->force_state() != ForceState::lost) s.wrong_count = 0;
  if (early && s.early_pace == 0) {
    s.early_pace = s.early_time / static_cast<double>(s.early_ticks);
  }
  if (reading.fault || !timed || s.rig->force_state() != ForceState::fault) s.early_pace = 0;
  return s.device->torque();
}

void DeviceLoop::arm() noexcept { state_->force.arm(); }
void DeviceLoop::cut() noexcept { state_->force.cut(); }
bool DeviceLoop::armed() const noexcept { return state_->rig->force().armed(); }
double DeviceLoop::force_share() const noexcept {
  return state_->refused != nullptr ? 0 : state_->rig->force().gain();
}
std::string DeviceLoop::force_text() const {
  const State& s = *state_;
  if (s.wrong_count > 0) {
    return fmt::format("force off: a reading has {} positions; needed: {}, one per joint",
                       s.wrong_count - 1, joints());
  }
  if (s.refused != nullptr) return fmt::format("force off: {}", s.refused);
  if (s.early_pace > 0) return "force off: " + s.pace_text(s.early_pace);
  const ForceState why = s.rig->force_state();
  std::string text = limpid::force_text(why);
  if (why == ForceState::frozen && force_share() > 0) {
    text = fmt::format("force held back: {}", explain(why));
  }
  if (!text.empty() || s.ticks == 0) return text;
  if (force_share() < 1) return "force fades in";
  const std::span<const double> row = s.row;
  const auto part = [&](Column column) { return s.layout.in(row, column)[0]; };
  std::vector<std::string> all;
  constexpr double kWhole = 0.995;
  for (const auto& [held, column] :
       {std::pair("walls", Column::governor), {"all force", Column::torque_governor}}) {
    if (part(column) >= kWhole) continue;
    all.push_back(fmt::format("{} held back to {:.0f} % by the law's energy account", held,
                              100 * part(column)));
  }
  if (s.at_motor_limit()) {
    all.emplace_back("motors at their limit");
  } else if (s.at_tip_limit()) {
    all.emplace_back("motors at the tip's limit");
  }
  const double T = period();
  constexpr double kOff = 0.2;  // of the period
  if (s.measured == State::kMeasured && std::abs(s.mean_period - T) > kOff * T) {
    all.push_back(s.pace_text(s.mean_period));
  }
  return fmt::format("{}", fmt::join(all, "; "));
}

SimulatedLoop::SimulatedLoop(const LoopOptions& options)
    : Loop(as_library([&] {
        auto state =
            std::make_unique<State>(read_plan(options, LoopArm::own), options, LoopArm::own);
        state->rig.emplace(state->plan.arm, state->plan.document.scene);
        state->begin(rest_at(state->plan.arm, rest_tip(state->plan.arm)));
        return state;
      })) {}

void SimulatedLoop::start(Point3 target) {
  State& s = *state_;
  if (s.recorder) throw LoopError("start: a recording is running; finish the recording first");
  const auto outside = [&](const std::string& why) {
    return LoopError(fmt::format("start: target: ({:.4g}, {:.4g}, {:.4g}) m: {}", target[0],
                                 target[1], target[2], why));
  };
  if (!std::ranges::all_of(target, finite_number)) throw outside("needed: finite numbers");
  try {
    s.begin(rest_at(s.plan.arm, Vec3(target[0], target[1], target[2])));
  } catch (const std::exception& e) {
    throw outside(e.what());
  }
}

std::span<const double> SimulatedLoop::step(const Hand& hand) noexcept {
  State& s = *state_;
  HandInput input{Vec3(hand.target[0], hand.target[1], hand.target[2]),
                  std::clamp(hand.grip, 0.0, 1.0)};
  input.magnet = hand.magnet;
  if (hand.torque.size() == joints()) input.torque = hand.torque;
  const bool finite = std::ranges::all_of(hand.target, finite_number) && std::isfinite(hand.grip) &&
                      std::ranges::all_of(input.torque, finite_number);
  if (!finite) input = {s.tip(), 0};
  s.step({input});
  return row();
}

SimulatedLoop::RunEnd SimulatedLoop::run(std::span<const double> path, double duration,
                                         const TakeRow& take) const {
  std::exception_ptr thrown;  // by the caller's own function
  RunEnd all = as_library([&]() -> RunEnd {
    if (!take) throw LoopError("take: is empty; needed: a function that takes each row");
    if (!(duration >= 0) || !std::isfinite(duration)) {
      throw LoopError(fmt::format("duration: {} is not allowed; allowed: 0 s or more", duration));
    }
    RunPlan plan = state_->plan;
    plan.hand = hand_of_rows(path);
    if (const std::string why = out_of_reach(plan); !why.empty()) throw LoopError(why);
    plan.rows = ticks_in(duration > 0 ? duration : plan.hand.duration(), plan.parameters.tick);
    std::vector<double> si(state_->row_si.size());
    RunWatch watch(plan.arm, state_->layout, plan.parameters);
    const auto end = simulate(plan, {}, [&](std::span<const double> row, LaneChanges) {
      watch.add(row);
      state_->in_si(row, si);
      try {
        return take(si);
      } catch (...) {
        thrown = std::current_exception();
        return false;
      }
    });
    return {end.rows, end.diverged,
            end.diverged ? fmt::format("unstable since t = {:.3f} s: {}", end.diverged_at, end.why)
                         : std::string(),
            watch.cautions()};
  });
  if (thrown) std::rethrow_exception(thrown);
  return all;
}

std::string library_version() { return program_version(); }

std::vector<SettingInfo> setting_list() {
  std::vector<SettingInfo> all;
  for (const ParameterInfo& info : parameter_table()) {
    std::vector<std::string> words(info.words.begin(), info.words.end());
    if (info.kind == FieldInfo::Kind::flag) words = {"false", "true"};
    all.push_back({info.key, info.unit, info.minimum, info.maximum, std::move(words), info.live,
                   info.meaning});
  }
  return all;
}

}  // namespace limpid
