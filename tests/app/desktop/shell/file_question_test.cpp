// Questions for a file: to the desktop's own dialog, which a stand-in shows, and to ours.
#include "app/desktop/shell/file_question.h"

#include <dbus/dbus.h>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <optional>

#include "app/base/session_bus.h"
#include "app/style/theme.h"
#include "tests/app/plot/imgui_frames.h"
#include "tests/support/drawn_text.h"
#include "tests/support/portal_response.h"
#include "tests/support/private_bus.h"
#include "tests/support/until.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

// The desktop's portal. It shows one dialog at a time, under a handle of its own.
class StandInPortal {
 public:
  StandInPortal() : bus_(session_bus()) {
    dbus_bus_request_name(bus_.get(), "org.freedesktop.portal.Desktop", 0, nullptr);
  }
  // Waits for a question, and shows its dialog or, without `shows`, knows no such method.
  bool is_asked(bool shows) {
    BusMessage asked;
    test::until([&] {
      dbus_connection_read_write(bus_.get(), 0);
      asked.reset(dbus_connection_pop_message(bus_.get()));
      return asked && dbus_message_is_method_call(asked.get(), "org.freedesktop.portal.FileChooser",
                                                  "OpenFile") == TRUE;
    });
    if (!asked) return false;
    if (!shows) {
      send(BusMessage(
          dbus_message_new_error(asked.get(), DBUS_ERROR_UNKNOWN_METHOD, "no such method")));
      return true;
    }
    handle_ = fmt::format("/org/freedesktop/portal/desktop/request/own/{}", ++count_);
    const BusMessage reply(dbus_message_new_method_return(asked.get()));
    const char* const path = handle_.c_str();
    dbus_message_append_args(reply.get(), DBUS_TYPE_OBJECT_PATH, &path, DBUS_TYPE_INVALID);
    send(reply);
    return true;
  }
  // Ends the dialog: given up, or with a file.
  void end(const fs::path& file) {
    send(test::portal_response(handle_, file.empty() ? 1 : 0,
                               file.empty() ? std::string() : uri_of(file)));
  }

 private:
  void send(const BusMessage& message) {
    dbus_connection_send(bus_.get(), message.get(), nullptr);
    dbus_connection_flush(bus_.get());
  }

  Bus bus_;
  std::string handle_;
  int count_ = 0;
};

class AFileQuestion : public ImGuiFrames {
 protected:
  static void SetUpTestSuite() {
    if (const char* before = std::getenv(kVariable)) before_ = before;
    bus_.emplace();
  }
  static void TearDownTestSuite() {
    bus_.reset();
    before_ ? setenv(kVariable, before_->c_str(), 1) : unsetenv(kVariable);
  }
  void SetUp() override {
    if (!bus_->runs()) GTEST_SKIP() << "no dbus-daemon here";
    apply_theme(Theme::dark, 1);
    portal_.emplace();
    std::ofstream(folder_ / "a scene.toml") << "x";
  }
  void frames(int count) {
    for (int i = 0; i < count; ++i) {
      frame([&] {
        const fs::path file = question_.draw(open_, [&] {
          return FileQuestion::Place{.first = folder_ / "", .places = {}, .own = own_};
        });
        if (!file.empty()) chosen_ = file;
      });
    }
  }
  template <class Done>
  bool until(Done done) {
    return test::until(done, [&] {
      frames(1);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    });
  }
  static bool says(const std::string& what) { return words().find(what) != std::string::npos; }
  static std::string words() {
    std::string all;
    for (const test::DrawnText& each : test::drawn_texts()) all += each.text + '\n';
    return all;
  }
  // Asks; the desktop's dialog is shown.
  void shown() {
    open_ = true;
    frames(2);
    ASSERT_TRUE(portal_->is_asked(true));
    ASSERT_TRUE(until([&] { return says("Choose the file in your desktop's own dialog."); }));
    frames(3);
    EXPECT_TRUE(says("Open scene"));
    EXPECT_TRUE(open_);
  }
  void click(const std::string& text) {
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.text != text) continue;
      show_mouse(each.middle());
      frames(2);
      for (const bool down : {true, false}) {
        show_mouse_button(0, down);
        frames(1);
      }
      return frames(3);
    }
    ADD_FAILURE() << text << " is not in:\n" << words();
  }
  void expect_own_dialog() {
    EXPECT_TRUE(until([&] { return says("a scene.toml"); })) << words();
    EXPECT_FALSE(says("your desktop's own dialog"));
    EXPECT_TRUE(open_);
  }
  int open_windows() const { return ImGui::GetCurrentContext()->OpenPopupStack.Size; }

  const test::TempDir folder_;
  std::optional<StandInPortal> portal_;
  FileQuestion question_{{.title = "Open scene", .action = "Open", .extensions = {".toml"}}};
  bool open_ = false, own_ = false;
  fs::path chosen_;

 private:
  static constexpr const char* kVariable = "DBUS_SESSION_BUS_ADDRESS";
  static inline std::optional<std::string> before_;
  static inline std::optional<test::PrivateBus> bus_;
};

TEST_F(AFileQuestion, TakesTheFileOfTheDesktopsDialog) {
  for (int i = 0; i < 2; ++i) {
    shown();
    portal_->end(folder_ / "a scene.toml");
    ASSERT_TRUE(until([&] { return !open_; }));
    EXPECT_EQ(chosen_, folder_ / "a scene.toml");
    chosen_.clear();
    frames(3);
    EXPECT_EQ(words(), "") << "and is gone";
    EXPECT_EQ(open_windows(), 0);
  }
}

TEST_F(AFileQuestion, IsGivenUpThereOrHere) {
  shown();
  portal_->end({});
  ASSERT_TRUE(until([&] { return !open_; }));
  frames(3);
  EXPECT_EQ(open_windows(), 0);
  shown();
  click("Cancel (Esc)");
  EXPECT_FALSE(open_);
  EXPECT_EQ(open_windows(), 0);
  EXPECT_TRUE(chosen_.empty());
}

TEST_F(AFileQuestion, IsAskedHereIfSomebodyDoesNotFindTheOther) {
  shown();
  click("Ask here instead");
  expect_own_dialog();
  click("a scene.toml");
  click("Open");
  EXPECT_EQ(chosen_, folder_ / "a scene.toml");
  EXPECT_FALSE(open_);
}

TEST_F(AFileQuestion, IsAskedHereWhereTheDesktopHasNoDialogOrItIsNotWanted) {
  open_ = true;
  frames(2);
  ASSERT_TRUE(portal_->is_asked(false));
  expect_own_dialog();
  click("Cancel (Esc)");
  EXPECT_FALSE(open_);
  own_ = open_ = true;
  frames(4);
  EXPECT_TRUE(says("a scene.toml")) << "at once";
}

TEST_F(AFileQuestion, GoesOnHereWithAFileThatCannotBeTaken) {
  shown();
  portal_->end(folder_ / "gone.toml");
  ASSERT_TRUE(until([&] { return says("There is no such file."); }));
  expect_own_dialog();
  EXPECT_TRUE(chosen_.empty());
}

}  // namespace
}  // namespace limpid
