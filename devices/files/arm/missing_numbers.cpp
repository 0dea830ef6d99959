#include "devices/files/arm/missing_numbers.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "devices/files/arm/body.h"

namespace limpid {
namespace {

constexpr double kLeastShare = 1e-6;   // of what hangs on a link, its own inertia
constexpr double kGuess = 1e-3;        // where it is less
constexpr double kGravity = 9.81;      // [m/s^2]
constexpr double kLeastEffort = 0.01;  // [N m]

// What resists a joint: inertia about it, or of a slide mass along it [kg m^2].
double resistance(const Joint& joint, const Link& link) {
  if (slides(joint)) return link.mass * kSlideUnit * kSlideUnit;
  return joint.axis.dot(about_origin(link) * joint.axis);
}

// The most that such a joint could be resisted with by a body, whichever way it turned.
double most_resistance(const Joint& joint, const Link& body) {
  if (slides(joint)) return resistance(joint, body);
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(about_origin(body), Eigen::EigenvaluesOnly);
  return solver.eigenvalues().maxCoeff();
}

void check_body(const Link& link, const UrdfPlaces& places) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(link.inertia, Eigen::EigenvaluesOnly);
  const double largest = link.inertia.cwiseAbs().maxCoeff();
  if (solver.eigenvalues().minCoeff() < -1e-9 * largest) {
    places.refuse_link(link.name, "inertia is not that of any body (a negative moment)");
  }
}

// Link i with all that hangs on it, at zero, in its frame.
Link outer(const ArmDescription& arm, std::size_t i) {
  Link all;
  Pose at = Pose::Identity();
  for (std::size_t j = i; j < arm.links.size(); ++j) {
    if (j > i) at = at * arm.joints[j].origin;
    merge(all, arm.links[j], at);
  }
  return all;
}

std::string list(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace

void complete_inertias(ArmDescription& arm, UrdfPlaces& places) {
  for (const Link& link : arm.links) check_body(link, places);
  if (const Link all = outer(arm, 0); !(all.mass > 0) && !(all.inertia.norm() > 0)) {
    places.refuse(
        "no link that moves has an <inertial>; needed: mass and inertia of each, as from CAD or a "
        "data sheet");
  }
  std::vector<std::string> guessed;
  for (std::size_t i = arm.links.size(); i-- > 0;) {
    Link& link = arm.links[i];
    const Joint& joint = arm.joints[i];
    const Link all = outer(arm, i);
    const double most = most_resistance(joint, all);
    if (resistance(joint, link) > kLeastShare * most) continue;
    if (!(most > 0 && std::isfinite(most))) {
      places.refuse_link(
          link.name,
          fmt::format("inertia {:.3g} kg m^2 about joint '{}', and nothing beyond it; needed: more "
                      "than 0 (its <inertial> or that of links fixed to it), or a tip before it "
                      "(--tip LINK)",
                      resistance(joint, link), joint.name));
    }
    const double least = kGuess * most;
    if (slides(joint)) {
      link.mass += kGuess * all.mass;
    } else {
      link.inertia += least * Mat3::Identity();
    }
    guessed.push_back(fmt::format("'{}' ({:.2g})", link.name, least));
  }
  if (guessed.empty()) return;
  std::ranges::reverse(guessed);
  places.warn(
      fmt::format("no inertia of their own: {}; taken as a thousandth of what hangs on them "
                  "[kg m^2]; an <inertial> says better",
                  list(guessed)));
}

void complete_efforts(ArmDescription& arm, UrdfPlaces& places) {
  std::vector<std::string> guessed;
  double weight = 0, moment = 0;  // of what is beyond, stretched out [N, N m]
  for (std::size_t i = arm.joints.size(); i-- > 0;) {
    Joint& joint = arm.joints[i];
    const Link& link = arm.links[i];
    if (i + 1 < arm.joints.size()) {
      moment += weight * arm.joints[i + 1].origin.translation().norm();
    }
    moment += kGravity * link.mass * link.com.norm();
    weight += kGravity * link.mass;
    if (joint.effort != 0) continue;
    joint.effort = std::max(kLeastEffort, 2 * (slides(joint) ? weight * kSlideUnit : moment));
    guessed.push_back(slides(joint)
                          ? fmt::format("'{}' ({:.2g} N)", joint.name, joint.effort / kSlideUnit)
                          : fmt::format("'{}' ({:.2g} N m)", joint.name, joint.effort));
  }
  if (guessed.empty()) return;
  std::ranges::reverse(guessed);
  places.warn(
      fmt::format("no effort in <limit>: {}; taken as twice what holds the arm stretched "
                  "out",
                  list(guessed)));
}

}  // namespace limpid
