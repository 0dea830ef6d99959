#include "render/model/gltf_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "render/model/gltf_draco.h"

namespace limpid {

namespace {

using Bytes = std::vector<unsigned char>;

constexpr std::uint32_t kGlbMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;

void put(Bytes& out, std::size_t number) {
  const auto bytes =
      std::bit_cast<std::array<unsigned char, 4>>(static_cast<std::uint32_t>(number));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

// Signs in a URI that tinygltf decodes; it takes a plus for a blank.
constexpr const char* kDecodable = "%+";

bool names_decodable(const std::string& uri) {
  return !tinygltf::IsDataURI(uri) && uri.find_first_of(kDecodable) != uri.npos;
}

constexpr int kDeepest = 64;
constexpr std::size_t kMostValues = 8'000'000;
constexpr std::size_t kMostObjects = 1'000'000;  // each may become a struct of two kilobytes

// Checks JSON before memory is spent on it, value by value as the parser reaches them. Throws
// std::runtime_error naming the file for text that is no JSON object, nests deeper than 64, has
// more than 8 million values or 1 million objects, or is glTF 1.
class Guard {
 public:
  explicit Guard(const std::string& name) : name_(name) {}

  bool null() { return count(); }
  bool boolean(bool) { return count(); }
  bool number_integer(std::int64_t) { return count(); }
  bool number_unsigned(std::uint64_t) { return count(); }
  bool number_float(double, const std::string&) { return count(); }
  // Number of buffers that stand for the binary chunk (each would be a copy of it).
  std::size_t embedded() const { return embedded_; }
  // Whether a URI has signs that tinygltf would decode.
  bool decodable() const { return decodable_; }

  bool string(std::string& text) {
    if (depth_ == 2 && in_asset_ && at_version_ && text.starts_with("1")) refuse_old();
    if (depth_ == 3 && at_uri_) {
      has_uri_ = !text.empty();
      decodable_ = decodable_ || names_decodable(text);
    }
    return count();
  }
  bool binary(nlohmann::json::binary_t&) { return count(); }
  bool key(std::string& key) {
    if (depth_ == 1) {
      in_buffers_ = key == "buffers";
      in_asset_ = key == "asset";
      at_list_ = key == "accessors" || key == "meshes" || key == "bufferViews";
    }
    if (depth_ == 2) at_version_ = key == "version";
    if (depth_ == 3) {
      at_uri_ = key == "uri";
      if (at_uri_) has_uri_ = false;
    }
    return count();
  }
  bool start_object(std::size_t) {
    if (depth_ == 1 && at_list_) refuse_old();  // glTF 2 has arrays there
    if (depth_ == 2) has_uri_ = false;
    if (++objects_ > kMostObjects) refuse("has more than 1 million JSON objects");
    return enter();
  }
  bool end_object() {
    --depth_;
    if (depth_ == 2 && in_buffers_ && !has_uri_) ++embedded_;
    return true;
  }
  bool start_array(std::size_t) {
    if (depth_ == 0) refuse("is not a JSON object");
    return enter();
  }
  bool end_array() {
    --depth_;
    return true;
  }
  bool parse_error(std::size_t at, const std::string&, const nlohmann::json::exception&) {
    refuse("is not valid JSON at its byte " + std::to_string(at));
  }

 private:
  bool count() {
    if (++values_ > kMostValues) refuse("has more than 8 million JSON values");
    return true;
  }
  bool enter() {
    if (++depth_ > kDeepest) refuse("has JSON nested deeper than 64");
    return count();
  }
  [[noreturn]] void refuse(const std::string& why) const {
    throw std::runtime_error(name_ + ": " + why);
  }

  [[noreturn]] void refuse_old() const { refuse(kOldGltf); }

  const std::string& name_;
  std::size_t values_ = 0, objects_ = 0;
  std::size_t embedded_ = 0;
  int depth_ = 0;
  bool in_buffers_ = false, at_uri_ = false, has_uri_ = false;
  bool in_asset_ = false, at_version_ = false, at_list_ = false;
  bool decodable_ = false;
};

using nlohmann::json;

constexpr std::uint32_t kJsonChunk = 0x4E4F534A;

std::uint32_t word_at(std::span<const unsigned char> bytes, std::size_t at) {
  std::uint32_t word;
  std::memcpy(&word, bytes.data() + at, 4);
  return word;
}

// Returns the JSON text in a binary file. Compares all lengths with the file first, as tinygltf
// trusts them in places.
std::span<const unsigned char> json_of_glb(std::span<const unsigned char> bytes,
                                           const std::string& name) {
  if (bytes.size() < 20) refuse(name, "is too short for a glTF file");
  if (word_at(bytes, 0) != 0x46546C67u)
    refuse(name, "is not a glTF file (it does not begin with glTF or {)");
  if (word_at(bytes, 4) == 1) refuse(name, kOldGltf);
  if (word_at(bytes, 4) != 2)
    refuse(name, "is glTF " + std::to_string(word_at(bytes, 4)) + ", not 2");
  if (word_at(bytes, 8) != bytes.size())
    refuse(name, "has the wrong length: it has " + std::to_string(bytes.size()) +
                     " bytes, but its header says " + std::to_string(word_at(bytes, 8)));
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

// Returns a text file's JSON without a byte order mark and blanks in front; empty: it is no text.
std::span<const unsigned char> json_of_text(std::span<const unsigned char> bytes) {
  if (bytes.size() >= 3 && bytes[0] == 0xEF && bytes[1] == 0xBB && bytes[2] == 0xBF)
    bytes = bytes.subspan(3);
  while (!bytes.empty() && std::strchr(" \t\r\n", bytes[0]) && bytes[0] != 0)
    bytes = bytes.subspan(1);
  return !bytes.empty() && bytes[0] == '{' ? bytes : bytes.subspan(bytes.size());
}

// Decodes a data URI of a kind that tinygltf does not know, as WebP.
std::optional<std::vector<unsigned char>> embedded(const std::string& uri) {
  constexpr std::string_view kMark = ";base64,";
  const auto at = uri.find(kMark);
  if (at == uri.npos) return std::nullopt;
  const std::string known = "data:application/octet-stream" + uri.substr(at);
  std::vector<unsigned char> bytes;
  std::string kind;
  if (!tinygltf::DecodeDataURI(&bytes, kind, known, 0, false)) return std::nullopt;
  return bytes;
}

bool read_other(std::vector<unsigned char>* out, std::string* error, const std::string& uri,
                void* user) {
  auto& around = *static_cast<Companions*>(user);
  std::string why = around.none() ? "it must contain everything itself" : "it does not exist";
  try {
    auto bytes = uri.starts_with("data:") ? embedded(uri)
                 : around.none()          ? std::nullopt
                                          : around.read(uri);
    if (bytes) {
      *out = std::move(*bytes);
      return true;
    }
  } catch (const std::runtime_error& e) {  // fatal for a buffer, not for a picture
    why = e.what();
  }
  if (error) *error = why;
  return false;
}

// Replaces the file system. A template, for not every tinygltf asks for a file's size.
template <class Callbacks>
Callbacks only_companions(Companions& around) {
  Callbacks out{};
  out.FileExists = [](const std::string&, void*) { return true; };
  out.ExpandFilePath = [](const std::string& path, void*) { return path; };
  out.ReadWholeFile = read_other;
  out.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&,
                          void*) { return false; };
  out.user_data = &around;
  if constexpr (requires { out.GetFileSizeInBytes; }) {
    // tinygltf asks only for files that it reads whole afterwards, and reading has its own limits.
    out.GetFileSizeInBytes = [](std::size_t* size, std::string*, const std::string&, void*) {
      *size = 1;
      return true;
    };
  }
  return out;
}

// Keeps pictures encoded: which of them are needed is not known yet. Those in buffer views stay
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

bool contains(std::span<const unsigned char> text, std::string_view word) {
  return std::search(text.begin(), text.end(), word.begin(), word.end()) != text.end();
}

// Returns whether a view has its bytes in the buffer. Compressed views count by the buffer of their
// extension.
bool is_used(json& gltf, std::size_t buffer) {
  const auto names = [&](const json& object) {
    const auto found = object.find("buffer");
    return found != object.end() && *found == buffer;
  };
  for (const json& view : gltf_list(gltf, "bufferViews")) {
    if (!view.is_object()) continue;
    bool packed = false;
    for (const json& extension : view.value("extensions", json::object())) {
      if (!extension.is_object() || !extension.contains("mode")) continue;
      packed = true;
      if (names(extension)) return true;
    }
    if (!packed && names(view)) return true;
  }
  return false;
}

// Makes buffers that exist in name only, for readers without meshopt, a byte each: tinygltf would
// take each for the binary chunk. Returns how many others have no uri.
std::size_t shrink_fallbacks(json& gltf) {
  std::size_t embedded = 0;
  json& buffers = gltf_list(gltf, "buffers");
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    json& buffer = buffers[i];
    if (!buffer.is_object() || buffer.contains("uri")) continue;
    if (is_used(gltf, i)) {
      ++embedded;
      continue;
    }
    buffer["byteLength"] = 1;
    buffer["uri"] = "data:application/octet-stream;base64,AA==";
  }
  return embedded;
}

// Gives indices in Draco data a buffer view: tinygltf wants one.
void give_views(json& gltf) {
  json& accessors = gltf_list(gltf, "accessors");
  for (json& mesh : gltf_list(gltf, "meshes")) {
    if (!mesh.is_object()) continue;
    for (json& primitive : gltf_list(mesh, "primitives")) {
      if (!primitive.is_object()) continue;
      const json packed =
          primitive.value(json::json_pointer("/extensions") / kDracoExtension, json());
      const json indices = primitive.value("indices", json());
      if (!packed.is_object() || !indices.is_number_unsigned()) continue;
      const auto at = indices.get<std::size_t>();
      if (at < accessors.size() && accessors[at].is_object() &&
          !accessors[at].contains("bufferView"))
        accessors[at]["bufferView"] = packed.value("bufferView", json(0));
    }
  }
}

// Has tinygltf ask for URIs as they are written: Companions decodes a file's name where there is no
// file of that very name.
void keep_names(json& gltf) {
  for (const char* key : {"buffers", "images"}) {
    for (json& object : gltf_list(gltf, key)) {
      if (!object.is_object() || !object.contains("uri") || !object["uri"].is_string()) continue;
      auto& uri = object["uri"].get_ref<std::string&>();
      if (!names_decodable(uri)) continue;
      std::string encoded;
      for (const char c : uri) {
        encoded += c == '%' ? "%25" : c == '+' ? "%2B" : std::string(1, c);
      }
      uri = std::move(encoded);
    }
  }
}

// Rewrites what tinygltf would not understand.
std::vector<unsigned char> reworded(std::span<const unsigned char> bytes,
                                    std::span<const unsigned char> text, bool binary,
                                    const std::string& name) {
  json gltf = json::parse(text.begin(), text.end(), nullptr, false);
  // The reader says what is wrong with it.
  if (!gltf.is_object()) return {bytes.begin(), bytes.end()};
  if (shrink_fallbacks(gltf) > (binary ? 1 : 0))
    refuse(name, "has more than one buffer without a uri");
  give_views(gltf);
  keep_names(gltf);
  for (const char* key : {"buffers", "images", "bufferViews", "accessors", "meshes"})
    if (gltf[key].empty()) gltf.erase(key);  // a list must not be
  const std::string changed = gltf.dump();
  if (!binary) return {changed.begin(), changed.end()};
  const std::size_t data = static_cast<std::size_t>(text.data() - bytes.data()) + text.size() + 8;
  const auto rest = bytes.subspan(std::min(data, bytes.size()));
  return glb_bytes(changed, {rest.begin(), rest.end()});
}

}  // namespace

void fill_up(Bytes& bytes, unsigned char filler) {
  bytes.resize((bytes.size() + 3) / 4 * 4, filler);
}

Bytes glb_bytes(const std::string& json, const Bytes& data) {
  const std::size_t text = (json.size() + 3) / 4 * 4, binary = (data.size() + 3) / 4 * 4;
  Bytes out;
  out.reserve(28 + text + binary);
  put(out, kGlbMagic);
  put(out, 2);
  put(out, 12 + 8 + text + 8 + binary);
  put(out, text);
  put(out, kJson);
  out.insert(out.end(), json.begin(), json.end());
  fill_up(out, ' ');
  put(out, binary);
  put(out, kBinary);
  out.insert(out.end(), data.begin(), data.end());
  fill_up(out, 0);
  return out;
}

nlohmann::json& gltf_list(nlohmann::json& object, const char* key) {
  nlohmann::json& found = object[key];
  if (!found.is_array()) found = nlohmann::json::array();
  return found;
}

std::span<const unsigned char> gltf_json(std::span<const unsigned char> bytes,
                                         const std::string& name) {
  const auto text = json_of_text(bytes);
  return text.empty() ? json_of_glb(bytes, name) : text;
}

GltfFile parse_gltf_file(std::span<const unsigned char> bytes, const std::string& name,
                         const std::filesystem::path& folder) {
  if (bytes.size() > kLargestModelFiles)
    refuse(name,
           "is larger than the limit of " + std::to_string(kLargestModelFiles >> 20) + " MiB");
  auto text = json_of_text(bytes);
  const bool binary = text.empty();
  if (binary) text = json_of_glb(bytes, name);
  std::vector<unsigned char> changed;
  Guard guard(name);
  json::sax_parse(text.begin(), text.end(), &guard);
  if (guard.embedded() > (binary ? 1 : 0) || guard.decodable() || contains(text, kDracoExtension)) {
    changed = reworded(bytes, text, binary, name);
    bytes = changed;
    text = binary ? json_of_glb(bytes, name) : bytes;
  }

  GltfFile out;
  Companions around(name, folder, bytes.size());
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keep_encoded, &out.pictures);
  loader.SetFsCallbacks(only_companions<tinygltf::FsCallbacks>(around));
  std::string error, warning;
  bool good = false;
  try {
    good = binary ? loader.LoadBinaryFromMemory(&out.gltf, &error, &warning, bytes.data(),
                                                static_cast<unsigned>(bytes.size()))
                  : loader.LoadASCIIFromString(&out.gltf, &error, &warning,
                                               reinterpret_cast<const char*>(text.data()),
                                               static_cast<unsigned>(text.size()), "");
  } catch (const std::logic_error&) {  // JSON that tinygltf did not expect
    error = "is not valid glTF";
  }
  if (!good) refuse(name, error.empty() ? "is not valid glTF" : first_line(error));
  if (!error.empty()) out.warnings.push_back(one_line(first_line(error)));
  for (tinygltf::Image& image : out.gltf.images) image.uri = decoded_uri(image.uri);
  out.pictures.resize(out.gltf.images.size());
  return out;
}

}  // namespace limpid
