#include "app/plot/plot_export.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/utf8.h"

namespace limpid {
namespace {

History two_channels() {
  History history({.channels = 2, .seconds = 5});
  for (int i = 0; i < 3000; ++i) {
    history.append(i * 0.001, std::array{0.001 * i, i == 1 ? std::nan("") : -2.0});
  }
  history.mark(1.5, "eta < 0.6 & \"more\"");
  return history;
}

PlotSpec spec() {
  return {.title = "Error <|x_E|>",
          .y = {.unit = "mrad", .factor = 1000},
          .curves = {{.channel = 0, .label = "joint 1"},
                     {.channel = 1, .label = "joint 2, \"other\""},
                     {.channel = 1, .label = "hidden", .visible = false}},
          .thresholds = {{1.5, "limit"}}};
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> all;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) all.push_back(line);
  return all;
}

// Expects every tag closed in order and no stray < or &; this catches forgotten escaping.
void expect_well_formed(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t at = 0; (at = xml.find_first_of("<&", at)) != std::string::npos; ++at) {
    if (xml[at] == '&') {
      const std::string entity = xml.substr(at, xml.find(';', at) - at + 1);
      EXPECT_TRUE(entity == "&amp;" || entity == "&lt;" || entity == "&gt;" || entity == "&quot;")
          << entity;
      continue;
    }
    const std::size_t end = xml.find('>', at);
    ASSERT_NE(end, std::string::npos);
    const std::string tag = xml.substr(at + 1, end - at - 1);
    EXPECT_EQ(tag.find('<'), std::string::npos) << tag;
    if (tag.front() == '?' || tag.back() == '/') continue;
    if (tag.front() == '/') {
      ASSERT_FALSE(open.empty());
      EXPECT_EQ(open.back(), tag.substr(1));
      open.pop_back();
    } else {
      open.push_back(tag.substr(0, tag.find_first_of(" \n")));
    }
  }
  EXPECT_TRUE(open.empty());
}

TEST(PlotCsv, HasAHeaderWithUnitsAndOneLineForEachRow) {
  const auto all = lines(csv_text(plot_table(spec(), two_channels(), 1.0, 1.002)));
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all[0], "time [s],joint 1 [mrad],\"joint 2, \"\"other\"\" [mrad]\"");
  EXPECT_EQ(all[1], "1.000000,1000,-2000");
  EXPECT_EQ(all[3], "1.002000,1002,-2000");
}

TEST(PlotCsv, LeavesMissingValuesEmpty) {
  const auto all = lines(csv_text(plot_table(spec(), two_channels(), 0, 0.002)));
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all[2], "0.001000,1,");
}

TEST(PlotCsv, HasWhatIsAlongTheOtherAxisBeforeTheCurve) {
  PlotSpec cross = spec();
  cross.kind = PlotKind::cross;
  cross.x = {.label = "torque", .unit = "N m"};
  cross.curves = {{.channel = 1, .across = 0, .label = "a"},
                  {.channel = 0, .across = 0, .label = "b"},
                  {.channel = 0, .across = 1, .label = "twin a"}};
  const auto all = lines(csv_text(plot_table(cross, two_channels(), 2, 2.001)));
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0], "time [s],torque [N m],a [mrad],b [mrad],torque (twin a) [N m],twin a [mrad]");
  EXPECT_EQ(all[2], "2.001000,2.001,-2000,2001,-2,2001");
}

// A ramp's amplitudes are known only roughly; its frequencies are those of a second.
TEST(PlotCsv, OfASpectrumHasFrequencies) {
  PlotSpec spectrum = spec();
  spectrum.kind = PlotKind::spectrum;
  const auto all = lines(csv_text(plot_table(spectrum, two_channels(), 1, 2)));
  EXPECT_EQ(all[0], "frequency [Hz],joint 1 [mrad],\"joint 2, \"\"other\"\" [mrad]\"");
  ASSERT_EQ(all.size(), 1 + 251u);
  EXPECT_TRUE(all[2].starts_with("2.000000,")) << all[2];
  EXPECT_TRUE(all.back().starts_with("500.000000,")) << all.back();
  EXPECT_TRUE(all[10].ends_with(",0")) << "the second channel stands still: " << all[10];
}

TEST(PlotSvg, IsWellFormedWhateverTheLabelsSay) {
  const PlotPicture whole{0, 3, {}, {{-3, 3}}};
  expect_well_formed(plot_svg(spec(), two_channels(), whole));
  const PlotPicture close{1.0, 1.1, {}, {{-3, 3}}};
  expect_well_formed(plot_svg(spec(), two_channels(), close));
}

TEST(PlotSvg, DrawsBandsFromAfarAndLinesFromClose) {
  const std::string far = plot_svg(spec(), two_channels(), {0, 3, {}, {{-3, 3}}});
  EXPECT_NE(far.find("<polygon"), std::string::npos);
  EXPECT_EQ(far.find("<polyline"), std::string::npos);
  const std::string close = plot_svg(spec(), two_channels(), {1.0, 1.1, {}, {{-3, 3}}});
  EXPECT_NE(close.find("<polyline"), std::string::npos);
}

TEST(PlotSvg, StripesWhatABandMarksFromWhereToWhere) {
  History history({.channels = 2, .seconds = 5});
  for (int i = 0; i < 3000; ++i) {
    history.append(i * 0.001, std::array{0.0, i >= 1000 && i < 2000 ? 1.0 : 0.0});
  }
  PlotSpec marked = spec();
  marked.bands = {{.channel = 1, .names = {"", "force off: <why>"}, .striped = true}};
  const std::string svg = plot_svg(marked, history, {0, 3, {}, {{-3, 3}}});
  expect_well_formed(svg);
  EXPECT_NE(svg.find("force off: &lt;why&gt;"), std::string::npos);
  // The clip path's rectangle is the curves' area; a third in the middle is marked.
  double left = 0, width = 0, from = 0, wide = 0, other = 0;
  const auto number = [&](std::size_t at, const char* format, auto*... into) {
    ASSERT_NE(at, std::string::npos);
    ASSERT_GT(std::sscanf(svg.c_str() + at, format, into...), 0);
  };
  number(svg.find("<rect x", svg.find("clipPath")), "<rect x=\"%lf\" y=\"%lf\" width=\"%lf\"",
         &left, &other, &width);
  const std::size_t filled = svg.find("fill=\"url(#stripes)\"");
  number(svg.rfind("<rect x", filled), "<rect x=\"%lf\" y=\"%lf\" width=\"%lf\"", &from, &other,
         &wide);
  EXPECT_NEAR(from, left + width / 3, 2);
  EXPECT_NEAR(wide, width / 3, 2);
  marked.bands[0].channel = 0;
  EXPECT_EQ(plot_svg(marked, history, {0, 3, {}, {{-3, 3}}}).find("url(#stripes)"),
            std::string::npos);
}

// A printed curve has the colours of the laws that made it, none of a law that did not.
TEST(PlotSvg, DrawsPartsInTheColoursOfTheirLaws) {
  History history({.channels = 2, .seconds = 5});
  for (int i = 0; i < 2000; ++i) {
    history.append(i * 0.001, std::array{0.001 * i, i < 1000 ? 0.0 : 1.0});
  }
  PlotSpec spec{.title = "error",
                .curves = {{.channel = 0, .label = "now predictive", .law = 2, .law_channel = 1}}};
  const std::string svg = plot_svg(spec, history, {0, 2, {}, {{0, 2}}});
  const auto drawn = [&](int law) {
    const Rgb c = law_ink(kLightPalette, law);
    const std::string begins = fmt::format("<polygon fill=\"#{:02x}{:02x}{:02x}\"", c.r, c.g, c.b);
    std::size_t count = 0;
    for (std::size_t at = 0; (at = svg.find(begins, at)) != std::string::npos; ++at) ++count;
    return count;
  };
  EXPECT_EQ(drawn(0), 1u);
  EXPECT_EQ(drawn(1), 1u);
  EXPECT_EQ(drawn(2), 0u);
}

TEST(PlotSvg, SaysALawInTheLegendAndNotInTables) {
  PlotSpec of_tank = spec();
  of_tank.curves[0].law_name = "tank";
  const std::string svg = plot_svg(of_tank, two_channels(), {0, 3, {}, {{-3, 3}}});
  EXPECT_NE(svg.find(">tank joint 1</text>"), std::string::npos);
  EXPECT_EQ(plot_table(of_tank, two_channels(), 0, 3).columns.front(), "joint 1 [mrad]");
}

// Two plots stand below one another, each with its own title, axes and clipped curves.
TEST(PlotSvg, OfAFigureHasAllPlotsBelowOneAnother) {
  PlotSpec other = spec();
  other.title = "Energy";
  const PlotPicture picture{0, 3, {}, {{-3, 3}}, 400, 200};
  const std::array parts{FigurePart{spec(), picture}, FigurePart{other, picture}};
  const std::string svg = figure_svg(parts, two_channels());
  expect_well_formed(svg);
  EXPECT_NE(svg.find("viewBox=\"0 0 400 400\""), std::string::npos);
  const std::string one = plot_svg(spec(), two_channels(), picture);
  const auto count = [](const std::string& text, const char* what) {
    std::size_t all = 0;
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; ++at) ++all;
    return all;
  };
  EXPECT_EQ(count(svg, "<polygon"), 2 * count(one, "<polygon"));
  EXPECT_EQ(count(svg, "<clipPath id=\"area1\""), 1u);
  EXPECT_EQ(count(svg, "<clipPath id=\"area2\""), 1u);
  double first = 0, second = 0;
  ASSERT_EQ(std::sscanf(svg.c_str() + svg.rfind("<text", svg.find("Error")),
                        "<text x=\"%*f\" y=\"%lf\"", &first),
            1);
  ASSERT_EQ(std::sscanf(svg.c_str() + svg.rfind("<text", svg.find("Energy")),
                        "<text x=\"%*f\" y=\"%lf\"", &second),
            1);
  EXPECT_EQ(second - first, 200);
}

TEST(PlotSvg, LeavesHiddenCurvesOut) {
  const std::string svg = plot_svg(spec(), two_channels(), {0, 3, {}, {{-3, 3}}});
  EXPECT_EQ(svg.find("hidden"), std::string::npos);
  EXPECT_NE(svg.find("joint 1"), std::string::npos);
}

TEST(PlotSvg, OfOtherKindsIsWellFormedAndHasBothAxes) {
  PlotSpec other = spec();
  other.x = {.label = "torque <f2>", .unit = "N m"};
  other.curves.front().across = 1;
  other.curves.resize(1);
  other.kind = PlotKind::cross;
  const std::string cross = plot_svg(other, two_channels(), {0, 3, {{-3, 3}}, {{0, 3}}});
  expect_well_formed(cross);
  EXPECT_NE(cross.find("torque &lt;f2&gt;  [N m]"), std::string::npos);
  EXPECT_NE(cross.find("<polyline"), std::string::npos);
  other.kind = PlotKind::spectrum;
  other.x = {.label = "frequency", .unit = "Hz", .log = true};
  other.y.log = true;
  const std::string spectrum =
      plot_svg(other, two_channels(), {0, 3, {{-1, 2.7}, true}, {{-6, 0}, true}});
  expect_well_formed(spectrum);
  EXPECT_NE(spectrum.find(">100<"), std::string::npos) << "hertz";
  EXPECT_NE(spectrum.find("<polyline"), std::string::npos);
}

TEST(PlotSvg, OfAnEmptyHistoryIsStillAPicture) {
  expect_well_formed(plot_svg(spec(), History({.channels = 2}), {0, 10, {}, {{-1, 1}}}));
}

// With two runs in one history the times are the second one's, as on its axis.
TEST(PlotCsv, HasTheTimesOfTheNewestRun) {
  History history({.channels = 2, .seconds = 5});
  for (const double value : {1.0, 2.0}) {
    for (int i = 0; i < 1000; ++i) history.append(i * 0.001, std::array{value, 0.001 * i});
  }
  const double began = history.time(1000);
  const auto all = lines(csv_text(plot_table(spec(), history, began + 0.5, began + 0.5005)));
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[1], "0.500000,2000,500");
}

// The band's outline follows the highest values forwards and the lowest ones backwards.
TEST(PlotSvg, DrawsABandFromTheHighestToTheLowestOfEachColumn) {
  History history({.channels = 1, .seconds = 30});
  for (int i = 0; i < 20000; ++i) history.append(i * 0.001, std::array{i % 2 == 0 ? 1.0 : -2.0});
  PlotSpec one;
  one.curves = {{.channel = 0, .label = "a"}};
  const PlotPicture picture{2, 18, {}, {{-4, 4}}};
  const std::string svg = plot_svg(one, history, picture);
  const std::size_t polygon = svg.find("<polygon"), begin = svg.find("points=\"", polygon) + 8;
  ASSERT_NE(polygon, std::string::npos);
  std::istringstream in(svg.substr(begin, svg.find('"', begin) - begin));
  std::vector<std::array<double, 2>> points;
  char comma = 0;
  for (double x = 0, y = 0; in >> x >> comma >> y;) points.push_back({x, y});
  ASSERT_GT(points.size(), 1000u);
  ASSERT_EQ(points.size() % 2, 0u);
  // The axis reaches from -4 to 4 between the frame's edges: 1 is at 3/8 of it, -2 at 3/4.
  const std::string area = svg.substr(svg.find("<clipPath"));
  const auto number = [&](const std::string& key) {
    return std::stod(area.substr(area.find(" " + key + "=\"") + key.size() + 3));
  };
  const double top = number("y"), height = number("height");
  const std::size_t half = points.size() / 2;
  for (std::size_t i = 0; i < half; ++i) {
    EXPECT_NEAR(points[i][1], top + height * 3 / 8, 0.02) << i;
    EXPECT_NEAR(points[half + i][1], top + height * 3 / 4, 0.02) << i;
    EXPECT_EQ(points[i][0], points[points.size() - 1 - i][0]) << i;
    if (i > 0) {
      EXPECT_GT(points[i][0], points[i - 1][0]);
    }
  }
  EXPECT_LT(points[half - 1][0] - number("x") - number("width"), 2);
}

// A text's place, from where it begins; its height is that of a line.
struct TextPlace {
  std::string text;
  double left = 0, right = 0, base = 0;
};

std::vector<TextPlace> places_of(const std::string& svg, const std::vector<std::string>& texts) {
  const std::regex pattern(
      R"re(<text x="([-0-9.]+)" y="([-0-9.]+)" text-anchor="(start|end)"[^>]*>([^<]*)</text>)re");
  std::vector<TextPlace> found;
  for (std::sregex_iterator it(svg.begin(), svg.end(), pattern), end; it != end; ++it) {
    const std::string text = (*it)[4];
    if (std::ranges::find(texts, text) == texts.end()) continue;
    const double wide = 0.55 * 12 * static_cast<double>(text.size()), x = std::stod((*it)[1]);
    const double left = (*it)[3] == "end" ? x - wide : x;
    found.push_back({text, left, left + wide, std::stod((*it)[2])});
  }
  return found;
}

TEST(PlotSvg, HasNoLabelOnAnotherOneNorBeyondTheArea) {
  History history = two_channels();
  history.mark(1.502, "stiffness 400", "stiffness");
  history.mark(1.51, "stiffness 700", "stiffness 2");
  history.mark(2.95, "law: proposed", "law");
  PlotSpec with = spec();
  with.curves.resize(1);
  with.thresholds = {{1.5, "a limit"}, {1.52, "another limit"}, {0.05, "near the ground"}};
  const std::vector<std::string> texts{"stiffness 400", "stiffness 700", "law: proposed",
                                       "a limit",       "another limit", "near the ground"};
  const PlotPicture picture{0, 3, {}, {{0, 3}}};
  const auto places = places_of(plot_svg(with, history, picture), texts);
  ASSERT_EQ(places.size(), texts.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_LE(places[i].right, picture.width - 14) << places[i].text;
    for (std::size_t k = 0; k < i; ++k) {
      const bool apart = places[i].right <= places[k].left || places[k].right <= places[i].left ||
                         std::abs(places[i].base - places[k].base) >= 12;
      EXPECT_TRUE(apart) << places[i].text << " lies on " << places[k].text;
    }
  }
}

// A plot with as many curves as labels, over time or over another channel.
PlotSpec with_legend(const std::vector<std::string>& labels, PlotKind kind) {
  PlotSpec spec{.title = "Energy", .kind = kind, .y = {.unit = "J"}};
  spec.x = {.label = "human and contact torque", .unit = "N m"};
  for (const std::string& label : labels) {
    spec.curves.push_back(
        {.channel = 0, .across = kind == PlotKind::cross ? 1 : -1, .label = label});
  }
  return spec;
}

double lower_edge_of_area(const std::string& svg) {
  double top = 0, height = 0;
  const std::string area = svg.substr(svg.find("<clipPath"));
  EXPECT_EQ(std::sscanf(area.c_str(),
                        "<clipPath id=\"area1\"><rect x=\"%*f\" y=\"%lf\" width=\"%*f\" "
                        "height=\"%lf\"",
                        &top, &height),
            2);
  return top + height;
}

// Expects the legend's texts within the picture, beside one another, and under the area's times.
void expect_room(const std::vector<TextPlace>& places, const std::string& svg,
                 const PlotPicture& picture) {
  for (const TextPlace& each : places) {
    EXPECT_LE(each.right, picture.width) << each.text;
    EXPECT_LE(each.base, picture.height - 4) << each.text;
    EXPECT_GE(each.base - 12, lower_edge_of_area(svg) + 16) << each.text;
    for (const TextPlace& other : places) {
      if (&other == &each || other.base != each.base || other.left < each.left) continue;
      EXPECT_GE(other.left - 23, each.right) << other.text << " or its sample lies on it";
    }
  }
}

TEST(PlotSvg, HasAllOfItsLegendInRowsWithinThePicture) {
  const PlotPicture picture{0, 3, {{-3, 3}}, {{-3, 3}}};
  for (const PlotKind kind : {PlotKind::time, PlotKind::cross}) {
    for (const int count : {1, 2, 3, 9}) {
      std::vector<std::string> texts;
      for (int i = 1; i <= count; ++i) {
        texts.push_back(fmt::format("re-run: predictive, controller energy {}", i));
      }
      const std::string svg = plot_svg(with_legend(texts, kind), two_channels(), picture);
      if (kind == PlotKind::cross) texts.emplace_back("human and contact torque  [N m]");
      const auto places = places_of(svg, texts);
      ASSERT_EQ(places.size(), texts.size()) << count;
      expect_room(places, svg, picture);
    }
  }
}

TEST(PlotSvg, ShortensWhatIsWiderThanARowOfItsLegend) {
  std::string label = "recorded:";
  for (int i = 0; i < 30; ++i) label += " \u03b7 = 2";  // a letter of two bytes
  const PlotPicture picture{0, 3, {{-3, 3}}, {{-3, 3}}};
  const std::string svg =
      plot_svg(with_legend({label, "re-run"}, PlotKind::time), two_channels(), picture);
  EXPECT_EQ(svg.find(label), std::string::npos);
  const std::size_t begin = svg.find("recorded:"), end = svg.find('<', begin);
  ASSERT_NE(begin, std::string::npos);
  const std::string shown = svg.substr(begin, end - begin);
  EXPECT_TRUE(shown.ends_with("\u2026")) << shown;
  EXPECT_TRUE(label.starts_with(shown.substr(0, shown.size() - 3))) << shown;
  const double right = 56 + 23 + 0.6 * 12 * static_cast<double>(count_characters(shown));
  EXPECT_LE(right, picture.width - 14);
  EXPECT_GT(right, picture.width - 14 - 12) << "it takes the whole row";
  EXPECT_EQ(places_of(svg, {"re-run"}).size(), 1u);
}

// A low picture keeps room for its curves, and says how many names had none.
TEST(PlotSvg, CountsWhatItsLegendHasNoRoomFor) {
  const PlotPicture picture{0, 3, {{-3, 3}}, {{-3, 3}}, 720, 200};
  std::vector<std::string> texts;
  for (int i = 1; i <= 30; ++i) {
    texts.push_back(fmt::format("re-run: predictive, controller energy {}", i));
  }
  for (const PlotKind kind : {PlotKind::time, PlotKind::cross}) {
    const std::string svg = plot_svg(with_legend(texts, kind), two_channels(), picture);
    EXPECT_GE(lower_edge_of_area(svg), 32 + 40);
    std::vector<std::string> all = texts;
    const std::size_t shown = places_of(svg, texts).size();
    EXPECT_GT(shown, 5u);
    all.push_back(fmt::format("and {} more", 30 - shown));
    all.emplace_back("human and contact torque  [N m]");
    const auto places = places_of(svg, all);
    EXPECT_EQ(places.size(), shown + (kind == PlotKind::cross ? 2 : 1));
    expect_room(places, svg, picture);
  }
}

}  // namespace
}  // namespace limpid
