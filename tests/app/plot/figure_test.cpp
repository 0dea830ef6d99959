#include "app/plot/figure.h"

#include <gmock/gmock.h>

#include <array>
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
  draw_figure(small(), dir_, "f");
  EXPECT_EQ(read(dir_ / "f.png").substr(1, 3), "PNG");
  const std::string svg = read(dir_ / "f.svg");
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

}  // namespace
}  // namespace limpid
