// Icon of the window in the desktop's lists: the ghost of an arm and its proxy.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

struct GLFWwindow;

namespace limpid {

// Returns `size` x `size` pixels of RGBA, from the upper left corner, not premultiplied.
std::vector<std::uint8_t> icon(int size);
// Returns the icon as SVG.
std::string icon_svg();
// Gives the icon to the window, in several sizes.
void set_icon(GLFWwindow* window);

}  // namespace limpid
