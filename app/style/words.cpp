#include "app/style/words.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

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

constexpr std::array kWords{
    std::pair{"coupling.eta", "Impedance scaling \xCE\xB7"},
    std::pair{"observer.alpha", "Observer gain \xCE\xB1"},
    std::pair{"coupling.damping", "Damping felt"},
    std::pair{"coupling.band", "Band of the inertia"},
    std::pair{"coupling.k_vc", "Coupling spring k_vc"},
    std::pair{"coupling.b_vc", "Coupling damper b_vc"},
    std::pair{"coupling.b_v", "Proxy damper b_v"},
    std::pair{"ledger.energy", "Energy allowed E\xE2\x82\x80"},
    std::pair{"tank.energy", "Energy of both tanks"},
    std::pair{"tank.damping", "Refilling damper"},
    std::pair{"link.delay", "Link delay, each way"},
    std::pair{"link.jitter", "Link jitter"},
    std::pair{"link.loss", "Packets lost"},
    std::pair{"hand.stiffness", "Grip stiffness"},
    std::pair{"hand.damping", "Grip damping"},
    std::pair{"hand.mass", "Hand mass"},
    std::pair{"device.delay", "Device delay"},
    std::pair{"model.delay", "Delay that is known"},
    std::pair{"predictor.preset", "Predictor"},
    std::pair{"device.torque_limit", "Motors' largest torque"},
    std::pair{"model.gravity", "Hold the weight"},
    std::pair{"device.down", "Down, seen from the base"},
    std::pair{"model.friction", "Friction taken off"},
    std::pair{"model.springs", "Hold the springs"},
    std::pair{"device.gravity", "The arm weighs"},
    std::pair{"device.springs", "The arm has its springs"},
    std::pair{"device.damping", "Device damping b_d"},
    std::pair{"device.friction", "Device friction"},
    std::pair{"device.encoder_step", "Encoder step"},
    std::pair{"observer.anti_windup", "Observer knows the motors' limit"},
    std::pair{"observer.velocity", "Velocity estimate"},
    std::pair{"model.inertia_error", "Error of the model's inertia"},
    std::pair{"proxy.inertia_ratio", "Proxy inertia M\xE2\x82\x82/M\xE2\x82\x81"},
};

}  // namespace

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

void tooltip(const char* text) {
  if (!ImGui::IsItemHovered()) return;
  begin_tooltip(ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  ImGui::TextUnformatted(text);
  end_tooltip();
}

const char* caption(const ParameterInfo& info) {
  for (const auto& [key, words] : kWords) {
    if (std::string_view(key) == info.key) return words;
  }
  return info.label;
}

std::string with_unit(const ParameterInfo& info, double value) {
  if (std::isnan(value)) {
    return std::string_view(info.key).starts_with("device.") ? "arm's own" : "automatic";
  }
  const bool whole = std::holds_alternative<int Parameters::*>(info.field);
  std::string text = whole ? std::to_string(std::lround(value)) : three_digits(value);
  if (std::string_view(info.unit) != "-") text += std::string(" ") + info.unit;
  return text;
}

bool of_paper(const ParameterInfo& info) {
  constexpr std::array kOfPaper{"coupling.k_vc", "coupling.b_vc", "coupling.b_v", "observer.alpha"};
  return std::ranges::find(kOfPaper, std::string_view(info.key)) != kOfPaper.end();
}

std::string mark_text(const ParameterInfo& info, const Parameters& p) {
  const double value = parameter_number(p, info);
  const bool of_device = std::string_view(info.key).starts_with("device.");
  std::string text = with_unit(info, value);
  if (std::isnan(value)) text = of_device ? "the arm's" : "automatic";
  if (const auto* choice = std::get_if<Choice<Parameters>>(&info.field)) {
    text = choice->words[choice->get(p)];
  }
  if (std::holds_alternative<bool Parameters::*>(info.field)) text = value != 0 ? "on" : "off";
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
