#include "core/touch/body_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/touch/body_motion.h"
#include "core/touch/collision_solid.h"
#include "core/touch/free_space.h"
#include "core/touch/kept_point.h"

namespace limpid {
namespace {

constexpr double kBeside = 1e-6;  // a corner this far from a face's normal is beside the face [m]
constexpr std::size_t kMostCorners = 128;  // of a hull whose corners are tested on a model
constexpr int kPointsOfPair = 4;           // points of a pair that Bullet keeps

// A body may pass what it goes by this part of both extents. It meets again what it is in where it
// gets deeper by this part of them [-]. Error of the way to where it meets something, and distance
// of points that meet at once [m].
constexpr double kPasses = 0.25, kDeeper = 0.02, kMeets = 1e-6, kAtOnce = 1e-5;

Vec3 middle(const btManifoldPoint& point) {
  return 0.5 *
         (from_bullet(point.getPositionWorldOnA()) + from_bullet(point.getPositionWorldOnB()));
}

}  // namespace

struct BodyGeometry::Inside {
  using Solid = CollisionSolid;
  struct Pair {
    Solid *a, *b;
    btCollisionAlgorithm* algorithm = nullptr;
    btPersistentManifold* manifold = nullptr;
    bool single = false;          // the two meet in one point at most
    bool refresh = true;          // its search does not remove points that are gone
    bool lowest = false;          // on a model: the lowest points of a are tested
    bool rolls = false;           // a round shape: points do not stay where they are on it
    std::array<bool, 4> meets{};  // whether it may meet so by its own geometry, by Meets
    int points = 0;               // points of its manifold
    FacePoints next{};            // its points in the middle of the tick, if they are known
    double goes = 0;              // way of a point until then, at most [m]
    double lost = 0;              // of its points that have just gone, as BodyContact has it [J]

    void clear() { manifold->clearManifold(), points = 0; }
  };

  explicit Inside(const Scene& scene);
  ~Inside();
  void add(const Scene& scene, std::size_t object, int body);
  void pair(Solid& a, Solid& b);
  static void keep_deepest(const Pair& pair);
  static Vec3 out_of_b(const Pair& pair, const btManifoldPoint& point);
  static bool face_below(const Solid& model, const btVector3& corner, const btVector3& middle,
                         double within, btVector3& normal, btScalar& distance);
  void find_lowest(const Pair& pair, PairPoints& result);
  enum class Meets : std::uint8_t { a_on_b, b_on_a, flat, sides };
  static std::optional<FacePoints> own_points(const Pair& pair, Meets meets, const Pose& a,
                                              const Pose& b, double near);
  struct Ways {
    std::array<Meets, 4> all{};
    std::size_t count = 0;
  };
  static Ways ways_to_meet(const Pair& pair, const Pose& a, const Pose& b, double near);
  bool deepest_in(Pair& pair, const FacePoints& own, PairPoints& result);
  bool find_own(Pair& pair, PairPoints& result);
  Pose next_pose(const Solid& solid) const;
  static void follow(const Pair& pair, BodyContact& contact);
  static void go_on(Pair& pair, std::span<BodyContact* const> before);
  void find(Pair& pair, PairPoints& result);
  void meet(Pair& pair);
  const btManifoldPoint* deepest(Pair& pair);
  // A body's way, as first_meeting() has it.
  struct Way {
    const Pose &from, &to;
    const Vec3& center;
    double times;
  };
  void meet_on(const Way& way, Pair& pair, Solid& moving, Meeting& first);
  static bool hides(const Pair& by, const Pair& pair, bool if_tied);
  static void hide_seams(std::span<Pair> of_ball);
  void take(Pair& pair, bool anew);
  static void share_lost(Pair& pair, std::span<BodyContact* const> contacts);
  BodyContact* fresh(const Pair& pair);
  bool allowed(const Pair& pair) const;

  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher;
  btDispatcherInfo info;
  std::vector<std::unique_ptr<Solid>> solids;
  std::vector<std::vector<Solid*>> of_body;
  std::vector<double> least_of_body, reach_of_body;  // of its solids [m]
  std::vector<std::array<int, 2>> apart;             // jointed bodies, which do not touch
  std::vector<Pair> pairs;
  std::vector<BodyContact> pool;
  std::vector<BodyContact*> free_ones, points, last;  // last: the points of the search before
  int left_out = 0;
  std::array<FacePoints::Point, kMostCorners> low_points;  // of find_lowest()
  std::span<const Pose> next;  // poses of bodies in the middle of the tick, during a search

  static btDefaultCollisionConstructionInfo sizes() {
    btDefaultCollisionConstructionInfo info;
    info.m_defaultMaxPersistentManifoldPoolSize = 8192;
    info.m_defaultMaxCollisionAlgorithmPoolSize = 16384;
    return info;
  }
};

BodyGeometry::Inside::Inside(const Scene& scene)
    : configuration(sizes()), dispatcher(&configuration), pool(kMost) {
  info.m_dispatchFunc = btDispatcherInfo::DISPATCH_DISCRETE;
  int body = 0;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].body) add(scene, i, body++);
  }
  of_body.resize(static_cast<std::size_t>(body));
  for (const auto& solid : solids) {
    of_body[static_cast<std::size_t>(solid->body)].push_back(solid.get());
  }
  for (const auto& parts : of_body) {
    double least = CollisionSolid::kWide, reach = 0;
    for (const Solid* solid : parts) {
      least = std::min(least, solid->least);
      reach = std::max(reach, solid->reach);
    }
    least_of_body.push_back(least);
    reach_of_body.push_back(reach);
  }
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (!scene.objects[i].body) add(scene, i, BodyContact::kStill);
  }
  const auto number = [&](const std::string& name) {
    int n = 0;
    for (const Object& object : scene.objects) {
      if (!object.body) continue;
      if (object.name == name) return n;
      ++n;
    }
    return BodyContact::kStill;
  };
  int n = 0;
  for (const Object& object : scene.objects) {
    if (!object.body) continue;
    if (object.body->joint && !object.body->joint->to.empty()) {
      apart.push_back({n, number(object.body->joint->to)});
    }
    ++n;
  }
  for (std::size_t i = 0; i < solids.size(); ++i) {
    for (std::size_t j = i + 1; j < solids.size(); ++j) {
      if (solids[i]->body != BodyContact::kStill && solids[i]->body != solids[j]->body) {
        pair(*solids[i], *solids[j]);
      }
    }
  }
  free_ones.reserve(kMost);
  points.reserve(kMost);
  last.reserve(kMost);
  for (auto c = pool.rbegin(); c != pool.rend(); ++c) free_ones.push_back(&*c);
}

BodyGeometry::Inside::~Inside() {
  for (Pair& p : pairs) {
    p.algorithm->~btCollisionAlgorithm();
    dispatcher.freeCollisionAlgorithm(p.algorithm);
  }
}

void BodyGeometry::Inside::add(const Scene& scene, std::size_t object, int body) {
  const Object& o = scene.objects[object];
  const auto number = static_cast<int>(object);
  const std::size_t before = solids.size();
  const auto add_part = [&](const Shape& shape, const Pose& in_object) {
    if (auto solid = collision_solid(shape, in_object, number, body))
      solids.push_back(std::move(solid));
  };
  add_part(o.shape, Pose::Identity());
  for (const BodyPart& part : o.parts) add_part(part.shape, part.pose);
  for (std::size_t i = before; i < solids.size(); ++i) {
    Solid& solid = *solids[i];
    const auto* plane = std::get_if<Plane>(&o.shape);
    if (plane != nullptr) {
      solid.level = to_bullet(plane->normal);
      solid.height = plane->normal.dot(Vec3(o.pose.translation()));
    }
    solid.at.setWorldTransform(
        to_bullet(plane != nullptr ? block_below(*plane, o.pose) : o.pose * solid.in_object));
    solid.bound();
  }
}

// Prepares a pair with all its memory, so that no tick has to.
void BodyGeometry::Inside::pair(Solid& a, Solid& b) {
  Pair p{&a, &b};
  if (!allowed(p)) return;
  const bool convex = a.shape->isConvex() && b.shape->isConvex();
  p.single = (a.ball() || b.ball()) && convex;
  p.rolls = a.rolls() || b.rolls() || ((a.ball() || b.ball()) && !convex);
  p.lowest = b.model && (a.rolls() || (!a.corners.empty() && a.corners.size() <= kMostCorners));
  const bool flat = !a.faces.empty() && !b.faces.empty() && !b.level && !(a.boxy() && b.boxy());
  p.meets = {!flat && a.meets_faces_of(b), !flat && b.meets_faces_of(a), flat,
             a.rolls() && b.rolls()};
  p.refresh = !convex || (a.ball() && b.ball()) || p.lowest;
  // Extra iterations: Bullet turns the shapes slightly, to find more points than the deepest.
  const int wanted = p.single ? 0 : kPointsOfPair;
  configuration.setConvexConvexMultipointIterations(wanted, wanted);
  const btCollisionObjectWrapper on_a(nullptr, a.shape.get(), &a.at, a.at.getWorldTransform(), -1,
                                      -1);
  const btCollisionObjectWrapper on_b(nullptr, b.shape.get(), &b.at, b.at.getWorldTransform(), -1,
                                      -1);
  p.algorithm = dispatcher.findAlgorithm(&on_a, &on_b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
  // The first use allocates the memory for its points.
  btManifoldResult result(&on_a, &on_b);
  p.algorithm->processCollision(&on_a, &on_b, info, &result);
  btManifoldArray all;
  p.algorithm->getAllContactManifolds(all);
  if (all.size() != 1)
    throw std::logic_error("no memory was reserved for the contacts of a pair of shapes");
  p.manifold = all[0];
  p.manifold->clearManifold();
  const double near = std::min(CollisionSolid::kNear, 0.1 * std::min(a.least, b.least));
  p.manifold->setContactBreakingThreshold(near);
  p.manifold->setContactProcessingThreshold(near);
  pairs.push_back(p);
}

bool BodyGeometry::Inside::allowed(const Pair& pair) const {
  return std::ranges::none_of(apart, [&](const std::array<int, 2>& two) {
    return (two[0] == pair.a->body && two[1] == pair.b->body) ||
           (two[1] == pair.a->body && two[0] == pair.b->body);
  });
}

// Normal of a point. Bullet may have swapped the pair.
Vec3 BodyGeometry::Inside::out_of_b(const Pair& p, const btManifoldPoint& point) {
  return (p.manifold->getBody0() == &p.a->at ? 1.0 : -1.0) * from_bullet(point.m_normalWorldOnB);
}

// Keeps only the deepest point of a ball: older ones that Bullet keeps beside it would turn the
// ball.
void BodyGeometry::Inside::keep_deepest(const Pair& p) {
  btPersistentManifold& m = *p.manifold;
  while (m.getNumContacts() > 1) {
    m.removeContactPoint(
        m.getContactPoint(0).getDistance() > m.getContactPoint(1).getDistance() ? 0 : 1);
  }
}

// Treats a new point of a pair as one that has just gone, moved, and keeps its state: the nearest
// of them first. Otherwise bodies on points that come and go would sink; of two balls Bullet makes
// a new point every time.
void BodyGeometry::Inside::go_on(Pair& p, std::span<BodyContact* const> before) {
  constexpr double kSame = 1e-5;  // a point in the same order that moved less is the same [m]
  btPersistentManifold& m = *p.manifold;
  bool all = before.size() == static_cast<std::size_t>(m.getNumContacts());
  for (std::size_t i = 0; all && i < before.size(); ++i) {
    const btManifoldPoint& point = m.getContactPoint(static_cast<int>(i));
    all = point.m_userPersistentData == before[i] ||
          (point.m_userPersistentData == nullptr &&
           (before[i]->point - middle(point)).squaredNorm() < kSame * kSame);
  }
  if (all) {
    for (std::size_t i = 0; i < before.size(); ++i)
      m.getContactPoint(static_cast<int>(i)).m_userPersistentData = before[i];
    return;
  }
  std::array<btManifoldPoint*, kPointsOfPair> fresh{};
  std::array<BodyContact*, kPointsOfPair> gone{};
  std::size_t points = 0, contacts = before.size();
  std::ranges::copy(before, gone.begin());
  for (int i = 0; i < m.getNumContacts(); ++i) {
    btManifoldPoint& point = m.getContactPoint(i);
    if (point.m_userPersistentData == nullptr) {
      fresh[points++] = &point;
    } else {
      const auto left =
          std::remove(gone.begin(), gone.begin() + static_cast<std::ptrdiff_t>(contacts),
                      static_cast<BodyContact*>(point.m_userPersistentData));
      contacts = static_cast<std::size_t>(left - gone.begin());
    }
  }
  for (; points > 0 && contacts > 0; --points, --contacts) {
    std::size_t point = 0, contact = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points; ++i) {
      const Vec3 at = middle(*fresh[i]);
      for (std::size_t k = 0; k < contacts; ++k) {
        const double away = (gone[k]->point - at).squaredNorm();
        if (away >= least) continue;
        least = away;
        point = i;
        contact = k;
      }
    }
    fresh[point]->m_userPersistentData = gone[contact];
    std::swap(fresh[point], fresh[points - 1]);
    std::swap(gone[contact], gone[contacts - 1]);
  }
  for (std::size_t i = 0; i < contacts; ++i) p.lost += gone[i]->lost;
}

// Finds the face of a model below a corner of a box that is nearest to it; false if there is none.
// `middle`: of the box, on the side that counts.
bool BodyGeometry::Inside::face_below(const Solid& model, const btVector3& corner,
                                      const btVector3& middle, double within, btVector3& normal,
                                      btScalar& distance) {
  const TriangleMesh& mesh = *model.model->mesh;
  const double size = model.model->size;
  const btTransform& at = model.at.getWorldTransform();
  const auto in_mesh = [&](const btVector3& v) {
    return Vec3(from_bullet(at.invXform(v)) / size - mesh.middle());
  };
  const Vec3 p = in_mesh(corner);
  MeshPoint foot;
  if (!mesh.nearest(p, within / size, MeshPoint::kNone, foot)) return false;
  const double out = foot.normal.dot(in_mesh(middle) - foot.point) < 0 ? -1 : 1;
  const Vec3 way = p - foot.point;
  const double height = out * foot.normal.dot(way);
  const bool beside = (way - foot.normal.dot(way) * foot.normal).norm() > kBeside / size;
  normal = at.getBasis() * to_bullet(Vec3(out * foot.normal));
  distance = size * height;
  return !beside;
}

// Finds the lowest points of a solid that are near to faces of a model, four at most: corners, or
// at each end of a rod the lowest points by the face that is nearest to it.
void BodyGeometry::Inside::find_lowest(const Pair& p, PairPoints& result) {
  const btTransform& at = p.a->at.getWorldTransform();
  const btVector3 middle = at * to_bullet(p.a->middle);
  const btScalar near = p.manifold->getContactBreakingThreshold();
  const double within = std::max(near, 0.5 * p.a->least);
  std::size_t count = 0;
  const auto try_at = [&](const btVector3& point) {
    btVector3 normal;
    btScalar distance = 0;
    if (!face_below(*p.b, point, middle, within, normal, distance)) return;
    if (distance <= near) low_points[count++] = {from_bullet(point), from_bullet(normal), distance};
  };
  for (const Vec3& corner : p.a->corners) try_at(at * to_bullet(corner));
  if (p.a->rolls()) {
    const Rod one = p.a->rod(from_bullet(at));
    for (const double side : {-1.0, 1.0}) {
      const Vec3 end = one.center + side * one.half * one.axis;
      btVector3 normal;
      btScalar distance = 0;
      if (!face_below(*p.b, to_bullet(end), middle, one.radius + CollisionSolid::kNear, normal,
                      distance))
        continue;
      const EndPoints ends = end_points(one, end, from_bullet(normal));
      for (const Vec3& point : ends.all()) try_at(to_bullet(point));
    }
  }
  result.take(widest_of(std::span(low_points).first(count)));
}

// Returns the points of a pair at these poses, on its first and with normals out of its second, if
// it meets in this way.
std::optional<FacePoints> BodyGeometry::Inside::own_points(const Pair& p, Meets meets,
                                                           const Pose& a, const Pose& b,
                                                           double near) {
  if (meets == Meets::sides) return points_of_sides(p.a->rod(a), p.b->rod(b), near);
  if (meets == Meets::flat) return points_of_hulls(p.a->hull(a), p.b->hull(b), near);
  const bool first = meets == Meets::a_on_b;
  const Solid &one = first ? *p.a : *p.b, &flat = first ? *p.b : *p.a;
  const auto solid = one.convex(first ? a : b);
  const auto face = flat.face_towards(*solid, first ? b : a);
  auto found = face ? points_on_face(*solid, *face, near) : std::nullopt;
  if (!found || first) return found;
  turn_round(*found);
  return found;
}

// Returns the ways in which a pair may meet by its own geometry, the likeliest first: on the face
// that the other solid is furthest from, or least deep in. A face that it is much deeper in is none
// that it meets.
BodyGeometry::Inside::Ways BodyGeometry::Inside::ways_to_meet(const Pair& p, const Pose& a,
                                                              const Pose& b, double near) {
  Ways ways;
  const auto may = [&](Meets meets) { return p.meets[static_cast<std::size_t>(meets)]; };
  const auto add = [&](Meets meets) { ways.all[ways.count++] = meets; };
  if (may(Meets::a_on_b) && may(Meets::b_on_a)) {
    const auto height = [](const Solid& one, const Pose& at, const Solid& flat, const Pose& on) {
      const auto solid = one.convex(at);
      const auto face = flat.face_towards(*solid, on);
      return face ? height_above(*solid, *face) : -std::numeric_limits<double>::infinity();
    };
    const double on_b = height(*p.a, a, *p.b, b), on_a = height(*p.b, b, *p.a, a);
    if (on_b >= on_a - near) add(Meets::a_on_b);
    if (on_a >= on_b - near) add(Meets::b_on_a);
    if (on_a > on_b && ways.count == 2) std::swap(ways.all[0], ways.all[1]);
  } else if (may(Meets::a_on_b) || may(Meets::b_on_a)) {
    add(may(Meets::a_on_b) ? Meets::a_on_b : Meets::b_on_a);
  }
  if (may(Meets::flat)) add(Meets::flat);
  if (may(Meets::sides)) add(Meets::sides);
  return ways;
}

// Whether a pair is nowhere much deeper than in these points, as Bullet finds it; else it takes
// Bullet's points.
bool BodyGeometry::Inside::deepest_in(Pair& p, const FacePoints& own, PairPoints& result) {
  constexpr double kAlike = 0.9;  // part of the depth that Bullet finds
  double known = 2 * kMargin;
  for (const FacePoints::Point& point : own.all())
    known = std::max(known, 2 * kMargin - point.distance);
  // Beside the points that are there Bullet looks for the deepest alone.
  const auto search = [&] {
    p.algorithm->processCollision(result.getBody0Wrap(), result.getBody1Wrap(), info, &result);
  };
  search();
  if (known >= -kAlike * result.deepest) return true;
  p.manifold->clearManifold();
  search();
  return false;
}

// Finds the points where a pair meets by its own geometry, and where they are in the middle of the
// tick; false if it does not meet so.
bool BodyGeometry::Inside::find_own(Pair& p, PairPoints& result) {
  const Pose a = from_bullet(p.a->at.getWorldTransform());
  const Pose b = from_bullet(p.b->at.getWorldTransform());
  const double near = p.manifold->getContactBreakingThreshold();
  p.next.count = 0;
  const Ways ways = ways_to_meet(p, a, b, near);
  for (const Meets meets : std::span(ways.all).first(ways.count)) {
    const auto own = own_points(p, meets, a, b, near);
    if (!own) continue;
    if (!own->sure && !deepest_in(p, *own, result)) return true;
    result.take(*own);
    // Corners go with their body; where round things meet depends on how they roll.
    if (own->count == 0 || next.empty() || !(p.a->round || p.b->round)) return true;
    const Pose next_a = next_pose(*p.a), next_b = next_pose(*p.b);
    p.next =
        own_points(p, meets, next_a, next_b, near + CollisionSolid::kNear).value_or(FacePoints{});
    // A point may go as far as rolling takes it; further off it is another one.
    const double turned =
        (next_a.linear() - a.linear()).norm() + (next_b.linear() - b.linear()).norm();
    p.goes =
        2 * ((next_a.translation() - a.translation()).norm() +
             (next_b.translation() - b.translation()).norm() + turned * (p.a->reach + p.b->reach));
    return true;
  }
  return false;
}

Pose BodyGeometry::Inside::next_pose(const Solid& solid) const {
  if (solid.body == BodyContact::kStill) return from_bullet(solid.at.getWorldTransform());
  return next[static_cast<std::size_t>(solid.body)] * solid.in_object;
}

// Tells a contact where it goes within the tick.
void BodyGeometry::Inside::follow(const Pair& p, BodyContact& c) {
  c.goes_on = false;
  if (p.next.count == 0) return;
  double least = p.goes * p.goes;
  for (const auto& point : p.next.all()) {
    const Vec3 there = 0.5 * (point.at + point.on_other());
    const double away = (there - c.point).squaredNorm();
    if (away > least) continue;
    least = away;
    c.goes_on = true;
    c.next_point = there;
    c.next_normal = point.normal;
  }
}

void BodyGeometry::Inside::find(Pair& p, PairPoints& result) {
  result.setPersistentManifold(p.manifold);
  if (std::ranges::count(p.meets, true) > 0 && find_own(p, result)) return;
  p.next.count = 0;
  if (p.lowest) find_lowest(p, result);
  result.only_edges = p.lowest;
  p.algorithm->processCollision(result.getBody0Wrap(), result.getBody1Wrap(), info, &result);
}

void BodyGeometry::Inside::meet(Pair& p) {
  std::array<BodyContact*, kPointsOfPair> before{};
  std::size_t count = 0;
  for (int i = 0; i < p.manifold->getNumContacts(); ++i) {
    auto* c = static_cast<BodyContact*>(p.manifold->getContactPoint(i).m_userPersistentData);
    if (c != nullptr) before[count++] = c;
  }
  const btCollisionObjectWrapper on_a(nullptr, p.a->shape.get(), &p.a->at,
                                      p.a->at.getWorldTransform(), -1, -1);
  const btCollisionObjectWrapper on_b(nullptr, p.b->shape.get(), &p.b->at,
                                      p.b->at.getWorldTransform(), -1, -1);
  if (p.rolls) p.manifold->clearManifold();
  PairPoints result(&on_a, &on_b);
  find(p, result);
  if (p.refresh) result.refreshContactPoints();
  if (p.single) keep_deepest(p);
  p.points = p.manifold->getNumContacts();
  go_on(p, {before.data(), count});
}

// The deepest point of a pair as it stands, in place of its points; null: the two do not touch.
const btManifoldPoint* BodyGeometry::Inside::deepest(Pair& p) {
  p.manifold->clearManifold();
  if (!p.a->overlaps(*p.b)) return nullptr;
  const btCollisionObjectWrapper on_a(nullptr, p.a->shape.get(), &p.a->at,
                                      p.a->at.getWorldTransform(), -1, -1);
  const btCollisionObjectWrapper on_b(nullptr, p.b->shape.get(), &p.b->at,
                                      p.b->at.getWorldTransform(), -1, -1);
  PairPoints result(&on_a, &on_b);
  find(p, result);
  const btManifoldPoint* most = nullptr;
  for (int i = 0; i < p.manifold->getNumContacts(); ++i) {
    const btManifoldPoint& point = p.manifold->getContactPoint(i);
    if (point.getDistance() < (most != nullptr ? most->getDistance() : 0)) most = &point;
  }
  return most;
}

// Looks along the way in steps that pass nothing, and then for the place of the meeting.
void BodyGeometry::Inside::meet_on(const Way& way, Pair& p, Solid& moving, Meeting& first) {
  const double thick = p.a->thick() + p.b->thick();
  const double turned = (way.to.linear() - way.from.linear()).norm();  // at least the angle
  const double length =
      (way.to * way.center - way.from * way.center).norm() + turned * moving.reach;
  if (way.times * first.part * length <= kPasses * thick) return;
  const double steps = std::ceil(first.part * length / (kPasses * thick));
  const auto deepest_at = [&](double part) {
    const Pose there = pose_between(way.from, way.to, way.center, part);
    moving.at.setWorldTransform(to_bullet(there * moving.in_object));
    moving.bound();
    return deepest(p);
  };
  const auto depth = [](const btManifoldPoint* point) {
    return point != nullptr ? -point->getDistance() : 0;
  };
  double most = depth(deepest_at(0));
  if (most > 0) most += kDeeper * thick;
  const double last_part = first.part;
  for (double step = 1; step <= steps; ++step) {
    double free = (step - 1) / steps * last_part, meets = step / steps * last_part;
    if (!(depth(deepest_at(meets)) > most)) continue;
    while ((meets - free) * length > kMeets) {
      const double half = 0.5 * (free + meets);
      (depth(deepest_at(half)) > most ? meets : free) = half;
    }
    const btScalar met = -depth(deepest_at(meets));
    first = {meets, p.a->body, p.b->body, p.a->object, p.b->object};
    const bool swapped = p.manifold->getBody0() != &p.a->at;  // Bullet may have swapped the pair
    for (int i = 0; i < p.manifold->getNumContacts(); ++i) {
      const btManifoldPoint& point = p.manifold->getContactPoint(i);
      if (point.getDistance() > met + kAtOnce) continue;
      first.points[first.count++] = {middle(point),
                                     (swapped ? -1.0 : 1.0) * from_bullet(point.m_normalWorldOnB)};
    }
    return;
  }
}

BodyContact* BodyGeometry::Inside::fresh(const Pair& p) {
  if (free_ones.empty()) return nullptr;
  BodyContact* c = free_ones.back();
  free_ones.pop_back();
  *c = {.a = p.a->body, .b = p.b->body, .object_a = p.a->object, .object_b = p.b->object};
  c->round_a = p.a->round ? &*p.a->round : nullptr;
  c->round_b = p.b->round ? &*p.b->round : nullptr;
  return c;
}

// The energy that a pair lost in one point pays for the depth of all: bodies that turn as they hit
// each other meet in one point and come to rest on others.
void BodyGeometry::Inside::share_lost(Pair& p, std::span<BodyContact* const> contacts) {
  const double gone = std::exchange(p.lost, 0);
  if (contacts.empty()) return;
  contacts.front()->lost += gone;
  double lost = 0, deep = 0;
  const auto not_pressed = [](const BodyContact& c) { return std::max(0.0, c.depth - c.pressed); };
  for (const BodyContact* c : contacts) {
    lost += c->lost;
    deep += not_pressed(*c);
  }
  if (!(lost > 0 && deep > 0)) return;
  for (BodyContact* c : contacts) c->lost = lost * not_pressed(*c) / deep;
}

// Whether the surface that a ball is deeper in reaches above the point where the ball meets another
// solid: there the other solid's edge is no edge. Round solids bend away from the point. `if_tied`:
// the answer where both are as deep.
bool BodyGeometry::Inside::hides(const Pair& by, const Pair& p, bool if_tied) {
  if (by.points != 1 || !by.single || !p.single || by.b->round || by.b->body != p.b->body) {
    return false;
  }
  const btManifoldPoint &over = by.manifold->getContactPoint(0),
                        &point = p.manifold->getContactPoint(0);
  const double deeper = point.getDistance() - over.getDistance();
  if (deeper < 0 || (deeper == 0 && !if_tied)) return false;
  // Both points lie on lines through the ball's centre.
  const double radius = by.a->radius;
  const double height = radius + over.getDistance() -
                        (radius + point.getDistance()) * out_of_b(by, over).dot(out_of_b(p, point));
  return height <= kMeeting;
}

// Takes away the points of a ball that are hidden, so that it rolls over the seam of level surfaces
// as on one. The point that stays goes on with the state of the one that goes.
void BodyGeometry::Inside::hide_seams(std::span<Pair> of_ball) {
  for (Pair& p : of_ball) {
    if (p.points != 1) continue;
    const auto by = std::ranges::find_if(
        of_ball, [&](const Pair& other) { return &other != &p && hides(other, p, &other < &p); });
    if (by == of_ball.end()) continue;
    void*& state = by->manifold->getContactPoint(0).m_userPersistentData;
    auto* c = static_cast<BodyContact*>(p.manifold->getContactPoint(0).m_userPersistentData);
    by->lost += std::exchange(p.lost, 0) + (c != nullptr && state != nullptr ? c->lost : 0);
    if (c != nullptr && state == nullptr) {
      c->object_b = by->b->object;
      c->round_b = nullptr;
      state = c;
    }
    p.clear();
  }
}

// Takes in the points of a pair. `anew`: they are found in this tick.
void BodyGeometry::Inside::take(Pair& p, bool anew) {
  if (p.points == 0) p.lost = 0;
  const std::size_t before = points.size();
  for (int i = 0; i < p.points; ++i) {
    btManifoldPoint& point = p.manifold->getContactPoint(i);
    auto* c = static_cast<BodyContact*>(point.m_userPersistentData);
    if (c == nullptr) {
      c = fresh(p);
      if (c == nullptr) {
        ++left_out;
        continue;
      }
      point.m_userPersistentData = c;
    }
    c->normal = out_of_b(p, point);
    c->point = middle(point);
    c->depth = -point.getDistance();
    follow(p, *c);
    c->seen = true;
    points.push_back(c);  // its capacity covers the whole pool
  }
  if (anew && p.points > 0) share_lost(p, std::span(points).subspan(before));
}

BodyGeometry::BodyGeometry(const Scene& scene) : in_(std::make_unique<Inside>(scene)) {}
BodyGeometry::~BodyGeometry() = default;
BodyGeometry::BodyGeometry(BodyGeometry&&) noexcept = default;
BodyGeometry& BodyGeometry::operator=(BodyGeometry&&) noexcept = default;

void BodyGeometry::place(int body, const Pose& pose) {
  for (Inside::Solid* solid : in_->of_body[static_cast<std::size_t>(body)]) {
    solid->at.setWorldTransform(to_bullet(pose * solid->in_object));
    solid->bound();
  }
}

void BodyGeometry::search(std::span<const std::uint8_t> awake, std::span<const Pose> next) {
  Inside& in = *in_;
  in.next = next;
  std::swap(in.points, in.last);
  in.points.clear();
  in.left_out = 0;
  for (BodyContact* c : in.last) c->seen = false;
  const auto moves = [&](const Inside::Solid& s) {
    return s.body != BodyContact::kStill && awake[static_cast<std::size_t>(s.body)] != 0;
  };
  const auto anew = [&](const Inside::Pair& p) { return moves(*p.a) || moves(*p.b); };
  const auto find = [&](Inside::Pair& p) {
    if (p.a->overlaps(*p.b)) {
      in.meet(p);
    } else if (p.points > 0) {
      p.clear();
    }
  };
  for (auto p = in.pairs.begin(); p != in.pairs.end();) {
    const bool found = anew(*p);
    if (!found && p->points == 0) {
      p++->lost = 0;
      continue;
    }
    if (found) find(*p);
    auto to = p + 1;
    if (p->single && p->a->ball()) {
      for (; to != in.pairs.end() && to->a == p->a; ++to) {
        if (anew(*to)) find(*to);
      }
      Inside::hide_seams({p, to});
    }
    for (; p != to; ++p) in.take(*p, anew(*p));
  }
  for (BodyContact* c : in.last) {
    if (!c->seen) in.free_ones.push_back(c);
  }
  in.next = {};
}

bool BodyGeometry::may_pass(int body, double way, double turned) const {
  const auto at = static_cast<std::size_t>(body);
  return way + turned * in_->reach_of_body[at] > kPasses * in_->least_of_body[at];
}

Meeting BodyGeometry::first_meeting(int body, const Pose& from, const Pose& to, const Vec3& center,
                                    double times) {
  Meeting first;
  for (Inside::Solid* solid : in_->of_body[static_cast<std::size_t>(body)]) {
    solid->at.setWorldTransform(to_bullet(from * solid->in_object));
    solid->bound();
    btVector3 low = solid->low, high = solid->high;  // of the box around all of its way
    solid->at.setWorldTransform(to_bullet(to * solid->in_object));
    solid->bound();
    low.setMin(solid->low);
    high.setMax(solid->high);
    for (Inside::Pair& p : in_->pairs) {
      if ((p.a != solid && p.b != solid) || p.b->level) continue;
      if (!(p.a == solid ? *p.b : *p.a).overlaps(low, high)) continue;
      // Puts its points aside.
      std::array<btManifoldPoint, kPointsOfPair> points;
      const int count = p.manifold->getNumContacts();
      for (int i = 0; i < count; ++i) {
        points[static_cast<std::size_t>(i)] = p.manifold->getContactPoint(i);
      }
      in_->meet_on({from, to, center, times}, p, *solid, first);
      p.manifold->clearManifold();
      for (int i = 0; i < count; ++i) {
        p.manifold->addManifoldPoint(points[static_cast<std::size_t>(i)]);
      }
    }
  }
  return first;
}

bool BodyGeometry::any_round() const {
  return std::ranges::any_of(in_->solids,
                             [](const auto& solid) { return solid->round.has_value(); });
}

std::span<BodyContact* const> BodyGeometry::points() const { return in_->points; }
int BodyGeometry::left_out() const { return in_->left_out; }

bool BodyGeometry::near(int a, int b) const {
  for (const Inside::Solid* one : in_->of_body[static_cast<std::size_t>(a)]) {
    for (const Inside::Solid* two : in_->of_body[static_cast<std::size_t>(b)]) {
      if (one->overlaps(*two)) return true;
    }
  }
  return false;
}

void BodyGeometry::forget() {
  for (Inside::Pair& p : in_->pairs) p.clear();
  in_->points.clear();
  in_->left_out = 0;
  in_->free_ones.clear();
  for (auto c = in_->pool.rbegin(); c != in_->pool.rend(); ++c) {
    *c = {};
    in_->free_ones.push_back(&*c);
  }
}

void BodyGeometry::write(std::vector<double>& into) const {
  const auto& pairs = in_->pairs;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const btPersistentManifold& m = *pairs[k].manifold;
    for (int i = 0; i < m.getNumContacts(); ++i) {
      const btManifoldPoint& point = m.getContactPoint(i);
      const auto* c = static_cast<const BodyContact*>(point.m_userPersistentData);
      if (c == nullptr) continue;
      into.push_back(static_cast<double>(k));
      KeptPoint::write(point, m.getBody0() != &pairs[k].a->at, *c, into);
    }
  }
}

std::span<const double> BodyGeometry::read(std::span<const double> from) {
  constexpr std::size_t kNumbers = 1 + KeptPoint::kNumbers;
  forget();
  for (; from.size() >= kNumbers; from = from.subspan(kNumbers)) {
    const double pair = from[0];
    if (!(pair >= 0 && pair < static_cast<double>(in_->pairs.size()))) break;
    Inside::Pair& p = in_->pairs[static_cast<std::size_t>(pair)];
    if (p.manifold->getNumContacts() == kPointsOfPair) break;
    const KeptPoint kept(from.subspan(1));
    p.manifold->setBodies(kept.turned ? &p.b->at : &p.a->at, kept.turned ? &p.a->at : &p.b->at);
    const int at = p.manifold->addManifoldPoint(kept.point);
    p.points = p.manifold->getNumContacts();
    BodyContact* c = in_->fresh(p);
    if (c == nullptr) break;
    c->point = middle(kept.point);
    KeptPoint::read(from.subspan(1), *c);
    p.manifold->getContactPoint(at).m_userPersistentData = c;
    in_->points.push_back(c);
  }
  return from;
}

}  // namespace limpid
