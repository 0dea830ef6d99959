// Flaws of scenes, each in a scene with a single one.
#include "app/run/scene_flaws.h"

#include <gmock/gmock.h>

#include "app/run/analysis.h"
#include "app/run/scene_meshes.h"
#include "app/run/tip_limits.h"
#include "core/dynamics/arm.h"
#include "core/dynamics/farthest_tip.h"
#include "tests/support/built_in.h"
#include "tests/support/meshes.h"

namespace limpid {
namespace {

using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Parameters under(CouplingKind kind) {
  Parameters p;
  p.kind = kind;
  return p;
}

std::vector<std::string> flaws(Object object, CouplingKind kind = CouplingKind::predictive) {
  Scene scene;
  object.name = "thing";
  scene.add(std::move(object));
  return scene_flaws(scene, test::omni(), under(kind));
}

Object floor_at(double z) { return {.pose = pose_at(Vec3(0, 0, z)), .shape = Plane{}}; }

TEST(SceneFlaws, AreNoneInTheScenesThatComeAlong) {
  for (const auto& entry : std::filesystem::directory_iterator(test::assets_dir() / "scenes")) {
    if (entry.path().extension() != ".toml") continue;
    SceneDocument document = read_scene(entry.path(), test::omni());
    build_meshes(document);
    EXPECT_THAT(scene_flaws(document.scene, test::omni(), under(CouplingKind::predictive)),
                IsEmpty())
        << entry.path();
  }
}

TEST(SceneFlaws, AreWhatTheTipNeverReaches) {
  const double reach = farthest_tip(test::omni()).distance;
  const double root = test::omni().joints[0].origin.translation().z();
  EXPECT_THAT(flaws(floor_at(root - reach - 1)),
              ElementsAre(HasSubstr("1 m outside the tip's reach")));
  EXPECT_THAT(flaws(floor_at(root - reach + 0.01)), IsEmpty());
  const Object far{.pose = pose_at(Vec3(5, 0, 0)), .shape = Sphere{0.1}};
  EXPECT_THAT(flaws(far), ElementsAre(HasSubstr("outside the tip's reach")));
}

TEST(SceneFlaws, AreKineticFrictionAboveStaticFriction) {
  Object plane = floor_at(-0.04);
  plane.material.friction_static = 0.2;
  plane.material.friction_kinetic = 0.2;
  EXPECT_THAT(flaws(plane), IsEmpty());
  plane.material.friction_kinetic = 0.3;
  EXPECT_THAT(flaws(plane), ElementsAre(HasSubstr("friction_kinetic 0.3 is above")));
}

TEST(SceneFlaws, AreWallsStifferThanTheLawRenders) {
  const ArmDescription arm = test::omni();
  for (const auto kind : {CouplingKind::proposed, CouplingKind::predictive}) {
    const double most = tip_limits(arm, rest_pose(arm), under(kind), {}).wall(kind).stiffness;
    Object plane = floor_at(-0.04);
    plane.material.stiffness = 0.99 * most;
    EXPECT_THAT(flaws(plane, kind), IsEmpty());
    plane.material.stiffness = 1.01 * most;
    EXPECT_THAT(flaws(plane, kind), ElementsAre(HasSubstr(name(kind))));
  }
}

Vec3 tip_at_start() {
  const Arm<kAnyDof> arm(test::omni());
  Arm<kAnyDof>::Frames f;
  arm.frames(rest_pose(test::omni()), f);
  return arm.tip(f);
}

TEST(SceneFlaws, AreThingsInWhichTheTipIsAtTheStart) {
  const Vec3 tip = tip_at_start();
  const Object around{.pose = pose_at(tip), .shape = Sphere{0.012}};
  EXPECT_THAT(flaws(around), ElementsAre(HasSubstr("12 mm inside")));
  EXPECT_THAT(flaws({.pose = pose_at(tip + Vec3(0, 0, 0.0121)), .shape = Sphere{0.012}}),
              IsEmpty());
}

TEST(SceneFlaws, AreModelsAndBodiesInWhichTheTipIsAtTheStart) {
  const Vec3 tip = tip_at_start();
  const auto ball_at = [&](double above) {
    Object ball = test::obstacle(
        test::icosphere(3).mapped([](const Vec3& p) { return Vec3(0.012 / p.norm() * p); }));
    ball.pose = pose_at(tip + Vec3(0, 0, above));
    return ball;
  };
  EXPECT_THAT(flaws(ball_at(0.007)), ElementsAre(ContainsRegex("the tip is (4.9|5).* mm inside")));
  EXPECT_THAT(flaws(ball_at(0.0125)), IsEmpty());
  Object box{.pose = pose_at(tip - Vec3(0, 0, 0.01)), .shape = Box{Vec3::Constant(0.04)}};
  box.body = Body{.mass = 0.1};
  EXPECT_THAT(flaws(box), ElementsAre(HasSubstr("the tip is 10 mm inside")));
  box.pose = pose_at(tip - Vec3(0, 0, 0.0205));
  EXPECT_THAT(flaws(box), IsEmpty());
  box.parts = {{.pose = pose_at(Vec3(0, 0, 0.0205)), .shape = Sphere{0.01}}};
  EXPECT_THAT(flaws(box), ElementsAre(HasSubstr("the tip is 10 mm inside"))) << "a part of it";
}

}  // namespace
}  // namespace limpid
