// The bar below on a screen of twice the pixels: it has what it has on an ordinary one.
#include "tests/app/desktop/shell/whole_window.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

class ScaledBar : public WholeWindow {
 protected:
  void SetUp() override {
    WholeWindow::SetUp();
    if (!desktop) return;
    fs::copy_file(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5", dir / "mine.h5");
    desktop->playback.open(dir / "mine.h5");
    ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
    desktop->playback.shown()->player().pause();
    desktop->playback.shown()->player().seek(0);
    frames(3);
  }
  void scale(float wanted) {
    ImGuiGl::change(Theme::dark, wanted);
    frames(2);
  }
  // Returns which controls are shown in a window of this width.
  std::vector<std::string> shown(int wide) {
    width = wide;
    frames(3);
    std::vector<std::string> all;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.window != "transport") continue;
      EXPECT_TRUE(each.whole()) << each.text << " is cut off at " << wide;
      const bool clock = each.text.find(" / ") != std::string::npos;
      all.push_back(clock ? "clock" : each.text);
    }
    return all;
  }
};

// Words of a larger font are not exactly twice as wide: the next narrower or wider window decides.
TEST_F(ScaledBar, LeavesOutTheSameControlsInTheSameOrder) {
  constexpr int kNarrowest = 420, kStep = 28, kCount = 14;
  std::vector<std::vector<std::string>> ordinary, twice;
  for (int i = 0; i < kCount; ++i) ordinary.push_back(shown(kNarrowest + kStep * i));
  height *= 2;
  scale(2);
  for (int i = 0; i < kCount; ++i) twice.push_back(shown(2 * (kNarrowest + kStep * i)));
  EXPECT_LT(ordinary.front().size(), ordinary.back().size());
  for (std::size_t i = 1; i + 1 < kCount; ++i) {
    const bool same =
        twice[i] == ordinary[i - 1] || twice[i] == ordinary[i] || twice[i] == ordinary[i + 1];
    EXPECT_TRUE(same) << kNarrowest + kStep * static_cast<int>(i) << ": "
                      << testing::PrintToString(twice[i]) << " and "
                      << testing::PrintToString(ordinary[i]);
  }
}

// Every text of the window is at about twice its place, and what is folded is folded on both.
TEST_F(ScaledBar, HasAllItsWordsAtTwiceTheirPlaces) {
  const auto places = [&] {
    away();
    std::vector<test::DrawnText> all;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.window == "transport") all.push_back(each);
    }
    return all;
  };
  const std::vector<test::DrawnText> ordinary = places();
  width *= 2;
  height *= 2;
  scale(2);
  const std::vector<test::DrawnText> twice = places();
  ASSERT_EQ(twice.size(), ordinary.size());
  for (std::size_t i = 0; i < twice.size(); ++i) {
    EXPECT_EQ(twice[i].text, ordinary[i].text);
    EXPECT_NEAR(twice[i].min.x, 2 * ordinary[i].min.x, 40) << twice[i].text;
    EXPECT_NEAR(twice[i].middle().y, 2 * ordinary[i].middle().y, 8) << twice[i].text;
  }
}

}  // namespace
}  // namespace limpid
