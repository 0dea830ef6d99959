// The window's own dialog for files: what it lists, takes, makes and refuses.
#include "app/desktop/widgets/path_dialog.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <optional>

#include "app/style/theme.h"
#include "tests/app/plot/imgui_frames.h"
#include "tests/support/drawn_text.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

class AFileDialog : public ImGuiFrames {
 protected:
  AFileDialog() {
    ImGui::GetIO().DisplaySize = {1400, 900};
    apply_theme(Theme::dark, 1);
    fs::create_directories(folder_ / "inside/deeper");
    for (const char* name : {"b.toml", "a.TOML", "notes.txt", ".hidden.toml", "inside/c.toml"}) {
      std::ofstream(folder_ / name) << "x";
    }
  }
  void open(bool new_file, const fs::path& first) {
    if (dialog_) {
      is_open_ = false;
      frames(3);
    }
    dialog_.emplace(PathDialog::Options{
        .title = "Pick", .action = "Take", .extensions = {".toml"}, .new_file = new_file});
    first_ = first;
    is_open_ = true;
    chosen_.clear();
    frames(4);
  }
  void frames(int count) {
    for (int i = 0; i < count; ++i) {
      frame([&] {
        const fs::path file = dialog_->draw(is_open_, first_, places_);
        if (!file.empty()) chosen_ = file;
      });
    }
  }
  void press(int key, bool control = false) {
    show_modifiers(control, false, false);
    for (const bool down : {true, false}) {
      show_key(key, down);
      frames(1);
    }
    show_modifiers(false, false, false);
    frames(2);
  }
  // Writes over the path, which has the temporary folder's name in it.
  void write_over(const std::string& text) {
    for (const test::DrawnText& each : test::drawn_texts()) {
      const bool is_path = each.text.find("limpid-") != std::string::npos;
      if (each.window == "Pick" && is_path) return write_at(each.middle(), text);
    }
    ADD_FAILURE() << "no path in:\n" << words();
  }
  void write_at(ImVec2 place, const std::string& text) {
    click(place);
    press(GLFW_KEY_A, true);
    ImGui::GetIO().AddInputCharactersUTF8(text.c_str());
    frames(3);
  }
  static std::optional<test::DrawnText> find(const std::string& text) {
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.text == text) return each;
    }
    return std::nullopt;
  }
  void click(const std::string& text, int times = 1) {
    const auto at = find(text);
    ASSERT_TRUE(at) << text << " is not in:\n" << words();
    click(at->middle(), times);
  }
  void click(ImVec2 place, int times = 1) {
    show_mouse(place);
    frames(20);  // earlier clicks are over
    for (int i = 0; i < times; ++i) {
      for (const bool down : {true, false}) {
        show_mouse_button(0, down);
        frames(1);
      }
    }
    frames(2);
  }
  static std::string words() {
    std::string all;
    for (const test::DrawnText& each : test::drawn_texts()) all += each.text + '\n';
    return all;
  }
  // Names that are listed, in their order.
  static std::vector<std::string> listed() {
    std::vector<std::string> all;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.window.find("/folder_") != std::string::npos) all.push_back(each.text);
    }
    return all;
  }
  void expect_refused(const char* why) {
    EXPECT_THAT(words(), testing::HasSubstr(why));
    EXPECT_TRUE(is_open_);
    EXPECT_TRUE(chosen_.empty());
  }

  const test::TempDir folder_;
  std::optional<PathDialog> dialog_;
  fs::path first_, chosen_;
  std::vector<PathDialog::Place> places_;
  bool is_open_ = false;
};

using Names = std::vector<std::string>;

TEST_F(AFileDialog, ListsFoldersThenFilesOfItsKindAndGoesThroughThem) {
  open(false, folder_ / "");
  EXPECT_EQ(listed(), (Names{"../", "inside/", "a.TOML", "b.toml"}));
  click("inside/");
  EXPECT_EQ(listed(), (Names{"../", "deeper/", "c.toml"}));
  click("deeper/");
  EXPECT_EQ(listed(), Names{"../"});
  click("../");
  click("../");
  EXPECT_EQ(listed(), (Names{"../", "inside/", "a.TOML", "b.toml"}));
  click("b.toml");
  EXPECT_TRUE(is_open_) << "it is named, not taken";
  click("Take");
  EXPECT_EQ(chosen_, folder_ / "b.toml");
  EXPECT_FALSE(is_open_);
  open(false, folder_ / "");
  click("a.TOML", 2);
  EXPECT_EQ(chosen_, folder_ / "a.TOML") << "by a double click";
  EXPECT_FALSE(is_open_);
}

TEST_F(AFileDialog, TakesATypedPathAndGoesIntoATypedFolder) {
  open(false, folder_ / "");
  write_over((folder_ / "inside").string());
  EXPECT_EQ(listed(), (Names{"../", "deeper/", "c.toml"})) << "while it is typed";
  press(GLFW_KEY_ENTER);
  EXPECT_TRUE(is_open_) << "a folder is no file";
  write_over((folder_ / "none/x.toml").string());
  EXPECT_EQ(listed(), Names{"no such folder"});
  press(GLFW_KEY_ENTER);
  expect_refused("There is no such file.");
  write_over((folder_ / "inside/c.toml").string());
  EXPECT_THAT(words(), testing::Not(testing::HasSubstr("There is no such file.")));
  press(GLFW_KEY_ENTER);
  EXPECT_EQ(chosen_, folder_ / "inside/c.toml");
  EXPECT_FALSE(is_open_);
}

TEST_F(AFileDialog, BeginsAnewEachTimeAndIsLeftByItsButton) {
  open(false, folder_ / "");
  write_over((folder_ / "none.toml").string());
  press(GLFW_KEY_ENTER);
  expect_refused("There is no such file.");
  click("Cancel (Esc)");
  EXPECT_FALSE(is_open_);
  frames(3);
  is_open_ = true;
  frames(4);
  EXPECT_THAT(words(), testing::Not(testing::HasSubstr("There is no such file.")));
  EXPECT_EQ(listed(), (Names{"../", "inside/", "a.TOML", "b.toml"}));
}

TEST_F(AFileDialog, GoesToItsPlaces) {
  places_ = {{"Here", folder_ / "."}, {"There", folder_ / "inside"}};
  open(false, folder_ / "");
  click("There");
  EXPECT_EQ(listed(), (Names{"../", "deeper/", "c.toml"}));
  open(true, folder_ / "mine.toml");
  EXPECT_EQ(listed(), (Names{"../", "inside/", "a.TOML", "b.toml"}));
  click("There");
  EXPECT_EQ(listed(), (Names{"../", "deeper/", "c.toml"}));
  click("Take");
  EXPECT_EQ(chosen_, folder_ / "inside/mine.toml") << "its name goes along";
}

TEST_F(AFileDialog, AddsTheEndingAndAsksBeforeItReplaces) {
  open(true, folder_ / "b.toml");
  write_over((folder_ / "new").string());
  click("Take");
  EXPECT_EQ(chosen_, folder_ / "new.toml");
  open(true, folder_ / "b.toml");
  click("Take");
  expect_refused("b.toml exists already.");
  write_over((folder_ / "none/b").string());
  EXPECT_THAT(words(), testing::Not(testing::HasSubstr("exists already.")));
  press(GLFW_KEY_ENTER);
  expect_refused("There is no folder");
  write_over((folder_ / "b").string());
  click("Replace it");
  EXPECT_EQ(chosen_, folder_ / "b.toml") << "it was asked for before";
  open(true, folder_ / "b.toml");
  EXPECT_FALSE(find("Replace it")) << "it asks anew";
}

TEST_F(AFileDialog, MakesAFolder) {
  open(true, folder_ / "mine.toml");
  const auto name_it = [&](const char* before, const char* name) {
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.window != "Pick" || !each.text.starts_with(before)) continue;
      write_at(each.middle(), name);
      press(GLFW_KEY_ENTER);
      return frames(3);
    }
    ADD_FAILURE() << before << " is not in:\n" << words();
  };
  click("New folder");
  frames(3);
  name_it("name; Enter", "inside");
  expect_refused("inside exists already.");
  name_it("inside", "..");
  expect_refused("A folder's name has no / in it.");
  name_it("..", "fresh");
  EXPECT_TRUE(fs::is_directory(folder_ / "fresh"));
  EXPECT_EQ(listed(), Names{"../"}) << "it is shown";
  EXPECT_TRUE(find("New folder"));
  click("Take");
  EXPECT_EQ(chosen_, folder_ / "fresh/mine.toml");
  open(false, folder_ / "");
  EXPECT_FALSE(find("New folder")) << "there is nothing to write";
}

// The desktop's dialog has asked already whether a file may be replaced.
TEST_F(AFileDialog, GoesOnWithAFileOfAnotherDialogThatItCannotTake) {
  open(true, folder_ / "b.toml");
  is_open_ = false;
  frames(3);
  EXPECT_EQ(dialog_->take(folder_ / "b.toml"), folder_ / "b.toml");
  EXPECT_EQ(dialog_->take(folder_ / "fresh"), folder_ / "fresh.toml");
  EXPECT_TRUE(dialog_->take(folder_ / "none/x.toml").empty());
  is_open_ = true;
  frames(4);
  expect_refused("There is no folder");
  open(false, folder_ / "");
  is_open_ = false;
  frames(3);
  EXPECT_TRUE(dialog_->take(folder_ / "gone.toml").empty());
  is_open_ = true;
  frames(4);
  expect_refused("There is no such file.");
}

TEST(Expanded, PathsBeginAtHome) {
  const char* home = std::getenv("HOME");
  const std::string before = home != nullptr ? home : "";
  setenv("HOME", "/home/somebody", 1);
  EXPECT_EQ(expanded("~"), fs::path("/home/somebody/"));
  EXPECT_EQ(expanded("~/a/b.toml"), fs::path("/home/somebody/a/b.toml"));
  EXPECT_EQ(expanded("~else/a"), fs::path("~else/a"));
  EXPECT_EQ(expanded("/a/~"), fs::path("/a/~"));
  unsetenv("HOME");
  EXPECT_EQ(expanded("~/a"), fs::path("~/a"));
  if (home != nullptr) setenv("HOME", before.c_str(), 1);
}

}  // namespace
}  // namespace limpid
