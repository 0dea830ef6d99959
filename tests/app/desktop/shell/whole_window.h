// The whole window, drawn without a display: its parts, a mouse, and what can be read on it.
#pragma once

#include <GLFW/glfw3.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "app/desktop/shell/commands.h"
#include "app/desktop/shell/desktop.h"
#include "app/desktop/shell/frame.h"
#include "app/style/imgui_gl.h"
#include "app/style/imgui_input.h"
#include "tests/support/computer.h"
#include "tests/support/drawn_text.h"
#include "tests/support/faultless_context.h"
#include "tests/support/temp_dir.h"
#include "tests/support/until.h"

namespace limpid {

class WholeWindow : public testing::Test {
 protected:
  void SetUp() override {
    setenv("XDG_DATA_HOME", (dir / "data").c_str(), 1);
    setenv("XDG_CONFIG_HOME", (dir / "config").c_str(), 1);
    setenv("XDG_CACHE_HOME", (dir / "cache").c_str(), 1);
    if (!test::has_offscreen_pictures()) GTEST_SKIP() << "no EGL here";
    context = std::make_unique<test::FaultlessContext>(64, 64);
    imgui = std::make_unique<ImGuiGl>();
    begin_imgui_input();
    ImGuiGl::set_up(Theme::dark, 1);
    Settings settings;
    settings.hint_seen = true;
    settings.picture_quality = "low";
    settings.own_file_dialogs = true;
    desktop = std::make_unique<Desktop>(settings, AskForPriority{});
    desktop->world.open_given("", "", "");
    frame = std::make_unique<Frame>(
        *desktop,
        [this] {
          return FrameSize{width, height, width, height};
        },
        [this](std::string_view id) { run_or_say(id, *desktop); });
    frames(4);
  }
  void TearDown() override {
    if (frame) frame->drop_pictures();
    frame.reset();
    if (desktop) desktop->drop_pictures();
    desktop.reset();
    imgui.reset();
  }

  void frames(int count) {
    using namespace std::chrono_literals;
    ImGuiIO& io = ImGui::GetIO();
    for (int i = 0; i < count; ++i) {
      io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
      io.DeltaTime = 0.02f;
      desktop->update(0.02);
      ImGuiGl::begin_frame();
      ImGui::NewFrame();
      const int styles = ImGui::GetCurrentContext()->StyleVarStack.Size;
      const int colours = ImGui::GetCurrentContext()->ColorStack.Size;
      frame->differs();
      frame->draw();
      EXPECT_EQ(ImGui::GetCurrentContext()->StyleVarStack.Size, styles) << "a style is left";
      EXPECT_EQ(ImGui::GetCurrentContext()->ColorStack.Size, colours) << "a colour is left";
      EXPECT_EQ(ImGui::GetCurrentContext()->CurrentWindowStack.Size, 1) << "a window is open";
      ImGui::Render();
      std::this_thread::sleep_for(1ms);
    }
  }
  template <class Done>
  bool until(Done done) {
    return test::until(done, [this] { frames(1); });
  }
  bool said(const std::string& what) const {
    return std::ranges::any_of(desktop->notices.all(), [&](const Notice& notice) {
      return notice.text.find(what) != std::string::npos;
    });
  }
  void run(const char* command) {
    EXPECT_EQ(run_command(command, *desktop), "") << command;
    frames(3);
  }
  void point_at(ImVec2 place) {
    show_mouse(place);
    frames(3);
  }
  void away() { point_at({static_cast<float>(width) - 1, static_cast<float>(height) - 1}); }
  void click(ImVec2 place) {
    point_at(place);
    for (const bool down : {true, false}) {
      show_mouse_button(0, down);
      frames(1);
    }
    frames(2);
  }
  void press(int key) {
    for (const bool down : {true, false}) {
      show_key(key, down);
      frames(1);
    }
    frames(1);
  }

  // Puts a text in place of that of the field with the keyboard's focus.
  void write_over(const std::string& text) {
    show_modifiers(true, false, false);
    press(GLFW_KEY_A);
    show_modifiers(false, false, false);
    ImGui::GetIO().AddInputCharactersUTF8(text.c_str());
    frames(3);
  }

  // Finds a text in a window whose name begins so; "" for any.
  static std::optional<test::DrawnText> find(const std::string& text, const std::string& in = "") {
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.text == text && each.window.starts_with(in)) return each;
    }
    return std::nullopt;
  }
  // Returns all words that a window shows, a text a line.
  static std::string words(const std::string& in = "") {
    std::string all;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.window.starts_with(in)) all += each.text + '\n';
    }
    return all;
  }
  // The same in one line, as a sentence may stand in several.
  static std::string sentences(const std::string& in = "") {
    std::string all = words(in);
    std::ranges::replace(all, '\n', ' ');
    return all;
  }
  void click(const std::string& text, const std::string& in = "") {
    const auto found = find(text, in);
    ASSERT_TRUE(found) << text << " is not there:\n" << words(in);
    click(found->middle());
  }
  // Returns what the tooltip of a text says; empty for none.
  std::string hint(const std::string& text, const std::string& in = "") {
    const auto found = find(text, in);
    EXPECT_TRUE(found) << text << " is not there:\n" << words(in);
    if (!found) return "";
    away();
    point_at(found->middle());
    std::string said;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.window.starts_with("##Tooltip")) said += (said.empty() ? "" : " ") + each.text;
    }
    return said;
  }

  const test::TempDir dir;
  int width = 1440, height = 900;
  std::unique_ptr<test::FaultlessContext> context;
  std::unique_ptr<ImGuiGl> imgui;
  std::unique_ptr<Desktop> desktop;
  std::unique_ptr<Frame> frame;
};

}  // namespace limpid
