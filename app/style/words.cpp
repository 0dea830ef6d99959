#include "app/style/words.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cfloat>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "app/style/ticks.h"

namespace limpid {

namespace {

constexpr float kWidth = 26;          // [text sizes]
constexpr float kNarrowPanel = 0.5f;  // of the window's width

struct Place {
  ImVec2 at, pivot;
};

Place place_of(const ImRect& item, const ImRect& panel, ImVec2 window) {
  const float gap = 0.5f * ImGui::GetFontSize();
  const bool low = item.GetCenter().y > 0.5f * window.y;
  const bool right = item.GetCenter().x > 0.5f * window.x;
  if (panel.GetWidth() <= kNarrowPanel * window.x) {
    return {{right ? panel.Min.x - gap : panel.Max.x + gap, low ? item.Max.y : item.Min.y},
            {right ? 1.0f : 0.0f, low ? 1.0f : 0.0f}};
  }
  return {{right ? item.Max.x : item.Min.x, low ? item.Min.y - gap : item.Max.y + gap},
          {right ? 1.0f : 0.0f, low ? 1.0f : 0.0f}};
}

}  // namespace

std::string shortened(const std::string& text, float room, const ImFont* in) {
  const auto fits = [&](const std::string& words) {
    return in->CalcTextSizeA(in->FontSize, FLT_MAX, 0, words.c_str()).x <= room;
  };
  if (fits(text)) return text;
  std::vector<std::size_t> letters;  // where each begins
  for (std::size_t i = 0; i < text.size(); ++i) {
    if ((static_cast<unsigned char>(text[i]) & 0xc0) != 0x80) letters.push_back(i);
  }
  std::string found = "\xE2\x80\xA6";
  for (std::size_t kept = 1; kept < letters.size(); ++kept) {
    const std::size_t before = kept - kept / 2, after = kept / 2;
    const std::size_t tail = after == 0 ? text.size() : letters[letters.size() - after];
    std::string longer = text.substr(0, letters[before]) + "\xE2\x80\xA6" + text.substr(tail);
    if (!fits(longer)) break;
    found = std::move(longer);
  }
  return found;
}

void begin_tooltip(ImVec2 from, ImVec2 to) {
  const ImGuiWindow* window = ImGui::GetCurrentWindow();
  const ImRect panel = window->RootWindow != nullptr ? window->RootWindow->Rect() : window->Rect();
  const ImVec2 size = ImGui::GetMainViewport()->Size;
  const Place place = place_of(ImRect(from, to), panel, size);
  ImGui::SetNextWindowPos(place.at, ImGuiCond_Always, place.pivot);
  ImGui::BeginTooltip();
  const float room = place.pivot.x > 0 ? place.at.x : size.x - place.at.x;
  ImGui::PushTextWrapPos(
      std::min(kWidth * ImGui::GetFontSize(), room - 3 * ImGui::GetStyle().WindowPadding.x));
}

void end_tooltip() {
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

std::string with_greek(std::string text) {
  const auto in_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
  for (const auto& [word, letter] :
       {std::pair<std::string_view, const char*>{"eta", "\xCE\xB7"}, {"alpha", "\xCE\xB1"}}) {
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
      const char before = at > 0 ? text[at - 1] : ' ';
      const char after = at + word.size() < text.size() ? text[at + word.size()] : ' ';
      if (in_word(before) || before == '.' || in_word(after) || after == '=') continue;
      text.replace(at, word.size(), letter);
    }
  }
  return text;
}

void tooltip(const char* text) {
  if (!ImGui::IsItemHovered()) return;
  begin_tooltip(ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  ImGui::TextUnformatted(with_greek(text).c_str());
  end_tooltip();
}

std::string with_unit(const FieldInfo& info, double value) {
  if (std::isnan(value)) {
    return std::string_view(info.key).starts_with("device.") ? "arm's own" : "automatic";
  }
  const bool whole = info.kind == FieldInfo::Kind::whole;
  std::string text = whole ? std::to_string(std::lround(value)) : three_digits(value);
  if (info.has_unit()) text += std::string(" ") + info.unit;
  return text;
}

bool of_paper(const FieldInfo& info) {
  constexpr std::array kOfPaper{"coupling.k_vc", "coupling.b_vc", "coupling.b_v", "observer.alpha"};
  return std::ranges::find(kOfPaper, std::string_view(info.key)) != kOfPaper.end();
}

std::string mark_text(const ParameterInfo& info, const Parameters& p) {
  const double value = parameter_number(p, info);
  const bool of_device = std::string_view(info.key).starts_with("device.");
  std::string text = with_unit(info, value);
  if (std::isnan(value)) text = of_device ? "the arm's" : "automatic";
  if (!info.words.empty()) text = info.words[static_cast<std::size_t>(value)];
  if (info.kind == FieldInfo::Kind::flag) text = value != 0 ? "on" : "off";
  return fmt::format("{} {}", info.label, text);
}

std::string energy_text(double joules) {
  const bool large = std::abs(joules) >= 1;
  const double shown = large ? joules : 1e3 * joules;
  if (std::abs(shown) < 0.005) return "0 mJ";
  const std::string digits = three_digits(std::abs(shown));
  return fmt::format("{}{} {}", shown < 0 ? "\xE2\x88\x92" : "", digits, large ? "J" : "mJ");
}

}  // namespace limpid
