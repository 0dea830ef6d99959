#include "app/run/run_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "app/run/analysis.h"
#include "app/run/replay.h"
#include "core/dynamics/arm.h"
#include "core/dynamics/inverse_kinematics.h"

namespace limpid {
namespace {

constexpr std::size_t kTipVelocity = 1;  // of the device, in kDerivedInfo

// Returns the largest E_c that the law allows [J].
double promised(const Parameters& p) {
  switch (info(p.kind).promise) {
    case Promise::ledger: return p.energy;
    case Promise::tanks: return p.tank_energy;
    default: return 0;
  }
}

// Returns a bound of the distance from any joint that turns to the tip [m]: infinite with a slide
// that has no end.
double longest_lever(const ArmDescription& arm) {
  for (const Joint& joint : arm.joints) {
    const bool ends = std::isfinite(joint.lower) && std::isfinite(joint.upper);
    if (joint.kind == Joint::Kind::prismatic && !ends) {
      return std::numeric_limits<double>::infinity();
    }
  }
  constexpr double kPushedIn = 1.5;  // slides give at their ends
  return kPushedIn * reach(arm);
}

std::string joules_text(double joules) {
  return std::abs(joules) < 0.1 ? fmt::format("{:.3g} mJ", 1e3 * joules)
                                : fmt::format("{:.3g} J", joules);
}

}  // namespace

RunWatch::RunWatch(const ArmDescription& arm, const RowLayout& layout, const Parameters& p)
    : arm_(arm), layout_(layout), tips_(arm), reach_(longest_lever(arm)), diverged_(layout) {
  hold(p);
}

void RunWatch::change(std::uint64_t row, const Parameters& p) { changes_.push_back({row, p}); }

void RunWatch::hold(const Parameters& p) {
  tick_ = p.tick;
  limits_ = motor_limits(arm_, p);
  promised_ = std::max(promised_, promised(p));
  by_port_ = info(p.kind).promise == Promise::port;
  at_fault_ = passivity(analyze(arm_, rest_pose(arm_), p, std::nullopt), p).passive == false;
  settings_ = std::string(info(p.kind).key);
  if (info(p.kind).takes_eta) settings_ += fmt::format(", eta {:.3g}", p.eta);
}

void RunWatch::Excess::take(double time, double value, double allowed,
                            const std::string& settings) {
  most = std::max(most, value);
  if (since >= 0 || !(value > allowed)) return;
  since = time;
  with = settings;
}

void RunWatch::add(std::span<const double> row) {
  const double time = layout_.in(row, Column::time)[0];
  for (; !changes_.empty() && changes_.front().row <= rows_; changes_.pop_front()) {
    shares_.change(time);
    hold(changes_.front().parameters);
  }
  const bool limited = any_at_limit(layout_, row, limits_);
  at_limit_ += limited ? tick_ : 0;
  ++rows_;
  diverged_.add(row);
  if (diverged_.wild()) return;  // instability has its own warning
  const double energy =
      layout_.in(row, Column::energy_total)[0] - layout_.in(row, Column::energy_compensation)[0];
  const double from_contacts = layout_.in(row, Column::contact_gain)[0];
  if (!begun_at_) {
    begun_at_ = before_ = energy;
    contacts_begun_at_ = from_contacts;
    shares_.begin(spring_energy(layout_, row));
  }
  if (by_port_) {
    aside_ += energy - before_;
    given_.take(time, layout_.in(row, Column::energy_port)[0], kGivenEnergy, settings_);
  }
  before_ = energy;
  const double counted = energy - *begun_at_ - aside_;
  whole_ = std::max(whole_, counted);
  shares_.take(time, counted, withheld_.add(layout_, row), limited);
  energy_.take(time, at_fault_ ? shares_.without_limits() : shares_.own(), promised_ + kGivenEnergy,
               settings_);
  contacts_.take(time, from_contacts - contacts_begun_at_, kFromContacts, settings_);
  if (tip_speed_bound(row) <= kFastestTip) return;
  const auto tips = tips_.of(DerivedColumns::from(layout_, row));
  speed_.take(time, tips[kTipVelocity].norm(), kFastestTip, settings_);
}

double RunWatch::tip_speed_bound(std::span<const double> row) const {
  const auto v = layout_.in(row, Column::device_velocity);
  double bound = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    bound += std::abs(v[i]) * (arm_.slides(i) ? kSlideUnit : reach_);
  }
  return bound;
}

std::vector<std::string> RunWatch::warnings() const {
  std::vector<std::string> all = cautions();
  if (diverged_.lost()) {
    all.insert(all.begin(),
               fmt::format("unstable since t = {:.3f} s: {}", diverged_.since(), diverged_.why()));
  }
  return all;
}

std::vector<std::string> RunWatch::cautions() const {
  std::vector<std::string> all;
  if (energy_.since >= 0) {
    const std::string allowed =
        promised_ > 0 ? fmt::format(", more than the {} that the energy account allows",
                                    joules_text(promised_))
                      : "";
    constexpr double kMore = 1.01;  // times the share that is the coupling's own
    const bool part = whole_ > kMore * energy_.most;
    const std::string gave =
        part ? fmt::format(
                   "the coupling by itself gave {} (E_c rose to {}, with changes of settings, "
                   "motors at their limit and force held back)",
                   joules_text(energy_.most), joules_text(whole_))
             : "E_c rose to " + joules_text(energy_.most);
    all.push_back(
        fmt::format("{}{}, above the limit since t = {:.3f} s: this run is not passive ({})", gave,
                    allowed, energy_.since, energy_.with));
  }
  if (given_.since >= 0) {
    all.push_back(
        fmt::format("the hand was given {}, above the limit since t = {:.3f} s: this run is not "
                    "passive ({})",
                    joules_text(given_.most), given_.since, given_.with));
  }
  if (contacts_.since >= 0) {
    all.push_back(fmt::format(
        "contacts gave {} by themselves, above the limit since t = {:.3f} s, as corners "
        "of surfaces whose stiffness differs do ({})",
        joules_text(contacts_.most), contacts_.since, contacts_.with));
  }
  if (speed_.since >= 0) {
    all.push_back(
        fmt::format("the tip reached {:.3g} m/s, above {:.0f} m/s since t = {:.3f} s: no hand "
                    "moves so fast ({})",
                    speed_.most, kFastestTip, speed_.since, speed_.with));
  }
  return all;
}

std::string at_limit_text(std::span<const double> lanes) {
  std::string text;
  for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
    if (!(lanes[lane] > 0)) continue;
    text += fmt::format(
        "motors at their limit    {:.3g} s{}; in this time device and proxy may drift apart\n",
        lanes[lane], lanes.size() == 1 ? "" : fmt::format(" in the {} run", lane_ordinal(lane)));
  }
  return text;
}

void add_warnings(const std::vector<std::string>& of_lane, std::size_t lane,
                  std::vector<std::string>& into) {
  for (const std::string& warning : of_lane) {
    into.push_back(lane == kMainLane ? warning
                                     : fmt::format("the {} run: {}", lane_ordinal(lane), warning));
  }
}

std::string warnings_text(const std::vector<std::string>& warnings) {
  return fmt::format("{}", fmt::join(warnings, "\n"));
}

SessionWatch::SessionWatch(const Session& about, const std::string& file)
    : stride_(static_cast<std::size_t>(about.layout.stride())) {
  const auto arm = recorded_arm(about.info);
  if (!arm) return;
  for (std::size_t i = 0; i < about.lanes(); ++i) {
    const Session& lane = about.lane(i);
    Parameters p = session_parameters(lane, file);
    RunWatch& watch = lanes_.emplace_back(*arm, lane.layout, p);
    for (const SettingChange& change : lane.changes) {
      apply_change(p, change);
      watch.change(change.row, p);
    }
  }
}

void SessionWatch::take(LaneRows rows) {
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    for (std::size_t at = 0; at < rows[i].size(); at += stride_) {
      lanes_[i].add(rows[i].subspan(at, stride_));
    }
  }
}

std::vector<std::string> SessionWatch::warnings() const {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < lanes_.size(); ++i) add_warnings(lanes_[i].warnings(), i, all);
  return all;
}

std::vector<double> SessionWatch::at_limit() const {
  std::vector<double> all;
  for (const RunWatch& lane : lanes_) all.push_back(lane.at_limit());
  return all;
}

std::vector<std::string> warnings_of(const Session& session, const std::string& file) {
  SessionWatch watch(session, file);
  watch.take(session.lane_rows());
  return watch.warnings();
}

}  // namespace limpid
