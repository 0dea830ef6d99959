#include "app/desktop/widgets/widgets.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "app/desktop/widgets/modal.h"
#include "app/style/imgui_input.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "app/style/words.h"

namespace limpid {

bool has_part(const std::string& text, const std::string& part) {
  return small_letters(text).find(small_letters(part)) != std::string::npos;
}

std::string small_letters(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

void splitter(const char* name, ScreenRect rect, bool vertical, double direction, double& size,
              double least, double most) {
  ImGui::SetNextWindowPos(rect.min);
  ImGui::SetNextWindowSize(rect.size());
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoSavedSettings);
  ImGui::InvisibleButton("grip", rect.size());
  if (ImGui::IsItemActive() || ImGui::IsItemHovered()) {
    ImGui::SetMouseCursor(vertical ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
  }
  if (ImGui::IsItemActive()) {
    const ImVec2 delta = ImGui::GetIO().MouseDelta;
    size += direction * static_cast<double>((vertical ? delta.x : delta.y) / current_scale());
  }
  size = std::clamp(size, least, most);
  ImGui::End();
  ImGui::PopStyleVar(2);
}

void fold_tab(const char* name, ScreenRect rect, ImGuiDir arrow, const char* help, bool& wanted) {
  ImGui::SetNextWindowPos(rect.min);
  ImGui::SetNextWindowSize(rect.size());
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  if (ImGui::InvisibleButton("fold", rect.size())) wanted = !wanted;
  const bool over = ImGui::IsItemHovered();
  const Palette& colours = current_palette();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(rect.min, rect.max, colour(over ? colours.frame_active : colours.frame, 0.8f),
                     3 * current_scale());
  ImGui::RenderFrameBorder(rect.min, rect.max, 3 * current_scale());
  const float size = 0.6f * ImGui::GetFontSize();
  ImGui::RenderArrow(
      &list, {(rect.min.x + rect.max.x - size) / 2, (rect.min.y + rect.max.y - size) / 2},
      colour(over ? colours.text : colours.muted), arrow, size / ImGui::GetFontSize());
  tooltip(help);
  ImGui::End();
  ImGui::PopStyleVar(3);
}

void begin_panel(const char* name, ScreenRect rect, bool led) {
  // The backdrop shows behind the panel's round corners.
  ImGui::GetBackgroundDrawList()->AddRectFilled(rect.min, rect.max,
                                                colour(current_palette().backdrop));
  ImGui::SetNextWindowPos(rect.min);
  ImGui::SetNextWindowSize(rect.size());
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoBringToFrontOnFocus |
                   ImGuiWindowFlags_NoSavedSettings | (led ? 0 : ImGuiWindowFlags_NoNavInputs));
  if (led) lead_window_by_keys();
}

bool section(const char* name, bool open_at_first) {
  ImGui::PushFont(font(Face::semibold));
  const bool open = ImGui::CollapsingHeader(
      name, open_at_first ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None);
  ImGui::PopFont();
  return open;
}

void heading(const char* text) {
  ImGui::Spacing();
  ImGui::PushFont(font(Face::semibold));
  ImGui::TextUnformatted(text);
  ImGui::PopFont();
  ImGui::Spacing();
}

void read_out(const char* label, const std::string& value, const std::string& broken,
              const char* help) {
  const Palette& colours = palette(current_theme());
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(colours.muted));
  ImGui::TextUnformatted(label);
  note_place(label);
  ImGui::PopStyleColor();
  const bool on_label = ImGui::IsItemHovered();
  const ImVec2 label_from = ImGui::GetItemRectMin();
  const float width = ImGui::CalcTextSize(value.c_str()).x;
  const float right = ImGui::GetWindowContentRegionMax().x;
  const float end = ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x;
  // A value without room beside its label stands below it.
  if (end + ImGui::GetStyle().ItemSpacing.x + width <= right) {
    ImGui::SameLine(right - width);
  } else {
    ImGui::SetCursorPosX(std::max(ImGui::GetCursorPosX(), right - width));
  }
  ImGui::PushStyleColor(ImGuiCol_Text,
                        colour_vector(broken.empty() ? colours.text : colours.broken));
  ImGui::TextWrapped("%s", value.c_str());
  ImGui::PopStyleColor();
  if (!on_label && !ImGui::IsItemHovered()) return;
  const char* text = broken.empty() ? help : broken.c_str();
  if (text == nullptr) return;
  begin_tooltip(label_from, ImGui::GetItemRectMax());
  ImGui::TextUnformatted(text);
  end_tooltip();
}

void flow(float width) {
  const float end = ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x;
  if (end + ImGui::GetStyle().ItemSpacing.x + width < ImGui::GetWindowContentRegionMax().x) {
    ImGui::SameLine();
  }
}

void flow(const char* words) { flow(ImGui::CalcTextSize(words).x + 2 * ImGui::GetFontSize()); }

void underline_button(Rgb rgb) {
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  const float high = std::round(3 * current_scale());
  ImGui::GetWindowDrawList()->AddRectFilled({from.x, to.y - high}, to, colour(rgb),
                                            ImGui::GetStyle().FrameRounding,
                                            ImDrawFlags_RoundCornersBottom);
}

void ListKeys::move(int count, int columns) {
  int step = 0;
  if (key_pressed(GLFW_KEY_DOWN)) step += columns;
  if (key_pressed(GLFW_KEY_UP)) step -= columns;
  if (columns > 1 && key_pressed(GLFW_KEY_RIGHT)) ++step;
  if (columns > 1 && key_pressed(GLFW_KEY_LEFT)) --step;
  if (count <= 0) return forget();
  if (step == 0) return;
  at_ = at_ == kNone ? 0 : std::clamp(at_ + step, 0, count - 1);
  moved_ = true;
}

bool ListKeys::at(int item) {
  if (item != at_) return false;
  if (std::exchange(moved_, false)) ImGui::SetScrollHereY(0.25f);
  return true;
}

bool ListKeys::taken(int item) const {
  return item == at_ && at_ != kNone &&
         (key_pressed(GLFW_KEY_ENTER, false) || key_pressed(GLFW_KEY_KP_ENTER, false));
}

void progress_bar(double part, float width, std::string text) {
  const Palette& colours = current_palette();
  const double filled = std::clamp(part, 0.0, 1.0);
  if (text.empty()) text = fmt::format("{:.0f} %", 100 * filled);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size(width > 0 ? width : ImGui::GetContentRegionAvail().x, ImGui::GetFrameHeight());
  const ImVec2 to(at.x + size.x, at.y + size.y);
  const float edge = at.x + static_cast<float>(filled) * size.x;
  const ImVec2 extent = ImGui::CalcTextSize(text.c_str());
  const ImVec2 place(std::round(at.x + (size.x - extent.x) / 2),
                     std::round(at.y + (size.y - extent.y) / 2));
  // The text has the colours of both sides of the edge, each with its own contrast.
  ImDrawList* draw = ImGui::GetWindowDrawList();
  const auto side = [&](float from, float until, Rgb back, Rgb ink) {
    draw->PushClipRect({from, at.y}, {until, to.y}, true);
    draw->AddRectFilled(at, to, colour(back), ImGui::GetStyle().FrameRounding);
    if (extent.x <= size.x) draw->AddText(place, colour(ink), text.c_str());
    draw->PopClipRect();
  };
  side(at.x, edge, colours.accent, colours.panel);
  side(edge, to.x, colours.frame, colours.text);
  ImGui::RenderFrameBorder(at, to, ImGui::GetStyle().FrameRounding);
  ImGui::Dummy(size);
}

}  // namespace limpid
