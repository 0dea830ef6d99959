// The shapes that a body has besides its own.
#pragma once

#include <string>
#include <vector>

#include "app/desktop/panels/shape_fields.h"

namespace limpid {

class PartsEditor {
 public:
  // Says what was changed of which part, "" for nothing.
  std::string edit(Object& object);

 private:
  std::vector<RotationField> rotations_;  // part by part
};

}  // namespace limpid
