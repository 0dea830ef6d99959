// What was recorded of a device while it was moved to be identified, and its smoothing.
#pragma once

#include <Eigen/Core>

namespace limpid {

// One row a tick, one column a joint. The torque of a row is what was sent after its reading.
struct MotionRecord {
  double T = 0.001;        // from row to row [s]
  Eigen::MatrixXd x;       // read [rad]
  Eigen::MatrixXd torque;  // sent [N m]

  Eigen::Index rows() const { return x.rows(); }
  Eigen::Index joints() const { return x.cols(); }
};

// The same Gaussian window over positions and torques: what it keeps of one it keeps of the other,
// so that a linear law between their derivatives stays exact. Without a shift in time.
struct Smoothing {
  double sigma;                                         // [s]
  double reach() const { return 5 * sigma; }            // what is beyond it weighs less than 4e-6
  double independent() const { return 3.545 * sigma; }  // 2 sqrt(pi) sigma: noise further apart is
};

struct Motion3 {
  Eigen::MatrixXd x, v, a;  // a row for each time [rad, rad/s, rad/s^2]
};

// Of each joint, the least by which it was seen to move: the encoder's step, where it is coarse.
Eigen::VectorXd encoder_steps(const MotionRecord& record);
// The narrowest window, from 8 to 12.5 ms, in which the encoders' steps make less than 3e-4 of the
// mean square of each joint's acceleration; noise there would pass for less inertia.
Smoothing smoothing_for(const MotionRecord& record);

// At these times [s] since the first row; each at least the window's reach within the record.
Motion3 motion_at(const MotionRecord& record, const Smoothing& window,
                  const Eigen::VectorXd& times);
// The torques that acted there if each began `delay` [s] after its reading and was held for a tick.
Eigen::MatrixXd torque_at(const MotionRecord& record, const Smoothing& window,
                          const Eigen::VectorXd& times, double delay);

}  // namespace limpid
