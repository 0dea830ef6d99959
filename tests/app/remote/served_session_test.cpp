// A loop without a window, led over its control socket.
#include "app/remote/served_session.h"

#include <gmock/gmock.h>

#include <fstream>

#include "devices/files/session/session.h"
#include "tests/support/built_in.h"
#include "tests/support/line_client.h"
#include "tests/support/temp_dir.h"
#include "tests/support/until.h"
#include "tests/support/wired_device.h"

namespace limpid {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

class Served : public testing::Test {
 protected:
  ServedSession::World world(const char* scene = "table.toml") const {
    ServedSession::World world;
    world.plan.arm = test::omni();
    world.plan.document = test::omni_document(scene);
    world.plan.parameters.torque_limit = 0.4;
    return world;
  }
  // Serves a loop whose openings are answered here.
  void serve(ServedSession::World world, std::unique_ptr<Device> device = nullptr) {
    session.emplace(std::move(world), std::move(device), SafetyLimits{},
                    ServedSession::Options{
                        .open = [this](const OpenRequest& asked,
                                       const Parameters& now) { return open(asked, now); },
                        .draw =
                            [this](const fs::path& png, const RunPlan&, std::span<const double>) {
                              if (png == dir / "refused.png") throw std::runtime_error("no room");
                              std::ofstream(png) << "drawn";
                            },
                        .folder = dir / "sessions",
                        .ask = {}});
    remote =
        std::make_unique<Remote>(dir / "s/a.control", session->host(), [this] { session->cut(); });
    client.emplace(dir / "s/a.control");
    EXPECT_TRUE(until([&] { return state()["ticks"] > 20; }));
  }
  ~Served() override {
    client.reset();
    remote.reset();
    session.reset();
  }

  void turn() {
    session->turn(*remote);
    remote->turn();
    std::this_thread::sleep_for(1ms);
  }
  template <class Done>
  bool until(const Done& done) {
    turn();
    return test::until(done, [this] { turn(); });
  }
  json answer(const json& request) {
    client->say(request.dump());
    std::optional<json> line;
    until([&] { return (line = client->take()).has_value(); });
    return line.value_or(json());
  }
  json ask(const json& request) { return test::granted(answer(request)); }
  std::string refused(const json& request) { return test::reason(answer(request)); }
  json state() { return ask({{"do", "get"}, {"keys", json::array()}})["state"]; }
  json value(const std::string& channel) {
    return ask({{"do", "row"}, {"channels", {channel}}})["values"][channel];
  }

  test::TempDir dir;
  std::function<ServedSession::World(const OpenRequest&, const Parameters&)> open =
      [](const OpenRequest&, const Parameters&) -> ServedSession::World {
    throw FileError("nothing is there");
  };
  std::optional<ServedSession> session;
  std::unique_ptr<Remote> remote;
  std::optional<test::LineClient> client;
};

TEST_F(Served, RunsTheVirtualArmThatNobodyHolds) {
  serve(world());
  const json now = state();
  EXPECT_EQ(ask({{"do", "hello"}})["kind"], "serve");
  EXPECT_EQ(now["arm"], test::omni().name);
  EXPECT_EQ(now["objects"], test::omni_document("table.toml").scene.objects.size());
  EXPECT_EQ(now["recording"], false);
  EXPECT_EQ(now["trouble"], nullptr);
  EXPECT_EQ(now["lanes"], 1);
  EXPECT_EQ(now["twin"], false);
  EXPECT_EQ(now["hand"], nullptr);
}

TEST_F(Served, HoldsProgramsToTheLimitsItWasStartedWith) {
  serve(world());
  EXPECT_THAT(refused({{"do", "set"}, {"values", {{"device.torque_limit", 0.5}}}}),
              HasSubstr("device.torque_limit"));
  ask({{"do", "set"}, {"values", {{"device.torque_limit", 0.2}, {"coupling.eta", 0.6}}}});
  ask({{"do", "set"}, {"values", {{"device.torque_limit", 0.4}}}});
  EXPECT_TRUE(until([&] { return value("coupling/eta") == 0.6; }));
}

TEST_F(Served, RecordsWhatRuns) {
  serve(world());
  EXPECT_THAT(refused({{"do", "stop"}}), HasSubstr("nothing is being recorded"));
  const std::string file = (dir / "a.h5").string();
  EXPECT_EQ(ask({{"do", "record"}, {"file", file}})["file"], file);
  EXPECT_EQ(state()["recording"], true);
  EXPECT_THAT(refused({{"do", "record"}}), HasSubstr("runs already"));
  EXPECT_THAT(refused({{"do", "open"}, {"scene", "x"}}), HasSubstr("stop the recording first"));
  EXPECT_THAT(refused({{"do", "start_over"}}), HasSubstr("stop the recording first"));
  EXPECT_THAT(refused({{"do", "twin"}}), HasSubstr("stop the recording first"));
  ask({{"do", "mark"}, {"text", "here"}});
  for (int i = 0; i < 20; ++i) turn();
  const json done = ask({{"do", "stop"}});
  EXPECT_EQ(done["file"], file);
  const Session recorded = read_session(file);
  EXPECT_EQ(recorded.size(), done["rows"]);
  EXPECT_GT(recorded.size(), 10u);
  EXPECT_EQ(recorded.info.source, "nobody");
  ASSERT_EQ(recorded.marks.size(), 1u);
  EXPECT_EQ(recorded.marks[0].text, "here");
  EXPECT_THAT(refused({{"do", "record"}, {"file", file}}), HasSubstr("a.h5"));
  const std::string unnamed = ask({{"do", "record"}})["file"];
  EXPECT_THAT(unnamed, testing::StartsWith((dir / "sessions/session-").string()));
  EXPECT_EQ(ask({{"do", "stop"}})["file"], unnamed);
}

TEST_F(Served, RunsLanesBesideTheFirst) {
  serve(world());
  ask({{"do", "twin"}, {"values", {{"coupling.eta", 0.35}}}});
  EXPECT_TRUE(until([&] { return value("twin/coupling/eta") == 0.35; }));
  EXPECT_NE(value("coupling/eta"), 0.35);
  EXPECT_EQ(state()["lanes"], 2);
  EXPECT_THAT(refused({{"do", "twin"}, {"values", {{"ledger.energy", 0.02}}}}),
              HasSubstr("ledger.energy"));
  EXPECT_THAT(refused({{"do", "twin"}, {"values", {{"hand.stiffness", 444}}}}),
              HasSubstr("hand.stiffness: is one setting for all runs"));
  ask({{"do", "twin"}, {"lane", 2}});
  EXPECT_EQ(state()["lanes"], 3);
  ask({{"do", "twin"}, {"on", false}});
  EXPECT_EQ(state()["lanes"], 1);
  EXPECT_EQ(state()["twin"], false);
}

TEST_F(Served, OpensWhatIsAskedForAndGoesOnWhereThatFails) {
  serve(world());
  EXPECT_THAT(refused({{"do", "open"}}), HasSubstr("nothing to open"));
  EXPECT_THAT(refused({{"do", "open"}, {"scene", "x.toml"}}), HasSubstr("nothing is there"));
  EXPECT_EQ(state()["objects"], test::omni_document("table.toml").scene.objects.size());
  OpenRequest heard;
  open = [&](const OpenRequest& asked, const Parameters& now) {
    heard = asked;
    ServedSession::World next = world("free.toml");
    next.plan.parameters = now;
    next.plan.parameters.torque_limit = 5;
    return next;
  };
  ask({{"do", "set"}, {"values", {{"coupling.eta", 0.6}}}});
  const json opened = ask({{"do", "open"}, {"scene", "x.toml"}, {"arm", "y.urdf"}, {"tip", "z"}});
  EXPECT_EQ(heard.scene, "x.toml");
  EXPECT_EQ(heard.arm, "y.urdf");
  EXPECT_EQ(heard.tip, "z");
  EXPECT_EQ(opened["objects"], 0);
  EXPECT_EQ(value("coupling/eta"), 0.6) << "its first row is there";
  const json set =
      ask({{"do", "get"}, {"keys", {"coupling.eta", "device.torque_limit"}}})["values"];
  EXPECT_EQ(set["coupling.eta"], 0.6);
  EXPECT_LE(set["device.torque_limit"], 0.4) << "no file raises a limit";
}

// The hand of a file waits for the recording, if that is asked for.
TEST_F(Served, IsLedByAHandThatWaits) {
  serve(world());
  open = [&](const OpenRequest&, const Parameters&) {
    ServedSession::World next = world("free.toml");
    next.plan.hand = test::hand("touch.csv");
    next.led = true;
    return next;
  };
  const json opened = ask({{"do", "open"}, {"hand", "touch.csv"}, {"wait", true}});
  EXPECT_THAT(opened["hand"]["source"].get<std::string>(), HasSubstr("touch.csv"));
  EXPECT_GT(opened["hand"]["duration"], 1);
  for (int i = 0; i < 50; ++i) turn();
  EXPECT_EQ(state()["hand"]["time"], 0);
  EXPECT_TRUE(ask({{"do", "start_over"}}).contains("tick"));
  ask({{"do", "record"}, {"file", (dir / "led.h5").string()}});
  EXPECT_TRUE(until([&] { return state()["hand"]["time"] > 0.05; }));
  ask({{"do", "stop"}});
  EXPECT_THAT(read_session(dir / "led.h5").info.source, HasSubstr("touch.csv"));
}

TEST_F(Served, RefusesSessionsWhoseTickTakesTheComputer) {
  serve(world());
  open = [&](const OpenRequest&, const Parameters&) {
    ServedSession::World next = world();
    next.plan.parameters.tick = 5e-5;
    return next;
  };
  EXPECT_THAT(refused({{"do", "open"}, {"session", "x.h5"}}),
              HasSubstr("is too short for the live loop; allowed: 0.0001 to 0.1"));
}

TEST_F(Served, DrawsPicturesBesideTheLoop) {
  serve(world());
  const fs::path file = dir / "a.png";
  EXPECT_EQ(ask({{"do", "picture"}, {"file", file.string()}})["file"], file.string());
  EXPECT_TRUE(fs::exists(file));
  EXPECT_THAT(refused({{"do", "picture"}, {"file", (dir / "refused.png").string()}}),
              HasSubstr("no room"));
}

// Nobody arms a real device through it but its second button; programs cut its force.
TEST_F(Served, LeavesTheForceOfARealDeviceToItsSecondButton) {
  const auto wire = std::make_shared<test::Wire>();
  serve(world(), std::make_unique<test::WiredDevice>(3, wire));
  const auto armed = [&] { return state()["force"].get<bool>(); };
  EXPECT_FALSE(armed());
  ask({{"do", "start_over"}});
  for (int i = 0; i < 30; ++i) turn();
  EXPECT_FALSE(armed());
  const auto press = [&](std::uint32_t buttons) {
    for (const std::uint32_t now : {buttons, 0u}) {
      wire->buttons = now;
      for (int i = 0; i < 30; ++i) turn();
    }
  };
  press(1);
  EXPECT_FALSE(armed()) << "the first button";
  press(2);
  EXPECT_TRUE(until(armed));
  press(2);
  EXPECT_TRUE(until([&] { return !armed(); }));
  press(2);
  EXPECT_TRUE(until(armed));
  ask({{"do", "cut"}});
  EXPECT_TRUE(until([&] { return !armed(); }));
  EXPECT_THAT(refused({{"do", "open"}, {"arm", "omni.urdf"}}), HasSubstr("moves a real device"));
  EXPECT_THAT(refused({{"do", "twin"}}), HasSubstr("one hand cannot hold two real devices"));
}

TEST_F(Served, TakesAButtonForNothingThatIsHeldBeforeTheFirstReport) {
  const auto wire = std::make_shared<test::Wire>();
  wire->buttons_known = 0;
  serve(world(), std::make_unique<test::WiredDevice>(3, wire));
  ASSERT_TRUE(until([&] { return state()["ticks"] > 50; }));
  for (int i = 0; i < 30; ++i) turn();
  wire->buttons = 2;
  wire->buttons_known = ~0u;
  for (int i = 0; i < 100; ++i) turn();
  EXPECT_FALSE(state()["force"].get<bool>());
}

}  // namespace
}  // namespace limpid
