#include "core/touch/body_world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace limpid {
namespace {

// Change of a force that counts as settled, for bodies that the arm touches, and for others [N].
constexpr double kEnough = 1e-8;
constexpr double kEnoughElse = 1e-5, kEnoughOfMass = 1e-2;  // [N], [N/kg]
constexpr int kMostSweeps = 30;  // most sweeps over bodies that the arm touches
constexpr int kFewSweeps = 10, kManySweeps = 60;
constexpr std::size_t kMostRowsSwept = 2000;  // rows in a tick's sweeps beyond kFewSweeps: 0.2 ms
// A body rests while it is slower than this: one that something bears if it also stays where it is
// [m/s, m]; one that nothing bears.
constexpr double kSlow = 1e-3, kStays = 5e-6, kStill = 1e-8;
constexpr double kReach = 0.05;  // distance at which turning counts as moving [m]
constexpr double kQuiet = 0.5;   // time of rest before a body sleeps [s]
constexpr double kGone = 20;     // distance at which a body is given up [m]
// Energy of forces that are right but for rounding and for what is settled, by the lightest mass
// [J/kg].
constexpr double kMade = 1e-10;
constexpr double kFew = 1e4;  // times this energy is taken from the motion, and needs no standstill
constexpr double kUnbounded = std::numeric_limits<double>::infinity();
constexpr int kMostMeetings = 8;     // of a quick body in a tick
constexpr int kMostPartings = 100;   // sweeps over contacts that part
constexpr double kSameSpeed = 1e-9;  // change of speed at which they end [m/s]
constexpr int kMostRounds = 4;       // rounds of sweeps for forces that make energy
// Rounds of sweeps for bodies that turn by far in a tick. Their turning counts as assumed if the
// way in a tick and its error, multiplied, are less than the first of these; by more than the
// second none is assumed [rad^2].
constexpr int kMostTurnings = 5;
constexpr double kSameTurn2 = 2.5e-5, kTooFar2 = 1;
constexpr double kSamePlace = 1e-12;  // change of a spring's way that is none [m]
constexpr double kHitsFollow = -1;    // stands for the pair of a contact where hits follow

// Calls visit(forces along it) for each joint that may have stops.
template <class Constraints, class Visit>
void for_each_hit(Constraints& constraints, const Visit& visit) {
  for (auto& joint : constraints.world_joints) visit(joint.along);
  for (auto& between : constraints.joints_between) visit(between.joint.forces);
}

}  // namespace

Bodies::Bodies(const Scene& scene) {
  for (const Object& object : scene.objects) {
    objects.push_back(object.material);
    if (!object.body) continue;
    motions.emplace_back(object, scene.gravity);
    about.push_back(*object.body);
  }
  awake.assign(motions.size(), 1);
  pressed.assign(motions.size(), 0);
}

BodyWorld::BodyWorld(const Scene& scene) : bodies_(scene), geometry_(scene) {
  for (const Object& object : scene.objects) {
    body_of_.push_back(object.body ? static_cast<int>(names_.size()) : BodyContact::kStill);
    if (object.body) names_.push_back(object.name);
  }
  const std::size_t n = names_.size();
  touched_.assign(n, 0);
  tied_.assign(n, 0);
  linked_.assign(n, 0);
  turned_.assign(n, 0);
  if (geometry_.any_round()) next_.assign(n, Pose::Identity());
  for (int i = 0; i < count(); ++i) {
    const Body& body = bodies_.about[at(i)];
    tied_[at(i)] = body.joint ? 1 : 0;
    stops_in_.push_back(std::sqrt(bodies_[i].mass() / body.contact_stiffness));
  }
  passing_.reserve(n);
  started_.resize(n);
  quiet_island_.assign(n, 0);
  quiet_.assign(n, 0);
  quiet_at_.assign(n, Pose::Identity());
  made_.assign(n, 0);
  moving_.assign(n, 0);
  slower_.assign(n, 1);
  parting_.reserve(BodyGeometry::kMost);
  parent_.assign(n, 0);
  quick_.reserve(n);
  enough_else_ = kEnoughElse;
  right_ = std::numeric_limits<double>::infinity();
  for (const BodyMotion& motion : bodies_.motions) {
    enough_else_ = std::min(enough_else_, kEnoughOfMass * motion.mass());
    right_ = std::min(right_, kMade * motion.mass());
  }
  add_links(scene);
  for (const JointLink& link : constraints_.joint_links)
    linked_[at(link.a)] = linked_[at(link.b)] = 1;
  for_each_of(constraints_.lasting(), [&](const auto& c) {
    for (const int body : {int{c.a}, int{c.b}}) {
      if (body != BodyContact::kStill) tied_[at(body)] = 1;
    }
  });
  constraints_.pairs.reserve(BodyGeometry::kMost);
  constraints_.pulls.reserve(1);
  std::size_t most = BodyGeometry::kMost + 1;
  for_each_of(constraints_.lasting(), [&](const auto&) { ++most; });
  for (auto* numbers : {&before_, &now_, &along_}) numbers->assign(3 * most, 0);
  reset();
}

// Adds joints and springs.
void BodyWorld::add_links(const Scene& scene) {
  auto& [pairs, joint_links, springs, world_joints, joints_between, pulls] = constraints_;
  joint_links.reserve(3 * names_.size());  // joints look at their links
  for (int i = 0; i < count(); ++i) {
    const auto& joint = bodies_.about[at(i)].joint;
    if (bodies_[i].on_joint()) world_joints.push_back({i, {}});
    if (bodies_[i].on_joint() || !joint) continue;
    const int to = number(joint->to);
    const std::size_t first = joint_links.size();
    if (to != BodyContact::kStill) limpid::add_links(bodies_, i, to, joint_links);
    if (to == BodyContact::kStill && !HeldJoint::needed(*joint)) continue;
    joints_between.emplace_back(bodies_, i, to, std::span(joint_links).subspan(first));
  }
  for (const BodySpring& spring : scene.springs) {
    SpringLink link;
    link.spring = spring;
    link.a = number(spring.between[0]);
    link.b = number(spring.between[1]);
    link.on_a = spring.points[0];
    link.on_b = spring.points[1];
    if (link.a == BodyContact::kStill) {
      std::swap(link.a, link.b);
      std::swap(link.on_a, link.on_b);
    }
    if (link.a != BodyContact::kStill) springs.push_back(link);  // else between fixed ends
  }
}

int BodyWorld::number(const std::string& name) const {
  const auto found = std::ranges::find(names_, name);
  return found == names_.end() ? BodyContact::kStill : static_cast<int>(found - names_.begin());
}

void BodyWorld::reset() {
  for (BodyMotion& body : bodies_.motions) body.reset();
  std::ranges::fill(bodies_.awake, 1);
  std::ranges::fill(bodies_.pressed, 0);
  std::ranges::fill(quiet_, 0);
  for_each_of(constraints_.in_files(), [](auto& c) {
    constexpr decltype(c.numbers()) kAtRest{};
    c.read(kAtRest.data());
  });
  let_go();
  geometry_.forget();
  for (int i = 0; i < count(); ++i) geometry_.place(i, pose(i));
  constraints_.pairs.clear();
  fresh_ = true;
  given_ = given_now_ = all_given_ = all_pulled_ = energy_ = first_energy_ = gain_ = 0;
  stood_still_ = turned_less_ = 0;
}

void BodyWorld::take_over(const BodyWorld& other) {
  given_ = other.given_;
  all_given_ = other.all_given_;
  all_pulled_ = other.all_pulled_;
  gain_ = other.gain_;
  std::array<double, BodyMotion::kNumbers> numbers{};
  for (int i = 0; i < count(); ++i) {
    const int theirs = other.number(names_[at(i)]);
    if (theirs == BodyContact::kStill || !bodies_[i].alike(other.bodies_[theirs])) continue;
    const BodyMotion& before = other.bodies_[theirs];
    before.write(numbers);
    // Keeps the object's place, although its centre of mass may have moved.
    const Vec3 own = pose(i).inverse() * bodies_[i].turns_at();
    const Vec3 moved = before.pose() * own - before.turns_at();
    if (moved.norm() > 1e-12) {
      const Vec3 speed = before.spin().cross(moved);
      for (std::size_t k = 0; k < 3; ++k) {
        numbers[k] += moved[static_cast<int>(k)];
        numbers[12 + k] += speed[static_cast<int>(k)];
      }
    }
    bodies_[i].read(numbers);
    geometry_.place(i, pose(i));
  }
  for (JointBetween& own : constraints_.joints_between) {
    for (const JointBetween& theirs : other.constraints_.joints_between) {  // sides may be swapped
      if (names_[at(own.a)] == other.names_[at(theirs.a)]) own.joint.place = theirs.joint.place;
    }
    own.follow(bodies_);
  }
}

void BodyWorld::wake(int body) {
  bodies_.awake[at(body)] = 1;
  quiet_[at(body)] = 0;
}

void BodyWorld::touch(int body) {
  touched_[at(body)] = 1;
  wake(body);
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
  for (const JointBetween& between : constraints_.joints_between) {
    if (between.a == body) return between.joint.place;
  }
  return bodies_[body].joint();
}

void BodyWorld::begin(double T) {
  bodies_.T = T;
  sweeps_ = 0;
  if (pull_.body >= count()) pull_ = {};
  if (pull_.body != BodyContact::kStill) wake(pull_.body);
  wake_neighbours();
  for (std::size_t i = 0; i < next_.size(); ++i) {
    const auto body = static_cast<int>(i);
    next_[i] = moves(body) ? bodies_[body].ahead(0.5 * T) : pose(body);
  }
  geometry_.search(bodies_.awake, next_);
  for (int i = 0; i < count(); ++i) {
    if (moves(i)) bodies_[i].begin(T, bodies_.pressed[at(i)] != 0);
  }
  for (int& ticks : bodies_.pressed) ticks = std::max(0, ticks - 1);
  constraints_.pairs.clear();
  for (BodyContact* contact : geometry_.points()) {
    if (moves(contact->a) || moves(contact->b)) constraints_.pairs.emplace_back(*contact);
  }
  constraints_.pulls.clear();
  if (moves(pull_.body)) constraints_.pulls.emplace_back(pull_);
  find_islands();
  for_each_of(constraints_.all(), [&](auto& c) {
    if (!c.off() && (moves(c.a) || moves(c.b))) c.prepare(bodies_);
  });
  take_stock();
}

// Wakes bodies that a moving body comes near to or is linked to.
void BodyWorld::wake_neighbours() {
  const auto quick = [&](int i) { return moves(i) && quiet_[at(i)] == 0; };
  for_each_of(constraints_.lasting(), [&](const auto& c) {
    if (!c.kWakes || c.b == BodyContact::kStill || c.off()) return;
    if (quick(c.a) && !moves(c.b)) wake(c.b);
    if (quick(c.b) && !moves(c.a)) wake(c.a);
  });
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
  for_each_of(constraints_.all(), [&](const auto& c) {
    if (!c.off()) join(c.a, c.b);
  });
  std::ranges::fill(made_, 0.0);
  // An island counts as touched if one of its bodies is.
  for (int i = 0; i < count(); ++i) {
    if (touched_[at(i)] != 0) touched_[at(root(i))] = 1;
  }
}

bool BodyWorld::in_turn(int a, int b, bool touched) {
  const int body = moves(a) ? a : b;
  return moves(body) && (touched_[at(root(body))] != 0) == touched;
}

double BodyWorld::sweep(bool touched) {
  double most = 0;
  for_each_of(constraints_.in_sweeps(), [&](auto& c) {
    if (!c.off() && in_turn(c.a, c.b, touched)) most = std::max(most, c.solve(bodies_));
  });
  return most;
}

std::size_t BodyWorld::forces(std::vector<double>& into) {
  double* to = into.data();
  for_each_of(constraints_.all(), [&](const auto& c) {
    const Vec3 of_it = c.forces();
    to = std::copy_n(of_it.data(), 3, to);
  });
  return static_cast<std::size_t>(to - into.data());
}

void BodyWorld::add_forces(const std::vector<double>& more) {
  const double* at = more.data();
  for_each_of(constraints_.all(), [&](auto& c) {
    c.add(bodies_, Vec3(at[0], at[1], at[2]));
    at += 3;
  });
}

// Finds the response of bodies on joints anew, and the joints' levers, where they turn otherwise
// than was assumed, by `before` at most. Returns by how much; zero: nothing is done [rad^2].
double BodyWorld::turn_again(bool touched, double before) {
  double most = 0;
  for (int i = 0; i < count(); ++i) {
    const bool turns = linked_[at(i)] != 0 && in_turn(i, i, touched);
    const double otherwise = turns ? bodies_[i].turns_otherwise(bodies_.T) : 0;
    turned_[at(i)] = otherwise > kSameTurn2 ? 1 : 0;
    most = std::max(most, otherwise);
  }
  if (most <= kSameTurn2 || most > before) return 0;
  const auto turned = [&](int body) {
    return body != BodyContact::kStill && turned_[at(body)] != 0;
  };
  for (int i = 0; i < count(); ++i) {
    if (turned(i)) bodies_[i].turn_again(bodies_.T);
  }
  for (JointLink& link : constraints_.joint_links) {
    if (turned(link.a) || turned(link.b)) link.turn(bodies_);
  }
  for (JointBetween& joint : constraints_.joints_between) {
    if (turned(joint.a) || turned(joint.b)) joint.turn(bodies_);
  }
  return most;
}

// Takes the places of springs by the spins found so far; returns the largest change of a way [m].
double BodyWorld::turn_springs(bool touched) {
  double most = 0;
  for (SpringLink& spring : constraints_.springs) {
    if (!spring.off() && in_turn(spring.a, spring.b, touched))
      most = std::max(most, spring.turn(bodies_));
  }
  return most;
}

// Ends where bodies turn as was assumed, or where that comes no nearer.
void BodyWorld::sweep_turning(bool touched, double enough, int most) {
  sweep(touched, enough, most);
  for (int i = 0; i < kMostTurnings && turn_springs(touched) > kSamePlace; ++i)
    sweep(touched, enough, most);
  if (constraints_.joint_links.empty()) return;
  double otherwise = kTooFar2;
  for (int i = 0; i < kMostTurnings; ++i) {
    otherwise = turn_again(touched, otherwise);
    if (otherwise == 0) return;
    sweep(touched, enough, most);
  }
}

double BodyWorld::sweep(bool touched, double enough, int most) {
  double last2 = 0;
  for (int i = 1;; ++i) {
    const std::size_t numbers = forces(before_);
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
  given_now_ += bodies_.T * force.dot(velocity(end));
}

void BodyWorld::halt(int body) {
  bodies_[body].halt();
  bodies_.awake[at(body)] = 0;
}

void BodyWorld::hold_touched() {
  for_each_of(constraints_.all(), [&](auto& c) {
    if (in_turn(c.a, c.b, true)) c.hold(bodies_);
  });
  // Puts touched islands to sleep; those near the tip or a moving body wake at the next tick.
  for (int i = 0; i < count(); ++i) parent_[at(i)] = root(i);
  for (int i = 0; i < count(); ++i) {
    if (moves(i) && touched_[at(parent_[at(i)])] != 0) halt(i);
  }
}

void BodyWorld::settle() {
  sweep_turning(true, kEnough, kMostSweeps);
  const auto many =
      static_cast<int>(kMostRowsSwept / std::max<std::size_t>(1, constraints_.pairs.size()));
  sweep_turning(false, enough_else_, std::clamp(many, kFewSweeps, kManySweeps));
  settle_what_makes_energy();
}

void BodyWorld::add_up_made() {
  std::ranges::fill(made_, 0);
  for (int i = 0; i < count(); ++i) {
    if (moves(i)) made_[at(root(i))] += bodies_[i].made(bodies_.T);
  }
  for_each_of(constraints_.all(), [&](const auto& c) {
    if (c.off() || !(moves(c.a) || moves(c.b))) return;
    made_[at(root(moves(c.a) ? c.a : c.b))] += c.made(bodies_);
  });
}

void BodyWorld::settle_what_makes_energy() {
  const auto makes = [&](int i) { return moves(i) && !(made_[at(root(i))] <= right_); };
  for (int round = 0; round < kMostRounds; ++round) {
    add_up_made();
    bool touched = false, others = false;
    for (int i = 0; i < count(); ++i) {
      if (makes(i)) (touched_[at(root(i))] != 0 ? touched : others) = true;
    }
    if (!touched && !others) return;
    if (touched) sweep(true, kEnough, kMostSweeps);
    if (others) sweep(false, kEnough, kManySweeps);
  }
  add_up_made();
}

// Takes energy that was made from the motion at the tick's end; what is mostly made up stands
// still.
void BodyWorld::hold_what_is_made_up() {
  std::ranges::fill(slower_, 1.0);
  if (std::ranges::all_of(made_, [this](double made) { return made <= right_; })) return;
  std::ranges::fill(moving_, 0.0);
  for (int i = 0; i < count(); ++i) {
    if (moves(i)) moving_[at(root(i))] += bodies_[i].kinetic_after();
  }
  const auto stands = [&](int island) {
    const double made = made_[at(island)];
    return !(made <= kFew * right_ || 2 * made <= moving_[at(island)]);
  };
  bool any = false;
  for (int i = 0; i < count(); ++i) {
    const int island = moves(i) ? root(i) : 0;
    if (!moves(i) || made_[at(island)] <= right_) continue;
    slower_[at(island)] = std::sqrt(std::max(0.0, 1 - made_[at(island)] / moving_[at(island)]));
    if (!stands(island)) continue;
    slower_[at(island)] = 1;
    bodies_[i].halt();
    any = true;
  }
  if (!any) return;
  ++stood_still_;
  for_each_of(constraints_.all(), [&](auto& c) {
    if (c.off() || !(moves(c.a) || moves(c.b))) return;
    const int island = root(moves(c.a) ? c.a : c.b);
    if (!(made_[at(island)] <= right_) && stands(island)) c.hold(bodies_);
  });
}

void BodyWorld::finish() {
  passing_.clear();
  given_ = given_now_;
  all_given_ += given_now_;
  given_now_ = 0;
  hold_what_is_made_up();
  for (const PullLink& pull : constraints_.pulls) all_pulled_ += pull.work(bodies_);
  for_each_of(constraints_.all(), [&](auto& c) { c.finish(bodies_); });
  bool less = std::ranges::any_of(constraints_.joints_between, [this](const JointBetween& c) {
    return c.joint.turns_less && (moves(c.a) || moves(c.b));
  });
  for (int i = 0; i < count(); ++i) {
    if (!moves(i)) continue;
    BodyMotion& body = bodies_[i];
    if (is_quick(i)) {
      started_[at(i)] = body.pose();
      passing_.push_back(i);
    }
    body.finish(bodies_.T);
    if (linked_[at(i)] != 0 && body.limit_spin(bodies_.T)) less = true;
    if (!body.finite()) body.reset();
    if (const double by = slower_[at(root(i))]; by != 1) body.slow_down(by);
    geometry_.place(i, pose(i));
  }
  turned_less_ += less ? 1 : 0;
  for (const int i : passing_) bounce(i);
  part();
  fall_asleep();
  std::ranges::fill(touched_, 0);
}

// A body by itself that is quick enough to pass something before a contact stops it.
bool BodyWorld::is_quick(int body) const {
  if (tied_[at(body)] != 0 || magnet_.body == body) return false;
  const double time = std::max(bodies_.T, stops_in_[at(body)]);
  const BodyMotion& motion = bodies_[body];
  return geometry_.may_pass(body, time * motion.velocity(Vec3::Zero()).norm(),
                            time * motion.turning().norm());
}

// Lets a quick body meet what is in its way within the tick: it bounces there, and flies on. After
// a number of meetings it stays for the rest of the tick.
void BodyWorld::bounce(int body) {
  BodyMotion& motion = bodies_[body];
  const double times = std::max(1.0, stops_in_[at(body)] / bodies_.T);
  Pose start = started_[at(body)];
  double left = bodies_.T;
  for (int i = 0; i < kMostMeetings; ++i) {
    const Vec3 center = motion.pose().inverse() * motion.center();
    const Meeting meeting = geometry_.first_meeting(body, start, motion.pose(), center, times);
    if (meeting.part == 1) break;
    left *= 1 - meeting.part;
    motion.go_back(start, meeting.part, left);
    strike(meeting);
    start = motion.pose();
    if (i + 1 < kMostMeetings) motion.fly(left);
  }
  geometry_.place(body, pose(body));
}

// Gives two that meet impulses after Moreau: none of their points approaches with more than the
// restitution leaves, or pulls. Then friction, at most as much as stops a point across. Neither
// gives energy.
void BodyWorld::strike(const Meeting& meeting) {
  for (const int body : {meeting.a, meeting.b}) {
    if (body != BodyContact::kStill) wake(body);
  }
  const auto points = std::span(meeting.points).first(meeting.count);
  const auto speed = [&](const Meeting::Point& point) -> Vec3 {
    return bodies_.speed_at(meeting.a, point.at) - bodies_.speed_at(meeting.b, point.at);
  };
  const auto give = [&](const Vec3& at, const Vec3& n, double change, double least, double most) {
    const double yields = bodies_.yields(meeting.a, at, n) + bodies_.yields(meeting.b, at, n);
    const double impulse = yields > 0 ? std::clamp(change / yields, least, most) : 0;
    bodies_.strike(meeting.a, at, impulse * n);
    bodies_.strike(meeting.b, at, -impulse * n);
    return impulse;
  };
  std::array<double, 4> before{}, pressed{};
  double approach = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    before[i] = points[i].normal.dot(speed(points[i]));
    approach = std::max(approach, -before[i]);
  }
  const auto restitution = [&](int body) {
    return body == BodyContact::kStill ? 0.0 : bodies_.about[at(body)].restitution;
  };
  const double e =
      approach > Impact::kSlowest ? std::max(restitution(meeting.a), restitution(meeting.b)) : 0;
  double change = 1;
  for (int round = 0; round < kMostPartings && change > kSameSpeed; ++round) {
    change = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double more = -e * before[i] - points[i].normal.dot(speed(points[i]));
      const double given = give(points[i].at, points[i].normal, more, -pressed[i], kUnbounded);
      pressed[i] += given;
      if (given != 0) change = std::max(change, std::abs(more));
    }
  }
  const double friction = std::max(bodies_.objects[at(meeting.object_a)].friction_kinetic,
                                   bodies_.objects[at(meeting.object_b)].friction_kinetic);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 slides = speed(points[i]);
    const Vec3 across = slides - points[i].normal.dot(slides) * points[i].normal;
    if (across.norm() < kStill) continue;
    give(points[i].at, -across.normalized(), across.norm(), 0, friction * pressed[i]);
  }
}

// Ends impacts: gives contacts that now part their speed, all of them together.
void BodyWorld::part() {
  parting_.clear();
  for (BodyPair& pair : constraints_.pairs) {
    if (pair.turns(bodies_)) parting_.push_back(&pair);
  }
  double change = parting_.empty() ? 0 : 1;
  for (int i = 0; i < kMostPartings && change > kSameSpeed; ++i) {
    change = 0;
    for (const BodyPair* pair : parting_) change = std::max(change, pair->part(bodies_));
  }
}

// Puts an island to sleep after all of it has been at rest for a while.
void BodyWorld::fall_asleep() {
  const auto long_enough = static_cast<int>(kQuiet / bodies_.T);
  for (int i = 0; i < count(); ++i) {
    if (!moves(i)) continue;
    const BodyMotion& body = bodies_[i];
    const bool borne = bodies_.pressed[at(i)] == Bodies::kPressed;
    const double most = borne ? kSlow : kStill;
    const bool slow = body.speed().norm() < most && kReach * body.spin().norm() < most;
    const Pose& then = quiet_at_[at(i)];
    const Mat3& R = body.pose().linear();
    const bool stays = (body.center() - then.translation()).norm() < kStays &&
                       kReach * (R - then.linear()).norm() < kStays;
    const bool gone = body.center().norm() > kGone;
    quiet_[at(i)] = slow && stays ? quiet_[at(i)] + 1 : 0;
    if (quiet_[at(i)] == 0) {
      quiet_at_[at(i)].translation() = body.center();
      quiet_at_[at(i)].linear() = R;
    }
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
    if (moves(i) && quiet_island_[at(parent_[at(i)])] != 0) halt(i);
  }
}

void BodyWorld::take_stock() {
  double E = 0;
  for (const BodyMotion& body : bodies_.motions) {
    E += body.kinetic() + body.weight_energy();
    if (body.on_joint()) E += body.potential().energy(body.joint());
  }
  for (const BodyContact* c : geometry_.points()) E += BodyPair::energy(*c, bodies_);
  for_each_of(constraints_.lasting(), [&](const auto& c) {
    if (!c.off()) E += c.energy(bodies_);
  });
  energy_ = E;
  const double from_outside = all_given_ + all_pulled_;
  if (fresh_) first_energy_ = E - from_outside - gain_;
  fresh_ = false;
  gain_ = E - first_energy_ - from_outside;
}

int BodyWorld::awake() const {
  return static_cast<int>(std::ranges::count_if(bodies_.awake, [](auto a) { return a != 0; }));
}

void BodyWorld::write(std::vector<double>& into) const {
  std::array<double, BodyMotion::kNumbers> numbers{};
  into.push_back(count());
  into.push_back(
      static_cast<double>(constraints_.joint_links.size() + constraints_.springs.size()));
  into.insert(into.end(),
              {double(magnet_.body), magnet_.point.x(), magnet_.point.y(), magnet_.point.z(),
               magnet_.force.x(), magnet_.force.y(), magnet_.force.z(), magnet_.spent ? 1.0 : 0.0});
  for (int i = 0; i < count(); ++i) {
    bodies_[i].write(numbers);
    into.insert(into.end(), numbers.begin(), numbers.end());
    for (const int n : {int{bodies_.awake[at(i)]}, bodies_.pressed[at(i)], quiet_[at(i)]})
      into.push_back(n);
    const auto& then = quiet_at_[at(i)].matrix();
    for (int k = 0; k < 12; ++k) into.push_back(then(k % 3, k / 3));
  }
  for_each_of(constraints_.in_files(), [&](const auto& c) {
    const auto numbers_of_it = c.numbers();
    into.insert(into.end(), numbers_of_it.begin(), numbers_of_it.end());
  });
  geometry_.write(into);
  bool any = false;
  for_each_hit(constraints_, [&](const JointForces& along) { any |= along.kept_hit() != 0; });
  if (!any) return;
  into.push_back(kHitsFollow);
  for_each_hit(constraints_, [&](const JointForces& along) { into.push_back(along.kept_hit()); });
}

bool BodyWorld::read(std::span<const double> from) {
  constexpr std::size_t kMagnet = 8, kBody = BodyMotion::kNumbers + 3 + 12;
  std::size_t own = 2 + kMagnet + kBody * names_.size();
  for_each_of(constraints_.in_files(), [&](const auto& c) { own += c.numbers().size(); });
  if (from.size() < own || from[0] != count() ||
      from[1] !=
          static_cast<double>(constraints_.joint_links.size() + constraints_.springs.size()) ||
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
    bodies_[i].read(from.first<BodyMotion::kNumbers>());
    bodies_.awake[at(i)] = from[BodyMotion::kNumbers] != 0 ? 1 : 0;
    bodies_.pressed[at(i)] = static_cast<int>(from[BodyMotion::kNumbers + 1]);
    quiet_[at(i)] = static_cast<int>(from[BodyMotion::kNumbers + 2]);
    for (int k = 0; k < 12; ++k) {
      quiet_at_[at(i)].matrix()(k % 3, k / 3) = from[BodyMotion::kNumbers + 3 + std::size_t(k)];
    }
    geometry_.place(i, pose(i));
  }
  for_each_of(constraints_.in_files(), [&](auto& c) {
    c.read(from.data());
    from = from.subspan(c.numbers().size());
  });
  from = geometry_.read(from);
  if (from.empty() || from[0] != kHitsFollow) return true;
  from = from.subspan(1);
  for_each_hit(constraints_, [&](JointForces& along) {
    if (from.empty()) return;
    along.hit.speed = from[0];
    from = from.subspan(1);
  });
  return true;
}

}  // namespace limpid
