// All that moves in a scene besides the arm, and what holds it together.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/touch/body_geometry.h"
#include "core/touch/body_motion.h"
#include "core/touch/held_joint.h"

namespace limpid {

// Free bodies, bodies on joints, springs and contacts among them and with what stands still. Over a
// tick all of them are solved together with whatever the arm touches: a row, which is a force
// between two sides, asks both for their velocity without it and for what it adds to it. With
// converged sweeps, the change of kinetic energy, weight and all that rows store is at most what
// the arm gave, whatever masses, stiffnesses and the tick are.
//
// A tick: touch() what the arm is near to, begin(), then velocity(), answer() and push() of the
// arm's rows between sweep()s, settle(), book() of each of them, and finish(). Allocates nothing
// after it was made.
class BodyWorld {
 public:
  // Every mesh of the scene has its shape.
  explicit BodyWorld(const Scene& scene);

  int count() const { return static_cast<int>(bodies_.size()); }
  void reset();  // as the scene has it
  // Takes over the books, and where bodies of the same name, start and joint are in another scene.
  void take_over(const BodyWorld& other);

  // The arm is near to it: it wakes up, and its rows are solved with the arm's.
  void touch(int body);
  void begin(double T);

  // A place on a body, as a row's end; of what is asleep or none: it stands still.
  struct End {
    int body = BodyContact::kStill;
    BodyMotion::Lever lever = Vec3::Zero();
  };
  // `rolls`: the place stays where it is while the body turns.
  End end_at(int body, const Vec3& point, bool rolls = false) const;
  Vec3 velocity(const End& end) const {  // mean over the tick [m/s]
    if (end.body == BodyContact::kStill) return Vec3::Zero();
    return bodies_[at(end.body)].velocity(end.lever);
  }
  Mat3 answer(const End& end) const;  // to a force there [m/(N s)]
  void push(const End& end, const Vec3& force) {
    if (end.body == BodyContact::kStill) return;
    bodies_[at(end.body)].push(end.lever, force);
    pushed_[at(end.body)] = 1;
  }
  // Over the rows of what the arm touches and what hangs together with it, or of all others, until
  // no force changes by more than `enough` or it was gone over them `most` times; returns the
  // largest change of the last time [N]. Sweeps alone take as many as a heavy body on a light one
  // weighs more: so from one to the next forces go on as by conjugate gradients (Silcowitz, Niebe
  // and Erleben 2010), and the last word is a sweep's.
  double sweep(bool touched, double enough, int most);
  // What the tip holds as if by a magnet: a spring without length from the tip to a point of it.
  struct Magnet {
    static constexpr double kBreaks = 5;  // [N]
    int body = BodyContact::kStill;       // none
    Vec3 point = Vec3::Zero();            // in the object's frame [m]
    Vec3 force = Vec3::Zero();            // on the tip [N]
    bool spent = false;                   // it broke: it has to be switched off first
  };
  const Magnet& magnet() const { return magnet_; }
  void attach(int body, const Vec3& tip);
  void let_go() { magnet_ = {}; }
  Vec3 magnet_point() const { return place(magnet_.body, magnet_.point); }  // [m]
  void pulled(const Vec3& force);  // by the magnet, over the tick [N]
  // From the next begin() on: a spring and damper from the point of the body to the target, as
  // stiff as the body is heavy, with at most 2.5 times its weight, however far off the target is.
  // Implicit as all rows are: whatever the mass, it does not swing up.
  void pull(const BodyPull& pull) { pull_ = pull; }

  // By that, since the start [J]: neither the arm's nor the bodies' own.
  double all_pulled() const { return all_pulled_; }

  // What the arm touches, and what hangs together with it, stays where it is for this tick, at
  // rest, with the forces of the last one: it can only lose energy by that.
  void hold_touched();
  // What the arm's row at this end gave, by its force on it over the whole tick [N].
  void book(const End& end, const Vec3& force);
  // Sweeps until nothing changes any more.
  void settle();
  void finish();

  const Pose& pose(int body) const { return bodies_[at(body)].pose(); }
  const Vec3& center(int body) const { return bodies_[at(body)].center(); }
  Vec3 speed(int body) const { return bodies_[at(body)].speed(); }
  Vec3 spin(int body) const { return bodies_[at(body)].spin(); }
  double joint(int body) const;  // how far it is from its start along it [m] or [rad]
  // Of the body in the scene that moves, or none: as BodyWorld counts them.
  int body_of(std::size_t object) const { return body_of_[object]; }
  bool magnetic(int body) const { return of_bodies_[at(body)].magnet; }

  double given() const { return given_; }    // by the arm over the last tick [J]
  double energy() const { return energy_; }  // then: kinetic, weight and stored [J]
  // At the start of the last tick, beyond what there was at first, and what the arm and pull() gave
  // [J].
  double gain() const { return gain_; }
  double all_given() const { return all_given_; }  // by the arm since the start [J]
  int awake() const;
  int sweeps() const { return sweeps_; }  // of the last tick
  // Points at which bodies touch that there is no room for: these do not push.
  int left_out() const { return geometry_.left_out(); }

  // All that is kept from tick to tick: appended to `into`, and taken from there again. False:
  // these numbers are of another scene.
  void write(std::vector<double>& into) const;
  bool read(std::span<const double> from);
  static constexpr std::size_t kMostNumbers = 64 + kMostBodies * 64 + BodyGeometry::kMost * 30;

 private:
  // A contact's force over a tick.
  struct Row {
    BodyContact* contact = nullptr;
    End a, b;
    Material material;  // the harder one's damping and friction are the pair's
    double K = 0, B = 0, depth = 0, radius = 0;
    Mat3 frame, W;  // columns: normal, two tangents; W in the frame
    double force = 0;
    Eigen::Vector2d friction, anchor;
  };
  // A point of one body held to a point of another or of the world, of a joint, or by a spring with
  // a length.
  struct Link {
    int a = 0, b = BodyContact::kStill;
    Vec3 on_a = Vec3::Zero(),
         on_b = Vec3::Zero();  // in their objects' frames; of the world: in it [m]
    double length = 0, K = 0, B = 0;
    double breaks_at = std::numeric_limits<double>::infinity();
    bool spring = false;  // else a joint
    bool rail = false;    // of a slider: along `rail_axis`, in the frame of b, it is free
    bool broken = false;
    Vec3 rail_axis = Vec3::UnitZ();
    Vec3 force = Vec3::Zero();  // on a [N]
    // Of the tick:
    End end_a, end_b;
    Vec3 stretch = Vec3::Zero(), along = Vec3::Zero();
    Mat3 held = Mat3::Identity();                // a projection on the directions that are not free
    Mat3 W = Mat3::Zero(), give = Mat3::Zero();  // force that a stretch's velocity without it makes
    double c = 0;
  };
  // Of a body on a slider or a hinge of the world.
  struct JointRow {
    int body = 0;
    JointForces forces;
  };

  // A joint that links hold, and what acts in it.
  struct Held {
    HeldJoint joint;
    int a = 0, b = BodyContact::kStill;
    std::size_t first = 0, links = 0;  // those that hold it
    // At the start: its axis, a direction across it and the centre of mass of a in the frame of b,
    // and that direction in the frame of a.
    Vec3 axis = Vec3::UnitZ(), across_b = Vec3::UnitX(), center = Vec3::Zero(),
         across_a = Vec3::UnitX();
    End end_a, end_b;  // of the tick, of a force along it
  };

  static std::size_t at(int body) { return static_cast<std::size_t>(body); }
  bool moves(int body) const { return body != BodyContact::kStill && awake_[at(body)] != 0; }
  void add_links(const Scene& scene);
  void add_joint(int body, const BodyJoint& joint);
  void add_link(int body, int to, const Vec3& point, const Vec3* rail_axis);
  int number(const std::string& name) const;
  void wake_neighbours();
  void find_islands();
  int root(int body);
  void join(int a, int b);
  bool in_turn(int a, int b, bool touched);
  bool begin_row(BodyContact& contact);
  void begin_link(Link& link);
  void begin_pull();
  void begin_rail(Link& link);
  void begin_held(Held& held);
  void follow(Held& held) const;
  Vec3 speed(const Held& held) const;
  void push(const Held& held, const Vec3& force);
  Vec3 directed(int body, const Vec3& own) const;  // in the world
  Vec3 place(int body, const Vec3& own) const;
  double stiffness(const BodyContact& contact) const;
  void apply(const End& a, const End& b, const Vec3& force) {
    if (force.isZero(0)) return;
    push(a, force);
    push(b, -force);
  }
  double sweep(bool touched);  // once
  double sweep(Row& row);
  double sweep(Link& link);
  double sweep(JointRow& row);
  double sweep(Held& held);
  void forces(std::vector<double>& into) const;
  void add_forces(const std::vector<double>& more);
  void end_rows();
  void fall_asleep();
  void take_stock();

  std::vector<BodyMotion> bodies_;
  std::vector<std::string> names_;
  std::vector<Body> of_bodies_;
  std::vector<std::uint8_t> awake_, pushed_, touched_;
  std::vector<std::uint8_t> quiet_island_;  // by root
  std::vector<int> quiet_;                  // ticks
  std::vector<int> parent_;                 // of islands
  std::vector<int> quick_;                  // those that wake others
  std::vector<int> body_of_;                // by object
  std::vector<Material> of_objects_;
  BodyGeometry geometry_;
  std::vector<Row> rows_;
  std::size_t count_ = 0;
  std::vector<Link> links_;
  std::vector<JointRow> joints_;
  std::vector<Held> held_;
  Magnet magnet_;
  BodyPull pull_;
  Link pulling_;  // what pull_ is in the tick; of a body that stands still: none
  std::vector<double> before_, now_, along_;  // forces of all rows; where they go on to [N]
  double T_ = 1e-3;
  bool fresh_ = true;  // first_energy_ is to be taken
  double given_now_ = 0, given_ = 0, all_given_ = 0, energy_ = 0, first_energy_ = 0, gain_ = 0;
  double all_pulled_ = 0;
  int sweeps_ = 0;
};

}  // namespace limpid
