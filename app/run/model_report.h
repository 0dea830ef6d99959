// Likely meaning of the numbers in a model's file, and what touching the model will be like.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/touch/triangle_mesh.h"
#include "render/model/model.h"

namespace limpid {

struct ModelAxes {
  double unit = 1;       // of the coordinates [m]
  bool y_up = false;     // y is up, else z
  bool guessed = false;  // the file does not say all of it
};

// Reads the axes from the file, or takes the usual ones. STL is in millimetres, unless it is then
// smaller than one, as robots' parts are; others are in metres. z is up in STL and PLY, y in OBJ.
ModelAxes axes_of(const Model& model, const std::filesystem::path& file);

// Describes the axes for people: "in mm, z up", with "(guessed)" behind if they are.
std::string text_of(const ModelAxes& axes);

// Facts and warnings about a model's file before it is touched.
struct ModelReport {
  std::vector<std::string> facts;     // "triangles    12000", a line each
  std::vector<std::string> warnings;  // parts left out, and what will feel odd
};

// Builds the shape by which the model is touched. Errors: FileError naming the model `where`;
// LoadCancelled.
std::shared_ptr<const TriangleMesh> shape_of(const Model& model, const std::string& where,
                                             const std::atomic<bool>* cancel);

// Lists what will feel odd: holes, branches, sheets, walls turned inside out. A line each.
std::vector<std::string> touch_warnings(const Model& model, const TriangleMesh& shape);

// Warns people of a model that is larger than 10 m or smaller than 1 mm with this unit [m]: the
// unit was likely another one. Else empty.
std::string size_warning(const Model& model, double unit);

// Reads the file and builds its shape. Errors: FileError and std::runtime_error naming the file;
// LoadCancelled.
ModelReport report_on_model(const std::filesystem::path& file, const LoadProgress& progress = {});

}  // namespace limpid
