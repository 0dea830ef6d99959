// Exports of the window's plots: files hold the stretch, size and colours that were ordered.
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

#include "tests/app/desktop/shell/whole_window.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Format = ExportOrder::Format;
using What = ExportOrder::What;

std::string bytes_in(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// A number of four bytes, the largest first, as PNG has them.
unsigned long number_at(const std::string& bytes, std::size_t at) {
  unsigned long number = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    number = 256 * number + static_cast<unsigned char>(bytes.at(at + i));
  }
  return number;
}

TEST(ExportOrder, IsOfAFileWhoseEndingSaysWhatIsInIt) {
  EXPECT_EQ(wrong_ending({.format = Format::svg}, "a.svg"), "");
  EXPECT_EQ(wrong_ending({.what = What::table, .format = Format::pdf}, "a.csv"), "");
  EXPECT_EQ(wrong_ending({.what = What::window, .format = Format::pdf}, "a.png"), "");
  for (const char* name : {"a.png", "a", "svg", "a.svg.txt"}) {
    EXPECT_THAT(wrong_ending({.format = Format::svg}, name), HasSubstr(".svg")) << name;
  }
}

class AnExport : public WholeWindow {
 protected:
  void SetUp() override {
    WholeWindow::SetUp();
    if (!desktop) return;
    ASSERT_TRUE(until([&] { return stage().history.end_time() > 1; }));
    stage().group.set_following(false);
    frames(2);
  }
  Stage& stage() { return desktop->shown.stage(); }
  // Carries an order out; returns what the file holds.
  std::string exported(ExportOrder order, const char* name) {
    order.file = dir / name;
    desktop->exporter.forget();
    EXPECT_EQ(desktop->exporter.carry_out(order, stage()), fs::path());
    EXPECT_TRUE(until([&] { return !desktop->exporter.written().empty(); })) << name;
    EXPECT_EQ(desktop->exporter.written(), order.file);
    return bytes_in(order.file);
  }
  // The first and the last time of a table [s].
  static std::pair<double, double> times(const std::string& csv) {
    std::istringstream in(csv);
    std::string line;
    std::getline(in, line);
    std::pair<double, double> ends{NAN, NAN};
    while (std::getline(in, line)) {
      ends.second = std::stod(line);
      if (std::isnan(ends.first)) ends.first = ends.second;
    }
    return ends;
  }
};

TEST_F(AnExport, OfATableHasTheRowsOfTheSelectedStretchAlone) {
  const double end = std::floor(10 * stage().history.end_time()) / 10 - stage().history.offset();
  const double offset = stage().history.offset(), from = end - 0.4, to = end - 0.1;
  stage().group.select(PlotRange{.start = from + offset, .stop = to + offset});
  const auto [first, last] = times(exported({.what = What::table}, "part.csv"));
  EXPECT_NEAR(first, from, 1.5e-3);
  EXPECT_NEAR(last, to, 1.5e-3);
  const auto [begin, stop] = times(exported({.what = What::table, .stretch = false}, "all.csv"));
  EXPECT_LT(begin, from - 0.2);
  EXPECT_GT(stop, to);
  stage().group.select(std::nullopt);
  EXPECT_EQ(times(exported({.what = What::table}, "none.csv")).first, begin)
      << "nothing is selected";
}

TEST_F(AnExport, OfAPictureIsAsLargeAsItIsPrinted) {
  const std::string svg = exported({.format = Format::svg, .width = 100, .height = 50}, "plot.svg");
  EXPECT_THAT(svg, HasSubstr("width=\"100mm\" height=\"50"));
  EXPECT_THAT(svg, HasSubstr(fmt::format("viewBox=\"0 0 {} {}\"", std::lround(100 * 96 / 25.4),
                                         std::lround(50 * 96 / 25.4))));
  EXPECT_THAT(svg, HasSubstr(stage().plots[0].spec().curves[0].label));
  const std::string png =
      exported({.format = Format::png, .width = 100, .height = 50, .dpi = 200}, "plot.png");
  ASSERT_GT(png.size(), 60u);
  EXPECT_NEAR(static_cast<double>(number_at(png, 16)), 100 / 25.4 * 200, 2);
  EXPECT_NEAR(static_cast<double>(number_at(png, 20)), 50 / 25.4 * 200, 2);
  EXPECT_THAT(png, HasSubstr(std::string("tEXtDescription\0limpid ", 23)));
  const std::size_t physical = png.find("pHYs");
  ASSERT_NE(physical, std::string::npos);
  EXPECT_EQ(number_at(png, physical + 4), 7874u) << "200 dots an inch, in dots a metre";
  EXPECT_EQ(number_at(png, physical + 8), 7874u);
  const std::string pdf = exported({.format = Format::pdf, .width = 100, .height = 50}, "plot.pdf");
  EXPECT_TRUE(pdf.starts_with("%PDF-"));
  double wide = 0, high = 0;
  const std::size_t box = pdf.find("/MediaBox");
  ASSERT_NE(box, std::string::npos);
  ASSERT_EQ(std::sscanf(pdf.c_str() + box, "/MediaBox [ 0 0 %lf %lf", &wide, &high), 2);
  EXPECT_NEAR(wide, 100 / 25.4 * 72, 1);
  EXPECT_NEAR(high, 50 / 25.4 * 72, 1);
}

TEST_F(AnExport, OfAFigureHasAllPlots) {
  const std::size_t plots = stage().plots.size();
  ASSERT_GT(plots, 1u);
  const std::string svg = exported(
      {.what = What::figure, .format = Format::svg, .width = 120, .height = 60}, "plots.svg");
  for (std::size_t i = 1; i <= plots; ++i) {
    EXPECT_THAT(svg, HasSubstr(fmt::format("<clipPath id=\"area{}\"", i)));
  }
  EXPECT_THAT(svg, HasSubstr(fmt::format("viewBox=\"0 0 {} {}\"", std::lround(120 * 96 / 25.4),
                                         static_cast<long>(plots) * std::lround(60 * 96 / 25.4))));
  const std::string png = exported(
      {.what = What::figure, .format = Format::png, .width = 120, .height = 60, .dpi = 100},
      "plots.png");
  EXPECT_NEAR(static_cast<double>(number_at(png, 20)), static_cast<double>(plots) * 60 / 25.4 * 100,
              3 * static_cast<double>(plots));
  const std::string second = exported({.plot = 1, .format = Format::svg}, "second.svg");
  EXPECT_THAT(second, HasSubstr(stage().plots[1].spec().curves[0].label));
  EXPECT_EQ(second.find("area2"), std::string::npos) << "one alone";
}

TEST_F(AnExport, IsInTheColoursThatWereAsked) {
  const auto ground = [&](Theme theme, const char* name) {
    const std::string svg = exported({.format = Format::svg, .theme = theme}, name);
    const std::size_t at = svg.find("fill=\"#");
    return svg.substr(at + 6, 7);
  };
  const Rgb dark = palette(Theme::dark).panel;
  EXPECT_EQ(ground(Theme::light, "light.svg"), "#ffffff");
  EXPECT_EQ(ground(Theme::dark, "dark.svg"),
            fmt::format("#{:02x}{:02x}{:02x}", dark.r, dark.g, dark.b));
}

TEST_F(AnExport, SaysWhatCannotBeWrittenAndLeavesPicturesOfTheWindowToIt) {
  ExportOrder order{.what = What::table};
  order.file = dir / "none/here.csv";
  desktop->exporter.carry_out(order, stage());
  EXPECT_TRUE(until([&] {
    return std::ranges::any_of(desktop->notices.all(), [](const Notice& each) {
      return each.bad && each.text.find("none/here.csv") != std::string::npos;
    });
  }));
  EXPECT_TRUE(desktop->exporter.written().empty());
  order.what = What::window;
  EXPECT_EQ(desktop->exporter.carry_out(order, stage()), order.file);
  order = {.plot = 1000};
  EXPECT_EQ(desktop->exporter.carry_out(order, stage()), fs::path()) << "there is no such plot";
}

// A banner offers the last file for half a minute.
TEST_F(AnExport, IsOfferedForAWhile) {
  exported({.what = What::table}, "a.csv");
  EXPECT_FALSE(desktop->exporter.written().empty());
  frames(1400);  // 28 s
  EXPECT_FALSE(desktop->exporter.written().empty());
  frames(200);
  EXPECT_TRUE(desktop->exporter.written().empty());
}

}  // namespace
}  // namespace limpid
