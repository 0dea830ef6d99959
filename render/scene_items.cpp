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

// Link frames at q = 0.
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

// A touchable shape that a model of the scene already shows is not drawn twice.
bool shown_by_visual(const Plane& plane, const std::vector<Bounds>& visuals) {
  return std::any_of(visuals.begin(), visuals.end(), [&](const Bounds& box) {
    double highest = -1e9;
    for (int i = 0; i < 8; ++i)
      highest = std::max(
          highest, plane.normal.dot(box.corner(static_cast<Bounds::CornerType>(i)) - plane.point));
    return std::abs(highest) < 0.002;
  });
}

bool shown_by_visual(const Bounds& shape, const std::vector<Bounds>& visuals) {
  const double close = 0.1 * shape.sizes().maxCoeff();
  return std::any_of(visuals.begin(), visuals.end(), [&](const Bounds& box) {
    return (box.min() - shape.min()).cwiseAbs().maxCoeff() < close &&
           (box.max() - shape.max()).cwiseAbs().maxCoeff() < close;
  });
}

Item slab(const Plane& plane, double reach) {
  const double edge = 2.2 * reach, thickness = 0.07 * reach;
  const Vec3 normal = plane.normal.normalized();
  const Vec3 ahead = 0.45 * reach * Vec3::UnitX();
  Pose pose = Pose::Identity();
  pose.translation() = ahead - normal.dot(ahead - plane.point) * normal - 0.5 * thickness * normal;
  pose.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), normal).toRotationMatrix();
  return {make_box({edge, edge, thickness}, 0.25 * thickness, kObject), pose, -1};
}

void add_scene(const Scene& scene, std::span<const VisualPicture> seen, double reach,
               SceneItems& items) {
  std::vector<Bounds> visuals;
  for (const VisualPicture& visual : seen) {
    Item item{load_model_file(visual.file), visual.pose, -1};
    transform(item.model, Eigen::Affine3d(Eigen::Scaling(visual.scale)));
    add_coarse(item.model);
    visuals.push_back(moved(item.model.bounds(), item.pose));
    items.world.push_back(std::move(item));
  }
  for (const Plane& plane : scene.planes)
    if (!shown_by_visual(plane, visuals)) items.world.push_back(slab(plane, reach));
  for (const Sphere& sphere : scene.spheres) {
    const Vec3 r = Vec3::Constant(sphere.radius);
    if (shown_by_visual(Bounds(sphere.center - r, sphere.center + r), visuals)) continue;
    Pose pose = Pose::Identity();
    pose.translation() = sphere.center;
    items.world.push_back({make_sphere(sphere.radius, kObject), pose, -1});
  }
  for (const Box& box : scene.boxes) {
    const Bounds edges(-0.5 * box.size, 0.5 * box.size);
    if (shown_by_visual(moved(edges, box.pose), visuals)) continue;
    items.world.push_back({make_box(box.size, 0.04 * box.size.minCoeff(), kObject), box.pose, -1});
  }
}

// The direction, in the frame of joint j at zero, in which the arm leaves the joint's axis.
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

void add_joint_walls(const ArmDescription& arm, const Scene& scene, SceneItems& items) {
  for (const JointContact& contact : scene.joint_contacts) {
    if (contact.joint < 0 || contact.joint >= arm.dof()) continue;
    const auto j = static_cast<std::size_t>(contact.joint);
    const Vec3 axis = arm.joints[j].axis.normalized(), arm_of = lever(arm, j);
    const Vec3 x = arm_of.normalized();
    Mat3 frame;
    frame << x, axis.cross(x), axis;
    Pose pose = arm.joints[j].origin;
    pose.rotate(Eigen::AngleAxisd(contact.angle, axis).toRotationMatrix() * frame);
    const double length = arm_of.norm();
    const double angle = contact.direction < 0 ? -0.5 : 0.5;
    items.walls.push_back({make_sector(0.15 * length, 0.8 * length, angle, 0.2 * length, {}), pose,
                           contact.joint - 1});
  }
}

// The arm at rest, and the room in front of it where the hand will be.
Bounds bounds_of_arm(const ArmDescription& arm, const SceneItems& items) {
  const std::vector<Pose> links = zero_poses(arm);
  Bounds box;
  for (const auto* list : {&items.base, &items.moving})
    for (const Item& item : *list)
      box.extend(moved(item.model.bounds(), pose_of(links, item.link) * item.pose));
  if (arm.dof() > 0) {  // as it stands to begin with
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

// The grid lies on the highest level plane, as far as the model that shows the plane goes;
// without one, on the ground.
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
  Surroundings around{items.arm_bounds, 0, {}};
  // Of what can be touched only what stands in the arm's room: a desk may be larger than the
  // picture.
  const Vec3 room = 0.6 * items.reach * Vec3::Ones();
  const Bounds near(around.bounds.center() - room, around.bounds.center() + room);
  const std::array<const std::vector<Bounds>*, 2> all = {&world, &meshes};
  for (const auto* list : all)
    for (const Bounds& box : *list)
      if (near.contains(box)) around.bounds.extend(box);
  // Of a mesh that is larger, what the arm can reach of it.
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
  items.walls.clear();
  items.probes.clear();
  items.level_planes.clear();
  add_scene(scene, visuals, items.reach, items);
  add_joint_walls(arm, scene, items);
  for (const Probe& probe : scene.probes)
    items.probes.push_back({make_capsule(probe.from, probe.to, std::max(probe.radius, 0.002), {}),
                            Pose::Identity(), probe.link});
  for (const Plane& plane : scene.planes)
    if (plane.normal.normalized().z() > 0.999) items.level_planes.push_back(plane.point.z());
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
