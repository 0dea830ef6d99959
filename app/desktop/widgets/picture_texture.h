// A picture from a file, as ImGui shows it.
#pragma once

#include <imgui.h>

#include <filesystem>
#include <optional>
#include <span>

#include "app/style/palette.h"

namespace limpid {

// Pixels of four bytes: what was white becomes `sheet`, a dark colour, what was black white; hues
// and saturation stay.
void onto_dark(std::span<unsigned char> rgba, Rgb sheet);

// Needs a current OpenGL context from construction to destruction.
class PictureTexture {
 public:
  // On `sheet` a figure that was drawn on white paper lies on paper of that colour. Errors:
  // std::runtime_error naming a file that is missing or no picture.
  explicit PictureTexture(const std::filesystem::path& file, std::optional<Rgb> sheet = {});
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
