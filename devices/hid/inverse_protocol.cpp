#include "devices/hid/inverse_protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/dynamics/arm_description.h"
#include "core/realtime/clock.h"
#include "devices/hid/hid_transport.h"

namespace limpid {
namespace {

using nlohmann::json;
using Cursor = std::array<double, 3>;  // [m] or [N]

constexpr std::array kAxes{"x", "y", "z"};
// Data sheet: the force that it holds in 80 % of its workspace; for a moment it can do 10 N.
constexpr double kForce = 4;          // along each axis [N]
constexpr double kResolution = 1e-5;  // [m]
constexpr double kRate = 1000;        // commands a second [Hz]
// Limits as in assets/devices/inverse3.urdf, which gives their source.
constexpr Cursor kLower{-0.25, -0.27, 0}, kUpper{0.25, 0.03, 0.32};  // [m]

// The value of a key; null if there is none, also in what is no object.
const json& at(const json& object, const char* key) {
  static const json kNothing;
  if (!object.is_object()) return kNothing;
  const auto found = object.find(key);
  return found == object.end() ? kNothing : *found;
}

json parsed(std::span<const std::uint8_t> report) {
  if (report.empty()) return {};
  const auto text = report.subspan(1);
  return json::parse(text.begin(), text.end(), nullptr, false);
}

std::optional<Cursor> vector_in(const json& object) {
  Cursor values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const json& value = at(object, kAxes[i]);
    if (!value.is_number()) return std::nullopt;
    values[i] = value.get<double>();
    if (!std::isfinite(values[i])) return std::nullopt;
  }
  return values;
}

std::string text_of(const json& value) { return value.is_string() ? value.get<std::string>() : ""; }

// The device in a message; null if the message has no such device.
const json& device_in(const json& message, const std::string& id) {
  static const json kNothing;
  const json& devices = at(message, "inverse3");
  if (!devices.is_array()) return kNothing;
  for (const json& device : devices) {
    const std::string own = text_of(at(device, "device_id"));
    if (!own.empty() && (id.empty() || own == id)) return device;
  }
  return kNothing;
}

bool says_no(const json& status, const char* key) {
  const json& value = at(status, key);
  return value.is_boolean() && !value.get<bool>();
}

bool ill(const json& status) {
  return says_no(status, "ready") || says_no(status, "calibrated") ||
         says_no(status, "power_supply");
}

bool other_basis(const std::string& basis) { return basis != "XYZ"; }
bool other_preset(const std::string& preset) {
  return preset != "defaults" && preset != "arm_front";
}
bool moved(const json& transform) {
  const json& inner = at(transform, "transform").is_null() ? transform : transform["transform"];
  const Cursor one{1, 1, 1}, zero{};
  return vector_in(at(inner, "scale")).value_or(one) != one ||
         vector_in(at(inner, "position")).value_or(zero) != zero ||
         vector_in(at(inner, "rotation")).value_or(zero) != zero;
}

// A frame that is not the device's own, for people; empty if it is. What the service does not say
// is as it is initially.
std::string other_frame(const json& config, const json& workspace) {
  const std::string basis = text_of(at(at(config, "basis"), "permutation"));
  if (!basis.empty() && other_basis(basis)) return fmt::format("the basis {}; needed: XYZ", basis);
  const std::string preset = text_of(at(config, "preset"));
  if (!preset.empty() && other_preset(preset)) {
    return fmt::format("the preset {}; needed: defaults or arm_front", preset);
  }
  if (moved(at(config, "mount")) || moved(workspace)) {
    return "a mount or a workspace that is shifted, rotated or scaled; needed: no shift, no "
           "rotation, no scaling";
  }
  return {};
}

}  // namespace

std::vector<std::string> inverse_ids(std::span<const std::uint8_t> report) {
  std::vector<std::string> ids;
  const json message = parsed(report);
  const json& devices = at(message, "inverse3");
  if (!devices.is_array()) return ids;
  for (const json& device : devices) {
    if (std::string id = text_of(at(device, "device_id")); !id.empty())
      ids.push_back(std::move(id));
  }
  return ids;
}

void InverseProtocol::open(HidTransport& transport) {
  Report first(HidTransport::kMaxMessage);
  const int size = transport.read(first, kFirstMessage);
  first.resize(static_cast<std::size_t>(std::max(size, 0)));
  const json message = parsed(first);
  if (!at(message, "inverse3").is_array()) {
    throw HidError(
        "the service does not list its devices; needed: Haply Inverse Service 3.1 to 3.5");
  }
  const json& device = device_in(message, id_);
  if (device.is_null()) {
    throw HidError(id_.empty() ? "the service has no Inverse3"
                               : fmt::format("the service has no Inverse3 {}", id_));
  }
  if (const std::string frame =
          other_frame(at(device, "config"), at(at(device, "state"), "transform"));
      !frame.empty()) {
    throw HidError("the service is set to " + frame);
  }
  id_ = text_of(at(device, "device_id"));
  fault_ = ill(at(device, "status"));
  traits_.dof = 3;
  traits_.pushes = true;
  traits_.rate = kRate;
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    traits_.lower.push_back(kLower[i] / kSlideUnit);
    traits_.upper.push_back(kUpper[i] / kSlideUnit);
    traits_.resolution.push_back(kResolution / kSlideUnit);
    traits_.effort.push_back(kForce * kSlideUnit);
  }
  stop_reports_ = {command({})};
}

// Refuses a jump that no hand makes: it is a damaged reading, or another device's.
bool InverseProtocol::follows(const Cursor& cursor) {
  double distance = 0;
  for (std::size_t i = 0; i < cursor.size(); ++i) {
    if (std::abs(cursor[i]) > kFarthest) return false;
    distance = std::max(distance, std::abs(cursor[i] - cursor_[i]));
  }
  return !seen_any_ || distance <= kLeap + kFastest * in_seconds(now_ - seen_);
}

// Follows the frame, which other programs can turn, move or scale at any time. What a message does
// not say has not changed.
template <class Json>
void InverseProtocol::follow_frame(const Json& config, const Json& workspace) {
  const std::string basis = text_of(at(at(config, "basis"), "permutation"));
  const std::string preset = text_of(at(config, "preset"));
  const Json& mount = at(config, "mount");
  if (!basis.empty()) other_frame_[0] = other_basis(basis);
  if (!preset.empty()) other_frame_[1] = other_preset(preset);
  if (!mount.is_null()) other_frame_[2] = moved(mount);
  if (!workspace.is_null()) other_frame_[3] = moved(workspace);
}

Decoded InverseProtocol::decode(std::span<const std::uint8_t> report,
                                DeviceReading& reading) noexcept {
  unanswered_ = std::max(0, unanswered_ - 1);
  const json message = parsed(report);
  const json& device = device_in(message, id_);
  follow_frame(at(device, "config"), at(at(device, "state"), "transform"));
  const auto cursor = vector_in(at(at(device, "state"), "cursor_position"));
  if (!cursor || !follows(*cursor)) {
    if (!other_frame_.any()) return Decoded::unusable;
    reading.fault = true;  // its position may be in the other frame
    return Decoded::status;
  }
  cursor_ = *cursor;
  seen_ = now_;
  seen_any_ = true;
  if (const json& status = at(device, "status"); status.is_object()) fault_ = ill(status);
  reading.fault = fault_ || other_frame_.any();
  for (std::size_t i = 0; i < cursor_.size(); ++i) reading.x[i] = cursor_[i] / kSlideUnit;
  take_buttons(at(message, "wireless_verse_grip"), reading);
  return Decoded::reading;
}

// Takes the buttons of the grip that was alone in the first list that had any. Of several grips
// nobody knows which one is in the hand that holds the device.
template <class Json>
void InverseProtocol::take_buttons(const Json& grips, DeviceReading& reading) {
  reading.buttons = reading.buttons_known = 0;
  if (!grips.is_array() || grips.empty()) return;
  if (!std::exchange(seen_grips_, true) && grips.size() == 1) {
    grip_ = text_of(at(grips.front(), "device_id"));
  }
  for (const Json& grip : grips) {
    if (grip_.empty() || text_of(at(grip, "device_id")) != grip_) continue;
    const Json& buttons = at(at(grip, "state"), "buttons");
    for (std::uint32_t i = 0; const char* name : {"a", "b", "c"}) {
      const Json& pressed = at(buttons, name);
      const std::uint32_t bit = 1u << i++;
      if (!pressed.is_boolean()) continue;
      reading.buttons_known |= bit;
      if (pressed.template get<bool>()) reading.buttons |= bit;
    }
  }
}

Report InverseProtocol::command(const Cursor& force) const {
  Report report{0};
  // Writes the id as JSON: it may contain quotation marks.
  fmt::format_to(std::back_inserter(report),
                 R"({{"inverse3":[{{"device_id":{},"commands":{{"set_cursor_force":{{"values":)"
                 R"({{"x":{:.5f},"y":{:.5f},"z":{:.5f}}}}}}}}}]}})",
                 json(id_).dump(-1, ' ', false, json::error_handler_t::replace), force[0], force[1],
                 force[2]);
  return report;
}

void InverseProtocol::encode(std::span<const double> torque, nanoseconds now,
                             const SendReport& send) noexcept {
  now_ = now;
  Cursor force{};
  for (std::size_t i = 0; i < std::min(torque.size(), force.size()); ++i) {
    force[i] = torque[i] / kSlideUnit;
  }
  const bool any = std::ranges::any_of(force, [](double f) { return f != 0; });
  const bool again = zero_lost_ && now - asked_ >= kZeroAgain;
  const bool lets_go = !any && (pushing_ || again);
  if (unanswered_ > 0 && !lets_go && now - asked_ < kAskAgain) return;
  if (now - asked_ >= kAskAgain) unanswered_ = 0;
  ++unanswered_;
  asked_ = now;
  pushing_ = any;
  zero_lost_ = false;
  send(command(force));
}

// A lost zero is sent again without waiting for an answer.
void InverseProtocol::undelivered() noexcept { zero_lost_ = !pushing_; }

}  // namespace limpid
