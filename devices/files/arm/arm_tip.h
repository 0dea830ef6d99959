// Where a chain of joints may end, in a file of more than one chain.
#pragma once

#include <string>
#include <vector>

#include "devices/files/file_error.h"

namespace limpid {

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

}  // namespace limpid
