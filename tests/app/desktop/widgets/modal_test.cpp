// Dialogs drawn frame by frame and clicked on.
#include "app/desktop/widgets/modal.h"

#include <imgui_internal.h>

#include <string>
#include <utility>

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

TEST_F(ADialog, IsInTheMiddleAndAsLargeAsItIsAsked) {
  const auto shown = [&](const char* title, ImVec2 size, int lines) {
    bool open = true;
    for (int i = 0; i < 4; ++i) {
      frame([&] {
        if (!begin_modal(title, open, size)) return;
        for (int k = 0; k < lines; ++k) ImGui::TextUnformatted("A line.");
        ImGui::EndPopup();
      });
    }
    const ImGuiWindow* window = ImGui::FindWindowByName(title);
    EXPECT_NE(window, nullptr) << title;
    const ImRect rect = window->Rect();
    EXPECT_NEAR(rect.GetCenter().x, 400, 1) << title;
    EXPECT_NEAR(rect.GetCenter().y, 300, 1) << title;
    open = false;
    frame([&] { EXPECT_FALSE(begin_modal(title, open, size)); });
    return rect.GetSize();
  };
  const ImVec2 given = shown("given", {310, 170}, 1);
  EXPECT_EQ(given.x, 310);
  EXPECT_EQ(given.y, 170);
  const ImVec2 one = shown("one", {310, 0}, 1), ten = shown("ten", {310, 0}, 10);
  EXPECT_EQ(one.x, 310);
  EXPECT_EQ(ten.x, 310);
  EXPECT_NEAR(ten.y - one.y, 9 * ImGui::GetTextLineHeightWithSpacing(), 1) << "as the lines need";
  EXPECT_LT(shown("small", {0, 0}, 1).x, 200);
}

// Programs click where the cross is noted: that is its middle.
TEST_F(ADialog, NotesTheMiddleOfItsCross) {
  const float aside = 0.35f * ImGui::GetFontSize();
  for (const bool modal : {true, false}) {
    for (const ImVec2 by : {ImVec2(-aside, 0), {aside, 0}, {0, -aside}, {0, aside}}) {
      open_ = true;
      frames(modal);
      const auto places = dialog_places();
      ASSERT_TRUE(places);
      click({places->cross.x + by.x, places->cross.y + by.y}, modal);
      EXPECT_FALSE(open_) << modal << ", " << by.x << ", " << by.y;
      show_mouse({5, 5});
      frames(modal);
    }
    open_ = true;
    frames(modal);
    const ImVec2 beside = dialog_places()->cross;
    click({beside.x - 2 * ImGui::GetFontSize(), beside.y}, modal);
    EXPECT_TRUE(open_) << "that is the title";
    open_ = false;
    frames(modal);
  }
}

TEST_F(ADialog, MayHaveNoCross) {
  for (int i = 0; i < 4; ++i) {
    frame([&] {
      if (!begin_modal("Answer", open_, {300, 0}, false)) return;
      ImGui::TextUnformatted("Which?");
      ImGui::EndPopup();
    });
  }
  const auto places = dialog_places();
  ASSERT_TRUE(places);
  EXPECT_FALSE(places->button) << "nor a button that closes it";
  show_mouse(places->cross);
  for (const bool down : {false, true, false, false}) {
    show_mouse_button(0, down);
    frame([&] {
      if (begin_modal("Answer", open_, {300, 0}, false)) ImGui::EndPopup();
    });
  }
  EXPECT_TRUE(open_);
}

TEST_F(ADialog, IsAcceptedByEnterOnceItIsThere) {
  int accepts = 0;
  bool writes = false;
  const auto draw_it = [&] {
    frame([&] {
      if (!begin_modal("Accept", open_, {300, 0})) return;
      if (writes) {
        ImGui::SetKeyboardFocusHere();
        char letters[8] = "";
        ImGui::InputText("##text", letters, sizeof(letters));
      }
      accepts += accepted() ? 1 : 0;
      ImGui::EndPopup();
    });
  };
  const auto enter = [&](int key) {
    for (const bool down : {true, false}) {
      show_key(key, down);
      draw_it();
    }
    draw_it();
    return std::exchange(accepts, 0);
  };
  EXPECT_EQ(enter(GLFW_KEY_ENTER), 0) << "that has opened it";
  draw_it();
  EXPECT_EQ(enter(GLFW_KEY_ENTER), 1);
  EXPECT_EQ(enter(GLFW_KEY_KP_ENTER), 1);
  EXPECT_EQ(enter(GLFW_KEY_A), 0);
  writes = true;
  for (int i = 0; i < 3; ++i) draw_it();
  EXPECT_EQ(enter(GLFW_KEY_ENTER), 0) << "it is the text's";
}

TEST_F(ADialog, NotesPlacesOfOneFrameByWindowAndLabel) {
  const auto draw_it = [&](bool both) {
    frame([&] {
      ImGui::SetNextWindowPos({100, 50});
      ImGui::SetNextWindowSize({200, 100});
      ImGui::Begin("here###same", nullptr, ImGuiWindowFlags_NoDecoration);
      noted_button("one");
      if (both) noted_button("one");
      ImGui::BeginChild("part");
      note_at("a place", {7, 8});
      ImGui::EndChild();
      ImGui::End();
    });
  };
  draw_it(true);
  draw_it(true);
  ASSERT_EQ(noted_places().size(), 3u);
  const NotedPlace& first = noted_places()[0];
  EXPECT_EQ(first.window, "here###same");
  EXPECT_EQ(first.label, "one");
  const auto found = noted_place("here###same", "one");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->y, first.at.y) << "the first of them";
  EXPECT_LT(first.at.y, noted_places()[1].at.y);
  EXPECT_TRUE(noted_place("there###same", "one")) << "its words may change";
  const auto place = noted_place("here###same", "a place");
  ASSERT_TRUE(place) << "a part's is its window's";
  EXPECT_EQ(place->x, 7);
  EXPECT_EQ(place->y, 8);
  draw_it(false);
  EXPECT_EQ(noted_places().size(), 2u);
}

}  // namespace
}  // namespace limpid
