#include "app/style/imgui_gl.h"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

namespace limpid {

ImGuiGl::ImGuiGl() {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

ImGuiGl::~ImGuiGl() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext();
}

void ImGuiGl::set_up(Theme theme, float scale, float density) {
  load_fonts(scale, density);
  apply_theme(theme, scale);
}

void ImGuiGl::change(Theme theme, float scale, float density) {
  set_up(theme, scale, density);
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

void ImGuiGl::begin_frame() { ImGui_ImplOpenGL3_NewFrame(); }

void ImGuiGl::render() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace limpid
