#include "render/model/gltf_material.h"

#include <stb/stb_image.h>
#include <webp/decode.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "render/model/model_building.h"

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

// Finds width and height; false for what is not to be read. Accepts only these kinds: stb would try
// many more.
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

// Decodes into image.rgba; returns false for broken bytes.
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

float unit(double value) {
  return std::isfinite(value) ? static_cast<float>(std::clamp(value, 0.0, 1.0)) : 0.0f;
}

double number(const tinygltf::Value& object, const char* key, double otherwise) {
  const auto& value = object.Get(key);
  const double read = value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
  return std::isfinite(read) ? read : otherwise;
}

Eigen::Vector2f pair(const tinygltf::Value& object, const char* key, float otherwise) {
  const auto& value = object.Get(key);
  Eigen::Vector2f out = Eigen::Vector2f::Constant(otherwise);
  for (int i = 0; value.IsArray() && value.ArrayLen() == 2 && i < 2; ++i)
    out[i] = static_cast<float>(value.Get(i).IsNumber() ? value.Get(i).GetNumberAsDouble() : 0);
  return out.allFinite() && out.cwiseAbs().maxCoeff() < 1e6f ? out
                                                             : Eigen::Vector2f::Constant(otherwise);
}

// Returns the transform of KHR_texture_transform.
Eigen::Affine2f move_of(const tinygltf::Value& extension) {
  const double turn = number(extension, "rotation", 0);
  const auto c = static_cast<float>(std::cos(turn)), s = static_cast<float>(std::sin(turn));
  Eigen::Affine2f move = Eigen::Affine2f::Identity();
  move.linear() << c, s, -s, c;
  move.linear() *= pair(extension, "scale", 1).asDiagonal();
  move.translation() = pair(extension, "offset", 0);
  return move;
}

Image::Wrap wrap_of(int gl) {
  return gl == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Image::Wrap::clamp
         : gl == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Image::Wrap::mirror
                                                       : Image::Wrap::repeat;
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

void GltfMaterials::warn(const std::string& what) { add_warning(model_, what); }

const GltfMaterial& GltfMaterials::at(int index) {
  const auto found = known_.find(index);
  if (found != known_.end()) return found->second;
  GltfMaterial made;
  if (index >= 0) made = read(file_.at(source_.gltf.materials, index, "material"));
  return known_.emplace(index, made).first->second;
}

GltfMaterial GltfMaterials::read(const tinygltf::Material& from) {
  GltfMaterial to;
  bool placed = false;  // a texture has named its coordinates
  const auto& pbr = from.pbrMetallicRoughness;
  if (pbr.baseColorFactor.size() == 4) {
    for (int i = 0; i < 3; ++i)
      to.color[i] = unit(pbr.baseColorFactor[static_cast<std::size_t>(i)]);
    to.opacity = unit(pbr.baseColorFactor[3]);
  }
  to.surface = {unit(pbr.metallicFactor), unit(pbr.roughnessFactor)};
  to.material.color = texture(pbr.baseColorTexture, true, to, placed);
  to.material.surface = texture(pbr.metallicRoughnessTexture, false, to, placed);
  to.material.normal = texture(from.normalTexture, false, to, placed);
  to.material.emission = texture(from.emissiveTexture, true, to, placed);
  if (to.material.normal >= 0 && std::isfinite(from.normalTexture.scale))
    to.material.bump = static_cast<float>(std::clamp(from.normalTexture.scale, -10.0, 10.0));
  if (from.emissiveFactor.size() == 3)
    for (std::size_t i = 0; i < 3; ++i) to.material.glow[i] = unit(from.emissiveFactor[i]);
  to.material.two_sided = from.doubleSided;
  if (from.alphaMode == "MASK") {
    to.material.alpha = Finish::Alpha::mask;
    to.material.cutoff = unit(from.alphaCutoff);
  } else if (from.alphaMode == "BLEND") {
    to.material.alpha = Finish::Alpha::blend;
  } else {
    to.opacity = 1;
  }
  return to;
}

// Keeps one set of coordinates: that of the material's first texture.
template <class Info>
int GltfMaterials::texture(const Info& info, bool srgb, GltfMaterial& to, bool& placed) {
  if (info.index < 0) return -1;
  int set = info.texCoord;
  Eigen::Affine2f move = Eigen::Affine2f::Identity();
  const auto extension = info.extensions.find("KHR_texture_transform");
  if (extension != info.extensions.end() && extension->second.IsObject()) {
    move = move_of(extension->second);
    set = static_cast<int>(std::clamp(number(extension->second, "texCoord", set), -1.0, 99.0));
  }
  if (placed && (set != to.uv_set || !move.matrix().isApprox(to.uv_move.matrix()))) {
    warn("a texture that has its own coordinates is ignored");
    return -1;
  }
  const auto& texture = file_.at(source_.gltf.textures, info.index, "texture");
  int source = texture.source;
  std::string kinds;
  for (const auto& [name, value] : texture.extensions) {
    kinds += " " + name;
    if (source < 0 && name == "EXT_texture_webp" && value.Get("source").IsInt())
      source = value.Get("source").GetNumberAsInt();
  }
  if (source < 0) {
    warn("a texture of a kind that Limpid cannot read is ignored:" + one_line(kinds));
    return -1;
  }
  file_.at(source_.gltf.images, source, "image");
  tinygltf::Sampler sampler;
  if (texture.sampler >= 0) sampler = file_.at(source_.gltf.samplers, texture.sampler, "sampler");
  const int image = picture(source, srgb, wrap_of(sampler.wrapS), wrap_of(sampler.wrapT));
  if (image < 0) return -1;
  placed = true;
  to.uv_set = set;
  to.uv_move = move;
  return image;
}

int GltfMaterials::picture(int source, bool srgb, Image::Wrap wrap_u, Image::Wrap wrap_v) {
  const auto [place, is_new] = pictures_.try_emplace({source, srgb, wrap_u, wrap_v}, -1);
  if (!is_new) return place->second;
  const auto& from = source_.gltf.images[static_cast<std::size_t>(source)];
  const auto bytes = from.bufferView >= 0
                         ? file_.view(from.bufferView)
                         : std::span(source_.pictures[static_cast<std::size_t>(source)]);
  auto image = images_.decode(bytes, name_);
  if (!image) {
    warn("image " + std::to_string(source) +
         (from.uri.empty() ? "" : " (\"" + one_line(from.uri) + "\")") +
         (bytes.empty() ? " is missing, so it is ignored" : std::string(" is ") + kUnknownPicture));
    return -1;
  }
  image->srgb = srgb;
  image->wrap_u = wrap_u;
  image->wrap_v = wrap_v;
  model_.images.push_back(std::move(*image));
  return place->second = static_cast<int>(model_.images.size()) - 1;
}

}  // namespace limpid
