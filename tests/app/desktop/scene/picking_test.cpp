// Objects that a click in the picture meets.
#include "app/desktop/scene/picking.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "app/desktop/scene/scene_editor.h"
#include "core/touch/pull_link.h"
#include "core/touch/triangle_mesh.h"

namespace limpid {
namespace {

Pose turned(const Vec3& position, const Vec3& axis, double angle) {
  Pose pose = pose_at(position);
  pose.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  return pose;
}

// A tetrahedron around the origin, in millimetres.
std::shared_ptr<const Model> tetrahedron() {
  Model model;
  for (const auto& [x, y, z] : {std::array{10.f, 10.f, 10.f},
                                {-10.f, -10.f, 10.f},
                                {-10.f, 10.f, -10.f},
                                {10.f, -10.f, -10.f}}) {
    model.vertices.push_back({.position = {x, y, z}, .normal = {0, 0, 1}});
  }
  model.indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  return std::make_shared<const Model>(std::move(model));
}

struct Shapes {
  Scene scene;
  MeshModels models;

  std::size_t add(const char* name, Shape shape, const Pose& pose) {
    const std::size_t place = scene.add({.name = name, .pose = pose, .shape = std::move(shape)});
    const bool mesh = has_shape<Mesh>(scene.objects[place]);
    models.insert(models.begin() + static_cast<std::ptrdiff_t>(place),
                  mesh ? tetrahedron() : nullptr);
    return place;
  }
  std::optional<std::size_t> under(const Vec3& from, const Vec3& at,
                                   std::span<const Pose> bodies = {}) const {
    return object_under({from, (at - from).normalized()}, scene, models, bodies);
  }
};

// Signed distance of a point in a shape's frame, by the shape's definition [m].
double distance(const Shape& shape, const Vec3& p) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return p.norm() - sphere->radius;
  if (const auto* box = std::get_if<Box>(&shape)) return (p.cwiseAbs() - box->size / 2).maxCoeff();
  if (const auto* tube = std::get_if<Cylinder>(&shape)) {
    return std::max(p.head<2>().norm() - tube->radius, std::abs(p.z()) - tube->length / 2);
  }
  const auto& pill = std::get<Capsule>(shape);
  const double z = std::clamp(p.z(), -pill.length / 2, pill.length / 2);
  return (p - Vec3(0, 0, z)).norm() - pill.radius;
}

// The place to aim at is a centimetre deep, or in the middle of what is thinner; a plane is none.
TEST(Picking, AimsIntoObjects) {
  Scene scene;
  scene.add({.name = "floor", .shape = Plane{Vec3::UnitZ()}});
  scene.add({.name = "slab", .pose = pose_at({0, 0, 0.1}), .shape = Box{{0.1, 0.1, 0.006}}});
  scene.add({.name = "block", .pose = pose_at({0.3, 0, 0.1}), .shape = Box{{0.1, 0.1, 0.1}}});
  const auto down = [&](double x) {
    return aim_along({{x, 0.01, 0.5}, -Vec3::UnitZ()}, scene, {});
  };
  const auto slab = down(0.02), block = down(0.31);
  ASSERT_TRUE(slab && block);
  EXPECT_EQ(slab->object, 1u);
  EXPECT_LT((slab->point - Vec3(0.02, 0.01, 0.1)).norm(), 1e-12);
  EXPECT_EQ(block->object, 2u);
  EXPECT_LT((block->point - Vec3(0.31, 0.01, 0.14)).norm(), 1e-12);
  EXPECT_FALSE(down(0.15)) << "nothing but the floor";
}

TEST(Picking, TellsWhatIsBelow) {
  Scene scene;
  scene.add({.name = "floor", .shape = Plane{Vec3::UnitZ()}});
  scene.add({.name = "ball", .pose = pose_at({0.1, 0, 0.03}), .shape = Sphere{0.03}});
  const std::array moved{Pose(pose_at({-0.1, 0, 0.03}))};
  EXPECT_NEAR(*drop_below({0, 0, 0.2}, scene, {}), 0.2, 1e-12);
  EXPECT_NEAR(*drop_below({0.1, 0, 0.2}, scene, {}), 0.14, 1e-12);
  EXPECT_FALSE(drop_below({0, 0, 0.7}, scene, {})) << "too far";
  scene.objects[1].body = Body{};
  EXPECT_NEAR(*drop_below({-0.1, 0, 0.2}, scene, moved), 0.14, 1e-12) << "where it is now";
}

TEST(Picking, GraspsABodyByThePointUnderTheMouse) {
  Shapes all;
  Object block{.name = "block", .pose = pose_at({0.1, 0, 0}), .shape = Box{{0.02, 0.02, 0.02}}};
  block.body = Body{};
  all.scene.add({.name = "post", .pose = pose_at({0, 0, 0}), .shape = Sphere{0.02}});
  all.scene.add(block);
  all.models.resize(2);
  const std::array now{Pose(turned({0.1, 0, 0.3}, {0, 0, 1}, 0.7))};
  const auto under = [&](const Vec3& from, const Vec3& way) {
    return body_under({from, way.normalized()}, all.scene, all.models, now);
  };
  const auto pull = under({0.103, 0.002, 1}, {0, 0, -1});
  ASSERT_TRUE(pull);
  EXPECT_EQ(pull->body, 0) << "of those that move, the first";
  EXPECT_LT((pull->target - Vec3(0.103, 0.002, 0.31)).norm(), 1e-12);
  EXPECT_LT((now[0] * pull->point - pull->target).norm(), 1e-12);
  EXPECT_FALSE(under({0, 0, 1}, {0, 0, -1})) << "a post stands still";
  EXPECT_FALSE(under({-1, 0, -3}, {1.1, 0, 3.3})) << "the post is before it";
  EXPECT_FALSE(under({0.5, 0, 1}, {0, 0, -1})) << "nothing is there";
}

// Compared with a walk along the ray in steps of a tenth of a millimetre.
TEST(Picking, MeetsAShapeWhereTheRayGoesIntoIt) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto vec = [&] { return Vec3(any(random), any(random), any(random)); };
  int met = 0;
  for (int i = 0; i < 400; ++i) {
    const Shape shapes[] = {Sphere{.radius = 0.03}, Box{.size = {0.03, 0.05, 0.08}},
                            Cylinder{.radius = 0.02, .length = 0.06},
                            Capsule{.radius = 0.02, .length = 0.05}};
    const Shape& shape = shapes[i % 4];
    const Pose pose = turned(0.05 * vec(), vec(), 3 * any(random));
    Shapes all;
    all.add("it", shape, pose);
    const Vec3 from = Vec3(0.5, 0.1, 0.3) + 0.1 * vec(), at = pose.translation() + 0.05 * vec();
    const Vec3 way = (at - from).normalized();
    double least = 1;
    for (double s = 0; s < 1; s += 1e-4) {
      least = std::min(least, distance(shape, pose.inverse() * (from + s * way)));
    }
    if (std::abs(least) < 2e-4) continue;  // a near miss, which the walk cannot decide
    EXPECT_EQ(all.under(from, at).has_value(), least < 0) << i;
    met += least < 0 ? 1 : 0;
  }
  EXPECT_GT(met, 100);
  EXPECT_LT(met, 350);
}

TEST(Picking, TakesTheNearestOfWhatIsThere) {
  Shapes all;
  all.add("table", Plane{}, pose_at({0, 0, -0.1}));
  const auto far = all.add("far", Sphere{.radius = 0.02}, pose_at({-0.1, 0, 0}));
  const auto near = all.add("near", Box{.size = Vec3::Constant(0.02)}, pose_at({0.1, 0, 0}));
  EXPECT_EQ(all.under({0.5, 0, 0}, {0, 0, 0}), near);
  EXPECT_EQ(all.under({-0.5, 0, 0}, {0, 0, 0}), far);
  EXPECT_EQ(all.under({0.3, 0.1, 0.2}, {0, 0.1, -0.1}), 0u) << "the table";
  EXPECT_EQ(all.under({0.3, 0.1, 0.2}, {0.3, 0.1, 1}), std::nullopt) << "the sky";
  EXPECT_EQ(all.under({0.5, 0, 0}, {1, 0, 0}), std::nullopt) << "what is behind the eye";
}

TEST(Picking, MeetsAMeshByItsTrianglesAtItsScale) {
  Shapes all;
  all.add("model", Mesh{.model = "m", .scale = 2, .unit = 1e-3}, pose_at({0.1, 0, 0}));
  // Rays along a face, x + y - z = 20 mm: below it is the body, above it an empty corner of the
  // bounding box.
  for (const double part : {0.2, 0.3, 0.36, 0.8}) {
    const Vec3 through = Vec3(0.1, 0, 0) + 0.02 * part * Vec3(1, 1, -1);
    const Vec3 from = through + 0.3 * Vec3(1, -1, 0);
    EXPECT_EQ(all.under(from, through).has_value(), 3 * part < 1) << part;
  }
}

TEST(Picking, LooksForWhatMovesWhereItIs) {
  Shapes all;
  all.scene.add({.name = "still", .pose = pose_at({0, 0.2, 0}), .shape = Sphere{.radius = 0.02}});
  all.scene.add({.name = "die",
                 .pose = pose_at({0, 0, 0}),
                 .shape = Box{.size = Vec3::Constant(0.02)},
                 .body = Body{}});
  all.models.resize(2);
  const Pose there = turned({0, -0.2, 0}, {0, 0, 1}, 0.5);
  EXPECT_EQ(all.under({0.5, 0, 0}, {0, 0, 0}, {{there}}), std::nullopt);
  EXPECT_EQ(all.under({0.5, -0.2, 0}, {0, -0.2, 0}, {{there}}), 1u);
  EXPECT_EQ(placed_now(all.scene, 1, {{there}}).pose.matrix(), there.matrix());
  EXPECT_EQ(placed_now(all.scene, 0, {{there}}).pose.translation().y(), 0.2);
  EXPECT_EQ(all.under({0.5, 0, 0}, {0, 0, 0}), 1u) << "where it starts, as long as nobody knows";
}

// A shape is met where a walk along the ray gets into it, whichever function is asked.
TEST(Picking, MeetsShapesAsFarAwayAsTheyAre) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto vec = [&] { return Vec3(any(random), any(random), any(random)); };
  int met = 0;
  for (int i = 0; i < 200; ++i) {
    const Shape shapes[] = {Sphere{.radius = 0.03}, Box{.size = {0.03, 0.05, 0.08}},
                            Cylinder{.radius = 0.02, .length = 0.06},
                            Capsule{.radius = 0.02, .length = 0.05}};
    const Shape& shape = shapes[i % 4];
    const Pose pose = turned(0.05 * vec(), vec(), 3 * any(random));
    Shapes all;
    all.add("it", shape, pose);
    const Vec3 from = Vec3(0.3, 0.1, 0.2) + 0.1 * vec();
    const Vec3 way = (pose.translation() + 0.015 * vec() - from).normalized();
    const auto inside = [&](double s) {
      return distance(shape, pose.inverse() * (from + s * way));
    };
    double in = 0;
    while (in < 1 && inside(in) > 0) in += 1e-4;
    double out = in;
    while (out < 1 && inside(out) <= 0) out += 1e-4;
    if (in >= 1 || out - in < 2e-3) continue;  // a near miss
    ++met;
    EXPECT_TRUE(covered({from, way}, in + 3e-4, all.scene, {})) << i;
    EXPECT_FALSE(covered({from, way}, in - 3e-4, all.scene, {})) << i;
    const auto aim = aim_along({from, way}, all.scene, {});
    ASSERT_TRUE(aim) << i;
    const double deep = std::min(0.01, (out - in) / 2);
    EXPECT_LT((aim->point - (from + (in + deep) * way)).norm(), 4e-4) << i;
    all.scene.objects[0].body = Body{};
    const auto pull = body_under({from, way}, all.scene, all.models, {});
    ASSERT_TRUE(pull) << i;
    EXPECT_LT((pull->target - (from + in * way)).norm(), 3e-4) << i;
    EXPECT_LT((pose * pull->point - pull->target).norm(), 1e-12) << i;
    const Vec3 above = pose.translation() + Vec3(0.004 * any(random), 0.004 * any(random), 0.2);
    double drop = 0;
    const auto below = [&](double s) {
      return distance(shape, pose.inverse() * (above - s * Vec3::UnitZ()));
    };
    while (drop < 0.5 && below(drop) > 0) drop += 1e-4;
    const auto found = drop_below(above, all.scene, {});
    ASSERT_TRUE(found) << i;
    EXPECT_NEAR(*found, drop, 3e-4) << i;
  }
  EXPECT_GT(met, 120);
}

// The pull of the mouse is the spring's of the body's own mass, whichever body it is.
TEST(Picking, PullsEachBodyByItsOwnMass) {
  Scene scene;
  scene.add({.name = "post", .shape = Sphere{0.01}});
  scene.add({.name = "light", .shape = Sphere{0.01}, .body = Body{.mass = 0.02}});
  scene.add({.name = "heavy", .shape = Sphere{0.01}, .body = Body{.mass = 0.2}});
  const std::array<Vec3, 2> pull{Vec3(0.1, 0, 0), Vec3(0.1, 0.03, 0.04)};
  const double light = pull_on(scene, 0, pull), heavy = pull_on(scene, 1, pull);
  EXPECT_GT(light, 0);
  EXPECT_EQ(light, PullLink::force_of(0.02, 0.05));
  EXPECT_EQ(heavy, PullLink::force_of(0.2, 0.05));
  EXPECT_EQ(pull_on(scene, 2, pull), 0) << "there are two";
  EXPECT_EQ(pull_on(scene, 1, {pull[0], pull[0]}), PullLink::force_of(0.2, 0));
}

TEST(Picking, MeetsPartsAndStopsAtWhatHasNoShape) {
  Shapes all;
  const auto place = all.add("it", Sphere{.radius = 0.01}, pose_at({0, 0, 0}));
  all.scene.objects[place].parts = {{pose_at(Vec3(0, 0.1, 0)), Box{Vec3::Constant(0.02)}}};
  all.add("stop", JointStop{}, pose_at({0, -0.1, 0}));
  EXPECT_EQ(all.under({0.5, 0.1, 0}, {0, 0.1, 0}), place) << "its part";
  EXPECT_EQ(all.under({0.5, 0.05, 0}, {0, 0.05, 0}), std::nullopt) << "between both";
  EXPECT_EQ(all.under({0.5, -0.1, 0}, {0, -0.1, 0}), std::nullopt) << "a stop is nowhere";
  all.add("floor", Plane{}, pose_at({0, 0, -0.1}));
  EXPECT_TRUE(all.under({0.49, 0, 0}, {0.49, 0, -0.1})) << "as far as it is drawn";
  EXPECT_FALSE(all.under({0.51, 0, 0}, {0.51, 0, -0.1}));
}

// Lines through the objects' middles, whose way into each is known.
TEST(Covered, IsWhatLiesBehindAnObjectAndNotWhatLiesBeforeIt) {
  const std::pair<Shape, double> shapes[] = {{Sphere{.radius = 0.03}, 0.03},
                                             {Box{.size = Vec3::Constant(0.04)}, 0.02},
                                             {Cylinder{.radius = 0.025, .length = 0.06}, 0.025},
                                             {Capsule{.radius = 0.015, .length = 0.05}, 0.015}};
  for (const auto& [shape, reach] : shapes) {
    Shapes all;
    all.add("it", shape, pose_at({0.1, 0, 0}));
    const Ray ray{{0.5, 0, 0}, {-1, 0, 0}};
    const double met = 0.4 - reach;
    EXPECT_TRUE(covered(ray, met + 1e-6, all.scene, {})) << shape.index();
    EXPECT_FALSE(covered(ray, met - 1e-6, all.scene, {})) << shape.index();
    EXPECT_FALSE(covered({{0.5, 0.1, 0}, {-1, 0, 0}}, 1, all.scene, {})) << "beside it";
    EXPECT_FALSE(covered({{0.5, 0, 0}, {1, 0, 0}}, 1, all.scene, {})) << "behind the eye";
  }
}

// The touched triangles are those of the model.
TEST(Covered, SeesMeshesWhereTheyAreMet) {
  const auto model = tetrahedron();
  std::vector<Eigen::Vector3f> corners;
  for (const Vertex& vertex : model->vertices) corners.push_back(vertex.position);
  Mesh mesh{.model = "m", .scale = 2, .unit = 1e-3, .y_up = true};
  mesh.triangles = std::make_shared<const TriangleMesh>(corners, model->indices);
  Shapes all;
  all.add("model", mesh, turned({0.1, 0.02, 0}, {1, 2, 3}, 0.7));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto vec = [&] { return Vec3(any(random), any(random), any(random)); };
  int met = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 from = Vec3(0.5, 0.1, 0.3) + 0.1 * vec(), at = Vec3(0.1, 0.02, 0) + 0.02 * vec();
    const bool hit = covered({from, (at - from).normalized()}, 2, all.scene, {});
    EXPECT_EQ(hit, all.under(from, at).has_value()) << i;
    EXPECT_FALSE(covered({from, (at - from).normalized()}, 0.2, all.scene, {}));
    met += hit ? 1 : 0;
  }
  EXPECT_GT(met, 60);
  EXPECT_LT(met, 280);
}

TEST(Covered, LooksForWhatMovesWhereItIs) {
  Shapes all;
  all.scene.add({.name = "die", .shape = Box{.size = Vec3::Constant(0.02)}, .body = Body{}});
  const Ray ray{{0.5, 0, 0}, {-1, 0, 0}};
  const Pose aside = pose_at({0, 0.2, 0});
  EXPECT_TRUE(covered(ray, 1, all.scene, {}));
  EXPECT_FALSE(covered(ray, 1, all.scene, {{aside}}));
}

}  // namespace
}  // namespace limpid
