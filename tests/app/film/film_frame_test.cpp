// Pictures of a video, read back from their pixels. Skipped where EGL gives no context.
#include <gtest/gtest.h>

#include <optional>

#include "app/base/folders.h"
#include "app/film/session_film.h"
#include "devices/files/urdf_file.h"
#include "tests/support/computer.h"
#include "tests/support/faultless_context.h"

namespace limpid {
namespace {

constexpr double kTick = 0.01, kShown = 2.0;  // [s]

struct Picture {
  int width, height;
  std::vector<unsigned char> rgba;

  Rgb at(int x, int y) const {
    const auto i = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                        static_cast<std::size_t>(x));
    return {rgba[i], rgba[i + 1], rgba[i + 2]};
  }
};

// A row with the device 20 mrad ahead of the proxy, in the proposed coupling.
std::vector<double> row_at(const RowLayout& layout, double time) {
  std::vector<double> row(static_cast<std::size_t>(layout.stride()), 0.0);
  const auto put = [&](Column column, double value) {
    layout.in(std::span<double>(row), column)[0] = value;
  };
  put(Column::time, time);
  put(Column::kind, 1);
  put(Column::device_position, 0.02);
  return row;
}

class FilmFrames : public testing::Test {
 protected:
  void begin(FilmLook look) {
    look_ = look;
    if (!test::has_offscreen_pictures()) GTEST_SKIP() << "no EGL here";
    frame_.emplace(look);
    History history({.channels = 2 * TraceChannels(layout_).count(), .seconds = 10, .tick = kTick});
    stage_ = std::make_unique<Stage>(read_urdf(default_device()), SceneDocument{}, MeshModels{},
                                     std::move(history), kShown);
    camera_.reset(stage_->picture.bounds());
    camera_.finish();
  }
  void TearDown() override {
    if (frame_) test::expect_no_gl_error();
  }
  Picture draw_at(double time) {
    for (; next_ * kTick <= time; ++next_) stage_->append(row_at(layout_, next_ * kTick));
    const ViewState view = stage_->rows().view(layout_, row_at(layout_, time));
    return {look_.width, look_.height,
            frame_->draw(*stage_, view, camera_, {.time = "1.00 s", .text = {}, .aside = {}}, 0.1)};
  }

  Picture draw_beside(const std::vector<double>& row, const std::vector<double>& other,
                      const std::string& told = {}) {
    const ViewState view = stage_->rows().view(layout_, row);
    const ImVec2 size = frame_->viewport(2);
    camera_.resize(size.x, size.y);
    stage_->name_runs({{"a", "a"}, true});
    return {
        look_.width, look_.height,
        frame_->draw(*stage_, view, camera_, {.time = {}, .text = {}, .aside = {}, .told = told},
                     0.1, {stage_->rows().view(layout_, other)})};
  }

  const RowLayout layout_{3};
  FilmLook look_;
  std::optional<FilmFrame> frame_;
  std::unique_ptr<Stage> stage_;
  Camera camera_;
  int next_ = 0;
};

// First and last column of the first plot's curve, below its title and legend, left of the next
// plot.
std::pair<int, int> curve_ends(const Picture& picture) {
  const Rgb ink = limpid::ink(kDarkPalette, Ink::proxy);
  int first = picture.width, last = -1;
  for (int y = picture.height * 2 / 3 + 40; y < picture.height; ++y) {
    for (int x = 0; x < picture.width / 3 - 10; ++x) {
      const Rgb seen = picture.at(x, y);
      const int off =
          std::abs(seen.r - ink.r) + std::abs(seen.g - ink.g) + std::abs(seen.b - ink.b);
      if (off > 60) continue;
      first = std::min(first, x);
      last = std::max(last, x);
    }
  }
  return {first, last};
}

TEST_F(FilmFrames, HaveCurvesThatEndAtThePresent) {
  ASSERT_NO_FATAL_FAILURE(begin({}));
  if (!frame_) return;
  const auto [from, half] = curve_ends(draw_at(0.5 * kShown));
  const auto [same, whole] = curve_ends(draw_at(kShown));
  ASSERT_GT(whole, from + 200) << "there is no curve";
  EXPECT_EQ(from, same);
  EXPECT_NEAR(static_cast<double>(half - from) / (whole - from), 0.5, 0.02);
}

// Number of pixels of the sign's colour in the upper part of the picture.
int sign_pixels(const Picture& picture) {
  int count = 0;
  for (int y = 0; y < picture.height / 5; ++y) {
    for (int x = picture.width / 4; x < picture.width * 3 / 4; ++x) {
      count += picture.at(x, y) == kDarkPalette.accent ? 1 : 0;
    }
  }
  return count;
}

TEST_F(FilmFrames, SayOverThePictureWhatMustNotBeMissed) {
  ASSERT_NO_FATAL_FAILURE(begin({}));
  if (!frame_) return;
  const ViewState view = stage_->rows().view(layout_, row_at(layout_, 0));
  const auto with = [&](const std::string& sign) {
    FilmCaption caption;
    caption.sign = sign;
    return Picture{look_.width, look_.height, frame_->draw(*stage_, view, camera_, caption, 0.1)};
  };
  const int without = sign_pixels(with(""));
  EXPECT_GT(sign_pixels(with("force off: not armed")), without + 1000);
}

TEST_F(FilmFrames, KeepNoCurvesInTheLegendThatNobodyCanSwitchOn) {
  ASSERT_NO_FATAL_FAILURE(begin({}));
  if (!frame_) return;
  draw_at(0.1);
  for (const Plot& plot : stage_->plots) {
    EXPECT_FALSE(plot.spec().curves.empty());
    for (const Curve& curve : plot.spec().curves) EXPECT_TRUE(curve.visible) << curve.label;
  }
}

TEST_F(FilmFrames, WithoutPlotsAreThePictureDownToTheEdge) {
  ASSERT_NO_FATAL_FAILURE(begin({.plots = false}));
  if (!frame_) return;
  const Picture picture = draw_at(0.1);
  EXPECT_NE(picture.at(8, picture.height - 8), kDarkPalette.panel);
  EXPECT_EQ(picture.at(4, 4), kDarkPalette.panel) << "the caption's background";
}

TEST_F(FilmFrames, WithPlotsHaveTheirPanelBelow) {
  ASSERT_NO_FATAL_FAILURE(begin({}));
  if (!frame_) return;
  const Picture picture = draw_at(0.1);
  EXPECT_EQ(picture.at(8, picture.height - 8), kDarkPalette.panel);
}

TEST_F(FilmFrames, LeaveThePlotsOutWhereThereIsNoRoom) {
  ASSERT_NO_FATAL_FAILURE(begin({.width = 240, .height = 160}));
  if (!frame_) return;
  const Picture picture = draw_at(0.1);
  EXPECT_NE(picture.at(8, picture.height - 8), kDarkPalette.panel);
}

// Number of pixels below the legend that differ between the left half and the right one.
int differing(const Picture& picture) {
  const int half = picture.width / 2, left = half - 1, right = half + 1;
  int count = 0;
  for (int y = 130; y < picture.height - 100; ++y) {
    for (int x = 0; x < left - 1; ++x) {
      const Rgb a = picture.at(x, y), b = picture.at(right + x, y);
      if (std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b) > 30) ++count;
    }
  }
  return count;
}

TEST_F(FilmFrames, ShowTwoRunsInHalvesThroughOneCamera) {
  ASSERT_NO_FATAL_FAILURE(begin({.plots = false}));
  if (!frame_) return;
  const std::vector<double> row = row_at(layout_, 0);
  std::vector<double> turned = row;
  layout_.in(std::span<double>(turned), Column::proxy_position)[0] = 0.3;
  EXPECT_LT(differing(draw_beside(row, row)), 200);
  EXPECT_GT(differing(draw_beside(row, turned)), 2000);
}

TEST_F(FilmFrames, ShowTwoRunsInOnePictureWhereThatIsAskedFor) {
  ASSERT_NO_FATAL_FAILURE(begin({.plots = false, .overlaid = true}));
  if (!frame_) return;
  EXPECT_EQ(frame_->viewport(2).x, frame_->viewport(1).x);
  const std::vector<double> row = row_at(layout_, 0);
  std::vector<double> turned = row;
  layout_.in(std::span<double>(turned), Column::proxy_position)[0] = 0.6;
  const Picture same = draw_beside(row, row), apart = draw_beside(row, turned);
  EXPECT_NE(same.rgba, apart.rgba);
  const int border = look_.width / 2, high = look_.height / 4;
  EXPECT_EQ(apart.at(border, high), apart.at(border + 4, high)) << "nothing between halves";
}

TEST_F(FilmFrames, TellTheirSentenceAtTheBottomOfThePicture) {
  ASSERT_NO_FATAL_FAILURE(begin({.plots = false}));
  if (!frame_) return;
  const std::vector<double> row = row_at(layout_, 0);
  const auto bright = [&](const Picture& picture) {
    int count = 0;
    for (int y = picture.height - 60; y < picture.height; ++y) {
      for (int x = picture.width / 3; x < picture.width * 2 / 3; ++x) {
        const Rgb seen = picture.at(x, y);
        if (seen.r > 170 && seen.g > 170 && seen.b > 170) ++count;
      }
    }
    return count;
  };
  const int without = bright(draw_beside(row, row));
  EXPECT_GT(bright(draw_beside(row, row, "Something that is told.")), without + 200);
}

}  // namespace
}  // namespace limpid
