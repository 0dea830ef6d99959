#include "app/live/live_loop.h"

#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "core/dynamics/inverse_kinematics.h"

namespace limpid {
namespace {

constexpr std::size_t kTraceRows = 1 << 13;  // eight seconds of a window that does not come
constexpr int kFirstReading = 200;           // how long a device may take to say where it is [ms]
constexpr double kGuideReach = 0.03;         // a guided hand stays this near to the tip [m]

}  // namespace

LiveLoop::LiveLoop(AskForPriority ask) : thread_(std::move(ask)) {}

void LiveLoop::open(const ArmDescription& arm, const Scene& scene, const Parameters& p,
                    const Vec3& home) {
  RigStart start = rest_at(arm, home);
  close();
  rig_ = std::make_unique<Rig>(arm, scene);
  begin(std::move(start), p);
}

void LiveLoop::open(const ArmDescription& arm, const Scene& scene, const Parameters& p,
                    std::unique_ptr<Device> device) {
  close();
  rig_ = std::make_unique<Rig>(arm, scene, true);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(arm.dof());
  RigStart start{rest_pose(arm), zero, rest_pose(arm), zero, zero, Vec3::Zero(), false};
  DeviceReading first;
  for (int i = 0; i < kFirstReading && device && device->read(first) && first.count == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  if (first.count > 0) {
    start.x1 = start.x2 = Eigen::Map<const Eigen::VectorXd>(first.x.data(), arm.dof());
  }
  plug(std::move(device));
  begin(std::move(start), p);
}

void LiveLoop::begin(RigStart start, const Parameters& p) {
  const auto stride = static_cast<std::size_t>(rig_->layout().stride());
  trace_ = std::make_unique<TraceRing>(kTraceRows, stride);
  row_.assign(stride, 0.0);
  home_ = rebase_ = std::move(start);
  parameters_ = p;
  rig_->start(p, home_);
  hand_.reset(home_.target);
  guided_.reset(home_.target);
  led_ = false;
  thread_.start(nanoseconds(std::llround(p.tick * 1e9)),
                [this](const TickTiming& timing) { tick(timing); });
}

void LiveLoop::close() {
  thread_.stop();
  worlds_.clear();
  plugs_.clear();
  if (rig_) rig_->plug(nullptr);
  delete std::exchange(plug_, nullptr);
  plugged_ = false;
  rig_.reset();
}

LiveLoop::~LiveLoop() { close(); }

void LiveLoop::plug(std::unique_ptr<Device> device) {
  plugged_ = device != nullptr;
  plugs_.offer(std::make_unique<Plug>(Plug{std::move(device)}));
}

// What the window has offered.
void LiveLoop::take_in() {
  if (TouchWorld* world = worlds_.take()) {
    rig_->exchange(*world);
    worlds_.give_back(world);
  }
  if (Plug* plug = plugs_.take()) {
    if (plug_ != nullptr && plug_->device) plug_->device->stop();
    if (rig_->real()) rig_->plug(plug->device.get());
    plugs_.give_back(std::exchange(plug_, plug));
  }
}

// The mouse leads the hand; a guide does while the mouse does not.
HandInput LiveLoop::hand_input(const Controls& controls) {
  const Vec3 tip = rig_->tip();
  const double T = parameters_.tick;
  connected_ = plug_ != nullptr && plug_->device;
  if (rig_->real()) {
    connected_ = connected_ && rig_->device_reading(guide_);
    return {tip, 1};
  }
  connected_ = connected_ && plug_->device->read(guide_);
  Vec3 goal = controls.goal;
  bool grab = controls.grab;
  if (grab) {
    guided_.reset(goal);
    led_ = false;
  } else if (connected_ && plug_->guides()) {
    if (!led_) guided_.reset(tip);
    led_ = guided_.step(guide_, T) || led_;
    guided_.stay_near(tip, kGuideReach);
    goal = guided_.goal();
    grab = led_;
  }
  return hand_.step(grab, goal, tip, parameters_.hand_stiffness, T);
}

void LiveLoop::tick(const TickTiming& timing) {
  const auto began = std::chrono::steady_clock::now();
  controls_.update();
  const Controls& controls = controls_.front();
  take_in();
  if (controls.resets != resets_) {
    resets_ = controls.resets;
    if (rig_->real()) {  // it is where it is
      rig_->present(home_);
      home_.x2 = home_.x1;
      home_.v2 = home_.v1;
    }
    home_.armed = controls.force;
    rig_->start(controls.parameters, home_);
    hand_.reset(home_.target);
  }
  if (!(controls.parameters == parameters_)) {
    parameters_ = controls.parameters;
    if (Recorder* recorder = present_recorder_.load(std::memory_order_relaxed)) {
      recorder->changed(parameters_);
    }
  }
  const HandInput hand = hand_input(controls);
  begin_recording(hand.target);
  rig_->step(parameters_, {hand, controls.force}, row_);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  compute_ = took.count();
  publish(timing);
}

// Takes up or lets go of the recorder. A recording starts the rig anew from where it stands, so
// that its first row says all that the later ones depend on.
void LiveLoop::begin_recording(const Vec3& target) {
  Recorder* wanted = wanted_recorder_.load(std::memory_order_acquire);
  if (wanted == present_recorder_.load(std::memory_order_relaxed)) return;
  if (wanted != nullptr) {
    if (!rig_->steady()) return;
    rig_->present(rebase_);
    rebase_.target = target;
    rig_->start(parameters_, rebase_);
    wanted->changed(parameters_);
  }
  present_recorder_.store(wanted, std::memory_order_release);
}

void LiveLoop::publish(const TickTiming& timing) {
  const RowLayout& layout = rig_->layout();
  layout.in(std::span(row_), Column::wake_latency)[0] = timing.wake_latency;
  layout.in(std::span(row_), Column::compute)[0] = compute_;
  trace_->push(row_);
  Recorder* recorder = present_recorder_.load(std::memory_order_relaxed);
  if (recorder != nullptr) recorder->push(row_);
  Snapshot& snapshot = snapshots_.back();
  std::ranges::copy(row_, snapshot.row.begin());
  snapshot.contact_count = rig_->contacts(snapshot.contacts);
  snapshot.diverged = rig_->diverged();
  snapshot.recording = recorder != nullptr;
  snapshot.force_state = rig_->force_state();
  snapshot.connected = connected_;
  snapshot.reading = guide_;
  snapshots_.publish();
}

void LiveLoop::record(const std::filesystem::path& out, const SessionInfo& info,
                      const Parameters& now, bool force) {
  recorder_ = std::make_unique<Recorder>(out, info, now, force);
  wanted_recorder_.store(recorder_.get(), std::memory_order_release);
}

void LiveLoop::stop_recording() {
  wanted_recorder_.store(nullptr, std::memory_order_release);
  // The loop answers within a tick; one that has stopped never does, and does not write either.
  while (present_recorder_.load(std::memory_order_acquire) != nullptr && thread_.status().running) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  present_recorder_.store(nullptr);
  const std::unique_ptr<Recorder> recorder = std::move(recorder_);
  recorder->finish();
}

}  // namespace limpid
