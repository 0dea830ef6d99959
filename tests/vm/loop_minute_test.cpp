// A minute of the proposed coupling on the virtual joystick, against the same hand on the virtual
// arm.
#include <gtest/gtest.h>

#include "app/run/replay.h"
#include "tests/support/rows.h"
#include "tests/support/temp_dir.h"
#include "tests/vm/desk.h"

namespace limpid::test {
namespace {

constexpr double kMinute = 60;   // [s]
constexpr double kRest = 1.5;    // of the hand, before it moves [s]
constexpr double kLean = 0.28;   // its furthest, behind the gate's sides [rad]
constexpr double kTurns = 0.37;  // a second
constexpr double kPi = 3.14159265358979323846;

// Around and around, into all four sides and along them.
double hand_path(int axis, double t) {
  const double s = std::max(t - kRest, 0.0);
  const double grow = std::min(s, 1.0) * std::min(s, 1.0);
  const double turn = axis == 0 ? kTurns : 0.61 * kTurns;
  return kLean * grow * std::sin(2 * kPi * turn * s);
}

// Also says when each reading was taken.
class Watched final : public Device {
 public:
  explicit Watched(std::unique_ptr<Device> device, std::vector<Time>& times)
      : device_(std::move(device)), times_(times) {}
  const DeviceTraits& traits() const override { return device_->traits(); }
  bool read(DeviceReading& newest) noexcept override {
    if (times_.size() < times_.capacity()) times_.push_back(steady_now());
    return device_->read(newest);
  }
  void write(std::span<const double> torque) noexcept override { device_->write(torque); }
  void stop() noexcept override { device_->stop(); }

 private:
  std::unique_ptr<Device> device_;
  std::vector<Time>& times_;
};

// The device's two independent axes with the same hand, as joint torques on the virtual arm.
Rows virtual_run(const ArmDescription& arm, const Scene& scene, const AxisPhysics& hand,
                 const std::vector<double>& times) {
  Rig rig(arm, scene);
  rig.start({}, rest_at(arm, Vec3(0, 0, 0.12)));
  Rows rows(rig.layout());
  std::array<double, 2> x{}, v{};
  for (const double t : times) {
    std::array<double, 2> torque{};
    for (std::size_t i = 0; i < 2; ++i) {
      const int axis = static_cast<int>(i);
      const double target = hand_path(axis, t);
      const double speed = (hand_path(axis, t + 1e-4) - target) / 1e-4;
      torque[i] = hand.stiffness * (target - x[i]) + hand.damping * (speed - v[i]);
    }
    const auto row = rows.add();
    rig.step({}, {{rig.tip(), 0, torque}, true}, row);
    RigStart now = rest_at(arm, Vec3(0, 0, 0.12));
    rig.present(now);
    for (std::size_t i = 0; i < 2; ++i) {
      x[i] = now.x1[static_cast<Eigen::Index>(i)];
      v[i] = now.v1[static_cast<Eigen::Index>(i)];
    }
  }
  return rows;
}

struct Minute {
  std::vector<double> times;  // of the rows, in the hand's time [s]
  Session session;
};

Minute run_on_device(Desk<PidJoystickModel>& desk) {
  const TempDir dir;
  Minute minute;
  std::vector<Time> reads;
  reads.reserve(100'000);
  const Time start = desk.device->with([&](Time now) {
    for (int axis = 0; axis < 2; ++axis) {
      desk.model->hand().axis(axis).path = [axis](double t) { return hand_path(axis, t); };
    }
    desk.model->hand().begin(now);
    return now;
  });
  desk.open(std::make_unique<Watched>(desk.connect(), reads));
  desk.arm_force(true);
  RunPlan plan;
  plan.arm = desk.arm;
  plan.scene = desk.scene;
  plan.hand.source = "device";
  desk.loop.record(dir / "a.h5", session_info(plan), plan.parameters, true);
  wait(std::chrono::seconds(static_cast<int>(kMinute + kRest)));
  EXPECT_EQ(desk.force_state(), ForceState::on);
  EXPECT_EQ(desk.loop.recorder()->dropped(), 0u);
  desk.loop.stop_recording();
  const LoopStatus status = desk.loop.status();
  EXPECT_EQ(status.missed, 0);
  desk.loop.close();
  minute.session = read_session(dir / "a.h5");

  // The trace has every tick from the first on; the recording's are those after the restart of
  // its time.
  const RowLayout layout = minute.session.layout;
  const auto stride = static_cast<std::size_t>(layout.stride());
  std::vector<double> early(8192 * stride);
  const std::size_t count = desk.loop.drain(early);
  std::size_t first = 1;
  while (first < count && layout.in(std::span<const double>(early).subspan(first * stride, stride),
                                    Column::time)[0] > 0) {
    ++first;
  }
  for (std::size_t k = 0; k < minute.session.size(); ++k) {
    minute.times.push_back(std::chrono::duration<double>(reads.at(first + k) - start).count());
  }
  return minute;
}

// What the two may differ by [N m]. The virtual arm sees its angle and pushes at once; here the
// newest reading is up to 1 ms old when the tick takes it, and the torque waits up to 1 ms for the
// next turn of the I/O thread. So the torque follows up to 2 ms later:
//   - leaning, it changes with the hand's speed through the springs in series, hand (2), coupling
//     (10) and gate (600 N/m at 0.12 m), and its dampers;
//   - the axes count 65534 steps over 0.7 rad and the magnitude 10000 over the effort.
// The independent axes of the device lack what couples the arm's: at x2 the first axis is lighter
// by 2.8e-4 sin(x2)^2 of 3.2e-4, a twentieth at most, and its inertial torque is part of what the
// hand and not the motor balances.
double allowed_difference(const AxisPhysics& hand) {
  const double gate = 600 * 0.12 * 0.12, coupling = 10;
  const double contact = gate * coupling / (gate + coupling);
  const double series = contact * hand.stiffness / (contact + hand.stiffness);
  const double speed = 2 * kPi * kTurns * kLean;
  const double delay = 2e-3 * speed * series;
  const double axis_step = coupling * 2 * kRange / 65534;
  const double force_step = kEffort / 10000;
  return delay + axis_step + force_step;
}

TEST(PidLoop, AgreesWithTheVirtualArmForAMinute) {
  Desk<PidJoystickModel> desk;
  const AxisPhysics hand = stick_axis(1);
  const Minute minute = run_on_device(desk);
  ASSERT_GE(minute.session.size(), 60'000u);
  desk.device->with([&](Time) {
    EXPECT_TRUE(desk.model->violations().empty()) << desk.model->violations()[0];
  });
  const Rows rows = virtual_run(desk.arm, desk.scene, hand, minute.times);
  double largest = 0, difference = 0, squares = 0;
  std::size_t worst = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto device = minute.session.at(k, Column::motor_torque);
    const auto ideal = rows.vec(k, Column::motor_torque);
    for (std::size_t i = 0; i < 2; ++i) {
      const double error = std::abs(device[i] - ideal[static_cast<Eigen::Index>(i)]);
      largest = std::max(largest, std::abs(device[i]));
      squares += error * error;
      if (error > difference) {
        difference = error;
        worst = k;
      }
    }
  }
  const double rms = std::sqrt(squares / (2.0 * static_cast<double>(rows.size())));
  const double allowed = allowed_difference(hand);
  std::printf("| %zu ticks, torque up to %.3f N m, difference at most %.2f (at %.3f s), rms %.3f, "
              "allowed %.2f mN m\n",
              rows.size(), largest, 1e3 * difference, 1e-3 * static_cast<double>(worst), 1e3 * rms,
              1e3 * allowed);
  EXPECT_GT(largest, 0.1);
  EXPECT_LT(rms, allowed);
  EXPECT_LT(difference, 5 * allowed);
}

}  // namespace
}  // namespace limpid::test
