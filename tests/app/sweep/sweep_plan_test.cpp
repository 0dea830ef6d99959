#include "app/sweep/sweep_plan.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <map>

#include "app/run/fitted_gains.h"
#include "devices/files/text_file.h"
#include "tests/app/sweep/plans.h"

namespace limpid {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;

class SweepPlans : public testing::Test {
 protected:
  SweepPlan read(const std::string& text) { return test::sweep_plan(dir_, text); }
  std::string refusal(const std::string& text) {
    try {
      read(text);
    } catch (const FileError& e) {
      return e.what();
    }
    return "taken";
  }
  static std::string with(const std::string& line) {
    return "scene = \"free.toml\"\nmeasure = [\"energy\"]\n" + line + "\n";
  }
  test::TempDir dir_;
};

TEST_F(SweepPlans, NumberTheirPointsWithTheLastAxisFastest) {
  const SweepPlan plan = read(with(R"(repeats = 2
axis = [ { key = "coupling.eta", values = [0.5, 1] },
         { key = "hand.stiffness", values = [100, 200, 300] } ])"));
  ASSERT_EQ(plan.points(), 12u);
  EXPECT_THAT(point_of(plan, 0).values, ElementsAre(0.5, 100));
  EXPECT_EQ(point_of(plan, 1).repeat, 1u);
  EXPECT_THAT(point_of(plan, 2).values, ElementsAre(0.5, 200));
  EXPECT_THAT(point_of(plan, 6).values, ElementsAre(1, 100));
  EXPECT_THAT(point_of(plan, 11).values, ElementsAre(1, 300));
  EXPECT_NE(run_of(plan, 1).hand.position, run_of(plan, 0).hand.position);
  EXPECT_EQ(run_of(plan, 1).hand.position, run_of(plan, 3).hand.position);
}

TEST_F(SweepPlans, SayWhichOfTheirFilesIsNotThere) {
  for (const char* key : {"device", "scene", "hand"}) {
    const std::string said = refusal(std::string(key) +
                                     " = \"nope.file\"\nmeasure = [\"energy\"]\n"
                                     "axis = [ { key = \"coupling.eta\", values = [1] } ]\n");
    EXPECT_THAT(said, AllOf(HasSubstr((dir_ / "x").parent_path().string()),
                            HasSubstr("file \"nope.file\" not found")))
        << key;
  }
}

// Gains fit the arm as in `limpid run`, but for those that the plan says.
TEST_F(SweepPlans, FitGainsToTheArm) {
  const SweepPlan plan = read(R"(device = "omega.urdf"
scene = "free.toml"
hand = { at = [0.19, 0, 0] }
seconds = 0.1
measure = ["energy"]
set = ["coupling.kind = standard", "coupling.b_v = 0.5"]
axis = [{ key = "coupling.b_vc", values = [0.001, 0.002] }]
)");
  const RunPlan run = run_of(plan, 1);
  const Parameters fit = fitted(run.arm);
  EXPECT_NE(fit.k_vc, Parameters{}.k_vc);
  EXPECT_EQ(run.parameters.k_vc, fit.k_vc);
  EXPECT_EQ(run.parameters.alpha, fit.alpha);
  EXPECT_EQ(run.parameters.b_v, 0.5) << "the plan's own";
  EXPECT_EQ(run.parameters.b_vc, 0.002) << "the axis' own";
  EXPECT_EQ(run.parameters.kind, CouplingKind::standard);
}

TEST_F(SweepPlans, FitGainsToRandomArmsThatTap) {
  const SweepPlan plan = read(R"(hand = { tap = 2 }
measure = ["energy"]
axis = [{ key = "arm.mass", values = [5] }]
)");
  const RunPlan run = run_of(plan, 0);
  const Parameters random = fitted(run.arm);
  EXPECT_NE(random.b_v, Parameters{}.b_v);
  EXPECT_EQ(run.parameters.b_v, random.b_v);
}

// Each number is as likely as the others.
TEST_F(SweepPlans, SampleWholeNumbersUniformly) {
  for (const char* way : {"random", "latin", "sobol"}) {
    const SweepPlan plan = read(with(fmt::format(R"(samples = 3000
axis = [{{ key = "device.delay", sample = "{}", from = 0, to = 2 }}])",
                                                 way)));
    std::map<double, int> count;
    for (const double x : plan.axes[0].values) ++count[x];
    ASSERT_EQ(count.size(), 3u) << way;
    for (const auto& [x, n] : count)
      EXPECT_NEAR(n, 1000, 4 * std::sqrt(3000 * 2 / 9.0)) << way << x;
  }
}

const std::string kTaps = R"(hand = { tap = 2 }
measure = ["wall_felt"]
set = ["coupling.kind = predictive"]
axis = [ { key = "arm.joints", values = [1, 7] }, { key = "arm.mass", values = [0.1, 10] } ]
)";

TEST_F(SweepPlans, TapWallsWithArmsOfAnySizeAndMassAsStiffAsAreNamedForThem) {
  const SweepPlan plan = read(kTaps);
  for (std::uint64_t i = 0; i < plan.points(); ++i) {
    const RunPlan run = run_of(plan, i);
    const SweepPoint point = point_of(plan, i);
    EXPECT_EQ(run.arm.dof(), point.values[0]);
    double mass = 0;
    for (const Link& link : run.arm.links) mass += link.mass;
    EXPECT_NEAR(mass, point.values[1], 1e-9 * mass);
    ASSERT_EQ(run.document.scene.objects.size(), 1u);
    // The tip begins before the wall, and the hand ends in it.
    const Object& wall = run.document.scene.objects.front();
    const Vec3 out = std::get<Plane>(wall.shape).normal, foot = wall.pose.translation();
    EXPECT_GT(out.dot(run.start->target - foot), 0);
    EXPECT_LT(out.dot(run.hand.position.back() - foot), 0);
    EXPECT_FALSE(run.arm.urdf.empty()) << "a session of it has its file";
  }
  EXPECT_EQ(run_of(plan, 0).hand.position, run_of(plan, 0).hand.position);
}

// A link of an arm whose mass no axis has weighs 50 g, as those of desktop devices do.
TEST_F(SweepPlans, TapWithArmsOfDesktopSizeWhereNoAxisHasTheirMass) {
  const SweepPlan plan = read(R"(hand = { tap = 2 }
measure = ["wall_felt"]
set = ["coupling.kind = predictive"]
axis = [ { key = "arm.joints", values = [2, 3, 7] } ])");
  for (std::uint64_t i = 0; i < plan.points(); ++i) {
    const RunPlan run = run_of(plan, i);
    double mass = 0;
    for (const Link& link : run.arm.links) mass += link.mass;
    EXPECT_NEAR(mass, 0.05 * run.arm.dof(), 1e-9) << run.arm.dof() << " joints";
  }
}

TEST_F(SweepPlans, TapWallsOfTheStiffnessThatAnAxisHas) {
  const SweepPlan plan = read(R"(hand = { tap = 2 }
measure = ["wall"]
axis = [ { key = "scene.stiffness", values = [200, 400] } ])");
  for (std::uint64_t i = 0; i < 2; ++i) {
    EXPECT_EQ(run_of(plan, i).document.scene.objects.front().material.stiffness, 200 * (i + 1));
  }
}

TEST_F(SweepPlans, RefuseArmsThatNobodyTapsWithAndTapsThatGoElsewhere) {
  EXPECT_THAT(refusal(with(R"(axis = [ { key = "arm.mass", values = [1] } ])")),
              HasSubstr("only with hand = { tap"));
  EXPECT_THAT(refusal(R"(hand = { tap = 2, at = [0, 0, 0] }
measure = ["energy"]
axis = [ { key = "coupling.eta", values = [1] } ])"),
              HasSubstr("finds its own way"));
  EXPECT_THAT(refusal("scene = \"free.toml\"\n" + kTaps), HasSubstr("its own wall"));
  const auto joints = [](const std::string& count) {
    return "hand = { tap = 2 }\nmeasure = [\"energy\"]\n[[axis]]\nkey = \"arm.joints\"\nvalues = "
           "[" +
           count + "]\n";
  };
  for (const char* count : {"0", "33", "2.5"}) {
    EXPECT_THAT(refusal(joints(count)), HasSubstr("whole numbers from 1 to 32")) << count;
  }
  EXPECT_EQ(refusal(joints("32")), "taken");
}

// A stranger's plan, or a table that holds one, must not start a program that runs the stranger's
// code.
TEST_F(SweepPlans, ExpandNoXacroUnlessTheyMay) {
  std::ofstream(dir_ / "arm.xacro") << "<robot name='r'><xacro:link name='a'/></robot>";
  const std::string text =
      with("device = \"arm.xacro\"\naxis = [{ key = \"coupling.eta\", values = [1] }]");
  EXPECT_THAT(refusal(text), AllOf(HasSubstr("arm.xacro"), HasSubstr("--allow-xacro")));
  const std::string path = getenv("PATH");
  setenv("PATH", "/nowhere", 1);  // if allowed, the program is looked for
  try {
    read_sweep_plan(dir_ / "plan.toml", Xacro::expand);
    ADD_FAILURE();
  } catch (const FileError& e) {
    EXPECT_THAT(e.what(), HasSubstr("is not installed"));
  }
  setenv("PATH", path.c_str(), 1);
}

TEST_F(SweepPlans, SpreadValuesOverALogarithm) {
  const SweepPlan plan = read(with(
      R"(axis = [{ key = "hand.stiffness", from = 30, to = 3000, count = 3, scale = "log" }])"));
  EXPECT_THAT(plan.axes[0].values, ElementsAre(30, DoubleNear(300, 1e-9), 3000));
  EXPECT_EQ(plan.axes[0].unit, "N/m");
}

TEST_F(SweepPlans, PutEveryChoiceIntoTheRun) {
  const SweepPlan plan = read(R"(scene = "table.toml"
seconds = 0.5
set = ["hand.damping = 3"]
measure = ["energy"]
axis = [
  { name = "ticks", cases = [ { name = "slow", set = ["loop.tick = 0.002"] },
                              { name = "free", set = ["loop.tick = 1e-4"], scene = "free.toml" } ] },
  { key = "scene.stiffness", values = [750] },
  { key = "device", values = ["omni.urdf"] },
  { key = "hand", values = ["touch.csv", "circle.csv"] },
  { key = "coupling.kind", values = ["predictive"] },
]
)");
  ASSERT_EQ(plan.points(), 4u);
  const RunPlan slow = run_of(plan, 1), free = run_of(plan, 2);
  EXPECT_EQ(slow.rows, 250u);
  EXPECT_EQ(slow.parameters.hand_damping, 3);
  EXPECT_EQ(slow.parameters.kind, CouplingKind::predictive);
  ASSERT_EQ(slow.document.scene.objects.size(), 1u);
  EXPECT_EQ(slow.document.scene.objects[0].material.stiffness, 750);
  EXPECT_EQ(slow.hand.source, "circle.csv");
  EXPECT_EQ(free.rows, 5000u);
  EXPECT_TRUE(free.document.scene.objects.empty());
  EXPECT_EQ(free.hand.source, "touch.csv");
}

TEST_F(SweepPlans, DrawSampledAxesTogetherWithinTheirRanges) {
  const SweepPlan plan = read(with(R"(samples = 16
seed = 4
axis = [ { key = "coupling.eta", from = 0.3, to = 0.9, sample = "sobol" },
         { key = "hand.stiffness", from = 30, to = 3000, scale = "log", sample = "sobol" },
         { key = "device.substeps", from = 2, to = 9, sample = "latin" },
         { key = "observer.alpha", values = [0.02, 0.03] } ])"));
  ASSERT_EQ(plan.points(), 32u);
  for (std::uint64_t i = 0; i < 32; ++i) {
    const SweepPoint point = point_of(plan, i);
    EXPECT_EQ(point.values[0], plan.axes[0].values[i % 16]);
    EXPECT_TRUE(point.values[0] >= 0.3 && point.values[0] <= 0.9);
    EXPECT_TRUE(point.values[1] >= 30 && point.values[1] <= 3000);
    EXPECT_EQ(point.values[2], std::round(point.values[2]));
    EXPECT_EQ(run_of(plan, i).parameters.substeps, static_cast<int>(point.values[2]));
  }
}

TEST_F(SweepPlans, SayWhatIsNotAllowedAndWhere) {
  const auto axis = [&](const std::string& keys) {
    return refusal(with("axis = [{ " + keys + " }]"));
  };
  EXPECT_THAT(axis("key = \"coupling.etta\", values = [1]"),
              AllOf(HasSubstr("plan.toml:3: axis.key"), HasSubstr("did you mean coupling.eta?")));
  EXPECT_THAT(axis("key = \"coupling.eta\", values = [0.5, 777]"),
              AllOf(HasSubstr("plan.toml:3"), HasSubstr("777")));
  EXPECT_THAT(axis("key = \"coupling.eta\", from = 0.9, to = 0.3, count = 3"),
              HasSubstr("more than 0.9"));
  EXPECT_THAT(axis("key = \"coupling.eta\", from = 0.3, to = 0.9"), HasSubstr("count: missing"));
  EXPECT_THAT(axis("key = \"coupling.eta\", values = [1], name = \"a/b\""), HasSubstr("letters"));
  EXPECT_THAT(axis("key = \"coupling.kind\", values = [\"propsed\"]"),
              HasSubstr("standard, proposed, predictive"));
  EXPECT_THAT(axis("key = \"coupling.eta\", from = 0.3, to = 0.9, sample = \"sobol\""),
              HasSubstr("samples: missing"));
  EXPECT_THAT(axis("key = \"device\", values = [\"none.urdf\"]"), HasSubstr("none.urdf"));
  EXPECT_THAT(refusal(with("axis = [{ key = \"coupling.eta\", values = [1] },"
                           "{ key = \"coupling.eta\", values = [1] }]")),
              HasSubstr("no other axis"));
  EXPECT_THAT(refusal("measure = [\"energi\"]\n"),
              AllOf(HasSubstr("energi"), HasSubstr("energy_highest")));
  EXPECT_THAT(refusal(with("hand = { at = [2, 0, 0] }\nseconds = 1")), HasSubstr("reaches"));
  EXPECT_THAT(refusal(with("set = [\"hand.damping = -1\"]")), HasSubstr("hand.damping"));
  EXPECT_THAT(refusal(with("[[stop]]\nmeasure = \"energy\"")), HasSubstr("above or below"));
  EXPECT_THAT(refusal(with("sets = 1")), HasSubstr("sets: no such key"));
}

TEST_F(SweepPlans, OfOlderProgramsHearThatRefinementLeftAndWhatToDo) {
  const std::string said = refusal(with(R"(axis = [ { key = "coupling.eta", values = [0.5, 1] } ]
[refine]
depth = 3)"));
  EXPECT_THAT(said, AllOf(HasSubstr("plan.toml:4: refine: "), HasSubstr("remove [refine]"),
                          HasSubstr("larger count")));
}

TEST_F(SweepPlans, AreKnownByTheirTextAndTheFilesTheyName) {
  std::ofstream(dir_ / "hand.csv") << "time_s,x_m,y_m,z_m\n0,0.19,0,0\n1,0.2,0,0\n";
  const std::string text = with("hand = \"hand.csv\"");
  const std::uint64_t key = read(text).key;
  EXPECT_EQ(read(text).key, key);
  EXPECT_NE(read(text + "# other\n").key, key);
  std::ofstream(dir_ / "hand.csv") << "time_s,x_m,y_m,z_m\n0,0.19,0,0\n1,0.201,0,0\n";
  EXPECT_NE(read(text).key, key);
}

TEST_F(SweepPlans, FollowTheHandAnotherWayInEveryRepeat) {
  const SweepPlan plan = read(with(R"(repeats = 4
axis = [ { key = "coupling.eta", values = [0.5, 1] } ])"));
  for (std::uint64_t a = 0; a < 4; ++a) {
    for (std::uint64_t b = a + 1; b < 4; ++b) {
      EXPECT_NE(run_of(plan, a).hand.position, run_of(plan, b).hand.position) << a << ", " << b;
    }
    EXPECT_EQ(run_of(plan, a).hand.position, run_of(plan, 4 + a).hand.position)
        << "the same in every point";
  }
}

TEST_F(SweepPlans, HaveNoLogarithmOfZeroOrLess) {
  const auto axis = [&](const std::string& from, const std::string& more) {
    return refusal(with("axis = [{ key = \"device.damping\", from = " + from +
                        ", to = 0.1, scale = \"log\"" + more + " }]"));
  };
  for (const char* more : {", count = 3", ", count = 3, sample = \"latin\""}) {
    EXPECT_THAT(axis("0", more), HasSubstr("above 0 on a log scale")) << more;
  }
  EXPECT_EQ(axis("0.001", ", count = 3"), "taken");
}

TEST_F(SweepPlans, SuggestTheFileThatWasMeant) {
  const std::string said = refusal(
      "device = \"omnii.urdf\"\nmeasure = [\"energy\"]\n"
      "axis = [ { key = \"coupling.eta\", values = [1] } ]\n");
  EXPECT_THAT(said, AllOf(HasSubstr("plan.toml: file \"omnii.urdf\" not found, neither beside the "
                                    "plan nor in "),
                          HasSubstr("assets/devices; did you mean omni.urdf?")));
}

TEST_F(SweepPlans, HaveNoMoreWorldsThanMemoryHolds) {
  const auto names = [](const char* ending) {
    std::string all;
    for (int i = 0; i < 32; ++i) all += fmt::format("{}\"{}{}\"", i > 0 ? ", " : "", i, ending);
    return all;
  };
  EXPECT_THAT(
      refusal("measure = [\"energy\"]\naxis = [ { key = \"scene\", values = [" + names(".toml") +
              "] }, { key = \"hand\", values = [" + names(".csv") + "] } ]\n"),
      HasSubstr("plan.toml: more than 1000 combinations of device, scene and hand"));
}

// A hand that jumps is at its start for one tick, whatever the tick is.
TEST_F(SweepPlans, LetAHandJumpInItsFirstTick) {
  const SweepPlan plan = read(R"(scene = "free.toml"
hand = { at = [0.19, 0, 0], jump = [0.001, 0, -0.002] }
seconds = 0.1
seed = 5
measure = ["energy"]
axis = [{ key = "loop.tick", values = [0.001, 0.004] }]
)");
  for (std::uint64_t i = 0; i < 2; ++i) {
    const RunPlan run = run_of(plan, i);
    const double tick = run.parameters.tick;
    EXPECT_EQ(tick, plan.axes[0].values[i]);
    EXPECT_EQ(run.rows, i == 0 ? 100u : 25u);
    EXPECT_EQ(run.seed, 5u);
    EXPECT_EQ(run.hand.source, "a jump");
    EXPECT_EQ(run.hand.sample(0, tick), Vec3(0.19, 0, 0));
    for (const std::size_t k : {1, 2, 20}) {
      EXPECT_LT((run.hand.sample(k, tick) - Vec3(0.191, 0, -0.002)).norm(), 1e-15) << k;
      EXPECT_EQ(run.hand.grip_sample(k, tick), 1);
    }
  }
}

TEST_F(SweepPlans, MakeRandomArmsBySeedAndTapAsTheySay) {
  const SweepPlan plan = read(R"(hand = { tap = 2 }
seconds = 0.25
measure = ["energy"]
axis = [ { key = "arm.seed", values = [0, 1, 2] }, { key = "scene.stiffness", values = [150] } ]
)");
  for (std::uint64_t i = 0; i < 3; ++i) {
    const RunPlan run = run_of(plan, i);
    EXPECT_EQ(run.arm.dof(), 3) << "where no axis says";
    EXPECT_EQ(run.arm.urdf, run_of(plan, i).arm.urdf);
    EXPECT_NE(run.arm.urdf, run_of(plan, (i + 1) % 3).arm.urdf);
    EXPECT_THAT(run.arm.urdf, AllOf(HasSubstr("random arm: 3 joints, 0.15"),
                                    HasSubstr(fmt::format(" kg, seed {} -->", i))));
    EXPECT_EQ(run.document.scene.objects.front().material.stiffness, 150);
  }
}

TEST_F(SweepPlans, MeetTheirLimits) {
  const auto met = [](std::optional<double> above, std::optional<double> below, double value) {
    return SweepLimit{find_measure("energy"), above, below}.met(value);
  };
  EXPECT_TRUE(met({}, {}, 1) && !met({}, {}, 0)) << "yes";
  EXPECT_TRUE(met(2, {}, 2.5) && !met(2, {}, 2) && !met(2, {}, 1));
  EXPECT_TRUE(met({}, 2, 1.5) && !met({}, 2, 2) && !met({}, 2, 3));
  EXPECT_TRUE(met(1, 2, 1.5) && !met(1, 2, 0.5) && !met(1, 2, 2.5)) << "between";
  EXPECT_FALSE(met(1, {}, std::nan("")));
}

TEST_F(SweepPlans, NumberAPointAsTheyFindIt) {
  const SweepPlan plan = read(with(R"(repeats = 2
samples = 3
axis = [ { key = "coupling.eta", values = [0.5, 1] },
         { key = "hand.damping", from = 1, to = 2, sample = "random" },
         { key = "hand.stiffness", values = [100, 200, 300, 400] } ])"));
  ASSERT_EQ(plan.points(), 48u);
  for (std::uint64_t i = 0; i < 48; ++i) {
    const SweepPoint point = point_of(plan, i);
    EXPECT_EQ(point.place[0], i / 24);
    EXPECT_EQ(point.place[1], i / 2 % 3) << "the sample";
    EXPECT_EQ(point.place[2], i / 6 % 4);
    EXPECT_EQ(point.repeat, i % 2);
    EXPECT_EQ(number_of(plan, point.place, i / 2 % 3, i % 2), i);
  }
}

}  // namespace
}  // namespace limpid
