// Fields that objects and their parts have in common: how large, how turned, of what colour.
#pragma once

#include <optional>
#include <string_view>

#include "core/touch/scene.h"

namespace limpid {

inline constexpr double kMillimetreSpeed = 0.25, kDegreeSpeed = 0.5;  // per pixel of a drag

// A length in mm, 0.1 to 1000. True if it changed.
bool drag_length(const char* label, double& value, const char* help);

// How large it is. Each says what was changed, "" for nothing.
std::string_view edit_size(Sphere& sphere);
std::string_view edit_size(Box& box);
std::string_view edit_size(Cylinder& cylinder);
std::string_view edit_size(Capsule& capsule);

// A colour of its own, or the one that `otherwise` names. True if it changed.
bool edit_color(std::optional<Vec3>& color, const char* otherwise);

// Roll, pitch and yaw of a pose, as they were typed: a rotation has many.
class RotationField {
 public:
  bool edit(Pose& pose);  // true if it changed

 private:
  Mat3 turned_ = Mat3::Zero();  // the rotation that `degrees_` stand for
  Vec3 degrees_ = Vec3::Zero();
};

}  // namespace limpid
