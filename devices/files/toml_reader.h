// TOML tables read strictly. Unknown keys, values of the wrong type and out of range are refused
// with file, line, key, what was found and what is allowed.
#pragma once

#include <toml++/toml.h>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/field.h"
#include "core/base/nearest_word.h"  // nearest(), for readers

namespace limpid {

// Parses TOML. Errors: FileError "WHERE:LINE: ..." for text that is not TOML.
toml::table parse_toml(std::string_view text, const std::string& where);

// The value of a node as it stands in the file, shortened for messages.
std::string found_text(const toml::node& node);

// A table of a TOML file. Every reader returns nothing if the key is missing, and throws
// FileError if its value is not allowed. need() refuses a missing key, too.
class TomlTable {
 public:
  // `path` names the table in messages; "" is the whole file.
  TomlTable(const toml::table& table, std::string where, std::string path)
      : table_(table), where_(std::move(where)), path_(std::move(path)) {}

  void allow_only(const std::vector<const char*>& keys) const;
  // Refuses keys that are nearly one of `known`, likely slips; other unknown keys stay.
  void refuse_slips(const std::vector<const char*>& known) const;
  // Refuses keys other than `known` for which `stray` is true.
  void refuse_strays(const std::vector<const char*>& known,
                     const std::function<bool(std::string_view, const toml::node&)>& stray,
                     const std::string& allowed) const;
  std::optional<std::string> text(const char* key) const;
  // The place of one of these words.
  std::optional<std::size_t> choice(const char* key, std::span<const char* const> words) const;
  std::optional<double> number(const char* key, const Range& range) const;
  std::optional<std::uint64_t> count(const char* key, std::uint64_t least,
                                     std::uint64_t most) const;
  std::vector<std::string> texts(const char* key) const;  // a list of text; empty without the key
  std::optional<bool> flag(const char* key) const;
  std::optional<Vec3> vector(const char* key, const Range& each) const;
  std::optional<std::vector<Vec3>> vectors(const char* key, const Range& each) const;
  // A list of exactly `count` numbers.
  std::optional<std::vector<double>> numbers(const char* key, std::size_t count,
                                             const Range& each) const;
  std::optional<std::vector<std::array<double, 2>>> pairs(const char* key, const Range& each) const;
  std::optional<TomlTable> table(const char* key) const;  // under [key], or { ... }
  std::vector<TomlTable> tables(const char* key) const;   // of [[key]]
  // A table in the list at `key`, named by its place there.
  TomlTable element(const char* key, std::size_t i, const toml::table& table) const;
  const toml::node* find(const char* key) const { return table_.get(key); }

  template <class T>
  T need(std::optional<T> value, const char* key) const {
    if (!value) refuse_missing(key);
    return *std::move(value);
  }

  [[noreturn]] void refuse(const char* key, const std::string& allowed) const;
  // Refuses a value, with its own words for what was found.
  [[noreturn]] void refuse_as(const char* key, const std::string& found,
                              const std::string& allowed) const;
  [[noreturn]] void refuse_missing(const char* key) const;

 private:
  std::string full(std::string_view key) const;
  // A list of lists of `count` numbers each.
  std::optional<std::vector<std::vector<double>>> lists(const char* key, std::size_t count,
                                                        const Range& each) const;

  const toml::table& table_;
  std::string where_;
  std::string path_;
};

}  // namespace limpid
