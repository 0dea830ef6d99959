#include "core/touch/contact_solve.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "core/touch/wall_force.h"

namespace limpid {

namespace {

constexpr int kMostSteps = 10;    // steps of Newton's method; two or three are usual
constexpr int kFinest = 1 << 10;  // parts of a segment: finest search for changes of planes

// State of the room at a point of the segment.
struct Held {
  Vec3 pull;               // from the point to the nearest free place [m]
  FreeSpace::Active by{};  // the planes
  Vec3 weights;            // weight of each plane
};

// Means over the segment from s = 0 to 1.
struct Mean {
  Vec3 pull = Vec3::Zero();    // [m]
  Mat3 damped = Mat3::Zero();  // factor of the damper on a velocity [-]
  Mat3 later = Mat3::Zero();   // slope of the pull's mean over the segment's end [-]
};

class Segment {
 public:
  Segment(const FreeSpace& space, const Vec3& from, const Vec3& D)
      : space_(space), from_(from), D_(D) {}

  Mean mean() const {
    Mean m;
    const Held a = at(0), b = at(1);
    add(0, kFinest, a, b, m);
    return m;
  }

 private:
  Held at(double s) const {
    const Vec3 c = from_ + s * D_;
    Held h;
    Vec3 x;
    space_.project(c, x, h.by, h.weights);
    h.pull = x - c;
    return h;
  }

  Mat3 projection(const FreeSpace::Active& by) const {
    Mat3 e;
    const int rank = space_.basis(by, e);
    return e.leftCols(rank) * e.leftCols(rank).transpose();
  }

  // Damper of the planes that hold. Each damps along its normal as a wall by itself does. Planes
  // that face nearly the same way share it, in proportion to their part of the depth below them. So
  // the crease between two faces of a valley drags no more than the faces do.
  Mat3 damper(const Held& h) const {
    Mat3 D = Mat3::Zero();
    for (int i = 0; i < h.by.count; ++i) {
      const Vec3& n = space_.normal(h.by.plane[static_cast<std::size_t>(i)]);
      if (h.by.count == 1) return n * n.transpose();
      const double depth = n.dot(h.pull);
      if (depth > 0) D += std::min(h.weights[i] / depth, 1.0) * n * n.transpose();
    }
    return D;
  }

  // Adds a part of the segment: the pull is linear between two places that the same planes hold.
  void add(int first, int last, const Held& a, const Held& b, Mean& m) const {
    const double s0 = static_cast<double>(first) / kFinest;
    const double s1 = static_cast<double>(last) / kFinest;
    if (last - first > 1) {
      const int half = (first + last) / 2;
      const Held middle = at(0.5 * (s0 + s1));
      if (!(a.by == b.by && a.by == middle.by)) {
        add(first, half, a, middle, m);
        add(half, last, middle, b, m);
        return;
      }
    }
    m.pull += 0.5 * (s1 - s0) * (a.pull + b.pull);
    for (const Held* h : {&a, &b}) {
      m.damped += 0.5 * (s1 - s0) * damper(*h);
      m.later += 0.25 * (s1 * s1 - s0 * s0) * projection(h->by);
    }
  }

  const FreeSpace& space_;
  Vec3 from_, D_;
};

Mean mean_of(const MeshTouch& touch, const Vec3& center, const Vec3& D) {
  if (!touch.held()) return Segment(touch.space(), center, D).mean();
  return {touch.anchor() - center - 0.5 * D, Mat3::Identity(), 0.5 * Mat3::Identity()};
}

constexpr double kNear = 2e-3;  // contacts further off are left out, unless they approach [m]
// Least lever of a contact: below it no joint can serve the contact, and its force, which moves
// nothing, is left out with its friction [m].
constexpr double kLeastLever = 1e-9;
constexpr double kSettled = 1e-8;   // largest change of a settled force, relative to it or to 1 N
constexpr double kFelt = 1e-7;      // least change of a force that shows a body's response [N]
constexpr int kSweepsOfBodies = 5;  // sweeps over other bodies for each one over touched ones

// Frame of a unit vector and two unit vectors across it.
Mat3 frame_of(const Vec3& normal) {
  Mat3 frame;
  frame.col(0) = normal;
  frame.col(1) = normal.unitOrthogonal();
  frame.col(2) = normal.cross(frame.col(1));
  return frame;
}

double friction_radius(const Material& m, bool slipping) {
  return slipping ? m.friction_kinetic : std::max(m.friction_static, m.friction_kinetic);
}

}  // namespace

void room_force(const MeshTouch& touch, const RoomTick& tick, Vec3& F) {
  const double b = tick.B / tick.T;
  Vec3 pull = Vec3::Zero();
  for (int i = 0; i < kMostSteps; ++i) {
    const Vec3 D = tick.a + tick.W * F;
    const Mean m = mean_of(touch, tick.center, D);
    const Vec3 wanted = tick.K * m.pull - b * (m.damped * D);
    const Mat3 slope = Mat3::Identity() + (tick.K * m.later + b * m.damped) * tick.W;
    const Vec3 step = slope.inverse() * (wanted - F);
    F += step;
    pull = m.pull;
    if (step.squaredNorm() <= 1e-20 * (1 + F.squaredNorm())) break;
  }
  if (F.dot(pull) <= 0) F.setZero();  // walls do not stick
}

Vec3 room_push(const MeshTouch& touch, const RoomTick& tick, Mat3& on_D) {
  const double b = tick.B / tick.T;
  const Mean m = mean_of(touch, tick.center, tick.a);
  const Vec3 F = tick.K * m.pull - b * (m.damped * tick.a);
  const bool pushes = F.dot(m.pull) > 0;
  on_D = pushes ? Mat3(-tick.K * m.later - b * m.damped) : Mat3(Mat3::Zero());
  return pushes ? F : Vec3(Vec3::Zero());
}

template <int N>
typename ContactSolve<N>::Row& ContactSolve<N>::next_row(double depth) {
  std::size_t at = static_cast<std::size_t>(count_);
  if (count_ < kMost) {
    ++count_;
  } else {
    at = static_cast<std::size_t>(std::ranges::min_element(depths_) - depths_.begin());
  }
  depths_[at] = depth;
  rows_[at].clear();
  return rows_[at];
}

template <int N>
void ContactSolve<N>::collect(Contacts<N>& contacts, const Arm<N>& arm,
                              const typename Arm<N>::Frames& f, const Vec<N>& u, double T) {
  count_ = 0;
  world_ = contacts.world();
  if (contacts.magnet().on) add(contacts.magnet(), *world_);
  for (Contact<N>& c : contacts.list()) {
    double deeper = T * c.gradient.dot(u);
    if (c.body != BodyContact::kStill) {
      deeper += T * c.normal.dot(world_->velocity(world_->end_at(c.body, c.point)));
    }
    const bool near = c.depth > -kNear || c.depth + 2 * deeper > 0;
    const bool served = c.gradient.squaredNorm() > kLeastLever * kLeastLever;
    if (near && served && (count_ < kMost || c.depth > std::ranges::min(depths_)))
      add(c, contacts, arm, f);
    c.force = 0;
    c.friction.setZero();
  }
  for (MeshContact<N>& c : contacts.meshes()) {
    c.force.setZero();
    if (c.touch.near() && (count_ < kMost || c.depth.norm() > std::ranges::min(depths_))) {
      add(c, contacts);
    }
  }
}

template <int N>
void ContactSolve<N>::add(Contact<N>& c, Contacts<N>& contacts, const Arm<N>& arm,
                          const typename Arm<N>::Frames& f) {
  Row& row = next_row(c.depth);
  row.wall = &c;
  row.material = c.material;
  row.before = contacts.memory(c.id);
  row.radius = friction_radius(c.material, row.before.slipping);
  row.g[0] = -c.gradient;
  row.push.x() = row.before.push.x();
  if (c.body != BodyContact::kStill) {
    row.frame = frame_of(c.normal);
    on_body(row, contacts.world(), c.body, c.point);
  }
  if (row.radius == 0 || c.normal.isZero(0)) return;
  row.axes = 3;
  row.frame = frame_of(c.normal);
  Jacobian<N> J;
  arm.point_jacobian(f, c.link, c.point, J);
  for (int i = 1; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    row.g[axis].noalias() = J.transpose() * row.frame.col(i);
  }
  row.friction = -friction_stiffness(c.material) * (row.frame.transpose() * row.before.anchor);
  row.friction.x() = 0;
}

template <int N>
void ContactSolve<N>::add(MeshContact<N>& c, Contacts<N>& contacts) {
  Row& row = next_row(c.depth.norm());
  row.mesh = &c;
  row.material = c.material;
  row.before = contacts.memory(c.id);
  row.radius = friction_radius(c.material, row.before.slipping);
  row.axes = 3;
  for (int i = 0; i < 3; ++i) row.g[static_cast<std::size_t>(i)] = c.J.row(i).transpose();
  row.push = row.before.push;
  if (row.radius > 0) row.friction = -friction_stiffness(c.material) * row.before.anchor;
  if (c.body != BodyContact::kStill) on_body(row, contacts.world(), c.body, c.center);
}

// Adds the magnet, which deeper contacts may not displace.
template <int N>
void ContactSolve<N>::add(typename Contacts<N>::Magnet& magnet, BodyWorld& world) {
  Row& row = next_row(std::numeric_limits<double>::infinity());
  row.magnet = &magnet;
  row.material = magnet.material;
  row.axes = 3;
  for (int i = 0; i < 3; ++i) row.g[static_cast<std::size_t>(i)] = magnet.J.row(i).transpose();
  row.push = world.magnet().force;
  on_body(row, &world, magnet.body, magnet.at);
}

// Makes a body the other side of a row.
template <int N>
void ContactSolve<N>::on_body(Row& row, BodyWorld* world, int body, const Vec3& point) {
  row.world = world;
  row.end = world->end_at(body, point);
}

template <int N>
Vec3 ContactSolve<N>::of_body(const Row& row) {
  Vec3 v = Vec3::Zero();
  if (row.world != nullptr) v = row.frame.transpose() * row.world->velocity(row.end);
  if (row.axes == 1) v.tail<2>().setZero();
  return v;
}

template <int N>
void ContactSolve<N>::learn(Row& row, const ContactAnswer<N>& answer, double T) {
  const auto axes = static_cast<std::size_t>(row.axes);
  for (std::size_t j = 0; j < axes; ++j) {
    row.Z[j] = answer.respond(row.g[j]);
    for (std::size_t i = 0; i < axes; ++i) {
      row.W(static_cast<int>(i), static_cast<int>(j)) = row.g[i].dot(row.Z[j].u);
    }
  }
  if (row.world != nullptr) {
    row.W_body = row.frame.transpose() * row.world->answer(row.end) * row.frame;
    row.W += row.W_body;
  }
  set_damping(row, answer, T);
  row.known = true;
}

template <int N>
void ContactSolve<N>::set_damping(Row& row, const ContactAnswer<N>& answer, double T) {
  if (answer.inertia == nullptr) {
    row.B = row.material.damping;
    return;
  }
  Vec<N> direction = row.g[0];
  Vec3 along = Vec3::UnitX();
  if (row.magnet != nullptr && !row.magnet->stretch.isZero(0)) {
    along = row.magnet->stretch.normalized();
    direction = row.magnet->J.transpose() * along;
  } else if (row.mesh != nullptr) {
    const FreeSpace& space = row.mesh->touch.space();
    along = !row.push.isZero(0)                        ? Vec3(row.push.normalized())
            : row.mesh->rank == 0 && space.count() > 0 ? space.normal(0)
                                                       : Vec3(row.mesh->direction.col(0));
    direction = row.mesh->J.transpose() * along;
  }
  double mass = 1 / direction.dot(answer.inertia->solve(direction));
  if (row.world != nullptr) {
    const double give = along.dot(row.W_body * along);
    mass = 1 / (1 / mass + give / (BodyMotion::kTheta * T));
  }
  const double jump = answer.jump * direction.norm();
  const double own = wall_damping(row.material.stiffness, mass, T, answer.damping, jump);
  row.B = std::min(own + row.material.damping, answer.most_damping * mass / T);
}

template <int N>
Vec3 ContactSolve<N>::speed(const Row& row, const Vec<N>& u) {
  Vec3 v = Vec3::Zero();
  for (int i = 0; i < row.axes; ++i) v[i] = row.g[static_cast<std::size_t>(i)].dot(u);
  return v;
}

template <int N>
void ContactSolve<N>::apply(Row& row, const Vec3& change, Motion<N>& motion) {
  if (row.world != nullptr) {
    row.world->push(row.end, -(row.frame * change));
    row.on_body += change;
  }
  for (int i = 0; i < row.axes; ++i) {
    if (change[i] != 0) motion.add(change[i], row.Z[static_cast<std::size_t>(i)]);
  }
}

template <int N>
double ContactSolve<N>::push_wall(Row& row, double T, Motion<N>& motion) {
  const double c = T * row.W(0, 0);
  const double v = row.g[0].dot(motion.u) - of_body(row).x();
  const double a = -T * v + c * row.push.x();
  const double F = wall_force({row.material.stiffness, row.B, T, row.wall->depth, a, c});
  const double change = F - row.push.x();
  apply(row, change * Vec3::UnitX(), motion);
  row.push.x() = F;
  return std::abs(change) + rub(row, T, Vec3::UnitX(), F, motion);
}

// The magnet's force f = -(K x + (K T/2 + B) v): spring and damper at the middle of the tick.
template <int N>
double ContactSolve<N>::push_magnet(Row& row, double T, Motion<N>& motion) {
  const Vec3 before = row.push;
  const Vec3 v0 = speed(row, motion.u) - of_body(row) - row.W * before;
  const double K = row.material.stiffness, k = K * T / 2 + row.B;
  const Mat3 stiff = Mat3::Identity() + k * row.W;
  row.push = -(stiff.inverse() * (K * row.magnet->stretch + k * v0));
  const Vec3 change = row.push - before;
  apply(row, change, motion);
  return change.norm();
}

template <int N>
double ContactSolve<N>::push_mesh(Row& row, double T, Motion<N>& motion) {
  const Vec3 before = row.push;
  const Vec3 a = T * (speed(row, motion.u) - of_body(row) - row.W * before);
  room_force(row.mesh->touch, {row.material.stiffness, row.B, T, row.mesh->center, a, T * row.W},
             row.push);
  const Vec3 change = row.push - before;
  apply(row, change, motion);
  const double force = row.push.norm();
  const Vec3 normal = force > 0 ? Vec3(row.push / force) : Vec3::UnitX();
  return change.norm() + rub(row, T, normal, force, motion);
}

// Force of a wall or a room without friction. The motion v, along the row's axes, excludes the
// force's effect on its own body. Returns the slope over v.
template <int N>
Mat3 ContactSolve<N>::push(Row& row, double T, const Vec3& v) {
  Mat3 slope = Mat3::Zero();
  const double K = row.material.stiffness;
  if (row.wall != nullptr) {
    const double a = -T * v.x(), c = T * row.W_body(0, 0);
    WallPush F = wall_push({K, row.B, T, row.wall->depth, a, 0});
    if (c > 0) {
      F.force = wall_force({K, row.B, T, row.wall->depth, a, c});
      const double on_D = wall_push({K, row.B, T, row.wall->depth, a - c * F.force, 0}).slope;
      F.slope = on_D / (1 + c * on_D);
    }
    row.push = F.force * Vec3::UnitX();
    slope(0, 0) = -T * F.slope;
  } else if (row.magnet != nullptr) {
    const double k = K * T / 2 + row.B;
    slope = -k * (Mat3::Identity() + k * row.W_body).inverse();
    row.push = slope / k * (K * row.magnet->stretch + k * v);
  } else if (row.world != nullptr) {
    const RoomTick tick{K, row.B, T, row.mesh->center, T * v, T * row.W_body};
    room_force(row.mesh->touch, tick, row.push);
    Mat3 on_D;
    room_push(row.mesh->touch,
              {K, row.B, T, row.mesh->center, T * (v + row.W_body * row.push), Mat3::Zero()}, on_D);
    slope = T * (Mat3::Identity() - T * on_D * row.W_body).inverse() * on_D;
  } else {
    Mat3 on_D;
    row.push =
        room_push(row.mesh->touch,
                  {row.material.stiffness, row.B, T, row.mesh->center, T * v, Mat3::Zero()}, on_D);
    slope = T * on_D;
  }
  return slope;
}

// Adds friction across the normal, and its slope while the normal is fixed.
template <int N>
void ContactSolve<N>::rub(Row& row, double T, const Vec3& v, Mat3& slope) {
  row.friction.setZero();
  const double force = row.push.norm();
  if (row.radius == 0 || row.axes < 3 || force == 0) return;
  const Vec3 normal = row.push / force;
  const Mat3 frame = row.wall != nullptr ? Mat3::Identity() : frame_of(normal);
  const auto across = frame.template rightCols<2>();
  const Vec3 anchor =
      row.wall != nullptr ? Vec3(row.frame.transpose() * row.before.anchor) : row.before.anchor;
  const double K_t = friction_stiffness(row.material);
  const Mat2 W = across.transpose() * row.W_body * across;
  const Mat2 stick = Mat2::Identity() + K_t * T * W;
  const Vec3 free = v + row.W_body * row.push;
  const Vec2 wanted = -K_t * (stick.inverse() * (across.transpose() * (anchor + T * free)));
  const double most = row.radius * force, size = wanted.norm();
  Mat2 on_v = -K_t * T * stick.inverse();
  Vec2 l = wanted;
  if (size > most) {
    const Vec2 along = wanted / size;
    l = row.world != nullptr ? friction_force(K_t, most, across.transpose() * anchor, T,
                                              across.transpose() * free, W)
                             : Vec2(most * along);
    on_v = most / size * (on_v - along * (along.transpose() * on_v));
    slope += across * (row.radius * along) * (normal.transpose() * slope).eval();
  }
  slope += across * on_v * across.transpose();
  row.friction = across * l;
}

template <int N>
void ContactSolve<N>::prepare(const ContactAnswer<N>& answer, double T) {
  for (Row& row : std::span(rows_.data(), static_cast<std::size_t>(count_))) {
    if (row.world != nullptr) {
      row.W_body = row.frame.transpose() * row.world->answer(row.end) * row.frame;
      row.body_free = of_body(row) + row.W_body * row.on_body;
      row.rubbed = row.friction;
    }
    set_damping(row, answer, T);
  }
}

// Response of a point to a force: `given`, as measured, along d, and W as before across it.
Mat3 answer_along(const Mat3& W, const Vec3& d, double given) {
  const Mat3 across = Mat3::Identity() - d * d.transpose();
  return std::clamp(given, 0.0, d.dot(W * d)) * d * d.transpose() + across * W * across;
}

template <int N>
double ContactSolve<N>::push_bodies(int turn) {
  if (world_ == nullptr) return 0;
  double most = 0;
  std::array<Vec3, kMost> changes, before;
  for (int i = 0; i < count_; ++i) {
    Row& row = rows_[static_cast<std::size_t>(i)];
    if (row.world == nullptr) continue;
    before[static_cast<std::size_t>(i)] = of_body(row);
    const Vec3 change = row.push + row.friction - row.on_body;
    changes[static_cast<std::size_t>(i)] = change;
    most = std::max(most, change.norm());
  }
  for (int i = 0; i < count_; ++i) {
    Row& row = rows_[static_cast<std::size_t>(i)];
    if (row.world == nullptr) continue;
    const Vec3& change = changes[static_cast<std::size_t>(i)];
    row.world->push(row.end, -(row.frame * change));
    row.on_body += change;
    row.rubbed = row.friction;
  }
  world_->sweep(true, kSettled, kMostSweeps);
  for (int i = 0; i < count_; ++i) {
    Row& row = rows_[static_cast<std::size_t>(i)];
    if (row.world == nullptr) continue;
    const Vec3& change = changes[static_cast<std::size_t>(i)];
    const double size = change.norm();
    const Vec3 now = of_body(row);
    if (turn > 0 && size > kFelt) {
      const Vec3 d = change / size;
      row.W_body =
          answer_along(row.W_body, d, d.dot(before[static_cast<std::size_t>(i)] - now) / size);
    }
    row.body_free = now + row.W_body * row.on_body;
  }
  return most;
}

template <int N>
void ContactSolve<N>::hold_bodies() {
  if (world_ == nullptr) return;
  world_->hold_touched();
  for (Row& row : std::span(rows_.data(), static_cast<std::size_t>(count_))) {
    if (row.world == nullptr) continue;
    row.W_body.setZero();
    row.body_free.setZero();
    row.rubbed.setZero();
  }
}

template <int N>
Vec<N> ContactSolve<N>::push(const Vec<N>& u, double T, Mat<N>* slope) {
  if (slope != nullptr) slope->setZero();
  for (Row& row : std::span(rows_.data(), static_cast<std::size_t>(count_))) {
    const Vec3 v = speed(row, u) - row.body_free;
    // Friction also moves a body along the normal; the last friction is used.
    Mat3 on_v = push(row, T, row.world != nullptr ? Vec3(v + row.W_body * row.rubbed) : v);
    rub(row, T, v, on_v);
    if (slope == nullptr || on_v.isZero(0)) continue;
    for (int i = 0; i < row.axes; ++i) {
      for (int j = 0; j < row.axes; ++j) {
        if (on_v(i, j) == 0) continue;
        const Vec<N>& torque = row.g[static_cast<std::size_t>(i)];
        slope->noalias() += on_v(i, j) * torque * row.g[static_cast<std::size_t>(j)].transpose();
      }
    }
  }
  return f2(u.size());
}

// Updates friction across the normal, in the row's axes.
template <int N>
double ContactSolve<N>::rub(Row& row, double T, const Vec3& normal, double force,
                            Motion<N>& motion) {
  if (row.radius == 0 || row.axes < 3) return 0;
  const Mat3 frame = row.wall != nullptr ? Mat3::Identity() : frame_of(normal);
  const auto across = frame.template rightCols<2>();
  const Vec3 before = row.friction;
  const Mat2 W = across.transpose() * row.W * across;
  const Vec2 b = across.transpose() * (speed(row, motion.u) - of_body(row) - row.W * before);
  const Vec3 anchor =
      row.wall != nullptr ? Vec3(row.frame.transpose() * row.before.anchor) : row.before.anchor;
  const Vec2 l = friction_force(friction_stiffness(row.material), row.radius * force,
                                across.transpose() * anchor, T, b, W);
  row.friction = across * l;
  const Vec3 change = row.friction - before;
  apply(row, change, motion);
  return change.norm();
}

// True if a row stays apart, for any forces of the other contacts alone.
template <int N>
bool ContactSolve<N>::apart(const Row& row, double T, const Vec<N>& u) {
  if (row.known || row.magnet != nullptr || !row.push.isZero(0) || !row.friction.isZero(0)) {
    return false;
  }
  if (row.wall != nullptr) {
    const double v = row.g[0].dot(u) - of_body(row).x();
    return row.wall->depth <= 0 && row.wall->depth - T * v <= 0;
  }
  if (row.mesh->touch.held() || row.mesh->rank > 0) return false;
  Vec3 x;
  FreeSpace::Active by;
  return row.mesh->touch.space().project(row.mesh->center + T * (speed(row, u) - of_body(row)), x,
                                         by) &&
         by.count == 0;
}

template <int N>
void ContactSolve<N>::solve(const ContactAnswer<N>& answer, double T, Motion<N>& motion) {
  const std::span<Row> rows(rows_.data(), static_cast<std::size_t>(count_));
  for (Row& row : rows) {
    row.known = false;
    if (row.push.isZero(0) && row.friction.isZero(0)) continue;
    learn(row, answer, T);
    apply(row, row.push + row.friction, motion);
  }
  double most = 0;
  settled_ = false;
  for (sweeps_ = 0; !settled_ && sweeps_ < kMostSweeps; ++sweeps_) {
    settled_ = true;
    last_change_ = 0;
    for (Row& row : rows) {
      if (apart(row, T, motion.u)) continue;
      if (!row.known) learn(row, answer, T);
      const double change = row.wall != nullptr     ? push_wall(row, T, motion)
                            : row.magnet != nullptr ? push_magnet(row, T, motion)
                                                    : push_mesh(row, T, motion);
      most = std::max(most, row.push.norm());
      settled_ = settled_ && change < kSettled * std::max(1.0, most);
      last_change_ = std::max(last_change_, change / std::max(1.0, most));
    }
    if (world_ != nullptr) {
      const double enough = kSettled * std::max(1.0, most);
      const double bodies = world_->sweep(true, enough, kSweepsOfBodies);
      settled_ = bodies <= enough && settled_;
      last_change_ = std::max(last_change_, bodies / std::max(1.0, most));
    } else if (count_ == 1 && rows_[0].radius == 0) {
      settled_ = true;
    }
  }
}

template <int N>
Vec<N> ContactSolve<N>::f2(Eigen::Index n) const {
  Vec<N> f = Vec<N>::Zero(n);
  for (const Row& row : std::span(rows_.data(), static_cast<std::size_t>(count_))) {
    const Vec3 force = row.push + row.friction;
    for (int i = 0; i < row.axes; ++i) f += force[i] * row.g[static_cast<std::size_t>(i)];
  }
  return f;
}

template <int N>
void ContactSolve<N>::finish(Contacts<N>& contacts) const {
  if (world_ != nullptr) {
    world_->settle();
    for (const Row& row : std::span(rows_.data(), static_cast<std::size_t>(count_))) {
      if (row.world != nullptr) world_->book(row.end, -(row.frame * row.on_body));
    }
    world_->finish();
  }
  contacts.forget();  // those that are gone, too
  const auto keep = [&](std::size_t id, const Row& row) {
    const double force = row.push.norm(), rubs = row.friction.norm();
    ContactMemory& now = contacts.memory(id);
    now.push = row.push;
    now.anchor = -(row.frame * row.friction) / friction_stiffness(row.material);
    const double limit = row.radius * force * (1 - 1e-9);
    // Without kinetic friction a contact that slips goes on until it is lifted.
    now.slipping = force > 0 && (row.radius > 0 ? rubs >= limit : row.before.slipping);
  };
  for (const Row& row : std::span(rows_.data(), static_cast<std::size_t>(count_))) {
    if (row.wall != nullptr) {
      row.wall->force = row.push.x();
      row.wall->friction = row.frame * row.friction;
      keep(row.wall->id, row);
    } else if (row.magnet != nullptr) {
      row.magnet->force = row.push;
      world_->pulled(row.push);
    } else {
      row.mesh->force = row.push + row.friction;
      keep(row.mesh->id, row);
    }
  }
}

template class ContactSolve<3>;
template class ContactSolve<kAnyDof>;

}  // namespace limpid
