// Experiments, each run as a whole: what they promise, and figures that show something.
#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "app/experiments/experiment.h"
#include "app/experiments/passivity.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
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

TEST_P(Promises, AreKeptAndShownInAFigure) {
  test::TempDir temp;
  TrialRunner::Options options;
  options.dir = temp / ".";
  TrialRunner lab(GetParam(), options);
  const Outcome outcome = called(GetParam()).run(lab);
  expect_promises(GetParam(), outcome.checks);
  expect_a_figure(outcome.figure);
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
