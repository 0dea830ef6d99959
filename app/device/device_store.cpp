#include "app/device/device_store.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <span>
#include <sstream>

#include "app/base/folders.h"
#include "devices/files/atomic_file.h"
#include "devices/files/text_file.h"
#include "devices/files/toml_reader.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = 1 << 20;  // of the store

// Reads an entry; absent keys keep their defaults. A key that cannot be understood is an error: a
// default in its place might let the device push harder, or the wrong way.
class Entry {
 public:
  Entry(const toml::table& table, const std::string& file, const std::string& path)
      : table_(table), reader_(table, file, path), file_(file), path_(path) {}

  void take(const char* key, double least, double most, double& value) const {
    value = reader_.number(key, {least, most}).value_or(value);
  }
  void take(const char* key, std::string& value) const {
    value = reader_.text(key).value_or(value);
  }
  void take(const char* key, bool& value) const {
    const toml::node* node = reader_.find(key);
    if (node == nullptr) return;
    if (!node->is_boolean()) reader_.refuse(key, "true or false");
    value = *node->value<bool>();
  }
  void take_one_of(const char* key, std::span<const char* const> names, std::size_t& value) const {
    const std::optional<std::string> text = reader_.text(key);
    if (!text) return;
    const auto found = std::ranges::find(names, *text);
    if (found == names.end()) reader_.refuse(key, fmt::format("{}", fmt::join(names, ", ")));
    value = static_cast<std::size_t>(found - names.begin());
  }
  // The table at this key, if there is one.
  std::optional<Entry> below(const char* key) const {
    const toml::node* node = reader_.find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_table()) reader_.refuse(key, "a table");
    return Entry(*node->as_table(), file_, fmt::format("{}.{}", path_, key));
  }
  // Calls `use` for each element of a list, one a joint, at most as many as a device can have.
  template <class Use>
  void each(const char* key, const char* allowed, const Use& use) const {
    const toml::node* node = reader_.find(key);
    if (node == nullptr) return;
    const toml::array* list = node->as_array();
    if (list == nullptr || list->size() > kMaxDof) reader_.refuse(key, allowed);
    for (std::size_t i = 0; i < list->size(); ++i) {
      if (!use(i, *list->get(i))) reader_.refuse(key, allowed);
    }
  }
  // Refuses keys that are nearly one of `known`, likely slips; other unknown keys stay.
  void no_slips(const std::vector<std::string>& known) const {
    for (const auto& [key, node] : table_) {
      const std::string word(key.str());
      if (std::ranges::find(known, word) != known.end()) continue;
      if (const auto meant = nearest(word, known)) {
        reader_.refuse(word.c_str(), fmt::format("the key \"{}\"", *meant));
      }
    }
  }
  void only(const std::vector<const char*>& known) const { reader_.allow_only(known); }
  Entry element(const char* key, std::size_t i, const toml::table& table) const {
    return {table, file_, fmt::format("{}.{}[{}]", path_, key, i)};
  }

 private:
  const toml::table& table_;
  TomlTable reader_;
  std::string file_, path_;
};

OwnForces read_compensation(const Entry& entry) {
  OwnForces c;
  auto down = static_cast<std::size_t>(c.down);
  entry.take("gravity", c.holds_weight);
  entry.take("springs", c.holds_springs);
  entry.take("friction", 0, CompensationSettings::kMostShare, c.friction_share);
  entry.take_one_of("down", kDowns, down);
  c.down = static_cast<Down>(down);
  return c;
}

toml::table write_compensation(const OwnForces& c) {
  return toml::table{{"gravity", c.holds_weight},
                     {"down", kDowns[static_cast<std::size_t>(c.down)]},
                     {"friction", c.friction_share},
                     {"springs", c.holds_springs}};
}

void read_axes(const Entry& entry, std::vector<AxisAdjustment>& axes) {
  entry.each("axis", "a list of tables, one a joint", [&](std::size_t i, const toml::node& node) {
    if (!node.is_table()) return false;
    const Entry each = entry.element("axis", i, *node.as_table());
    each.no_slips({"zero", "scale", "inverted"});
    AxisAdjustment& axis = axes.emplace_back();
    each.take("zero", -100, 100, axis.zero);
    each.take("scale", 0.1, 10, axis.scale);
    each.take("inverted", axis.inverted);
    return true;
  });
  entry.each("reverse", "a list of true or false, one a joint",
             [&](std::size_t i, const toml::node& node) {
               if (!node.is_boolean()) return false;
               if (axes.size() <= i) axes.resize(i + 1);
               axes[i].reversed = *node.value<bool>();
               return true;
             });
}

// Errors: FileError.
DeviceNotes read_notes(const Entry& entry) {
  DeviceNotes notes;
  entry.no_slips({"range", "effort", "reverse", "limits", "checked", "checked_as", "arm",
                  "taken_for", "taken_for_tip", "taken_as", "delay", "torque_scale", "compensation",
                  "axis"});
  entry.take("range", 0.01, 3.2, notes.pid.range);
  entry.take("effort", 0.01, 50, notes.pid.effort);
  if (const std::optional<Entry> limits = entry.below("limits")) {
    std::vector<const char*> keys;
    keys.reserve(kSafetyLimitInfo.size());
    for (const SafetyLimitInfo& info : kSafetyLimitInfo) keys.emplace_back(info.key);
    limits->only(keys);  // an unknown key would leave its limit at the widest
    for (const SafetyLimitInfo& info : kSafetyLimitInfo) {
      double& value = notes.limits.*info.field;
      limits->take(info.key, info.least, value, value);
    }
  }
  entry.take("checked", notes.checked);
  entry.take("checked_as", notes.checked_as);
  entry.take("arm", notes.arm);
  entry.take("taken_for", notes.taken_for);
  entry.take("taken_for_tip", notes.taken_for_tip);
  entry.take("taken_as", notes.taken_as);
  entry.take("delay", 0, 1, notes.delay);
  entry.take("torque_scale", kLeastTorqueScale, kMostTorqueScale, notes.torque_scale);
  if (const std::optional<Entry> forces = entry.below("compensation")) {
    notes.compensation = read_compensation(*forces);
  }
  read_axes(entry, notes.axes);
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
  toml::array axes, reverse;
  for (const AxisAdjustment& axis : notes.axes) {
    axes.push_back(
        toml::table{{"zero", axis.zero}, {"scale", axis.scale}, {"inverted", axis.inverted}});
    reverse.push_back(axis.reversed);
  }
  toml::table table{{"range", notes.pid.range},
                    {"effort", notes.pid.effort},
                    {"reverse", reverse},
                    {"limits", write_limits(notes.limits)},
                    {"checked", notes.checked},
                    {"checked_as", notes.checked_as},
                    {"arm", notes.arm},
                    {"taken_for", notes.taken_for},
                    {"taken_for_tip", notes.taken_for_tip},
                    {"taken_as", notes.taken_as},
                    {"torque_scale", notes.torque_scale},
                    {"compensation", write_compensation(notes.compensation)},
                    {"axis", axes}};
  if (notes.delay >= 0) table.insert("delay", notes.delay);
  return table;
}

// Applies the changes from `before` to `now` to `into`, whose other keys stay.
void merge(const toml::table& before, const toml::table& now, toml::table& into) {
  for (const auto& [key, node] : before) {
    if (!now.contains(key.str())) into.erase(key.str());
  }
  for (const auto& [key, node] : now) {
    const toml::node* old = before.get(key.str());
    toml::node* there = into.get(key.str());
    if (old != nullptr && old->is_table() && node.is_table() && there != nullptr &&
        there->is_table()) {
      merge(*old->as_table(), *node.as_table(), *there->as_table());
      continue;
    }
    node.visit([&, name = key.str()](const auto& value) {
      using Value = std::remove_cvref_t<decltype(value)>;
      const auto* same = old != nullptr ? old->as<Value>() : nullptr;
      if (same == nullptr || !(*same == value)) into.insert_or_assign(name, value);
    });
  }
}

std::string entry_path(std::string_view id) { return fmt::format("device.\"{}\"", id); }

// Reads the file as TOML. Errors: FileError.
toml::table parse_store(const fs::path& file) {
  std::error_code none;
  if (fs::status(file, none).type() == fs::file_type::not_found) return {};
  return parse_toml(read_text(file, kMostBytes), file.string());
}

// Errors: FileError.
const toml::table* devices_in(const toml::table& store, const fs::path& file) {
  const toml::node* node = store.get("device");
  if (node == nullptr) return nullptr;
  if (!node->is_table()) TomlTable(store, file.string(), "").refuse("device", "a table");
  return node->as_table();
}

// Errors: FileError.
DeviceNotes notes_in(const toml::table& devices, const std::string& id, const fs::path& file) {
  const toml::node& node = *devices.get(id);
  if (!node.is_table()) TomlTable(devices, file.string(), "device").refuse(id.c_str(), "a table");
  return read_notes({*node.as_table(), file.string(), entry_path(id)});
}

}  // namespace

std::string what_it_is(const std::string& name, int dof) {
  return fmt::format("{}, {} joint{}", name, dof, dof == 1 ? "" : "s");
}

bool remember_check(const AxisCheck& check, DeviceNotes& notes) {
  if (!check.passed()) return false;
  notes.axes.resize(std::max(notes.axes.size(), static_cast<std::size_t>(check.dof())));
  for (int i = 0; i < check.dof(); ++i) {
    bool& reversed = notes.axes[static_cast<std::size_t>(i)].reversed;
    if (check.finding(i).verdict == AxisVerdict::reversed) reversed = !reversed;
  }
  notes.checked = true;
  notes.checked_as = what_it_is(check.device(), check.dof());
  return true;
}

std::string limits_text(const SafetyLimits& limits) {
  std::ostringstream text;
  text << write_limits(limits) << '\n';
  return text.str();
}

fs::path device_store_file() { return user_config_dir() / "devices.toml"; }

std::string DeviceStore::complaint() const {
  std::string all = refusal;
  for (const auto& [id, each] : notes) {
    if (!each.refusal.empty()) all += (all.empty() ? "" : "\n") + each.refusal;
  }
  return all;
}

DeviceStore load_device_store(const fs::path& file) {
  DeviceStore store;
  try {
    const toml::table table = parse_store(file);
    store.in_use = TomlTable(table, file.string(), "").text("in_use").value_or("");
    Entry(table, file.string(), "").no_slips({"in_use", "device"});
    const toml::table* devices = devices_in(table, file);
    if (devices == nullptr) return store;
    for (const auto& [key, node] : *devices) {
      const std::string id(key.str());
      try {
        store.notes[id] = notes_in(*devices, id, file);
      } catch (const FileError& error) {
        store.notes[id].refusal = error.what();
      }
    }
  } catch (const std::exception& error) {
    store.refusal = error.what();
  }
  return store;
}

std::string save_device_store(const DeviceStore& before, const DeviceStore& now,
                              const fs::path& file) {
  const auto changed_store = [&](const std::string& text) {
    toml::table table = parse_toml(text, file.string());
    if (now.in_use != before.in_use) table.insert_or_assign("in_use", now.in_use);
    devices_in(table, file);
    toml::table& devices = *table.insert("device", toml::table{}).first->second.as_table();
    for (const auto& [id, notes] : now.notes) {
      const auto known = before.notes.find(id);
      const toml::table old =
          write_notes(known == before.notes.end() ? DeviceNotes{} : known->second);
      const toml::table changed = write_notes(notes);
      if (old == changed) continue;
      // Entries that reading would refuse are not written either.
      read_notes({changed, file.string(), fmt::format("device.\"{}\"", id)});
      if (!devices.contains(id)) {
        devices.insert(id, changed);
        continue;
      }
      notes_in(devices, id, file);  // refuses to write over an entry that cannot be understood
      merge(old, changed, *devices.get_as<toml::table>(id));
    }
    std::ostringstream written;
    written << table << '\n';
    return written.str();
  };
  try {
    update_file_under_lock(file, changed_store);
    return {};
  } catch (const std::exception& error) {
    return fmt::format("not saved: {}", error.what());
  }
}

}  // namespace limpid
