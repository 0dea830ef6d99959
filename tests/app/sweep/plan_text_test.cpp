// Texts of plans: what they come to, and the reason for each that is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "app/sweep/sweep_plan.h"
#include "devices/files/text_file.h"

namespace limpid {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string complaint_about(const std::string& text) {
  try {
    plan_of_text(text, "plan.toml");
  } catch (const FileError& e) {
    return e.what();
  }
  return "taken";
}

const std::string kEta = "{ key = \"coupling.eta\", values = [0.5, 1] }";
const std::string kMeasured = "measure = [\"energy\"]\n";

struct Refused {
  const char *text, *why;
};

TEST(TextOfAPlan, SaysWhatIsWrongWithAnAxis) {
  for (const auto& [text, why] : std::initializer_list<Refused>{
           {"values = [1]", "key: missing"},
           {"key = \"scene.body.it.banana\", values = [1]", "axis.key"},
           {"key = \"coupling.kind\"", "values: missing"},
           {"key = \"coupling.kind\", values = 3", "a list of words from: standard"},
           {"key = \"coupling.kind\", values = [3]", "a list of words from: standard"},
           {"key = \"coupling.kind\", values = [\"predctive\"]", "did you mean predictive?"},
           {"key = \"coupling.eta\", values = []", "a list of numbers"},
           {"key = \"coupling.eta\", values = \"1\"", "a list of numbers"},
           {"key = \"coupling.eta\", values = [\"1\"]", "a list of numbers"},
           {"key = \"coupling.eta\", to = 1, count = 3", "from: missing"},
           {"key = \"coupling.eta\", from = 0.5, count = 3", "to: missing"},
           {"key = \"coupling.eta\", from = 0.5, to = 0.5, count = 3", "more than 0.5"},
           {"key = \"coupling.eta\", from = 0.5, to = 1, count = 1", "count"},
           {"key = \"coupling.eta\", from = 0.5, to = 1, count = 3, scale = \"ln\"", "linear, log"},
           {"key = \"coupling.eta\", from = 0.5, to = 1, count = 3, sample = \"all\"", "grid, "},
           {"key = \"hand.stiffness\", values = [-1]", "numbers from"},
           {"key = \"scene.stiffness\", values = [0]", "numbers above 0 to"},
           {"key = \"device\", values = []", "values: missing"},
           {"key = \"scene\"", "values: missing"},
           {"key = \"hand\", values = []", "values: missing"},
           {"cases = [{ name = \"a\" }]", "name: missing"},
           {"name = \"n\", cases = [{ set = [] }]", "name: missing"},
           {"name = \"n\", cases = [{ name = \"a\", sets = [] }]", "sets: no such key"},
           {"name = \"n\", cases = [{ name = \"a\", set = [\"hand.damping = -1\"] }]",
            "hand.damping"},
           {"key = \"coupling.eta\", values = [1], names = 3", "names: no such key"},
           {"key = \"coupling.eta\", values = [1], name = \"\"", "letters, digits"},
           {"key = \"arm.mass\", values = [1]", "only with hand = { tap = NEWTONS }"}}) {
    const std::string said =
        complaint_about(kMeasured + "axis = [{ " + std::string(text) + " }]\n");
    EXPECT_THAT(said, HasSubstr("plan.toml:2: ")) << text;
    EXPECT_THAT(said, HasSubstr(why)) << text;
  }
}

TEST(TextOfAPlan, SaysWhatIsWrongWithTheRest) {
  const std::string taps = kMeasured + "hand = { tap = 2 }\n";
  for (const auto& [text, why] : std::initializer_list<std::pair<std::string, const char*>>{
           {"", "measure: missing"},
           {"measure = [\"energie\"]", "did you mean energy"},
           {"measure = [\"banana\"]", "no such measure; a list of measures from"},
           {kMeasured + "seconds = -1", "seconds"},
           {kMeasured + "repeats = 0", "repeats"},
           {kMeasured + "block = 0", "block"},
           {kMeasured + "samples = 5", "no value, because no axis is sampled"},
           {kMeasured + "hand = { jump = [0, 0, 1] }\nseconds = 1", "at: missing"},
           {kMeasured + "hand = { at = [0, 0, 0] }", "seconds: missing"},
           {kMeasured + "hand = { at = [0, 0, 0] }\nseconds = 1\nrepeats = 2",
            "1, because a hand that jumps"},
           {kMeasured + "hand = { at = [0, 0, 0], too = 1 }\nseconds = 1", "too: no such key"},
           {kMeasured + "hand = { tap = 0 }", "tap"},
           {kMeasured + "hand = { tap = 2, jump = [0, 0, 1] }",
            "a hand that taps finds its own way"},
           {kMeasured + "hand = { tap = 2, at = [0, 0, 1] }", "a hand that taps finds its own way"},
           {taps + "scene = \"free.toml\"", "a tap test has its own wall"},
           {taps + "repeats = 2", "1, because a hand that taps"},
           {taps + "axis = [{ key = \"scene.body.it.mass\", values = [1] }]", "no key of a body"},
           {kMeasured + "boundary = 3", "a table [boundary]"},
           {"[boundary]\nmeasure = \"stable\"\ntolerance = 0.1", "axis: missing"},
           {"[boundary]\naxis = { key = \"coupling.kind\", values = [\"direct\"] }\n"
            "measure = \"stable\"\ntolerance = 0.1",
            "numbers from, to and a count"},
           {"[boundary]\naxis = { key = \"coupling.eta\", values = [1] }\nmeasure = \"stable\"\n"
            "tolerance = 0.1",
            "numbers from, to and a count"},
           {"[boundary]\naxis = " + kEta + "\nmeasure = \"stable\"", "tolerance: missing"},
           {"[boundary]\naxis = " + kEta + "\nmeasure = \"banana\"\ntolerance = 0.1",
            "a measure that limpid sweep --help lists"},
           {"[boundary]\naxis = " + kEta + "\nmeasure = \"energy\"\ntolerance = 0.1",
            "above or below"},
           {kMeasured + "[boundary]\naxis = " + kEta + "\nmeasure = \"stable\"\ntolerance = 0.1",
            "a sweep with a boundary measures only the boundary"},
           {kMeasured + "axis = [{ key = \"coupling.eta\", values = [0.5, 1, 0.5] }]",
            "each value only once"},
           {kMeasured + "axis = [{ key = \"coupling.kind\", values = [\"tank\", \"tank\"] }]",
            "each value only once"},
           {kMeasured + "axis = [{ name = \"a\", cases = [{ name = \"b\" }, { name = \"b\" }] }]",
            "each value only once"},
           {kMeasured + "axis = [" + kEta + ", { key = \"coupling.eta\", name = \"eta2\", " +
                "values = [0.2, 0.9] }]",
            "a key that no other axis sets; coupling.eta"},
           {kMeasured + "axis = [" + kEta + ", { name = \"case\", cases = [{ name = \"x\", " +
                "set = [\" coupling.eta = 1\"] }] }]",
            "a key that no other axis sets; coupling.eta"},
           {kMeasured + "axis = [{ key = \"scene\", values = [\"free.toml\"] }, { name = \"c\", " +
                "cases = [{ name = \"x\", scene = \"table.toml\" }] }]",
            "a key that no other axis sets; scene"},
           {"axis = [" + kEta + "]\n[boundary]\naxis = { key = \"coupling.eta\", from = 0.1, " +
                "to = 1, count = 3 }\nmeasure = \"stable\"\ntolerance = 0.1",
            "a key that no other axis sets; coupling.eta"},
           {taps + "axis = [{ key = \"scene\", values = [\"free.toml\", \"table.toml\"] }]",
            "a tap test has its own wall"},
           {taps + "axis = [{ name = \"c\", cases = [{ name = \"x\", hand = \"touch.csv\" }] }]",
            "the plan's own `hand` is not a file"},
           {kMeasured + "hand = { at = [0, 0, 0] }\nseconds = 1\naxis = [{ key = \"hand\", " +
                "values = [\"touch.csv\"] }]",
            "the plan's own `hand` is not a file"},
           {taps + "axis = [{ key = \"arm.joints\", values = [2, 3] }, { key = \"device\", " +
                "values = [\"omni.urdf\"] }]",
            "a random arm is not a device"},
           {kMeasured + "[[stop]]\nabove = 1", "measure: missing"},
           {kMeasured + "[[stop]]\nmeasure = \"stable\"\nafter = -1", "after"},
           {kMeasured + "[figure]\nx = \"eta\"", "the name of an axis"},
           {kMeasured + "[figure]\ny = \"eta\"", "the name of an axis"},
           {kMeasured + "[figure]\nmeasure = \"stable\"", "a measure that the plan measures"},
           {kMeasured + "[figure]\ntheory = [\"banana\"]", "a list of names from"},
           {kMeasured + "[figure]\ntitle = \"a\"", "title: no such key"},
           {kMeasured + "axis = [{ key = \"coupling.eta\", from = 0.1, to = 1, count = 1000 },\n"
                        "{ key = \"hand.stiffness\", from = 10, to = 1000, count = 1000 },\n"
                        "{ key = \"hand.damping\", from = 0, to = 1, count = 1000 }]",
            "1e+09 points; allowed: up to 100000000"}}) {
    EXPECT_THAT(complaint_about(text), HasSubstr(why)) << text;
  }
}

TEST(TextOfAPlan, IsReadAsItIsSaid) {
  const SweepPlan plan = plan_of_text(R"(title = "All of it"
device = "arm.urdf"
scene = "wall.toml"
hand = { at = [0.1, 0.2, 0.3], jump = [0, 0, -0.01] }
seconds = 2.5
seed = 42
samples = 7
block = 3
set = ["hand.damping = 5"]
measure = ["energy", "stable"]
axis = [ { key = "coupling.eta", from = 0.1, to = 10, count = 3, scale = "log" },
         { key = "hand.stiffness", from = 100, to = 200, sample = "latin", name = "grip" },
         { name = "law", cases = [ { name = "a", set = ["coupling.kind = direct"] },
                                   { name = "b", device = "other.urdf", scene = "s.toml" } ] } ]
[[stop]]
measure = "energy"
above = 3
after = 0.5
[figure]
x = "grip"
y = "eta"
measure = "energy"
theory = ["pr"]
caption = "What is seen."
)",
                                      "plans/plan.toml");
  EXPECT_EQ(plan.title, "All of it");
  EXPECT_EQ(plan.world.device, "arm.urdf");
  EXPECT_EQ(plan.world.scene, "wall.toml");
  ASSERT_TRUE(plan.jump);
  EXPECT_EQ(plan.jump->at, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(plan.jump->by, Vec3(0, 0, -0.01));
  EXPECT_FALSE(plan.tap);
  EXPECT_EQ(plan.seconds, 2.5);
  EXPECT_EQ(plan.seed, 42u);
  EXPECT_EQ(plan.samples, 7u);
  EXPECT_EQ(plan.repeats, 1u);
  EXPECT_EQ(plan.block, 3u);
  EXPECT_EQ(plan.parameters.hand_damping, 5);
  ASSERT_EQ(plan.axes.size(), 3u);
  EXPECT_EQ(plan.axes[0].name, "eta");
  EXPECT_TRUE(plan.axes[0].logarithmic);
  EXPECT_THAT(plan.axes[0].values, ElementsAre(0.1, testing::DoubleNear(1, 1e-12), 10));
  EXPECT_EQ(plan.axes[1].name, "grip");
  EXPECT_EQ(plan.axes[1].unit, "N/m");
  EXPECT_EQ(plan.axes[1].spread, Spread::latin);
  // A Latin square has one value in each seventh of the range.
  std::set<int> sevenths;
  for (const double x : plan.axes[1].values) sevenths.insert(static_cast<int>((x - 100) / 100 * 7));
  EXPECT_THAT(sevenths, ElementsAre(0, 1, 2, 3, 4, 5, 6));
  EXPECT_THAT(plan.axes[2].words, ElementsAre("a", "b"));
  EXPECT_THAT(plan.axes[2].values, ElementsAre(0, 1));
  ASSERT_EQ(plan.axes[2].cases.size(), 2u);
  EXPECT_THAT(plan.axes[2].cases[0].settings, ElementsAre("coupling.kind = direct"));
  EXPECT_EQ(plan.axes[2].cases[1].world.device, "other.urdf");
  EXPECT_EQ(plan.axes[2].cases[1].world.scene, "s.toml");
  EXPECT_EQ(plan.axes[2].cases[1].world.hand, "");
  ASSERT_EQ(plan.measures.size(), 2u);
  EXPECT_STREQ(plan.measures[1]->name, "stable");
  ASSERT_EQ(plan.stops.size(), 1u);
  EXPECT_STREQ(plan.stops[0].limit.measure->name, "energy");
  EXPECT_EQ(plan.stops[0].limit.above, 3);
  EXPECT_FALSE(plan.stops[0].limit.below);
  EXPECT_EQ(plan.stops[0].after, 0.5);
  EXPECT_EQ(plan.figure.x, "grip");
  EXPECT_EQ(plan.figure.y, "eta");
  EXPECT_EQ(plan.figure.measure, "energy");
  EXPECT_THAT(plan.figure.theory, ElementsAre("pr"));
  EXPECT_EQ(plan.figure.caption, "What is seen.");
}

TEST(TextOfAPlan, HasUsualValuesForWhatItDoesNotSay) {
  const SweepPlan plan = plan_of_text(kMeasured, "plans/grips.toml");
  EXPECT_EQ(plan.title, "grips");
  EXPECT_EQ(plan.seed, 0u);
  EXPECT_EQ(plan.samples, 1u);
  EXPECT_EQ(plan.repeats, 1u);
  EXPECT_EQ(plan.block, 1u);
  EXPECT_EQ(plan.points(), 1u);
  EXPECT_EQ(plan.seconds, 0);
  EXPECT_FALSE(plan.tap || plan.jump || plan.boundary);
  EXPECT_TRUE(plan.stops.empty());
  const SweepPlan wall = plan_of_text(
      "hand = { tap = 2 }\n" + kMeasured + "axis = [{ key = \"scene.stiffness\", values = [5] }]",
      "a.toml");
  EXPECT_EQ(wall.tap, 2);
  EXPECT_EQ(wall.axes.at(0).name, "wall");
  EXPECT_EQ(wall.axes.at(0).unit, "N/m");
}

TEST(TextOfAPlan, HasABoundaryWithAnAxisOfItsOwn) {
  const SweepPlan plan = plan_of_text(R"([boundary]
axis = { key = "coupling.eta", values = [1, 0.5, 0.75] }
measure = "energy"
below = 0.25
tolerance = 0.01
)",
                                      "a.toml");
  ASSERT_TRUE(plan.boundary);
  EXPECT_EQ(plan.boundary->axis.key, "coupling.eta");
  EXPECT_THAT(plan.boundary->axis.values, ElementsAre(0.5, 0.75, 1)) << "in order";
  EXPECT_STREQ(plan.boundary->condition.measure->name, "energy");
  EXPECT_EQ(plan.boundary->condition.below, 0.25);
  EXPECT_FALSE(plan.boundary->condition.above);
  EXPECT_EQ(plan.boundary->tolerance, 0.01);
}

}  // namespace
}  // namespace limpid
