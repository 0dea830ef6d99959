// TOML tables read strictly: what is unknown, of the wrong type or out of range is refused with
// file, line, key, what was found and what is allowed.
#pragma once

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/sizes.h"

namespace limpid {

// Which numbers a file may have somewhere.

struct Range {
  double minimum;
  double maximum;
  bool exclusive_minimum = false;
  const char* unit = "";

  // The allowed number nearest to x; `otherwise` in place of what is no number.
  double hold(double x, double otherwise) const {
    if (std::isnan(x)) return otherwise;
    const double least =
        exclusive_minimum ? std::max(minimum, std::numeric_limits<double>::min()) : minimum;
    return std::clamp(x, least, maximum);
  }
};

// Errors: FileError "WHERE:LINE: ..." for text that is not TOML.
toml::table parse_toml(std::string_view text, const std::string& where);

// What stands in the file, short, for messages.
std::string found_text(const toml::node& node);

// The candidate nearest to `word` in spelling, or nothing if none resembles it.
std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& among);

// Every reader returns nothing where the key is missing and throws FileError where its value is
// not allowed; `need` turns the former into the latter.
class TomlTable {
 public:
  // `path` names the table in messages, "" the whole file.
  TomlTable(const toml::table& table, std::string where, std::string path)
      : table_(table), where_(std::move(where)), path_(std::move(path)) {}

  void allow_only(const std::vector<const char*>& keys) const;
  std::optional<std::string> text(const char* key) const;
  std::optional<double> number(const char* key, const Range& range) const;
  std::optional<std::uint64_t> count(const char* key, std::uint64_t least,
                                     std::uint64_t most) const;
  std::vector<std::string> texts(const char* key) const;  // a list of text; empty without the key
  std::optional<bool> flag(const char* key) const;
  std::optional<Vec3> vector(const char* key, const Range& each) const;
  std::optional<std::vector<Vec3>> vectors(const char* key, const Range& each) const;
  // A list of just so many numbers.
  std::optional<std::vector<double>> numbers(const char* key, std::size_t count,
                                             const Range& each) const;
  std::optional<std::vector<std::array<double, 2>>> pairs(const char* key, const Range& each) const;
  std::optional<TomlTable> table(const char* key) const;  // under [key], or { ... }
  std::vector<TomlTable> tables(const char* key) const;   // of [[key]]
  const toml::node* find(const char* key) const { return table_.get(key); }

  template <class T>
  T need(std::optional<T> value, const char* key) const {
    if (!value) refuse_missing(key);
    return *std::move(value);
  }

  [[noreturn]] void refuse(const char* key, const std::string& allowed) const;
  // For what was found in words of its own.
  [[noreturn]] void refuse_as(const char* key, const std::string& found,
                              const std::string& allowed) const;
  [[noreturn]] void refuse_missing(const char* key) const;

 private:
  std::string full(std::string_view key) const;
  // Lists of `count` numbers each.
  std::optional<std::vector<std::vector<double>>> lists(const char* key, std::size_t count,
                                                        const Range& each) const;

  const toml::table& table_;
  std::string where_;
  std::string path_;
};

}  // namespace limpid
