#include "app/base/open_elsewhere.h"

#include <dbus/dbus.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <string>

#include "app/base/session_bus.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr int kPatience = 3000;  // longest wait for an answer over D-Bus [ms]

bool ask_file_manager(const fs::path& file) {
  const Bus bus = session_bus();
  if (!bus) return false;
  const BusMessage call(dbus_message_new_method_call("org.freedesktop.FileManager1",
                                                     "/org/freedesktop/FileManager1",
                                                     "org.freedesktop.FileManager1", "ShowItems"));
  const std::string uri = uri_of(file);
  const char* const item = uri.c_str();
  const char* const* const items = &item;
  const char* const startup = "";
  if (!call || !dbus_message_append_args(call.get(), DBUS_TYPE_ARRAY, DBUS_TYPE_STRING, &items, 1,
                                         DBUS_TYPE_STRING, &startup, DBUS_TYPE_INVALID)) {
    return false;
  }
  const BusMessage answer(
      dbus_connection_send_with_reply_and_block(bus.get(), call.get(), kPatience, nullptr));
  return answer != nullptr;
}

}  // namespace

// Starts xdg-open from a shell, which does not wait for it: it may run for hours.
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
