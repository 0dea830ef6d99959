#include "render/model/gltf_pack.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "render/model/gltf_file.h"

namespace limpid {
namespace {

using nlohmann::json;
using Bytes = std::vector<unsigned char>;

bool lies_outside(const json& object) {
  const auto uri = object.is_object() ? object.find("uri") : object.end();
  return object.is_object() && uri != object.end() && uri->is_string() &&
         !uri->get_ref<const std::string&>().starts_with("data:");
}

bool any_outside(const json& gltf, const char* key) {
  const auto found = gltf.find(key);
  return found != gltf.end() && found->is_array() &&
         std::any_of(found->begin(), found->end(), lies_outside);
}

// Moves a view, or an extension of one, from its buffer into the joint first one.
void move_into_first(json& view, const std::vector<std::size_t>& starts) {
  if (!view.is_object() || !view.contains("buffer") || !view["buffer"].is_number_unsigned()) return;
  const auto buffer = view["buffer"].get<std::size_t>();
  if (buffer >= starts.size()) return;
  const json offset = view.value("byteOffset", json(0u));
  view["buffer"] = 0;
  view["byteOffset"] =
      starts[buffer] + (offset.is_number_unsigned() ? offset.get<std::size_t>() : 0);
}

// Joins all buffers into one.
Bytes join_buffers(json& gltf, const GltfFile& file) {
  Bytes all;
  std::vector<std::size_t> starts;
  for (const auto& buffer : file.gltf.buffers) {
    starts.push_back(all.size());
    all.insert(all.end(), buffer.data.begin(), buffer.data.end());
    fill_up(all, 0);
  }
  for (json& view : gltf_list(gltf, "bufferViews")) {
    move_into_first(view, starts);
    if (!view.is_object() || !view.contains("extensions")) continue;
    for (json& extension : view["extensions"]) move_into_first(extension, starts);
  }
  return all;
}

const char* kind_of(const Bytes& picture) {
  return picture.front() == 0xFF  ? "image/jpeg"
         : picture.front() == 'R' ? "image/webp"
                                  : "image/png";
}

void bring_in_pictures(json& gltf, const GltfFile& file, Bytes& all) {
  json& images = gltf_list(gltf, "images");
  json& views = gltf_list(gltf, "bufferViews");
  std::map<std::string, std::size_t> known;  // views of pictures by where they lie
  for (std::size_t i = 0; i < std::min(images.size(), file.pictures.size()); ++i) {
    const Bytes& picture = file.pictures[i];
    if (!lies_outside(images[i]) || picture.empty()) continue;
    const auto [place, is_new] =
        known.try_emplace(images[i]["uri"].get<std::string>(), views.size());
    if (is_new) {
      views.push_back({{"buffer", 0}, {"byteOffset", all.size()}, {"byteLength", picture.size()}});
      all.insert(all.end(), picture.begin(), picture.end());
      fill_up(all, 0);
    }
    images[i].erase("uri");
    images[i]["bufferView"] = place->second;
    if (!images[i].contains("mimeType")) images[i]["mimeType"] = kind_of(picture);
  }
  if (images.empty()) gltf.erase("images");  // a list must not be empty
}

}  // namespace

std::vector<unsigned char> pack_gltf(std::span<const unsigned char> bytes, const std::string& name,
                                     const std::filesystem::path& folder) {
  const auto text = gltf_json(bytes, name);
  json gltf = json::parse(text.begin(), text.end(), nullptr, false);
  if (!gltf.is_object()) throw std::runtime_error(name + ": is not valid JSON");
  if (!any_outside(gltf, "buffers") && !any_outside(gltf, "images")) return {};
  const GltfFile file = parse_gltf_file(bytes, name, folder);
  Bytes all = join_buffers(gltf, file);
  bring_in_pictures(gltf, file, all);
  if (all.empty()) return {};
  gltf["buffers"] = json::array({{{"byteLength", all.size()}}});
  Bytes out = glb_bytes(gltf.dump(), all);
  if (out.size() > kLargestModelFiles) {
    throw std::runtime_error(name + ": is larger than the limit of " +
                             std::to_string(kLargestModelFiles >> 20) +
                             " MiB, together with the files it refers to");
  }
  return out;
}

}  // namespace limpid
