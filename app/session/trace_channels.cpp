#include "app/session/trace_channels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace limpid {
namespace {

double norm(std::span<const double> v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

constexpr int kMostJointCurves = 7;

}  // namespace

std::vector<double> motor_limits(const ArmDescription& arm, const Parameters& p) {
  std::vector<double> limits;
  for (const Joint& joint : arm.joints) {
    limits.push_back(std::isnan(p.torque_limit) ? joint.effort : p.torque_limit);
  }
  return limits;
}

TraceChannels::TraceChannels(const RowLayout& layout) : layout_(layout) {}

bool TraceChannels::limited(std::span<const double> row, int joint) const {
  const auto j = static_cast<std::size_t>(joint);
  if (j >= limits_.size()) return false;
  const double given = std::abs(layout_.in(row, Column::motor_torque)[j]);
  const double asked = std::abs(layout_.in(row, Column::commanded_torque)[j]);
  // A law that knows the limit asks for no more than that.
  return given >= limits_[j] * (1 - 1e-9) && asked >= given * (1 - 1e-9);
}

void TraceChannels::values(std::span<const double> row, std::span<double> into) const {
  const auto at = [&](Column c) { return layout_.in(row, c); };
  const auto put = [&](Channel c, double value) { into[static_cast<std::size_t>(c)] = value; };
  const auto x1 = at(Column::device_position);
  const auto x2 = at(Column::proxy_position);
  const std::span<double> joints = into.subspan(static_cast<std::size_t>(Channel::joints));
  std::ranges::transform(x1, x2, joints.begin(), std::minus{});
  put(Channel::kind, at(Column::kind)[0]);
  put(Channel::error, norm(joints.first(x1.size())));
  put(Channel::energy_total, at(Column::energy_total)[0]);
  put(Channel::energy_commanded, at(Column::energy_commanded)[0]);
  put(Channel::human, norm(layout_.human_torque(row)));
  put(Channel::human_estimate, norm(at(Column::hand_torque_estimate)));
  put(Channel::contact, norm(at(Column::contact_torque)));
  bool any_limited = false;
  for (int j = 0; j < layout_.dof(); ++j) any_limited = any_limited || limited(row, j);
  put(Channel::limited, any_limited ? 1 : 0);
}

void TraceChannels::append(History& history, std::span<const double> row,
                           std::span<const double> again) const {
  const auto one = static_cast<std::size_t>(count());
  std::array<double, 2 * (static_cast<std::size_t>(Channel::joints) + kMaxDof)> all{};
  const auto used = std::span(all).first(static_cast<std::size_t>(history.channels()));
  values(row, used.first(one));
  if (used.size() > one) {
    if (again.empty()) {
      std::ranges::fill(used.subspan(one), std::numeric_limits<double>::quiet_NaN());
    } else {
      values(again, used.subspan(one));
    }
  }
  history.append(layout_.in(row, Column::time)[0], used);
}

std::vector<PlotSpec> TraceChannels::plots(const RunNames& names) const {
  const auto curve = [&](Channel c, std::string label, Ink ink, float shade, bool again) {
    Curve result;
    result.channel = static_cast<int>(c) + (again ? count() : 0);
    const std::string& run = again ? names.second : names.first;
    result.label = run.empty() ? std::move(label) : run + " " + label;
    result.ink = again && !names.twin ? Ink::rerun : ink;
    result.shade = again && names.twin ? shade + 0.55f : shade;
    // Two runs leave no room for what is seldom asked for; a click on the legend shows it.
    result.visible =
        !names.twin || (c != Channel::energy_commanded && c != Channel::human_estimate);
    if (!names.twin) result.dash_channel = static_cast<int>(Channel::kind) + (again ? count() : 0);
    return result;
  };
  PlotSpec error{.title = "coordination error |x_E|",
                 .unit = "mrad",
                 .factor = 1e3,
                 .units = {{"mrad", 1e3, 1}, {"rad", 1, 1e9}},
                 .file_name = "coordination-error",
                 .smallest_span = 20e-3};
  PlotSpec energy{.title = "controller energy E_c",
                  .unit = "mJ",
                  .factor = 1e3,
                  .units = {{"mJ", 1e3, 1}, {"J", 1, 1e9}},
                  .file_name = "controller-energy",
                  .smallest_span = 1e-3};
  PlotSpec torque{.title = "human and contact torque",
                  .unit = "N m",
                  .factor = 1,
                  .file_name = "torque",
                  .smallest_span = 0.05};
  for (PlotSpec* plot : {&error, &energy, &torque}) {
    plot->band_channel = static_cast<int>(Channel::limited);
    plot->band_label = "motor at its limit";
  }
  for (const bool again : {false, true}) {
    if (again && names.second.empty()) break;
    error.curves.push_back(curve(Channel::error, "|x_E|", Ink::proxy, 0, again));
    energy.curves.push_back(curve(Channel::energy_total, "total", Ink::energy, 0, again));
    energy.curves.push_back(
        curve(Channel::energy_commanded, "commanded", Ink::energy, 0.5f, again));
    torque.curves.push_back(curve(Channel::human, "|f1|", Ink::hand, 0, again));
    torque.curves.push_back(
        curve(Channel::human_estimate, "|f1| estimate", Ink::hand, 0.55f, again));
    torque.curves.push_back(
        curve(Channel::contact, "|f2|", Ink::contact, again && !names.twin ? -0.5f : 0, again));
  }
  for (int j = 0; j < std::min(layout_.dof(), kMostJointCurves); ++j) {
    const auto ink = static_cast<Ink>(static_cast<int>(Ink::joint_1) + j);
    Curve joint = curve(Channel::joints, "joint " + std::to_string(j + 1), ink, 0, false);
    joint.channel += j;
    joint.visible = false;
    error.curves.push_back(joint);
  }
  return {error, energy, torque};
}

}  // namespace limpid
