// Limpid's haptic loop as a library: one tick of a device loop of your own, or of a simulated arm
// in a simulated hand.
//
//     limpid::LoopOptions options;
//     options.arm = "my_arm.urdf";
//     options.scene = "table.toml";
//     options.settings = {"coupling.kind=predictive", "coupling.eta=0.5"};
//     limpid::DeviceLoop loop(options, device.positions());
//     loop.arm();  // as soon as a person holds the device
//     while (running) {
//       device.wait();
//       const auto positions = device.positions();  // must live until tick() returns
//       limpid::DeviceLoop::Reading reading;
//       reading.position = positions;
//       device.push(loop.tick(reading));
//     }
//
// Quantities have SI units. Joints that turn have rad, rad/s and N m, joints that slide m, m/s and
// N. Points are in the frame of the arm's base: x forward, y left, z up. A parallel robot (a delta)
// is an arm of three slides along x, y and z with the mass that the hand feels: give the place of
// its tip as positions, and turn the forces f into the motors' torques by your Jacobian, J^T f.
//
// Threads: arm(), cut() and the free functions may be called from any thread. All else of a loop
// belongs to the thread that ticks. tick() and step() neither allocate, lock nor throw, and touch
// no file; constructors, set() with a text, record() and finish_recording() do.
//
// Errors: limpid::LoopError. Its text names the file and line, or the key, what was found, and what
// is allowed.
#pragma once

#if __cplusplus < 202002L
#error "limpid/limpid.h needs C++20: compile with -std=c++20"
#endif

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <ranges>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Version of this header by the rules of semantic versioning: incompatible changes raise the first
// number, before 1.0.0 the second.
#define LIMPID_VERSION_MAJOR 0
#define LIMPID_VERSION_MINOR 2
#define LIMPID_VERSION_PATCH 0

#define LIMPID_API __attribute__((visibility("default")))

namespace limpid {

using Point3 = std::array<double, 3>;  // x, y, z [m]

// A view of numbers that the caller keeps until the tick that takes them returns. A vector or array
// that nobody keeps, as a function returns it, does not compile.
class KeptNumbers : public std::span<const double> {
 public:
  constexpr KeptNumbers() noexcept = default;
  constexpr KeptNumbers(const double* first, std::size_t count) : span(first, count) {}
  template <std::ranges::borrowed_range R>
  requires std::convertible_to<R, std::span<const double>>
  constexpr KeptNumbers(R&& numbers)  // NOLINT(bugprone-forwarding-reference-overload)
      : span(std::forward<R>(numbers)) {}
};

class LIMPID_API LoopError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  ~LoopError() override;
};

// Returns the version of the library that runs, as "0.2.0+41.g3f2a94d1".
LIMPID_API std::string library_version();

// Whose motors a DeviceLoop moves. With `real` a person's hand is on them: force is off until it is
// armed, fades in within 0.5 s, and the limits below hold. With `simulated` force is on from the
// first tick, and nothing but the arm's file limits it.
enum class Motors : std::uint8_t { real, simulated };

// Limits for real motors. They can be lowered only: the values here are the largest allowed.
struct LoopLimits {
  double joint_speed =
      15;  // Fastest joint, 0.5 to 15 rad/s, over some ticks; force is gone at 1.5 of it.
  double tip_speed = 2;   // Tip, 0.05 to 2 m/s; force is gone at 1.5 of it.
  double tip_force = 10;  // Motors' force at the tip, 0.1 to 10 N.
  double energy = 1.5;    // Energy that motors put out in a second, 0.02 to 1.5 J; more trips.
  double range = 1;       // Part of each joint's range, about its middle, 0.1 to 1.
};

struct LoopOptions {
  // URDF file of the arm, or the name of one in share/limpid/assets/devices, as "omni.urdf". Empty:
  // the built-in arm of three joints, but not for real motors. Xacro is not expanded here.
  std::string arm;
  // URDF of the arm as text, in place of the file; urdf_text() below writes one.
  std::string arm_text;
  // Link of the arm that the hand holds. Empty: the one that the file names, or the end of the
  // longest chain.
  std::string tip;
  // TOML file of the scene, or the name of one in share/limpid/assets/scenes, as "table.toml".
  // Empty: a table where the arm reaches it, else nothing to touch.
  std::string scene;
  // The scene as text, in place of the file; SceneBuilder below writes one. Models that it names
  // are looked for in the present folder.
  std::string scene_text;
  // TOML file of settings, as `limpid run --config` takes it; if it has loop.tick, it has to be
  // `period`. Empty: none.
  std::string config;
  // Settings by their keys, as "coupling.kind=predictive"; later ones win, also over `config`.
  // setting_list() has all of them. The law is "proposed", the paper's, unless coupling.kind says
  // another; "predictive" renders stiffer walls, and stays passive with a low eta. Gains that no
  // setting names are fitted to the arm. Of a device say the step of its encoders,
  // device.encoder_step, and its delay in ticks, model.delay. hand.*, plant.*,
  // device.substeps, device.gravity and device.springs belong to the simulated hand and arm, and
  // device.delay and device.friction to simulated motors: a DeviceLoop refuses them here, and takes
  // no notice of them in `config`. In settings, whose units have
  // rad, 1 rad of a slide is 0.1 m: coupling.k_vc = 1 N m/rad is 100 N/m, device.damping = 1 N m
  // s/rad is 100 N s/m, a torque of 1 N m is 10 N, and device.encoder_step = 1e-4 rad is 1e-5 m.
  std::vector<std::string> settings;
  // Time from a tick to the next, 1e-5 to 0.1 s, with real motors at most 0.004 s: what your loop
  // keeps. Faster loops render stiffer walls. Most of what Limpid promises was tried at 0.001.
  double period = 0.001;
  // The two below are a DeviceLoop's.
  Motors motors = Motors::real;
  LoopLimits limits;
};

// A setting, as the sliders of the window and `limpid run --help` describe it.
struct SettingInfo {
  std::string key;                 // "coupling.eta"
  std::string unit;                // "-" for none
  double least = 0, most = 0;      // allowed numbers; of a flag 0 and 1
  std::vector<std::string> words;  // in a text, of a choice or a flag; else empty
  bool live = true;                // may change while the loop runs
  std::string meaning;             // a sentence for people
};
LIMPID_API std::vector<SettingInfo> setting_list();

constexpr double kGuessed = std::numeric_limits<double>::quiet_NaN();

// A joint and the link that it moves. Its frame is that of its origin; the axis is in it.
struct ArmJoint {
  std::string name;                    // Unique in the arm.
  bool slides = false;                 // Else it turns.
  Point3 position{};                   // Origin in the frame of the joint before [m].
  Point3 rpy{};                        // Roll, pitch and yaw of the origin [rad].
  Point3 axis{0, 0, 1};                // Any length but 0.
  double lower = -3.14, upper = 3.14;  // Range [rad or m]; it contains the real device's.
  // Motor's largest torque or force, above 0 [N m or N]. kGuessed: twice what holds the arm
  // stretched out; notes() say how much.
  double effort = kGuessed;
  double damping = 0;   // b_d, viscous [N m s/rad or N s/m]: only what is measured: too much lets
                        // the loop give energy.
  double friction = 0;  // Coulomb's [N m or N].
  double mass = 0;      // Link [kg]; some link of the arm has one.
  Point3 center{};      // Centre of the link's mass in its frame [m].
  std::array<double, 6> inertia{};  // xx, xy, xz, yy, yz, zz about the centre [kg m^2].
};

struct ArmModel {
  std::string name = "arm";
  std::vector<ArmJoint> joints;  // 1 to 32, base first
  Point3 tip{};                  // in the last joint's frame [m]
};
// Returns the arm as URDF, for LoopOptions::arm_text or a file. Errors: a number that is not
// finite, but for a guessed effort; an effort of 0 or less.
LIMPID_API std::string urdf_text(const ArmModel& arm);

// Surface of an object. Stiffness up to 1e6, damping up to 1000, friction 0 to 1.
struct SurfaceMaterial {
  double stiffness = 600;  // [N/m]
  double damping = 0;      // while it is pressed in or let out [N s/m]
  double friction = 0;     // kinetic, tangential force over the normal one [-]
  double sticking = 0;     // static; raised to the kinetic one if it is less [-]
};

// Writes a scene, an object a call. Names are for people, and for "/objects/..." of a row.
class LIMPID_API SceneBuilder {
 public:
  // Objects that stay where they are. `normal` points out of the material.
  SceneBuilder& plane(const std::string& name, Point3 point, Point3 normal, SurfaceMaterial = {});
  SceneBuilder& sphere(const std::string& name, Point3 center, double radius, SurfaceMaterial = {});
  SceneBuilder& box(const std::string& name, Point3 center, Point3 size, SurfaceMaterial = {});
  // Objects that move, with their mass, 1e-6 to 100 kg, and even density.
  SceneBuilder& ball(const std::string& name, Point3 center, double radius, double mass,
                     SurfaceMaterial = {});
  SceneBuilder& block(const std::string& name, Point3 center, Point3 size, double mass,
                      SurfaceMaterial = {});
  // Anything else that scene files have, as TOML: "[[spring]] ...", "gravity = [0, 0, 0]" comes
  // before all objects.
  SceneBuilder& toml(const std::string& text);

  const std::string& text() const { return text_; }  // for LoopOptions::scene_text or a file

 private:
  std::string text_;
};

// A column of a row.
struct RowColumn {
  std::string path;        // as in recordings: "/device/position"
  std::string unit;        // where joints differ, one of each: "rad, rad, m"
  std::string what;        // a sentence for people
  std::size_t offset = 0;  // of its first number in the row
  std::size_t width = 0;   // numbers: 1, 3, one a joint, ...
  // Shape of these numbers, the last of it running fastest: {} of a single number, {joints} also of
  // one joint, {3} of x, y, z, {4, 3} of those of four contacts, {objects, 7}.
  std::vector<std::size_t> shape;
};

// Energies of the coupling since the loop, or its recording, began [J]; 0 before the first tick.
// While there is no force, the proxy follows the device, and E_c counts what the hand stores in its
// walls.
struct LoopEnergy {
  // E_c: given by the coupling, with the device's own damping. A passive one's is 0 at most as long
  // as all force is on. Force that is off, fades or is held back raises it, because walls then
  // store what no motor took from the hand: `port` and `reserve` say what the hand was given.
  double controller = 0;
  double commanded = 0;  // Part of E_c by motors and proxy.
  double port = 0;       // Given to the human by motors and own damping.
  // Left to give, by the law's account; 0 without an account. Near 0 and below, where there is a
  // debt, the law holds walls back until the device has given energy again.
  double reserve = 0;
};

// Settings, rows, energies and recording of either kind of loop. A loop that was moved from may
// only be assigned to or destroyed.
class LIMPID_API Loop {
 public:
  ~Loop();

  std::size_t joints() const;
  double period() const;  // T [s]
  // Sentences on what was mended, guessed, fitted or left out of arm, scene and models.
  const std::vector<std::string>& notes() const;
  // Says why the law with its present settings is not passive, as "eta is below eta_min 0.5204,
  // equation (25)"; empty if it is, or if no theory is known.
  std::string not_passive_text() const;

  // Settings. Errors: no such key; a value that is not allowed; a key that is fixed once the loop
  // is made (SettingInfo::live).
  void set(const std::string& key_value);             // "coupling.kind=standard"
  void set(std::span<const std::string> key_values);  // all of them or none
  void set(std::string_view key, double value);       // of a number or a flag; does not allocate
  double get(std::string_view key) const;  // of a choice the place of its word; NaN: the arm's own

  // The row of the last tick, which recordings keep. NaN stands for what nobody knows, and for all
  // of it before the first tick.
  const std::vector<RowColumn>& columns() const;
  std::span<const double> row() const noexcept;
  std::span<const double> row(std::string_view path) const;  // Errors: no such column.
  // Columns that recordings have besides: where the tips are and how fast they move, and the total
  // force of the contacts. derived() computes them from a row of this loop; their offsets are in
  // what it returns.
  const std::vector<RowColumn>& derived_columns() const;
  std::array<double, 15> derived(std::span<const double> row) const noexcept;
  Point3 contact_force() const noexcept;  // sum of all contacts on the proxy in the last tick [N]
  double time() const noexcept;           // t_k since start or recording began [s]; 0 before a tick
  Point3 tip() const noexcept;            // of the device, after the tick [m]
  Point3 proxy_tip() const noexcept;  // of the proxy, and of the device before the first tick [m]
  LoopEnergy energy() const noexcept;
  // True once the loop was unstable: force is off, and stays off.
  bool diverged() const noexcept;

  // Records every row from the coming tick on into a session, an HDF5 file whose name ends in .h5.
  // A recording that is begun while force fades in waits for the end of the fade; one that runs
  // goes on. A thread of its own writes. With simulated motors a tick waits where the disk is
  // slower; with real ones rows that find no room are lost, and counted. Errors: another ending;
  // the file exists and not `replace`; it cannot be written.
  void record(const std::string& file, bool replace = false);
  // Ends the recording and returns the number of lost rows. Without it FILE.part is left, which
  // `limpid recover` mends. Errors: a write failed; nothing was being recorded.
  std::uint64_t finish_recording();

 protected:
  Loop(Loop&&) noexcept;
  Loop& operator=(Loop&&) noexcept;
  struct __attribute__((visibility("hidden"))) State;
  explicit Loop(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// A loop round a device of your own, or a simulation of one: it reads positions and returns
// torques.
class LIMPID_API DeviceLoop : public Loop {
 public:
  // With simulated motors `fresh`, `hand` and `fault` are not looked at; a reading that is not
  // finite, or of another number of joints, gives no torque and leaves the loop as it is. Positions
  // of a reading that is not fresh are not looked at after the first, and may be empty.
  struct Reading {
    KeptNumbers position;  // of each joint, now
    // False: the same reading as at the last tick. Force ends where none is fresh for 5 ms.
    bool fresh = true;
    bool hand = true;    // False: the dead-man switch is open; force waits.
    bool fault = false;  // True: the device is not well; force trips until it is armed again.
    // Time since the last tick [s]. 0: measured by the library with real motors, one period with
    // simulated ones. More than 5 ms is a stall, after which force fades in anew. A loop that gives
    // its own time has to measure it, or its stalls are not seen. Not finite or below 0: a fault.
    // Law and row count the nearest number of whole periods, at least one; limits of speed and
    // energy count the time itself.
    // Real motors trip where ticks come more than a tenth faster than `period` says; a loop that
    // makes up for more than 50 ms of ticks it missed does so, too.
    double elapsed = 0;
  };

  // `position`: of each joint now, where the proxy begins. notes() say which joint is outside of
  // its range. Errors: LoopError, also for a joint that is outside by more than a tenth of its
  // range.
  DeviceLoop(const LoopOptions& options, std::span<const double> position);

  // Runs the tick and returns each joint's torque or force, to be held until the next one; valid
  // until then. With real motors force trips where a reading is not finite, far outside of the
  // range, of another number of joints, or further from the last one than 100 rad/s or 10 m/s make
  // in the time between and 5 ms more (0.6 rad at 1 kHz); smaller jumps count as speed. Force also
  // fades where readings stay the same to the bit for 0.3 s while the motors push, and trips after
  // 0.6 s. If your
  // loop hangs, the last torque stays: let the device's own watchdog end what is not renewed within
  // 5 to 20 ms.
  std::span<const double> tick(const Reading& reading) noexcept;

  // Ask for force, and end it; heard at the next tick. A cut wins over every arm() before that
  // tick. Whoever calls arm() answers for a person who holds the device.
  void arm() noexcept;
  void cut() noexcept;
  bool armed() const noexcept;  // asked for, and not cut since, as heard so far; also after a trip
  double force_share() const noexcept;  // part of the torque that leaves, 0 to 1
  // Why there is no force, or less; empty while all of it is on. "held back" returns by itself, and
  // so does "off" by an open hand switch; "off" by anything else returns after arm(). Of force that
  // is on it also says that it fades in, that the law's account holds walls or all force back, that
  // a motor gives all it can, and that ticks come at another pace than `period` says.
  std::string force_text() const;
};

// A loop of the library's simulated arm, which a simulated hand leads: what `limpid run` does.
class LIMPID_API SimulatedLoop : public Loop {
 public:
  struct Hand {
    Point3 target{};       // where it wants the tip [m]
    double grip = 1;       // 1 holds, 0 has let go; scales stiffness and damping
    bool magnet = false;   // picks up objects that may be picked up
    KeptNumbers torque{};  // one a joint, pushed besides; of another size: none
  };

  // Begins at rest, in the middle of the joints' ranges. Errors: LoopError.
  explicit SimulatedLoop(const LoopOptions& options);

  // Begins anew, at rest, with the tip at `target`. Errors: out of reach; a recording is under way.
  void start(Point3 target);
  // Runs a tick of arm, hand and coupling; returns its row. A hand with a number that is not finite
  // counts as one that has let go.
  std::span<const double> step(const Hand& hand) noexcept;

  // Takes each row of run(); returning false ends it.
  using TakeRow = std::function<bool(std::span<const double> row)>;
  struct RunEnd {
    std::uint64_t rows = 0;
    bool diverged = false;
    std::string why;  // what was unstable, and when; else empty
    // Sentences on what else no run should do: the coupling gave energy, the tip moved as no hand
    // does.
    std::vector<std::string> warnings;
  };
  // Leads a hand along a path as fast as it goes, with the present settings: the rows of `limpid
  // run`, bit for bit. `path` has rows of time [s], x, y, z [m], at least two, of increasing time,
  // of which the first counts as 0; between them a monotone cubic leads. `duration` [s]; 0: the
  // path's. The loop itself stays as it is, so that threads may run one loop at once. Errors:
  // LoopError, and whatever `take` throws.
  RunEnd run(std::span<const double> path, double duration, const TakeRow& take) const;
};

}  // namespace limpid
