#include "core/tick/arming.h"

#include <algorithm>

namespace limpid {

void ForceGate::step(ForceRequest wish, const Objections& against, double T) noexcept {
  const Arming before = state_;
  if (wish == ForceRequest::arm) take(ArmingEvent::arm);
  armed_anew_ = state_ != before;
  if (wish == ForceRequest::cut) take(ArmingEvent::cut);
  if (against.gap) take(ArmingEvent::gap);
  if (against.gap || !(state_ == Arming::fading || state_ == Arming::on)) gain_ = 0;
  if (against.fault != ForceState::on) {
    // Lets `lost` replace an earlier fault: an unplugged device falls silent first.
    const bool better = against.fault == ForceState::lost;
    if (state_ != Arming::tripped || better) tripped_ = against.fault;
    take(ArmingEvent::trip);
  }
  take(against.hand ? ArmingEvent::hand : ArmingEvent::no_hand);
  if (state_ == Arming::fading || state_ == Arming::on) {
    gain_ = against.ceiling > 0 ? std::min({1.0, against.ceiling, gain_ + T / kFade}) : 0;
    take(gain_ < 1 ? ArmingEvent::held_back : ArmingEvent::full);
  } else {
    gain_ = 0;
  }
  why_ = reason(against);
}

// Names a fault even while force is off: it is why arming would not help.
ForceState ForceGate::reason(const Objections& against) const noexcept {
  if (state_ == Arming::tripped) return tripped_;
  if (against.fault != ForceState::on) return against.fault;
  if (state_ == Arming::off) return ForceState::off;
  if (against.gap) return ForceState::stalled;
  if (state_ == Arming::waiting) return ForceState::no_hand;
  return against.limited;
}

}  // namespace limpid
