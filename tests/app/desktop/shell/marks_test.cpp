// Marks that a person sets, changes and removes, and where they are kept.
#include <fmt/format.h>

#include <cmath>

#include "app/desktop/shell/marking.h"
#include "devices/files/session/session_file.h"
#include "tests/app/desktop/shell/a_desktop.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

struct AMark : ADesktop {
  Marking& marking() const { return desktop->marking; }
  const History& history() const { return desktop->live.stage().history; }
  // The mouse is at a time of the plots.
  void hover(double time) const { desktop->shown.stage().group.hover(time); }
  std::string offered() const {
    marking().begin();
    return marking().when();
  }
  void play() {
    file = dir / "mine.h5";
    fs::copy_file(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5", file);
    write_marks(file, {}, read_session(file).marks);
    desktop->playback.open(file);
    ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
    player().pause();
    ASSERT_TRUE(desktop->playback.shown()->marks().empty());
  }
  Player& player() const { return desktop->playback.shown()->player(); }
  double tick() const { return player().session().info.tick; }
  // The marks that are shown, as "text at tick", once the file has them, too.
  std::vector<std::string> marks() {
    const std::vector<Mark>& shown = desktop->playback.shown()->marks();
    EXPECT_TRUE(until([&] {
      try {
        const std::vector<Mark> kept = read_session(file).marks;
        return std::ranges::equal(kept, shown, [](const Mark& a, const Mark& b) {
          return a.tick == b.tick && a.text == b.text;
        });
      } catch (const FileError&) {  // another process is writing
        return false;
      }
    })) << "the file has others";
    std::vector<std::string> all;
    for (const Mark& mark : shown) all.push_back(fmt::format("{} at {}", mark.text, mark.tick));
    return all;
  }
  void set(std::uint64_t at, const std::string& text) {
    player().seek(static_cast<double>(at) * tick());
    marking().begin();
    marking().accept(text);
    frames(2);
  }

  fs::path file;
};

TEST_F(AMark, UnderTheMouseIsInTheRecordingIfThatHadBegun) {
  frames(30);
  EXPECT_EQ(desktop->dialog.name(), "");
  const double before = history().end_time() - 0.1;
  record_something();
  frames(10);
  const double under = history().end_time() - 0.05;
  hover(under);
  const double time = history().time(history().nearest(under)) - history().offset();
  EXPECT_EQ(offered(), fmt::format("at {:.3f} s; kept in the recording", time));
  EXPECT_EQ(desktop->dialog.name(), "mark");
  EXPECT_EQ(marking().text(), "mark 1");
  EXPECT_FALSE(marking().there());
  marking().accept("under the mouse");
  frames(2);
  hover(before);
  EXPECT_EQ(offered(), fmt::format("at {:.3f} s; only in the plots (no recording)",
                                   history().time(history().nearest(before)) - history().offset()));
  marking().accept("before it began");
  EXPECT_FALSE(said("The recording has ended"));
  frames(2);
  desktop->world.toggle_recording();
  ASSERT_TRUE(until([&] { return said("Recorded "); }));
  const Session session = read_session(recordings().at(0));
  ASSERT_EQ(session.marks.size(), 1u);
  EXPECT_EQ(session.marks[0].text, "under the mouse");
  EXPECT_NEAR(session.at(session.marks[0].tick, Column::time)[0], time, 0.6 * session.info.tick);
}

TEST_F(AMark, StandsWhereTheMouseIsOrElseWhereThePlayerIs) {
  play();
  player().seek(0.75);
  EXPECT_EQ(offered(), "at 0.750 s; kept in mine.h5");
  const double start = desktop->shown.stage().history.offset();
  hover(start + 0.5004);
  EXPECT_EQ(offered(), "at 0.500 s; kept in mine.h5");
  hover(start - 1);
  EXPECT_EQ(offered(), "at 0.000 s; kept in mine.h5");
  hover(start + 1e6);
  const auto last = static_cast<double>(player().session().size() - 1);
  EXPECT_EQ(offered(), fmt::format("at {:.3f} s; kept in mine.h5", last * tick()));
}

TEST_F(AMark, OfARecordingIsSetChangedRemovedUndoneAndRedone) {
  play();
  EXPECT_FALSE(marking().can_undo() || marking().can_redo());
  set(700, "second");
  EXPECT_TRUE(until([&] { return said("The marks are kept in mine.h5."); }));
  set(300, "first");
  EXPECT_EQ(marks(), (std::vector<std::string>{"first at 300", "second at 700"}));
  marking().begin();
  EXPECT_EQ(marking().text(), "mark 3");
  marking().edit(1);
  EXPECT_TRUE(marking().there());
  EXPECT_EQ(marking().text(), "second");
  EXPECT_EQ(marking().when(), fmt::format("at {:.3f} s; kept in mine.h5", 700 * tick()));
  marking().accept("renamed");
  EXPECT_EQ(marks(), (std::vector<std::string>{"first at 300", "renamed at 700"}));
  marking().edit(0);
  marking().remove();
  EXPECT_EQ(marks(), std::vector<std::string>{"renamed at 700"});
  EXPECT_TRUE(marking().can_undo());
  EXPECT_FALSE(marking().can_redo());
  desktop->dialog.close();
  run("edit.undo");
  EXPECT_EQ(marks(), (std::vector<std::string>{"first at 300", "renamed at 700"}));
  EXPECT_TRUE(marking().can_redo());
  run("edit.undo");
  EXPECT_EQ(marks(), (std::vector<std::string>{"first at 300", "second at 700"}));
  run("edit.redo");
  EXPECT_EQ(marks(), (std::vector<std::string>{"first at 300", "renamed at 700"}));
  set(500, "third");
  EXPECT_FALSE(marking().can_redo()) << "another way was taken";
  marking().edit(7);
  marking().begin();
  marking().remove();
  EXPECT_EQ(marks().size(), 3u) << "there is no such mark";
  desktop->settings.parameters().eta = 0.5;
  EXPECT_FALSE(marking().can_undo()) << "a setting was changed last";
}

TEST_F(AMark, IsGoneToFromOneToTheNext) {
  play();
  set(300, "first");
  set(500, "second");
  set(700, "third");
  player().seek(0);
  for (const std::size_t next : {300u, 500u, 700u}) {
    marking().go(1);
    EXPECT_EQ(player().index(), next);
  }
  marking().go(1);
  EXPECT_EQ(player().index(), 700u);
  EXPECT_TRUE(said("There is no mark after this moment."));
  for (const std::size_t before : {500u, 300u}) {
    marking().go(-1);
    EXPECT_EQ(player().index(), before);
  }
  marking().go(-1);
  EXPECT_EQ(player().index(), 300u);
  EXPECT_TRUE(said("There is no mark before this moment."));
}

TEST_F(AMark, ThatCannotBeKeptStaysInThePlotsAndSaysSo) {
  play();
  set(300, "first");
  ASSERT_TRUE(until([&] { return said("The marks are kept in mine.h5."); }));
  fs::remove(file);
  fs::create_directory(file);
  set(500, "second");
  EXPECT_TRUE(until([&] { return said(". The marks are in the plots only."); }));
  EXPECT_EQ(desktop->playback.shown()->marks().size(), 2u);
}

}  // namespace
}  // namespace limpid
