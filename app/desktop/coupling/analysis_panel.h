// Panel of the couplings' analysis at the arm's present pose: walls, free motion, limits of eta,
// poles in the hand.
#pragma once

#include <atomic>
#include <complex>
#include <future>
#include <span>
#include <string>
#include <vector>

#include "app/run/analysis.h"
#include "app/run/tip_limits.h"
#include "app/run/wall_trial.h"
#include "core/dynamics/arm_description.h"

namespace limpid {

class AnalysisPanel {
 public:
  AnalysisPanel() = default;
  ~AnalysisPanel() { stop_ = true; }
  AnalysisPanel(const AnalysisPanel&) = delete;
  AnalysisPanel& operator=(const AnalysisPanel&) = delete;

  // Draws into the open ImGui window. `x`: the arm's pose [rad]; `band`: the human's bandwidth
  // [Hz], which can be changed here.
  void draw(const Parameters& p, const ArmDescription& arm, const Scene& scene,
            std::span<const double> x, double& band);

 private:
  void update(const Parameters& p, const ArmDescription& arm, const Scene& scene,
              std::span<const double> x, double band);
  void draw_walls(const Parameters& p) const;
  void draw_trial(const Parameters& p, const ArmDescription& arm, std::span<const double> x);
  void draw_felt(const Parameters& p, double band) const;
  void draw_nyquist(const Parameters& p) const;
  void draw_observed(const Parameters& p, double& band);

  Analysis analysis_;
  TipLimits tip_;
  std::vector<std::complex<double>> poles_;
  std::string basis_;  // how the analysis knows inertia, damping and delay
  double due_ = 0;     // when the pose is read again [s of ImGui's time]
  std::string tried_;  // label of the law whose wall was tried
  WallTrial trial_;
  std::atomic<bool> stop_ = false;
  std::future<WallTrial> coming_;  // waits for its thread when it goes, so it goes first
};

}  // namespace limpid
