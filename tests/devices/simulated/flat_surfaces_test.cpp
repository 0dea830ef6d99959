// Surfaces that are flat, made of several things: the tip goes over their seams as over one thing.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/meshes.h"
#include "tests/support/random_arm.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

using test::Random;
using test::Rows;

constexpr double kFlatTop = -0.03;  // [m]
const Vec3 kMiddle(0.19, 0, kFlatTop);
constexpr std::array kKinds{CouplingKind::standard, CouplingKind::proposed,
                            CouplingKind::predictive};
constexpr std::array kRadii{0.0, 0.002, 0.005};  // of the tip [m]

// A closed box of triangles, its top in the middle of the model.
test::Triangles block_below(const Vec3& size) {
  test::Triangles out;
  for (int i = 0; i < 8; ++i) {
    out.vertices.push_back(Vec3((i & 1) != 0 ? size.x() / 2 : -size.x() / 2,
                                (i & 2) != 0 ? size.y() / 2 : -size.y() / 2,
                                (i & 4) != 0 ? 0 : -size.z())
                               .cast<float>());
  }
  out.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return out;
}

// A box or a model whose top is level and lies in the plane z = kFlatTop, turned about the
// vertical.
Object slab(const Vec3& middle, const Vec3& size, double turn, bool model, Material material) {
  Object object;
  object.material = material;
  if (model) {
    object.shape = Mesh{.triangles = block_below(size).mesh()};
  } else {
    object.shape = Box{size};
  }
  object.pose.linear() = Eigen::AngleAxisd(turn, Vec3::UnitZ()).matrix();
  object.pose.translation() = middle - (model ? 0.0 : size.z() / 2) * Vec3::UnitZ();
  return object;
}

struct Floor {
  std::string name;
  // Makes it of a material; the place of its seams is drawn.
  std::function<Scene(Random&, const Material&)> make;
};

// Slabs of `wide` side by side, across the tip's way.
Scene row_of_slabs(Random& random, const Material& material, double wide, double high,
                   const std::vector<bool>& models) {
  const double turn = random.between(-0.3, 0.3), shift = random.between(-0.008, 0.008);
  const Vec3 along(-std::sin(turn), std::cos(turn), 0);
  Scene scene;
  const auto count = static_cast<int>(models.size());
  for (int i = 0; i < count; ++i) {
    const Vec3 middle = kMiddle + (shift + wide * (i - (count - 1) / 2.0)) * along;
    scene.add(
        slab(middle, Vec3(0.2, wide, high), turn, models[static_cast<std::size_t>(i)], material));
  }
  return scene;
}

Scene let_into_a_plane(Random& random, const Material& material, bool model) {
  Scene scene;
  scene.add({"", pose_at(kMiddle), Plane{}, material});
  const Vec3 middle = kMiddle + Vec3(0, random.between(-0.005, 0.005), 0);
  scene.add(slab(middle, Vec3(0.03, 0.02, 0.02), random.between(-1, 1), model, material));
  return scene;
}

Floor slabs(const char* name, double wide, double high, const std::vector<bool>& models) {
  return {name, [=](Random& random, const Material& material) {
            return row_of_slabs(random, material, wide, high, models);
          }};
}

Floor inlay(const char* name, bool model) {
  return {name, [=](Random& random, const Material& material) {
            return let_into_a_plane(random, material, model);
          }};
}

std::vector<Floor> floors_of_solids() {
  return {slabs("two boxes", 0.1, 0.02, {false, false}),
          slabs("tiles", 0.01, 0.02, std::vector<bool>(9)),
          slabs("thin tiles", 0.01, 0.001, std::vector<bool>(9)),
          inlay("a box let into a plane", false)};
}

std::vector<Floor> floors_of_models() {
  return {slabs("two models", 0.1, 0.02, {true, true}),
          slabs("tiles that are models", 0.01, 0.02, std::vector<bool>(9, true)),
          slabs("a box beside a model", 0.1, 0.02, {false, true}),
          slabs("tiles of both kinds", 0.01, 0.02,
                {true, false, true, false, true, true, false, false, true}),
          inlay("a model let into a plane", true)};
}

using Hand = std::function<Vec3(double)>;  // target of the tip at a time

Rows run_under(const Scene& scene, CouplingKind kind, const Hand& hand, double seconds) {
  const ArmDescription arm = test::omni();
  Parameters p;
  p.kind = kind;
  Rig rig(arm, scene);
  rig.start(p, rest_at(arm, hand(0)));
  Rows rows(rig.layout());
  for (int k = 0; k < seconds / p.tick; ++k) rig.step(p, {{hand(k * p.tick), 1}}, rows.add());
  return rows;
}

// Goes down, presses by 6 mm of the hand's spring, and strokes by 4 cm along y with 2 cm/s.
Rows stroked(const Scene& scene, CouplingKind kind) {
  const double low = kFlatTop - 0.006 + scene.tip_radius;
  const auto hand = [&](double t) {
    const double down = std::min(2 * t, 1.0), way = std::clamp(0.02 * (t - 0.7), 0.0, 0.04);
    return Vec3(kMiddle.x(), way - 0.02, down * low);
  };
  return run_under(scene, kind, hand, 3);
}

Vec3 end_of(const Rows& rows) {  // of the proxy
  static const Arm<3> arm(test::omni());
  return arm.tip_at(rows.vec(rows.size() - 1, Column::proxy_position));
}

void expect_flat(const Scene& scene, CouplingKind kind, double friction) {
  const Rows rows = stroked(scene, kind);
  Vec3 before = rows.force(650);
  double change = 0, against = 0, least = before.z();
  for (std::size_t k = 650; k < rows.size(); ++k) {
    const Vec3 now = rows.force(k);
    change = std::max(change, (now - before).norm());
    against = std::max(against, now.head<2>().norm() - friction * now.z());
    least = std::min(least, now.z());
    before = now;
  }
  EXPECT_LT(change, 0.05);   // in a tick [N]
  EXPECT_LT(against, 0.01);  // beyond friction [N]
  EXPECT_GT(least, 0.4);
  EXPECT_NEAR(end_of(rows).y(), 0.02, friction == 0 ? 5e-4 : 4e-3);
}

void expect_all_flat(const std::vector<Floor>& floors, unsigned seed, double friction) {
  Random random(seed);
  for (const Floor& floor : floors) {
    for (const double radius : kRadii) {
      for (const CouplingKind kind : kKinds) {
        SCOPED_TRACE(floor.name + ", radius " + std::to_string(radius) + ", " + name(kind));
        Scene scene = floor.make(random, {600, 0, friction, friction});
        scene.tip_radius = radius;
        expect_flat(scene, kind, friction);
      }
    }
  }
}

TEST(FlatSurfaces, OfSeveralSolidsHaveNoSeamsForTheTip) {
  expect_all_flat(floors_of_solids(), 91, 0);
}

TEST(FlatSurfaces, OfSeveralSolidsRubAsOne) { expect_all_flat(floors_of_solids(), 92, 0.4); }

TEST(FlatSurfaces, OfModelsAndSolidsHaveNoSeamsForTheTip) {
  expect_all_flat(floors_of_models(), 95, 0);
}

TEST(FlatSurfaces, OfModelsAndSolidsRubAsOne) { expect_all_flat(floors_of_models(), 96, 0.4); }

// A floor and a ramp that rises from it, its edge at the floor's height or a little below. A point
// also meets edges above; a ball would pop over them.
Scene floor_with_ramp(Random& random, const Material& material, double radius) {
  Scene scene;
  if (random.between(0, 1) < 0.5) {
    scene.add({.pose = pose_at(kMiddle), .shape = Plane{}, .material = material});
  } else {
    scene.add(slab(kMiddle, Vec3(0.2, 0.2, 0.02), 0, false, material));
  }
  const Vec3 size(0.1, 0.05, 0.02);
  const double edge = random.between(0, 1) < 0.3 ? 0 : random.between(-5e-4, radius > 0 ? 0 : 1e-3);
  Object ramp = slab(Vec3(0, size.y() / 2, 0), size, 0, false, material);
  Pose up = pose_at(kMiddle + edge * Vec3::UnitZ());
  up.linear() = Eigen::AngleAxisd(random.between(0.1, 1.3), Vec3::UnitX()).matrix();
  ramp.pose = up * ramp.pose;
  scene.add(ramp);
  return scene;
}

// The force turns where a floor ends and a ramp begins; it does not jump.
TEST(FlatSurfaces, ThatRiseTakeTheTipOverSteadily) {
  Random random(97);
  for (int round = 0; round < 12; ++round) {
    for (const double radius : kRadii) {
      for (const CouplingKind kind : kKinds) {
        SCOPED_TRACE(std::to_string(round) + ", radius " + std::to_string(radius) + ", " +
                     name(kind));
        Scene scene = floor_with_ramp(random, {.stiffness = 600}, radius);
        scene.tip_radius = radius;
        const Rows rows = stroked(scene, kind);
        double change = 0, moved = 0;
        for (std::size_t k = 651; k < rows.size(); ++k) {
          change = std::max(change, (rows.force(k) - rows.force(k - 1)).norm());
          moved = std::max(
              moved, (rows.vec(k, Column::proxy_position) - rows.vec(k - 1, Column::proxy_position))
                         .norm());
        }
        EXPECT_LT(change, 0.05);  // in a tick [N]
        EXPECT_LT(moved, 1e-3);   // in a tick [rad]
        const double gained =
            rows.at(rows.size() - 1, Column::contact_gain) - rows.at(650, Column::contact_gain);
        EXPECT_LT(std::abs(gained), 1e-4);  // [J]
      }
    }
  }
}

// Presses slowly, by 45 mm of the hand's spring.
Rows pressed_through(const Scene& scene, CouplingKind kind) {
  const auto hand = [&](double t) {
    const double down = std::min(2 * t, 1.0), further = std::clamp(0.009 * (t - 0.5), 0.0, 0.045);
    return Vec3(kMiddle.x(), 0, down * (kFlatTop + scene.tip_radius) - further);
  };
  return run_under(scene, kind, hand, 6);
}

void expect_holds(Scene scene, Random& random) {
  for (const double radius : kRadii) {
    for (const CouplingKind kind : kKinds) {
      SCOPED_TRACE("radius " + std::to_string(radius) + ", " + name(kind));
      scene.tip_radius = radius;
      const double K = random.between(300, 1000);
      set_surface_stiffness(scene, K);
      const Rows rows = pressed_through(scene, kind);
      const double pressed = rows.force(rows.size() - 1).z();
      EXPECT_GT(pressed, 3);
      // The board gives as its spring does, one that moves a little more where it rests.
      EXPECT_NEAR(end_of(rows).z(), kFlatTop + radius - pressed / K, 5e-4);
    }
  }
}

TEST(ThinThings, ArePressedByTheTipFromTheSideWhereItCameIn) {
  Random random(93);
  for (const double thick : {0.0005, 0.002, 0.01}) {
    SCOPED_TRACE("thick " + std::to_string(thick));
    Scene board;
    board.add(slab(kMiddle, Vec3(0.1, 0.1, thick), random.between(-1, 1), false, {}));
    expect_holds(board, random);
    Scene disc;
    disc.add(
        {.pose = pose_at(kMiddle - thick / 2 * Vec3::UnitZ()), .shape = Cylinder{0.05, thick}});
    expect_holds(disc, random);
  }
}

TEST(ThinThings, ThatMoveArePressedFromTheSideWhereTheTipCameIn) {
  Random random(94);
  constexpr double kThick = 0.003;
  Scene scene;
  for (const double y : {-0.04, 0.04}) {
    const Vec3 below = kMiddle + Vec3(0, y, -kThick);
    scene.add(slab(below, Vec3(0.1, 0.01, 0.02), 0, false, {}));
  }
  Object board = slab(kMiddle, Vec3(0.1, 0.1, kThick), 0, false, {});
  board.body = Body{.mass = 0.2};
  board.parts.push_back({pose_at(Vec3(0, 0.045, 0.005)), Box{Vec3(0.1, 0.003, 0.01)}});
  scene.add(board);
  expect_holds(scene, random);
}

}  // namespace
}  // namespace limpid
