#include <random>

#include "devices/files/config_file.h"
#include "tests/devices/files/test_files.h"

namespace limpid {
namespace {

using test::refusal;
using testing::AllOf;
using testing::HasSubstr;

TEST(Config, SetsWhatItNamesAndLeavesTheRest) {
  Parameters p;
  apply_config_text(p, R"(
observer.alpha = 0.05
observer.anti_windup = false
observer.velocity = "adaptive"
[coupling]
kind = "standard"
eta = 2
[hand]
stiffness = 1e3
)",
                    "x.toml");
  Parameters wanted;
  wanted.alpha = 0.05;
  wanted.kind = CouplingKind::standard;
  wanted.eta = 2;
  wanted.hand_stiffness = 1000;
  wanted.anti_windup = false;
  wanted.velocity = VelocitySource::adaptive;
  EXPECT_TRUE(p == wanted);
}

TEST(Config, RefusesWithFileLineKeyFoundAndAllowed) {
  struct Case {
    const char* text;
    std::vector<std::string> said;
  };
  const Case cases[] = {
      {"[coupling]\neta = 0.6\netta = 1\n", {"x.toml:3:", "coupling.etta", "coupling.eta?"}},
      {"coupling.eta = \"much\"\n", {"x.toml:1:", "coupling.eta", "\"much\"", "number"}},
      {"\n\ncoupling.eta = -1\n", {"x.toml:3:", "coupling.eta", "-1"}},
      {"coupling.eta = nan\n", {"x.toml:1:", "coupling.eta", "nan"}},
      {"coupling.eta = inf\n", {"x.toml:1:", "coupling.eta", "inf"}},
      {"coupling.kind = \"best\"\n", {"x.toml:1:", "coupling.kind", "best", "standard, proposed"}},
      {"device.substeps = 2.5\n", {"x.toml:1:", "device.substeps", "2.5", "whole"}},
      {"observer.anti_windup = 1\n", {"x.toml:1:", "observer.anti_windup", "true, false"}},
      {"[coupling]\neta = [1, 2]\n", {"x.toml:2:", "coupling.eta", "[1, 2]"}},
      {"coupling = 3\n", {"x.toml:1:", "coupling"}},
      {"[coupling.eta]\nx = 1\n", {"x.toml:1:", "coupling.eta", "a table"}},
      {"coupling.eta = 1\ncoupling.eta = 2\n", {"x.toml:2:", "not TOML"}},
      {"this is no TOML", {"x.toml:1:", "not TOML"}},
      {"\xff\xfe", {"x.toml:1:", "not TOML"}},
  };
  for (const Case& c : cases) {
    Parameters p;
    const std::string said = refusal([&] { apply_config_text(p, c.text, "x.toml"); });
    for (const std::string& part : c.said) EXPECT_THAT(said, HasSubstr(part)) << c.text;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    EXPECT_TRUE(p == Parameters{}) << "a refused file changes nothing: " << c.text;
  }
}

// Recordings and settings of Limpid 0.2 have a key that is no more.
TEST(Config, PassesOverARetiredKey) {
  const std::string text = "[predictor]\npreset = \"coarse\"\np = 0.3\n";
  Parameters p;
  apply_config_text(p, text, "x.toml");
  EXPECT_EQ(p.memory, 0.3);
  EXPECT_TRUE(
      take_config_table(p, "[parameters.predictor]\npreset = \"auto\"\n", "parameters", "x.toml")
          .empty());
  EXPECT_TRUE(has_retired(text, "x.toml"));
  EXPECT_FALSE(has_retired("[predictor]\np = 0.3\n", "x.toml"));
  EXPECT_THROW(apply_setting(p, "predictor.preset=fine"), ParameterError) << "by hand it is a slip";
}

TEST(Config, RefusesAFileThatIsNotThere) {
  Parameters p;
  EXPECT_THAT(refusal([&] { apply_config(p, "/nowhere/x.toml"); }), HasSubstr("/nowhere/x.toml"));
  EXPECT_THAT(refusal([&] { apply_config(p, "/"); }), HasSubstr("not a file"));
}

TEST(Config, GivesEveryValueBackToTheLastBit) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 200; ++round) {
    Parameters p;
    for (const ParameterInfo& info : parameter_table()) {
      std::uniform_real_distribution<double> in_range(info.minimum, info.maximum);
      set_parameter_number(p, info, in_range(random));
    }
    if (round % 5 == 0) p.friction = kFromArm;
    Parameters again;
    apply_config_text(again, config_text(p), "again");
    ASSERT_TRUE(again == p) << config_text(p);
  }
}

TEST(Config, LeavesOutWhatIsLeftToTheArm) {
  EXPECT_EQ(config_text(Parameters{}).find("torque_limit"), std::string::npos);
}

TEST(Setting, TakesTomlValuesAndBareWords) {
  Parameters p;
  apply_setting(p, "coupling.eta=0.6");
  apply_setting(p, " coupling.k_vc = 8 ");
  apply_setting(p, "coupling.kind=standard");
  apply_setting(p, "observer.velocity=\"lowpass\"");
  apply_setting(p, "observer.anti_windup=false");
  EXPECT_EQ(p.eta, 0.6);
  EXPECT_EQ(p.k_vc, 8);
  EXPECT_EQ(p.kind, CouplingKind::standard);
  EXPECT_EQ(p.velocity, VelocitySource::lowpass);
  EXPECT_FALSE(p.anti_windup);
}

// TOML has no such numbers; people write them, and every other option takes them.
TEST(Setting, TakesNumbersThatLackAZero) {
  for (const auto& [text, value] : {std::pair(".5", 0.5), {"5.", 5.0}, {"+.25", 0.25}}) {
    Parameters p;
    apply_setting(p, std::string("coupling.eta=") + text);
    EXPECT_EQ(p.eta, value) << text;
  }
  Parameters p;
  for (const char* none : {".", "5.x", "+-.5", ".5 6"}) {
    EXPECT_THROW(apply_setting(p, std::string("coupling.eta=") + none), ParameterError) << none;
  }
}

TEST(Setting, RefusesWhatIsNone) {
  const char* const cases[] = {"",
                               "coupling.eta",
                               "=1",
                               "coupling.eta=",
                               "coupling.eta=1\ncoupling.b_v=2",
                               "coupling.eta=nan",
                               "coupling.eta=one",
                               "coupling.eat=1",
                               "coupling.eta=[1]"};
  for (const char* setting : cases) {
    Parameters p;
    EXPECT_NE(refusal<ParameterError>([&] { apply_setting(p, setting); }), "") << setting;
    EXPECT_TRUE(p == Parameters{}) << setting;
  }
  Parameters p;
  EXPECT_THAT(refusal<ParameterError>([&] { apply_setting(p, "observer.alfa=1"); }),
              AllOf(HasSubstr("observer.alfa"), HasSubstr("observer.alpha")));
}

}  // namespace
}  // namespace limpid
