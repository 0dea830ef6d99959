// A window that is led by programs on its control socket.
#include "app/desktop/shell/window_remote.h"

#include <fstream>

#include "devices/files/session/session_file.h"
#include "tests/app/desktop/shell/whole_window.h"
#include "tests/support/line_client.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

class LedWindow : public WholeWindow {
 protected:
  void SetUp() override {
    WholeWindow::SetUp();
    if (!desktop) return;
    remote.emplace(dir / "s/window.control", *desktop);
    client.emplace(dir / "s/window.control");
  }
  void TearDown() override {
    client.reset();
    other.reset();
    remote.reset();
    WholeWindow::TearDown();
  }

  // Draws frames, with the turns of a window that is led.
  void turns(int count = 1) {
    for (int i = 0; i < count; ++i) {
      frames(1);
      remote->turn();
    }
  }
  template <class Done>
  bool in_time(Done done) {
    return until([&] {
      remote->turn();
      return done();
    });
  }
  json hear(test::LineClient& from) {
    std::optional<json> line;
    in_time([&] { return (line = from.take()).has_value(); });
    return line.value_or(json());
  }
  json answer(const json& request) {
    client->say(request.dump());
    return hear(*client);
  }
  // Return the answer to a request that is granted, and the reason of one that is refused.
  json ask(const json& request) { return test::granted(answer(request)); }
  std::string refused(const json& request) { return test::reason(answer(request)); }
  json state() { return ask({{"do", "get"}, {"keys", json::array()}})["state"]; }
  double eta() const { return desktop->settings.parameters().eta; }

  std::optional<WindowRemote> remote;
  std::optional<test::LineClient> client, other;
};

TEST_F(LedWindow, SaysWhatItIs) {
  const json hello = ask({{"do", "hello"}});
  EXPECT_EQ(hello["kind"], "window");
  for (const char* verb : {"open", "record", "stop", "start_over", "mark", "twin", "blind", "ask",
                           "picture", "cut", "set", "get", "row", "follow"}) {
    EXPECT_TRUE(hello["verbs"].contains(verb)) << verb;
  }
  EXPECT_EQ(state()["arm"], desktop->live.stage().arm().name);
}

TEST_F(LedWindow, SetsWhatIsSetUntilTheLeaderIsGone) {
  const double before = eta();
  ask({{"do", "set"}, {"values", {{"coupling.eta", 0.45}, {"coupling.kind", "predictive"}}}});
  EXPECT_EQ(eta(), 0.45);
  EXPECT_TRUE(in_time([&] {
    return ask({{"do", "row"}, {"channels", {"coupling/eta"}}})["values"]["coupling/eta"] == 0.45;
  })) << "in the loop";
  other.emplace(dir / "s/window.control");
  other->say(R"({"do":"hello"})");
  EXPECT_TRUE(hear(*other).contains("ok"));
  other->leave();
  turns(5);
  EXPECT_EQ(eta(), 0.45) << "another one, who has set nothing, is gone";
  client->leave();
  EXPECT_TRUE(in_time([&] { return eta() == before; }));
}

TEST_F(LedWindow, HoldsProgramsToTheLimitsOfThePerson) {
  desktop->settings.parameters().torque_limit = 0.2;
  turns(2);
  EXPECT_THAT(refused({{"do", "set"}, {"values", {{"device.torque_limit", 0.3}}}}),
              HasSubstr("device.torque_limit"));
  ask({{"do", "set"}, {"values", {{"device.torque_limit", 0.1}}}});
  turns(2);
  ask({{"do", "set"}, {"values", {{"device.torque_limit", 0.2}}}});
  EXPECT_EQ(desktop->settings.parameters().torque_limit, 0.2);
}

TEST_F(LedWindow, OpensScenesAndArms) {
  const json scene = ask({{"do", "open"}, {"scene", "spheres.toml"}});
  EXPECT_THAT(scene["file"].get<std::string>(), HasSubstr("scenes/spheres.toml"));
  EXPECT_EQ(scene["objects"], desktop->document.editor().scene().objects.size());
  const std::string before = desktop->live.stage().arm().name;
  const json arm = ask({{"do", "open"}, {"arm", "paddle.urdf"}});
  EXPECT_EQ(arm["arm"], "paddle");
  EXPECT_EQ(arm["joints"], 1);
  EXPECT_NE(before, "paddle");
}

TEST_F(LedWindow, PlaysSessionsAndHands) {
  EXPECT_EQ(ask({{"do", "open"}, {"session", "gears.h5"}})["playing"], true);
  EXPECT_TRUE(desktop->playback.on());
  EXPECT_TRUE(ask({{"do", "start_over"}}).contains("tick"));
  EXPECT_FALSE(desktop->playback.on()) << "back to live";
  EXPECT_EQ(ask({{"do", "open"}, {"hand", "touch.csv"}})["playing"], true);
}

TEST_F(LedWindow, RefusesASessionThatCannotBeReadWhileAnotherOneIsShown) {
  EXPECT_EQ(ask({{"do", "open"}, {"session", "gears.h5"}})["playing"], true);
  const fs::path broken = dir / "broken.h5";
  std::ofstream(broken) << "x";
  EXPECT_THAT(refused({{"do", "open"}, {"session", broken.string()}}), HasSubstr("broken.h5"));
  EXPECT_FALSE(desktop->playback.on()) << "it is not what was asked for";
}

TEST_F(LedWindow, RefusesToOpenWhatIsNotThereOrNotAllowed) {
  EXPECT_THAT(refused({{"do", "open"}, {"scene", "nowhere.toml"}}),
              HasSubstr("there is no file \"nowhere.toml\""));
  EXPECT_THAT(refused({{"do", "open"}, {"scene", "/nowhere.toml"}}), HasSubstr("there is no file"));
  EXPECT_THAT(refused({{"do", "open"}}), HasSubstr("one of scene, arm, session, hand"));
  EXPECT_THAT(refused({{"do", "open"}, {"scene", "spheres.toml"}, {"hand", "touch.csv"}}),
              HasSubstr("one of scene, arm, session, hand"));
  EXPECT_THAT(refused({{"do", "open"}, {"scene", "spheres.toml"}, {"tip", "x"}}),
              HasSubstr("belongs to an arm"));
  EXPECT_THAT(refused({{"do", "open"}, {"hand", "touch.csv"}, {"wait", true}}),
              HasSubstr("limpid serve"));
  const fs::path broken = dir / "broken.toml";
  std::ofstream(broken) << "[[sphere]]\ncenter = [0, 0, 0]\nradius = \"wide\"\n";
  EXPECT_THAT(refused({{"do", "open"}, {"scene", broken.string()}}), HasSubstr("radius"));
  const fs::path no_arm = dir / "broken.urdf";
  std::ofstream(no_arm) << "<robot";
  EXPECT_THAT(refused({{"do", "open"}, {"arm", no_arm.string()}}), HasSubstr("broken.urdf"));
  const fs::path no_session = dir / "broken.h5";
  std::ofstream(no_session) << "x";
  EXPECT_THAT(refused({{"do", "open"}, {"session", no_session.string()}}), HasSubstr("broken.h5"));
  desktop->world.add_object({.shape = Sphere{}});
  turns(2);
  EXPECT_THAT(refused({{"do", "open"}, {"scene", "spheres.toml"}}),
              HasSubstr("the scene has unsaved changes"));
}

TEST_F(LedWindow, RecordsUnderTheNameThatIsAskedFor) {
  EXPECT_THAT(refused({{"do", "stop"}}), HasSubstr("nothing is being recorded"));
  const std::string file = (dir / "a.h5").string();
  EXPECT_EQ(ask({{"do", "record"}, {"file", file}})["file"], file);
  EXPECT_TRUE(desktop->live.recording());
  EXPECT_THAT(refused({{"do", "record"}}), HasSubstr("a recording runs already"));
  EXPECT_THAT(refused({{"do", "open"}, {"scene", "spheres.toml"}}),
              HasSubstr("stop the recording first"));
  EXPECT_THAT(refused({{"do", "start_over"}}), HasSubstr("stop the recording first"));
  EXPECT_TRUE(ask({{"do", "mark"}, {"text", "here"}}).contains("time"));
  turns(5);
  const json done = ask({{"do", "stop"}});
  EXPECT_EQ(done["file"], file);
  EXPECT_EQ(done["dropped"], 0);
  EXPECT_GT(done["rows"], 0);
  EXPECT_TRUE(fs::exists(file));
  EXPECT_THAT(refused({{"do", "record"}, {"file", file}}), HasSubstr("exists already"));
  EXPECT_EQ(ask({{"do", "record"}, {"file", file}, {"force", true}})["file"], file);
  EXPECT_EQ(ask({{"do", "stop"}})["file"], file);
  EXPECT_THAT(refused({{"do", "record"}, {"file", (dir / "no/a.h5").string()}}), HasSubstr("no"));
}

TEST_F(LedWindow, CompletesTheRecordingOfALeaderThatIsGone) {
  ask({{"do", "set"}, {"values", {{"coupling.eta", 0.5}}}});
  const fs::path file = dir / "a.h5";
  ask({{"do", "record"}, {"file", file.string()}});
  turns(3);
  client->leave();
  EXPECT_TRUE(in_time([&] { return !desktop->live.recording() && fs::exists(file); }));
}

TEST_F(LedWindow, RunsATwinBesideTheFirst) {
  EXPECT_EQ(ask({{"do", "twin"}, {"values", {{"coupling.eta", 0.35}}}})["on"], true);
  EXPECT_EQ(desktop->settings.lanes.count, 2u);
  EXPECT_EQ(desktop->settings.lanes.parameters[kTwinLane].eta, 0.35);
  EXPECT_NE(eta(), 0.35);
  EXPECT_THAT(refused({{"do", "twin"}, {"values", {{"coupling.eta", -1}}}}),
              HasSubstr("coupling.eta"));
  EXPECT_EQ(ask({{"do", "twin"}, {"lane", 2}})["on"], true);
  EXPECT_EQ(desktop->settings.lanes.count, 3u);
  EXPECT_EQ(ask({{"do", "twin"}, {"on", false}})["on"], false);
  EXPECT_EQ(desktop->settings.lanes.count, 1u) << "with those beside it";
}

TEST_F(LedWindow, HidesTheSettingsForOneProgramAtATime) {
  desktop->dialog.open("help");
  turns(2);
  ask({{"do", "blind"}});
  EXPECT_TRUE(desktop->blind);
  EXPECT_EQ(desktop->dialog.name(), "");
  other.emplace(dir / "s/window.control");
  other->say(R"({"do":"blind","on":false})");
  EXPECT_THAT(hear(*other)["error"].get<std::string>(), HasSubstr("another program"));
  EXPECT_TRUE(desktop->blind);
  other->leave();
  turns(5);
  EXPECT_TRUE(desktop->blind);
  ask({{"do", "blind"}, {"on", false}});
  EXPECT_FALSE(desktop->blind);
  ask({{"do", "blind"}});
  client->leave();
  EXPECT_TRUE(in_time([&] { return !desktop->blind; })) << "it ends with the program";
}

TEST_F(LedWindow, AsksThePersonAndWaits) {
  client->say(R"({"id":1,"do":"ask","text":"Which?","choices":["this","that"]})");
  ASSERT_TRUE(in_time([&] { return desktop->dialog.name() == "ask"; }));
  turns(4);
  EXPECT_TRUE(find("Which?"));
  client->say(R"({"id":2,"do":"ask","text":"And?"})");
  const json second = hear(*client);
  EXPECT_EQ(second["id"], 2);
  EXPECT_THAT(second["error"].get<std::string>(), HasSubstr("another question is open"));
  desktop->dialog.close();
  turns(3);
  EXPECT_EQ(desktop->dialog.name(), "ask") << "it stays until it is answered";
  press(GLFW_KEY_2);
  const json said = hear(*client);
  EXPECT_EQ(said["id"], 1);
  EXPECT_EQ(said["ok"]["answer"], "that");
  EXPECT_EQ(said["ok"]["index"], 1);
  EXPECT_EQ(desktop->dialog.name(), "");
  client->say(R"({"do":"ask","text":"Ready?"})");
  ASSERT_TRUE(in_time([&] { return desktop->dialog.name() == "ask"; }));
  turns(4);
  press(GLFW_KEY_ENTER);
  EXPECT_EQ(hear(*client)["ok"]["answer"], "Go on");
  const json ended = ask({{"do", "ask"}, {"text", "Feel."}, {"seconds", 0.2}});
  EXPECT_EQ(ended["answer"], nullptr);
  EXPECT_EQ(ended["index"], nullptr);
}

TEST_F(LedWindow, TakesBackTheQuestionOfAProgramThatIsGone) {
  client->say(R"({"do":"ask","text":"Which?","choices":["this","that"]})");
  ASSERT_TRUE(in_time([&] { return desktop->dialog.name() == "ask"; }));
  client->leave();
  EXPECT_TRUE(in_time([&] { return desktop->dialog.name().empty(); }));
  EXPECT_FALSE(desktop->question.asking());
}

TEST_F(LedWindow, SavesAPictureAndSaysWhatBecameOfIt) {
  const fs::path file = dir / "window.png";
  client->say(json{{"id", 1}, {"do", "picture"}, {"file", file.string()}}.dump());
  ASSERT_TRUE(in_time([&] { return desktop->asked.picture == file; }));
  client->say(json{{"id", 2}, {"do", "picture"}, {"file", (dir / "b.png").string()}}.dump());
  EXPECT_THAT(hear(*client)["error"].get<std::string>(),
              HasSubstr("another picture is being saved"));
  desktop->asked.picture.clear();
  remote->saved(std::array{SavedPicture{dir / "other.png", ""}, SavedPicture{file, ""}});
  EXPECT_EQ(hear(*client), (json{{"id", 1}, {"ok", {{"file", file.string()}}}}));
  client->say(json{{"do", "picture"}, {"file", file.string()}}.dump());
  ASSERT_TRUE(in_time([&] { return desktop->asked.picture == file; }));
  desktop->asked.picture.clear();
  remote->saved(std::array{SavedPicture{file, "the disk is full"}});
  EXPECT_EQ(hear(*client)["error"], "picture: the disk is full");
}

TEST_F(LedWindow, CutsTheForce) {
  ASSERT_TRUE(in_time([&] { return desktop->live.force_armed(); }));
  ask({{"do", "cut"}});
  EXPECT_TRUE(in_time([&] { return !desktop->live.force_armed(); }));
}

// Each run has its settings; a change reaches one setting of one run.
TEST_F(LedWindow, GetsAndSetsOneSettingOfOneRun) {
  desktop->tuning.add_lane();
  desktop->tuning.add_lane();
  turns(3);
  LaneParameters& lanes = desktop->settings.lanes.parameters;
  for (std::size_t i = 0; i < kMostLanes; ++i) {
    lanes[i].eta = 0.6 + 0.125 * static_cast<double>(i);
    lanes[i].alpha = 0.01 * static_cast<double>(i + 1);
  }
  turns(2);
  const json all = ask({{"do", "get"}});
  for (std::size_t i = 0; i < kMostLanes; ++i) {
    const json& values = all[i == kMainLane ? "values" : lane_name(i)];
    EXPECT_EQ(values["coupling.eta"], lanes[i].eta) << i;
    EXPECT_EQ(values["observer.alpha"], lanes[i].alpha) << i;
    EXPECT_EQ(values["coupling.kind"], name(lanes[i].kind)) << i;
  }
  EXPECT_EQ(all["state"]["lanes"], 3);
  for (std::size_t i = 0; i < kMostLanes; ++i) {
    LaneParameters wanted = lanes;
    wanted[i].alpha = 0.035;
    const json now =
        ask({{"do", "set"}, {"lane", i}, {"values", {{"observer.alpha", 0.035}}}})["values"];
    EXPECT_EQ(now, (json{{"observer.alpha", 0.035}}));
    EXPECT_EQ(lanes, wanted) << i;
  }
  EXPECT_THAT(refused({{"do", "set"}, {"lane", 3}, {"values", json::object()}}), HasSubstr("lane"));
}

TEST_F(LedWindow, MarksTheMomentInPlotsAndRecording) {
  const auto notes = [&] {
    std::vector<std::string> all;
    for (const PlotMark& mark : desktop->live.stage().history.marks()) {
      if (mark.key == kNoteMark) all.push_back(mark.label);
    }
    return all;
  };
  EXPECT_TRUE(ask({{"do", "mark"}, {"text", "before"}}).contains("tick"));
  EXPECT_EQ(notes(), std::vector<std::string>{"before"});
  const fs::path file = dir / "marked.h5";
  ask({{"do", "record"}, {"file", file.string()}});
  turns(10);
  ask({{"do", "mark"}, {"text", "first"}});
  turns(10);
  const json second = ask({{"do", "mark"}, {"text", "second"}});
  turns(5);
  ask({{"do", "stop"}});
  EXPECT_EQ(notes(), (std::vector<std::string>{"before", "first", "second"}));
  const Session session = read_session(file);
  ASSERT_EQ(session.marks.size(), 2u);
  EXPECT_EQ(session.marks[0].text, "first");
  EXPECT_EQ(session.marks[1].text, "second");
  EXPECT_GT(session.marks[1].tick, session.marks[0].tick);
  EXPECT_LT(session.marks[1].tick, session.size());
  EXPECT_GT(second["time"], 0);
}

TEST_F(LedWindow, SaysWhoHasEndedAndWhatComesBack) {
  const auto said = [&](const char* what) {
    return std::ranges::any_of(desktop->notices.all(),
                               [&](const Notice& notice) { return notice.text == what; });
  };
  const char* const program =
      "The program that controlled this window has ended. Your settings are back.";
  const char* const study = "The study has ended. Your settings are back.";
  for (const bool hidden : {false, true}) {
    desktop->notices.clear();
    const double before = eta();
    if (hidden) ask({{"do", "blind"}});
    ask({{"do", "set"}, {"values", {{"coupling.eta", 0.45}}}});
    EXPECT_TRUE(desktop->lead.on());
    client->leave();
    ASSERT_TRUE(in_time([&] { return !desktop->lead.on(); }));
    EXPECT_EQ(eta(), before);
    EXPECT_EQ(said(study), hidden);
    EXPECT_EQ(said(program), !hidden);
    client.emplace(dir / "s/window.control");
  }
  desktop->notices.clear();
  ask({{"do", "set"}, {"values", {{"coupling.eta", eta()}}}});
  client->leave();
  ASSERT_TRUE(in_time([&] { return !desktop->lead.on(); }));
  EXPECT_TRUE(desktop->notices.all().empty()) << "nothing was changed";
}

TEST_F(LedWindow, HoldsAnArmThatItOpensToThePersonsLimit) {
  desktop->settings.parameters().torque_limit = 0.01;
  turns(2);
  EXPECT_EQ(ask({{"do", "open"}, {"arm", "paddle.urdf"}})["arm"], "paddle");
  EXPECT_LE(desktop->settings.parameters().torque_limit, 0.01);
  EXPECT_THAT(refused({{"do", "set"}, {"values", {{"device.torque_limit", 0.02}}}}),
              HasSubstr("device.torque_limit"));
}

}  // namespace
}  // namespace limpid
