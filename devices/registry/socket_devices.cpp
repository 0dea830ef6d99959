#include "devices/registry/socket_devices.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>

#include "devices/hid/hid_error.h"
#include "devices/hid/protocols/raw_protocol.h"
#include "devices/hid/socket_transport.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr DeviceKind kSocketKind{
    .key = "socket", .name = "device on a socket", .use = "its own joints, pushes if it says so"};

// A program that has ended leaves its socket behind. The kernel tells by the error when one asks
// for a connection of another type, and the program learns nothing of it.
bool somebody_listens(const fs::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string text = path.string();
  if (text.size() >= sizeof(address.sun_path)) return true;  // opening it says what is wrong
  text.copy(address.sun_path, text.size());
  const int file = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (file < 0) return true;
  const int result = connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof(address));
  const bool refused = result < 0 && errno == ECONNREFUSED;
  close(file);
  return !refused;
}

std::string socket_claim_key(const FoundDevice& found) {
  std::error_code error;
  const fs::path path = fs::canonical(found.place.path, error);
  return "socket:" + (error ? found.place.path : path.string());
}

std::unique_ptr<Device> open_socket_device(const FoundDevice& found, const PidSettings&,
                                           const AskForPriority& ask, DeviceClaim claim) {
  try {
    // Without a path: the end of this process closes the connection, nobody has to watch over it.
    return std::make_unique<HidDevice>(
        open_socket(found.place.path), std::make_unique<RawProtocol>(),
        HidPlace{found.place.name, found.place.id, ""}, ask, std::move(claim));
  } catch (const HidError& error) {
    throw HidError(fmt::format("{}: {}", found.place.name, error.what()));
  }
}

}  // namespace

fs::path socket_folder() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  return runtime != nullptr && *runtime != '\0' ? fs::path(runtime) / "limpid" : fs::path();
}

std::vector<FoundDevice> list_socket_devices(const fs::path& folder) {
  std::vector<FoundDevice> found;
  std::error_code error;  // no such folder: no devices
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path& path = entry->path();
    if (path.extension() != ".device" || !somebody_listens(path)) continue;
    const std::string name = path.stem().string();
    found.push_back({{name, "socket:" + name, path.string()},
                     &kSocketKind,
                     {},
                     open_socket_device,
                     socket_claim_key});
  }
  std::ranges::sort(found, {}, [](const FoundDevice& one) { return one.place.path; });
  return found;
}

}  // namespace limpid
