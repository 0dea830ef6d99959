// Frequency response of the human force observer: measured, and in theory.
#pragma once

#include <complex>
#include <vector>

#include "app/experiments/signals.h"
#include "devices/files/session/session.h"

namespace limpid {

// f1_hat over f1 at increasing frequencies.
struct Response {
  std::vector<double> f;      // [Hz]
  std::vector<double> gain;   // [-]
  std::vector<double> phase;  // [rad], without jumps
};

// Frequencies where the gain falls below 1/sqrt(2) and the phase below -45 degrees [rad/s]; both
// are w_f for a first-order lag. 0 if that never happens.
double gain_bandwidth(const Response& response);
double phase_bandwidth(const Response& response);

// Response measured along the direction u in joint space, at the frequencies of the shaking. The
// session's rows from `from` on must last whole periods.
Response measured_response(const Session& session, std::size_t from, const Eigen::VectorXd& u,
                           const Multisine& shaking);

// Response of the sampled (17): the torque of the last two ticks seen through the lag f1_hat_k = E
// f1_hat_k-1 + (1 - E) d_k, E = 1 / (1 + w_f T + (w_f T)^2 / 2).
Response sampled_response(const std::vector<double>& f, double w_f, double T);

// Rate at which an error of that lag decays [1/s]; w_f while w_f T is small.
double sampled_decay(double w_f, double T);

}  // namespace limpid
