// RealtimeKit's answers, from a stand-in on a bus of the test's own.
#include "app/live/rtkit.h"

#include <dbus/dbus.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <functional>
#include <future>
#include <optional>
#include <string>

#include "tests/support/private_bus.h"

namespace limpid {
namespace {

constexpr const char* kName = "org.freedesktop.RealtimeKit1";

struct Asked {
  std::string method;
  dbus_uint64_t process = 0, thread = 0;
  dbus_uint32_t priority = 0;
};
struct Outcome {
  bool granted = false;
  std::string why;
  Asked asked;
};

// Outcome of ask_rtkit() for an answer to its only question; an empty `answer` gives none.
Outcome ask(const std::function<DBusMessage*(DBusMessage*)>& answer) {
  Outcome outcome;
  DBusConnection* kit = dbus_bus_get_private(DBUS_BUS_SYSTEM, nullptr);
  dbus_connection_set_exit_on_disconnect(kit, FALSE);
  dbus_bus_request_name(kit, kName, 0, nullptr);
  auto asking =
      std::async(std::launch::async, [&] { outcome.granted = ask_rtkit(4711, 20, &outcome.why); });
  while (asking.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    dbus_connection_read_write(kit, 10);
    DBusMessage* question = dbus_connection_pop_message(kit);
    if (question == nullptr) continue;
    Asked& asked = outcome.asked;
    if (dbus_message_get_args(question, nullptr, DBUS_TYPE_UINT64, &asked.process, DBUS_TYPE_UINT64,
                              &asked.thread, DBUS_TYPE_UINT32, &asked.priority,
                              DBUS_TYPE_INVALID)) {
      asked.method = dbus_message_get_member(question);
      if (DBusMessage* reply = answer(question)) {
        dbus_connection_send(kit, reply, nullptr);
        dbus_message_unref(reply);
      }
    }
    dbus_message_unref(question);
  }
  dbus_connection_close(kit);
  dbus_connection_unref(kit);
  return outcome;
}

class Rtkit : public testing::Test {
 protected:
  static void SetUpTestSuite() { bus_.emplace(); }
  static void TearDownTestSuite() { bus_.reset(); }
  void SetUp() override {
    if (!bus_->runs()) GTEST_SKIP() << "no dbus-daemon here";
  }

 private:
  static inline std::optional<test::PrivateBus> bus_;
};

TEST_F(Rtkit, IsAskedForTheThreadOfThisProcess) {
  const Outcome outcome =
      ask([](DBusMessage* question) { return dbus_message_new_method_return(question); });
  EXPECT_TRUE(outcome.granted) << outcome.why;
  EXPECT_EQ(outcome.asked.method, "MakeThreadRealtimeWithPID");
  EXPECT_EQ(outcome.asked.process, static_cast<dbus_uint64_t>(getpid()));
  EXPECT_EQ(outcome.asked.thread, 4711u);
  EXPECT_EQ(outcome.asked.priority, 20u);
}

TEST_F(Rtkit, SaysWhyItRefuses) {
  const Outcome outcome = ask([](DBusMessage* question) {
    return dbus_message_new_error(question, DBUS_ERROR_ACCESS_DENIED, "too many threads");
  });
  EXPECT_FALSE(outcome.granted);
  EXPECT_EQ(outcome.why, "rtkit: too many threads");
}

TEST_F(Rtkit, IsNotWaitedForForEver) {
  const Outcome outcome = ask([](DBusMessage*) -> DBusMessage* { return nullptr; });
  EXPECT_FALSE(outcome.granted);
  EXPECT_EQ(outcome.asked.thread, 4711u);
  EXPECT_EQ(outcome.why.substr(0, 7), "rtkit: ");
  EXPECT_GT(outcome.why.size(), 7u);
}

TEST_F(Rtkit, IsMissedInWords) {
  std::string why;
  EXPECT_FALSE(ask_rtkit(4711, 20, &why));
  EXPECT_NE(why.find(kName), std::string::npos) << why;
  EXPECT_FALSE(ask_rtkit(4711, 20, nullptr));
}

}  // namespace
}  // namespace limpid
