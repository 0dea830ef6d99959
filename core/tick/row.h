// Columns and layout of a row: what one tick leaves behind, as consecutive doubles of the session
// file.
//
// Row k holds the state at t_k and the torques held over [t_k, t_k+1). The columns below are the
// single list that the tick fills, the recorder writes, the plots read and `info --csv` prints.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "core/coupling/laws.h"
#include "core/math/sizes.h"
#include "core/touch/scene.h"

namespace limpid {

enum class Column : std::uint8_t {
  time,
  device_position,
  device_velocity,
  measured_position,
  measured_velocity,
  commanded_torque,
  motor_torque,
  proxy_position,
  proxy_velocity,
  proxy_torque,
  contact_torque,
  hand_target,
  hand_torque,
  hand_torque_estimate,
  hand_grip,
  force_wanted,
  force_state,
  kind,
  eta,
  alpha,
  governor,
  damping_governor,
  torque_governor,
  solved,
  unsettled,
  energy_total,
  energy_commanded,
  energy_port,
  energy_ledger,
  proxy_kinetic,
  contact_potential,
  contact_gain,
  contact_point,
  contact_force,
  compensation_torque,
  energy_compensation,
  body_pose,
  body_velocity,
  energy_to_objects,
  energy_objects,
  objects_gain,
  objects_awake,
  objects_sweeps,
  objects_left_out,
  objects_stood_still,
  objects_turned_less,
  magnet,
  hand_magnet,
  hand_pull,
  pull_point,
  pull_target,
  energy_pulled,
  tool_orientation,
  motor_warmth,
  excitation,
  wake_latency,
  compute,
  count_,
};

inline constexpr int kColumns = static_cast<int>(Column::count_);

// Number of contacts that a row has room for: the hardest, if there are more.
inline constexpr int kRowContacts = 4;

// Number of doubles in a column; `contacts` has x, y, z of each. Columns of bodies exist only in
// scenes where something moves.
enum class ColumnWidth : std::uint8_t {
  one,
  three,
  four,
  dof,
  contacts,
  poses,
  velocities,
  if_bodies,
  three_if_bodies
};

// True for columns of x, y, z.
constexpr bool of_axes(ColumnWidth width) {
  return width == ColumnWidth::three || width == ColumnWidth::three_if_bodies;
}

// Numbers of each body in its columns: a place and a quaternion, and two velocities.
inline constexpr int kPoseNumbers = 7, kVelocityNumbers = 6;

struct ColumnInfo {
  Column column;
  const char* path;  // dataset in the session file
  ColumnWidth width;
  const char* unit;  // "-" for none
  const char* what;
  bool byte = false;  // stored as uint8
};

inline constexpr std::array<ColumnInfo, kColumns> kColumnInfo{{
    {Column::time, "/time", ColumnWidth::one, "s", "t_k"},
    {Column::device_position, "/device/position", ColumnWidth::dof, "rad", "x1, true"},
    {Column::device_velocity, "/device/velocity", ColumnWidth::dof, "rad/s", "v1, true"},
    {Column::measured_position, "/device/measured_position", ColumnWidth::dof, "rad",
     "x1 as the loop measured it"},
    {Column::measured_velocity, "/device/measured_velocity", ColumnWidth::dof, "rad/s",
     "velocity estimate that the observer used"},
    {Column::commanded_torque, "/device/commanded_torque", ColumnWidth::dof, "N m",
     "tau1 of equation (1) or (14), without the device's own damping"},
    {Column::motor_torque, "/device/motor_torque", ColumnWidth::dof, "N m",
     "torque sent to the motors, after all limits"},
    {Column::proxy_position, "/proxy/position", ColumnWidth::dof, "rad", "x2"},
    {Column::proxy_velocity, "/proxy/velocity", ColumnWidth::dof, "rad/s", "v2"},
    {Column::proxy_torque, "/proxy/torque", ColumnWidth::dof, "N m", "tau2 during the tick"},
    {Column::contact_torque, "/proxy/contact_torque", ColumnWidth::dof, "N m",
     "f2 during the tick"},
    {Column::hand_target, "/hand/target", ColumnWidth::three, "m",
     "where the hand wants the tip to be"},
    {Column::hand_torque, "/hand/torque", ColumnWidth::dof, "N m",
     "f1, mean of the tick; not a number for a real device"},
    {Column::hand_torque_estimate, "/hand/torque_estimate", ColumnWidth::dof, "N m",
     "f1_hat used at t_k"},
    {Column::hand_grip, "/hand/grip", ColumnWidth::one, "-",
     "1: the hand holds the device; 0: it does not"},
    {Column::force_wanted, "/device/force_wanted", ColumnWidth::one, "-",
     "1: force armed; 0: force off", true},
    {Column::force_state, "/device/force_state", ColumnWidth::one, "-",
     "0: force on; else the reason why it is off or reduced: 1 not armed, 2 no hand, 3 no new "
     "reading, 4 fault, 5 not connected, 6 too fast, 7 out of range, 8 too much energy, 9 "
     "unstable, 10 the window does not answer, 11 the loop stopped for a moment, 12 the readings "
     "do not change, 13 a reading is impossible",
     true},
    {Column::kind, "/coupling/kind", ColumnWidth::one, "-", kLawNumbers.data(), true},
    {Column::eta, "/coupling/eta", ColumnWidth::one, "-", "impedance scaling"},
    {Column::alpha, "/coupling/alpha", ColumnWidth::one, "N m s/rad", "observer gain"},
    {Column::governor, "/coupling/governor", ColumnWidth::one, "-",
     "share of the contact force that the energy account allows; tank: the proxy's damping divided "
     "by the sum of this damping and the damping that its tank adds"},
    {Column::damping_governor, "/coupling/damping_governor", ColumnWidth::one, "-",
     "share of the damping cancellation that the energy account allows; popc and tdpn: 1 minus the "
     "share of the law's largest damper that acts"},
    {Column::torque_governor, "/coupling/torque_governor", ColumnWidth::one, "-",
     "share of all torque that the energy account (predictive, eba) or the device's tank allows; "
     "sfa: share of the walls' full torque that it has reached"},
    {Column::solved, "/coupling/solved", ColumnWidth::one, "-",
     "how the tick was solved: 0 as usual; with the predictive law also 1: with motors at their "
     "limit, 2: solving one contact after the other did not succeed; 3: no solution, the proxy did "
     "not move",
     true},
    {Column::unsettled, "/coupling/unsettled", ColumnWidth::one, "-",
     "ticks so far without a common solution for all contacts (predictive law: and for motors at "
     "their limit); the proxy did not move in these ticks"},
    {Column::energy_total, "/energy/controller_total", ColumnWidth::one, "J",
     "E_c with the device's own damping"},
    {Column::energy_commanded, "/energy/controller_commanded", ColumnWidth::one, "J",
     "E_c of motors and proxy"},
    {Column::energy_port, "/energy/port", ColumnWidth::one, "J",
     "energy given to the human: work of the motors minus the energy that the device's own damping "
     "takes"},
    {Column::energy_ledger, "/energy/ledger", ColumnWidth::one, "J",
     "reserve of the energy account, or energy in both tanks and on its way between them; 0 until "
     "a law with an energy account has run"},
    {Column::proxy_kinetic, "/energy/proxy_kinetic", ColumnWidth::one, "J",
     "kinetic energy of the proxy"},
    {Column::contact_potential, "/energy/contact_potential", ColumnWidth::one, "J",
     "energy stored in the contacts"},
    {Column::contact_gain, "/energy/contact_gain", ColumnWidth::one, "J",
     "energy that the contacts gave in addition to the energy they had stored"},
    {Column::contact_point, "/contact/point", ColumnWidth::contacts, "m",
     "points where the proxy is touched: x, y, z of at most four contacts, those with the largest "
     "force; not a number for contacts that do not exist"},
    {Column::contact_force, "/contact/force", ColumnWidth::contacts, "N",
     "force on the proxy at these points, during the tick"},
    {Column::compensation_torque, "/device/compensation_torque", ColumnWidth::dof, "N m",
     "torque in addition to tau1, for weight, springs and friction of the device and to measure "
     "the grip"},
    {Column::energy_compensation, "/energy/compensation", ColumnWidth::one, "J",
     "the part of E_c that the motors gave to cancel weight, springs and friction of the device "
     "and to measure the grip"},
    {Column::body_pose, "/objects/pose", ColumnWidth::poses, "m",
     "for each body: x, y, z of its centre of mass, and its rotation as a quaternion w, x, y, z "
     "[-]"},
    {Column::body_velocity, "/objects/velocity", ColumnWidth::velocities, "m/s",
     "for each body: velocity of its centre of mass, x, y, z, then its angular velocity, x, y, z "
     "[rad/s]"},
    {Column::energy_to_objects, "/energy/to_objects", ColumnWidth::if_bodies, "J",
     "energy that the proxy has given to bodies"},
    {Column::energy_objects, "/energy/objects", ColumnWidth::if_bodies, "J",
     "energy of the bodies: kinetic energy, potential energy of their weight, and energy stored in "
     "contacts and springs between them"},
    {Column::objects_gain, "/energy/objects_gain", ColumnWidth::if_bodies, "J",
     "energy of the bodies minus the energy they had at the start and were given, pulls included; "
     "below 0 if they lost energy"},
    {Column::objects_awake, "/objects/awake", ColumnWidth::if_bodies, "-",
     "number of bodies that move"},
    {Column::objects_sweeps, "/objects/sweeps", ColumnWidth::if_bodies, "-",
     "iterations over all contacts until the forces of the tick were found"},
    {Column::objects_left_out, "/objects/left_out", ColumnWidth::if_bodies, "-",
     "number of contact points of bodies for which the loop has no memory: these points do not "
     "push"},
    {Column::objects_stood_still, "/objects/stood_still", ColumnWidth::if_bodies, "-",
     "ticks so far in which the solver found no forces for the bodies; the bodies did not move in "
     "these ticks"},
    {Column::objects_turned_less, "/objects/turned_less", ColumnWidth::if_bodies, "-",
     "ticks so far in which a body of a mechanism would have turned by more than one radian; it "
     "turned by less"},
    {Column::magnet, "/objects/held", ColumnWidth::if_bodies, "-",
     "number of the body that the magnet held during the tick, counted from 1; 0: none"},
    {Column::hand_magnet, "/hand/magnet", ColumnWidth::if_bodies, "-",
     "1: the hand wants the tip to pick up a body that a magnet can hold; 0: it does not", true},
    {Column::hand_pull, "/hand/pull", ColumnWidth::if_bodies, "-",
     "number of the body that the mouse pulls in the picture, counted from 1; 0: none", true},
    {Column::pull_point, "/hand/pull_point", ColumnWidth::three_if_bodies, "m",
     "point of the body where it is pulled, in the body's frame"},
    {Column::pull_target, "/hand/pull_target", ColumnWidth::three_if_bodies, "m",
     "point to which the body is pulled"},
    {Column::energy_pulled, "/energy/pulled", ColumnWidth::if_bodies, "J",
     "energy that these pulls have given to bodies"},
    {Column::tool_orientation, "/device/orientation", ColumnWidth::four, "-",
     "orientation of the tool in the hand as a quaternion w, x, y, z; 1 0 0 0: it points forward; "
     "not a number if it is not known"},
    {Column::motor_warmth, "/device/warmth", ColumnWidth::dof, "-",
     "warmth of each motor, from 0 (cold) to 1 (as warm as allowed): the value of the arm's model, "
     "or the value that the device reports for its hottest motor if it is larger; 0 if neither is "
     "known"},
    {Column::excitation, "/device/excitation", ColumnWidth::three, "N",
     "force commanded at the tip to measure the grip: x, y, z; 0 if nothing is measured"},
    {Column::wake_latency, "/timing/wake_latency", ColumnWidth::one, "s",
     "how late the tick began"},
    {Column::compute, "/timing/compute", ColumnWidth::one, "s", "how long the tick took"},
}};

// Places of columns in a row, for an arm of n joints and a number of bodies.
class RowLayout {
 public:
  explicit constexpr RowLayout(int dof, int bodies = 0) : dof_(dof), bodies_(bodies) {
    int at = 0;
    for (const ColumnInfo& info : kColumnInfo) {
      offset_[static_cast<std::size_t>(info.column)] = at;
      at += width(info.column);
    }
    stride_ = at;
  }

  constexpr int dof() const { return dof_; }
  constexpr int bodies() const { return bodies_; }
  constexpr int stride() const { return stride_; }  // doubles per row
  constexpr bool has(Column c) const { return width(c) > 0; }
  constexpr int offset(Column c) const { return offset_[static_cast<std::size_t>(c)]; }
  constexpr int width(Column c) const {
    switch (kColumnInfo[static_cast<std::size_t>(c)].width) {
      case ColumnWidth::one: return 1;
      case ColumnWidth::three: return 3;
      case ColumnWidth::four: return 4;
      case ColumnWidth::dof: return dof_;
      case ColumnWidth::contacts: return 3 * kRowContacts;
      case ColumnWidth::poses: return kPoseNumbers * bodies_;
      case ColumnWidth::velocities: return kVelocityNumbers * bodies_;
      case ColumnWidth::if_bodies: return bodies_ > 0 ? 1 : 0;
      case ColumnWidth::three_if_bodies: return bodies_ > 0 ? 3 : 0;
    }
    return 0;
  }

  template <class T>  // T: double or const double
  std::span<T> in(std::span<T> row, Column c) const {
    return row.subspan(static_cast<std::size_t>(offset(c)), static_cast<std::size_t>(width(c)));
  }

  // The human's torque where it is known, else the observer's estimate (real devices).
  std::span<const double> human_torque(std::span<const double> row) const {
    const auto measured = in(row, Column::hand_torque);
    return std::isnan(measured[0]) ? in(row, Column::hand_torque_estimate) : measured;
  }

 private:
  int dof_;
  int bodies_;
  int stride_ = 0;
  std::array<int, kColumns> offset_{};
};

// Layout for an arm of `dof` joints in this scene.
inline RowLayout row_layout(int dof, const Scene& scene) {
  return RowLayout(dof, count_bodies(scene));
}

// Largest possible row, for storage of fixed size.
inline constexpr int kMaxStride = RowLayout(kMaxDof, kMostBodies).stride();

}  // namespace limpid
