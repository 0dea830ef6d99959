#include "app/desktop/panels/analysis_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

constexpr double kLookAgain = 0.25;  // [s]
constexpr int kPoints = 160;         // of one Nyquist curve

// H_L(jw) times b: 1/eta at standstill, whatever the mode.
std::vector<std::complex<double>> nyquist(const LockedMode& mode, double eta) {
  std::vector<std::complex<double>> curve;
  const double slow = 0.01 * mode.w_c(), fast = 100 * std::max(mode.w_f(), mode.w_c());
  for (int i = 0; i < kPoints; ++i) {
    const double w = slow * std::pow(fast / slow, i / (kPoints - 1.0));
    curve.push_back(mode.b * locked_response(mode, eta, w));
  }
  return curve;
}

}  // namespace

void AnalysisPanel::update(const Parameters& p, const ArmDescription& arm,
                           std::span<const double> x, double band) {
  if (ImGui::GetTime() < due_) return;
  due_ = ImGui::GetTime() + kLookAgain;
  const Eigen::VectorXd pose =
      Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
  analysis_ = analyze(arm, pose, p, 2 * std::numbers::pi * band);
  poles_ = handle_poles(arm, pose, p);
}

void AnalysisPanel::draw(const Parameters& p, const ArmDescription& arm, std::span<const double> x,
                         double& band) {
  update(p, arm, x, band);
  draw_nyquist(p);
  auto hertz = static_cast<float>(band);
  ImGui::SetNextItemWidth(-1);
  if (ImGui::SliderFloat("##band", &hertz, 0.5f, 100, "human below %.1f Hz",
                         ImGuiSliderFlags_Logarithmic)) {
    band = hertz;
    due_ = 0;
  }
  tooltip("The human's bandwidth: eta_min counts only the frequencies below it.");
  const auto limit = [&](const char* label, double value, const char* help) {
    read_out(label, fmt::format("{:.3f}", value), {}, help);
  };
  limit("\xCE\xB7_min, all frequencies", analysis_.eta_min, "(25), the worst mode at this pose");
  limit("\xCE\xB7_min, this band", analysis_.eta_min_band.value_or(0),
        "Re H_L >= 0 is asked only below the human's bandwidth");
  limit("\xCE\xB7_min in this grip", analysis_.eta_min_grip, "Routh: stable in the hand above it");
  std::string modes;
  for (const LockedMode& mode : analysis_.modes) {
    modes += fmt::format("{}{:.2f}", modes.empty() ? "" : ", ", 1e4 * mode.m);
  }
  read_out("modes of M_L", modes + "e-4 kg m\xC2\xB2", {}, "Eigenvalues of M1 + M2 at this pose");
  std::complex<double> worst(-1e300, 0);
  for (const auto& pole : poles_) worst = pole.real() > worst.real() ? pole : worst;
  read_out("slowest pole in the hand",
           fmt::format("{:.1f} \xC2\xB1 {:.0f}i rad/s", worst.real(), std::abs(worst.imag())),
           worst.real() > 0 ? "A pole in the right half plane: unstable while the hand holds." : "",
           "Of the locked system held by the grip, in continuous time");
}

void AnalysisPanel::draw_nyquist(const Parameters& p) const {
  const Palette& colours = palette(current_theme());
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size(ImGui::GetContentRegionAvail().x, 150 * current_scale());
  ImDrawList* draw = ImGui::GetWindowDrawList();
  draw->AddRectFilled(at, {at.x + size.x, at.y + size.y}, colour(colours.frame, 0.5f), 3);
  const double eta = info(p.kind).scales_inertia ? p.eta : 1;
  double left = -0.1, right = 0.1, low = -0.1;
  std::vector<std::vector<std::complex<double>>> curves;
  for (const LockedMode& mode : analysis_.modes) {
    curves.push_back(nyquist(mode, eta));
    for (const auto& h : curves.back()) {
      left = std::min(left, h.real());
      right = std::max(right, h.real());
      low = std::min(low, h.imag());
    }
  }
  const double margin = 0.08 * (right - left);
  left -= margin;
  right += margin;
  low *= 1.1;
  const double high = -0.12 * low;
  const auto place = [&](double re, double im) {
    return ImVec2(at.x + size.x * static_cast<float>((re - left) / (right - left)),
                  at.y + size.y * static_cast<float>((high - im) / (high - low)));
  };
  draw->PushClipRect(at, {at.x + size.x, at.y + size.y}, true);
  const ImVec2 origin = place(0, 0);
  const bool passive = eta >= analysis_.eta_min;
  draw->AddRectFilled(at, {origin.x, at.y + size.y},
                      colour(passive ? colours.muted : colours.broken, 0.14f));
  draw->AddLine({origin.x, at.y}, {origin.x, at.y + size.y}, colour(colours.axis));
  draw->AddLine({at.x, origin.y}, {at.x + size.x, origin.y}, colour(colours.axis));
  for (std::size_t i = 0; i < curves.size(); ++i) {
    std::vector<ImVec2> points;
    for (const auto& h : curves[i]) points.push_back(place(h.real(), h.imag()));
    draw->AddPolyline(points.data(), static_cast<int>(points.size()),
                      colour(ink(colours, Ink::proxy, 0.4f - 0.4f * static_cast<float>(i))), 0,
                      1.6f * current_scale());
  }
  ImFont* small = font(Face::small);
  draw->AddText(small, small->FontSize, {at.x + 6, at.y + size.y - 1.4f * small->FontSize},
                colour(colours.muted),
                fmt::format("b H_L(j\xCF\x89) at \xCE\xB7 {:.2f}: {}", eta,
                            passive ? "passive" : "not passive")
                    .c_str());
  draw->PopClipRect();
  ImGui::Dummy(size);
  tooltip(
      "H_L(jw) of (24), one curve a mode of the inertia at the present pose. Positive real, and "
      "so passive, while it stays right of the vertical line.");
}

}  // namespace limpid
