// Something of the world that is only looked at.
#pragma once

#include <filesystem>

#include "core/math/sizes.h"

namespace limpid {

// A vertex v of the model appears at pose * (scale * v).
struct VisualPicture {
  std::filesystem::path file;  // a model
  Pose pose = Pose::Identity();
  double scale = 1;
};

}  // namespace limpid
