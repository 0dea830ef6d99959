// Effects of each command, the tick in its menu, and the reason why it cannot be run.
#include <imgui.h>

#include <fstream>
#include <sstream>
#include <utility>

#include "app/base/folders.h"
#include "app/style/sliders.h"
#include "tests/app/desktop/shell/a_desktop.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

struct ACommand : ADesktop {
  // Some commands ask where the mouse is.
  void SetUp() override {
    ImGui::CreateContext();
    ADesktop::SetUp();
  }
  void TearDown() override {
    ADesktop::TearDown();
    ImGui::DestroyContext();
  }
  bool ticked(const char* command) const { return find_command(command)->how.checked(*desktop); }
  std::string why(const char* command) const { return why_not(*find_command(command), *desktop); }
  std::string opens(const char* command) {
    desktop->dialog.close();
    run(command);
    return std::string(desktop->dialog.name());
  }
  void play() {
    desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
    ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
    desktop->playback.shown()->player().pause();
  }
};

TEST_F(ACommand, SwitchesOneThingToAndFroAndIsTicked) {
  const std::pair<const char*, bool Settings::*> switches[] = {
      {"view.left_panel", &Settings::show_left},
      {"view.right_panel", &Settings::show_right},
      {"view.plots", &Settings::show_plots},
      {"view.everything", &Settings::everything},
      {"view.ghost", &Settings::show_ghost},
      {"view.lens", &Settings::show_lens},
      {"view.trail", &Settings::show_trail},
      {"view.forces", &Settings::show_forces},
      {"view.grid", &Settings::show_grid},
      {"view.joints", &Settings::show_joints},
      {"view.overlay", &Settings::overlaid},
      {"view.own_file_dialogs", &Settings::own_file_dialogs},
      {"help.your_turn", &Settings::your_turn}};
  for (const auto& [command, member] : switches) {
    SCOPED_TRACE(command);
    std::vector<bool> before, after;
    for (const auto& [other, each] : switches) before.push_back(desktop->settings.*each);
    EXPECT_EQ(ticked(command), desktop->settings.*member);
    run(command);
    EXPECT_EQ(ticked(command), desktop->settings.*member);
    for (std::size_t i = 0; i < std::size(switches); ++i) {
      const bool changed = desktop->settings.*switches[i].second != before[i];
      EXPECT_EQ(changed, switches[i].first == command) << switches[i].first;
    }
    run(command);
    for (const auto& [other, each] : switches) after.push_back(desktop->settings.*each);
    EXPECT_EQ(after, before);
  }
}

TEST_F(ACommand, ChoosesOneOfSeveralAndIsTickedAlone) {
  const auto alone = [&](std::initializer_list<const char*> ids, const char* which) {
    for (const char* id : ids) EXPECT_EQ(ticked(id), id == which) << id << " after " << which;
  };
  const auto themes = {"view.dark", "view.light", "view.contrast"};
  for (const auto& [id, theme] : {std::pair(themes.begin()[1], Theme::light),
                                  {themes.begin()[2], Theme::contrast},
                                  {themes.begin()[0], Theme::dark}}) {
    run(id);
    EXPECT_EQ(desktop->settings.theme, theme);
    alone(themes, id);
  }
  const auto sizes = {"view.text.usual", "view.text.large", "view.text.very_large",
                      "view.text.largest"};
  for (const auto& [id, size] : {std::pair(sizes.begin()[1], 1.25),
                                 {sizes.begin()[2], 1.5},
                                 {sizes.begin()[3], 2.0},
                                 {sizes.begin()[0], 1.0}}) {
    run(id);
    EXPECT_EQ(desktop->settings.text_size, size);
    alone(sizes, id);
  }
  const auto qualities = {"view.quality.automatic", "view.quality.high", "view.quality.medium",
                          "view.quality.low"};
  for (const char* id : qualities) {
    run(id);
    EXPECT_EQ("view.quality." + desktop->settings.picture_quality, id);
    alone(qualities, id);
  }
  desktop->settings.picture_quality = "high";
  EXPECT_EQ(desktop->shown.quality_level(), 0);
  desktop->settings.picture_quality = "medium";
  EXPECT_EQ(desktop->shown.quality_level(), 2);
  desktop->settings.picture_quality = "low";
  EXPECT_EQ(desktop->shown.quality_level(), Quality::kLowest);
}

TEST_F(ACommand, MakesTextLargerAndSmallerByOneSizeUpToTheEnds) {
  double& size = desktop->settings.text_size;
  for (const double larger : {1.25, 1.5, 2.0, 2.0}) {
    run("view.text.larger");
    EXPECT_EQ(size, larger);
  }
  for (const double smaller : {1.5, 1.25, 1.0, 1.0}) {
    run("view.text.smaller");
    EXPECT_EQ(size, smaller);
  }
  size = 1.3;  // of a file, between two
  run("view.text.larger");
  EXPECT_EQ(size, 1.5);
  size = 1.3;
  run("view.text.smaller");
  EXPECT_EQ(size, 1.25);
}

TEST_F(ACommand, OpensItsDialog) {
  const std::pair<const char*, const char*> dialogs[] = {
      {"arm.open", "open arm"},         {"scene.open", "open scene"},
      {"session.open", "open session"}, {"session.play", "open session"},
      {"scene.add_model", "add model"}, {"scene.save", "save scene"},
      {"scene.save_as", "save scene"},  {"export.begin", "export"},
      {"settings.presets", "presets"},  {"plots.layouts", "layouts"},
      {"sweep.begin", "new sweep"},     {"scene.gallery", "gallery"},
      {"help.about", "about"},          {"session.mark", "mark"}};
  for (const auto& [command, dialog] : dialogs) EXPECT_EQ(opens(command), dialog) << command;
  // These close theirs, too, and take another one's place.
  const std::pair<const char*, const char*> to_and_fro[] = {{"device.identify", "identify"},
                                                            {"experiments.show", "experiments"},
                                                            {"sweep.show", "new sweep"},
                                                            {"help.keys", "help"},
                                                            {"help.messages", "messages"}};
  for (const auto& [command, dialog] : to_and_fro) {
    EXPECT_EQ(opens(command), dialog) << command;
    run(command);
    EXPECT_EQ(desktop->dialog.name(), "") << command;
    desktop->dialog.open("about");
    run(command);
    EXPECT_EQ(desktop->dialog.name(), dialog) << command;
  }
  // A sweep's settings are the present ones: a broken coupling has to end first.
  desktop->dialog.close();
  desktop->tuning.break_passivity();
  run("sweep.show");
  EXPECT_FALSE(desktop->settings.before_break);
}

TEST_F(ACommand, AsksTheWindow) {
  run("window.quit");
  EXPECT_TRUE(std::exchange(desktop->asked.close, false));
  run("window.menu");
  EXPECT_TRUE(std::exchange(desktop->asked.menu, false));
  EXPECT_FALSE(ticked("window.full_screen"));
  run("window.full_screen");
  EXPECT_TRUE(std::exchange(desktop->asked.toggle_full_screen, false));
  desktop->full_screen = true;
  EXPECT_TRUE(ticked("window.full_screen"));
  run("window.save_picture");
  const fs::path picture = desktop->asked.picture;
  EXPECT_EQ(picture.parent_path(), dir / "data/limpid/sessions");
  EXPECT_THAT(picture.filename().string(), testing::MatchesRegex("limpid-[0-9]{8}-[0-9]{6}\\.png"));
  EXPECT_FALSE(desktop->asked.close || desktop->asked.menu || desktop->asked.toggle_full_screen);
  for (const LedPanel next : {LedPanel::left, LedPanel::right, LedPanel::none}) {
    run("window.panels");
    EXPECT_EQ(desktop->led_panel, next);
  }
  EXPECT_EQ(why("window.end_recording_and_quit"), "Nothing is being recorded.");
  record_something();
  run("window.end_recording_and_quit");
  EXPECT_TRUE(desktop->asked.close && desktop->recording_may_end);
  EXPECT_TRUE(until([&] { return said("Recorded "); }));
}

TEST_F(ACommand, LooksFromItsSide) {
  const Camera& camera = desktop->shown.camera;
  const std::pair<const char*, Vec3> sides[] = {
      {"view.front", {-1, 0, 0}}, {"view.side", {0, 1, 0}}, {"view.top", {0, 0, -1}}};
  for (const auto& [command, forward] : sides) {
    run("view.reset");
    EXPECT_TRUE(desktop->shown.automatic_view());
    run(command);
    desktop->shown.camera.finish();
    EXPECT_FALSE(desktop->shown.automatic_view());
    EXPECT_LT((camera.forward() - forward).norm(), 0.02) << command;
  }
  run("view.reset");
  desktop->shown.camera.finish();
  for (int i = 0; i < 3; ++i) EXPECT_GT(std::abs(camera.forward()[i]), 0.1) << "from a corner";
}

TEST_F(ACommand, LooksAtWhatIsSelected) {
  EXPECT_EQ(why("scene.look"), "Select an object of the scene first (Tab).");
  desktop->world.add_object({"mine", pose_at({0.2, 0.05, 0.03}), Sphere{0.01}, {500}});
  const Vec3 middle = document().selected_bounds().center();
  run("scene.look");
  desktop->shown.camera.finish();
  EXPECT_FALSE(desktop->shown.automatic_view());
  EXPECT_LT((desktop->shown.camera.target() - middle).norm(), 1e-3);
  EXPECT_LT(desktop->shown.camera.distance(), 0.2) << "it is small";
  document().editor().select(0);
  ASSERT_TRUE(document().selected_bounds().isEmpty()) << "a plane has no end";
  run("scene.look");
  desktop->shown.camera.finish();
  const Vec3 all = desktop->live.stage().picture.bounds().center();
  EXPECT_LT((desktop->shown.camera.target() - all).norm(), 0.05);
}

TEST_F(ACommand, StepsASettingBySliderSteps) {
  using Step = std::tuple<const char*, const char*, const char*>;
  for (const auto& [smaller, larger, key] :
       {Step("coupling.smaller_eta", "coupling.larger_eta", "coupling.eta"),
        Step("observer.smaller_alpha", "observer.larger_alpha", "observer.alpha"),
        Step("coupling.softer", "coupling.stiffer", "coupling.k_vc"),
        Step("hand.softer", "hand.stiffer", "hand.stiffness")}) {
    SCOPED_TRACE(key);
    Parameters& p = desktop->tuning.edited();
    p.kind = CouplingKind::proposed;
    const ParameterInfo& info = *find_parameter(key);
    const double usual = parameter_number(Parameters{}, info);
    const Parameters before = p;
    run(larger);
    const double up = parameter_number(p, info);
    EXPECT_GT(up, usual);
    EXPECT_NEAR(up, slider_step(info, usual, usual, 1), 1e-12);
    run(smaller);
    EXPECT_NEAR(parameter_number(p, info), usual, 1e-9 * usual) << "back again";
    run(smaller);
    EXPECT_LT(parameter_number(p, info), usual);
    Parameters only = before;
    set_parameter_number(only, info, parameter_number(p, info));
    EXPECT_EQ(p, only) << "nothing else";
    p = before;
  }
  EXPECT_FALSE(said("does not use this setting"));
  desktop->tuning.edited().kind = CouplingKind::standard;
  run("hand.stiffer");
  EXPECT_FALSE(said("does not use this setting")) << "a hand is no part of the law";
  run("coupling.larger_eta");
  EXPECT_TRUE(said("The law Standard does not use this setting."));
}

TEST_F(ACommand, PausesAndStepsTheLoop) {
  EXPECT_FALSE(ticked("loop.pause"));
  EXPECT_EQ(why("loop.step"), "Pause the simulation first (K).");
  run("loop.pause");
  EXPECT_TRUE(ticked("loop.pause"));
  EXPECT_TRUE(desktop->live.paused());
  const auto steps = desktop->live.controls().steps;
  run("loop.step");
  EXPECT_EQ(desktop->live.controls().steps, steps + 1);
  run("loop.step_ten");
  EXPECT_EQ(desktop->live.controls().steps, steps + 11);
  run("loop.pause");
  EXPECT_FALSE(desktop->live.paused());
  run("plots.freeze");
  EXPECT_FALSE(desktop->shown.stage().group.following());
  run("plots.freeze");
  EXPECT_TRUE(desktop->shown.stage().group.following());
}

TEST_F(ACommand, LeadsThroughARecording) {
  const char* const need_one[] = {
      "session.mark_before", "session.mark_after",   "session.tick_back",
      "session.tick_on",     "session.step_back",    "session.step_on",
      "session.loop",        "session.rerun",        "session.write_table",
      "session.write_video", "session.back_to_live", "session.to_the_beginning"};
  for (const char* command : need_one) {
    EXPECT_EQ(why(command), "Open a recording first (Ctrl+O).") << command;
  }
  EXPECT_EQ(why("device.start_over"), "");
  play();
  for (const char* command : need_one) EXPECT_EQ(why(command), "") << command;
  const char* const live_only[] = {"device.start_over", "hand.magnet", "loop.pause",
                                   "coupling.break_passivity"};
  for (const char* command : live_only) {
    EXPECT_EQ(why(command), "Go back to live first (Backspace).") << command;
  }
  Player& player = desktop->playback.shown()->player();
  player.seek(1);
  const auto at = player.index();
  const std::pair<const char*, int> steps[] = {{"session.tick_on", 1},
                                               {"session.step_on", 101},
                                               {"session.tick_back", 100},
                                               {"session.step_back", 0}};
  for (const auto& [command, ticks] : steps) {
    run(command);
    EXPECT_EQ(player.index(), at + static_cast<std::size_t>(ticks)) << command;
  }
  run("session.loop");
  EXPECT_TRUE(player.loop);
  run("session.loop");
  EXPECT_FALSE(player.loop);
  run("session.play");
  EXPECT_TRUE(player.playing());
  run("session.play");
  EXPECT_FALSE(player.playing());
  run("session.to_the_beginning");
  EXPECT_EQ(player.index(), 0u);
  EXPECT_EQ(opens("session.write_video"), "video");
  run("session.rerun");
  EXPECT_TRUE(desktop->playback.rerunning());
  run("help.your_turn");
  EXPECT_FALSE(desktop->playback.on()) << "it is about the live arm";
  run("session.play");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); })) << "the last one";
  run("session.back_to_live");
  EXPECT_FALSE(desktop->playback.on());
}

TEST_F(ACommand, SaysWhyItCannotBeRun) {
  const std::pair<const char*, const char*> reasons[] = {
      {"session.drop_run", "There is only one run, and it cannot be ended. B starts a second run."},
      {"scene.save_and_leave",
       "This command answers the question about unsaved changes. That question is not open now."},
      {"scene.discard_and_leave",
       "This command answers the question about unsaved changes. That question is not open now."},
      {"scene.open_kept", "There is no automatically saved scene."},
      {"scene.leave_kept", "There is no automatically saved scene."},
      {"scene.discard_kept", "There is no automatically saved scene."},
      {"export.open", "Nothing was exported recently."},
      {"export.show", "Nothing was exported recently."},
      {"export.forget", "Nothing was exported recently."},
      {"session.forget_recovered", "Nothing was recovered."},
      {"coupling.end_break", "Passivity is not broken."},
      {"coupling.mend_chatter", "The loop does not chatter."},
      {"coupling.forget_chatter", "The loop does not chatter."},
      {"scene.soften_wall", "The loop does not chatter."},
      {"object.move", "Select an object of the scene first (Tab)."},
      {"object.turn", "Select an object of the scene first (Tab)."},
      {"object.scale", "Select an object of the scene first (Tab)."},
      {"scene.copy", "Select an object of the scene first (Tab)."},
      {"hand.magnet", "Nothing in this scene can be picked up."}};
  for (const auto& [command, reason] : reasons) {
    EXPECT_EQ(why(command), reason) << command;
    EXPECT_EQ(run_command(command, *desktop), reason) << command;
  }
  document().editor().select(0);
  EXPECT_EQ(why("object.scale"), "This object cannot be changed in that way.") << "a plane";
  EXPECT_EQ(why("object.move"), "");
  run("session.twin");
  EXPECT_TRUE(ticked("session.twin"));
  EXPECT_THAT(why("object.move"), StartsWith("Runs are shown side by side."));
  run("view.overlay");
  EXPECT_EQ(why("object.move"), "");
  run("session.add_run");
  EXPECT_EQ(why("session.add_run"),
            "At most three runs are possible at the same time. Ctrl+Shift+B ends one of them.");
  run("session.drop_run");
  EXPECT_EQ(why("session.add_run"), "");
  EXPECT_EQ(why("session.drop_run"), "");
  run("session.twin");
  EXPECT_FALSE(ticked("session.twin"));
  record_something();
  for (const char* command : {"session.twin", "session.add_run", "session.drop_run"}) {
    EXPECT_EQ(why(command), "Stop the recording before you add or end a run.") << command;
  }
  EXPECT_THAT(why("object.move"), StartsWith("Stop the recording (R)"));
  EXPECT_THAT(why("scene.copy"), StartsWith("Stop the recording (R)"));
}

TEST_F(ACommand, IsNotThePersonsWhileAProgramHidesSettings) {
  desktop->blind = true;
  std::size_t hidden = 0;
  for (const Command& command : commands()) {
    const std::string of_person = why_not(command, *desktop, Asker::person);
    const bool refused = of_person.starts_with("A program that is connected to Limpid hides law");
    EXPECT_EQ(refused, !command.how.blind) << command.id;
    EXPECT_THAT(why_not(command, *desktop, Asker::program),
                testing::Not(HasSubstr("hides law, settings")));
    hidden += refused ? 1 : 0;
  }
  EXPECT_GT(hidden, 20u);
  for (const char* open_to_all : {"force.cut", "window.escape", "device.force", "view.front"}) {
    EXPECT_EQ(why(open_to_all), "") << open_to_all;
  }
  const CouplingKind law = desktop->settings.parameters().kind;
  EXPECT_NE(run_command("coupling.next", *desktop), "");
  EXPECT_EQ(desktop->settings.parameters().kind, law);
  run_or_say("coupling.next", *desktop);
  EXPECT_TRUE(said("hides law, settings and plots"));
  EXPECT_EQ(run_command("coupling.next", *desktop, Asker::program), "");
  EXPECT_NE(desktop->settings.parameters().kind, law);
}

TEST_F(ACommand, NamesWhatItWouldDoNow) {
  const auto label = [&](const char* id) { return find_command(id)->how.now(*desktop); };
  ASSERT_TRUE(armed());
  EXPECT_STREQ(label("device.force").text, "Force off");
  EXPECT_STREQ(label("device.force").keys, "Esc");
  run("device.force");
  ASSERT_TRUE(until([&] { return arming() == Arming::off; }));
  EXPECT_STREQ(label("device.force").text, "Force on");
  EXPECT_EQ(label("device.force").keys, nullptr);
  ASSERT_TRUE(armed());
  run("force.cut");
  ASSERT_TRUE(until([&] { return arming() == Arming::off; }));
  EXPECT_STREQ(label("session.record").text, "Record");
  run("session.record");
  ASSERT_TRUE(until([&] { return loop().recording(); }));
  EXPECT_STREQ(label("session.record").text, "Stop recording");
  run("session.record");
  EXPECT_TRUE(until([&] { return said("Recorded "); }));
}

TEST_F(ACommand, ChangesTheScene) {
  const std::size_t first = document().scene().objects.size();
  run("scene.select_next");
  EXPECT_EQ(document().editor().selected(), 0u);
  run("scene.copy");
  EXPECT_EQ(document().scene().objects.size(), first + 1);
  frames(2);
  run("scene.remove");
  EXPECT_EQ(document().scene().objects.size(), first);
  frames(2);
  run("edit.undo");
  EXPECT_EQ(document().scene().objects.size(), first + 1);
  frames(2);
  run("edit.redo");
  EXPECT_EQ(document().scene().objects.size(), first);
  document().editor().select(std::nullopt);
  run("scene.select_previous");
  EXPECT_EQ(document().editor().selected(), first - 1);
  ASSERT_TRUE(document().save_as(dir / "own.toml"));
  fs::remove(dir / "own.toml");
  EXPECT_EQ(opens("scene.save"), "") << "it has a file of its own";
  EXPECT_TRUE(fs::exists(dir / "own.toml"));
  document().editor().set_tip_radius(0.006);
  desktop->world.new_scene();
  ASSERT_TRUE(document().asking());
  run("scene.save_and_leave");
  EXPECT_FALSE(document().asking());
  EXPECT_EQ(fs::path(document().file()).filename(), "untitled.toml");
  std::stringstream text;
  text << std::ifstream(dir / "own.toml").rdbuf();
  EXPECT_THAT(text.str(), HasSubstr("0.006"));
  document().editor().set_tip_radius(0.007);
  desktop->world.open_scene(dir / "own.toml");
  ASSERT_TRUE(document().asking());
  run("scene.discard_and_leave");
  EXPECT_TRUE(until([&] { return document().file() == dir / "own.toml"; }));
  EXPECT_EQ(document().scene().tip_radius, 0.006);
}

TEST_F(ACommand, TakesTheEncodersOfATouchAndGivesThemBack) {
  EXPECT_TRUE(ticked("arm.built_in"));
  run("arm.touch");
  EXPECT_TRUE(said("A Touch has 52 g at the tip"));
  ASSERT_TRUE(until([&] { return !ticked("arm.built_in"); }));
  const double step = desktop->live.stage().arm().encoder_step;
  EXPECT_NEAR(step, 0.42e-3, 0.01e-3) << "as the notice says";
  EXPECT_EQ(desktop->settings.parameters().encoder_step, step);
  EXPECT_THAT(desktop->settings.device, HasSubstr("touch.urdf"));
  run("arm.built_in");
  ASSERT_TRUE(until([&] { return ticked("arm.built_in"); }));
  EXPECT_EQ(desktop->settings.parameters().encoder_step, 0);
  EXPECT_EQ(desktop->settings.device, "");
  desktop->settings.parameters().encoder_step = 1e-3;  // the user's own
  run("arm.built_in");
  EXPECT_EQ(desktop->settings.parameters().encoder_step, 1e-3);
}

}  // namespace
}  // namespace limpid
