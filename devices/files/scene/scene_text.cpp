#include "devices/files/scene/scene_text.h"

#include <fmt/format.h>

#include "devices/files/rpy.h"
#include "devices/files/scene/scene_document.h"

namespace limpid {

std::string toml_number(double x) {
  std::string text = fmt::format("{}", x);
  if (text.find_first_of(".ein") == std::string::npos) text += ".0";
  return text;
}

std::string toml_numbers(std::span<const double> list) {
  std::string all;
  for (const double x : list) all += (all.empty() ? "" : ", ") + toml_number(x);
  return "[" + all + "]";
}

std::string toml_vector(const Vec3& v) { return toml_numbers({v.data(), 3}); }

std::string toml_quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += {'\\', c};
    } else if (c == '\n') {
      out += "\\n";
    } else if (byte < 0x20 || byte == 0x7f) {
      out += fmt::format("\\u{:04X}", byte);
    } else {
      out += c;
    }
  }
  return out + '"';
}

void SceneText::table(const char* kind) {
  text_ += fmt::format("{}[[{}]]\n", text_.empty() ? "" : "\n", kind);
}
void SceneText::only_table(const char* kind) { text_ += fmt::format("[{}]\n", kind); }

void SceneText::put(const char* key, const std::string& value) { put_raw(key, toml_quoted(value)); }
void SceneText::put(const char* key, double value) { put_raw(key, toml_number(value)); }
void SceneText::put(const char* key, const Vec3& value) { put_raw(key, toml_vector(value)); }
void SceneText::put(const char* key, std::int64_t value) { put_raw(key, std::to_string(value)); }
void SceneText::put(const char* key, bool value) { put_raw(key, value ? "true" : "false"); }
void SceneText::put_raw(const char* key, const std::string& value) {
  text_ += fmt::format("{} = {}\n", key, value);
}

void SceneText::put_rotation(const Pose& pose, const char* key) {
  if (pose.linear() != Mat3::Identity()) put(key, rpy_of(pose.linear()));
}

void SceneText::put_place(const Pose& pose, double scale) {
  if (!pose.translation().isZero(0)) put_position("position", pose);
  put_rotation(pose);
  if (scale != 1) put("scale", scale);
}

void put_model(SceneText& text, const Mesh& mesh) {
  text.put("file", mesh.model);
  const ModelUnit* const known = model_unit(mesh.unit);
  if (known && mesh.unit != usual_unit(mesh.model)) text.put("unit", std::string(known->name));
  if (mesh.y_up) text.put("up", std::string("y"));
}

}  // namespace limpid
