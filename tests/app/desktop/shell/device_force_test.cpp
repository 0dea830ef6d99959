// The force of a device in the desktop: who arms it, what cuts it, and what is said of it.
#include <imgui.h>
#include <imgui_internal.h>

#include <cmath>

#include "tests/app/desktop/shell/a_desktop.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

using test::Wire;
using test::WiredDevice;

TEST_F(ADesktop, HasForceOnTheVirtualArmFromTheStart) {
  EXPECT_TRUE(until([&] { return arming() == Arming::on; }));
}

TEST_F(ADesktop, DoesNotArmWhenItStartsOver) {
  desktop->cut_force();
  ASSERT_TRUE(until([&] { return arming() == Arming::off; }));
  desktop->live.start_over();
  frames(80);
  EXPECT_EQ(arming(), Arming::off);
  desktop->toggle_force();
  EXPECT_TRUE(until([&] { return arming() == Arming::on; }));
}

TEST_F(ADesktop, LeavesARealDeviceOffWhateverElseIsDone) {
  const auto wire = plug_in(3);
  ASSERT_TRUE(loop().device_in_place());
  const auto expect_off = [&](const char* after) {
    frames(70);
    EXPECT_EQ(arming(), Arming::off) << after;
    EXPECT_EQ(wire->torque, 0) << after;
  };
  expect_off("plugging in");
  desktop->live.start_over();
  expect_off("starting over");
  desktop->tuning.next_law();
  document().undo();
  expect_off("undo");
  desktop->world.open_scene(fs::path(LIMPID_ASSETS_DIR) / "scenes/spheres.toml");
  ASSERT_TRUE(until([&] { return said("Scene:"); }));
  EXPECT_TRUE(loop().device_in_place()) << "the device stays in the loop";
  expect_off("another scene");
  desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  desktop->playback.start_rerun(desktop->settings.parameters());
  ASSERT_TRUE(until([&] { return desktop->playback.shown()->has_rerun(); }));
  expect_off("playback and re-run");
  desktop->playback.close();
  expect_off("going back to live");
}

// A device without force leaves the keys to the player.
TEST_F(ADesktop, PlaysByItsKeysBesideADeviceWithoutForce) {
  const auto wire = plug_in(3);
  const std::unique_ptr<ImGuiContext, decltype(&ImGui::DestroyContext)> no_menu(
      ImGui::CreateContext(), &ImGui::DestroyContext);
  desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  const bool playing = desktop->playback.shown()->player().playing();
  desktop->cut_or_play();
  EXPECT_NE(desktop->playback.shown()->player().playing(), playing);
  desktop->escape();
  EXPECT_FALSE(desktop->playback.on());
  EXPECT_EQ(wire->torque, 0);
  ASSERT_TRUE(armed());
  desktop->cut_or_play();
  EXPECT_TRUE(until([&] { return arming() == Arming::off; })) << "live the key cuts";
}

// The scene that the device would push into is not on the screen then.
TEST_F(ADesktop, HasNoForceOnARealDeviceWhileARecordingIsShown) {
  const auto wire = pushed();
  desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  EXPECT_TRUE(until([&] { return arming() == Arming::off; }));
  EXPECT_EQ(wire->torque, 0);
  run("device.force");
  wire->buttons = 2;
  frames(70);
  EXPECT_EQ(arming(), Arming::off);
  EXPECT_TRUE(said("Go back to live"));
  wire->buttons = 0;
  desktop->playback.close();
  frames(5);
  EXPECT_TRUE(until_on([&] { run("device.force"); }));
}

TEST_F(ADesktop, TakesTheForceOfARealDeviceAwayBeforeAnythingChanges) {
  auto wire = pushed();
  desktop->live.start_over();
  EXPECT_TRUE(until([&] { return arming() == Arming::off; }));
  EXPECT_EQ(wire->torque, 0);
  wire->angle = 0;
  ASSERT_TRUE(armed());
  desktop->world.open_scene(fs::path(LIMPID_ASSETS_DIR) / "scenes/spheres.toml");
  ASSERT_TRUE(until([&] { return said("Scene:"); }));
  frames(70);
  EXPECT_EQ(arming(), Arming::off);
}

TEST_F(ADesktop, TakesAButtonForNothingThatIsHeldBeforeTheFirstReport) {
  auto wire = std::make_shared<Wire>();
  wire->buttons_known = 0;
  desktop->world.open_device(std::make_unique<WiredDevice>(3, wire));
  await_device();
  frames(120);  // longer than a device takes to settle
  wire->buttons = 2;
  wire->buttons_known = ~0u;
  frames(30);
  EXPECT_EQ(arming(), Arming::off);
}

TEST_F(ADesktop, TakesAButtonThatWasHeldWhilePluggingInForNothing) {
  auto wire = std::make_shared<Wire>();
  wire->buttons = 2;
  desktop->world.open_device(std::make_unique<WiredDevice>(3, wire));
  await_device();
  frames(120);  // longer than a device takes to settle
  EXPECT_EQ(arming(), Arming::off);
  wire->buttons = 0;
  frames(10);
  EXPECT_EQ(arming(), Arming::off);
  const auto press = [&] {
    wire->buttons = 0;
    frames(5);
    wire->buttons = 2;
    frames(5);
  };
  EXPECT_TRUE(until_on(press)) << "one that is pressed now arms";
  press();
  EXPECT_TRUE(until([&] { return !desktop->live.force_armed(); }));
}

TEST_F(ADesktop, SaysThatADeviceIsGoneAndClosesItBesideTheWindow) {
  const auto wire = pushed();
  frames(60);
  wire->here = false;
  EXPECT_TRUE(until([&] { return said("The device is disconnected"); }));
  EXPECT_EQ(arming(), Arming::tripped);
  EXPECT_TRUE(until([&] { return wire->closed == 1; }));
}

// A program leads, as on the control socket.
TEST_F(ADesktop, CutsTheForceOfADeviceWhenAProgramHasEndedAndSettingsComeBack) {
  Parameters& p = desktop->settings.parameters();
  p.eta = 0.8;
  pushed();
  desktop->lead.begin();
  p.eta = 0.5;
  p.torque_limit = 0.1;
  desktop->lead.note_program();
  frames(3);
  ASSERT_TRUE(armed());
  EXPECT_TRUE(desktop->lead.end(true));
  EXPECT_EQ(p.eta, 0.8);
  EXPECT_TRUE(std::isnan(p.torque_limit)) << "the arm's own";
  EXPECT_TRUE(until([&] { return arming() == Arming::off; })) << "before it may push harder";
  EXPECT_TRUE(said("The study has ended. Your settings are back."));
}

TEST_F(ADesktop, LeavesTheForceWhereAProgramThatHasEndedLeftAllAsItWas) {
  pushed();
  desktop->lead.begin();
  desktop->lead.note_program();
  ASSERT_TRUE(armed());
  EXPECT_TRUE(desktop->lead.end(false));
  frames(5);
  EXPECT_EQ(arming(), Arming::on);
  EXPECT_FALSE(said("Your settings are back."));
}

// A real device is not armed by somebody who sees a recording; that is said as a warning.
TEST_F(ADesktop, ArmsNoRealDeviceOverARecording) {
  const auto wire = plug_in(3);
  ASSERT_TRUE(until([&] { return loop().snapshot().connected; }));
  desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  ASSERT_TRUE(loop().device_in_place());
  desktop->notices.clear();
  desktop->toggle_force();
  ASSERT_FALSE(desktop->notices.all().empty());
  EXPECT_THAT(desktop->notices.all().back().text, testing::HasSubstr("Go back to live"));
  EXPECT_TRUE(desktop->notices.all().back().bad);
  EXPECT_FALSE(desktop->live.force_armed());
  frames(30);
  EXPECT_EQ(arming(), Arming::off);
  EXPECT_EQ(wire->torque, 0);
}

// A desktop with ImGui, whose menus and text fields may use Esc.
struct ADesktopWithKeys : ADesktop {
  void SetUp() override {
    ImGui::CreateContext();
    ADesktop::SetUp();
  }
  void TearDown() override {
    ADesktop::TearDown();
    ImGui::DestroyContext();
  }
  bool stays(Arming wanted) {
    frames(20);
    return arming() == wanted;
  }
};

TEST_F(ADesktopWithKeys, OnTheVirtualArmEscClosesWhatIsOpenAndOnlyThenCutsTheForce) {
  ASSERT_TRUE(until([&] { return arming() == Arming::on; }));
  for (const char* dialog : {"help", "sweep", "open session", "identify"}) {
    desktop->dialog.open(dialog);
    desktop->escape();
    EXPECT_EQ(desktop->dialog.name(), "");
    EXPECT_TRUE(stays(Arming::on)) << dialog;
  }
  ImGui::GetIO().WantTextInput = true;  // a number is being typed over a slider
  ImGui::GetCurrentContext()->WantTextInputNextFrame = 1;
  ImGui::GetCurrentContext()->ActiveId = 1;
  ASSERT_TRUE(desktop->focus().text);
  desktop->escape();
  EXPECT_TRUE(stays(Arming::on)) << "ImGui gives the typing up";
  ImGui::GetIO().WantTextInput = false;
  ImGui::GetCurrentContext()->WantTextInputNextFrame = -1;
  ImGui::GetCurrentContext()->ActiveId = 0;
  desktop->document.editor().select(0);
  desktop->escape();
  EXPECT_FALSE(desktop->document.editor().selected());
  EXPECT_TRUE(stays(Arming::on)) << "the object is let go of";
  desktop->escape();
  EXPECT_TRUE(until([&] { return arming() == Arming::off; }));
}

TEST_F(ADesktopWithKeys, OnARealDeviceEscClosesAndCutsTheForce) {
  const auto wire = pushed();
  desktop->dialog.open("help");
  desktop->escape();
  EXPECT_EQ(desktop->dialog.name(), "");
  EXPECT_TRUE(until([&] { return arming() == Arming::off; }));
  EXPECT_EQ(wire->torque, 0);
  ASSERT_TRUE(armed());
  desktop->escape();
  EXPECT_TRUE(until([&] { return arming() == Arming::off; }));
  ASSERT_TRUE(armed());
  desktop->document.editor().select(0);
  desktop->escape();
  EXPECT_TRUE(until([&] { return arming() == Arming::off; })) << "with an object selected, too";
  EXPECT_EQ(wire->torque, 0);
}

TEST_F(ADesktopWithKeys, SpaceCutsTheForceThroughADialogAndLeavesItOpen) {
  ASSERT_TRUE(until([&] { return arming() == Arming::on; }));
  desktop->dialog.open("help");
  desktop->cut_force();
  EXPECT_TRUE(until([&] { return arming() == Arming::off; }));
  EXPECT_EQ(desktop->dialog.name(), "help");
}

TEST_F(ADesktop, SaysOverThePictureThatThereIsNoForceAndWhy) {
  ASSERT_TRUE(until([&] { return arming() == Arming::on; }));
  EXPECT_TRUE(desktop->banners().empty());
  desktop->cut_force();
  ASSERT_TRUE(until([&] { return arming() == Arming::off; }));
  ASSERT_EQ(desktop->banners().size(), 1u);
  EXPECT_EQ(desktop->banners()[0].text, "Force is off: not armed. Key F switches the force on.");
  ASSERT_EQ(desktop->banners()[0].buttons.size(), 1u);
  EXPECT_STREQ(desktop->banners()[0].buttons[0].command, "device.force");
  record_something();
  EXPECT_EQ(desktop->banners()[0].text,
            "Recording without force: not armed. Key F switches the force on.");
  EXPECT_TRUE(desktop->banners()[0].bad);
  desktop->world.toggle_recording();
  ASSERT_TRUE(until([&] { return said("Recorded"); }));
  // Playback of the recording shows it, in any state of the loop.
  ASSERT_TRUE(armed());
  EXPECT_TRUE(desktop->banners().empty());
  run("session.play");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  ASSERT_EQ(desktop->banners().size(), 1u);
  EXPECT_EQ(desktop->banners()[0].text, "In this recording: force off: not armed.");
  EXPECT_TRUE(desktop->banners()[0].buttons.empty());
}

// The map of a sweep takes the whole window: banners over the picture wait until it closes.
TEST_F(ADesktop, SaysNothingOverADialogThatHasTheWholeWindow) {
  ASSERT_TRUE(until([&] { return arming() == Arming::on; }));
  desktop->cut_force();
  ASSERT_TRUE(until([&] { return arming() == Arming::off; }));
  for (const auto& [dialog, banners] : {std::pair("sweep", 0u), {"help", 1u}, {"gallery", 1u}}) {
    desktop->dialog.open(dialog);
    EXPECT_EQ(desktop->banners().size(), banners) << dialog;
  }
  desktop->dialog.close();
  EXPECT_EQ(desktop->banners().size(), 1u);
}

}  // namespace
}  // namespace limpid
