#include "app/desktop/coupling/chatter_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/desktop/base/passivity_break.h"
#include "app/desktop/scene/picking.h"
#include "app/run/analysis.h"
#include "app/run/tip_limits.h"
#include "core/dynamics/arm.h"

namespace limpid {
namespace {

constexpr auto kStays = std::chrono::seconds(20);  // after the last stretch of chatter
constexpr auto kJustSeen = std::chrono::seconds(1);
constexpr auto kJustTouched = std::chrono::seconds(2);  // longer than chatter takes to be seen

// Returns a value of two digits, which is enough for a slider.
double rounded_down(double stiffness) {
  const double step = std::pow(10, std::floor(std::log10(stiffness)) - 1);
  return step * std::floor(stiffness / step + 1e-9);
}

}  // namespace

// Notes the object at the hardest contact, which is the first in a row.
void ChatterWatch::note_touch() {
  const Stage& stage = live_.stage();
  const RowLayout& layout = stage.channels().layout();
  const auto p = layout.in(live_.row(), Column::contact_point);
  const auto f = layout.in(live_.row(), Column::contact_force);
  const Vec3 point(p[0], p[1], p[2]), force(f[0], f[1], f[2]);
  if (!point.allFinite() || !(force.norm() > 0)) return;
  constexpr double kOutside = 0.005;  // start of the ray outside of the contact [m]
  const Vec3 out = force.normalized();
  const SceneEditor& editor = document_.editor();
  const auto under = object_under({point + kOutside * out, -out}, editor.scene(), editor.models(),
                                  stage.rows().bodies(layout, live_.row()));
  if (!under) return;
  touched_ = under;
  touched_at_ = Clock::now();
}

void ChatterWatch::judge_from_now() {
  for (Chatter& each : chatter_) each.start_over(live_.stage().history.end());
}

std::optional<ChatterWatch::Wall> ChatterWatch::wall_of(const Parameters& p) const {
  const Scene& scene = document_.scene();
  if (!touched_ || *touched_ >= scene.objects.size()) return std::nullopt;
  if (Clock::now() - touched_at_ > kJustTouched) return std::nullopt;
  const Object& object = scene.objects[*touched_];
  const ArmDescription& arm = live_.stage().arm();
  const double holds = tip_limits(arm, rest_pose(arm), p, scene).wall(p.kind).stiffness;
  const double stiffness = object.material.stiffness;
  const double softer = std::min(holds > 0 ? holds : stiffness, stiffness / 2);
  return Wall{*touched_, object.name, stiffness, rounded_down(softer)};
}

void ChatterWatch::follow() {
  const Stage& stage = live_.stage();
  if (std::exchange(of_, &stage) != &stage) {
    chatter_ = {};
    touched_.reset();
    found_.reset();
  }
  note_touch();
  if (found_ && is_over()) found_.reset();
  const int channels = stage.channels().count();
  for (std::size_t lane = 0; lane < kMostLanes; ++lane) {
    Chatter& chatter = chatter_[lane];
    const Parameters& p = settings_.lanes.parameters[lane];
    // Samples of other settings, or of passivity broken on purpose, say nothing of these.
    if (lane >= settings_.lanes.count || passivity_broken(settings_) || !(p == judged_[lane])) {
      judged_[lane] = p;
      chatter.start_over(stage.history.end());
      continue;
    }
    chatter.follow(stage.history, stage.history.end(), static_cast<int>(lane) * channels,
                   coupling_springs(stage.arm(), p));
    if (!chatter.there()) continue;
    if (!found_) found_ = Found{lane, p, wall_of(p)};
    if (found_->lane == lane) seen_ = Clock::now();
  }
}

// Returns whether the finding is out of date: other settings or another wall are judged anew.
bool ChatterWatch::is_over() const {
  const Parameters& now = settings_.lanes.parameters[found_->lane];
  const Scene& scene = document_.scene();
  const auto& wall = found_->wall;
  const bool same_wall =
      !wall ||
      (wall->place < scene.objects.size() && scene.objects[wall->place].name == wall->name &&
       scene.objects[wall->place].material.stiffness == wall->stiffness);
  return Clock::now() - seen_ > kStays || !(now == found_->parameters) || !same_wall ||
         found_->lane >= settings_.lanes.count || passivity_broken(settings_);
}

std::string ChatterWatch::text() const {
  const LawInfo& law = info(found_->parameters.kind);
  const std::string of = found_->lane == kMainLane ? ""
                         : settings_.lanes.count == 2
                             ? " of the twin"
                             : fmt::format(" of the {} run", lane_ordinal(found_->lane));
  const auto& wall = found_->wall;
  const bool now = Clock::now() - seen_ < kJustSeen;
  const char* const says = now ? "The loop chatters" : "The loop chattered";
  if (!wall) {
    return fmt::format("{}, because the {} law{} {} energy.", says, law.key, of,
                       now ? "gives" : "gave");
  }
  return fmt::format(
      "{}, because {} ({:.4g} N/m) is stiffer than the {} law{} can render there without chatter.",
      says, wall->name, wall->stiffness, law.key, of);
}

void ChatterWatch::take_predictive() {
  settings_.lanes.parameters[found_->lane].kind = CouplingKind::predictive;
  forget();
  judge_from_now();
}

void ChatterWatch::soften_wall() {
  if (!found_->wall || !document_.may_edit()) return;
  const Wall wall = *found_->wall;
  Object object = document_.scene().objects[wall.place];
  object.material.stiffness = wall.softer;
  document_.editor().set(wall.place, std::move(object), "stiffness");
  forget();
  judge_from_now();
}

}  // namespace limpid
