#include "app/experiments/tap_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/experiments/signals.h"
#include "app/run/analysis.h"
#include "app/run/fitted_gains.h"
#include "app/run/tip_limits.h"
#include "core/dynamics/arm.h"
#include "core/math/high_pass.h"

namespace limpid {

namespace {

constexpr double kTapAhead = 0.2;  // [m]
constexpr double kTapWall = 600,
                 kTapGrip = 300;  // any: what is named does not depend on them [N/m]

std::string table(double wall) {
  return fmt::format(R"(title = "Table"
about = "A table top below the tip."

[[plane]]
name = "table top"
point = [{}, 0.0, {}]
normal = [0.0, 0.0, 1.0]
stiffness = {:.9g}
)",
                     kTapAhead, TapBench::kSurface, wall);
}

struct WallSearch {
  double low = kSoftest, high = kStiffest;
  bool done = false;
};

// Whether each wall is good in every grip; NaN walls are not tried. A wall that is bad in one grip
// is not tried in the next.
std::vector<char> try_walls(TrialRunner& lab, std::span<const TapSetting> settings,
                            const std::vector<double>& walls, const WallTest& test) {
  std::vector<char> good(settings.size(), 1);
  for (const double grip : test.grips) {
    std::vector<std::size_t> of;
    std::vector<TapBench> benches;
    std::vector<Trial> trials;
    for (std::size_t i = 0; i < settings.size(); ++i) {
      if (std::isnan(walls[i]) || good[i] == 0) continue;
      of.push_back(i);
      benches.emplace_back(lab.arm(), settings[i], walls[i], grip, 1);
      trials.push_back(benches.back().trial());
      trials.back().may_diverge = true;  // the search looks for the onset of divergence
    }
    lab.run(trials, [&](std::size_t t, const TrialResult& result) {
      const bool exact = benches[t].parameters().encoder_step == 0;
      good[of[t]] = test.good(benches[t].touch(result), exact) ? 1 : 0;
    });
  }
  return good;
}

}  // namespace

TapBench::TapBench(const ExperimentArm& on, const TapSetting& setting, double wall, double grip,
                   int taps)
    : on_(&on),
      setting_(setting),
      wall_(wall),
      grip_(grip),
      down_(kAbove + setting.press / grip + setting.press / wall),
      taps_(taps) {}

double TapBench::height(double t) const {
  const double in = std::fmod(t, period());
  return std::clamp(std::min(in - kRest, period() - kRest - in) * kSpeed, 0.0, down_);
}

Parameters TapBench::parameters() const {
  Parameters p = on_->settings;
  p.kind = setting_.kind;
  p.eta = setting_.eta;
  p.tick = setting_.tick;
  // The device's step stays the same for any tick.
  p.substeps = std::max(1, static_cast<int>(std::lround(p.substeps * p.tick / 0.001)));
  if (setting_.encoder_step > 0) p.encoder_step = setting_.encoder_step;
  p.hand_mass_at_tip = setting_.hand_mass;
  if (!setting_.expects_a_mass) p.hand_mass = 0;
  p.hand_stiffness = grip_;
  p.hand_damping = kGripDamping;
  p.torque_limit = setting_.own_motors ? kFromArm : setting_.torque_limit;
  if (setting_.delay > 0) p.device_delay = static_cast<int>(std::lround(setting_.delay));
  p.delay = setting_.knows_delay ? p.device_delay : 0;
  p.link_delay = setting_.link;
  if (setting_.fits_link) {
    const Parameters fit = fitted(on_->description, p, 0, p);
    static_cast<SpringDamper&>(p) = fit;
    p.alpha = fit.alpha;
  }
  return p;
}

Trial TapBench::trial() const {
  const Parameters p = parameters();
  const auto at = [&](double t) { return Vec3(kTapAhead, 0, kSurface + kAbove - height(t)); };
  const std::string source = fmt::format("{} taps at {} m/s, {:.6g} m down", taps_, kSpeed, down_);
  Trial trial{"", plan_in(on_->description, table(wall_),
                          hand_path(source, p.tick, taps_ * period(), at), p)};
  trial.keep = false;
  return trial;
}

Touch TapBench::touch(const TrialResult& result) const {
  constexpr double kLost = std::numeric_limits<double>::infinity();
  if (result.end.diverged) return {kLost, kLost, kLost, 0, kLost, kLost};
  const Session& s = result.session;
  const double T = s.info.tick;
  const Arm<kAnyDof> arm(on_->description);
  HighPass fast[] = {{kFast, 1 / T}, {kFast, 1 / T}, {kFast, 1 / T}};
  Touch touch;
  double fast2 = 0, moving2 = 0, force = 0, depth = 0;
  std::size_t held = 0;
  Vec3 before = arm.tip_at(vector_at(s, 0, Column::device_position));
  for (std::size_t k = 0; k < s.size(); ++k) {
    touch.energy = worse(touch.energy, s.at(k, Column::energy_total)[0]);
    touch.port = worse(touch.port, s.at(k, Column::energy_port)[0]);
    touch.torque =
        worse(touch.torque, vector_at(s, k, Column::contact_torque).cwiseAbs().maxCoeff());
    const Vec3 tip = arm.tip_at(vector_at(s, k, Column::device_position));
    Vec3 v = (tip - before) / T;
    before = tip;
    const double speed2 = v.squaredNorm();
    for (int i = 0; i < 3; ++i) v[i] = fast[i](v[i]);
    const double in = std::fmod(static_cast<double>(k) * T, period()) - start_of_hold();
    if (in < setting_.hold - kJudged || in >= setting_.hold) continue;
    fast2 += v.squaredNorm();
    moving2 += speed2;
    ++held;
    if (tip.z() >= kSurface) continue;
    depth += kSurface - tip.z();
    force += s.at(k, Column::contact_force)[2];
  }
  const auto ticks = static_cast<double>(std::max<std::size_t>(1, held));
  touch.chatter = std::sqrt(fast2 / ticks);
  touch.moving = std::sqrt(moving2 / ticks);
  touch.felt = depth > 0 ? force / depth / wall_ : 0;
  return touch;
}

TipAlong tip_at_table(const ExperimentArm& on) {
  const ArmDescription& arm = on.description;
  const ArmAt at = arm_at(arm, rest_at(arm, Vec3(kTapAhead, 0, TapBench::kSurface)).x1);
  return tip_along(at.J, at.M, device_damping(arm, on.settings), Vec3::UnitZ());
}

double named_wall(const ExperimentArm& on, const TapSetting& setting) {
  const ArmDescription& arm = on.description;
  const Eigen::VectorXd x = rest_at(arm, Vec3(kTapAhead, 0, TapBench::kSurface)).x1;
  const Parameters p = TapBench(on, setting, kTapWall, kTapGrip, 1).parameters();
  const TipLimits limits = tip_limits(arm, x, p, {});
  return limits.wall(p.kind).stiffness;
}

bool well_rendered(const Touch& touch, bool exact_encoder) {
  using W = WellRendered;
  return touch.port <= W::kPort && touch.chatter <= W::kChatter &&
         std::abs(touch.felt - 1) <= W::kFelt && std::isfinite(touch.energy) &&
         (!exact_encoder || touch.energy <= W::kEnergy);
}

std::vector<double> stiffest_walls(TrialRunner& lab, std::span<const TapSetting> settings,
                                   const WallTest& test) {
  std::vector<WallSearch> searches(settings.size());
  std::vector<double> walls(settings.size());
  // The ends come first: if one is the answer, nothing lies between.
  for (int step = -2; step < kBisections; ++step) {
    for (std::size_t i = 0; i < settings.size(); ++i) {
      const WallSearch& s = searches[i];
      walls[i] = s.done       ? std::nan("")
                 : step == -2 ? s.high
                 : step == -1 ? s.low
                              : std::sqrt(s.low * s.high);
    }
    const std::vector<char> good = try_walls(lab, settings, walls, test);
    for (std::size_t i = 0; i < settings.size(); ++i) {
      WallSearch& s = searches[i];
      if (s.done) continue;
      (good[i] != 0 ? s.low : s.high) = walls[i];
      s.done = s.low >= s.high;
    }
  }
  std::vector<double> found;
  for (const WallSearch& s : searches) found.push_back(s.low);
  return found;
}

}  // namespace limpid
