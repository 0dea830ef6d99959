#include "app/desktop/shell/key_labels.h"

#include <algorithm>
#include <cctype>

namespace limpid {
namespace {

constexpr std::array kSigns{GLFW_KEY_APOSTROPHE, GLFW_KEY_COMMA,     GLFW_KEY_MINUS,
                            GLFW_KEY_PERIOD,     GLFW_KEY_SLASH,     GLFW_KEY_SEMICOLON,
                            GLFW_KEY_EQUAL,      GLFW_KEY_BACKSLASH, GLFW_KEY_GRAVE_ACCENT};

bool is_of_commands(int key) {
  return (key >= GLFW_KEY_0 && key <= GLFW_KEY_9) || (key >= GLFW_KEY_A && key <= GLFW_KEY_Z) ||
         key == GLFW_KEY_LEFT_BRACKET || key == GLFW_KEY_RIGHT_BRACKET;
}

// Returns whether a US keyboard has the key, with its character as GLFW's number.
bool is_us(int key) {
  return is_of_commands(key) || std::ranges::find(kSigns, key) != kSigns.end();
}

// Returns the key with this label on a US keyboard; 0: none.
int us_key(const std::string& name) {
  if (name == "+") return GLFW_KEY_EQUAL;  // a US keyboard has it there, with Shift
  if (name.size() != 1) return 0;
  const int key = std::toupper(static_cast<unsigned char>(name[0]));
  return is_us(key) ? key : 0;
}

}  // namespace

bool is_printable(int key) {
  return is_us(key) || key == GLFW_KEY_WORLD_1 || key == GLFW_KEY_WORLD_2 || key > GLFW_KEY_LAST;
}

KeyLabels::KeyLabels()
    : KeyLabels([name = std::string()](int place) mutable {
        name = static_cast<char>(std::tolower(place));
        return is_us(place) ? name.c_str() : nullptr;
      }) {}

KeyLabels::KeyLabels(const NameOf& name_of) {
  std::array<int, kPlaces> named{};
  for (int place = 0; place < kPlaces; ++place) {
    const auto at = static_cast<std::size_t>(place);
    if (!is_printable(place)) continue;
    if (const char* name = name_of(place)) names_[at] = name;
    named[at] = us_key(names_[at]);
  }
  const auto has = [](const auto& keys, int key) {
    return std::ranges::find(keys, key) != keys.end();
  };
  // Keys of commands that are missing get their US place; another sign there gives way.
  for (int place = 0; place < kPlaces; ++place) {
    auto& key = keys_[static_cast<std::size_t>(place)];
    if (is_of_commands(place) && !has(named, place)) key = place;
  }
  for (std::size_t at = 0; at < keys_.size(); ++at) {
    if (keys_[at] == 0) keys_[at] = named[at];
  }
  for (int place = 0; place < kPlaces; ++place) {
    auto& key = keys_[static_cast<std::size_t>(place)];
    if (key == 0 && is_us(place) && !has(keys_, place)) key = place;
  }
}

int KeyLabels::at(int place) const {
  if (place < 0 || place >= kPlaces || !is_printable(place)) return place;
  const int key = keys_[static_cast<std::size_t>(place)];
  return key != 0 ? key : GLFW_KEY_LAST + 1 + place;
}

std::string KeyLabels::text(std::string_view key) const {
  if (key != "[" && key != "]") return std::string(key);
  const auto found = std::ranges::find(keys_, static_cast<int>(key[0]));
  if (found == keys_.end()) return std::string(key);
  const std::string& name = names_[static_cast<std::size_t>(found - keys_.begin())];
  return name.empty() ? std::string(key) : name;
}

}  // namespace limpid
