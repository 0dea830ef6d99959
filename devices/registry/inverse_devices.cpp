#include "devices/registry/inverse_devices.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "devices/hid/hid_error.h"
#include "devices/inverse3/inverse_protocol.h"

namespace limpid {
namespace {

constexpr int kLook = 300;      // longest wait for a service that is looked for [ms]
constexpr int kConnect = 1000;  // for one that is used [ms]
constexpr std::string_view kKey = "inverse3";

constexpr DeviceKind kInverseKind{.key = "inverse3",
                                  .name = "Haply Inverse3",
                                  .use = "its tip in three directions, pushes",
                                  .pushes = true,
                                  .arm = "inverse3.urdf",
                                  .service = true};

bool is_port(const std::string& text) {
  unsigned port = 0;
  const char* end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, port);
  return error == std::errc{} && at == end && port >= 1 && port <= 65535;
}

std::unique_ptr<Device> open_inverse(const FoundDevice& found, const PidSettings&,
                                     const AskForPriority& ask, DeviceClaim claim) {
  try {
    const auto name = inverse_name(found.place.id);
    return std::make_unique<HidDevice>(open_web_socket(name.value().address, kConnect),
                                       std::make_unique<InverseProtocol>(name->id),
                                       HidPlace{found.place.name, found.place.id, ""}, ask,
                                       std::move(claim));
  } catch (const HidError& error) {
    throw HidError(fmt::format("{}: {}", found.place.name, error.what()));
  }
}

std::vector<std::string> ids_at(const ServiceAddress& address) {
  const auto service = open_web_socket(address, kLook);
  Report first(HidTransport::kMaxMessage);
  const int size = service->read(first, kLook);
  return inverse_ids(std::span(first).first(static_cast<std::size_t>(std::max(size, 0))));
}

// Whoever names none of a service's devices gets its first, and claims that one.
std::string inverse_claim_key(const FoundDevice& found) {
  const InverseName name = inverse_name(found.place.id).value();
  std::string id = name.id;
  if (id.empty()) {
    const std::vector<std::string> ids = ids_at(name.address);
    if (!ids.empty()) id = ids.front();
  }
  return fmt::format("inverse3:{}:{}", resolved(name.address), id);
}

FoundDevice entry(const InverseName& name, bool only, const std::string& missing) {
  const std::string place = name.address.text();
  const std::string which = only || name.id.empty() ? "" : " " + name.id;
  return {{fmt::format("Haply Inverse3{} ({})", which, place), name.text(), place},
          &kInverseKind,
          missing,
          open_inverse,
          inverse_claim_key};
}

}  // namespace

std::string InverseName::text() const {
  return fmt::format("{}{}{}@{}", kKey, id.empty() ? "" : ":", id, address.text());
}

std::optional<InverseName> inverse_name(const std::string& words) {
  if (!words.starts_with(kKey)) return std::nullopt;
  std::string rest = words.substr(kKey.size());
  if (!rest.empty() && rest[0] != ':' && rest[0] != '@') return std::nullopt;  // e.g. a file
  InverseName name;
  const auto refuse = [&] [[noreturn]] {
    throw HidError(fmt::format(
        "\"{}\" names no device; allowed: inverse3[:ID][@HOST[:PORT]], a port from 1 to 65535",
        words));
  };
  const auto place = rest.find('@');
  if (rest.starts_with(":")) {
    name.id = rest.substr(1, place == std::string::npos ? place : place - 1);
    if (name.id.empty()) refuse();
  }
  if (place == std::string::npos) return name;
  const std::string address = rest.substr(place + 1);
  const auto colon = address.rfind(':');
  name.address.host = address.substr(0, colon);
  if (colon != std::string::npos) name.address.port = address.substr(colon + 1);
  if (name.address.host.empty() || !is_port(name.address.port)) refuse();
  return name;
}

std::vector<FoundDevice> list_inverse_devices(const std::optional<InverseName>& wanted,
                                              const ServiceAddress& usual) {
  std::vector<ServiceAddress> places{usual};
  if (wanted && wanted->address != usual) places.push_back(wanted->address);
  std::vector<FoundDevice> found;
  for (const ServiceAddress& place : places) {
    const bool here = wanted && wanted->address == place;
    std::string missing =
        here && wanted->id.empty() ? "the service has no Inverse3" : "the service does not have it";
    std::vector<std::string> ids;
    try {
      ids = ids_at(place);
    } catch (const HidError& error) {
      missing = fmt::format("no Haply Inverse Service at {}", error.what());
    }
    for (const std::string& id : ids) found.push_back(entry({id, place}, ids.size() == 1, {}));
    const bool there =
        here && (wanted->id.empty() ? !ids.empty() : std::ranges::count(ids, wanted->id) > 0);
    if (here && !there) found.push_back(entry(*wanted, false, missing));
  }
  return found;
}

}  // namespace limpid
