#include "devices/hid/hid_device.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "devices/hid/hid_transport.h"
#include "devices/hid/raw_protocol.h"
#include "tests/support/fake_hid.h"
#include "tests/support/raw_reports.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using test::raw_command;
using test::sealed;

// A raw device of two joints whose thread sends a reading about every millisecond.
struct LiveRawDevice : testing::Test {
  LiveRawDevice() { fake->features[0] = sealed(test::raw_feature(2)); }
  ~LiveRawDevice() override { freeze(); }

  // Opens the device; a guardian writes to the file at `path`, if there is one.
  std::unique_ptr<HidDevice> connect(const std::string& path = "") {
    return std::make_unique<HidDevice>(std::make_unique<test::FakeTransport>(fake, true),
                                       std::make_unique<RawProtocol>(),
                                       HidPlace{"A device", "1209:4c50:1", path});
  }
  void play() {
    player = std::thread([this] {
      for (std::uint32_t i = 1; !frozen; ++i) {
        fake->send(sealed(test::raw_reading(i, {0.5f, 0.25f})));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
  }
  void freeze() {
    frozen = true;
    if (player.joinable()) player.join();
  }
  // Ticks until the device has force.
  void push(HidDevice& device) {
    std::atomic<bool> pushed = false;
    std::thread ticks([&] {
      while (!pushed) {
        DeviceReading newest;
        device.read(newest);
        device.write(std::vector<double>{0.25, 0});
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
    fake->wait_for([](const Report& r) { return raw_command(r).pushes(); });
    pushed = true;
    ticks.join();
  }

  std::shared_ptr<test::FakeHid> fake = std::make_shared<test::FakeHid>();
  std::atomic<bool> frozen = false;
  std::thread player;
};

TEST_F(LiveRawDevice, IsReadAndPushed) {
  play();
  const auto device = connect();
  EXPECT_EQ(device->traits().name, "T2");
  EXPECT_EQ(device->traits().id, "1209:4c50:1");
  push(*device);
  DeviceReading reading;
  EXPECT_TRUE(device->read(reading));
  EXPECT_GT(reading.count, 0u);
  EXPECT_EQ(reading.x[0], 0.5);
}

TEST_F(LiveRawDevice, IsWithoutForceWhenClosed) {
  play();
  auto device = connect();
  push(*device);
  device.reset();
  EXPECT_FALSE(raw_command(fake->received().back()).pushes());
  EXPECT_EQ(raw_command(fake->received().back()).sequence, 0u) << "the stop report";
}

TEST_F(LiveRawDevice, IsWithoutForceWhenNobodyTicks) {
  play();
  const auto device = connect();
  push(*device);
  fake->forget_received();
  fake->wait_for([](const Report& r) { return !raw_command(r).pushes(); });
}

TEST_F(LiveRawDevice, IsLostWhenUnplugged) {
  play();
  const auto device = connect();
  push(*device);
  fake->unplug();
  DeviceReading reading;
  while (device->read(reading)) std::this_thread::yield();
  EXPECT_TRUE(device->lost());
  device->write(std::vector<double>{0.25, 0});
  device->stop();
}

TEST_F(LiveRawDevice, IsStoppedByItsGuardianIfItTakesNoStopFromUs) {
  const test::TempDir dir;
  const std::string path = (dir / "device").string();
  for (const bool refuses : {false, true}) {
    std::ofstream(path, std::ios::trunc).flush();
    auto device = connect(path);
    fake->refuse_writes(refuses);
    device.reset();
    EXPECT_EQ(std::filesystem::file_size(path) > 0, refuses);
  }
}

TEST_F(LiveRawDevice, IsStoppedIfNobodyCanGuardIt) {
  EXPECT_THROW(connect("/nonexistent/hidraw0"), HidError);
  ASSERT_FALSE(fake->received().empty());
  EXPECT_EQ(raw_command(fake->received().back()).mode, 0);
}

TEST_F(LiveRawDevice, IsRefusedIfItDoesNotSayWhatItIs) {
  fake->features.clear();
  EXPECT_THROW(connect(), HidError);
}

}  // namespace
}  // namespace limpid
