#include "core/touch/contact_solve.h"

#include <Eigen/LU>
#include <algorithm>
#include <variant>

namespace limpid {

namespace {

constexpr double kSettled = 1e-8;   // largest change of a settled force, relative to it or to 1 N
constexpr double kFelt = 1e-7;      // least change of a force that shows a body's response [N]
constexpr int kSweepsOfBodies = 5;  // sweeps over other bodies for each one over touched ones

}  // namespace

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
  for_each_of(contacts.magnet_first(), [&](auto& c) {
    c.rest();
    if (!c.may_touch(world_, u, T)) return;
    if (count_ == kMost && c.deep() <= std::ranges::min(depths_)) return;
    Row& row = next_row(c.deep());
    row.source = &c;
    row.material = c.material;
    if (c.body != BodyContact::kStill) {
      row.world = world_;
      row.end = world_->end_at(c.body, c.place());
    }
    if constexpr (std::decay_t<decltype(c)>::kRemembers) {
      row.before = contacts.memory(c.id);
      row.radius = friction_radius(c.material, row.before.slipping);
    }
    c.start(row, arm, f);
  });
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
  Vec3 along = Vec3::UnitX();
  const Vec<N> direction =
      std::visit([&](const auto* c) { return c->damped(row, along); }, row.source);
  double mass = 1 / direction.dot(answer.inertia->solve(direction));
  if (row.world != nullptr) {
    const double give = along.dot(row.W_body * along);
    mass = 1 / (1 / mass + give / (BodyMotion::kTheta * T));
  }
  const double jump = answer.jump * direction.norm();
  const double own = wall_damping(row.material.stiffness, mass, T, answer.damping, jump);
  row.B = std::min(own + row.material.damping, answer.most_damping * mass / T);
}

// Adds friction across the normal, and its slope while the normal is fixed.
template <int N>
void ContactSolve<N>::rub(Row& row, double T, const Vec3& v, Mat3& slope) {
  row.friction.setZero();
  const double force = row.push.norm();
  if (row.radius == 0 || row.axes < 3 || force == 0) return;
  const Vec3 normal = row.push / force;
  const Mat3 frame = row.across(normal);
  const auto across = frame.template rightCols<2>();
  const Vec3 anchor = row.anchor();
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
  for (Row& row : rows()) {
    if (row.world != nullptr) {
      row.W_body = row.frame.transpose() * row.world->answer(row.end) * row.frame;
      row.body_free = row.of_body() + row.W_body * row.on_body;
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
    before[static_cast<std::size_t>(i)] = row.of_body();
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
    const Vec3 now = row.of_body();
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
  for (Row& row : rows()) {
    if (row.world == nullptr) continue;
    row.W_body.setZero();
    row.body_free.setZero();
  }
}

template <int N>
Vec<N> ContactSolve<N>::push(const Vec<N>& u, double T, Mat<N>* slope, Slope how) {
  if (slope != nullptr) slope->setZero();
  for (Row& row : rows()) {
    const Vec3 v = row.speed(u) - row.body_free;
    // Friction also moves a body along the normal; the last friction is used.
    const Vec3 own = row.world != nullptr ? Vec3(v + row.W_body * row.rubbed) : v;
    Mat3 on_v = std::visit([&](const auto* c) { return c->push(row, T, own, how); }, row.source);
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

// True if a row stays apart, for any forces of the other contacts alone.
template <int N>
bool ContactSolve<N>::apart(const Row& row, double T, const Vec<N>& u) {
  if (row.known || !row.push.isZero(0) || !row.friction.isZero(0)) return false;
  return std::visit([&](const auto* c) { return c->apart(row, T, u); }, row.source);
}

template <int N>
void ContactSolve<N>::solve(const ContactAnswer<N>& answer, double T, Motion<N>& motion) {
  for (Row& row : rows()) {
    row.known = false;
    if (row.push.isZero(0) && row.friction.isZero(0)) continue;
    learn(row, answer, T);
    row.apply(row.push + row.friction, motion);
  }
  double most = 0;
  settled_ = false;
  for (sweeps_ = 0; !settled_ && sweeps_ < kMostSweeps; ++sweeps_) {
    settled_ = true;
    last_change_ = 0;
    for (Row& row : rows()) {
      if (apart(row, T, motion.u)) continue;
      if (!row.known) learn(row, answer, T);
      const double change =
          std::visit([&](const auto* c) { return c->solve(row, T, motion); }, row.source);
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
  for (const Row& row : rows()) {
    const Vec3 force = row.push + row.friction;
    for (int i = 0; i < row.axes; ++i) f += force[i] * row.g[static_cast<std::size_t>(i)];
  }
  return f;
}

template <int N>
HeldContacts<N> ContactSolve<N>::held(const Vec<N>& u, double T) const {
  HeldContacts<N> held{Vec<N>::Zero(u.size())};
  for (const Row& row : rows()) {
    const Vec3 v = row.speed(u) - row.of_body();
    const Vec3 spring =
        std::visit([&](const auto* c) { return c->spring_after(row, T * v); }, row.source);
    const double size = spring.norm();
    if (!(size > 0)) continue;
    const Vec3 normal = spring / size;
    const double approach = -T * normal.dot(v);
    const double force = std::max(0.0, size + row.material.damping * approach / T);
    const double most = row.radius * force, rubs = row.friction.norm();
    const Vec3 friction = rubs > most ? Vec3(most / rubs * row.friction) : row.friction;
    const Vec3 all = force * normal + friction;
    for (int i = 0; i < row.axes; ++i) held.torque += all[i] * row.g[static_cast<std::size_t>(i)];
    held.stored += size * size / (2 * row.material.stiffness) +
                   friction.squaredNorm() / (2 * friction_stiffness(row.material));
    held.spring_work += row.material.stiffness * approach * approach / 2;
  }
  return held;
}

template <int N>
void ContactSolve<N>::finish(Contacts<N>& contacts) const {
  if (world_ != nullptr) {
    world_->settle();
    for (const Row& row : rows()) {
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
  for (const Row& row : rows()) {
    std::visit(
        [&](auto* c) {
          c->finish(row);
          if constexpr (std::remove_pointer_t<decltype(c)>::kRemembers) keep(c->id, row);
        },
        row.source);
  }
}

template class ContactSolve<3>;
template class ContactSolve<7>;
template class ContactSolve<kAnyDof>;

}  // namespace limpid
