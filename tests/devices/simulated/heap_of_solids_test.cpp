// A tip that is dragged, deep, over heaps of solids at random.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

using test::Random;
using test::Rows;

const Vec3 kHeap(0.19, 0, -0.03);  // of the heap's floor [m]
constexpr double kHeapLasts = 3;

// Four solids of any kind in each other and in a floor.
Scene heap(Random& random) {
  Scene scene;
  scene.tip_radius = random.one_of({0.0, 0.002, 0.005});
  const Material material{.stiffness = random.between(300, 1000)};
  scene.add({.pose = pose_at(kHeap), .shape = Plane{}, .material = material});
  for (int i = 0; i < 4; ++i) {
    Object o{.material = material};
    o.pose = pose_at(kHeap + Vec3(random.between(-0.02, 0.02), random.between(-0.03, 0.03),
                                  random.between(-0.02, 0.015)));
    o.pose.linear() = random.rotation();
    const double length = random.between(0.01, 0.04), radius = random.between(0.005, 0.015);
    switch (random.one_of({0, 1, 2, 3})) {
      case 0:
        o.shape = Box{Vec3(length, random.between(0.01, 0.04), random.between(0.01, 0.04))};
        break;
      case 1: o.shape = Sphere{radius}; break;
      case 2: o.shape = Cylinder{radius, length}; break;
      default: o.shape = Capsule{radius, length};
    }
    scene.add(o);
  }
  return scene;
}

// Goes down, and then wherever a few sines lead it, up to 15 mm deep.
struct Wandering {
  explicit Wandering(Random& random, double radius) : floor(kHeap.z() + radius) {
    for (auto& wave : waves) wave = Vec3(random.between(0.1, 0.5), random.between(0, 6), 0);
    press = random.between(0.005, 0.015);
  }
  double sine(std::size_t axis, double t) const {
    double sum = 0;
    for (std::size_t i = 3 * axis; i < 3 * axis + 3; ++i) {
      sum += std::sin(2 * M_PI * waves[i][0] * t + waves[i][1]) - std::sin(waves[i][1]);
    }
    return sum / 3;
  }
  Vec3 at(double t) const {
    const double down = std::min(2 * t, 1.0);
    const double later = std::max(0.0, t - 0.5);
    return Vec3(kHeap.x() + 0.02 * sine(0, later), 0.03 * sine(1, later),
                floor + 0.02 - down * (0.02 + press) + 0.01 * sine(2, later));
  }
  double floor, press = 0;
  std::array<Vec3, 9> waves;
};

TEST(AHeapOfSolids, GivesHardlyAnyEnergyHoweverDeepTheTipIs) {
  Random random(98);
  const ArmDescription arm = test::omni();
  for (int round = 0; round < 40; ++round) {
    const Scene scene = heap(random);
    const Wandering hand(random, scene.tip_radius);
    for (const CouplingKind kind :
         {CouplingKind::standard, CouplingKind::proposed, CouplingKind::predictive}) {
      SCOPED_TRACE("heap " + std::to_string(round) + ", " + name(kind));
      Parameters p;
      p.kind = kind;
      Rig rig(arm, scene);
      rig.start(p, rest_at(arm, hand.at(0)));
      Rows rows(rig.layout());
      for (int k = 0; k < kHeapLasts / p.tick; ++k)
        rig.step(p, {{hand.at(k * p.tick), 1}}, rows.add());
      double most = 0;
      for (std::size_t k = 0; k < rows.size(); ++k)
        most = std::max(most, rows.at(k, Column::contact_gain));
      EXPECT_LT(most, 1e-3);  // [J]
    }
  }
}

}  // namespace
}  // namespace limpid
