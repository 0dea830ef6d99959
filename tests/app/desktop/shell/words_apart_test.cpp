// Room in the whole window: no text is cut off at a side or lies over another one, in any state.
#include <imgui_internal.h>

#include <set>

#include "app/desktop/widgets/modal.h"
#include "tests/app/desktop/shell/whole_window.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

class RoomForWords : public WholeWindow {
 protected:
  // The plots' own marks and names move with their curves.
  static bool of_plots(const test::DrawnText& each) { return each.window.starts_with("plots"); }

  void expect_whole(const std::string& state) const {
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (of_plots(each)) continue;
      const bool low = each.middle().y < each.clip.y || each.middle().y > each.clip.w;
      if (low) continue;  // it can be scrolled to
      EXPECT_GE(each.min.x, each.clip.x - 1) << state << ": " << each.text << " in " << each.window;
      EXPECT_LE(each.max.x, each.clip.z + 1) << state << ": " << each.text << " in " << each.window;
      EXPECT_GE(each.min.x, -1) << state << ": " << each.text;
      EXPECT_LE(each.max.x, static_cast<float>(width) + 1) << state << ": " << each.text;
    }
  }
  static void expect_apart(const std::string& state) {
    const std::vector<test::DrawnText> all = test::drawn_texts();
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t k = i + 1; k < all.size(); ++k) {
        if (all[i].window != all[k].window || of_plots(all[i])) continue;
        if (!all[i].whole() || !all[k].whole()) continue;
        const float wide =
            std::min(all[i].max.x, all[k].max.x) - std::max(all[i].min.x, all[k].min.x);
        const float high =
            std::min(all[i].max.y, all[k].max.y) - std::max(all[i].min.y, all[k].min.y);
        EXPECT_FALSE(wide > 2 && high > 4)
            << state << ": " << all[i].text << " over " << all[k].text << " in " << all[i].window;
      }
    }
  }
  // Windows of ImGui within the one of the system; panels stand beside each other.
  void expect_windows_in_place(const std::string& state) const {
    std::vector<const ImGuiWindow*> panels;
    for (const ImGuiWindow* each : ImGui::GetCurrentContext()->Windows) {
      const bool child = (each->Flags & ImGuiWindowFlags_ChildWindow) != 0;
      if (!each->Active || child || std::string(each->Name).starts_with("Debug")) continue;
      EXPECT_GE(each->Pos.x, -1) << state << ": " << each->Name;
      EXPECT_GE(each->Pos.y, -1) << state << ": " << each->Name;
      EXPECT_LE(each->Rect().Max.x, static_cast<float>(width) + 1) << state << ": " << each->Name;
      EXPECT_LE(each->Rect().Max.y, static_cast<float>(height) + 1) << state << ": " << each->Name;
      const std::string name = each->Name;
      if (name == "coupling" || name == kSidePanel || name == "transport" || name == "plots" ||
          name == "##MainMenuBar") {
        panels.push_back(each);
      }
    }
    for (const ImGuiWindow* a : panels) {
      for (const ImGuiWindow* b : panels) {
        if (a >= b) continue;
        ImRect both = a->Rect();
        both.ClipWith(b->Rect());
        EXPECT_LE(both.GetWidth() * std::max(0.0f, both.GetHeight()), 4) << a->Name << b->Name;
      }
    }
  }
  void expect_room(const std::string& state) const {
    expect_whole(state);
    expect_apart(state);
    expect_windows_in_place(state);
  }
  void unfold_all() {
    desktop->settings.everything = true;
    for (const char* folded : {"Analysis", "This tick", "Device", "Imperfections", "Timing"}) {
      if (find(folded, kSidePanel)) click(folded, kSidePanel);
    }
    away();
    frames(3);
  }
};

TEST_F(RoomForWords, IsInEverySizeOfTheWindow) {
  for (const auto& [w, h] :
       {std::pair(1920, 1080), {1440, 900}, {1280, 720}, {900, 560}, {430, 700}}) {
    width = w;
    height = h;
    frames(6);
    expect_room(fmt::format("{} x {}", w, h));
  }
}

TEST_F(RoomForWords, IsInUnfoldedSections) {
  height = 2600;
  frames(3);
  unfold_all();
  expect_room("unfolded");
  desktop->settings.everything = false;
  frames(4);
  expect_room("simple");
}

TEST_F(RoomForWords, IsUnderEveryLaw) {
  height = 1500;
  desktop->settings.everything = true;
  for (std::uint8_t law = 0; law < kLaws; ++law) {
    desktop->settings.parameters().kind = static_cast<CouplingKind>(law);
    frames(4);
    expect_room(name(static_cast<CouplingKind>(law)));
  }
}

TEST_F(RoomForWords, IsBesideWhatIsSelected) {
  height = 1400;
  for (const char* scene : {"table.toml", "stack.toml", "drawer_door.toml", "keys.toml"}) {
    desktop->world.open_scene(fs::path(LIMPID_ASSETS_DIR) / "scenes" / scene);
    ASSERT_TRUE(until([&] { return !desktop->document.loader().busy(); }));
    frames(4);
    for (std::size_t i = 0; i < std::min<std::size_t>(2, desktop->document.scene().objects.size());
         ++i) {
      desktop->document.editor().select(i);
      frames(5);
      expect_room(fmt::format("{}, object {}", scene, i));
    }
  }
}

TEST_F(RoomForWords, IsInPlaybackAndWithFurtherRuns) {
  desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  desktop->playback.shown()->player().pause();
  frames(5);
  expect_room("playback");
  desktop->playback.close();
  frames(3);
  desktop->tuning.toggle_twin();
  ASSERT_TRUE(until([&] { return desktop->shown.rows().size() == 2; }));
  frames(6);
  expect_room("a twin");
}

// Dialogs whose contents follow from their opening alone.
TEST_F(RoomForWords, IsInEveryDialog) {
  const std::set<std::string> asked{"ask", "arm tip", "expand xacro", "video", "sweep", "plot"};
  for (const auto& [w, h] : {std::pair(1440, 900), {900, 560}}) {
    width = w;
    height = h;
    frames(3);
    for (const DialogKind& kind : dialog_kinds()) {
      if (asked.contains(kind.name)) continue;
      desktop->dialog.open(kind.name);
      frames(6);
      expect_room(fmt::format("{} at {} x {}", kind.name, w, h));
      press(GLFW_KEY_ESCAPE);
      desktop->escape();
      frames(3);
    }
  }
}

TEST_F(RoomForWords, IsInTheDialogsOfARecordingAndAPlot) {
  desktop->playback.open(fs::path(LIMPID_ASSETS_DIR) / "sessions/table.h5");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  desktop->playback.shown()->player().pause();
  frames(3);
  run("session.write_video");
  frames(5);
  expect_room("video");
  desktop->escape();
  frames(3);
  desktop->playback.close();
  frames(3);
  run("plots.add");
  frames(5);
  expect_room("plot");
}

}  // namespace
}  // namespace limpid
