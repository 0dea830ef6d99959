#include "app/film/session_film.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace limpid {
namespace {

// A session of 2 s without motion.
Session two_seconds() {
  Session session;
  session.info.tick = 0.001;
  session.rows.resize(2000 * static_cast<std::size_t>(session.layout.stride()));
  return session;
}

FilmCut cut_of(const FilmOrder& order) { return cut(order, two_seconds(), "a.h5"); }

TEST(FilmCuts, HaveAsManyPicturesAsDurationTimesRate) {
  EXPECT_EQ(cut_of({.out = "a.mp4", .fps = 25}).pictures(), 50u);
  EXPECT_EQ(cut_of({.out = "a.mp4", .fps = 25, .speed = 0.5}).pictures(), 100u);
  EXPECT_EQ(cut_of({.out = "a.mp4", .fps = 25, .speed = 5}).pictures(), 10u);
  EXPECT_EQ(cut_of({.out = "a.mp4", .fps = 10, .from = 0.5, .to = 1.7}).pictures(), 12u);
  EXPECT_EQ(cut_of({.out = "a.mp4", .fps = 1, .from = 1, .to = 1.001}).pictures(), 1u);
}

TEST(FilmCuts, PassThroughTheSessionEvenlyAndStayInIt) {
  const FilmCut cut = cut_of({.out = "a.mp4", .fps = 20, .from = 0.4, .to = 1.9, .speed = 0.3});
  EXPECT_EQ(cut.time(0), 0.4);
  for (std::size_t i = 1; i < cut.pictures(); ++i) {
    EXPECT_NEAR(cut.time(i) - cut.time(i - 1), 0.3 / 20, 1e-12);
    EXPECT_LE(cut.time(i), 1.9);
  }
  EXPECT_NEAR(cut.time(cut.pictures() - 1), 1.9, 0.3 / 20 + 1e-12);
}

TEST(FilmCuts, TakeTheRateThatIsUsualForTheFileUnlessItIsSaid) {
  EXPECT_EQ(cut_of({.out = "a.mp4"}).fps, 30);
  EXPECT_EQ(cut_of({.out = "a.GIF"}).fps, 15);
  EXPECT_EQ(cut_of({.out = "a.gif", .fps = 5}).fps, 5);
}

TEST(FilmCuts, RefuseTimesThatAreNotInTheSession) {
  const auto refused = [](double from, std::optional<double> to) {
    EXPECT_THROW(cut_of({.out = "a.mp4", .from = from, .to = to}), FileError)
        << from << " " << to.value_or(-1);
  };
  refused(-0.1, {});
  refused(2, {});
  refused(1, 1);
  refused(1, 0.5);
  refused(0, 2.001);
  refused(std::numeric_limits<double>::quiet_NaN(), {});
  refused(0, std::numeric_limits<double>::quiet_NaN());
  EXPECT_NO_THROW(cut_of({.out = "a.mp4", .from = 0, .to = 2}));
  EXPECT_THROW(cut({.out = "a.mp4"}, Session{}, "a.h5"), FileError);
}

}  // namespace
}  // namespace limpid
