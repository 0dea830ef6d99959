#include "core/touch/stop_hit.h"

#include <algorithm>
#include <cmath>

#include "core/touch/impact.h"

namespace limpid {

void StopHit::begin(const BodyJoint& joint, double place, double rate, double theta, double force,
                    double T) {
  holds = speed < 0 || (speed > 0 && force != 0);
  if (!holds && force == 0) speed = std::abs(rate) > Impact::kSlowest ? std::abs(rate) : 0;
  pulls = speed > 0;
  lossless = speed != 0 && joint.stop_restitution > 0;
  if (!holds) return;
  const bool up = upper_is_nearer(joint, place);
  const double inwards = up ? rate : -rate;
  if (pulls) speed = std::max(speed, inwards);
  const double kept = std::max(joint.stop_restitution, kLeastKept) * std::abs(speed);
  // The speed at the tick's end is inwards + (mean - inwards)/theta.
  const double mean = inwards - theta * (kept + inwards);
  const double to_other_stop = up ? place - joint.low : joint.high - place;
  least = std::clamp(mean, -std::max(0.0, to_other_stop) / T, 0.0);
}

void StopHit::finish(const BodyJoint& joint, double place, double way) {
  if (!holds || (pulls && least == 0)) return;  // none, or only stopped so far
  const bool up = upper_is_nearer(joint, place);
  const double inwards = up ? way : -way;
  const double depth = (up ? place - joint.high : joint.low - place) + inwards;
  if (depth < 0 || (!pulls && inwards >= 0)) {
    speed = 0;
  } else if (inwards < 0) {
    speed = -std::abs(speed);
  }
}

double StopHit::limited(double force, double free, double sign, double answer) const {
  const double still = free / answer;  // the force that stops the joint
  if (!holds || force <= still) return force;
  const double left = (free + sign * trembling - least) / answer;
  return std::clamp(left, pulls ? still : std::max(0.0, still), force);
}

}  // namespace limpid
