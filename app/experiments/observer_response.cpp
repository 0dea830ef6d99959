#include "app/experiments/observer_response.h"

#include <cmath>
#include <numbers>

#include "app/experiments/harmonics.h"
#include "app/experiments/series.h"

namespace limpid {
namespace {

constexpr double kPi = std::numbers::pi;

double lag(double w_f, double T) {
  constexpr double kPole = 1 - 1 / std::numbers::sqrt2;
  const double A = w_f * T;
  return (1 + (2 * kPole - 1) * A) / std::pow(1 + kPole * A, 2);
}

void add(Response& r, double f, std::complex<double> H) {
  double phase = std::arg(H);
  const double before = r.phase.empty() ? 0 : r.phase.back();
  phase -= 2 * kPi * std::round((phase - before) / (2 * kPi));
  r.f.push_back(f);
  r.gain.push_back(std::abs(H));
  r.phase.push_back(phase);
}

std::vector<double> along(const Session& s, std::size_t from, Column column,
                          const Eigen::VectorXd& u) {
  std::vector<double> values;
  for (std::size_t k = from; k < s.size(); ++k) values.push_back(u.dot(vector_at(s, k, column)));
  return values;
}

}  // namespace

double gain_bandwidth(const Response& response) {
  return 2 * kPi * falls_through(response.f, response.gain, std::numbers::sqrt2 / 2);
}

double phase_bandwidth(const Response& response) {
  return 2 * kPi * falls_through(response.f, response.phase, -kPi / 4);
}

Response measured_response(const Session& session, std::size_t from, const Eigen::VectorXd& u,
                           const Multisine& shaking) {
  const double T = session.info.tick;
  const std::vector<double> human = along(session, from, Column::hand_torque, u);
  const std::vector<double> estimate = along(session, from, Column::hand_torque_estimate, u);
  Response response;
  for (const Multisine::Line& line : shaking.lines) {
    const double f = shaking.frequency(line);
    // A row holds the mean torque over the tick that follows t_k.
    const double half = kPi * f * T;
    const std::complex<double> mean = std::polar(std::sin(half) / half, half);
    add(response, f, amplitude_at(estimate, T, f) * mean / amplitude_at(human, T, f));
  }
  return response;
}

Response sampled_response(const std::vector<double>& f, double w_f, double T) {
  const double E = lag(w_f, T);
  Response response;
  for (const double hertz : f) {
    const double half = kPi * hertz * T;
    const double sinc = std::sin(half) / half;
    const std::complex<double> delay = std::polar(1.0, -2 * half);
    add(response, hertz, sinc * sinc * delay * (1 - E) / (1.0 - E * delay));
  }
  return response;
}

// Of fast modes the error changes its sign from tick to tick.
double sampled_decay(double w_f, double T) { return -std::log(std::abs(lag(w_f, T))) / T; }

}  // namespace limpid
