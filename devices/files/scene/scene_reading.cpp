#include "devices/files/scene/scene_reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/base/model_kinds.h"
#include "devices/files/field_file.h"
#include "devices/files/rpy.h"
#include "devices/files/scene/scene_fields.h"
#include "devices/files/text_file.h"

namespace limpid {

using namespace scene_limits;
namespace fs = std::filesystem;

Pose pose_of(const TomlTable& t, const Vec3& position, const char* key) {
  Pose p = pose_at(position);
  if (const auto rpy = t.vector(key, kAngle)) p.linear() = rotation(*rpy);
  return p;
}

Vec3 point_of(const TomlTable& t, const char* key) { return t.need(t.vector(key, kPosition), key); }

void hold_color(std::optional<Vec3>& color) {
  if (!color) return;
  for (double& part : *color) part = kColor.hold(part, 0.5);
}

std::string name_of(const TomlTable& t) { return t.need(t.text("name"), "name"); }

std::string model_of(const TomlTable& t) {
  const std::string file = t.need(t.text("file"), "file");
  if (model_kind(file) == nullptr) {
    t.refuse("file", fmt::format("a model ({})", model_suffixes()));
  }
  return file;
}

fs::path model_path(const TomlTable& t, const std::string& file, const fs::path& base_dir) {
  const fs::path absolute = fs::absolute(base_dir / file).lexically_normal();
  std::error_code error;
  if (const std::string why = why_not_found(absolute, ""); !why.empty()) {
    throw FileError(fmt::format("{}: {}", absolute.string(), why));
  }
  if (!fs::is_regular_file(absolute, error)) {
    t.refuse("file", fmt::format("a file that exists; there is no {}", absolute.string()));
  }
  return absolute;
}

namespace {

double unit_of(const TomlTable& t, const std::string& file) {
  const auto wanted = t.text("unit");
  if (!wanted) return usual_unit(file);
  std::vector<std::string> names;
  for (const ModelUnit& each : kModelUnits) {
    if (each.name == *wanted) return each.metres;
    names.push_back(fmt::format("\"{}\"", each.name));
  }
  t.refuse("unit", fmt::format("{}", fmt::join(names, ", ")));
}

}  // namespace

void read_model_keys(const TomlTable& t, Mesh& mesh) {
  mesh.model = model_of(t);
  read_fields(t, kMeshFields, mesh);
  mesh.unit = unit_of(t, mesh.model);
  const std::string up = t.text("up").value_or("z");
  if (up != "y" && up != "z") t.refuse("up", "\"y\", \"z\"");
  mesh.y_up = up == "y";
}

void take_model(const TomlTable& t, const Mesh& mesh, const fs::path& base_dir,
                const SceneFiles& files, SceneDocument& out) {
  if (out.models.contains(mesh.model)) return;
  ModelFile& model = out.models[mesh.model];
  if (const auto known = files.find(mesh.model); known != files.end()) {
    model.bytes = known->second;
    return;
  }
  const fs::path path = model_path(t, mesh.model, base_dir);
  const std::string bytes = read_text(path, kLargestModel);
  model = {path.string(),
           std::make_shared<const std::vector<unsigned char>>(bytes.begin(), bytes.end())};
}

}  // namespace limpid
