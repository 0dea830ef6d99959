#include "app/live/rtkit.h"

#include <dbus/dbus.h>
#include <unistd.h>

#include <cstdint>
#include <memory>

namespace limpid {
namespace {

constexpr int kTimeout = 1000;  // [ms]

struct Error : DBusError {
  Error() { dbus_error_init(this); }
  ~Error() { dbus_error_free(this); }
  Error(const Error&) = delete;
  Error& operator=(const Error&) = delete;
};

struct CloseConnection {
  void operator()(DBusConnection* connection) const {
    dbus_connection_close(connection);
    dbus_connection_unref(connection);
  }
};
struct FreeMessage {
  void operator()(DBusMessage* message) const { dbus_message_unref(message); }
};
using Connection = std::unique_ptr<DBusConnection, CloseConnection>;
using Message = std::unique_ptr<DBusMessage, FreeMessage>;

// A private connection: losing the shared one would make libdbus end the process.
Connection connect(Error& error) {
  Connection bus(dbus_bus_get_private(DBUS_BUS_SYSTEM, &error));
  if (bus) dbus_connection_set_exit_on_disconnect(bus.get(), FALSE);
  return bus;
}

Message request(pid_t tid, int priority) {
  Message message(
      dbus_message_new_method_call("org.freedesktop.RealtimeKit1", "/org/freedesktop/RealtimeKit1",
                                   "org.freedesktop.RealtimeKit1", "MakeThreadRealtimeWithPID"));
  const auto process = static_cast<std::uint64_t>(getpid());
  const auto thread = static_cast<std::uint64_t>(tid);
  const auto wanted = static_cast<std::uint32_t>(priority);
  if (message &&
      !dbus_message_append_args(message.get(), DBUS_TYPE_UINT64, &process, DBUS_TYPE_UINT64,
                                &thread, DBUS_TYPE_UINT32, &wanted, DBUS_TYPE_INVALID))
    message.reset();
  return message;
}

bool refused(std::string* why, const std::string& reason) {
  if (why) *why = "rtkit: " + reason;
  return false;
}

}  // namespace

bool ask_rtkit(pid_t tid, int priority, std::string* why) {
  Error error;
  const Connection bus = connect(error);
  if (!bus) return refused(why, error.message);
  const Message question = request(tid, priority);
  if (!question) return refused(why, "out of memory");
  const Message answer(
      dbus_connection_send_with_reply_and_block(bus.get(), question.get(), kTimeout, &error));
  return answer ? true : refused(why, error.message);
}

AskForPriority by_rtkit() {
  return [](pid_t tid, int priority) { return ask_rtkit(tid, priority, nullptr); };
}

}  // namespace limpid
