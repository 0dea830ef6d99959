#include "core/touch/contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace limpid {
namespace {

// Spacing of the balls that replace a capsule, in radii, and their largest number.
constexpr double kSpacing = 0.75;
constexpr int kMostBalls = 24;
// Distance below which a body does not sleep [m].
constexpr double kWakes = 5e-3;
// Reach of the tip's magnet [m].
constexpr double kPicksUp = 5e-3;

// Cosine between normals below which surfaces are at right angles: each holds by itself [-].
constexpr double kSquare = 1e-9;

// Depth below the plane that it is deepest under, or else the nearest one [m].
double deepest(const FreeSpace& space, const Vec3& x) {
  double depth = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < space.count(); ++i) {
    depth = std::max(depth, space.offset(i) - space.normal(i).dot(x));
  }
  return depth;
}

// Checks a joint's index: the scene may have been read for another arm. Errors:
// std::invalid_argument.
void check_index(int index, const ArmDescription& arm, const char* what) {
  if (index >= 0 && index < arm.dof()) return;
  throw std::invalid_argument(std::string(what) + " of the scene is at joint " +
                              std::to_string(index + 1) + ", and the arm has " +
                              std::to_string(arm.dof()));
}

}  // namespace

template <int N>
Contacts<N>::Contacts(const ArmDescription& arm, const Scene& scene)
    : stiffest_(stiffest_surface(scene)), rub_(has_rubbing_surfaces(scene)) {
  const Vec3 tip = arm.tip.translation();
  probes_.push_back({"tip", arm.dof() - 1, tip, tip, scene.tip_radius});
  for (const Probe& probe : scene.probes) {
    check_index(probe.link, arm, "a probe");
    probes_.push_back(probe);
  }
  if (count_bodies(scene) > 0) world_ = std::make_unique<BodyWorld>(scene);
  magnet_.J = Jacobian<N>::Zero(3, arm.dof());
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    const int body = world_ ? world_->body_of(i) : BodyContact::kStill;
    if (const auto* stop = std::get_if<JointStop>(&object.shape)) {
      check_index(stop->joint, arm, "a stop");
      stops_.push_back({*stop, {.stiffness = object.material.stiffness}});
      continue;
    }
    if (body != BodyContact::kStill) of_bodies_.push_back(object.material);
    add_solid(object.shape, Pose::Identity(), object, body);
    for (const BodyPart& part : object.parts) add_solid(part.shape, part.pose, object, body);
  }
  Contact<N> empty;
  empty.gradient = Vec<N>::Zero(arm.dof());
  for (const Probe& probe : probes_) touches_.emplace_back(probe.radius, solids_.size());
  contacts_.assign(solids_.size() * probes_.size() + stops_.size(), empty);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (!has_shape<Mesh>(scene.objects[i])) continue;
    const int body = world_ ? world_->body_of(i) : BodyContact::kStill;
    add_mesh_contacts(scene.objects[i], body, arm);
  }
  for (std::size_t k = 0; solids_.size() > 1 && k < probes_.size(); ++k) {
    corners_.emplace_back(SolidCorner(probes_[k].radius), Material{}, arm.dof());
    corners_.back().link = probes_[k].link;
    corners_.back().id = contacts_.size() + meshes_.size() + k;
  }
  memories_.resize(contacts_.size() + meshes_.size() + corners_.size());
  balls_.resize(probes_.size());
  for (MeshContact<N>& contact : meshes_) {
    if (contact.probe >= 0) balls_[static_cast<std::size_t>(contact.probe)].push_back(&contact);
  }
  for (std::size_t k = 0; k < probes_.size(); ++k) {
    std::vector<const MeshTouch*> touches;
    for (const MeshContact<N>* contact : balls_[k]) touches.push_back(&contact->touch);
    touches_[k].set_meshes(std::move(touches));
  }
}

template <int N>
void Contacts<N>::add_solid(const Shape& shape, const Pose& in_object, const Object& object,
                            int body) {
  std::visit(
      [&]<class S>(const S& solid) {
        if constexpr (!std::is_same_v<S, JointStop> && !std::is_same_v<S, Mesh>) {
          solids_.push_back({solid, object.pose * in_object, object.material, body, in_object});
        }
      },
      shape);
}

template <int N>
void Contacts<N>::add_mesh_contacts(const Object& mesh, int body, const ArmDescription& arm) {
  for (const Probe& probe : probes_) {
    const double length = (probe.to - probe.from).norm();
    const double apart = std::max(kSpacing * probe.radius, length / (kMostBalls - 1));
    const int balls = length > 0 ? 1 + static_cast<int>(std::ceil(length / apart)) : 1;
    for (int i = 0; i < balls; ++i) {
      const double part = balls > 1 ? static_cast<double>(i) / (balls - 1) : 0;
      MeshContact<N> contact(mesh, probe.radius, arm.dof());
      contact.id = contacts_.size() + meshes_.size();
      contact.link = probe.link;
      contact.body = body;
      if (length == 0) contact.probe = static_cast<int>(&probe - probes_.data());
      contact.on_link = probe.from + part * (probe.to - probe.from);
      meshes_.push_back(std::move(contact));
    }
  }
}

template <int N>
void Contacts<N>::place(const Arm<N>& arm, const typename Arm<N>::Frames& f, const Vec<N>& x) {
  magnet_.body = BodyContact::kStill;
  for (MeshContact<N>& contact : meshes_) {
    contact.center = Arm<N>::point(f, contact.link, contact.on_link);
    contact.touch.place(contact.center);
    contact.force.setZero();
  }
  for (SolidTouch& touch : touches_) touch.forget();
  forget();
  find(arm, f, x, 0);
  for (Contact<N>& contact : contacts_) contact.force = 0;
}

template <int N>
void Contacts<N>::take_over(const Contacts& other) {
  if (world_ && other.world_) world_->take_over(*other.world_);
  const auto alike = [](const Solid& one, const Solid& two) {
    const bool moves = one.body != BodyContact::kStill;
    return one.body == two.body && one.shape == two.shape &&
           (moves ? one.in_body.matrix() == two.in_body.matrix()
                  : one.pose.matrix() == two.pose.matrix());
  };
  // Keeps the sides on which probes are; of other solids, and beside meshes, the nearest ones will
  // do. place() saw bodies where they start, so its sides are not those of now.
  const bool same =
      touches_.size() == other.touches_.size() && std::ranges::equal(solids_, other.solids_, alike);
  for (std::size_t k = 0; k < touches_.size(); ++k) {
    if (same && balls_[k].empty() && other.balls_[k].empty()) {
      touches_[k] = other.touches_[k];
    } else {
      touches_[k].forget();
    }
  }
  for (MeshContact<N>& mine : meshes_) {
    for (const MeshContact<N>& theirs : other.meshes_) {
      if (!mine.touch.same_surface(theirs.touch) || mine.link != theirs.link ||
          mine.on_link != theirs.on_link) {
        continue;
      }
      mine.touch.take_over(theirs.touch);
      mine.center = theirs.center;
      memories_[mine.id] = other.memories_[theirs.id];
    }
  }
}

template <int N>
bool Contacts<N>::recoverable() const {
  const auto mesh = [](const MeshContact<N>& c) { return c.touch.recoverable(); };
  const auto solid = [](const SolidTouch& touch) { return touch.recoverable(); };
  return std::ranges::all_of(meshes_, mesh) && std::ranges::all_of(touches_, solid);
}

template <int N>
void Contacts<N>::add(const Contact<N>& found, const Arm<N>& arm,
                      const typename Arm<N>::Frames& f) {
  Contact<N>& c = contacts_[count_++];
  c = found;
  c.touching = found.depth > 0;
  Jacobian<N> J;
  arm.point_jacobian(f, found.link, found.point, J);
  c.gradient.noalias() = -J.transpose() * found.normal;
}

template <int N>
void Contacts<N>::find(const Arm<N>& arm, const typename Arm<N>::Frames& f, const Vec<N>& x,
                       double T) {
  if (world_) follow_bodies();
  count_ = 0;
  for (std::size_t k = 0; k < probes_.size(); ++k) {
    const Vec3 from = Arm<N>::point(f, probes_[k].link, probes_[k].from);
    const Vec3 to = Arm<N>::point(f, probes_[k].link, probes_[k].to);
    touches_[k].look(solids_, from, to);
  }
  // First those meshes that do not hold the ball: they may take it over from what does.
  for (MeshContact<N>& contact : meshes_) {
    const Vec3 before = contact.center;
    contact.center = Arm<N>::point(f, contact.link, contact.on_link);
    // Planes that are right in the middle of the tick give and take equally over it.
    contact.ahead = contact.center + 0.5 * (contact.center - before);
    contact.holds = contact.probe >= 0 && contact.touch.holds(contact.center);
  }
  if (!meshes_.empty()) follow(false, T);
  for (std::size_t k = 0; k < probes_.size(); ++k) {
    const std::size_t first = k * solids_.size();
    touches_[k].settle(solids_);
    if (!corners_.empty()) look_at_corner(k, arm, f);
    for (const auto& near : touches_[k].near()) {
      const Solid& solid = solids_[near.solid];
      const double depth = probes_[k].radius - near.surface.distance;
      if (solid.body != BodyContact::kStill && depth > -kWakes) world_->touch(solid.body);
      if (!near.counts || in_corner(k, near)) continue;
      add({depth,
           {},
           solid.material,
           near.point,
           near.surface.normal,
           probes_[k].link,
           first + near.solid,
           solid.body},
          arm, f);
    }
  }
  if (!meshes_.empty()) follow(true, T);
  std::size_t id = probes_.size() * solids_.size();
  for (const auto& [stop, material] : stops_) {
    Contact<N>& c = contacts_[count_++];
    c.depth = stop.direction * (x[stop.joint] - stop.angle);
    c.gradient.setZero();
    c.gradient[stop.joint] = stop.direction;
    c.material = material;
    c.normal.setZero();
    c.friction.setZero();
    c.id = id++;
    c.body = BodyContact::kStill;
    c.touching = c.depth > 0;
  }
  for (MeshContact<N>& contact : meshes_) {
    look(contact, arm, f);
    if (contact.body != BodyContact::kStill && contact.touch.near()) world_->touch(contact.body);
  }
  if (rub_) pass_on();
  if (world_ && T > 0) look_for_magnet(arm, f);
  potential_ = stored();
  if (world_ && T > 0) world_->begin(T);
}

// Lifts a point out of the meshes that hold the centre of a ball, or, `whole`, the ball.
template <int N>
Vec3 Contacts<N>::lifted_out_of_meshes(Vec3 point, const Vec3& centre, std::size_t probe,
                                       const MeshContact<N>* except, bool whole) const {
  const double above = kAbove + (whole ? probes_[probe].radius : 0);
  for (const MeshContact<N>* other : balls_[probe]) {
    if (other == except || !other->touch.near() || other->touch.held()) continue;
    if (whole || other->touch.holds(centre)) point = other->touch.lifted(point, above);
  }
  return point;
}

// Free place of a mesh's ball: lifted out of what else holds its centre, or, `whole`, the ball.
template <int N>
Vec3 Contacts<N>::free_place(const MeshContact<N>& of, bool whole) const {
  const auto k = static_cast<std::size_t>(of.probe);
  const Vec3 out = touches_[k].lifted(solids_, of.center, whole);
  return lifted_out_of_meshes(out, of.center, k, &of, whole);
}

// Lets meshes follow that do or do not hold their ball. What else holds it leaves only a free place
// to be looked at from; a surface that something else covers there does not push.
template <int N>
void Contacts<N>::follow(bool holds, double T) {
  for (MeshContact<N>& contact : meshes_) {
    if (contact.holds != holds) continue;
    if (contact.probe < 0) {
      contact.touch.follow(contact.ahead, T);
      continue;
    }
    // Near a seam the place now says which of two surfaces is below, not the one ahead. A surface
    // that is covered waits below the whole ball.
    const Vec3 here = free_place(contact, contact.covered);
    const bool beside = here != contact.center || covers_others(contact);
    contact.touch.follow(beside ? here : contact.ahead, T);
  }
  for (MeshContact<N>& contact : meshes_) {
    if (contact.holds != holds || contact.probe < 0) continue;
    contact.covered = false;
    if (!has_company(contact)) continue;
    Vec3 from = free_place(contact, false);
    if (from == contact.center && holds) from = contact.touch.lifted(from, kAbove);
    const std::optional<Vec3> place = contact.touch.nearest_to(from);
    contact.covered = place && covered(contact, *place, from);
    if (contact.covered) contact.touch.hide();
  }
}

// True if a mesh's ball touches something else as well, or is about to.
template <int N>
bool Contacts<N>::has_company(const MeshContact<N>& mesh) const {
  constexpr double kSoon = 2e-3;  // [m]
  const auto k = static_cast<std::size_t>(mesh.probe);
  const double within = probes_[k].radius + kSoon;
  const auto close = [&](const SolidTouch::Near& near) { return near.surface.distance < within; };
  const auto other = [&](const MeshContact<N>* one) { return one != &mesh && one->touch.near(); };
  return std::ranges::any_of(touches_[k].near(), close) || std::ranges::any_of(balls_[k], other);
}

// True if some other surface near a mesh's ball is, or was just now, covered by something.
template <int N>
bool Contacts<N>::covers_others(const MeshContact<N>& mesh) const {
  const auto k = static_cast<std::size_t>(mesh.probe);
  const auto hidden = [](const SolidTouch::Near& near) { return !near.counts; };
  const auto covered = [](const MeshContact<N>* other) { return other->covered; };
  return std::ranges::any_of(touches_[k].near(), hidden) || std::ranges::any_of(balls_[k], covered);
}

// True if something else covers a place of a mesh, seen from a free place.
template <int N>
bool Contacts<N>::covered(const MeshContact<N>& mesh, const Vec3& place, const Vec3& free) const {
  const auto k = static_cast<std::size_t>(mesh.probe);
  if (touches_[k].covers(solids_, place, free)) return true;
  return std::ranges::any_of(balls_[k], [&](const MeshContact<N>* other) {
    const std::optional<Vec3> its = other->touch.nearest_to(free);
    if (other == &mesh || !its) return false;
    const double further = (free - place).norm() - (free - *its).norm();
    if (further < -kTied || !other->touch.meets(place, kMeeting)) return false;
    // The first counts of two that hold each other's nearest point.
    return further > kTied || other->id < mesh.id || !mesh.touch.meets(*its, kMeeting);
  });
}

// Finds the corner that a probe is in: surfaces of plain solids of one body that hold it together
// and are not at right angles. A wall by itself would begin there with a force. Half spaces alone
// have no ends, so each begins without.
template <int N>
void Contacts<N>::look_at_corner(std::size_t probe, const Arm<N>& arm,
                                 const typename Arm<N>::Frames& f) {
  CornerContact<N>& corner = corners_[probe];
  corner.touch.clear();
  corner.rank = 0;
  corner.active = {};
  if (probes_[probe].from != probes_[probe].to) return;
  std::array<const SolidTouch::Near*, FreeSpace::kMostPlanes> by{};
  std::size_t count = 0;
  bool square = true, bounded = false;
  for (const auto& near : touches_[probe].near()) {
    if (!near.counts || !near.holds) continue;
    if (count == by.size()) return;
    for (std::size_t i = 0; i < count; ++i) {
      if (solids_[by[i]->solid].body != solids_[near.solid].body) return;
      square = square && std::abs(by[i]->surface.normal.dot(near.surface.normal)) < kSquare;
    }
    bounded = bounded || !std::holds_alternative<Plane>(solids_[near.solid].shape);
    by[count++] = &near;
  }
  if (square || !bounded) return;
  corner.center = by[0]->point;
  for (std::size_t i = 0; i < count; ++i) {
    const Surface& s = by[i]->surface;
    const double offset = s.normal.dot(corner.center) - s.distance + probes_[probe].radius;
    corner.touch.add(s.normal, offset);
  }
  Vec3 weights;
  if (!corner.touch.settle(corner.center, corner.active, weights)) return corner.touch.clear();
  arm.point_jacobian(f, corner.link, corner.center, corner.J);
  corner.aim();
  // The stiffness is a mean by the parts of the depth; the rest is the main surface's.
  double all = 0, stiff = 0, most = -1;
  for (std::size_t i = 0; i < static_cast<std::size_t>(corner.active.count); ++i) {
    const double weight = weights[static_cast<Eigen::Index>(i)];
    const auto plane = static_cast<std::size_t>(corner.active.plane[i]);
    const Solid& solid = solids_[by[plane]->solid];
    all += weight;
    stiff += weight * solid.material.stiffness;
    if (weight <= most) continue;
    most = weight;
    corner.material = solid.material;
    corner.body = solid.body;
  }
  if (all > 0) corner.material.stiffness = stiff / all;
}

// True if the probe's corner holds it in place of a surface.
template <int N>
bool Contacts<N>::in_corner(std::size_t probe, const SolidTouch::Near& near) const {
  return !corners_.empty() && corners_[probe].touch.near() && near.holds;
}

template <int N>
Material Contacts<N>::material_of(std::size_t id) const {
  if (id < contacts_.size()) return solids_[id % solids_.size()].material;
  id -= contacts_.size();
  return id < meshes_.size() ? meshes_[id].material : corners_[id - meshes_.size()].material;
}

// Gives the force and the friction of a contact that something else now covers to the one that took
// the probe over. Friction's spring keeps its force, or gets less where that would take energy.
template <int N>
void Contacts<N>::pass_on() {
  constexpr auto kNone = std::numeric_limits<std::size_t>::max();
  for (std::size_t k = 0; k < probes_.size(); ++k) {
    const auto hidden = [](const SolidTouch::Near& near) { return !near.counts; };
    const CornerContact<N>* corner = corners_.empty() ? nullptr : &corners_[k];
    const bool cornered =
        corner != nullptr && (corner->touch.near() || !memories_[corner->id].push.isZero(0));
    if (balls_[k].empty() && !cornered && std::ranges::none_of(touches_[k].near(), hidden)) {
      continue;
    }
    std::size_t from = kNone, to = kNone;
    const auto take = [&](std::size_t id, bool covered, bool inside) {
      const bool pushed = !memories_[id].push.isZero(0);
      if (covered && pushed) from = id;
      if (!covered && inside && !pushed) to = id;
    };
    for (const auto& near : touches_[k].near()) {
      const bool inside = near.surface.distance < probes_[k].radius;
      take(k * solids_.size() + near.solid, !near.counts || in_corner(k, near), inside);
    }
    for (const MeshContact<N>* mesh : balls_[k]) take(mesh->id, mesh->covered, mesh->rank > 0);
    if (cornered) take(corner->id, !corner->touch.near(), corner->rank > 0);
    if (from == kNone || to == kNone) continue;
    // A wall remembers the size of its force, a room a vector; the solve corrects both.
    ContactMemory& now = memories_[to];
    now = memories_[from];
    memories_[from] = {};
    const bool to_room = to >= contacts_.size(), from_room = from >= contacts_.size();
    if (to_room && !from_room) {
      const std::size_t room = to - contacts_.size();
      now.push = now.push.norm() *
                 (room < meshes_.size() ? meshes_[room].direction : corner->direction).col(0);
    } else if (from_room && !to_room) {
      now.push = now.push.norm() * Vec3::UnitX();
    }
    now.anchor *=
        std::min(1.0, friction_stiffness(material_of(from)) / friction_stiffness(material_of(to)));
  }
}

// Lets the magnet take the nearest magnetic body at the tip's place.
template <int N>
void Contacts<N>::look_for_magnet(const Arm<N>& arm, const typename Arm<N>::Frames& f) {
  BodyWorld& world = *world_;
  if (!magnet_wanted_) world.let_go();
  const Vec3 tip = Arm<N>::point(f, probes_[0].link, probes_[0].from);
  if (magnet_wanted_ && world.magnet().body == BodyContact::kStill && !world.magnet().spent) {
    int nearest = BodyContact::kStill;
    double depth = -kPicksUp;
    const auto take = [&](int body, double its_depth) {
      if (body == BodyContact::kStill || !world.magnetic(body) || its_depth <= depth) return;
      nearest = body;
      depth = its_depth;
    };
    for (const Contact<N>& c : list()) {
      if (c.id < solids_.size())
        take(c.body, c.depth);  // the first solids.size() contacts are the tip's
    }
    if (!corners_.empty() && corners_[0].touch.near()) {
      take(corners_[0].body, corners_[0].depth.norm());
    }
    for (const MeshContact<N>& c : meshes_) {
      const bool tips = c.link == probes_[0].link && c.on_link == probes_[0].from;
      if (tips && c.touch.near()) take(c.body, deepest(c.touch.space(), c.center));
    }
    if (nearest != BodyContact::kStill) world.attach(nearest, tip);
  }
  magnet_.force.setZero();
  magnet_.body = world.magnet().body;
  if (!magnet_.on()) return;
  world.touch(magnet_.body);
  magnet_.at = world.magnet_point();
  magnet_.stretch = tip - magnet_.at;
  magnet_.material = of_bodies_[static_cast<std::size_t>(magnet_.body)];
  arm.point_jacobian(f, probes_[0].link, tip, magnet_.J);
}

template <int N>
void Contacts<N>::follow_bodies() {
  for (Solid& solid : solids_) {
    if (solid.body != BodyContact::kStill) solid.pose = world_->pose(solid.body) * solid.in_body;
  }
  for (MeshContact<N>& contact : meshes_) {
    if (contact.body != BodyContact::kStill) contact.touch.move(world_->pose(contact.body));
  }
}

template <int N>
void Contacts<N>::step_bodies() {
  if (!world_) return;
  for_each_of(kinds(), [&](auto& c) {
    if (c.body == BodyContact::kStill || c.on_arm().isZero(0)) return;  // no push, no touch
    world_->push(world_->end_at(c.body, c.place()), -c.on_arm());
  });
  world_->settle();
  for_each_of(kinds(), [&](auto& c) {
    if (c.body != BodyContact::kStill) world_->book(world_->end_at(c.body, c.place()), -c.on_arm());
  });
  if (magnet_.on()) world_->pulled(magnet_.force);
  world_->finish();
}

// Finds the planes that push on the centre at its present place.
template <int N>
void Contacts<N>::look(MeshContact<N>& contact, const Arm<N>& arm,
                       const typename Arm<N>::Frames& f) {
  contact.rank = 0;
  contact.active = {};
  if (!contact.touch.near()) return;
  arm.point_jacobian(f, contact.link, contact.center, contact.J);
  if (contact.touch.held()) {
    contact.rank = 3;
    contact.direction.setIdentity();
    contact.depth = contact.touch.anchor() - contact.center;
    return;
  }
  Vec3 x;
  contact.touch.space().project(contact.center, x, contact.active);
  contact.aim();
}

template <int N>
void Contacts<N>::add_to(Mat<N>& A, Vec<N>& b, double T, const ContactShare<N>& share,
                         const Mat<N>& M2) const {
  for_each_of(kinds(), [&](const auto& c) {
    c.springs([&](double depth, const Vec<N>& gradient) {
      // Response of tau2 + f2 to a deeper contact, with opposite sign.
      const Vec<N> answer = c.material.stiffness * share.of(gradient, M2);
      A.noalias() += (0.5 * T) * answer * gradient.transpose();
      b -= depth * answer;
    });
  });
}

template <int N>
bool Contacts<N>::push(const Vec<N>& vbar, double T, Vec<N>& f2) {
  f2 = Vec<N>::Zero(vbar.size());
  bool settled = true;
  for_each_of(magnet_first(), [&](auto& c) { settled = c.press(vbar, T, f2) && settled; });
  return settled;
}

template <int N>
bool Contacts<N>::reconsider(const Vec<N>& vbar, double T, bool only_let_go) {
  bool changed = false;
  for_each_of(kinds(), [&](auto& c) { changed = c.reconsider(vbar, T, only_let_go) || changed; });
  return changed;
}

template <int N>
std::size_t Contacts<N>::forces(std::span<ContactForce> into) const {
  std::size_t count = 0;
  const auto take = [&](const ContactForce& contact) {
    const auto hardness = [](const ContactForce& c) { return c.force.squaredNorm(); };
    if (count < into.size()) {
      into[count++] = contact;
    } else if (!into.empty()) {
      ContactForce& weakest = *std::ranges::min_element(into, {}, hardness);
      if (hardness(contact) > hardness(weakest)) weakest = contact;
    }
  };
  for_each_of(kinds(), [&](const auto& c) {
    if (const auto felt = c.felt()) take(*felt);
  });
  return count;
}

template <int N>
bool Contacts<N>::engaged() const {
  bool engaged = false;
  for_each_of(kinds(), [&](const auto& c) {
    engaged = engaged || c.inside();
    if constexpr (std::decay_t<decltype(c)>::kRemembers)
      engaged = engaged || !memories_[c.id].push.isZero(0);
  });
  return engaged;
}

template <int N>
double Contacts<N>::stored() const {
  double U = 0;
  for_each_of(magnet_first(), [&](const auto& c) {
    double in_friction = 0;
    if constexpr (std::decay_t<decltype(c)>::kRemembers) {
      const Vec3& anchor = memories_[c.id].anchor;
      in_friction = 0.5 * friction_stiffness(c.material) * anchor.squaredNorm();
    }
    U += c.stored(in_friction);
  });
  return U;
}

template class Contacts<3>;
template class Contacts<7>;
template class Contacts<kAnyDof>;

}  // namespace limpid
