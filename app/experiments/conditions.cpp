#include "app/experiments/conditions.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

namespace limpid {
namespace {

constexpr std::size_t kListed = 4;  // more values are told by the first and the last

std::string values(const std::set<double>& set, const std::string& unit) {
  std::vector<std::string> words;
  for (const double value : set) words.push_back(fmt::format("{:.4g}", value));
  if (words.size() > kListed) return fmt::format("{} to {} {}", words.front(), words.back(), unit);
  if (words.size() < 2) return fmt::format("{} {}", words.front(), unit);
  const std::string last = words.back();
  words.pop_back();
  return fmt::format("{} and {} {}", fmt::join(words, ", "), last, unit);
}

// "none", or the values; zero among others is said in words, too.
std::string or_none(std::set<double> set, const std::string& unit, const std::string& none) {
  const bool zero = set.erase(0) > 0;
  if (set.empty()) return none;
  return (zero ? none + " and " : "") + values(set, unit);
}

}  // namespace

void Conditions::add(const ArmDescription& arm, const Parameters& p) {
  arms_.insert(arm.name);
  joints_.insert(arm.dof());
  if (std::isnan(p.torque_limit)) {
    for (const Joint& joint : arm.joints) own_limits_.insert(joint.effort);
  } else {
    limits_.insert(p.torque_limit);
  }
  grips_.insert(p.hand_stiffness);
  dampers_.insert(p.hand_damping);
  masses_.insert(p.hand_mass_at_tip);
  encoders_.insert(p.encoder_step);
  delays_.insert(1e3 * p.tick * p.device_delay);
  ticks_.insert(1e3 * p.tick);
}

std::string Conditions::arms() const {
  std::string names;
  for (const std::string& name : arms_) names += (names.empty() ? "" : ", ") + name;
  if (joints_.size() > 1) {
    return fmt::format("{} of {} to {} joints", names, *joints_.begin(), *joints_.rbegin());
  }
  return fmt::format("{} of {} joint{}", names, *joints_.begin(), *joints_.begin() > 1 ? "s" : "");
}

std::string Conditions::motors() const {
  const std::string own = own_limits_.empty() ? "" : "the arm's own, " + values(own_limits_, "N m");
  if (limits_.empty()) return own;
  return (own.empty() ? "" : own + "; and ") + values(limits_, "N m");
}

std::string Conditions::text() const {
  if (arms_.empty()) return "";
  return fmt::format(
      "Conditions: arm {}; limit of every motor: {}; grip {}, {}; {}; {}; {}; tick {}.", arms(),
      motors(), values(grips_, "N/m"), or_none(dampers_, "N s/m", "undamped"),
      or_none(masses_, "kg in the hand", "no mass in the hand"),
      or_none(encoders_, "rad a step of the encoders", "exact encoders"),
      or_none(delays_, "ms of delay", "no delay"), values(ticks_, "ms"));
}

std::string Conditions::of_the_device() const {
  return fmt::format("Conditions: arm {}; limit of every motor: {}; tick {}.", arms(), motors(),
                     values(ticks_, "ms"));
}

}  // namespace limpid
