// `limpid characterize`: where its numbers come from, and that lines and JSON say the same.
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "app/experiments/law_bench.h"
#include "tests/app/cli/said.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::lines_of;
using test::Said;
using test::text_of;
using testing::ContainsRegex;
using testing::HasSubstr;

class Characterizing : public test::Program {
 protected:
  // Runs it on an arm, and reads the numbers that its report stands on.
  Said make(std::vector<std::string> words) {
    words.insert(words.begin(), "characterize");
    words.insert(words.end(), {"--out", "o"});
    const Said said = run(words);
    found_ = json::parse(text_of("o/characterize.json"), nullptr, false);
    numbers_.clear();
    for (const json& number : found_["numbers"]) numbers_[number["key"]] = number;
    return said;
  }
  void expect(const char* key, double value, double off, const char* unit, bool assumed,
              const char* from) {
    ASSERT_TRUE(numbers_.contains(key)) << key;
    const json& number = numbers_[key];
    EXPECT_NEAR(number["value"].get<double>(), value, off) << key;
    EXPECT_EQ(number["unit"], unit) << key;
    EXPECT_EQ(number["assumed"], assumed) << key;
    EXPECT_THAT(number["from"].get<std::string>(), HasSubstr(from)) << key;
  }

  json found_;
  std::map<std::string, json> numbers_;
};

// A Touch has encoders of 4.19e-4 rad, 0.26 N of friction, and 1 ms of delay, which is assumed.
TEST_F(Characterizing, OfAFileTakesItsReadingsAndSaysWhatIsAssumed) {
  const Said said = make({"touch.urdf"});
  EXPECT_EQ(said.status, 0) << said.err;
  expect("encoder_step", 4.19e-4, 1e-9, "rad", false, "the arm's file");
  expect("friction", 0.26, 0.01, "N", false, "the arm's file");
  expect("delay", 1, 1e-9, "ms", true, "assumed in the arm's file");
  expect("mass", 50, 45, "g", false, "the arm's file");
  for (const auto& [key, number] : numbers_) {
    EXPECT_THAT(said.out, HasSubstr(number["what"].get<std::string>())) << key;
    EXPECT_THAT(said.out, HasSubstr((number["assumed"].get<bool>() ? " ASSUMED: " : " ") +
                                    number["from"].get<std::string>()))
        << key;
  }
  // A row for each law, as in the file.
  ASSERT_EQ(found_["laws"].size(), kBenchLaws.size());
  for (const json& law : found_["laws"]) {
    const std::string name = law["law"];
    std::smatch row;
    const std::regex wanted(
        "\n" + name +
        " +(below 50|[0-9]+|[0-9]+ or more) +([0-9]+) +(none|-?[0-9]+ to [0-9]+) +"
        "(unstable|[0-9.]+) +(unstable|-?[0-9.]+ g, -?[0-9.]+ N s/m)\n");
    ASSERT_TRUE(std::regex_search(said.out, row, wanted)) << name << said.out;
    const double wall = law["stiffest_n_per_m"];
    EXPECT_EQ(row[1] == "below 50", wall <= 50) << name;
    EXPECT_EQ(row[1].str().ends_with("or more"), wall >= 0.95 * 20000) << name;
    EXPECT_NEAR(std::stod(row[2]), law["analyze_n_per_m"].get<double>(), 0.51) << name;
    double least = HUGE_VAL, most = 0, given = 0;
    bool stable = true;
    ASSERT_EQ(law["taps"].size(), 4u) << "hands";
    for (const json& tap : law["taps"]) {
      least = std::min(least, tap["felt_n_per_m"].get<double>());
      most = std::max(most, tap["felt_n_per_m"].get<double>());
      stable = stable && tap["stable"].get<bool>();
      if (tap["stable"].get<bool>()) given = std::max(given, tap["given_j"].get<double>());
    }
    if (row[3] != "none") {
      EXPECT_NEAR(std::stod(row[3].str().substr(row[3].str().find("to ") + 3)), most, 0.51) << name;
    }
    EXPECT_EQ(row[4] == "unstable", !stable) << name;
    if (stable) {
      EXPECT_NEAR(std::stod(row[4]), 1e3 * given, 0.0051) << name;
    }
    const json& free = law["free"];
    EXPECT_EQ(row[5] == "unstable", free.empty()) << name;
    for (const json& at : free) {
      if (at["frequency_hz"] != 2) continue;
      EXPECT_NEAR(std::stod(row[5]), 1e3 * at["mass_kg"].get<double>(), 0.051) << name;
    }
  }
  const std::string page = text_of("o/report.html");
  EXPECT_THAT(page, HasSubstr("assumed: assumed in the arm"));
  EXPECT_THAT(page, HasSubstr("Measured on the virtual arm; no device was pushed."));
  EXPECT_EQ(found_["arm"], found_["device"]);
  EXPECT_EQ(found_["wall_n_per_m"], 2000);
}

TEST_F(Characterizing, TakesWhatIsSetForKnown) {
  make({"omni.urdf", "--set", "device.delay=2", "--set", "device.encoder_step=0.0001", "--set",
        "device.friction=0.01", "--set", "device.damping=0.02"});
  expect("encoder_step", 1e-4, 1e-12, "rad", false, "set");
  expect("delay", 2, 1e-9, "ms", false, "set");
  EXPECT_EQ(numbers_["friction"]["from"], "set");
  EXPECT_EQ(numbers_["damping"]["from"], "set");
  EXPECT_GT(numbers_["friction"]["value"].get<double>(), 0);
  EXPECT_FALSE(numbers_["damping"]["assumed"].get<bool>());
}

TEST_F(Characterizing, SaysWhatTheBuiltInArmDoesNotKnow) {
  make({"omni.urdf"});
  expect("encoder_step", 0, 0, "rad", true, "exact encoders; --set device.encoder_step=STEP");
  expect("delay", 0, 0, "ms", true, "no delay; --set device.delay=TICKS");
  expect("friction", 0, 0, "N", true, "no friction: the arm's file gives none");
}

TEST_F(Characterizing, RefusesWhatWouldHaveNoEffect) {
  EXPECT_THAT(refused({"characterize", "--out", "o"}), HasSubstr("needed: an arm's file"));
  EXPECT_THAT(refused({"characterize", "omni.urdf"}), HasSubstr("--out"));
  for (const auto& [words, what] :
       {std::pair(std::vector<std::string>{"--coupling", "tank"}, "--coupling"),
        {{"--set", "coupling.kind=tank"}, "coupling.kind"},
        {{"--set", "hand.stiffness=3"}, "hand.stiffness"},
        {{"--set", "hand.damping=3"}, "hand.damping"}}) {
    std::vector<std::string> all{"characterize", "omni.urdf", "--out", "o"};
    all.insert(all.end(), words.begin(), words.end());
    EXPECT_THAT(refused(all), HasSubstr(std::string(what) + ": cannot be chosen here"));
  }
  EXPECT_FALSE(fs::exists("o"));
  EXPECT_THAT(
      refused({"characterize", "--device", "raw:none", "--out", "o"}),
      HasSubstr("Plug the device in: a connected device reports the encoder steps itself."));
}

}  // namespace
}  // namespace limpid
