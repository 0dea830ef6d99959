// Objects of a scene by their shape.
#pragma once

#include <gtest/gtest.h>

#include <stdexcept>

#include "core/touch/scene.h"

namespace limpid::test {

// Index among all objects of the i-th one of a shape.
template <class S>
std::size_t place(const Scene& scene, std::size_t i = 0) {
  for (std::size_t at = 0; at < scene.objects.size(); ++at) {
    if (has_shape<S>(scene.objects[at]) && i-- == 0) return at;
  }
  throw std::out_of_range("fewer objects of this shape");
}
template <class S>
const Object& object(const Scene& scene, std::size_t i = 0) {
  return scene.objects[place<S>(scene, i)];
}
template <class S>
Object& object(Scene& scene, std::size_t i = 0) {
  return scene.objects[place<S>(scene, i)];
}
template <class S>
const S& shape(const Scene& scene, std::size_t i = 0) {
  return std::get<S>(object<S>(scene, i).shape);
}
template <class S>
S& shape(Scene& scene, std::size_t i = 0) {
  return std::get<S>(object<S>(scene, i).shape);
}

// Compares bit for bit.
inline void expect_same(const Object& a, const Object& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.pose.matrix(), b.pose.matrix()) << a.name;
  EXPECT_TRUE(a.shape == b.shape) << a.name;
  EXPECT_EQ(a.material.stiffness, b.material.stiffness) << a.name;
  EXPECT_EQ(a.material.damping, b.material.damping) << a.name;
  EXPECT_EQ(a.material.friction_static, b.material.friction_static) << a.name;
  EXPECT_EQ(a.material.friction_kinetic, b.material.friction_kinetic) << a.name;
  EXPECT_TRUE(a.body == b.body) << a.name;
  EXPECT_EQ(a.color, b.color) << a.name;
  ASSERT_EQ(a.parts.size(), b.parts.size()) << a.name;
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    EXPECT_EQ(a.parts[i].pose.matrix(), b.parts[i].pose.matrix()) << a.name;
    EXPECT_TRUE(a.parts[i].shape == b.parts[i].shape) << a.name;
    EXPECT_EQ(a.parts[i].color, b.parts[i].color) << a.name;
  }
}

}  // namespace limpid::test
