// What the numbers of a model's file are likely to mean.
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
  bool y_up = false;     // else z
  bool guessed = false;  // the file does not say all of it
};

// As the file says; else the usual: STL in millimetres unless it is then smaller than one, as it
// is with robots' parts, others in metres; z up in STL and PLY, y in OBJ.
ModelAxes axes_of(const Model& model, const std::filesystem::path& file);

// For people: "in mm, z up", "(guessed)" behind it if it is.
std::string text_of(const ModelAxes& axes);

// What there is to know about a model's file before it is touched.
struct ModelReport {
  std::vector<std::string> facts;     // "triangles    12000", a line each
  std::vector<std::string> warnings;  // what was left out, and what touching will feel odd
};

// The model as it is touched. Errors: FileError naming the model `where`; LoadCancelled.
std::shared_ptr<const TriangleMesh> shape_of(const Model& model, const std::string& where,
                                             const std::atomic<bool>* cancel);

// What touching will feel odd: holes, branches, sheets, walls turned inside out. A line each.
std::vector<std::string> touch_warnings(const Model& model, const TriangleMesh& shape);

// Whether a model of this unit [m] is larger than 10 m or smaller than 1 mm, for people: then the
// unit was likely another one. Else empty.
std::string size_warning(const Model& model, double unit);

// Reads the file and builds its shape. Errors: FileError and std::runtime_error naming the file;
// LoadCancelled.
ModelReport report_on_model(const std::filesystem::path& file, const LoadProgress& progress = {});

}  // namespace limpid
