// Banners over the picture, what Esc closes one after the other, and questions of programs.
#include <fmt/format.h>

#include <optional>

#include "tests/app/desktop/shell/whole_window.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Banners : public WholeWindow {
 protected:
  void SetUp() override {
    WholeWindow::SetUp();
    if (!desktop) return;
    ASSERT_TRUE(until([&] { return desktop->banners().empty(); }));
  }
  // Returns one of the banners; on a busy computer that of the force may come and go.
  std::optional<Banner> banner(const std::string& id) const {
    for (const Banner& each : desktop->banners()) {
      if (each.id == id) return each;
    }
    return std::nullopt;
  }
  static std::vector<std::string> labels(const Banner& banner) {
    std::vector<std::string> all;
    for (const Banner::Button& button : banner.buttons) all.push_back(button.label);
    return all;
  }
  void play() {
    desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
    ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
    desktop->playback.shown()->player().pause();
    frames(3);
  }
  // Asks a question with `count` choices and returns what `answer` chooses.
  template <class Reply>
  std::optional<std::size_t> asked(std::size_t count, bool beside, Reply answer) {
    std::vector<std::string> choices;
    for (std::size_t i = 0; i < count; ++i) choices.push_back(fmt::format("choice {}", i + 1));
    desktop->question.ask("Which?", choices, {.beside = beside});
    desktop->dialog.open("ask");
    frames(4);
    answer();
    const auto said = desktop->question.take();
    EXPECT_EQ(desktop->question.asking(), !said);
    desktop->question.withdraw();
    desktop->dialog.close();
    frames(3);
    return said ? said->choice : std::nullopt;
  }
};

TEST_F(Banners, OfAnExportOfferTheFileForAWhile) {
  const char* const id = "banner of the export";
  const fs::path file = dir / "plots/table.csv";
  EXPECT_FALSE(banner(id));
  desktop->exporter.wrote(file);
  const auto offer = banner(id);
  ASSERT_TRUE(offer);
  EXPECT_EQ(offer->text, fmt::format("table.csv is in {}.", file.parent_path().string()));
  EXPECT_FALSE(offer->bad);
  EXPECT_EQ(labels(*offer), (std::vector<std::string>{"Open", "Show in folder", "Close"}));
  frames(3);
  click("Close", id);
  EXPECT_FALSE(banner(id));
  desktop->exporter.wrote(file);
  ImGui::GetCurrentContext()->Time += 28;
  frames(3);
  EXPECT_TRUE(banner(id));
  ImGui::GetCurrentContext()->Time += 4;
  frames(3);
  EXPECT_FALSE(banner(id)) << "after 30 s";
}

TEST_F(Banners, OfBrokenPassivitySayWhatIsMissing) {
  const char* const id = "banner of the break";
  const auto says = [&](const char* what) {
    return until([&] { return banner(id) && banner(id)->text.find(what) != std::string::npos; });
  };
  EXPECT_FALSE(banner(id));
  desktop->tuning.break_passivity();
  frames(3);
  ASSERT_TRUE(banner(id));
  EXPECT_EQ(labels(*banner(id)), std::vector<std::string>{"Repair (C)"});
  EXPECT_TRUE(banner(id)->bad);
  EXPECT_TRUE(says("A stiff hand holds the arm, and energy grows."));
  desktop->live.controls().grab = false;
  EXPECT_TRUE(says("Energy will grow as soon as a hand holds the arm."));
  desktop->cut_force();
  EXPECT_TRUE(says("Energy will grow as soon as the force is on."));
  EXPECT_TRUE(banner("banner of the force"));
  run("coupling.end_break");
  EXPECT_FALSE(banner(id));
}

TEST_F(Banners, OfWorkBesideTheWindowLeadToIt) {
  const char* const id = "banner of the experiments";
  EXPECT_FALSE(banner(id));
  desktop->experiments_under_way = "3 of 12: passivity";
  ASSERT_TRUE(banner(id));
  EXPECT_EQ(banner(id)->text, "Experiments are running: 3 of 12: passivity.");
  ASSERT_EQ(labels(*banner(id)), std::vector<std::string>{"Show (F5)"});
  EXPECT_STREQ(banner(id)->buttons[0].command, "experiments.show");
  desktop->dialog.open("experiments");
  EXPECT_FALSE(banner(id)) << "its dialog says so";
  desktop->dialog.open("sweep");
  EXPECT_TRUE(desktop->banners().empty()) << "they would cover the map";
}

TEST_F(Banners, LeaveAnEndedForceToF) {
  const char* const id = "banner of the force";
  desktop->cut_force();
  ASSERT_TRUE(until([&] { return banner(id).has_value(); }));
  frames(4);
  EXPECT_THAT(banner(id)->text, testing::StartsWith("Force is off: "));
  EXPECT_THAT(banner(id)->text, HasSubstr("Key F switches the force on."));
  EXPECT_EQ(labels(*banner(id)), std::vector<std::string>{"Force on (F)"});
  click("Force on (F)", id);
  EXPECT_TRUE(until([&] { return desktop->live.force_armed(); }));
  desktop->cut_force();
  ASSERT_TRUE(until([&] { return !desktop->live.force_armed(); }));
  desktop->world.toggle_recording();
  ASSERT_TRUE(until([&] { return desktop->live.loop().recording(); }));
  frames(2);
  ASSERT_TRUE(banner(id));
  EXPECT_THAT(banner(id)->text, testing::StartsWith("Recording without force: "));
  EXPECT_TRUE(banner(id)->bad);
  desktop->world.toggle_recording();
  EXPECT_TRUE(until([&] { return !desktop->live.recording(); }));
}

// Esc closes one thing at a time; the force goes last.
TEST_F(Banners, StayWhileEscClosesOneThingAfterTheOther) {
  play();
  Stage& stage = desktop->playback.shown()->stage();
  const double start = stage.history.offset();
  stage.group.select(PlotRange{start + 0.2, start + 0.4, 0});
  desktop->dialog.open("help");
  frames(3);
  click("View", "##MainMenuBar");
  ASSERT_TRUE(popup_open());
  desktop->escape();
  frames(3);
  EXPECT_FALSE(popup_open()) << "the menu";
  EXPECT_EQ(desktop->dialog.name(), "help");
  desktop->escape();
  EXPECT_EQ(desktop->dialog.name(), "");
  EXPECT_TRUE(stage.group.range());
  desktop->escape();
  EXPECT_FALSE(stage.group.range());
  EXPECT_TRUE(desktop->playback.on());
  desktop->escape();
  EXPECT_FALSE(desktop->playback.on());
  desktop->led_panel = LedPanel::left;
  desktop->document.editor().select(0);
  desktop->escape();
  EXPECT_EQ(desktop->led_panel, LedPanel::none);
  EXPECT_TRUE(desktop->document.editor().selected());
  desktop->escape();
  EXPECT_FALSE(desktop->document.editor().selected());
  ASSERT_TRUE(until([&] { return desktop->live.force_armed(); }));
  desktop->escape();
  EXPECT_TRUE(until([&] { return !desktop->live.force_armed(); }));
}

TEST_F(Banners, AreNoAnswersButDigitsAndEnterAre) {
  width = 640;
  height = 480;
  for (const bool beside : {false, true}) {
    SCOPED_TRACE(beside);
    const auto type = [&](const char* text) {
      ImGui::GetIO().AddInputCharactersUTF8(text);
      frames(3);
    };
    EXPECT_EQ(asked(9, beside, [&] { type("1"); }), 0u);
    EXPECT_EQ(asked(9, beside, [&] { type("9"); }), 8u);
    EXPECT_EQ(asked(3, beside, [&] { type("4"); }), std::nullopt) << "there is no such choice";
    EXPECT_EQ(asked(3, beside, [&] { type("0"); }), std::nullopt);
    EXPECT_EQ(asked(3, beside, [&] { press(GLFW_KEY_3); }), 2u);
    EXPECT_EQ(asked(3, beside, [&] { press(GLFW_KEY_KP_2); }), 1u);
    EXPECT_EQ(asked(3, beside, [&] { press(GLFW_KEY_4); }), std::nullopt);
    EXPECT_EQ(asked(3, beside, [&] { press(GLFW_KEY_ENTER); }), std::nullopt)
        << "which of them is not said";
    EXPECT_EQ(asked(1, beside, [&] { press(GLFW_KEY_ENTER); }), 0u);
    EXPECT_EQ(asked(1, beside, [&] { press(GLFW_KEY_KP_ENTER); }), 0u);
    EXPECT_EQ(asked(3, beside, [&] { click("2   choice 2"); }), 1u);
    EXPECT_EQ(asked(1, beside, [&] { click("choice 1  (Enter)"); }), 0u);
    EXPECT_EQ(asked(3, beside,
                    [&] {
                      show_modifiers(true, false, false);
                      press(GLFW_KEY_2);
                      show_modifiers(false, false, false);
                    }),
              std::nullopt)
        << "Ctrl+2 is no answer";
  }
}

}  // namespace
}  // namespace limpid
