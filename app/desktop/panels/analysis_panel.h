// Passivity at the arm's present pose: Nyquist plot, limits of eta, poles in the hand.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "app/run/analysis.h"
#include "core/dynamics/arm_description.h"

namespace limpid {

class AnalysisPanel {
 public:
  // Draws into the ImGui window that is open. `x`: the arm's pose [rad]; `band`: the human's
  // bandwidth [Hz], which can be changed here.
  void draw(const Parameters& p, const ArmDescription& arm, std::span<const double> x,
            double& band);

 private:
  void update(const Parameters& p, const ArmDescription& arm, std::span<const double> x,
              double band);
  void draw_nyquist(const Parameters& p) const;

  Analysis analysis_;
  std::vector<std::complex<double>> poles_;
  double due_ = 0;  // when to look at the pose again [s of ImGui's time]
};

}  // namespace limpid
