// What there is to know about a model's file before it is touched.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/touch/triangle_mesh.h"
#include "render/model/load_progress.h"
#include "render/model/model.h"

namespace limpid {

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
