// Labels of keys: GLFW names a key by its place on a US keyboard, people by its print.
#pragma once

#include <GLFW/glfw3.h>

#include <array>
#include <functional>
#include <string>
#include <string_view>

#define GLFW_INCLUDE_NONE

namespace limpid {

// Key at each place of a keyboard, both by GLFW's names. Letters, digits and signs are where this
// keyboard has them. If it has none, they stay at their US place: all letters of a Russian
// keyboard, the digits of a French one, "[" on a German one. Letters, digits and brackets, which
// commands use, come before other signs there.
class KeyLabels {
 public:
  // Returns the label of the key at a place, in UTF-8; null: none.
  using NameOf = std::function<const char*(int place)>;

  KeyLabels();  // of a US keyboard
  explicit KeyLabels(const NameOf& name_of);

  // Returns the key at a place; for a key without a name a number above all of GLFW's.
  int at(int place) const;
  // Returns the label of "[" or "]" on this keyboard, as "ü"; all else as it is.
  std::string text(std::string_view key) const;

 private:
  static constexpr int kPlaces = GLFW_KEY_WORLD_2 + 1;  // places of keys that write something

  std::array<int, kPlaces> keys_{};
  std::array<std::string, kPlaces> names_;
};

// Returns whether the key writes something by itself, other than a space.
bool is_printable(int key);

}  // namespace limpid
