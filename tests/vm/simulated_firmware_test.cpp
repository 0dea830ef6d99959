// The PID protocol spoken to each firmware that people own, in simulated time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "devices/hid/hid_transport.h"
#include "tests/vm/simulated_desk.h"

namespace limpid::test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::IsEmpty;

template <class Model>
struct Firmware : testing::Test {
  Firmware() { plug_in(Model::usual_options()); }
  void plug_in(PidJoystickOptions options) {
    options.torque_limit = kEffort;
    options.physics = stick_axis(1);
    model = std::make_unique<Model>(options);
    model->power(true, now);
  }
  void connect() {
    link = std::make_unique<SimulatedLink>(
        *model,
        std::make_unique<PidJoystick>(
            parse_report_descriptor(model->report_descriptor()),
            PidSettings{.range = kRange, .effort = kEffort, .reverse = Model::kReversed}),
        now);
  }
  std::string complaint() {
    try {
      connect();
    } catch (const HidError& error) {
      return error.what();
    }
    return "none";
  }
  // Commands `torque` for so many milliseconds; returns the motors' torque at the end.
  Torque push(std::array<double, 2> torque, int milliseconds = 20) {
    for (int i = 0; i < milliseconds; ++i, now += 1ms) {
      link->transport.arrive(model->input(now));
      link->write(torque);
      link->exchange.step();
    }
    return model->acting(now);
  }
  DeviceReading reading() {
    DeviceReading newest;
    EXPECT_TRUE(link->read(newest));
    return newest;
  }

  Time now = 1h;
  std::unique_ptr<Model> model;
  std::unique_ptr<SimulatedLink> link;
};
using Models = testing::Types<PidJoystickModel, ArduinoJoystick, FinoJoystick, OpenFfboardJoystick,
                              AdaptJoystick>;
TYPED_TEST_SUITE(Firmware, Models);

TYPED_TEST(Firmware, PushesAlongTheAxisThatIsAskedFor) {
  this->connect();
  // Rounding: none of 255 directions is 90 degrees, none of 127 magnitudes is 0.3.
  const double leak = 0.007 * 0.3, step = kEffort / 127;
  for (const double asked : {0.3, -0.3}) {
    const Torque x = this->push({asked, 0});
    EXPECT_NEAR(x[0], asked, step);
    EXPECT_NEAR(x[1], 0, leak);
    const Torque y = this->push({0, asked});
    EXPECT_NEAR(y[0], 0, leak);
    EXPECT_NEAR(y[1], asked, step);
    const Torque both = this->push({asked, -asked});
    EXPECT_NEAR(both[0], asked, step);
    EXPECT_NEAR(both[1], -asked, step + leak);
  }
  EXPECT_THAT(this->model->violations(), IsEmpty());
}

TYPED_TEST(Firmware, MovesTheStickToWhereItIsPushed) {
  this->connect();
  this->push({0.1, -0.05}, 500);
  const double stiffness = stick_axis(1).stiffness;
  EXPECT_NEAR(this->reading().x[0], 0.1 / stiffness, 2e-3);
  EXPECT_NEAR(this->reading().x[1], -0.05 / stiffness, 2e-3);
}

// A bit that is never set is no missing hand and no fault.
TYPED_TEST(Firmware, IsWellWhateverItLeavesUnsaid) {
  this->connect();
  this->push({0.1, 0}, 100);
  EXPECT_TRUE(this->reading().hand);
  EXPECT_FALSE(this->reading().fault);
}

TYPED_TEST(Firmware, StopsForGood) {
  this->connect();
  this->push({0.3, 0.3});
  EXPECT_TRUE(this->link->exchange.finish());
  EXPECT_EQ(this->model->acting(this->now), Torque{});
  EXPECT_FALSE(this->model->actuators());
  EXPECT_THAT(this->model->effects(), IsEmpty());
  EXPECT_THAT(this->model->violations(), IsEmpty());
}

TYPED_TEST(Firmware, EndsItsForceByItselfWithinTheEffectsTime) {
  this->connect();
  this->push({0.3, 0});
  const Time silence = this->now;
  for (; this->now < silence + 30ms; this->now += 1ms) this->model->input(this->now);
  const auto zero = this->model->forces().zero_after(silence);
  ASSERT_TRUE(zero);
  EXPECT_LE(*zero, 11ms);
}

// The reset removes the effects that an earlier program has left.
TYPED_TEST(Firmware, HasRoomAgainAfterAnotherProgramLeftItFull) {
  const auto options = TypeParam::usual_options();
  for (int i = 0; i < options.capacity; ++i) {
    this->connect();  // without ending the program before
    this->link.reset();
  }
  EXPECT_EQ(this->complaint(), "none");
  EXPECT_EQ(this->model->effects().size(), 2u);
}

TYPED_TEST(Firmware, SaysWhenItsPoolIsFull) {
  PidJoystickOptions options = TypeParam::usual_options();
  options.capacity = 1;
  this->plug_in(options);
  EXPECT_THAT(this->complaint(), HasSubstr("no memory left"));
}

TYPED_TEST(Firmware, SaysWhenItCannotMakeAnEffect) {
  PidJoystickOptions options = TypeParam::usual_options();
  options.fails_to_load = true;
  this->plug_in(options);
  EXPECT_THAT(this->complaint(), HasSubstr("cannot make an effect"));
}

template <class Model>
struct TellingFirmware : Firmware<Model> {};
using TellingModels =
    testing::Types<PidJoystickModel, ArduinoJoystick, FinoJoystick, AdaptJoystick>;
TYPED_TEST_SUITE(TellingFirmware, TellingModels);

TYPED_TEST(TellingFirmware, TellsThatTheHandLetGoOrThePowerFailed) {
  this->connect();
  this->push({0.1, 0});
  this->model->let_go(true);
  this->push({0.1, 0});
  EXPECT_FALSE(this->reading().hand);
  EXPECT_EQ(this->model->acting(this->now)[0], 0);
  this->model->let_go(false);
  this->push({0.1, 0});
  EXPECT_TRUE(this->reading().hand);
  this->model->lose_power(true);
  this->push({0.1, 0});
  EXPECT_TRUE(this->reading().fault);
  EXPECT_EQ(this->model->acting(this->now)[0], 0);
}

}  // namespace
}  // namespace limpid::test
