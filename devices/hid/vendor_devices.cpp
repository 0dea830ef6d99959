#include "devices/hid/vendor_devices.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "core/base/child.h"
#include "core/base/descriptor.h"
#include "devices/hid/raw_device.h"
#include "devices/hid/raw_protocol.h"
#include "devices/hid/transports.h"
#include "devices/hid/vendor_kinds.h"

namespace limpid {
namespace {

using Clock = std::chrono::steady_clock;
using nlohmann::json;

constexpr std::chrono::seconds kLongestList{15};
constexpr std::size_t kMostText = 64 * 1024;

#define KIND(key_, name_, maker, ...)                                        \
  DeviceKind{.key = #key_,                                                   \
             .name = name_ " device",                                        \
             .use = "has a tip that moves in three directions; gives force", \
             .pushes = true,                                                 \
             .arm = #key_ ".urdf",                                           \
             .service = true},
constexpr std::array kKinds{LIMPID_VENDORS(KIND)};
#undef KIND

const DeviceKind* kind_of(const std::string& back_end) {
  const auto found =
      std::ranges::find_if(kKinds, [&](const DeviceKind& kind) { return back_end == kind.key; });
  return found == kKinds.end() ? nullptr : &*found;
}

struct VendorName {
  std::string back_end, name;
};

std::optional<VendorName> vendor_name(const std::string& id) {
  const auto colon = id.find(':');
  if (colon == std::string::npos || kind_of(id.substr(0, colon)) == nullptr) return std::nullopt;
  return VendorName{id.substr(0, colon), id.substr(colon + 1)};
}

// Reads until the other end closes, for some time at most.
std::string read_all(int file, Clock::time_point until) {
  std::string text;
  std::array<char, 4096> piece;
  while (text.size() < kMostText) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now()).count();
    pollfd ready{file, POLLIN, 0};
    if (left <= 0 || ::poll(&ready, 1, static_cast<int>(left)) <= 0) return text;
    const ssize_t size = ::read(file, piece.data(), piece.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return text;
    text.append(piece.data(), static_cast<std::size_t>(size));
  }
  return text;
}

std::string text_at(const json& line, const char* key) {
  const auto found = line.find(key);
  return found != line.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::optional<VendorLine> read_line(const std::string& text) {
  const json line = json::parse(text, nullptr, false);
  if (!line.is_object()) return std::nullopt;
  VendorLine read;
  read.back_end = text_at(line, "backend");
  read.is_device = line.contains("device");
  read.name = text_at(line, read.is_device ? "device" : "library");
  read.title = text_at(line, "title");
  read.missing = text_at(line, "missing");
  read.version = text_at(line, "version");
  read.absent = line.value("absent", json(false)) == json(true);
  if (read.back_end.empty()) return std::nullopt;
  return read;
}

std::unique_ptr<Device> open_vendor_device(const FoundDevice& found, const PidSettings&,
                                           const AskForPriority& ask, DeviceClaim claim) {
  try {
    const VendorName which = vendor_name(found.place.id).value();
    auto transport = open_vendor(which.back_end, which.name, claim.descriptor());
    return std::make_unique<HidDevice>(
        std::move(transport), std::make_unique<RawProtocol>(),
        HidPlace{found.place.name, found.place.id, "", found.place.library}, ask, std::move(claim));
  } catch (const HidError& error) {
    throw HidError(fmt::format("{}: {}", found.place.name, error.what()));
  }
}

std::string claim_key(const FoundDevice& found) {
  const VendorName which = vendor_name(found.place.id).value();
  return vendor_claim_key(which.back_end, which.name);
}

// The library's own line among `lines`; null if there is none.
const VendorLine* library_line(const std::vector<VendorLine>& lines, const std::string& back_end) {
  const auto found = std::ranges::find_if(
      lines, [&](const VendorLine& line) { return !line.is_device && line.back_end == back_end; });
  return found == lines.end() ? nullptr : &*found;
}

FoundDevice found_device(const DeviceKind& kind, const std::string& name, const std::string& title,
                         const std::string& missing, const VendorLine* library) {
  const std::string id = fmt::format("{}:{}", kind.key, name);
  FoundDevice found{{title, id, fmt::format("{} {} \"{}\"", kVendorProgram, kind.key, name)},
                    &kind,
                    missing,
                    open_vendor_device,
                    claim_key};
  if (library != nullptr) {
    found.place.library = library->name;
    found.version = library->version;
  }
  return found;
}

}  // namespace

std::vector<VendorLine> ask_vendors() {
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return {};
  const Descriptor answers(ends[0]), nowhere(::open("/dev/null", O_RDWR | O_CLOEXEC));
  Descriptor other_end(ends[1]);
  const std::array<Given, 3> given{Given{*nowhere, STDIN_FILENO}, Given{*other_end, STDOUT_FILENO},
                                   Given{*nowhere, STDERR_FILENO}};
  const Child child({own_program(kVendorProgram).string(), "list"}, given);
  other_end.close();
  if (!child.started()) return {};
  std::istringstream text(read_all(*answers, Clock::now() + kLongestList));
  std::vector<VendorLine> lines;
  for (std::string line; std::getline(text, line);) {
    if (const auto read = read_line(line)) lines.push_back(*read);
  }
  return lines;
}

std::vector<FoundDevice> list_vendor_devices(const std::vector<VendorLine>& lines,
                                             const std::string& wanted) {
  std::vector<FoundDevice> found;
  for (const VendorLine& line : lines) {
    const DeviceKind* const kind = kind_of(line.back_end);
    if (!line.is_device || kind == nullptr) continue;
    found.push_back(found_device(*kind, line.name, line.title, line.missing,
                                 library_line(lines, line.back_end)));
  }
  const auto name = vendor_name(wanted);
  if (!name || std::ranges::count(found, wanted, [](const auto& one) { return one.place.id; })) {
    return found;
  }
  if (const VendorLine* const library = library_line(lines, name->back_end)) {
    const DeviceKind& kind = *kind_of(name->back_end);
    found.push_back(found_device(kind, name->name, fmt::format("{} {}", kind.name, name->name),
                                 library->missing, library));
  }
  return found;
}

const DeviceKind* vendor_kind(const std::string& id) {
  const auto name = vendor_name(id);
  return name ? kind_of(name->back_end) : nullptr;
}

std::unique_ptr<HidTransport> open_vendor(const std::string& back_end, const std::string& name,
                                          int claim) {
  std::array<int, 2> ends{-1, -1};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends.data()) != 0) {
    throw HidError("there are too many open files");
  }
  constexpr int kThere = 3, kClaim = 4;
  const Descriptor other_end(ends[1]);
  std::vector<Given> given{{*other_end, kThere}};
  if (claim >= 0) given.push_back({claim, kClaim});
  const std::string program = own_program(kVendorProgram).string();
  auto child = std::make_unique<Child>(
      std::vector<std::string>{program, back_end, name, "--connection", std::to_string(kThere)},
      given);
  if (!child->started()) {
    ::close(ends[0]);
    throw HidError(
        fmt::format("the program {}, which controls the device, cannot be started", program));
  }
  return open_socket_of(std::move(child), ends[0], kRefusal);
}

}  // namespace limpid
