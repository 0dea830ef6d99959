// The dialog of an export, the chooser of a plot's channels, and the row of plots: keys and drags.
#include <cmath>

#include "app/desktop/widgets/modal.h"
#include "tests/app/desktop/shell/whole_window.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

class PlotsOfTheWindow : public WholeWindow {
 protected:
  std::optional<ImVec2> place(const std::string& label) {
    for (const NotedPlace& each : noted_places()) {
      if (each.label == label) return each.at;
    }
    return std::nullopt;
  }
  void click_place(const std::string& label) {
    const auto at = place(label);
    ASSERT_TRUE(at) << label;
    click(*at);
  }
  const std::vector<PlotChoice>& choices() const { return desktop->settings.plot_choices; }
};

TEST_F(PlotsOfTheWindow, AreExportedByEnterWithoutAClick) {
  run("export.begin");
  frames(6);
  press(GLFW_KEY_ENTER);
  EXPECT_EQ(desktop->dialog.name(), "");
  ASSERT_TRUE(until([&] { return !desktop->exporter.written().empty(); }));
  const fs::path first = desktop->exporter.written();
  EXPECT_GT(fs::file_size(first), 0u);
  run("export.forget");
  // Enter in the field of the name does the same.
  run("export.begin");
  frames(6);
  const fs::path file = dir / "by hand.png";
  const std::vector<test::DrawnText> all = test::drawn_texts();
  const auto field = std::ranges::find_if(all, [](const test::DrawnText& each) {
    return each.window.starts_with("Export") && each.text.ends_with(".png");
  });
  ASSERT_NE(field, all.end()) << words("Export");
  click(ImVec2{field->min.x + 5, field->middle().y});
  write_over(file.string());
  press(GLFW_KEY_ENTER);
  frames(3);
  EXPECT_EQ(desktop->dialog.name(), "");
  EXPECT_TRUE(until([&] { return desktop->exporter.written() == file; }));
}

TEST_F(PlotsOfTheWindow, HaveTheSizeInPixelsOfTheirExport) {
  run("export.begin");
  frames(4);
  const auto in_line = [&](const char* a, const char* b) {
    const auto left = find(a, "Export"), right = find(b, "Export");
    EXPECT_TRUE(left && right) << words("Export");
    if (!left || !right) return;
    EXPECT_NEAR(left->middle().y, right->middle().y, 3) << a << ", " << b;
    EXPECT_LT(left->max.x, right->min.x) << a << ", " << b;
  };
  in_line("PNG, pixels", "SVG, lines");
  in_line("SVG, lines", "PDF, a page");
  in_line("light, for paper", "dark, for slides");
  in_line("by", "printed");
  in_line("Export (Enter)", "Cancel (Esc)");
  // 160 by 80 mm at 300 dots an inch of 25.4 mm.
  EXPECT_THAT(words("Export"), HasSubstr("1890 x 945 pixels"));
  in_line("dpi", "1890 x 945 pixels");
  click("PDF, a page", "Export");
  EXPECT_THAT(words("Export"), AllOf(Not(HasSubstr("945 pixels")), ContainsRegex("-001.pdf")));
  click("a plot, as a picture", "Export");
  click("all plots, as one figure");
  const std::size_t plots = desktop->live.stage().plots.size();
  if (plots > 1) {
    EXPECT_THAT(words("Export"), HasSubstr(fmt::format("{} plots one above the other: 160 by {} mm",
                                                       plots, 80 * plots)));
  }
  EXPECT_THAT(words("Export"), HasSubstr("plots-001.pdf"));
  click("PNG, pixels", "Export");
  EXPECT_THAT(words("Export"),
              HasSubstr(fmt::format("1890 x {:.0f} pixels",
                                    std::round(80.0 * static_cast<double>(plots) / 25.4 * 300))));
}

TEST_F(PlotsOfTheWindow, ChooseTheirChannelsInTheirOrder) {
  run("plots.add");
  frames(4);
  const std::size_t plot = desktop->plots.chosen();
  ASSERT_LT(plot, choices().size());
  click("None");
  for (const char* key : {"coordination/gap", "contact/total_force_norm"}) click_place(key);
  EXPECT_EQ(choices()[plot].channels,
            (std::vector<std::string>{"coordination/gap", "contact/total_force_norm"}));
  click_place("coordination/gap");
  EXPECT_EQ(choices()[plot].channels, (std::vector<std::string>{"contact/total_force_norm"}));
  EXPECT_TRUE(find("Most used channels", "What the plot shows"));
  const auto gap = place("coordination/gap");
  ASSERT_TRUE(gap);
  away();
  point_at(*gap);
  std::string said;
  for (const test::DrawnText& each : test::drawn_texts()) {
    if (each.window.starts_with("##Tooltip")) said += each.text + ' ';
  }
  EXPECT_THAT(said,
              AllOf(HasSubstr("coordination/gap"), HasSubstr("Can be dragged into any plot.")));
  for (const auto& [label, help] : {std::pair("over time", "The channels against time."),
                                    {"against a channel", "against another channel."},
                                    {"spectrum", "Amplitude against frequency"},
                                    {"None", "Removes all channels from the plot."}}) {
    EXPECT_THAT(hint(label, "What the plot shows"), HasSubstr(help));
  }
}

TEST_F(PlotsOfTheWindow, AreCrossedByTheChannelThatIsChosen) {
  run("plots.add");
  frames(4);
  const std::size_t plot = desktop->plots.chosen();
  click("against a channel", "What the plot shows");
  EXPECT_EQ(choices()[plot].kind, PlotKind::cross);
  EXPECT_EQ(choices()[plot].across, "proxy/contact_torque_norm") << "as long as none is chosen";
  const auto gap = place("coordination/gap");
  ASSERT_TRUE(gap);
  std::optional<ImVec2> along;
  for (const test::DrawnText& each : test::drawn_texts()) {
    if (each.text == "along x" && std::abs(each.middle().y - gap->y) < 5) along = each.middle();
  }
  ASSERT_TRUE(along) << words("What the plot shows");
  EXPECT_GT(along->x, gap->x) << "behind the channel's name";
  click(*along);
  EXPECT_EQ(choices()[plot].across, "coordination/gap");
  click("over time", "What the plot shows");
  EXPECT_EQ(choices()[plot].kind, PlotKind::time);
}

TEST_F(PlotsOfTheWindow, FindTheFirstChannelByEnterAndEndByAnother) {
  run("plots.add");
  frames(4);
  const std::size_t plot = desktop->plots.chosen();
  click("None");
  click("Remove plot");
  EXPECT_EQ(choices().size(), plot);
  run("plots.add");
  frames(4);
  const std::size_t before = choices()[plot].channels.size();
  ImGui::GetIO().AddInputCharactersUTF8("no such channel");
  frames(3);
  EXPECT_THAT(words(), HasSubstr("No channel matches the words of the filter."));
  press(GLFW_KEY_ENTER);
  frames(2);
  EXPECT_EQ(choices()[plot].channels.size(), before);
  EXPECT_NE(desktop->dialog.name(), "") << "the words alone are gone";
  press(GLFW_KEY_ENTER);
  frames(2);
  EXPECT_EQ(desktop->dialog.name(), "");
}

// A channel is dragged from the list into the first of the plots.
TEST_F(PlotsOfTheWindow, TakeAChannelThatIsDroppedIntoThem) {
  ASSERT_GE(choices().size(), 2u);
  const std::string key = "device/tip_speed";
  ASSERT_EQ(std::ranges::count(choices()[0].channels, key), 0);
  run("plots.add");
  frames(4);
  const auto from = place(key);
  ASSERT_TRUE(from);
  const ImGuiWindow* panel = ImGui::FindWindowByName("plots");
  ASSERT_NE(panel, nullptr);
  const ImVec2 to{panel->Pos.x + 40, panel->Pos.y + 0.5f * panel->Size.y};
  show_mouse(*from);
  frames(3);
  show_mouse_button(0, true);
  frames(2);
  show_mouse({from->x + 20, from->y + 20});
  frames(2);
  EXPECT_THAT(words("##Tooltip"), HasSubstr("drop it into another plot"));
  show_mouse(to);
  frames(3);
  show_mouse_button(0, false);
  frames(3);
  EXPECT_EQ(std::ranges::count(choices()[0].channels, key), 1);
  EXPECT_FALSE(ImGui::GetCurrentContext()->DragDropActive);
}

TEST_F(PlotsOfTheWindow, AreOfferedWhereThereIsNone) {
  desktop->settings.plot_choices.clear();
  frames(4);
  ASSERT_TRUE(desktop->live.stage().plots.empty());
  const auto button = find("Add a plot (N)", "plots");
  ASSERT_TRUE(button) << words("plots");
  const ImGuiWindow* panel = ImGui::FindWindowByName("plots");
  ASSERT_NE(panel, nullptr);
  EXPECT_NEAR(button->middle().x, panel->Pos.x + panel->Size.x / 2, 3) << "in the middle";
  EXPECT_GT(button->middle().y, panel->Pos.y + 0.2f * panel->Size.y);
  EXPECT_LT(button->middle().y, panel->Pos.y + 0.8f * panel->Size.y);
  run("export.begin");
  frames(4);
  EXPECT_THAT(sentences("Export"), HasSubstr("There is no plot."));
  press(GLFW_KEY_ENTER);
  EXPECT_EQ(desktop->dialog.name(), "export") << "there is nothing to export";
  desktop->escape();
  frames(3);
  click("Add a plot (N)", "plots");
  frames(3);
  EXPECT_EQ(choices().size(), 1u);
}

}  // namespace
}  // namespace limpid
