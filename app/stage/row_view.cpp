#include "app/stage/row_view.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/touch/mass_properties.h"

namespace limpid {

namespace {

constexpr double kTrail = 1.0;        // duration of the tips' trail [s]
constexpr double kSamePlace = 0.015;  // a contact that moved less is the same one [m]
constexpr double kPause = 0.05;       // a contact away for less has not ended [s]

Vec<kAnyDof> joints(std::span<const double> x) {
  return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

}  // namespace

RowView::RowView(const ArmDescription& arm, const Scene& scene) : arm_(arm) { show(scene); }

void RowView::show(const Scene& scene) {
  centers_.clear();
  for (const Object& object : scene.objects) {
    if (object.body) centers_.push_back(mass_properties(object).center);
  }
}

ArmPose RowView::pose(std::span<const double> x) const {
  Arm<kAnyDof>::Frames f;
  arm_.frames(joints(x), f);
  ArmPose pose;
  for (std::size_t i = 0; i < x.size(); ++i) {
    Pose link = Pose::Identity();
    link.linear() = f.R[i];
    link.translation() = f.p[i];
    pose.links.push_back(link);
  }
  pose.tip = arm_.tip(f);
  return pose;
}

Vec3 RowView::tip(std::span<const double> x) const { return arm_.tip_at(joints(x)); }

Vec3 RowView::tip_force(std::span<const double> x, std::span<const double> torque) const {
  Arm<kAnyDof>::Frames f;
  arm_.frames(joints(x), f);
  Jacobian<kAnyDof> J;
  arm_.point_jacobian(f, arm_.dof() - 1, arm_.tip(f), J);
  Mat3 A = J * J.transpose();
  A.diagonal().array() += 1e-9 * A.trace();
  return A.ldlt().solve(J * joints(torque));
}

std::vector<ContactForce> RowView::contacts(const RowLayout& layout,
                                            std::span<const double> row) const {
  const auto points = layout.in(row, Column::contact_point);
  const auto forces = layout.in(row, Column::contact_force);
  if (std::isnan(forces[0])) {
    const auto x2 = layout.in(row, Column::proxy_position);
    return {{tip(x2), tip_force(x2, layout.in(row, Column::contact_torque))}};
  }
  std::vector<ContactForce> contacts;
  for (std::size_t i = 0; i < forces.size(); i += 3) {
    const Vec3 force(forces[i], forces[i + 1], forces[i + 2]);
    if (force.isZero(0)) continue;
    contacts.push_back({Vec3(points[i], points[i + 1], points[i + 2]), force});
  }
  return contacts;
}

std::vector<Pose> RowView::bodies(const RowLayout& layout, std::span<const double> row) const {
  const auto all = layout.in(row, Column::body_pose);
  std::vector<Pose> frames;
  const std::size_t count = std::min(centers_.size(), static_cast<std::size_t>(layout.bodies()));
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = all.subspan(i * kPoseNumbers, kPoseNumbers);
    Pose frame = Pose::Identity();
    frame.linear() = Eigen::Quaterniond(x[3], x[4], x[5], x[6]).normalized().toRotationMatrix();
    frame.translation() = Vec3(x[0], x[1], x[2]) - frame.linear() * centers_[i];
    frames.push_back(frame);
  }
  return frames;
}

ViewState RowView::view(const RowLayout& layout, std::span<const double> row) const {
  const auto at = [&](Column c) { return layout.in(row, c); };
  ViewState view;
  view.device = pose(at(Column::device_position));
  view.proxy = pose(at(Column::proxy_position));
  const auto target = at(Column::hand_target);
  view.hand_target = Vec3(target[0], target[1], target[2]);
  view.hand_grips = view.show_hand = at(Column::hand_grip)[0] > 0.5;
  view.hand_force = tip_force(at(Column::device_position), layout.human_torque(row));
  view.bodies = bodies(layout, row);
  if (const auto q = at(Column::tool_orientation); !std::isnan(q[0])) {
    view.tool = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  }
  if (layout.has(Column::hand_magnet)) {
    view.magnet = at(Column::hand_magnet)[0] > 0;
    view.magnet_holds = at(Column::magnet)[0] > 0;
    const auto body = static_cast<std::size_t>(std::max(0.0, at(Column::hand_pull)[0]));
    if (body > 0 && body <= view.bodies.size()) {
      const auto vector = [&](Column c) { return Vec3(at(c)[0], at(c)[1], at(c)[2]); };
      view.pulled = body - 1;
      view.pull = {view.bodies[body - 1] * vector(Column::pull_point), vector(Column::pull_target)};
    }
  }
  return view;
}

void lay_over(ViewState& view, const ViewState& other) {
  view.beside.push_back(
      {other.device, other.proxy, other.hand_force, other.contacts, other.bodies});
}

void ViewMemory::clear() {
  touches_.clear();
  tips_.clear();
}

void ViewMemory::update(ViewState& view, std::span<const ContactForce> contacts, double time) {
  if (!tips_.empty() && (time < tips_.back().time || time > tips_.back().time + 1)) clear();
  if (!tips_.empty() && tips_.back().time == time) tips_.pop_back();  // time stands still
  tips_.push_back({time, view.device.tip, view.proxy.tip});
  while (tips_.front().time < time - kTrail) tips_.pop_front();
  for (const Tips& tips : tips_) {
    view.device.trail.push_back(tips.device);
    view.proxy.trail.push_back(tips.proxy);
  }

  for (const ContactForce& contact : contacts) {
    if (contact.force.isZero()) continue;
    const auto same = [&](const Touch& t) { return (t.point - contact.point).norm() < kSamePlace; };
    auto touch = std::ranges::find_if(touches_, same);
    if (touch == touches_.end()) touch = touches_.insert(touch, {contact.point, time, time});
    touch->point = contact.point;
    touch->seen = time;
    view.contacts.push_back({contact.point, contact.force, time - touch->began});
  }
  std::erase_if(touches_, [&](const Touch& t) { return t.seen < time - kPause; });
}

}  // namespace limpid
