// The desktop without a window: laws, lanes, broken passivity, first steps, commands, plots, view
// and magnet.
#include "app/desktop/shell/desktop.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <set>

#include "app/desktop/base/first_steps.h"
#include "tests/app/desktop/shell/a_desktop.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

// The tip rests in the box and touches it.
TEST_F(ADesktop, PicksUpWithTheMagnetAndLetsGoOfIt) {
  EXPECT_NE(run_command("hand.magnet", *desktop), "") << "a table cannot be picked up";
  const Vec3 tip = desktop->live.controls().goal;
  const fs::path file = dir / "die.toml";
  std::ofstream(file) << fmt::format(
      "tip_radius = 0.004\ngravity = [0, 0, 0]\n[[body]]\nname = \"die\"\n"
      "box = [0.02, 0.02, 0.02]\nmass = 0.02\nposition = [{}, {}, {}]\nmagnet = true\n",
      tip.x(), tip.y(), tip.z() - 0.0135);
  desktop->world.open_scene(file);
  ASSERT_TRUE(until([&] { return said("Scene:"); }));
  const auto held = [&] { return loop().layout().in(desktop->live.row(), Column::magnet)[0] == 1; };
  const CouplingKind law = desktop->settings.parameters().kind;
  run("hand.magnet");
  EXPECT_TRUE(until(held));
  run("hand.magnet");
  EXPECT_TRUE(until([&] { return !held(); }));
  desktop->pick_up_or_next_law();
  EXPECT_TRUE(until(held)) << "so does a device's first button";
  EXPECT_EQ(desktop->settings.parameters().kind, law);
  desktop->live.start_over();
  EXPECT_TRUE(until([&] { return !held(); }));
}

TEST_F(ADesktop, RunsLanesWhoseSettingsAreTheirOwnAndWhoseWorldIsNot) {
  frames(5);
  LaneSettings& lanes = desktop->settings.lanes;
  run("session.twin");
  run("session.add_run");
  EXPECT_NE(run_command("session.add_run", *desktop), "") << "three are the most";
  frames(20);
  EXPECT_EQ(desktop->shown.rows().size(), 3u);
  std::set<CouplingKind> kinds;
  for (const Parameters& p : lanes.parameters) kinds.insert(p.kind);
  EXPECT_EQ(kinds.size(), kMostLanes) << "each has a law of its own at first";
  for (std::size_t lane = 1; lane < kMostLanes; ++lane) {
    lanes.edited = lane;
    EXPECT_EQ(&desktop->tuning.edited(), &lanes.parameters[lane]);
    const LaneParameters before = lanes.parameters;
    desktop->tuning.next_law();
    for (std::size_t i = 0; i < kMostLanes; ++i) {
      EXPECT_EQ(lanes.parameters[i].kind != before[i].kind, i == lane);
    }
  }
  desktop->settings.parameters().hand_stiffness = 432;
  frames(20);
  const RunNames& names = desktop->live.stage().names();
  EXPECT_TRUE(names.beside);
  ASSERT_EQ(names.laws.size(), kMostLanes);
  for (std::size_t i = 0; i < kMostLanes; ++i) {
    EXPECT_EQ(lanes.parameters[i].hand_stiffness, 432);
    EXPECT_EQ(names.law(i), static_cast<int>(lanes.parameters[i].kind));
    const RowLayout& layout = desktop->live.loop().layout();
    EXPECT_EQ(layout.in(desktop->shown.rows()[i], Column::kind)[0],
              static_cast<double>(lanes.parameters[i].kind));
  }
  run("session.drop_run");
  frames(20);
  EXPECT_EQ(desktop->shown.rows().size(), 2u);
  EXPECT_EQ(&desktop->tuning.edited(), &desktop->settings.parameters());
  run("session.twin");
  frames(20);
  EXPECT_EQ(desktop->shown.rows().size(), 1u);
  EXPECT_FALSE(desktop->live.stage().names().several());
  EXPECT_NE(run_command("session.drop_run", *desktop), "") << "one is left";
}

// A first step is done once its thing was done; settings of broken passivity are nobody's choice.
TEST_F(ADesktop, NotesEachFirstStepThatWasDone) {
  const auto steps = [&] {
    std::vector<FirstStep> all;
    for (const FirstStepInfo& each : kFirstSteps) {
      if (done(desktop->settings, each.step)) all.push_back(each.step);
    }
    return all;
  };
  using testing::ElementsAre;
  EXPECT_THAT(steps(), testing::IsEmpty());
  desktop->tuning.break_passivity();
  frames(3);
  document().undo();
  frames(3);
  EXPECT_THAT(steps(), testing::IsEmpty());
  run("session.twin");
  frames(3);
  EXPECT_THAT(steps(), ElementsAre(FirstStep::twin));
  run("session.twin");
  frames(3);
  desktop->tuning.next_law();
  frames(3);
  EXPECT_THAT(steps(), ElementsAre(FirstStep::law, FirstStep::twin));
  desktop->settings.parameters().eta = 0.77;
  frames(3);
  EXPECT_THAT(steps(), ElementsAre(FirstStep::law, FirstStep::eta, FirstStep::twin));
  desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  desktop->playback.shown()->player().play();
  frames(3);
  EXPECT_THAT(steps(),
              ElementsAre(FirstStep::law, FirstStep::eta, FirstStep::twin, FirstStep::play));
}

TEST_F(ADesktop, TakesBackAPresetOfAnyLane) {
  frames(5);
  LaneSettings& lanes = desktop->settings.lanes;
  for (std::size_t lane = 0; lane < kMostLanes; ++lane) {
    if (lane > 0) run("session.add_run");
    frames(5);
    lanes.edited = lane;
    const LaneParameters before = lanes.parameters;
    desktop->tuning.use_preset("Light hand");
    const Parameters& edited = lanes.parameters[lane];
    EXPECT_EQ(edited.eta, 0.3);
    EXPECT_EQ(edited.kind, CouplingKind::predictive);
    frames(5);
    desktop->document.undo();
    EXPECT_EQ(lanes.parameters, before);
    frames(5);
    desktop->document.redo();
    EXPECT_EQ(edited.eta, 0.3);
    frames(5);
  }
}

TEST_F(ADesktop, RunsCommandsByTheirIdsAndSaysWhyOneCannotBeRun) {
  run("view.ghost");
  EXPECT_FALSE(desktop->settings.show_ghost);
  EXPECT_FALSE(find_command("view.ghost")->how.checked(*desktop));
  EXPECT_EQ(run_command("view.gost", *desktop), "There is no command \"view.gost\".");
  EXPECT_EQ(run_command("session.rerun", *desktop), "Open a recording first (Ctrl+O).");
  EXPECT_EQ(run_command("scene.remove", *desktop), "Select an object of the scene first (Tab).");
  run_or_say("session.back_to_live", *desktop);
  EXPECT_TRUE(said("Open a recording first"));
  run("session.open");
  EXPECT_EQ(desktop->dialog.name(), "open session");
  EXPECT_THROW(desktop->dialog.open("a dialog"), std::logic_error);
  desktop->dialog.close();
  record_something();
  EXPECT_THAT(run_command("session.twin", *desktop), testing::HasSubstr("Stop the recording"));
  EXPECT_EQ(desktop->settings.lanes.count, 1u);
}

// The banner of a chattering wall offers two ways out.
TEST_F(ADesktop, SaysWhichWallChattersUnderWhichLawAndMendsIt) {
  Controls& controls = desktop->live.controls();
  const auto chatters = [&] {
    desktop->settings.parameters().kind = CouplingKind::proposed;
    desktop->settings.parameters().eta = 1;
    Object table = document().scene().objects[0];
    table.material.stiffness = 5000;
    document().editor().set(0, table, "stiffness");
    controls.goal = Vec3(0.2, 0, 0);
    controls.grab = true;
    frames(50);
    for (int i = 1; i <= 100; ++i) {
      controls.goal.z() = -0.045 * i / 100;
      frames(1);
    }
    return until([&] { return desktop->chatter.found().has_value(); });
  };
  ASSERT_EQ(document().scene().objects[0].name, "table top");
  EXPECT_TRUE(desktop->banners().empty());
  for (const char* way : {"coupling.mend_chatter", "scene.soften_wall"}) {
    ASSERT_TRUE(chatters()) << way;
    const std::vector<Banner> banners = desktop->banners();
    ASSERT_FALSE(banners.empty());
    const Banner& banner = banners.back();
    EXPECT_TRUE(banner.bad);
    EXPECT_EQ(
        banner.text,
        "The loop chatters, because table top (5000 N/m) is stiffer than the proposed law can "
        "render there without chatter.");
    ASSERT_EQ(banner.buttons.size(), 3u);
    EXPECT_EQ(banner.buttons[0].label, "Predictive");
    // The stiffness is that of `analyze` for the built-in arm, in two digits.
    EXPECT_EQ(banner.buttons[1].label, "Soften the wall to 1500 N/m");
    run(way);
    EXPECT_FALSE(desktop->chatter.found());
    const bool softened = std::string(way) == "scene.soften_wall";
    EXPECT_EQ(document().scene().objects[0].material.stiffness, softened ? 1500 : 5000);
    EXPECT_EQ(desktop->settings.parameters().kind,
              softened ? CouplingKind::proposed : CouplingKind::predictive);
    frames(150);
    EXPECT_FALSE(desktop->chatter.found()) << "it is mended: " << way;
    controls.grab = false;
  }
}

// The loop's last ticks are those of passivity broken on purpose, which no law is to blame for.
TEST_F(ADesktop, BlamesNoLawForPassivityThatWasBrokenOnPurpose) {
  Controls& controls = desktop->live.controls();
  controls.goal = Vec3(0.2, 0, 0.04);
  controls.grab = true;
  frames(50);
  desktop->tuning.break_passivity();
  const RowLayout& layout = desktop->live.stage().channels().layout();
  ASSERT_TRUE(until([&] { return layout.in(desktop->live.row(), Column::energy_total)[0] > 0.1; }));
  desktop->tuning.end_break();
  for (int i = 0; i < 120; ++i) {
    frames(1);
    ASSERT_FALSE(desktop->chatter.found()) << "frame " << i << " after the repair";
  }
}

// After any further action the settings are the former ones.
TEST_F(ADesktop, PutsEverythingBackWhenBrokenPassivityEnds) {
  Settings& settings = desktop->settings;
  settings.parameters().hand_stiffness = 222;
  settings.parameters().eta = 0.8;
  frames(2);
  const Parameters before = settings.parameters();
  const auto broken = [&] {
    desktop->tuning.break_passivity();
    frames(2);
    EXPECT_EQ(settings.parameters().hand_stiffness, 3000);
    EXPECT_EQ(settings.parameters().hand_damping, 0);
    EXPECT_STREQ(desktop->banners().back().buttons.at(0).command, "coupling.end_break");
  };
  const auto expect_whole = [&](const char* after) {
    EXPECT_TRUE(settings.parameters() == before) << after;
    EXPECT_FALSE(settings.before_break) << after;
  };
  broken();
  desktop->tuning.end_break();
  expect_whole("Repair");
  broken();
  desktop->tuning.next_law();
  expect_whole("C");
  broken();
  document().undo();
  expect_whole("Ctrl+Z");
  frames(2);
  broken();
  desktop->tuning.use_preset("Light hand");
  EXPECT_EQ(settings.parameters().hand_stiffness, 222);
  frames(2);
  document().undo();
  expect_whole("a preset, and what was before it");
  frames(2);
  broken();
  settings.parameters().kind = CouplingKind::standard;  // by a click on the law
  frames(2);
  EXPECT_EQ(settings.parameters().kind, CouplingKind::standard);
  settings.parameters().kind = before.kind;
  frames(2);
  expect_whole("another law");
  broken();
  desktop->world.open_scene(fs::path(LIMPID_ASSETS_DIR) / "scenes/spheres.toml");
  ASSERT_TRUE(until([&] { return said("Scene:"); }));
  expect_whole("another scene");
  broken();
  desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  frames(1);
  EXPECT_TRUE(settings.parameters() == before) << "a recording";
  desktop->playback.close();
  broken();
  plug_in(3);
  EXPECT_EQ(settings.parameters().hand_stiffness, 222) << "a device";
  desktop->world.close_device();
  frames(2);
  broken();
  EXPECT_EQ(desktop->lead.settings_to_keep().parameters().hand_stiffness, 222) << "the next start";
  EXPECT_EQ(desktop->lead.settings_to_keep().parameters().eta, 0.8);
  EXPECT_FALSE(desktop->lead.settings_to_keep().before_break);
}

TEST_F(ADesktop, CountsBrokenPassivityAsNoStepOfUndo) {
  frames(2);
  const Parameters first = desktop->settings.parameters();
  desktop->tuning.edited().eta = 0.77;
  frames(60);  // a separate step of undo
  desktop->tuning.break_passivity();
  frames(5);
  desktop->tuning.edited().eta = 0.2;  // changed meanwhile
  frames(60);
  document().undo();
  EXPECT_EQ(desktop->tuning.edited().eta, 0.77);
  frames(5);
  document().undo();
  EXPECT_TRUE(desktop->settings.parameters() == first);
}

TEST_F(ADesktop, ShowsTheChosenPlotsLiveAndInPlayback) {
  desktop->plots.add();
  desktop->settings.plot_choices.back() = {.kind = PlotKind::spectrum,
                                           .channels = {"hand/torque_norm"}};
  frames(3);
  ASSERT_EQ(desktop->shown.stage().plots.size(), 5u);
  EXPECT_EQ(desktop->dialog.name(), "plot");
  desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  frames(2);
  ASSERT_EQ(desktop->shown.stage().plots.size(), 5u);
  EXPECT_EQ(desktop->shown.stage().plots.back().spec().title, "spectrum of |f1|");
  desktop->plots.remove(0);
  desktop->plots.use("As at first");
  frames(2);
  EXPECT_EQ(desktop->shown.stage().plots.size(), 4u);
  EXPECT_EQ(desktop->dialog.name(), "");
}

TEST_F(ADesktop, NamesTheLawOfItsRunInThePlotAgainstAChannel) {
  const auto law_name = [&] {
    std::string name;
    for (const Plot& plot : desktop->shown.stage().plots) {
      if (plot.spec().kind == PlotKind::cross) name = plot.spec().curves.at(0).law_name;
    }
    return name;
  };
  const auto torques = [&]() -> std::vector<Curve>& {
    return desktop->live.stage().plots.at(2).spec().curves;
  };
  EXPECT_EQ(law_name(), info(desktop->settings.parameters().kind).key);
  ASSERT_EQ(torques().size(), 3u);
  torques()[1].visible = false;
  const std::string before = law_name();
  desktop->tuning.next_law();
  frames(3);
  EXPECT_NE(law_name(), before);
  EXPECT_EQ(law_name(), info(desktop->settings.parameters().kind).key);
  EXPECT_FALSE(torques()[1].visible) << "what was hidden stays so";
  desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  frames(1);
  const Parameters& recorded = desktop->playback.shown()->settings();
  EXPECT_EQ(law_name(), info(recorded.kind).key);
}

TEST_F(ADesktop, ChoosesTheViewUntilSomebodyDoes) {
  EXPECT_TRUE(desktop->shown.automatic_view());
  desktop->shown.look(Camera::View::top);
  EXPECT_FALSE(desktop->shown.automatic_view());
  desktop->shown.reset_view();
  EXPECT_TRUE(desktop->shown.automatic_view());
}

// The panel's energies follow the plots' newest row, whatever came before.
TEST_F(ADesktop, AccountsForTheEnergyOfItsLoop) {
  const int energy = static_cast<int>(Channel::energy_total);
  const auto stage = [&]() -> const Stage& { return desktop->live.stage(); };
  desktop->settings.parameters().eta = 0.3;  // not passive, so that energy is given
  Controls& controls = desktop->live.controls();
  controls.goal = Vec3(0.17, 0.04, 0.03);
  controls.grab = true;
  EXPECT_TRUE(until([&] { return std::abs(stage().energy[kMainLane].total()) > 1e-4; }));
  controls.grab = false;
  frames(5);
  const History& history = stage().history;
  EXPECT_NEAR(stage().energy[kMainLane].total(), history.value(energy, history.end() - 1), 1e-6);
}

}  // namespace
}  // namespace limpid
