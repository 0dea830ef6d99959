// Requests of clients and the answers, each a line with a JSON object.
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

// Thrown for a refused request; what() names the key, what was found and what is allowed.
struct RemoteError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A request's kind, its keys and its help.
struct Verb {
  const char* name;
  std::span<const char* const> keys;  // beside "id" and "do"
  const char* help;
};
std::span<const Verb> verbs();
const Verb* find_verb(std::string_view name);  // null: no such verb

struct Request {
  nlohmann::json id;  // a whole number or a text; null: no id
  const Verb* verb = nullptr;
  nlohmann::json keys;  // an object: all keys but "id" and "do"
};

// Reads a request. Errors: RemoteError if `line` is no JSON object, is nested too deeply, or has no
// verb or an unknown key. `id` is set as far as it can be read.
Request read_request(std::string_view line, nlohmann::json& id);
// Whether a line asks to cut the force, whatever else may be wrong with it.
bool asks_for_cut(std::string_view line);

std::string answer_line(const nlohmann::json& id, const nlohmann::json& ok);
std::string error_line(const nlohmann::json& id, std::string_view error);
// Any other line. Numbers that are not finite become null, as JSON has none; bytes that are not
// UTF-8 are replaced.
std::string json_line(const nlohmann::json& message);

// Keys of a request, read within their bounds. Errors of all functions: RemoteError.
class Keys {
 public:
  explicit Keys(const Request& request) : verb_(request.verb->name), keys_(request.keys) {}

  static constexpr std::size_t kLongestText = 4000;

  bool has(const char* key) const { return keys_.contains(key); }
  const nlohmann::json& of(const char* key) const;  // must be there
  std::string text(const char* key) const;          // must be there, not empty
  std::optional<std::string> text_if(const char* key) const;
  // "file", an absolute path with this ending.
  std::filesystem::path file(std::string_view ending) const;
  // "file" to be written: must not exist, unless "replace" is true.
  std::filesystem::path file_to_write(std::string_view ending) const;
  double number_or(const char* key, double usual, double least, double most) const;
  bool flag_or(const char* key, bool usual) const;
  // Texts, at most `most`; none if there is no such key.
  std::optional<std::vector<std::string>> texts_if(const char* key, std::size_t most) const;

  // "VERB: KEY: what"
  RemoteError error(const char* key, const std::string& what) const;

 private:
  std::string verb_;
  const nlohmann::json& keys_;
};

// `value` in a message, cut to a few characters.
std::string shown(const nlohmann::json& value);

}  // namespace limpid
