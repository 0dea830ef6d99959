#include "app/run/measured_hand.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/run/replay.h"
#include "app/run/tip_limits.h"
#include "devices/files/urdf_file.h"
#include "devices/identify/grip_probe.h"

namespace limpid {
namespace {

constexpr double kGripBegin = 0.5;  // of the excitation in a run [s]

double eta_min_in(const ArmDescription& arm, Parameters p, const Grip& grip, double stiffness,
                  double damping) {
  p.hand_stiffness = stiffness;
  p.hand_damping = damping;
  return analyze(arm, grip.pose, p, std::nullopt).eta_min_compliant;
}

// Decimals with which a bound has two digits.
int decimals_of(double bound) {
  constexpr int kMost = 4;
  int decimals = 0;
  for (; bound > 0 && bound < 10 && decimals < kMost; bound *= 10) ++decimals;
  return decimals;
}

}  // namespace

Parameters with_grip(Parameters p, const Grip& grip) {
  const auto set = [&p](const char* key, double value) {
    set_parameter_number(p, *find_parameter(key), std::max(value, 0.0));
  };
  set("hand.stiffness", grip.stiffness.value);
  set("hand.damping", grip.damping.value);
  set("hand.mass", grip.mass.value);
  return p;
}

MeasuredHand judged(const ArmDescription& arm, const Parameters& p, const Scene& scene, Grip grip) {
  MeasuredHand hand{std::move(grip), std::nullopt, std::nullopt};
  const Grip& of = hand.grip;
  if (!of.known() || !still_tip(arm).empty()) return hand;
  Parameters in = with_grip(p, of);
  MeasuredHand::EtaMin eta{eta_min_in(arm, in, of, of.stiffness.value, in.hand_damping), 1, 0};
  for (const double stiffness : {of.stiffness.low(), of.stiffness.high()}) {
    for (const double damping : {of.damping.low(), of.damping.high()}) {
      const double found = eta_min_in(arm, in, of, stiffness, damping);
      eta.low = std::min(eta.low, found);
      eta.high = std::max(eta.high, found);
    }
  }
  hand.eta_min = eta;
  in.hand_damping = of.damping.low();
  hand.hands =
      in_hands(arm, of.pose, in, analyze(arm, of.pose, in, std::nullopt),
               tip_limits(arm, of.pose, in, scene), {of.stiffness.low(), of.stiffness.high()});
  return hand;
}

Grip recorded_grip(const Session& session, const std::string& where) {
  const ArmDescription arm = parse_urdf(session.info.device_urdf, where + " (device_urdf)", {});
  Parameters now = session_parameters(session, where), then = now;
  GripRecord record(session.layout, session.info.tick);
  std::size_t next = 0;
  for (std::size_t k = 0; k < session.size(); ++k) {
    for (; next < session.changes.size() && session.changes[next].row <= k; ++next) {
      apply_change(now, session.changes[next]);
    }
    record.take(session.row(k));
    if (record.samples() == 1) then = now;
  }
  return find_grip(arm, then, record);
}

double grip_run_duration() { return kGripBegin + GripProbe::kDuration + 0.01; }

bool measure_grip(RunPlan& plan) {
  const double T = plan.parameters.tick;
  if (static_cast<double>(plan.rows) * T < grip_run_duration()) return false;
  const GripProbe probe(plan.arm);
  plan.excitation.clear();
  for (double time = -kGripBegin; time < GripProbe::kDuration; time += T) {
    plan.excitation.push_back(probe.at(time));
  }
  return true;
}

std::string bounded_text(const Bounded& of, const char* unit) {
  const int decimals = decimals_of(of.bound);
  return fmt::format("{:.{}f} \xC2\xB1 {:.{}f} {}", of.value, decimals, of.bound, decimals, unit);
}

std::string unknown_text(const Grip& grip) {
  return grip.known() ? "" : "not known: " + grip.unknown;
}

std::vector<GripLine> grip_lines(const MeasuredHand& hand) {
  std::vector<GripLine> lines;
  if (hand.grip.measured) {
    lines.push_back({"stiffness", bounded_text(hand.grip.stiffness, "N/m")});
    lines.push_back({"damping", bounded_text(hand.grip.damping, "N s/m")});
    lines.push_back(
        {"mass", bounded_text({1e3 * hand.grip.mass.value, 1e3 * hand.grip.mass.bound}, "g")});
  }
  if (hand.eta_min) {
    const auto& [value, low, high] = *hand.eta_min;
    constexpr double kNone = 0.005;  // nothing that two decimals show
    lines.push_back({"eta_min in this hand",
                     high < kNone ? "0, every eta is stable"
                                  : fmt::format("{:.2f} ({:.2f} to {:.2f})", value, low, high)});
  }
  return lines;
}

}  // namespace limpid
