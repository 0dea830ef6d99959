#include "app/desktop/widgets/picture_texture.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "render/gl/image_texture.h"

namespace limpid {

void onto_dark(std::span<unsigned char> rgba, Rgb sheet) {
  const std::array paper{sheet.r, sheet.g, sheet.b};
  for (std::size_t i = 0; i + 3 < rgba.size(); i += 4) {
    const auto pixel = rgba.subspan(i, 3);
    const auto [least, most] = std::ranges::minmax(pixel);
    for (std::size_t c = 0; c < 3; ++c) {
      const int turned = pixel[c] + 255 - least - most;  // lightness, as HSL has it
      pixel[c] = static_cast<unsigned char>(paper[c] + turned * (255 - paper[c]) / 255);
    }
  }
}

PictureTexture::PictureTexture(const std::filesystem::path& file, std::optional<Rgb> sheet) {
  texture_ = load_texture(file, width_, height_, [&](std::span<unsigned char> rgba) {
    if (sheet) onto_dark(rgba, *sheet);
  });
}

PictureTexture::~PictureTexture() { delete_texture(texture_); }

PictureTexture::PictureTexture(PictureTexture&& other) noexcept
    : texture_(std::exchange(other.texture_, 0)), width_(other.width_), height_(other.height_) {}

PictureTexture& PictureTexture::operator=(PictureTexture&& other) noexcept {
  std::swap(texture_, other.texture_);
  std::swap(width_, other.width_);
  std::swap(height_, other.height_);
  return *this;
}

ImTextureID PictureTexture::id() const {
  return reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(texture_));
}

}  // namespace limpid
