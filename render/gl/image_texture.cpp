#include "render/gl/image_texture.h"

#include <epoxy/gl.h>
#include <stb/stb_image.h>

#include <memory>
#include <stdexcept>

namespace limpid {

unsigned load_texture(const std::filesystem::path& file, int& width, int& height,
                      const std::function<void(std::span<unsigned char>)>& repaint) {
  int channels = 0;
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load(file.c_str(), &width, &height, &channels, 4), stbi_image_free);
  if (!pixels) throw std::runtime_error(file.string() + ": cannot be read as a picture");
  const auto count = 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (repaint) repaint({pixels.get(), count});
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
               pixels.get());
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glBindTexture(GL_TEXTURE_2D, 0);
  return texture;
}

void delete_texture(unsigned texture) {
  if (texture != 0) glDeleteTextures(1, &texture);
}

}  // namespace limpid
