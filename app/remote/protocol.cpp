#include "app/remote/protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace limpid {
namespace {

using nlohmann::json;

constexpr int kDeepest = 6;             // most nested objects and lists
constexpr std::size_t kLongestId = 64;  // of an id that is a text
constexpr std::size_t kShown = 60;

constexpr std::array<const char*, 0> kNone{};
constexpr std::array kGet{"keys"};
constexpr std::array kSet{"values", "twin", "lane", "reset"};
constexpr std::array kOpen{"scene", "arm", "tip", "session", "hand", "wait"};
constexpr std::array kRecord{"file", "force"};
constexpr std::array kMark{"text"};
constexpr std::array kRow{"channels"};
constexpr std::array kFollow{"channels", "rate"};
constexpr std::array kTwin{"on", "values", "lane"};
constexpr std::array kBlind{"on"};
constexpr std::array kAsk{"text", "choices", "beside", "seconds"};
constexpr std::array kPicture{"file", "replace"};

constexpr std::array kVerbs{
    Verb{"hello", kNone, "which version of Limpid this is, and what it offers"},
    Verb{"get", kGet, "gives the settings (all, or only those in \"keys\") and the state"},
    Verb{"set", kSet,
         "sets the \"values\" of settings; if one is wrong, none is set; \"twin\": true sets those "
         "of the twin (second run), \"lane\": 2 those of the third run; \"reset\": true gives all "
         "other settings their usual values"},
    Verb{"open", kOpen, "opens a scene, an arm, a session or a hand's path"},
    Verb{"record", kRecord,
         "records every tick, into \"file\" or a new file of the user's sessions; \"force\": true "
         "replaces an existing file"},
    Verb{"stop", kNone, "ends the recording; answers once the file is complete"},
    Verb{"start_over", kNone,
         "starts again, at rest in the middle or at the beginning of the hand's path"},
    Verb{"mark", kMark,
         "writes \"text\" as a mark into the plots and into the recording; answers with the tick"},
    Verb{"row", kRow,
         "gives the newest row: those in \"channels\", or without them each number that plots have "
         "of the first run"},
    Verb{"follow", kFollow,
         "sends rows of \"channels\" from now on, \"rate\" rows per second; an empty list of "
         "channels ends the sending"},
    Verb{"twin", kTwin,
         "adds a second run with the same hand and its own \"values\"; \"lane\": 2 adds a third "
         "run"},
    Verb{"blind", kBlind,
         "the window hides law, settings and plots while this client is connected"},
    Verb{"ask", kAsk,
         "asks a person the question \"text\"; returns the answer, one of \"choices\", and the "
         "time it took; with \"beside\": true the picture can still be used; \"seconds\" limits "
         "the time"},
    Verb{"picture", kPicture,
         "draws the picture into \"file\", a PNG; \"replace\": true replaces an existing file"},
    Verb{"cut", kNone, "cuts the force at once"},
    Verb{"bye", kNone, "ends the connection"},
};

std::string list(std::span<const char* const> words) {
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, ", "));
}

std::string names_of_verbs() {
  std::vector<const char*> names;
  names.reserve(std::size(kVerbs));
  for (const Verb& verb : kVerbs) names.push_back(verb.name);
  return list(names);
}

json parse(std::string_view line) {
  const auto shallow = [](int depth, json::parse_event_t, json&) {
    if (depth <= kDeepest) return true;
    throw RemoteError(
        fmt::format("lists and objects of a line may be nested at most {} deep; those of this line "
                    "are nested deeper",
                    kDeepest));
  };
  try {
    return json::parse(line.begin(), line.end(), shallow);
  } catch (const json::exception&) {
    std::string start(line.substr(0, kShown));
    for (char& c : start) {
      if (c < 0x20 || c == 0x7F) c = '?';
    }
    throw RemoteError(fmt::format(
        R"(a line must be one JSON object, for example {{"id": 1, "do": "hello"}}; found: {})",
        start));
  }
}

}  // namespace

std::span<const Verb> verbs() { return kVerbs; }

const Verb* find_verb(std::string_view name) {
  const auto* found = std::ranges::find(kVerbs, name, &Verb::name);
  return found == kVerbs.end() ? nullptr : found;
}

std::string json_line(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string answer_line(const json& id, const json& ok) {
  return json_line({{"id", id}, {"ok", ok}});
}

std::string error_line(const json& id, std::string_view error) {
  return json_line({{"id", id}, {"error", error}});
}

std::string shown(const json& value) {
  std::string text = json_line(value);
  if (text.size() > kShown) text = text.substr(0, kShown) + "...";
  return text;
}

Request read_request(std::string_view line, json& id) {
  id = nullptr;
  json whole = parse(line);
  if (!whole.is_object()) {
    throw RemoteError("a line must be one JSON object; found: " + shown(whole));
  }
  if (const auto given = whole.find("id"); given != whole.end()) {
    const bool short_text =
        given->is_string() && given->get_ref<const std::string&>().size() <= kLongestId;
    if (!given->is_number_integer() && !short_text && !given->is_null()) {
      throw RemoteError(
          fmt::format("id: {} is not allowed; allowed: a whole number, or a text of "
                      "up to {} characters",
                      shown(*given), kLongestId));
    }
    id = *given;
    whole.erase(given);
  }
  const auto wanted = whole.find("do");
  if (wanted == whole.end()) {
    throw RemoteError("do: is missing; allowed: " + names_of_verbs());
  }
  const Verb* verb =
      wanted->is_string() ? find_verb(wanted->get_ref<const std::string&>()) : nullptr;
  if (verb == nullptr) {
    throw RemoteError(
        fmt::format("do: {} is not known; allowed: {}", shown(*wanted), names_of_verbs()));
  }
  whole.erase(wanted);
  for (const auto& [key, value] : whole.items()) {
    if (std::ranges::count(verb->keys, std::string_view(key)) > 0) continue;
    throw RemoteError(fmt::format("{}: {} is not a key of this command; allowed: {}", verb->name,
                                  shown(key), list(verb->keys)));
  }
  return {id, verb, std::move(whole)};
}

bool asks_for_cut(std::string_view line) {
  if (line.find("cut") == std::string_view::npos) return false;
  const json whole = json::parse(line.begin(), line.end(), nullptr, false);
  return whole.is_object() && whole.value("do", json()) == json("cut");
}

const json& Keys::of(const char* key) const {
  const auto found = keys_.find(key);
  if (found == keys_.end()) throw error(key, "is missing");
  return *found;
}

std::optional<std::string> Keys::text_if(const char* key) const {
  const auto found = keys_.find(key);
  if (found == keys_.end() || found->is_null()) return std::nullopt;
  if (!found->is_string()) {
    throw error(key, fmt::format("{} is not allowed; allowed: a text", shown(*found)));
  }
  const auto& text = found->get_ref<const std::string&>();
  if (text.empty() || text.size() > kLongestText || text.find('\0') != std::string::npos) {
    throw error(key, fmt::format("{} is not allowed; allowed: a text of 1 to {} characters",
                                 shown(*found), kLongestText));
  }
  return text;
}

std::string Keys::text(const char* key) const {
  auto text = text_if(key);
  if (!text) throw error(key, "is missing");
  return *std::move(text);
}

std::filesystem::path Keys::file(std::string_view ending) const {
  std::filesystem::path named = text("file");
  if (!named.is_absolute() || named.extension() != ending) {
    throw error("file",
                fmt::format("{} is not allowed; allowed: a path that begins with / and ends in {}",
                            shown(named.string()), ending));
  }
  return named;
}

std::filesystem::path Keys::file_to_write(std::string_view ending) const {
  std::filesystem::path named = file(ending);
  std::error_code none;
  if (flag_or("replace", false) || std::filesystem::symlink_status(named, none).type() ==
                                       std::filesystem::file_type::not_found) {
    return named;
  }
  throw error("file", fmt::format("{} exists already; allowed: a new file, or \"replace\": true",
                                  shown(named.string())));
}

double Keys::number_or(const char* key, double usual, double least, double most) const {
  const auto found = keys_.find(key);
  if (found == keys_.end()) return usual;
  if (found->is_number()) {
    const double x = found->get<double>();
    if (x >= least && x <= most) return x;
  }
  throw error(
      key, fmt::format("{} is not allowed; allowed: {:.6g} to {:.6g}", shown(*found), least, most));
}

bool Keys::flag_or(const char* key, bool usual) const {
  const auto found = keys_.find(key);
  if (found == keys_.end()) return usual;
  if (found->is_boolean()) return found->get<bool>();
  throw error(key, fmt::format("{} is not allowed; allowed: true, false", shown(*found)));
}

std::optional<std::vector<std::string>> Keys::texts_if(const char* key, std::size_t most) const {
  const auto found = keys_.find(key);
  if (found == keys_.end() || found->is_null()) return std::nullopt;
  const auto text = [](const json& each) {
    return each.is_string() && !each.get_ref<const std::string&>().empty() &&
           each.get_ref<const std::string&>().size() <= kLongestText;
  };
  if (!found->is_array() || found->size() > most || !std::ranges::all_of(*found, text)) {
    throw error(key, fmt::format("{} is not allowed; allowed: a list of at most {} texts",
                                 shown(*found), most));
  }
  return found->get<std::vector<std::string>>();
}

RemoteError Keys::error(const char* key, const std::string& what) const {
  return RemoteError(fmt::format("{}: {}: {}", verb_, key, what));
}

}  // namespace limpid
