#include "render/model/gltf_meshopt.h"

#include <meshoptimizer.h>

#include <string>

namespace limpid {
namespace {

// Not below zero, nor beyond what a file can hold.
std::size_t number(const tinygltf::Value& object, const char* key) {
  const auto& value = object.Get(key);
  const double read = value.IsNumber() ? value.GetNumberAsDouble() : 0;
  return read >= 0 && read < 4e9 ? static_cast<std::size_t>(read) : 0;
}

std::string word(const tinygltf::Value& object, const char* key) {
  const auto& value = object.Get(key);
  return value.IsString() ? value.Get<std::string>() : "";
}

// What stands in for numbers that compress better; false: unknown, or it does not fit.
bool undo_filter(const std::string& filter, std::vector<unsigned char>& out, std::size_t count,
                 std::size_t stride) {
  if (filter.empty() || filter == "NONE") return true;
  if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) {
    meshopt_decodeFilterOct(out.data(), count, stride);
  } else if (filter == "QUATERNION" && stride == 8) {
    meshopt_decodeFilterQuat(out.data(), count, stride);
  } else if (filter == "EXPONENTIAL" && stride % 4 == 0) {
    meshopt_decodeFilterExp(out.data(), count, stride);
  } else {
    return false;
  }
  return true;
}

}  // namespace

const tinygltf::Value* meshopt_extension(const tinygltf::BufferView& view) {
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    const auto found = view.extensions.find(name);
    if (found != view.extensions.end() && found->second.IsObject()) return &found->second;
  }
  return nullptr;
}

MeshoptSource meshopt_source(const tinygltf::Value& extension) {
  return {static_cast<int>(number(extension, "buffer") & 0x7FFFFFFF),
          number(extension, "byteOffset"), number(extension, "byteLength")};
}

std::vector<unsigned char> decode_meshopt(const tinygltf::Value& extension,
                                          std::span<const unsigned char> bytes, std::size_t most) {
  const std::size_t count = number(extension, "count"), stride = number(extension, "byteStride");
  const std::string mode = word(extension, "mode");
  if (count == 0 || stride == 0 || stride > 256 || count > most / stride) return {};
  std::vector<unsigned char> out(count * stride);
  int failed = 1;
  // The library takes these conditions for granted.
  if (mode == "ATTRIBUTES" && stride % 4 == 0) {
    failed = meshopt_decodeVertexBuffer(out.data(), count, stride, bytes.data(), bytes.size());
    if (failed == 0 && !undo_filter(word(extension, "filter"), out, count, stride)) failed = 1;
  } else if (mode == "TRIANGLES" && count % 3 == 0 && (stride == 2 || stride == 4)) {
    failed = meshopt_decodeIndexBuffer(out.data(), count, stride, bytes.data(), bytes.size());
  } else if (mode == "INDICES" && (stride == 2 || stride == 4)) {
    failed = meshopt_decodeIndexSequence(out.data(), count, stride, bytes.data(), bytes.size());
  }
  if (failed != 0) out.clear();
  return out;
}

}  // namespace limpid
