#include "app/run/fitted_gains.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/run/analysis.h"
#include "core/dynamics/arm.h"
#include "core/math/eigen.h"
#include "core/math/elementary.h"

namespace limpid {
namespace {

constexpr double kPaperDamping = 0.012;  // b_d [N m s/rad]
constexpr double kAmple = 5;             // times the paper's: stiffer gains are worth it then
// The built-in arm's b_d over the geometric mean of its inertia's modes at rest [1/s].
constexpr double kRate = 50;
constexpr double kLeastMeasured = 1e-3;  // gains need some damping to go by [N m s/rad]
constexpr double kSpread = 100;  // heaviest mode over the one that the damping is for, at most

// Returns the unit of a number's second digit: a power of ten.
double unit_of(double x) {
  const double digits = std::floor(logarithm(x) / std::numbers::ln10);
  // The quotient may round across a power of ten.
  const double above = power(10, digits + 1), below = power(10, digits);
  return power(10, digits - (x >= above ? 0 : x < below ? 2 : 1));
}

// Rounds to two digits, downwards or upwards.
double down(double x) {
  const double unit = unit_of(x);
  return std::floor(x / unit * (1 + 1e-12)) * unit;
}
double up(double x) {
  const double unit = unit_of(x);
  return std::ceil(x / unit * (1 - 1e-12)) * unit;
}

void set(Parameters& p, const char* key, double value) {
  // The number goes through its text, so that it is the one that people see.
  const double written = std::stod(fmt::format("{:.6g}", value));
  set_parameter_number(p, *find_parameter(key), written);
}

// Returns a damping for an arm whose file says none for all joints. A joint that comes to rest
// within a tick would ring in laws that model it by the midpoint rule: so the lightest mode bounds
// the damping.
double wanted_damping(const ArmDescription& arm, double tick) {
  double said = 0;
  for (const Joint& joint : arm.joints) {
    if (joint.damping > 0) said = said > 0 ? std::min(said, joint.damping) : joint.damping;
  }
  if (said > 0) return said;
  const Eigen::VectorXd modes = symmetric_eigen(arm_at(arm, rest_pose(arm)).M).values;
  double sum = 0;
  for (const double mode : modes) sum += logarithm(std::max(mode, 1e-300));
  const double mean = exponential(sum / static_cast<double>(modes.size()));
  const double wanted = kRate * std::max(mean, modes.maxCoeff() / kSpread);
  return up(std::min(wanted, 2 * modes[0] / tick));
}

// Delay of a device's readings by its arm's file [s].
double delay_of(const ArmDescription& arm) { return arm.delay.value_or(arm.assumed_delay); }

bool same_springs(const Parameters& a, const Parameters& b) {
  return a.k_vc == b.k_vc && a.b_vc == b.b_vc && a.b_v == b.b_v;
}

bool same(const Parameters& a, const Parameters& b, const char* key) {
  const ParameterInfo& info = *find_parameter(key);
  return parameter_text(a, info) == parameter_text(b, info);
}

}  // namespace

Parameters fitted(const ArmDescription& arm, const Parameters& chosen, double delay,
                  const LinkSettings& link) {
  delay = std::max(delay, arm.delay.value_or(0));
  Parameters p;
  const Eigen::VectorXd of_joints = device_damping(arm, p);
  double b_d = of_joints.minCoeff();
  const bool suits =
      condition3(p, p.tick, std::span(&b_d, 1), delay, link).holds && b_d <= kAmple * kPaperDamping;
  if (suits) return p;
  if (chosen.damping > 0) {
    p.damping = b_d = chosen.damping;
  } else if (arm.delay) {  // measured: no damping means none
    b_d = std::max(b_d, kLeastMeasured);
  } else if (!(b_d > 0)) {
    set(p, "device.damping", wanted_damping(arm, chosen.tick));
    b_d = p.damping;
  }
  const bool least_fits = std::isnan(p.damping) && b_d == of_joints.minCoeff();
  p.per_joint = least_fits && of_joints.maxCoeff() > b_d && same_springs(chosen, {});
  // Gains follow (3) for packets that are `old` [s], and velocities that count `again` times more.
  const double old = link.oldest() * chosen.tick, again = 0.5 * link.link_jitter;
  set(p, "coupling.b_vc", down(b_d / (12 + 6 * again)));
  set(p, "coupling.k_vc", down((b_d - (2 + again) * p.b_vc) / (chosen.tick + 1.5 * delay + old)));
  const double least = again * p.b_vc + p.k_vc * (chosen.tick + delay + 2 * old) / 2;
  set(p, "coupling.b_v", up(std::max(b_d, least)));
  set(p, "observer.alpha", down(35.0 / 12 * b_d));
  // Gains beyond (3), at their least value, would be so by the largest weight.
  p.per_joint = p.per_joint && condition3(p, chosen.tick, std::span(&b_d, 1), delay, link).holds;
  return p;
}

Parameters with_readings_of(const ArmDescription& arm, Parameters p) {
  p.encoder_step = arm.encoder_step;
  p.device_delay = p.delay =
      static_cast<int>(std::min<long>(kMostDelay, std::lround(delay_of(arm) / p.tick)));
  return p;
}

Parameters fitted_with_readings(const ArmDescription& arm, const Parameters& chosen) {
  Parameters p = fitted(arm, chosen, delay_of(arm));
  p.tick = chosen.tick;  // the delay is in whole ticks
  return with_readings_of(arm, p);
}

std::string readings_text(const ArmDescription& arm, const Parameters& p) {
  const Parameters filed = with_readings_of(arm, p);
  if (filed.encoder_step == 0 && filed.device_delay == 0) return {};
  if (filed.encoder_step == p.encoder_step && filed.device_delay == p.device_delay) return {};
  const bool slides = arm.only_slides();
  const auto told = [slides](const Parameters& of) {
    const std::string step = of.encoder_step > 0
                                 ? fmt::format("encoder steps of {:.3g} {}",
                                               1000 * of.encoder_step * (slides ? kSlideUnit : 1),
                                               slides ? "mm" : "mrad")
                                 : "exact encoders";
    const std::string delay =
        of.device_delay > 0 ? fmt::format("a delay of {:.3g} ms", 1e3 * of.device_delay * of.tick)
                            : "no delay";
    return step + " and " + delay;
  };
  return fmt::format("the arm's file says {}; the settings say {}", told(filed), told(p));
}

CompensationSettings suggested_compensation(const ArmDescription& arm) {
  CompensationSettings c;
  if (!arm.delay) return c;
  c.holds_weight = !arm.gravity.isZero();
  for (const Joint& joint : arm.joints) {
    if (joint.friction > 0) c.friction_share = CompensationSettings::kUsualShare;
    c.holds_springs = c.holds_springs || joint.spring != 0 || joint.offset != 0;
  }
  return c;
}

std::string fit_text(const Parameters& own) {
  const Parameters paper;
  std::string text;
  for (const char* key : kFittedKeys) {
    if (same(own, paper, key)) continue;
    const ParameterInfo& info = *find_parameter(key);
    text += text.empty() ? "" : ", ";
    if (std::string_view(key) == "coupling.per_joint") {
      text += "gains that grow with each joint's damping";
    } else {
      text += fmt::format("{} {:.3g} {}", key, parameter_number(own, info), info.unit);
    }
  }
  return text;
}

void refit(Parameters& p, const ArmDescription* before, const ArmDescription* now) {
  Parameters paper;
  paper.tick = p.tick;
  const Parameters own = now != nullptr ? fitted(*now, paper) : paper;
  const Parameters old = before != nullptr ? fitted(*before, paper) : paper;
  const bool own_springs = !same_springs(p, paper) && !same_springs(p, old);
  for (const char* key : kFittedKeys) {
    if (!same(p, paper, key) && !same(p, old, key)) continue;
    if (own_springs && std::string_view(key) == "coupling.per_joint") continue;
    const ParameterInfo& info = *find_parameter(key);
    set_parameter_number(p, info, parameter_number(own, info));
  }
}

}  // namespace limpid
