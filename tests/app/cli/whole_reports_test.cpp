// Whole reports of `info` and `run`, against numbers computed from the rows themselves, and of what
// a hand is found to be.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "app/run/measured_hand.h"
#include "app/story/run_story.h"
#include "devices/files/session/session.h"
#include "tests/app/cli/said.h"

namespace limpid {
namespace {

using nlohmann::json;
using test::lines_of;
using test::Said;
using test::text_of;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class WholeReports : public test::Program {
 protected:
  static json told(std::vector<std::string> words) {
    words.emplace_back("--json");
    const Said said = run(words);
    EXPECT_EQ(said.status, 0) << said.err;
    return json::parse(said.out, nullptr, false);
  }
};

double norm_of(std::span<const double> values) {
  double sum = 0;
  for (const double each : values) sum += each * each;
  return std::sqrt(sum);
}

// The numbers of a run, from its rows.
struct RunNumbers {
  double in_contact = 0;                                 // share
  double error = 0, contact = 0, human = 0;              // [rad, N m, N m]
  double total = 0, highest = -HUGE_VAL, commanded = 0;  // [J]
};

RunNumbers numbers_in(const Session& run) {
  RunNumbers all;
  const auto rows = static_cast<double>(run.size());
  for (std::size_t k = 0; k < run.size(); ++k) {
    const auto device = run.at(k, Column::device_position);
    std::vector<double> apart(device.begin(), device.end());
    for (std::size_t i = 0; i < apart.size(); ++i) apart[i] -= run.at(k, Column::proxy_position)[i];
    const double contact = norm_of(run.at(k, Column::contact_torque));
    all.in_contact += (contact > 0 ? 1 : 0) / rows;
    all.error = std::max(all.error, norm_of(apart));
    all.contact = std::max(all.contact, contact);
    all.human += std::pow(norm_of(run.at(k, Column::hand_torque)), 2) / rows;
    all.total = run.at(k, Column::energy_total)[0];
    all.highest = std::max(all.highest, all.total);
    all.commanded = run.at(k, Column::energy_commanded)[0];
  }
  all.human = std::sqrt(all.human);
  return all;
}

std::string text_with(const RunNumbers& n, std::size_t ticks) {
  return fmt::format(
      "ticks                    {}\n"
      "in contact               {:.0f} %\n"
      "largest |x_E|            {:.3f} mrad\n"
      "largest |f2|             {:.4f} N m\n"
      "rms human torque         {:.4f} N m\n"
      "E_c total                {:.3f} mJ (highest {:.3f} mJ)\n"
      "E_c commanded            {:.3f} mJ\n",
      ticks, 100 * n.in_contact, 1e3 * n.error, n.contact, n.human, 1e3 * n.total, 1e3 * n.highest,
      1e3 * n.commanded);
}

// A run that is not passive, with all that a file may say of it.
TEST_F(WholeReports, OfInfoSayAllThatARecordingHolds) {
  const Said ran = run({"run", "--coupling", "proposed", "--eta", "0.05", "--set",
                        "hand.stiffness=3000", "--set", "hand.damping=0", "--duration", "4",
                        "--set", "link.delay=1", "--record", "a.h5"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  Session session = read_session("a.h5");
  session.info.created = "2026-01-02T03:04:05Z";
  session.info.build = "a build";
  session.info.source = "a hand";
  session.info.safety = "tip_force = 3\nrange = 0.5";
  session.info.seed = 11;
  session.changes = {{1000, "observer.alpha = 0.0123"}};
  session.marks = {{50, "here"}, {2500, "there"}};
  SessionWriter writer("b.h5", session.info, false);
  writer.append(session.rows);
  for (const SettingChange& change : session.changes) writer.append(change);
  for (const Mark& mark : session.marks) writer.append(mark);
  writer.close();
  const RunNumbers n = numbers_in(session);
  const std::string before =
      "b.h5\n"
      "created                  2026-01-02T03:04:05Z by limpid " +
      session.info.app_version +
      "\n"
      "build                    a build\n"
      "hand                     a hand\n"
      "coupling at first        proposed, eta 0.05\n"
      "link at first            1 ticks each way, jitter 0, loss 0\n"
      "settings unlike defaults hand.stiffness = 3000.0\n"
      "                         hand.damping = 0.0\n"
      "limits of force          tip_force = 3 range = 0.5\n"
      "arm                      3 joints, tick 0.001 s, seed 11\n"
      "length                   4.000 s\n" +
      text_with(n, 4000);
  const std::string text = done({"info", "b.h5"});
  EXPECT_THAT(text, StartsWith(before));
  const json all = told({"info", "b.h5"});
  ASSERT_FALSE(all["warnings"].empty()) << "it is not passive";
  std::string rest = text.substr(before.size());
  if (rest.starts_with("motors at their limit")) rest.erase(0, rest.find('\n') + 1);
  std::string after =
      "force                    on all the time\n"
      "contacts                 the 4 strongest contacts of every tick, x, y, z one after the "
      "other\n";
  EXPECT_THAT(all["warnings"][0].get<std::string>(), HasSubstr("not passive"));
  for (const json& warning : all["warnings"]) {
    after += "warning                  " + warning.get<std::string>() + '\n';
  }
  after +=
      "from    1.000 s          observer.alpha = 0.0123\n"
      "mark    0.050 s          here\n"
      "mark    2.500 s          there\n";
  EXPECT_EQ(rest, after);
  const json expected{{"file", "b.h5"},
                      {"created", "2026-01-02T03:04:05Z"},
                      {"build", "a build"},
                      {"source", "a hand"},
                      {"joints", 3},
                      {"tick_s", 0.001},
                      {"seed", 11},
                      {"late_ticks", 0},
                      {"largest_lateness_s", 0.0},
                      {"length_s", 4.0},
                      {"objects", json::array()}};
  for (const auto& [key, value] : expected.items()) {
    EXPECT_EQ(all[key], value) << key;
  }
  EXPECT_EQ(all["changes"], json({{{"row", 1000}, {"setting", "observer.alpha = 0.0123"}}}));
  EXPECT_EQ(all["marks"],
            json({{{"row", 50}, {"text", "here"}}, {{"row", 2500}, {"text", "there"}}}));
  const json& lane = all["runs"][0];
  EXPECT_EQ(lane["ticks"], 4000);
  EXPECT_NEAR(lane["share_in_contact"], n.in_contact, 1e-9);
  EXPECT_NEAR(lane["largest_error_rad"], n.error, 1e-12);
  EXPECT_NEAR(lane["largest_contact_torque_N_m"], n.contact, 1e-12);
  EXPECT_NEAR(lane["rms_human_torque_N_m"], n.human, 1e-9);
  EXPECT_NEAR(lane["energy_total_J"], n.total, 1e-12);
  EXPECT_NEAR(lane["highest_energy_total_J"], std::max(0.0, n.highest), 1e-12);
  EXPECT_NEAR(lane["energy_commanded_J"], n.commanded, 1e-12);
}

// Columns of all runs, and how the others compare with the first.
TEST_F(WholeReports, OfRunsBesideEachOtherAreATable) {
  const std::vector<std::string> names{"first", "twin", "lane3"};
  for (const std::size_t lanes : {2u, 3u}) {
    std::vector<std::string> words{"run",      "--coupling", "standard", "--duration", "1.5",
                                   "--record", "a.h5",       "--force",  "--twin"};
    if (lanes == 3) words.insert(words.end(), {"--lane3", "coupling.kind=proposed"});
    done(words);
    const Session session = read_session("a.h5");
    ASSERT_EQ(session.lanes(), lanes);
    std::vector<RunNumbers> n;
    std::string table =
        fmt::format("{} runs with the same hand\n{:<24}", lanes == 2 ? "two" : "three", "");
    for (std::size_t i = 0; i < lanes; ++i) {
      n.push_back(numbers_in(session.lane(i)));
      table += fmt::format(" {:>16}", names[i]);
    }
    table += "      ";
    for (std::size_t i = 1; i < lanes; ++i) table += "      ratio";
    table += '\n';
    const auto row = [&](const char* what, const char* unit, auto value) {
      table += fmt::format("{:<24}", what);
      for (const RunNumbers& each : n) table += fmt::format(" {:>16.4f}", value(each));
      table += fmt::format(" {:<5}", unit);
      for (std::size_t i = 1; i < lanes; ++i) {
        const bool none = std::abs(value(n[0])) <= 1e-9;
        table += none ? fmt::format(" {:>10}", "-")
                      : fmt::format(" {:>10.3g}", value(n[i]) / value(n[0]));
      }
      table += '\n';
    };
    row("in contact", "%", [](const RunNumbers& of) { return 100 * of.in_contact; });
    row("largest |x_E|", "mrad", [](const RunNumbers& of) { return 1e3 * of.error; });
    row("largest |f2|", "N m", [](const RunNumbers& of) { return of.contact; });
    row("rms human torque", "N m", [](const RunNumbers& of) { return of.human; });
    row("E_c total", "mJ", [](const RunNumbers& of) { return 1e3 * of.total; });
    EXPECT_THAT(done({"info", "a.h5"}), HasSubstr(table));
    const json all = told({"info", "a.h5"});
    ASSERT_EQ(all["runs"].size(), lanes);
    for (std::size_t i = 0; i < lanes; ++i) {
      EXPECT_NEAR(all["runs"][i]["largest_error_rad"], n[i].error, 1e-12) << i;
    }
  }
  EXPECT_THAT(refused({"run", "--lane3", "--duration", "0.1"}),
              HasSubstr("--lane3: needs --twin as well"));
}

TEST_F(WholeReports, OfInfoSayWhenForceWasOff) {
  done({"run", "--duration", "0.1", "--record", "a.h5"});
  Session session = read_session("a.h5");
  const auto stride = static_cast<std::size_t>(session.layout.stride());
  for (std::size_t k = 20; k < 50; ++k) {
    const auto row = std::span(session.rows).subspan(k * stride, stride);
    session.layout.in(row, Column::force_state)[0] = 3;
    if (k < 25) session.layout.in(row, Column::force_state)[0] = 1;
  }
  write_session(session, {}, "b.h5", false);
  EXPECT_THAT(done({"info", "b.h5"}),
              ContainsRegex("force off or reduced     0.030 s of 0.100 s, without fade-ins\n"
                            "  for    0.005 s         force [^\n]+\n"
                            "  for    0.025 s         force [^\n]+\ncontacts "));
}

// The first edition had no points of contact: their force is no number in its rows.
TEST_F(WholeReports, OfInfoSayThatContactsAreNotRecorded) {
  done({"run", "--duration", "0.05", "--record", "a.h5"});
  Session session = read_session("a.h5");
  const auto stride = static_cast<std::size_t>(session.layout.stride());
  for (std::size_t k = 0; k < session.size(); ++k) {
    const auto row = std::span(session.rows).subspan(k * stride, stride);
    std::ranges::fill(session.layout.in(row, Column::contact_force), std::nan(""));
  }
  write_session(session, {}, "b.h5", false);
  EXPECT_THAT(done({"info", "b.h5"}),
              HasSubstr("contacts                 contact points and forces were not recorded\n"));
}

TEST_F(WholeReports, OfAReplayAreThoseOfTheRunItself) {
  const std::string first = done(
      {"run", "--duration", "0.6", "--coupling", "proposed", "--eta", "0.8", "--record", "a.h5"});
  const auto numbers = [](const std::string& text) {
    return text.substr(text.find("ticks "), text.find(" s in ") - text.find("ticks "));
  };
  const Said again = run({"run", "--hand", "a.h5", "--record", "b.h5"});
  EXPECT_EQ(again.status, 0);
  EXPECT_EQ(numbers(again.out), numbers(first));
  EXPECT_EQ(again.err, "") << "a recording has its own settings";
  const Session one = read_session("a.h5"), two = read_session("b.h5");
  ASSERT_EQ(one.size(), two.size());
  for (const std::size_t k : {std::size_t{0}, one.size() / 2, one.size() - 1}) {
    const auto before = one.at(k, Column::device_position),
               now = two.at(k, Column::device_position);
    EXPECT_TRUE(std::ranges::equal(before, now)) << k;
  }
  const Said other = run({"run", "--hand", "a.h5", "--eta", "0.5", "--record", "c.h5"});
  EXPECT_EQ(other.status, 0);
  EXPECT_THAT(done({"info", "c.h5"}), HasSubstr("proposed, eta 0.5\n"));
}

// Half the tick: twice the rows, and a change stays at its time.
TEST_F(WholeReports, OfAReplayKeepTheTimesOfChangesAtAnotherTick) {
  done({"run", "--duration", "0.2", "--twin", "--record", "a.h5"});
  Session session = read_session("a.h5");
  session.changes = {{100, "coupling.eta = 0.75"}};
  session.beside[0].changes = {{150, "coupling.eta = 0.65"}};
  write_session(session, {}, "b.h5", false);
  const Said said = run({"run", "--hand", "b.h5", "--set", "loop.tick=0.0005", "--record", "c.h5"});
  ASSERT_EQ(said.status, 0) << said.err;
  const Session twice = read_session("c.h5");
  EXPECT_EQ(twice.size(), 400u);
  EXPECT_EQ(twice.info.tick, 0.0005);
  ASSERT_EQ(twice.changes.size(), 1u);
  EXPECT_EQ(twice.changes[0].row, 200u);
  EXPECT_EQ(twice.at(199, Column::eta)[0], session.at(0, Column::eta)[0]);
  EXPECT_EQ(twice.at(201, Column::eta)[0], 0.75);
  const auto of_twin =
      std::ranges::find(twice.beside[0].changes, "coupling.eta = 0.65", &SettingChange::setting);
  ASSERT_NE(of_twin, twice.beside[0].changes.end());
  EXPECT_EQ(of_twin->row, 300u);
  EXPECT_THAT(done({"info", "c.h5"}), HasSubstr("from    0.100 s          coupling.eta = 0.75\n"));
}

TEST_F(WholeReports, OfAReplayHaveTheSceneAndTheArmThatAreNamed) {
  done({"run", "--duration", "0.1", "--record", "a.h5"});
  done({"run", "--hand", "a.h5", "--scene", "free.toml", "--record", "free.h5"});
  EXPECT_THAT(read_session("a.h5").info.scene, HasSubstr("table"));
  EXPECT_THAT(read_session("free.h5").info.scene, Not(HasSubstr("table top")));
  const Said other = run({"run", "--hand", "a.h5", "--device", "touch.urdf", "--record", "t.h5"});
  EXPECT_EQ(other.status, 0) << other.err;
  EXPECT_THAT(read_session("t.h5").info.device_urdf, HasSubstr("\"touch\""));
  EXPECT_EQ(read_session("t.h5").info.scene, read_session("a.h5").info.scene);
  EXPECT_THAT(refused({"run", "--hand", "a.h5", "--readings"}),
              HasSubstr("--readings: not together with a recorded session"));
}

TEST_F(WholeReports, OfVariationsTakeMagnetsForMoreThanAPath) {
  write("plain.csv", "time_s,x_m,y_m,z_m\n0,0.19,0,0\n0.2,0.19,0.01,0\n");
  write("magnet.csv", "time_s,x_m,y_m,z_m,magnet\n0,0.19,0,0,0\n0.2,0.19,0.01,0,1\n");
  EXPECT_EQ(run({"run", "--hand", "plain.csv", "--variation", "1"}).status, 0);
  EXPECT_EQ(run({"run", "--hand", "magnet.csv"}).status, 0);
  EXPECT_THAT(refused({"run", "--hand", "magnet.csv", "--variation", "1"}),
              HasSubstr("--variation: --hand magnet.csv contains more than a path"));
}

// The simulated hand is a spring and a damper as they are set, so its grip is known.
TEST_F(WholeReports, OfAMeasuredGripFindTheHandThatIsSet) {
  const std::vector<std::string> words{"run",   "--measure-grip",     "--scene", "free.toml",
                                       "--set", "hand.stiffness=400", "--set",   "hand.damping=3"};
  std::vector<std::string> recorded = words;
  recorded.insert(recorded.end(), {"--record", "grip.h5"});
  const std::string text = done(recorded);
  const std::size_t at = text.find("the grip, measured         known;");
  ASSERT_NE(at, std::string::npos) << text;
  const json all = told(words);
  const json& grip = all["measured_grip"];
  EXPECT_EQ(grip["known"], true);
  EXPECT_NEAR(grip["stiffness"]["value"], 400,
              std::max(8.0, 2 * grip["stiffness"]["bound"].get<double>()));
  EXPECT_NEAR(grip["damping"]["value"], 3,
              std::max(0.3, 2 * grip["damping"]["bound"].get<double>()));
  EXPECT_GT(grip["stiffness"]["bound"], 0);
  EXPECT_GT(grip["moved"], 0);
  EXPECT_EQ(grip["touched"], 0) << "nothing is there";
  EXPECT_EQ(all["recorded"], nullptr);
  EXPECT_EQ(all["runs"][0]["ticks"], std::lround(1e3 * grip_run_duration()));
  const auto lines = lines_of(text.substr(at));
  double shown = 0;
  ASSERT_EQ(std::sscanf(lines.at(1).c_str(), "stiffness %lf", &shown), 1) << lines[1];
  EXPECT_NEAR(shown, grip["stiffness"]["value"].get<double>(), 0.51);
  // The session says the same, and walls in this hand besides.
  const std::string analyzed = done({"analyze", "--grip-of", "grip.h5"});
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(lines_of(analyzed).at(i), lines.at(i));
  const json of_session = told({"analyze", "--grip-of", "grip.h5"});
  EXPECT_EQ(of_session["measured_grip"], grip);
  EXPECT_EQ(of_session["units"]["measured_grip.stiffness.value"], "N/m");
  EXPECT_NEAR(of_session["grip"]["from"].get<double>(),
              grip["stiffness"]["value"].get<double>() - grip["stiffness"]["bound"].get<double>(),
              1e-6);
  EXPECT_NEAR(of_session["grip"]["to"].get<double>(),
              grip["stiffness"]["value"].get<double>() + grip["stiffness"]["bound"].get<double>(),
              1e-6);
  EXPECT_THAT(analyzed, HasSubstr("stable walls, "));
  EXPECT_NE(run({"analyze", "--grip-of", "grip.h5", "--device", "omni.urdf"}).status, 0);
}

TEST_F(WholeReports, OfAGripNeedTheirTime) {
  EXPECT_THAT(refused({"run", "--measure-grip", "--duration", "1"}),
              HasSubstr(fmt::format("--measure-grip: give --duration of at least {:.4g} s",
                                    grip_run_duration())));
  EXPECT_THAT(done({"run", "--help"}), HasSubstr(fmt::format("{:.4g}", grip_run_duration())));
  done({"run", "--duration", "0.1", "--record", "none.h5"});
  EXPECT_THAT(refused({"analyze", "--grip-of", "none.h5"}),
              HasSubstr("none.h5: the grip was not measured"));
}

}  // namespace
}  // namespace limpid
