// Plots of the window, drawn frame by frame.
#include <algorithm>
#include <cmath>
#include <set>

#include "app/plot/plot.h"
#include "app/plot/plot_legend.h"
#include "tests/app/plot/imgui_frames.h"
#include "tests/support/drawn_text.h"

namespace limpid {
namespace {

class APlot : public ImGuiFrames {
 protected:
  static PlotSpec energy() {
    return {.title = "energy",
            .y = {.unit = "mJ",
                  .factor = 1e3,
                  .units = {{"mJ", 1e3, 1}, {"J", 1, 1e9}},
                  .smallest_span = 1e-3},
            .curves = {{.label = "total"}}};
  }
  void draw(Plot& plot, const History& history, int frames) {
    for (int i = 0; i < frames; ++i) {
      frame([&] {
        ImGui::SetNextWindowSize({400, 200});
        ImGui::Begin("plots");
        group_.begin_frame(history);
        plot.draw(history, group_, {380, 160});
        ImGui::End();
      });
    }
  }

  PlotGroup group_;
};

TEST_F(APlot, WritesLargeEnergiesInJoules) {
  History history({.channels = 1});
  Plot plot(energy());
  for (int i = 0; i < 1000; ++i) history.append(0.001 * i, std::array{0.0005 * i});
  draw(plot, history, 3);
  EXPECT_EQ(plot.spec().y.unit, "mJ");
  for (int i = 1000; i < 3000; ++i) history.append(0.001 * i, std::array{0.0005 * i});
  draw(plot, history, 200);
  EXPECT_EQ(plot.spec().y.unit, "J");
  EXPECT_EQ(plot.spec().y.factor, 1);
}

TEST_F(APlot, LeavesTheEnergyOfTheRunBeforeBehindAtOnce) {
  History history({.channels = 1});
  Plot plot(energy());
  for (int i = 0; i < 1000; ++i) history.append(0.001 * i, std::array{5.761});
  draw(plot, history, 3);
  EXPECT_EQ(plot.spec().y.unit, "J");
  for (int i = 0; i < 10; ++i) history.append(0.001 * i, std::array{0.0});
  draw(plot, history, 1);
  EXPECT_EQ(plot.spec().y.unit, "mJ") << "the new run's axis, with the old run still in the window";
}

TEST_F(APlot, SaysTheLawBeforeTheNameOfItsCurve) {
  History history({.channels = 1});
  history.append(0, std::array{0.0});
  PlotSpec spec = energy();
  spec.curves[0].law_name = "tank";
  Plot plot(spec);
  draw(plot, history, 3);
  const auto texts = test::drawn_texts();
  EXPECT_EQ(std::ranges::count(texts, "tank total", &test::DrawnText::text), 1);
}

struct Found {
  std::set<int> curves;
  float lowest = 0;  // lowest end of a name
};

Found names(const PlotLegend& legend, ImVec2 size) {
  Found found;
  for (float y = 0; y < size.y; ++y) {
    for (float x = 0; x < size.x; x += 2) {
      const int curve = legend.curve_at({x, y});
      if (curve < 0) continue;
      found.curves.insert(curve);
      found.lowest = y;
    }
  }
  return found;
}

TEST_F(APlot, NamesItsVisibleCurvesAboveThemInEverySize) {
  PlotSpec spec = energy();
  spec.curves = {{.label = "|f1|"},
                 {.label = "|f1| estimate"},
                 {.label = "|f2|"},
                 {.label = "joint 1", .visible = false},
                 {.label = "joint 2", .visible = false}};
  for (const ImVec2 size : {ImVec2{190, 110}, {280, 165}, {420, 250}, {900, 300}}) {
    frame([&] {
      PlotLegend legend;
      const ScreenRect outer{{0, 0}, size};
      const float title_bottom = 20;
      const float height = legend.place({outer, {{100, 0}, {size.x, title_bottom}}, 84}, spec, 1);
      const Found found = names(legend, size);
      for (const int curve : {0, 1, 2}) {
        EXPECT_TRUE(found.curves.contains(curve)) << curve << " at " << size.x;
      }
      EXPECT_LE(found.lowest, title_bottom + height) << "no name lies over the curves";
      EXPECT_GE(size.y - title_bottom - height, 60) << "and they keep their room";
    });
  }
}

TEST_F(APlot, NamesBothRunsOfATwinInALineThatIsTooShortForTheirWholeNames) {
  PlotSpec spec = energy();
  const std::vector<std::string> labels = {"standard |f1|", "standard |f2|", "predictive |f1|",
                                           "predictive |f2|"};
  spec.curves.clear();
  for (const std::string& label : labels) spec.curves.push_back({.label = label});
  frame([&] {
    PlotLegend legend;
    const auto width = [](const std::string& label) { return text_size(Face::small, label).x; };
    const float narrow = width(labels[0]) + width("|f2|") + width(labels[2]) + width("|f2|") + 60;
    ASSERT_LT(narrow, width(labels[0]) + width(labels[1]) + width(labels[2]) + width(labels[3]));
    legend.place({{{0, 0}, {narrow, 100}}, {{80, 0}, {narrow, 20}}, 84}, spec, 1);
    EXPECT_EQ(names(legend, {narrow, 100}).curves, (std::set{0, 1, 2, 3}));
    const float narrower = narrow - 70;
    legend.place({{{0, 0}, {narrower, 100}}, {{80, 0}, {narrower, 20}}, 84}, spec, 1);
    EXPECT_EQ(names(legend, {narrower, 100}).curves, (std::set{0, 1})) << "each quantity once";
  });
}

// The label stands at the height of the value under the mouse, not at the curve's end.
TEST_F(APlot, WritesTheValuesOfTheMomentThatIsPointedAt) {
  PlotSpec spec = energy();
  spec.end_labels = true;
  History history({.channels = 1});
  for (int k = 0; k < 1000; ++k) history.append(1e-3 * k, std::array{6e-3 * k});
  frame([&] {
    const ScreenRect area{{60, 0}, {200, 400}};
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    const PlotFrame in{list, current_palette(),   1,        {{0, 0}, {300, 420}},
                       area, {1.0 / 140, 0, 140}, {{0, 1}}, {{0, 6}}};
    for (const double time : {0.9, 0.5, 0.1}) {
      const int before = list.VtxBuffer.Size;
      draw_end_labels(in, spec, history, time);
      ASSERT_GT(list.VtxBuffer.Size, before);
      const float line = text_size(Face::small, "0").y;
      for (int i = before; i < list.VtxBuffer.Size; ++i) {
        EXPECT_NEAR(list.VtxBuffer[i].pos.y, in.y_of(6 * time), line) << time;
      }
    }
  });
}

TEST_F(APlot, WritesValuesAtTheBottomInsideThePlotAndApart) {
  PlotSpec spec = energy();
  spec.end_labels = true;
  spec.curves = {{.channel = 0, .label = "nothing"}, {.channel = 1, .label = "little"}};
  History history({.channels = 2});
  history.append(0, std::array{0.0, 0.05});
  const ScreenRect area{{60, 0}, {200, 400}};
  float line = 0;
  frame([&] {
    line = text_size(Face::small, "0").y;
    const PlotFrame in{*ImGui::GetForegroundDrawList(),
                       current_palette(),
                       1,
                       {{0, 0}, {300, 420}},
                       area,
                       {1.0 / 140, 0, 140},
                       {{0, 1}},
                       {{0, 6}}};
    draw_end_labels(in, spec, history, 0);
  });
  const std::vector<test::DrawnText> texts = test::drawn_texts();
  ASSERT_EQ(texts.size(), 2u);
  for (const test::DrawnText& text : texts) {
    EXPECT_LE(text.max.y, area.max.y + 1) << text.text;
    EXPECT_GT(text.min.y, area.max.y - 3 * line) << text.text;
  }
  EXPECT_GE(std::abs(texts[0].middle().y - texts[1].middle().y), line - 1);
}

// Whatever the value, its digits stand inside the plot.
TEST_F(APlot, WritesValuesAtTheEndsThatFitIntoTheMargin) {
  PlotSpec spec = energy();
  spec.end_labels = true;
  const float scale = current_scale();
  for (const Limits& limits : {Limits{0, 0.6}, Limits{-0.05, 0.05}, Limits{-2e-4, 1e-4},
                               Limits{-3000, 200}, Limits{-6, 0}}) {
    for (const bool log : {false, true}) {
      for (const double value : {1.9e-4, 3.04e-5, 0.0213, 0.0673, 12.345, 123.4, 2999.0, 0.0}) {
        for (const double sign : {1.0, -1.0}) {
          History history({.channels = 1});
          history.append(0, std::array{log ? value : sign * value});
          frame([&] {
            const ScreenRect area{{60, 0}, {200, 400}};
            const ScreenRect outer{{0, 0}, {200 + 6 * scale + end_label_width(), 420}};
            ImDrawList& list = *ImGui::GetForegroundDrawList();
            const PlotFrame in{list, current_palette(),   scale,    outer,
                               area, {1.0 / 140, 0, 140}, {{0, 1}}, {limits, log}};
            const int before = list.VtxBuffer.Size;
            draw_end_labels(in, spec, history, 0);
            ASSERT_GT(list.VtxBuffer.Size, before);
            for (int i = before; i < list.VtxBuffer.Size; ++i) {
              EXPECT_LE(list.VtxBuffer[i].pos.x, outer.max.x) << sign * value << " " << log;
            }
          });
        }
      }
    }
  }
}

// The curve has a sign for each distance along it, complete while it scrolls.
TEST_F(APlot, PutsSignsOnTheCurveOfASecondRun) {
  frame([&] {
    const ScreenRect area{{0, 0}, {640, 100}};
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    Trace trace;
    TracePen pen(trace);
    for (int x = 0; x <= 640; ++x) pen.put({static_cast<float>(x), 1, 1});
    const auto drawn = [&](std::int64_t first, RunSign sign) {
      const PlotFrame in{list, current_palette(),  1,        area,
                         area, {1e-3, first, 640}, {{0, 1}}, {{0, 2}}};
      const int before = list.VtxBuffer.Size;
      draw_run_signs(in, trace, {.sign = sign}, 1);
      return list.VtxBuffer.Size - before;
    };
    EXPECT_EQ(drawn(0, RunSign::none), 0);
    const int ten = drawn(0, RunSign::square);
    EXPECT_GT(ten, 0);
    for (const std::int64_t first : {1, 17, 63, 64, -5}) {
      EXPECT_NEAR(drawn(first, RunSign::square), ten, ten / 10) << first;
    }
    EXPECT_NE(drawn(0, RunSign::ring), ten) << "another shape";
  });
}

TEST_F(APlot, WritesNoMoreValuesAtTheEndsThanThereIsRoomFor) {
  PlotSpec spec = energy();
  spec.end_labels = true;
  spec.curves.clear();
  for (int i = 0; i < 4; ++i) spec.curves.push_back({.channel = i, .label = "curve"});
  History history({.channels = 4});
  for (int k = 0; k < 100; ++k) history.append(1e-3 * k, std::array{1.0, 1.01, 1.02, 5.0});
  frame([&] {
    const float line = text_size(Face::small, "0").y;
    const ScreenRect area{{60, 100}, {200, 100 + 2.5f * line}};
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    const PlotFrame in{list, current_palette(), 1,           {{0, 60}, {300, 200}},
                       area, {1e-3, 0, 140},    {{0, 0.14}}, {{0, 6}}};
    const int before = list.VtxBuffer.Size;
    draw_end_labels(in, spec, history, 0.1);
    EXPECT_GT(list.VtxBuffer.Size, before);
    for (int i = before; i < list.VtxBuffer.Size; ++i) {
      EXPECT_GE(list.VtxBuffer[i].pos.y, area.min.y - 1) << "over the legend";
      EXPECT_LE(list.VtxBuffer[i].pos.y, area.max.y + 1);
    }
  });
}

// A box beside the moment that is pointed at, drawn for a plot from 60 to 460 px.
class AReadOut : public APlot {
 protected:
  AReadOut() {
    spec_.y = {.unit = "J"};
    spec_.curves = {{.label = "rises"},
                    {.channel = 1, .label = "stays"},
                    {.label = "hidden", .visible = false}};
  }
  PlotFrame in(Limits x) {
    return {*ImGui::GetForegroundDrawList(),
            current_palette(),
            1,
            {{0, 0}, {500, 420}},
            {{60, 0}, {460, 400}},
            {x.span() / 400, std::llround(400 * x.low / x.span()), 400},
            {x},
            {{0, 6}}};
  }
  template <class Draw>
  void show(const Draw& draw) {
    frame(draw);
    texts_ = test::drawn_texts();
  }
  // Finds a text that begins so.
  const test::DrawnText* find(const std::string& text) const {
    const auto found = std::ranges::find_if(
        texts_, [&](const test::DrawnText& each) { return each.text.starts_with(text); });
    return found == texts_.end() ? nullptr : &*found;
  }
  // Expects a curve's name with its value behind it, in one line.
  void expect_line(const std::string& name, const std::string& value) {
    const test::DrawnText *left = find(name), *right = find(value);
    ASSERT_TRUE(left) << name;
    ASSERT_TRUE(right) << value;
    EXPECT_TRUE(right->text.ends_with(" J")) << right->text;
    EXPECT_NEAR(left->middle().y, right->middle().y, 3);
    EXPECT_GT(right->min.x, left->max.x);
  }

  PlotSpec spec_;
  std::vector<test::DrawnText> texts_;
};

TEST_F(AReadOut, SaysTimeAndValuesBesideTheMoment) {
  History history({.channels = 2});
  for (int k = 0; k <= 1000; ++k) history.append(1e-3 * k, std::array{6e-3 * k, 1.25});
  const auto point_at = [&](double time) {
    show([&] { draw_read_out(in({0, 1}), spec_, history, time, {200, 200}); });
  };
  point_at(0.5);
  ASSERT_TRUE(find("0.500 s"));
  EXPECT_GT(find("0.500 s")->min.x, 60 + 0.5f * 400) << "at the right of the moment";
  expect_line("rises", "3.0");
  expect_line("stays", "1.25");
  EXPECT_FALSE(find("hidden"));
  point_at(0.98);
  expect_line("rises", "5.88");
  EXPECT_LT(find("5.88")->max.x, 60 + 0.98f * 400) << "at the left, where there is room";
  point_at(1.5);
  EXPECT_TRUE(texts_.empty()) << "outside of what is shown";
}

TEST_F(AReadOut, SaysWhereThereIsNoData) {
  History history({.channels = 2});
  for (const int k : {0, 1, 2, 800, 801}) history.append(1e-3 * k, std::array{3.0, 1.25});
  show([&] { draw_read_out(in({0, 1}), spec_, history, 0.4, {200, 200}); });
  ASSERT_TRUE(find("0.4"));
  EXPECT_TRUE(find("0.4")->text.ends_with("no data"));
  EXPECT_FALSE(find("rises"));
}

// A sample counts up to one and a half ticks around it, or as far as its pixel goes.
TEST_F(AReadOut, TakesTheSampleThatIsNear) {
  History history({.channels = 2});
  for (int k = 0; k < 20; ++k) history.append(1e-3 * k, std::array{3.0, 1.25});
  for (int k = 24; k < 40; ++k) history.append(1e-3 * k, std::array{4.0, 1.25});
  const auto has_data = [&](Limits x, double time) {
    show([&] { draw_read_out(in(x), spec_, history, time, {200, 200}); });
    return find("rises") != nullptr;
  };
  EXPECT_TRUE(has_data({0, 0.04}, 0.0104));
  EXPECT_TRUE(has_data({0, 0.04}, 0.0204));
  EXPECT_FALSE(has_data({0, 0.04}, 0.0209));
  EXPECT_FALSE(has_data({0, 0.04}, 0.0216));
  EXPECT_TRUE(has_data({0, 0.04}, 0.0226));
  EXPECT_TRUE(has_data({0, 1}, 0.0212)) << "within a pixel of 2.5 ms";
  EXPECT_FALSE(has_data({0, 1}, 0.05));
}

// The time is the run's own after it has started over, and has minutes from the first one on.
TEST_F(AReadOut, SaysTheTimeOfTheRun) {
  History history({.channels = 2, .seconds = 200, .tick = 0.5});
  for (int k = 0; k < 20; ++k) history.append(0.5 * k, std::array{3.0, 1.25});
  for (int k = 0; k <= 240; ++k) history.append(0.5 * k, std::array{4.0, 1.25});
  const auto said = [&](double time) {
    const double at = time + history.offset();
    show([&] { draw_read_out(in({at - 100, at + 100}), spec_, history, at, {200, 200}); });
    EXPECT_FALSE(texts_.empty());
    return texts_.empty() ? "" : texts_.front().text;
  };
  EXPECT_EQ(said(12), "12.0 s");
  EXPECT_EQ(said(59.5), "59.5 s");
  EXPECT_EQ(said(60), "1:00.0");
  EXPECT_EQ(said(90.5), "1:30.5");
}

// Over another channel the box is beside the point of the moment.
TEST_F(AReadOut, OfPairsOfValuesIsBesideTheirPoint) {
  spec_.kind = PlotKind::cross;
  spec_.x = {.unit = "N"};
  spec_.curves.resize(1);
  spec_.curves[0].across = 1;
  History history({.channels = 2});
  for (int k = 0; k <= 100; ++k) history.append(1e-3 * k, std::array{3.0, 0.01 * k});
  show([&] {
    PlotFrame frame = in({0, 1});
    frame.window = {1e-3, 0, 400};
    draw_read_out(frame, spec_, history, 0.05, {200, 200});
  });
  ASSERT_TRUE(find("rises"));
  EXPECT_TRUE(find("rises")->min.x > 60 + 0.5f * 400) << "0.5 across";
  EXPECT_LT(find("rises")->min.x, 60 + 0.5f * 400 + 40);
  ASSERT_TRUE(find("3.0"));
  EXPECT_NE(find("3.0")->text.find("0.500 N"), std::string::npos) << find("3.0")->text;
}

// The highest amplitude counts among the frequencies of one pixel.
TEST_F(AReadOut, SaysTheAmplitudesOfAFrequency) {
  AmplitudeSpectrum peaked{0.1, {}}, even{0.1, {}};
  peaked.amplitude.assign(5001, 1);
  even.amplitude.assign(5001, 2.5);
  peaked.amplitude[2003] = 4;
  show([&] { draw_spectrum_read_out(in({0, 400}), spec_, {peaked, even}, 200, {200, 200}); });
  EXPECT_TRUE(find("200 Hz"));
  expect_line("rises", "4.0");
  expect_line("stays", "2.5");
  show([&] { draw_spectrum_read_out(in({0, 400}), spec_, {peaked, even}, 300, {200, 200}); });
  EXPECT_TRUE(find("300 Hz"));
  expect_line("rises", "1.0");
}

}  // namespace
}  // namespace limpid
