// The Inverse3 as the loop uses it, over a real connection, against a stand-in of its service.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "devices/hid/device_list.h"
#include "devices/hid/hid_transport.h"
#include "devices/simulated/rig.h"
#include "tests/support/inverse_service.h"
#include "tests/support/random_arm.h"
#include "tests/support/until.h"

namespace limpid {
namespace {

using namespace std::chrono_literals;
using test::InverseService;

bool pushes(const std::string& line) { return line.starts_with("force") && line != "force 0 0 0"; }

std::unique_ptr<Device> open_inverse(const ServiceAddress& address, const std::string& id = {}) {
  const auto found = list_inverse_devices(InverseName{id, address}, address);
  if (found.empty()) throw HidError("none");
  return open_device(found.back());
}

// Takes the loop's part: a tick about every millisecond, until the condition holds.
bool turn(Device& device, const std::vector<double>& torque,
          const std::function<bool(const DeviceReading&, bool here)>& done) {
  const auto read = [&] {
    DeviceReading reading;
    const bool here = device.read(reading);
    return done(reading, here);
  };
  return test::until(read, [&] {
    device.write(torque);
    std::this_thread::sleep_for(1ms);
  });
}

// Ticks for so many milliseconds as if nothing had happened; returns whether the condition held.
bool turn_for(Device& device, int ticks, const std::function<bool()>& holds) {
  for (int i = 0; i < ticks; ++i) {
    DeviceReading reading;
    device.read(reading);
    device.write(std::vector{0.1, 0.0, -0.05});
    if (holds()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return false;
}

struct AnInverseService : testing::Test {
  // Returns when a force is on the device.
  void push(Device& device) {
    bool any = false;
    std::thread listener([&] {
      service.wait_for(pushes);
      any = true;
      service.tell("count");
    });
    EXPECT_TRUE(turn(device, {0.1, 0, -0.05}, [&](auto&, bool) { return any; }));
    listener.join();
  }

  InverseService service;
};

TEST_F(AnInverseService, MovesAsItsForcePushesIt) {
  service.tell("spring 100");
  const auto device = open_inverse(service.address());
  EXPECT_TRUE(turn(*device, {0.1, 0, -0.05}, [](const DeviceReading& r, bool) {  // 1 N, -0.5 N
    return std::abs(r.x[0] - 0.1) < 1e-6 && std::abs(r.x[2] - (1.6 - 0.05)) < 1e-6;
  }));
  EXPECT_EQ(device->traits().id, "inverse3:049D@" + service.address().text());
}

TEST_F(AnInverseService, HasAZeroForceBeforeItIsLetGo) {
  {
    const auto device = open_inverse(service.address());
    push(*device);
  }
  service.wait_for("force 0 0 0");
  service.wait_for("end");
}

TEST_F(AnInverseService, HasAZeroForceOnceTheLoopStands) {
  const auto device = open_inverse(service.address());
  push(*device);
  service.wait_for("force 0 0 0");
}

TEST_F(AnInverseService, HasAZeroForceOnceNobodyAsks) {
  const auto device = open_inverse(service.address());
  push(*device);
  device->stop();
  service.wait_for("force 0 0 0");
}

TEST_F(AnInverseService, ThatFallsSilentHasAZeroForceAndGivesOldReadings) {
  const auto device = open_inverse(service.address());
  push(*device);
  service.tell("silent");
  EXPECT_TRUE(turn(*device, {0.1, 0, 0}, [](const DeviceReading& r, bool here) {
    return here && r.age > 0.05 && r.lapses > 0;
  }));
  service.wait_for("force 0 0 0");
  service.tell("answer");
  DeviceReading before;
  device->read(before);
  EXPECT_TRUE(turn(*device, {0, 0, 0}, [&](const DeviceReading& r, bool) {
    return r.count > before.count + 10;
  })) << "it goes on by itself, without force";
}

TEST_F(AnInverseService, ThatTalksNonsenseHasAZeroForce) {
  for (const char* words :
       {"nonsense", R"({"inverse3":[]})",
        R"({"inverse3":[{"device_id":"04BA","state":{"cursor_position":{"x":0,"y":0,"z":0}}}]})"}) {
    service.tell("answer");
    const auto device = open_inverse(service.address());
    push(*device);
    service.tell(std::string("say ") + words);
    EXPECT_TRUE(turn(*device, {0.1, 0, 0},
                     [](const DeviceReading& r, bool here) { return here && r.lapses > 0; }));
    service.wait_for("force 0 0 0");
  }
}

// The loop with its safety, tick by tick; a stop pushes the device's first axis back.
TEST_F(AnInverseService, ThatRepeatsItsLastCursorHasNoForceAfterAWhile) {
  service.tell("spring 400");
  const auto device = open_inverse(service.address());
  ASSERT_TRUE(turn(*device, {0, 0, 0}, [](const DeviceReading& r, bool) { return r.count > 0; }));
  ArmDescription arm = test::random_arm(3, 71, test::Slides::all);
  for (std::size_t i = 0; i < 3; ++i) {
    arm.joints[i].origin = Pose::Identity();
    arm.joints[i].axis = Vec3::Unit(static_cast<Eigen::Index>(i));
    arm.joints[i].lower = -4;
    arm.joints[i].upper = 4;
    arm.joints[i].effort = 0.4;
  }
  Scene scene;
  scene.add({.name = "stop", .shape = JointStop{0, -0.02, 1}, .material = {20}});
  Rig rig(arm, scene, device.get());
  RigStart start;
  start.x1 = start.v1 = start.x2 = start.v2 = start.f1_hat = Eigen::Vector3d::Zero();
  rig.start({}, start);
  std::vector<double> row(static_cast<std::size_t>(rig.layout().stride()));
  const auto run = [&](ForceRequest wish, const std::function<bool()>& until,
                       std::chrono::seconds most = 60s) {
    const auto end = std::chrono::steady_clock::now() + most;
    while (!until() && std::chrono::steady_clock::now() < end) {
      // A busy machine sometimes stands still for more than 5 ms.
      const ForceState why = rig.force_state();
      const bool late = why == ForceState::stale || why == ForceState::stalled;
      if (late && rig.force().state() == Arming::tripped) wish = ForceRequest::arm;
      rig.step({}, {.hand = {rig.tip(), 1}, .force = std::exchange(wish, ForceRequest::as_it_is)},
               row);
      std::this_thread::sleep_for(1ms);
    }
    return until();
  };
  ASSERT_TRUE(run(ForceRequest::arm, [&] { return rig.force().gain() == 1; }));
  int ticks = 0;
  EXPECT_TRUE(run(ForceRequest::as_it_is, [&] {
    return ++ticks > 2000 && rig.force().gain() > 0.5;
  })) << "it is held still, but gives way as its force fades";
  // The repeated cursor may date from a moment at which the force had faded: then another try is
  // made.
  const auto tripped = [&] {
    return rig.force_state() == ForceState::frozen && rig.force().state() == Arming::tripped;
  };
  bool stopped = false;
  for (int i = 0; i < 20 && !stopped; ++i) {
    service.tell("answer");
    EXPECT_TRUE(run(ForceRequest::as_it_is, [&] { return rig.force().gain() == 1; }));
    service.wait_for(pushes);
    service.tell("repeat");
    stopped = run(ForceRequest::as_it_is, tripped, 3s);
  }
  EXPECT_TRUE(stopped);
  service.wait_for("force 0 0 0");
  ticks = 0;
  EXPECT_TRUE(run(ForceRequest::arm, [&] {
    return ++ticks > 700 && rig.force_state() == ForceState::frozen;
  })) << "armed again, but not moved";
  EXPECT_EQ(rig.force().gain(), 0);
}

// A service that answers after 20 ms must not get a queue of forces.
TEST_F(AnInverseService, ThatIsSlowIsNotFlooded) {
  const auto device = open_inverse(service.address());
  EXPECT_TRUE(turn(*device, {0, 0, 0}, [](const DeviceReading& r, bool) { return r.count > 0; }));
  service.tell("slow 0.02");
  DeviceReading before;
  device->read(before);
  service.tell("count");
  const std::string first =
      service.wait_for([](const auto& l) { return l.starts_with("messages"); });
  EXPECT_TRUE(turn(*device, {0.1, 0, 0},
                   [&](const DeviceReading& r, bool) { return r.count >= before.count + 20; }));
  service.tell("count");
  const std::string second =
      service.wait_for([](const auto& l) { return l.starts_with("messages"); });
  // Each answer allows one command; zeros do not wait for it.
  EXPECT_LE(std::stoi(second.substr(9)) - std::stoi(first.substr(9)), 2 * 20 + 10);
}

TEST_F(AnInverseService, ThatDropsTheConnectionIsLostAndCanBeHadAgain) {
  auto device = open_inverse(service.address());
  push(*device);
  service.tell("drop");
  EXPECT_TRUE(turn(*device, {0.1, 0, 0}, [](auto&, bool here) { return !here; }));
  device.reset();
  device = open_inverse(service.address());
  DeviceReading reading;
  EXPECT_TRUE(turn(*device, {0, 0, 0}, [](const DeviceReading& r, bool) { return r.count > 0; }));
  push(*device);
}

TEST_F(AnInverseService, ThatIsStartedAnewIsAnotherConnection) {
  auto device = open_inverse(service.address());
  push(*device);
  service.end();
  EXPECT_TRUE(turn(*device, {0.1, 0, 0}, [](auto&, bool here) { return !here; }));
  device.reset();
  EXPECT_TRUE(list_inverse_devices({}, service.address()).empty());
  InverseService again(service.address().port);
  device = open_inverse(again.address());
  EXPECT_TRUE(turn(*device, {0, 0, 0}, [](const DeviceReading& r, bool) { return r.count > 0; }));
}

TEST_F(AnInverseService, ThatIsToldAnotherFrameMeanwhileHasAZeroForce) {
  const auto device = open_inverse(service.address());
  push(*device);
  service.tell(R"(merge {"config": {"basis": {"permutation": "XZY"}}})");
  EXPECT_TRUE(turn(*device, {0.1, 0, 0}, [](const DeviceReading& r, bool) { return r.fault; }));
  const auto pushed = [&] { return turn_for(*device, 100, [&] { return service.heard(pushes); }); };
  service.wait_for("force 0 0 0");
  // This zero may be of a stall of this computer: forces sent before the fault came after it.
  if (pushed()) service.wait_for("force 0 0 0");
  service.tell("count");
  EXPECT_FALSE(pushed());
}

// Any name of the address counts: a second stream of forces would pull the device to and fro.
TEST_F(AnInverseService, IsHadByOneAndHearsNothingOfAnother) {
  const auto device = open_inverse(service.address());
  push(*device);
  const ServiceAddress other_name{"localhost", service.address().port};
  for (const ServiceAddress& address : {service.address(), other_name}) {
    FoundDevice found = list_inverse_devices({}, service.address()).at(0);
    found.place.id = InverseName{"049D", address}.text();
    try {
      open_device(found);
      FAIL();
    } catch (const HidError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("in use by process"));
    }
  }
  // The service says "session" for each connection that sends something.
  EXPECT_FALSE(turn_for(*device, 100, [&] {
    return service.heard(
        [](const std::string& line) { return line == "session" || line == "end"; });
  })) << "no other began to send, and the first has not ended";
  push(*device);
}

TEST_F(AnInverseService, OfWhichNoDeviceIsNamedIsClaimedAsItsFirst) {
  const FoundDevice first = list_inverse_devices({}, service.address()).at(0);
  FoundDevice unnamed = first;
  unnamed.place.id = InverseName{"", service.address()}.text();
  EXPECT_EQ(unnamed.claim_key(unnamed), first.claim_key(first));
  service.tell("devices 049D 04BA");
  const auto both = list_inverse_devices({}, service.address());
  ASSERT_EQ(both.size(), 2u);
  EXPECT_NE(both[0].claim_key(both[0]), both[1].claim_key(both[1])) << "each has one of its own";
}

TEST_F(AnInverseService, HasAZeroForceWhenWeAreKilled) {
  const pid_t child = fork();
  if (child == 0) {
    const auto device = open_inverse(service.address());
    turn(*device, {0.1, 0, 0}, [](auto&, bool) { return false; });
    _exit(1);
  }
  service.wait_for(pushes);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  service.wait_for("force 0 0 0");
  service.wait_for("end");
}

}  // namespace
}  // namespace limpid
