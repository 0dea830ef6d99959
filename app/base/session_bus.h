// The bus of the desktop's session (D-Bus), and files as its programs name them.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

struct DBusConnection;
struct DBusMessage;

namespace limpid {

struct CloseBus {
  void operator()(DBusConnection* bus) const;
};
struct FreeBusMessage {
  void operator()(DBusMessage* message) const;
};
using Bus = std::unique_ptr<DBusConnection, CloseBus>;
using BusMessage = std::unique_ptr<DBusMessage, FreeBusMessage>;

// Asking for a bus where there is none may start one.
bool has_session_bus();
// A connection of the caller's own: losing the shared one would end the process. Null where there
// is none. May take seconds: not for the window's thread.
Bus session_bus();

// "file:///home/a%20b"
std::string uri_of(const std::filesystem::path& file);
// Nothing where it is no file of this computer.
std::optional<std::filesystem::path> file_of(const std::string& uri);

}  // namespace limpid
