// ImGui without a window: frames with the test's mouse and keys.
#pragma once

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include "app/style/imgui_input.h"

namespace limpid {

class ImGuiFrames : public testing::Test {
 protected:
  ImGuiFrames() {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {800, 600};
    begin_imgui_input();
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
  }
  ~ImGuiFrames() override { ImGui::DestroyContext(); }

  // Draws a frame of `seconds` in which `draw` is called.
  template <class Draw>
  void frame(Draw&& draw, float seconds = 0.02f) {
    ImGui::GetIO().DeltaTime = seconds;
    ImGui::NewFrame();
    draw();
    ImGui::Render();
  }
};

}  // namespace limpid
