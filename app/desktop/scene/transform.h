// Transform: moves, turns or scales an object with the mouse in the picture.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "app/run/scene_meshes.h"
#include "core/touch/scene.h"
#include "render/camera.h"

namespace limpid {

inline constexpr std::array kAxisNames{"x", "y", "z"};

enum class TransformKind : std::uint8_t { move, turn, scale };

// Returns whether the object can be transformed so: a stop of a joint is nowhere, a plane has no
// size, and a fixed ball looks the same from everywhere.
bool can(TransformKind kind, const Object& object);

struct Transform {
  TransformKind kind = TransformKind::move;
  Object from{};              // before the transform
  Vec3 pivot = Vec3::Zero();  // point that stays while it turns or grows [m]
  std::optional<int> axis{};  // 0 x, 1 y, 2 z; without one: in the picture's plane, or as a whole

  Transform() = default;
  // Puts the pivot into the middle of the object's bounds.
  Transform(TransformKind kind, Object from, const Model* model);

  // Returns the unit direction of an axis: the world's, or the object's own for scaling.
  Vec3 direction(int axis) const;
  // Returns the object after the mouse went from one pixel to another, and the amount for people.
  // `steps`: only whole steps of 5 mm, 15 degrees or a tenth.
  struct Result {
    Object object;
    std::string text;
  };
  Result to(const Camera& camera, const Eigen::Vector2d& begin, const Eigen::Vector2d& now,
            bool steps) const;
  // Returns the same for an amount in numbers: mm along the axis, or x without one; degrees; a
  // factor.
  Result by(const Camera& camera, double amount) const;
  // Returns the change's name for undo.
  const char* what() const;

 private:
  Result moved(const Camera& camera, const Eigen::Vector2d& begin, const Eigen::Vector2d& now,
               bool steps) const;
  Result moved_along(int axis, double way) const;
  Result turned(const Camera& camera, double angle, bool steps) const;
  Result scaled(double factor, bool steps) const;
};

}  // namespace limpid
