#include "app/desktop/shell/command_keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "app/desktop/shell/desktop.h"

namespace limpid {
namespace {

// Line of the help for mouse and the like, before or after the keys.
struct Hint {
  const char *with, *what;
};
constexpr std::array kBefore{
    Hint{"drag the tip with the left button",
         "pull the arm, at the depth of the object under the mouse; turn the wheel at the same "
         "time to move nearer or farther; Shift keeps the depth"},
    Hint{"Ctrl+left drag",
         "pull a movable object without the arm; turn the wheel at the same time to move it nearer "
         "or farther"},
    Hint{"left drag elsewhere, right drag", "turn the camera"},
    Hint{"middle drag, Shift+right drag", "move the camera"},
    Hint{"wheel", "zoom to the cursor"},
    Hint{"click, right click", "select an object; open its menu"},
};
constexpr std::array kAfter{
    Hint{"gamepad",
         "left stick: move the hand; triggers: nearer, farther; A: hold, B: force off, Y: next "
         "law, X: magnet"},
    Hint{"plots",
         "drag: move; wheel: zoom; double click: show all; Shift+drag: select a time and see its "
         "mean, rms and limits; right click: choose channels, save"},
    Hint{"sliders", "double click to type, right click for the default value"},
};

// Group of the help, with the beginnings of its commands' ids; groups have this order in the help.
struct Group {
  const char* heading;
  std::array<std::string_view, 4> ids;
};
constexpr std::array kGroups{
    Group{"Force and hand", {"force.", "window.escape", "device.", "hand."}},
    Group{"Mouse and gamepad", {"mouse"}},
    Group{"Coupling", {"coupling.", "observer."}},
    Group{"Recording and playback", {"session.", "loop."}},
    Group{"Plots and picture", {"plots.", "view."}},
    Group{"Scene and objects", {"scene.", "object.", "edit."}},
    Group{"Experiments", {"experiments.", "sweep."}},
    Group{"Settings, window and help", {"settings.", "window.", "export.", "help."}},
};

std::size_t group_of(std::string_view id) {
  for (std::size_t i = 0; i < kGroups.size(); ++i) {
    for (const std::string_view begin : kGroups[i].ids) {
      if (!begin.empty() && id.starts_with(begin)) return i;
    }
  }
  return kGroups.size() - 1;
}

struct Key {
  int modifiers, key;
};

// Returns the key of "Ctrl+Shift+S", by GLFW's numbers.
Key key_of(std::string_view text) {
  Key all{};
  for (const auto& [name, modifier] : {std::pair(std::string_view("Ctrl+"), GLFW_MOD_CONTROL),
                                       {"Alt+", GLFW_MOD_ALT},
                                       {"Shift+", GLFW_MOD_SHIFT}}) {
    if (!text.starts_with(name)) continue;
    all.modifiers |= modifier;
    text.remove_prefix(name.size());
  }
  // Signs that a US keyboard has with Shift.
  if (text == "?") return {all.modifiers | GLFW_MOD_SHIFT, GLFW_KEY_SLASH};
  if (text == "+") return {all.modifiers | GLFW_MOD_SHIFT, GLFW_KEY_EQUAL};
  static constexpr std::array<std::pair<std::string_view, int>, 12> kNamed{
      {{"Space", GLFW_KEY_SPACE},
       {"Esc", GLFW_KEY_ESCAPE},
       {"Enter", GLFW_KEY_ENTER},
       {"Keypad Enter", GLFW_KEY_KP_ENTER},
       {"Keypad +", GLFW_KEY_KP_ADD},
       {"Keypad -", GLFW_KEY_KP_SUBTRACT},
       {"Tab", GLFW_KEY_TAB},
       {"Backspace", GLFW_KEY_BACKSPACE},
       {"Delete", GLFW_KEY_DELETE},
       {"Left", GLFW_KEY_LEFT},
       {"Right", GLFW_KEY_RIGHT},
       {"Home", GLFW_KEY_HOME}}};
  const auto* named = std::ranges::find(kNamed, text, &std::pair<std::string_view, int>::first);
  if (named != kNamed.end()) {
    all.key = named->second;
  } else if (text.size() > 1) {  // "F12"
    all.key = GLFW_KEY_F1 - 1 + std::stoi(std::string(text.substr(1)));
  } else {
    all.key = static_cast<unsigned char>(text[0]);
  }
  return all;
}

// Splits "Ctrl+Y, Ctrl+Shift+Z" into both keys.
std::vector<std::string_view> keys_of(const Command& command) {
  std::vector<std::string_view> keys;
  std::string_view left = command.keys != nullptr ? command.keys : "";
  while (!left.empty()) {
    const std::size_t end = std::min(left.find(", "), left.size());
    keys.push_back(left.substr(0, end));
    left.remove_prefix(std::min(end + 2, left.size()));
  }
  return keys;
}

// Returns "Ctrl+[" with the label of that key instead of "[".
std::string text_on(const KeyLabels& labels, std::string_view text) {
  const std::size_t key = text.size() - 1;
  return std::string(text.substr(0, key)) + labels.text(text.substr(key));
}

bool reaches(const Command& command, KeyOwner owner) {
  switch (command.how.reach) {
    case Reach::view:
      return owner == KeyOwner::view || owner == KeyOwner::playback || owner == KeyOwner::selection;
    case Reach::playback: return owner == KeyOwner::playback;
    case Reach::selection: return owner == KeyOwner::selection || owner == KeyOwner::transform;
    case Reach::transform: return owner == KeyOwner::transform;
    case Reach::panel:
      return owner == KeyOwner::panel || owner == KeyOwner::view || owner == KeyOwner::playback ||
             owner == KeyOwner::selection;
    case Reach::question: return owner == KeyOwner::question;
    case Reach::all_but_text: return owner != KeyOwner::text;
    case Reach::all: return true;
  }
  return false;
}

// Returns whether the character is among the command's keys. Signs and digits count wherever a
// keyboard has them, with any modifiers: "?" is Shift and another key nearly everywhere.
bool is_written_by(const Command& command, unsigned character) {
  if (character <= ' ' || character > '~' || std::isalpha(static_cast<int>(character)) != 0) {
    return false;
  }
  const std::string written(1, static_cast<char>(character));
  const auto keys = keys_of(command);
  return std::ranges::find(keys, written) != keys.end();
}

// Returns whether the key is among the command's. Modifiers do not matter for cutting the force:
// nobody looks for them first.
bool has_key(const Command& command, int key, int modifiers) {
  const bool any = command.how.reach == Reach::all || command.how.reach == Reach::all_but_text;
  return std::ranges::any_of(keys_of(command), [&](std::string_view text) {
    const Key each = key_of(text);
    return each.key == key && (any || each.modifiers == modifiers);
  });
}

}  // namespace

const Command* command_of(KeyOwner owner, const KeyPress& press) {
  const int held =
      press.modifiers & (GLFW_MOD_SHIFT | GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER);
  const Command* found = nullptr;
  const auto look = [&](auto&& meant) {
    for (const Command& command : commands()) {
      if (!reaches(command, owner) || !meant(command)) continue;
      if (found == nullptr || found->how.reach == Reach::view) found = &command;
    }
  };
  if ((held & ~GLFW_MOD_SHIFT) == 0) {
    look([&](const Command& command) { return is_written_by(command, press.character); });
  }
  if (found == nullptr) {
    look([&](const Command& command) { return has_key(command, press.key, held); });
  }
  return found == nullptr || (press.repeated && !found->how.repeats) ? nullptr : found;
}

void handle_keys(std::span<const KeyPress> pressed, Desktop& desktop) {
  for (const KeyPress& press : pressed) {
    // The owner is asked for each key, as the key before may have opened something.
    const KeyOwner owner = owner_of(desktop.focus());
    if (owner == KeyOwner::transform) {
      const bool back = press.key == GLFW_KEY_BACKSPACE;
      if (back ? desktop.transform.untype() : desktop.transform.type(press.character)) continue;
    }
    const Command* command = command_of(owner, press);
    if (command != nullptr) run_or_say(command->id, desktop);
  }
}

std::string key_text(const Command& command, const KeyLabels& labels) {
  const auto keys = keys_of(command);
  return keys.empty() ? "" : text_on(labels, keys.front());
}

std::vector<Shortcut> shortcuts(const KeyLabels& labels) {
  std::array<std::vector<Shortcut>, kGroups.size()> groups;
  const auto hint = [&](const Hint& each) {
    const std::size_t at = group_of("mouse");
    groups[at].push_back({kGroups[at].heading, each.with, each.what});
  };
  std::ranges::for_each(kBefore, hint);
  Shortcut* last = nullptr;  // line of the last command with a help text of its own
  for (const Command& command : commands()) {
    if (command.keys == nullptr || command.how.reach == Reach::question) continue;
    std::string keys;
    for (const std::string_view key : keys_of(command)) {
      keys += (keys.empty() ? "" : ", ") + text_on(labels, key);
    }
    if (command.help == nullptr || *command.help != '\0') {
      const std::size_t at = group_of(command.id);
      groups[at].push_back(
          {kGroups[at].heading, keys, command.help != nullptr ? command.help : command.text});
      last = &groups[at].back();
    } else {
      last->keys += ", " + keys;
    }
  }
  std::ranges::for_each(kAfter, hint);
  std::vector<Shortcut> all;
  for (const auto& group : groups) all.insert(all.end(), group.begin(), group.end());
  return all;
}

}  // namespace limpid
