#include "app/desktop/panels.h"
#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {

void begin_panel(const char* name, const ScreenRect& rect) {
  ImGui::SetNextWindowPos(rect.min);
  ImGui::SetNextWindowSize(rect.size());
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoBringToFrontOnFocus |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNavInputs);
}

void heading(const char* text) {
  ImGui::Spacing();
  ImGui::PushFont(font(Face::semibold));
  ImGui::TextUnformatted(text);
  ImGui::PopFont();
  ImGui::Spacing();
}

void tooltip(const char* text) {
  if (!ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

void read_out(const char* label, const std::string& value, const std::string& broken,
              const char* help) {
  const Palette& colours = palette(current_theme());
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(colours.muted));
  ImGui::TextUnformatted(label);
  ImGui::PopStyleColor();
  const bool on_label = ImGui::IsItemHovered();
  const float width = ImGui::CalcTextSize(value.c_str()).x;
  ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - width);
  ImGui::PushStyleColor(ImGuiCol_Text,
                        colour_vector(broken.empty() ? colours.text : colours.broken));
  ImGui::TextUnformatted(value.c_str());
  ImGui::PopStyleColor();
  if (!on_label && !ImGui::IsItemHovered()) return;
  if (!broken.empty()) {
    ImGui::SetTooltip("%s", broken.c_str());
  } else if (help != nullptr) {
    ImGui::SetTooltip("%s", help);
  }
}

}  // namespace limpid
