#include "devices/files/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "devices/files/text_file.h"

namespace limpid {

namespace {

// Keys that tables of different kinds have for the same thing.
constexpr std::array<std::array<std::string_view, 2>, 4> kSameThing{
    {{"position", "center"}, {"center", "position"}, {"rotation", "rpy"}, {"rpy", "rotation"}}};

std::string allowed_text(const Range& range) {
  const std::string unit = range.has_unit() ? fmt::format(" {}", range.unit) : "";
  return fmt::format("a number {} {} up to {}{}", range.exclusive_minimum ? "above" : "from",
                     range.minimum, range.maximum, unit);
}

std::optional<double> number_in(const toml::node& node, const Range& range) {
  if (!node.is_number()) return std::nullopt;
  const double x = *node.value<double>();
  return range.holds(x) ? std::optional(x) : std::nullopt;
}

// A list of exactly `count` numbers in range; nothing if the node is anything else.
std::optional<std::vector<double>> list_in(const toml::node& node, std::size_t count,
                                           const Range& range) {
  const toml::array* list = node.as_array();
  if (list == nullptr || list->size() != count) return std::nullopt;
  std::vector<double> all;
  for (const toml::node& each : *list) {
    const auto x = number_in(each, range);
    if (!x) return std::nullopt;
    all.push_back(*x);
  }
  return all;
}

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& where) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw FileError(
        fmt::format("{}:{}: not TOML: {}", where, error.source().begin.line, error.description()));
  }
}

std::string found_text(const toml::node& node) {
  if (const auto x = node.value_exact<bool>()) return *x ? "true" : "false";
  if (const auto x = node.value_exact<std::int64_t>()) return std::to_string(*x);
  if (const auto x = node.value_exact<double>()) return fmt::format("{}", *x);
  if (const auto x = node.value_exact<std::string>()) return fmt::format("\"{:.60}\"", *x);
  if (const toml::array* list = node.as_array()) {
    std::string all;
    for (const toml::node& each : *list) {
      all += (all.empty() ? "" : ", ") + found_text(each);
      if (all.size() > 60) return "[" + all.substr(0, 60) + "...]";
    }
    return "[" + all + "]";
  }
  return node.is_table() ? "a table" : "a date or time";
}

std::string TomlTable::full(std::string_view key) const {
  return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

void TomlTable::allow_only(const std::vector<const char*>& keys) const {
  const std::vector<std::string> known(keys.begin(), keys.end());
  for (const auto& [key, node] : table_) {
    const std::string word(key.str());
    if (std::ranges::count(known, word) > 0) continue;
    auto meant = nearest(word, known);
    for (const auto& [one, other] : kSameThing) {
      if (word == one && std::ranges::count(known, other) > 0) meant = other;
    }
    throw FileError(fmt::format(
        "{}:{}: {}: no such key{} allowed: {}", where_, key.source().begin.line, full(word),
        meant ? fmt::format("; did you mean {}?", *meant) : ";", fmt::join(keys, ", ")));
  }
}

void TomlTable::refuse_slips(const std::vector<const char*>& known) const {
  for (const auto& [key, node] : table_) {
    const std::string word(key.str());
    if (std::ranges::find(known, word) != known.end()) continue;
    if (const auto meant = nearest(word, {known.begin(), known.end()})) {
      refuse(word.c_str(), fmt::format("the key \"{}\"", *meant));
    }
  }
}

void TomlTable::refuse_strays(const std::vector<const char*>& known,
                              const std::function<bool(std::string_view, const toml::node&)>& stray,
                              const std::string& allowed) const {
  for (const auto& [key, node] : table_) {
    const std::string word(key.str());
    if (std::ranges::find(known, word) == known.end() && stray(word, node)) {
      refuse(word.c_str(), allowed);
    }
  }
}

std::optional<std::string> TomlTable::text(const char* key) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_string()) refuse(key, "text in quotes");
  return *node->value<std::string>();
}

std::optional<std::size_t> TomlTable::choice(const char* key,
                                             std::span<const char* const> words) const {
  const auto word = text(key);
  if (!word) return std::nullopt;
  const auto found = std::ranges::find(words, *word);
  if (found == words.end()) refuse(key, allowed_for(*word, {words.begin(), words.end()}));
  return static_cast<std::size_t>(found - words.begin());
}

std::optional<double> TomlTable::number(const char* key, const Range& range) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto x = number_in(*node, range);
  if (!x) refuse(key, allowed_text(range));
  return x;
}

std::optional<std::uint64_t> TomlTable::count(const char* key, std::uint64_t least,
                                              std::uint64_t most) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto x = node->value_exact<std::int64_t>();
  if (x && *x >= 0 && static_cast<std::uint64_t>(*x) >= least &&
      static_cast<std::uint64_t>(*x) <= most) {
    return static_cast<std::uint64_t>(*x);
  }
  refuse(key, fmt::format("a whole number from {} to {}", least, most));
}

std::vector<std::string> TomlTable::texts(const char* key) const {
  std::vector<std::string> all;
  const toml::node* node = find(key);
  if (node == nullptr) return all;
  const toml::array* list = node->as_array();
  const char* allowed = "a list of texts, for example [\"one\", \"two\"]";
  if (list == nullptr) refuse(key, allowed);
  for (const toml::node& each : *list) {
    if (!each.is_string()) refuse(key, allowed);
    all.push_back(*each.value<std::string>());
  }
  return all;
}

std::optional<Vec3> TomlTable::vector(const char* key, const Range& each) const {
  const auto list = numbers(key, 3, each);
  return list ? std::optional(Vec3(list->data())) : std::nullopt;
}

std::optional<std::vector<double>> TomlTable::numbers(const char* key, std::size_t count,
                                                      const Range& each) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  auto list = list_in(*node, count, each);
  if (!list) refuse(key, fmt::format("a list of {}, each {}", count, allowed_text(each)));
  return list;
}

std::optional<std::vector<std::vector<double>>> TomlTable::lists(const char* key, std::size_t count,
                                                                 const Range& each) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const toml::array* rows = node->as_array();
  const std::string allowed =
      fmt::format("a list of lists of {}, each {}", count, allowed_text(each));
  if (rows == nullptr) refuse(key, allowed);
  std::vector<std::vector<double>> all;
  for (const toml::node& row : *rows) {
    auto list = list_in(row, count, each);
    if (!list) refuse(key, allowed);
    all.push_back(*std::move(list));
  }
  return all;
}

std::optional<std::vector<Vec3>> TomlTable::vectors(const char* key, const Range& each) const {
  const auto rows = lists(key, 3, each);
  if (!rows) return std::nullopt;
  std::vector<Vec3> all;
  for (const std::vector<double>& row : *rows) all.emplace_back(row.data());
  return all;
}

std::optional<std::vector<std::array<double, 2>>> TomlTable::pairs(const char* key,
                                                                   const Range& each) const {
  const auto rows = lists(key, 2, each);
  if (!rows) return std::nullopt;
  std::vector<std::array<double, 2>> all;
  for (const std::vector<double>& row : *rows) all.push_back({row[0], row[1]});
  return all;
}

std::optional<bool> TomlTable::flag(const char* key) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_boolean()) refuse(key, "true, false");
  return *node->value<bool>();
}

std::optional<TomlTable> TomlTable::table(const char* key) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_table()) refuse(key, fmt::format("a table under [{}]", full(key)));
  return TomlTable(*node->as_table(), where_, full(key));
}

TomlTable TomlTable::element(const char* key, std::size_t i, const toml::table& table) const {
  return {table, where_, fmt::format("{}[{}]", full(key), i)};
}

std::vector<TomlTable> TomlTable::tables(const char* key) const {
  std::vector<TomlTable> all;
  const toml::node* node = find(key);
  if (node == nullptr) return all;
  const toml::array* list = node->as_array();
  const std::string allowed = fmt::format("tables, each under [[{}]]", full(key));
  if (list == nullptr) refuse(key, allowed);
  for (const toml::node& each : *list) {
    if (!each.is_table()) refuse(key, allowed);
    all.emplace_back(*each.as_table(), where_, full(key));
  }
  return all;
}

void TomlTable::refuse(const char* key, const std::string& allowed) const {
  refuse_as(key, found_text(*find(key)), allowed);
}

void TomlTable::refuse_as(const char* key, const std::string& found,
                          const std::string& allowed) const {
  throw FileError(fmt::format("{}:{}: {}: {} is not allowed; allowed: {}", where_,
                              find(key)->source().begin.line, full(key), found, allowed));
}

void TomlTable::refuse_missing(const char* key) const {
  throw FileError(fmt::format("{}:{}: {}: missing", where_, table_.source().begin.line, full(key)));
}

}  // namespace limpid
