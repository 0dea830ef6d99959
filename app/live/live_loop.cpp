#include "app/live/live_loop.h"

#include <chrono>
#include <cmath>
#include <thread>

namespace limpid {
namespace {

constexpr std::size_t kTraceRows = 1 << 13;  // eight seconds of a window that does not come

}  // namespace

LiveLoop::LiveLoop(AskForPriority ask) : thread_(std::move(ask)) {}

void LiveLoop::open(const ArmDescription& arm, const Scene& scene, const Parameters& p,
                    const Vec3& home) {
  RigStart start = rest_at(arm, home);
  close();
  rig_ = std::make_unique<Rig>(arm, scene);
  const auto stride = static_cast<std::size_t>(rig_->layout().stride());
  trace_ = std::make_unique<TraceRing>(kTraceRows, stride);
  row_.assign(stride, 0.0);
  home_ = rebase_ = start;
  parameters_ = p;
  rig_->start(p, start);
  hand_.reset(home);
  thread_.start(nanoseconds(std::llround(p.tick * 1e9)),
                [this](const TickTiming& timing) { tick(timing); });
}

void LiveLoop::close() {
  thread_.stop();
  drop_worlds();
  rig_.reset();
}

LiveLoop::~LiveLoop() { close(); }

void LiveLoop::exchange(std::unique_ptr<TouchWorld> world) {
  delete old_world_.exchange(nullptr, std::memory_order_acquire);
  delete wanted_world_.exchange(world.release(), std::memory_order_acq_rel);
}

void LiveLoop::drop_worlds() {
  delete old_world_.exchange(nullptr);
  delete wanted_world_.exchange(nullptr);
}

// Waits for the window to take the last one away: the loop never deletes.
void LiveLoop::exchange_world() {
  if (old_world_.load(std::memory_order_acquire) != nullptr) return;
  TouchWorld* world = wanted_world_.exchange(nullptr, std::memory_order_acq_rel);
  if (world == nullptr) return;
  rig_->exchange(*world);
  old_world_.store(world, std::memory_order_release);
}

void LiveLoop::tick(const TickTiming& timing) {
  const auto began = std::chrono::steady_clock::now();
  controls_.update();
  const Controls& controls = controls_.front();
  exchange_world();
  if (controls.resets != resets_) {
    resets_ = controls.resets;
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
  const HandInput hand = hand_.step(controls.grab, controls.goal, rig_->tip(),
                                    parameters_.hand_stiffness, parameters_.tick);
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
