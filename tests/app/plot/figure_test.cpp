#include "app/plot/figure.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "devices/files/text_file.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using testing::HasSubstr;
using testing::Not;

namespace fs = std::filesystem;

std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

class Figures : public testing::Test {
 protected:
  test::TempDir temp_;
  const fs::path dir_ = temp_ / ".";
};

Figure small() {
  Figure figure;
  figure.title = "A figure";
  figure.panels = {{.title = "Panel",
                    .x_label = "time [s]",
                    .y_label = "angle [rad]",
                    .series = {{"line", kDeviceInk, Series::Style::line, {{0, 1}, {1, 2}}},
                               {"band", kProxyInk, Series::Style::band, {{0, 1, 0.5, 1.5}}}}}};
  return figure;
}

std::string script_of(const Figure& figure) {
  return gnuplot_script(figure, std::array{FigureFile{"svg", 1, "f.svg"}});
}

TEST_F(Figures, WriteTheirDataAsATableOfAllSeries) {
  write_figure_data(small(), dir_ / "f.csv");
  EXPECT_EQ(read(dir_ / "f.csv"),
            "panel,series,x,y,low,high\n"
            "\"Panel\",\"line\",0,1,0,0\n\"Panel\",\"line\",1,2,0,0\n"
            "\"Panel\",\"band\",0,1,0.5,1.5\n");
}

TEST_F(Figures, DoubleQuotesInsideTextsOfTheTable) {
  Figure figure = small();
  figure.panels[0].title = "a \"b\", c";
  write_figure_data(figure, dir_ / "f.csv");
  EXPECT_THAT(read(dir_ / "f.csv"), HasSubstr("\n\"a \"\"b\"\", c\",\"line\",0,1"));
}

TEST_F(Figures, WriteNumbersThatReadBackTheSame) {
  Figure figure = small();
  figure.panels[0].series[0].points = {{0.1, 1.0 / 3}};
  write_figure_data(figure, dir_ / "f.csv");
  EXPECT_THAT(read(dir_ / "f.csv"), HasSubstr("\"line\",0.1,0.3333333333333333,"));
}

TEST_F(Figures, SayWhichTableCouldNotBeWritten) {
  try {
    write_figure_data(small(), dir_ / "none" / "f.csv");
    FAIL();
  } catch (const FileError& e) {
    EXPECT_THAT(e.what(), HasSubstr("none/f.csv"));
  }
}

TEST_F(Figures, BecomeAPngAndAnSvgAndNothingElse) {
  Figure figure = small();
  figure.made_by = "limpid 9, seed 1";
  draw_figure(figure, dir_, "f");
  const std::string png = read(dir_ / "f.png"), svg = read(dir_ / "f.svg");
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(png.substr(8 + 25 + 4, 32), std::string("tEXtDescription\0limpid 9, seed 1", 32));
  EXPECT_THAT(svg, HasSubstr("<metadata>limpid 9, seed 1</metadata>"));
  EXPECT_THAT(svg, HasSubstr("<svg"));
  EXPECT_THAT(svg, HasSubstr("time [s]"));
  EXPECT_EQ(std::distance(fs::directory_iterator(dir_), {}), 2);
}

// A backtick between double quotes would run a command.
TEST_F(Figures, TakeNoTextForACommand) {
  const fs::path odd = dir_ / "it's `touch hacked` \"$HOME\"";
  fs::create_directories(odd);
  Figure figure = small();
  figure.title = "`touch " + (dir_ / "hacked").string() + "` 'quoted' \\n @macro #no";
  figure.panels[0].title = "' ; system('touch " + (dir_ / "hacked").string() + "') ; '";
  figure.panels[0].x_label = "two\nlines {/Symbol a} x_1^b";
  figure.panels[0].series[0].label = "100 % of \"it\" & <more>";
  figure.panels[0].x_ticks = {{0, "`touch " + (dir_ / "hacked").string() + "` \"it's\""}};
  draw_figure(figure, odd, "f");
  EXPECT_TRUE(fs::exists(odd / "f.png"));
  EXPECT_FALSE(fs::exists(dir_ / "hacked"));
  EXPECT_THAT(read(odd / "f.svg"), HasSubstr("x_1^b"));
}

TEST_F(Figures, AreDrawnWithoutAnyPoint) {
  Figure figure = small();
  for (Series& series : figure.panels[0].series) series.points.clear();
  figure.panels[0].x_range = {{0, 1}};
  figure.panels[0].y_range = {{0, 1}};
  EXPECT_NO_THROW(draw_figure(figure, dir_, "f"));
}

TEST_F(Figures, AreDrawnWithAPanelInWhichNothingIsMeasured) {
  Figure figure = small();
  FigurePanel still{.title = "Still", .x_label = "time [s]", .y_label = "speed [m/s]"};
  still.series = {{"none", kHandInk, Series::Style::line, {}},
                  {"not finite", kHandInk, Series::Style::line, {{1, std::nan("")}}}};
  figure.panels.push_back(still);
  still.log_y = true;
  figure.panels.push_back(still);
  draw_figure(figure, dir_, "f");
  EXPECT_TRUE(fs::exists(dir_ / "f.png"));
}

TEST_F(Figures, HoldValuesThatAreNotFinite) {
  Figure figure = small();
  figure.panels[0].series[0].points = {{0, 1}, {1, std::nan("")}, {2, HUGE_VAL}, {3, 4}};
  EXPECT_NO_THROW(draw_figure(figure, dir_, "f"));
}

TEST(GnuplotScript, ShowsWordsOfThePaperAsItsSymbols) {
  Figure figure = small();
  figure.panels[0].series[0].label = "eta = 0.6";
  figure.panels[0].title = "Error |x1 - x2| of a theta beta";
  const std::string script = script_of(figure);
  EXPECT_THAT(script, HasSubstr("'η = 0.6'"));
  EXPECT_THAT(script, HasSubstr("'Error |x₁ − x₂| of a theta beta'"));
  EXPECT_EQ(typeset("1 / (1 - m w^2 / K)"), "1 / (1 − m ω² / K)");
  EXPECT_EQ(typeset("w_f T <= 0.1, window, 10^-12 kg m^2, 2^x"),
            "ω_f T <= 0.1, window, 10⁻¹² kg m², 2^x");
}

TEST(GnuplotScript, ShowsAllOfABand) {
  Figure figure = small();
  figure.panels[0].series[1].points = {{0, 1, -10, 10}, {1, 1, -10, 10}};
  EXPECT_THAT(script_of(figure), HasSubstr("set yrange [-11:11]"));
}

TEST(GnuplotScript, KeepsARangeThatIsGiven) {
  Figure figure = small();
  figure.panels[0].y_range = {{-1, 3}};
  EXPECT_THAT(script_of(figure), HasSubstr("set yrange [-1:3]"));
}

TEST(GnuplotScript, NamesOnlySeriesWithALabel) {
  Figure figure = small();
  figure.panels[0].series[0].label = "";
  const std::string script = script_of(figure);
  EXPECT_THAT(script, Not(HasSubstr("label ''")));
  EXPECT_THAT(script, HasSubstr("'band'"));
}

// Two panels of 640 px beside each other under a title of 52 px, each with its margins.
TEST(GnuplotScript, PutsPanelsBesideAndBelowEachOther) {
  Figure figure = small();
  figure.columns = 2;
  figure.panel_height = 400;
  figure.panels = {figure.panels[0], figure.panels[0], figure.panels[0]};
  const std::string script = script_of(figure);
  EXPECT_THAT(script, HasSubstr("size 1280,852 "));
  std::vector<double> left, right, bottom, top;
  for (const auto& [margin, into] : {std::pair("lmargin", &left),
                                     {"rmargin", &right},
                                     {"bmargin", &bottom},
                                     {"tmargin", &top}}) {
    const std::string key = std::string("set ") + margin + " at screen ";
    for (std::size_t at = 0; (at = script.find(key, at)) != std::string::npos; at += key.size()) {
      into->push_back(std::stod(script.substr(at + key.size())));
    }
    ASSERT_EQ(into->size(), 3u) << margin;
  }
  EXPECT_NEAR(left[0] * 1280, 92, 0.01);
  EXPECT_NEAR(right[0] * 1280, 640 - 26, 0.01);
  EXPECT_NEAR(left[1] * 1280, 640 + 92, 0.01);
  EXPECT_NEAR(right[1] * 1280, 1280 - 26, 0.01);
  EXPECT_NEAR(left[2], left[0], 1e-9) << "the third one is below the first one";
  // Under the figure's title: the panel's title, one line of its legend, the axes, their labels.
  EXPECT_NEAR(top[0] * 852, 852 - 52 - 38 - 20, 0.01);
  EXPECT_NEAR(bottom[0] * 852, 852 - 52 - 400 + 58, 0.01);
  EXPECT_NEAR(top[1], top[0], 1e-9);
  EXPECT_NEAR(top[2] * 852, 852 - 52 - 400 - 38 - 20, 0.01);
  EXPECT_NEAR(bottom[2] * 852, 58, 0.01);
}

// Entries flow in lines of the axes' width; gnuplot's letters are 6.8 px wide.
TEST(GnuplotScript, BreaksALongLegendIntoLines) {
  Figure figure = small();
  figure.panels[0].series.clear();
  for (int i = 0; i < 5; ++i) {
    figure.panels[0].series.push_back({fmt::format("{:-<20}{}", "curve", i),
                                       kDeviceInk,
                                       Series::Style::line,
                                       {{0, 1.0}, {1, 2.0 + i}}});
  }
  const std::string script = script_of(figure);
  std::vector<std::pair<double, double>> places;
  for (int i = 0; i < 5; ++i) {
    const std::string label = typeset(fmt::format("{:-<20}{}", "curve", i));
    const std::size_t at = script.find("set label '" + label + "' at screen ");
    ASSERT_NE(at, std::string::npos) << label;
    double x = 0, y = 0;
    ASSERT_EQ(std::sscanf(script.c_str() + script.find("screen ", at), "screen %lf,%lf", &x, &y),
              2);
    places.emplace_back(x * 640, y * (420 + 52));
  }
  // 26 px of sample, 6 beside it, 21 letters, 20 to the next: two fit into 522 px.
  const double wide = 26 + 6 + 21 * 6.8 + 20;
  EXPECT_NEAR(places[0].first, 92 + 26 + 6, 0.01);
  EXPECT_NEAR(places[1].first - places[0].first, wide, 0.01);
  EXPECT_NEAR(places[1].second, places[0].second, 0.01);
  const std::size_t in_line = places[2].second < places[0].second - 1 ? 2 : 3;
  EXPECT_NEAR(places[in_line].first, places[0].first, 0.01) << "the next line begins at the left";
  EXPECT_NEAR(places[0].second - places[in_line].second, 20, 0.01) << "and lies below";
}

TEST(GnuplotScript, DrawsEachStyleAsItIsNamed) {
  Figure figure = small();
  Series points{"dots", kHandInk, Series::Style::points, {{0, 1}}};
  points.mark = 5;
  Series cells{"", "", Series::Style::cells, {}, {{0, 1, 2, 4, 0.5}}};
  cells.label = "share [-]";
  figure.panels[0].series = {{"line", kDeviceInk, Series::Style::line, {{0, 1}, {1, 2}}},
                             {"dashed", kProxyInk, Series::Style::dashed, {{0, 1}, {1, 2}}},
                             points,
                             {"band", kContactInk, Series::Style::band, {{0, 1, 0.5, 1.5}}},
                             cells};
  figure.panels[0].value_range = {{0, 2}};
  const std::string script = script_of(figure);
  const std::string plot = script.substr(script.find("\nplot "));
  for (const std::string& words :
       {fmt::format("$d0 using 1:2 with lines lw 1.8 dt 1 lc rgb '{}' notitle", kDeviceInk),
        fmt::format("$d1 using 1:2 with lines lw 1.8 dt (7,4) lc rgb '{}' notitle", kProxyInk),
        fmt::format("$d2 using 1:2 with points pt 5 ps 0.6 lc rgb '{}' notitle", kHandInk),
        std::string("$d3 using 1:3:4 with filledcurves"),
        std::string("$d4 using 1:2:3:4:5:6:7 with boxxyerror")}) {
    EXPECT_THAT(plot, HasSubstr(words));
  }
  // x y, then x_low x_high y_low y_high value.
  EXPECT_THAT(script, HasSubstr("$d4 << EOD\n0 2 0 1 2 4 0.5\nEOD"));
  EXPECT_THAT(script, HasSubstr("$d3 << EOD\n0 1 0.5 1.5\nEOD"));
  EXPECT_THAT(script, HasSubstr("set cbrange [0:2]"));
  EXPECT_THAT(script, HasSubstr("'share [−]'"));
  double right = 0;
  ASSERT_EQ(
      std::sscanf(script.c_str() + script.find("set rmargin"), "set rmargin at screen %lf", &right),
      1);
  EXPECT_NEAR(right * 640, 640 - 104, 0.01) << "room for the bar of colours";
}

TEST(GnuplotScript, ChoosesRangesWithRoomAroundTheValues) {
  const auto range = [](std::vector<FigurePoint> points, bool log = false) {
    Figure figure = small();
    figure.panels[0].log_y = log;
    figure.panels[0].series = {{"line", kDeviceInk, Series::Style::line, std::move(points)}};
    const std::string script = script_of(figure);
    const std::size_t at = script.find("set yrange ") + 11;
    return script.substr(at, script.find('\n', at) - at);
  };
  EXPECT_EQ(range({{0, 100}, {1, 200}}), "[95:205]") << "a twentieth on both sides";
  EXPECT_EQ(range({{0, 1}, {1, 101}}), "[0:106]") << "zero is near";
  EXPECT_EQ(range({{0, -20}, {1, 80}}), "[-25:85]");
  EXPECT_EQ(range({{0, 4}, {1, 4}}), "[3.8:4.2]") << "a level line";
  EXPECT_EQ(range({{0, 3}, {1, 12}}, true), "[2:18]");
  EXPECT_EQ(range({{0, -3}, {1, 3}, {2, 12}}, true), "[2:18]") << "positive values alone";
  EXPECT_EQ(range({{0, std::nan("")}}), "[1:10]") << "gnuplot takes no empty range";
  Figure figure = small();
  figure.panels[0].x_range = {{-1, 4}};
  figure.panels[0].log_x = true;
  figure.panels[0].x_ticks = {{0.5, "none"}, {2, "two"}};
  const std::string script = script_of(figure);
  EXPECT_THAT(script, HasSubstr("set xrange [-1:4]"));
  EXPECT_THAT(script, HasSubstr("set logscale x\n"));
  EXPECT_THAT(script, HasSubstr("unset logscale y\n"));
  EXPECT_THAT(script, HasSubstr("set xtics noenhanced ('none' 0.5, 'two' 2)"));
  EXPECT_THAT(script_of(small()), HasSubstr("set xtics enhanced autofreq"));
}

TEST(GnuplotScript, DrawsIntoEachFileInItsSize) {
  Figure figure = small();
  const std::array files{FigureFile{"pngcairo", 2, "/a.png"}, FigureFile{"svg", 1, "/it's.svg"}};
  const std::string script = gnuplot_script(figure, files);
  EXPECT_THAT(script, HasSubstr("set terminal pngcairo size 1280,944 "));
  EXPECT_THAT(script, HasSubstr("fontscale 2 linewidth 2 pointscale 2"));
  EXPECT_THAT(script, HasSubstr("set output '/a.png'"));
  EXPECT_THAT(script, HasSubstr("set terminal svg size 640,472 "));
  EXPECT_THAT(script, HasSubstr("set output '/it''s.svg'"));
  EXPECT_THAT(script, testing::EndsWith("unset multiplot\nset output\n"));
  figure.panels[0].series.clear();
  EXPECT_THAT(script_of(figure), HasSubstr("plot NaN notitle"));
}

// Places in a panel of 640 by 420 px below a title of 52, counted from the lower left.
TEST(GnuplotScript, PutsTitleLegendAndNamesOfAxesAroundTheCurves) {
  const auto at = [](double x, double y) {
    return fmt::format("screen {:.6f},{:.6f}", x / 640, y / 472);
  };
  Figure figure = small();
  Series points{"dots", kHandInk, Series::Style::points, {{0, 1}}};
  points.mark = 5;
  figure.panels[0].series.push_back(points);
  figure.panels[0].series.push_back({"gap", kContactInk, Series::Style::dashed, {{0, 1}, {1, 1}}});
  const std::string script = script_of(figure);
  // Axes are from 58 to 420 - 38 - 20.
  const double top = 362, middle = (58 + top) / 2, line = top + 14;
  // Entries: a sample of 26, 6, letters of 6.8, and 20 to the next one.
  const double band = 92 + 52 + 4 * 6.8, dots = band + 52 + 4 * 6.8, gap = dots + 52 + 4 * 6.8;
  for (const std::string& words :
       {"set label 'Panel' at " + at(92, top + 40) + " left noenhanced font ',13'\n",
        "set arrow from " + at(92, line) + " to " + at(118, line) +
            fmt::format(" nohead lw 1.8 dt 1 lc rgb '{}'\n", kDeviceInk),
        "set label 'line' at " + at(124, line) + " left noenhanced font ',11'\n",
        "set object rectangle from " + at(band, line - 5) + " to " + at(band + 26, line + 5) +
            fmt::format(" fc rgb '{}' fs transparent solid 0.2 noborder\n", kProxyInk),
        "set label 'band' at " + at(band + 32, line) + " left",
        "set label '' at " + at(dots + 13, line) +
            fmt::format(" point pt 5 ps 0.6 lc rgb '{}'\n", kHandInk),
        "set arrow from " + at(gap, line) + " to " + at(gap + 26, line) +
            fmt::format(" nohead lw 1.8 dt (7,4) lc rgb '{}'\n", kContactInk),
        "set label 'angle [rad]' at " + at(20, middle) + " center rotate by 90 noenhanced\n",
        std::string("set xlabel 'time [s]' noenhanced offset 0,0.3\n"),
        std::string("unset logscale x\nset format x '%g'\n"), std::string("unset colorbox\n"),
        std::string("set multiplot title 'A figure'")}) {
    EXPECT_THAT(script, HasSubstr(words));
  }
}

TEST(GnuplotScript, PutsABarOfColoursBesideAMap) {
  const auto at = [](double x, double y) { return fmt::format("{:.6f},{:.6f}", x / 640, y / 472); };
  Figure figure = small();
  Series map{"share", "", Series::Style::cells, {}, {{0, 1, 2, 4, 0.5}}};
  figure.panels[0].series = {map};
  const std::string script = script_of(figure);
  // A map has no entry in the legend; its axes end at 536.
  const double top = 420 - 38;
  EXPECT_THAT(script, HasSubstr("set colorbox vertical user origin screen " + at(546, 58) +
                                " size " + at(14, top - 58) + " noborder\n"));
  EXPECT_THAT(script, HasSubstr("set cbrange [*:*]\nset format cb '%g'\n"));
  EXPECT_THAT(script, HasSubstr("set label 'share' at screen " + at(618, (top + 58) / 2) +
                                " center rotate by 90"));
  EXPECT_THAT(script, HasSubstr("fc palette notitle"));
  figure.panels[0].series[0].color = kHandInk;
  EXPECT_THAT(script_of(figure), HasSubstr(fmt::format("fc rgb '{}'", kHandInk)));
  EXPECT_THAT(script_of(figure), HasSubstr("unset colorbox\n"));
}

TEST_F(Figures, WriteTheMiddleOfCells) {
  Figure figure = small();
  figure.panels[0].log_x = true;
  figure.panels[0].series = {{"map", "", Series::Style::cells, {}, {{1, 100, 2, 4, 0.5}}}};
  write_figure_data(figure, dir_ / "f.csv");
  EXPECT_EQ(read(dir_ / "f.csv"), "panel,series,x,y,low,high\n\"Panel\",\"map\",10,3,0.5,0.5\n");
}

}  // namespace
}  // namespace limpid
