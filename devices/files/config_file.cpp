#include "devices/files/config_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "devices/files/text_file.h"
#include "devices/files/toml_reader.h"

namespace limpid {

namespace {

constexpr std::size_t kLongestConfig = 1 << 20;  // [bytes]
constexpr std::string_view kRetired = "predictor.preset";

std::optional<ParameterValue> value_of(const toml::node& node) {
  if (const auto x = node.value_exact<bool>()) return *x;
  if (const auto x = node.value_exact<std::int64_t>()) return *x;
  if (const auto x = node.value_exact<double>()) return *x;
  if (const auto x = node.value_exact<std::string>()) return *x;
  return std::nullopt;
}

// set_parameter, with a hint for a key that does not exist.
void set(Parameters& p, const std::string& key, const ParameterValue& value) {
  if (find_parameter(key) == nullptr) {
    std::vector<std::string> keys;
    for (const ParameterInfo& info : parameter_table()) keys.emplace_back(info.key);
    if (const auto meant = nearest(key, keys)) {
      throw ParameterError(fmt::format("{}: no such key; did you mean {}?", key, *meant));
    }
  }
  set_parameter(p, key, value);
}

void set_from(Parameters& p, const std::string& key, const toml::node& node) {
  if (const auto value = value_of(node)) return set(p, key, *value);
  throw ParameterError(
      fmt::format("{}: {} is not allowed; allowed: one value", key, found_text(node)));
}

template <class Untaken>
void take_table(Parameters& p, const toml::table& table, const std::string& prefix,
                const std::string& where, const Untaken& untaken) {
  for (const auto& [name, node] : table) {
    const std::string key = prefix + std::string(name.str());
    if (is_retired(key)) continue;
    if (node.is_table() && find_parameter(key) == nullptr) {
      take_table(p, *node.as_table(), key + ".", where, untaken);
      continue;
    }
    try {
      set_from(p, key, node);
    } catch (const ParameterError& error) {
      untaken(key, fmt::format("{}:{}: {}", where, name.source().begin.line, error.what()));
    }
  }
}

// `text` as a TOML value; if it is none, as text.
ParameterValue parse_value(const std::string& text) {
  try {
    const toml::table table = toml::parse("v = " + text);
    if (table.size() == 1) {
      if (const auto value = value_of(*table.get("v"))) return *value;
    }
  } catch (const toml::parse_error&) {
  }
  // People write ".5", "5." and "+.5", which TOML does not know.
  double number = 0;
  const char* const begin = text.data() + (text.starts_with("+.") ? 1 : 0);
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(begin, end, number);
  if (read.ec == std::errc{} && read.ptr == end) return number;
  return text;
}

}  // namespace

bool is_retired(std::string_view key) { return key == kRetired; }

bool has_retired(std::string_view text, const std::string& where) {
  return static_cast<bool>(parse_toml(text, where).at_path(kRetired));
}

void apply_config(Parameters& p, const std::filesystem::path& file) {
  apply_config_text(p, read_text(file, kLongestConfig), file.string());
}

void apply_config_text(Parameters& p, std::string_view text, const std::string& where) {
  Parameters changed = p;
  take_table(changed, parse_toml(text, where), "", where,
             [](const std::string&, const std::string& why) { throw FileError(why); });
  p = changed;
}

std::vector<UntakenKey> take_config_table(Parameters& p, const std::string& text,
                                          const std::string& table, const std::string& where) {
  const toml::table all = parse_toml(text, where);
  const toml::node* node = all.get(table);
  if (node == nullptr) return {};
  if (!node->is_table()) {
    return {{"", fmt::format("{}:{}: {}: {} is not allowed; allowed: a table", where,
                             node->source().begin.line, table, found_text(*node))}};
  }
  std::vector<UntakenKey> untaken;
  take_table(p, *node->as_table(), "", where, [&](const std::string& key, const std::string& why) {
    untaken.push_back({key, why});
  });
  return untaken;
}

std::string key_of_setting(std::string_view setting) {
  return std::string(trimmed(setting.substr(0, setting.find('='))));
}

void apply_setting(Parameters& p, std::string_view setting) {
  const auto equals = setting.find('=');
  const std::string key = key_of_setting(setting);
  const std::string value(equals == std::string_view::npos ? ""
                                                           : trimmed(setting.substr(equals + 1)));
  if (key.empty() || value.empty()) {
    throw ParameterError(fmt::format(
        "'{}': not a setting; needed: key=value, for example coupling.eta=0.6", setting));
  }
  set(p, key, parse_value(value));
}

std::string config_text(const Parameters& p) {
  // Collects the keys of each table, so that every table is written once.
  std::vector<std::pair<std::string_view, std::string>> tables;
  for (const ParameterInfo& info : parameter_table()) {
    const std::string value = parameter_text(p, info);
    if (value.empty()) continue;
    const std::string_view key = info.key;
    const auto dot = key.find('.');
    const std::string_view name = key.substr(0, dot);
    auto table = std::ranges::find(tables, name, [](const auto& t) { return t.first; });
    if (table == tables.end()) table = tables.insert(tables.end(), {name, {}});
    table->second += fmt::format("{} = {}\n", key.substr(dot + 1), value);
  }
  std::string text;
  for (const auto& [name, lines] : tables) {
    text += fmt::format("{}[{}]\n{}", text.empty() ? "" : "\n", name, lines);
  }
  return text;
}

}  // namespace limpid
