#include "app/device/device_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <sstream>

#include "app/base/folders.h"
#include "devices/files/atomic_file.h"
#include "devices/files/field_file.h"
#include "devices/files/text_file.h"
#include "devices/files/toml_reader.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = 1 << 20;  // of the store

// Calls `use` for each element of a list, one a joint, at most as many as a device can have.
template <class Use>
void each_joint(const TomlTable& entry, const char* key, const char* allowed, const Use& use) {
  const toml::node* node = entry.find(key);
  if (node == nullptr) return;
  const toml::array* list = node->as_array();
  if (list == nullptr || list->size() > kMaxDof) entry.refuse(key, allowed);
  for (std::size_t i = 0; i < list->size(); ++i) {
    if (!use(i, *list->get(i))) entry.refuse(key, allowed);
  }
}

// Returns whether one of the words of a key, between dots and underscores, is a limit's.
bool names_a_limit(std::string_view key) {
  std::string words = fmt::format("_{}_", key);
  std::ranges::replace(words, '.', '_');
  return words.find("_limit") != std::string::npos ||
         std::ranges::any_of(kSafetyLimits, [&](const auto& limit) {
           return words.find(fmt::format("_{}_", limit.key)) != std::string::npos;
         });
}

// Refuses limits outside of their table, and tables that are unknown: nobody would read them, and
// the device would have its widest limits.
void refuse_limits_elsewhere(const TomlTable& table, const std::vector<const char*>& known) {
  table.refuse_strays(
      known,
      [](std::string_view key, const toml::node& node) {
        return node.is_table() || node.is_array_of_tables() || names_a_limit(key);
      },
      "limits under [device.\"ID\".limits] only");
}

void read_axes(const TomlTable& entry, std::vector<AxisAdjustment>& axes) {
  each_joint(entry, "axis", "a list of tables, one per joint",
             [&](std::size_t i, const toml::node& node) {
               if (!node.is_table()) return false;
               const TomlTable each = entry.element("axis", i, *node.as_table());
               AxisAdjustment& axis = axes.emplace_back();
               std::vector<const char*> keys;
               add_keys(kAxisFields, axis, keys);
               each.refuse_slips(keys);
               refuse_limits_elsewhere(each, keys);
               read_fields(each, kAxisFields, axis);
               return true;
             });
  each_joint(entry, "reverse", "a list of true or false, one per joint",
             [&](std::size_t i, const toml::node& node) {
               if (!node.is_boolean()) return false;
               if (axes.size() <= i) axes.resize(i + 1);
               axes[i].reversed = *node.value<bool>();
               return true;
             });
}

// Reads an entry; absent keys keep their defaults. A key that cannot be understood is an error: a
// default in its place might let the device push harder, or the wrong way. Errors: FileError.
DeviceNotes read_notes(const TomlTable& entry) {
  DeviceNotes notes;
  std::vector<const char*> known{"reverse", "limits", "compensation", "axis"};
  add_keys(kNotesFields, notes, known);
  add_keys(kPidFields, notes.pid, known);
  entry.refuse_slips(known);
  refuse_limits_elsewhere(entry, known);
  read_fields(entry, kNotesFields, notes);
  read_fields(entry, kPidFields, notes.pid);
  if (const auto limits = entry.table("limits")) {
    std::vector<const char*> keys;
    add_keys(kSafetyLimits, notes.limits, keys);
    limits->allow_only(keys);  // an unknown key would leave its limit at the widest
    read_fields(*limits, kSafetyLimits, notes.limits);
  }
  if (const auto forces = entry.table("compensation")) {
    std::vector<const char*> keys;
    add_keys(kOwnForcesFields, notes.compensation, keys);
    refuse_limits_elsewhere(*forces, keys);
    read_fields(*forces, kOwnForcesFields, notes.compensation);
  }
  read_axes(entry, notes.axes);
  return notes;
}

template <class Table, class Owner>
toml::table table_of(const Table& fields, const Owner& owner) {
  toml::table table;
  insert_fields(table, fields, owner);
  return table;
}

toml::table write_notes(const DeviceNotes& notes) {
  toml::array axes, reverse;
  for (const AxisAdjustment& axis : notes.axes) {
    axes.push_back(table_of(kAxisFields, axis));
    reverse.push_back(axis.reversed);
  }
  toml::table table = table_of(kNotesFields, notes);
  insert_fields(table, kPidFields, notes.pid);
  table.insert("reverse", reverse);
  table.insert("limits", table_of(kSafetyLimits, notes.limits));
  table.insert("compensation", table_of(kOwnForcesFields, notes.compensation));
  table.insert("axis", axes);
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
  // A limit without a device's id would be nobody's.
  const TomlTable devices(*node->as_table(), file.string(), "device");
  devices.refuse_strays(
      {},
      [](std::string_view key, const toml::node& each) {
        const bool is_limit =
            std::ranges::any_of(kSafetyLimits, [&](const auto& limit) { return key == limit.key; });
        return is_limit || key == "limits" || key == "axis" || key == "compensation" ||
               !each.is_table();
      },
      "a table for each device, [device.\"ID\"]");
  return node->as_table();
}

// Errors: FileError.
DeviceNotes notes_in(const toml::table& devices, const std::string& id, const fs::path& file) {
  return read_notes({*devices.get(id)->as_table(), file.string(), entry_path(id)});
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
  text << table_of(kSafetyLimits, limits) << '\n';
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
    const TomlTable whole(table, file.string(), "");
    whole.refuse_slips({"in_use", "device"});
    refuse_limits_elsewhere(whole, {"in_use", "device"});
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
