// The Inverse3 as the loop has it, over a real connection, against a stand-in of its service.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "devices/hid/hid_error.h"
#include "devices/registry/inverse_devices.h"
#include "tests/support/inverse_service.h"

namespace limpid {
namespace {

using namespace std::chrono_literals;
using test::InverseService;

bool pushes(const std::string& line) { return line.starts_with("force") && line != "force 0 0 0"; }

std::unique_ptr<Device> open(const ServiceAddress& address, const std::string& id = {}) {
  const auto found = list_inverse_devices(InverseName{id, address}, address);
  if (found.empty()) throw HidError("none");
  return open_device(found.back());
}

// The loop's part: a tick about every millisecond, until the condition holds.
bool turn(Device& device, const std::vector<double>& torque,
          const std::function<bool(const DeviceReading&, bool here)>& until) {
  const auto end = std::chrono::steady_clock::now() + 60s;
  for (;;) {
    DeviceReading reading;
    const bool here = device.read(reading);
    if (until(reading, here)) return true;
    if (std::chrono::steady_clock::now() > end) return false;
    device.write(torque);
    std::this_thread::sleep_for(1ms);
  }
}

struct AnInverseService : testing::Test {
  // A force is on it when this returns.
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
  const auto device = open(service.address());
  EXPECT_TRUE(turn(*device, {0.1, 0, -0.05}, [](const DeviceReading& r, bool) {  // 1 N, -0.5 N
    return std::abs(r.x[0] - 0.1) < 1e-6 && std::abs(r.x[2] - (1.6 - 0.05)) < 1e-6;
  }));
  EXPECT_EQ(device->traits().id, "inverse3:049D@" + service.address().text());
}

TEST_F(AnInverseService, HasAZeroForceBeforeItIsLetGo) {
  {
    const auto device = open(service.address());
    push(*device);
  }
  service.wait_for("force 0 0 0");
  service.wait_for("end");
}

TEST_F(AnInverseService, HasAZeroForceOnceTheLoopStands) {
  const auto device = open(service.address());
  push(*device);
  service.wait_for("force 0 0 0");
}

TEST_F(AnInverseService, HasAZeroForceOnceNobodyAsks) {
  const auto device = open(service.address());
  push(*device);
  device->stop();
  service.wait_for("force 0 0 0");
}

TEST_F(AnInverseService, ThatFallsSilentHasAZeroForceAndGivesOldReadings) {
  const auto device = open(service.address());
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
    const auto device = open(service.address());
    push(*device);
    service.tell(std::string("say ") + words);
    EXPECT_TRUE(turn(*device, {0.1, 0, 0},
                     [](const DeviceReading& r, bool here) { return here && r.lapses > 0; }));
    service.wait_for("force 0 0 0");
  }
}

// One that answers after 20 ms must not have a queue of forces before it.
TEST_F(AnInverseService, ThatIsSlowIsNotFlooded) {
  const auto device = open(service.address());
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
  // One command an answer, but for zeros that do not wait for it.
  EXPECT_LE(std::stoi(second.substr(9)) - std::stoi(first.substr(9)), 2 * 20 + 10);
}

TEST_F(AnInverseService, ThatDropsTheConnectionIsLostAndCanBeHadAgain) {
  auto device = open(service.address());
  push(*device);
  service.tell("drop");
  EXPECT_TRUE(turn(*device, {0.1, 0, 0}, [](auto&, bool here) { return !here; }));
  device.reset();
  device = open(service.address());
  DeviceReading reading;
  EXPECT_TRUE(turn(*device, {0, 0, 0}, [](const DeviceReading& r, bool) { return r.count > 0; }));
  push(*device);
}

TEST_F(AnInverseService, ThatIsStartedAnewIsAnotherConnection) {
  auto device = open(service.address());
  push(*device);
  service.end();
  EXPECT_TRUE(turn(*device, {0.1, 0, 0}, [](auto&, bool here) { return !here; }));
  device.reset();
  EXPECT_TRUE(list_inverse_devices({}, service.address()).empty());
  InverseService again(service.address().port);
  device = open(again.address());
  EXPECT_TRUE(turn(*device, {0, 0, 0}, [](const DeviceReading& r, bool) { return r.count > 0; }));
}

TEST_F(AnInverseService, HasAZeroForceWhenWeAreKilled) {
  const pid_t child = fork();
  if (child == 0) {
    const auto device = open(service.address());
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
