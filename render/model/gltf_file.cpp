#include "render/model/gltf_file.h"

#include <cstring>
#include <stdexcept>

#include "render/model/gltf_guard.h"

namespace limpid {
namespace {

constexpr std::uint32_t kJsonChunk = 0x4E4F534A;

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw std::runtime_error(name + ": " + one_line(why));
}

std::uint32_t word_at(std::span<const unsigned char> bytes, std::size_t at) {
  std::uint32_t word;
  std::memcpy(&word, bytes.data() + at, 4);
  return word;
}

// The JSON text in a binary file. tinygltf trusts the lengths a file states in places, so all of
// them are compared with the file first.
std::span<const unsigned char> json_of_glb(std::span<const unsigned char> bytes,
                                           const std::string& name) {
  if (bytes.size() < 20) refuse(name, "is too short for a glTF file");
  if (word_at(bytes, 0) != 0x46546C67u)
    refuse(name, "is not a glTF file (it begins neither with glTF nor {)");
  if (word_at(bytes, 4) != 2)
    refuse(name, "is glTF " + std::to_string(word_at(bytes, 4)) + ", not 2");
  if (word_at(bytes, 8) != bytes.size())
    refuse(name, "is truncated or padded, it has " + std::to_string(bytes.size()) +
                     " bytes and says " + std::to_string(word_at(bytes, 8)));
  std::size_t at = 12;
  while (at < bytes.size()) {
    const std::size_t left = bytes.size() - at;
    if (left < 8 || word_at(bytes, at) > left - 8)
      refuse(name, "has a chunk at byte " + std::to_string(at) + " that is longer than the file");
    at += 8 + word_at(bytes, at);
  }
  if (word_at(bytes, 16) != kJsonChunk) refuse(name, "has no JSON chunk at its beginning");
  return bytes.subspan(20, word_at(bytes, 12));
}

// A text file's JSON without a byte order mark and blanks in front; empty: it is no text.
std::span<const unsigned char> json_of_text(std::span<const unsigned char> bytes) {
  if (bytes.size() >= 3 && bytes[0] == 0xEF && bytes[1] == 0xBB && bytes[2] == 0xBF)
    bytes = bytes.subspan(3);
  while (!bytes.empty() && std::strchr(" \t\r\n", bytes[0]) && bytes[0] != 0)
    bytes = bytes.subspan(1);
  return !bytes.empty() && bytes[0] == '{' ? bytes : bytes.subspan(bytes.size());
}

bool read_other(std::vector<unsigned char>* out, std::string* error, const std::string& uri,
                void* user) {
  auto& around = *static_cast<Companions*>(user);
  auto bytes = around.none() ? std::nullopt : around.read(uri);
  if (!bytes) {
    if (error) *error = around.none() ? "it must contain everything itself" : "it does not exist";
    return false;
  }
  *out = std::move(*bytes);
  return true;
}

// Pictures stay encoded: which of them are needed is not known yet. Those in buffer views stay
// there; tinygltf has not compared the views with their buffers, so their bytes are not touched.
bool keep_encoded(tinygltf::Image* image, const int index, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void* user) {
  if (image->bufferView >= 0) return true;
  auto& pictures = *static_cast<std::vector<std::vector<unsigned char>>*>(user);
  const auto at = static_cast<std::size_t>(index);
  if (pictures.size() <= at) pictures.resize(at + 1);
  pictures[at].assign(bytes, bytes + size);
  return true;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

std::span<const unsigned char> gltf_json(std::span<const unsigned char> bytes,
                                         const std::string& name) {
  const auto text = json_of_text(bytes);
  return text.empty() ? json_of_glb(bytes, name) : text;
}

GltfFile parse_gltf_file(std::span<const unsigned char> bytes, const std::string& name,
                         const std::filesystem::path& folder) {
  if (bytes.size() > kLargestModelFiles)
    refuse(name,
           "is larger than the " + std::to_string(kLargestModelFiles >> 20) + " MiB that are read");
  const auto text = json_of_text(bytes);
  const bool binary = text.empty();
  guard_gltf_json(binary ? json_of_glb(bytes, name) : text, name);

  GltfFile out;
  Companions around(name, folder, bytes.size());
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keep_encoded, &out.pictures);
  loader.SetFsCallbacks({[](const std::string&, void*) { return true; },
                         [](const std::string& path, void*) { return path; }, read_other,
                         [](std::string*, const std::string&, const std::vector<unsigned char>&,
                            void*) { return false; },
                         &around});
  std::string error, warning;
  bool good = false;
  try {
    good = binary ? loader.LoadBinaryFromMemory(&out.gltf, &error, &warning, bytes.data(),
                                                static_cast<unsigned>(bytes.size()))
                  : loader.LoadASCIIFromString(&out.gltf, &error, &warning,
                                               reinterpret_cast<const char*>(text.data()),
                                               static_cast<unsigned>(text.size()), "");
  } catch (const std::logic_error&) {  // what tinygltf did not expect in the JSON
    error = "is not valid glTF";
  }
  if (!good) refuse(name, error.empty() ? "is not valid glTF" : first_line(error));
  if (!error.empty()) out.warnings.push_back(one_line(first_line(error)));
  out.pictures.resize(out.gltf.images.size());
  return out;
}

}  // namespace limpid
