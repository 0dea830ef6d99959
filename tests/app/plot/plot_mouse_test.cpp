// A plot under the mouse: each gesture moves, scales, selects or points as it is described.
#include <algorithm>
#include <cmath>
#include <fstream>

#include "app/plot/plot.h"
#include "tests/app/plot/imgui_frames.h"
#include "tests/support/drawn_text.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

constexpr double kStep = 1.18;  // of the wheel

// A plot of a long history, of which the last ten seconds are shown, and the mouse.
class AMouse : public ImGuiFrames {
 protected:
  AMouse() {
    spec_.title = "force";
    spec_.file_name = "force";
    spec_.y = {.unit = "N", .zero_line = false};
    spec_.curves = {{.label = "first"}, {.channel = 1, .label = "second"}};
    for (int k = 0; k <= 20000; ++k) {
      const double t = 1e-3 * k;
      history_.append(t, std::array{3 + std::sin(t), 1 + 0.1 * t});
    }
  }
  void start() {
    plot_.emplace(spec_);
    frames(3);
  }
  // Draws frames, and keeps what they said.
  void frames(int count = 1) {
    for (int i = 0; i < count; ++i) {
      frame([&] {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({700, 400});
        ImGui::Begin("plots", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
        group_.begin_frame(history_, playback_);
        const PlotEvents said = plot_->draw(history_, group_, {660, 360}, saving_);
        ImGui::End();
        if (said.playback) events_.playback = said.playback;
        if (said.range) events_.range = said.range;
        if (said.notice) events_.notice = said.notice;
        if (said.wish != PlotWish::none) events_.wish = said.wish;
        events_.unselect = events_.unselect || said.unselect;
      });
    }
  }
  void point(ImVec2 at) {
    show_mouse(at);
    frames(2);
  }
  void button(bool down, int which = ImGuiMouseButton_Left) {
    show_mouse_button(which, down);
    frames(2);
  }
  void click(ImVec2 at, int which = ImGuiMouseButton_Left) {
    point(at);
    button(true, which);
    button(false, which);
  }
  void drag(ImVec2 from, ImVec2 to) {
    point(from);
    button(true);
    point(to);
    button(false);
  }
  void wheel(ImVec2 at, float turns, bool with_control = false) {
    point(at);
    show_modifiers(with_control, false, false);
    ImGui::GetIO().MouseWheel = turns;
    frames(1);
    show_modifiers(false, false, false);
    ImGui::GetIO().MouseWheel = 0;
    frames(1);
  }
  void hold_shift(bool down) {
    show_modifiers(false, down, false);
    frames(1);
  }

  const ScreenRect& area() const { return plot_->area(); }
  // A place by its parts of the area, from the lower left.
  ImVec2 at(float across, float up) const {
    return {area().min.x + across * area().width(), area().max.y - up * area().height()};
  }
  double time_at(float x) const {
    return group_.start() + (x - area().min.x) / area().width() * group_.length();
  }
  Limits y() const { return plot_->picture(group_).y.limits; }
  Limits x() const { return plot_->picture(group_).x.limits; }
  double value_at(ImVec2 place) const {
    return y().low + (area().max.y - place.y) / area().height() * y().span();
  }
  static void expect_same(const Limits& a, const Limits& b) {
    EXPECT_NEAR(a.low, b.low, 1e-6 * std::max(1.0, std::abs(b.low)));
    EXPECT_NEAR(a.high, b.high, 1e-6 * std::max(1.0, std::abs(b.high)));
  }

  PlotSpec spec_;
  History history_{{.channels = 2}};
  std::optional<Plot> plot_;
  std::optional<double> playback_;
  PlotGroup group_;
  PlotEvents events_;
  PlotSaving saving_;
};

TEST_F(AMouse, DragsTheTimeAlong) {
  start();
  ASSERT_NEAR(group_.start(), 10, 1e-6);
  const double moved = 100 / static_cast<double>(area().width()) * 10;
  const Limits values = y();
  drag(at(0.3f, 0.5f), {at(0.3f, 0.5f).x + 100, at(0.3f, 0.5f).y - 60});
  EXPECT_NEAR(group_.start(), 10 - moved, 0.02);
  EXPECT_NEAR(group_.length(), 10, 1e-9);
  EXPECT_FALSE(group_.following());
  expect_same(y(), values);
  EXPECT_FALSE(events_.range);
  EXPECT_FALSE(events_.playback);
  drag(at(0.9f, 0.5f), {at(0.9f, 0.5f).x - 300, at(0.9f, 0.5f).y});
  EXPECT_TRUE(group_.following()) << "the newest data is in view again";
}

TEST_F(AMouse, LeavesAShortTrembleForAClick) {
  start();
  const ImVec2 from = at(0.3f, 0.5f);
  drag(from, {from.x + 1, from.y});
  EXPECT_TRUE(group_.following());
  EXPECT_NEAR(group_.start(), 10, 1e-6);
}

TEST_F(AMouse, ScalesTimeByTheWheelAboutItsPlace) {
  start();
  group_.pan(-4);
  frames(2);
  const ImVec2 place = at(0.25f, 0.5f);
  const double there = time_at(place.x);
  const Limits values = y();
  wheel(place, 1);
  EXPECT_NEAR(group_.length(), 10 / kStep, 1e-6) << "a turn away shows less";
  EXPECT_NEAR(time_at(place.x), there, 0.03);
  wheel(place, -2);
  EXPECT_NEAR(group_.length(), 10 * kStep, 1e-6);
  EXPECT_NEAR(time_at(place.x), there, 0.03);
  EXPECT_NEAR(y().span(), values.span(), 0.7) << "it follows the data";
}

TEST_F(AMouse, ScalesValuesByTheWheelOverTheirAxisOrWithCtrl) {
  start();
  for (const bool over_axis : {true, false}) {
    plot_->fit_values();
    frames(2);
    const Limits before = y();
    const ImVec2 inside = at(0.5f, 0.25f);
    const ImVec2 place = over_axis ? ImVec2{area().min.x - 10, inside.y} : inside;
    const double there = value_at(place);
    wheel(place, 1, !over_axis);
    EXPECT_NEAR(y().span(), before.span() / kStep, 1e-6);
    EXPECT_NEAR(value_at(place), there, 1e-3) << "the value under the mouse stays";
    EXPECT_NEAR(group_.length(), 10, 1e-9) << "time stays";
  }
}

TEST_F(AMouse, DragsValuesAlongOnceTheyDoNotFollow) {
  start();
  wheel(at(0.5f, 0.5f), 1, true);
  const Limits before = y();
  const ImVec2 from = at(0.5f, 0.5f);
  drag(from, {from.x, from.y + 50});
  const double by = 50 / static_cast<double>(area().height()) * before.span();
  expect_same(y(), {before.low + by, before.high + by});
  EXPECT_TRUE(group_.following()) << "no time was dragged";
}

TEST_F(AMouse, DragsTheValueAxisItself) {
  start();
  const Limits before = y();
  const ImVec2 from{area().min.x - 15, at(0, 0.5f).y};
  drag(from, {from.x + 30, from.y - 40});
  const double by = -40 / static_cast<double>(area().height()) * before.span();
  expect_same(y(), {before.low + by, before.high + by});
  EXPECT_NEAR(group_.start(), 10, 1e-6) << "and no time";
  frames(20);
  expect_same(y(), {before.low + by, before.high + by});
}

TEST_F(AMouse, SelectsAStretchWithShift) {
  start();
  hold_shift(true);
  drag(at(0.2f, 0.5f), at(0.6f, 0.4f));
  ASSERT_TRUE(events_.range);
  EXPECT_NEAR(events_.range->start, 12, 0.05);
  EXPECT_NEAR(events_.range->stop, 16, 0.05);
  EXPECT_FALSE(events_.unselect);
  events_.range.reset();
  drag(at(0.7f, 0.5f), {area().min.x - 40, at(0, 0.5f).y});
  ASSERT_TRUE(events_.range) << "also from right to left";
  EXPECT_NEAR(events_.range->start, 10, 0.05) << "and no farther than the plot";
  EXPECT_NEAR(events_.range->stop, 17, 0.05);
  events_.range.reset();
  drag(at(0.5f, 0.5f), {area().max.x + 30, at(0, 0.5f).y});
  ASSERT_TRUE(events_.range);
  EXPECT_NEAR(events_.range->stop, 20, 0.05);
  EXPECT_NEAR(group_.start(), 10, 1e-6) << "nothing moved";
  events_.range.reset();
  click(at(0.4f, 0.5f));
  EXPECT_TRUE(events_.unselect);
  EXPECT_FALSE(events_.range);
  hold_shift(false);
}

TEST_F(AMouse, FitsByADoubleClick) {
  start();
  group_.pan(-5);
  group_.zoom(0.5, 12);
  frames(1);
  wheel(at(0.5f, 0.5f), 3, true);
  const Limits close = y();
  point(at(0.5f, 0.5f));
  for (int i = 0; i < 2; ++i) {
    show_mouse_button(0, true);
    frames(1);
    show_mouse_button(0, false);
    frames(1);
  }
  frames(2);
  EXPECT_TRUE(group_.following());
  EXPECT_NEAR(group_.length(), 10, 1e-9);
  EXPECT_NEAR(group_.stop(), 20, 1e-6);
  EXPECT_GT(y().span(), close.span());
  EXPECT_LE(y().low, 2.1);
  EXPECT_GE(y().high, 3.9);
}

TEST_F(AMouse, HidesAndShowsACurveByItsName) {
  start();
  const auto texts = test::drawn_texts();
  const auto name = std::ranges::find(texts, "second", &test::DrawnText::text);
  ASSERT_NE(name, texts.end());
  click(name->middle());
  EXPECT_TRUE(plot_->spec().curves[0].visible);
  EXPECT_FALSE(plot_->spec().curves[1].visible);
  EXPECT_TRUE(group_.following());
  click(name->middle());
  EXPECT_TRUE(plot_->spec().curves[1].visible);
}

TEST_F(AMouse, PointsAtTheTimeBelowIt) {
  start();
  for (const float part : {0.1f, 0.5f, 0.93f}) {
    point(at(part, 0.5f));
    ASSERT_TRUE(group_.hovered()) << part;
    EXPECT_NEAR(*group_.hovered(), 10 + 10 * part, 0.03);
  }
  for (const ImVec2 outside :
       {ImVec2{area().min.x - 5, at(0, 0.5f).y}, ImVec2{at(0.5f, 0).x, area().max.y + 5},
        ImVec2{at(0.5f, 0).x, area().min.y - 5}}) {
    point(outside);
    EXPECT_FALSE(group_.hovered());
  }
}

TEST_F(AMouse, TakesPlaybackAlongAndJumpsThereByAClick) {
  playback_ = 16;
  start();
  const auto x_of = [&](double t) {
    return area().min.x +
           static_cast<float>((t - group_.start()) / group_.length()) * area().width();
  };
  drag({x_of(16) + 3, at(0, 0.5f).y}, {x_of(16) + 90, at(0, 0.4f).y});
  ASSERT_TRUE(events_.playback);
  EXPECT_NEAR(*events_.playback, time_at(x_of(16) + 90), 0.03);
  events_.playback.reset();
  // Farther from its line than 5 px a drag moves time, and a click jumps.
  const double begin = group_.start();
  drag({x_of(16) + 9, at(0, 0.5f).y}, {x_of(16) + 69, at(0, 0.5f).y});
  EXPECT_FALSE(events_.playback);
  EXPECT_LT(group_.start(), begin);
  EXPECT_FALSE(group_.following());
  click(at(0.25f, 0.5f));
  ASSERT_TRUE(events_.playback);
  EXPECT_NEAR(*events_.playback, time_at(at(0.25f, 0).x), 0.03);
}

TEST_F(AMouse, JumpsToANote) {
  playback_ = 16;
  history_.mark(13, "here", kNoteMark);
  start();
  const float x =
      area().min.x + static_cast<float>((13 - group_.start()) / group_.length()) * area().width();
  click({x + 3, at(0, 0.5f).y});
  ASSERT_TRUE(events_.playback);
  EXPECT_NEAR(*events_.playback, 13, 1e-9) << "exactly there";
  events_.playback.reset();
  click({x + 30, at(0, 0.5f).y});
  ASSERT_TRUE(events_.playback);
  EXPECT_GT(*events_.playback, 13.2);
}

TEST_F(AMouse, OpensAMenuByItsRightButton) {
  saving_.arranged = true;
  start();
  click(at(0.5f, 0.5f), ImGuiMouseButton_Right);
  const auto shown = [&](const char* what) {
    const auto texts = test::drawn_texts();
    return std::ranges::find(texts, what, &test::DrawnText::text) != texts.end();
  };
  for (const char* item : {"Channels and name...", "Add a plot...", "Remove this plot", "Export...",
                           "Copy as CSV", "Save as CSV", "Save as SVG", "Fit"}) {
    EXPECT_TRUE(shown(item)) << item;
  }
  EXPECT_FALSE(shown("Save as PNG")) << "nobody saves one here";
  const auto texts = test::drawn_texts();
  click(std::ranges::find(texts, "Add a plot...", &test::DrawnText::text)->middle());
  EXPECT_EQ(events_.wish, PlotWish::add);
  EXPECT_FALSE(shown("Copy as CSV")) << "it is closed";
}

TEST_F(AMouse, HasEachWishOfTheMenu) {
  const test::TempDir dir;
  saving_.folder = dir / "out";
  saving_.arranged = true;
  start();
  for (const PlotWish wish :
       {PlotWish::choose, PlotWish::add, PlotWish::remove, PlotWish::export_as}) {
    plot_->ask(wish);
    frames(1);
    EXPECT_EQ(events_.wish, wish);
    events_ = {};
  }
  group_.pan(-5);
  group_.zoom(0.5, 12);
  plot_->ask(PlotWish::fit);
  frames(2);
  EXPECT_TRUE(group_.following());
  EXPECT_NEAR(group_.length(), 10, 1e-9);
  EXPECT_EQ(events_.wish, PlotWish::none) << "that is done here";
  for (const auto& [wish, file] :
       {std::pair(PlotWish::save_csv, "force-001.csv"), {PlotWish::save_svg, "force-001.svg"}}) {
    plot_->ask(wish);
    frames(1);
    ASSERT_TRUE(events_.notice) << file;
    EXPECT_FALSE(events_.notice->bad) << events_.notice->text;
    EXPECT_EQ(events_.notice->file.filename(), file);
    EXPECT_TRUE(std::filesystem::exists(dir / "out" / file));
    events_ = {};
  }
  // The table has the stretch that is shown.
  std::ifstream in(dir / "out" / "force-001.csv");
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "time [s],first [N],second [N]");
  std::vector<double> times;
  while (std::getline(in, line)) times.push_back(std::stod(line));
  ASSERT_GT(times.size(), 9000u);
  EXPECT_NEAR(times.front(), group_.start(), 0.02);
  EXPECT_NEAR(times.back(), group_.stop(), 0.02);
  const auto texts = test::drawn_texts();
  EXPECT_TRUE(std::ranges::any_of(texts, [](const test::DrawnText& each) {
    return each.text.starts_with("Saved force-001.svg");
  })) << "the plot says so itself";
  frames(230);  // 4.6 s
  const auto later = test::drawn_texts();
  EXPECT_TRUE(std::ranges::none_of(later, [](const test::DrawnText& each) {
    return each.text.starts_with("Saved");
  })) << "for four seconds";
}

// The menu is closed, and nothing that is pointed at is in the picture.
TEST_F(AMouse, SavesItsPlaceAsAPng) {
  const test::TempDir dir;
  int saved = 0, waited = 0;
  ScreenRect box{};
  std::filesystem::path file;
  saving_.folder = dir / "out";
  saving_.save_png = [&](const ScreenRect& where, const std::filesystem::path& into) {
    ++saved;
    box = where;
    file = into;
  };
  start();
  plot_->ask(PlotWish::save_png);
  for (; saved == 0 && waited < 10; ++waited) frames(1);
  EXPECT_EQ(saved, 1);
  EXPECT_EQ(waited, 2) << "frames, in which the menu closes";
  EXPECT_NEAR(box.width(), 660, 1);
  EXPECT_NEAR(box.height(), 360, 1);
  EXPECT_EQ(file, dir / "out" / "force-001.png");
  frames(5);
  EXPECT_EQ(saved, 1) << "once";
  std::ofstream(dir / "full") << "a file where a folder should be";
  saving_.folder = dir / "full";
  plot_->ask(PlotWish::save_png);
  frames(3);
  EXPECT_EQ(saved, 1);
  const auto texts = test::drawn_texts();
  EXPECT_TRUE(std::ranges::any_of(texts, [](const test::DrawnText& each) {
    return each.text.find("the folder cannot be made") != std::string::npos;
  }));
}

TEST_F(AMouse, ScalesBothAxesOverAnotherChannel) {
  spec_.kind = PlotKind::cross;
  spec_.x = {.label = "across", .unit = "m", .zero_line = false};
  spec_.curves = {{.channel = 0, .across = 1, .label = "pair"}};
  start();
  const Limits across = x(), up = y();
  wheel(at(0.5f, 0.5f), 1);
  EXPECT_NEAR(x().span(), across.span() / kStep, 1e-6);
  EXPECT_NEAR(y().span(), up.span() / kStep, 1e-6);
  EXPECT_NEAR(x().low + x().high, across.low + across.high, 2e-2) << "about the middle";
  EXPECT_NEAR(group_.length(), 10, 1e-9);
  const Limits kept = y();
  wheel({at(0.5f, 0).x, area().max.y + 8}, 1);
  EXPECT_NEAR(x().span(), across.span() / kStep / kStep, 1e-6) << "below, only along";
  expect_same(y(), kept);
  const Limits from_x = x(), from_y = y();
  const ImVec2 from = at(0.5f, 0.5f);
  drag(from, {from.x + 40, from.y + 30});
  const double by_x = -40 / static_cast<double>(area().width()) * from_x.span();
  const double by_y = 30 / static_cast<double>(area().height()) * from_y.span();
  expect_same(x(), {from_x.low + by_x, from_x.high + by_x});
  expect_same(y(), {from_y.low + by_y, from_y.high + by_y});
}

// Pairs lie on y = 3 + sin(t), x = 1 + 0.1 t.
TEST_F(AMouse, PointsAtTheMomentOfAPair) {
  spec_.kind = PlotKind::cross;
  spec_.x = {.label = "across", .unit = "m", .zero_line = false};
  spec_.curves = {{.channel = 0, .across = 1, .label = "pair"}};
  start();
  const auto place = [&](double t) {
    const AxisMap across{x()}, up{y()};
    return ImVec2{area().min.x + static_cast<float>(across.part(1 + 0.1 * t)) * area().width(),
                  area().max.y - static_cast<float>(up.part(3 + std::sin(t))) * area().height()};
  };
  for (const double t : {11.0, 14.2, 18.0}) {
    const ImVec2 there = place(t);
    point({there.x + 6, there.y});
    ASSERT_TRUE(group_.hovered()) << t;
    EXPECT_NEAR(*group_.hovered(), t, 0.2);
  }
  point(at(0.5f, 0.5f));
  point({place(14.2).x, place(14.2).y < at(0, 0.5f).y ? place(14.2).y + 80 : place(14.2).y - 80});
  EXPECT_FALSE(group_.hovered()) << "nothing is within 30 px";
}

TEST_F(AMouse, PointsAtAFrequencyOfASpectrum) {
  spec_.kind = PlotKind::spectrum;
  spec_.x = {.label = "frequency", .unit = "Hz", .zero_line = false, .log = true};
  spec_.y.log = true;
  start();
  EXPECT_NEAR(x().low, std::log10(0.2), 0.01) << "of halves of ten seconds";
  EXPECT_NEAR(x().high, std::log10(500), 1e-6) << "half of the rate of ticks";
  const Limits before = x();
  point(at(0.5f, 0.5f));
  ASSERT_TRUE(group_.hovered_frequency());
  EXPECT_NEAR(std::log10(*group_.hovered_frequency()), (before.low + before.high) / 2, 0.01);
  EXPECT_FALSE(group_.hovered());
  wheel(at(0.5f, 0.5f), 1);
  EXPECT_NEAR(x().span(), before.span() / kStep, 1e-6) << "along the frequencies";
  EXPECT_NEAR(group_.length(), 10, 1e-9);
}

// A click needs no more than a frame; values that are too fine for single precision are no limits.
TEST_F(AMouse, ScalesNoFartherThanNumbersGo) {
  start();
  for (int i = 0; i < 120; ++i) wheel(at(0.5f, 0.5f), 1, true);
  const double largest = std::max(std::abs(y().low), std::abs(y().high));
  EXPECT_GE(y().span(), 0.99e-6 * largest);
  EXPECT_LT(y().span(), 1e-4 * largest);
  for (int i = 0; i < 320; ++i) wheel(at(0.5f, 0.5f), -1, true);
  EXPECT_LE(y().span(), 1e12);
  EXPECT_GT(y().span(), 1e11);
  for (int i = 0; i < 120; ++i) group_.zoom(1 / kStep, 19);
  EXPECT_NEAR(group_.length(), 8e-3, 1e-6) << "eight ticks";
  for (int i = 0; i < 120; ++i) group_.zoom(kStep, 19);
  EXPECT_NEAR(group_.length(), 24, 1e-3) << "1.2 of all there is";
}

TEST_F(AMouse, KeepsLimitsOfOneKindOnly) {
  start();
  wheel(at(0.5f, 0.5f), 4, true);
  const Limits close = y();
  PlotSpec other = spec_;
  other.curves.pop_back();
  plot_->show(other);
  frames(2);
  expect_same(y(), close);
  other.kind = PlotKind::cross;
  other.curves[0].across = 1;
  plot_->show(other);
  frames(2);
  EXPECT_GT(y().span(), close.span()) << "another kind has limits of its own";
}

}  // namespace
}  // namespace limpid
