// Solve of all contacts' forces over a tick together: walls and meshes, with damping and friction,
// by Gauss-Seidel sweeps. The forces do exactly the work that the contacts' potentials lose.
#pragma once

#include <span>
#include <vector>

#include "core/touch/contact_row.h"
#include "core/touch/contacts.h"

namespace limpid {

// Contacts as they hold the arm where a tick ends.
template <int N>
struct HeldContacts {
  Vec<N> torque;           // [N m]
  double stored = 0;       // by their springs and by friction's [J]
  double spring_work = 0;  // 1/2 D.K D: by touching springs K over one more tick's motion D [J]
};

template <int N>
class ContactSolve {
 public:
  static constexpr int kMost = 32;  // most contacts that push at a time; of more, the deepest
  static constexpr int kMostSweeps = 30;

  // Collects the contacts that may touch within a tick of T [s] in which the proxy without contacts
  // would move by u.
  void collect(Contacts<N>& contacts, const Arm<N>& arm, const typename Arm<N>::Frames& f,
               const Vec<N>& u, double T);
  // Solves. motion: in, without contacts; out, with them. Starts from the last forces.
  void solve(const ContactAnswer<N>& answer, double T, Motion<N>& motion);
  // Prepares push(), the forces as functions of the proxy's motion, for solves of other kinds.
  // First, after collect().
  void prepare(const ContactAnswer<N>& answer, double T);
  // Gives bodies of the scene the forces of the last push() and lets them settle; returns the
  // largest change of an arm's force on a body [N]. push() then uses their new places. From the
  // second `turn` on (counted from 0) it uses their response to the last change too: a body that
  // rests on others yields less than it would alone.
  double push_bodies(int turn);
  // Holds the bodies that the arm touches, and all connected to them, for the tick: without a
  // solution for their forces they do not move, and so gain no energy.
  void hold_bodies();
  // Returns the torque [N m] of the forces over a tick in which the proxy moves with the mean
  // velocity u [rad/s]; f2() and finish() refer to the last call. `slope`: derivative over u [N m
  // s/rad], on the present piece of the forces' laws; may be null. `how` it is found.
  Vec<N> push(const Vec<N>& u, double T, Mat<N>* slope, Slope how = Slope::quick);
  // After push() for the same u: the springs where the tick ends, not their mean over it, with the
  // materials' dampers and with friction.
  HeldContacts<N> held(const Vec<N>& u, double T) const;
  // Torque of the forces found [N m].
  Vec<N> f2(Eigen::Index n) const;
  bool any() const { return count_ > 0; }
  int sweeps() const { return sweeps_; }     // of the last solve
  bool settled() const { return settled_; }  // the last solve ended before kMostSweeps
  // Largest change of a force in the last sweep, relative to the largest force or to 1 N.
  double last_change() const { return last_change_; }

  // Stores the tick's forces in the contacts and their memories.
  void finish(Contacts<N>& contacts) const;

 private:
  using Row = ContactRow<N>;
  Row& next_row(double depth);
  std::span<Row> rows() { return {rows_.data(), static_cast<std::size_t>(count_)}; }
  std::span<const Row> rows() const { return {rows_.data(), static_cast<std::size_t>(count_)}; }
  static void learn(Row& row, const ContactAnswer<N>& answer, double T);
  static void set_damping(Row& row, const ContactAnswer<N>& answer, double T);
  static void rub(Row& row, double T, const Vec3& v, Mat3& slope);
  static bool apart(const Row& row, double T, const Vec<N>& u);

  std::array<Row, kMost> rows_;
  std::array<double, kMost> depths_{};
  BodyWorld* world_ = nullptr;
  int count_ = 0;
  int sweeps_ = 0;
  bool settled_ = true;
  double last_change_ = 0;
};

extern template class ContactSolve<3>;
extern template class ContactSolve<7>;
extern template class ContactSolve<kAnyDof>;

}  // namespace limpid
