// `check` and `analyze` as wholes: each line has its place, its unit and its number.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/app/cli/said.h"

namespace limpid {
namespace {

using nlohmann::json;
using test::lines_of;
using test::Said;
using testing::AllOf;
using testing::Contains;
using testing::ContainsRegex;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class CheckAndAnalyze : public test::Program {
 protected:
  static json told(std::vector<std::string> words) {
    words.emplace_back("--json");
    const Said said = run(words);
    EXPECT_LT(said.status, 2) << said.err;
    return json::parse(said.out, nullptr, false);
  }
  static std::string line_with(const std::string& text, const std::string& begin) {
    for (const std::string& line : lines_of(text)) {
      if (line.starts_with(begin)) return line;
    }
    ADD_FAILURE() << "no line begins with " << begin << " in " << text;
    return {};
  }
};

// A paddle of one joint about z; its link has two shapes, and its tip is `away` from the axis.
std::string paddle_text(const char* away, const char* dynamics = "damping=\"0.002\"") {
  return fmt::format(R"(<robot name="paddle"><link name="base"/>
<joint name="hinge" type="revolute"><parent link="base"/><child link="blade"/><axis xyz="0 0 1"/>
<limit lower="-0.5" upper="0.75" effort="0.4" velocity="10"/><dynamics {}/></joint>
<link name="blade"><inertial><origin xyz="0.05 0 0"/><mass value="0.2"/>
<inertia ixx="1e-5" iyy="2e-4" izz="2e-4" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><box size="0.1 0.01 0.01"/></geometry></visual>
<visual><origin xyz="0.1 0 0"/><geometry><sphere radius="0.01"/></geometry></visual></link>
<joint name="t" type="fixed"><parent link="blade"/><child link="tip"/><origin xyz="{} 0 0.02"/>
</joint><link name="tip"/></robot>)",
                     dynamics, away);
}

// About the hinge the link has 2e-4 kg m^2 and, by Steiner, 0.2 kg at 5 cm besides.
TEST_F(CheckAndAnalyze, OfAnArmHaveItsWholeReport) {
  write("paddle.urdf", paddle_text("0.12"));
  const Said said = run({"check", "paddle.urdf"});
  ASSERT_LT(said.status, 2) << said.err;
  const auto lines = lines_of(said.out);
  ASSERT_GE(lines.size(), 8u);
  EXPECT_EQ(lines[0], "arm          paddle, 1 joints to 'tip'");
  EXPECT_EQ(lines[1],
            fmt::format("reach        {:.3g} m from the origin of joint 'hinge' to 'tip', "
                        "moving mass 0.2 kg",
                        std::hypot(0.12, 0.02)));
  EXPECT_EQ(lines[2], "picture      2 shapes");
  EXPECT_EQ(lines[3], fmt::format("  {:<26} {:>18} {:>12} {:>14} {:>10} {:>15}", "joint", "range",
                                  "effort", "damping", "link mass", "inertia at rest"));
  EXPECT_EQ(lines[4],
            fmt::format("  {:<26} {:>18} {:>7.3g} {:<4} {:>7.2g} {:<6} {:>7.3g} kg {:>8.2g} {}",
                        "hinge", "-0.5 to 0.75 rad", 0.4, "N m", 0.002, "N m s", 0.2,
                        2e-4 + 0.2 * 0.05 * 0.05, "kg m^2"));
  EXPECT_THAT(lines[5], StartsWith("gains        "));
  EXPECT_EQ(lines[6],
            "             for inertia and damping as in the arm's file, no delay (assumed)");
  EXPECT_THAT(said.out, HasSubstr("force at a real device's tip: 10 N\n"));
  EXPECT_THAT(said.out, ContainsRegex("limits       torque as in the column effort, reached in "
                                      "[0-9]+ ms at the earliest; "));
  // The eta is that of `analyze`, with two decimals.
  const json analyzed = told({"analyze", "--device", "paddle.urdf"});
  EXPECT_THAT(said.out, HasSubstr(fmt::format("condition (3) is met; by equation (25) the proposed "
                                              "law is passive at an eta of {:.2f} or above\n",
                                              analyzed["eta_min"].get<double>())));
  write("free.urdf", paddle_text("0.12"));
  std::string endless = paddle_text("0.12");
  endless.replace(endless.find("revolute"), 8, "continuous");
  write("endless.urdf", endless);
  EXPECT_THAT(run({"check", "endless.urdf"}).out, ContainsRegex("\n  hinge +no limits +0.4 N m "));
}

TEST_F(CheckAndAnalyze, OfAnArmWithReadingsSayWhatItsFileHas) {
  const std::string plain = run({"check", "touch.urdf"}).out;
  EXPECT_THAT(
      plain,
      HasSubstr(" or above\nreadings     the arm's file says encoder steps of 0.419 mrad and a "
                "delay of 1 ms; the settings say exact encoders and no delay; "
                "--readings takes the values of the arm's file\n"));
  const std::string with = run({"check", "touch.urdf", "--readings"}).out;
  EXPECT_THAT(with, Not(HasSubstr("\nreadings ")));
  EXPECT_THAT(with, HasSubstr("a delay of 1.0 ms as in the settings\n"));
  EXPECT_THAT(done({"analyze", "--device", "touch.urdf"}),
              HasSubstr("\nreadings                   the arm's file says encoder steps of 0.419 "
                        "mrad and a delay of 1 ms; "));
  EXPECT_THAT(done({"analyze", "--device", "touch.urdf", "--readings"}),
              Not(HasSubstr("\nreadings ")));
  for (const std::vector<std::string>& words : {std::vector<std::string>{"check", "omni.urdf"},
                                                {"check", "table.toml"},
                                                {"analyze"},
                                                {"run", "--duration", "0.01"}}) {
    std::vector<std::string> none = words;
    none.emplace_back("--readings");
    EXPECT_THAT(refused(none), HasSubstr("--readings: the file of the arm omni has neither"));
  }
  const json late = told({"check", "touch.urdf", "--readings", "--coupling", "standard", "--set",
                          "coupling.k_vc=5000"});
  ASSERT_EQ(late["warnings"].size(), 1u) << late;
  EXPECT_THAT(
      late["warnings"][0].get<std::string>(),
      AllOf(StartsWith("condition (3) is not met with these settings: reduce coupling.k_vc"),
            HasSubstr("; gains that fulfil condition (3) with this delay: coupling.")));
  const json soon = told({"check", "touch.urdf", "--set", "coupling.k_vc=5000"});
  ASSERT_EQ(soon["warnings"].size(), 1u) << soon;
  EXPECT_THAT(soon["warnings"][0].get<std::string>(), EndsWith("Limpid then fits both to the arm"));
}

TEST_F(CheckAndAnalyze, OfASceneMeasureItsModels) {
  write("block.obj",
        "v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nv 0 0 4\nv 2 0 4\nv 2 3 4\nv 0 3 4\n"
        "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  write("scene.toml",
        "title = \"Block\"\n[[mesh]]\nname = \"block\"\nfile = \"block.obj\"\nscale = 0.01\n"
        "position = [0.19, -0.015, -0.08]\nstiffness = 500.0\n");
  const std::string said = run({"check", "scene.toml"}).out;
  EXPECT_THAT(said, StartsWith("scene        Block\nto touch     planes 0, spheres 0, boxes 0, "
                               "cylinders 0, capsules 0, models 1, stops of joints 0\n"
                               "model        block, 12 triangles, 0.02 x "));
  EXPECT_THAT(said, ContainsRegex("0.02 x (0.03 x 0.04|0.04 x 0.03) m\n"));
}

// A wall is too stiff for one law and not for another.
TEST_F(CheckAndAnalyze, OfASceneJudgeWallsByTheLawThatIsNamed) {
  const auto wall = [](const char* law) {
    return told({"analyze", "--coupling", law, "--no-trial"})["tip"][law]["wall"].get<double>();
  };
  const double usual = wall("predictive"), other = wall("standard");
  ASSERT_GT(std::abs(std::log(usual / other)), 0.05);
  write("scene.toml", fmt::format("[[plane]]\nname = \"wall\"\npoint = [0.2, 0.0, -0.04]\nnormal = "
                                  "[0.0, 0.0, 1.0]\nstiffness = {:.1f}\n",
                                  std::sqrt(usual * other)));
  const auto too_stiff = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"check", "scene.toml"});
    return run(more).out.find("is stiffer than") != std::string::npos;
  };
  EXPECT_EQ(too_stiff({}), usual < other);
  EXPECT_EQ(too_stiff({"--coupling", "predictive"}), usual < other);
  EXPECT_EQ(too_stiff({"--coupling", "standard"}), other < usual);
}

TEST_F(CheckAndAnalyze, OfPlansAndStoriesCountTheirParts) {
  write("plan.toml", R"(title = "Four"
scene = "free.toml"
hand = { at = [0.19, 0, 0], jump = [2e-4, 2e-4, 2e-4] }
seconds = 0.02
measure = ["stable"]
[[axis]]
key = "coupling.kind"
values = ["proposed", "predictive"]
[[axis]]
key = "coupling.eta"
values = [0.5, 1, 2]
)");
  EXPECT_EQ(done({"check", "plan.toml"}),
            "sweep        Four: 6 points\n"
            "             kind, 2 values\n"
            "             eta, 3 values\n"
            "fine\n");
  const json plan = told({"check", "plan.toml"});
  EXPECT_EQ(plan["facts"].size(), 3u);
  EXPECT_EQ(plan["warnings"], json::array());
  EXPECT_THAT(plan["provenance"].get<std::string>(), StartsWith("limpid "));
  write("story.toml",
        "title = \"Short\"\nscene = \"table.toml\"\nseconds = 0.4\n[[step]]\ntime = "
        "0\ncaption = \"One.\"\nhand = [[0, 0.19, 0, 0], [0.1, 0.19, 0, 0.002]]\n");
  EXPECT_EQ(done({"check", "story.toml"}),
            "story        Short: 1 steps, 0.4 s, 2 runs with the same hand\nfine\n");
  for (const auto& [file, kind] : {std::pair("plan.toml", "a sweep"), {"story.toml", "a story"}}) {
    for (const auto& [option, value] : {std::pair("--device", "omni.urdf"),
                                        {"--tip", "x"},
                                        {"--eta", "1"},
                                        {"--config", "x.toml"}}) {
      EXPECT_THAT(
          refused({"check", file, option, value}),
          AllOf(HasSubstr(option),
                HasSubstr(fmt::format(": not for {}, because the file itself says", kind))));
    }
    EXPECT_THAT(refused({"check", file, "--readings"}), HasSubstr("--readings: not for "));
  }
  write("hand.csv", "time_s,x_m,y_m,z_m\n0,0.19,0,0\n1.5,0.19,0.02,-0.03\n");
  EXPECT_EQ(done({"check", "hand.csv", "--device", "touch.urdf"}),
            "hand         2 samples, 1.5 s, in a space of 0 x 20 x 30 mm\nfine\n");
  write("fast.csv", "time_s,x_m,y_m,z_m\n0,0.19,0,0\n1,0.19,0,0.01\n1.01,0.1,0,0.01\n");
  EXPECT_THAT(run({"check", "fast.csv"}).out,
              HasSubstr("warning      the hand moves at 9 m/s at 1.000 s; a hand at a "
                        "device's tip stays below 2 m/s"));
  for (const char* any : {"plan.toml", "story.toml", "hand.csv", "touch.urdf", "table.toml"}) {
    EXPECT_THAT(refused({"check", any, "--scene", "nix.toml"}),
                HasSubstr("\"--scene nix.toml\": not expected here"));
  }
}

// An arm whose tip is on its only axis.
TEST_F(CheckAndAnalyze, OfATipThatNothingMovesSaySo) {
  write("still.urdf", paddle_text("0"));
  const std::string why =
      "no joint moves the tip 'tip' from the rest pose, so nothing can be felt at this tip; choose "
      "another link with --tip";
  const std::string text = done({"analyze", "--device", "still.urdf", "--scene", "free.toml"});
  EXPECT_THAT(text, EndsWith("\n\n" + why + "\n"));
  EXPECT_THAT(text, Not(HasSubstr("at the tip: ")));
  const Said said = run({"analyze", "--device", "still.urdf", "--scene", "free.toml", "--json",
                         "--grip", "100", "200"});
  EXPECT_EQ(said.status, 0);
  EXPECT_EQ(said.err, "limpid: warning: " + why + "\n");
  const json all = json::parse(said.out);
  EXPECT_EQ(all["tip"], nullptr);
  EXPECT_EQ(all["grip"], nullptr);
  EXPECT_TRUE(all.contains("tip") && all.contains("grip"));
  EXPECT_FALSE(all["units"].contains("grip.from"));
}

TEST_F(CheckAndAnalyze, TellTheTrialOfTheChosenLawBelowItsWall) {
  const std::vector<std::string> words{"analyze", "--coupling", "predictive"};
  const std::string text = done(words);
  const json all = told(words);
  const json& trial = all["tip"]["trial"];
  EXPECT_EQ(trial["wall"], all["tip"]["predictive"]["wall"]) << "the one that is named";
  EXPECT_LE(trial["held"], trial["wall"]);
  const std::string held =
      trial["held"] > 0 ? fmt::format("{:>6.0f} N/m", trial["held"].get<double>()) : "  none   ";
  const std::string fault = trial["fault"];
  EXPECT_THAT(
      text,
      ContainsRegex(
          "\nstiffest wall, predictive [^\n]*\n  held in simulated presses " + held + "  " +
          (fault.empty() ? "tapped and pressed slowly in three grips" : "not " + fault) + "\n"));
  EXPECT_EQ(text.find("held in simulated"), text.rfind("held in simulated")) << "of this law alone";
  for (std::vector<std::string> none :
       {std::vector<std::string>{"analyze", "--no-trial"}, {"analyze", "--mass", "0.001"}}) {
    EXPECT_THAT(done(none), Not(HasSubstr("held in simulated")));
    const json untried = told(none);
    EXPECT_FALSE(untried.contains("tip") && untried["tip"].contains("trial"));
  }
}

// The laws with a button of their own, or all; the same in walls and in the table below.
TEST_F(CheckAndAnalyze, NameTheSameLawsInWallsAndInWhatIsFelt) {
  for (const bool all : {false, true}) {
    std::vector<std::string> words{"analyze", "--no-trial", "--coupling", "sfa"};
    if (all) words.emplace_back("--all");
    const std::string text = done(words);
    std::vector<std::string> walls, felt;
    for (const std::string& line : lines_of(text)) {
      if (!line.starts_with("stiffest wall, ") || line.starts_with("stiffest wall, in any"))
        continue;
      walls.push_back(line.substr(15, line.find(' ', 15) - 15));
    }
    std::istringstream header(line_with(text, "felt in free motion").substr(19));
    for (std::string law; header >> law;) felt.push_back(law);
    EXPECT_EQ(walls, felt);
    EXPECT_THAT(walls, Contains("sfa")) << "the chosen one is told in any case";
    EXPECT_EQ(walls.size() == 10, all) << text;
  }
  EXPECT_THAT(done({"analyze", "--no-trial"}), Not(HasSubstr("stiffest wall, sfa")));
}

TEST_F(CheckAndAnalyze, SayWhatDelayLeavesOfAnEtaAboveOne) {
  const std::vector<std::string> words{"analyze", "--no-trial", "--coupling", "predictive",
                                       "--eta",   "5",          "--set",      "device.delay=3"};
  const json all = told(words);
  const std::string line = line_with(done(words), "eta, predictive            ");
  EXPECT_THAT(line, StartsWith(fmt::format("eta, predictive            {:.3g} up to ",
                                           all["tip"]["eta_felt"].get<double>())));
  EXPECT_THAT(line, HasSubstr("because the torque may be "));
  EXPECT_EQ(all["delay"], 0.003);
  EXPECT_GE(all["tip"]["delay_most"], 3);
  EXPECT_THAT(done({"analyze", "--no-trial", "--coupling", "predictive", "--eta", "0.8"}),
              Not(HasSubstr("eta, predictive  ")));
}

TEST_F(CheckAndAnalyze, HaveDampersOfSlidesInNewtonsPerMetreAndSecond) {
  const std::vector<std::string> words{
      "analyze", "--no-trial",        "--device", "omega.urdf",
      "--set",   "coupling.b_v=0.02", "--set",    "device.damping=0.01"};
  const json all = told(words);
  const std::string text = done(words);
  EXPECT_THAT(text, HasSubstr("damping b = b_d + b_v      3 N s/m\n"));
  EXPECT_THAT(line_with(text, "condition (3)"),
              EndsWith(fmt::format("margins: device {:.4g}, proxy {:.4g} N s/m",
                                   all["condition3"]["device_margin"].get<double>(),
                                   all["condition3"]["proxy_margin"].get<double>())));
  EXPECT_EQ(all["condition3"]["known"], true);
  EXPECT_THAT(text,
              StartsWith("computed from              inertia as in the arm's file, damping as "
                         "in the settings, no delay (assumed)\n"));
}

// Each law is known to be passive, known not to be, or neither.
TEST_F(CheckAndAnalyze, SayInJsonWhetherALawIsPassive) {
  EXPECT_EQ(told({"analyze", "--no-trial", "--coupling", "proposed", "--eta", "0.1"})["passive"],
            false);
  const json lossy = told({"analyze", "--no-trial", "--coupling", "standard", "--set",
                           "link.delay=2", "--set", "link.loss=0.1"});
  EXPECT_EQ(lossy["passive"], nullptr);
  EXPECT_EQ(lossy["condition3"]["known"], false);
  EXPECT_NEAR(lossy["link"], 0.002, 0.0011);
  EXPECT_NE(lossy["passive_by"], "");
  const std::string text = done({"analyze", "--no-trial", "--coupling", "standard", "--set",
                                 "link.delay=2", "--set", "link.loss=0.1"});
  EXPECT_THAT(text, ContainsRegex("\nstandard, eta [0-9.]+ +not known to be passive: "));
}

// Motors with a limit for hours of use are as warm as they were held.
TEST_F(CheckAndAnalyze, AndRunsSayHowWarmMotorsBecame) {
  const std::vector<std::string> words{"run", "--device", "touch.urdf", "--duration", "2"};
  const std::string text = run(words).out;
  std::vector<std::string> as_json = words;
  as_json.emplace_back("--json");
  const json lane = json::parse(run(as_json).out)["runs"][0];
  const std::string line = line_with(text, "warmth of the motors     at most ");
  EXPECT_THAT(line, HasSubstr(fmt::format("at most {:.0f} % of the limit for hours of use (",
                                          100 * lane["largest_motor_warmth"].get<double>())));
  EXPECT_THAT(line, EndsWith(fmt::format("was not available for {:.3f} s",
                                         lane["held_by_warmth_s"].get<double>())));
  EXPECT_THAT(done({"run", "--duration", "0.1"}), Not(HasSubstr("warmth of the motors")));
}

}  // namespace
}  // namespace limpid
