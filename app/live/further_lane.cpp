#include "app/live/further_lane.h"

#include <algorithm>
#include <limits>

namespace limpid {

void FurtherLane::open(std::unique_ptr<Rig> rig) {
  rig_ = std::move(rig);
  running_ = false;
}

void FurtherLane::step(bool on, const Parameters& p, const Rig& first, const RigInput& input,
                       std::span<double> row) noexcept {
  changed_ = running_ && !(p == parameters_);
  parameters_ = p;
  if (!on) {
    if (running_) std::ranges::fill(row, std::numeric_limits<double>::quiet_NaN());
    running_ = false;
    return;
  }
  if (!running_ || anew_) {
    first.present(start_);
    start_.armed = first.force().armed();
    rig_->start(parameters_, start_);
    running_ = true;
    anew_ = false;
  }
  rig_->step(parameters_, input, row);
}

void FurtherLane::restart_here(const Vec3& target) noexcept {
  if (running_) rig_->restart_here(parameters_, start_, target);
}

}  // namespace limpid
