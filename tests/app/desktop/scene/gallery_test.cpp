// The gallery: scenes of a folder, their cards, and what a click or a key opens.
#include "app/desktop/scene/gallery.h"

#include "app/desktop/base/settings.h"
#include "tests/app/desktop/shell/whole_window.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/drawn_ink.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(ScenesOfAFolder, AreListedByTitleWithWhatBelongsToThem) {
  const test::TempDir dir;
  for (const char* folder : {"scenes/thumbnails", "sessions"}) {
    fs::create_directories(dir / folder);
  }
  test::write_file(dir / "scenes/z.toml", "title = \"An arch\"\nabout = \"Go under it.\"\n");
  test::write_file(dir / "scenes/b.toml", "# nothing\n");
  test::write_file(dir / "scenes/a.toml", "title = \"Zebra\"\nabout = [\n");
  test::write_file(dir / "scenes/notes.txt", "title = \"No scene\"\n");
  test::write_file(dir / "scenes/thumbnails/z.png", "a picture");
  test::write_file(dir / "sessions/b.h5", "a session");
  const std::vector<GalleryCard> all = gallery_of(dir / "scenes", dir / "sessions");
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].title, "An arch");
  EXPECT_EQ(all[0].about, "Go under it.");
  EXPECT_EQ(all[0].scene, dir / "scenes/z.toml");
  EXPECT_EQ(all[0].picture, dir / "scenes/thumbnails/z.png");
  EXPECT_EQ(all[0].session, fs::path());
  EXPECT_EQ(all[1].title, "a") << "it cannot be read, and goes by its name";
  EXPECT_THAT(all[1].about, StartsWith("Cannot be read: "));
  EXPECT_EQ(all[2].title, "b");
  EXPECT_EQ(all[2].about, "");
  EXPECT_EQ(all[2].picture, fs::path());
  EXPECT_EQ(all[2].session, dir / "sessions/b.h5");
  EXPECT_TRUE(gallery_of(dir / "none", dir / "sessions").empty());
}

// The window with two scenes of one's own, the second with a recording of the same name.
class AGallery : public WholeWindow {
 protected:
  void SetUp() override {
    WholeWindow::SetUp();
    if (!desktop) return;
    height = 1600;
    const fs::path shipped = fs::path(LIMPID_ASSETS_DIR);
    for (const auto& [name, title, about] :
         {std::tuple("first", "Aardvark", "It digs."), {"second", "Badger", "It digs, too."}}) {
      test::write_file(scenes_dir() / (std::string(name) + ".toml"),
                       fmt::format("title = \"{}\"\nabout = \"{}\"\n[[sphere]]\nname = \"ball\"\n"
                                   "center = [0.2, 0, 0]\nradius = 0.02\n",
                                   title, about));
    }
    fs::copy_file(shipped / "sessions/table.h5", sessions_dir() / "second.h5");
    run("scene.gallery");
    frames(4);
  }
  // Cards are in a window within the dialog.
  static std::optional<test::DrawnText> card(const std::string& text) {
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.text == text && each.window.starts_with("Gallery/")) return each;
    }
    return std::nullopt;
  }
};

TEST_F(AGallery, HasOnesOwnScenesFirst) {
  const auto yours = card("Yours"), shipped = card("Shipped with Limpid");
  const auto first = card("Aardvark"), second = card("Badger");
  ASSERT_TRUE(yours && shipped && first && second) << words("Gallery");
  EXPECT_LT(yours->max.y, first->min.y);
  EXPECT_LT(first->max.y, shipped->min.y);
  EXPECT_NEAR(first->middle().y, second->middle().y, 2) << "side by side";
  EXPECT_LT(first->max.x, second->min.x);
  for (const auto& [title, file, about] :
       {std::tuple(*first, "first.toml", "It digs."), {*second, "second.toml", "It digs, too."}}) {
    const auto name = card(file), text = card(about);
    ASSERT_TRUE(name && text) << words("Gallery");
    EXPECT_NEAR(name->middle().y, title.middle().y, 4) << "the file beside its title";
    EXPECT_LT(title.max.x, name->min.x);
    EXPECT_GT(text->min.y, title.max.y);
    EXPECT_NEAR(text->min.x, title.min.x, 3);
    EXPECT_EQ(text->colour, colour(current_palette().muted));
  }
  const auto button = card("Play its recorded session");
  ASSERT_TRUE(button);
  EXPECT_GT(button->min.x, second->min.x - 3) << "only the second has one";
  EXPECT_FALSE(card("table.toml")) << "shipped scenes go without the names of their files";
}

TEST_F(AGallery, DrawsShapesWhereThereIsNoPicture) {
  const auto title = card("Aardvark");
  ASSERT_TRUE(title);
  bool ground = false;
  for (float up = 20; up < 140; up += 0.1f) {
    const ImVec2 at{title->min.x + 60, title->min.y - up};
    ground =
        ground || test::inked(at, [](ImU32 ink) { return ink == colour(current_palette().axis); });
  }
  EXPECT_TRUE(ground) << "a table's edge";
}

TEST_F(AGallery, PlaysTheRecordingWhoseButtonIsClicked) {
  click(card("Play its recorded session")->middle());
  EXPECT_EQ(desktop->dialog.name(), "");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  EXPECT_EQ(desktop->playback.shown()->file(), sessions_dir() / "second.h5");
  EXPECT_NE(desktop->document.file(), scenes_dir() / "second.toml");
}

TEST_F(AGallery, MarksTheCardThatKeysAreAt) {
  const auto title = card("Badger");
  ASSERT_TRUE(title);
  const auto marked = [&](const test::DrawnText& of) {
    bool left = false;
    for (float x = of.min.x - 14; x < of.min.x; x += 0.25f) {
      left = left || test::inked({x, of.middle().y},
                                 [](ImU32 ink) { return ink == colour(current_palette().accent); });
    }
    return left;
  };
  EXPECT_FALSE(marked(*title));
  press(GLFW_KEY_RIGHT);
  press(GLFW_KEY_RIGHT);
  EXPECT_TRUE(marked(*card("Badger")));
  EXPECT_FALSE(marked(*card("Aardvark")));
}

TEST_F(AGallery, IsLeftByItsButtonWithoutAChoice) {
  click("Close (Esc)", "Gallery");
  EXPECT_EQ(desktop->dialog.name(), "");
  EXPECT_FALSE(said("Scene: Aardvark"));
}

}  // namespace
}  // namespace limpid
