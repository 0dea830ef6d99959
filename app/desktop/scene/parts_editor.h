// Editor of the shapes that a body has besides its own.
#pragma once

#include <string>
#include <vector>

#include "app/desktop/scene/shape_fields.h"

namespace limpid {

class PartsEditor {
 public:
  // Edits the parts; returns the name of the change with its part, "" for none.
  std::string edit(Object& object);

 private:
  std::vector<RotationField> rotations_;  // one for each part
};

}  // namespace limpid
