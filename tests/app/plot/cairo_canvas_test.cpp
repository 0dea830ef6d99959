// Pixels against known areas, and the picture of a plot against the same at another size.
#include "app/plot/cairo_canvas.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "app/plot/plot_export.h"
#include "app/style/theme.h"
#include "tests/support/computer.h"

namespace limpid {
namespace {

constexpr Rgb kBlack{0, 0, 0}, kWhite{255, 255, 255};
using Point = PlotCanvas::Point;

// Area of black in pixels of the layout; grey ones count in part.
double black(const Raster& raster, double scale) {
  double sum = 0;
  for (std::size_t i = 0; i < raster.rgba.size(); i += 4) sum += 1 - raster.rgba[i] / 255.0;
  return sum / (scale * scale);
}

class Pixels : public testing::TestWithParam<double> {
 protected:
  RasterCanvas canvas{100, 80, GetParam(), kWhite};
  double area() { return black(canvas.take(), GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Scales, Pixels, testing::Values(1.0, 2.0, 3.125));

TEST_P(Pixels, HasTheSizeOfItsLayout) {
  const Raster raster = canvas.take();
  EXPECT_EQ(raster.width, std::lround(100 * GetParam()));
  EXPECT_EQ(raster.height, std::lround(80 * GetParam()));
  EXPECT_EQ(raster.rgba.size(), 4u * static_cast<unsigned>(raster.width * raster.height));
  EXPECT_EQ(black(raster, 1), 0);
}

TEST_P(Pixels, CoversARectangleByItsArea) {
  canvas.rect({10.3, 20.7, 33.4, 11.1}, kBlack, 1);
  EXPECT_NEAR(area(), 33.4 * 11.1, 1);
}

TEST_P(Pixels, CoversATriangleByItsArea) {
  canvas.polygon(std::array{Point{10, 10}, Point{70, 20}, Point{30, 60}}, kBlack, 0);
  EXPECT_NEAR(area(), 0.5 * std::abs(60 * 50 - 20 * 10), 2);
}

TEST_P(Pixels, CoversALineByItsLengthAndWidth) {
  canvas.line({10, 10}, {50, 40}, kBlack, 3, 0, 0);
  EXPECT_NEAR(area(), 50 * 3, 2);
}

TEST_P(Pixels, LeavesTheGapsOfADashedLineFree) {
  canvas.line({10, 40}, {90, 40}, kBlack, 2, 5, 5);
  EXPECT_NEAR(area(), 80 * 2 * 0.5, 2);
}

// A corner is no darker than the rest, for every turn of the line.
TEST_P(Pixels, JoinsALineRoundAndOnce) {
  canvas.polyline(std::array{Point{20, 20}, Point{60, 20}, Point{60, 60}}, kBlack, 4);
  const double ends = std::numbers::pi * 4;  // a half disc of radius 2 at each end
  // Outside, a quarter disc instead of a square.
  const double corner = 4 - std::numbers::pi * 4 / 4;
  EXPECT_NEAR(area(), 80 * 4 + ends - corner, 5);
}

TEST_P(Pixels, DrawsARingByItsRadius) {
  canvas.ring({50, 40}, 20, kBlack, kWhite);
  const double ring = 2 * std::numbers::pi * 20 * 1.8;  // a thin line in pieces: to a twentieth
  EXPECT_NEAR(area(), ring, 0.05 * ring);
}

TEST_P(Pixels, DrawsNothingOutsideOfItsClip) {
  const PlotCanvas::Box clip{20, 20, 30, 30};
  canvas.clip(&clip);
  canvas.rect({0, 0, 100, 80}, kBlack, 1);
  canvas.clip(nullptr);
  EXPECT_NEAR(area(), 900, 60 / GetParam());
}

TEST_P(Pixels, StaysWithinThePictureWhateverIsDrawn) {
  for (const double far : {-1e4, 1e4}) {
    canvas.polyline(std::array{Point{50, 40}, Point{far, far}, Point{-far, far}}, kBlack, 2);
    canvas.rect({far, far, 10, 10}, kBlack, 1);
    canvas.text({far, 40}, PlotCanvas::Anchor::end, kBlack, "far", false);
  }
  const Raster raster = canvas.take();
  EXPECT_EQ(raster.rgba.size(), 4u * static_cast<unsigned>(raster.width * raster.height));
}

TEST_P(Pixels, SetsTextWhereItsAnchorIs) {
  if (!test::has_inter()) GTEST_SKIP() << "Inter is not installed";
  const auto middle_of = [&](PlotCanvas::Anchor anchor) {
    RasterCanvas text(200, 40, GetParam(), kWhite);
    text.text({100, 25}, anchor, kBlack, "ooooo", false);
    const Raster raster = text.take();
    double sum = 0, at = 0;
    for (int y = 0; y < raster.height; ++y) {
      for (int x = 0; x < raster.width; ++x) {
        const double dark = 255 - raster.rgba[4 * static_cast<std::size_t>(y * raster.width + x)];
        sum += dark;
        at += dark * (x + 0.5);
      }
    }
    EXPECT_GT(sum, 0);
    return at / sum / GetParam();
  };
  EXPECT_NEAR(middle_of(PlotCanvas::Anchor::middle), 100, 0.5);
  const double half = middle_of(PlotCanvas::Anchor::start) - 100;
  EXPECT_GT(half, 12) << "five letters of 12 px";
  EXPECT_NEAR(middle_of(PlotCanvas::Anchor::end), 100 - half, 0.5);
}

TEST_P(Pixels, DrawsOnBehindATextThatIsNoUtf8) {
  canvas.text({-500, 0}, PlotCanvas::Anchor::start, kBlack, "\xff\xfe \xc3", false);
  canvas.rect({10, 10, 40, 20}, kBlack, 1);
  EXPECT_NEAR(area(), 800, 1);
}

TEST(PageOfPdf, HasItsSizeInPointsAndSaysWhoMadeIt) {
  PdfCanvas canvas(400, 200, 0.75, kWhite, "limpid, a test");
  canvas.rect({10, 10, 50, 50}, kBlack, 0.5);
  canvas.text({100, 100}, PlotCanvas::Anchor::middle, kBlack, "\xCE\xB7 = 0.5", true);
  const std::string document = canvas.end();
  EXPECT_TRUE(document.starts_with("%PDF-"));
  EXPECT_NE(document.find("%%EOF"), std::string::npos);
  EXPECT_NE(document.find("/MediaBox [ 0 0 300 150 ]"), std::string::npos) << document;
  EXPECT_NE(document.find("(limpid, a test)"), std::string::npos);
}

TEST(PageOfPdf, MayBeLeftUnfinished) {
  PdfCanvas canvas(40, 20, 1, kWhite, "");
  canvas.line({0, 0}, {40, 20}, kBlack, 1, 0, 0);
}

// Both sizes look the same to a person.
TEST(RasterOfAPlot, IsTheSamePictureAtEverySize) {
  History history({.channels = 2, .seconds = 5});
  for (int i = 0; i < 3000; ++i) {
    history.append(0.001 * i, std::array{std::sin(0.004 * i), i < 1500 ? 0.0 : 2.0});
  }
  history.mark_at(1.2, "here", kNoteMark);
  const PlotSpec spec{
      .title = "a wave",
      .y = {.unit = "mrad"},
      .curves = {{.channel = 0, .label = "wave", .ink = Ink::device}},
      .bands = {{.channel = 1, .names = {"standard", "proposed", "predictive"}, .laws = true}}};
  for (const Theme theme : {Theme::dark, Theme::light}) {
    PlotPicture picture{0, 3, {}, {{-1.2, 1.2}}};
    picture.width = 300;
    picture.height = 160;
    picture.theme = theme;
    const Raster once = plot_raster(spec, history, picture, 1);
    const Raster large = plot_raster(spec, history, picture, 4);
    ASSERT_EQ(large.width, 4 * once.width);
    double apart = 0;
    for (int y = 0; y < once.height; ++y) {
      for (int x = 0; x < once.width; ++x) {
        for (std::size_t c = 0; c < 3; ++c) {
          double mean = 0;
          for (int i = 0; i < 16; ++i) {
            const auto at = static_cast<std::size_t>((4 * y + i / 4) * large.width + 4 * x + i % 4);
            mean += large.rgba[4 * at + c] / 16.0;
          }
          const auto at = static_cast<std::size_t>(y * once.width + x);
          apart += std::abs(mean - once.rgba[4 * at + c]);
        }
      }
    }
    EXPECT_LT(apart / (3 * once.width * once.height), 2) << "of 255";
    // The colours of the curve and the paper occur.
    const Rgb wave = ink(palette(theme), Ink::device);
    int found = 0;
    for (std::size_t i = 0; i < large.rgba.size(); i += 4) {
      found += Rgb{large.rgba[i], large.rgba[i + 1], large.rgba[i + 2]} == wave ? 1 : 0;
    }
    EXPECT_GT(found, 500);
  }
}

}  // namespace
}  // namespace limpid
