#include "app/desktop/base/open_elsewhere.h"

#include <dbus/dbus.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <cstdlib>
#include <memory>
#include <string>

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr int kPatience = 3000;  // [ms]

// "file:///home/a%20b"
std::string uri_of(const fs::path& file) {
  std::string uri = "file://";
  for (const char c : fs::absolute(file).string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || std::string_view("/-_.~").find(c) != std::string_view::npos) {
      uri += c;
    } else {
      uri += fmt::format("%{:02X}", byte);
    }
  }
  return uri;
}

// Asking for the session's bus where there is none may start one.
bool has_session_bus() {
  if (std::getenv("DBUS_SESSION_BUS_ADDRESS") != nullptr) return true;
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  std::error_code none;
  return runtime != nullptr && fs::exists(fs::path(runtime) / "bus", none);
}

bool ask_file_manager(const fs::path& file) {
  if (!has_session_bus()) return false;
  DBusConnection* bus = dbus_bus_get_private(DBUS_BUS_SESSION, nullptr);
  if (bus == nullptr) return false;
  dbus_connection_set_exit_on_disconnect(bus, FALSE);
  const auto close = [](DBusConnection* each) {
    dbus_connection_close(each);
    dbus_connection_unref(each);
  };
  const std::unique_ptr<DBusConnection, decltype(close)> closing(bus, close);
  const auto free_message = [](DBusMessage* each) { dbus_message_unref(each); };
  using Message = std::unique_ptr<DBusMessage, decltype(free_message)>;
  const Message call(
      dbus_message_new_method_call("org.freedesktop.FileManager1", "/org/freedesktop/FileManager1",
                                   "org.freedesktop.FileManager1", "ShowItems"),
      free_message);
  const std::string uri = uri_of(file);
  const char* const item = uri.c_str();
  const char* const* const items = &item;
  const char* const startup = "";
  if (!call || !dbus_message_append_args(call.get(), DBUS_TYPE_ARRAY, DBUS_TYPE_STRING, &items, 1,
                                         DBUS_TYPE_STRING, &startup, DBUS_TYPE_INVALID)) {
    return false;
  }
  const Message answer(
      dbus_connection_send_with_reply_and_block(bus, call.get(), kPatience, nullptr), free_message);
  return answer != nullptr;
}

}  // namespace

// A shell of its own lets go of what xdg-open starts, which may run for hours.
bool open_elsewhere(const fs::path& file) {
  std::string shell = "/bin/sh", option = "-c",
              words = "command -v xdg-open >/dev/null || exit 1; xdg-open \"$0\" >/dev/null 2>&1 &",
              name = file.string();
  const std::array<char*, 5> arguments{shell.data(), option.data(), words.data(), name.data(),
                                       nullptr};
  pid_t child = -1;
  if (posix_spawn(&child, shell.c_str(), nullptr, nullptr, arguments.data(), environ) != 0) {
    return false;
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool show_in_folder(const fs::path& file) {
  return ask_file_manager(file) || open_elsewhere(file.parent_path());
}

}  // namespace limpid
