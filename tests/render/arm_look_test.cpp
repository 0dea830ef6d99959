#include "render/arm_look.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "devices/files/urdf_file.h"
#include "tests/support/random_arm.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using testing::HasSubstr;

// A triangle with its corners on the axes, at 1, 2 and 3.
Model triangle() {
  Model model;
  for (int i = 0; i < 3; ++i) {
    model.vertices.push_back(
        {static_cast<float>(i + 1) * Eigen::Vector3f::Unit(i), Eigen::Vector3f::UnitX()});
    model.indices.push_back(static_cast<std::uint32_t>(i));
  }
  model.parts = {{0, 3}};
  return model;
}

Visual mesh(const Vec3& scale) {
  Visual visual;
  visual.link = 0;
  visual.size = scale;
  visual.model = std::make_shared<const Model>(triangle());
  return visual;
}

Model drawn(const Visual& visual) {
  ArmDescription arm = test::random_arm(1, 1);
  arm.visuals = {visual};
  SceneItems items;
  add_arm(arm, items);
  return items.moving.at(0).model;
}

// Normal of the triangle by the order of its corners.
Eigen::Vector3f facing(const Model& m) {
  const auto at = [&](std::size_t i) { return m.vertices[m.indices[i]].position; };
  return (at(1) - at(0)).cross(at(2) - at(0)).normalized();
}

TEST(ArmLook, MirrorsWithoutTurningInsideOut) {
  const Model model = drawn(mesh({1, -2, 1}));
  EXPECT_EQ(model.bounds().min().y(), -4);
  const Eigen::Vector3f out = facing(triangle()), mirrored = facing(model);
  EXPECT_LT((mirrored - out.cwiseProduct(Eigen::Vector3f(2, -1, 2)).normalized()).norm(), 1e-6f);
}

TEST(ArmLook, ShadesWhatIsStretchedAsItsTrianglesLie) {
  for (const Vec3& scale : {Vec3(1, 2, 3), Vec3(0.5, 4, 1), Vec3(1, -2, 1)}) {
    Model tilted = triangle();
    for (Vertex& v : tilted.vertices) v.normal = facing(tilted);
    Visual visual = mesh(scale);
    visual.model = std::make_shared<const Model>(tilted);
    const Model model = drawn(visual);
    for (const Vertex& v : model.vertices) EXPECT_LT((v.normal - facing(model)).norm(), 1e-6f);
  }
}

TEST(ArmLook, MakesSmallWithoutTurningInsideOut) {
  const Model model = drawn(mesh({0.5, 0.5, 0.5}));
  EXPECT_EQ(model.bounds().max().y(), 1);
  EXPECT_LT((facing(model) - facing(triangle())).norm(), 1e-6f);
}

TEST(ArmLook, PaintsWhatHasNoColourOfItsOwn) {
  Visual visual = mesh(Vec3::Ones());
  visual.color = Eigen::Vector4f(1, 0, 0.5f, 1);
  const Eigen::Vector3f linear(1, 0, 0.2140f);  // by IEC 61966-2-1
  EXPECT_LT((drawn(visual).vertices[0].color - linear).norm(), 1e-3f);
  Model own = triangle();
  for (Vertex& v : own.vertices) v.color = {0, 1, 0};
  visual.model = std::make_shared<const Model>(own);
  EXPECT_EQ(drawn(visual).vertices[0].color, Eigen::Vector3f(0, 1, 0));
}

// glTF has y up, URDF z: the built-in arm's pictures stand as its links do.
TEST(ArmLook, TurnsGltfUpright) {
  ArmDescription arm = read_urdf(LIMPID_ASSETS_DIR "/devices/omni.urdf");
  load_visuals(arm);
  ASSERT_EQ(arm.warnings, std::vector<std::string>());
  const auto bounds = [&](std::size_t i) { return arm.visuals[i].model->bounds(); };
  EXPECT_NEAR(bounds(0).min().z(), -0.04, 1e-4) << "the foot stands on the table";
  EXPECT_NEAR(bounds(2).max().x(), 0.135 + 0.0124, 1e-3) << "the upper arm reaches to the elbow";
  EXPECT_NEAR(bounds(2).min().y(), -bounds(2).max().y(), 1e-4) << "and is as wide to both sides";
}

TEST(ArmLook, PutsACapsuleInThePlaceOfALinkThatCannotBeShown) {
  ArmDescription arm = test::random_arm(3, 1);
  const test::TempDir dir;
  std::ofstream(dir / "spoilt.glb") << "not a model";
  Visual spoilt;
  spoilt.link = 1;
  spoilt.mesh = (dir / "spoilt.glb").string();
  Visual stand_in;
  stand_in.link = 0;
  stand_in.shape = Visual::Shape::stand_in;
  arm.visuals = {mesh(Vec3::Ones()), stand_in, spoilt, spoilt};
  load_visuals(arm);
  ASSERT_EQ(arm.warnings.size(), 1u) << "one for a file that is named twice";
  EXPECT_THAT(arm.warnings[0], HasSubstr("spoilt.glb"));
  SceneItems items;
  items.reach = 0.3;
  add_arm(arm, items);
  ASSERT_EQ(items.moving.size(), 3u) << "the triangle of link 0, capsules for links 1 and 2";
  EXPECT_EQ(items.moving[1].link, 1);
  const Bounds capsule = items.moving[1].model.bounds();
  const Vec3 end = arm.joints[2].origin.translation();
  EXPECT_TRUE(capsule.contains(Vec3::Zero()) && capsule.contains(end));
  EXPECT_LT(capsule.diagonal().norm(), end.norm() + 0.2);
  EXPECT_TRUE(items.base.empty());
}

// A link that is not drawn would leave a gap in the arm.
TEST(ArmLook, DrawsLinksWithoutAPictureWhereOthersHaveOne) {
  ArmDescription arm = test::random_arm(4, 1);
  arm.joints[2].origin.translation().setZero();  // link 1 has no length, like a wrist's frame
  arm.visuals = {mesh(Vec3::Ones())};
  SceneItems items;
  items.reach = 0.4;
  add_arm(arm, items);
  std::vector<int> links;
  for (const Item& item : items.moving) links.push_back(item.link);
  EXPECT_THAT(links, testing::ElementsAre(0, 2, 3));
  const Bounds capsule = items.moving[1].model.bounds();
  EXPECT_TRUE(capsule.contains(arm.joints[3].origin.translation()));
  EXPECT_TRUE(items.base.empty());
}

TEST(ArmLook, DrawsAnArmWithoutPicturesAsCapsules) {
  ArmDescription arm = test::random_arm(3, 1);
  SceneItems items;
  items.reach = 0.3;
  add_arm(arm, items);
  EXPECT_EQ(items.moving.size(), 3u);
  EXPECT_EQ(items.base.size(), 1u);
}

// More joints make thinner links, within 3 mm and 3 cm; the last one ends in a ball as thick as the
// links before it.
TEST(ArmLook, DrawsThinnerCapsulesForMoreJoints) {
  const auto half_width = [](const Item& item) {
    return item.model.bounds().sizes().minCoeff() / 2;
  };
  double before = 0.03;
  for (const int joints : {2, 4, 6}) {
    ArmDescription arm = test::random_arm(joints, 1);
    SceneItems items;
    items.reach = 0.3;
    add_arm(arm, items);
    const double foot = half_width(items.base.at(0)) / 1.5;
    EXPECT_LT(foot, before) << joints;
    before = foot;
    const Vec3 end = arm.tip.translation();
    double beyond = 0;
    for (const Vertex& v : items.moving.back().model.vertices) {
      beyond = std::max(beyond, (v.position.cast<double>() - end).dot(end.normalized()));
    }
    EXPECT_NEAR(beyond, foot, 0.02 * foot) << "a ball at the tip";
    EXPECT_EQ(items.moving.back().link, joints - 1);
  }
  for (const auto& [reach, radius] : {std::pair(1e-3, 0.003), std::pair(100.0, 0.03)}) {
    SceneItems items;
    items.reach = reach;
    add_arm(test::random_arm(2, 1), items);
    EXPECT_NEAR(half_width(items.base.at(0)), 1.5 * radius, 0.03 * radius);
  }
}

// URDF's boxes, cylinders and spheres have their sizes; a box's edges are only a little round.
TEST(ArmLook, DrawsPlainShapesOfUrdf) {
  const auto half = [](Visual::Shape shape, const Vec3& size) {
    Visual visual;
    visual.link = 0;
    visual.shape = shape;
    visual.size = size;
    return Vec3(drawn(visual).bounds().sizes() / 2);
  };
  const Vec3 box = half(Visual::Shape::box, {0.1, 0.2, 0.3});
  EXPECT_LT((box - Vec3(0.05, 0.1, 0.15)).norm(), 1e-6);
  EXPECT_LT((half(Visual::Shape::cylinder, {0.05, 0.4, 0}) - Vec3(0.05, 0.05, 0.2)).norm(), 2e-3);
  EXPECT_LT((half(Visual::Shape::sphere, {0.07, 0, 0}) - Vec3::Constant(0.07)).norm(), 2e-3);
  Visual visual;
  visual.link = 0;
  visual.shape = Visual::Shape::box;
  visual.size = {0.1, 0.1, 0.1};
  int flat = 0;
  for (const Vertex& v : drawn(visual).vertices) flat += v.position.z() == 0.05f;
  EXPECT_GE(flat, 4);
  for (const Vertex& v : drawn(visual).vertices) {
    const Eigen::Vector3f off = v.position.cwiseAbs();
    EXPECT_GT(off.sum(), 0.15f - 3 * 0.011f) << "its corners are nearly those of the box";
  }
}

}  // namespace
}  // namespace limpid
