// Fields of objects and their parts: size, rotation and colour.
#pragma once

#include <optional>
#include <string_view>

#include "core/touch/scene.h"

namespace limpid {

inline constexpr double kMillimetreSpeed = 0.25, kDegreeSpeed = 0.5;  // per pixel of a drag

// Edits a length in mm, 0.1 to 1000. Returns whether it changed.
bool drag_length(const char* label, double& value, const char* help);

// Edits the size of a shape. Returns the name of the change, "" for none.
std::string_view edit_size(Sphere& sphere);
std::string_view edit_size(Box& box);
std::string_view edit_size(Cylinder& cylinder);
std::string_view edit_size(Capsule& capsule);

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
