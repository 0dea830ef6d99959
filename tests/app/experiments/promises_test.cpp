// Experiments, each run as a whole: what they promise, and figures that show something.
#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "app/experiments/experiment.h"
#include "app/experiments/passivity.h"
#include "tests/app/experiments/promised_figures.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using test::expect_dots;
using test::Promised;
using testing::EndsWith;
using testing::Not;

const Experiment& called(const std::string& name) {
  return *std::ranges::find(experiments(), name, &Experiment::name);
}

const nlohmann::json& promises() {
  static const auto all = nlohmann::json::parse(
      std::ifstream(fs::path(LIMPID_SOURCE_DIR) / "tests/support/promises.json"));
  return all;
}

class Promises : public testing::TestWithParam<const char*> {};

void expect_promises(const std::string& name, const std::vector<Check>& checks) {
  const nlohmann::json& promised = promises().at(name);
  ASSERT_EQ(checks.size(), promised.size());
  for (std::size_t i = 0; i < checks.size(); ++i) {
    const Check& check = checks[i];
    EXPECT_EQ(check.what, promised[i][0].get<std::string>());
    const double bound = promised[i][2].get<double>();
    EXPECT_NEAR(check.bound, bound, 1e-12) << check.what;
    const auto judged = promised[i][1].get<std::string>();
    EXPECT_EQ(relation(check), judged) << check.what;
    if (judged == "measured") continue;
    ASSERT_TRUE(judged == "at most" || judged == "at least") << check.what << ": " << judged;
    EXPECT_TRUE(judged == "at most" ? check.value <= bound : check.value >= bound)
        << check.what << ": " << check.value;
    EXPECT_TRUE(check.passed) << check.what;
  }
}

bool within(const std::optional<std::pair<double, double>>& range, double value) {
  return !range || (value >= range->first && value <= range->second);
}

// A curve is drawn where a point of it is within the panel's ranges.
void expect_a_curve(const FigurePanel& panel, const Series& s) {
  const std::string where = panel.title + ": " + s.label;
  static const std::regex kColour("#[0-9A-Fa-f]{6}");
  EXPECT_GT(s.width, 0) << where;
  if (s.style == Series::Style::cells) {
    EXPECT_FALSE(s.cells.empty()) << where;
    for (const FigureCell& cell : s.cells) {
      EXPECT_LT(cell.x_low, cell.x_high) << where;
      EXPECT_LT(cell.y_low, cell.y_high) << where;
    }
    return;
  }
  EXPECT_TRUE(std::regex_match(s.color, kColour)) << where << ": " << s.color;
  EXPECT_FALSE(s.points.empty()) << where;
  bool seen = false;
  for (const FigurePoint& p : s.points) {
    EXPECT_TRUE(std::isfinite(p.x)) << where;
    const double y = s.style == Series::Style::band ? (p.low + p.high) / 2 : p.y;
    EXPECT_LE(p.low, p.high) << where;
    seen |= within(panel.x_range, p.x) && within(panel.y_range, y) && (!panel.log_x || p.x > 0) &&
            (!panel.log_y || y > 0);
  }
  EXPECT_TRUE(seen) << where << " is drawn nowhere";
}

void expect_a_panel(const FigurePanel& panel) {
  static const std::regex kUnit(R"(.*\[[^\]]+\].*)");
  EXPECT_FALSE(panel.title.empty());
  if (panel.x_ticks.empty()) {
    EXPECT_TRUE(std::regex_match(panel.x_label, kUnit)) << panel.title << ": " << panel.x_label;
  }
  EXPECT_TRUE(std::regex_match(panel.y_label, kUnit)) << panel.title << ": " << panel.y_label;
  for (const auto& [range, logarithmic] :
       {std::pair(panel.x_range, panel.log_x), {panel.y_range, panel.log_y}}) {
    if (!range) continue;
    EXPECT_LT(range->first, range->second) << panel.title;
    EXPECT_TRUE(!logarithmic || range->first > 0) << panel.title;
  }
  std::set<std::string> labels;
  EXPECT_FALSE(panel.series.empty()) << panel.title;
  for (const Series& s : panel.series) {
    if (!s.label.empty()) {
      EXPECT_TRUE(labels.insert(s.label).second) << panel.title << ": " << s.label << " twice";
    }
    expect_a_curve(panel, s);
  }
}

void expect_a_figure(const Figure& figure) {
  EXPECT_FALSE(figure.title.empty());
  EXPECT_THAT(figure.title, Not(EndsWith(".")));
  EXPECT_THAT(figure.caption, EndsWith("."));
  EXPECT_GE(figure.columns, 1);
  EXPECT_LE(figure.columns, 2) << "a report's page has room for two";
  EXPECT_GE(figure.panels.size(), static_cast<std::size_t>(figure.columns));
  EXPECT_GE(figure.panel_height, 200);
  EXPECT_LE(figure.panel_height, 640);
  std::set<std::string> titles;
  for (const FigurePanel& panel : figure.panels) {
    EXPECT_TRUE(titles.insert(panel.title).second) << panel.title << " twice";
    expect_a_panel(panel);
  }
}

// Trials of eta = 0.4, and the two in a stiff grip.
void expect_passivity(const Promised& shown, const std::filesystem::path& dir) {
  const std::string zero = "Commanded, where it changes sign";
  for (const char* label : {"eta = 0.4", "eta = 0.6"}) {
    const Series &mean = shown.curve(zero, label), &band = shown.beside(zero, label, -1);
    EXPECT_EQ(band.style, Series::Style::band);
    EXPECT_EQ(mean.points.size(), 201u);
    for (std::size_t i = 0; i < band.points.size(); ++i) {
      EXPECT_LE(band.points[i].low, mean.points.at(i).y + 1e-12);
      EXPECT_GE(band.points[i].high, mean.points.at(i).y - 1e-12);
    }
  }
  const Series &here = shown.curve(zero, "eta = 0.6"),
               &there = shown.curve("Commanded", "eta = 0.6");
  for (std::size_t i = 0; i < here.points.size(); ++i) {
    EXPECT_EQ(here.points[i].y, there.points.at(i).y);
  }
  // Each trial at 0.4 reaches above the limit; the highest of them are in the band.
  double highest = 0;
  for (const FigurePoint& p : shown.curve(zero, "eta = 0.4").points) {
    highest = std::max(highest, p.high);
  }
  EXPECT_GE(highest, 1e3 * shown.check("highest commanded E_c at eta = 0.4 (not passive), in each "
                                       "trial, lower limit [J]") -
                         1e-2);
  const auto last = [&](const std::string& of) {
    return 1e-3 * shown.curve("Total", of).points.back().y;
  };
  for (const auto& [low, high] : {std::pair("standard", "eta = 0.6"),
                                  {"eta = 3", "standard"},
                                  {"eta = 1", "eta = 0.6"},
                                  {"eta = 3", "eta = 1"},
                                  {"eta = 5", "eta = 3"}}) {
    const std::string what = fmt::format("mean of the final total E_c: {} minus {} [J]", low, high);
    EXPECT_NEAR(shown.check(what), last(low) - last(high), 1e-12);
  }
  std::size_t grown = 0;
  for (const char* name : {"grip-above", "grip-below"}) {
    const Session s = read_session(dir / (std::string(name) + ".h5"));
    const std::size_t eighth = s.size() / 8;
    double late = 0, early = 0;
    for (std::size_t k = 0; k < eighth; ++k) {
      late += vector_at(s, s.size() - eighth + k, Column::device_velocity).squaredNorm();
      early += vector_at(s, eighth + k, Column::device_velocity).squaredNorm();
    }
    const double growth = std::sqrt(late / early);
    for (const Check& check : shown.checks()) {
      if (!check.what.starts_with("stiff grip, ")) continue;
      if (check.least != (std::string(name) == "grip-below")) continue;
      EXPECT_NEAR(check.value, growth, 1e-9 * growth) << check.what;
      ++grown;
    }
  }
  EXPECT_EQ(grown, 2u);
}

// A cube that fell off has no curve, and the caption names it.
void expect_mass(const Promised& shown, const std::filesystem::path& dir) {
  int held = 0;
  for (const char* law : {"predictive", "proposed", "standard"}) {
    for (const double grams : {5.0, 50.0, 500.0}) {
      const Session s = read_session(dir / fmt::format("{}-eta-1-{}-g-5000.h5", law, grams));
      const bool stayed = s.size() == 8001 && s.at(s.size() - 1, Column::magnet)[0] > 0;
      const std::string title = fmt::format("Mass felt for a cube of {} g", grams);
      EXPECT_EQ(shown.has(title, law), stayed) << law << ", " << grams << " g";
      EXPECT_EQ(shown.caption().find(fmt::format("{} ({} g)", law, grams)) == std::string::npos,
                stayed)
          << law << ", " << grams << " g";
      held += stayed;
      if (stayed) expect_dots(shown.curve(title, law), shown.beside(title, law, 1));
    }
  }
  EXPECT_GE(held, 3) << "the predictive coupling holds all";
  if (held < 9) {
    EXPECT_THAT(shown.caption(), testing::HasSubstr("These cubes fell off"));
  }
}

// Motions of a recorded trial's bodies, as its checks have them; `bodies`: as they call them.
void expect_moving(const Promised& shown, const fs::path& file, const std::string& which,
                   const std::string& bodies) {
  const Session s = read_session(file);
  double energy = 0, gain = 0, beyond = 0, governor = 1, unsolved = 0;
  for (std::size_t k = 0; k < s.size(); ++k) {
    const auto one = [&](Column c) { return s.at(k, c)[0]; };
    energy = std::max(energy, one(Column::energy_total));
    gain = std::max(gain, one(Column::objects_gain));
    beyond = std::max(beyond, one(Column::energy_port) + one(Column::energy_to_objects));
    governor = std::min(governor, one(Column::governor));
    unsolved += one(Column::solved) == 3;
  }
  int seen = 0;
  for (const Check& check : shown.checks()) {
    for (const auto& [what, value] :
         {std::pair("highest E_c [J]", energy),
          {"number of ticks without a solution, in which the proxy did not move", unsolved},
          {"smallest share of the contact force that the governor allowed", governor}}) {
      if (check.what == which + what) {
        EXPECT_EQ(check.value, value) << check.what;
      }
    }
    const std::string gained = which + "energy gained by the " + bodies,
                      given = which + "largest energy given to the human minus the energy ";
    if (check.what.starts_with(gained)) {
      EXPECT_EQ(check.value, gain) << check.what;
    }
    if (check.what.starts_with(given)) {
      EXPECT_EQ(check.value, beyond) << check.what;
    }
    seen += check.what.starts_with(given);
  }
  EXPECT_EQ(seen, 1) << which;
}

void expect_all_moving(const std::string& name, const Promised& shown, const fs::path& dir) {
  if (name == "stack") {
    for (const auto& [file, label] : {std::pair("five", "5 of 20 g"),
                                      {"heavy-below", "500, 50, 5 g from below"},
                                      {"heavy-above", "5, 50, 500 g from below"},
                                      {"hundred-times", "5, 500 g from below"}}) {
      expect_moving(shown, dir / (std::string(file) + ".h5"), std::string(label) + ": ", "blocks");
    }
  }
  if (name != "drop" && name != "click") return;
  for (const int stiffness : {600, 2000, 5000}) {
    expect_moving(shown, dir / fmt::format("predictive-{}.h5", stiffness),
                  fmt::format("predictive, {} N/m: ", stiffness), "block");
  }
}

// Settings as README and the checks have them, which a caption has to tell.
void expect_told(const std::string& name, const std::string& caption) {
  static const std::map<std::string, std::vector<const char*>> kTold{
      {"approaches",
       {"taps a wall at 0.15 m/s", "presses with 4 N", "at most 20 %", "at most 20 mm/s",
        "Walls from 50 to 20000 N/m"}},
      {"coordination", {"grip 300 N/m and 2 N s/m, paper's gains, eta = 1"}},
      {"click",
       {"a button of 2 g", "0.5 + 0.4 sin(2 pi s / 8 mm) N", "The highest speed is 35 mm/s"}},
      {"delay",
       {"eta 0.1 to 5", "a delay of 0 to 3 ms", "Grips are 100 to 3000 N/m with 2 N s/m",
        "0.25 mm at 1 Hz", "taps at 0.15 m/s and presses with 2 N"}},
      {"drop", {"A block of 50 g falls from 10 cm", "600, 2000 and 5000 N/m"}},
      {"eta_min",
       {"Built-in arm", "paper's gains", "0.19 m ahead", "jumps by 20 um", "0.6 s or less",
        "k_vc / b_v = 833 rad/s"}},
      {"friction",
       {"a plane of 1000 N/m with 3 N", "30 mm sideways", "presses with 5 N", "100 N m"}},
      {"lightness", {"0.25 mm at 1 Hz", "a grip of 300 N/m and 4 N s/m; exact encoders"}},
      {"link",
       {"taps at 0.15 m/s, presses with 4 N and holds for 6 s", "E_c is at most 5 mJ",
        "at most 5 mm/s", "Walls of 100 to 20000 N/m", "outside 0.001 mJ to 100 J"}},
      {"mass",
       {"at 5000 N/m (600 N/m where", "0.25 mm at 1 Hz", "a cube of 1 mg", "the tip by 0.1 mm",
        "above 5000 N/m", "no mass up to 3 kg"}},
      {"observer", {"Built-in arm with its tip held 0.19 m", "ticks of 1 ms", "0.2 to 200 Hz"}},
      {"passivity", {"mean of 10 trials", "a spring of 3000 N/m", "paper's gains"}},
      {"saturation", {"paper's gains, eta = 0.6", "limited to 0.2 N m"}},
      {"spectrum", {"in the 50 trials", "windows of 2.048 s", "0.49 Hz apart"}},
      {"stack",
       {"Blocks of 30 mm", "with 1 N after 1 s", "K_o = 20000 N/m at each of 4 points",
        "the tip's contact has 2000 N/m"}},
      {"switching", {"at 3.3 Hz", "a table of 600 N/m with 1 N"}},
      {"transparency",
       {"paper's gains", "0.19 m ahead", "0.5 to 200 Hz", "grip of 100 N/m",
        "presses with 1 N and damps with 2 N s/m"}},
      {"walls",
       {"36 random arms of 1 to 12 joints and 0.02 to 30 kg", "at 0.15 m/s", "presses with 4 N",
        "grips of 300 and 3000 N/m, arms of 5 kg or more in grips of 1000 and 3000 N/m",
        "above 20 Hz is 0.1 times the pressing force, and 2 N for robots"}},
      {"zwidth",
       {"taps a wall at 0.15 m/s, presses with 4 N", "grips of 300 and 3000 N/m with 2 N s/m",
        "Motors of 100 N m", "at most 0.05 mJ", "above 20 Hz is at most 20 mm/s", "at most 5 %",
        "Walls of 100 to 20000 N/m"}}};
  const auto told = kTold.find(name);
  if (told == kTold.end()) return;
  for (const char* words : told->second) EXPECT_THAT(caption, testing::HasSubstr(words));
}

TEST_P(Promises, AreKeptAndShownInAFigure) {
  test::TempDir temp;
  TrialRunner::Options options;
  options.dir = temp / ".";
  TrialRunner lab(GetParam(), options);
  const Outcome outcome = called(GetParam()).run(lab);
  expect_promises(GetParam(), outcome.checks);
  expect_a_figure(outcome.figure);
  expect_told(GetParam(), outcome.figure.caption);
  test::expect_promised_figure(GetParam(), outcome);
  const fs::path kept = options.dir / GetParam();
  expect_all_moving(GetParam(), Promised(outcome), kept);
  if (kept.filename() == "passivity") expect_passivity(Promised(outcome), kept);
  if (kept.filename() == "mass") expect_mass(Promised(outcome), kept);
  EXPECT_EQ(lab.diverged(), 0u);
  EXPECT_FALSE(lab.conditions().text().empty());
}

// `robust` takes too long here; the system tests run all of them.
INSTANTIATE_TEST_SUITE_P(Of, Promises,
                         testing::Values("bodies", "coordination", "inertia", "passivity",
                                         "spectrum", "saturation", "observer", "transparency",
                                         "eta_min", "lightness", "approaches", "switching",
                                         "friction", "delay", "walls", "mass", "click", "drop",
                                         "stack", "link", "zwidth"),
                         [](const auto& one) { return std::string(one.param); });

// Recordings below a folder, and when each was written.
std::map<std::string, fs::file_time_type> recordings(const fs::path& dir) {
  std::map<std::string, fs::file_time_type> all;
  for (const fs::directory_entry& each : fs::recursive_directory_iterator(dir)) {
    if (each.path().extension() == ".h5") {
      all[fs::relative(each.path(), dir).string()] = each.last_write_time();
    }
  }
  return all;
}

// `passivity` keeps the trials that `spectrum` reads, and none of those that nothing else reads.
TEST(PromisesOfExperiments, LeaveTheTrialsThatOthersRead) {
  const test::TempDir temp;
  TrialRunner::Options options;
  options.dir = temp / ".";
  TrialRunner first("passivity", options), second("spectrum", options);
  called("passivity").run(first);
  const auto left = recordings(options.dir);
  for (std::size_t i = 0; i < kTrialsOfACase; ++i) {
    for (const PassivityCase& one : passivity_cases()) {
      EXPECT_TRUE(left.contains(fmt::format("passivity/{}-{}.h5", one.file_name, i))) << one.name;
    }
    EXPECT_FALSE(left.contains(fmt::format("passivity/eta-0.4-{}.h5", i))) << i;
  }
  called("spectrum").run(second);
  EXPECT_EQ(recordings(options.dir), left) << "it ran some again";
}

// `robust` is stopped here before its first trial; all of these are known by then.
TEST(PromisesOfExperiments, OfRobustAreTriedOnAnIdealArmAndATouch) {
  static const std::atomic<bool> kStop{true};
  const test::TempDir temp;
  TrialRunner::Options options;
  options.dir = temp / ".";
  options.stop = &kStop;
  TrialRunner lab("robust", options);
  EXPECT_THROW(called("robust").run(lab), Cancelled);
  EXPECT_EQ(
      lab.conditions().text(),
      "Conditions: arm omni, touch of 3 joints; limit of every motor: the arm's own, 0.45 and "
      "0.64 N m; grip 300 and 3000 N/m, undamped and 2 N s/m; no mass in the hand; exact "
      "encoders and 0.000419 rad per encoder step; no delay and 1 ms of delay; tick 1 ms.");
}

TEST(PromisesOfExperiments, AreMadeByEachOfThem) {
  std::set<std::string> promised, known;
  for (const auto& [name, checks] : promises().items()) promised.insert(name);
  for (const Experiment& e : experiments()) {
    known.insert(e.name);
    EXPECT_STRNE(e.about, "");
  }
  EXPECT_EQ(promised, known);
}

}  // namespace
}  // namespace limpid
