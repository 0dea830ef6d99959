// Figures of a stretch of time that is selected in a plot.
#include <fmt/format.h>

#include <fstream>

#include "app/plot/range_figures.h"
#include "tests/app/desktop/shell/whole_window.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

class AStretchOfTime : public WholeWindow {
 protected:
  void SetUp() override {
    WholeWindow::SetUp();
    if (!desktop) return;
    desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
    ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
    player().pause();
    frames(3);
    stage().group.select(PlotRange{start() + 1, start() + 1.5, 0});
    frames(4);
  }
  Player& player() { return desktop->playback.shown()->player(); }
  Stage& stage() { return desktop->playback.shown()->stage(); }
  double start() { return stage().history.offset(); }
};

TEST_F(AStretchOfTime, HasMeanRmsLeastAndMostOfEachCurve) {
  const PlotSpec& spec = stage().plots[0].spec();
  const auto title = find(spec.title + ": 1.000 s to 1.500 s, 0.500 s long", "range");
  ASSERT_TRUE(title) << words("range");
  std::size_t shown = 0;
  for (const Curve& curve : spec.curves) {
    if (!curve.visible) continue;
    ++shown;
    const RangeFigures f =
        figures_between(stage().history, curve.channel, start() + 1, start() + 1.5);
    const auto name = find(curve.label, "range");
    ASSERT_TRUE(name) << curve.label;
    for (const auto& [head, value] :
         {std::pair("mean", f.mean), {"rms", f.rms}, {"min", f.low}, {"max", f.high}}) {
      const auto above = find(head, "range");
      ASSERT_TRUE(above) << head;
      const std::string text = fmt::format("{:.4g}", value * spec.y.factor);
      bool there = false;
      for (const test::DrawnText& each : test::drawn_texts()) {
        there = there || (each.window.starts_with("range") && each.text == text &&
                          std::abs(each.middle().y - name->middle().y) < 3 &&
                          std::abs(each.max.x - above->max.x) < 3);
      }
      EXPECT_TRUE(there) << curve.label << ", " << head << ": " << text << " is not in\n"
                         << words("range");
    }
  }
  EXPECT_GT(shown, 0u);
}

TEST_F(AStretchOfTime, IsPlayedFromItsBeginning) {
  click("Play this", "range");
  EXPECT_TRUE(player().playing());
  EXPECT_GE(player().time(), 1);
  EXPECT_TRUE(until([&] { return !player().playing(); }));
  EXPECT_NEAR(player().time(), 1.5, 0.03);
}

TEST_F(AStretchOfTime, GoesIntoATable) {
  click("Export range as CSV", "range");
  std::string said;
  ASSERT_TRUE(until([&] {
    for (const Notice& notice : desktop->notices.all()) said = notice.text;
    return said.find(".csv") != std::string::npos;
  }));
  std::size_t rows = 0;
  for (const auto& each : fs::recursive_directory_iterator(dir / "data")) {
    if (each.path().extension() != ".csv") continue;
    std::ifstream in(each.path());
    for (std::string line; std::getline(in, line);) {
      rows += !line.empty() && (std::isdigit(line[0]) != 0);
    }
  }
  EXPECT_NEAR(static_cast<double>(rows), 501, 1) << said;
}

TEST_F(AStretchOfTime, IsLeftByItsButton) {
  click("Clear (Esc)", "range");
  EXPECT_FALSE(stage().group.range());
  frames(3);
  EXPECT_EQ(words("range"), "");
}

}  // namespace
}  // namespace limpid
