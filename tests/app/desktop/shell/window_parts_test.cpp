// Parts of the window and their menus: where they stand at each scale, and what a click does.
#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <initializer_list>

#include "app/desktop/base/first_steps.h"
#include "app/desktop/scene/object_signs.h"
#include "app/desktop/shell/command_keys.h"
#include "tests/app/desktop/shell/whole_window.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class Parts : public WholeWindow {
 protected:
  static std::string in_menus() {
    std::string all = "\n";
    for (const test::DrawnText& each : test::drawn_texts()) {
      const bool menu = each.window.starts_with("##Menu") || each.window.starts_with("##Popup");
      if (menu) all += each.text + '\n';
    }
    return all;
  }
  // Opens a menu of the bar, and those inside of it.
  void open_menu(const char* menu, std::initializer_list<std::string> inner) {
    if (popup_open()) desktop->escape();
    away();
    click(menu, "##MainMenuBar");
    for (const std::string& each : inner) {
      const auto at = find(each, "##Menu");
      ASSERT_TRUE(at) << each << " is not in:" << in_menus();
      point_at(at->middle());
      frames(25);
    }
  }
  void drag(ImVec2 from, ImVec2 by) {
    point_at(from);
    show_mouse_button(0, true);
    frames(2);
    point_at({from.x + by.x, from.y + by.y});
    show_mouse_button(0, false);
    frames(2);
    away();
  }
  void right_click(ImVec2 at) {
    point_at(at);
    for (const bool down : {true, false}) {
      show_mouse_button(1, down);
      frames(1);
    }
    frames(4);
  }
  // Place of a point of the scene in the window.
  ImVec2 seen(const Vec3& point) const {
    const auto pixel = *desktop->shown.camera.project(point);
    const ImVec2 from = desktop->shown.picture.min;
    return {from.x + static_cast<float>(pixel.x()), from.y + static_cast<float>(pixel.y())};
  }
  static ScreenRect rect_of(const char* window) {
    const ImGuiWindow* found = ImGui::FindWindowByName(window);
    EXPECT_NE(found, nullptr) << window;
    return found != nullptr ? ScreenRect{found->Pos, found->Rect().Max} : ScreenRect{};
  }
  static fs::path shipped(const char* file) { return fs::path(LIMPID_ASSETS_DIR) / file; }
};

TEST_F(Parts, HaveTabsAndBordersInProportionToTheText) {
  width = 2200;
  height = 1300;
  for (const float scale : {1.f, 1.5f}) {
    SCOPED_TRACE(scale);
    ImGuiGl::change(Theme::dark, scale);
    frames(5);
    const ScreenRect view = desktop->shown.picture;
    const ImVec2 middle{(view.min.x + view.max.x) / 2, (view.min.y + view.max.y) / 2};
    const ScreenRect left = rect_of("left tab"), right = rect_of("right tab");
    const ScreenRect plots = rect_of("plots tab");
    for (const ScreenRect& tab : {left, right}) {
      EXPECT_NEAR(tab.width(), 12 * scale, 1);
      EXPECT_NEAR(tab.height(), 44 * scale, 1);
      EXPECT_NEAR((tab.min.y + tab.max.y) / 2, middle.y, 1.5);
    }
    EXPECT_NEAR(left.min.x, view.min.x + 3 * scale, 1);
    EXPECT_NEAR(right.max.x, view.max.x - 3 * scale, 1);
    EXPECT_NEAR(plots.width(), 44 * scale, 1);
    EXPECT_NEAR(plots.height(), 12 * scale, 1);
    EXPECT_NEAR(plots.max.y, view.max.y - 3 * scale, 1);
    EXPECT_NEAR((plots.min.x + plots.max.x) / 2, middle.x, 1.5);
    Settings& settings = desktop->settings;
    EXPECT_NEAR(view.min.x, scale * settings.left, 1);
    EXPECT_NEAR(static_cast<float>(width) - view.max.x, scale * settings.right, 1);
    const double wide_left = settings.left, wide_right = settings.right, high = settings.plots;
    for (const char* grip : {"left grip", "right grip"}) {
      EXPECT_NEAR(rect_of(grip).width(), 6 * scale, 1) << grip;
      EXPECT_NEAR(rect_of(grip).height(), view.height(), 1) << grip;
    }
    EXPECT_NEAR(rect_of("plot grip").height(), 6 * scale, 1);
    EXPECT_NEAR(rect_of("plot grip").width(), width, 1);
    const float third = view.min.y + view.height() / 3;
    drag({view.min.x, third}, {30, 0});
    EXPECT_NEAR(settings.left, wide_left + 30 / scale, 0.1);
    drag({view.max.x, third}, {-15, 0});
    EXPECT_NEAR(settings.right, wide_right + 15 / scale, 0.1);
    drag({middle.x + 200, view.max.y}, {0, -12});
    EXPECT_NEAR(settings.plots, high + 12 / scale, 0.1);
    EXPECT_NEAR(desktop->shown.picture.min.x, scale * settings.left, 1);
  }
}

TEST_F(Parts, OfHelpHaveAColumnOfKeysAndAWiderOneOfWords) {
  height = 3000;
  run("help.keys");
  frames(4);
  const ScreenRect all = rect_of("Keys and mouse");
  const auto key = find("Space", "Keys and mouse"), other = find("F12", "Keys and mouse");
  const auto picture = find("save a picture of the window", "Keys and mouse");
  ASSERT_TRUE(key && other && picture) << words("Keys and mouse");
  EXPECT_NEAR(key->min.x, other->min.x, 2);
  const float keys = picture->min.x - other->min.x, rest = all.max.x - picture->min.x;
  EXPECT_GT(rest, 2 * keys) << "sentences need more room than keys";
  EXPECT_GT(keys, 10 * ImGui::GetFontSize()) << "keys have room for two";
  EXPECT_NEAR(picture->middle().y, other->middle().y, 3);
}

TEST_F(Parts, HideTheirHintsBehindAQuestion) {
  const char* const hint = "Turn the wheel while you drag: nearer and farther.";
  const auto told = [&] { return sentences().find(hint) != std::string::npos; };
  note_done(desktop->settings, FirstStep::pull);
  frames(3);
  EXPECT_TRUE(told());
  desktop->question.ask("Which?", {"left", "right"}, {.beside = true});
  desktop->dialog.open("ask");
  frames(4);
  EXPECT_FALSE(told());
  desktop->question.withdraw();
  desktop->dialog.close();
  frames(4);
  EXPECT_TRUE(told());
  desktop->dialog.open("help");
  frames(4);
  EXPECT_TRUE(told()) << "no question";
}

TEST_F(Parts, HaveAMenuForEachPlot) {
  const auto title = [&](std::size_t i) { return desktop->live.stage().plots[i].spec().title; };
  const std::size_t count = desktop->live.stage().plots.size();
  ASSERT_GT(count, 2u);
  desktop->settings.show_plots = false;
  open_menu("View", {"Plots of"});
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_THAT(in_menus(), HasSubstr("\n" + title(i) + "\n"));
  }
  open_menu("View", {"Plots of", title(1)});
  for (const char* item : {"Channels and name...", "Add a plot...", "Remove this plot", "Export...",
                           "Copy as CSV", "Save as CSV", "Save as PNG", "Save as SVG", "Fit"}) {
    EXPECT_THAT(in_menus(), HasSubstr(std::string("\n") + item + "\n"));
  }
  click("Channels and name...", "##Menu");
  frames(3);
  EXPECT_TRUE(desktop->settings.show_plots) << "it comes to light";
  EXPECT_EQ(desktop->dialog.name(), "plot");
  EXPECT_EQ(desktop->plots.chosen(), 1u);
  desktop->dialog.close();
  frames(3);
  open_menu("View", {"Plots of", title(2)});
  click("Export...", "##Menu");
  frames(3);
  EXPECT_EQ(desktop->dialog.name(), "export");
  EXPECT_EQ(desktop->exporter.plot(), 2u);
  desktop->dialog.close();
  frames(3);
  const std::string removed = title(0);
  open_menu("View", {"Plots of", removed});
  click("Remove this plot", "##Menu");
  frames(3);
  EXPECT_EQ(desktop->live.stage().plots.size(), count - 1);
  EXPECT_NE(title(0), removed);
}

TEST_F(Parts, HavePresetsLayoutsAndScenesInTheirMenus) {
  open_menu("Edit", {"Presets of settings"});
  for (const NamedTexts::Entry& entry : desktop->tuning.presets.all()) {
    EXPECT_THAT(in_menus(), HasSubstr("\n" + entry.name + "\n"));
  }
  click("Light hand", "##Menu");
  EXPECT_EQ(desktop->settings.parameters().eta, 0.3);
  open_menu("View", {"Layouts"});
  for (const NamedTexts::Entry& entry : desktop->plots.layouts.all()) {
    EXPECT_THAT(in_menus(), HasSubstr("\n" + entry.name + "\n"));
  }
  click("Frequencies", "##Menu");
  EXPECT_EQ(desktop->settings.plot_choices.at(0).kind, PlotKind::spectrum);
  open_menu("Device", {});
  EXPECT_THAT(in_menus(), HasSubstr("\nomni, virtual, 3 joints\n"));
  open_menu("Scene", {});
  EXPECT_THAT(hint("Soft and hard", "##Menu"), HasSubstr("Five balls from felt to brass"));
  open_menu("Scene", {});
  click("Soft and hard", "##Menu");
  EXPECT_TRUE(
      until([&] { return fs::path(desktop->document.file()).filename() == "spheres.toml"; }));
}

TEST_F(Parts, ListRecentFilesAndWhichOfThemAreGone) {
  const fs::path gone = dir / "gone/lost.toml";
  desktop->settings.recent = {gone.string(), shipped("sessions/table.h5").string()};
  frames(2);
  open_menu("File", {"Open recent"});
  const std::string shown = in_menus();
  EXPECT_LT(shown.find("lost.toml"), shown.find("table.h5")) << "in their order";
  EXPECT_THAT(shown, HasSubstr("no longer there: "));
  click("lost.toml", "##Menu");
  EXPECT_FALSE(desktop->document.loader().busy() || desktop->playback.loading());
  open_menu("File", {"Open recent"});
  click("table.h5", "##Menu");
  EXPECT_TRUE(until([&] { return desktop->playback.on(); }));
  EXPECT_EQ(desktop->playback.shown()->file(), shipped("sessions/table.h5"));
}

TEST_F(Parts, OfAnObjectsMenuAreThoseOfWhatIsUnderTheMouse) {
  desktop->world.open_scene(shipped("scenes/free.toml"));
  ASSERT_TRUE(until([&] { return fs::path(desktop->document.file()).filename() == "free.toml"; }));
  ASSERT_TRUE(until([&] { return desktop->banners().empty(); })) << "the force is on";
  desktop->world.add_object({"mine", pose_at({0.2, 0.05, 0.05}), Sphere{0.015}, {500}});
  frames(5);
  const std::size_t place = desktop->document.scene().objects.size() - 1;
  const Vec3 middle = desktop->document.selected_bounds().center();
  desktop->document.editor().select(std::nullopt);
  desktop->settings.show_right = false;
  frames(5);
  right_click(seen(middle));
  EXPECT_EQ(desktop->document.editor().selected(), place);
  for (const char* item : {"mine", "Move", "Turn", "Scale", "Copy selected object",
                           "Remove selected object", "Look at the selected object"}) {
    EXPECT_THAT(in_menus(), HasSubstr(std::string("\n") + item + "\n"));
  }
  EXPECT_THAT(in_menus(), Not(HasSubstr("Add ball")));
  click("Material, size, joint...", "##Popup");
  EXPECT_TRUE(desktop->settings.show_right);
  frames(4);
  right_click(seen(middle));
  click("Remove selected object", "##Popup");
  EXPECT_EQ(desktop->document.scene().objects.size(), place);
  const ScreenRect view = desktop->shown.picture;
  right_click({view.max.x - 60, view.min.y + 60});  // the sky
  for (const NewObject& each : new_objects()) {
    std::string label = each.label;
    label[0] = static_cast<char>(std::tolower(label[0]));
    EXPECT_THAT(in_menus(), HasSubstr("\nAdd " + label + "\n"));
  }
  EXPECT_THAT(in_menus(), HasSubstr("\nAdd model...\n"));
  click("Add block", "##Popup");
  ASSERT_EQ(desktop->document.scene().objects.size(), place + 1);
  EXPECT_EQ(desktop->document.scene().objects.back().name, "block");
}

TEST_F(Parts, OfTheStatusLineTellWhatGoesOn) {
  const auto line = [] { return words("##MainMenuBar"); };
  EXPECT_THAT(line(), Not(HasSubstr("led by a program")));
  desktop->lead.begin();
  desktop->live.controls().slow = 10;
  frames(3);
  EXPECT_THAT(line(), HasSubstr("led by a program"));
  EXPECT_THAT(line(), HasSubstr("1/10 speed"));
  EXPECT_THAT(hint("led by a program", "##MainMenuBar"), HasSubstr("Your own settings come back"));
  EXPECT_THAT(hint("1/10 speed", "##MainMenuBar"), HasSubstr("Pauses or slows only"));
  EXPECT_TRUE(desktop->lead.end(false));
  desktop->live.controls().slow = 1;
  desktop->playback.open(shipped("sessions/table.h5"));
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  desktop->playback.shown()->player().pause();
  frames(3);
  EXPECT_THAT(line(), HasSubstr("space plays [Esc: live]"));
  EXPECT_THAT(line(), Not(HasSubstr("force o")));
  EXPECT_THAT(line(), Not(HasSubstr("recording [R]")));
  EXPECT_EQ(hint("playing table.h5", "##MainMenuBar"), "table.h5");
  const auto row = desktop->shown.row();
  const RowLayout& layout = desktop->shown.stage().channels().layout();
  const auto kind = static_cast<CouplingKind>(layout.in(row, Column::kind)[0]);
  std::string law = info(kind).label;
  for (char& c : law) c = static_cast<char>(std::toupper(c));
  EXPECT_THAT(line(), HasSubstr(law)) << "the recorded one";
  if (info(kind).takes_eta) {
    EXPECT_THAT(line(), HasSubstr(fmt::format("{:.2f}", layout.in(row, Column::eta)[0])));
  }
}

TEST_F(Parts, AreLedByKeysUntilAClick) {
  run("window.panels");
  EXPECT_EQ(desktop->led_panel, LedPanel::left);
  EXPECT_EQ(owner_of(desktop->focus()), KeyOwner::panel);
  desktop->settings.show_left = false;
  frames(3);
  EXPECT_EQ(desktop->led_panel, LedPanel::right) << "there is none at the left";
  desktop->settings.show_right = false;
  frames(3);
  EXPECT_EQ(desktop->led_panel, LedPanel::none);
  desktop->settings.show_left = desktop->settings.show_right = true;
  frames(3);
  for (const bool dialog : {false, true}) {
    run("window.panels");
    EXPECT_EQ(desktop->led_panel, LedPanel::left);
    if (dialog) {
      desktop->dialog.open("help");
      frames(3);
    } else {
      const ScreenRect view = desktop->shown.picture;
      click(ImVec2{view.max.x - 60, view.min.y + 60});
    }
    EXPECT_EQ(desktop->led_panel, LedPanel::none) << dialog;
  }
}

}  // namespace
}  // namespace limpid
