// How what can be touched pushes back. Contacts are pure stiffness (paper, section 4.1).
#pragma once

namespace limpid {

struct Material {
  double stiffness = 600;  // [N/m]
};

}  // namespace limpid
