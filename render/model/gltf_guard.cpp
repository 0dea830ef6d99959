#include "render/model/gltf_guard.h"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace limpid {
namespace {

constexpr int kDeepest = 64;
constexpr std::size_t kMostValues = 8'000'000;
constexpr std::size_t kMostObjects = 1'000'000;  // each may become a struct of two kilobytes

// Told of each value in turn by the parser; false ends the reading.
class Guard {
 public:
  explicit Guard(const std::string& name) : name_(name) {}

  bool null() { return count(); }
  bool boolean(bool) { return count(); }
  bool number_integer(std::int64_t) { return count(); }
  bool number_unsigned(std::uint64_t) { return count(); }
  bool number_float(double, const std::string&) { return count(); }
  std::size_t embedded() const { return embedded_; }

  bool string(std::string& text) {
    if (depth_ == 2 && in_asset_ && at_version_ && text.starts_with("1")) refuse_old();
    if (depth_ == 3 && at_uri_) has_uri_ = !text.empty();
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
};

}  // namespace

std::size_t guard_gltf_json(std::span<const unsigned char> text, const std::string& name) {
  Guard guard(name);
  nlohmann::json::sax_parse(text.begin(), text.end(), &guard);
  return guard.embedded();
}

}  // namespace limpid
