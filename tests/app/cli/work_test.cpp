// Commands that work through plans: sweeps, experiments, stories, devices and what is beside them.
#include <fcntl.h>

#include <nlohmann/json.hpp>
#include <set>

#include "app/experiments/experiment.h"
#include "tests/app/cli/said.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::lines_of;
using test::Said;
using test::text_of;
using testing::ContainsRegex;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class Work : public test::Program {
 protected:
  // Four runs of 20 ms.
  std::string plan(const std::string& more = "") {
    write("plan.toml", R"(title = "Four"
scene = "free.toml"
hand = { at = [0.19, 0, 0], jump = [2e-4, 2e-4, 2e-4] }
seconds = 0.02
measure = ["stable", "human_rms"]
)" + more + R"(
[[axis]]
key = "coupling.kind"
values = ["proposed", "predictive"]
[[axis]]
key = "coupling.eta"
values = [0.5, 1]
)");
    return "plan.toml";
  }
};

TEST_F(Work, OfARunSaysThatItAsksNothing) {
  EXPECT_EQ(run({"run", "--yes", "--duration", "0.02"}).err,
            "limpid: note: --yes changes nothing here: only --live asks a question before it "
            "begins\n");
}

TEST_F(Work, OfASweepIsATableAndAFigure) {
  EXPECT_EQ(done({"sweep", plan(), "--out", "swept", "--threads", "2", "--csv"}),
            "4 of 4 points in swept/table.h5\n");
  const std::vector<std::string> lines = lines_of(text_of("swept/table.csv"));
  EXPECT_GE(lines.size(), 5u);
  EXPECT_THAT(text_of("swept/figure.svg"), HasSubstr("<svg"));
  EXPECT_EQ(done({"sweep", "plan.toml", "--out", "swept", "--gather"}),
            "4 of 4 points in swept/table.h5\n");
  for (const char* command : {"info", "check"}) {
    EXPECT_THAT(refused({command, "swept/table.h5"}),
                ContainsRegex("swept/table.h5: a sweep's table.*; `limpid play swept/table.h5`"));
  }
}

TEST_F(Work, OfASweepCanBeSharedOut) {
  const std::string file = plan();
  EXPECT_THAT(done({"sweep", file, "--out", "swept", "--shard", "1/2", "--threads", "1"}),
              ContainsRegex("^part 1/2 is done; [0-4] of 4 points are in swept; `limpid sweep "
                            "plan.toml --out swept --gather` makes the table"));
  EXPECT_FALSE(fs::exists("swept/table.h5"));
  const Said half = run({"sweep", file, "--out", "swept", "--gather"});
  EXPECT_EQ(half.status, 1) << "it is not complete";
  EXPECT_THAT(done({"sweep", file, "--out", "swept", "--shard", "2/2", "--threads", "1"}),
              HasSubstr("part 2/2 is done; 4 of 4 points are in swept; "));
  EXPECT_EQ(done({"sweep", file, "--out", "swept", "--gather"}),
            "4 of 4 points in swept/table.h5\n");
  for (const char* wrong : {"0/2", "3/2", "1/0", "1", "1/2x", "a/b", "-1/2", "1/100000"}) {
    EXPECT_THAT(refused({"sweep", file, "--out", "other", "--shard", wrong}),
                HasSubstr("allowed: I/N with I from 1 to N"));
  }
  EXPECT_EQ(run({"sweep", file, "--out", "last", "--shard", "1/99999"}).status, 0);
}

TEST_F(Work, OfASweepRunsOnePointAgain) {
  const std::string file = plan();
  const std::string shown = std::getenv("DISPLAY") != nullptr ? std::getenv("DISPLAY") : "";
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  const std::string said = done({"sweep", file, "--out", "swept", "--open", "3"});
  EXPECT_THAT(said, HasSubstr("recorded in swept/points/"));
  const std::string recorded = said.substr(said.find("swept/points/"));
  EXPECT_THAT(done({"info", recorded.substr(0, recorded.find('\n'))}),
              HasSubstr("predictive, eta 1\n"));
  EXPECT_THAT(refused({"sweep", file, "--out", "swept", "--open", "4"}),
              HasSubstr("--open 4: is not allowed; allowed: the number of a point, 0 to 3"));
  EXPECT_THAT(refused({"sweep", file, "--out", "swept", "--open", "-1"}),
              HasSubstr("whole number"));
  EXPECT_EQ(run({"sweep", file, "--out", "swept", "--open", "3", "--csv"}).status, 2);
  EXPECT_EQ(run({"sweep", file, "--out", "swept", "--open", "3", "--gather"}).status, 2);
  if (!shown.empty()) setenv("DISPLAY", shown.c_str(), 1);
}

TEST_F(Work, OfASweepNeedsWhatBelongsTogether) {
  const std::string file = plan();
  EXPECT_THAT(refused({"sweep", file, "--out", "o", "--mpi"}),
              HasSubstr("--mpi: this process is not one of many"));
  for (const auto& [one, other] : {std::pair("--mpi", "--slurm"), std::pair("--gather", "--mpi")}) {
    EXPECT_EQ(run({"sweep", file, "--out", "o", one, other}).status, 2);
  }
  EXPECT_EQ(run({"sweep", file, "--out", "o", "--tasks", "3"}).status, 2) << "of --slurm";
  EXPECT_EQ(run({"sweep", file, "--out", "o", "--threads", "0"}).status, 2);
  EXPECT_EQ(run({"sweep", file, "--out", "o", "--threads", "1025"}).status, 2);
  write("file", "mine");
  EXPECT_THAT(refused({"sweep", file, "--out", "file"}), HasSubstr("--out file: Not a directory"));
  EXPECT_THAT(refused({"sweep", file, "--out", "file/x"}), HasSubstr("Not a directory"));
  const std::string help = done({"sweep", "--help"});
  EXPECT_THAT(help, ContainsRegex("\n  human_rms +N m +"));
}

TEST_F(Work, OfAnExperimentLeavesAReport) {
  const std::string said = done({"experiment", "inertia", "--out", "found"});
  EXPECT_THAT(
      said,
      StartsWith("inertia: passed\n  ok    rms human torque at eta = 0.6: relative deviation"));
  EXPECT_THAT(said, HasSubstr(" <= 0.1\n"));
  EXPECT_THAT(said, EndsWith("report: found/report.html\n"));
  EXPECT_THAT(text_of("found/report.html"), HasSubstr("1 of 1 experiments passed"));
  for (const char* end : {"csv", "png", "svg", "json"}) {
    EXPECT_TRUE(fs::exists(std::string("found/inertia.") + end)) << end;
  }
}

TEST_F(Work, OfAnExperimentHasItsOwnWorld) {
  for (const auto& [option, value] :
       {std::pair("--scene", "table.toml"), std::pair("--config", "x"),
        std::pair("--set", "coupling.eta=1"), std::pair("--coupling", "tank"),
        std::pair("--eta", "1"), std::pair("--alpha", "1")}) {
    EXPECT_THAT(refused({"experiment", "inertia", "--out", "o", option, value}),
                HasSubstr(std::string(option) + ": only together with --live"))
        << option;
  }
  const std::string unknown = refused({"experiment", "banana", "--out", "o"});
  EXPECT_THAT(unknown, HasSubstr("\"banana\" is not an experiment; allowed: all"));
  for (const Experiment& e : experiments()) EXPECT_THAT(unknown, HasSubstr(e.name));
  EXPECT_THAT(refused({"experiment", "inertia"}), HasSubstr("--out"));
  EXPECT_EQ(run({"experiment", "inertia", "--out", "o", "--threads", "257"}).status, 2);
  EXPECT_FALSE(fs::exists("o"));
  EXPECT_THAT(refused({"experiment", "banana", "--out", "o", "--live", "--yes"}),
              HasSubstr("\"banana\": not together with --live"));
}

TEST_F(Work, OfAnExperimentTakesAnArm) {
  const std::string said = done({"experiment", "inertia", "--device", "touch.urdf", "--readings",
                                 "--set", "coupling.k_vc=10", "--out", "found"});
  EXPECT_THAT(said, StartsWith("inertia, on touch with its readings and coupling.k_vc=10: measured"
                               "\n  ----  rms human torque at eta = 0.6: relative deviation"));
  EXPECT_THAT(said, HasSubstr(" (missed; promised for the built-in arm: <= 0.1)\n"));
  EXPECT_THAT(done({"experiment", "inertia", "--device", "omni.urdf", "--out", "same"}),
              StartsWith("inertia: passed\n"))
      << "the built-in arm by its file";
}

TEST_F(Work, OfAnExperimentSaysWhichArmItDoesNotTake) {
  for (const auto& [words, why] :
       {std::pair(std::vector<std::string>{"robust", "--device", "touch.urdf"},
                  "robust: accepts no other arm or settings, because it has arms of its own: an "
                  "ideal arm and a Touch"),
        {{"zwidth", "--device", "touch.urdf", "--readings"},
         "zwidth: takes no readings of an arm's file (--readings)"},
        {{"passivity", "--device", "planar2.urdf"}, "needs an arm of 3 joints; planar2 has 2"},
        {{"all", "--device", "planar2.urdf"}, "needs an arm of 3 joints; planar2 has 2"},
        {{"coordination", "--device", "omega.urdf"},
         "the same joint names and the same motion as the built-in arm"},
        {{"inertia", "--readings"}, "--readings: the file of the arm omni has neither"},
        {{"inertia", "--device", "none.urdf"}, "none.urdf"},
        {{"inertia", "--device", "touch.urdf", "--set", "coupling.eta=2"}, "--set: only together"},
        {{"inertia", "--live", "--yes", "--readings"}, "--readings: not together with --live"},
        {{"inertia", "--live", "--yes", "--seed", "3"}, "--seed: not together with --live"},
        {{"inertia", "--live", "--yes", "--threads", "1"},
         "--threads: not together with --live"}}) {
    std::vector<std::string> all{"experiment"};
    all.insert(all.end(), words.begin(), words.end());
    all.insert(all.end(), {"--out", "o"});
    EXPECT_THAT(refused(all), HasSubstr(why));
  }
  EXPECT_FALSE(fs::exists("o"));
}

constexpr const char* kStory = R"(title = "Short"
scene = "table.toml"
seconds = 0.4
[[step]]
time = 0
caption = "Two laws."
first = ["coupling.kind = standard"]
twin = ["coupling.kind = predictive"]
hand = [[0, 0.19, 0, 0], [0.1, 0.19, 0, 0.002]]
[[step]]
time = 0.2
caption = "Later."
)";

TEST_F(Work, OfAStoryTellsItsSteps) {
  write("short.toml", kStory);
  EXPECT_EQ(done({"story", "short.toml", "--check"}),
            "  0.0 to   0.2 s  Two laws.\n  0.2 to   0.4 s  Later.\n");
  const std::string told = done({"story", "short.toml", "--record", "short.h5"});
  EXPECT_THAT(told, StartsWith("0.0 to 0.2 s  Two laws.\n    standard "));
  EXPECT_THAT(told, ContainsRegex("\n    predictive +\\|x_E\\| up to [0-9.e-]+ mrad, \\|f1\\| "));
  EXPECT_THAT(told, HasSubstr("\n0.2 to 0.4 s  Later.\n"));
  EXPECT_THAT(told, EndsWith("recorded 400 ticks of 2 runs in short.h5\n"));
  EXPECT_THAT(done({"info", "short.h5"}), HasSubstr("story                    Short, 2 steps\n"));
  EXPECT_THAT(refused({"story", "short.toml", "--record", "short.h5"}), HasSubstr("short.h5"));
  EXPECT_THAT(done({"story", "short.toml", "--record", "short.h5", "--force"}),
              HasSubstr("400 ticks"));
  EXPECT_GT(lines_of(done({"story", "--check"})).size(), 5u) << "the one that comes along";
}

TEST_F(Work, OfAVideoIsAskedForAsItIsSaid) {
  done({"play", "table.h5", "--video", "out.mp4"});
  EXPECT_THAT(video().of, EndsWith("sessions/table.h5"));
  const VideoOptions usual = video().options;
  EXPECT_EQ(usual.out, "out.mp4");
  EXPECT_EQ(usual.size, "");
  EXPECT_EQ(usual.fps, std::nullopt);
  EXPECT_EQ(usual.from, 0);
  EXPECT_EQ(usual.to, std::nullopt);
  EXPECT_EQ(usual.speed, 1);
  EXPECT_TRUE(usual.plots);
  EXPECT_FALSE(usual.overlaid || usual.force || usual.print_progress);
  EXPECT_EQ(video().text_scale, 0);
  done({"play",       "table.h5", "--video",    "out.gif",    "--size",  "640x480",
        "--fps",      "20",       "--from",     "1",          "--to",    "2.5",
        "--speed",    "0.5",      "--no-plots", "--overlaid", "--force", "--print-progress",
        "--ui-scale", "1.5"});
  const VideoOptions asked = video().options;
  EXPECT_EQ(asked.out, "out.gif");
  EXPECT_EQ(asked.size, "640x480");
  EXPECT_EQ(asked.fps, 20);
  EXPECT_EQ(asked.from, 1);
  EXPECT_EQ(asked.to, 2.5);
  EXPECT_EQ(asked.speed, 0.5);
  EXPECT_FALSE(asked.plots);
  EXPECT_TRUE(asked.overlaid && asked.force && asked.print_progress);
  EXPECT_EQ(video().text_scale, 1.5);
  done({"--ui-scale", "2", "play", "table.h5", "--video", "out.mp4"});
  EXPECT_EQ(video().text_scale, 2) << "also before the command";
  done({"story", "first.toml", "--video", "story.mp4", "--fps", "10"});
  EXPECT_THAT(video().of, EndsWith("stories/first.toml"));
  EXPECT_EQ(video().options.fps, 10);
}

TEST_F(Work, OfAVideoShowsTheSessionAsItIs) {
  for (const auto& [option, value] :
       {std::pair("--device", "omni.urdf"), std::pair("--scene", "table.toml"),
        std::pair("--eta", "1")}) {
    EXPECT_THAT(refused({"play", "table.h5", "--video", "o.mp4", option, value}),
                HasSubstr("--video: shows the session as it was recorded"))
        << option;
  }
  EXPECT_THAT(refused({"play", "table.h5", "--video", "o.mp4", "--listen", "x"}),
              HasSubstr("--listen: is an option of the window"));
  EXPECT_THAT(refused({"play", "table.h5", "--video", "o.mp4", "--print-state"}),
              HasSubstr("--print-state: is an option of the window"));
  EXPECT_EQ(run({"play", "table.h5", "--fps", "20"}).status, 2) << "of --video";
  EXPECT_EQ(run({"play", "table.h5", "--video", "o.mp4", "--speed", "0.009"}).status, 2);
  EXPECT_EQ(run({"play", "table.h5", "--video", "o.mp4", "--speed", "101"}).status, 2);
  EXPECT_EQ(run({"story", "first.toml", "--video", "o.mp4", "--check"}).status, 2);
}

TEST_F(Work, OfTheWindowIsCheckedBeforeItOpens) {
  EXPECT_THAT(refused({"--until-eof"}), HasSubstr("--until-eof: needs --listen"));
  EXPECT_THAT(refused({"none.txt"}), HasSubstr("\"none.txt\": neither a command nor a file"));
  EXPECT_THAT(refused({"--scene", "none.toml"}), HasSubstr("none.toml"));
  EXPECT_THAT(refused({"--eta", "many"}), HasSubstr("coupling.eta"));
  EXPECT_EQ(run({"--ui-scale", "0.4"}).status, 2);
  EXPECT_EQ(run({"--ui-scale", "4.1"}).status, 2);
  EXPECT_THAT(refused({"--listen", "a/b"}), HasSubstr("a/b"));
  EXPECT_THAT(refused({"play", "none.h5"}), HasSubstr("none.h5"));
}

TEST_F(Work, OfDevicesListsThemWithTheVirtualArm) {
  const json told = json::parse(done({"devices", "--json"}));
  const std::string text = done({"devices"});
  EXPECT_THAT(text, StartsWith("virtual arm\n  built in; any URDF chain of 1 to 32 joints"));
  EXPECT_EQ(told["devices"].empty(),
            text.find("no haptic device is plugged in\n") != std::string::npos);
  EXPECT_THAT(refused({"devices", "raw:1"}),
              HasSubstr("raw:1: a device can be named only together with --arm"));
  EXPECT_EQ(run({"devices", "--tip", "x"}).status, 2) << "of --arm";
  EXPECT_EQ(run({"devices", "--json", "--arm", "x"}).status, 2);
  EXPECT_THAT(refused({"devices", "--arm", "omni.urdf", "raw:1"}),
              HasSubstr("raw:1: is not connected"));
}

TEST_F(Work, OfTheDoctorEndsWithTheWorstThatItFound) {
  const Said said = run({"doctor", "--json"});
  const json told = json::parse(said.out);
  const std::vector<std::string> states{"ok", "better", "broken"};
  long worst = 0;
  std::set<std::string> areas;
  for (const json& finding : told["findings"]) {
    const auto at = std::ranges::find(states, finding["state"].get<std::string>()) - states.begin();
    ASSERT_LT(at, 3);
    worst = std::max(worst, static_cast<long>(at));
    areas.insert(finding["area"].get<std::string>());
    EXPECT_FALSE(finding["what"].get<std::string>().empty());
    EXPECT_FALSE(finding["found"].get<std::string>().empty());
    EXPECT_TRUE(at == 0 || !finding["cost"].get<std::string>().empty()) << finding;
  }
  EXPECT_EQ(areas.size(), 4u) << "real time, devices, picture, files";
  EXPECT_EQ(told["state"], states[static_cast<std::size_t>(worst)]);
  EXPECT_EQ(said.status, worst);
  const Said text = run({"doctor"});
  for (const json& finding : told["findings"]) {
    EXPECT_THAT(text.out, HasSubstr(finding["what"].get<std::string>()));
    EXPECT_THAT(text.out, HasSubstr(finding["cost"].get<std::string>()));
    if (finding["mend"] != "") {
      EXPECT_THAT(text.out, HasSubstr("-> " + finding["mend"].get<std::string>()));
    }
  }
  constexpr const char* kEnds[] = {"all is well\n", "all works; some things can be improved\n",
                                   "something does not work\n"};
  EXPECT_THAT(text.out, EndsWith(std::string("\n\n") + kEnds[text.status]));
}

TEST_F(Work, OfIdentifyingNeedsADeviceAndAFolder) {
  EXPECT_THAT(refused({"identify"}), HasSubstr("--out is required"));
  EXPECT_THAT(
      refused({"identify", "--out", "o"}),
      HasSubstr("no device is chosen; `limpid devices` lists the devices' ids, and \"simulated\""));
  for (const char* wrong : {"0,0", "0,0,-30", "0,0,-9.81,1", "a,b,c", "0,0,nan", "0,0,-9.81x"}) {
    EXPECT_THAT(refused({"identify", "simulated", "--out", "o", "--gravity", wrong}),
                HasSubstr("needed: none, or X,Y,Z in m/s^2"));
  }
  EXPECT_THAT(refused({"identify", "simulated", "--out", "o", "--scene", "table.toml"}),
              HasSubstr("\"--scene table.toml\": not expected here"));
  EXPECT_THAT(done({"identify", "--help"}), HasSubstr("REQUIRED, except with --forget"));
  EXPECT_THAT(refused({"identify", "simulated", "--out", "o", "--masses-right"}),
              HasSubstr("the masses of the simulated device differ"));
  EXPECT_THAT(refused({"identify", "--out", "o", "--yes", "--load", "0.1"}),
              HasSubstr("--yes: not together with --load: a person must be asked"));
  EXPECT_EQ(run({"identify", "--out", "o", "--range", "0.04"}).status, 2);
  EXPECT_EQ(run({"identify", "--out", "o", "--range", "0.91"}).status, 2);
  EXPECT_EQ(run({"identify", "--out", "o", "--torque", "1.01"}).status, 2);
}

// The device is unlike its file: told what it is, a coupling is nearer to what it promises.
TEST_F(Work, OfIdentifyingFindsOutASimulatedDevice) {
  const std::string said = done({"identify", "simulated", "--out", "o", "--load", "0.05"});
  EXPECT_THAT(said, StartsWith("joint"));
  EXPECT_THAT(said, ContainsRegex("\ndelay +[0-9.]+ \\+- [0-9.]+ ms"));
  double gives = 0, off = 0, drawn = 0;
  const std::size_t motors = said.find("\nmotors ");
  ASSERT_NE(motors, std::string::npos);
  ASSERT_EQ(std::sscanf(said.c_str() + motors,
                        "\nmotors give %lf +- %lf times the commanded torque\n%lf is the true",
                        &gives, &off, &drawn),
            3)
      << said;
  EXPECT_NEAR(gives, drawn, std::max(4 * off, 0.01));
  EXPECT_THAT(said, EndsWith("\narm: o/identified.urdf\nreport: o/report.html\n"));
  const json found = json::parse(text_of("o/identified.json"));
  for (const char* law : {"proposed", "predictive"}) {
    const json& when = found.at("rehearsal").at(law);
    EXPECT_LT(when.at("identified").at("off"), when.at("file").at("off")) << law;
  }
  EXPECT_THAT(found.at("provenance").get<std::string>(), HasSubstr(", seed 1, "));
  EXPECT_THAT(text_of("o/identified.urdf"), HasSubstr(", seed 1, "));
  EXPECT_THAT(text_of("o/report.html"), HasSubstr("Seed of the simulated device: 1."));
  EXPECT_GT(lines_of(text_of("o/motion.csv")).size(), 1000u);
  EXPECT_TRUE(fs::exists("o/motion-with-load.csv"));
  EXPECT_THAT(run({"check", "o/identified.urdf"}).out, HasSubstr("delay of"));
}

TEST_F(Work, OfIdentifyingSaysHowToStayWithinTheLimits) {
  const Said said = run(
      {"identify", "simulated", "--out", "o", "--range", "0.9", "--torque", "1", "--seed", "3"});
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("moves too fast); try a smaller --range or --torque, or another "
                                  "--seed; o/motion.csv contains"));
}

TEST_F(Work, OfIdentifyingForgetsOnlyWhatIsChosen) {
  EXPECT_THAT(done({"identify", "--forget"}), HasSubstr("forgotten"));
}

TEST_F(Work, OfServingEndsWithItsInput) {
  const int before = dup(STDIN_FILENO), nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  const Said said = run({"serve", "here", "--until-eof"});
  dup2(before, STDIN_FILENO);
  close(before);
  close(nothing);
  EXPECT_EQ(said.status, 0) << said.err;
  EXPECT_THAT(said.out, ContainsRegex("^limpid listens on .*/home/limpid/here.control\n$"));
  EXPECT_THAT(refused({"serve", "a/b", "--until-eof"}), HasSubstr("a/b"));
  EXPECT_THAT(refused({"serve", "--live", "--hand", "touch.csv"}),
              HasSubstr("--hand: not together with --live"));
}

}  // namespace
}  // namespace limpid
