// Dialogs of the window: what each of them offers, refuses and hands over.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "app/experiments/experiment.h"
#include "tests/app/desktop/shell/whole_window.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

class Dialog : public WholeWindow {
 protected:
  void write(const std::string& text) {
    ImGui::GetIO().AddInputCharactersUTF8(text.c_str());
    frames(3);
  }
  void play(const char* session) {
    desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions" / session);
    ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
    desktop->playback.shown()->player().pause();
    frames(3);
  }
};

TEST_F(Dialog, OfPresetsListsUsesKeepsRenamesAndRemoves) {
  run("settings.presets");
  frames(3);
  for (const char* name :
       {"Paper's values", "Spring and damper", "Light hand", "Stiff walls", "comes with Limpid"}) {
    EXPECT_TRUE(find(name, "Presets")) << name;
  }
  click("Use", "Presets");
  EXPECT_EQ(desktop->dialog.name(), "presets") << "none is chosen";
  click("Light hand", "Presets");
  click("Remove", "Presets");
  EXPECT_TRUE(find("Light hand", "Presets")) << "it came along";
  EXPECT_FALSE(find("Remove it", "Presets"));
  click("Use", "Presets");
  EXPECT_EQ(desktop->dialog.name(), "");
  EXPECT_EQ(desktop->settings.parameters().kind, CouplingKind::predictive);
  EXPECT_EQ(desktop->settings.parameters().eta, 0.3);

  run("settings.presets");
  frames(3);
  click("Save the present one", "Presets");
  EXPECT_THAT(words("Presets"), HasSubstr("Type a name first."));
  click("Close (Esc)", "Presets");
  run("settings.presets");
  frames(4);
  write("mine");
  click("Save the present one", "Presets");
  EXPECT_TRUE(find("mine", "Presets"));
  EXPECT_TRUE(find("Replace by the present one", "Presets")) << "it is one's own";
  EXPECT_NE(desktop->tuning.presets.find("mine"), nullptr);
  click("Remove", "Presets");
  EXPECT_NE(desktop->tuning.presets.find("mine"), nullptr) << "asks once more";
  click("Remove it", "Presets");
  EXPECT_EQ(desktop->tuning.presets.find("mine"), nullptr);
}

TEST_F(Dialog, OfPresetsTakesANameByEnterAndKeepsWhatCameAlong) {
  run("settings.presets");
  frames(4);
  write("Heavy hand");
  click("Save the present one", "Presets");
  EXPECT_THAT(words("Presets"), HasSubstr("Heavy hand comes with Limpid; choose another name."));
  click("Close (Esc)", "Presets");
  run("settings.presets");
  frames(4);
  write("Heavy hand");
  press(GLFW_KEY_ENTER);
  frames(2);
  EXPECT_EQ(desktop->settings.parameters().eta, 3);
  EXPECT_EQ(desktop->dialog.name(), "");
}

TEST_F(Dialog, OfLayoutsSetsPanelsAndPlots) {
  run("plots.layouts");
  frames(3);
  EXPECT_THAT(words("Layouts"), HasSubstr("says which plots and panels the window"));
  click("Frequencies", "Layouts");
  click("Use", "Layouts");
  frames(3);
  ASSERT_GE(desktop->settings.plot_choices.size(), 2u);
  EXPECT_EQ(desktop->settings.plot_choices[0].kind, PlotKind::spectrum);
  EXPECT_EQ(desktop->settings.plot_choices[0].title, "hand and contact torque");
}

TEST_F(Dialog, OfAMarkTakesItsTextAndSaysWhereItStands) {
  play("table.h5");
  const std::size_t before = desktop->playback.shown()->marks().size();
  desktop->playback.shown()->player().seek(0.75);
  away();
  run("session.mark");
  frames(3);
  EXPECT_THAT(words("Mark"), HasSubstr("at 0.750 s; kept in table.h5"));
  EXPECT_FALSE(find("Remove", "Mark")) << "it is not there yet";
  click("Cancel (Esc)", "Mark");
  EXPECT_EQ(desktop->playback.shown()->marks().size(), before);
}

TEST_F(Dialog, OfAMarkIsInThePlotsWhereNothingIsRecorded) {
  away();
  run("session.mark");
  frames(4);
  EXPECT_THAT(words("Mark"), ContainsRegex("at [0-9.]+ s; only in the plots .no recording."));
  EXPECT_TRUE(find("mark 1", "Mark"));
  write_over("here it was");
  click("Set (Enter)", "Mark");
  frames(2);
  const auto& marks = desktop->live.stage().history.marks();
  ASSERT_FALSE(marks.empty());
  EXPECT_EQ(marks.back().label, "here it was");
  run("session.mark");
  frames(4);
  EXPECT_TRUE(find("mark 2", "Mark"));
  write_over(std::string(300, 'x'));
  EXPECT_THAT(words("Mark"), ContainsRegex("300 bytes; allowed: at most [0-9]+"));
  const std::size_t count = marks.size();
  click("Set (Enter)", "Mark");
  EXPECT_EQ(desktop->live.stage().history.marks().size(), count) << "it is too long";
}

TEST_F(Dialog, OfAnExportWritesThePlotInTheSizeThatIsAsked) {
  run("export.begin");
  frames(4);
  const std::string shown = words("Export");
  for (const char* label :
       {"a plot, as a picture", "what", "plot", "PNG, pixels", "SVG, lines", "light, for paper",
        "dark, for slides", "by", "printed", "dpi", "file", "Export (Enter)", "Cancel (Esc)"}) {
    EXPECT_THAT(shown, HasSubstr(label));
  }
  click("SVG, lines", "Export");
  EXPECT_FALSE(find("dpi", "Export")) << "lines have none";
  EXPECT_THAT(words("Export"), ContainsRegex("-001.svg"));
  click("PNG, pixels", "Export");
  EXPECT_TRUE(find("dpi", "Export"));
  click("a plot, as a picture", "Export");
  click("a plot, as a table (CSV)");
  EXPECT_FALSE(find("PNG, pixels", "Export"));
  EXPECT_THAT(words("Export"), ContainsRegex("-001.csv"));
  click("Export (Enter)", "Export");
  EXPECT_EQ(desktop->dialog.name(), "");
  ASSERT_TRUE(until([&] { return !desktop->exporter.written().empty(); }));
  const fs::path file = desktop->exporter.written();
  EXPECT_EQ(file.extension(), ".csv");
  EXPECT_GT(fs::file_size(file), 0u);
  EXPECT_TRUE(run_command("export.forget", *desktop).empty());
  run("export.begin");
  frames(4);
  EXPECT_THAT(words("Export"), ContainsRegex("-002.csv")) << "the first name is taken";
  click("a plot, as a table (CSV)", "Export");
  click("the whole window");
  click("Export (Enter)", "Export");
  EXPECT_EQ(desktop->asked.picture.extension(), ".png");
}

TEST_F(Dialog, OfAnExportRefusesWhatCannotBeAndAsksBeforeItReplacesAFile) {
  const auto write_into = [&](const std::string& shown, const std::string& text) {
    const std::vector<test::DrawnText> all = test::drawn_texts();
    const auto field = std::ranges::find_if(all, [&](const test::DrawnText& each) {
      return each.window.starts_with("Export") && each.text.ends_with(shown);
    });
    ASSERT_NE(field, all.end()) << words("Export");
    click(ImVec2{field->min.x + 5, field->middle().y});
    write_over(text);
  };
  const auto refuses = [&](const char* why) {
    EXPECT_THAT(sentences("Export"), HasSubstr(why));
    click("Export (Enter)", "Export");
    EXPECT_EQ(desktop->dialog.name(), "export") << why;
  };
  const fs::path file = dir / "mine.svg";
  std::ofstream(file) << "mine";
  run("export.begin");
  frames(4);
  write_into("160 mm", "1");
  refuses("The size is 1 x 80 mm; allowed:");
  write_into("1 mm", "100");
  write_into("300", "1");
  refuses("1 dpi; allowed:");
  click("SVG, lines", "Export");
  click("dark, for slides", "Export");
  click("a plot, as a picture", "Export");
  click("all plots, as one figure");
  EXPECT_TRUE(find("each plot", "Export"));
  write_into("/plots-001.svg", (dir / "none/mine.svg").string());
  refuses("There is no folder");
  write_into("none/mine.svg", file.string());
  EXPECT_THAT(sentences("Export"), HasSubstr("This file already exists."));
  EXPECT_FALSE(find("Export (Enter)", "Export"));
  click("Replace it (Enter)", "Export");
  EXPECT_EQ(desktop->dialog.name(), "");
  ASSERT_TRUE(until([&] { return desktop->exporter.written() == file; }));
  std::ifstream in(file);
  const std::string svg{std::istreambuf_iterator<char>(in), {}};
  EXPECT_THAT(svg, HasSubstr("width=\"100mm\""));
  const std::size_t plots = desktop->live.stage().plots.size();
  EXPECT_THAT(svg, HasSubstr(fmt::format("\"area{}\"", plots)));
  const Rgb dark = palette(Theme::dark).panel;
  EXPECT_THAT(svg, HasSubstr(fmt::format("#{:02x}{:02x}{:02x}", dark.r, dark.g, dark.b)));
}

TEST_F(Dialog, OfAnExportTakesAllTimesWhereItsBoxIsEmpty) {
  play("table.h5");
  Stage& stage = desktop->playback.shown()->stage();
  const double from = stage.history.offset() + 1;
  stage.group.select(PlotRange{from, from + 0.5, 0});
  const auto rows = [&](bool click_box) {
    run("export.begin");
    frames(4);
    if (find("a plot, as a picture", "Export")) {
      click("a plot, as a picture", "Export");
      click("a plot, as a table (CSV)");
    }
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.text.starts_with("only the selected time") && click_box) click(each.middle());
    }
    click("Export (Enter)", "Export");
    EXPECT_TRUE(until([&] { return !desktop->exporter.written().empty(); }));
    std::ifstream in(desktop->exporter.written());
    run("export.forget");
    return std::count(std::istreambuf_iterator<char>(in), {}, '\n') - 1;
  };
  EXPECT_NEAR(static_cast<double>(rows(false)), 0.5 / stage.history.tick(), 1.5);
  EXPECT_GT(static_cast<double>(rows(true)), 1 / stage.history.tick());
}

TEST_F(Dialog, OfAnExportOffersAVideoOfRecordingsAlone) {
  run("export.begin");
  frames(4);
  click("a plot, as a picture", "Export");
  EXPECT_FALSE(find("the recording, as a video"));
  press(GLFW_KEY_ESCAPE);
  desktop->escape();
  frames(3);
  play("table.h5");
  run("export.begin");
  frames(4);
  click("a plot, as a picture", "Export");
  click("the recording, as a video");
  EXPECT_THAT(words("Export"), HasSubstr("The next dialog asks for length, size and speed."));
  click("Go on (Enter)", "Export");
  EXPECT_EQ(desktop->dialog.name(), "video");
}

TEST_F(Dialog, OfAFileListsFoldersAndFilesOfItsKind) {
  const fs::path folder = dir / "files";
  fs::create_directories(folder / "inside");
  std::ofstream(folder / "one.toml") << "title = \"One\"\n";
  std::ofstream(folder / "two.txt") << "";
  std::ofstream(folder / ".hidden.toml") << "";
  desktop->dialog.last_folder = folder;
  run("scene.open");
  frames(4);
  const std::string shown = words("Open scene");
  EXPECT_THAT(shown, HasSubstr("inside/"));
  EXPECT_THAT(shown, HasSubstr("one.toml"));
  EXPECT_THAT(shown, Not(HasSubstr("two.txt")));
  EXPECT_THAT(shown, Not(HasSubstr(".hidden")));
  EXPECT_THAT(shown, HasSubstr("Scenes of Limpid")) << "a place";
  click("inside/", "Open scene");
  EXPECT_THAT(words("Open scene"), Not(HasSubstr("one.toml")));
  EXPECT_THAT(words("Open scene"), HasSubstr("../"));
  click("../", "Open scene");
  EXPECT_THAT(words("Open scene"), HasSubstr("inside/")) << "up again";
  click("one.toml", "Open scene");
  click("Open", "Open scene");
  EXPECT_EQ(desktop->dialog.name(), "");
  EXPECT_TRUE(until([&] { return desktop->document.file() == folder / "one.toml"; }));
}

TEST_F(Dialog, OfAFileSaysWhatIsNotThere) {
  desktop->dialog.last_folder = dir / ".";
  run("scene.open");
  frames(4);
  write_over((dir / "none.toml").string());
  click("Open", "Open scene");
  EXPECT_THAT(words("Open scene"), HasSubstr("There is no such file."));
  click("Cancel (Esc)", "Open scene");
  EXPECT_EQ(desktop->dialog.name(), "");
}

TEST_F(Dialog, OfANewFileAsksBeforeItReplacesOne) {
  const fs::path folder = dir / "files";
  fs::create_directories(folder);
  std::ofstream(folder / "old.toml") << "mine";
  run("scene.save_as");
  frames(4);
  write_over((folder / "old").string());
  click("Save", "Save scene as");
  EXPECT_THAT(words("Save scene as"), HasSubstr("old.toml exists already."));
  click("Replace it", "Save scene as");
  EXPECT_TRUE(until([&] { return desktop->document.file() == folder / "old.toml"; }));
  run("scene.save_as");
  frames(4);
  write_over((folder / "none/new.toml").string());
  click("Save", "Save scene as");
  EXPECT_THAT(words("Save scene as"), HasSubstr("There is no folder"));
  click("New folder", "Save scene as");
  frames(3);
  write("a/b");
  press(GLFW_KEY_ENTER);
  EXPECT_THAT(words("Save scene as"), HasSubstr("A folder's name has no / in it."));
}

TEST_F(Dialog, OfSessionsListsWhatCameAlong) {
  run("session.open");
  frames(4);
  const std::string shown = words("Open session");
  for (const char* label : {"Yours", "none yet", "Shipped with Limpid", "Open (Enter)",
                            "Cancel (Esc)", "Elsewhere..."}) {
    EXPECT_THAT(shown, HasSubstr(label));
  }
  EXPECT_THAT(shown, ContainsRegex("[0-9.]+ MiB"));
  write((dir / "none.h5").string());
  click("Open (Enter)", "Open session");
  EXPECT_THAT(words("Open session"), HasSubstr("There is no such file."));
  click("Cancel (Esc)", "Open session");
  run("session.open");
  frames(4);
  write((dir / ".").string());
  click("Open (Enter)", "Open session");
  EXPECT_THAT(sentences("Open session"),
              HasSubstr("There is no table.h5 of a sweep in that folder."));
  click("Elsewhere...", "Open session");
  EXPECT_EQ(desktop->dialog.name(), "find session");
}

TEST_F(Dialog, OfSessionsFindsAPartOfAName) {
  run("session.open");
  frames(4);
  EXPECT_THAT(words("Open session"), AllOf(HasSubstr("table.h5"), HasSubstr("stack.h5")));
  write("STACK");
  const std::string shown = words("Open session");
  EXPECT_THAT(shown, AllOf(HasSubstr("stack.h5"), Not(HasSubstr("table.h5"))));
  press(GLFW_KEY_ENTER);
  EXPECT_TRUE(until([&] { return desktop->playback.on(); }));
  EXPECT_EQ(desktop->playback.last().filename(), "stack.h5");
}

TEST_F(Dialog, OfTheGalleryOpensAScene) {
  height = 1600;
  run("scene.gallery");
  frames(4);
  const std::string shown = words();
  EXPECT_THAT(shown, HasSubstr("Shipped with Limpid"));
  EXPECT_THAT(shown, HasSubstr("Arrow keys and Enter choose a scene"));
  EXPECT_THAT(shown, HasSubstr("Play its recorded session"));
  press(GLFW_KEY_RIGHT);
  press(GLFW_KEY_RIGHT);
  press(GLFW_KEY_ENTER);
  EXPECT_EQ(desktop->dialog.name(), "");
  EXPECT_TRUE(until([&] { return said("Scene:"); }));
}

TEST_F(Dialog, OfTheGalleryShowsTheScenesWithAPartOfAName) {
  height = 1600;
  run("scene.gallery");
  frames(4);
  write("SEESAW");
  frames(2);
  const std::string shown = words();
  EXPECT_THAT(shown, HasSubstr("Seesaw"));
  EXPECT_THAT(shown, Not(HasSubstr("Dominoes")));
  write("x");
  frames(2);
  EXPECT_THAT(words(), HasSubstr("no scene of this name"));
  press(GLFW_KEY_ENTER);
  EXPECT_EQ(desktop->dialog.name(), "gallery") << "nothing to open";
  desktop->escape();
  frames(3);
  EXPECT_EQ(desktop->dialog.name(), "");
  run("scene.gallery");
  frames(4);
  EXPECT_THAT(words(), HasSubstr("Dominoes")) << "begins anew";
  write("seesaw");
  frames(2);
  press(GLFW_KEY_ENTER);
  EXPECT_EQ(desktop->dialog.name(), "");
  EXPECT_TRUE(until([&] { return said("Scene: Seesaw"); }));
}

TEST_F(Dialog, OfMessagesHasAllThatWasSaid) {
  for (int i = 0; i < 3; ++i) desktop->notices.say("number " + std::to_string(i), i == 1);
  desktop->notices.clear();
  run("help.messages");
  frames(4);
  const std::string shown = words();
  EXPECT_LT(shown.find("number 2"), shown.find("number 0")) << "the newest comes first";
  click("Copy all");
  EXPECT_THAT(std::string(ImGui::GetClipboardText()), HasSubstr("number 1"));
  for (std::size_t i = 0; i < 2 * Notices::kKept; ++i)
    desktop->notices.say("more " + std::to_string(i));
  EXPECT_EQ(desktop->notices.past().size(), Notices::kKept) << "the oldest leave";
  EXPECT_EQ(desktop->notices.past().back().text, "more 399");
}

TEST_F(Dialog, OfAPersonGivesTheAnswerThatIsClickedOrTyped) {
  for (const bool beside : {false, true}) {
    for (const bool typed : {false, true}) {
      desktop->question.ask("Which is lighter?", {"left", "right"}, {.beside = beside});
      desktop->dialog.open("ask");
      frames(6);
      EXPECT_THAT(words(), HasSubstr("Which is lighter?"));
      EXPECT_TRUE(find("1   left"));
      if (typed) {
        write("2");
      } else {
        click("2   right");
      }
      const auto answer = desktop->question.take();
      ASSERT_TRUE(answer) << beside << typed;
      EXPECT_EQ(answer->choice, 1u);
      EXPECT_GT(answer->seconds, 0);
      ASSERT_TRUE(until([&] { return desktop->dialog.name().empty(); }));
    }
  }
}

TEST_F(Dialog, OfAPersonTakesEnterForTheOnlyAnswer) {
  desktop->question.ask("Read this.", {"Go on"}, {});
  desktop->dialog.open("ask");
  frames(6);
  EXPECT_TRUE(find("Go on  (Enter)"));
  press(GLFW_KEY_ENTER);
  const auto answer = desktop->question.take();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->choice, 0u);
}

// An answered question beside the picture stays a moment; one that is withdrawn does not.
TEST_F(Dialog, OfAPersonGoesAtOnceWhenItIsWithdrawn) {
  // A busy computer may draw the next pictures after that moment.
  ASSERT_TRUE(until([&] {
    desktop->question.ask("Which?", {"left", "right"}, {.beside = true});
    desktop->dialog.open("ask");
    frames(6);
    click("2   right");
    EXPECT_TRUE(desktop->question.take());
    const auto answered = std::chrono::steady_clock::now();
    desktop->question.withdraw();
    frames(2);
    EXPECT_EQ(desktop->dialog.name(), "");
    return std::chrono::steady_clock::now() - answered < std::chrono::milliseconds(200);
  }));
}

TEST_F(Dialog, OfAPersonEndsWithItsTime) {
  desktop->question.ask("Quick!", {"a", "b"}, {.seconds = 0.2});
  desktop->dialog.open("ask");
  ASSERT_TRUE(until([&] { return !desktop->question.asking(); }));
  const auto answer = desktop->question.take();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->choice, std::nullopt);
  EXPECT_GE(answer->seconds, 0.2);
}

TEST_F(Dialog, OfARecordingThatIsUnderWayKeepsIt) {
  desktop->world.toggle_recording();
  ASSERT_TRUE(until([&] { return desktop->live.loop().recording(); }));
  desktop->dialog.open("quit");
  frames(5);
  EXPECT_THAT(words("End the recording?"), HasSubstr("The part recorded until now is kept."));
  click("Go on (Esc)", "End the recording?");
  EXPECT_FALSE(desktop->asked.close);
  EXPECT_EQ(desktop->dialog.name(), "");
  desktop->dialog.open("quit");
  frames(5);
  click("End it and quit (Enter)", "End the recording?");
  EXPECT_TRUE(desktop->asked.close && desktop->recording_may_end);
  EXPECT_TRUE(until([&] { return !desktop->live.loop().recording(); }));
}

TEST_F(Dialog, OfUnsavedChangesSavesDiscardsOrStays) {
  const auto ask = [&] {
    desktop->document.editor().set_tip_radius(desktop->document.scene().tip_radius + 0.001);
    frames(2);
    desktop->world.new_scene();
    frames(5);
    ASSERT_TRUE(desktop->document.asking());
    EXPECT_THAT(words("Save changes?"), HasSubstr("The scene has changes that are not saved."));
    EXPECT_TRUE(find("Save as... (Enter)", "Save changes?")) << "it has no file of its own";
  };
  ask();
  click("Cancel (Esc)", "Save changes?");
  EXPECT_FALSE(desktop->document.asking());
  EXPECT_TRUE(desktop->document.editor().dirty());
  ask();
  click("Save as... (Enter)", "Save changes?");
  EXPECT_EQ(desktop->dialog.name(), "save scene");
  desktop->dialog.close();
  frames(3);
  ask();
  click("Discard (D)", "Save changes?");
  EXPECT_TRUE(until([&] { return !desktop->document.editor().dirty(); }));
}

TEST_F(Dialog, OfIdentifyingTriesASimulatedDevice) {
  run("device.identify");
  frames(4);
  const std::string shown = words("Identify the device");
  for (const char* label :
       {"of each joint's range", "of the motors' limits", "down, seen from the base",
        "identify again with a load at the tip", "Begin (Enter)", "Close (Esc)"}) {
    EXPECT_THAT(shown, HasSubstr(label));
  }
  EXPECT_THAT(shown, HasSubstr("Limpid moves a simulated device"));
  EXPECT_FALSE(find("load", "Identify the device"));
  click("identify again with a load at the tip", "Identify the device");
  EXPECT_TRUE(find("load", "Identify the device"));
  EXPECT_NE(hint("of the motors' limits", "Identify the device"), "");
  click("Begin (Enter)", "Identify the device");
  ASSERT_TRUE(until([&] { return desktop->identify.moving(); }));
  frames(3);
  EXPECT_THAT(words("Identify the device"), HasSubstr("The motors move the device now: "));
  EXPECT_FALSE(find("Close (Esc)", "Identify the device")) << "it has to be stopped first";
  click("Stop (Esc)", "Identify the device");
  EXPECT_TRUE(until([&] { return !desktop->identify.moving(); }));
}

TEST_F(Dialog, OfIdentifyingShowsWhatWasFoundOfEachJoint) {
  const std::string title = "Identify the device";
  run("device.identify");
  frames(4);
  click("Begin (Enter)", title);
  const auto found = [&] { return desktop->identify.phase() == IdentifyController::Phase::found; };
  ASSERT_TRUE(until(found) || until(found) || until(found)) << desktop->identify.wrong();
  frames(4);
  const std::string shown = words(title);
  const Identification& result = desktop->identify.done()->identification;
  ASSERT_EQ(result.found.joints.size(), 3u);
  for (std::size_t j = 0; j < 3; ++j) {
    const JointFinding& joint = result.found.joints[j];
    for (const std::string& text :
         {result.found.arm.joints[j].name, fmt::format("{:.3f}", result.inertia_in_file[j] / 1e-3),
          fmt::format("{:.1f} %", 100 * joint.residual / joint.torque)}) {
      EXPECT_THAT(shown, HasSubstr(text)) << "of joint " << j;
    }
  }
  EXPECT_TRUE(find("Again", title));
}

// A motion that was stopped is no result: the dialog asks again and says so, until the next one
// begins.
TEST_F(Dialog, OfIdentifyingSaysThatItWasStopped) {
  const std::string title = "Identify the device";
  run("device.identify");
  frames(4);
  EXPECT_EQ(desktop->identify.wrong(), "");
  EXPECT_THAT(words(title), Not(HasSubstr("Ended:")));
  for (int round = 0; round < 2; ++round) {
    click("Begin (Enter)", title);
    ASSERT_TRUE(until([&] { return desktop->identify.moving(); }));
    EXPECT_EQ(desktop->identify.wrong(), "") << "of this one";
    frames(3);
    click("Stop (Esc)", title);
    ASSERT_TRUE(until([&] { return !desktop->identify.moving(); }));
    frames(3);
    EXPECT_EQ(desktop->identify.phase(), IdentifyController::Phase::asking);
    EXPECT_EQ(desktop->identify.wrong(), "stopped");
    EXPECT_THAT(words(title), HasSubstr("Ended: stopped\n"));
  }
}

TEST_F(Dialog, OfExperimentsListsThemAndRunsOne) {
  run("experiments.show");
  frames(4);
  const std::string shown = words();
  EXPECT_THAT(shown, HasSubstr("Each experiment runs in the"));
  EXPECT_THAT(shown, HasSubstr("Run all"));
  for (const Experiment& each : experiments()) {
    EXPECT_TRUE(noted_place("Experiments", each.name)) << each.name;
  }
  for (const Experiment& each : experiments().first(4)) {
    const std::string words(each.about + 1);  // the first letter is a capital
    EXPECT_THAT(shown, HasSubstr(words.substr(0, words.find(' ')))) << "before " << each.name;
  }
  const auto button = noted_place("Experiments", "Run inertia");
  ASSERT_TRUE(button);
  click(*button);
  ASSERT_TRUE(until([&] { return !desktop->experiments_under_way.empty() || said("inertia:"); }));
  ASSERT_TRUE(until([&] { return said("inertia: passed"); }));
  frames(4);
  const std::string verdict = words();
  for (const char* head : {" \u2264 0.02", "passed", "Trials, to open in playback"}) {
    EXPECT_THAT(verdict, HasSubstr(head));
  }
}

TEST_F(Dialog, OfExperimentsLetsThemWaitForEachOtherAndStopsThem) {
  run("experiments.show");
  frames(4);
  const auto button_of = [&](const char* name) -> test::DrawnText {
    const auto at = noted_place("Experiments", std::string("Run ") + name);
    for (const test::DrawnText& each : test::drawn_texts()) {
      const bool is_one = each.text == "Run" || each.text == "runs" || each.text == "waits";
      if (at && is_one && std::abs(each.middle().y - at->y) < 4) return each;
    }
    ADD_FAILURE() << name << " has no button";
    return {};
  };
  click(button_of("passivity").middle());
  ASSERT_TRUE(until([&] { return !desktop->experiments_under_way.empty(); }));
  click(button_of("inertia").middle());
  EXPECT_EQ(button_of("passivity").text, "runs");
  EXPECT_EQ(button_of("inertia").text, "waits");
  EXPECT_EQ(button_of("coordination").text, "Run");
  EXPECT_THAT(desktop->experiments_under_way, testing::StartsWith("1 of 2: passivity"));
  EXPECT_FALSE(find("Run all"));
  click("Stop");
  ASSERT_TRUE(
      until([&] { return said("The experiments have stopped. Finished trials are kept"); }));
  frames(5);
  EXPECT_EQ(button_of("passivity").text, "Run");
  EXPECT_EQ(button_of("inertia").text, "Run") << "it has not begun";
  EXPECT_TRUE(find("Run all"));
  EXPECT_EQ(desktop->experiments_under_way, "");
}

TEST_F(Dialog, OfAPlotChoosesItsChannels) {
  run("plots.add");
  frames(4);
  for (const char* label :
       {"over time", "against a channel", "spectrum", "Done (Esc)", "None", "Remove plot"}) {
    EXPECT_TRUE(find(label)) << label;
  }
  const std::size_t plot = desktop->plots.chosen();
  EXPECT_NE(hint("spectrum"), "");
  write("hand torque norm");
  press(GLFW_KEY_ENTER);
  frames(2);
  ASSERT_LT(plot, desktop->settings.plot_choices.size());
  EXPECT_EQ(desktop->settings.plot_choices[plot].channels.size(), 1u);
  click("spectrum");
  EXPECT_EQ(desktop->settings.plot_choices[plot].kind, PlotKind::spectrum);
  click("against a channel");
  EXPECT_TRUE(find("along x"));
  EXPECT_NE(desktop->settings.plot_choices[plot].across, "");
  click("None");
  EXPECT_TRUE(desktop->settings.plot_choices[plot].channels.empty());
  click("Remove plot");
  EXPECT_EQ(desktop->settings.plot_choices.size(), plot);
  EXPECT_EQ(desktop->dialog.name(), "");
}

TEST_F(Dialog, OfAPlotTakesItsNameInAFieldAsWideAsTheDialog) {
  const char* title = "What the plot shows";
  run("plots.add");
  frames(4);
  const std::size_t plot = desktop->plots.chosen();
  const std::vector<test::DrawnText> all = test::drawn_texts();
  const auto field = std::ranges::find_if(all, [&](const test::DrawnText& each) {
    return each.window.starts_with(title) && each.text.starts_with("name:");
  });
  ASSERT_NE(field, all.end()) << words(title);
  const ImGuiWindow* window = ImGui::FindWindowByName(title);
  ASSERT_NE(window, nullptr);
  click(ImVec2{window->WorkRect.Max.x - 5, field->middle().y});
  write("mine");
  ASSERT_LT(plot, desktop->settings.plot_choices.size());
  EXPECT_EQ(desktop->settings.plot_choices[plot].title, "mine");
}

}  // namespace
}  // namespace limpid
