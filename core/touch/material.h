// How what can be touched pushes back. The paper's couplings render its stiffness alone (section
// 4.1: contacts are pure stiffness), the predictive one all of it.
#pragma once

namespace limpid {

struct Material {
  double stiffness = 600;       // [N/m]
  double damping = 0;           // while pressed in or let out [N s/m]
  double friction_static = 0;   // largest tangential force that sticks, by the normal one [-]
  double friction_kinetic = 0;  // the tangential force while slipping, by the normal one [-]
};

}  // namespace limpid
