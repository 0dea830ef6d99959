#include "app/style/parameter_slider.h"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "app/style/theme.h"
#include "app/style/ticks.h"
#include "app/style/tooltip.h"
#include "app/style/words.h"

namespace limpid {
namespace {

void show_tooltip(const ParameterInfo& info, double usual, const char* broken) {
  begin_tooltip(ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  if (broken != nullptr) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(current_palette().broken));
    ImGui::TextUnformatted(broken);
    ImGui::PopStyleColor();
    ImGui::Spacing();
  }
  ImGui::TextUnformatted(info.meaning);
  ImGui::Spacing();
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyle().Colors[ImGuiCol_TextDisabled]);
  const bool number = std::holds_alternative<double Parameters::*>(info.field) || is_int(info);
  if (number) {
    const std::string range = three_digits(info.minimum) + " to " + with_unit(info, info.maximum);
    ImGui::Text("%s, %s", info.key, range.c_str());
    ImGui::Text("%s: %s (right click). Double click to type.", of_paper(info) ? "Paper" : "Usual",
                with_unit(info, usual).c_str());
  } else {
    ImGui::Text("%s. Right click: the usual choice.", info.key);
  }
  if (!info.live) ImGui::TextUnformatted("Takes effect when the loop starts again.");
  ImGui::PopStyleColor();
  end_tooltip();
}

void draw_choice(const ImRect& box, const char* text, bool chosen, bool hovered) {
  const Palette& p = current_palette();
  const float rounding = ImGui::GetStyle().FrameRounding;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (chosen || hovered) {
    list.AddRectFilled(box.Min, box.Max, colour(chosen ? p.accent : p.frame_active), rounding);
  }
  const ImVec2 size = ImGui::CalcTextSize(text);
  const ImVec2 at{std::round(box.GetCenter().x - 0.5f * size.x),
                  std::round(box.GetCenter().y - 0.5f * size.y)};
  const Rgb rgb = chosen ? p.panel : hovered ? p.text : p.muted;
  list.PushClipRect(box.Min, box.Max, true);
  list.AddText(at, colour(rgb), text);
  list.PopClipRect();
}

// Radio buttons side by side, of which one is pressed in.
bool choices(const ParameterInfo& info, const Choice<Parameters>& choice, Parameters& p) {
  ImGui::TextUnformatted(caption(info));
  const int count = static_cast<int>(choice.words.size());
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size{ImGui::GetContentRegionAvail().x, ImGui::GetFrameHeight()};
  ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + size.x, at.y + size.y},
                                            colour(current_palette().frame),
                                            ImGui::GetStyle().FrameRounding);
  bool changed = false;
  for (int i = 0; i < count; ++i) {
    const char* word = choice.words[static_cast<std::size_t>(i)];
    const bool chosen = choice.get(p) == i;
    const float left = std::round(size.x * static_cast<float>(i) / static_cast<float>(count));
    const float right = std::round(size.x * static_cast<float>(i + 1) / static_cast<float>(count));
    ImGui::SetCursorScreenPos({at.x + left, at.y});
    if (ImGui::InvisibleButton(word, {right - left, size.y})) {
      changed = !chosen;
      choice.set(p, static_cast<std::uint8_t>(i));
    }
    const ImRect box({at.x + left, at.y}, {at.x + right, at.y + size.y});
    draw_choice(box, word, choice.get(p) == i, ImGui::IsItemHovered());
  }
  return changed;
}

}  // namespace

bool value_slider(const ParameterInfo& info, double& value, double usual) {
  ImGui::PushID(info.key);
  const bool changed = number_slider(info, value, usual, false);
  if (changed) value = std::clamp(value, info.minimum, info.maximum);
  ImGui::PopID();
  return changed;
}

bool parameter_slider(const ParameterInfo& info, Parameters& parameters, double usual,
                      const char* broken) {
  ImGui::PushID(info.key);
  ImGui::BeginGroup();
  bool changed = false;
  if (const auto* flag = std::get_if<bool Parameters::*>(&info.field)) {
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {2 * current_scale(), 2 * current_scale()});
    changed = ImGui::Checkbox(caption(info), &(parameters.**flag));
    ImGui::PopStyleVar();
  } else if (const auto* choice = std::get_if<Choice<Parameters>>(&info.field)) {
    changed = choices(info, *choice, parameters);
  } else {
    double value = parameter_number(parameters, info);
    changed = number_slider(info, value, usual, broken != nullptr);
    if (changed) set_parameter_number(parameters, info, value);
  }
  ImGui::EndGroup();
  const bool is_choice = !std::holds_alternative<double Parameters::*>(info.field) && !is_int(info);
  if (is_choice && broken != nullptr) {
    draw_broken_frame(ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  }
  if (ImGui::IsItemHovered()) {
    if (is_choice && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
      changed = parameter_number(parameters, info) != usual;
      set_parameter_number(parameters, info, usual);
    }
    const bool busy = ImGui::IsAnyItemActive();
    if (!busy && ImGui::GetCurrentContext()->HoveredIdTimer > 0.5f) {
      show_tooltip(info, usual, broken);
    }
  }
  ImGui::PopID();
  return changed;
}

}  // namespace limpid
