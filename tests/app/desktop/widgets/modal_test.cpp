// Dialogs drawn frame by frame and clicked on.
#include "app/desktop/widgets/modal.h"

#include "tests/app/plot/imgui_frames.h"

namespace limpid {
namespace {

class ADialog : public ImGuiFrames {
 protected:
  void draw(bool modal) {
    frame([&] {
      if (modal) {
        if (!begin_modal("Question", open_, {300, 0})) return;
        ImGui::TextUnformatted("Shall it be so?");
        close_button("Cancel (Esc)", open_);
        ImGui::EndPopup();
      } else if (open_) {
        ImGui::SetNextWindowSize({300, 200});
        begin_dialog("Beside", open_, 0);
        ImGui::BeginChild("part");
        close_button("Close (Esc)", open_);
        ImGui::EndChild();
        ImGui::End();
      }
    });
  }
  void frames(bool modal, int count = 4) {
    for (int i = 0; i < count; ++i) draw(modal);
  }
  void click(ImVec2 at, bool modal) {
    show_mouse(at);
    frames(modal);
    show_mouse_button(0, true);
    frames(modal);
    show_mouse_button(0, false);
    frames(modal);
  }

  bool open_ = true;
};

TEST_F(ADialog, IsClosedByItsCrossAndStaysClosed) {
  for (const bool modal : {true, false}) {
    open_ = true;
    frames(modal);
    const auto places = dialog_places();
    ASSERT_TRUE(places);
    click(places->cross, modal);
    EXPECT_FALSE(open_) << (modal ? "modal" : "beside the others");
    frames(modal, 20);
    EXPECT_FALSE(dialog_places());
    EXPECT_FALSE(ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopup));
  }
}

TEST_F(ADialog, IsClosedByItsButtonAlsoInAPartOfIt) {
  for (const bool modal : {true, false}) {
    open_ = true;
    frames(modal);
    const auto places = dialog_places();
    ASSERT_TRUE(places && places->button);
    click(*places->button, modal);
    EXPECT_FALSE(open_);
    EXPECT_FALSE(dialog_places());
  }
}

TEST_F(ADialog, ThatIsClosedOtherwiseIsGoneAndOpensAgain) {
  frames(true);
  open_ = false;  // as Esc does
  frames(true);
  EXPECT_FALSE(dialog_places());
  open_ = true;
  frames(true);
  EXPECT_TRUE(dialog_places());
}

TEST_F(ADialog, NotesWhereAButtonIsWhileItIsThere) {
  const auto draw_it = [&](bool there) {
    frame([&] {
      ImGui::SetNextWindowPos({100, 50});
      ImGui::Begin("strip", nullptr, ImGuiWindowFlags_NoDecoration);
      if (there && noted_button("Press me")) open_ = false;
      ImGui::End();
    });
  };
  draw_it(true);
  draw_it(true);
  const auto at = noted_place("strip", "Press me");
  ASSERT_TRUE(at);
  show_mouse(*at);
  for (const bool down : {false, true, false}) {
    show_mouse_button(0, down);
    draw_it(true);
    draw_it(true);
  }
  EXPECT_FALSE(open_);
  draw_it(false);
  EXPECT_FALSE(noted_place("strip", "Press me"));
  EXPECT_FALSE(noted_place("no such window", "Press me"));
}

}  // namespace
}  // namespace limpid
