// Solve of all contacts' forces over a tick together: walls and meshes, with damping and friction,
// by Gauss-Seidel sweeps. The forces do exactly the work that the contacts' potentials lose.
#pragma once

#include <span>
#include <vector>

#include "core/math/coupled_system.h"
#include "core/touch/contacts.h"
#include "core/touch/mesh_touch.h"
#include "core/touch/wall_force.h"

namespace limpid {

// Force of a mesh's room of planes over a whole tick, conservative like a single wall's. A spring K
// and damper B pull a ball's centre to the nearest place that the mesh leaves free. Over the tick
// the centre moves by D = a + W F: a without this force [m], W the response to it [m/N].
struct RoomTick {
  double K, B, T;
  Vec3 center;
  Vec3 a;
  Mat3 W;
};

// Computes the constant force F [N] = mean of -grad U over the segment from center to center + D.
// The damper's force in the held directions is subtracted. The mean of a gradient along a segment
// does exactly the work that the potential loses. `F`: in, a first guess; out, the force.
void room_force(const MeshTouch& touch, const RoomTick& tick, Vec3& F);

// The force of room_force() for a known D = a, and its slope over D [N/m], with the damper's
// directions fixed.
Vec3 room_push(const MeshTouch& touch, const RoomTick& tick, Mat3& on_D);

// Response of everything that moves to torques, and to a torque f2 of the contacts on the proxy.
// Unknown are the device's motion w and the proxy's relative motion u - w.
template <int N>
struct ContactAnswer {
  ContactAnswer() = default;
  // Builds the system from its blocks.
  template <class... Blocks>
  ContactAnswer(double device, const Wide<N>& proxy, const Blocks&... blocks)
      : system(blocks...), on_device(device), on_proxy(proxy) {}

  CoupledSystem<N> system;
  double on_device = 0;  // share of f2 in the first rows
  Wide<N> on_proxy;      // share of f2 in the second rows [-]
  // Inertia behind a wall's damping; null: walls have only their material's damping.
  const SymmetricFactor<N>* inertia = nullptr;
  double damping = 0;       // see wall_damping() [-]
  double jump = 0;          // jump of a joint's velocity when its encoder makes a step [rad/s]
  double most_damping = 0;  // largest damping of a wall, in m_n/T [-]

  Motion<N> solve(const Motion<N>& b) const {
    Motion<N> m = system.solve(b);
    m.u += m.w;
    return m;
  }
  Motion<N> respond(const Vec<N>& f2) const {
    return solve({on_device * f2, times<N>(on_proxy, f2)});
  }
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
  // s/rad], on the present piece of the forces' laws; may be null.
  Vec<N> push(const Vec<N>& u, double T, Mat<N>* slope);
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
  // A contact: forces along the axes of a frame. A wall's axes are its normal and two tangents;
  // without friction only the first is used. A mesh's frame is the world's.
  struct Row {
    // Source of the force: one of the three.
    Contact<N>* wall = nullptr;
    MeshContact<N>* mesh = nullptr;
    typename Contacts<N>::Magnet* magnet = nullptr;
    Material material;
    ContactMemory before;
    int axes = 1;
    double radius = 0;  // of friction's disc, by the normal force [-]
    Mat3 frame = Mat3::Identity();
    std::array<Vec<N>, 3> g;       // torque of a unit force along each axis
    std::array<Motion<N>, 3> Z;    // motion by this torque
    Mat3 W = Mat3::Zero();         // g_i . Z_j.u [m/(N s)]
    double B = 0;                  // damping [N s/m]
    bool known = false;            // Z and W are known
    Vec3 push = Vec3::Zero();      // along the axes, without friction [N]
    Vec3 friction = Vec3::Zero();  // [N]
    // State of a body's surface.
    BodyWorld* world = nullptr;
    BodyWorld::End end;
    Mat3 W_body = Mat3::Zero();     // along the axes [m/(N s)]
    Vec3 on_body = Vec3::Zero();    // force applied to it so far, with opposite sign [N]
    Vec3 rubbed = Vec3::Zero();     // friction's part of on_body [N]
    Vec3 body_free = Vec3::Zero();  // its velocity without on_body, along the axes [m/s]

    void clear() {
      wall = nullptr;
      mesh = nullptr;
      magnet = nullptr;
      axes = 1;
      radius = B = 0;
      frame.setIdentity();
      W.setZero();
      known = false;
      push.setZero();
      friction.setZero();
      world = nullptr;
      end = {};
      W_body.setZero();
      on_body.setZero();
      rubbed.setZero();
      body_free.setZero();
    }
  };
  Row& next_row(double depth);
  static void on_body(Row& row, BodyWorld* world, int body, const Vec3& point);
  static Vec3 of_body(const Row& row);  // velocity of the row's body along the row's axes [m/s]
  void add(Contact<N>& c, Contacts<N>& contacts, const Arm<N>& arm,
           const typename Arm<N>::Frames& f);
  void add(MeshContact<N>& c, Contacts<N>& contacts);
  void add(typename Contacts<N>::Magnet& magnet, BodyWorld& world);
  static void learn(Row& row, const ContactAnswer<N>& answer, double T);
  static void set_damping(Row& row, const ContactAnswer<N>& answer, double T);
  static Mat3 push(Row& row, double T, const Vec3& v);
  static void rub(Row& row, double T, const Vec3& v, Mat3& slope);
  static Vec3 speed(const Row& row, const Vec<N>& u);
  static void apply(Row& row, const Vec3& change, Motion<N>& motion);
  static double push_wall(Row& row, double T, Motion<N>& motion);
  static double push_magnet(Row& row, double T, Motion<N>& motion);
  static double push_mesh(Row& row, double T, Motion<N>& motion);
  static double rub(Row& row, double T, const Vec3& normal, double force, Motion<N>& motion);
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
extern template class ContactSolve<kAnyDof>;

}  // namespace limpid
