#include "app/experiments/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <vector>

#include "app/base/in_parallel.h"
#include "app/base/markup.h"
#include "app/experiments/live.h"
#include "app/plot/figure.h"
#include "app/run/provenance.h"
#include "app/run/reach_check.h"
#include "app/run/recorder.h"
#include "app/run/replay.h"
#include "app/run/run_key.h"
#include "app/sweep/sweep_table.h"
#include "devices/files/atomic_file.h"
#include "devices/files/config_file.h"

namespace limpid {

// Each is defined in NAME.cpp.
Outcome coordination(TrialRunner& lab);
Outcome inertia(TrialRunner& lab);
Outcome passivity(TrialRunner& lab);
Outcome spectrum(TrialRunner& lab);
Outcome saturation(TrialRunner& lab);
Outcome observer(TrialRunner& lab);
Outcome transparency(TrialRunner& lab);
Outcome eta_min_map(TrialRunner& lab);
Outcome lightness(TrialRunner& lab);
Outcome zwidth(TrialRunner& lab);
Outcome approaches(TrialRunner& lab);
Outcome switching(TrialRunner& lab);
Outcome friction(TrialRunner& lab);
Outcome delay(TrialRunner& lab);
Outcome link(TrialRunner& lab);
Outcome walls(TrialRunner& lab);
Outcome robust(TrialRunner& lab);
Outcome mass(TrialRunner& lab);
Outcome click(TrialRunner& lab);
Outcome drop(TrialRunner& lab);
Outcome stack(TrialRunner& lab);
Outcome bodies(TrialRunner& lab);

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kListed = 4;  // longer lists are given by first and last value

std::string values(const std::set<double>& set, const std::string& unit) {
  std::vector<std::string> words;
  words.reserve(set.size());
  for (const double value : set) words.push_back(fmt::format("{:.4g}", value));
  if (words.size() > kListed) return fmt::format("{} to {} {}", words.front(), words.back(), unit);
  if (words.size() < 2) return fmt::format("{} {}", words.front(), unit);
  const std::string last = words.back();
  words.pop_back();
  return fmt::format("{} and {} {}", fmt::join(words, ", "), last, unit);
}

// "none", or the values; a zero among them is named, too.
std::string or_none(std::set<double> set, const std::string& unit, const std::string& none) {
  const bool zero = set.erase(0) > 0;
  if (set.empty()) return none;
  return (zero ? none + " and " : "") + values(set, unit);
}

fs::path stamp_of(const fs::path& session) { return fs::path(session).replace_extension(".key"); }

std::string stamp_text(std::uint64_t key, std::uint64_t bytes) {
  return fmt::format("trial {:016x}\nsession {:016x}\n", key, bytes);
}

using Takes = Experiment::Takes;
constexpr const char *kJumpIsSmall = "the hand jumps by less than a step of the encoders",
                     *kVariesReadings = "it varies encoder steps and delays itself",
                     *kLinkTheory = "its theory assumes exact encoders and a device without delay";

constexpr std::array kExperiments{
    Experiment{"coordination", "coordination of device and proxy in contact (Figs. 3 and 4)",
               coordination, Takes::moving_as_built_in},
    Experiment{"inertia",
               "inertia felt in free motion: the hand's torque at three values of eta (Fig. 5)",
               inertia, Takes::moving_as_built_in},
    Experiment{"passivity", "passivity: energy of the controller over many trials (Fig. 6)",
               passivity},
    Experiment{"spectrum", "spectrum of the hand's motion (Fig. 7)", spectrum},
    Experiment{"saturation",
               "contact that needs more than the motors' torque limit, with and without "
               "anti-windup (section 3.1), and in corners of walls",
               saturation, Takes::moving_as_built_in},
    Experiment{"observer", "bandwidth of the estimate of the hand's force (section 3.1)", observer},
    Experiment{"transparency", "transparency: impedance felt at the handle", transparency,
               Takes::moving_as_built_in},
    Experiment{"eta_min", "stability for many eta and grips, compared with theory (section 4.2)",
               eta_min_map, Takes::any, "", kJumpIsSmall},
    Experiment{"lightness",
               "inertia and damping felt, and the damping that a passive law adds if it makes the "
               "arm light",
               lightness},
    Experiment{"zwidth", "Z-width: the stiffest wall that is rendered well", zwidth, Takes::any, "",
               kVariesReadings},
    Experiment{"approaches",
               "laws of other papers compared with these laws: stiffness felt and energy given",
               approaches, Takes::none,
               "an ideal arm, a Touch, an omega and an Inverse3 (`limpid characterize` makes the "
               "same tests with any arm)"},
    Experiment{"switching", "contacts begun and ended, couplings switched while the tip presses",
               switching, Takes::moving_as_built_in},
    Experiment{"friction", "friction: sticking, slipping, and the energy that friction takes",
               friction},
    Experiment{"delay",
               "effect of a delay of the device's torque on energy given, inertia and walls felt",
               delay, Takes::any, "", kVariesReadings},
    Experiment{
        "link",
        "teleoperation: the stiffest wall with a delay between device and proxy, under each law",
        link, Takes::any, "", kLinkTheory},
    Experiment{"walls", "walls for any arm, with the stiffness that `limpid analyze` computes",
               walls, Takes::none, "36 random arms"},
    Experiment{"robust",
               "a device that differs from its model: the largest difference at which each promise "
               "is kept",
               robust, Takes::none, "an ideal arm and a Touch"},
    Experiment{"mass",
               "the mass felt of a body that is held, and the smallest mass that can be held",
               mass},
    Experiment{"click", "a button: force felt against its displacement", click},
    Experiment{"drop", "a body that falls on the tip, and the energy account", drop},
    Experiment{
        "stack",
        "stacks of bodies: how deep they sink into each other, iterations of the solver, energy",
        stack},
    Experiment{"bodies",
               "motion of bodies compared with closed-form solutions; both too large and too "
               "small values count as errors",
               bodies, Takes::none, "bodies without an arm"},
};

void write_verdict(const std::string& name, const Outcome& outcome,
                   const std::filesystem::path& file, const std::string& more) {
  nlohmann::ordered_json checks = nlohmann::ordered_json::array();
  for (const Check& c : outcome.checks) {
    nlohmann::ordered_json check{{"what", c.what},
                                 {"value", c.value},
                                 {"relation", relation(c)},
                                 {"bound", c.bound},
                                 {"passed", c.passed}};
    if (!c.unjudged.empty()) {
      check["passed"] = nullptr;
      check["unjudged"] = c.unjudged;
    }
    if (c.against) {
      check["expected"] = nullptr;
      if (c.against->expected) check["expected"] = *c.against->expected;
      check["measured"] = c.against->measured;
      check["unit"] = c.against->unit;
      check["conditions"] = c.against->conditions;
    }
    checks.push_back(check);
  }
  nlohmann::ordered_json verdict{{"name", name},
                                 {"passed", outcome.passed()},
                                 {"title", outcome.figure.title},
                                 {"caption", outcome.figure.caption},
                                 {"provenance", outcome.figure.made_by},
                                 {"checks", checks}};
  if (!outcome.arm.empty()) verdict["arm"] = outcome.arm;
  if (!more.empty()) verdict.update(nlohmann::ordered_json::parse(more));
  std::ofstream out(file);
  out << verdict.dump(2) << '\n';
  if (!out.flush()) throw FileError(file.string() + ": could not be written");
}

// Infinite numbers are null in JSON.
std::string number(const json& value) {
  return value.is_number() ? fmt::format("{:.4g}", value.get<double>()) : "not finite";
}

std::string verdict(bool passed) {
  return passed ? R"(<span class="passed">✓ passed</span>)"
                : R"(<span class="failed">✗ failed</span>)";
}

std::string verdict(const json& check) {
  const json& passed = check.at("passed");
  return passed.is_null() ? R"(<span class="soft">measured</span>)" : verdict(passed.get<bool>());
}

bool good(const json& page) { return page.value("passed", false); }

// On an arm for which nothing is promised there is nothing to pass.
bool only_measured(const json& page) { return page.contains("arm") && good(page); }

std::string whole_verdict(const json& page) {
  return only_measured(page) ? R"(<span class="soft">measured</span>)" : verdict(good(page));
}

// Rows of checks that compare with theory say in a line of their own under what conditions.
std::string table(const json& checks) {
  const bool compares =
      std::ranges::any_of(checks, [](const json& c) { return c.contains("expected"); });
  std::string text = "<table><thead><tr><th>Check</th>";
  if (compares) {
    text += R"(<th class="number">Expected</th><th class="number">Measured</th>)";
  }
  text +=
      R"(<th class="number">Value</th><th class="number">Bound</th><th class="verdict">Verdict</th>)"
      "</tr></thead><tbody>\n";
  const auto cell = [](const std::string& value) {
    return fmt::format("<td class=\"number\">{}</td>", value);
  };
  for (const json& check : checks) {
    text += "<tr><td>" + escaped(typeset(check.at("what").get<std::string>()));
    for (const char* words : {"conditions", "unjudged"}) {
      if (!check.contains(words)) continue;
      text += fmt::format("<br><span class=\"soft\">{}</span>",
                          escaped(typeset(check.at(words).get<std::string>())));
    }
    text += "</td>";
    if (compares && check.contains("expected")) {
      const std::string unit = " " + escaped(typeset(check.value("unit", "")));
      text += check.at("expected").is_null() ? cell("") : cell(number(check.at("expected")) + unit);
      text += cell(number(check.at("measured")) + unit);
    } else if (compares) {
      text += cell("") + cell("");
    }
    text += cell(number(check.at("value"))) +
            cell((check.value("relation", "") == "at least" ? "&ge; " : "&le; ") +
                 number(check.at("bound")));
    text += fmt::format("<td class=\"verdict\">{}</td></tr>\n", verdict(check));
  }
  return text + "</tbody></table>";
}

struct Page {
  std::string name, about;
  json verdict;
};

std::optional<Page> page_in(const fs::path& dir, const std::string& name,
                            const std::string& about) {
  std::ifstream file(dir / (name + ".json"));
  if (!file) return std::nullopt;
  json found = json::parse(file, nullptr, false);
  if (!found.is_object() || !found.contains("checks")) return std::nullopt;
  return Page{name, about, std::move(found)};
}

std::vector<Page> pages_in(const fs::path& dir) {
  std::vector<Page> pages;
  const auto add = [&](const std::string& name, const char* about) {
    if (auto page = page_in(dir, name, about)) pages.push_back(std::move(*page));
  };
  for (const Experiment& e : experiments()) add(e.name, e.about);
  for (const LiveExperiment& e : live_experiments()) add(live_name(e), e.about);
  return pages;
}

std::string section(const Page& page) {
  const json& v = page.verdict;
  return fmt::format(
      R"(<section id="{0}">
<header><h2>{1}</h2>{2}</header>
<p class="soft">{0}: {3}</p>
<figure><img src="{0}.svg" alt="{1}">
<figcaption>{4} <a href="{0}.csv">data</a>, <a href="{0}.png">picture</a></figcaption></figure>
<p class="soft">{6}</p>
{5}
</section>
)",
      page.name, escaped(typeset(v.value("title", page.name))), whole_verdict(v),
      escaped(typeset(page.about)), escaped(typeset(v.value("caption", ""))), table(v.at("checks")),
      escaped(v.value("provenance", "")));
}

std::string report_summary(std::size_t passed, std::size_t measured, std::size_t all) {
  std::vector<std::string> sentences;
  if (measured < all || all == 0) {
    sentences.push_back(fmt::format("{} of {} experiments passed.", passed, all - measured));
  }
  if (measured > 0) {
    sentences.push_back(
        fmt::format("Without a verdict, because no bound is promised for the arm: {}.", measured));
  }
  return fmt::format("{}", fmt::join(sentences, " "));
}

// Names the arm in an outcome. Bounds are promised for the built-in arm alone.
void measured_on(const ExperimentArm& on, Outcome& outcome) {
  if (on.built_in()) return;
  outcome.arm = on.name;
  outcome.figure.title += ", on " + on.name;
  for (Check& c : outcome.checks) {
    if (!c.unjudged.empty()) continue;
    c.unjudged = fmt::format("Promised only for the built-in arm: {} {:.4g}. {} {}.", relation(c),
                             c.bound, on.heading(),
                             std::isnan(c.value) ? "gives no value"
                             : c.passed          ? "keeps this bound"
                                                 : "does not keep this bound");
  }
}

}  // namespace

void Conditions::add(const ArmDescription& arm, const Parameters& p) {
  configs_.insert(config_text(p));
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
  std::string own = own_limits_.empty() ? "" : "the arm's own, " + values(own_limits_, "N m");
  if (limits_.empty()) return own;
  return (own.empty() ? "" : own + "; and ") + values(limits_, "N m");
}

std::string Conditions::text() const {
  if (arms_.empty()) return "";
  return fmt::format(
      "Conditions: arm {}; limit of every motor: {}; grip {}, {}; {}; {}; {}; tick {}.", arms(),
      motors(), values(grips_, "N/m"), or_none(dampers_, "N s/m", "undamped"),
      or_none(masses_, "kg in the hand", "no mass in the hand"),
      or_none(encoders_, "rad per encoder step", "exact encoders"),
      or_none(delays_, "ms of delay", "no delay"), values(ticks_, "ms"));
}

std::string Conditions::settings() const {
  return configs_.empty() ? "" : settings_digest(configs_);
}

std::string Conditions::of_the_device() const {
  return fmt::format("Conditions: arm {}; limit of every motor: {}; tick {}.", arms(), motors(),
                     values(ticks_, "ms"));
}

void stamp(const fs::path& session, std::uint64_t key) {
  const auto bytes = file_digest(session);
  if (!bytes) throw FileError(session.string() + ": cannot be read");
  const std::string text = stamp_text(key, *bytes);
  write_atomically(stamp_of(session),
                   {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

std::optional<Session> stamped_session(const fs::path& file, std::uint64_t key) {
  std::ifstream in(stamp_of(file));
  std::ostringstream said;
  said << in.rdbuf();
  const auto bytes = file_digest(file);
  if (!bytes || said.str() != stamp_text(key, *bytes)) return std::nullopt;
  try {
    return read_session(file);
  } catch (const FileError&) {
    return std::nullopt;
  }
}

TrialRunner::TrialRunner(std::string experiment, Options options)
    : experiment_(std::move(experiment)), options_(std::move(options)) {
  options_.threads = threads_for(options_.threads);
  if (options_.program == 0) options_.program = program_digest();
  if (!options_.arm) options_.arm = built_in_arm();
}

TrialResult TrialRunner::run_one(const Trial& trial) const {
  TrialResult result;
  result.session.info = session_info(trial.plan);
  result.session.layout = trial.plan.layout();
  const std::string& folder = trial.folder.empty() ? experiment_ : trial.folder;
  const fs::path file = options_.dir / folder / (trial.name + ".h5");
  const std::uint64_t key = trial.keep ? trial_key(trial.plan, options_.program) : 0;
  if (auto found = trial.keep ? stamped_session(file, key) : std::nullopt) {
    const RunEnd end = end_of(*found);
    return {std::move(*found), end};
  }
  if (stopped()) throw Cancelled();
  std::optional<Recorder> recorder;
  if (trial.keep) {
    fs::create_directories(file.parent_path());
    recorder.emplace(file, result.session.info, trial.plan.parameters, true,
                     Recorder::kWaitingRoom);
    tell_start(*recorder, trial.plan);
  }
  LargeVector<double>& rows = result.session.rows;
  rows.reserve(trial.plan.rows * static_cast<std::size_t>(result.session.layout.stride()));
  result.end = simulate(trial.plan, {.realtime = false, .stop = options_.stop},
                        [&](std::span<const double> row, LaneChanges changed) {
                          rows.insert(rows.end(), row.begin(), row.end());
                          if (recorder && changed[0] != nullptr) recorder->changed(*changed[0]);
                          return !recorder || recorder->push_waiting(row);
                        });
  // A trial that was cut short stays a .part and is run again another time.
  if (stopped()) throw Cancelled();
  if (recorder) {
    recorder->finish();
    stamp(file, key);
  }
  return result;
}

void TrialRunner::each(std::size_t count, const std::function<void(std::size_t)>& work) {
  std::size_t done = 0;
  std::mutex mutex;
  in_parallel(count, options_.threads, [&](std::size_t i, const std::atomic<bool>&) {
    work(i);
    const std::lock_guard lock(mutex);
    ++done;
    const double part = static_cast<double>(done) / static_cast<double>(count);
    if (options_.progress) options_.progress(part);
    return true;
  });
}

void TrialRunner::run(const std::vector<Trial>& trials,
                      const std::function<void(std::size_t, const TrialResult&)>& take) {
  for (const Trial& trial : trials) {
    conditions_.add(trial.plan.arm, trial.plan.parameters);
    const std::string far = arm().built_in() ? "" : out_of_reach(trial.plan);
    if (!far.empty()) throw OutOfReach(experiment_ + ": " + far);
  }
  each(trials.size(), [&](std::size_t i) {
    const TrialResult result = run_one(trials[i]);
    if (result.end.diverged && !trials[i].may_diverge) ++diverged_;
    take(i, result);
  });
}

SweepTable TrialRunner::sweep(const SweepPlan& plan) {
  SweepTable table(plan);
  for (std::uint64_t i = 0; i < table.points(); ++i) {
    const RunPlan run = run_of(plan, i);
    conditions_.add(run.arm, run.parameters);
  }
  static const std::atomic<bool> kNever{false};
  const std::atomic<bool>& stop = options_.stop != nullptr ? *options_.stop : kNever;
  each(table.points(), [&](std::size_t i) {
    const auto values = measure_point(plan, i, stop);
    if (!values) throw Cancelled();
    table.take(i, *values);
  });
  return table;
}

std::vector<TrialResult> TrialRunner::run(const std::vector<Trial>& trials) {
  std::vector<TrialResult> results(trials.size());
  run(trials, [&](std::size_t i, const TrialResult& result) { results[i] = result; });
  return results;
}

std::span<const Experiment> experiments() { return kExperiments; }

std::string why_not(const Experiment& experiment, const ExperimentArm& on) {
  constexpr int kJoints = 3;
  if (on.built_in()) return {};
  const std::string begin = std::string(experiment.name) + ": ";
  if (experiment.takes == Takes::none) {
    return begin + "accepts no other arm or settings, because it has arms of its own: " +
           experiment.own_arms;
  }
  if (on.description.dof() != kJoints) {
    return begin + fmt::format("needs an arm of {} joints; {} has {}", kJoints, on.description.name,
                               on.description.dof());
  }
  if (experiment.takes == Takes::moving_as_built_in && !moves_as_built_in(on.description)) {
    return begin + fmt::format(
                       "needs an arm with the same joint names and the same motion as the built-in "
                       "arm; {} differs",
                       on.description.name);
  }
  if (on.readings && *experiment.own_readings != '\0') {
    return begin + "takes no readings of an arm's file (--readings), because " +
           experiment.own_readings;
  }
  return {};
}

void write_outcome(const std::string& name, const Outcome& outcome,
                   const std::filesystem::path& dir, const std::string& more) {
  std::filesystem::create_directories(dir);
  write_figure_data(outcome.figure, dir / (name + ".csv"));
  draw_figure(outcome.figure, dir, name);
  // Written last: a verdict means that everything else is there.
  write_verdict(name, outcome, dir / (name + ".json"), more);
}

Outcome carry_out(const Experiment& experiment, const TrialRunner::Options& options) {
  std::filesystem::create_directories(options.dir);
  TrialRunner lab(experiment.name, options);
  Outcome outcome = experiment.run(lab);
  measured_on(lab.arm(), outcome);
  const std::string conditions = lab.conditions().text();
  if (!conditions.empty()) {
    outcome.figure.caption += " " + conditions;
    outcome.checks.push_back(
        at_most("number of diverged trials, among the trials that must not diverge",
                static_cast<double>(lab.diverged()), 0));
  }
  outcome.figure.made_by = provenance(lab.conditions().settings(), lab.seed());
  write_outcome(experiment.name, outcome, options.dir);
  return outcome;
}

std::string report_section(const std::string& name, const std::string& about, const fs::path& dir) {
  const std::optional<Page> page = page_in(dir, name, about);
  return page ? section(*page) : std::string();
}

void write_report(const fs::path& dir) {
  const std::vector<Page> pages = pages_in(dir);
  std::size_t passed = 0, measured = 0;
  std::string contents, sections;
  for (const Page& page : pages) {
    (only_measured(page.verdict) ? measured : passed) += good(page.verdict) ? 1 : 0;
    contents += fmt::format(
        "<tr><td><a href=\"#{0}\">{1}</a></td><td class=\"soft\">{2}</td>"
        "<td class=\"number\">{3} checks</td><td class=\"verdict\">{4}</td></tr>\n",
        page.name, escaped(typeset(page.verdict.value("title", page.name))),
        escaped(typeset(page.about)), page.verdict.at("checks").size(),
        whole_verdict(page.verdict));
    sections += section(page);
  }
  write_page(
      dir / "report.html", "Transparent virtual coupling: experiments",
      report_summary(passed, measured, pages.size()),
      fmt::format("<section><table><tbody>\n{}</tbody></table></section>\n{}", contents, sections));
}

}  // namespace limpid
