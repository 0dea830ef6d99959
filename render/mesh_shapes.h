// Simple solids that the view needs besides models from files: meshes centred on their own frame.
#pragma once

#include "render/model/model.h"

namespace limpid {

struct Paint {
  Eigen::Vector3f color = Eigen::Vector3f::Constant(0.75f);  // linear
  float metallic = 0, roughness = 0.45f;
};

// Converts a part of a screen's colour (sRGB) to light.
float linear_light(float part);

Model make_box(const Vec3& size, double bevel, const Paint& paint);
Model make_sphere(double radius, const Paint& paint);
Model make_cylinder(double radius, double length, const Paint& paint);  // along z
// A capsule from `from` to `to`, with half spheres at both ends.
Model make_capsule(const Vec3& from, const Vec3& to, double radius, const Paint& paint);
// Makes a cone of radius and height 1, its tip at z = 1, and a tube of radius 1 from z = 0 to 1.
Model make_cone(const Paint& paint);
Model make_tube(const Paint& paint);
// Makes a slice of a disc: from angle 0 to `angle` about z, between two radii, `thickness` along z.
Model make_sector(double inner, double outer, double angle, double thickness, const Paint& paint);
// Makes a round, flat patch facing z, with uv from -1 to 1.
Model make_patch(double radius, const Paint& paint);

void transform(Model& model, const Eigen::Affine3d& by);  // rotation, translation, uniform scale
void append(Model& model, const Model& other);            // neither has textures

}  // namespace limpid
