// What the numbers of a model's file are likely to mean.
#pragma once

#include <filesystem>
#include <string>

#include "render/model/model.h"

namespace limpid {

struct ModelAxes {
  double unit = 1;       // of the coordinates [m]
  bool y_up = false;     // else z
  bool guessed = false;  // the file does not say all of it
};

// As the file says; else the usual: STL in millimetres unless it is then smaller than one, as it
// is with robots' parts, others in metres; z up in STL and PLY, y in OBJ.
ModelAxes axes_of(const Model& model, const std::filesystem::path& file);

// For people: "in mm, z up", "(guessed)" behind it if it is.
std::string text_of(const ModelAxes& axes);

}  // namespace limpid
