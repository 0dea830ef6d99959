// Record of a device's motion for identification, and its smoothing.
#pragma once

#include <Eigen/Core>

namespace limpid {

// A record with one row a tick and one column a joint. A row's torque is the one sent after its
// reading.
struct MotionRecord {
  double T = 0.001;        // time between rows [s]
  Eigen::MatrixXd x;       // read [rad]
  Eigen::MatrixXd torque;  // sent [N m]

  Eigen::Index rows() const { return x.rows(); }
  Eigen::Index joints() const { return x.cols(); }
};

// The same Gaussian window for positions and torques, without a shift in time. A linear law between
// their derivatives stays exact, as both lose the same.
struct Smoothing {
  double sigma;                               // [s]
  double reach() const { return 5 * sigma; }  // weights beyond it are below 4e-6
  // Least distance of independent noise, 2 sqrt(pi) sigma.
  double independent() const { return 3.545 * sigma; }
};

struct Motion3 {
  Eigen::MatrixXd x, v, a;  // a row for each time [rad, rad/s, rad/s^2]
};

// The least step by which each joint was seen to move: its encoder's, if that is coarse [rad].
Eigen::VectorXd encoder_steps(const MotionRecord& record);
// The narrowest window, from 8 to 12.5 ms, in which the encoders' steps make less than 3e-4 of the
// mean square of each joint's acceleration. More noise would pass for less inertia.
Smoothing smoothing_for(const MotionRecord& record);

// The smoothed motion at `times`, since the first row; each lies at least reach() inside the record
// [s].
Motion3 motion_at(const MotionRecord& record, const Smoothing& window,
                  const Eigen::VectorXd& times);
// The torques at `times` if each began `delay` [s] after its reading and was held for a tick.
Eigen::MatrixXd torque_at(const MotionRecord& record, const Smoothing& window,
                          const Eigen::VectorXd& times, double delay);

}  // namespace limpid
