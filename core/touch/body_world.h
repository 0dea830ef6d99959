// The bodies of a scene, and the joints, springs and contacts that hold them together.
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

// Free bodies, bodies on joints, springs and contacts among them and with fixed objects. Over a
// tick all of them are solved together with the arm's contacts. A row is a force between two sides;
// it asks both for their velocity without it and for their response to it. With converged sweeps,
// the change of kinetic energy, weight and stored energy is at most the energy given by the arm.
// This holds for any masses, stiffnesses and ticks.
//
// A tick: touch() the bodies near the arm and begin(). Then velocity(), answer() and push() of the
// arm's rows between sweep()s. Last settle(), book() of each row, and finish(). Nothing is
// allocated after construction.
class BodyWorld {
 public:
  // Needs the triangles of every mesh.
  explicit BodyWorld(const Scene& scene);

  int count() const { return static_cast<int>(bodies_.size()); }
  void reset();  // to the scene's state
  // Takes over the books, and the state of bodies that have the same name, start and joint in
  // another scene.
  void take_over(const BodyWorld& other);

  // Wakes a body that the arm is near; its rows are solved with the arm's.
  void touch(int body);
  void begin(double T);

  // A place on a body, as a row's end; fixed if the body is asleep or none.
  struct End {
    int body = BodyContact::kStill;
    BodyMotion::Lever lever = Vec3::Zero();
  };
  // `rolls`: the place does not turn with the body.
  End end_at(int body, const Vec3& point, bool rolls = false) const;
  Vec3 velocity(const End& end) const {  // mean over the tick [m/s]
    if (end.body == BodyContact::kStill) return Vec3::Zero();
    return bodies_[at(end.body)].velocity(end.lever);
  }
  Mat3 answer(const End& end) const;  // response to a force there [m/(N s)]
  void push(const End& end, const Vec3& force) {
    if (end.body == BodyContact::kStill) return;
    bodies_[at(end.body)].push(end.lever, force);
    pushed_[at(end.body)] = 1;
  }
  // Sweeps over the rows of all bodies connected to the arm's contacts, or of all others. Ends when
  // no force changes by more than `enough`, or after `most` sweeps; returns the last largest change
  // [N]. The number of plain sweeps grows with the ratio of a heavy body to a light one below it.
  // So between sweeps forces go on as by conjugate gradients (Silcowitz, Niebe and Erleben 2010); a
  // sweep comes last.
  double sweep(bool touched, double enough, int most);
  // The body that the tip holds as if by a magnet: a spring of zero length from the tip to a point
  // of it.
  struct Magnet {
    static constexpr double kBreaks = 5;  // [N]
    int body = BodyContact::kStill;       // none
    Vec3 point = Vec3::Zero();            // in the object's frame [m]
    Vec3 force = Vec3::Zero();            // on the tip [N]
    bool spent = false;                   // it broke and must be switched off first
  };
  const Magnet& magnet() const { return magnet_; }
  void attach(int body, const Vec3& tip);
  void let_go() { magnet_ = {}; }
  Vec3 magnet_point() const { return place(magnet_.body, magnet_.point); }  // [m]
  void pulled(const Vec3& force);  // takes the magnet's force over the tick [N]
  // Sets the pull from the next begin() on: a spring and damper from the point of the body to the
  // target. Its stiffness grows with the body's mass; its force is at most 2.5 times the weight,
  // however far the target is. It is implicit as all rows are: it does not swing up for any mass.
  void pull(const BodyPull& pull) { pull_ = pull; }

  // Energy given by pulls since the start [J], part of neither the arm's nor the bodies' own.
  double all_pulled() const { return all_pulled_; }

  // Holds the bodies that the arm touches, and all connected to them, at rest for this tick, with
  // the forces of the last one. They can only lose energy by it.
  void hold_touched();
  // Books the energy that the arm's row at this end gave, by its force on it over the whole tick
  // [N].
  void book(const End& end, const Vec3& force);
  // Sweeps until nothing changes any more.
  void settle();
  void finish();

  const Pose& pose(int body) const { return bodies_[at(body)].pose(); }
  const Vec3& center(int body) const { return bodies_[at(body)].center(); }
  Vec3 speed(int body) const { return bodies_[at(body)].speed(); }
  Vec3 spin(int body) const { return bodies_[at(body)].spin(); }
  double joint(int body) const;  // distance from its start along the joint [m] or [rad]
  // Number of the object's body, or kStill if it does not move.
  int body_of(std::size_t object) const { return body_of_[object]; }
  bool magnetic(int body) const { return of_bodies_[at(body)].magnet; }

  double given() const { return given_; }    // by the arm over the last tick [J]
  double energy() const { return energy_; }  // after the last tick: kinetic, weight and stored [J]
  // Energy of bodies at the start of the last tick, less the first one and all that the arm and
  // pull() gave [J].
  double gain() const { return gain_; }
  double all_given() const { return all_given_; }  // by the arm since the start [J]
  int awake() const;
  int sweeps() const { return sweeps_; }  // of the last tick
  // Number of points for which there was no room: they do not push.
  int left_out() const { return geometry_.left_out(); }

  // Writes all state that is kept from tick to tick behind `into`; read() restores it. False: the
  // numbers are of another scene.
  void write(std::vector<double>& into) const;
  bool read(std::span<const double> from);
  static constexpr std::size_t kMostNumbers = 64 + kMostBodies * 64 + BodyGeometry::kMost * 30;

 private:
  // A contact's force over a tick.
  struct Row {
    BodyContact* contact = nullptr;
    End a, b;
    Material material;  // damping and friction are the harder one's
    double K = 0, B = 0, depth = 0, radius = 0;
    Mat3 frame, W;  // columns: normal, two tangents; W in the frame
    double force = 0;
    Eigen::Vector2d friction, anchor;
  };
  // A link between points of two bodies, or of a body and the world: part of a joint, or a spring
  // with a length.
  struct Link {
    int a = 0, b = BodyContact::kStill;
    Vec3 on_a = Vec3::Zero(),
         on_b = Vec3::Zero();  // in their objects' frames, or in the world's [m]
    double length = 0, K = 0, B = 0;
    double breaks_at = std::numeric_limits<double>::infinity();
    bool spring = false;  // else a joint
    bool rail = false;    // of a slider: free along `rail_axis`, in the frame of b
    bool broken = false;
    Vec3 rail_axis = Vec3::UnitZ();
    Vec3 force = Vec3::Zero();  // on a [N]
    // State of the tick.
    End end_a, end_b;
    Vec3 stretch = Vec3::Zero(), along = Vec3::Zero();
    Mat3 held = Mat3::Identity();                // projection on the directions that are not free
    Mat3 W = Mat3::Zero(), give = Mat3::Zero();  // give: force for a velocity of stretching
    double c = 0;
  };
  // Forces of a body on a slider or a hinge of the world.
  struct JointRow {
    int body = 0;
    JointForces forces;
  };

  // A joint held by links, and the forces that act in it.
  struct Held {
    HeldJoint joint;
    int a = 0, b = BodyContact::kStill;
    std::size_t first = 0, links = 0;  // the links that hold it
    // State at the start: the axis, a direction across it and the centre of mass of a, in the frame
    // of b; and that direction in the frame of a.
    Vec3 axis = Vec3::UnitZ(), across_b = Vec3::UnitX(), center = Vec3::Zero(),
         across_a = Vec3::UnitX();
    End end_a, end_b;  // ends of a force along it, in the tick
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
  std::vector<std::uint8_t> quiet_island_;  // by the island's root
  std::vector<int> quiet_;                  // ticks
  std::vector<int> parent_;                 // union of islands
  std::vector<int> quick_;                  // bodies that wake others
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
  Link pulling_;                              // pull_ in the tick; none if the body stands still
  std::vector<double> before_, now_, along_;  // forces of all rows, and the search direction [N]
  double T_ = 1e-3;
  bool fresh_ = true;  // first_energy_ is not yet known
  double given_now_ = 0, given_ = 0, all_given_ = 0, energy_ = 0, first_energy_ = 0, gain_ = 0;
  double all_pulled_ = 0;
  int sweeps_ = 0;
};

}  // namespace limpid
