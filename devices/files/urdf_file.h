// Arms from URDF files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "devices/files/text_file.h"

namespace limpid {

// Files in xacro are expanded by the program `xacro`, which runs code that the file contains: only
// somebody who named the file himself can want that.

enum class Xacro : std::uint8_t { refuse, expand };

// A file that would have to be expanded, and nobody has said that it may be.
struct XacroToExpand : FileError {
  explicit XacroToExpand(std::filesystem::path of)
      : FileError(of.string() +
                  ": is a xacro file: expanding it runs program xacro, which can run code in the "
                  "file. Only what is named on the command line is expanded without a question; "
                  "expand it first (xacro FILE > arm.urdf), or call limpid sweep with "
                  "--allow-xacro"),
        file(std::move(of)) {}

  std::filesystem::path file;
};

// Where a chain of joints may end, in a file of more than one chain.
struct ArmTip {
  std::string link;
  int joints = 0;  // that move, on the way to it

  friend bool operator==(const ArmTip&, const ArmTip&) = default;
};

// An arm that branches, to ends that could both be meant.
struct TipsToChoose : FileError {
  TipsToChoose(const FileError& what, std::string of, std::vector<ArmTip> all)
      : FileError(what), file(std::move(of)), tips(std::move(all)) {}

  std::string file;
  std::vector<ArmTip> tips;  // the ends and the links where it branches, most joints first
};

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
