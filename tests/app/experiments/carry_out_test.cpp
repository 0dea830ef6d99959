#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "app/experiments/signals.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using testing::HasSubstr;
using testing::Not;

namespace fs = std::filesystem;

std::string read(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

Outcome sound(TrialRunner&) {
  Outcome outcome;
  outcome.figure.title = "Sound";
  outcome.figure.panels = {
      {.title = "P", .series = {{"s", kHandInk, Series::Style::line, {{0, 0}, {1, 1}}}}}};
  outcome.checks = {at_most("three at most four", 3, 4), at_least("three at least three", 3, 3)};
  return outcome;
}

Outcome broken(TrialRunner& lab) {
  Outcome outcome = sound(lab);
  outcome.figure.title = "Broken <script>";
  outcome.checks.push_back(at_most("not finite", std::numeric_limits<double>::quiet_NaN(), 1));
  return outcome;
}

TrialRunner::Options in(const fs::path& dir) {
  TrialRunner::Options options;
  options.dir = dir;
  return options;
}

class CarryOut : public testing::Test {
 protected:
  test::TempDir temp_;
  const fs::path dir_ = temp_ / ".";
};

TEST_F(CarryOut, LeavesTableFigureAndVerdict) {
  EXPECT_TRUE(carry_out({"sound", "about", sound}, in(dir_ / "new")).passed());
  for (const char* end : {".csv", ".png", ".svg", ".json"}) {
    EXPECT_TRUE(fs::exists(dir_ / "new" / (std::string("sound") + end))) << end;
  }
  const auto verdict = nlohmann::json::parse(read(dir_ / "new/sound.json"));
  EXPECT_EQ(verdict.at("name"), "sound");
  EXPECT_EQ(verdict.at("passed"), true);
  ASSERT_EQ(verdict.at("checks").size(), 2u);
  EXPECT_EQ(verdict.at("checks")[0], (nlohmann::json{{"what", "three at most four"},
                                                     {"value", 3.0},
                                                     {"relation", "at most"},
                                                     {"bound", 4.0},
                                                     {"passed", true}}));
}

TEST_F(CarryOut, CallsAValueThatIsNotFiniteAFailure) {
  EXPECT_FALSE(carry_out({"broken", "about", broken}, in(dir_)).passed());
  EXPECT_EQ(nlohmann::json::parse(read(dir_ / "broken.json")).at("passed"), false);
}

Outcome spoiled(TrialRunner& lab) {
  Outcome outcome = sound(lab);
  Check judged = at_most("roll: error [%]", 0.5, 1);
  judged.against = Comparison{4, 4.02, "m/s^2", "A ball."};
  Check known = at_most("bounce: error [%]", 30, 1);
  known.against = Comparison{0.1, 0.13, "of it", "Another ball."};
  known.unjudged = "Known fault: it bounces.";
  outcome.checks = {judged, known};
  return outcome;
}

// A row that a known fault spoils is neither passed nor failed, and says why.
TEST_F(CarryOut, MeasuresAndDoesNotJudgeWhatAKnownFaultSpoils) {
  const Outcome outcome = carry_out({"inertia", "about", spoiled}, in(dir_));
  EXPECT_TRUE(outcome.passed());
  const auto verdict = nlohmann::json::parse(read(dir_ / "inertia.json"));
  EXPECT_EQ(verdict.at("passed"), true);
  EXPECT_EQ(verdict.at("checks")[0], (nlohmann::json{{"what", "roll: error [%]"},
                                                     {"value", 0.5},
                                                     {"relation", "at most"},
                                                     {"bound", 1.0},
                                                     {"passed", true},
                                                     {"expected", 4.0},
                                                     {"measured", 4.02},
                                                     {"unit", "m/s^2"},
                                                     {"conditions", "A ball."}}));
  EXPECT_EQ(verdict.at("checks")[1].at("passed"), nullptr);
  EXPECT_EQ(verdict.at("checks")[1].at("unjudged"), "Known fault: it bounces.");
  write_report(dir_);
  const std::string html = read(dir_ / "report.html");
  EXPECT_THAT(html, HasSubstr("Known fault: it bounces."));
  EXPECT_THAT(html, HasSubstr("4.02 m/s²"));
  EXPECT_THAT(html, HasSubstr("A ball."));
  EXPECT_THAT(html, HasSubstr("measured"));
}

TEST_F(CarryOut, FailsWhereARowFailsBesideOneThatIsOnlyMeasured) {
  const auto fails = [](TrialRunner& lab) {
    Outcome outcome = spoiled(lab);
    outcome.checks[0].passed = false;
    return outcome;
  };
  EXPECT_FALSE(carry_out({"inertia", "about", fails}, in(dir_)).passed());
}

Outcome runs_away(TrialRunner& lab) {
  Parameters p;
  p.eta = 0.05;
  p.hand_stiffness = 3000;
  p.hand_damping = 0;
  p.torque_limit = 1000;
  lab.run({Trial{"away", plan_of(built_in_arm().description, "free", "free", p), false}});
  return sound(lab);
}

// Holds for any other result of the experiment.
TEST_F(CarryOut, CallsATrialThatDivergedAFailureAndSaysTheConditions) {
  const Outcome outcome = carry_out({"away", "about", runs_away}, in(dir_));
  EXPECT_FALSE(outcome.passed());
  EXPECT_EQ(outcome.checks.back().what,
            "number of diverged trials, among the trials that must not diverge");
  EXPECT_EQ(outcome.checks.back().value, 1);
  EXPECT_THAT(outcome.figure.caption, HasSubstr("Conditions: arm omni"));
}

TEST(Worse, KeepsWhatIsNoNumberWhereMaximumWouldDropIt) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(worse(1, 2), 2);
  EXPECT_EQ(worse_low(1, 2), 1);
  EXPECT_TRUE(std::isnan(worse(1, none)));
  EXPECT_TRUE(std::isnan(worse(none, 1)));
  EXPECT_TRUE(std::isnan(worse_low(1, none)));
  EXPECT_FALSE(at_most("", worse(0, none), 1).passed);
}

TEST_F(CarryOut, PromisesNothingWithoutChecks) { EXPECT_FALSE(Outcome{}.passed()); }

TEST_F(CarryOut, ReportsOnEveryVerdictThereIs) {
  // The report knows the experiments by name; made up ones take their places here.
  carry_out({"inertia", "about", sound}, in(dir_));
  carry_out({"passivity", "about", broken}, in(dir_));
  write_report(dir_);
  const std::string html = read(dir_ / "report.html");
  EXPECT_THAT(html, HasSubstr("1 of 2 experiments passed"));
  EXPECT_THAT(html, HasSubstr("inertia.svg"));
  EXPECT_THAT(html, HasSubstr("passivity.svg"));
  EXPECT_THAT(html, HasSubstr("three at most four"));
  EXPECT_THAT(html, HasSubstr("Broken &lt;script&gt;"));
  EXPECT_THAT(html, Not(HasSubstr("coordination.svg")));
}

// Returns the words of each cell of the last table, by rows; tags inside a cell are left out.
std::vector<std::vector<std::string>> table_of(std::string html) {
  const std::size_t begin = html.rfind("<table>");
  html = html.substr(begin, html.rfind("</table>") - begin);
  std::vector<std::vector<std::string>> rows;
  for (std::size_t at = 0; at < html.size();) {
    const std::size_t end = html.find('>', at);
    const std::string tag = html.substr(at + 1, end - at - 1);
    if (tag == "tr") rows.emplace_back();
    if (tag.starts_with("td") || tag.starts_with("th ") || tag == "th") rows.back().emplace_back();
    at = html.find('<', end);
    if (at == std::string::npos) break;
    if (!rows.empty() && !rows.back().empty() && html[end + 1] != '\n')
      rows.back().back() += html.substr(end + 1, at - end - 1);
  }
  return rows;
}

TEST_F(CarryOut, ReportsComparisonsInColumnsOfTheirOwn) {
  const auto mixed = [](TrialRunner& lab) {
    Outcome outcome = spoiled(lab);
    outcome.checks.push_back(at_most("three at most four", 3, 4));
    Check open = at_most("no theory", 1, 2);
    open.against = Comparison{std::nullopt, 7, "mm", "A third ball."};
    outcome.checks.push_back(open);
    return outcome;
  };
  carry_out({"inertia", "about", mixed}, in(dir_));
  write_report(dir_);
  const auto rows = table_of(read(dir_ / "report.html"));
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[0], (std::vector<std::string>{"Check", "Expected", "Measured", "Value", "Bound",
                                               "Verdict"}));
  for (const auto& row : rows) EXPECT_EQ(row.size(), 6u);
  EXPECT_EQ(rows[1][1], "4 m/s²");
  EXPECT_EQ(rows[1][2], "4.02 m/s²");
  EXPECT_EQ(rows[3],
            (std::vector<std::string>{"three at most four", "", "", "3", "&le; 4", "✓ passed"}));
  EXPECT_EQ(rows[4][1], "");
  EXPECT_EQ(rows[4][2], "7 mm");
}

TEST_F(CarryOut, ReportsNoComparisonsWhereThereAreNone) {
  carry_out({"inertia", "about", sound}, in(dir_));
  write_report(dir_);
  const auto rows = table_of(read(dir_ / "report.html"));
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0], (std::vector<std::string>{"Check", "Value", "Bound", "Verdict"}));
  EXPECT_EQ(rows[1], (std::vector<std::string>{"three at most four", "3", "&le; 4", "✓ passed"}));
}

TEST_F(CarryOut, ReportsPastAVerdictThatIsDamaged) {
  carry_out({"inertia", "about", sound}, in(dir_));
  std::ofstream(dir_ / "passivity.json") << "{\"checks\": [";
  write_report(dir_);
  EXPECT_THAT(read(dir_ / "report.html"), HasSubstr("1 of 1 experiments passed"));
}

TEST(Experiments, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const Experiment& e : experiments()) EXPECT_TRUE(names.insert(e.name).second) << e.name;
}

}  // namespace
}  // namespace limpid
