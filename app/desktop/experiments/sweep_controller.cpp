#include "app/desktop/experiments/sweep_controller.h"

#include <fmt/format.h>
#include <unistd.h>

#include "app/base/dated_file.h"
#include "app/base/folders.h"
#include "app/desktop/base/settings.h"
#include "app/sweep/record_point.h"
#include "app/sweep/sweep_map.h"
#include "devices/files/atomic_file.h"
#include "devices/files/text_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kBetweenLooks{500};
constexpr int kTries = 20;

// Returns the point's place on each axis.
std::vector<Fact> axes_of(const SweepPlan& plan, std::uint64_t number) {
  const SweepPoint point = point_of(plan, number);
  std::vector<Fact> facts;
  for (std::size_t a = 0; a < plan.axes.size(); ++a) {
    const SweepAxis& axis = plan.axes[a];
    const bool plain = axis.unit == "-" || !axis.words.empty();
    facts.push_back({axis.name, value_text(axis, point.place[a]) + (plain ? "" : " " + axis.unit)});
  }
  if (plan.repeats > 1) facts.push_back({"repeat", fmt::format("{}", point.repeat)});
  return facts;
}

// Returns a point's name, as "kind predictive, stiffness 100 N/m".
std::string named(const SweepPlan& plan, std::uint64_t number) {
  std::string text;
  for (const Fact& axis : axes_of(plan, number)) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", axis.name, axis.value);
  }
  return text;
}

std::vector<Fact> facts_of(const SweepPlan& plan, std::uint64_t number, std::optional<double> at) {
  std::vector<Fact> facts{{"Point of the sweep", fmt::format("{}", number)}};
  for (Fact& axis : axes_of(plan, number)) facts.push_back(std::move(axis));
  if (at && plan.boundary) {
    facts.push_back({plan.boundary->axis.name, fmt::format("{:.4g}", *at)});
  }
  return facts;
}

// Returns the point's measures, as in the table's columns.
std::vector<Fact> measured_of(const OpenedSweep& sweep, std::optional<double> at,
                              const std::vector<double>& again) {
  const auto fact = [](const std::string& name, const std::string& unit, bool yes_no, double x) {
    const bool plain = unit.empty() || unit == "-";
    return Fact{name, yes_no ? (x == 1 ? "yes" : "no")
                             : fmt::format("{:.4g}{}", x, plain ? "" : " " + unit)};
  };
  if (at) {
    const MeasureInfo& measure = *sweep.plan->boundary->condition.measure;
    return {fact(measure.words, measure.unit, measure.yes_no(), again.front())};
  }
  std::vector<Fact> facts;
  for (std::size_t i = 0; i < std::min(again.size(), sweep.table.columns.size()); ++i) {
    const SweepColumn& column = sweep.table.columns[i];
    facts.push_back(
        fact(words_of_measure(column.name), column.unit, column.unit == "yes/no", again[i]));
  }
  return facts;
}

// Returns the file for a point's session: beside the table or, if that cannot be written, among the
// user's sessions.
fs::path place_for(const fs::path& table, std::uint64_t point, std::optional<double> at) {
  fs::path beside = point_file(table.parent_path(), point, at);
  const fs::path folder = beside.parent_path();
  std::error_code none;
  const fs::path there = fs::is_directory(folder, none) ? folder : folder.parent_path();
  if (::access(there.empty() ? "." : there.c_str(), W_OK) == 0) return beside;
  const std::string sweep = fs::weakly_canonical(table, none).parent_path().filename().string();
  return sessions_dir() / fmt::format("{}-{}", sweep, beside.filename().string());
}

// Notes for people whether the results `again` are as in the table.
void compare(const OpenedSweep& sweep, std::uint64_t point, std::optional<double> at,
             const std::vector<double>& again, LoadedSession& loaded) {
  const SweepPlan& plan = *sweep.plan;
  const std::string name = fmt::format("Point {}: {}", point, named(plan, point));
  if (at) {
    const MeasureInfo& measure = *plan.boundary->condition.measure;
    const std::string value = measure.yes_no() ? (again.front() == 1 ? "yes" : "no")
                                               : fmt::format("{:.6g}", again.front());
    loaded.said = fmt::format("{}, {} {:.4g}; {}: {}.", name, plan.boundary->axis.name, *at,
                              measure.words, value);
    return;
  }
  if (!sweep.table.done[point]) {
    loaded.said = name + ". The table does not have this point yet.";
    return;
  }
  const std::size_t width = sweep.table.columns.size();
  const std::string other =
      differences(plan, again, std::span(sweep.table.values).subspan(point * width, width));
  loaded.bad = !other.empty();
  if (other.empty()) {
    loaded.said = name + ". The result is exactly the same as in the table.";
  } else if (sweep.build != hex(build_digest())) {
    loaded.said = fmt::format(
        "{}. The result differs from the table, which another build of limpid ({}) made: {}.", name,
        sweep.build, other);
  } else {
    loaded.said = fmt::format("{}. The result differs from the table: {}.", name, other);
  }
}

}  // namespace

void SweepController::open(const fs::path& table) {
  asked_ = table;
  look(table, true);
}

void SweepController::look(const fs::path& file, bool anew) {
  next_look_ = std::chrono::steady_clock::now() + kBetweenLooks;
  const std::shared_ptr<const OpenedSweep> before = anew ? nullptr : sweep_;
  looking_.start(fmt::format("loading {}", file.filename().string()),
                 [file, before, last = changed_](TaskProgress&) -> Look {
                   std::error_code gone;
                   const Time changed =
                       fs::last_write_time(file, gone);  // an older one looks again
                   if (before != nullptr && (gone || changed == last)) return {nullptr, last};
                   return {open_table(file, before.get()), changed};
                 });
}

bool SweepController::take_look() {
  auto found = looking_.take();
  if (!found) return false;
  changed_ = found->changed;
  if (!found->sweep) return false;
  const bool fresh = !asked_.empty();
  if (fresh && found->sweep->plan->axes.empty()) {
    throw FileError(asked_.string() + ": the sweep's plan has no axis, so there is no map");
  }
  asked_.clear();
  sweep_ = std::move(found->sweep);
  if (fresh) {
    map_.reset();
    mapped_.reset();
    mapping_.cancel();
    choice_ = first_choice(*sweep_->plan, sweep_->table);
  }
  ++revision_;
  return fresh;
}

void SweepController::follow_map() {
  if (auto made = mapping_.take()) {
    map_ = std::move(made->map);
    mapped_ = std::move(made->of);
    ++revision_;
  }
  if (!sweep_ || mapping_.busy() || (mapped_ == sweep_ && map_ && map_->choice == choice_)) return;
  mapping_.start("drawing the map", [sweep = sweep_, choice = choice_](TaskProgress&) -> Made {
    return {make_map(*sweep, choice), sweep};
  });
}

void SweepController::start(const SweepDraft& draft) {
  const fs::path folder = dated_file(sweeps_dir(), as_file_name(short_name(draft)));
  std::error_code none;
  fs::create_directories(folder, none);
  const std::string text = plan_text(draft);
  write_atomically(folder / "plan.toml",
                   {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
  work(folder);
}

bool SweepController::may_go_on() const {
  if (!sweep_ || runner_.busy() || sweep_->table.complete()) return false;
  std::error_code none;
  const fs::path folder = sweep_->file.parent_path();
  return fs::equivalent(folder.parent_path(), sweeps_dir(), none) && sweep_->why_no_run.empty() &&
         sweep_->build == hex(build_digest());
}

void SweepController::go_on() { work(sweep_->file.parent_path()); }

void SweepController::work(const fs::path& folder) {
  why_not_started_.clear();
  runner_.start(folder);
}

// Opens the table of a sweep that was started, and says how its work ended.
void SweepController::follow_runner() {
  try {
    if (const auto table = runner_.take_table()) {
      started_ = *table;
      tries_ = kTries;
    }
    // A busy computer may fail to read a table that is being written: it is tried again.
    std::error_code none;
    if (sweep_ && fs::equivalent(sweep_->file, started_, none)) tries_ = 0;
    if (tries_ > 0 && !looking_.busy() && std::chrono::steady_clock::now() >= next_look_) {
      --tries_;
      open(started_);
    }
    if (const auto said = runner_.take()) notices_.say(*said);
  } catch (const std::exception& e) {
    why_not_started_ = e.what();
    notices_.say(why_not_started_, true);
  }
}

bool SweepController::update() {
  bool fresh = false;
  follow_runner();
  try {
    if (looking_.busy()) {
      fresh = take_look();
    } else if (sweep_ && std::chrono::steady_clock::now() >= next_look_) {
      look(sweep_->file, false);
    }
    follow_map();
  } catch (const std::exception& e) {
    asked_.clear();
    if (tries_ == 0) notices_.say_once(e.what(), true);
  }
  return fresh;
}

void SweepController::choose(const MapChoice& choice) { choice_ = mended(*sweep_->plan, choice); }

void SweepController::play(std::uint64_t point, std::optional<double> at, Playback& playback) {
  if (!sweep_->why_no_run.empty()) {
    return notices_.say(fmt::format("Point {} cannot be run again: {}.", point, sweep_->why_no_run),
                        true);
  }
  last_point_ = place_for(sweep_->file, point, at);
  playback.load(fmt::format("running point {}", point),
                [sweep = sweep_, point, at,
                 out = last_point_](TaskProgress& progress) -> std::optional<LoadedSession> {
                  const auto recorded = record_point(*sweep->plan, point, at, out, progress.cancel,
                                                     [&](double part) { progress.part = part; });
                  if (!recorded) return std::nullopt;
                  LoadedSession loaded = load_session(out);
                  compare(*sweep, point, at, recorded->values, loaded);
                  loaded.facts = facts_of(*sweep->plan, point, at);
                  loaded.verdict = measured_of(*sweep, at, recorded->values);
                  return loaded;
                });
}

}  // namespace limpid
