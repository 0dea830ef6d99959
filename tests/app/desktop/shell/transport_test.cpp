// The bar below: where it leads time, and what it leaves out in a narrow window.
#include <cmath>

#include "app/desktop/widgets/modal.h"
#include "tests/app/desktop/shell/whole_window.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class TheBarBelow : public WholeWindow {
 protected:
  void play() {
    fs::copy_file(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5", dir / "mine.h5");
    desktop->playback.open(dir / "mine.h5");
    ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
    player().pause();
    player().seek(0);
    frames(3);
  }
  Player& player() const { return desktop->playback.shown()->player(); }
  static std::optional<test::DrawnText> clock() {
    for (const test::DrawnText& each : test::drawn_texts()) {
      const bool both = each.text.find(" / ") != std::string::npos;
      if (each.window == "transport" && both) return each;
    }
    return std::nullopt;
  }
  // Place of the time line between the button before and the clock behind it.
  struct Line {
    float left, right, y;
  };
  static Line line() {
    const ImGuiStyle& style = ImGui::GetStyle();
    const auto before = find("Re-run", "transport"), behind = clock();
    EXPECT_TRUE(before && behind);
    return {before->max.x + style.FramePadding.x + style.ItemSpacing.x,
            behind->min.x - style.ItemSpacing.x, before->middle().y};
  }
  // Place of a moment on it, where the middle of the slider's grab is then.
  float x_of(double time) const {
    const Line at = line();
    const float pad = 2 + 0.5f * ImGui::GetStyle().GrabMinSize;
    const auto part = static_cast<float>(time / player().duration());
    return at.left + pad + part * (at.right - at.left - 2 * pad);
  }
};

TEST_F(TheBarBelow, GoesToTheMomentThatIsClicked) {
  play();
  for (const double part : {0.25, 0.8, 0.5}) {
    const double wanted = part * player().duration();
    click(ImVec2{x_of(wanted), line().y});
    EXPECT_NEAR(player().time(), wanted, 0.01 * player().duration());
  }
  click(ImVec2{line().left + 1, line().y});
  EXPECT_NEAR(player().time(), 0, 0.01);
  click(ImVec2{line().right - 2, line().y});
  EXPECT_NEAR(player().time(), player().duration(), 0.01);
  player().seek(0);
  player().play();
  click(ImVec2{x_of(0.5 * player().duration()), line().y});
  EXPECT_FALSE(player().playing()) << "the hand leads";
}

TEST_F(TheBarBelow, HasMarksAtTheirMoments) {
  play();
  const std::size_t before = desktop->playback.shown()->marks().size();
  const double duration = player().duration();
  player().seek(0.6 * duration);
  desktop->marking.begin();
  desktop->marking.accept("a moment");
  ASSERT_TRUE(until([&] { return desktop->playback.shown()->marks().size() == before + 1; }));
  desktop->escape();
  player().seek(0);
  frames(4);
  const auto& marks = desktop->playback.shown()->marks();
  const auto mine = std::ranges::find(marks, "a moment", &Mark::text);
  ASSERT_NE(mine, marks.end());
  const double at = desktop->playback.shown()->time_of(*mine);
  EXPECT_NEAR(at, 0.6 * duration, 2e-3);
  const auto place =
      noted_place("transport", fmt::format("mark {}", std::distance(marks.begin(), mine)));
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->x, x_of(at), 2);
  EXPECT_NEAR(place->y, line().y, 3);
  point_at({place->x + 2, place->y});
  EXPECT_THAT(
      sentences("##Tooltip"),
      HasSubstr("a moment A click goes to this mark. A right click renames or removes the mark."));
  click(ImVec2{place->x + 3, place->y});
  EXPECT_NEAR(player().time(), at, 1e-9) << "exactly there, beside it as well";
  EXPECT_EQ(desktop->dialog.name(), "");
  for (const bool down : {true, false}) {
    show_mouse_button(1, down);
    frames(1);
  }
  frames(2);
  EXPECT_EQ(desktop->dialog.name(), "mark");
  EXPECT_EQ(desktop->marking.text(), "a moment");
  desktop->escape();
  point_at({place->x + 12, place->y});
  EXPECT_THAT(sentences("##Tooltip"), HasSubstr("Drag to go to any moment"));
}

TEST_F(TheBarBelow, LeavesOutWhatHasNoRoom) {
  play();
  const std::vector<std::string> all{"Play", "|<", "<",      ">",
                                     "Loop", "1x", "Re-run", "Back to live"};
  std::size_t shown_before = all.size() + 1;
  for (const int wide : {1440, 800, 640, 560, 480, 430}) {
    width = wide;
    frames(4);
    EXPECT_TRUE(find("Play", "transport")) << wide;
    EXPECT_TRUE(find("Back to live", "transport")) << wide;
    EXPECT_EQ(find("<", "transport").has_value(), find("|<", "transport").has_value());
    std::size_t shown = clock() ? 1 : 0;
    for (const std::string& label : all) shown += find(label, "transport").has_value();
    if (wide == 1440) {
      EXPECT_EQ(shown, all.size() + 1) << "there is room for all";
    }
    EXPECT_LE(shown, shown_before) << wide;
    shown_before = shown;
    float before = 0;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.window != "transport") continue;
      EXPECT_TRUE(each.whole()) << each.text << " at " << wide;
      EXPECT_LE(each.max.x, static_cast<float>(wide)) << each.text;
      EXPECT_GT(each.min.x, before) << each.text << ": one behind the other";
      before = each.max.x;
    }
  }
  EXPECT_LT(shown_before, all.size()) << "a narrow window has fewer";
}

TEST_F(TheBarBelow, ChoosesSpeedAndStretchOfTheLoop) {
  for (const auto& [shown, wanted, slow] :
       {std::tuple("1x", "0.1x", 10), {"0.1x", "0.01x", 100}, {"0.01x", "1x", 1}}) {
    click(shown, "transport");
    click(wanted, "##Combo");
    EXPECT_EQ(desktop->live.controls().slow, slow);
  }
  click("10 s", "transport");
  for (const char* each : {"1 s", "2 s", "5 s", "20 s", "30 s", "60 s"}) {
    EXPECT_TRUE(find(each, "##Combo")) << each;
  }
  click("30 s", "##Combo");
  EXPECT_EQ(desktop->settings.plot_length, 30);
  EXPECT_NEAR(desktop->live.stage().group.length(), 30, 1e-9);
  EXPECT_TRUE(desktop->live.stage().group.following());
}

TEST_F(TheBarBelow, StepsAndPausesTheLoop) {
  click("Pause", "transport");
  ASSERT_TRUE(until([&] { return desktop->live.paused(); }));
  frames(5);
  const auto time = [&] {
    return desktop->live.loop().layout().in(desktop->live.row(), Column::time)[0];
  };
  const double before = time();
  frames(5);
  EXPECT_EQ(time(), before);
  for (int i = 1; i <= 3; ++i) {
    click(">", "transport");
    EXPECT_TRUE(until([&] { return time() > before + 1e-3 * (i - 0.5); }));
    frames(5);
    EXPECT_NEAR(time(), before + 1e-3 * i, 1e-9) << "one tick";
  }
}

TEST_F(TheBarBelow, WritesTimesInMinutesAndTenths) {
  play();
  const double duration = player().duration();
  player().seek(std::min(1.26, duration));
  frames(3);
  ASSERT_TRUE(clock());
  EXPECT_EQ(clock()->text, fmt::format("00:01.3 / {:02d}:{:04.1f}", static_cast<int>(duration / 60),
                                       std::fmod(duration, 60.0)));
}

}  // namespace
}  // namespace limpid
