// The picture of the window in the desktop's lists: the ghost of an arm and its proxy.
#pragma once

#include <cstdint>
#include <vector>

struct GLFWwindow;

namespace limpid {

// `size` x `size` pixels of RGBA, from the upper left corner, not multiplied by their opacity.
std::vector<std::uint8_t> icon(int size);
// Gives it to the window, in several sizes.
void set_icon(GLFWwindow* window);

}  // namespace limpid
