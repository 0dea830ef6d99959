// A picture from a file, as ImGui shows it.
#pragma once

#include <imgui.h>

#include <filesystem>

namespace limpid {

// Needs a current OpenGL context from construction to destruction.
class PictureTexture {
 public:
  // Errors: std::runtime_error naming a file that is missing or no picture.
  explicit PictureTexture(const std::filesystem::path& file);
  ~PictureTexture();
  PictureTexture(PictureTexture&& other) noexcept;
  PictureTexture& operator=(PictureTexture&& other) noexcept;

  ImTextureID id() const;
  float width() const { return static_cast<float>(width_); }    // [px]
  float height() const { return static_cast<float>(height_); }  // [px]

 private:
  unsigned texture_ = 0;
  int width_ = 0, height_ = 0;
};

}  // namespace limpid
