#include "render/upright.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "render/model/model_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using Box = Eigen::AlignedBox3d;

// Larger collision shapes of one arm than these are not read to find out.
constexpr int kMostMeshes = 40;
// How much better one way has to fit, as parts of the link's size, before it counts.
constexpr double kTells = 0.05;
// Of a file by itself, against what its folder says.
constexpr double kFitsAlone = 0.1, kFarOffAlone = 0.4;

Vec3 turned(const Vec3& p) { return {p.x(), -p.z(), p.y()}; }

Box placed(const Visual& visual, const Box& box, bool turn) {
  Box out;
  if (box.isEmpty()) return out;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = box.corner(static_cast<Box::CornerType>(i));
    out.extend(visual.origin * Vec3((turn ? turned(corner) : corner).cwiseProduct(visual.size)));
  }
  return out;
}

Box box_of(const Visual& shape) {
  Visual whole = shape;
  whole.size.setOnes();
  Vec3 half = shape.size / 2;
  if (shape.shape == Visual::Shape::cylinder) {
    half = Vec3(shape.size.x(), shape.size.x(), shape.size.y() / 2);
  } else if (shape.shape == Visual::Shape::sphere) {
    half.setConstant(shape.size.x());
  }
  return placed(whole, Box(-half, half), false);
}

// The boxes of links, by their numbers.
class LinkBoxes {
 public:
  LinkBoxes(const ArmDescription& arm, std::span<const Visual> collisions,
            const LoadProgress& progress)
      : arm_(arm), collisions_(collisions), progress_(progress) {}

  // Of the collision shapes; empty without any, or where these are glTF themselves.
  const Box& collision(int link) {
    const auto [at, fresh] = known_.try_emplace(link);
    if (!fresh) return at->second;
    Box box;
    for (const Visual& shape : collisions_) {
      if (shape.link != link) continue;
      if (shape.shape != Visual::Shape::mesh) {
        box.extend(box_of(shape));
        continue;
      }
      const Box mesh = bounds_of(shape.mesh);
      if (mesh.isEmpty()) return at->second;  // half of a link says nothing
      box.extend(placed(shape, mesh, false));
    }
    return at->second = box;
  }

  // Of the frames that it carries, and the joint after it.
  Box frames(int link) const {
    Box box;
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
  Box bounds_of(const std::string& file) {
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
  std::map<int, Box> known_;
  int read_ = 0;
};

// How far the faces of a box are from those of another one, as parts of its size.
double difference(const Box& box, const Box& other) {
  const double apart =
      (box.min() - other.min()).lpNorm<1>() + (box.max() - other.max()).lpNorm<1>();
  return apart / other.sizes().sum();
}

// How far points at the corners of `points` are outside of a box, as parts of its size.
double outside(const Box& box, const Box& points) {
  const Vec3 over = (box.min() - points.min()).cwiseMax(0) + (points.max() - box.max()).cwiseMax(0);
  return over.sum() / box.sizes().sum();
}

// What is wrong with the pictures in some links: turned from y up, and as they are in their files.
struct Wrong {
  double turned = 0, as_it_is = 0;

  void add(double one, double other) {
    if (std::abs(one - other) < kTells) return;
    turned += one;
    as_it_is += other;
  }
  bool tells() const { return turned != as_it_is; }
};

// One folder's pictures.
struct Folder {
  std::map<int, std::pair<Box, Box>> links;  // all of a link together: turned, and as they are
  Wrong by_collision, by_frames;

  bool z_up() const {
    const Wrong& wrong = by_collision.tells() ? by_collision : by_frames;
    // Frames are points; they say less than shapes, and so more of it is asked for.
    const double share = by_collision.tells() ? 1 : 0.75;
    return wrong.as_it_is < share * wrong.turned;
  }
};

// By the collision shape of its link alone, where that is beyond doubt.
std::optional<bool> alone(const std::pair<Box, Box>& boxes, const Box& collision) {
  const double turn = difference(boxes.first, collision);
  const double as_it_is = difference(boxes.second, collision);
  if (as_it_is < kFitsAlone && turn > kFarOffAlone) return true;
  if (turn < kFitsAlone && as_it_is > kFarOffAlone) return false;
  return std::nullopt;
}

}  // namespace

bool is_gltf(const std::string& file) {
  std::string suffix = fs::path(file).extension().string();
  for (char& c : suffix) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return suffix == ".glb" || suffix == ".gltf";
}

std::set<std::string> with_z_up(const ArmDescription& arm,
                                const std::map<std::string, Model>& models,
                                std::span<const Visual> collisions, const LoadProgress& progress) {
  std::map<fs::path, Folder> folders;
  std::map<std::string, std::pair<int, std::pair<Box, Box>>> files;  // a link that each is in
  for (const Visual& visual : arm.visuals) {
    const auto model = models.find(visual.mesh);
    if (model == models.end() || !is_gltf(visual.mesh)) continue;
    const Box box = model->second.bounds();
    const std::pair boxes{placed(visual, box, true), placed(visual, box, false)};
    auto& together = folders[fs::path(visual.mesh).parent_path()].links[visual.link];
    together.first.extend(boxes.first);
    together.second.extend(boxes.second);
    files[visual.mesh] = {visual.link, boxes};
  }
  LinkBoxes links(arm, collisions, progress);
  for (auto& [path, folder] : folders) {
    for (const auto& [link, boxes] : folder.links) {
      if (const Box& shape = links.collision(link); !shape.isEmpty()) {
        folder.by_collision.add(difference(boxes.first, shape), difference(boxes.second, shape));
      }
      const Box frames = links.frames(link);
      folder.by_frames.add(outside(boxes.first, frames), outside(boxes.second, frames));
    }
  }
  std::set<std::string> z_up;
  for (const auto& [file, place] : files) {
    const Folder& folder = folders[fs::path(file).parent_path()];
    const Box& shape = links.collision(place.first);
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

}  // namespace limpid
