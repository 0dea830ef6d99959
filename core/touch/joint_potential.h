// Potential along a joint, whose slope is a force: springs, detents, tables, weight.
#pragma once

#include <utility>

#include "core/touch/body.h"

namespace limpid {

class JointPotential {
 public:
  JointPotential() = default;
  explicit JointPotential(JointForce force) : force_(std::move(force)) {}
  // Adds the weight on a hinge, V(s) = cosine cos s + sine sin s [J].
  void add_weight(double cosine, double sine) {
    weight_cos_ = cosine;
    weight_sin_ = sine;
  }
  // Adds the weight on a slider [N].
  void add_weight(double force) { constant_ = force; }

  bool any() const;
  double energy(double s) const;    // [J]
  double force(double s) const;     // -dE/ds
  double softness(double s) const;  // d force / ds
  // Computes the constant force F along the joint over a tick in which it moves by D = a + c F: its
  // work F D is exactly the energy lost. Newton's method. `F`: in, a first guess; out, the force.
  void over_a_tick(double s, double a, double c, double& F) const;

 private:
  double travelled(double s) const;  // integral of the table from its first point [J]
  double table(double s, double& slope) const;

  JointForce force_;
  double weight_cos_ = 0, weight_sin_ = 0, constant_ = 0;
};

}  // namespace limpid
