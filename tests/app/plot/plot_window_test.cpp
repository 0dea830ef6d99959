// Plots as the window draws them, frame by frame.
#include <set>

#include "app/plot/plot.h"
#include "app/plot/plot_legend.h"
#include "tests/app/plot/imgui_frames.h"

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

struct Found {
  std::set<int> curves;
  float lowest = 0;  // that a name reaches
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
      const float height = legend.place(outer, 100, title_bottom, 84, spec, 1);
      const Found found = names(legend, size);
      for (const int curve : {0, 1, 2}) {
        EXPECT_TRUE(found.curves.contains(curve)) << curve << " at " << size.x;
      }
      EXPECT_LE(found.lowest, title_bottom + height) << "no name lies over the curves";
      EXPECT_GE(size.y - title_bottom - height, 60) << "and they keep their room";
    });
  }
}

}  // namespace
}  // namespace limpid
