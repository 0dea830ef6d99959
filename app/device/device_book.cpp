#include "app/device/device_book.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

#include "app/base/user_dirs.h"
#include "devices/files/atomic_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

// A finite number within its range, else what it was.
void take(const toml::table& t, const char* key, double least, double most, double& value) {
  const auto found = t[key].value<double>();
  if (found && *found >= least && *found <= most) value = *found;
}

CompensationSettings read_compensation(const toml::table& t) {
  CompensationSettings c;
  c.holds_weight = t["gravity"].value_exact<bool>().value_or(false);
  c.holds_springs = t["springs"].value_exact<bool>().value_or(false);
  take(t, "friction", 0, CompensationSettings::kMostShare, c.friction_share);
  const auto down = std::ranges::find(kDowns, t["down"].value_or(std::string(kDowns[0])));
  if (down != kDowns.end()) c.down = static_cast<Down>(down - kDowns.begin());
  return c;
}

toml::table write_compensation(const CompensationSettings& c) {
  return toml::table{{"gravity", c.holds_weight},
                     {"down", kDowns[static_cast<std::size_t>(c.down)]},
                     {"friction", c.friction_share},
                     {"springs", c.holds_springs}};
}

DeviceNotes read_notes(const toml::table& t) {
  DeviceNotes notes;
  take(t, "range", 0.01, 3.2, notes.pid.range);
  take(t, "effort", 0.01, 50, notes.pid.effort);
  for (std::size_t i = 0; i < 2; ++i) {
    notes.pid.reverse[i] = t["reverse"][i].value_or(false);
  }
  if (const toml::table* limits = t["limits"].as_table()) {
    for (const SafetyLimitInfo& info : kSafetyLimitInfo) {
      double& value = notes.limits.*info.field;
      take(*limits, info.key, info.least, value, value);
    }
  }
  notes.checked = t["checked"].value_or(false);
  notes.arm = t["arm"].value_or(std::string());
  take(t, "delay", 0, 1, notes.delay);
  take(t, "torque_scale", kLeastTorqueScale, kMostTorqueScale, notes.torque_scale);
  if (const toml::table* forces = t["compensation"].as_table()) {
    notes.compensation = read_compensation(*forces);
  }
  if (const toml::array* axes = t["axis"].as_array()) {
    for (const toml::node& node : *axes) {
      AxisAdjustment& axis = notes.axes.emplace_back();
      if (const toml::table* each = node.as_table()) {
        take(*each, "zero", -100, 100, axis.zero);
        take(*each, "scale", 0.1, 10, axis.scale);
        axis.inverted = (*each)["inverted"].value_or(false);
      }
    }
  }
  return notes;
}

toml::table write_limits(const SafetyLimits& limits) {
  toml::table table;
  for (const SafetyLimitInfo& info : kSafetyLimitInfo) {
    table.insert(info.key, limits.*info.field);
  }
  return table;
}

toml::table write_notes(const DeviceNotes& notes) {
  toml::array axes;
  for (const AxisAdjustment& axis : notes.axes) {
    axes.push_back(
        toml::table{{"zero", axis.zero}, {"scale", axis.scale}, {"inverted", axis.inverted}});
  }
  toml::table table{{"range", notes.pid.range},
                    {"effort", notes.pid.effort},
                    {"reverse", toml::array{notes.pid.reverse[0], notes.pid.reverse[1]}},
                    {"limits", write_limits(notes.limits)},
                    {"checked", notes.checked},
                    {"arm", notes.arm},
                    {"torque_scale", notes.torque_scale},
                    {"compensation", write_compensation(notes.compensation)},
                    {"axis", axes}};
  if (notes.delay >= 0) table.insert("delay", notes.delay);
  return table;
}

}  // namespace

bool remember_check(const AxisCheck& check, DeviceNotes& notes) {
  if (!check.passed() || check.dof() > static_cast<int>(notes.pid.reverse.size())) return false;
  for (int i = 0; i < check.dof(); ++i) {
    bool& reverse = notes.pid.reverse[static_cast<std::size_t>(i)];
    if (check.finding(i).verdict == AxisVerdict::reversed) reverse = !reverse;
  }
  notes.checked = true;
  return true;
}

std::string limits_text(const SafetyLimits& limits) {
  std::ostringstream text;
  text << write_limits(limits) << '\n';
  return text.str();
}

fs::path device_book_file() { return user_config_dir() / "devices.toml"; }

DeviceBook load_device_book(const fs::path& file, std::string& complaint) {
  DeviceBook book;
  std::error_code none;
  if (!fs::exists(file, none)) return book;
  try {
    const toml::table table = toml::parse_file(file.string());
    book.in_use = table["in_use"].value_or(std::string());
    if (const toml::table* devices = table["device"].as_table()) {
      for (const auto& [id, node] : *devices) {
        if (const toml::table* t = node.as_table()) book.notes[std::string(id)] = read_notes(*t);
      }
    }
  } catch (const std::exception& e) {
    complaint = fmt::format("{}: not read: {}", file.string(), e.what());
  }
  return book;
}

std::string save_device_book(const DeviceBook& book, const fs::path& file) {
  toml::table devices;
  for (const auto& [id, notes] : book.notes) devices.insert(id, write_notes(notes));
  const toml::table all{{"in_use", book.in_use}, {"device", devices}};
  std::ostringstream text;
  text << all << '\n';
  return try_write_atomically(file, text.str());
}

}  // namespace limpid
