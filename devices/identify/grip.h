// Stiffness, damping and mass of the hand that holds a device, from its motion under a GripProbe.
//
// At one frequency, with s = jw, motors and hand move the joints q together:
//     (M s^2 + B s + K) q = tau + J^T f,   f = -(k + b s + m s^2) J q.
// tau is all that the motors gave, the coupling law's torque too, so the law's loop and limits that
// cut the excitation make no error. k, b and m are the least squares over the probe's lines,
// weighted by the noise between the lines: what the hand does of its own, and the encoders' steps.
//
// The device itself is known to some part only. Its friction and delay are fitted along, held to
// what is known of them; the doubt about its inertia and damping is a part of the bounds.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "core/tick/arming.h"
#include "core/tick/parameters.h"
#include "core/tick/row.h"

namespace limpid {

// Rows of the last measurement in a run, as they came.
class GripRecord {
 public:
  GripRecord(const RowLayout& layout, double tick) : layout_(layout), T_(tick) {}

  // Takes the next row of the run; those without excitation are passed over.
  void take(std::span<const double> row);

  bool begun() const { return samples() > 0; }
  bool ended() const { return ended_; }
  double duration() const { return static_cast<double>(samples()) * T_; }  // [s]
  std::size_t samples() const { return touched_.size(); }
  int dof() const { return layout_.dof(); }
  double tick() const { return T_; }
  bool real() const { return real_; }                // not a simulated device
  bool torn() const { return torn_; }                // too many rows are missing in one place
  ForceState ended_by() const { return ended_by_; }  // state of the force at its end
  // Excitation [N], measured positions [rad] and torque of the motors [N m], sample by sample.
  std::span<const double> force() const { return force_; }
  std::span<const double> x() const { return x_; }
  std::span<const double> torque() const { return torque_; }
  std::span<const char> touched() const { return touched_; }  // the tip had a contact

 private:
  void add(std::span<const double> force, std::span<const double> x, std::span<const double> torque,
           bool touched);

  RowLayout layout_;
  double T_, time_ = 0;
  std::vector<double> force_, x_, torque_;
  std::vector<char> touched_;
  bool real_ = false, torn_ = false, ended_ = false;
  ForceState ended_by_ = ForceState::on;
};

// A value and the bound of its error, which holds for 95 of 100 grips.
struct Bounded {
  double value = 0, bound = 0;

  double low() const { return value > bound ? value - bound : 0; }
  double high() const { return value + bound; }
};

struct Grip {
  std::string unknown;               // why it is not known, and how to mend it; empty: it is known
  bool measured = false;             // the values below were fitted
  Bounded stiffness, damping, mass;  // [N/m, N s/m, kg]
  Eigen::VectorXd pose;              // of the joints, the mean [rad]
  double moved = 0;                  // farthest that the tip went from its mean place [m]
  double touched = 0;                // share of the time with a contact [-]
  double work = 0;                   // of the excitation [J]

  bool known() const { return unknown.empty(); }
};

// Parts to which a device's own properties are known; those of a simulated one are exact.
struct DeviceTrust {
  double inertia, damping, friction;  // relative standard deviations [-]
  double delay;                       // standard deviation [s]

  static DeviceTrust of(const ArmDescription& arm, bool real, double tick);
};

// Finds the hand in a record. `p`: settings as the loop took them.
Grip find_grip(const ArmDescription& arm, const Parameters& p, const GripRecord& record);

}  // namespace limpid
