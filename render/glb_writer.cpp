#include "render/glb_writer.h"

#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>

namespace limpid {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;
constexpr int kFloat = 5126, kUnsigned = 5125, kVertices = 34962, kIndices = 34963;

void put(std::vector<unsigned char>& out, std::uint32_t number) {
  const auto bytes = std::bit_cast<std::array<unsigned char, 4>>(number);
  out.insert(out.end(), bytes.begin(), bytes.end());
}

void put(std::vector<unsigned char>& out, const Eigen::Vector3f& v) {
  for (const float x : v) put(out, std::bit_cast<std::uint32_t>(x));
}

// A chunk's length, kind and bytes, filled up to a multiple of four.
void put_chunk(std::vector<unsigned char>& out, std::uint32_t kind,
               std::span<const unsigned char> bytes, unsigned char filler) {
  const std::size_t length = (bytes.size() + 3) / 4 * 4;
  put(out, static_cast<std::uint32_t>(length));
  put(out, kind);
  out.insert(out.end(), bytes.begin(), bytes.end());
  out.resize(out.size() + length - bytes.size(), filler);
}

}  // namespace

std::vector<unsigned char> write_glb(const Model& model) {
  using nlohmann::json;
  std::vector<unsigned char> data;
  json views = json::array(), accessors = json::array();
  const auto close = [&](std::size_t from, int target, int type, const char* shape,
                         std::size_t count) {
    views.push_back({{"buffer", 0},
                     {"byteOffset", from},
                     {"byteLength", data.size() - from},
                     {"target", target}});
    accessors.push_back({{"bufferView", views.size() - 1},
                         {"componentType", type},
                         {"type", shape},
                         {"count", count}});
  };
  Eigen::AlignedBox3f box;
  std::size_t from = data.size();
  for (const Vertex& v : model.vertices) put(data, v.position), box.extend(v.position);
  close(from, kVertices, kFloat, "VEC3", model.vertices.size());
  accessors[0]["min"] = {box.min().x(), box.min().y(), box.min().z()};
  accessors[0]["max"] = {box.max().x(), box.max().y(), box.max().z()};
  from = data.size();
  for (const Vertex& v : model.vertices) put(data, v.normal);
  close(from, kVertices, kFloat, "VEC3", model.vertices.size());
  from = data.size();
  for (const Vertex& v : model.vertices) put(data, v.color);
  close(from, kVertices, kFloat, "VEC3", model.vertices.size());
  from = data.size();
  for (const std::uint32_t i : model.indices) put(data, i);
  close(from, kIndices, kUnsigned, "SCALAR", model.indices.size());

  const Eigen::Vector2f surface =
      model.vertices.empty() ? Eigen::Vector2f(0, 0.5f) : model.vertices.front().surface;
  const json gltf = {{"asset", {{"version", "2.0"}}},
                     {"scene", 0},
                     {"scenes", {{{"nodes", {0}}}}},
                     {"nodes", {{{"mesh", 0}}}},
                     {"meshes",
                      {{{"primitives",
                         {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"COLOR_0", 2}}},
                           {"indices", 3},
                           {"material", 0}}}}}}},
                     {"materials",
                      {{{"pbrMetallicRoughness",
                         {{"metallicFactor", surface[0]}, {"roughnessFactor", surface[1]}}}}}},
                     {"buffers", {{{"byteLength", data.size()}}}},
                     {"bufferViews", views},
                     {"accessors", accessors}};
  const std::string text = gltf.dump();
  std::vector<unsigned char> out;
  const std::size_t json_length = (text.size() + 3) / 4 * 4;
  const std::size_t data_length = (data.size() + 3) / 4 * 4;
  put(out, kMagic);
  put(out, std::uint32_t{2});
  put(out, static_cast<std::uint32_t>(12 + 8 + json_length + 8 + data_length));
  put_chunk(out, kJson, {reinterpret_cast<const unsigned char*>(text.data()), text.size()}, ' ');
  put_chunk(out, kBinary, data, 0);
  return out;
}

}  // namespace limpid
