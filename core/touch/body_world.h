// The bodies of a scene, and the joints, springs and contacts that hold them together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/touch/body_constraints.h"

namespace limpid {

// Free bodies, bodies on joints, springs and contacts among them and with fixed objects. Over a
// tick all of them are solved together with the arm's contacts. A constraint is a force between two
// sides; it asks both for their velocity without it and for their response to it. With converged
// sweeps, the change of kinetic energy, weight and stored energy is at most the energy given by the
// arm. This holds for any masses, stiffnesses and ticks.
//
// A tick: touch() the bodies near the arm and begin(). Then velocity(), answer() and push() of the
// arm's rows between sweep()s. Last settle(), book() of each row, and finish(). Nothing is
// allocated after construction.
class BodyWorld {
 public:
  // Needs the triangles of every mesh.
  explicit BodyWorld(const Scene& scene);

  int count() const { return bodies_.count(); }
  void reset();  // to the scene's state
  // Sets a body going between ticks, as far as its joint lets it [m/s, rad/s].
  void set_speed(int body, const Vec3& speed, const Vec3& spin) {
    wake(body);
    bodies_[body].set_speed(speed, spin);
  }
  // Takes over the books, and the state of bodies that have the same name, start and joint in
  // another scene.
  void take_over(const BodyWorld& other);

  // Wakes a body that the arm is near; its rows are solved with the arm's.
  void touch(int body);
  void begin(double T);

  using End = BodyEnd;
  // Ends of forces on bodies; Bodies says more.
  End end_at(int body, const Vec3& point) const { return bodies_.end_at(body, point); }
  Vec3 velocity(const End& end) const { return bodies_.velocity(end); }
  Mat3 answer(const End& end) const { return bodies_.answer(end); }
  void push(const End& end, const Vec3& force) {
    bodies_.push(end, force);
    bodies_.press(end.body);
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
  Vec3 magnet_point() const { return bodies_.place(magnet_.body, magnet_.point); }  // [m]
  void pulled(const Vec3& force);  // takes the magnet's force over the tick [N]
  // Sets the pull from the next begin() on, see PullLink.
  void pull(const BodyPull& pull) { pull_ = pull; }

  // Energy given by pulls since the start [J], part of neither the arm's nor the bodies' own.
  double all_pulled() const { return all_pulled_; }

  // Holds the bodies that the arm touches, and all connected to them, at rest for this tick, with
  // the forces of the last one. They can only lose energy by it.
  void hold_touched();
  // Books the energy that the arm's row at this end gave, by its force on it over the whole tick
  // [N].
  void book(const End& end, const Vec3& force);
  // Sweeps until nothing changes any more. Forces that are not found so make energy: then more
  // sweeps follow, and what still makes energy stands still for the tick.
  void settle();
  void finish();

  const Pose& pose(int body) const { return bodies_[body].pose(); }
  Vec3 center(int body) const { return bodies_[body].center(); }
  Vec3 speed(int body) const { return bodies_[body].speed(); }
  Vec3 spin(int body) const { return bodies_[body].spin(); }
  double joint(int body) const;  // distance from its start along the joint [m] or [rad]
  // Number of the object's body, or kStill if it does not move.
  int body_of(std::size_t object) const { return body_of_[object]; }
  bool magnetic(int body) const { return bodies_.about[at(body)].magnet; }

  double given() const { return given_; }    // by the arm over the last tick [J]
  double energy() const { return energy_; }  // after the last tick: kinetic, weight and stored [J]
  // Energy of bodies at the start of the last tick, less the first one and all that the arm and
  // pull() gave [J].
  double gain() const { return gain_; }
  double all_given() const { return all_given_; }  // by the arm since the start [J]
  int awake() const;
  int sweeps() const { return sweeps_; }  // of the last tick
  // Number of ticks since the start in which forces were not found and a mechanism stood still.
  int stood_still() const { return stood_still_; }
  // Number of ticks since the start in which a body or a hinge of a mechanism would have turned
  // further than BodyMotion::kMostTurn.
  int turned_less() const { return turned_less_; }
  // Number of points for which there was no room: they do not push.
  int left_out() const { return geometry_.left_out(); }

  // Writes all state that is kept from tick to tick behind `into`; read() restores it. False: the
  // numbers are of another scene. Hits on stops come last, and only where there are some: so
  // numbers without them are read as well.
  void write(std::vector<double>& into) const;
  bool read(std::span<const double> from);
  static constexpr std::size_t kMostNumbers = 64 + kMostBodies * 80 + BodyGeometry::kMost * 31;

 private:
  static std::size_t at(int body) { return static_cast<std::size_t>(body); }
  bool moves(int body) const { return bodies_.moves(body); }
  void add_links(const Scene& scene);
  int number(const std::string& name) const;
  void wake(int body);
  void wake_neighbours();
  void find_islands();
  double turn_again(bool touched, double before);
  double turn_springs(bool touched);
  void sweep_turning(bool touched, double enough, int most);
  int root(int body);
  void join(int a, int b);
  bool in_turn(int a, int b, bool touched);
  double sweep(bool touched);                     // once
  std::size_t forces(std::vector<double>& into);  // of all; returns how many numbers
  void add_forces(const std::vector<double>& more);
  void halt(int body);
  void fall_asleep();
  void take_stock();
  void part();
  bool is_quick(int body) const;
  void bounce(int body);
  void strike(const Meeting& meeting);
  // Energy that the forces of each island make from nothing over the tick, at its root [J].
  void add_up_made();
  void settle_what_makes_energy();
  void hold_what_is_made_up();

  Bodies bodies_;
  double enough_else_ = 0;  // change of a force that counts as settled where the arm is not [N]
  double right_ = 0;        // energy that forces which count as right may make in a tick [J]
  std::vector<std::string> names_;
  std::vector<std::uint8_t> touched_;
  std::vector<double> stops_in_;            // time in which a contact's spring stops a body [s]
  std::vector<std::uint8_t> tied_;          // a joint or a spring holds it
  std::vector<std::uint8_t> linked_;        // a joint with another body holds it
  std::vector<std::uint8_t> turned_;        // its response was found anew
  std::vector<std::uint8_t> quiet_island_;  // by the island's root
  std::vector<int> quiet_;                  // ticks
  std::vector<Pose> quiet_at_;              // poses since then: centre of mass [m], turning
  std::vector<double> made_, moving_;       // energies, by the island's root [J]
  std::vector<double> slower_;              // factors of velocities, by the island's root [-]
  std::vector<int> parent_;                 // union of islands
  std::vector<int> quick_;                  // bodies that wake others
  std::vector<int> passing_;                // bodies that may pass something in a tick
  std::vector<Pose> started_;               // their poses at its start
  std::vector<Pose> next_;                  // in the middle of the tick, if something is round
  std::vector<int> body_of_;                // by object
  BodyGeometry geometry_;
  BodyConstraints constraints_;
  Magnet magnet_;
  BodyPull pull_;
  std::vector<BodyPair*> parting_;            // contacts whose impact turns
  std::vector<double> before_, now_, along_;  // forces of all, and the search direction [N]
  bool fresh_ = true;                         // first_energy_ is not yet known
  double given_now_ = 0, given_ = 0, all_given_ = 0, energy_ = 0, first_energy_ = 0, gain_ = 0;
  double all_pulled_ = 0;
  int sweeps_ = 0, stood_still_ = 0, turned_less_ = 0;
};

}  // namespace limpid
