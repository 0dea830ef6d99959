// The text of a scene's file, key by key.
#pragma once

#include <span>
#include <string>

#include "core/touch/scene.h"

namespace limpid {

class SceneText {
 public:
  void table(const char* kind);       // one of several, [[kind]]
  void only_table(const char* kind);  // [kind]
  void put(const char* key, const std::string& value);
  void put(const char* key, double value);
  void put(const char* key, const Vec3& value);
  void put(const char* key, int value);
  void put(const char* key, bool value);
  // Writes `value` as it is, without quotes.
  void put_raw(const char* key, const std::string& value);
  void put_position(const char* key, const Pose& pose) { put(key, Vec3(pose.translation())); }
  void put_rotation(const Pose& pose, const char* key = "rpy");
  // Writes position, rotation and scale, without those that may be left out.
  void put_place(const Pose& pose, double scale);
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// Values as TOML has them.
std::string toml_number(double x);
std::string toml_vector(const Vec3& v);
std::string toml_numbers(std::span<const double> list);
std::string toml_quoted(const std::string& text);

// Writes the stiffness, and all else that differs from the default.
void put_material(SceneText& text, const Material& material);
// Writes the model of a mesh, without its place.
void put_model(SceneText& text, const Mesh& mesh);

}  // namespace limpid
