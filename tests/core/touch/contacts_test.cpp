// Distances against brute force, contacts against differences of their depth.
#include "core/touch/contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <tuple>

#include "tests/support/meshes.h"
#include "tests/support/objects.h"

namespace limpid {
namespace {

using test::Random;
using test::random_arm;

// A shape at its pose.
template <class S>
struct Placed {
  S shape;
  Pose pose = pose_at(Vec3(0.1, -0.2, 0.3));

  Surface from(const Vec3& point) const { return distance_to(shape, pose, point); }
  Vec3 origin() const { return pose.translation(); }
};

Placed<Plane> some_plane() { return {Plane{Vec3(1, 2, -3).normalized()}}; }
Placed<Sphere> some_sphere() { return {Sphere{0.07}}; }
Placed<Box> some_box() {
  Random random(3);
  Placed<Box> box{Box{Vec3(0.11, 0.23, 0.17)}};
  box.pose.linear() = random.rotation();
  return box;
}

// Distance to the nearest of a grid of points on the box's six faces.
double distance_to_grid(const Placed<Box>& box, const Vec3& point, int cells) {
  double least = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-0.5, 0.5}) {
      for (int i = 0; i <= cells; ++i) {
        for (int j = 0; j <= cells; ++j) {
          Vec3 p;
          p[axis] = side;
          p[(axis + 1) % 3] = static_cast<double>(i) / cells - 0.5;
          p[(axis + 2) % 3] = static_cast<double>(j) / cells - 0.5;
          least = std::min(least, (box.pose * p.cwiseProduct(box.shape.size) - point).norm());
        }
      }
    }
  }
  return least;
}

bool inside(const Placed<Box>& box, const Vec3& point) {
  const Vec3 p = box.pose.inverse() * point;
  return (p.cwiseAbs().array() < box.shape.size.array() / 2).all();
}

// The normal of a surface is the gradient of the distance to it.
template <class S>
void expect_gradient(const Placed<S>& placed, const Vec3& point) {
  constexpr double h = 1e-6;
  Vec3 slope;
  for (int i = 0; i < 3; ++i) {
    const Vec3 step = h * Vec3::Unit(i);
    slope[i] = (placed.from(point + step).distance - placed.from(point - step).distance) / (2 * h);
  }
  const Vec3 normal = placed.from(point).normal;
  EXPECT_NEAR(normal.norm(), 1, 1e-12);
  EXPECT_LT((normal - slope).norm(), 1e-6);
}

TEST(Distance, ToAPlaneIsSignedAndAlongItsNormal) {
  const Placed<Plane> plane = some_plane();
  const Vec3 normal = plane.shape.normal;
  EXPECT_NEAR(plane.from(plane.origin()).distance, 0, 1e-15);
  EXPECT_NEAR(plane.from(plane.origin() + 0.2 * normal).distance, 0.2, 1e-15);
  const Vec3 within = normal.unitOrthogonal();
  EXPECT_NEAR(plane.from(plane.origin() - 0.1 * normal + within).distance, -0.1, 1e-15);
  expect_gradient(plane, Vec3(0.3, 0.1, -0.2));
}

TEST(Distance, ToASphereIsFromItsCentreLessTheRadius) {
  const Placed<Sphere> sphere = some_sphere();
  const double radius = sphere.shape.radius;
  Random random(1);
  for (int round = 0; round < 100; ++round) {
    const Vec3 direction = random.direction();
    const double r = random.between(0.01, 0.2);
    const Vec3 point = sphere.origin() + r * direction;
    EXPECT_NEAR(sphere.from(point).distance, r - radius, 1e-15);
    expect_gradient(sphere, point);
  }
  const Surface centre = sphere.from(sphere.origin());
  EXPECT_EQ(centre.distance, -radius);
  EXPECT_NEAR(centre.normal.norm(), 1, 1e-15);
}

TEST(Distance, ToABoxIsToTheNearestOfItsPoints) {
  const Placed<Box> box = some_box();
  constexpr int kCells = 60;
  const double spacing = box.shape.size.maxCoeff() / kCells;
  Random random(2);
  int within = 0;
  for (int round = 0; round < 60; ++round) {
    const Vec3 point = box.pose.translation() + random.point(0.15);
    const double sampled = distance_to_grid(box, point, kCells);
    const Surface surface = box.from(point);
    EXPECT_EQ(surface.distance < 0, inside(box, point));
    EXPECT_LE(std::abs(surface.distance), sampled + 1e-15);
    EXPECT_GE(std::abs(surface.distance), sampled - spacing);
    within += inside(box, point) ? 1 : 0;
    expect_gradient(box, point);
    // The foot along the normal lies on the surface.
    const Vec3 foot = point - surface.distance * surface.normal;
    EXPECT_NEAR(box.from(foot).distance, 0, 1e-12);
  }
  EXPECT_GT(within, 5);
}

template <class S>
void expect_nearest(const Placed<S>& placed, Random& random) {
  for (int round = 0; round < 100; ++round) {
    const Vec3 from = Vec3(0.1, -0.2, 0.3) + random.point(0.3);
    const Vec3 to = Vec3(0.1, -0.2, 0.3) + random.point(0.3);
    const Vec3 found = nearest_on_segment(placed.shape, placed.pose, from, to);
    const Vec3 along = to - from;
    const double s = along.dot(found - from) / along.squaredNorm();
    EXPECT_LT((from + s * along - found).norm(), 1e-12);
    EXPECT_GE(s, -1e-12);
    EXPECT_LE(s, 1 + 1e-12);
    const double least = placed.from(found).distance;
    for (int i = 0; i <= 500; ++i) {
      EXPECT_GE(placed.from(from + i / 500.0 * along).distance, least - 1e-9);
    }
  }
}

TEST(NearestOnSegment, IsNoFurtherThanAnyOtherPointOfIt) {
  Random random(4);
  expect_nearest(some_plane(), random);
  expect_nearest(some_sphere(), random);
  expect_nearest(some_box(), random);
}

// An arm of n joints with one capsule in its middle, its pose, and a scene.
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
  Vec3 from, to;  // ends of the capsule
};

class ContactsOfJoints : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Arms, ContactsOfJoints, testing::Values(1, 2, 3, 7, 32));

TEST_P(ContactsOfJoints, OfACapsuleOnABallAreAsDeepAsTheirSurfacesOverlap) {
  World w(GetParam());
  const Vec3 side = (w.to - w.from).unitOrthogonal();
  const Vec3 middle = 0.6 * w.from + 0.4 * w.to;
  w.scene.add({"", pose_at(middle + 0.049 * side), Sphere{0.04}, 700});
  const auto contacts = w.contacts_at(w.x);
  ASSERT_FALSE(contacts.empty());
  const Contact<kAnyDof>& c = contacts.back();
  EXPECT_NEAR(c.depth, 0.012 + 0.04 - 0.049, 1e-12);
  EXPECT_LT((c.point - middle).norm(), 1e-9);
  EXPECT_LT((c.normal + side).norm(), 1e-9);
  EXPECT_EQ(c.material.stiffness, 700);
  w.expect_gradient();
}

TEST_P(ContactsOfJoints, OfACapsuleOnAPlaneHaveTheGradientOfTheirDepth) {
  World w(GetParam());
  const Vec3 normal = Vec3(0.3, -0.5, 0.8).normalized();
  const Vec3 low = normal.dot(w.to - w.from) < 0 ? w.to : w.from;
  w.scene.add({"", pose_at(low + 0.004 * normal), Plane{normal}, 600});
  const auto contacts = w.contacts_at(w.x);
  ASSERT_FALSE(contacts.empty());
  EXPECT_NEAR(contacts.back().depth, 0.012 + 0.004, 1e-12);
  w.expect_gradient();
}

TEST_P(ContactsOfJoints, OfTheTipInABoxHaveTheGradientOfTheirDepth) {
  World w(GetParam());
  w.scene.tip_radius = 0.005;
  w.scene.probes.clear();
  Placed<Box> box = some_box();
  // The middle of a face 3 mm above the tip.
  const Vec3 face(0.01, 0.02, box.shape.size.z() / 2);
  box.pose.translation() = w.arm.tip(w.frames) - box.pose.linear() * (face - Vec3(0, 0, 0.003));
  w.scene.add({"", box.pose, box.shape});
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
  w.scene.add({.shape = JointStop{joint, w.x[joint] - 0.1, 1}, .material = {20}});
  w.scene.add({.shape = JointStop{joint, w.x[joint] - 0.1, -1}, .material = {30}});
  const auto contacts = w.contacts_at(w.x);
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_NEAR(contacts[0].depth, 0.1, 1e-15);
  EXPECT_NEAR(contacts[1].depth, -0.1, 1e-15);
  EXPECT_EQ(contacts[1].material.stiffness, 30);
  EXPECT_EQ(contacts[0].normal, Vec3::Zero());
  w.expect_gradient();
}

TEST(Contacts, OfASceneThatWasReadForAnotherArmAreRefused) {
  World w(3);
  w.scene.probes.clear();
  for (const int joint : {-1, 3, 7}) {
    Scene scene = w.scene;
    scene.add({.shape = JointStop{joint, 0, 1}});
    EXPECT_THROW(Contacts<kAnyDof>(w.description, scene), std::invalid_argument) << joint;
    scene = w.scene;
    scene.probes.push_back({"elbow", joint, Vec3::Zero(), Vec3::Zero(), 0.01});
    EXPECT_THROW(Contacts<kAnyDof>(w.description, scene), std::invalid_argument) << joint;
  }
}

// The tip is 1 mm deep in half spaces, the hardest neither first nor last. A stop has no place to
// be listed.
TEST(Contacts, AreListedByTheHardestIfThereIsNoRoomForAll) {
  World w(3);
  w.scene.probes.clear();
  for (const double stiffness : {300.0, 500.0, 200.0, 700.0, 400.0, 600.0, 100.0}) {
    const Vec3 side(0, std::cos(stiffness), std::sin(stiffness));
    w.scene.add({"", pose_at(w.arm.tip(w.frames) - 0.001 * side), Plane{-side}, stiffness});
  }
  w.scene.add({.shape = JointStop{0, w.x[0] - 0.1, 1}, .material = {1e4}});
  Contacts<kAnyDof> contacts(w.description, w.scene);
  contacts.find(w.arm, w.frames, w.x, 0.001);
  Vec<kAnyDof> f2;
  contacts.push(Vec<kAnyDof>::Zero(3), 0.001, f2);
  std::array<ContactForce, 9> all;
  EXPECT_EQ(contacts.forces(all), 7u);
  std::array<ContactForce, 4> hardest;
  ASSERT_EQ(contacts.forces(hardest), 4u);
  std::ranges::sort(hardest, {}, [](const ContactForce& c) { return c.force.norm(); });
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(hardest[i].force.norm(), 0.4 + 0.1 * static_cast<double>(i), 1e-9);
    EXPECT_LT((hardest[i].point - w.arm.tip(w.frames)).norm(), 1e-12);
  }
  EXPECT_EQ(contacts.forces({}), 0u);
}

TEST(Contacts, ThatAreFarAwayAreLeftOut) {
  World w(3);
  w.scene.add({"", pose_at(Vec3(5, 5, 5)), Sphere{0.1}, 600});
  w.scene.add({"", pose_at(Vec3(0, 0, -9)), Plane{Vec3::UnitZ()}, 600});
  EXPECT_TRUE(w.contacts_at(w.x).empty());
}

TEST(Contacts, HaveRoomForEveryPairAndKnowTheEnergyInThem) {
  World w(3);
  const Vec3 tip = w.arm.tip(w.frames);
  for (int i = 0; i < 5; ++i) {
    w.scene.add({"", pose_at(tip + 0.01 * Random(static_cast<unsigned>(i)).direction()),
                 Sphere{0.03}, 100.0 * (i + 1)});
  }
  w.scene.add({.shape = JointStop{1, w.x[1] - 0.2, 1}, .material = {20}});
  Contacts<kAnyDof> contacts(w.description, w.scene);
  EXPECT_EQ(contacts.capacity(), 5u * 2 + 1);
  contacts.find(w.arm, w.frames, w.x, 0.001);
  double wanted = 0.5 * 20 * 0.2 * 0.2;
  for (int i = 0; i < 5; ++i) wanted += 0.5 * 100 * (i + 1) * 0.02 * 0.02;
  ASSERT_EQ(contacts.list().size(), 5u + 1);  // the capsule is out of reach of all
  EXPECT_NEAR(contacts.potential(), wanted, 1e-12);
}

// The tip of an arm of three joints before a plane, a ball and a sheet that face three ways.
class TipBeforeThings : public testing::Test {
 protected:
  static constexpr double kRadius = 0.005, kTick = 0.001;

  TipBeforeThings() {
    scene_.tip_radius = kRadius;
    arm_.frames(x_, frames_);
    tip_ = arm_.tip(frames_);
    arm_.point_jacobian(frames_, 2, tip_, J_);
  }

  // Adds a plane that is `deep` in the tip; a negative value is a gap.
  void add_plane(double deep) {
    scene_.add({"", pose_at(tip_ - (kRadius - deep) * out_[0]), Plane{out_[0]}, 700});
  }
  void add_ball(double deep) {
    scene_.add({"", pose_at(tip_ - (0.03 + kRadius - deep) * out_[1]), Sphere{0.03}, 800});
  }
  void add_sheet(double deep, double scale = 1, double aside = 0) {
    Object sheet = test::obstacle(test::sheet(4, 0.3), 900);
    test::mesh_of(sheet).scale = scale;
    sheet.pose.linear() =
        Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), out_[2]).toRotationMatrix();
    sheet.pose.translation() = tip_ - (kRadius - deep) * out_[2] + aside * out_[2].unitOrthogonal();
    scene_.add(sheet);
  }
  // Joint angles with the tip at `to`, reached straight from x.
  Vec<kAnyDof> led(Vec<kAnyDof> x, const Vec3& to) const {
    Arm<kAnyDof>::Frames f;
    Jacobian<kAnyDof> J;
    for (int i = 0; i < 200; ++i) {
      arm_.frames(x, f);
      const Vec3 left = to - arm_.tip(f);
      arm_.point_jacobian(f, 2, arm_.tip(f), J);
      x += Mat3(J).inverse() * (left * std::min(1.0, 2e-4 / (left.norm() + 1e-9)));
    }
    return x;
  }
  // Joint rates for this rate of the tip.
  Vec<kAnyDof> joints(const Vec3& rate) const { return Mat3(J_).inverse() * rate; }
  // Rate of the tip with these components along the three normals.
  Vec3 rate(const Vec3& along) const {
    Mat3 normals;
    for (int i = 0; i < 3; ++i) normals.row(i) = out_[i];
    return normals.inverse() * along;
  }
  void find(Contacts<kAnyDof>& contacts, const Vec<kAnyDof>& x) const {
    Arm<kAnyDof>::Frames f;
    arm_.frames(x, f);
    contacts.find(arm_, f, x, kTick);
  }
  Contacts<kAnyDof> placed(const Vec<kAnyDof>& x) const {
    Contacts<kAnyDof> contacts(description_, scene_);
    Arm<kAnyDof>::Frames f;
    arm_.frames(x, f);
    contacts.place(arm_, f, x);
    return contacts;
  }

  ArmDescription description_ = random_arm(3, 27);
  Arm<kAnyDof> arm_{description_};
  Vec<kAnyDof> x_ = Random(28).vector(3, 2);
  const Vec3 out_[3] = {Vec3(0.2, 0.1, 0.9).normalized(), Vec3(-0.8, 0.5, 0.1).normalized(),
                        Vec3(0.3, 0.8, -0.3).normalized()};
  Arm<kAnyDof>::Frames frames_;
  Jacobian<kAnyDof> J_;
  Vec3 tip_;
  Scene scene_;
};

TEST_F(TipBeforeThings, TakesNobodyInOnceContactsAreOnlyLetGo) {
  add_plane(0.003);
  add_ball(-0.001);
  add_sheet(-0.001);
  Contacts<kAnyDof> contacts = placed(x_);
  find(contacts, x_);
  ASSERT_EQ(contacts.list().size(), 2u);
  ASSERT_TRUE(contacts.list()[0].touching);
  ASSERT_FALSE(contacts.list()[1].touching);
  ASSERT_EQ(contacts.meshes()[0].rank, 0);
  // Half a tick of this moves the tip 4 mm away from the plane, and into ball and sheet.
  const Vec<kAnyDof> vbar = joints(rate(Vec3(8, -8, -8)));
  EXPECT_TRUE(contacts.reconsider(vbar, kTick, true));
  EXPECT_FALSE(contacts.list()[0].touching);
  EXPECT_FALSE(contacts.list()[1].touching);
  EXPECT_EQ(contacts.meshes()[0].rank, 0);
  EXPECT_FALSE(contacts.reconsider(vbar, kTick, true));  // the iteration of a tick ends here
  EXPECT_TRUE(contacts.reconsider(vbar, kTick, false));
  EXPECT_FALSE(contacts.list()[0].touching);
  EXPECT_TRUE(contacts.list()[1].touching);
  EXPECT_EQ(contacts.meshes()[0].rank, 1);
  EXPECT_FALSE(contacts.reconsider(vbar, kTick, false));
  // The reverse motion releases all, the sheet as well.
  EXPECT_TRUE(contacts.reconsider(-vbar, kTick, true));
  EXPECT_FALSE(contacts.list()[0].touching);
  EXPECT_FALSE(contacts.list()[1].touching);
  EXPECT_EQ(contacts.meshes()[0].rank, 0);
}

TEST_F(TipBeforeThings, SaysWhereAndHowHardItIsPushedUntilItIsLifted) {
  add_plane(0.003);
  scene_.add({"", pose_at(tip_ - (kRadius - 0.002) * out_[1]), Plane{out_[1]}, {800}});
  add_sheet(0.001);
  Contacts<kAnyDof> contacts = placed(x_);
  std::array<ContactForce, 8> forces;
  EXPECT_EQ(contacts.forces(forces), 0u);  // nothing has pushed yet
  find(contacts, x_);
  Vec<kAnyDof> f2;
  EXPECT_TRUE(contacts.push(Vec<kAnyDof>::Zero(3), kTick, f2));
  ASSERT_EQ(contacts.forces(forces), 3u);
  const double newtons[] = {700 * 0.003, 800 * 0.002, 900 * 0.001};
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT((forces[i].force - newtons[i] * out_[i]).norm(), 1e-5) << i;
    sum += newtons[i] * out_[i];
  }
  // Forces from shapes name the middle of the tip as their place, those from meshes the place on
  // the surface.
  EXPECT_LT((forces[0].point - tip_).norm(), 1e-12);
  EXPECT_LT((forces[2].point - (tip_ - 0.004 * out_[2])).norm(), 1e-7);
  EXPECT_LT((f2 - J_.transpose() * sum).norm(), 1e-6);
  EXPECT_EQ(contacts.forces(std::span(forces).first(2)), 2u);  // no more than fit

  // A position 10 mm away from all three.
  const Vec<kAnyDof> away = led(x_, tip_ + rate(Vec3::Constant(0.01)));
  find(contacts, away);
  EXPECT_TRUE(contacts.push(Vec<kAnyDof>::Zero(3), kTick, f2));
  EXPECT_EQ(contacts.forces(forces), 0u);
  EXPECT_EQ(f2.norm(), 0);
}

TEST_F(TipBeforeThings, PushesAtTheMiddleOfAStep) {
  add_plane(0.003);
  add_sheet(0.002);
  Contacts<kAnyDof> contacts = placed(x_);
  find(contacts, x_);
  const Vec3 tip_rate = rate(Vec3(1.5, 0, -2.5));  // [m/s]
  Vec<kAnyDof> f2;
  EXPECT_TRUE(contacts.push(joints(tip_rate), kTick, f2));
  const Vec3 plane = 700 * (0.003 - 0.5 * kTick * 1.5) * out_[0];
  const Vec3 sheet = 900 * (0.002 + 0.5 * kTick * 2.5) * out_[2];
  EXPECT_LT((f2 - J_.transpose() * (plane + sheet)).norm(), 1e-6);
  EXPECT_NEAR(contacts.potential(), 0.5 * 700 * 9e-6 + 0.5 * 900 * 4e-6, 1e-8);
}

TEST_F(TipBeforeThings, LooksTwoCentimetresAroundAndStoresNothingThere) {
  // The tip moves less than this distance within a tick.
  add_plane(-0.015);
  add_ball(-0.019);
  Contacts<kAnyDof> contacts = placed(x_);
  find(contacts, x_);
  EXPECT_EQ(contacts.list().size(), 2u);
  EXPECT_EQ(contacts.potential(), 0);
  scene_ = {};
  scene_.tip_radius = kRadius;
  add_plane(-0.021);
  add_ball(-0.03);
  contacts = placed(x_);
  find(contacts, x_);
  EXPECT_TRUE(contacts.list().empty());
  scene_.add({.shape = JointStop{1, x_[1] + 0.3, 1}, .material = {20}});  // 0.3 rad before a stop
  contacts = placed(x_);
  find(contacts, x_);
  EXPECT_EQ(contacts.potential(), 0);
}

// The tip is led through a sheet to 3 mm behind it. Contacts that begin anew there are pushed to
// the other side.
class TipBehindASheet : public TipBeforeThings {
 protected:
  static constexpr double kWay = 0.01;  // from 2 mm before the sheet [m]

  // Pull on the ball along the sheet's normal [m].
  double pull(const Contacts<kAnyDof>& contacts) const {
    const auto& c = contacts.meshes()[0];
    return out_[2].dot(c.direction.leftCols(c.rank) * c.depth.head(c.rank));
  }
  // The pull after a tick behind the sheet [m].
  double side_after(Contacts<kAnyDof>& contacts) const {
    find(contacts, behind_);
    return pull(contacts);
  }
  Contacts<kAnyDof> came_through() const {
    Contacts<kAnyDof> contacts = placed(x_);
    for (int k = 1; k <= 200; ++k) find(contacts, led(x_, tip_ - k / 200.0 * kWay * out_[2]));
    return contacts;
  }

  Vec<kAnyDof> behind_ = led(x_, tip_ - kWay * out_[2]);
};

TEST_F(TipBehindASheet, IsTakenOverWithItsSideByAnEqualWorldOnly) {
  const auto set = [&](double scale, double aside, double radius) {
    scene_ = {};
    scene_.tip_radius = kRadius;
    add_sheet(-0.002, scale, aside);
    scene_.tip_radius = radius;
  };
  set(1, 0, kRadius);
  Contacts<kAnyDof> first = came_through();
  ASSERT_GT(side_after(first), 0.007);  // towards the side it came from
  const std::shared_ptr<const TriangleMesh> shape = test::shape<Mesh>(scene_).triangles;
  const auto taken_over = [&] {
    Contacts<kAnyDof> next = placed(behind_);
    next.take_over(first);
    return side_after(next);
  };
  set(1, 0, kRadius);
  EXPECT_LT(taken_over(), 0) << "another shape, even if it is an equal one";
  test::shape<Mesh>(scene_).triangles = shape;
  EXPECT_GT(taken_over(), 0.007);
  test::object<Mesh>(scene_).material.stiffness = 100;  // stiffness may change
  EXPECT_GT(taken_over(), 0.007);
  for (const auto& [scale, aside, radius] :
       {std::tuple(2.0, 0.0, kRadius), {1.0, 0.001, kRadius}, {1.0, 0.0, 0.0051}}) {
    set(scale, aside, radius);
    test::shape<Mesh>(scene_).triangles = shape;
    EXPECT_LT(taken_over(), 0) << scale << ' ' << aside << ' ' << radius;
  }
}

// Balls are at most 0.75 radii apart, but no more than 24.
TEST(Contacts, OfACapsuleAndAMeshAreARowOfBallsFromEndToEnd) {
  World w(3);
  w.scene.add(test::obstacle(test::sheet(4, 0.3), 900));
  for (const auto& [length, radius, balls] : {std::tuple(0.1, 0.01, 15),
                                              {0.015, 0.01, 3},
                                              {0.001, 0.01, 2},
                                              {0.0, 0.01, 1},
                                              {1.0, 0.001, 24}}) {
    const Vec3 from(0.01, -0.02, 0.03), to = from + length * Vec3(0.6, 0, -0.8);
    w.scene.probes = {{"", 1, from, to, radius}};
    const Contacts<kAnyDof> contacts(w.description, w.scene);
    const auto all = contacts.meshes();
    ASSERT_EQ(all.size(), 1u + static_cast<std::size_t>(balls)) << length;
    EXPECT_LT((all[1].on_link - from).norm(), 1e-15);
    EXPECT_LT((all.back().on_link - to).norm(), 1e-15) << length;
    for (std::size_t i = 2; i < all.size(); ++i) {
      EXPECT_NEAR((all[i].on_link - all[i - 1].on_link).norm(), length / (balls - 1), 1e-15);
      EXPECT_EQ(all[i].link, 1);
      EXPECT_EQ(all[i].touch.radius(), radius);
    }
  }
}

// All later forces are equal bit for bit: the new contacts have everything that the old ones know.
TEST_F(TipBehindASheet, GoesOnAsTheOneItWasTakenOverFrom) {
  add_sheet(-0.002);
  Contacts<kAnyDof> first = came_through();
  Contacts<kAnyDof> next = placed(led(x_, tip_ - 3 * kWay * out_[2]));
  next.take_over(first);
  EXPECT_EQ(next.recoverable(), first.recoverable());
  Random random(29);
  Vec3 at = -kWay * out_[2];
  for (int k = 0; k < 400; ++k) {
    at += random.point(k % 7 == 0 ? 0.01 : 0.001);
    at *= 0.98;
    const Vec<kAnyDof> x = led(x_, tip_ + at);
    find(first, x);
    find(next, x);
    ASSERT_EQ(pull(next), pull(first)) << k;
    ASSERT_EQ(next.meshes()[0].rank, first.meshes()[0].rank) << k;
    ASSERT_EQ(next.potential(), first.potential()) << k;
  }
}

}  // namespace
}  // namespace limpid
