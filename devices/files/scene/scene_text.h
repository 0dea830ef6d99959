// The text of a scene's file, key by key.
#pragma once

#include <span>
#include <string>

#include "core/base/field.h"
#include "core/touch/scene.h"

namespace limpid {

class SceneText {
 public:
  void table(const char* kind);       // one of several, [[kind]]
  void only_table(const char* kind);  // [kind]
  void put(const char* key, const std::string& value);
  void put(const char* key, double value);
  void put(const char* key, const Vec3& value);
  void put(const char* key, std::int64_t value);
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

// Writes the needed fields, and those that differ from the usual.
template <class Table, class Owner>
void put_fields(SceneText& text, const Table& fields, const Owner& owner) {
  const Owner usual{};
  for (const Field<Owner>& field : fields) {
    const std::optional<FieldValue> value = value_of(field, owner);
    if (!value || !field.of(owner)) continue;
    if (!field.needed && value == value_of(field, usual)) continue;
    std::visit([&](const auto& x) { text.put(field.key, x); }, *value);
  }
}
// Writes the model of a mesh, without its place.
void put_model(SceneText& text, const Mesh& mesh);

}  // namespace limpid
