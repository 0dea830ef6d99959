// Pictures from files as OpenGL textures.
#pragma once

#include <filesystem>
#include <functional>
#include <span>

namespace limpid {

// Returns the name of a new texture with the picture, first row on top. Needs a current OpenGL
// context. Calls `repaint` first with the pixels, four bytes each. Errors: std::runtime_error
// naming a file that is missing or no picture.
unsigned load_texture(const std::filesystem::path& file, int& width, int& height,
                      const std::function<void(std::span<unsigned char>)>& repaint = {});
void delete_texture(unsigned texture);  // 0 is nothing

}  // namespace limpid
