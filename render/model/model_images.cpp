#include "render/model/model_images.h"

#include <stb/stb_image.h>
#include <webp/decode.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <stdexcept>

namespace limpid {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 30;
constexpr int kLongestEdge = 16384;
constexpr int kMostScans = 200;  // of a progressive JPEG; each goes over the whole picture

bool is_png(std::span<const unsigned char> bytes) {
  constexpr unsigned char kMagic[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  return bytes.size() > 8 && std::equal(std::begin(kMagic), std::end(kMagic), bytes.begin());
}

bool is_jpeg(std::span<const unsigned char> bytes) {
  if (bytes.size() < 4 || bytes[0] != 0xFF || bytes[1] != 0xD8) return false;
  int scans = 0;
  for (std::size_t i = 0; i + 1 < bytes.size(); ++i)
    if (bytes[i] == 0xFF && bytes[i + 1] == 0xDA && ++scans > kMostScans) return false;
  return true;
}

bool is_webp(std::span<const unsigned char> bytes) {
  const auto has = [&](const char* tag, std::size_t at) {
    return std::equal(tag, tag + 4, bytes.begin() + static_cast<std::ptrdiff_t>(at));
  };
  return bytes.size() > 12 && has("RIFF", 0) && has("WEBP", 8);
}

// Width and height; false for what is not to be read. Only these kinds: stb would try many more.
bool measure(std::span<const unsigned char> bytes, int& width, int& height) {
  const auto length = static_cast<int>(bytes.size());
  int channels = 0;
  const bool known =
      is_webp(bytes) ? WebPGetInfo(bytes.data(), bytes.size(), &width, &height) != 0
      : is_png(bytes) || is_jpeg(bytes)
          ? stbi_info_from_memory(bytes.data(), length, &width, &height, &channels) != 0
          : false;
  return known && width >= 1 && height >= 1 && width <= kLongestEdge && height <= kLongestEdge;
}

// False for what turns out to be broken.
bool fill(std::span<const unsigned char> bytes, std::size_t size, Image& image) {
  if (is_webp(bytes)) {
    image.rgba.resize(size);
    return WebPDecodeRGBAInto(bytes.data(), bytes.size(), image.rgba.data(), size,
                              4 * image.width) != nullptr;
  }
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width, &height,
                            &channels, 4),
      stbi_image_free);
  if (!pixels || width != image.width || height != image.height) return false;
  image.rgba.assign(pixels.get(), pixels.get() + size);
  return true;
}

}  // namespace

std::optional<Image> ModelImages::decode(std::span<const unsigned char> bytes,
                                         const std::string& name) {
  Image image;
  if (bytes.size() > kMostBytes || !measure(bytes, image.width, image.height)) return std::nullopt;
  const std::size_t size =
      4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  encoded_ += bytes.size();
  decoded_ += size;
  if (encoded_ > kMostBytes || decoded_ > kMostBytes)
    throw std::runtime_error(name + ": has more than 1 GiB of pictures");
  return fill(bytes, size, image) ? std::optional(std::move(image)) : std::nullopt;
}

}  // namespace limpid
