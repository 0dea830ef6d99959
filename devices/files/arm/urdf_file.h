// Arms from URDF files.
#pragma once

#include <filesystem>
#include <string>

#include "core/dynamics/arm_description.h"
#include "devices/files/arm/arm_tip.h"
#include "devices/files/arm/xacro_consent.h"

namespace limpid {

// A chain of 1 to 32 joints that turn or slide, from the root to the link `tip`, or where none is
// named to the one that the text names itself (<limpid tip="LINK"/>), or to the end of the longest
// chain (way_to_tip in urdf_path.h). Everything else is held still at zero or the limit next to it;
// links behind joints that do not move are merged into the one that moves them (those before the
// first joint weigh nothing); the tip is the origin of the last link.
//
// What else the text says of the device is in <limpid>, see urdf_own.h.
//
// What an arm can do without is a line in its `warnings`: pictures that cannot be found (see
// MeshFinder) or read, efforts of 0, links without inertia, joints that cannot move.
// Errors: TipsToChoose where a name has to say which tip; XacroToExpand; FileError "FILE:LINE: ..."
// for what is not URDF or xacro that cannot be expanded, floating and planar joints in the chain, a
// zero axis, numbers that are not finite, negative damping, friction, effort or mass, crossed
// limits, and arms without any inertia.
ArmDescription read_urdf(const std::filesystem::path& file, const std::string& tip = {},
                         Xacro xacro = Xacro::refuse);

// `where` names the text in messages. With an empty `base_dir` (a text that has no folder, as the
// one inside a session) meshes with relative names are not found.
ArmDescription parse_urdf(const std::string& text, const std::string& where,
                          const std::filesystem::path& base_dir, const std::string& tip = {});

}  // namespace limpid
