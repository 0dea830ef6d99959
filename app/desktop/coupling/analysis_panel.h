// Panel of the couplings' analysis at the arm's present pose: walls, free motion, limits of eta,
// poles in the hand.
#pragma once

#include <complex>
#include <span>
#include <string>
#include <vector>

#include "app/run/analysis.h"
#include "app/run/tip_limits.h"
#include "core/dynamics/arm_description.h"

namespace limpid {

class AnalysisPanel {
 public:
  // Draws into the open ImGui window. `x`: the arm's pose [rad]; `band`: the human's bandwidth
  // [Hz], which can be changed here.
  void draw(const Parameters& p, const ArmDescription& arm, const Scene& scene,
            std::span<const double> x, double& band);

 private:
  void update(const Parameters& p, const ArmDescription& arm, const Scene& scene,
              std::span<const double> x, double band);
  void draw_walls(const Parameters& p) const;
  void draw_felt(const Parameters& p, double band) const;
  void draw_nyquist(const Parameters& p) const;
  void draw_observed(const Parameters& p, double& band);

  Analysis analysis_;
  TipLimits tip_;
  std::vector<std::complex<double>> poles_;
  std::string basis_;  // how the analysis knows inertia, damping and delay
  double due_ = 0;     // when the pose is read again [s of ImGui's time]
};

}  // namespace limpid
