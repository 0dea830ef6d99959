#include "render/model/model_images.h"

#include <stb/stb_image.h>

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

}  // namespace

std::optional<Image> ModelImages::decode(std::span<const unsigned char> bytes,
                                         const std::string& name) {
  // Only the two kinds that glTF has; stb would try many more.
  if (bytes.size() > kMostBytes || !(is_png(bytes) || is_jpeg(bytes))) return std::nullopt;
  const auto length = static_cast<int>(bytes.size());
  Image image;
  int channels = 0;
  if (!stbi_info_from_memory(bytes.data(), length, &image.width, &image.height, &channels))
    return std::nullopt;
  if (image.width < 1 || image.height < 1 || image.width > kLongestEdge ||
      image.height > kLongestEdge)
    return std::nullopt;
  const std::size_t size =
      4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  encoded_ += bytes.size();
  decoded_ += size;
  if (encoded_ > kMostBytes || decoded_ > kMostBytes)
    throw std::runtime_error(name + ": has more than 1 GiB of pictures");
  int width = 0, height = 0;
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(bytes.data(), length, &width, &height, &channels, 4), stbi_image_free);
  if (!pixels || width != image.width || height != image.height) return std::nullopt;
  image.rgba.assign(pixels.get(), pixels.get() + size);
  return image;
}

}  // namespace limpid
