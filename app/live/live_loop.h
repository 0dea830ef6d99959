// The running loop behind the window: lanes, haptic thread, and their exchange with other threads.
#pragma once

#include <array>
#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <optional>

#include "app/live/device_pace.h"
#include "app/live/further_lane.h"
#include "app/live/warmth_memory.h"
#include "app/run/recorder.h"
#include "core/realtime/hand_over.h"
#include "core/realtime/haptic_thread.h"
#include "core/realtime/triple_buffer.h"
#include "core/tick/as_taken.h"
#include "core/tick/force_asked.h"
#include "devices/files/session/hand_file.h"
#include "devices/identify/grip_probe.h"
#include "devices/simulated/hands.h"
#include "devices/simulated/rig.h"

namespace limpid {

// From the window to the loop; the newest wins.
struct Controls {
  // Settings of each lane that runs. A device in the arm's place has the first one alone.
  std::array<Parameters, kMostLanes> lanes;
  std::size_t lane_count = 1;
  SafetyLimits limits;       // of a guarded device
  bool grab = false;         // the hand holds the tip
  Vec3 goal = Vec3::Zero();  // the mouse's target for the tip [m]
  bool magnet = false;       // picks up bodies
  BodyPull pull{};           // the mouse's pull on a body, instead of the arm
  std::uint32_t resets = 0;  // the loop starts over whenever this grows
  // Number of the measurement of the grip that is wanted; 0: none. A new number begins it.
  std::uint32_t probe = 0;
  // Time of a virtual arm: one tick in every `slow` of the loop's. Paused, the arm ticks only when
  // `steps` grows, at a start, or when force comes or goes.
  int slow = 1;
  bool paused = false;
  std::uint32_t steps = 0;

  Parameters& parameters() { return lanes[kMainLane]; }
  const Parameters& parameters() const { return lanes[kMainLane]; }
};

// The things to touch from now on, for each lane.
struct TouchWorlds {
  TouchWorlds(const ArmDescription& arm, const Scene& scene) {
    for (std::size_t i = 0; i < kMostLanes; ++i) lanes.emplace_back(arm, scene);
  }

  std::deque<TouchWorld> lanes;
};

// From the loop to the window; the newest wins.
struct Snapshot {
  std::array<double, kMaxStride> row{};  // of the first lane
  bool diverged = false;
  bool recording = false;
  Arming arming = Arming::off;
  // Whether force is on, or will be as soon as nothing keeps it off.
  bool armed() const { return arming != Arming::off && arming != Arming::tripped; }
  ForceState force_state = ForceState::off;
  bool connected = false;  // the device that is plugged in answers
  DeviceReading reading;   // newest of the device
  double led = 0;          // time followed along the hand's path [s]
  // Number of the last measurement of the grip, and whether its excitation still goes on.
  std::uint32_t probe = 0;
  bool probing = false;
};

// A path for the virtual arm's hand; without samples the controls lead the hand again.
struct LedPath {
  HandPath hand;
  bool waits = false;  // at its first point, until a recording begins
};

// Disposes of a device, which may take seconds if it hangs.
using Dispose = std::function<void(std::unique_ptr<Device>)>;

// A device for the loop; null: none is plugged in.
struct DeviceSlot {
  std::unique_ptr<Device> device;
  const Dispose* dispose = nullptr;
  int* held = nullptr;      // number of slots with a device
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

  // Whether the device leads the virtual arm's hand instead of being the arm.
  static bool guides(const DeviceTraits& traits) { return !traits.pushes && traits.dof == 6; }
  bool guides() const { return device && guides(device->traits()); }
};

// Functions are for the window's thread, unless said to be the loop's. Starting over, another arm
// or another scene stop the thread for a moment; nothing else does.
class LiveLoop {
 public:
  // `dispose` takes devices no longer used; none: they are closed at once.
  explicit LiveLoop(AskForPriority ask, Dispose dispose = {});
  ~LiveLoop();

  // Opens a new world; hand and tip rest at `home` [m]. Force stays as on the last virtual arm, on
  // at first. Errors: as rest_at() and Rig; the last loop then goes on.
  void open(const ArmDescription& arm, const Scene& scene, const Parameters& p, const Vec3& home);
  // Opens a world with a device of as many joints in the arm's place; force is off until armed.
  // Starts at the device's posture if it is known, its motors as warm as those of the last device
  // must still be. Errors: as Rig; the last loop then goes on, and
  // the device is disposed of.
  void open(const ArmDescription& arm, const Scene& scene, const Parameters& p,
            std::unique_ptr<Device> device);
  // Ends the loop and a recording, which take_recorded() then returns.
  void close();
  // Sets another scene for the same arm, built beside the loop, from the next tick on.
  void exchange(std::unique_ptr<TouchWorlds> worlds) { worlds_.offer(std::move(worlds)); }
  // Plugs in a device, or none, from the next tick on: a hand's guide, or the device in the arm's
  // place again.
  void plug(std::unique_ptr<Device> device);
  // Leads the virtual arm's hand along a path, at whose end it rests; starting over begins the path
  // again. close() forgets it.
  void lead(std::unique_ptr<LedPath> path) { paths_.offer(std::move(path)); }
  bool device_in_place() const { return in_place_; }
  bool device_plugged() const { return plugged_; }  // by the window; its connection may be lost
  // The source of recordings with the device that was plugged in last; empty: none was.
  const std::string& device_source() const { return device_source_; }
  // The settings as the loop takes them: as_taken() with a real device in the arm's place.
  Parameters taken(const Parameters& p) const { return device_in_place() ? as_taken(p, real_) : p; }
  // Whether a slot still has a device, in use or replaced; devices are free once this is false.
  bool holds_device() const { return held_ > 0; }

  // Asks for force; nothing else does. Requests from before open() are forgotten.
  void arm() { force_.arm(); }
  // Cuts the force from the next tick on; wins over arm() within the same tick. For any thread.
  void cut() { force_.cut(); }
  // Cuts the force if it is on, else asks for it. Returns false, and asks for nothing, within a
  // second after a device's force tripped: a person who presses then wants it to be off.
  bool toggle_force();

  // Sets the controls, and shows that somebody is there: without calls for SafetyLimits::kSilence
  // the force of guarded motors fades.
  void set(const Controls& controls) {
    controls_.write(controls);
    beat_.store(MonotonicTime{}.now(), std::memory_order_relaxed);
  }
  // Takes the newest snapshot; true if it is new. Also releases what the loop has given back: a
  // device is then free for others.
  bool update() {
    worlds_.collect();
    slots_.collect();
    paths_.collect();
    const bool news = snapshots_.update();
    if (news) note_trip();
    return news;
  }
  const Snapshot& snapshot() const { return snapshots_.front(); }
  // Number of times, since the start, that a device's force was seen to trip.
  std::uint64_t trips() const { return trips_; }
  // Takes the ticks since the last call, as far as `into` has room; returns their number. Each tick
  // is the rows of all kMostLanes lanes, NaN where none runs.
  std::size_t drain(std::span<double> into);
  // Number of the first tick of the last drain(), counted since open().
  std::uint64_t drained_from() const { return drained_from_; }
  std::uint64_t trace_dropped() const { return trace_ ? trace_->dropped() : 0; }
  const RowLayout& layout() const { return rig_->layout(); }

  // Begins recording at the next tick without fading; its first row is time zero. Preconditions:
  // the loop runs, with rows as wide as the recorder's, and is not recording. The recording begins
  // once all lanes that the recorder is of run, and keeps them running. Errors:
  // std::invalid_argument for several lanes with a device in the arm's place.
  void record(std::unique_ptr<Recorder> recorder);
  bool recording() const { return recorder_ && !stopping_; }
  const Recorder* recorder() const { return recorder_.get(); }
  // Returns the row of the recording nearest to a tick that drain() counts. Precondition: there is
  // a recorder.
  std::uint64_t recorded_row(std::uint64_t tick) const;
  // Notes a mark at a row of the recording. Errors: FileError if the text is too long.
  void mark(const Mark& mark) {
    if (recording()) recorder_->mark(mark);
  }
  // Asks the loop to let go of the recorder.
  void stop_recording();
  // The stopped recorder once the loop has released it, to be finished by the caller; null before.
  std::unique_ptr<Recorder> take_recorded();
  // Stops the recording and completes its file. Errors: FileError.
  void finish_recording();

  LoopStatus status() const { return thread_.status(); }
  const HapticThread& thread() const { return thread_; }
  // Memory for what warms up a device's motors beside the loop; the next loop begins with it.
  const std::shared_ptr<WarmthMemory>& warmth_memory() const { return warmth_; }
  // Punctuality of the device in the arm's place.
  const DevicePace& device_pace() const { return pace_; }

 private:
  void tick(const TickTiming& timing);                                  // the loop's
  Parameters for_device(Parameters p) const noexcept;                   // the loop's
  void start_over(const Parameters& p);                                 // the loop's
  void follow_recorder(const Vec3& target);                             // the loop's
  RigInput rig_input(const TickTiming& timing, const HandInput& hand);  // the loop's
  void step_beside(const Controls& controls, const RigInput& input);    // the loop's
  std::span<double> row(std::size_t lane);                              // a part of rows_
  bool lanes_run(std::size_t count) const;                              // the loop's
  void publish(const TickTiming& timing);
  void take_in();                                      // the loop's
  HandInput hand_input(const Controls& controls);      // the loop's
  bool due(const Controls& controls);                  // the loop's
  Vec3 excite(const Controls& controls, int periods);  // the loop's
  HandInput follow_path();                             // the loop's
  void begin(RigStart start, const Parameters& p);
  bool recorder_is_free();
  void note_trip();  // the window's

  Dispose dispose_;
  TripleBuffer<Controls> controls_;
  TripleBuffer<Snapshot> snapshots_;
  std::unique_ptr<TraceRing> trace_;
  std::uint64_t drained_from_ = 0;
  HandOver<TouchWorlds> worlds_;
  int held_ = 0;  // devices in slots_; must outlive them
  HandOver<DeviceSlot> slots_;
  HandOver<LedPath> paths_;
  bool in_place_ = false;  // a device has the arm's place; changes only while the loop is stopped
  RealDevice real_;        // the device in place; the window writes its encoders
  bool plugged_ = false;   // the window's
  std::string device_source_;
  bool virtual_armed_ = true;
  bool tripped_ = false;  // as far as the window knows
  std::optional<nanoseconds> tripped_at_;
  std::uint64_t trips_ = 0;
  std::shared_ptr<WarmthMemory> warmth_ = std::make_shared<WarmthMemory>();  // of devices in place

  // Counted by the window, read by the loop.
  ForceAsked force_;
  std::atomic<nanoseconds> beat_{nanoseconds{0}};

  // The window offers a recorder, or withdraws the offer. Once taken, the recorder is the loop's,
  // until the window asks for its release and the loop confirms that.
  std::unique_ptr<Recorder> recorder_;
  bool stopping_ = false;
  std::atomic<Recorder*> offered_recorder_{nullptr};
  std::atomic<std::size_t> offered_lanes_{1};  // of the recorder that is offered
  std::atomic<bool> let_go_{false}, has_let_go_{false};
  std::atomic<std::uint64_t> recorded_from_{0};  // tick of the recording's first row

  // Used by the loop alone.
  Recorder* recording_to_ = nullptr;
  std::uint64_t published_ = 0;  // ticks, as drain() counts them
  std::unique_ptr<Rig> rig_;
  std::array<FurtherLane, kMostLanes - 1> beside_;
  DeviceSlot* slot_ = nullptr;
  DeviceReading guide_;
  bool connected_ = false;
  DevicePace pace_;
  MouseHand hand_;
  GuidedHand guided_;
  bool led_ = false;  // by the guide, since it was last touched
  LedPath* path_ = nullptr;
  std::size_t path_tick_ = 0;  // the next tick of path_
  bool path_runs_ = false;
  GripProbe probe_;
  std::uint32_t probe_number_ = 0;  // of the newest one
  bool probing_ = false;
  double probe_time_ = 0;        // since its begin [s]
  Vec3 held_at_ = Vec3::Zero();  // by the virtual hand meanwhile [m]
  Parameters parameters_;
  SafetyLimits limits_;
  RigStart home_;
  RigStart rebase_;
  std::uint32_t resets_ = 0;
  std::uint32_t steps_ = 0;   // taken, or obsolete
  int slowed_ = 0;            // ticks of the loop since the last one of the arm
  std::vector<double> rows_;  // the newest rows of all lanes
  double compute_ = 0;

  HapticThread thread_;  // last, to be destroyed first
};

}  // namespace limpid
