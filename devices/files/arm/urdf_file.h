// Arms from URDF files.
#pragma once

#include <filesystem>
#include <string>

#include "core/dynamics/arm_description.h"

namespace limpid {

// A chain of 1 to 32 revolute or continuous joints with fixed joints anywhere. Links behind fixed
// joints are merged into the one that moves them (those before the first joint weigh nothing); the
// tip is the origin of the last link.
// Errors: FileError "FILE:LINE: ..." for what is not URDF, branches, other kinds of joints, a zero
// axis, numbers that are not finite, negative damping, friction or mass, an effort that is not
// positive, limits without room, links that no torque could hold back (no inertia about their
// joint), and meshes that are missing or not glTF.
ArmDescription read_urdf(const std::filesystem::path& file);

// `where` names the text in messages. With an empty `base_dir` (a text that has no folder, as the
// one inside a session) meshes with relative names are left out.
ArmDescription parse_urdf(const std::string& text, const std::string& where,
                          const std::filesystem::path& base_dir);

}  // namespace limpid
