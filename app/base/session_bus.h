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

// Returns whether there is a bus: asking for one where there is none may start it.
bool has_session_bus();
// Connects for the caller alone: losing the shared connection would end the process. Null if there
// is no bus. May take seconds: not for the window's thread.
Bus session_bus();

// Returns "file:///home/a%20b".
std::string uri_of(const std::filesystem::path& file);
// Returns nothing for an address that is no file of this computer.
std::optional<std::filesystem::path> file_of(const std::string& uri);

}  // namespace limpid
