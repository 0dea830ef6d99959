// An object that the mouse moves, turns or scales in the picture.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/run/scene_meshes.h"
#include "core/touch/scene.h"
#include "render/camera.h"

namespace limpid {

enum class TransformKind : std::uint8_t { move, turn, scale };

// Whether there is such a thing for this object: a stop of a joint is nowhere, a plane has no size,
// and a ball that stands still looks the same from everywhere.
bool can(TransformKind kind, const Object& object);

struct Transform {
  TransformKind kind = TransformKind::move;
  Object from{};              // as it was
  Vec3 pivot = Vec3::Zero();  // about which it turns and grows [m]
  std::optional<int> axis{};  // 0 x, 1 y, 2 z; without one: in the picture's plane, or as a whole

  Transform() = default;
  // About the middle of what the object takes.
  Transform(TransformKind kind, Object from, const Model* model);

  // Unit, in the world: those of the world, or the object's own for its size.
  Vec3 direction(int axis) const;
  // What it becomes while the mouse goes from one pixel to another, and how much that is, for
  // people. `steps`: whole ones only, of 5 mm, 15 degrees or a tenth.
  struct Result {
    Object object;
    std::string text;
  };
  Result to(const Camera& camera, const Eigen::Vector2d& begin, const Eigen::Vector2d& now,
            bool steps) const;
  // Names the change for undo.
  const char* what() const;

 private:
  Result moved(const Camera& camera, const Eigen::Vector2d& begin, const Eigen::Vector2d& now,
               bool steps) const;
  Result turned(const Camera& camera, double angle, bool steps) const;
  Result scaled(double factor, bool steps) const;
};

}  // namespace limpid
