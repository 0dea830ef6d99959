// Pictures without a display: an EGL context without a surface, and files for what was drawn.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace limpid {

// Makes an OpenGL 3.3 core context current on this thread for as long as it lives, with a
// framebuffer of the given size bound. Throws std::runtime_error where EGL cannot give one.
class OffscreenContext {
 public:
  OffscreenContext(int width, int height);
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Returns the name that OpenGL gives the current context's renderer.
std::string renderer_name();

// Fills the bound framebuffer with one colour, 0xrrggbb.
void fill(unsigned colour);

// Reads the rectangle (0, 0, width, height) of the bound framebuffer: four bytes a pixel, top row
// first, opaque.
std::vector<unsigned char> read_rgba(int width, int height);

// Returns such pixels of what `draw` draws into a framebuffer of its own. The current context's
// framebuffer and viewport stay as they were. Throws std::runtime_error if OpenGL refuses the size.
std::vector<unsigned char> drawn_rgba(int width, int height, const std::function<void()>& draw);

// Encodes such pixels as a PNG file, with `per_metre` pixels a metre for printing unless that is 0,
// and a description unless that is empty. Errors: std::invalid_argument when the sizes do not
// agree, std::runtime_error.
std::vector<unsigned char> png_of(int width, int height, const std::vector<unsigned char>& rgba,
                                  unsigned per_metre = 0, const std::string& about = "");

// Writes such pixels to a PNG file. Throws std::runtime_error naming the file when it cannot be
// written, std::invalid_argument when the sizes do not agree.
void write_png(const std::filesystem::path& path, int width, int height,
               const std::vector<unsigned char>& rgba);

}  // namespace limpid
