// Characters that reach ImGui's own fields of numbers and of text.
#include "app/style/imgui_input.h"

#include <gtest/gtest.h>
#include <imgui_stdlib.h>

#include <string>
#include <string_view>

#include "tests/app/plot/imgui_frames.h"

namespace limpid {
namespace {

class WrittenFields : public ImGuiFrames {
 protected:
  // Draws both fields; the keys go to the one that is named.
  void draw(std::string_view focus = {}) {
    frame(
        [&] {
          ImGui::Begin("panel");
          if (focus == "number") ImGui::SetKeyboardFocusHere();
          ImGui::InputDouble("number", &number, 0, 0, "%.3f");
          note_number_item();
          if (focus == "text") ImGui::SetKeyboardFocusHere();
          ImGui::InputText("text", &text);
          ImGui::End();
        },
        0.02f);
  }
  void write_into(const char* field, const char* characters) {
    draw(field);
    draw(), draw();
    for (const char* c = characters; *c != '\0'; ++c) {
      write_character(static_cast<unsigned char>(*c));
      draw();
    }
    for (const bool down : {true, false}) {
      show_key(GLFW_KEY_ENTER, down);
      draw();
    }
  }

  double number = 0;
  std::string text;
};

TEST_F(WrittenFields, OfNumbersTakeACommaForTheDecimalPoint) {
  write_into("number", "1,5");
  EXPECT_EQ(number, 1.5);
}

TEST_F(WrittenFields, OfTextKeepACommaAsItIs) {
  write_into("text", "1,5");
  EXPECT_EQ(text, "1,5");
}

}  // namespace
}  // namespace limpid
