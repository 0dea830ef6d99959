#include "render/arm_look.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "core/base/model_kinds.h"
#include "render/mesh_shapes.h"
#include "render/model/model_file.h"
#include "render/model/simplify.h"

namespace limpid {

namespace {

namespace fs = std::filesystem;
using Extent = Eigen::AlignedBox3d;

// Number of an arm's collision meshes that are read; with more, those left say nothing.
constexpr int kMostMeshes = 40;
// Least difference between the fits of both ways that counts, as parts of the link's size.
constexpr double kTells = 0.05;
// Limits of misfit by which a file decides alone, against what its folder says.
constexpr double kFitsAlone = 0.1, kFarOffAlone = 0.4;

Vec3 turned(const Vec3& p) { return {p.x(), -p.z(), p.y()}; }

Extent placed(const Visual& visual, const Extent& box, bool turn) {
  Extent out;
  if (box.isEmpty()) return out;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = box.corner(static_cast<Extent::CornerType>(i));
    out.extend(visual.origin * Vec3((turn ? turned(corner) : corner).cwiseProduct(visual.size)));
  }
  return out;
}

Extent box_of(const Visual& shape) {
  Visual whole = shape;
  whole.size.setOnes();
  Vec3 half = shape.size / 2;
  if (shape.shape == Visual::Shape::cylinder) {
    half = Vec3(shape.size.x(), shape.size.x(), shape.size.y() / 2);
  } else if (shape.shape == Visual::Shape::sphere) {
    half.setConstant(shape.size.x());
  }
  return placed(whole, Extent(-half, half), false);
}

// Boxes of links, by the links' numbers.
class LinkBoxes {
 public:
  LinkBoxes(const ArmDescription& arm, std::span<const Visual> collisions,
            const LoadProgress& progress)
      : arm_(arm), collisions_(collisions), progress_(progress) {}

  // Returns the box of the collision shapes; empty without any, or if any of them is glTF or
  // unread.
  const Extent& collision(int link) {
    const auto [at, fresh] = known_.try_emplace(link);
    if (!fresh) return at->second;
    Extent box;
    for (const Visual& shape : collisions_) {
      if (shape.link != link) continue;
      if (shape.shape != Visual::Shape::mesh) {
        box.extend(box_of(shape));
        continue;
      }
      const Extent mesh = bounds_of(shape.mesh);
      if (mesh.isEmpty()) return at->second;  // half of a link says nothing
      box.extend(placed(shape, mesh, false));
    }
    return at->second = box;
  }

  // Returns the box of the frames that the link carries, and of the joint after it.
  Extent frames(int link) const {
    Extent box;
    for (const NamedFrame& frame : arm_.frames) {
      if (frame.link == link) box.extend(frame.origin.translation());
    }
    const auto next = static_cast<std::size_t>(link + 1);
    box.extend(next < arm_.joints.size() ? arm_.joints[next].origin.translation()
                                         : arm_.tip.translation());
    if (link >= 0) box.extend(Vec3::Zero().eval());
    return box;
  }

 private:
  Extent bounds_of(const std::string& file) {
    if (is_gltf(file) || ++read_ > kMostMeshes) return {};
    try {
      return load_model_file(file, {.part = nullptr, .cancel = progress_.cancel}).bounds();
    } catch (const LoadCancelled&) {
      throw;
    } catch (const std::exception&) {
      return {};
    }
  }

  const ArmDescription& arm_;
  std::span<const Visual> collisions_;
  const LoadProgress& progress_;
  std::map<int, Extent> known_;
  int read_ = 0;
};

// Returns how far the faces of a box are from those of another one, as parts of its size.
double difference(const Extent& box, const Extent& other) {
  const double apart =
      (box.min() - other.min()).lpNorm<1>() + (box.max() - other.max()).lpNorm<1>();
  return apart / other.sizes().sum();
}

// Returns how far the corners of `points` are outside of a box, as parts of its size.
double outside(const Extent& box, const Extent& points) {
  const Vec3 over = (box.min() - points.min()).cwiseMax(0) + (points.max() - box.max()).cwiseMax(0);
  return over.sum() / box.sizes().sum();
}

// Misfit of the pictures in some links: turned from y up, and as they are in their files.
struct Wrong {
  double turned = 0, as_it_is = 0;

  void add(double one, double other) {
    if (std::abs(one - other) < kTells) return;
    turned += one;
    as_it_is += other;
  }
  bool tells() const { return turned != as_it_is; }
};

// Pictures of one folder.
struct Folder {
  std::map<int, std::pair<Extent, Extent>>
      links;  // all of a link together: turned, and as they are
  Wrong by_collision, by_frames;

  bool z_up() const {
    const Wrong& wrong = by_collision.tells() ? by_collision : by_frames;
    // Frames are points and say less than shapes: the misfits must differ more to count.
    const double share = by_collision.tells() ? 1 : 0.75;
    return wrong.as_it_is < share * wrong.turned;
  }
};

// Decides by the collision shape of the picture's link alone, where that is beyond doubt.
std::optional<bool> alone(const std::pair<Extent, Extent>& boxes, const Extent& collision) {
  const double turn = difference(boxes.first, collision);
  const double as_it_is = difference(boxes.second, collision);
  if (as_it_is < kFitsAlone && turn > kFarOffAlone) return true;
  if (turn < kFitsAlone && as_it_is > kFarOffAlone) return false;
  return std::nullopt;
}

constexpr double kSeen = 1e-3;  // shorter links are not missed where others have pictures [m]

Paint paint_of(const Visual& visual) {
  Paint paint{{0.75f, 0.76f, 0.78f}, 0, 0.4f};
  if (visual.color) paint.color = visual.color->head<3>().unaryExpr(&linear_light);
  return paint;
}

// Returns whether a model has neither colours nor pictures of its own, as an STL.
bool unpainted(const Model& model) {
  const Eigen::Vector3f none = Vertex{}.color;
  return model.images.empty() &&
         std::ranges::all_of(model.vertices, [&](const Vertex& v) { return v.color == none; });
}

void stretch(Model& model, const Vec3& by) {
  const Eigen::Vector3f scale = by.cast<float>();
  for (Vertex& v : model.vertices) {
    v.position = v.position.cwiseProduct(scale);
    v.normal = v.normal.cwiseQuotient(scale).normalized();
  }
  if (scale.prod() > 0) return;
  for (auto* corners :
       {&model.indices, &model.coarse}) {  // seen in a mirror they run the other way
    for (std::size_t i = 0; i + 2 < corners->size(); i += 3) {
      std::swap((*corners)[i], (*corners)[i + 1]);
    }
  }
}

Model model_of(const Visual& visual) {
  const Paint paint = paint_of(visual);
  const Vec3& size = visual.size;
  switch (visual.shape) {
    case Visual::Shape::box: return make_box(size, 0.1 * size.minCoeff(), paint);
    case Visual::Shape::cylinder: return make_cylinder(size.x(), size.y(), paint);
    case Visual::Shape::sphere: return make_sphere(size.x(), paint);
    case Visual::Shape::mesh:
    case Visual::Shape::stand_in: break;
  }
  Model model = *visual.model;
  stretch(model, size);
  if (unpainted(model)) {
    for (Vertex& v : model.vertices) {
      v.color = paint.color;
      v.surface = {paint.metallic, paint.roughness};
    }
  }
  return model;
}

// Reads a model; refuses empty files and files of nothing but a point, which show nothing.
Model read(const std::string& file, const LoadProgress& progress) {
  Model model = load_model_file(file, progress);
  const Bounds box = model.bounds();
  if (model.indices.empty() || box.isEmpty() || !(box.diagonal().norm() > 0)) {
    throw std::runtime_error(file + ": the model has nothing that can be shown");
  }
  return model;
}

// Reads the models of the visuals that have none, as their files have them. Each that cannot be
// read is a line in the arm's warnings.
std::map<std::string, Model> read_models(ArmDescription& arm, const LoadProgress& progress) {
  std::map<std::string, Model> models;
  std::set<std::string> tried;
  double done = 0;
  for (const Visual& visual : arm.visuals) {
    if (progress.part) *progress.part = done++ / static_cast<double>(arm.visuals.size());
    if (visual.shape != Visual::Shape::mesh || visual.model) continue;
    if (!tried.insert(visual.mesh).second) continue;
    try {
      models[visual.mesh] = read(visual.mesh, {.part = nullptr, .cancel = progress.cancel});
    } catch (const LoadCancelled&) {
      throw;
    } catch (const std::exception& e) {
      arm.warnings.push_back(std::string(e.what()) + "; a plain shape is shown instead");
    }
  }
  return models;
}

void say_z_up(ArmDescription& arm, const std::set<std::string>& files) {
  if (files.empty()) return;
  std::string names;
  std::size_t named = 0;
  for (const std::string& file : files) {
    if (++named > 3) continue;
    names += (names.empty() ? "" : ", ") + std::filesystem::path(file).filename().string();
  }
  if (named > 3) names += " and " + std::to_string(named - 3) + " more";
  arm.warnings.push_back(names + (named == 1 ? " has" : " have") +
                         " z up, but glTF says y up: no rotation is applied, because " +
                         (named == 1 ? "the picture fits the link" : "the pictures fit the links") +
                         " as " + (named == 1 ? "it is" : "they are"));
}

Item body(const ArmDescription& arm, std::size_t i, double reach) {
  const Paint paint = paint_of({});
  const double n = static_cast<double>(std::max(1, arm.dof()));
  const double radius = std::clamp(0.16 * reach / n, 0.003, 0.03);
  const bool last = i + 1 == arm.joints.size();
  Model link = make_capsule(Vec3::Zero(), end_of(arm, i), last ? 0.7 * radius : radius, paint);
  if (arm.slides(i)) {  // a rod as long as its travel
    const Joint& joint = arm.joints[i];
    append(link, make_capsule(Vec3::Zero(), -kSlideUnit * joint.upper * joint.axis, radius, paint));
  }
  if (last) {
    Model tip = make_sphere(radius, paint);
    transform(tip, Eigen::Affine3d(Eigen::Translation3d(end_of(arm, i))));
    append(link, tip);
  }
  return {std::move(link), Pose::Identity(), static_cast<int>(i)};
}

Item foot(const ArmDescription& arm, double reach) {
  const double n = static_cast<double>(std::max(1, arm.dof()));
  const double radius = std::clamp(0.16 * reach / n, 0.003, 0.03);
  return {make_sphere(1.5 * radius, paint_of({})), Pose::Identity(), -1};
}

}  // namespace

bool is_gltf(const std::string& file) {
  const ModelKind* const kind = model_kind(file);
  return kind != nullptr && kind->gltf;
}

std::set<std::string> with_z_up(const ArmDescription& arm,
                                const std::map<std::string, Model>& models,
                                std::span<const Visual> collisions, const LoadProgress& progress) {
  std::map<fs::path, Folder> folders;
  std::map<std::string, std::pair<int, std::pair<Extent, Extent>>> files;  // a link that each is in
  for (const Visual& visual : arm.visuals) {
    const auto model = models.find(visual.mesh);
    if (model == models.end() || !is_gltf(visual.mesh)) continue;
    const Extent box = model->second.bounds();
    const std::pair boxes{placed(visual, box, true), placed(visual, box, false)};
    auto& together = folders[fs::path(visual.mesh).parent_path()].links[visual.link];
    together.first.extend(boxes.first);
    together.second.extend(boxes.second);
    files[visual.mesh] = {visual.link, boxes};
  }
  LinkBoxes links(arm, collisions, progress);
  for (auto& [path, folder] : folders) {
    for (const auto& [link, boxes] : folder.links) {
      if (const Extent& shape = links.collision(link); !shape.isEmpty()) {
        folder.by_collision.add(difference(boxes.first, shape), difference(boxes.second, shape));
      }
      const Extent frames = links.frames(link);
      folder.by_frames.add(outside(boxes.first, frames), outside(boxes.second, frames));
    }
  }
  std::set<std::string> z_up;
  for (const auto& [file, place] : files) {
    const Folder& folder = folders[fs::path(file).parent_path()];
    const Extent& shape = links.collision(place.first);
    const auto own = shape.isEmpty() ? std::nullopt : alone(place.second, shape);
    if (own.value_or(folder.z_up())) z_up.insert(file);
  }
  return z_up;
}

void stand_upright(Model& model) {
  for (Vertex& v : model.vertices) {
    v.position = Eigen::Vector3f(v.position.x(), -v.position.z(), v.position.y());
    v.normal = Eigen::Vector3f(v.normal.x(), -v.normal.z(), v.normal.y());
  }
}

Vec3 end_of(const ArmDescription& arm, std::size_t i) {
  return i + 1 < arm.joints.size() ? Vec3(arm.joints[i + 1].origin.translation())
                                   : Vec3(arm.tip.translation());
}

void load_visuals(ArmDescription& arm, std::span<const Visual> collisions,
                  const LoadProgress& progress) {
  std::map<std::string, Model> models = read_models(arm, progress);
  // STL, OBJ and Collada have z up in URDF, whatever they say.
  const std::set<std::string> z_up = with_z_up(arm, models, collisions, progress);
  say_z_up(arm, z_up);
  std::map<std::string, std::shared_ptr<const Model>> ready;
  for (auto& [file, model] : models) {
    if (is_gltf(file) && !z_up.contains(file)) stand_upright(model);
    add_coarse(model);
    ready[file] = std::make_shared<const Model>(std::move(model));
  }
  for (Visual& visual : arm.visuals) {
    if (visual.shape != Visual::Shape::mesh || visual.model) continue;
    visual.model = ready[visual.mesh];
    if (!visual.model) visual.shape = Visual::Shape::stand_in;
  }
}

void add_arm(const ArmDescription& arm, SceneItems& items) {
  std::set<int> seen, wanted;
  for (const Visual& visual : arm.visuals) {
    if (visual.shape == Visual::Shape::stand_in) {
      wanted.insert(visual.link);
      continue;
    }
    seen.insert(visual.link);
    auto& list = visual.link < 0 ? items.base : items.moving;
    list.push_back({model_of(visual), visual.origin, visual.link});
  }
  if (arm.visuals.empty()) wanted.insert(-1);
  for (int i = 0; i < arm.dof(); ++i) {
    if (arm.visuals.empty() || end_of(arm, static_cast<std::size_t>(i)).norm() > kSeen ||
        arm.slides(static_cast<std::size_t>(i))) {
      wanted.insert(i);
    }
  }
  for (const int i : wanted) {
    if (seen.contains(i)) continue;
    if (i < 0) {
      items.base.push_back(foot(arm, items.reach));
    } else {
      items.moving.push_back(body(arm, static_cast<std::size_t>(i), items.reach));
    }
  }
}

}  // namespace limpid
