// Devices that are programs, here the shipped Python client, against Hooke's law for its springs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "devices/hid/device_list.h"
#include "devices/hid/hid_transport.h"
#include "devices/hid/raw_protocol.h"
#include "devices/hid/transports.h"
#include "devices/simulated/rig.h"
#include "tests/support/random_arm.h"
#include "tests/support/rows.h"
#include "tests/support/temp_dir.h"
#include "tests/support/until.h"

namespace limpid {
namespace {

using namespace std::chrono_literals;

constexpr double kSpring = 0.5;  // spring of each of the client's joints [N m/rad]

struct ASocketDevice : testing::Test {
  explicit ASocketDevice(const char* version = "1") {
    setenv("XDG_RUNTIME_DIR", (dir / "").c_str(), 1);
    const std::string program = LIMPID_ASSETS_DIR "/python/limpid_device.py";
    const char* words[] = {"python3", program.c_str(), "springs", "2", version, nullptr};
    EXPECT_EQ(posix_spawn(&client, "/usr/bin/python3", nullptr, nullptr,
                          const_cast<char* const*>(words), environ),
              0);
  }
  ~ASocketDevice() override { kill_client(); }
  void kill_client() {
    if (client <= 0) return;
    kill(client, SIGKILL);
    waitpid(client, nullptr, 0);
    client = 0;
  }
  FoundDevice find() const {
    std::vector<FoundDevice> found;
    EXPECT_TRUE(
        test::until([&] { return !(found = list_socket_devices(socket_folder())).empty(); }));
    return found.at(0);
  }

  test::TempDir dir;
  pid_t client = 0;
};

// The bare connection from the program's side.
struct Connection {
  explicit Connection(const std::string& path) : transport(open_socket(path)) {
    protocol.open(*transport);
  }
  // Sends one command, or none; reads what has arrived since.
  bool turn(const double* torque) {
    if (torque != nullptr) {
      protocol.encode({torque, 2}, {}, [&](auto report) { transport->write(report); });
    }
    std::array<std::uint8_t, 256> report{};
    int size = 0;
    while ((size = transport->read(report, 1)) > 0) {
      protocol.decode(std::span(report).first(static_cast<std::size_t>(size)), reading);
    }
    return size == 0;
  }

  std::unique_ptr<HidTransport> transport;
  RawProtocol protocol;
  DeviceReading reading;
};

TEST_F(ASocketDevice, IsListedWhileItsProgramRuns) {
  const FoundDevice found = find();
  EXPECT_EQ(found.place.name, "springs");
  EXPECT_EQ(found.place.id, "socket:springs");
  EXPECT_EQ(found.missing, "");
  const auto all = list_devices({.udev_rule = "rules"});  // other devices may be plugged in here
  EXPECT_EQ(std::ranges::count(all, found.place.id, [](const auto& one) { return one.place.id; }),
            1);
  kill_client();
  EXPECT_TRUE(list_socket_devices(socket_folder()).empty()) << "its socket is still there";
  EXPECT_TRUE(std::filesystem::exists(found.place.path));
}

TEST_F(ASocketDevice, SaysWhatItIs) {
  const auto device = open_device(find());
  const DeviceTraits& traits = device->traits();
  EXPECT_EQ(traits.dof, 2);
  EXPECT_TRUE(traits.pushes);
  EXPECT_TRUE(traits.guarded);
  EXPECT_EQ(traits.id, "socket:springs");
  EXPECT_THAT(traits.lower, testing::Each(testing::DoubleNear(-0.349, 1e-12)));
  EXPECT_THAT(traits.upper, testing::Each(testing::DoubleNear(0.349, 1e-12)));
  EXPECT_EQ(traits.effort, (std::vector<double>{0.2, 0.2}));
}

TEST_F(ASocketDevice, GivesWayToItsTorqueAsASpringDoes) {
  Connection to(find().place.path);
  const double torque[] = {0.1, -0.05};
  EXPECT_TRUE(test::until([&] {
    to.turn(torque);
    return std::abs(to.reading.x[0] - 0.1 / kSpring) < 0.01 &&
           std::abs(to.reading.x[1] + 0.05 / kSpring) < 0.01;
  }));
}

struct ASocketDeviceOfVersion2 : ASocketDevice {
  ASocketDeviceOfVersion2() : ASocketDevice("2") {}
};

TEST_F(ASocketDeviceOfVersion2, GivesWayToItsTorqueAsASpringDoes) {
  Connection to(find().place.path);
  EXPECT_EQ(to.protocol.traits().made_by, "limpid_device.py");
  EXPECT_EQ(to.protocol.traits().slides, (std::vector<bool>{false, false}));
  const double torque[] = {0.1, -0.05};
  EXPECT_TRUE(test::until([&] {
    to.turn(torque);
    return std::abs(to.reading.x[0] - 0.1 / kSpring) < 0.01 &&
           std::abs(to.reading.x[1] + 0.05 / kSpring) < 0.01;
  }));
  EXPECT_TRUE(test::until([&] { return to.turn(nullptr) && std::abs(to.reading.x[0]) < 0.01; }));
}

TEST_F(ASocketDevice, HasNoTorqueOnceItHearsNothingMore) {
  Connection to(find().place.path);
  const double torque[] = {0.1, 0.1};
  ASSERT_TRUE(test::until([&] { return to.turn(torque) && to.reading.x[0] > 0.1; }));
  EXPECT_TRUE(test::until([&] { return to.turn(nullptr) && std::abs(to.reading.x[0]) < 0.01; }));
}

TEST_F(ASocketDevice, HasNoTorqueOnceTheConnectionEnds) {
  const FoundDevice found = find();
  const double torque[] = {0.1, 0.1};
  {
    Connection to(found.place.path);
    ASSERT_TRUE(test::until([&] { return to.turn(torque) && to.reading.x[0] > 0.1; }));
  }
  std::optional<Connection> again;
  ASSERT_TRUE(test::until([&] {  // the client may not have noticed yet
    try {
      again.emplace(found.place.path);
    } catch (const HidError&) {
    }
    return again.has_value();
  }));
  EXPECT_TRUE(
      test::until([&] { return again->turn(nullptr) && std::abs(again->reading.x[0]) < 0.01; }));
}

TEST_F(ASocketDevice, SpeaksToOneProgramAtATime) {
  const FoundDevice found = find();
  const auto device = open_device(found);
  try {
    open_device(found);
    FAIL();
  } catch (const HidError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("in use by process"));
  }
  // Another name of the same socket does not help.
  std::filesystem::create_symlink(found.place.path, dir / "link.device");
  FoundDevice linked = found;
  linked.place.path = (dir / "link.device").string();
  EXPECT_EQ(linked.claim_key(linked), found.claim_key(found));
  EXPECT_THROW(open_device(linked), HidError);
  DeviceReading before, after;
  ASSERT_TRUE(test::until([&] { return device->read(before) && before.count > 0; }));
  EXPECT_TRUE(test::until([&] { return device->read(after) && after.count > before.count + 20; }))
      << "nothing has disturbed it";
}

TEST_F(ASocketDevice, IsListedWithWhoHasIt) {
  const FoundDevice found = find();
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t other = fork();
  if (other == 0) {
    const DeviceClaim claim(found.claim_key(found));
    [[maybe_unused]] const auto said = write(ready[1], "x", 1);
    for (;;) pause();
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  const auto listed = [&] {
    const auto all = list_devices({.udev_rule = "rules", .services = false});
    return *std::ranges::find(all, found.place.id, [](const auto& one) { return one.place.id; });
  };
  EXPECT_THAT(listed().in_use_by, testing::HasSubstr("process " + std::to_string(other)));
  kill(other, SIGKILL);
  waitpid(other, nullptr, 0);
  EXPECT_EQ(listed().in_use_by, "");
}

// The first joint is a little inside a stop, which pushes it back against its spring.
TEST_F(ASocketDevice, IsDrivenByTheLoopAndLostWithoutForceWhenItsProgramIsKilled) {
  const std::unique_ptr<Device> device = open_device(find());
  ArmDescription arm = test::random_arm(2, 7);
  for (Joint& joint : arm.joints) joint.effort = 0.2;
  Scene scene;
  scene.add({.name = "stop", .shape = JointStop{0, -0.1, 1}, .material = {20}});
  Rig rig(arm, scene, device.get());
  Parameters p;
  RigStart start;
  start.x1 = start.v1 = start.x2 = start.v2 = start.f1_hat = Eigen::VectorXd::Zero(2);
  rig.start(p, start);
  test::Rows rows(rig.layout());
  // Arms again when the client was too late for the limits, which hold as for any device.
  const auto step = [&] {
    const Arming now = rig.force().state();
    const bool arm_it = now == Arming::off || now == Arming::tripped;
    const ForceRequest wish = arm_it ? ForceRequest::arm : ForceRequest::as_it_is;
    rig.step(p, {.hand = {rig.tip(), 1}, .force = wish}, rows.add());
    const std::size_t last = rows.size() - 1;
    return rows.vec(last, Column::motor_torque)[0] < -0.01 &&
           rows.vec(last, Column::measured_position)[0] < -0.01;
  };
  EXPECT_TRUE(test::until(step)) << "pushed back, and it went";
  kill_client();
  EXPECT_TRUE(test::until([&] {
    step();
    return rig.force_state() == ForceState::lost;
  }));
  for (int k = 0; k < 100; ++k) step();
  EXPECT_EQ(rig.force_state(), ForceState::lost);
  EXPECT_EQ(rows.vec(rows.size() - 1, Column::motor_torque).norm(), 0);
}

TEST(SocketDevices, AreNoneWithoutAFolderOrForOtherFiles) {
  const test::TempDir dir;
  EXPECT_TRUE(list_socket_devices({}).empty());
  EXPECT_TRUE(list_socket_devices(dir / "no such folder").empty());
  std::ofstream(dir / "a.device") << "no socket";
  EXPECT_TRUE(list_socket_devices(dir / "").empty());
}

TEST(SocketTransport, SaysWhatIsWrongWithAPath) {
  const test::TempDir dir;
  const auto complaint = [](const std::string& path) -> std::string {
    try {
      open_socket(path);
    } catch (const HidError& error) {
      return error.what();
    }
    return {};
  };
  const std::string nobody = (dir / "nobody.device").string();
  EXPECT_EQ(complaint(nobody), nobody + ": No such file or directory");
  EXPECT_THAT(complaint("/" + std::string(200, 'a')), testing::HasSubstr("at most 107 characters"));
}

}  // namespace
}  // namespace limpid
