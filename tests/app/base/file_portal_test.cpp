// Questions to the desktop's file dialog, answered by a stand-in on a bus of the test's own.
#include "app/base/file_portal.h"

#include <dbus/dbus.h>
#include <gmock/gmock.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <thread>

#include "app/base/session_bus.h"
#include "tests/support/portal_response.h"
#include "tests/support/private_bus.h"

namespace limpid {
namespace {

using namespace std::chrono_literals;

using State = FilePortal::State;

constexpr const char* kPortalName = "org.freedesktop.portal.Desktop";

template <class Done>
bool within(std::chrono::milliseconds time, const Done& done) {
  const auto end = std::chrono::steady_clock::now() + time;
  while (std::chrono::steady_clock::now() < end) {
    if (done()) return true;
    std::this_thread::sleep_for(2ms);
  }
  return done();
}

// Call of a method, as the portal sees it: its texts, and its options by name. Of bytes and of
// filters an option has the text.
struct Call {
  BusMessage message;
  std::string method, sender;
  std::vector<std::string> texts;
  std::map<std::string, std::string> options;

  // Path of the dialog's request, as the portal's documentation makes it of sender and token.
  std::string handle() const {
    std::string name = sender.substr(1);
    std::ranges::replace(name, '.', '_');
    return "/org/freedesktop/portal/desktop/request/" + name + "/" + options.at("handle_token");
  }
};

// Writes a value; texts, bytes with their end as \0, numbers, lists and structures in brackets.
std::string text_of(DBusMessageIter at) {
  const int type = dbus_message_iter_get_arg_type(&at);
  if (type == DBUS_TYPE_STRING) {
    const char* text = nullptr;
    dbus_message_iter_get_basic(&at, &text);
    return text;
  }
  if (type == DBUS_TYPE_UINT32) {
    dbus_uint32_t number = 0;
    dbus_message_iter_get_basic(&at, &number);
    return std::to_string(number);
  }
  if (type == DBUS_TYPE_BYTE) {
    char byte = 0;
    dbus_message_iter_get_basic(&at, &byte);
    return byte == '\0' ? "\\0" : std::string(1, byte);
  }
  DBusMessageIter in;
  dbus_message_iter_recurse(&at, &in);
  if (type == DBUS_TYPE_VARIANT) return text_of(in);
  const bool bytes = dbus_message_iter_get_arg_type(&in) == DBUS_TYPE_BYTE;
  std::string all;
  for (; dbus_message_iter_get_arg_type(&in) != DBUS_TYPE_INVALID; dbus_message_iter_next(&in)) {
    all += (all.empty() || bytes ? "" : " ") + text_of(in);
  }
  return bytes ? all : "(" + all + ")";
}

// The desktop: it has the portal's name, hears calls and answers them.
class Desk {
 public:
  Desk() : bus_(session_bus()) { dbus_bus_request_name(bus_.get(), kPortalName, 0, nullptr); }

  std::optional<Call> call() {
    std::optional<Call> found;
    within(1min, [&] {
      dbus_connection_read_write(bus_.get(), 0);
      BusMessage message(dbus_connection_pop_message(bus_.get()));
      if (!message || dbus_message_get_type(message.get()) != DBUS_MESSAGE_TYPE_METHOD_CALL) {
        return false;
      }
      found = read(std::move(message));
      return true;
    });
    return found;
  }
  void reply(const Call& call, const std::string& handle) {
    const BusMessage reply(dbus_message_new_method_return(call.message.get()));
    const char* const path = handle.c_str();
    dbus_message_append_args(reply.get(), DBUS_TYPE_OBJECT_PATH, &path, DBUS_TYPE_INVALID);
    send(reply);
  }
  void reply(const Call& call) { reply(call, call.handle()); }
  void refuse(const Call& call) {
    send(BusMessage(
        dbus_message_new_error(call.message.get(), DBUS_ERROR_UNKNOWN_METHOD, "no such method")));
  }
  // Ends a dialog: `how` 0 with this address of a file.
  void respond(const std::string& handle, dbus_uint32_t how, const std::string& uri = "") {
    send(test::portal_response(handle, how, uri));
  }
  // Answers a question about a property with a number.
  void tell(const Call& call, dbus_uint32_t number) {
    const BusMessage reply(dbus_message_new_method_return(call.message.get()));
    DBusMessageIter at, value;
    dbus_message_iter_init_append(reply.get(), &at);
    dbus_message_iter_open_container(&at, DBUS_TYPE_VARIANT, "u", &value);
    dbus_message_iter_append_basic(&value, DBUS_TYPE_UINT32, &number);
    dbus_message_iter_close_container(&at, &value);
    send(reply);
  }

 private:
  static Call read(BusMessage message) {
    Call call;
    call.message = std::move(message);
    call.method = dbus_message_get_member(call.message.get());
    call.sender = dbus_message_get_sender(call.message.get());
    DBusMessageIter at, entry, pair;
    dbus_message_iter_init(call.message.get(), &at);
    for (; dbus_message_iter_get_arg_type(&at) == DBUS_TYPE_STRING; dbus_message_iter_next(&at)) {
      call.texts.push_back(text_of(at));
    }
    if (dbus_message_iter_get_arg_type(&at) != DBUS_TYPE_ARRAY) return call;
    for (dbus_message_iter_recurse(&at, &entry);
         dbus_message_iter_get_arg_type(&entry) == DBUS_TYPE_DICT_ENTRY;
         dbus_message_iter_next(&entry)) {
      dbus_message_iter_recurse(&entry, &pair);
      const std::string name = text_of(pair);
      dbus_message_iter_next(&pair);
      call.options[name] = text_of(pair);
    }
    return call;
  }
  void send(const BusMessage& message) {
    dbus_connection_send(bus_.get(), message.get(), nullptr);
    dbus_connection_flush(bus_.get());
  }

  Bus bus_;
};

const FilePortal::Question kOpen{.title = "Open scene",
                                 .action = "Open",
                                 .extensions = {".toml", ".h5"},
                                 .first = "/a folder/",
                                 .parent = "x11:4a"};

class AFilePortal : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const char* before = std::getenv(kVariable);
    if (before != nullptr) before_ = before;
    bus_.emplace();
  }
  static void TearDownTestSuite() {
    bus_.reset();
    before_ ? setenv(kVariable, before_->c_str(), 1) : unsetenv(kVariable);
  }
  void SetUp() override {
    if (!bus_->runs()) GTEST_SKIP() << "no dbus-daemon here";
    desk_.emplace();
  }

  // Asks; the dialog is shown.
  Call shown() {
    portal_.emplace(kOpen);
    Call call = *desk_->call();
    desk_->reply(call);
    EXPECT_TRUE(becomes(State::shown));
    return call;
  }
  bool becomes(State state, std::chrono::milliseconds time = 1min) {
    return within(time, [&] { return portal_->state() == state; });
  }
  // Returns whether the dialog of this handle is closed.
  bool closed(const std::string& handle) {
    const auto call = desk_->call();
    if (!call || call->method != "Close") return false;
    EXPECT_TRUE(dbus_message_get_no_reply(call->message.get())) << "nobody waits for an answer";
    return dbus_message_get_path(call->message.get()) == handle;
  }

  std::optional<Desk> desk_;
  std::optional<FilePortal> portal_;

 private:
  static constexpr const char* kVariable = "DBUS_SESSION_BUS_ADDRESS";
  static inline std::optional<std::string> before_;
  static inline std::optional<test::PrivateBus> bus_;
};

TEST_F(AFilePortal, IsAskedForWhatIsWanted) {
  portal_.emplace(kOpen);
  const auto call = desk_->call();
  ASSERT_TRUE(call);
  EXPECT_EQ(call->method, "OpenFile");
  EXPECT_EQ(call->texts, (std::vector<std::string>{"x11:4a", "Open scene"}));
  EXPECT_EQ(call->options.at("accept_label"), "Open");
  EXPECT_EQ(call->options.at("current_folder"), "/a folder\\0");
  EXPECT_EQ(call->options.at("filters"), "((*.toml, *.h5 ((0 *.[tT][oO][mM][lL]) (0 *.[hH]5))))");
  EXPECT_FALSE(call->options.contains("current_name"));
  portal_.emplace(FilePortal::Question{.title = "Save",
                                       .action = "Save",
                                       .extensions = {},
                                       .new_file = true,
                                       .first = "/b/scene.toml",
                                       .parent = {}});
  const auto save = desk_->call();
  ASSERT_TRUE(save);
  EXPECT_EQ(save->method, "SaveFile");
  EXPECT_EQ(save->options.at("current_folder"), "/b\\0");
  EXPECT_EQ(save->options.at("current_name"), "scene.toml");
  EXPECT_NE(save->options.at("handle_token"), call->options.at("handle_token"));
}

TEST_F(AFilePortal, IsShownAndThenGivesTheFile) {
  const Call call = shown();
  desk_->respond(call.handle() + "0", 1);  // another dialog's
  EXPECT_FALSE(becomes(State::given_up, 100ms));
  desk_->respond(call.handle(), 0, "file:///a%20b.toml");
  EXPECT_TRUE(becomes(State::chosen));
  EXPECT_EQ(portal_->file(), "/a b.toml");
}

TEST_F(AFilePortal, IsHeardUnderTheHandleThatItChooses) {
  portal_.emplace(kOpen);
  const auto call = desk_->call();
  ASSERT_TRUE(call);
  const std::string handle = "/org/freedesktop/portal/desktop/request/own/1";
  desk_->reply(*call, handle);
  EXPECT_TRUE(within(1min, [&] {
    desk_->respond(handle, 0, "file:///a.toml");
    return portal_->state() == State::chosen;
  }));
}

TEST_F(AFilePortal, IsGivenUpByThePerson) {
  desk_->respond(shown().handle(), 1);
  EXPECT_TRUE(becomes(State::given_up));
}

TEST_F(AFilePortal, IsAbsentWhereItEndsOtherwise) {
  desk_->respond(shown().handle(), 2);
  EXPECT_TRUE(becomes(State::absent)) << "it failed";
  desk_->respond(shown().handle(), 0, "sftp://host/a.toml");
  EXPECT_TRUE(becomes(State::absent)) << "of another computer";
  desk_->respond(shown().handle(), 0);
  EXPECT_TRUE(becomes(State::absent)) << "nothing is chosen";
  portal_.emplace(kOpen);
  desk_->refuse(*desk_->call());
  EXPECT_TRUE(becomes(State::absent, 600ms)) << "it knows no such question";
  shown();
  desk_.reset();
  EXPECT_TRUE(becomes(State::absent)) << "it has gone";
}

TEST_F(AFilePortal, IsClosedByWhoLeaves) {
  const Call call = shown();
  portal_.reset();
  EXPECT_TRUE(closed(call.handle()));
}

TEST_F(AFilePortal, IsClosedWhereItComesTooLate) {
  portal_.emplace(kOpen);
  const auto call = desk_->call();
  ASSERT_TRUE(call);
  EXPECT_EQ(portal_->state(), State::asked);
  EXPECT_TRUE(becomes(State::absent, 1500ms));
  desk_->reply(*call);
  EXPECT_TRUE(closed(call->handle()));
  EXPECT_EQ(portal_->state(), State::absent);
}

TEST_F(AFilePortal, IsAbsentWhereNobodyHasIt) {
  desk_.reset();
  portal_.emplace(kOpen);
  EXPECT_TRUE(becomes(State::absent, 600ms));
}

TEST_F(AFilePortal, TellsItsVersion) {
  std::optional<unsigned> version;
  std::thread asking([&] { version = file_portal_version(); });
  const auto call = desk_->call();
  if (call) desk_->tell(*call, 4);
  asking.join();
  ASSERT_TRUE(call);
  EXPECT_EQ(call->texts,
            (std::vector<std::string>{"org.freedesktop.portal.FileChooser", "version"}));
  EXPECT_EQ(version, 4u);
  desk_.reset();
  EXPECT_FALSE(file_portal_version()) << "nobody has it";
}

}  // namespace
}  // namespace limpid
