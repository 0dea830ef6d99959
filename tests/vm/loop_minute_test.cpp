// A minute of the proposed coupling on the virtual joystick, against the same hand on the virtual
// arm.
#include <gtest/gtest.h>

#include "tests/support/rows.h"
#include "tests/support/temp_dir.h"
#include "tests/vm/desk.h"

namespace limpid::test {
namespace {

constexpr double kMinute = 60;  // [s]

// A device that notes the time of each reading.
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

struct Minute {
  std::vector<double> times;  // times of the rows, on the hand's clock [s]
  Session session;
};

template <class Model>
Minute run_on_device(Desk<Model>& desk) {
  const TempDir dir;
  Minute minute;
  std::vector<Time> reads;
  reads.reserve(100'000);
  const Time start = desk.device->with([&](Time now) {
    for (int axis = 0; axis < 2; ++axis) {
      desk.model->hand().axis(axis).path = [axis](double t) { return Circling::path(axis, t); };
    }
    desk.model->hand().begin(now);
    desk.model->forces().expect(1'000'000);
    return now;
  });
  desk.open(std::make_unique<Watched>(desk.connect(), reads));
  desk.arm_force(true);
  RunPlan plan;
  plan.arm = desk.arm;
  plan.document = desk.document;
  plan.hand.source = "device";
  desk.record(dir / "a.h5", plan);
  wait(std::chrono::seconds(static_cast<int>(kMinute + Circling::kRest)));
  EXPECT_EQ(desk.force_state(), ForceState::on);
  EXPECT_EQ(desk.loop.recorder()->dropped(), 0u);
  // Read before the recording is finished: on the machine's one processor that delays the loop.
  EXPECT_LE(desk.loop.status().slipped, 6);
  desk.loop.finish_recording();
  desk.loop.close();
  minute.session = read_session(dir / "a.h5");

  // Times exist for every tick from the first on; the recording begins after the restart of its
  // time.
  const RowLayout layout = minute.session.layout;
  const auto stride = static_cast<std::size_t>(layout.stride());
  std::vector<double> early(8192 * kMostLanes * stride);
  const std::size_t count = desk.loop.drain(early);
  std::size_t first = 1;
  while (first < count &&
         layout.in(std::span<const double>(early).subspan(first * kMostLanes * stride, stride),
                   Column::time)[0] > 0) {
    ++first;
  }
  for (std::size_t k = 0; k < minute.session.size(); ++k) {
    minute.times.push_back(std::chrono::duration<double>(reads.at(first + k) - start).count());
  }
  return minute;
}

template <class Model>
struct PidMinute : testing::Test {};
using Models = testing::Types<ArduinoJoystick, FinoJoystick, OpenFfboardJoystick, AdaptJoystick>;
struct Names {
  template <class Model>
  static std::string GetName(int) {
    return name(Model::usual_options().firmware);
  }
};
TYPED_TEST_SUITE(PidMinute, Models, Names);

TYPED_TEST(PidMinute, AgreesWithTheVirtualArm) {
  Desk<TypeParam> desk;
  // Removes the bump: around its edge the torque changes faster than the hand moves.
  std::erase_if(desk.document.scene.objects, has_shape<Sphere>);
  const Minute minute = run_on_device(desk);
  ASSERT_GE(minute.session.size(), 60'000u);
  desk.device->with(
      [&](Time) { EXPECT_TRUE(desk.model->violations().empty()) << desk.model->violations()[0]; });
  Rows rows(minute.session.layout);
  for (std::size_t k = 0; k < minute.session.size(); ++k) rows.add(minute.session.row(k));
  const Difference d =
      difference(rows, circle_virtually(desk.arm, desk.document.scene, minute.times));
  // Two ticks of delay, and a tenth of a tick for the report's transfer.
  const Allowed allowed = allowed_difference(2.1e-3, TypeParam::kTorqueLevels);
  std::printf(
      "| %zu ticks, torque up to %.3f N m; difference rms %.3f (allowed %.2f), at most "
      "%.2f (allowed %.2f) mN m\n",
      rows.size(), d.largest_torque, 1e3 * d.rms, 1e3 * allowed.usual, 1e3 * d.worst,
      1e3 * allowed.touching);
  EXPECT_GT(d.largest_torque, 0.15);
  EXPECT_LT(d.rms, allowed.usual);
  EXPECT_LT(d.worst, allowed.touching);
}

}  // namespace
}  // namespace limpid::test
