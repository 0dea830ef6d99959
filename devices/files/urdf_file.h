// Arms read from URDF files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "devices/files/text_file.h"

namespace limpid {

// Permission to expand xacro files, by the program `xacro`, which runs code that the file contains.
// Only somebody who named the file can want that.
enum class Xacro : std::uint8_t { refuse, expand };

// Refusal of a file that would have to be expanded without permission.
struct XacroToExpand : FileError {
  explicit XacroToExpand(std::filesystem::path of)
      : FileError(of.string() +
                  ": is a xacro file: expanding it runs the program xacro, which can run code in "
                  "the file. Only files that are named on the command line are expanded without a "
                  "question. Expand the file first (xacro FILE > arm.urdf), or call limpid sweep "
                  "with --allow-xacro"),
        file(std::move(of)) {}

  std::filesystem::path file;
};

// A link at which a chain of joints may end, in a file of more than one chain.
struct ArmTip {
  std::string link;
  int joints = 0;  // moving joints on the way to it

  friend bool operator==(const ArmTip&, const ArmTip&) = default;
};

// Refusal of an arm that branches, to several ends that could be meant.
struct TipsToChoose : FileError {
  TipsToChoose(const FileError& what, std::string of, std::vector<ArmTip> all)
      : FileError(what), file(std::move(of)), tips(std::move(all)) {}

  std::string file;
  std::vector<ArmTip> tips;  // the ends and the links where it branches, most joints first
};

// Reads an arm: a chain of 1 to 32 joints that turn or slide, from the root to the link `tip`.
// Without a name, to the one that the text names itself (<limpid tip="LINK"/>), or to the end of
// the longest chain (way_to_tip in urdf_path.h). All other joints are held still at zero or the
// limit next to it. Links behind joints that do not move are merged into the link that moves them;
// those before the first joint weigh nothing. The tip is the origin of the last link.
//
// The text's own elements <limpid> say more of the device: see read_own() in urdf_values.h.
//
// Faults that an arm can do without are a line each in its `warnings`: pictures that cannot be
// found (see MeshFinder) or read, efforts of 0, links without inertia, joints that cannot move.
// Errors: TipsToChoose if a name has to say which tip; XacroToExpand; FileError "FILE:LINE: ..."
// for what is not URDF or xacro that cannot be expanded, floating and planar joints in the chain, a
// zero axis, numbers that are not finite, negative damping, friction, effort or mass, crossed
// limits, and arms without any inertia.
ArmDescription read_urdf(const std::filesystem::path& file, const std::string& tip = {},
                         Xacro xacro = Xacro::refuse);

// Reads an arm from text; `where` names it in messages. If `base_dir` is empty (text without a
// folder, as inside a session), meshes with relative names are not found.
ArmDescription parse_urdf(const std::string& text, const std::string& where,
                          const std::filesystem::path& base_dir, const std::string& tip = {});

}  // namespace limpid
