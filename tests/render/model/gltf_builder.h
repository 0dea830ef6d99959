// Small glTF files for tests, put together piece by piece.
#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "render/model/gltf_model.h"

namespace limpid {

using Bytes = std::vector<unsigned char>;

template <class T>
void append_values(Bytes& bytes, const std::vector<T>& values) {
  if (values.empty()) return;
  const std::size_t before = bytes.size();
  bytes.resize(before + values.size() * sizeof(T));
  std::memcpy(bytes.data() + before, values.data(), values.size() * sizeof(T));
}

inline void append_word(Bytes& bytes, std::size_t word) {
  append_values<std::uint32_t>(bytes, {static_cast<std::uint32_t>(word)});
}

inline Bytes glb(std::string json, Bytes binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, 0);
  Bytes bytes;
  for (const std::size_t word :
       {std::size_t{0x46546C67}, std::size_t{2}, 28 + json.size() + binary.size(), json.size(),
        std::size_t{0x4E4F534A}})
    append_word(bytes, word);
  bytes.insert(bytes.end(), json.begin(), json.end());
  append_word(bytes, binary.size());
  append_word(bytes, 0x004E4942);
  bytes.insert(bytes.end(), binary.begin(), binary.end());
  return bytes;
}

// Returns why a file is refused; empty if it is read.
inline std::string refusal(const Bytes& bytes) {
  try {
    parse_gltf(bytes, "part.glb");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

// A file with one mesh; every piece of JSON can be replaced before it is written.
struct GltfBuilder {
  std::string attributes, primitive, mesh, nodes = R"({"mesh":0})", roots = "0", more;
  std::string views, accessors, uri;
  Bytes data;
  int view_count = 0, accessor_count = 0;

  template <class T>
  int view(const std::vector<T>& values, const std::string& extra = "") {
    data.resize((data.size() + 3) / 4 * 4);
    views += (views.empty() ? "" : ",") + std::string(R"({"buffer":0,"byteOffset":)") +
             std::to_string(data.size()) + R"(,"byteLength":)" +
             std::to_string(values.size() * sizeof(T)) + extra + "}";
    append_values(data, values);
    return view_count++;
  }
  // `kind` is a component type and a type, e.g. 5126 and VEC3.
  int accessor(int buffer_view, int component, const std::string& type, std::size_t count,
               const std::string& extra = "") {
    accessors += (accessors.empty() ? "" : ",") + std::string("{") +
                 (buffer_view < 0 ? "" : R"("bufferView":)" + std::to_string(buffer_view) + ",") +
                 R"("componentType":)" + std::to_string(component) + R"(,"type":")" + type +
                 R"(","count":)" + std::to_string(count) + extra + "}";
    return accessor_count++;
  }
  void attribute(const std::string& key, int index) {
    attributes += (attributes.empty() ? "\"" : ",\"") + key + "\":" + std::to_string(index);
  }
  void positions(const std::vector<float>& xyz) {
    attribute("POSITION", accessor(view(xyz), 5126, "VEC3", xyz.size() / 3));
  }
  std::string json() const {
    const std::string one = R"({"attributes":{)" + attributes + "}" + primitive + "}";
    return R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" +
           nodes + R"(],"meshes":[{"primitives":[)" + (mesh.empty() ? one : mesh) +
           R"(]}],"accessors":[)" + accessors + R"(],"bufferViews":[)" + views +
           R"(],"buffers":[{"byteLength":)" + std::to_string(data.size()) +
           (uri.empty() ? "" : R"(,"uri":")" + uri + "\"") + "}]" + more + "}";
  }
  Bytes binary() const { return glb(json(), data); }
  Bytes text() const {
    const std::string all = json();
    return Bytes(all.begin(), all.end());
  }
};

// The corners of the unit square in the xy plane, and a picture of one red pixel.
inline const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
inline const Bytes kRedPng = {
    0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0x00, 0x00, 0x00, 0x0D, 0x49, 0x48,
    0x44, 0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x02, 0x00, 0x00,
    0x00, 0x90, 0x77, 0x53, 0xDE, 0x00, 0x00, 0x00, 0x0C, 0x49, 0x44, 0x41, 0x54, 0x78,
    0x9C, 0x63, 0xF8, 0xCF, 0xC0, 0x00, 0x00, 0x03, 0x01, 0x01, 0x00, 0xC9, 0xFE, 0x92,
    0xEF, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4E, 0x44, 0xAE, 0x42, 0x60, 0x82};

}  // namespace limpid
