#include "app/desktop/base/window_layout.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string_view>

#include "app/desktop/base/settings.h"
#include "devices/files/atomic_file.h"
#include "devices/files/config_file.h"
#include "devices/files/field_file.h"
#include "devices/files/text_file.h"
#include "devices/files/toml_reader.h"

namespace limpid {

namespace {

namespace fs = std::filesystem;
constexpr std::size_t kLongest = 1 << 20;  // longest file [bytes]

std::string text_of(const toml::table& table) {
  std::ostringstream text;
  text << toml::toml_formatter(table);
  return text.str();
}

constexpr Range kPanel{100, 1000};  // [px at scale 1]

// Settings of a layout but its plots.
constexpr std::array kLayoutFields{
    Field<Settings>("show_left", "left panel", &Settings::show_left, {0, 1}, ""),
    Field<Settings>("show_right", "right panel", &Settings::show_right, {0, 1}, ""),
    Field<Settings>("show_plots", "plots", &Settings::show_plots, {0, 1}, ""),
    Field<Settings>("left", "its width", &Settings::left, kPanel, ""),
    Field<Settings>("right", "its width", &Settings::right, kPanel, ""),
    Field<Settings>("plots", "their height", &Settings::plots, kPanel, ""),
};

bool of_preset(const ParameterInfo& info) {
  const std::string_view key = info.key;
  return std::ranges::any_of(std::array<std::string_view, 3>{"coupling.", "observer.", "ledger."},
                             [key](std::string_view group) { return key.starts_with(group); });
}

}  // namespace

struct NamedTexts::Tables {
  toml::table all;
};

NamedTexts::Tables NamedTexts::tables_of(const std::string& text, const fs::path& file) {
  Tables tables{parse_toml(text, file.string())};
  for (const auto& [name, node] : tables.all) {
    if (node.is_table()) continue;
    throw FileError(fmt::format("{}:{}: {}: {} is not allowed; allowed: a table, [\"a name\"]",
                                file.string(), name.source().begin.line, name.str(),
                                found_text(node)));
  }
  return tables;
}

NamedTexts::NamedTexts(const fs::path& shipped, fs::path own) : own_(std::move(own)) {
  const auto read = [this](const fs::path& file, bool from_program) {
    try {
      take(tables_of(read_text(file, kLongest), file), from_program);
    } catch (const std::exception& e) {
      complaint_ = e.what();
    }
  };
  read(shipped, true);
  std::error_code none;
  if (fs::exists(own_, none)) read(own_, false);
}

// Takes the tables over. Shipped texts hide the user's own of the same name, which stay in their
// file.
void NamedTexts::take(const Tables& tables, bool shipped) {
  std::erase_if(entries_, [&](const Entry& entry) { return entry.shipped == shipped; });
  for (const auto& [name, node] : tables.all) {
    const std::string text(name.str());
    if (find(text) == nullptr) entries_.push_back({text, text_of(*node.as_table()), shipped});
  }
}

const NamedTexts::Entry* NamedTexts::find(const std::string& name) const {
  const auto found = std::ranges::find(entries_, name, &Entry::name);
  return found == entries_.end() ? nullptr : &*found;
}

bool NamedTexts::may_change(const std::string& name) const {
  const Entry* entry = find(name);
  return !name.empty() && (entry == nullptr || !entry->shipped);
}

std::string NamedTexts::keep(const std::string& name, const std::string& text) {
  return change([&](Tables& own) { own.all.insert_or_assign(name, toml::parse(text)); });
}

std::string NamedTexts::rename(const std::string& from, const std::string& to) {
  if (from == to) return {};
  return change([&](Tables& own) {
    const toml::table* renamed = own.all[from].as_table();
    if (renamed == nullptr) {
      throw FileError(fmt::format(
          "{} does not exist any more, because another window changed the list.", from));
    }
    if (own.all.contains(to)) throw FileError(fmt::format("The name {} is used already.", to));
    own.all.insert(to, *renamed);
    own.all.erase(from);
  });
}

std::string NamedTexts::remove(const std::string& name) {
  return change([&](Tables& own) { own.all.erase(name); });
}

// Changes the file as it is now: another window may have changed it.
std::string NamedTexts::change(const std::function<void(Tables&)>& what) {
  try {
    Tables own;
    update_file_under_lock(own_, [&](const std::string& text) {
      try {
        own = tables_of(text, own_);
      } catch (const FileError&) {
        keep_unread(own_);
      }
      what(own);
      std::ostringstream out;
      out << own.all << '\n';
      return out.str();
    });
    take(own, false);
    return {};
  } catch (const std::exception& e) {
    return e.what();
  }
}

std::string layout_text(const Settings& settings) {
  toml::table table;
  insert_fields(table, kLayoutFields, settings);
  table.insert("plot", plots_toml(settings.plot_choices));
  std::ostringstream text;
  text << toml::toml_formatter(table);
  return text.str();
}

void apply_layout(Settings& settings, const std::string& text, const std::string& where) {
  const toml::table table = parse_toml(text, where);
  Settings changed = settings;
  const TomlTable whole(table, where, "");
  read_fields(whole, kLayoutFields, changed);
  changed.plot_choices = plots_of(table, where);
  settings = std::move(changed);
}

std::string preset_text(const Parameters& p) {
  std::string text;
  for (const ParameterInfo& info : parameter_table()) {
    const std::string value = parameter_text(p, info);
    if (of_preset(info) && !value.empty()) text += fmt::format("{} = {}\n", info.key, value);
  }
  return text;
}

void apply_preset(Parameters& p, const std::string& text, const std::string& where) {
  Parameters changed = p;
  const Parameters paper;
  for (const ParameterInfo& info : parameter_table()) {
    if (of_preset(info)) set_parameter_number(changed, info, parameter_number(paper, info));
  }
  apply_config_text(changed, text, where);
  p = changed;
}

}  // namespace limpid
