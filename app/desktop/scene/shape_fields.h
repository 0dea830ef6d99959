// Fields of objects, their bodies and their parts, as a person edits them.
#pragma once

#include <optional>
#include <string_view>

#include "devices/files/scene/scene_fields.h"

namespace limpid {

inline constexpr double kMillimetreSpeed = 0.25, kDegreeSpeed = 0.5;  // per pixel of a drag

// Edits a flag, or a number as people write it: lengths in mm, angles in degrees, masses in g; with
// a slider if the field has one. `turns`: of units such as "m or rad" the second. Returns whether
// it changed.
bool edit_value(const FieldInfo& field, double& value, double usual, bool turns = false);

// Edits the numbers and flags of a table. Returns the key of the one that changed, "" for none.
template <class Table, class Owner>
std::string_view edit_fields(const Table& fields, Owner& owner, bool turns = false) {
  std::string_view what;
  for (const Field<Owner>& field : fields) {
    const bool edits = field.is_number() || field.kind == FieldInfo::Kind::flag;
    if (!edits || !field.of(owner)) continue;
    double value = number_of(field, owner);
    if (!edit_value(field, value, number_of(field, Owner{}), turns)) continue;
    set_number(field, owner, value);
    what = field.key;
  }
  return what;
}

// Edits the size of a shape that is no model. Returns the name of the change, "" for none.
std::string_view edit_size(Shape& shape);

// Edits a colour, or its absence, which `otherwise` names. Returns whether it changed.
bool edit_color(std::optional<Vec3>& color, const char* otherwise);

// Field for roll, pitch and yaw of a pose. It keeps the typed angles, as a rotation has many.
class RotationField {
 public:
  bool edit(Pose& pose);  // returns whether it changed

 private:
  Mat3 turned_ = Mat3::Zero();  // the rotation of `degrees_`
  Vec3 degrees_ = Vec3::Zero();
};

}  // namespace limpid
