// The running loop behind the window: rig, haptic thread, and what travels between the threads.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <optional>

#include "app/live/device_pace.h"
#include "app/live/twin.h"
#include "app/run/recorder.h"
#include "core/realtime/hand_over.h"
#include "core/realtime/haptic_thread.h"
#include "core/realtime/triple_buffer.h"
#include "core/tick/as_taken.h"
#include "devices/files/session/hand_file.h"
#include "devices/simulated/hands.h"
#include "devices/simulated/rig.h"

namespace limpid {

// From the window to the loop; the newest wins.
struct Controls {
  Parameters parameters;
  SafetyLimits limits;       // of a guarded device
  bool grab = false;         // the hand holds the tip
  Vec3 goal = Vec3::Zero();  // where the mouse wants it [m]
  bool magnet = false;       // picks up what it may
  BodyPull pull{};           // what the mouse pulls on instead of the arm
  std::uint32_t resets = 0;  // start over whenever this counts on
  // A virtual arm's time: its tick comes with every so many of the loop's. Paused, it comes only
  // when `steps` counts on, or where it starts over or force comes or goes.
  int slow = 1;
  bool paused = false;
  std::uint32_t steps = 0;
  bool twin = false;  // a second run beside it; not beside a device in the arm's place
  Parameters twin_parameters;
};

// What can be touched from now on, for both runs.
struct TouchWorlds {
  TouchWorlds(const ArmDescription& arm, const Scene& scene)
      : first(arm, scene), twin(arm, scene) {}

  TouchWorld first, twin;
};

// From the loop to the window; the newest wins.
struct Snapshot {
  std::array<double, kMaxStride> row{}, twin{};  // not numbers without a twin
  bool diverged = false;
  bool recording = false;
  Arming arming = Arming::off;
  // Force is on, or will be as soon as nothing keeps it off.
  bool armed() const { return arming != Arming::off && arming != Arming::tripped; }
  ForceState force_state = ForceState::off;
  bool connected = false;  // the device that is plugged in answers
  DeviceReading reading;   // its newest
  double led = 0;          // how far the hand's path has been followed [s]
};

// A path for the virtual arm's hand; one without samples leaves the hand to the controls again.
struct LedPath {
  HandPath hand;
  bool waits = false;  // at its first point, until a recording begins
};

// Lets go of a device, which may take seconds if it hangs.
using Dispose = std::function<void(std::unique_ptr<Device>)>;

// A device for the loop; without one: none is plugged in any more.
struct DeviceSlot {
  std::unique_ptr<Device> device;
  const Dispose* dispose = nullptr;
  int* held = nullptr;      // how many of them have a device
  double encoder_step = 0;  // of a real one [rad]

  DeviceSlot(std::unique_ptr<Device> d, const Dispose& by, int& all)
      : device(std::move(d)), dispose(&by), held(&all) {
    if (!device) return;
    ++*held;
    if (device->traits().guarded) encoder_step = encoder_step_of(device->traits());
  }
  DeviceSlot(const DeviceSlot&) = delete;
  DeviceSlot& operator=(const DeviceSlot&) = delete;
  ~DeviceSlot() {
    if (!device) return;
    --*held;
    if (*dispose) (*dispose)(std::move(device));
  }

  // Leads the virtual arm's hand instead of being the arm.
  static bool guides(const DeviceTraits& traits) { return !traits.pushes && traits.dof == 6; }
  bool guides() const { return device && guides(device->traits()); }
};

// All but the functions said to be the loop's are the window's. Starting over, another arm or
// another scene stop the thread for a moment; nothing else does.
class LiveLoop {
 public:
  // `dispose`: where devices go that are done with; none: they are closed at once.
  explicit LiveLoop(AskForPriority ask, Dispose dispose = {});
  ~LiveLoop();

  // A new world; the hand rests with the tip at `home` [m], at rest. The force is as it was on the
  // last virtual arm, at first on. Errors: as rest_at() and Rig; the loop goes on as it was then.
  void open(const ArmDescription& arm, const Scene& scene, const Parameters& p, const Vec3& home);
  // The same with a device in the arm's place, which has as many joints; force is off until it is
  // armed. Starts where the device is, if it has said so already. Errors: as Rig; the loop goes on
  // as it was then, and the device is let go of.
  void open(const ArmDescription& arm, const Scene& scene, const Parameters& p,
            std::unique_ptr<Device> device);
  // Also ends a recording: take_recorded() has it then.
  void close();
  // Both are taken in by the running loop at its next tick. Another scene for the same arm, built
  // beside the loop:
  void exchange(std::unique_ptr<TouchWorlds> worlds) { worlds_.offer(std::move(worlds)); }
  // Another device, or none: a hand's guide, or, of a loop with a device in the arm's place, that
  // one back again.
  void plug(std::unique_ptr<Device> device);
  // The virtual arm's hand follows a path from its beginning on, and rests at its end; starting
  // over begins it again. close() forgets it.
  void lead(std::unique_ptr<LedPath> path) { paths_.offer(std::move(path)); }
  bool device_in_place() const { return in_place_; }
  bool device_plugged() const { return plugged_; }  // by the window; it may be lost
  // The settings as the loop takes them: while a real device has the arm's place, as as_taken().
  Parameters taken(const Parameters& p) const { return device_in_place() ? as_taken(p, real_) : p; }
  // One that is done with may be in the loop's hands still: it is free once this is false.
  bool holds_device() const { return held_ > 0; }

  // Asks for force; nothing else does. What was asked before open() is forgotten.
  void arm() { arms_.fetch_add(1, std::memory_order_relaxed); }
  // No force, from the next tick on; wins where both are asked within one. Any thread may.
  void cut() { cuts_.fetch_add(1, std::memory_order_relaxed); }

  // Also says that somebody is there: where motors are guarded the force fades when this is not
  // heard for SafetyLimits::kSilence.
  void set(const Controls& controls) {
    controls_.write(controls);
    beat_.store(MonotonicTime{}.now(), std::memory_order_relaxed);
  }
  // The newest snapshot; true if there is one newer than at the last call. Also lets go of what the
  // loop has given back: a device is free for others then.
  bool update() {
    worlds_.collect();
    slots_.collect();
    paths_.collect();
    return snapshots_.update();
  }
  const Snapshot& snapshot() const { return snapshots_.front(); }
  // Every tick since the last call, as far as `into` holds; returns how many. Each is its row, and
  // the twin's behind it, of no numbers without one.
  std::size_t drain(std::span<double> into);
  // Which tick the first row of the last drain() was of, counted since open().
  std::uint64_t drained_from() const { return drained_from_; }
  std::uint64_t trace_dropped() const { return trace_ ? trace_->dropped() : 0; }
  const RowLayout& layout() const { return rig_->layout(); }

  // Recording begins at the next tick at which nothing fades; its first row is time zero of the
  // loop. Precondition: the loop runs, as wide as the recorder's rows; none is recording; a twin
  // runs if the recorder is of one, and goes on running.
  void record(std::unique_ptr<Recorder> recorder);
  bool recording() const { return recorder_ && !stopping_; }
  const Recorder* recorder() const { return recorder_.get(); }
  // What somebody notes at a row of the recording. Errors: FileError for a text that is too long.
  void mark(const Mark& mark) {
    if (recording()) recorder_->mark(mark);
  }
  // Asks the loop to let go of the recorder.
  void stop_recording();
  // What was stopped, once the loop has let go of it; null before. To be finished by the caller.
  std::unique_ptr<Recorder> take_recorded();
  // Both, and waits: the file is complete when this returns. Errors: FileError.
  void finish_recording();

  LoopStatus status() const { return thread_.status(); }
  const HapticThread& thread() const { return thread_; }
  // Of the device in the arm's place.
  const DevicePace& device_pace() const { return pace_; }

 private:
  void tick(const TickTiming& timing);                                  // the loop's
  Parameters for_device(Parameters p) const noexcept;                   // the loop's
  void start_over(const Parameters& p);                                 // the loop's
  void follow_recorder(const Vec3& target);                             // the loop's
  RigInput rig_input(const TickTiming& timing, const HandInput& hand);  // the loop's
  ForceRequest wish();                                                  // the loop's
  void publish(const TickTiming& timing);
  void take_in();                                  // the loop's
  HandInput hand_input(const Controls& controls);  // the loop's
  bool due(const Controls& controls);              // the loop's
  HandInput follow_path();                         // the loop's
  void begin(RigStart start, const Parameters& p);
  bool recorder_is_free();

  Dispose dispose_;
  TripleBuffer<Controls> controls_;
  TripleBuffer<Snapshot> snapshots_;
  std::unique_ptr<TraceRing> trace_;
  // The window's count of ticks: of what the ring holds so many rows stand before those that found
  // no room.
  std::uint64_t next_tick_ = 0, drained_from_ = 0, seen_dropped_ = 0, gap_ = 0;
  std::size_t before_gap_ = 0;
  HandOver<TouchWorlds> worlds_;
  int held_ = 0;  // devices in plugs; these go before it
  HandOver<DeviceSlot> slots_;
  HandOver<LedPath> paths_;
  bool in_place_ = false;  // a device has the arm's place; changes while the loop stands
  RealDevice real_;        // then: it; its encoders are the window's
  bool plugged_ = false;   // the window's
  bool virtual_armed_ = true;

  // Counted by the window, followed by the loop.
  std::atomic<std::uint32_t> arms_{0}, cuts_{0};
  std::atomic<nanoseconds> beat_{nanoseconds{0}};

  // The window offers a recorder, or takes the offer back; the loop takes it and from then on it is
  // the loop's, until it has been asked to let go and says that it has.
  std::unique_ptr<Recorder> recorder_;
  bool stopping_ = false;
  std::atomic<Recorder*> offered_recorder_{nullptr};
  std::atomic<bool> let_go_{false}, has_let_go_{false};

  // The loop's own.
  Recorder* recording_to_ = nullptr;
  std::unique_ptr<Rig> rig_;
  Twin twin_;
  DeviceSlot* slot_ = nullptr;
  DeviceReading guide_;
  bool connected_ = false;
  DevicePace pace_;
  MouseHand hand_;
  GuidedHand guided_;
  bool led_ = false;  // by the guide, since it was last touched
  LedPath* path_ = nullptr;
  std::size_t path_tick_ = 0;  // of it, the next
  bool path_runs_ = false;
  Parameters parameters_;
  SafetyLimits limits_;
  RigStart home_;
  RigStart rebase_;
  std::uint32_t resets_ = 0, known_arms_ = 0, known_cuts_ = 0;
  std::uint32_t steps_ = 0;          // taken, or not wanted any more
  int slowed_ = 0;                   // ticks of the loop since the last one of the arm
  std::vector<double> rows_;         // the newest row and the twin's
  std::span<double> row_, of_twin_;  // in them
  double compute_ = 0;

  HapticThread thread_;  // last: it goes first
};

}  // namespace limpid
