#include "app/base/session_bus.h"

#include <dbus/dbus.h>
#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cstdlib>
#include <string_view>

namespace limpid {

namespace fs = std::filesystem;

void CloseBus::operator()(DBusConnection* bus) const {
  dbus_connection_close(bus);
  dbus_connection_unref(bus);
}

void FreeBusMessage::operator()(DBusMessage* message) const { dbus_message_unref(message); }

bool has_session_bus() {
  const char* address = std::getenv("DBUS_SESSION_BUS_ADDRESS");
  if (address != nullptr && *address != '\0') return true;
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  std::error_code none;
  return runtime != nullptr && fs::exists(fs::path(runtime) / "bus", none);
}

Bus session_bus() {
  if (!has_session_bus()) return nullptr;
  Bus bus(dbus_bus_get_private(DBUS_BUS_SESSION, nullptr));
  if (bus) dbus_connection_set_exit_on_disconnect(bus.get(), FALSE);
  return bus;
}

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

// Follows RFC 8089: the name of the computer is empty or "localhost".
std::optional<fs::path> file_of(const std::string& uri) {
  constexpr std::string_view kScheme = "file://", kHere = "localhost";
  if (!uri.starts_with(kScheme)) return std::nullopt;
  std::string_view rest = std::string_view(uri).substr(kScheme.size());
  if (rest.starts_with(kHere)) rest.remove_prefix(kHere.size());
  if (!rest.starts_with('/')) return std::nullopt;
  std::string file;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (rest[i] != '%') {
      file += rest[i];
      continue;
    }
    if (i + 2 >= rest.size()) return std::nullopt;
    const char *begin = rest.data() + i + 1, *end = begin + 2;
    unsigned char byte = 0;
    const auto [stop, error] = std::from_chars(begin, end, byte, 16);
    if (error != std::errc() || stop != end || byte == 0) return std::nullopt;
    file += static_cast<char>(byte);
    i += 2;
  }
  return file;
}

}  // namespace limpid
