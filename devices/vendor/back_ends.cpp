#include "devices/vendor/back_end.h"

namespace limpid {

std::span<const BackEndEntry> back_ends() {
  static const std::array<BackEndEntry, 2> all{{
      {"openhaptics", "3D Systems", {0x2988}, make_openhaptics},
      {"forcedimension", "Force Dimension", {0x1451}, make_force_dimension},
  }};
  return all;
}

}  // namespace limpid
