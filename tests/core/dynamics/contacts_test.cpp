// Distances against brute force, contacts against differences of their depth.
#include "core/dynamics/contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;
using test::random_arm;

Plane some_plane() { return {"", Vec3(0.1, -0.2, 0.3), Vec3(1, 2, -3).normalized(), 600}; }
Sphere some_sphere() { return {"", Vec3(0.1, -0.2, 0.3), 0.07, 600}; }
Box some_box() {
  Random random(3);
  Box box;
  box.pose.linear() = random.rotation();
  box.pose.translation() = Vec3(0.1, -0.2, 0.3);
  box.size = Vec3(0.11, 0.23, 0.17);
  return box;
}

// Distance to the nearest of a grid of points on the box's six faces.
double distance_to_grid(const Box& box, const Vec3& point, int cells) {
  double least = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-0.5, 0.5}) {
      for (int i = 0; i <= cells; ++i) {
        for (int j = 0; j <= cells; ++j) {
          Vec3 p;
          p[axis] = side;
          p[(axis + 1) % 3] = static_cast<double>(i) / cells - 0.5;
          p[(axis + 2) % 3] = static_cast<double>(j) / cells - 0.5;
          least = std::min(least, (box.pose * p.cwiseProduct(box.size) - point).norm());
        }
      }
    }
  }
  return least;
}

bool inside(const Box& box, const Vec3& point) {
  const Vec3 p = box.pose.inverse() * point;
  return (p.cwiseAbs().array() < box.size.array() / 2).all();
}

// The normal of a surface is the gradient of the distance to it.
template <class Obstacle>
void expect_gradient(const Obstacle& obstacle, const Vec3& point) {
  constexpr double h = 1e-6;
  Vec3 slope;
  for (int i = 0; i < 3; ++i) {
    const Vec3 step = h * Vec3::Unit(i);
    slope[i] = (distance_to(obstacle, point + step).distance -
                distance_to(obstacle, point - step).distance) /
               (2 * h);
  }
  const Vec3 normal = distance_to(obstacle, point).normal;
  EXPECT_NEAR(normal.norm(), 1, 1e-12);
  EXPECT_LT((normal - slope).norm(), 1e-6);
}

TEST(Distance, ToAPlaneIsSignedAndAlongItsNormal) {
  const Plane plane = some_plane();
  EXPECT_NEAR(distance_to(plane, plane.point).distance, 0, 1e-15);
  EXPECT_NEAR(distance_to(plane, plane.point + 0.2 * plane.normal).distance, 0.2, 1e-15);
  const Vec3 within = plane.normal.unitOrthogonal();
  EXPECT_NEAR(distance_to(plane, plane.point - 0.1 * plane.normal + within).distance, -0.1, 1e-15);
  expect_gradient(plane, Vec3(0.3, 0.1, -0.2));
}

TEST(Distance, ToASphereIsFromItsCentreLessTheRadius) {
  const Sphere sphere = some_sphere();
  Random random(1);
  for (int round = 0; round < 100; ++round) {
    const Vec3 direction = random.direction();
    const double r = random.between(0.01, 0.2);
    const Vec3 point = sphere.center + r * direction;
    EXPECT_NEAR(distance_to(sphere, point).distance, r - sphere.radius, 1e-15);
    expect_gradient(sphere, point);
  }
  const Surface centre = distance_to(sphere, sphere.center);
  EXPECT_EQ(centre.distance, -sphere.radius);
  EXPECT_NEAR(centre.normal.norm(), 1, 1e-15);
}

TEST(Distance, ToABoxIsToTheNearestOfItsPoints) {
  const Box box = some_box();
  constexpr int kCells = 60;
  const double spacing = box.size.maxCoeff() / kCells;
  Random random(2);
  int within = 0;
  for (int round = 0; round < 60; ++round) {
    const Vec3 point = box.pose.translation() + random.point(0.15);
    const double sampled = distance_to_grid(box, point, kCells);
    const Surface surface = distance_to(box, point);
    EXPECT_EQ(surface.distance < 0, inside(box, point));
    EXPECT_LE(std::abs(surface.distance), sampled + 1e-15);
    EXPECT_GE(std::abs(surface.distance), sampled - spacing);
    within += inside(box, point) ? 1 : 0;
    expect_gradient(box, point);
    // One step along the normal lands on the surface.
    const Vec3 foot = point - surface.distance * surface.normal;
    EXPECT_NEAR(distance_to(box, foot).distance, 0, 1e-12);
  }
  EXPECT_GT(within, 5);
}

template <class Obstacle>
void expect_nearest(const Obstacle& obstacle, Random& random) {
  for (int round = 0; round < 100; ++round) {
    const Vec3 from = Vec3(0.1, -0.2, 0.3) + random.point(0.3);
    const Vec3 to = Vec3(0.1, -0.2, 0.3) + random.point(0.3);
    const Vec3 found = nearest_on_segment(obstacle, from, to);
    const Vec3 along = to - from;
    const double s = along.dot(found - from) / along.squaredNorm();
    EXPECT_LT((from + s * along - found).norm(), 1e-12);
    EXPECT_GE(s, -1e-12);
    EXPECT_LE(s, 1 + 1e-12);
    const double least = distance_to(obstacle, found).distance;
    for (int i = 0; i <= 500; ++i) {
      EXPECT_GE(distance_to(obstacle, from + i / 500.0 * along).distance, least - 1e-9);
    }
  }
}

TEST(NearestOnSegment, IsNoFurtherThanAnyOtherPointOfIt) {
  Random random(4);
  expect_nearest(some_plane(), random);
  expect_nearest(some_sphere(), random);
  expect_nearest(some_box(), random);
}

// An arm of n joints with one capsule in its middle, and where they are.
struct World {
  explicit World(int n)
      : description(random_arm(n, 21)), arm(description), x(Random(22).vector(n, 2)) {
    const int link = n / 2;
    scene.probes.push_back({"", link, Vec3(0.01, 0.02, -0.03), Vec3(0.05, -0.02, 0.04), 0.012});
    arm.frames(x, frames);
    from = Arm<kAnyDof>::point(frames, link, scene.probes[0].from);
    to = Arm<kAnyDof>::point(frames, link, scene.probes[0].to);
  }

  std::vector<Contact<kAnyDof>> contacts_at(const Vec<kAnyDof>& at) {
    Contacts<kAnyDof> contacts(description, scene);
    Arm<kAnyDof>::Frames f;
    arm.frames(at, f);
    contacts.find(arm, f, at, 0.001);
    return {contacts.list().begin(), contacts.list().end()};
  }

  void expect_gradient() {
    constexpr double h = 1e-6;
    const auto here = contacts_at(x);
    ASSERT_FALSE(here.empty());
    for (int k = 0; k < x.size(); ++k) {
      Vec<kAnyDof> ahead = x, behind = x;
      ahead[k] += h;
      behind[k] -= h;
      const auto a = contacts_at(ahead), b = contacts_at(behind);
      ASSERT_EQ(a.size(), here.size());
      ASSERT_EQ(b.size(), here.size());
      for (std::size_t i = 0; i < here.size(); ++i) {
        EXPECT_NEAR(here[i].gradient[k], (a[i].depth - b[i].depth) / (2 * h), 1e-6);
      }
    }
  }

  ArmDescription description;
  Arm<kAnyDof> arm;
  Vec<kAnyDof> x;
  Scene scene;
  Arm<kAnyDof>::Frames frames;
  Vec3 from, to;  // of the capsule
};

class ContactsOfJoints : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Arms, ContactsOfJoints, testing::Values(1, 2, 3, 7, 32));

TEST_P(ContactsOfJoints, OfACapsuleOnABallAreAsDeepAsTheirSurfacesOverlap) {
  World w(GetParam());
  const Vec3 side = (w.to - w.from).unitOrthogonal();
  const Vec3 middle = 0.6 * w.from + 0.4 * w.to;
  w.scene.spheres.push_back({"", middle + 0.049 * side, 0.04, 700});
  const auto contacts = w.contacts_at(w.x);
  ASSERT_FALSE(contacts.empty());
  const Contact<kAnyDof>& c = contacts.back();
  EXPECT_NEAR(c.depth, 0.012 + 0.04 - 0.049, 1e-12);
  EXPECT_LT((c.point - middle).norm(), 1e-9);
  EXPECT_LT((c.normal + side).norm(), 1e-9);
  EXPECT_EQ(c.stiffness, 700);
  w.expect_gradient();
}

TEST_P(ContactsOfJoints, OfACapsuleOnAPlaneHaveTheGradientOfTheirDepth) {
  World w(GetParam());
  const Vec3 normal = Vec3(0.3, -0.5, 0.8).normalized();
  const Vec3 low = normal.dot(w.to - w.from) < 0 ? w.to : w.from;
  w.scene.planes.push_back({"", low + 0.004 * normal, normal, 600});
  const auto contacts = w.contacts_at(w.x);
  ASSERT_FALSE(contacts.empty());
  EXPECT_NEAR(contacts.back().depth, 0.012 + 0.004, 1e-12);
  w.expect_gradient();
}

TEST_P(ContactsOfJoints, OfTheTipInABoxHaveTheGradientOfTheirDepth) {
  World w(GetParam());
  w.scene.tip_radius = 0.005;
  w.scene.probes.clear();
  Box box = some_box();
  // The middle of a face 3 mm above the tip.
  const Vec3 face(0.01, 0.02, box.size.z() / 2);
  box.pose.translation() = w.arm.tip(w.frames) - box.pose.linear() * (face - Vec3(0, 0, 0.003));
  w.scene.boxes.push_back(box);
  const auto contacts = w.contacts_at(w.x);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR(contacts[0].depth, 0.005 + 0.003, 1e-12);
  EXPECT_LT((contacts[0].normal - box.pose.linear().col(2)).norm(), 1e-12);
  w.expect_gradient();
}

TEST_P(ContactsOfJoints, OfAJointAreAsDeepAsItIsBeyond) {
  World w(GetParam());
  w.scene.probes.clear();
  const int joint = GetParam() / 2;
  w.scene.joint_contacts.push_back({"", joint, w.x[joint] - 0.1, 1, 20});
  w.scene.joint_contacts.push_back({"", joint, w.x[joint] - 0.1, -1, 30});
  const auto contacts = w.contacts_at(w.x);
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_NEAR(contacts[0].depth, 0.1, 1e-15);
  EXPECT_NEAR(contacts[1].depth, -0.1, 1e-15);
  EXPECT_EQ(contacts[1].stiffness, 30);
  EXPECT_EQ(contacts[0].normal, Vec3::Zero());
  w.expect_gradient();
}

TEST(Contacts, ThatAreFarAwayAreLeftOut) {
  World w(3);
  w.scene.spheres.push_back({"", Vec3(5, 5, 5), 0.1, 600});
  w.scene.planes.push_back({"", Vec3(0, 0, -9), Vec3::UnitZ(), 600});
  EXPECT_TRUE(w.contacts_at(w.x).empty());
}

TEST(Contacts, HaveRoomForEveryPairAndKnowTheEnergyInThem) {
  World w(3);
  const Vec3 tip = w.arm.tip(w.frames);
  for (int i = 0; i < 5; ++i) {
    w.scene.spheres.push_back(
        {"", tip + 0.01 * Random(static_cast<unsigned>(i)).direction(), 0.03, 100.0 * (i + 1)});
  }
  w.scene.joint_contacts.push_back({"", 1, w.x[1] - 0.2, 1, 20});
  Contacts<kAnyDof> contacts(w.description, w.scene);
  EXPECT_EQ(contacts.capacity(), 5u * 2 + 1);
  contacts.find(w.arm, w.frames, w.x, 0.001);
  double wanted = 0.5 * 20 * 0.2 * 0.2;
  for (int i = 0; i < 5; ++i) wanted += 0.5 * 100 * (i + 1) * 0.02 * 0.02;
  ASSERT_EQ(contacts.list().size(), 5u + 1);  // the capsule is out of reach of all
  EXPECT_NEAR(contacts.potential(), wanted, 1e-12);
}

}  // namespace
}  // namespace limpid
