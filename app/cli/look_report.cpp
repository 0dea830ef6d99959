#include "app/cli/look_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/run/provenance.h"

namespace limpid {
namespace {

using nlohmann::ordered_json;

// A line of the report: its subject, and what is said of it.
std::string look_line(const char* what, const std::string& said) {
  return fmt::format("{:<20} {}\n", what, said);
}

// Length or angle of a unit of the joint's coordinate, and its unit.
struct JointUnit {
  double per_unit;
  const char* name;
};
JointUnit unit_of(const LookedDevice& device, std::size_t joint) {
  const bool slides = device.arm.joints[joint].kind == Joint::Kind::prismatic;
  return slides ? JointUnit{kSlideUnit, "m"} : JointUnit{1, "rad"};
}

std::optional<double> at(const std::vector<double>& values, std::size_t i) {
  return i < values.size() ? std::optional(values[i]) : std::nullopt;
}

// The bits that are set, counted from 1.
std::vector<int> pressed(const DeviceSeen& seen) {
  std::vector<int> all;
  for (int i = 0; i < 32; ++i) {
    if ((seen.buttons >> i & 1u) != 0) all.push_back(i + 1);
  }
  return all;
}

std::string joints_text(const LookedDevice& device, const DeviceSeen& seen) {
  std::string text =
      fmt::format("\n{:<18} {:>20} {:>20} {:>13} {:>13} {:>22}\n", "joint", "range seen",
                  "declared", "smallest step", "declared", "noise at rest");
  for (std::size_t i = 0; i < device.arm.joints.size(); ++i) {
    const JointSeen& joint = seen.joint(i);
    const auto [unit, name] = unit_of(device, i);
    const auto number = [unit = unit](std::optional<double> value) {
      return value && std::isfinite(*value) ? fmt::format("{:.3g}", unit * *value)
                                            : std::string("-");
    };
    const auto range = [&](std::optional<double> from, std::optional<double> to) {
      return number(from) + " to " + number(to);
    };
    const std::optional<double> noise = joint.noise.rms();
    text += fmt::format(
        "{:<18} {:>20} {:>20} {:>13} {:>13} {:>22}\n",
        fmt::format("{} [{}]", device.arm.joints[i].name, name), range(joint.least, joint.most),
        range(at(device.traits.lower, i), at(device.traits.upper, i)), number(joint.step),
        number(at(device.traits.resolution, i)),
        noise ? fmt::format("{} rms in {:.1f} s", number(noise), joint.noise.seconds())
              : "never at rest");
  }
  return text + "\n";
}

// Warnings: what the readings show that the device's own description does not have.
std::string beyond_text(const LookedDevice& device, const DeviceSeen& seen) {
  std::string text;
  for (std::size_t i = 0; i < device.arm.joints.size(); ++i) {
    const JointSeen& joint = seen.joint(i);
    if (joint.least < at(device.traits.lower, i).value_or(joint.least) ||
        joint.most > at(device.traits.upper, i).value_or(joint.most)) {
      text += look_line("range",
                        device.arm.joints[i].name + " left the range that the device declares");
    }
    if (joint.least == joint.most) {
      text += look_line("range",
                        device.arm.joints[i].name + " never moved: move each joint to its ends");
    }
  }
  return text;
}

std::string causes_text(const DeviceSeen& seen) {
  std::string text;
  for (std::size_t i = 1; i < seen.no_force.size(); ++i) {
    if (seen.no_force[i] <= 0) continue;
    const std::string words = device_words({.no_force = static_cast<NoForce>(i)});
    text += look_line("device's force off", fmt::format("{:.2f} s: {}", seen.no_force[i], words));
  }
  return text;
}

std::string state_text(const DeviceSeen& seen) {
  const auto for_some_time = [](double seconds, const char* never, const char* said) {
    return seconds > 0 ? fmt::format("{} for {:.2f} s", said, seconds) : std::string(never);
  };
  const std::vector<int> buttons = pressed(seen);
  std::string text =
      look_line("buttons", buttons.empty() ? "no button was pressed"
                                           : fmt::format("pressed: {}", fmt::join(buttons, ", "))) +
      look_line("hand", for_some_time(seen.without_hand,
                                      "held the switch all the time, or the device has no switch",
                                      "nobody held the switch")) +
      look_line("calibration",
                for_some_time(seen.uncalibrated, "no problem reported", "not calibrated")) +
      look_line("fault", for_some_time(seen.fault, "none", "reported")) + causes_text(seen);
  if (seen.warmth > 0) {
    text += look_line("warmth", fmt::format("at most {:.0f} % of the hottest motor's thermal limit",
                                            100 * seen.warmth));
  }
  if (seen.unbelieved > 0) {
    text += look_line(
        "wrong readings",
        fmt::format("{} readings were impossible, and are not in the table", seen.unbelieved));
  }
  return text;
}

ordered_json number(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json joint_json(const LookedDevice& device, const DeviceSeen& seen, std::size_t i) {
  const JointSeen& joint = seen.joint(i);
  const auto [unit, name] = unit_of(device, i);
  const auto declared = [i, unit = unit](const std::vector<double>& values) {
    return number(unit * at(values, i).value_or(std::nan("")));
  };
  return {{"name", device.arm.joints[i].name},
          {"unit", name},
          {"least", number(unit * joint.least)},
          {"most", number(unit * joint.most)},
          {"declared_least", declared(device.traits.lower)},
          {"declared_most", declared(device.traits.upper)},
          {"smallest_step", number(unit * joint.step)},
          {"declared_step", declared(device.traits.resolution)},
          {"noise", number(unit * joint.noise.rms().value_or(std::nan("")))},
          {"at_rest_s", joint.noise.seconds()}};
}

}  // namespace

std::string look_text(const LookedDevice& device, const DeviceSeen& seen) {
  const DeviceTraits& traits = device.traits;
  std::string text =
      look_line("device", fmt::format("{}, {}, {}", traits.name, device.kind, traits.id)) +
      look_line("arm", device.arm_why);
  if (!traits.made_by.empty()) text += look_line("driven by", traits.made_by);
  text +=
      look_line("motors", traits.pushes ? "the device has motors; the motors got no force"
                                        : "the device has no motors") +
      look_line("axes", device.checked ? "adjusted as found in the check of the axes"
                                       : "as the device reports them; not checked yet") +
      look_line("joints", std::to_string(traits.dof)) +
      look_line("readings",
                fmt::format("{}, {:.0f} per second{}; time between two readings: median {:.2f} ms, "
                            "at most {:.1f} ms",
                            seen.readings(), seen.rate(),
                            traits.rate > 0 ? fmt::format(" ({:.0f} declared)", traits.rate) : "",
                            1e3 * seen.median_gap(), 1e3 * seen.worst_gap()));
  return text + joints_text(device, seen) + beyond_text(device, seen) + state_text(seen);
}

ordered_json look_json(const LookedDevice& device, const DeviceSeen& seen) {
  const DeviceTraits& traits = device.traits;
  ordered_json json{
      {"provenance", provenance("", std::nullopt)},
      {"id", traits.id},
      {"name", traits.name},
      {"kind", device.kind},
      {"driven_by", traits.made_by.empty() ? ordered_json(nullptr) : ordered_json(traits.made_by)},
      {"arm", device.arm.name},
      {"arm_why", device.arm_why},
      {"axes_checked", device.checked},
      {"pushes", traits.pushes},
      {"force_given", false},
      {"readings", seen.readings()},
      {"rate_hz", seen.rate()},
      {"declared_rate_hz", traits.rate},
      {"median_gap_s", seen.median_gap()},
      {"worst_gap_s", seen.worst_gap()},
      {"gone", seen.gone},
      {"joints", ordered_json::array()}};
  for (std::size_t i = 0; i < device.arm.joints.size(); ++i) {
    json["joints"].push_back(joint_json(device, seen, i));
  }
  json["buttons"] = pressed(seen);
  json["without_hand_s"] = seen.without_hand;
  json["uncalibrated_s"] = seen.uncalibrated;
  json["fault_s"] = seen.fault;
  json["no_force_s"] = seen.no_force;  // by the raw protocol's numbers of causes
  json["warmth"] = seen.warmth;
  json["wrong_readings"] = seen.unbelieved;
  return json;
}

}  // namespace limpid
