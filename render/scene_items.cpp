#include "render/scene_items.h"

#include <algorithm>
#include <array>

#include "core/dynamics/arm.h"
#include "render/arm_look.h"
#include "render/mesh_shapes.h"
#include "render/model/model_file.h"
#include "render/model/simplify.h"

namespace limpid {
namespace {

const Paint kObject{{0.85f, 0.84f, 0.82f}, 0, 0.5f};

// Returns the link frames at q = 0.
std::vector<Pose> zero_poses(const ArmDescription& arm) {
  std::vector<Pose> poses;
  Pose pose = Pose::Identity();
  for (const Joint& joint : arm.joints) poses.push_back(pose = pose * joint.origin);
  return poses;
}

Pose pose_of(const std::vector<Pose>& links, int link) {
  return link < 0 ? Pose::Identity() : links[static_cast<std::size_t>(link)];
}

double reach_of(const ArmDescription& arm) {
  double reach = 0;
  for (std::size_t i = 0; i < arm.joints.size(); ++i) reach += end_of(arm, i).norm();
  return std::max(reach, 0.05);
}

bool shown_by_visual(const Bounds& shape, const std::vector<Bounds>& visuals) {
  const double close = 0.1 * shape.sizes().maxCoeff();
  return std::any_of(visuals.begin(), visuals.end(), [&](const Bounds& box) {
    return (box.min() - shape.min()).cwiseAbs().maxCoeff() < close &&
           (box.max() - shape.max()).cwiseAbs().maxCoeff() < close;
  });
}

// Returns the direction, in the frame of joint j at zero, in which the arm leaves the joint's axis.
Vec3 lever(const ArmDescription& arm, std::size_t j) {
  Vec3 along = Vec3::Zero();
  Pose pose = Pose::Identity();
  for (std::size_t i = j; i < arm.joints.size(); ++i) {
    along = pose * end_of(arm, i);
    along -= arm.joints[j].axis * arm.joints[j].axis.dot(along);
    if (along.norm() > 1e-3) return along;
    if (i + 1 < arm.joints.size()) pose = pose * arm.joints[i + 1].origin;
  }
  return arm.joints[j].axis.unitOrthogonal() * 0.05;
}

// Adds the items of an object. A shape that a model of the scene already shows is not drawn twice.
class ObjectItems {
 public:
  ObjectItems(const ArmDescription& arm, const std::vector<Bounds>& visuals, SceneItems& items)
      : arm_(arm), visuals_(visuals), items_(items) {}

  void add(const Object& object) {
    paint(object.color);
    if (!object.body) return add(object.pose, object.shape);
    body_ = static_cast<int>(items_.starts.size());
    items_.starts.push_back(object.pose);
    add(Pose::Identity(), object.shape);
    for (const BodyPart& part : object.parts) {
      paint(part.color ? part.color : object.color);
      add(part.pose, part.shape);
    }
    body_ = -1;
  }

  void add(const Pose& pose, const Shape& any) {
    std::visit([&](const auto& shape) { add(pose, shape); }, any);
  }

  void add(const Pose& pose, const Plane& plane) {
    const Vec3 normal = plane.normal.normalized();
    const Vec3 point = pose.translation();
    if (normal.z() > 0.999) items_.level_planes.push_back(point.z());
    const bool shown = std::any_of(visuals_.begin(), visuals_.end(), [&](const Bounds& box) {
      double highest = -1e9;
      for (int i = 0; i < 8; ++i) {
        const Vec3 corner = box.corner(static_cast<Bounds::CornerType>(i));
        highest = std::max(highest, plane.normal.dot(corner - point));
      }
      return std::abs(highest) < 0.002;
    });
    if (shown) return;
    const double edge = 2.2 * items_.reach, thickness = 0.07 * items_.reach;
    const Vec3 ahead = 0.45 * items_.reach * Vec3::UnitX();
    Pose slab = pose_at(ahead - normal.dot(ahead - point) * normal - 0.5 * thickness * normal);
    slab.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), normal).toRotationMatrix();
    items_.world.push_back(
        {make_box({edge, edge, thickness}, 0.25 * thickness, kObject), slab, -1});
  }

  void add(const Pose& pose, const Sphere& sphere) {
    const Vec3 r = Vec3::Constant(sphere.radius);
    if (shown(moved(Bounds(-r, r), pose))) return;
    put(make_sphere(sphere.radius, paint_), pose);
  }

  void add(const Pose& pose, const Box& box) {
    const Bounds edges(-0.5 * box.size, 0.5 * box.size);
    if (shown(moved(edges, pose))) return;
    put(make_box(box.size, 0.04 * box.size.minCoeff(), paint_), pose);
  }

  void add(const Pose& pose, const Cylinder& cylinder) {
    const double r = cylinder.radius, half = cylinder.length / 2;
    if (shown(moved(Bounds(Vec3(-r, -r, -half), Vec3(r, r, half)), pose))) return;
    put(make_cylinder(r, cylinder.length, paint_), pose);
  }

  void add(const Pose& pose, const Capsule& capsule) {
    const double r = capsule.radius;
    const Vec3 end = capsule.length / 2 * Vec3::UnitZ(), all = Vec3(r, r, r) + end;
    if (shown(moved(Bounds(-all, all), pose))) return;
    put(make_capsule(-end, end, r, paint_), pose);
  }

  void add(const Pose&, const Mesh&) {}  // SceneView::set_meshes() has their models

  void add(const Pose&, const JointStop& stop) {
    if (stop.joint < 0 || stop.joint >= arm_.dof()) return;
    const auto j = static_cast<std::size_t>(stop.joint);
    const Vec3 axis = arm_.joints[j].axis.normalized(), arm_of = lever(arm_, j);
    const Vec3 x = arm_of.normalized();
    Mat3 frame;
    frame << x, axis.cross(x), axis;
    Pose pose = arm_.joints[j].origin;
    pose.rotate(Eigen::AngleAxisd(stop.angle, axis).toRotationMatrix() * frame);
    const double length = arm_of.norm();
    const double angle = stop.direction < 0 ? -0.5 : 0.5;
    items_.walls.push_back(
        {make_sector(0.15 * length, 0.8 * length, angle, 0.2 * length, {}), pose, stop.joint - 1});
  }

 private:
  // Sets the paint of the shapes that follow: a screen's colour, or none.
  void paint(const std::optional<Vec3>& color) {
    own_color_ = color.has_value();
    paint_ = kObject;
    if (color) paint_.color = color->cast<float>().unaryExpr(&linear_light);
  }
  // Tells whether a model of the scene shows the shape; models never show bodies, which move.
  bool shown(const Bounds& shape) const { return body_ < 0 && shown_by_visual(shape, visuals_); }
  // Adds an item at `pose`; a body's shape is in the body's frame.
  void put(Model model, const Pose& pose) {
    (body_ < 0 ? items_.world : items_.bodies)
        .push_back({std::move(model), pose, body_, own_color_});
  }

  const ArmDescription& arm_;
  const std::vector<Bounds>& visuals_;
  SceneItems& items_;
  Paint paint_ = kObject;  // of the object being added
  bool own_color_ = false;
  int body_ = -1;  // number of the body being added; else -1
};

std::vector<Bounds> add_visuals(std::span<const VisualPicture> seen, SceneItems& items) {
  std::vector<Bounds> bounds;
  for (const VisualPicture& visual : seen) {
    Item item{load_model_file(visual.file), visual.pose, -1};
    transform(item.model, Eigen::Affine3d(Eigen::Scaling(visual.scale)));
    add_coarse(item.model);
    bounds.push_back(moved(item.model.bounds(), item.pose));
    items.world.push_back(std::move(item));
  }
  return bounds;
}

// Returns the box of the arm at rest, and the room in front of it where the hand will be.
Bounds bounds_of_arm(const ArmDescription& arm, const SceneItems& items) {
  const std::vector<Pose> links = zero_poses(arm);
  Bounds box;
  for (const auto* list : {&items.base, &items.moving})
    for (const Item& item : *list)
      box.extend(moved(item.model.bounds(), pose_of(links, item.link) * item.pose));
  if (arm.dof() > 0) {  // the arm as it stands to begin with
    const Arm<kAnyDof> at_rest(arm);
    Arm<kAnyDof>::Frames f;
    at_rest.frames(Vec<kAnyDof>(rest_pose(arm)), f);
    for (int i = 0; i < arm.dof(); ++i) box.extend(f.p[static_cast<std::size_t>(i)]);
    box.extend(at_rest.tip(f));
  }
  const Vec3 root = links.empty() ? Vec3::Zero() : Vec3(links[0].translation());
  box.extend(root + items.reach * Vec3(0.25, -0.26, 0.0));
  box.extend(root + items.reach * Vec3(0.85, 0.26, 0.28));
  return box;
}

// Places the grid on the highest level plane, as far as the model that shows the plane goes;
// without such a plane, on the ground.
Bounds grid_of(const SceneItems& items, const Surroundings& around,
               const std::vector<Bounds>& world) {
  const Vec3 half = 0.7 * around.bounds.diagonal().norm() * Vec3(1, 1, 0);
  Vec3 middle = around.bounds.center();
  middle.z() = around.ground;
  Bounds grid(middle - half, middle + half);
  for (const double height : items.level_planes) {
    if (height < grid.max().z()) continue;
    middle.z() = height;
    grid = Bounds(middle - half, middle + half);
    for (const Bounds& box : world) {
      if (std::abs(box.max().z() - height) > 0.002) continue;
      const Vec3 margin(0.012, 0.012, 0);
      grid = Bounds(box.min() + margin, box.max() - margin);
      grid.min().z() = grid.max().z() = height;
    }
  }
  return grid;
}

}  // namespace

Bounds moved(const Bounds& box, const Eigen::Affine3d& by) {
  Bounds out;
  for (int i = 0; i < 8; ++i) out.extend(by * box.corner(static_cast<Bounds::CornerType>(i)));
  return out;
}

Surroundings surroundings_of(const SceneItems& items, const std::vector<Bounds>& meshes) {
  std::vector<Bounds> world;
  for (const Item& item : items.world) world.push_back(moved(item.model.bounds(), item.pose));
  for (const Item& item : items.bodies)
    world.push_back(moved(item.model.bounds(), pose_of(items.starts, item.link) * item.pose));
  Surroundings around{items.arm_bounds, 0, {}};
  // Whole boxes count only within the arm's room: a desk may be larger than the picture.
  const Vec3 room = 0.6 * items.reach * Vec3::Ones();
  const Bounds near(around.bounds.center() - room, around.bounds.center() + room);
  const std::array<const std::vector<Bounds>*, 2> all = {&world, &meshes};
  for (const auto* list : all)
    for (const Bounds& box : *list)
      if (near.contains(box)) around.bounds.extend(box);
  // The part of a larger mesh that the arm can reach counts, too.
  for (const Bounds& box : meshes)
    if (near.intersects(box)) around.bounds.extend(near.intersection(box));
  around.ground = around.bounds.min().z();
  for (const auto* list : all)
    for (const Bounds& box : *list) around.ground = std::min(around.ground, box.min().z());
  around.grid = grid_of(items, around, world);
  return around;
}

void collect_scene_items(const ArmDescription& arm, const Scene& scene,
                         std::span<const VisualPicture> visuals, SceneItems& items) {
  items.world.clear();
  items.bodies.clear();
  items.starts.clear();
  items.walls.clear();
  items.probes.clear();
  items.level_planes.clear();
  const std::vector<Bounds> shown = add_visuals(visuals, items);
  ObjectItems objects(arm, shown, items);
  for (const Object& object : scene.objects) objects.add(object);
  for (const Probe& probe : scene.probes)
    items.probes.push_back({make_capsule(probe.from, probe.to, std::max(probe.radius, 0.002), {}),
                            Pose::Identity(), probe.link});
}

SceneItems collect_items(const ArmDescription& arm, const Scene& scene,
                         std::span<const VisualPicture> visuals) {
  SceneItems items;
  items.reach = reach_of(arm);
  ArmDescription seen = arm;
  load_visuals(seen);
  add_arm(seen, items);
  items.arm_bounds = bounds_of_arm(arm, items);
  collect_scene_items(arm, scene, visuals, items);
  return items;
}

}  // namespace limpid
