// A desktop without a window, with its loop, and with devices that a test plugs in.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "app/desktop/shell/commands.h"
#include "app/desktop/shell/desktop.h"
#include "tests/support/computer.h"
#include "tests/support/faultless_context.h"
#include "tests/support/temp_dir.h"
#include "tests/support/until.h"
#include "tests/support/wired_device.h"

namespace limpid {

struct ADesktop : testing::Test {
  void SetUp() override {
    setenv("XDG_DATA_HOME", (dir / "data").c_str(), 1);
    setenv("XDG_CONFIG_HOME", (dir / "config").c_str(), 1);
    if (!test::has_offscreen_pictures()) GTEST_SKIP() << "no EGL here";
    context = std::make_unique<test::FaultlessContext>(64, 64);
    desktop = std::make_unique<Desktop>(Settings{}, AskForPriority{});
    desktop->world.open_given("", "", "");
    frames(3);
  }
  void TearDown() override {
    if (desktop) desktop->drop_pictures();
    desktop.reset();
  }
  void frames(int count) {
    for (int i = 0; i < count; ++i) {
      desktop->update(0.01);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  template <class Done>
  bool until(Done done) {
    return test::until(done, [this] { frames(1); });
  }
  LiveLoop& loop() const { return desktop->live.loop(); }
  Document& document() const { return desktop->document; }
  Arming arming() const { return loop().snapshot().arming; }
  bool said(const std::string& what) const {
    return std::ranges::any_of(desktop->notices.all(), [&](const Notice& notice) {
      return notice.text.find(what) != std::string::npos;
    });
  }
  // Asks for force until it is on: on a busy computer the window may have been silent meanwhile.
  template <class Ask>
  bool until_on(Ask ask) {
    return until([&] {
      if (!desktop->live.force_armed()) {
        ask();
        frames(5);
      }
      return arming() == Arming::on;
    });
  }
  bool armed() {
    return until_on([&] { loop().arm(); });
  }
  // Waits for the loop's first tick with the device, without frames: a controller that did not
  // connect it gets no time.
  void await_device() {
    while (!loop().snapshot().connected) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      loop().update();
    }
  }
  std::shared_ptr<test::Wire> plug_in(int dof) {
    auto wire = std::make_shared<test::Wire>();
    desktop->world.open_device(std::make_unique<test::WiredDevice>(dof, wire));
    await_device();
    return wire;
  }
  // An armed device in the loop, pulled away from its proxy.
  std::shared_ptr<test::Wire> pushed() {
    auto wire = plug_in(3);
    EXPECT_TRUE(until([&] { return loop().snapshot().connected; }));
    wire->angle = 0.1;  // the coupling pulls it back
    EXPECT_TRUE(armed());
    return wire;
  }
  void run(const char* command) { EXPECT_EQ(run_command(command, *desktop), "") << command; }
  void record_something() {
    desktop->world.toggle_recording();
    ASSERT_TRUE(until([&] { return loop().snapshot().recording; }));
    frames(20);
  }
  std::vector<std::filesystem::path> recordings() const {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(dir / "data/limpid/sessions")) {
      files.push_back(entry.path());
    }
    return files;
  }
  bool has(const std::string& name) const {
    return std::ranges::any_of(document().editor().scene().objects,
                               [&](const Object& object) { return object.name == name; });
  }

  const test::TempDir dir;
  std::unique_ptr<test::FaultlessContext> context;
  std::unique_ptr<Desktop> desktop;
};

}  // namespace limpid
