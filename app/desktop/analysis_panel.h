// Passivity at the arm's present pose: Nyquist plot, limits of eta, poles in the hand.
#pragma once

#include "app/desktop/workbench.h"

namespace limpid {

class AnalysisPanel {
 public:
  // Draws into the ImGui window that is open.
  void draw(Workbench& bench);

 private:
  void update(Workbench& bench);
  void draw_nyquist(const Parameters& p) const;

  Analysis analysis_;
  std::vector<std::complex<double>> poles_;
  double due_ = 0;  // when to look at the pose again [s of ImGui's time]
};

}  // namespace limpid
