#include "app/experiments/live.h"

#include <Eigen/QR>
#include <array>
#include <cmath>
#include <stdexcept>

#include "app/experiments/contact_series.h"
#include "app/experiments/tap_bench.h"
#include "app/run/analysis.h"
#include "core/dynamics/arm.h"
#include "core/math/high_pass.h"

namespace limpid {

// Each in its own file, live_NAME.cpp.
Outcome live_coordination(LiveLaboratory& lab);
Outcome live_inertia(LiveLaboratory& lab);
Outcome live_passivity(LiveLaboratory& lab);
Outcome live_zwidth(LiveLaboratory& lab);

namespace {

constexpr std::array kLiveExperiments{
    LiveExperiment{"coordination", "device and proxy while you press (Figs. 3 and 4)",
                   live_coordination},
    LiveExperiment{"inertia", "what you feel at three etas (Fig. 5)", live_inertia},
    LiveExperiment{"passivity", "controller energy while you touch and circle (Fig. 6)",
                   live_passivity},
    LiveExperiment{"zwidth", "the stiffest wall that does not buzz in your hand", live_zwidth},
};

// The mean over as many rows to both sides, twice: nothing is shifted in time.
std::vector<Eigen::VectorXd> smooth(const std::vector<Eigen::VectorXd>& raw, std::size_t reach) {
  std::vector<Eigen::VectorXd> values = raw;
  for (int pass = 0; pass < 2; ++pass) {
    const std::vector<Eigen::VectorXd> from = values;
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(from.front().size());
    for (std::size_t k = 0; k < from.size() + reach; ++k) {
      if (k < from.size()) sum += from[k];
      if (k > 2 * reach) sum -= from[k - 2 * reach - 1];
      if (k < reach || k - reach >= from.size()) continue;
      const std::size_t first = k > 2 * reach ? k - 2 * reach : 0;
      const std::size_t last = std::min(k, from.size() - 1);
      values[k - reach] = sum / static_cast<double>(last - first + 1);
    }
  }
  return values;
}

}  // namespace

std::span<const LiveExperiment> live_experiments() { return kLiveExperiments; }

Outcome carry_out(const LiveExperiment& experiment, LiveLaboratory& lab,
                  const std::filesystem::path& dir) {
  Outcome outcome = experiment.run(lab);
  Conditions conditions;
  conditions.add(lab.arm, lab.parameters);
  outcome.figure.caption += " " + conditions.of_the_device();
  write_outcome(live_name(experiment), outcome, dir);
  return outcome;
}

Felt felt_of(const Session& s, const ArmDescription& arm) {
  constexpr std::size_t kReach = 25;  // rows: passes a hand's few hertz, no tremor
  constexpr std::size_t kStep = 10;   // rows from one place that is looked at to the next
  if (s.size() < 8 * kReach) throw std::runtime_error("too short to say what is felt");
  std::vector<Eigen::VectorXd> x, torque;
  for (std::size_t k = 0; k < s.size(); ++k) {
    x.push_back(vector_at(s, k, Column::device_position));
    torque.push_back(vector_at(s, k, Column::hand_torque_estimate));
  }
  x = smooth(x, kReach);
  torque = smooth(torque, kReach);
  const double T = s.info.tick;
  // f1_hat = share M a + what each joint has of damping and of a steady push: so that neither of
  // them leaks into the share.
  const Eigen::Index n = x[0].size();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(1 + 2 * n, 1 + 2 * n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(1 + 2 * n);
  for (std::size_t k = 3 * kReach; k + 3 * kReach < s.size(); k += kStep) {
    const double h = kStep * T;
    const Eigen::MatrixXd M = arm_at(arm, x[k]).M;
    Eigen::MatrixXd along(n, 1 + 2 * n);
    along.col(0) = M * (x[k + kStep] - 2 * x[k] + x[k - kStep]) / (h * h);
    along.middleCols(1, n) = ((x[k + kStep] - x[k - kStep]) / (2 * h)).asDiagonal();
    along.rightCols(n).setIdentity();
    // Without the observer's lag, (17): f1 = f1_hat + M f1_hat' / alpha.
    const Eigen::VectorXd f1 = torque[k] + M * (torque[k + kStep] - torque[k - kStep]) /
                                               (2 * h * s.at(k, Column::alpha)[0]);
    normal += along.transpose() * along;
    right += along.transpose() * f1;
  }
  const Eigen::VectorXd found = normal.completeOrthogonalDecomposition().solve(right);
  return {found[0], found.segment(1, n)};
}

double chatter_in_contact(const Session& s, const ArmDescription& description) {
  const Arm<kAnyDof> arm(description);
  const double T = s.info.tick;
  HighPass fast[] = {{TapBench::kFast, 1 / T}, {TapBench::kFast, 1 / T}, {TapBench::kFast, 1 / T}};
  double sum = 0;
  std::size_t touching = 0;
  Vec3 before = arm.tip_at(vector_at(s, 0, Column::device_position));
  for (std::size_t k = 0; k < s.size(); ++k) {
    const Vec3 tip = arm.tip_at(vector_at(s, k, Column::device_position));
    Vec3 v = (tip - before) / T;
    before = tip;
    for (int i = 0; i < 3; ++i) v[i] = fast[i](v[i]);
    if (!(contact_torque(s, k) > 0)) continue;
    sum += v.squaredNorm();
    ++touching;
  }
  return touching > 0 ? std::sqrt(sum / static_cast<double>(touching)) : 0;
}

}  // namespace limpid
