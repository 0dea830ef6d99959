#include "core/touch/body_world.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/math/elementary.h"
#include "core/touch/wall_force.h"

namespace limpid {
namespace {

// Change of a force that counts as settled, for bodies that the arm touches, and for others [N].
constexpr double kEnough = 1e-8;
constexpr double kEnoughElse = 1e-5;
constexpr int kMostSweeps = 30;  // most sweeps over bodies that the arm touches
constexpr int kFewSweeps = 10, kManySweeps = 60;
constexpr std::size_t kMostRowsSwept = 2000;  // rows in a tick's sweeps beyond kFewSweeps: 0.2 ms
constexpr double kFade = 0.05;  // time in which a depth present at the start fades [s]
constexpr double kSlow = 1e-3;  // largest speed of a body at rest [m/s]
constexpr double kQuiet = 0.5;  // time of rest before a body sleeps [s]
constexpr double kGone = 20;    // distance at which a body is given up [m]

// F^T W F, number by number in the order of Eigen's sums.
void turn_into(const Mat3& F, const Mat3& W, Mat3& out) {
  for (int i = 0; i < 3; ++i) {
    double T[3];
    for (int j = 0; j < 3; ++j) {
      T[j] = F(0, i) * W(0, j) + (F(1, i) * W(1, j) + F(2, i) * W(2, j));
    }
    for (int j = 0; j < 3; ++j) out(i, j) = T[0] * F(0, j) + (T[1] * F(1, j) + T[2] * F(2, j));
  }
}

}  // namespace

BodyWorld::BodyWorld(const Scene& scene) : geometry_(scene) {
  for (const Object& object : scene.objects) {
    of_objects_.push_back(object.material);
    body_of_.push_back(object.body ? count() : BodyContact::kStill);
    if (!object.body) continue;
    bodies_.emplace_back(object, scene.gravity);
    names_.push_back(object.name);
    of_bodies_.push_back(*object.body);
    if (bodies_.back().on_joint()) joints_.push_back({.body = count() - 1, .forces = {}});
  }
  const std::size_t n = bodies_.size();
  awake_.assign(n, 1);
  pushed_.assign(n, 0);
  touched_.assign(n, 0);
  quiet_island_.assign(n, 0);
  quiet_.assign(n, 0);
  parent_.assign(n, 0);
  quick_.reserve(n);
  rows_.resize(BodyGeometry::kMost);
  add_links(scene);
  for (auto* numbers : {&before_, &now_, &along_}) {
    numbers->assign(3 * (rows_.size() + links_.size() + joints_.size() + held_.size() + 1), 0);
  }
  reset();
}

int BodyWorld::number(const std::string& name) const {
  const auto found = std::ranges::find(names_, name);
  return found == names_.end() ? BodyContact::kStill : static_cast<int>(found - names_.begin());
}

void BodyWorld::reset() {
  for (BodyMotion& body : bodies_) body.reset();
  std::ranges::fill(awake_, 1);
  std::ranges::fill(pushed_, 0);
  std::ranges::fill(quiet_, 0);
  for (JointRow& row : joints_) row.forces = {};
  for (Link& link : links_) {
    link.force.setZero();
    link.broken = false;
  }
  constexpr std::array<double, HeldJoint::kNumbers> kAtRest{};
  for (Held& held : held_) held.joint.read(kAtRest);
  let_go();
  geometry_.forget();
  for (int i = 0; i < count(); ++i) geometry_.place(i, pose(i));
  count_ = 0;
  fresh_ = true;
  given_ = given_now_ = all_given_ = all_pulled_ = energy_ = first_energy_ = gain_ = 0;
}

void BodyWorld::take_over(const BodyWorld& other) {
  given_ = other.given_;
  all_given_ = other.all_given_;
  all_pulled_ = other.all_pulled_;
  gain_ = other.gain_;
  std::array<double, BodyMotion::kNumbers> numbers{};
  for (int i = 0; i < count(); ++i) {
    const int theirs = other.number(names_[at(i)]);
    if (theirs == BodyContact::kStill || !bodies_[at(i)].alike(other.bodies_[at(theirs)])) continue;
    const BodyMotion& before = other.bodies_[at(theirs)];
    before.write(numbers);
    // Keeps the object's place, although its centre of mass may have moved.
    const Vec3 own = pose(i).inverse() * center(i);
    const Vec3 moved = before.pose() * own - before.center();
    if (moved.norm() > 1e-12) {
      const Vec3 speed = before.spin().cross(moved);
      for (std::size_t k = 0; k < 3; ++k) {
        numbers[k] += moved[static_cast<int>(k)];
        numbers[12 + k] += speed[static_cast<int>(k)];
      }
    }
    bodies_[at(i)].read(numbers);
    geometry_.place(i, pose(i));
  }
  for (Held& held : held_) {
    for (const Held& theirs : other.held_) {  // may have its sides swapped
      if (names_[at(held.a)] == other.names_[at(theirs.a)]) held.joint.place = theirs.joint.place;
    }
    follow(held);
  }
}

void BodyWorld::touch(int body) {
  touched_[at(body)] = 1;
  awake_[at(body)] = 1;
  quiet_[at(body)] = 0;
}

void BodyWorld::attach(int body, const Vec3& tip) {
  magnet_ = {body, pose(body).inverse() * tip};
  touch(body);
}

void BodyWorld::pulled(const Vec3& force) {
  magnet_.force = force;
  if (!(force.norm() > Magnet::kBreaks)) return;
  let_go();
  magnet_.spent = true;
}

double BodyWorld::joint(int body) const {
  for (const Held& held : held_) {
    if (held.a == body) return held.joint.place;
  }
  return bodies_[at(body)].joint();
}

Vec3 BodyWorld::place(int body, const Vec3& own) const {
  return body == BodyContact::kStill ? own : Vec3(pose(body) * own);
}

void BodyWorld::begin(double T) {
  T_ = T;
  sweeps_ = 0;
  if (pull_.body >= count()) pull_ = {};
  if (pull_.body != BodyContact::kStill) {
    awake_[at(pull_.body)] = 1;
    quiet_[at(pull_.body)] = 0;
  }
  wake_neighbours();
  geometry_.search(awake_);
  for (int i = 0; i < count(); ++i) {
    if (moves(i)) bodies_[at(i)].begin(T, pushed_[at(i)] != 0);
  }
  std::ranges::fill(pushed_, 0);
  find_islands();
  count_ = 0;
  for (BodyContact* contact : geometry_.points()) {
    if (begin_row(*contact)) ++count_;
  }
  for (Link& link : links_) begin_link(link);
  begin_pull();
  for (JointRow& row : joints_) {
    if (moves(row.body)) bodies_[at(row.body)].push_joint(row.forces.sum());
  }
  for (Held& held : held_) begin_held(held);
  take_stock();
}

// Wakes bodies that a moving body comes near to or is linked to.
void BodyWorld::wake_neighbours() {
  const auto quick = [&](int i) { return moves(i) && quiet_[at(i)] == 0; };
  const auto wake = [&](int i) {
    awake_[at(i)] = 1;
    quiet_[at(i)] = 0;
  };
  for (const Link& link : links_) {
    if (link.b == BodyContact::kStill || link.broken) continue;
    if (quick(link.a) && !moves(link.b)) wake(link.b);
    if (quick(link.b) && !moves(link.a)) wake(link.a);
  }
  quick_.clear();
  for (int i = 0; i < count(); ++i) {
    if (quick(i)) quick_.push_back(i);
  }
  for (int i = 0; i < count() && !quick_.empty(); ++i) {
    if (moves(i)) continue;
    if (std::ranges::none_of(quick_, [&](int j) { return geometry_.near(i, j); })) continue;
    wake(i);
    quick_.push_back(i);
  }
}

int BodyWorld::root(int body) {
  while (parent_[at(body)] != body) {
    parent_[at(body)] = parent_[at(parent_[at(body)])];
    body = parent_[at(body)];
  }
  return body;
}

void BodyWorld::join(int a, int b) {
  if (!moves(a) || !moves(b)) return;
  const int one = root(a), two = root(b);
  parent_[at(std::max(one, two))] = std::min(one, two);
}

void BodyWorld::find_islands() {
  for (int i = 0; i < count(); ++i) parent_[at(i)] = i;
  for (const BodyContact* c : geometry_.points()) join(c->a, c->b);
  for (const Link& link : links_) {
    if (!link.broken) join(link.a, link.b);
  }
  // An island counts as touched if one of its bodies is.
  for (int i = 0; i < count(); ++i) {
    if (touched_[at(i)] != 0) touched_[at(root(i))] = 1;
  }
}

bool BodyWorld::in_turn(int a, int b, bool touched) {
  const int body = moves(a) ? a : b;
  return moves(body) && (touched_[at(root(body))] != 0) == touched;
}

double BodyWorld::stiffness(const BodyContact& contact) const {
  const double one = of_bodies_[at(contact.a)].contact_stiffness;
  return contact.b == BodyContact::kStill
             ? one
             : std::min(one, of_bodies_[at(contact.b)].contact_stiffness);
}

bool BodyWorld::begin_row(BodyContact& contact) {
  if (!moves(contact.a) && !moves(contact.b)) return false;
  Row& row = rows_[count_];
  row.contact = &contact;
  row.a = end_at(contact.a, contact.point, contact.ball_a);
  row.b = end_at(contact.b, contact.point, contact.ball_b);
  row.K = stiffness(contact);
  // Depth that was not pressed in fades, as fast as the contact's damper pays for it.
  contact.rest = std::max(contact.rest, contact.depth - contact.pressed);
  contact.rest = std::min(contact.rest, std::max(0.0, contact.depth));
  if (contact.rest > 0) {
    const double d = std::max(0.0, contact.depth - contact.rest);
    const double paid = std::sqrt(d * d + 2 * std::max(0.0, contact.lost) / row.K) - d;
    contact.rest -= std::min(paid, contact.rest * std::min(1.0, T_ / kFade));
  }
  row.depth = contact.depth - contact.rest;
  row.frame.col(0) = contact.normal;
  row.frame.col(1) = contact.normal.unitOrthogonal();
  row.frame.col(2) = contact.normal.cross(row.frame.col(1));
  Mat3 W = answer(row.a);
  if (row.b.body != BodyContact::kStill) W += answer(row.b);
  turn_into(row.frame, W, row.W);
  const Material& one = of_objects_[static_cast<std::size_t>(contact.object_a)];
  const Material& two = of_objects_[static_cast<std::size_t>(contact.object_b)];
  const double kinetic = std::max(one.friction_kinetic, two.friction_kinetic);
  const double still = std::max(one.friction_static, two.friction_static);
  row.radius = contact.slipping ? kinetic : std::max(still, kinetic);
  const auto of = [&](int body) {
    return body == BodyContact::kStill ? 0.0 : of_bodies_[at(body)].restitution;
  };
  const double m_eff = BodyMotion::kTheta * T_ / row.W(0, 0);
  row.B = 2 * damping_ratio(std::max(of(contact.a), of(contact.b))) * std::sqrt(row.K * m_eff);
  // Turns the stored force to the contact's present frame first: a force that no row has would do
  // unaccounted work.
  row.force = contact.force;
  row.friction.noalias() = row.frame.rightCols<2>().transpose() * contact.friction;
  row.anchor.noalias() = row.frame.rightCols<2>().transpose() * contact.anchor;
  if (row.radius == 0) row.friction.setZero();
  apply(row.a, row.b, row.force * contact.normal + row.frame.rightCols<2>() * row.friction);
  return true;
}

// Turns a direction from a body's frame to the world's.
Vec3 BodyWorld::directed(int body, const Vec3& own) const {
  return body == BodyContact::kStill ? own : Vec3(pose(body).linear() * own);
}

BodyWorld::End BodyWorld::end_at(int body, const Vec3& point, bool rolls) const {
  if (!moves(body)) return {};
  const BodyMotion& motion = bodies_[at(body)];
  return {body, rolls ? Vec3(point - motion.center()) : motion.lever(point, T_)};
}

Mat3 BodyWorld::answer(const End& end) const {
  if (end.body == BodyContact::kStill) return Mat3::Zero();
  return bodies_[at(end.body)].answer(end.lever);
}

double BodyWorld::sweep(bool touched) {
  double most = 0;
  for (JointRow& row : joints_) {
    if (in_turn(row.body, BodyContact::kStill, touched)) most = std::max(most, sweep(row));
  }
  for (Held& held : held_) {
    if (in_turn(held.a, held.b, touched)) most = std::max(most, sweep(held));
  }
  for (Link& link : links_) {
    if (!link.broken && in_turn(link.a, link.b, touched)) most = std::max(most, sweep(link));
  }
  if (in_turn(pulling_.a, pulling_.b, touched)) most = std::max(most, sweep(pulling_));
  for (Row& row : std::span(rows_.data(), count_)) {
    if (in_turn(row.contact->a, row.contact->b, touched)) most = std::max(most, sweep(row));
  }
  return most;
}

double BodyWorld::sweep(Row& row) {
  const Vec3 v = row.frame.transpose() * (velocity(row.a) - velocity(row.b));
  const double c = T_ * row.W(0, 0);
  const double F = wall_force({row.K, row.B, T_, row.depth, -T_ * v.x() + c * row.force, c});
  const double change = F - row.force;
  row.force = F;
  apply(row.a, row.b, change * row.frame.col(0));
  if (row.radius == 0) return std::abs(change);
  const auto across = row.frame.rightCols<2>();
  const Mat2 W = row.W.bottomRightCorner<2, 2>();
  const Vec2 b = across.transpose() * (velocity(row.a) - velocity(row.b)) - W * row.friction;
  const Vec2 l = friction_force(row.K, row.radius * F, row.anchor, T_, b, W);
  const Vec2 more = l - row.friction;
  row.friction = l;
  apply(row.a, row.b, across * more);
  return std::abs(change) + more.norm();
}

// Writes the forces of all rows, three numbers each.
void BodyWorld::forces(std::vector<double>& into) const {
  auto to = into.begin();
  for (const Row& row : std::span(rows_.data(), count_)) {
    *to++ = row.force;
    to = std::copy_n(row.friction.data(), 2, to);
  }
  for (const Link& link : links_) to = std::copy_n(link.force.data(), 3, to);
  for (const JointRow& row : joints_) {
    for (const double force : {row.forces.potential, row.forces.stop, row.forces.friction}) {
      *to++ = force;
    }
  }
  for (const Held& held : held_) to = std::ranges::copy(held.joint.numbers(), to).out;
  std::copy_n(pulling_.force.data(), 3, to);
}

void BodyWorld::add_forces(const std::vector<double>& more) {
  const double* at = more.data();
  for (Row& row : std::span(rows_.data(), count_)) {
    const Vec3 change = Eigen::Map<const Vec3>(at);
    row.force += change.x();
    row.friction += change.tail<2>();
    apply(row.a, row.b, row.frame * change);
    at += 3;
  }
  for (Link& link : links_) {
    const Vec3 change = Eigen::Map<const Vec3>(at);
    link.force += change;
    if (!change.isZero(0)) apply(link.end_a, link.end_b, change);
    at += 3;
  }
  for (JointRow& row : joints_) {
    row.forces.potential += at[0];
    row.forces.stop += at[1];
    row.forces.friction += at[2];
    const double change = at[0] + at[1] + at[2];
    if (change != 0) bodies_[this->at(row.body)].push_joint(change);
    at += 3;
  }
  for (Held& held : held_) {
    const Vec3 change = Eigen::Map<const Vec3>(at);
    if (!change.isZero(0)) push(held, held.joint.add(change));
    at += 3;
  }
  const Vec3 change = Eigen::Map<const Vec3>(at);
  pulling_.force += change;
  apply(pulling_.end_a, pulling_.end_b, change);
}

double BodyWorld::sweep(bool touched, double enough, int most) {
  const std::size_t numbers = 3 * (count_ + links_.size() + joints_.size() + held_.size() + 1);
  double last2 = 0;
  for (int i = 1;; ++i) {
    forces(before_);
    const double change = sweep(touched);
    ++sweeps_;
    if (change <= enough || i >= most) return change;
    forces(now_);
    double step2 = 0;
    for (std::size_t k = 0; k < numbers; ++k) {
      now_[k] -= before_[k];
      step2 += now_[k] * now_[k];
    }
    // Restarts when the steps grow.
    const double on = last2 > 0 && step2 <= last2 ? step2 / last2 : 0;
    last2 = step2;
    for (std::size_t k = 0; k < numbers; ++k) {
      before_[k] = on > 0 ? on * along_[k] : 0;
      along_[k] = before_[k] + now_[k];
    }
    if (on > 0) add_forces(before_);
  }
}

void BodyWorld::book(const End& end, const Vec3& force) {
  given_now_ += T_ * force.dot(velocity(end));
}

void BodyWorld::hold_touched() {
  for (Row& row : std::span(rows_.data(), count_)) {
    if (!in_turn(row.contact->a, row.contact->b, true)) continue;
    row.force = row.contact->force;
    row.friction = row.frame.rightCols<2>().transpose() * row.contact->friction;
  }
  for (JointRow& row : joints_) {
    if (!in_turn(row.body, BodyContact::kStill, true)) continue;
    row.forces.friction = -row.forces.anchor * bodies_[at(row.body)].of_joint().stop_stiffness;
  }
  for (Held& held : held_) {
    if (in_turn(held.a, held.b, true)) held.joint.hold();
  }
  // Puts touched islands to sleep; those near the tip or a moving body wake at the next tick.
  for (int i = 0; i < count(); ++i) parent_[at(i)] = root(i);
  for (int i = 0; i < count(); ++i) {
    if (!moves(i) || touched_[at(parent_[at(i)])] == 0) continue;
    bodies_[at(i)].halt();
    awake_[at(i)] = 0;
  }
}

void BodyWorld::end_rows() {
  for (const Row& row : std::span(rows_.data(), count_)) {
    BodyContact& c = *row.contact;
    c.force = row.force;
    c.friction = row.frame.rightCols<2>() * row.friction;
    c.anchor = -c.friction / row.K;
    c.slipping = row.force > 0 && row.radius > 0 &&
                 row.friction.norm() >= row.radius * row.force * (1 - 1e-9);
    const double D = -T_ * row.frame.col(0).dot(velocity(row.a) - velocity(row.b));
    const double before = std::max(0.0, row.depth), after = std::max(0.0, row.depth + D);
    c.pressed = after;
    c.lost = row.force * D - 0.5 * row.K * (after * after - before * before);
  }
  for (Link& link : links_) {
    if (link.force.norm() > link.breaks_at) {
      link.broken = true;
      link.force.setZero();
    }
  }
  for (JointRow& row : joints_) {
    row.forces.anchor = -row.forces.friction / bodies_[at(row.body)].of_joint().stop_stiffness;
  }
  for (Held& held : held_) {
    if (moves(held.a) || moves(held.b)) held.joint.finish(T_, speed(held));
  }
}

void BodyWorld::settle() {
  sweep(true, kEnough, kMostSweeps);
  const auto many = static_cast<int>(kMostRowsSwept / std::max<std::size_t>(1, count_));
  sweep(false, kEnoughElse, std::clamp(many, kFewSweeps, kManySweeps));
}

void BodyWorld::finish() {
  given_ = given_now_;
  all_given_ += given_now_;
  given_now_ = 0;
  all_pulled_ += T_ * pulling_.force.dot(velocity(pulling_.end_a));
  end_rows();
  for (int i = 0; i < count(); ++i) {
    if (!moves(i)) continue;
    BodyMotion& body = bodies_[at(i)];
    body.finish(T_);
    if (!body.finite()) body.reset();
    geometry_.place(i, pose(i));
  }
  fall_asleep();
  std::ranges::fill(touched_, 0);
}

// Puts an island to sleep after all of it has been at rest for a while.
void BodyWorld::fall_asleep() {
  const auto long_enough = static_cast<int>(kQuiet / T_);
  for (int i = 0; i < count(); ++i) {
    if (!moves(i)) continue;
    const BodyMotion& body = bodies_[at(i)];
    const bool slow = body.speed().norm() < kSlow && body.spin().norm() * 0.05 < kSlow;
    const bool gone = body.center().norm() > kGone;
    quiet_[at(i)] = slow || gone ? quiet_[at(i)] + 1 : 0;
    if (gone) quiet_[at(i)] = long_enough;
  }
  std::ranges::fill(quiet_island_, 1);
  for (int i = 0; i < count(); ++i) {
    parent_[at(i)] = root(i);  // each body's own root from now on
    if (moves(i) && (quiet_[at(i)] < long_enough || touched_[at(root(i))] != 0)) {
      quiet_island_[at(root(i))] = 0;
    }
  }
  for (int i = 0; i < count(); ++i) {
    if (!moves(i) || quiet_island_[at(parent_[at(i)])] == 0) continue;
    bodies_[at(i)].halt();
    awake_[at(i)] = 0;
  }
}

void BodyWorld::take_stock() {
  double E = 0;
  for (const BodyMotion& body : bodies_) {
    E += body.kinetic() + body.weight_energy();
    if (body.on_joint()) E += body.potential().energy(body.joint());
  }
  for (const BodyContact* c : geometry_.points()) {
    const double d = std::max(0.0, c->depth - c->rest), K = stiffness(*c);
    const Vec3 across = c->anchor - c->normal * c->normal.dot(c->anchor);
    E += 0.5 * K * (d * d + across.squaredNorm());
  }
  for (const Link& link : links_) {
    if (link.broken) continue;
    Vec3 off = place(link.a, link.on_a) - place(link.b, link.on_b);
    if (link.rail)
      off -= off.dot(directed(link.b, link.rail_axis)) * directed(link.b, link.rail_axis);
    const double x = off.norm();
    E += 0.5 * link.K * (x - link.length) * (x - link.length);
  }
  for (const JointRow& row : joints_) {
    const BodyMotion& body = bodies_[at(row.body)];
    const BodyJoint& joint = body.of_joint();
    const double d = std::max({0.0, joint.low - body.joint(), body.joint() - joint.high});
    E += 0.5 * joint.stop_stiffness * (d * d + row.forces.anchor * row.forces.anchor);
  }
  for (const Held& held : held_) E += held.joint.stored();
  energy_ = E;
  const double from_outside = all_given_ + all_pulled_;
  if (fresh_) first_energy_ = E - from_outside - gain_;
  fresh_ = false;
  gain_ = E - first_energy_ - from_outside;
}

int BodyWorld::awake() const {
  return static_cast<int>(std::ranges::count_if(awake_, [](auto a) { return a != 0; }));
}

void BodyWorld::write(std::vector<double>& into) const {
  std::array<double, BodyMotion::kNumbers> numbers{};
  into.push_back(count());
  into.push_back(static_cast<double>(links_.size()));
  into.insert(into.end(),
              {double(magnet_.body), magnet_.point.x(), magnet_.point.y(), magnet_.point.z(),
               magnet_.force.x(), magnet_.force.y(), magnet_.force.z(), magnet_.spent ? 1.0 : 0.0});
  for (int i = 0; i < count(); ++i) {
    bodies_[at(i)].write(numbers);
    into.insert(into.end(), numbers.begin(), numbers.end());
    for (const int n : {int{awake_[at(i)]}, int{pushed_[at(i)]}, quiet_[at(i)]}) into.push_back(n);
  }
  for (const JointRow& row : joints_) {
    const JointForces& forces = row.forces;
    into.insert(into.end(), {forces.potential, forces.stop, forces.friction, forces.anchor});
  }
  for (const Link& link : links_) {
    into.insert(into.end(),
                {link.force.x(), link.force.y(), link.force.z(), link.broken ? 1.0 : 0.0});
  }
  std::array<double, HeldJoint::kNumbers> of_joint{};
  for (const Held& held : held_) {
    held.joint.write(of_joint);
    into.insert(into.end(), of_joint.begin(), of_joint.end());
  }
  geometry_.write(into);
}

bool BodyWorld::read(std::span<const double> from) {
  constexpr std::size_t kMagnet = 8, kBody = BodyMotion::kNumbers + 3, kJoint = 4, kLink = 4;
  const std::size_t own = 2 + kMagnet + kBody * bodies_.size() + kJoint * joints_.size() +
                          kLink * links_.size() + HeldJoint::kNumbers * held_.size();
  if (from.size() < own || from[0] != count() || from[1] != static_cast<double>(links_.size()) ||
      !std::ranges::all_of(from, [](double x) { return std::isfinite(x); })) {
    return false;
  }
  reset();
  from = from.subspan(2);
  if (from[0] >= 0 && from[0] < count()) magnet_.body = static_cast<int>(from[0]);
  magnet_.point = Vec3(from[1], from[2], from[3]);
  magnet_.force = Vec3(from[4], from[5], from[6]);
  magnet_.spent = from[7] != 0;
  from = from.subspan(kMagnet);
  for (int i = 0; i < count(); ++i, from = from.subspan(kBody)) {
    bodies_[at(i)].read(from.first<BodyMotion::kNumbers>());
    awake_[at(i)] = from[BodyMotion::kNumbers] != 0 ? 1 : 0;
    pushed_[at(i)] = from[BodyMotion::kNumbers + 1] != 0 ? 1 : 0;
    quiet_[at(i)] = static_cast<int>(from[BodyMotion::kNumbers + 2]);
    geometry_.place(i, pose(i));
  }
  for (JointRow& row : joints_) {
    row.forces = {from[0], from[1], from[2], from[3]};
    from = from.subspan(kJoint);
  }
  for (Link& link : links_) {
    link.force = Vec3(from[0], from[1], from[2]);
    link.broken = from[3] != 0;
    from = from.subspan(kLink);
  }
  for (Held& held : held_) {
    held.joint.read(from.first<HeldJoint::kNumbers>());
    from = from.subspan(HeldJoint::kNumbers);
  }
  geometry_.read(from);
  return true;
}

}  // namespace limpid
