// Flaws of scenes, each in a scene with a single one.
#include "app/run/scene_flaws.h"

#include <gmock/gmock.h>

#include "app/run/analysis.h"
#include "app/run/tip_limits.h"
#include "core/dynamics/arm.h"
#include "core/dynamics/farthest_tip.h"
#include "tests/support/built_in.h"

namespace limpid {
namespace {

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
    const SceneDocument document = read_scene(entry.path(), test::omni());
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

TEST(SceneFlaws, AreThingsInWhichTheTipIsAtTheStart) {
  const Arm<kAnyDof> arm(test::omni());
  Arm<kAnyDof>::Frames f;
  arm.frames(rest_pose(test::omni()), f);
  const Vec3 tip = arm.tip(f);
  const Object around{.pose = pose_at(tip), .shape = Sphere{0.012}};
  EXPECT_THAT(flaws(around), ElementsAre(HasSubstr("12 mm inside")));
  EXPECT_THAT(flaws({.pose = pose_at(tip + Vec3(0, 0, 0.0121)), .shape = Sphere{0.012}}),
              IsEmpty());
}

}  // namespace
}  // namespace limpid
