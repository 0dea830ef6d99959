// The system's window, on the display that there is, else on an Xvfb of its own. Skipped where
// there is neither.
#include "app/desktop/shell/window.h"

#include <GLFW/glfw3.h>
#include <dlfcn.h>
#include <gmock/gmock.h>
#include <imgui.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/base/window_system.h"
#include "app/style/theme.h"
#include "render/gl/offscreen.h"
#include "tests/support/spoken_program.h"
#include "tests/support/temp_dir.h"
#include "tests/support/until.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

// Returns width and height of a PNG file, as its head says; none if it is no PNG.
std::array<unsigned, 2> png_size(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::array<unsigned char, 24> head{};
  in.read(reinterpret_cast<char*>(head.data()), head.size());
  if (!in || head[1] != 'P' || head[2] != 'N' || head[3] != 'G') return {};
  const auto number = [&](std::size_t at) {
    return static_cast<unsigned>(head[at] << 24 | head[at + 1] << 16 | head[at + 2] << 8 |
                                 head[at + 3]);
  };
  return {number(16), number(20)};
}

bool has_display() {
  const auto named = [](const char* variable) {
    const char* value = std::getenv(variable);
    return value != nullptr && *value != '\0';
  };
  return named("DISPLAY") || named("WAYLAND_DISPLAY");
}

class AWindow : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (has_display()) return;
    display.emplace(std::vector<std::string>{"Xvfb", "-displayfd", "1", "-screen", "0",
                                             "1280x900x24", "-nolisten", "tcp"});
    if (display->ready()) setenv("DISPLAY", (":" + display->line()).c_str(), 1);
  }
  static void TearDownTestSuite() {
    if (!display) return;
    unsetenv("DISPLAY");
    display.reset();
  }
  void SetUp() override {
    if (!has_display()) GTEST_SKIP() << "no display here";
    try {
      window.emplace(Window::Options{.width = 940, .height = 600, .ui_scale = 1});
    } catch (const std::runtime_error& e) {
      GTEST_SKIP() << e.what();
    }
    glfw = glfwGetCurrentContext();
    ASSERT_NE(glfw, nullptr);
  }
  void frame() {
    window->wait();
    window->begin_frame({});
    drawn();
    window->end_frame();
  }
  // Returns what GLFW calls on an event.
  template <class Set>
  auto callback(Set set) const {
    const auto found = set(glfw, nullptr);
    set(glfw, found);
    EXPECT_NE(found, nullptr);
    return found;
  }
  bool at_rest() {
    return test::until([&] { return !window->due(); }, [&] { frame(); });
  }

  inline static std::optional<test::SpokenProgram> display;
  const test::TempDir dir;
  std::optional<Window> window;
  GLFWwindow* glfw = nullptr;
  std::function<void()> drawn = [] {};
};

TEST_F(AWindow, IsAsLargeAsItIsAskedFor) {
  const WorkArea area = work_area();
  int width = 0, height = 0;
  window->size(width, height);
  EXPECT_EQ(width, std::min(static_cast<int>(area.scale * 940), area.width));
  EXPECT_EQ(height, std::min(static_cast<int>(area.scale * 600), area.height));
  int asked_width = 0, asked_height = 0;
  window->asked_size(asked_width, asked_height);
  EXPECT_NEAR(asked_width, static_cast<float>(width) / area.scale, 1);
  EXPECT_NEAR(asked_height, static_cast<float>(height) / area.scale, 1);
  int pixels_x = 0, pixels_y = 0, real_x = 0, real_y = 0;
  window->framebuffer_size(pixels_x, pixels_y);
  glfwGetFramebufferSize(glfw, &real_x, &real_y);
  EXPECT_EQ(pixels_x, real_x);
  EXPECT_EQ(pixels_y, real_y);
  EXPECT_EQ(window->renderer(), renderer_name());
  frame();
  EXPECT_GT(window->frame_time(), 0);
  EXPECT_LT(window->frame_time(), 60);
  if (on_wayland()) return;
  EXPECT_THAT(window_for_portals(), testing::MatchesRegex("x11:[0-9a-f]+"));
}

TEST_F(AWindow, IsDrawnAfterATouchAndRestsWithoutOne) {
  EXPECT_TRUE(window->due()) << "it has shown nothing yet";
  EXPECT_FALSE(window->input_waits());
  ASSERT_TRUE(at_rest());
  const auto expect_touch = [&](const char* what) {
    EXPECT_TRUE(window->due()) << what;
    ASSERT_TRUE(at_rest()) << what;
  };
  callback(glfwSetScrollCallback)(glfw, 0, 1);
  expect_touch("the wheel");
  callback(glfwSetWindowRefreshCallback)(glfw);
  expect_touch("the desktop asks for it");
}

TEST_F(AWindow, TakesKeysAndTextInTheOrderOfFrames) {
  const auto key = callback(glfwSetKeyCallback);
  const auto character = callback(glfwSetCharCallback);
  frame();
  const long before = window->input_taken().keys;
  key(glfw, GLFW_KEY_F2, 0, GLFW_PRESS, 0);
  key(glfw, GLFW_KEY_F2, 0, GLFW_RELEASE, 0);
  key(glfw, GLFW_KEY_F3, 0, GLFW_PRESS, GLFW_MOD_SHIFT);
  EXPECT_TRUE(window->input_waits());
  EXPECT_TRUE(window->due());
  for (const auto& [place, modifiers] :
       {std::pair(GLFW_KEY_F2, 0), {GLFW_KEY_F3, GLFW_MOD_SHIFT}}) {
    window->begin_frame({});
    ASSERT_FALSE(window->keys().empty());
    EXPECT_EQ(window->keys().back().key, place);
    EXPECT_EQ(window->keys().back().modifiers, modifiers);
    window->end_frame();
  }
  EXPECT_EQ(window->input_taken().keys, before + 2);
  EXPECT_FALSE(window->input_waits());
  window->wait();
  EXPECT_TRUE(window->keys().empty()) << "of another frame";
  character(glfw, 'x');
  EXPECT_TRUE(window->input_waits());
  window->begin_frame({});
  EXPECT_EQ(ImGui::GetIO().InputQueueCharacters.Size, 1);
  window->end_frame();
  EXPECT_FALSE(window->input_waits());
  EXPECT_FALSE(window->key_labels().text("[").empty());
}

TEST_F(AWindow, TakesTheMouseAndWhatIsDroppedOnIt) {
  const auto move = callback(glfwSetCursorPosCallback);
  const auto press = callback(glfwSetMouseButtonCallback);
  frame();
  callback(glfwSetCursorEnterCallback)(glfw, GLFW_TRUE);
  move(glfw, 321, 123);
  press(glfw, GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, GLFW_MOD_CONTROL);
  EXPECT_TRUE(window->input_waits());
  const long before = window->input_taken().buttons;
  window->begin_frame({});
  EXPECT_EQ(ImGui::GetIO().MousePos.x, 321);
  EXPECT_EQ(ImGui::GetIO().MousePos.y, 123);
  EXPECT_TRUE(ImGui::IsMouseDown(ImGuiMouseButton_Left));
  EXPECT_TRUE(ImGui::GetIO().KeyCtrl);
  window->end_frame();
  press(glfw, GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, 0);
  window->begin_frame({});
  EXPECT_FALSE(ImGui::IsMouseDown(ImGuiMouseButton_Left));
  window->end_frame();
  EXPECT_EQ(window->input_taken().buttons, before + 2);
  EXPECT_TRUE(window->dropped().empty());
  std::array<const char*, 2> files{"/a/one.toml", "/a/two.h5"};
  callback(glfwSetDropCallback)(glfw, 2, files.data());
  EXPECT_EQ(window->dropped(), (std::vector<fs::path>{"/a/one.toml", "/a/two.h5"}));
  window->wait();
  EXPECT_TRUE(window->dropped().empty());
}

TEST_F(AWindow, SavesPicturesOfAllAndOfAPart) {
  int width = 0, height = 0;
  window->framebuffer_size(width, height);
  const auto whole = std::array{static_cast<unsigned>(width), static_cast<unsigned>(height)};
  frame();
  EXPECT_TRUE(window->saved().empty());
  window->save_picture(dir / "all.png");
  window->save_picture(dir / "part.png", 10, 20, 110, 70);
  window->save_picture(dir / "beyond.png", -50, height - 30, 40, height + 100);
  window->save_picture(dir / "none/all.png");
  frame();
  ASSERT_EQ(window->saved().size(), 4u);
  for (const int i : {0, 1, 2}) {
    EXPECT_EQ(window->saved()[static_cast<std::size_t>(i)].error, "") << i;
  }
  EXPECT_EQ(window->saved()[1].file, dir / "part.png");
  EXPECT_NE(window->saved()[3].error, "");
  EXPECT_EQ(png_size(dir / "all.png"), whole);
  EXPECT_EQ(png_size(dir / "part.png"), (std::array{100u, 50u}));
  EXPECT_EQ(png_size(dir / "beyond.png"), (std::array{40u, 30u})) << "what there is of it";
  // A part has what is drawn there, and nothing else: pictures of one colour are as good as equal.
  drawn = [&] {
    ImGui::GetForegroundDrawList()->AddRectFilled({200, 100}, {300, 150}, IM_COL32(255, 0, 0, 255));
  };
  window->save_picture(dir / "red.png", 200, 100, 300, 150);
  window->save_picture(dir / "half.png", 150, 100, 250, 150);
  frame();
  ASSERT_EQ(window->saved().size(), 2u) << "once each";
  std::vector<unsigned char> red;
  for (int i = 0; i < 100 * 50; ++i) red.insert(red.end(), {255, 0, 0, 255});
  write_png(dir / "wanted.png", 100, 50, red);
  const auto bytes = [](const fs::path& file) {
    std::stringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
  };
  EXPECT_TRUE(bytes(dir / "red.png") == bytes(dir / "wanted.png"));
  EXPECT_FALSE(bytes(dir / "half.png") == bytes(dir / "wanted.png"));
}

TEST_F(AWindow, ChangesItsLookBetweenFrames) {
  frame();
  window->begin_frame({});
  const float before = ImGui::GetFontSize();
  EXPECT_EQ(current_theme(), Theme::dark);
  window->end_frame();
  window->set_look(Theme::light, 2);
  window->begin_frame({});
  EXPECT_NEAR(ImGui::GetFontSize(), 2 * before, 1);
  EXPECT_EQ(current_theme(), Theme::light);
  window->end_frame();
  window->set_look(Theme::light, 1);
  window->begin_frame({});
  EXPECT_NEAR(ImGui::GetFontSize(), before, 0.1);
  window->end_frame();
}

TEST_F(AWindow, IsClosedOrKeptOpenAndFillsTheScreen) {
  EXPECT_TRUE(window->wait());
  window->close();
  EXPECT_FALSE(window->wait());
  window->keep_open();
  EXPECT_TRUE(window->wait());
  EXPECT_EQ(window->focused(), glfwGetWindowAttrib(glfw, GLFW_FOCUSED) == GLFW_TRUE);
  int width = 0, height = 0, now_width = 0, now_height = 0;
  window->size(width, height);
  EXPECT_FALSE(window->full_screen());
  window->toggle_full_screen();
  EXPECT_TRUE(window->full_screen());
  window->toggle_full_screen();
  EXPECT_FALSE(window->full_screen());
  EXPECT_TRUE(test::until([&] {
    window->wait();
    window->size(now_width, now_height);
    return now_width == width && now_height == height;
  })) << "as large as before";
}

TEST_F(AWindow, IsMovedIntoAnAreaThatIsSmaller) {
  if (on_wayland()) GTEST_SKIP() << "windows have no places there";
  const WorkArea area{.x = 30, .y = 40, .width = 920, .height = 570};
  move_into(area, glfw);
  int x = 0, y = 0, width = 0, height = 0, left = 0, top = 0, right = 0, bottom = 0;
  EXPECT_TRUE(test::until([&] {
    window->wait();
    glfwGetWindowSize(glfw, &width, &height);
    glfwGetWindowPos(glfw, &x, &y);
    glfwGetWindowFrameSize(glfw, &left, &top, &right, &bottom);
    return width == 920 - left - right && height == 570 - top - bottom && x == 30 + left &&
           y == 40 + top;
  })) << width
      << " x " << height << " at " << x << ", " << y;
}

TEST_F(AWindow, LeavesOnceWhenTheDisplayIsLost) {
  using Handler = int (*)(void*);
  using Set = Handler (*)(Handler);
  const auto set = reinterpret_cast<Set>(dlsym(RTLD_DEFAULT, "XSetIOErrorHandler"));
  if (set == nullptr || on_wayland()) GTEST_SKIP() << "no X11 here";
  int left = 0;
  when_display_is_lost([&] { ++left; });
  const Handler handler = set(nullptr);
  ASSERT_NE(handler, nullptr);
  EXPECT_EQ(left, 0);
  handler(nullptr);
  handler(nullptr);
  EXPECT_EQ(left, 1);
}

}  // namespace
}  // namespace limpid
