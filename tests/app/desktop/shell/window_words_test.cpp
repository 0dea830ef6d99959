// Words of the whole window: menus, sections, dialogs and the bar below, in each of their states.
#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "app/desktop/base/first_steps.h"
#include "app/desktop/shell/command_keys.h"
#include "app/desktop/shell/state.h"
#include "tests/app/desktop/shell/whole_window.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class Words : public WholeWindow {
 protected:
  // Window names of ImGui's menus and popups.
  static bool is_menu(const std::string& window) {
    return window.starts_with("##Menu") || window.starts_with("##Popup");
  }
  static std::string menu_words() {
    std::string all = "\n";
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (is_menu(each.window)) all += each.text + '\n';
    }
    return all;
  }
  void play_table() {
    desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
    ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
    desktop->playback.shown()->player().pause();
    frames(3);
  }
};

TEST_F(Words, SayThatASceneWhichIsLoadedWaitsForTheEndOfARecording) {
  desktop->world.open_scene(fs::path(LIMPID_ASSETS_DIR) / "scenes/spheres.toml");
  desktop->world.toggle_recording();
  const auto says = [](const char* what) {
    return words("loading").find(what) != std::string::npos;
  };
  EXPECT_TRUE(until([&] { return says("loaded; it is shown when the recording ends (R)"); }));
  EXPECT_FALSE(says("preparing it for touch"));
  ASSERT_TRUE(until([&] { return desktop->live.loop().snapshot().recording; }));
  desktop->world.toggle_recording();
  EXPECT_TRUE(until([&] { return !desktop->document.loader().busy(); }));
  frames(3);
  EXPECT_EQ(words("loading"), "");
  EXPECT_EQ(fs::path(desktop->document.file()).filename(), "spheres.toml");
}

TEST_F(Words, OfMenusAreThoseOfTheirCommands) {
  for (const char* menu : {"File", "Edit", "View", "Session", "Scene", "Device", "Help"}) {
    click(menu, "##MainMenuBar");
    const std::string shown = menu_words();
    for (const Command& command : commands()) {
      if (command.menu == nullptr || std::string(command.menu) != menu) continue;
      const std::string label =
          command.how.now != nullptr ? command.how.now(*desktop).text : command.text;
      EXPECT_THAT(shown, HasSubstr("\n" + label + "\n")) << menu;
      const std::string keys = key_text(command, *desktop->key_labels);
      if (!keys.empty() && command.how.now == nullptr) {
        EXPECT_THAT(shown, HasSubstr("\n" + keys + "\n")) << label;
      }
    }
    press(GLFW_KEY_ESCAPE);
    click("Help", "##MainMenuBar");
    press(GLFW_KEY_ESCAPE);
    away();
  }
}

TEST_F(Words, OfInnerMenusStandInTheirMenu) {
  click("View", "##MainMenuBar");
  for (const char* inner : {"Plots of", "Layouts", "Picture quality"}) {
    EXPECT_THAT(menu_words(), HasSubstr(std::string("\n") + inner + "\n"));
  }
  point_at(find("Picture quality")->middle());
  frames(20);
  EXPECT_THAT(menu_words(), HasSubstr("automatic"));
  click("low");
  EXPECT_EQ(desktop->settings.picture_quality, "low");
}

TEST_F(Words, OfTheSceneMenuNameTheScenesThatCameAlong) {
  click("Scene", "##MainMenuBar");
  const std::string shown = menu_words();
  EXPECT_THAT(shown, HasSubstr("Drop models, scenes, recordings or sweeps on the window."));
  std::size_t scenes = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(LIMPID_ASSETS_DIR) / "scenes")) {
    if (entry.path().extension() != ".toml") continue;
    std::ifstream in(entry.path());
    std::string line;
    while (std::getline(in, line) && !line.starts_with("title = ")) {
    }
    const std::string title = line.substr(9, line.rfind('"') - 9);
    EXPECT_THAT(shown, HasSubstr(title)) << entry.path();
    ++scenes;
  }
  EXPECT_GT(scenes, 10u);
}

TEST_F(Words, OfCommandsThatCannotRunSayWhy) {
  click("Session", "##MainMenuBar");
  EXPECT_THAT(hint("Write as table (CSV)"), HasSubstr("Open a recording first (Ctrl+O)."));
  press(GLFW_KEY_ESCAPE);
}

// The window of every dialog is drawn and goes, as each name of dialogs is opened.
TEST_F(Words, OfDialogsFitIntoThem) {
  const std::set<std::string> asked{"ask", "arm tip", "expand xacro", "video", "sweep", "plot"};
  for (const auto& [w, h] : {std::pair(1440, 900), std::pair(900, 560)}) {
    width = w;
    height = h;
    frames(3);
    for (const DialogKind& kind : dialog_kinds()) {
      if (asked.contains(kind.name)) continue;  // need something to be about
      desktop->dialog.open(kind.name);
      frames(6);
      const auto places = dialog_places();
      ASSERT_TRUE(places) << kind.name;
      EXPECT_TRUE(places->cross.x > 0 && places->cross.x < static_cast<float>(width)) << kind.name;
      EXPECT_TRUE(places->cross.y > 0 && places->cross.y < static_cast<float>(height)) << kind.name;
      ASSERT_TRUE(places->button) << kind.name << " has no button that closes it";
      EXPECT_LT(places->button->y, static_cast<float>(height)) << kind.name;
      press(GLFW_KEY_ESCAPE);
      desktop->escape();
      frames(3);
      EXPECT_EQ(desktop->dialog.name(), "") << kind.name;
      EXPECT_FALSE(dialog_places()) << kind.name;
    }
  }
  for (const Notice& notice : desktop->notices.all()) EXPECT_FALSE(notice.bad) << notice.text;
}

TEST_F(Words, OfTextsNeverLieOverEachOther) {
  const auto expect_apart = [&](const std::string& state) {
    const std::vector<test::DrawnText> all = test::drawn_texts();
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t k = i + 1; k < all.size(); ++k) {
        if (all[i].window != all[k].window || !all[i].whole() || !all[k].whole()) continue;
        const float wide =
            std::min(all[i].max.x, all[k].max.x) - std::max(all[i].min.x, all[k].min.x);
        const float high =
            std::min(all[i].max.y, all[k].max.y) - std::max(all[i].min.y, all[k].min.y);
        EXPECT_FALSE(wide > 2 && high > 4)
            << state << ": " << all[i].text << " over " << all[k].text << " in " << all[i].window;
      }
    }
  };
  for (const auto& [w, h] : {std::pair(1440, 900), std::pair(900, 560)}) {
    width = w;
    height = h;
    frames(4);
    expect_apart("live");
    for (const char* dialog :
         {"help", "messages", "about", "export", "layouts", "presets", "mark", "quit"}) {
      desktop->dialog.open(dialog);
      frames(5);
      expect_apart(dialog);
      desktop->escape();
      frames(3);
    }
  }
}

TEST_F(Words, SayThatTheMagnetIsOn) {
  const Vec3 tip = desktop->live.controls().goal;
  const fs::path file = dir / "block.toml";
  std::ofstream(file) << fmt::format(
      "tip_radius = 0.004\ngravity = [0, 0, 0]\n[[body]]\nname = \"block\"\n"
      "box = [0.02, 0.02, 0.02]\nmass = 50\nposition = [{}, {}, {}]\nmagnet = true\n",
      tip.x(), tip.y(), tip.z() - 0.0135);
  desktop->world.open_scene(file);
  const auto& objects = [&]() -> auto& { return desktop->live.stage().document().scene.objects; };
  ASSERT_TRUE(until([&] { return objects().size() == 1 && objects()[0].name == "block"; }));
  const auto says = [&](const char* what) { return words().find(what) != std::string::npos; };
  run("hand.magnet");
  EXPECT_TRUE(until([&] {
    return desktop->live.loop().layout().in(desktop->live.row(), Column::magnet)[0] == 1;
  }));
  EXPECT_TRUE(until([&] { return says("The magnet is on. H lets go."); }));
  run("hand.magnet");
  EXPECT_TRUE(until([&] { return !says("The magnet"); }));
}

TEST_F(Words, OfTheHelpAreAllKeys) {
  height = 3000;
  run("help.keys");
  frames(4);
  const std::string shown = words("Keys and mouse");
  for (const char* heading :
       {"Force and hand", "Mouse and gamepad", "Coupling", "Recording and playback",
        "Plots and picture", "Scene and objects", "Experiments", "Settings, window and help"}) {
    EXPECT_THAT(shown, HasSubstr(heading));
  }
  for (const char* key : {"Space", "Esc", "Ctrl+S", "Shift+B", "F12", "middle drag", "gamepad"}) {
    EXPECT_THAT(shown, HasSubstr(key));
  }
}

TEST_F(Words, AboutLimpidNameItsVersionAndWhatItIsBuiltOn) {
  run("help.about");
  const std::string shown = words("About Limpid");
  EXPECT_THAT(shown, ContainsRegex("Limpid [0-9]+\\.[0-9]+"));
  for (const char* part : {"GLFW", "Dear ImGui", "Eigen", "HDF5", "Inter", "cite"}) {
    EXPECT_THAT(shown, HasSubstr(part));
  }
  click("Close (Esc)", "About Limpid");
  EXPECT_EQ(desktop->dialog.name(), "");
}

TEST_F(Words, OfSectionsAreThereOnceTheyAreUnfolded) {
  for (const char* title :
       {"Scene", "Hand", "Device", "Imperfections", "Analysis", "This tick", "Timing"}) {
    EXPECT_TRUE(find(title, kSidePanel)) << title;
  }
  height = 2600;
  for (const char* folded : {"Analysis", "This tick", "Device"}) click(folded, kSidePanel);
  const std::string shown = words(kSidePanel);
  for (const char* label :
       {"Grip stiffness", "Grip damping", "Hand mass", "haptic rate", "tick takes p50 / p99",
        "stored in contacts", "controller, E_c", "stiffest wall [N/m]"}) {
    EXPECT_THAT(shown, HasSubstr(label));
  }
  for (const char* label :
       {"hold where released", "virtual arm, by the mouse", "wake-up p50 / p99", "late over 0.2 ms",
        "missed", "slipped", "scheduling", "picture quality", "frame", "gap of the tips",
        "force of the motors", "stiffest in this scene"}) {
    EXPECT_NE(hint(label, kSidePanel), "") << label;
  }
  EXPECT_THAT(shown, HasSubstr("inertia felt [g at tip] against frequency [Hz]"));
  EXPECT_THAT(shown, HasSubstr("damping felt [N s/m] against frequency [Hz]"));
  for (const char* law : {"standard ", "proposed ", "predictive ", "tank "}) {
    EXPECT_THAT(shown, HasSubstr(law)) << "a wall's bar";
  }
}

TEST_F(Words, OfPictureQualitySayTheLevel) {
  const auto said = [&](const char* wanted) {
    desktop->settings.picture_quality = wanted;
    height = 1400;
    frames(4);
    return words(kSidePanel);
  };
  EXPECT_THAT(said("high"), HasSubstr("\nhigh\n"));
  EXPECT_THAT(said("low"), HasSubstr("\nlow\n"));
  EXPECT_THAT(said("automatic"), HasSubstr("\nautomatic: "));
}

TEST_F(Words, OfTheHandSayWhetherItHolds) {
  EXPECT_FALSE(desktop->settings.hold_on_release);
  click("hold where released", kSidePanel);
  EXPECT_TRUE(desktop->settings.hold_on_release);
}

TEST_F(Words, OfTheBarBelowSayWhatCanBeDone) {
  for (const char* button :
       {"Record", "Play", "Open...", "A/B", "Freeze plots", "Pause", "Start over"}) {
    EXPECT_TRUE(find(button, "transport")) << button;
    EXPECT_NE(hint(button, "transport"), "") << button;
  }
  EXPECT_THAT(hint("1x", "transport"), HasSubstr("Speed of the simulation."));
  const CouplingKind before = desktop->settings.parameters().kind;
  click("A/B", "transport");
  EXPECT_NE(desktop->settings.parameters().kind, before);
  click("Freeze plots", "transport");
  EXPECT_FALSE(desktop->shown.stage().group.following());
  click("Follow", "transport");
  EXPECT_TRUE(desktop->shown.stage().group.following());
  click("Pause", "transport");
  EXPECT_TRUE(desktop->live.paused());
  EXPECT_TRUE(find(">", "transport"));
  EXPECT_FALSE(find("1x", "transport"));
  click("Pause", "transport");
  EXPECT_FALSE(desktop->live.paused());
  click("Open...", "transport");
  EXPECT_EQ(desktop->dialog.name(), "open session");
}

TEST_F(Words, OfTheBarBelowCountWhatIsRecorded) {
  click("Record", "transport");
  ASSERT_TRUE(until([&] { return desktop->live.loop().recording(); }));
  frames(5);
  EXPECT_TRUE(find("Stop", "transport"));
  EXPECT_FALSE(find("Play", "transport"));
  EXPECT_THAT(words("transport"), ContainsRegex("\n00:0[0-9]\\.[0-9]\n"));
  click("Stop", "transport");
  EXPECT_TRUE(until([&] { return !desktop->live.recording(); }));
}

TEST_F(Words, OfPlaybackLeadThroughTheRecording) {
  play_table();
  Player& player = desktop->playback.shown()->player();
  for (const char* button : {"Play", "|<", "<", ">", "Loop", "Re-run", "Back to live"}) {
    EXPECT_TRUE(find(button, "transport")) << button;
    EXPECT_NE(hint(button, "transport"), "") << button;
  }
  player.seek(1);
  const double tick = desktop->playback.shown()->player().session().info.tick;
  click(">", "transport");
  EXPECT_NEAR(player.time(), 1 + tick, tick / 2);
  click("<", "transport");
  click("<", "transport");
  EXPECT_NEAR(player.time(), 1 - tick, tick / 2);
  EXPECT_THAT(words("transport"), ContainsRegex("00:01\\.0 / 00:[0-9.]+"));
  click("|<", "transport");
  EXPECT_EQ(player.time(), 0);
  click("Loop", "transport");
  EXPECT_TRUE(player.loop);
  click("Loop", "transport");
  EXPECT_FALSE(player.loop);
  click("Play", "transport");
  EXPECT_TRUE(player.playing());
  EXPECT_TRUE(find("Pause", "transport"));
  const std::string panel = words("coupling");
  for (const char* title :
       {"In this recording", "Settings of the re-run (E)", "Coupling", "Grip stiffness"}) {
    EXPECT_THAT(panel, HasSubstr(title));
  }
  EXPECT_THAT(sentences(kSidePanel),
              HasSubstr("The scene of the recording. This scene cannot be changed."));
  EXPECT_THAT(
      sentences(kSidePanel),
      HasSubstr(
          "These settings are for the re-run. The panel on the left shows the recorded ones."));
  EXPECT_THAT(words("##MainMenuBar"), HasSubstr("playing table.h5"));
  click("Back to live", "transport");
  EXPECT_FALSE(desktop->playback.on());
}

TEST_F(Words, OfPlaybackListItsSpeeds) {
  play_table();
  const Player& player = desktop->playback.shown()->player();
  for (const auto& [text, speed] : {std::pair("0.1x", 0.1),
                                    {"0.2x", 0.2},
                                    {"0.5x", 0.5},
                                    {"2x", 2.0},
                                    {"5x", 5.0},
                                    {"10x", 10.0},
                                    {"1x", 1.0}}) {
    const auto now = find(fmt::format("{:g}x", player.speed), "transport");
    ASSERT_TRUE(now) << words("transport");
    click(now->middle());
    click(text, "##Combo");
    EXPECT_EQ(player.speed, speed);
  }
}

TEST_F(Words, OfTheVideoDialogReckonItsLength) {
  play_table();
  run("session.write_video");
  frames(4);
  const std::string shown = words("Write a video");
  const double duration = desktop->playback.shown()->player().duration();
  for (const char* label : {"MP4 video", "format", "size", "pictures per second", "speed",
                            "as it was", "with the plots", "from", "to", "Write (Enter)"}) {
    EXPECT_THAT(shown, HasSubstr(std::string(label))) << label;
  }
  // 30 pictures per second, as usual.
  EXPECT_THAT(shown, HasSubstr(fmt::format("{:.1f} s, {:.0f} pictures", duration,
                                           std::round(30 * duration))));
  EXPECT_EQ(shown.find("in one picture") != std::string::npos,
            desktop->playback.shown()->player().session().lanes() > 1);
  click("Cancel (Esc)", "Write a video");
  EXPECT_EQ(desktop->dialog.name(), "");
}

TEST_F(Words, OfTheStatusLineAreLawRateAndForce) {
  desktop->settings.parameters().kind = CouplingKind::proposed;
  desktop->settings.parameters().eta = 0.75;
  frames(3);
  const std::string shown = words("##MainMenuBar");
  EXPECT_THAT(shown, HasSubstr("PROPOSED"));
  EXPECT_THAT(shown, HasSubstr("0.75"));
  EXPECT_THAT(shown, ContainsRegex("\n[0-9]+ Hz\n"));
  EXPECT_THAT(shown, ContainsRegex("\n(on time|[0-9.]+ % of ticks missed)\n"));
  EXPECT_TRUE(
      until([&] { return words("##MainMenuBar").find("force on [Esc]") != std::string::npos; }));
  desktop->cut_force();
  EXPECT_TRUE(
      until([&] { return words("##MainMenuBar").find("force off [F]") != std::string::npos; }));
  EXPECT_EQ(hint("force off [F]", "##MainMenuBar"), "Key F switches the force on");
  desktop->settings.parameters().kind = CouplingKind::standard;
  frames(3);
  EXPECT_THAT(words("##MainMenuBar"), HasSubstr("STANDARD"));
  EXPECT_THAT(words("##MainMenuBar"), Not(HasSubstr("0.75"))) << "it takes no eta";
  desktop->live.pause(true);
  frames(3);
  EXPECT_THAT(words("##MainMenuBar"), HasSubstr("paused"));
}

TEST_F(Words, OfANarrowWindowHaveOneMenu) {
  width = 430;
  frames(3);
  EXPECT_TRUE(find("Menu", "##MainMenuBar"));
  EXPECT_FALSE(find("Session", "##MainMenuBar"));
  EXPECT_THAT(words("##MainMenuBar"), HasSubstr("force o")) << "what matters most stays";
  click("Menu", "##MainMenuBar");
  EXPECT_THAT(menu_words(), HasSubstr("\nSession\n"));
}

TEST_F(Words, OfYourTurnTickWhatWasDone) {
  desktop->settings.your_turn = true;
  desktop->settings.tried.clear();
  frames(3);
  const std::string shown = words("Your turn");
  for (const FirstStepInfo& step : kFirstSteps) {
    EXPECT_THAT(shown, HasSubstr(step.what));
    EXPECT_THAT(shown, HasSubstr(step.how));
  }
  width = 900;
  height = 560;
  note_done(desktop->settings, FirstStep::pull);
  frames(4);
  EXPECT_THAT(words("Your turn"), HasSubstr("Your turn, 2 of 7:"));
  EXPECT_THAT(words("Your turn"), HasSubstr("Move the tip along the view"));
  click("Close", "Your turn");
  EXPECT_FALSE(desktop->settings.your_turn);
  width = 1440;
  height = 900;
  desktop->settings.your_turn = true;
  frames(3);
  EXPECT_TRUE(find("Close the list", "Your turn"));
  note_all_done(desktop->settings);
  frames(2);
  click("Done", "Your turn");
  EXPECT_FALSE(desktop->settings.your_turn);
}

TEST_F(Words, OfTheFirstStartOfferAStory) {
  desktop->settings.hint_seen = false;
  frames(3);
  EXPECT_THAT(hint("Show me (47 s)", "story"), HasSubstr("Plays a story"));
  click("Show me (47 s)", "story");
  EXPECT_TRUE(desktop->settings.hint_seen);
  EXPECT_TRUE(desktop->playback.loading() || desktop->playback.on());
}

TEST_F(Words, OfRunsOnOneHandStandSideBySide) {
  desktop->tuning.toggle_twin();
  ASSERT_TRUE(until([&] { return desktop->shown.rows().size() == 2; }));
  frames(4);
  const std::string shown = words("coupling");
  for (const char* line : {"|x_E| mrad", "|f1| N m", "|f2| N m", "E_c mJ", "all in one picture"}) {
    EXPECT_THAT(shown, HasSubstr(line));
  }
  EXPECT_THAT(hint("all in one picture", "coupling"), HasSubstr("(Shift+B)"));
  click("all in one picture", "coupling");
  EXPECT_TRUE(desktop->settings.overlaid);
  EXPECT_THAT(hint("+ run", "coupling"), HasSubstr("(Ctrl+B)"));
  click("+ run", "coupling");
  ASSERT_TRUE(until([&] { return desktop->shown.rows().size() == 3; }));
  frames(4);
  EXPECT_FALSE(find("+ run", "coupling")) << "three are the most";
}

TEST_F(Words, OfFoldedPanelsComeBackByTheirTabs) {
  for (bool Settings::*shown :
       {&Settings::show_left, &Settings::show_right, &Settings::show_plots}) {
    desktop->settings.*shown = false;
  }
  frames(3);
  EXPECT_EQ(words("coupling"), "");
  EXPECT_EQ(words(kSidePanel), "");
  const auto tab = [&](const char* name) {
    const ImGuiWindow* window = ImGui::FindWindowByName(name);
    EXPECT_NE(window, nullptr) << name;
    return window->Rect().GetCenter();
  };
  point_at(tab("left tab"));
  EXPECT_THAT(words("##Tooltip"), HasSubstr("Shows the coupling panel (F2)"));
  for (const char* name : {"left tab", "right tab", "plots tab"}) click(tab(name));
  EXPECT_TRUE(desktop->settings.show_left && desktop->settings.show_right &&
              desktop->settings.show_plots);
  EXPECT_NE(words("coupling"), "");
  point_at(tab("right tab"));
  EXPECT_THAT(words("##Tooltip"), HasSubstr("Hides the panel of scene and device (F3)"));
}

TEST_F(Words, OfABlindWindowTellNoLaw) {
  const float beside_panels = desktop->shown.picture.width();
  ASSERT_LT(beside_panels, static_cast<float>(width));
  desktop->blind = true;
  frames(4);
  EXPECT_EQ(desktop->shown.picture.width(), static_cast<float>(width)) << "the scene is all of it";
  const std::string shown = words();
  for (const char* word : {"Predictive", "PREDICTIVE", "Coupling", "File", "Record"}) {
    EXPECT_THAT(shown, Not(HasSubstr(word)));
  }
}

// The state for scripts, against the parts themselves.
TEST_F(Words, OfTheStateForScriptsAreThoseOfTheParts) {
  run("help.about");
  desktop->settings.parameters().alpha = 0.0123;
  desktop->notices.say("A notice.");
  frames(3);
  testing::internal::CaptureStdout();
  print_state(*desktop, {1440, 900, 77, true, {.keys = 3, .buttons = 5}});
  const auto state = nlohmann::json::parse(testing::internal::GetCapturedStdout());
  EXPECT_EQ(state["dialog"], "about");
  EXPECT_EQ(state["alpha"], 0.0123);
  EXPECT_EQ(state["eta"], desktop->settings.parameters().eta);
  EXPECT_EQ(state["k_vc"], desktop->settings.parameters().k_vc);
  EXPECT_EQ(state["size"], nlohmann::json({1440, 900}));
  EXPECT_EQ(state["frames"], 77);
  EXPECT_EQ(state["input_waits"], true);
  EXPECT_EQ(state["taken"], nlohmann::json({{"keys", 3}, {"buttons", 5}}));
  EXPECT_EQ(state["notices"].back(), "A notice.");
  EXPECT_EQ(state["arm"], "omni");
  EXPECT_EQ(state["playing"], false);
  EXPECT_EQ(state["recording"], false);
  EXPECT_EQ(state["twin"], false);
  EXPECT_EQ(state["twin_error"], 0);
  EXPECT_EQ(state["sweep"], nullptr);
  EXPECT_EQ(state["range"], nullptr);
  EXPECT_EQ(state["recorded"], nullptr);
  EXPECT_EQ(state["question"], nullptr);
  EXPECT_EQ(state["selected"], nullptr);
  EXPECT_EQ(state["objects"], desktop->document.scene().objects.size());
  EXPECT_EQ(state["plots"].size(), desktop->shown.stage().plots.size());
  EXPECT_EQ(state["identify"]["phase"], "asking");
  EXPECT_EQ(state["device_panel"]["in_use"], "");
  const auto places = dialog_places();
  ASSERT_TRUE(places);
  EXPECT_NEAR(state["closing"]["cross"][0].get<float>(), places->cross.x, 1);
  EXPECT_NEAR(state["closing"]["button"][1].get<float>(), places->button->y, 1);
  EXPECT_TRUE(state["places"]["tip"].is_array());
  EXPECT_EQ(state["places"]["objects"].size(), desktop->document.scene().objects.size());
}

TEST_F(Words, OfTheStateForScriptsTellOfPlaybackAndSelection) {
  desktop->document.editor().select(0);
  frames(2);
  const auto state = [&] {
    testing::internal::CaptureStdout();
    print_state(*desktop, {1440, 900, 1, false, {}});
    return nlohmann::json::parse(testing::internal::GetCapturedStdout());
  };
  EXPECT_EQ(state()["selected"], desktop->document.scene().objects[0].name);
  play_table();
  desktop->playback.shown()->player().seek(0.5);
  frames(2);
  const nlohmann::json playing = state();
  EXPECT_EQ(playing["playing"], true);
  EXPECT_NEAR(playing["recorded"]["at"].get<double>(), 0.5, 1e-3);
  EXPECT_EQ(playing["recorded"]["marks"].size(), desktop->playback.shown()->marks().size());
}

}  // namespace
}  // namespace limpid
