// Forces of all contacts together: each follows its own law for the motion, and they add up.
#include "core/touch/contact_solve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/math/eigen.h"
#include "core/touch/wall_force.h"
#include "tests/support/body_worlds.h"
#include "tests/support/meshes.h"
#include "tests/support/tick.h"

namespace limpid {
namespace {

using test::Random;
using Arm3 = Arm<3>;

using test::T;

// A device and its proxy on a stiff coupling, and the effect of the contacts' torque on both.
struct Answer {
  Answer(const Mat3& inertia, Random& random) : M(inertia) {
    const Mat3 D0 = 2 / T * M + random.matrix(3, 1e-3) + 0.012 * Mat3::Identity();
    const Mat3 impedance = 1e-4 * 2 / T * M + random.matrix(3, 1e-6);
    const Mat3 c = 0.006 * Mat3::Identity() + random.matrix(3, 2e-5);
    const Mat3 ww = D0 + c, uu = impedance + c;
    A << ww, -c, -c, uu;
    const Mat3 phi = 1e-4 * random.matrix(3, 1);
    const double governor = random.between(0.7, 1);
    // The sum of both sides' equations, and the proxy's; unknowns are the device's motion and the
    // proxy's relative to it.
    const Mat3 proxy_w = uu - c;
    contact.system = CoupledSystem<3>(ww - c + proxy_w, proxy_w, proxy_w, uu);
    contact.on_device = 1;
    contact.on_proxy = phi + (1 - governor) * Mat3::Identity();
    on_device = governor * Mat3::Identity() - phi;
    contact.inertia = &factor;
    contact.damping = 0.2;
    contact.most_damping = 0.34;
  }
  Motion<3> motion(const Eigen::VectorXd& b) const {
    const Eigen::VectorXd x = least_squares(A, b);
    return {x.head<3>(), x.tail<3>()};
  }
  // Motion of the proxy under a contact torque.
  Vec3 moved(const Vec3& torque) const {
    Eigen::VectorXd b(6);
    b << on_device * torque, contact.on_proxy * torque;
    return motion(b).u;
  }
  Answer(const Answer&) = delete;
  Answer& operator=(const Answer&) = delete;

  Mat3 M, on_device;
  SymmetricFactor<3> factor{M};
  Eigen::Matrix<double, 6, 6> A;
  ContactAnswer<3> contact;
};

// An arm among obstacles, ticked without its own inertia: the drive pushes it about.
class Bench {
 public:
  Bench(const Scene& scene, unsigned seed)
      : random(seed), answer(inertia(), random), contacts(test::random_arm(3, 5), scene) {
    arm.frames(x, f);
    contacts.place(arm, f, x);
  }
  static Mat3 inertia() {
    const Arm3 arm(test::random_arm(3, 5));
    Arm3::Frames f;
    Mat3 M;
    arm.frames(start(), f);
    arm.inertia(f, M);
    return M;
  }
  // A wall that lies `depth` above the arm's tip.
  static Object plane(const Vec3& normal, double depth, const Material& material) {
    const Vec3 tip = Arm3(test::random_arm(3, 5)).tip_at(start());
    return {"", pose_at(tip + depth * normal), Plane{normal}, material};
  }
  static Vec3 start() { return {0.3, -0.5, 0.8}; }

  Jacobian<3> tip_jacobian() const {
    Jacobian<3> J;
    arm.point_jacobian(f, 2, arm.tip(f), J);
    return J;
  }
  // Runs a tick with a force at the device's tip [N].
  void tick(const Vec3& push) {
    arm.frames(x, f);
    contacts.find(arm, f, x, T);
    Eigen::VectorXd b(6);
    b << tip_jacobian().transpose() * push, Vec3::Zero();
    base = b;
    motion = answer.motion(b);
    solve.collect(contacts, arm, f, motion.u, T);
    memories.clear();
    for (const Contact<3>& c : contacts.list()) memories.push_back(contacts.memory(c.id));
    potential = contacts.potential();
    solve.solve(answer.contact, T, motion);
    f2 = solve.f2(3);
    solve.finish(contacts);
  }
  void go_on() { x += T * motion.u; }

  Random random;
  Answer answer;
  Arm3 arm{test::random_arm(3, 5)};
  Contacts<3> contacts;
  ContactSolve<3> solve;
  Vec3 x = start();
  Arm3::Frames f;
  Eigen::VectorXd base;
  Motion<3> motion;
  Vec3 f2;
  double potential = 0;
  std::vector<ContactMemory> memories;  // of each contact in the list, before the tick
};

Material some_material(Random& random, bool friction) {
  Material m;
  m.stiffness = std::pow(10, random.between(2.5, 4));
  m.damping = random.between(0, 1);
  if (friction) {
    m.friction_kinetic = random.between(0.1, 0.8);
    m.friction_static = m.friction_kinetic + random.between(0, 0.3);
  }
  return m;
}

// Up to three walls across each other, a corner to press into.
Scene some_corner(Random& random, int walls, bool friction) {
  Scene scene;
  const Mat3 axes = random.rotation();
  for (int i = 0; i < walls; ++i) {
    const Vec3 normal = (axes.col(i) + 0.3 * random.direction()).normalized();
    scene.add(Bench::plane(normal, random.between(-2e-4, 2e-4), some_material(random, friction)));
  }
  return scene;
}

Vec3 press(const Scene& scene, Random& random) {
  Vec3 push = 2 * random.direction();
  for (const Object& plane : scene.objects) {
    push -= random.between(-1, 6) * std::get<Plane>(plane.shape).normal;
  }
  return push;
}

// Expects the contact's wall force and friction as computed from the motion alone.
void expect_its_own_law(const Bench& bench, const Contact<3>& c, const ContactMemory& before) {
  const Vec3 u = bench.motion.u, g = -c.gradient;
  const double response = T * g.dot(bench.answer.moved(g));
  const double mass = 1 / g.dot(Vec3(least_squares(bench.answer.M, g)));
  const double own = std::min(0.2 * mass / T, std::sqrt(c.material.stiffness * mass));
  const double B = std::min(own + c.material.damping, 0.34 * mass / T);
  const double a = T * c.gradient.dot(u) + response * c.force;
  const double F = wall_force({c.material.stiffness, B, T, c.depth, a, response});
  ASSERT_NEAR(c.force, F, 1e-6 * std::max(1.0, F));

  const double K_t = friction_stiffness(c.material);
  const double mu = before.slipping ? c.material.friction_kinetic : c.material.friction_static;
  const Mat3 across = Mat3::Identity() - c.normal * c.normal.transpose();
  Jacobian<3> J;
  bench.arm.point_jacobian(bench.f, c.link, c.point, J);
  Vec3 wanted = -K_t * across * (before.anchor + T * J * u);
  if (wanted.norm() > mu * F) wanted *= mu * F / wanted.norm();
  // Friction that slips is found by six steps of its own, which leave a small error.
  ASSERT_LT((c.friction - wanted).norm(), 1e-4 * std::max(1.0, F));
  ASSERT_LE(c.friction.norm(), mu * c.force * (1 + 1e-12) + 1e-15);
}

TEST(ContactSolve, LeavesEachContactWithWhatItsOwnLawAsksOfTheMotion) {
  Random random(91);
  int pushed = 0, stuck = 0, slipped = 0, unsettled = 0;
  for (int round = 0; round < 300; ++round) {
    const bool friction = round % 3 != 0;
    const Scene scene = some_corner(random, 1 + round % 7 % 3, friction);
    Bench bench(scene, 900 + static_cast<unsigned>(round));
    for (int k = 0; k < 20; ++k) {
      bench.tick(press(scene, random));
      bench.go_on();
      if (bench.solve.sweeps() == ContactSolve<3>::kMostSweeps) {
        ++unsettled;
        continue;
      }
      const auto list = std::as_const(bench.contacts).list();
      for (std::size_t i = 0; i < list.size(); ++i) {
        SCOPED_TRACE(testing::Message() << round << ' ' << k << ' ' << i);
        expect_its_own_law(bench, list[i], bench.memories[i]);
        if (testing::Test::HasFatalFailure()) return;
        if (list[i].force > 0) ++pushed;
        if (list[i].friction.isZero(0)) continue;
        (bench.contacts.memory(list[i].id).slipping ? slipped : stuck) += 1;
      }
    }
  }
  EXPECT_LT(unsettled, 200);
  EXPECT_GT(pushed, 1000);
  EXPECT_GT(stuck, 200);
  EXPECT_GT(slipped, 200);
}

// Forces as functions of the motion equal those found together, and their slopes are right.
TEST(ContactSolve, AsAFunctionOfTheMotionIsTheForceThatItSettledOn) {
  Random random(97);
  int pushed = 0, smooth = 0;
  for (int round = 0; round < 200; ++round) {
    const Scene scene = some_corner(random, 1 + round % 7 % 3, round % 3 != 0);
    Bench bench(scene, 700 + static_cast<unsigned>(round));
    for (int k = 0; k < 10; ++k) {
      bench.tick(press(scene, random));
      ContactSolve<3> known = bench.solve;
      const Vec3 u = bench.motion.u;
      known.prepare(bench.answer.contact, T);
      Mat3 slope;
      const Vec3 f2 = known.push(u, T, &slope);
      const double size = std::max(1e-3, bench.f2.norm());
      if (bench.solve.sweeps() < ContactSolve<3>::kMostSweeps) {
        ASSERT_LT((f2 - bench.f2).norm(), 1e-3 * size) << round << ' ' << k;
      }
      pushed += !f2.isZero(0);
      const auto answer = [&](int axis, double h) {
        const Vec3 step = h * Vec3::Unit(axis);
        return Vec3((known.push(u + step, T, nullptr) - known.push(u - step, T, nullptr)) /
                    (2 * h));
      };
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 fine = answer(axis, 1e-6), coarse = answer(axis, 4e-6);
        if ((fine - coarse).norm() > 1e-3 * (1e-3 + fine.norm())) continue;  // a corner of the law
        ++smooth;
        ASSERT_LT((slope.col(axis) - fine).norm(), 1e-2 * (1e-3 + fine.norm()))
            << round << ' ' << k << ' ' << axis;
      }
      bench.go_on();
    }
  }
  EXPECT_GT(pushed, 1000);
  EXPECT_GT(smooth, 4000);
}

TEST(ContactSolve, MovesAllByTheSumOfItsForcesAndOfTheirPowers) {
  Random random(92);
  for (int round = 0; round < 100; ++round) {
    const Scene scene = some_corner(random, 3, true);
    Bench bench(scene, 950 + static_cast<unsigned>(round));
    for (int k = 0; k < 10; ++k) {
      bench.tick(press(scene, random));
      Eigen::VectorXd b = bench.base;
      b.head<3>() += bench.answer.on_device * bench.f2;
      b.tail<3>() += bench.answer.contact.on_proxy * bench.f2;
      const Motion<3> wanted = bench.answer.motion(b);
      ASSERT_LT((bench.motion.w - wanted.w).norm(), 1e-9 * (1 + wanted.w.norm()));
      ASSERT_LT((bench.motion.u - wanted.u).norm(), 1e-9 * (1 + wanted.u.norm()));
      double power = 0, size = 0;
      for (const Contact<3>& c : bench.contacts.list()) {
        Jacobian<3> J;
        bench.arm.point_jacobian(bench.f, c.link, c.point, J);
        const Vec3 speed = J * bench.motion.u;
        power += (c.force * c.normal + c.friction).dot(speed);
        size += (c.force + c.friction.norm()) * speed.norm();
      }
      ASSERT_NEAR(bench.f2.dot(bench.motion.u), power, 1e-12 * size);
      bench.go_on();
    }
  }
}

TEST(ContactSolve, OfWallsWithFrictionNeverGivesEnergy) {
  Random random(93);
  for (int round = 0; round < 200; ++round) {
    const Scene scene = some_corner(random, 1 + round % 3, true);
    Bench bench(scene, 1200 + static_cast<unsigned>(round));
    for (int k = 0; k < 20; ++k) {
      bench.tick(press(scene, random));
      double after = 0;  // stored if walls are flat and the motion straight [J]
      for (const Contact<3>& c : bench.contacts.list()) {
        const double d = std::max(0.0, c.depth + T * c.gradient.dot(bench.motion.u));
        after +=
            0.5 * c.material.stiffness * d * d +
            0.5 * friction_stiffness(c.material) * bench.contacts.memory(c.id).anchor.squaredNorm();
      }
      ASSERT_LT(T * bench.f2.dot(bench.motion.u) + after - bench.potential, 1e-12) << round;
      bench.go_on();
    }
  }
}

TEST(ContactSolve, TakesTheDeepest32OfMore) {
  Scene scene;
  std::vector<int> order(50);
  for (int i = 0; i < 50; ++i) order[static_cast<std::size_t>(i)] = 7 * i % 50;
  for (const int i : order) {
    scene.add(Bench::plane(Vec3::UnitZ(), 1e-4 + 1e-5 * i, {.stiffness = 0.1}));
  }
  Bench bench(scene, 94);
  bench.answer.contact.damping = 0;  // the damper would hold contacts that others push out
  bench.tick(Vec3::Zero());
  ASSERT_EQ(std::as_const(bench.contacts).list().size(), 50u);
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(std::as_const(bench.contacts).list()[i].force > 0, order[i] >= 50 - 32) << order[i];
    EXPECT_EQ(bench.contacts.memory(i).push.x() > 0, order[i] >= 50 - 32);
  }
}

bool blank(const ContactMemory& m) { return m.push.isZero(0) && m.anchor.isZero(0) && !m.slipping; }

TEST(ContactSolve, ForgetsWhatItLeft) {
  const Material m{.stiffness = 1000, .friction_static = 0.5, .friction_kinetic = 0.1};
  for (const double away : {1e-3, 5e-3, 0.05}) {
    Scene scene;
    scene.add(Bench::plane(Vec3::UnitZ(), 1e-3, m));
    Bench bench(scene, 95);
    bench.tick(Vec3(0.3, 0, -1));
    bench.go_on();
    bench.tick(Vec3(3, 0, -1));
    ASSERT_FALSE(blank(bench.contacts.memory(0)));
    // The arm leaves within one tick, by any distance.
    const Jacobian<3> J = bench.tip_jacobian();
    bench.x += least_squares(J, Vec3(0, 0, 2e-3 + away));
    bench.tick(Vec3::Zero());
    EXPECT_TRUE(blank(bench.contacts.memory(0))) << away;
    EXPECT_EQ(bench.f2, Vec3::Zero());
  }
}

TEST(ContactSolve, SlipsAtTheKineticForceUntilItSticksAgain) {
  for (const double kinetic : {0.2, 0.0}) {
    Scene scene;
    const Material m{.stiffness = 1000, .friction_static = 0.6, .friction_kinetic = kinetic};
    scene.add(Bench::plane(Vec3::UnitZ(), 2e-3, m));  // pressed with 2 N
    Bench bench(scene, 96);
    bench.answer.on_device.setIdentity();
    bench.answer.contact.on_proxy.setZero();
    const auto friction = [&](double pull) {
      bench.tick(Vec3(pull, 0, -2));
      bench.go_on();
      const Contact<3>& c = std::as_const(bench.contacts).list()[0];
      EXPECT_GT(c.force, 0);
      return c.friction.norm() / c.force;
    };
    const auto slipping = [&] { return bench.contacts.memory(0).slipping; };
    for (int k = 0; k < 50; ++k) friction(0);
    EXPECT_FALSE(slipping());
    double most = 0, pull = 0;
    while (!slipping() && pull < 5) most = std::max(most, friction(pull += 0.002));
    EXPECT_NEAR(most, 0.6, 1e-6);  // the limit of sticking
    for (int k = 0; k < 5; ++k) {
      EXPECT_NEAR(friction(pull), kinetic, 1e-9);
      EXPECT_TRUE(slipping());
    }
    for (int k = 0; k < 100; ++k) friction(0);
    if (kinetic > 0) {
      EXPECT_FALSE(slipping());
    } else {
      EXPECT_TRUE(slipping()) << "nothing holds it until it is lifted";
      for (int k = 0; k < 10; ++k) {
        bench.tick(Vec3(0, 0, 20));
        bench.go_on();
      }
      EXPECT_FALSE(slipping());
    }
  }
}

TEST(ContactSolve, OfAFlatMeshIsThatOfAPlane) {
  Random random(97);
  int pushed = 0;
  for (int round = 0; round < 20; ++round) {
    const Material m = some_material(random, round % 2 == 1);
    constexpr double kRadius = 0.004;
    Scene flat, mesh;
    flat.tip_radius = mesh.tip_radius = kRadius;
    const Vec3 normal = random.direction();
    const Object plane = Bench::plane(normal, 5e-4 - kRadius, m);
    flat.add(plane);
    Object sheet = test::obstacle(test::sheet(3, 2));
    sheet.material = m;
    sheet.pose.linear() =
        Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), normal).toRotationMatrix();
    sheet.pose.translation() = plane.pose.translation();
    mesh.add(sheet);
    Bench a(flat, 98), b(mesh, 98);
    for (int k = 0; k < 60; ++k) {
      const Vec3 push = -3 * normal + 0.05 * k * normal.unitOrthogonal();
      a.tick(push);
      b.tick(push);
      // A mesh finds the moment of a break within a tick only to a 32nd.
      const Contact<3>& c = std::as_const(a.contacts).list()[0];
      if (c.depth + T * c.gradient.dot(a.motion.u) <= 0) break;
      ++pushed;
      ASSERT_LT((a.f2 - b.f2).norm(), 1e-5 * (1e-3 + a.f2.norm())) << k;
      ASSERT_LT((a.motion.u - b.motion.u).norm(), 1e-5 * (1e-3 + a.motion.u.norm())) << k;
      a.go_on();
      b.go_on();
    }
  }
  EXPECT_GT(pushed, 600);
}

// A wall faces along an axis about which nothing turns: it pushes nothing away and rubs at nothing.
TEST(ContactSolve, LeavesOutAWallThatNoJointCanServe) {
  Random random(98);
  for (int round = 0; round < 20; ++round) {
    Bench bench(some_corner(random, 1, true), 800 + static_cast<unsigned>(round));
    bench.tick(Vec3::Zero());
    const Vec3 pushed = bench.f2;
    for (Contact<3>& c : bench.contacts.list()) {
      c.depth = 1e-3;
      c.gradient.setZero();
    }
    bench.solve.collect(bench.contacts, bench.arm, bench.f, bench.motion.u, T);
    EXPECT_FALSE(bench.solve.any()) << pushed;
  }
}

// A body that is held neither moves nor gives way: its face pushes and rubs as a wall there would.
TEST(ContactSolve, PushesOffABodyThatIsHeldAsOffAWall) {
  Random random(99);
  int pushed = 0, stuck = 0, slipped = 0;
  for (int round = 0; round < 200; ++round) {
    const Vec3 normal = random.direction();
    Material m = some_material(random, true);
    m.damping = 0;
    constexpr double kEdge = 0.04;
    const Object face = Bench::plane(normal, random.between(0, 4e-4) - kEdge / 2, m);
    Object box = test::body("box", Box{Vec3::Constant(kEdge)}, random.between(0.02, 0.2), {});
    box.pose.linear() = frame_of(normal);
    box.pose.translation() = face.pose.translation();
    box.material = m;
    Scene scene;
    scene.add(box);
    Bench bench(scene, 820 + static_cast<unsigned>(round));
    bench.answer.contact.damping = 0;
    bench.contacts.world()->set_speed(0, random.point(0.1), Vec3::Zero());
    const Vec3 anchor = random.between(0, 2e-4) * normal.unitOrthogonal();
    bench.contacts.memory(0).anchor = anchor;
    bench.tick(2 * random.direction() - 2 * normal);
    bench.solve.prepare(bench.answer.contact, T);
    bench.solve.hold_bodies();
    const Vec3 u = bench.motion.u + random.point(0.1);
    const Vec3 f2 = bench.solve.push(u, T, nullptr);

    const Contact<3>& c = std::as_const(bench.contacts).list()[0];
    const double F = wall_force({m.stiffness, 0, T, c.depth, T * c.gradient.dot(u), 0});
    const Mat3 across = Mat3::Identity() - normal * normal.transpose();
    const Jacobian<3> J = bench.tip_jacobian();
    Vec3 rub = -friction_stiffness(m) * (anchor + T * across * J * u);
    const double most = m.friction_static * F;
    (rub.norm() > most ? slipped : stuck) += F > 0 ? 1 : 0;
    if (rub.norm() > most) rub *= most / rub.norm();
    ASSERT_LT((f2 - J.transpose() * (F * normal + rub)).norm(), 1e-5 * J.norm() * std::max(1., F))
        << round;
    pushed += F > 0;
  }
  EXPECT_GT(pushed, 100);
  EXPECT_GT(stuck, 20);
  EXPECT_GT(slipped, 20);
}

// A wall may damp by 0.34 of m_n/T at most; 0.2 of it is its own. m_n is the tip's mass along the
// normal.
TEST(ContactSolve, BoundsTheDamperOfAWall) {
  Random random(213);
  for (int i = 0; i < 20; ++i) {
    const Vec3 normal = random.direction(), push = random.point(5);
    const double depth = random.between(1e-4, 2e-3);
    const auto force = [&](double damping) {
      Scene scene;
      const Material material{.stiffness = 3000, .damping = damping};
      scene.add(Bench::plane(normal, depth, material));
      Bench bench(scene, 214);
      bench.tick(push);
      const Vec3 along = bench.tip_jacobian().transpose() * normal;
      const double mass = 1 / along.dot(bench.answer.M.inverse() * along);
      return std::pair(bench.contacts.list()[0].force, mass);
    };
    const double mass = force(0).second;
    const double bound = 0.34 * mass / T - std::min(0.2 * mass / T, std::sqrt(3000 * mass));
    const double at_bound = force(bound).first;
    EXPECT_NEAR(force(1e6).first, at_bound, 1e-9 * (1 + at_bound));
    EXPECT_NEAR(force(1.01 * bound).first, at_bound, 1e-9 * (1 + at_bound));
    EXPECT_GT(std::abs(force(0.5 * bound).first - at_bound), 1e-6) << "below it it counts";
  }
}

}  // namespace
}  // namespace limpid
