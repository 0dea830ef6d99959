// How the human force observer answers to torques of every frequency: measured, and in theory.
#pragma once

#include <complex>
#include <vector>

#include "app/study/signals.h"
#include "devices/files/session/session.h"

namespace limpid {

// f1_hat over f1 at increasing frequencies.
struct Response {
  std::vector<double> f;      // [Hz]
  std::vector<double> gain;   // [-]
  std::vector<double> phase;  // [rad], without jumps
};

// Where the gain falls below 1/sqrt(2) and where the phase falls below -45 degrees [rad/s]; a
// first-order lag has both at its w_f. 0 if it never happens.
double gain_bandwidth(const Response& response);
double phase_bandwidth(const Response& response);

// Measured along the direction u in joint space at the lines of a shaking hand; the session's rows
// from `from` on last whole periods of it.
Response measured_response(const Session& session, std::size_t from, const Eigen::VectorXd& u,
                           const Multisine& shaking);

// (17) in ticks: the torque of the last two ticks, seen through the lag
// f1_hat_k = E f1_hat_k-1 + (1 - E) d_k, E = 1 / (1 + w_f T + (w_f T)^2 / 2).
Response sampled_response(const std::vector<double>& f, double w_f, double T);

// The rate at which an error dies away in that lag [1/s]; w_f while w_f T is small.
double sampled_decay(double w_f, double T);

}  // namespace limpid
