#include "app/desktop/panels/coupling_panel.h"

#include <fmt/format.h>

#include <cmath>

#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "app/style/parameter_slider.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

// What is broken, by how much, and what would mend it; empty while the promise holds.
std::string eta_broken(const Parameters& p, const Analysis& a) {
  if (!info(p.kind).observes || a.passive) return {};
  return fmt::format(
      "eta {:.3g} is below eta_min {:.3f} of (25): the locked system is not passive.\nRaise eta by "
      "{:.3f}, lower alpha, or raise b_v.",
      p.eta, a.eta_min, a.eta_min - p.eta);
}

std::string device_broken(const Analysis& a) {
  if (a.condition3.holds || a.condition3.device_margin >= 0) return {};
  return fmt::format(
      "Condition (3): b_d is {:.4g} N m s/rad short of 2 b_vc + k_vc T.\nLower k_vc or b_vc.",
      -a.condition3.device_margin);
}

std::string proxy_broken(const Analysis& a) {
  if (a.condition3.holds || a.condition3.proxy_margin >= 0) return {};
  return fmt::format(
      "Condition (3): b_v is {:.4g} N m s/rad short of k_vc T / 2.\nRaise b_v or lower k_vc.",
      -a.condition3.proxy_margin);
}

void slider(Parameters& p, const char* key, const std::string& broken = {}) {
  const ParameterInfo& info = *find_parameter(key);
  Parameters shown = p;
  if (std::isnan(shown.felt_damping)) shown.felt_damping = p.damping_share(p.eta);
  if (parameter_slider(info, shown, parameter_number(Parameters{}, info),
                       broken.empty() ? nullptr : broken.c_str())) {
    set_parameter_number(p, info, parameter_number(shown, info));
  }
}

void kind_buttons(Parameters& p) {
  const Palette& colours = palette(current_theme());
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float width = ImGui::GetContentRegionAvail().x;
  const ImVec2 size((width - gap * (kLaws - 1)) / kLaws, ImGui::GetFrameHeight() * 1.2f);
  for (std::uint8_t i = 0; i < kLaws; ++i) {
    const auto kind = static_cast<CouplingKind>(i);
    const bool chosen = p.kind == kind;
    if (i > 0) ImGui::SameLine();
    if (chosen) {
      ImGui::PushStyleColor(ImGuiCol_Button, colour_vector(colours.accent));
      ImGui::PushStyleColor(ImGuiCol_ButtonHovered, colour_vector(colours.accent));
      ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(colours.panel));
    }
    if (ImGui::Button(info(kind).label, size)) p.kind = kind;
    if (chosen) ImGui::PopStyleColor(3);
    tooltip(fmt::format("{}: {} C switches.", info(kind).label, info(kind).meaning).c_str());
  }
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(colours.muted));
  ImGui::TextWrapped("%s", info(p.kind).verdict);
  ImGui::PopStyleColor();
}

void draw_sliders(Parameters& p, const Analysis& a) {
  const std::string eta = eta_broken(p, a);
  const std::string device = device_broken(a);
  const std::string proxy = proxy_broken(a);
  for (const char* key : info(p.kind).sliders) {
    const std::string_view name = key;
    const bool of_device = name == "coupling.k_vc" || name == "coupling.b_vc";
    slider(p, key,
           name == "coupling.eta"   ? eta
           : name == "coupling.b_v" ? proxy
           : of_device              ? device
                                    : std::string());
  }
}

void draw_passivity(const Parameters& p, const Analysis& a) {
  const std::string eta = eta_broken(p, a);
  const std::string device = device_broken(a);
  const std::string proxy = proxy_broken(a);
  heading("Passivity");
  const auto [slow, fast] = std::minmax_element(a.w_f.begin(), a.w_f.end());
  read_out("observer bandwidth w_f", fmt::format("{:.0f} to {:.0f} rad/s", *slow, *fast), {},
           "alpha / m over the modes of the inertia at the rest pose, (18)");
  const bool standard = !info(p.kind).observes;
  read_out("\xCE\xB7_min, all frequencies",
           fmt::format("{:.3f}{}", a.eta_min,
                       standard    ? ""
                       : a.passive ? "  ok"
                                   : "  broken"),
           eta, "w_f / (w_c + w_f) with b = b_d + b_v, (25)");
  const std::string unstable =
      !standard && p.eta < a.eta_min_grip
          ? fmt::format(
                "eta {:.3g} is below Routh's limit {:.3f} for this grip: the loop is "
                "unstable while the hand holds. Raise eta or soften the grip.",
                p.eta, a.eta_min_grip)
          : std::string();
  read_out("\xCE\xB7_min in this grip", fmt::format("{:.3f}", a.eta_min_grip), unstable,
           "Below it the loop is unstable in a hand of this stiffness and damping (Routh)");
  const auto verdict = [](const std::string& broken, double margin) {
    return broken.empty() ? fmt::format("ok  {:+.1e}", std::abs(margin) < 1e-12 ? 0.0 : margin)
                          : fmt::format("broken  {:+.1e}", margin);
  };
  read_out("(3) device b_d", verdict(device, a.condition3.device_margin), device,
           "b_d - 2 b_vc - k_vc T [N m s/rad]: not negative");
  read_out("(3) proxy b_v", verdict(proxy, a.condition3.proxy_margin), proxy,
           "b_v - k_vc T / 2 [N m s/rad]: not negative");
}

// What bounds the energy that the human is given, for a law that keeps account of it.
void draw_ledger(const CouplingReading& now) {
  heading("Energy ledger");
  read_out("reserve", fmt::format("{:.2f} mJ", 1e3 * now.reserve), {},
           "What the human may still be given; more after dissipating, 20 mJ at most");
  const auto share = [](const char* label, double part, const char* cut, const char* meaning) {
    read_out(label, fmt::format("{:.0f} %", 100 * part), part < 0.995 ? cut : "", meaning);
  };
  share("wall force let through", now.contact_governor,
        "The reserve runs low: the ledger holds a part of the wall's force back, so that the "
        "energy given stays bounded. Softer walls, a finer encoder or a known delay (model.delay) "
        "keep it from acting.",
        "100 % unless the reserve runs low; then the proxy leaves the device for a while");
  share("damping cancelled", now.damping_governor,
        "The reserve runs low: less of the device's damping is cancelled.",
        "Of what the damping slider asks for");
}

}  // namespace

void draw_coupling_panel(Parameters& p, const Analysis& analysis, const CouplingReading& now,
                         ScreenRect rect) {
  begin_panel("coupling", rect);
  kind_buttons(p);
  ImGui::Spacing();
  draw_sliders(p, analysis);
  if (info(p.kind).keeps_ledger) {
    draw_ledger(now);
  } else {
    draw_passivity(p, analysis);
  }
  const double energy = now.energy;
  const std::string active =
      energy > 1e-4
          ? "The coupling has given more energy than it took. Either it is not passive, or it was "
            "switched in contact: that puts energy in, too."
          : "";
  read_out("E_c total", fmt::format("{:.2f} mJ", 1e3 * energy), active,
           "Controller energy with the device's own damping: stays below zero while passive");
  ImGui::End();
}

}  // namespace limpid
