// Devices behind their protocol are found out, in simulated time.
#include <gtest/gtest.h>

#include "devices/identify/excitation.h"
#include "tests/support/built_in.h"
#include "tests/vm/simulated_desk.h"
#include "tests/vm/unlike_stick.h"

namespace limpid::test {
namespace {

using namespace std::chrono_literals;

struct Trial {
  unsigned seed;
  int bits;
  Time lag;
};

class SimulatedIdentify : public testing::TestWithParam<Trial> {
 protected:
  // Readings at each whole millisecond, the tick in the middle, its torque out with the next.
  void tick() {
    link_.transport.arrive(model_->input(now_));
    now_ += 50us;
    link_.exchange.step();
    now_ += 450us;
    DeviceReading reading;
    const bool here = link_.read(reading);
    const auto x = std::span(reading.x).first(2);
    const auto torque = motion_.step({x, 1e-3, {.guarded = true, .lost = !here}});
    link_.write(torque);
    x_.emplace_back(x[0], x[1]);
    torque_.emplace_back(torque[0], torque[1]);
    now_ += 500us;
  }

  const ArmDescription arm_ = read_urdf(assets_dir() / "devices/joystick.urdf");
  const UnlikeStick stick_{GetParam().seed, GetParam().bits, GetParam().lag};
  std::unique_ptr<RawDeviceModel> model_ = stick_.made();
  Time now_ = std::chrono::hours(1);
  const bool powered_ = (model_->power(true, now_), true);
  SimulatedLink link_{*model_, std::make_unique<RawProtocol>(), now_};
  Excitation motion_{arm_, link_.traits(), {}};
  std::vector<Eigen::Vector2d> x_, torque_;
};
INSTANTIATE_TEST_SUITE_P(Sticks, SimulatedIdentify,
                         testing::Values(Trial{1, 16, 1ms}, Trial{2, 10, 1ms}, Trial{3, 16, 4ms},
                                         Trial{4, 10, 4ms}, Trial{5, 10, 2ms}, Trial{6, 10, 3ms}));

TEST_P(SimulatedIdentify, FindsWhatTheStickIs) {
  while (motion_.end() == ExcitationEnd::running) tick();
  ASSERT_EQ(motion_.end(), ExcitationEnd::complete)
      << explain(motion_.end()) << ", " << explain(motion_.objection()) << " after "
      << motion_.time() << " s, joint " << motion_.joint();
  MotionRecord record;
  record.x.resize(static_cast<Eigen::Index>(x_.size()), 2);
  record.torque.resizeLike(record.x);
  for (std::size_t i = 0; i < x_.size(); ++i) {
    record.x.row(static_cast<Eigen::Index>(i)) = x_[i];
    record.torque.row(static_cast<Eigen::Index>(i)) = torque_[i];
  }
  stick_.expect_found(identify(arm_, record, {.gravity = Vec3(0, 0, -9.81)}), 1.05e-3);
  EXPECT_TRUE(model_->violations().empty()) << model_->violations()[0];
  EXPECT_LE(model_->forces().largest(), ExcitationPlan{}.torque * kEffort * (1 + 1e-6));
}

}  // namespace
}  // namespace limpid::test
