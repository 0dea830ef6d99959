#include "app/experiments/staggered.h"

#include <algorithm>
#include <cmath>

#include "core/dynamics/arm.h"
#include "devices/simulated/rig.h"
#include "devices/simulated/virtual_arm.h"

namespace limpid {

namespace {

constexpr double kTooFast = 100;  // faster tips or bodies have diverged [m/s]

// The staggered body, and the force of the tip's spring.
class Partner {
 public:
  Partner(const StaggeredBody& body, const Vec3& tip, double T) : body_(body), T_(T), tip_(tip) {
    stretch_ = body.normal ? Vec3(body.gap * *body.normal) : Vec3(Vec3::Zero());
    q_ = tip - stretch_;
  }

  // Force on the tip over the tick that begins [N].
  Vec3 force(const Vec3& tip) {
    const Vec3 x = tip - q_, rate = (tip - tip_) / T_ - v_;
    tip_ = tip;
    if (!body_.normal) return -body_.stiffness * x - body_.damping * rate;
    const double depth = -body_.normal->dot(x), deeper = -body_.normal->dot(rate);
    if (depth <= 0) return Vec3::Zero();
    return std::max(0.0, body_.stiffness * depth + body_.damping * deeper) * *body_.normal;
  }
  // Steps the body over the tick; returns the energy that the body gave the tip [J].
  double live(const Vec3& on_tip) {
    Vec3 all = -on_tip;
    if (body_.own) all += body_.own(travel_) * *body_.normal;
    const Vec3 before = v_;
    v_ += T_ / body_.mass * all;
    q_ += T_ * v_;
    const double given = -0.5 * T_ * on_tip.dot(before + v_);
    if (!body_.normal) return given;
    travel_ -= T_ * body_.normal->dot(v_);
    if (travel_ < body_.least_travel) {
      q_ -= (body_.least_travel - travel_) * *body_.normal;
      travel_ = body_.least_travel;
      v_.setZero();
    }
    return given;
  }
  double travel() const { return travel_; }
  double speed() const { return v_.norm(); }

 private:
  const StaggeredBody& body_;
  double T_;
  Vec3 tip_, q_, stretch_;
  Vec3 v_ = Vec3::Zero();
  double travel_ = 0;
};

}  // namespace

double StaggeredRun::most_beyond() const {
  if (diverged) return std::numeric_limits<double>::infinity();
  return beyond.empty() ? 0 : *std::ranges::max_element(beyond);
}

StaggeredRun run_staggered(const ArmDescription& description, const Parameters& p,
                           const HandPath& hand, const StaggeredBody& body) {
  Arm<3> model(description);
  Arm<3>::Frames frames;
  VirtualArm<3> arm(description);
  const Vec<3> start = rest_at(description, hand.position.front()).x1;
  arm.place(start, Vec<3>::Zero(), hand.position.front());
  Vec<3> limit, damping;
  for (int j = 0; j < 3; ++j) {
    const Joint& joint = description.joints[static_cast<std::size_t>(j)];
    limit[j] = std::isnan(p.torque_limit) ? joint.effort : p.torque_limit;
    damping[j] = std::isnan(p.damping) ? joint.damping : p.damping;
  }
  Partner partner(body, arm.tip(), p.tick);
  StaggeredRun run;
  run.record.tick = p.tick;
  run.record.tip.push_back(arm.tip());
  double beyond = 0;
  for (std::size_t k = 0; k < hand.time.size(); ++k) {
    model.frames(arm.x(), frames);
    Jacobian<3> J;
    model.point_jacobian(frames, 2, arm.tip(), J);
    const Vec3 force = partner.force(arm.tip());
    const Vec<3> torque = (J.transpose() * force).cwiseMin(limit).cwiseMax(-limit);
    const Vec<3> before = arm.x();
    arm.live(p, torque, {hand.sample(k, p.tick), hand.grip_sample(k, p.tick)});
    const Vec<3> dx = arm.x() - before;
    beyond += torque.dot(dx) - damping.cwiseProduct(dx).dot(dx) / p.tick + partner.live(force);
    model.frames(before + dx / 2, frames);
    model.point_jacobian(frames, 2, model.tip(frames), J);
    const Mat3 to_joints = J.transpose();
    run.record.force.emplace_back(to_joints.lu().solve(arm.hand_torque()));
    run.record.tip.push_back(arm.tip());
    run.travel.push_back(partner.travel());
    run.contact.push_back(body.normal ? body.normal->dot(force) : force.norm());
    run.speed.push_back(partner.speed());
    run.beyond.push_back(beyond);
    const double fastest = std::max(partner.speed(), (J * arm.v()).norm());
    if (!(fastest < kTooFast)) {
      run.diverged = true;
      break;
    }
  }
  return run;
}

}  // namespace limpid
