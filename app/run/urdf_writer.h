// Arms as URDF files.
#pragma once

#include <string>

#include "core/dynamics/arm_description.h"

namespace limpid {

// Writes the chain with its masses, limits, resistances, springs and delay; links fixed to others
// are merged into those. Read again it is the same arm. `remark` stands in a comment.
std::string urdf_text(const ArmDescription& arm, const std::string& remark);

}  // namespace limpid
