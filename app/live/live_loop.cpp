#include "app/live/live_loop.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>
#include <utility>

#include "app/run/simulate.h"
#include "core/dynamics/inverse_kinematics.h"
#include "devices/reading_watch.h"

namespace limpid {
namespace {

// Returns the ticks that the ring keeps for the window: eight seconds, or 128 MiB.
std::size_t trace_rows(std::size_t stride) {
  constexpr std::size_t kRows = 1 << 13, kBytes = std::size_t{128} << 20;
  return std::min(kRows, std::bit_floor(kBytes / (stride * sizeof(double))));
}

constexpr double kGuideReach = 0.03;  // a guided hand stays this near to the tip [m]

}  // namespace

LiveLoop::LiveLoop(AskForPriority ask, Dispose dispose)
    : dispose_(std::move(dispose)), thread_(std::move(ask)) {}

void LiveLoop::open(const ArmDescription& arm, const Scene& scene, const Parameters& p,
                    const Vec3& home) {
  RigStart start = rest_at(arm, home);
  auto rig = std::make_unique<Rig>(arm, scene);
  std::array<std::unique_ptr<Rig>, kMostLanes - 1> beside;
  for (auto& each : beside) each = std::make_unique<Rig>(arm, scene);
  close();
  rig_ = std::move(rig);
  probe_ = GripProbe(arm);
  for (std::size_t i = 0; i < beside.size(); ++i) beside_[i].open(std::move(beside[i]));
  start.armed = virtual_armed_;
  begin(std::move(start), p);
}

void LiveLoop::open(const ArmDescription& arm, const Scene& scene, const Parameters& p,
                    std::unique_ptr<Device> device) {
  auto rig = std::make_unique<Rig>(arm, scene, nullptr);
  close();
  rig_ = std::move(rig);
  probe_ = GripProbe(arm);
  in_place_ = true;
  real_ = RealDevice::of(arm, 0);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(arm.dof());
  RigStart start{rest_pose(arm), zero, rest_pose(arm), zero, zero, Vec3::Zero(), false};
  if (DeviceReading first;
      device && device->read(first) && first.count > 0 && within_reach(first, device->traits())) {
    start.x1 = start.x2 = Eigen::Map<const Eigen::VectorXd>(first.x.data(), arm.dof());
  }
  start.warmth = warmth_->take(arm, in_seconds(MonotonicTime{}.now()));
  plug(std::move(device));
  begin(std::move(start), p);
}

void LiveLoop::begin(RigStart start, const Parameters& p) {
  const auto stride = static_cast<std::size_t>(rig_->layout().stride());
  const std::size_t all = kMostLanes * stride;
  trace_ = std::make_unique<TraceRing>(trace_rows(all), all);
  drained_from_ = published_ = 0;
  rows_.assign(all, std::numeric_limits<double>::quiet_NaN());
  std::ranges::fill(row(kMainLane), 0.0);
  home_ = rebase_ = std::move(start);
  parameters_ = p;
  limits_ = {};  // as in a new rig; the first tick lowers them again
  rig_->start(p, home_);
  rig_->present(rebase_);  // makes room for all sizes needed from now on
  for (FurtherLane& lane : beside_) lane.room_for(*rig_);
  hand_.reset(home_.target);
  guided_.reset(home_.target);
  led_ = false;
  probing_ = false;
  force_.take();        // what was asked before has no meaning now
  snapshots_.update();  // the last loop's
  tripped_ = false;
  tripped_at_.reset();
  beat_.store(MonotonicTime{}.now());
  thread_.start(
      nanoseconds(std::llround(p.tick * 1e9)), [this](const TickTiming& timing) { tick(timing); },
      in_place_ ? Overdue::given_up : Overdue::run);
}

void LiveLoop::note_trip() {
  const bool tripped = in_place_ && snapshot().arming == Arming::tripped;
  if (std::exchange(tripped_, tripped) || !tripped) return;
  tripped_at_ = MonotonicTime{}.now();
  ++trips_;
}

bool LiveLoop::toggle_force() {
  constexpr std::chrono::seconds kFright{1};
  if (snapshot().armed()) {
    cut();
    return true;
  }
  if (in_place_ && tripped_at_ && MonotonicTime{}.now() - *tripped_at_ < kFright) return false;
  arm();
  return true;
}

void LiveLoop::close() {
  thread_.stop();
  if (slot_ != nullptr && slot_->device) slot_->device->stop();
  if (rig_ && !in_place_) virtual_armed_ = rig_->force().armed();
  if (rig_ && in_place_) {
    rig_->present(home_);
    warmth_->keep(home_.warmth, in_seconds(MonotonicTime{}.now()));
  }
  stop_recording();
  recording_to_ = nullptr;  // the next loop's rows are not for it
  has_let_go_.store(true, std::memory_order_relaxed);
  worlds_.clear();
  slots_.clear();
  paths_.clear();
  delete std::exchange(path_, nullptr);
  if (rig_) rig_->plug(nullptr);
  delete std::exchange(slot_, nullptr);
  plugged_ = false;
  rig_.reset();
  for (FurtherLane& lane : beside_) lane.close();
  in_place_ = false;
}

LiveLoop::~LiveLoop() { close(); }

std::size_t LiveLoop::drain(std::span<double> into) {
  if (!trace_ || trace_->size() == 0) return 0;
  drained_from_ = trace_->number();
  return trace_->pop(into);
}

void LiveLoop::plug(std::unique_ptr<Device> device) {
  plugged_ = device != nullptr;
  if (plugged_) device_source_ = "device: " + device_text(device->traits());
  auto slot = std::make_unique<DeviceSlot>(std::move(device), dispose_, held_);
  if (plugged_) real_.encoder_step = slot->encoder_step;
  slots_.offer(std::move(slot));
}

// Takes in what the window has offered.
void LiveLoop::take_in() {
  if (TouchWorlds* worlds = worlds_.take()) {
    rig_->exchange(worlds->lanes[kMainLane]);
    for (std::size_t i = 1; i < kMostLanes && !in_place_; ++i) {
      beside_[i - 1].exchange(worlds->lanes[i]);
    }
    worlds_.give_back(worlds);
  }
  if (DeviceSlot* slot = slots_.take()) {
    if (slot_ != nullptr && slot_->device) slot_->device->stop();
    if (in_place_) rig_->plug(slot->device.get());
    pace_.start();
    slots_.give_back(std::exchange(slot_, slot));
  }
  if (LedPath* path = paths_.take()) {
    paths_.give_back(std::exchange(path_, path));
    path_tick_ = 0;
    path_runs_ = !path->waits;
  }
}

HandInput LiveLoop::follow_path() {
  const std::size_t k = path_runs_ ? path_tick_++ : path_tick_;
  return input_at(path_->hand, k, parameters_.tick);
}

// The hand's input: from a path if there is one, else from the mouse while it grabs, else from a
// guide.
HandInput LiveLoop::hand_input(const Controls& controls) {
  const Vec3 tip = rig_->tip();
  const double T = parameters_.tick;
  connected_ = slot_ != nullptr && slot_->device;
  if (in_place_) {
    connected_ = connected_ && rig_->device_reading(guide_);
    return {tip, 1};
  }
  if (path_ != nullptr && !path_->hand.time.empty()) return follow_path();
  connected_ = connected_ && slot_->device->read(guide_);
  Vec3 goal = controls.goal;
  bool grab = controls.grab;
  if (grab) {
    guided_.reset(goal);
    led_ = false;
  } else if (connected_ && slot_->guides()) {
    if (!led_) guided_.reset(tip);
    led_ = guided_.step(guide_, T) || led_;
    guided_.stay_near(tip, kGuideReach);
    goal = guided_.goal();
    grab = led_;
  }
  if (probing_ && !grab) {
    goal = held_at_;
    grab = true;
  }
  return hand_.step(grab, goal, tip, parameters_.hand_stiffness, T);
}

// Returns the force that measures the grip, over the tick that begins [N]. It ends with its time,
// or for good once the whole force is no longer on.
Vec3 LiveLoop::excite(const Controls& controls, int periods) {
  if (std::exchange(probe_number_, controls.probe) != controls.probe) {
    probing_ = controls.probe > 0;
    probe_time_ = 0;
    held_at_ = rig_->tip();
  }
  probing_ = probing_ && probe_time_ < GripProbe::kDuration &&
             rig_->force().state() == Arming::on && !rig_->diverged();
  if (!probing_) return Vec3::Zero();
  const double now = std::exchange(probe_time_, probe_time_ + periods * parameters_.tick);
  return probe_.at(now);
}

RigInput LiveLoop::rig_input(const TickTiming& timing, const HandInput& hand) {
  RigInput input{hand, force_.take()};
  if (!in_place_) return input;
  input.periods = timing.periods;
  input.dt = timing.dt;
  input.silence = in_seconds(MonotonicTime{}.now() - beat_.load(std::memory_order_relaxed));
  return input;
}

// Starts over: a device where it is and without force, a virtual arm with its force unless that had
// tripped.
void LiveLoop::start_over(const Parameters& p) {
  if (in_place_) {
    rig_->present(home_);
    home_.x2 = home_.x1;
    home_.v2 = home_.v1;
  }
  home_.armed = rig_->force().armed() && rig_->force().state() != Arming::tripped;
  rig_->start(p, home_);
  for (FurtherLane& lane : beside_) lane.begin_anew();
  probing_ = false;
  hand_.reset(home_.target);
  led_ = false;  // else the guide would pull it back
  path_tick_ = 0;
  path_runs_ = path_ != nullptr && !path_->waits;
}

// Whether the arm's next tick comes now; the time of a device cannot be stopped.
bool LiveLoop::due(const Controls& controls) {
  const bool asked = controls.resets != resets_ || force_.waits();
  if (in_place_ || asked) return true;
  if (!controls.paused) {
    steps_ = controls.steps;
    slowed_ = (slowed_ + 1) % std::max(controls.slow, 1);
    return slowed_ == 0;
  }
  if (steps_ == controls.steps) return false;
  ++steps_;
  return true;
}

Parameters LiveLoop::for_device(Parameters p) const noexcept {
  if (!in_place_) return p;
  return as_taken(p, {real_.damping, real_.torque, slot_ != nullptr ? slot_->encoder_step : 0});
}

void LiveLoop::tick(const TickTiming& timing) {
  const auto began = std::chrono::steady_clock::now();
  controls_.update();
  const Controls& controls = controls_.front();
  take_in();
  if (!due(controls)) return;
  const Parameters wanted = for_device(controls.parameters());
  if (controls.resets != resets_) {
    resets_ = controls.resets;
    start_over(wanted);
  }
  if (!(controls.limits == limits_)) {
    limits_ = controls.limits;
    rig_->limit(limits_);
  }
  if (!(wanted == parameters_)) {
    parameters_ = wanted;
    if (recording_to_ != nullptr) recording_to_->changed(parameters_);
  }
  const Vec3 excitation = excite(controls, in_place_ ? timing.periods : 1);
  HandInput hand = hand_input(controls);
  hand.magnet = hand.magnet || controls.magnet;
  if (controls.pull.body >= 0) hand.pull = controls.pull;
  follow_recorder(hand.target);
  RigInput input = rig_input(timing, hand);
  input.excitation = excitation;
  if (!in_place_) step_beside(controls, input);
  rig_->step(parameters_, input, row(kMainLane));
  const auto ended = std::chrono::steady_clock::now();
  compute_ = std::chrono::duration<double>(ended - began).count();
  if (in_place_ && rig_->device_reading(guide_)) {
    pace_.note(guide_.count, guide_.age,
               std::chrono::duration<double>(ended.time_since_epoch()).count());
  }
  publish(timing);
}

// Steps all further lanes. One that joins waits until the first is steady; then all lanes begin
// anew where they stand, so that they count time and energy from the same tick.
void LiveLoop::step_beside(const Controls& controls, const RigInput& input) {
  const auto joins = [&](std::size_t i) {
    return i < controls.lane_count && !beside_[i - 1].runs();
  };
  bool any = false;
  for (std::size_t i = 1; i < kMostLanes; ++i) any = any || joins(i);
  const bool steady = rig_->steady();
  if (any && steady && recording_to_ == nullptr) {
    rig_->restart_here(parameters_, rebase_, input.hand.target);
    for (FurtherLane& lane : beside_) lane.restart_here(input.hand.target);
  }
  for (std::size_t i = 1; i < kMostLanes; ++i) {
    FurtherLane& lane = beside_[i - 1];
    const bool recorded = recording_to_ != nullptr && i < recording_to_->lanes();
    const bool on = i < controls.lane_count && (steady || lane.runs());
    lane.step(recorded || on, controls.lanes[i], *rig_, input, row(i));
    if (lane.changed() && recorded) recording_to_->changed(lane.parameters(), i);
  }
}

std::span<double> LiveLoop::row(std::size_t lane) {
  const std::size_t stride = rows_.size() / kMostLanes;
  return std::span(rows_).subspan(lane * stride, stride);
}

bool LiveLoop::lanes_run(std::size_t count) const {
  const auto beside = std::span(beside_).first(count - 1);
  return std::ranges::all_of(beside, [](const FurtherLane& lane) { return lane.runs(); });
}

// Takes up or releases the recorder. A recording restarts the rig where it stands, so that its
// first row determines all later ones.
void LiveLoop::follow_recorder(const Vec3& target) {
  if (recording_to_ != nullptr && let_go_.load(std::memory_order_relaxed)) {
    recording_to_ = nullptr;
    has_let_go_.store(true, std::memory_order_release);
  }
  if (offered_recorder_.load(std::memory_order_acquire) == nullptr || !rig_->steady()) return;
  if (!lanes_run(offered_lanes_.load(std::memory_order_relaxed))) return;
  // Null if the window has withdrawn it meanwhile.
  Recorder* offered = offered_recorder_.exchange(nullptr, std::memory_order_acq_rel);
  if (offered == nullptr) return;
  recording_to_ = offered;
  recorded_from_.store(published_, std::memory_order_relaxed);
  if (!std::exchange(path_runs_, true)) path_tick_ = 1;  // its first point is the first row's
  rig_->restart_here(parameters_, rebase_, target);
  for (FurtherLane& lane : beside_) lane.restart_here(target);
  offered->changed(parameters_);
  offered->begins(rebase_.world);
  for (std::size_t i = 1; i < offered->lanes(); ++i) {
    offered->changed(beside_[i - 1].parameters(), i);
    offered->begins(beside_[i - 1].start().world, i);
  }
}

void LiveLoop::publish(const TickTiming& timing) {
  const RowLayout& layout = rig_->layout();
  layout.in(row(kMainLane), Column::wake_latency)[0] = timing.wake_latency;
  layout.in(row(kMainLane), Column::compute)[0] = compute_;
  trace_->push(rows_);
  ++published_;
  if (recording_to_ != nullptr) {
    recording_to_->push(std::span(rows_).first(recording_to_->stride()));
  }
  Snapshot& snapshot = snapshots_.back();
  std::ranges::copy(row(kMainLane), snapshot.row.begin());
  snapshot.diverged = rig_->diverged();
  snapshot.recording = recording_to_ != nullptr;
  snapshot.arming = rig_->force().state();
  snapshot.force_state = rig_->force().why();
  snapshot.connected = connected_;
  snapshot.reading = guide_;
  snapshot.probe = probe_number_;
  snapshot.probing = probing_;
  snapshot.led = static_cast<double>(path_tick_) * parameters_.tick;
  snapshots_.publish();
}

std::uint64_t LiveLoop::recorded_row(std::uint64_t tick) const {
  const std::uint64_t from =
      recorded_from_.load(std::memory_order_relaxed) + recorder_->dropped_rows();
  return std::min(tick > from ? tick - from : 0, recorder_->newest());
}

void LiveLoop::record(std::unique_ptr<Recorder> recorder) {
  if (recorder->stride() / recorder->lanes() * kMostLanes != trace_->stride()) {
    throw std::invalid_argument("the recording was begun for an arm with other joints");
  }
  if (in_place_ && recorder->lanes() > 1) {
    throw std::invalid_argument(
        "the recording was begun for several runs on a virtual arm, which a real device cannot "
        "have");
  }
  recorder_ = std::move(recorder);
  stopping_ = false;
  let_go_.store(false, std::memory_order_relaxed);
  has_let_go_.store(false, std::memory_order_relaxed);
  offered_lanes_.store(recorder_->lanes(), std::memory_order_relaxed);
  offered_recorder_.store(recorder_.get(), std::memory_order_release);
}

void LiveLoop::stop_recording() {
  if (!recording()) return;
  stopping_ = true;
  // A recorder still offered was never the loop's, and will not be.
  const bool never_taken =
      offered_recorder_.exchange(nullptr, std::memory_order_acq_rel) != nullptr;
  if (never_taken) has_let_go_.store(true, std::memory_order_relaxed);
  let_go_.store(true, std::memory_order_relaxed);
}

// Whether the loop has released the recorder; a loop that has stopped cannot confirm it, and writes
// nothing.
bool LiveLoop::recorder_is_free() {
  if (has_let_go_.load(std::memory_order_acquire)) return true;
  if (thread_.status().running) return false;
  recording_to_ = nullptr;
  return true;
}

std::unique_ptr<Recorder> LiveLoop::take_recorded() {
  if (!stopping_ || !recorder_is_free()) return nullptr;
  stopping_ = false;
  return std::move(recorder_);
}

void LiveLoop::finish_recording() {
  stop_recording();
  while (recorder_) {
    if (const std::unique_ptr<Recorder> done = take_recorded()) return done->finish();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace limpid
