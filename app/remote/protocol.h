// What a line of a client says, and the lines that answer it: one JSON object each.
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace limpid {

inline constexpr int kProtocol = 1;

// Something asked for that cannot be had; what() names the key, what was found and what is allowed.
struct RemoteError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// What can be asked.
struct Verb {
  const char* name;
  std::span<const char* const> keys;  // beside "id" and "do"
  const char* help;
};
std::span<const Verb> verbs();
const Verb* find_verb(std::string_view name);  // null: there is none

struct Request {
  nlohmann::json id;  // a whole number or a text; null: none
  const Verb* verb = nullptr;
  nlohmann::json keys;  // an object: all but "id" and "do"
};

// Errors: RemoteError for what is no JSON object, nested deeper than it needs to be, without a
// verb, or with a key that the verb does not have. `id` is what the line gives, as far as it can be
// read.
Request read_request(std::string_view line, nlohmann::json& id);
// True for a line that asks for no force, whatever else may be wrong with it.
bool asks_for_cut(std::string_view line);

std::string answer_line(const nlohmann::json& id, const nlohmann::json& ok);
std::string error_line(const nlohmann::json& id, std::string_view error);
// Any other line. What is not a number becomes null, as JSON has none; bytes that are not UTF-8 are
// replaced.
std::string json_line(const nlohmann::json& message);

// A request's keys, read with their bounds. Errors of all of them: RemoteError.
class Keys {
 public:
  explicit Keys(const Request& request) : verb_(request.verb->name), keys_(request.keys) {}

  static constexpr std::size_t kLongestText = 4000;

  bool has(const char* key) const { return keys_.contains(key); }
  const nlohmann::json& of(const char* key) const;  // one that is needed
  std::string text(const char* key) const;          // the same, a text that is not empty
  std::optional<std::string> text_if(const char* key) const;
  // "file", to be written: a path from / on with this ending.
  std::filesystem::path file(std::string_view ending) const;
  // The same of one that is to be written: it is not there, or may be replaced by "replace".
  std::filesystem::path file_to_write(std::string_view ending) const;
  double number_or(const char* key, double usual, double least, double most) const;
  bool flag_or(const char* key, bool usual) const;
  // Texts, at most so many; none: there is no such key.
  std::optional<std::vector<std::string>> texts_if(const char* key, std::size_t most) const;

  // "VERB: KEY: what"
  RemoteError error(const char* key, const std::string& what) const;

 private:
  std::string verb_;
  const nlohmann::json& keys_;
};

// As it stands in a message: at most so many characters.
std::string shown(const nlohmann::json& value);

}  // namespace limpid
