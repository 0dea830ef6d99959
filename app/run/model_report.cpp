#include "app/run/model_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/model_kinds.h"
#include "devices/files/scene/scene_document.h"
#include "devices/files/text_file.h"
#include "render/model/model_file.h"

namespace limpid {

ModelAxes axes_of(const Model& model, const std::filesystem::path& file) {
  const ModelKind* const kind = model_kind(file);
  ModelAxes axes{usual_unit(file), kind != nullptr && kind->y_up, false};
  if (model.unit > 0) {
    axes.unit = model.unit;
  } else {
    axes.guessed = true;
    if (model.bounds().sizes().maxCoeff() < 1) axes.unit = 1;
  }
  if (model.up != Model::Up::unsaid) axes.y_up = model.up == Model::Up::y;
  return axes;
}

std::string text_of(const ModelAxes& axes) {
  const ModelUnit* const unit = model_unit(axes.unit);
  return fmt::format("in {}, {} up{}", unit ? unit->name : "its own unit", axes.y_up ? "y" : "z",
                     axes.guessed ? " (guessed)" : "");
}

namespace {

// Thinness of a closed body, as a part of its size, at which it is pushed through before it is
// felt.
constexpr double kThin = 0.005;
constexpr std::size_t kProbes = 2000;  // triangles that are looked at

// Returns the body's volume by the divergence theorem, in its own units; below zero if its surface
// faces inwards.
double volume(const Model& model, const Vec3& middle) {
  double sum = 0;
  for (std::size_t i = 0; i < model.indices.size(); i += 3) {
    const auto at = [&](std::size_t k) {
      return Vec3(model.vertices[model.indices[i + k]].position.cast<double>() - middle);
    };
    sum += at(0).dot(at(1).cross(at(2))) / 6;
  }
  return sum;
}

// Returns the share of triangles less than `thin` from the other side of the body.
double thin_share(const Model& model, const TriangleMesh& shape, double thin) {
  const std::size_t count = model.indices.size() / 3;
  const std::size_t step = std::max<std::size_t>(1, count / kProbes);
  std::size_t looked = 0, found = 0;
  for (std::size_t t = 0; t < count; t += step) {
    const auto at = [&](std::size_t k) {
      return Vec3(model.vertices[model.indices[3 * t + k]].position.cast<double>() -
                  shape.middle());
    };
    const Vec3 n = (at(1) - at(0)).cross(at(2) - at(0));
    if (!(n.norm() > 0)) continue;
    const Vec3 inward = -n.normalized(), middle = (at(0) + at(1) + at(2)) / 3;
    const double skin = 1e-4 * shape.radius();
    MeshPoint other;
    ++looked;
    if (shape.crossing(middle + skin * inward, middle + thin * inward, other) &&
        other.normal.dot(inward) > 0.5)
      ++found;
  }
  return looked > 0 ? static_cast<double>(found) / static_cast<double>(looked) : 0;
}

std::string counted(std::size_t n, const char* what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

std::string size_text(const Model& model, double unit) {
  const Vec3 size = unit * model.bounds().sizes();
  const bool large = size.maxCoeff() >= 1;
  const Vec3 shown = large ? size : Vec3(1e3 * size);
  return fmt::format("{:.4g} x {:.4g} x {:.4g} {}", shown.x(), shown.y(), shown.z(),
                     large ? "m" : "mm");
}

// Sizes of things touched with a hand: neither as large as a house nor as small as a grain of sand.
constexpr double kLargest = 10, kSmallest = 1e-3;  // [m]

std::size_t materials(const Model& model) {
  std::set<std::array<float, 4>> looks;
  for (const Vertex& v : model.vertices)
    looks.insert({v.color.x(), v.color.y(), v.color.z(), v.opacity});
  return std::max(looks.size() <= 64 ? looks.size() : 0, model.parts.size());
}

}  // namespace

std::shared_ptr<const TriangleMesh> shape_of(const Model& model, const std::string& where,
                                             const std::atomic<bool>* cancel) {
  std::vector<Eigen::Vector3f> corners;
  corners.reserve(model.vertices.size());
  for (const Vertex& v : model.vertices) corners.push_back(v.position);
  try {
    return std::make_shared<const TriangleMesh>(corners, model.indices, cancel);
  } catch (const std::exception& e) {
    if (cancel != nullptr && cancel->load()) throw LoadCancelled(where + ": cancelled");
    throw FileError(where + ": " + e.what());
  }
}

std::vector<std::string> touch_warnings(const Model& model, const TriangleMesh& shape) {
  std::vector<std::string> lines;
  if (const std::string health = shape.health().text(); !health.empty()) lines.push_back(health);
  if (!shape.health().closed()) return lines;
  if (volume(model, shape.middle()) < 0) {
    lines.push_back("the faces point inwards: the model is felt from inside, like a hollow");
  }
  const double size = model.bounds().sizes().maxCoeff();
  const double share = thin_share(model, shape, kThin * size);
  if (share > 0.2) {
    lines.push_back(
        fmt::format("{:.0f} % of the model's surface is a wall thinner than {:.2g} % of the "
                    "model's size: pressed hard, the tip may slip around the wall's edge",
                    100 * share, 100 * kThin));
  }
  return lines;
}

std::string size_warning(const Model& model, double unit) {
  const double longest = unit * model.bounds().sizes().maxCoeff();
  if (longest <= kLargest && longest >= kSmallest) return {};
  const bool large = longest > kLargest;
  return fmt::format(
      "the model is {:.3g} {} long, {}: the unit (m, cm, mm, in or ft) or the scale may be wrong",
      large ? longest : 1e3 * longest, large ? "m" : "mm",
      large ? "more than 10 m" : "less than 1 mm");
}

ModelReport report_on_model(const std::filesystem::path& file, const LoadProgress& progress) {
  const Model model = load_model_file(file, progress);
  const auto shape = shape_of(model, file.string(), progress.cancel);
  const ModelAxes axes = axes_of(model, file);
  ModelReport report;
  const auto fact = [&](const char* what, const std::string& value) {
    report.facts.push_back(fmt::format("{:<13}{}", what, value));
  };
  fact("triangles", fmt::format("{}", shape->triangles()));
  fact("size", size_text(model, axes.unit));
  fact("read as", text_of(axes));
  fact("surface", shape->health().closed() ? "closed" : "open");
  fact("materials", fmt::format("{}", materials(model)));
  fact("textures", counted(model.images.size(), "picture"));
  report.warnings = model.warnings;
  if (std::string odd = size_warning(model, axes.unit); !odd.empty()) {
    report.warnings.push_back("read as " + text_of(axes) + ", " + odd);
  }
  for (const std::string& line : touch_warnings(model, *shape)) report.warnings.push_back(line);
  return report;
}

}  // namespace limpid
