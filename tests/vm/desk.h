// A reference device on the desk and the running loop that holds it, as in the program.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

#include "app/live/live_loop.h"
#include "app/run/replay.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/urdf_file.h"
#include "devices/hid/device_list.h"
#include "tests/support/hid/pid_joystick_model.h"
#include "tests/support/hid/raw_device_model.h"
#include "tests/support/hid/space_mouse_model.h"
#include "tests/support/hid/uhid_device.h"
#include "tests/vm/leaning_hand.h"

namespace limpid::test {

using namespace std::chrono_literals;

inline constexpr Time kReport = 1ms;  // period of the reference devices
inline constexpr Time kReadingLife = 5ms + kReport;
inline constexpr Time kTickLife = 10ms;

inline double in_ms(Time time) { return std::chrono::duration<double, std::milli>(time).count(); }
inline void wait(Time time) { std::this_thread::sleep_for(time); }

template <class Done>
bool wait_until(Done done, Time longest = 3s) {
  for (const Time end = steady_now() + longest; steady_now() < end; wait(1ms)) {
    if (done()) return true;
  }
  return done();
}

inline ArmDescription joystick_arm() { return read_urdf("joystick.urdf"); }
inline SceneDocument joystick_gate() { return read_scene("joystick.toml", joystick_arm()); }

template <class Model>
std::unique_ptr<Model> make_model(double effort = kEffort) {
  if constexpr (std::is_base_of_v<PidJoystickModel, Model>) {
    PidJoystickOptions options = Model::usual_options();
    options.torque_limit = effort;
    options.physics = stick_axis(1);
    return std::make_unique<Model>(options);
  } else {
    return std::make_unique<Model>(
        RawDeviceLayout{.joints = 2, .torque_limit = effort, .physics = stick_axis(1)});
  }
}

// Finds the one device of this kind; a replugged one may take a moment.
inline FoundDevice find_device(std::string_view kind) {
  std::vector<FoundDevice> found;
  wait_until([&] {
    found = list_devices({.udev_rule = "rules"});
    std::erase_if(found, [&](const FoundDevice& one) { return one.kind->key != kind; });
    return !found.empty();
  });
  if (found.empty()) throw std::runtime_error("the device is not listed");
  return found.front();
}

template <class Model>
class Desk {
 public:
  static constexpr bool kPid = std::is_base_of_v<PidJoystickModel, Model>;

  Desk() : Desk(make_model<Model>()) {}
  explicit Desk(std::unique_ptr<Model> one) : model(std::move(one)) {
    model->hand().axis(0) = stick_axis(0);
    model->hand().axis(0).path = lean_right;
    device = std::make_unique<UhidDevice>(*model);
  }

  static std::unique_ptr<Device> connect(double effort = kEffort) {
    PidSettings settings{.range = kRange, .effort = effort};
    if constexpr (kPid) settings.reverse = Model::kReversed;
    return open_device(find_device(kPid ? "pid" : "raw"), settings);
  }
  void open() { open(connect()); }
  void open(std::unique_ptr<Device> one) {
    await_reading(*one, 200ms);
    loop.open(arm, document.scene, controls.parameters(), std::move(one));
    window = std::jthread([this](const std::stop_token& closed) {
      while (!closed.stop_requested()) {
        if (!hangs) {
          const std::lock_guard lock(mutex);
          loop.set(controls);
        }
        std::this_thread::sleep_for(16ms);
      }
    });
  }
  void arm_force(bool on) { on ? loop.arm() : loop.cut(); }
  void record(const std::filesystem::path& out, const RunPlan& plan) {
    loop.record(std::make_unique<Recorder>(out, session_info(plan), plan.parameters, true));
  }
  // Waits until the stick leans on the gate's side and is pushed back.
  bool push() {
    arm_force(true);
    return wait_until([&] { return torque() < -0.1; });
  }
  // Torque of the motors on the first axis [N m].
  double torque() {
    return device->with([&](Time) { return model->forces().newest()[0]; });
  }
  ForceState force_state() {
    loop.update();
    return loop.snapshot().force_state;
  }
  // Calls `failure` on the device; time from then until it had no force, if within 100 ms.
  std::optional<Time> time_to_zero(const std::function<void(Time)>& failure) {
    const Time moment = device->with([&](Time now) {
      failure(now);
      return now;
    });
    wait(100ms);
    return zero_after(moment);
  }
  std::optional<Time> zero_after(Time moment) {
    return device->with([&](Time) { return model->forces().zero_after(moment); });
  }

  ArmDescription arm = joystick_arm();
  SceneDocument document = joystick_gate();
  std::unique_ptr<Model> model;
  std::unique_ptr<UhidDevice> device;
  // Changes the window's settings from its next frame on.
  void set(const std::function<void(Controls&)>& change) {
    const std::lock_guard lock(mutex);
    change(controls);
  }

  Controls controls;
  std::mutex mutex;
  LiveLoop loop{{}};
  std::atomic<bool> hangs = false;  // the window makes no frames
  std::jthread window;
};

// Passes readings on, but keeps the loop waiting while `stalled`.
class Stalling final : public Device {
 public:
  Stalling(std::unique_ptr<Device> device, const std::atomic<bool>& stalled)
      : device_(std::move(device)), stalled_(stalled) {}
  const DeviceTraits& traits() const override { return device_->traits(); }
  bool read(DeviceReading& newest) noexcept override {
    while (stalled_) std::this_thread::sleep_for(100us);
    return device_->read(newest);
  }
  void write(std::span<const double> torque) noexcept override { device_->write(torque); }
  void stop() noexcept override { device_->stop(); }

 private:
  std::unique_ptr<Device> device_;
  const std::atomic<bool>& stalled_;
};

// Prints one line of the table of measured times.
inline void print_time(const std::string& what, std::optional<Time> zero, Time limit) {
  std::printf("| %-48s | %7.2f ms | %5.1f ms |\n", what.c_str(), zero ? in_ms(*zero) : NAN,
              in_ms(limit));
}

}  // namespace limpid::test
