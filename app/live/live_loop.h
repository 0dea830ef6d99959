// The running loop behind the window: rig, haptic thread, and what travels between the threads.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <optional>

#include "app/run/recorder.h"
#include "core/loop/hand_over.h"
#include "core/loop/haptic_thread.h"
#include "core/loop/triple_buffer.h"
#include "devices/guided_hand.h"
#include "devices/mouse_hand.h"
#include "devices/rig.h"

namespace limpid {

// From the window to the loop; the newest wins.
struct Controls {
  Parameters parameters;
  bool force = true;         // armed
  bool grab = false;         // the hand holds the tip
  Vec3 goal = Vec3::Zero();  // where the mouse wants it [m]
  std::uint32_t resets = 0;  // start over whenever this counts on
};

// From the loop to the window; the newest wins.
struct Snapshot {
  std::array<double, kMaxStride> row{};
  std::array<ContactForce, 16> contacts{};
  std::size_t contact_count = 0;
  bool diverged = false;
  bool recording = false;
  ForceState force_state = ForceState::on;
  bool connected = false;  // the device that is plugged in answers
  DeviceReading reading;   // its newest
};

// A device for the loop; without one: none is plugged in any more.
struct Plug {
  std::unique_ptr<Device> device;

  // Leads the virtual arm's hand instead of being the arm.
  static bool guides(const DeviceTraits& traits) { return !traits.pushes && traits.dof == 6; }
  bool guides() const { return device && guides(device->traits()); }
};

// All but the functions said to be the loop's are the window's. Starting over, another arm or
// another scene stop the thread for a moment; nothing else does.
class LiveLoop {
 public:
  explicit LiveLoop(AskForPriority ask);
  ~LiveLoop();

  // A new world; the hand rests with the tip at `home` [m], at rest. Errors: as rest_at().
  void open(const ArmDescription& arm, const Scene& scene, const Parameters& p, const Vec3& home);
  // The same with a real device for the arm, which has as many joints; force is off until it is
  // armed. Starts where the device is.
  void open(const ArmDescription& arm, const Scene& scene, const Parameters& p,
            std::unique_ptr<Device> device);
  void close();
  // Both are taken in by the running loop at its next tick. Another scene for the same arm, built
  // beside the loop:
  void exchange(std::unique_ptr<TouchWorld> world) { worlds_.offer(std::move(world)); }
  // Another device, or none: a hand's guide, or, of a loop for a real device, that one back again.
  void plug(std::unique_ptr<Device> device);
  bool real() const { return rig_ && rig_->real(); }
  bool device_plugged() const { return plugged_; }  // by the window; it may be lost

  void set(const Controls& controls) { controls_.write(controls); }
  // The newest snapshot; true if there is one newer than at the last call. Also lets go of what the
  // loop has given back: a device is free for others then.
  bool update() {
    worlds_.collect();
    plugs_.collect();
    return snapshots_.update();
  }
  const Snapshot& snapshot() const { return snapshots_.front(); }
  // Every tick since the last call, as far as `into` holds; returns the rows.
  std::size_t drain(std::span<double> into) { return trace_ ? trace_->pop(into) : 0; }
  std::uint64_t trace_dropped() const { return trace_ ? trace_->dropped() : 0; }
  const RowLayout& layout() const { return rig_->layout(); }

  // Recording begins at the next tick at which nothing fades; its first row is time zero of the
  // loop. Errors: FileError.
  void record(const std::filesystem::path& out, const SessionInfo& info, const Parameters& now,
              bool force);
  bool recording() const { return recorder_ != nullptr; }
  const Recorder* recorder() const { return recorder_.get(); }
  // Ends it; the file is complete when this returns. Errors: FileError.
  void stop_recording();

  LoopStatus status() const { return thread_.status(); }
  const HapticThread& thread() const { return thread_; }

 private:
  void tick(const TickTiming& timing);       // the loop's
  void begin_recording(const Vec3& target);  // the loop's
  void publish(const TickTiming& timing);
  void take_in();                                  // the loop's
  HandInput hand_input(const Controls& controls);  // the loop's
  void begin(RigStart start, const Parameters& p);

  TripleBuffer<Controls> controls_;
  TripleBuffer<Snapshot> snapshots_;
  std::unique_ptr<TraceRing> trace_;
  std::unique_ptr<Recorder> recorder_;
  HandOver<TouchWorld> worlds_;
  HandOver<Plug> plugs_;
  bool plugged_ = false;  // the window's
  // Where the loop records to: set by the window, taken up by the loop, which answers.
  std::atomic<Recorder*> wanted_recorder_{nullptr};
  std::atomic<Recorder*> present_recorder_{nullptr};

  // The loop's own.
  std::unique_ptr<Rig> rig_;
  Plug* plug_ = nullptr;
  DeviceReading guide_;
  bool connected_ = false;
  MouseHand hand_;
  GuidedHand guided_;
  bool led_ = false;  // by the guide, since it was last touched
  Parameters parameters_;
  RigStart home_;
  RigStart rebase_;
  std::uint32_t resets_ = 0;
  std::vector<double> row_;
  double compute_ = 0;

  HapticThread thread_;  // last: it goes first
};

}  // namespace limpid
