// Commands that run, analyse and check: what they print against what they write, and theory.
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <regex>

#include "app/story/run_story.h"
#include "devices/files/session/session.h"
#include "tests/app/cli/said.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::lines_of;
using test::Said;
using test::text_of;
using testing::AllOf;
using testing::Contains;
using testing::ContainsRegex;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

constexpr const char* kLawWords[] = {"standard", "proposed", "predictive", "tank", "direct",
                                     "eba",      "popc",     "wave",       "tdpn", "sfa"};

class Commands : public test::Program {
 protected:
  static json parsed(const std::vector<std::string>& words) { return json::parse(done(words)); }
  // The first number behind `label` in a text.
  static double behind(const std::string& text, const std::string& label) {
    const auto at = text.find(label);
    EXPECT_NE(at, std::string::npos) << label;
    std::smatch found;
    const std::string rest = text.substr(at + label.size());
    EXPECT_TRUE(std::regex_search(rest, found, std::regex(R"(-?\d+\.?\d*(e[-+]\d+)?)"))) << label;
    return std::stod(found[0]);
  }
};

TEST_F(Commands, RunSaysInJsonWhatItSaysInLines) {
  const std::vector<std::string> words{"run", "--duration", "0.8", "--coupling", "proposed"};
  std::vector<std::string> as_json = words;
  as_json.emplace_back("--json");
  const json told = parsed(as_json);
  const std::string text = done(words);
  ASSERT_EQ(told["runs"].size(), 1u);
  const json& run = told["runs"][0];
  EXPECT_EQ(run["ticks"], 800);
  EXPECT_EQ(behind(text, "ticks"), 800);
  EXPECT_NEAR(behind(text, "in contact"), 100 * run["share_in_contact"].get<double>(), 0.6);
  EXPECT_NEAR(behind(text, "largest |x_E|"), 1e3 * run["largest_error_rad"].get<double>(), 6e-4);
  EXPECT_NEAR(behind(text, "largest |f2|"), run["largest_contact_torque_N_m"].get<double>(), 6e-5);
  EXPECT_NEAR(behind(text, "rms human torque"), run["rms_human_torque_N_m"].get<double>(), 6e-5);
  EXPECT_NEAR(behind(text, "E_c total"), 1e3 * run["energy_total_J"].get<double>(), 6e-4);
  EXPECT_NEAR(behind(text, "(highest"), 1e3 * run["highest_energy_total_J"].get<double>(), 6e-4);
  EXPECT_NEAR(behind(text, "E_c commanded"), 1e3 * run["energy_commanded_J"].get<double>(), 6e-4);
  EXPECT_FALSE(run.contains("unstable_at_s"));
  EXPECT_EQ(told["recorded"], nullptr);
  EXPECT_THAT(told["warnings"], IsEmpty());
  EXPECT_THAT(told["provenance"].get<std::string>(), ContainsRegex("settings [0-9a-f]+, seed 0, "));
  EXPECT_THAT(text, HasSubstr("0.800 s in "));
  EXPECT_THAT(text, HasSubstr(" times real time"));
}

TEST_F(Commands, RunOfATwinHasTwoRunsOfTwoLaws) {
  const json told = parsed({"run", "--twin", "--duration", "0.5", "--coupling", "predictive",
                            "--record", "two.h5", "--json"});
  EXPECT_EQ(told["runs"].size(), 2u);
  EXPECT_EQ(told["runs"][1]["ticks"], 500);
  EXPECT_EQ(told["recorded"], "two.h5");
  const std::string text = done({"info", "two.h5"});
  EXPECT_THAT(text, HasSubstr("two runs with the same hand"));
  EXPECT_THAT(done({"run", "--twin", "--duration", "0.02", "--coupling", "predictive"}),
              ContainsRegex("predictive 1.*standard 1"));
  EXPECT_THAT(done({"run", "--twin", "--duration", "0.02", "--coupling", "standard"}),
              ContainsRegex("standard 1.*predictive 1"));
  EXPECT_THAT(
      done({"run", "--twin", "coupling.eta=0.7", "--duration", "0.02", "--coupling", "proposed"}),
      ContainsRegex("proposed 1.*proposed 0.7"));
  for (const char* shared : {"loop.tick=0.0005", "hand.stiffness=444", "device.torque_limit=0.1"}) {
    EXPECT_THAT(refused({"run", "--twin", shared, "--duration", "0.02"}),
                HasSubstr("is one setting for all runs; set it for the first run"));
  }
}

TEST_F(Commands, RunAndInfoSayForHowLongMotorsWereAtTheirLimit) {
  const std::vector<std::string> weak{
      "run", "--duration", "0.8", "--coupling", "standard", "--set", "device.torque_limit=0.002"};
  std::vector<std::string> recorded = weak, as_json = weak;
  recorded.insert(recorded.end(), {"--record", "weak.h5"});
  as_json.emplace_back("--json");
  const std::string text = done(recorded);
  const double time = behind(text, "motors at their limit");
  EXPECT_GT(time, 0.01);
  EXPECT_NEAR(parsed(as_json)["runs"][0]["at_limit_s"].get<double>(), time, 6e-4);
  EXPECT_NEAR(behind(done({"info", "weak.h5"}), "motors at their limit"), time, 6e-4);
  EXPECT_NEAR(parsed({"info", "weak.h5", "--json"})["runs"][0]["at_limit_s"].get<double>(), time,
              6e-4);
  std::vector<std::string> usual(weak.begin(), weak.end() - 2);
  EXPECT_THAT(done(usual), Not(HasSubstr("motors at their limit")));
  usual.insert(usual.end(), {"--set", "device.torque_limit=0.01", "--twin", "coupling.k_vc=100"});
  EXPECT_THAT(done(usual), ContainsRegex("motors at their limit +[0-9.]+ s in the second run;"));
}

TEST_F(Commands, RunKeepsFilesThatAreThereUnlessForced) {
  done({"run", "--duration", "0.05", "--record", "a.h5", "--picture", "a.png"});
  const std::string recorded = text_of("a.h5");
  EXPECT_THAT(refused({"run", "--duration", "0.05", "--record", "a.h5"}), HasSubstr("a.h5"));
  EXPECT_THAT(refused({"run", "--duration", "0.05", "--picture", "a.png"}),
              HasSubstr("--picture a.png: exists already; --force replaces it"));
  EXPECT_EQ(text_of("a.h5"), recorded);
  const std::string said =
      done({"run", "--duration", "0.1", "--record", "a.h5", "--picture", "a.png", "--force"});
  EXPECT_THAT(said, HasSubstr("recorded 100 ticks in a.h5"));
  EXPECT_EQ(parsed({"info", "a.h5", "--json"})["runs"][0]["ticks"], 100);
  EXPECT_THAT(text_of("a.png"), StartsWith("\x89PNG"));
  EXPECT_THAT(refused({"run", "--duration", "0.05", "--picture", "none/a.png"}),
              HasSubstr("No such file or directory"));
  EXPECT_THAT(refused({"run", "--duration", "0.05", "--picture", "home"}),
              HasSubstr("Is a directory"));
}

TEST_F(Commands, WriteNothingOverWhatTheyRead) {
  fs::copy_file(fs::path(LIMPID_ASSETS_DIR) / "hands/touch.csv", "hand.csv");
  fs::copy_file(fs::path(LIMPID_ASSETS_DIR) / "scenes/free.toml", "scene.toml");
  fs::copy_file(fs::path(LIMPID_ASSETS_DIR) / "stories/first.toml", "story.toml");
  done({"run", "--duration", "0.02", "--record", "a.h5"});
  write("settings.toml", "[coupling]\neta = 0.7\n");
  for (const auto& [words, file] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"run", "--hand", "hand.csv", "--record", "hand.csv"}, "hand.csv"},
           {{"run", "--scene", "scene.toml", "--record", "scene.toml"}, "scene.toml"},
           {{"run", "--config", "settings.toml", "--record", "settings.toml"}, "settings.toml"},
           {{"run", "--hand", "a.h5", "--picture", "a.h5"}, "a.h5"},
           {{"info", "a.h5", "--csv", "a.h5"}, "a.h5"},
           {{"story", "story.toml", "--record", "story.toml"}, "story.toml"}}) {
    const std::string before = text_of(file);
    std::vector<std::string> forced = words;
    forced.emplace_back("--force");
    EXPECT_THAT(refused(forced), HasSubstr("the command reads this file")) << file;
    EXPECT_EQ(text_of(file), before);
  }
}

TEST_F(Commands, RunTakesSettingsInTheOrderFilesSettingsShortOptions) {
  write("settings.toml", "[coupling]\nkind = \"standard\"\neta = 0.7\n[observer]\nalpha = 0.02\n");
  const auto settings = [](std::vector<std::string> words) {
    words.insert(words.begin(), {"run", "--duration", "0.01", "--record", "a.h5", "--force"});
    done(words);
    return done({"info", "a.h5"});
  };
  EXPECT_THAT(settings({"--config", "settings.toml"}),
              HasSubstr("coupling at first        standard, eta 0.7\n"));
  EXPECT_THAT(settings({"--config", "settings.toml", "--set", "coupling.eta=0.9"}),
              HasSubstr("standard, eta 0.9\n"));
  EXPECT_THAT(settings({"--set", "coupling.eta=0.9", "--eta", "1.1", "--coupling", "tank"}),
              HasSubstr("tank, eta 1.1\n"));
  EXPECT_THAT(
      settings({"--coupling", "standard", "--set", "link.delay=3", "--set", "link.jitter=2"}),
      HasSubstr("link at first            3 ticks each way, jitter 2, loss 0\n"));
}

TEST_F(Commands, RunSaysWhatDoesNothing) {
  EXPECT_THAT(run({"run", "--duration", "0.01", "--seed", "3"}).err,
              HasSubstr("note: --seed changes nothing here"));
  EXPECT_EQ(run({"run", "--duration", "0.01", "--seed", "3", "--variation", "1"}).err, "");
  EXPECT_THAT(
      run({"run", "--duration", "0.01", "--coupling", "predictive", "--set", "link.delay=5"}).err,
      HasSubstr("note: link.* does nothing here: the law"));
  EXPECT_EQ(run({"run", "--duration", "0.01", "--coupling", "tank", "--set", "link.delay=5"}).err,
            "");
}

TEST_F(Commands, RunWarnsOfEnergyAndFailsWhereItIsUnstable) {
  const Said wild = run({"run", "--coupling", "proposed", "--eta", "0.05", "--set",
                         "hand.stiffness=3000", "--set", "hand.damping=0"});
  EXPECT_EQ(wild.status, 0);
  EXPECT_THAT(wild.err, HasSubstr("limpid: warning: E_c rose to "));
  EXPECT_THAT(wild.err, HasSubstr("this run is not passive"));
  const Said lost =
      run({"run", "--coupling", "proposed", "--eta", "0.05", "--set", "hand.stiffness=3000",
           "--set", "hand.damping=0", "--set", "device.torque_limit=1000"});
  EXPECT_EQ(lost.status, 1);
  EXPECT_THAT(lost.err, HasSubstr("limpid: unstable since t = "));
}

TEST_F(Commands, RunHasVariationsOfPathsAlone) {
  const auto target = [](const std::vector<std::string>& more) {
    std::vector<std::string> words{"run", "--duration", "1.2", "--record", "a.h5", "--force"};
    words.insert(words.end(), more.begin(), more.end());
    done(words);
    done({"info", "a.h5", "--csv", "a.csv", "--force"});
    return text_of("a.csv");
  };
  const auto hand = [&](const std::vector<std::string>& more) {
    std::string path;
    std::istringstream in(target(more));
    std::string header, line;
    std::getline(in, header);
    const auto names =
        json::parse("[\"" + std::regex_replace(header, std::regex(","), "\",\"") + "\"]");
    const auto column = std::ranges::find(names, "hand_target_z_m") - names.begin();
    while (std::getline(in, line)) {
      std::istringstream cells(line);
      std::string cell;
      for (long i = 0; i <= column; ++i) std::getline(cells, cell, ',');
      path += cell + ' ';
    }
    return path;
  };
  const std::string first = hand({"--variation", "1", "--seed", "1"});
  EXPECT_EQ(hand({"--variation", "1", "--seed", "1"}), first);
  EXPECT_NE(hand({"--variation", "2", "--seed", "1"}), first);
  EXPECT_NE(hand({"--variation", "1", "--seed", "2"}), first);
  EXPECT_EQ(hand({"--variation", "0"}), hand({}));
  EXPECT_THAT(refused({"run", "--hand", "cup.h5", "--variation", "1"}),
              HasSubstr("cup.h5 contains more than a path"));
}

TEST_F(Commands, RunOnADeviceHasNoOtherHand) {
  for (const auto& [option, value] :
       {std::pair("--hand", "touch.csv"), std::pair("--variation", "1"), std::pair("--twin", "")}) {
    std::vector<std::string> words{"run", "--live", "--yes", option};
    if (*value != '\0') words.emplace_back(value);
    EXPECT_THAT(refused(words), HasSubstr(std::string(option) + ": not together with --live"));
  }
  EXPECT_THAT(refused({"run", "--live", "--yes", "--json"}),
              HasSubstr("--json: not together with --live"));
  EXPECT_THAT(refused({"run", "--live", "--yes"}), HasSubstr("no device is chosen"));
  EXPECT_THAT(refused({"run", "--live", "nothing:1", "--yes"}), HasSubstr("is not connected"));
}

TEST_F(Commands, InfoSaysTheSettingsOfEachRun) {
  done({"run", "--duration", "0.05", "--coupling", "proposed", "--set", "observer.alpha=0.02",
        "--record", "a.h5", "--twin", "coupling.kind=predictive", "coupling.k_vc=1.5"});
  const std::string text = done({"info", "a.h5"});
  EXPECT_THAT(text, HasSubstr("coupling at first        proposed, eta 1\n"
                              "settings unlike defaults observer.alpha = 0.02\n"
                              "twin, coupling at first  predictive, eta 1\n"
                              "twin, other settings     coupling.k_vc = 1.5\n"));
  const json runs = parsed({"info", "a.h5", "--json"})["runs"];
  EXPECT_EQ(runs[0]["settings"]["coupling.kind"], "proposed");
  EXPECT_EQ(runs[0]["settings"]["observer.alpha"], 0.02);
  EXPECT_EQ(runs[1]["settings"]["coupling.kind"], "predictive");
  EXPECT_EQ(runs[1]["settings"]["coupling.k_vc"], 1.5);
  for (const ParameterInfo& setting : parameter_table()) {
    EXPECT_TRUE(runs[0]["settings"].contains(setting.key)) << setting.key;
  }
}

TEST_F(Commands, InfoSaysWhatARecordingHolds) {
  done({"run", "--duration", "0.25", "--eta", "0.8", "--coupling", "proposed", "--seed", "7",
        "--variation", "1", "--scene", "stack.toml", "--record", "a.h5"});
  const std::string text = done({"info", "a.h5"});
  for (const char* line : {"a.h5\n", "length                   0.250 s\n",
                           "coupling at first        proposed, eta 0.8\n",
                           "arm                      3 joints, tick 0.001 s, seed 7\n",
                           "contacts                 the 4 strongest contacts of every tick, x, y, "
                           "z one after the other\n"}) {
    EXPECT_THAT(text, HasSubstr(line));
  }
  EXPECT_THAT(text,
              ContainsRegex("created                  ....-..-..T..:..:.. ?[^ ]* by limpid "));
  EXPECT_THAT(text, HasSubstr("objects that move        "));
  const json told = parsed({"info", "a.h5", "--json"});
  EXPECT_EQ(told["file"], "a.h5");
  EXPECT_EQ(told["joints"], 3);
  EXPECT_EQ(told["seed"], 7);
  EXPECT_DOUBLE_EQ(told["tick_s"].get<double>(), 1e-3);
  EXPECT_DOUBLE_EQ(told["length_s"].get<double>(), 0.25);
  EXPECT_EQ(told["runs"][0]["ticks"], 250);
  EXPECT_EQ(told["objects"].size(), 5u) << "the stack has five";
  EXPECT_THAT(told["changes"], IsEmpty());
  EXPECT_THAT(told["marks"], IsEmpty());
  EXPECT_THAT(told["warnings"], IsEmpty());
}

TEST_F(Commands, InfoTellsOfChangesAndMarks) {
  const json told = parsed({"info", "table.h5", "--json"});
  const std::string text = done({"info", "table.h5"});
  for (const json& mark : told["marks"]) {
    EXPECT_THAT(text, ContainsRegex("mark +[0-9.]+ s          " + mark["text"].get<std::string>()));
  }
  for (const json& change : told["changes"]) {
    EXPECT_THAT(text, HasSubstr(change["setting"].get<std::string>()));
  }
}

TEST_F(Commands, InfoSaysHowManyTicksCameLate) {
  done({"run", "--duration", "0.05", "--record", "a.h5"});
  EXPECT_THAT(done({"info", "a.h5"}), Not(HasSubstr("late ticks")));
  Session session = read_session("a.h5");
  const auto stride = static_cast<std::size_t>(session.layout.stride());
  for (const auto& [k, late] : {std::pair(3, 0.002), {7, 0.0142}, {9, 0.0009}}) {
    const auto row = std::span(session.rows).subspan(static_cast<std::size_t>(k) * stride, stride);
    session.layout.in(row, Column::wake_latency)[0] = late;
  }
  write_session(session, {}, "b.h5", false);
  EXPECT_THAT(done({"info", "b.h5"}),
              HasSubstr("late ticks               2 of 50, at most 14.2 ms late\n"));
  const json told = parsed({"info", "b.h5", "--json"});
  EXPECT_EQ(told["late_ticks"], 2);
  EXPECT_EQ(told["largest_lateness_s"], 0.0142);
}

TEST_F(Commands, InfoWritesATableBesideWhereItIsFrom) {
  done({"run", "--duration", "0.05", "--record", "a.h5"});
  const std::string said = done({"info", "a.h5", "--csv", "a.csv"});
  EXPECT_THAT(said,
              HasSubstr("table written as a.csv; the sources of the table: a.csv-metadata.json\n"));
  const std::vector<std::string> lines = lines_of(text_of("a.csv"));
  ASSERT_EQ(lines.size(), 51u);
  EXPECT_THAT(lines[0], StartsWith("time_s,"));
  for (const std::string& line : lines) {
    EXPECT_EQ(std::ranges::count(line, ','), std::ranges::count(lines[0], ','));
  }
  const json beside = json::parse(text_of("a.csv-metadata.json"));
  EXPECT_EQ(beside["url"], "a.csv");
  EXPECT_EQ(beside["dc:source"], "a.h5");
  EXPECT_THAT(beside["dc:description"].get<std::string>(), StartsWith("limpid "));
  EXPECT_THAT(refused({"info", "a.h5", "--csv", "a.csv"}), HasSubstr("a.csv"));
  EXPECT_THAT(refused({"info", "a.h5", "--csv", "none/a.csv"}), HasSubstr("none/a.csv"));
  EXPECT_THAT(refused({"info", "a.h5", "--csv", "-", "--json"}),
              HasSubstr("--json: not together with"));
  const Said both = run({"info", "a.h5", "--csv", "b.csv", "--json"});
  EXPECT_EQ(both.status, 0);
  EXPECT_EQ(json::parse(both.out)["runs"][0]["ticks"], 50);
  EXPECT_THAT(both.err, HasSubstr("written as b.csv"));
  const Said table = run({"info", "a.h5", "--csv", "-"});
  EXPECT_EQ(table.status, 0);
  EXPECT_EQ(table.out, text_of("a.csv"));
  EXPECT_THAT(table.err, HasSubstr("length                   0.050 s"));
  EXPECT_FALSE(fs::exists("-"));
}

TEST_F(Commands, InfoOverwritesNothingBesideItsTable) {
  done({"run", "--duration", "0.05", "--record", "a.h5"});
  write("c.csv-metadata.json", "precious");
  EXPECT_THAT(refused({"info", "a.h5", "--csv", "c.csv"}),
              HasSubstr("c.csv-metadata.json: exists"));
  EXPECT_EQ(text_of("c.csv-metadata.json"), "precious");
  EXPECT_FALSE(fs::exists("c.csv"));
  done({"info", "a.h5", "--csv", "c.csv", "--force"});
  EXPECT_THAT(text_of("c.csv-metadata.json"), HasSubstr("csvw"));
  fs::copy_file("a.h5", "m.csv-metadata.json");
  const auto before = fs::file_size("m.csv-metadata.json");
  EXPECT_THAT(refused({"info", "m.csv-metadata.json", "--csv", "m.csv", "--force"}),
              HasSubstr("the command reads this file"));
  EXPECT_EQ(fs::file_size("m.csv-metadata.json"), before);
}

TEST_F(Commands, CheckRefusesOptionsThatHaveNoEffect) {
  for (const char* file : {"tiny.toml", "first.toml"}) {
    EXPECT_THAT(refused({"check", file, "--device", "omni.urdf"}), HasSubstr("--device: not for"));
    EXPECT_THAT(refused({"check", file, "--set", "coupling.eta=5"}), HasSubstr("--set"));
    EXPECT_THAT(refused({"check", file, "--tip", "nonsense"}), HasSubstr("--tip: not for"));
  }
  EXPECT_THAT(refused({"check", "touch.urdf", "--device", "omni.urdf"}), HasSubstr("--device"));
  EXPECT_THAT(refused({"check", "touch.csv", "--eta", "1"}),
              AllOf(HasSubstr("--eta"), HasSubstr("not for a hand")));
}

// By the eigenvalues of the four states of device, proxy and estimate, computed elsewhere.
TEST_F(Commands, AnalyzeOfOneMassKnowsTheCouplingsSpring) {
  const auto least = [&](const char* damping) {
    return parsed({"analyze", "--mass", "0.001", "--eta", "0.65", "--coupling", "proposed", "--set",
                   damping, "--set", "hand.stiffness=3000", "--json"});
  };
  const json bare = least("hand.damping=0");
  EXPECT_NEAR(bare["eta_min_compliant"], 0.7030, 1e-4);
  EXPECT_EQ(bare["passive"], false);
  EXPECT_NEAR(least("hand.damping=0.5")["eta_min_compliant"], 0.0577, 1e-4);
}

// An arm that slides has newtons and metres wherever people read numbers.
TEST_F(Commands, AnalyzeHasNewtonsAndMetresOfSlides) {
  const json told = parsed({"analyze", "--device", "omega.urdf", "--json"});
  EXPECT_EQ(told["units"]["b"], "N s/m");
  EXPECT_EQ(told["units"]["condition3.device_margin"], "N s/m");
  const json inside = parsed({"analyze", "--device", "omega.urdf", "--set", "coupling.b_v=0.02",
                              "--set", "device.damping=0.01", "--json"});
  EXPECT_NEAR(inside["b"], 3, 1e-12) << "0.03 N m s/rad, where 1 rad is 0.1 m and 1 N m 10 N";
}

TEST_F(Commands, RecoverMakesASessionOfWhatWasLeft) {
  done({"run", "--duration", "0.05", "--record", "a.h5"});
  fs::rename("a.h5", "a.h5.part");
  EXPECT_EQ(done({"recover", "a.h5.part", "--out", "b.h5"}), "50 ticks recovered in b.h5\n");
  EXPECT_EQ(parsed({"info", "b.h5", "--json"})["runs"][0]["ticks"], 50);
  EXPECT_THAT(refused({"recover", "none.h5.part"}), HasSubstr("none.h5.part"));
}

// A scalar inertia m of the joint: the estimate's bandwidth is alpha / m, and a light grip holds
// k_vc between two masses, m/2 reduced.
TEST_F(Commands, AnalyzeHasTheobserversBandwidthOfOneMass) {
  const json told = parsed(
      {"analyze", "--mass", "0.004", "--alpha", "0.05", "--set", "coupling.k_vc=10", "--json"});
  ASSERT_EQ(told["w_f"].size(), 1u);
  EXPECT_NEAR(told["w_f"][0].get<double>(), 0.05 / 0.004, 1e-9);
  EXPECT_FALSE(told.contains("tip"));
  EXPECT_FALSE(told.contains("eta_min_band"));
  const json band = parsed({"analyze", "--mass", "0.004", "--band", "5", "--json"});
  EXPECT_LE(band["eta_min_band"].get<double>(), band["eta_min"].get<double>());
}

TEST_F(Commands, AnalyzeSaysInLinesWhatItSaysInJson) {
  const std::vector<std::string> words{"analyze", "--coupling", "proposed", "--eta",
                                       "0.8",     "--band",     "5",        "--all"};
  std::vector<std::string> as_json = words;
  as_json.emplace_back("--json");
  const json told = parsed(as_json);
  const std::string text = done(words);
  const auto near = [&](const char* label, const json& value, double off) {
    EXPECT_NEAR(behind(text, label), value.get<double>(), off) << label;
  };
  near("observer bandwidth w_f", told["w_f"][0], 0.06);
  near("locked system w_c", told["w_c"][0], 0.06);
  near("damping b = b_d + b_v", told["b"], 1e-3);
  near("eta_min, all frequencies", told["eta_min"], 6e-5);
  near("eta_min, in the band", told["eta_min_band"], 6e-5);
  near("eta_min, in this grip", told["eta_min_grip"], 6e-5);
  near("margins: device", told["condition3"]["device_margin"], 1e-3);
  near(", proxy", told["condition3"]["proxy_margin"], 1e-3);
  near("at the tip: mass", 1e3 * told["tip"]["mass"].get<double>(), 1);
  near("g, own damping", told["tip"]["damping"], 1e-2);
  near("stiffest wall, in any hand", told["tip"]["every_hand"], 0.6);
  near("stiffest in the scene", told["tip"]["scene"], 0.6);
  EXPECT_EQ(told["tip"]["scene"], 600) << "the table's";
  for (const char* law : kLawWords) {
    near((std::string("stiffest wall, ") + law).c_str(), told["tip"][law]["wall"], 0.6);
    EXPECT_THAT(text, HasSubstr(told["tip"][law]["bound"].get<std::string>()));
  }
  EXPECT_THAT(text, ContainsRegex("proposed, eta 0.8 +passive: "));
  EXPECT_EQ(told["passive"], true);
  EXPECT_EQ(told["coupling"], "proposed");
  EXPECT_EQ(told["eta"], 0.8);
  EXPECT_THAT(text, ContainsRegex("condition \\(3\\) +is met"));
  // A table with a row for each frequency, and mass and damping of each law in it.
  const auto lines = lines_of(text.substr(text.find("felt in free motion")));
  ASSERT_EQ(lines.size(), 1 + told["tip"]["frequency"].size());
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    std::istringstream in(lines[i + 1]);
    double f = 0;
    std::string word;
    in >> f >> word;
    EXPECT_EQ(f, told["tip"]["frequency"][i].get<double>());
    for (const char* law : kLawWords) {
      double mass = 0, damping = 0;
      in >> mass >> word >> damping >> word >> word;
      EXPECT_NEAR(mass, 1e3 * told["tip"][law]["felt_mass"][i].get<double>(), 0.006) << law << f;
      EXPECT_NEAR(damping, told["tip"][law]["felt_damping"][i].get<double>(), 0.006) << law << f;
      in.ignore(0);
    }
  }
}

TEST_F(Commands, AnalyzeNamesTheUnitOfEveryNumberThatHasOne) {
  const json told = parsed({"analyze", "--json"});
  for (const auto& [key, unit] : told["units"].items()) {
    EXPECT_THAT(unit.get<std::string>(), Not(IsEmpty()));
    const json* at = &told;
    std::istringstream parts(key);
    for (std::string part; std::getline(parts, part, '.');) {
      if (part == "LAW") part = "tank";
      ASSERT_TRUE(at->contains(part)) << key;
      at = &(*at)[part];
    }
    EXPECT_TRUE(at->is_number() || at->is_array()) << key;
  }
}

TEST_F(Commands, AnalyzeOfARangeOfHandsSaysWhatIsKnownOfEveryLaw) {
  const json told = parsed({"analyze", "--grip", "300", "3000", "--json"});
  const std::string text = done({"analyze", "--grip", "300", "3000", "--all"});
  EXPECT_EQ(told["grip"]["from"], 300);
  EXPECT_EQ(told["grip"]["to"], 3000);
  for (const char* law : kLawWords) {
    const json& of = told["grip"][law];
    for (const char* which : {"stable", "passive"}) {
      EXPECT_THAT(of[which]["by"].get<std::string>(), Not(IsEmpty())) << law;
      EXPECT_EQ(of[which]["every_wall"].is_null() || of[which]["every_wall"] == true,
                of[which]["wall"].is_null())
          << law;
    }
    EXPECT_THAT(of["llewellyn_by"].get<std::string>(), Not(IsEmpty())) << law;
    EXPECT_THAT(text, HasSubstr(std::string("stable walls, ") + law));
    EXPECT_THAT(text, HasSubstr(std::string("passive walls, ") + law));
  }
  EXPECT_TRUE(told["grip"]["popc"]["llewellyn"].is_null());
  EXPECT_LT(told["grip"]["direct"]["llewellyn"]["least"].get<double>(), -0.99);
  EXPECT_EQ(told["grip"]["colgate_schenkel"]["wall"], told["tip"]["every_hand"]);
  EXPECT_EQ(told["units"]["grip.LAW.stable.wall"], "N/m");
  EXPECT_THAT(text, ContainsRegex("Colgate and Schenkel +[0-9]+ N/m"));
  EXPECT_THAT(text, ContainsRegex("Abbott and Okamura +[0-9]+ N/m"));
  EXPECT_THAT(text, HasSubstr("Llewellyn's criterion"));
  EXPECT_THAT(done({"analyze"}), Not(HasSubstr("Llewellyn")));
  EXPECT_FALSE(parsed({"analyze", "--json"}).contains("grip"));
  const std::string late = done({"analyze", "--grip", "300", "3000", "--set", "device.delay=2"});
  EXPECT_THAT(late, ContainsRegex("Abbott and Okamura +not known"));
}

TEST_F(Commands, AnalyzeRefusesARangeThatIsNone) {
  for (const auto& [from, to] : {std::pair("300", "100"), {"0", "100"}, {"-1", "5"}}) {
    EXPECT_NE(run({"analyze", "--grip", from, to}).status, 0) << from << " " << to;
  }
  EXPECT_NE(run({"analyze", "--grip", "300"}).status, 0);
  EXPECT_NE(run({"analyze", "--grip", "300", "400", "--mass", "1"}).status, 0);
}

TEST_F(Commands, AnalyzeKnowsWhatIsNotPassiveAndWhatIsNotKnown) {
  EXPECT_THAT(done({"analyze", "--coupling", "proposed", "--eta", "0.1"}),
              ContainsRegex("proposed, eta 0.1 +NOT passive: "));
  const std::string broken =
      done({"analyze", "--coupling", "standard", "--set", "coupling.k_vc=1000"});
  EXPECT_THAT(broken, ContainsRegex("condition \\(3\\) +BROKEN"));
  const std::string lossy = done(
      {"analyze", "--coupling", "standard", "--set", "link.delay=2", "--set", "link.loss=0.1"});
  EXPECT_THAT(lossy, HasSubstr("no limit is known because packets are lost (link.loss)"));
  EXPECT_THAT(lossy, ContainsRegex("link +packets are lost"));
  const std::string late = done({"analyze", "--coupling", "standard", "--set", "link.delay=2"});
  EXPECT_THAT(late, ContainsRegex("link +packets up to [0-9.]+ ms old in each direction"));
  EXPECT_THAT(done({"analyze"}), Not(ContainsRegex("\nlink ")));
}

constexpr const char* kPlane =
    "[[plane]]\nname = \"wall\"\npoint = [0.2, 0.0, {}]\nnormal = [0.0, 0.0, 1.0]\n";

std::string plane_at(const char* z) {
  std::string text = kPlane;
  return text.replace(text.find("{}"), 2, z);
}

TEST_F(Commands, CheckNamesTheFlawsOfAScene) {
  for (const auto& [text, flaw] : std::vector<std::pair<std::string, std::string>>{
           {plane_at("-5") + "stiffness = 600", "outside the tip's reach"},
           {plane_at("-0.04") + "stiffness = 600\nfriction_static = 0.1\nfriction_kinetic = 0.2",
            "above friction_static"},
           {plane_at("-0.04") + "stiffness = 20000", "is stiffer than"},
           {plane_at("0.5") + "stiffness = 600", "mm inside"},
           {"title = \"x\"\n", "the scene has nothing to touch"}}) {
    write("scene.toml", text);
    const Said found = run({"check", "scene.toml"});
    EXPECT_EQ(found.status, 1) << flaw;
    EXPECT_THAT(found.out, HasSubstr(flaw));
    EXPECT_THAT(found.out, HasSubstr("warning      "));
    EXPECT_THAT(found.out, EndsWith("works, with a warning\n")) << found.out;
    const Said as_json = run({"check", "scene.toml", "--json"});
    EXPECT_EQ(as_json.status, 1);
    const json told = json::parse(as_json.out);
    ASSERT_EQ(told["warnings"].size(), 1u);
    EXPECT_EQ(told["file"], "scene.toml");
    std::string lines;
    for (const json& fact : told["facts"]) lines += fact.get<std::string>() + '\n';
    EXPECT_THAT(found.out, StartsWith(lines));
    EXPECT_THAT(found.out, HasSubstr(told["warnings"][0].get<std::string>()));
  }
  write("scene.toml", plane_at("-0.04") + "stiffness = 600");
  EXPECT_THAT(done({"check", "scene.toml"}), EndsWith("fine\n"));
  write("scene.toml", plane_at("-5") + "stiffness = 20000");
  EXPECT_THAT(run({"check", "scene.toml"}).out, EndsWith("works, with 2 warnings\n"));
  write("scene.toml", "title = \"x\"\nabout = \"Nothing, on purpose.\"\n");
  EXPECT_THAT(done({"check", "scene.toml"}), HasSubstr("to touch     nothing\n"));
}

TEST_F(Commands, CheckCountsWhatCanBeTouched) {
  write("scene.toml", plane_at("-0.06") +
                          "stiffness = 600.0\n"
                          "[[sphere]]\nname = \"a\"\ncenter = [0.2, 0.05, -0.04]\nradius = "
                          "0.01\nstiffness = 600.0\n"
                          "[[sphere]]\nname = \"b\"\ncenter = [0.2, -0.05, -0.04]\nradius = "
                          "0.01\nstiffness = 600.0\n"
                          "[[box]]\nname = \"c\"\ncenter = [0.15, 0.0, -0.05]\nsize = [0.01, 0.01, "
                          "0.01]\nstiffness = 600.0\n");
  EXPECT_THAT(run({"check", "scene.toml"}).out,
              HasSubstr("to touch     planes 1, spheres 2, boxes 1, cylinders 0, capsules 0, "
                        "models 0, stops of joints 0\n"));
}

std::string arm_text(const std::string& limits, const std::string& mass, const char* moments) {
  return R"(<robot name="made"><link name="base"/>
<joint name="hinge" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/>
<limit lower="-1.5" upper="1.25" effort="2" velocity="10"/><dynamics damping="0.03"/></joint>
<link name="a"><inertial><origin xyz="0.05 0 0"/><mass value=")" +
         mass + R"("/>
<inertia )" +
         moments +
         R"( ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="slide" type="prismatic"><parent link="a"/><child link="b"/><axis xyz="1 0 0"/>
<limit )" +
         limits +
         R"( effort="7" velocity="1"/><dynamics damping="0.5"/></joint>
<link name="b"><inertial><mass value="0.2"/><inertia ixx="1e-5" iyy="1e-5" izz="1e-5" ixy="0"
ixz="0" iyz="0"/></inertial></link>
<joint name="t" type="fixed"><parent link="b"/><child link="tip"/><origin xyz="0.15 0 0"/></joint>
<link name="tip"/></robot>)";
}

constexpr const char* kPlate = "ixx=\"1e-4\" iyy=\"1e-4\" izz=\"2e-4\"";

TEST_F(Commands, RunOfAnArmWithASlideSaysItsUnitsInJson) {
  write("arm.urdf", arm_text("lower=\"0\" upper=\"0.04\"", "0.3", kPlate));
  const std::vector<std::string> words{"run",       "--device",   "arm.urdf", "--scene",
                                       "free.toml", "--duration", "0.3",      "--json"};
  const json mixed = json::parse(run(words).out)["runs"][0];
  EXPECT_TRUE(mixed.contains("largest_error_rad_or_dm")) << mixed;
  EXPECT_TRUE(mixed.contains("rms_human_torque_N_m_or_daN"));
  std::string rail = arm_text("lower=\"0\" upper=\"0.04\"", "0.3", kPlate);
  rail.replace(rail.find("revolute"), 8, "prismatic");
  write("rail.urdf", rail);
  const Said text =
      run({"run", "--device", "rail.urdf", "--scene", "free.toml", "--duration", "0.3"});
  std::vector<std::string> again = words;
  again[2] = "rail.urdf";
  const json slides = json::parse(run(again).out)["runs"][0];
  ASSERT_TRUE(slides.contains("largest_error_m")) << slides;
  ASSERT_TRUE(slides.contains("rms_human_force_N"));
  EXPECT_NEAR(behind(text.out, "largest |x_E|"), 1e3 * slides["largest_error_m"].get<double>(),
              6e-4);
  EXPECT_NEAR(behind(text.out, "rms human torque"), slides["rms_human_force_N"].get<double>(),
              6e-5);
}

TEST_F(Commands, RunRefusesRecordingAndPictureInOneFile) {
  EXPECT_THAT(refused({"run", "--duration", "0.1", "--record", "same", "--picture", "./same"}),
              HasSubstr("--picture ./same: --record writes this file"));
}

TEST_F(Commands, CheckOfAnArmListsJointsInTheirUnits) {
  write("arm.urdf", arm_text("lower=\"0\" upper=\"0.04\"", "0.3", kPlate));
  const Said said = run({"check", "arm.urdf"});
  EXPECT_THAT(said.out, StartsWith("arm          made, 2 joints to 'tip'\n"));
  EXPECT_THAT(said.out, ContainsRegex("hinge +-1.5 to 1.25 rad +2 N m +0.03 N m s +0.3 kg"));
  // Alone on its slide: its own mass is what moves.
  EXPECT_THAT(said.out, ContainsRegex("slide +0 to 0.04 m +7 N +0.5 N s/m +0.2 kg +0.2 kg\n"));
  EXPECT_THAT(
      said.out,
      ContainsRegex("reach +0.19 m from the origin of joint 'hinge' to 'tip', moving mass 0.5 kg"));
  EXPECT_THAT(said.out, HasSubstr("picture      capsules from joint to joint\n"));
  EXPECT_THAT(said.out,
              ContainsRegex("limits +torque as in the column effort, reached in .* tip: 10 N"));
  EXPECT_THAT(said.out, ContainsRegex("condition \\(3\\) is met; by equation \\(25\\) the proposed "
                                      "law is passive at an eta of [0-9.]+ or"));
  EXPECT_THAT(run({"check", "arm.urdf", "--set", "device.torque_limit=0.5"}).out,
              ContainsRegex("limits +torque 0.5 N m, "));
  EXPECT_THAT(run({"check", "arm.urdf", "--set", "coupling.k_vc=5000"}).out,
              HasSubstr("warning      condition (3) is not met with these settings"));
}

TEST_F(Commands, CheckOfAnArmKnowsNoLimitWherePacketsAreLost) {
  write("arm.urdf", arm_text("lower=\"0\" upper=\"0.04\"", "0.3", kPlate));
  const std::string said =
      run({"check", "arm.urdf", "--coupling", "standard", "--set", "link.loss=0.1"}).out;
  EXPECT_THAT(said, HasSubstr("condition (3): no limit is known where packets are lost"));
  EXPECT_THAT(said, Not(HasSubstr("condition (3) is not met"))) << "nobody knows";
}

TEST_F(Commands, CheckOfAnArmDoubtsWhatNoBodyHas) {
  const auto check = [&](const std::string& limits, const std::string& mass, const char* moments) {
    write("arm.urdf", arm_text(limits, mass, moments));
    return run({"check", "arm.urdf"}).out;
  };
  const std::string usual = "lower=\"0\" upper=\"0.04\"";
  EXPECT_THAT(
      check(usual, "0.1", "ixx=\"100\" iyy=\"100\" izz=\"100\""),
      HasSubstr("link 'a': a moment of 100 kg m^2 with 0.1 kg would need a ring of 31.6 m radius"));
  EXPECT_THAT(check(usual, "0.1", "ixx=\"1e-5\" iyy=\"1e-5\" izz=\"1e-3\""),
              HasSubstr("at most the sum of the other two"));
  EXPECT_THAT(check(usual, "0.3", kPlate), Not(HasSubstr("warning      link")));
  EXPECT_THAT(check("lower=\"0\" upper=\"1000\"", "0.3", kPlate),
              HasSubstr("joint 'slide' slides through 1e+03 m; write the joint's real range"));
}

TEST_F(Commands, CheckOfAnArmDoubtsDegreesAndMillimetres) {
  const auto check = [&](const std::string& from, const std::string& to) {
    std::string arm = arm_text("lower=\"0\" upper=\"0.04\"", "0.3", kPlate);
    for (std::size_t at = 0; (at = arm.find(from, at)) != std::string::npos; at += to.size()) {
      arm.replace(at, from.size(), to);
    }
    write("arm.urdf", arm);
    return run({"check", "arm.urdf"}).out;
  };
  EXPECT_THAT(
      check("lower=\"-1.5\" upper=\"1.25\"", "lower=\"-90\" upper=\"90\""),
      HasSubstr("joint 'hinge' turns by 28.6 full turns, from -90 to 90 rad; are the limits "
                "in degrees?"));
  EXPECT_THAT(check("0.15 0 0", "150 0 0"),
              HasSubstr("the arm is 150 m long; are the lengths in mm?"));
  EXPECT_THAT(check("none", "none"), Not(HasSubstr("are the")));
}

TEST_F(Commands, CheckSaysWhatHandsStoriesAndSweepsHold) {
  write("hand.csv", "time_s,x_m,y_m,z_m\n0,0.19,0,0\n1.5,0.19,0.02,-0.03\n");
  EXPECT_THAT(run({"check", "hand.csv"}).out,
              HasSubstr("2 samples, 1.5 s, in a space of 0 x 20 x 30 mm"));
  write("far.csv", "time_s,x_m,y_m,z_m\n0,0.19,0,0\n1,3,0,0\n");
  const Said far = run({"check", "far.csv"});
  EXPECT_EQ(far.status, 1);
  EXPECT_THAT(far.out, HasSubstr("far.csv: the point at 1.000 s is 3.0000 m from the first joint"));
  EXPECT_THAT(run({"check", "touch.csv"}).out, HasSubstr("1001 samples, 10 s"));
  EXPECT_THAT(run({"check", "first.toml"}).out,
              HasSubstr("6 steps, 47 s, 2 runs with the same hand"));
  EXPECT_THAT(run({"check", "arms.toml"}).out, HasSubstr("468 points"));
  for (const auto& plan : fs::directory_iterator(fs::path(LIMPID_ASSETS_DIR) / "sweeps")) {
    const bool scene = plan.path().filename() == "pushed_block.toml";  // of one of the plans
    if (plan.path().extension() != ".toml" || scene) continue;
    EXPECT_THAT(run({"check", plan.path().string()}).out, StartsWith("sweep ")) << plan.path();
  }
  write("plan.toml", "measure = ['human_rms']\n[[axis]]\nkey = 'coupling.etta'\nvalues = [1]\n");
  EXPECT_THAT(refused({"check", "plan.toml"}), HasSubstr("did you mean"));
}

TEST_F(Commands, CheckRefusesWhatItDoesNotKnow) {
  write("a.txt", "words");
  EXPECT_THAT(refused({"check", "a.txt"}),
              HasSubstr("a.txt: this kind of file is not known; needed: an arm"));
  EXPECT_THAT(refused({"check", (fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5").string()}),
              HasSubstr("`limpid info "));
  EXPECT_THAT(refused({"check", "none.urdf"}), HasSubstr("none.urdf: no such file"));
  const fs::path assets = LIMPID_ASSETS_DIR;
  EXPECT_THAT(refused({"check", (assets / "presets.toml").string()}),
              HasSubstr("presets.toml: presets of settings"));
  EXPECT_THAT(refused({"check", (assets / "layouts.toml").string()}),
              HasSubstr("layouts.toml: layouts of the window"));
  write("settings.toml", "[coupling]\neta = 0.7\n");
  EXPECT_THAT(refused({"check", "settings.toml"}), HasSubstr("settings.toml: settings of a run"));
  const Said model = run({"check", (fs::path(LIMPID_ASSETS_DIR) / "scenes/cup.glb").string()});
  EXPECT_THAT(model.out, HasSubstr("triangles"));
}

}  // namespace
}  // namespace limpid
