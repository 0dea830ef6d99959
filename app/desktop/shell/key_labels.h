// Keys by what is printed on them: GLFW names a key by its place on a US keyboard.
#pragma once

#include <GLFW/glfw3.h>

#include <array>
#include <functional>
#include <string>
#include <string_view>

#define GLFW_INCLUDE_NONE

namespace limpid {

// Which key is at each place of a keyboard, both by GLFW's names. Letters, digits and signs are
// where this keyboard has them. What it has nowhere is at its place on a US keyboard: all letters
// of a Russian keyboard, the digits of a French one, "[" on a German one. Letters, digits and
// brackets, which commands have, come before other signs there.
class KeyLabels {
 public:
  // Gives the label of the key at a place, in UTF-8; null: it has none.
  using NameOf = std::function<const char*(int place)>;

  KeyLabels();  // of a US keyboard
  explicit KeyLabels(const NameOf& name_of);

  // A number above all of GLFW's for a key that has no name.
  int at(int place) const;
  // "[" or "]" as they are to be looked for here: "ü"; all else as it is.
  std::string text(std::string_view key) const;

 private:
  static constexpr int kPlaces = GLFW_KEY_WORLD_2 + 1;  // those that write something

  std::array<int, kPlaces> keys_{};
  std::array<std::string, kPlaces> names_;
};

// A key that writes something by itself, but a space.
bool is_printable(int key);

}  // namespace limpid
