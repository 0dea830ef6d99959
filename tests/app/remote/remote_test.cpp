// Requests are carried out as the loop's owner does, now or later, and nobody raises a limit.
#include "app/remote/remote.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "app/remote/remote_settings.h"
#include "tests/support/built_in.h"
#include "tests/support/line_client.h"
#include "tests/support/temp_dir.h"
#include "tests/support/until.h"

namespace limpid {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::HasSubstr;

// An owner whose loop has three joints, and one client.
class RemoteTest : public testing::Test {
 protected:
  RemoteTest() : row(static_cast<std::size_t>(layout.stride()), 1.0) {
    host.kind = "test";
    host.state = [] { return json{{"arm", "none"}}; };
    host.lanes = [this] { return lanes.size(); };
    host.parameters = [this](std::size_t lane) -> const Parameters& { return lanes[lane]; };
    host.highest = [this] { return highest; };
    host.set = [this](const Parameters& p, std::size_t lane) { lanes[lane] = p; };
    host.channels = [this]() -> const TraceChannels& { return channels; };
    host.rows = [this] { return std::vector<std::span<const double>>{row}; };
    host.tick = [] { return std::uint64_t{7}; };
    host.actions["record"] = [this](const Keys&, LineServer::Client) {
      return Answer::Later([this]() -> std::optional<json> {
        if (--turns_left > 0) return std::nullopt;
        return json{{"file", "a.h5"}};
      });
    };
    host.actions["cut"] = [](const Keys&, LineServer::Client) -> Answer { return json::object(); };
    host.gone = [this](LineServer::Client) { ++gone; };
    highest.torque_limit = 0.5;
  }

  void start() {
    remote = std::make_unique<Remote>(path, host, [this] { ++cuts; });
    client.emplace(path);
  }

  void say(const std::string& line) const { client->say(line); }
  // Next line, after turns of the owner.
  json hear() {
    std::optional<json> line;
    const auto heard = [&] {
      remote->turn();
      if (auto next = client->take()) line = *next;
      return line.has_value();
    };
    test::until(heard, [this] { remote->wait_until(std::chrono::steady_clock::now() + 1ms); });
    return line.value_or(json());
  }
  void pass(std::uint64_t tick) {
    const std::span<const double> first(row);
    remote->row(LaneRows(&first, 1), tick);
  }
  json ask(const std::string& line) {
    say(line);
    return hear();
  }

  test::TempDir dir;
  std::filesystem::path path = dir / "s" / "a.control";
  RowLayout layout{3};
  TraceChannels channels{layout};
  std::vector<double> row;
  std::vector<Parameters> lanes = std::vector<Parameters>(1);
  Parameters highest;
  RemoteHost host;
  std::unique_ptr<Remote> remote;
  std::optional<test::LineClient> client;
  int cuts = 0, gone = 0, turns_left = 3;
};

TEST_F(RemoteTest, SaysWhatItIsAndWhatCanBeAsked) {
  start();
  const json ok = ask(R"({"id":1,"do":"hello"})")["ok"];
  EXPECT_EQ(ok["protocol"], 1);
  EXPECT_EQ(ok["kind"], "test");
  EXPECT_TRUE(ok["verbs"].contains("record") && ok["verbs"].contains("follow"));
  EXPECT_FALSE(ok["verbs"].contains("ask"));
  EXPECT_THAT(ask(R"({"do":"ask","text":"?"})")["error"].get<std::string>(),
              HasSubstr("needs a window"));
}

TEST_F(RemoteTest, SetsAllOrNothing) {
  start();
  EXPECT_EQ(ask(R"({"do":"set","values":{"coupling.eta":0.5,"coupling.kind":"standard"}})")["ok"],
            json({{"values", {{"coupling.eta", 0.5}, {"coupling.kind", "standard"}}}}));
  EXPECT_EQ(lanes[kMainLane].eta, 0.5);
  const json error = ask(R"({"do":"set","values":{"coupling.eta":0.7,"coupling.k_vc":"much"}})");
  EXPECT_THAT(error["error"].get<std::string>(), HasSubstr("coupling.k_vc"));
  EXPECT_EQ(lanes[kMainLane].eta, 0.5);
  EXPECT_TRUE(ask(R"({"do":"set","twin":true,"values":{"coupling.eta":2}})").contains("error"));
  lanes.resize(2);
  EXPECT_TRUE(ask(R"({"do":"set","twin":true,"values":{"coupling.eta":2}})").contains("ok"));
  EXPECT_EQ(lanes[kTwinLane].eta, 2);
  EXPECT_NE(lanes[kMainLane].eta, 2);
  for (const char* whose : {R"("twin":true)", R"("lane":1)"}) {
    const std::string values = R"("values":{"coupling.eta":5,"hand.stiffness":555})";
    const json refused = ask(R"({"do":"set",)" + std::string(whose) + "," + values + "}");
    EXPECT_THAT(refused["error"].get<std::string>(),
                HasSubstr("hand.stiffness: is one setting for all runs"));
    EXPECT_EQ(lanes[kTwinLane].eta, 2) << "what is refused changes nothing";
  }
  const std::string third = R"({"do":"set","lane":2,"values":{"coupling.eta":3}})";
  EXPECT_TRUE(ask(third).contains("error")) << "there is none";
  EXPECT_TRUE(ask(R"({"do":"set","lane":1.5,"values":{}})").contains("error"));
  EXPECT_TRUE(ask(R"({"do":"set","lane":3,"values":{}})").contains("error"));
  lanes.resize(3);
  EXPECT_TRUE(ask(third).contains("ok"));
  EXPECT_EQ(lanes[2].eta, 3);
  EXPECT_EQ(lanes[kTwinLane].eta, 2);
  const json all = ask(R"({"do":"get","keys":["coupling.eta"]})")["ok"];
  EXPECT_EQ(all["values"]["coupling.eta"], lanes[kMainLane].eta);
  EXPECT_EQ(all["twin"]["coupling.eta"], 2);
  EXPECT_EQ(all["lane3"]["coupling.eta"], 3);
}

TEST_F(RemoteTest, SetsAllOthersAsTheyUsuallyAreWhenThatIsAskedFor) {
  lanes[kMainLane].eta = 0.5;
  lanes[kMainLane].hand_stiffness = 900;
  host.usual = [] { return Parameters{}; };
  start();
  EXPECT_TRUE(ask(R"({"do":"set","reset":true,"values":{"coupling.eta":-1}})").contains("error"));
  EXPECT_EQ(lanes[kMainLane].hand_stiffness, 900) << "what is refused changes nothing";
  EXPECT_TRUE(ask(R"({"do":"set","reset":true,"values":{"coupling.k_vc":8}})").contains("ok"));
  EXPECT_EQ(lanes[kMainLane].k_vc, 8);
  EXPECT_EQ(lanes[kMainLane].eta, Parameters{}.eta);
  EXPECT_EQ(lanes[kMainLane].hand_stiffness, Parameters{}.hand_stiffness);
}

TEST(UsualSettings, StayWithinLimitsAndLeaveADeviceWhatIsItsOwn) {
  const ArmDescription arm = test::omni();
  Parameters now, chosen;
  now.eta = 0.5;
  now.tick = 0.002;
  now.friction_share = 0.3;
  now.encoder_step = 1e-3;
  chosen.torque_limit = 0.1;
  set_parameter(chosen, "ledger.energy", 0.001);
  const Parameters device = usual_settings(now, chosen, arm, true);
  EXPECT_EQ(device.eta, Parameters{}.eta);
  EXPECT_EQ(device.tick, 0.002) << "fixed while the loop runs";
  EXPECT_EQ(device.torque_limit, 0.1);
  EXPECT_EQ(parameter_number(device, *find_parameter("ledger.energy")), 0.001);
  EXPECT_EQ(device.friction_share, 0.3);
  EXPECT_EQ(device.encoder_step, 1e-3);
  const Parameters simulated = usual_settings(now, chosen, arm, false);
  EXPECT_EQ(simulated.friction_share, 0);
  EXPECT_EQ(simulated.encoder_step, 0);
}

// Broken passivity puts temporary settings in place; a request must not keep these.
TEST_F(RemoteTest, SetsOnTopOfWhatIsThereOnceWhatIsForAWhileHasEnded) {
  lanes[kMainLane].hand_stiffness = 3000;
  host.before_set = [this](LineServer::Client) { lanes[kMainLane].hand_stiffness = 300; };
  start();
  EXPECT_TRUE(ask(R"({"do":"set","values":{"coupling.eta":-1}})").contains("error"));
  EXPECT_EQ(lanes[kMainLane].hand_stiffness, 3000) << "what is refused ends nothing";
  EXPECT_TRUE(ask(R"({"do":"set","values":{"coupling.eta":0.5}})").contains("ok"));
  EXPECT_EQ(lanes[kMainLane].hand_stiffness, 300);
  EXPECT_EQ(lanes[kMainLane].eta, 0.5);
}

TEST_F(RemoteTest, GivesSettingsAsTheyAreSet) {
  start();
  const json values = ask(R"({"do":"get"})")["ok"]["values"];
  EXPECT_EQ(values.size(), parameter_table().size());
  for (const ParameterInfo& info : parameter_table()) {
    const json& value = values[info.key];
    if (value.is_null() || !info.live) continue;
    Parameters again;
    EXPECT_NO_THROW(set_by_remote(again, info.key, value, lanes[kMainLane])) << info.key;
    EXPECT_TRUE(again == lanes[kMainLane]) << info.key;
  }
  EXPECT_TRUE(ask(R"({"do":"get","keys":["no.such"]})").contains("error"));
}

TEST_F(RemoteTest, AnswersLaterWhatTakesItsTimeAndMeanwhileTheRest) {
  turns_left = 1000;
  start();
  say(R"({"id":1,"do":"record"})");
  EXPECT_EQ(ask(R"({"id":2,"do":"get","keys":[]})")["id"], 2);
  turns_left = 1;
  EXPECT_EQ(hear(), json({{"id", 1}, {"ok", {{"file", "a.h5"}}}}));
}

TEST_F(RemoteTest, CutsBeforeTheOwnerHasItsTurn) {
  start();
  say(R"({"do":"cut"})");
  test::until([this] { return cuts != 0; });
  EXPECT_EQ(cuts, 1);
  EXPECT_TRUE(hear().contains("ok"));
}

TEST_F(RemoteTest, SendsRowsAtTheirRateAndCountsThoseThatAreMissing) {
  start();
  const json ok =
      ask(R"({"do":"follow","channels":["coupling/eta","twin/coupling/eta"],"rate":500})")["ok"];
  EXPECT_EQ(ok["every"], 2);
  for (const std::uint64_t tick : {10u, 11u, 12u, 13u, 20u}) pass(tick);
  EXPECT_EQ(hear(), json({{"rows", {{10, 1.0, nullptr}, {12, 1.0, nullptr}, {20, 1.0, nullptr}}},
                          {"dropped", 3}}));
  EXPECT_TRUE(ask(R"({"do":"follow"})").contains("ok"));
  pass(30);
  EXPECT_EQ(ask(R"({"id":5,"do":"get","keys":[]})")["id"], 5);
}

// Rows of further runs come by their names, and are null while no such run is there.
TEST_F(RemoteTest, SendsTheRowsOfEachRun) {
  start();
  ask(R"({"do":"follow","channels":["coupling/eta","twin/coupling/eta","lane3/coupling/eta"]})");
  std::array<std::vector<double>, kMostLanes> all;
  std::array<std::span<const double>, kMostLanes> rows;
  for (std::size_t i = 0; i < kMostLanes; ++i) {
    all[i].assign(row.size(), 1.0 + static_cast<double>(i));
    rows[i] = all[i];
  }
  remote->row(rows, 0);
  EXPECT_EQ(hear()["rows"], json({{0, 1.0, 2.0, 3.0}}));
  all[2][0] = std::nan("");  // no third run
  remote->row(rows, 10);
  EXPECT_EQ(hear()["rows"], json({{10, 1.0, 2.0, nullptr}}));
}

TEST_F(RemoteTest, KnowsNoPlaceOfContactsThatAreNotThere) {
  std::ranges::fill(layout.in(std::span(row), Column::contact_point), 0.0);
  const auto forces = layout.in(std::span(row), Column::contact_force);
  std::ranges::fill(forces, 0.0);
  forces[4] = 7;  // of the second contact
  start();
  json wanted{nullptr, nullptr, nullptr, 0.0, 0.0, 0.0};
  wanted.insert(wanted.end(), 6, nullptr);
  const json values =
      ask(R"({"do":"row","channels":["contact/point","contact/point.1"]})")["ok"]["values"];
  EXPECT_EQ(values, json({{"contact/point", wanted}, {"contact/point.1", nullptr}}));
  EXPECT_EQ(ask(R"({"do":"row"})")["ok"]["values"].at("contact/point.12"), nullptr);
  ask(R"({"do":"follow","channels":["contact/point"]})");
  pass(0);
  EXPECT_EQ(hear()["rows"], json::array({{0, wanted}}));
}

// A channel has the same name live and recorded.
TEST_F(RemoteTest, KnowsTheNamesThatSessionsHave) {
  const ArmDescription arm = test::omni();
  channels = TraceChannels(arm, layout, {});
  std::ranges::copy(std::array{1.0, 2.0, 3.0},
                    layout.in(std::span(row), Column::hand_torque).begin());
  layout.in(std::span(row), Column::time)[0] = 0.5;
  std::ranges::fill(layout.in(std::span(row), Column::contact_force), 0.0);
  layout.in(std::span(row), Column::contact_force)[2] = 7;
  start();
  const json ok = ask(R"({"do":"row","channels":["time","hand/torque","hand/torque.2"]})")["ok"];
  EXPECT_EQ(ok["values"],
            json({{"time", 0.5}, {"hand/torque", {1.0, 2.0, 3.0}}, {"hand/torque.2", 2.0}}));
  const json follows =
      ask(R"({"do":"follow","channels":["hand/torque","contact/total_force","twin/hand/torque"]})")
          ["ok"];
  EXPECT_EQ(follows["units"], json({"N m", "N", "N m"}));
  pass(0);
  EXPECT_EQ(hear()["rows"], json({{0, {1.0, 2.0, 3.0}, {0.0, 0.0, 7.0}, nullptr}}));
  for (const ColumnInfo& column : kColumnInfo) {
    if (layout.width(column.column) == 0) continue;  // of bodies, which are absent
    const std::string name = column.path + 1;
    EXPECT_TRUE(ask(R"({"do":"row","channels":[")" + name + R"("]})").contains("ok")) << name;
  }
  for (const DerivedInfo& derived : kDerivedInfo) {
    const std::string name = derived.path + 1;
    const json value = ask(R"({"do":"row","channels":[")" + name + R"("]})")["ok"]["values"][name];
    EXPECT_EQ(value.size(), 3u) << name;
  }
  EXPECT_TRUE(ask(R"({"do":"row","channels":["hand/torq"]})").contains("error"));
}

TEST_F(RemoteTest, DropsRowsOfOneThatDoesNotReadAndSaysHowMany) {
  start();
  ask(R"({"do":"follow","channels":["coupling/eta"],"rate":1000})");
  for (std::uint64_t tick = 0; tick < 400'000; ++tick) pass(tick);
  std::uint64_t seen = 0, dropped = 0;
  for (json line = hear(); dropped == 0 && line.contains("rows"); line = hear()) {
    seen += line["rows"].size();
    dropped = line["dropped"].get<std::uint64_t>();
    pass(400'000 + seen);
  }
  EXPECT_GT(dropped, 0u);
}

TEST_F(RemoteTest, ForgetsAClientThatIsGone) {
  start();
  ask(R"({"do":"follow","channels":["coupling/eta"]})");
  say(R"({"do":"record"})");
  client->leave();
  test::until([this] { return gone != 0; },
              [this] {
                remote->turn();
                remote->wait_until(std::chrono::steady_clock::now() + 1ms);
              });
  EXPECT_EQ(gone, 1);
  pass(1);
  remote->turn();
}

TEST(SetByRemote, LowersLimitsOnly) {
  Parameters highest;
  highest.torque_limit = 0.5;
  highest.energy = 0.005;
  for (const char* key : {"device.torque_limit", "ledger.energy"}) {
    Parameters p = highest;
    const double most = parameter_number(highest, *find_parameter(key));
    EXPECT_THROW(set_by_remote(p, key, 1.01 * most, highest), RemoteError) << key;
    EXPECT_TRUE(p == highest);
    set_by_remote(p, key, 0.5 * most, highest);
    set_by_remote(p, key, most, highest);
    EXPECT_TRUE(p == highest);
  }
}

TEST(SetByRemote, KnowsTheArmsOwnLimits) {
  const ArmDescription arm = test::omni();
  const double own = std::ranges::min(arm.joints, {}, &Joint::effort).effort;
  const Parameters highest = with_limits_of(arm, {});
  Parameters p;
  set_by_remote(p, "device.torque_limit", own, highest);
  EXPECT_THROW(set_by_remote(p, "device.torque_limit", 1.1 * own, highest), RemoteError);
  // A file cannot raise a limit above a person's choice.
  Parameters of_file;
  of_file.torque_limit = 100;
  hold_limits(of_file, Parameters{}, arm);
  EXPECT_TRUE(std::isnan(of_file.torque_limit));
  of_file.torque_limit = 0.5 * own;
  hold_limits(of_file, Parameters{}, arm);
  EXPECT_EQ(of_file.torque_limit, 0.5 * own);
}

TEST(SetByRemote, LeavesWhatIsFixedWhileTheLoopRuns) {
  Parameters p;
  EXPECT_THROW(set_by_remote(p, "loop.tick", 0.002, p), RemoteError);
  EXPECT_NO_THROW(set_by_remote(p, "loop.tick", 0.001, p));
  for (const json& value : {json::array(), json(), json::object()}) {
    EXPECT_THROW(set_by_remote(p, "coupling.eta", value, p), RemoteError);
  }
  EXPECT_THROW(set_by_remote(p, "coupling.eta", 1e300, p), ParameterError);
}

}  // namespace
}  // namespace limpid
