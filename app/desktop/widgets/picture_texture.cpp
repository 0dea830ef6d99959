#include "app/desktop/widgets/picture_texture.h"

#include <cstdint>
#include <utility>

#include "render/gl/image_texture.h"

namespace limpid {

PictureTexture::PictureTexture(const std::filesystem::path& file) {
  texture_ = load_texture(file, width_, height_);
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
