#include "app/desktop/coupling/analysis_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "app/desktop/widgets/chart.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/imgui_input.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "app/style/ticks.h"

namespace limpid {
namespace {

constexpr double kLookAgain = 0.25;                  // time between two analyses [s]
constexpr int kPoints = 120;                         // of a curve
constexpr double kSoftest = 100, kStiffest = 30000;  // range of the walls' axis [N/m]
constexpr double kSlowest = 0.3, kFastest = 30;      // range of free motion [Hz]
constexpr double kGram = 1000;                       // [g/kg]

// Returns H_L(jw) times b, which is 1/eta at standstill for every mode.
std::vector<std::complex<double>> nyquist(const LockedMode& mode, double eta) {
  std::vector<std::complex<double>> curve;
  const double slow = 0.01 * mode.w_c(), fast = 100 * std::max(mode.w_f(), mode.w_c());
  for (int i = 0; i < kPoints; ++i) {
    const double w = slow * std::pow(fast / slow, i / (kPoints - 1.0));
    curve.push_back(mode.b * locked_response(mode, eta, w));
  }
  return curve;
}

template <class Value>
std::vector<ChartPoint> over_frequency(const Value& value) {
  std::vector<ChartPoint> curve;
  for (int i = 0; i < kPoints; ++i) {
    const double f = kSlowest * std::pow(kFastest / kSlowest, i / (kPoints - 1.0));
    curve.push_back({f, value(f)});
  }
  return curve;
}

Rgb law_colour(const Palette& colours, CouplingKind kind, const Parameters& p) {
  return kind == p.kind ? colours.text : mix(colours.muted, colours.panel, 0.35f);
}

std::string newtons_per_metre(double stiffness) {
  return stiffness >= 1e4 ? fmt::format("{:.0f}k", stiffness / 1000)
                          : fmt::format("{:.0f}", stiffness);
}

// Returns "-11.9 rad/s", or "-11.9 ± 40i rad/s" for a pair.
std::string pole_text(std::complex<double> pole) {
  const std::string real = fixed_text(pole.real(), 1);
  if (std::abs(pole.imag()) < 0.5) return real + " rad/s";
  return fmt::format("{} \xC2\xB1 {:.0f}i rad/s", real, std::abs(pole.imag()));
}

}  // namespace

void AnalysisPanel::update(const Parameters& p, const ArmDescription& arm, const Scene& scene,
                           std::span<const double> x, double band) {
  if (ImGui::GetTime() < due_) return;
  due_ = ImGui::GetTime() + kLookAgain;
  const Eigen::VectorXd pose =
      Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
  analysis_ = analyze(arm, pose, p, 2 * std::numbers::pi * band);
  tip_ = tip_limits(arm, pose, p, scene);
  poles_ = handle_poles(arm, pose, p);
  basis_ = basis_text(arm, p);
}

void AnalysisPanel::draw(const Parameters& p, const ArmDescription& arm, const Scene& scene,
                         std::span<const double> x, double& band) {
  update(p, arm, scene, x, band);
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(current_palette().muted));
  ImGui::TextWrapped("for %s", basis_.c_str());
  ImGui::PopStyleColor();
  draw_walls(p);
  draw_trial(p, arm, x);
  draw_felt(p, band);
  if (info(p.kind).observes) draw_observed(p, band);
}

// Draws one bar a law on a logarithmic axis, and the scene's stiffest wall across them.
void AnalysisPanel::draw_walls(const Parameters& p) const {
  const Palette& colours = current_palette();
  const std::vector<CouplingKind> drawn = laws_told(p.kind);
  const auto rows = static_cast<double>(drawn.size());
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  {
    const Chart chart("stiffest wall [N/m]", {kSoftest, kStiffest, true}, {0, rows, false, false},
                      104);
    const float thick = 0.55f * chart.inside().height() / static_cast<float>(rows);
    const auto across = [&](double stiffness, Rgb rgb) {
      const float at = chart.place({stiffness, 0}).x;
      draw.AddLine({at, chart.inside().min.y}, {at, chart.inside().max.y}, colour(rgb),
                   1.4f * current_scale());
    };
    across(tip_.every_hand, colours.axis);
    if (tip_.scene > 0) across(tip_.scene, ink(colours, Ink::contact));
    double y = rows + 0.5;
    for (const CouplingKind kind : drawn) {
      const double stiffness = tip_.wall(kind).stiffness;
      y -= 1;
      const ImVec2 end = chart.place({std::min(stiffness, kStiffest), y});
      const Rgb ink = law_colour(colours, kind, p);
      draw.AddRectFilled({chart.inside().min.x, end.y - thick / 2}, {end.x, end.y + thick / 2},
                         colour(ink, 0.3f), 2);
      const std::string label = fmt::format("{} {}", info(kind).key, newtons_per_metre(stiffness));
      chart.text({chart.inside().min.x, end.y - 0.6f * font(Face::small)->FontSize}, label,
                 colour(kind == p.kind ? colours.text : colours.muted));
    }
  }
  const TipWall& mine = tip_.wall(p.kind);
  tooltip(fmt::format("The stiffest wall that each coupling renders well at this pose, in the "
                      "direction in which the tip is damped least.\n{}: {:.0f} N/m ({}).\nGrey "
                      "line: {:.0f} N/m, the stiffest wall that a plain spring can render and "
                      "still be passive in every hand (b_d/(T/2 + delay), Colgate and Schenkel). "
                      "Coloured line: the stiffest object in this scene.",
                      info(p.kind).label, mine.stiffness, mine.bound, tip_.every_hand)
              .c_str());
  if (tip_.scene <= 0) return;
  const bool soft = softens(info(p.kind));
  const bool over = !soft && tip_.scene > mine.stiffness;
  read_out("stiffest in this scene", fmt::format("{:.0f} N/m", tip_.scene),
           over ? fmt::format("The object is too stiff: the coupling {} renders well only up to "
                              "{:.0f} N/m here. Reason for the limit: {}.",
                              info(p.kind).key, mine.stiffness, mine.bound)
                : "",
           soft ? "The hand feels a softer wall, because this coupling's spring lies between hand "
                  "and wall."
                : "This coupling renders this stiffness well");
}

// Draws what came of presses on the wall named for this law, and a button that simulates them.
void AnalysisPanel::draw_trial(const Parameters& p, const ArmDescription& arm,
                               std::span<const double> x) {
  using std::chrono_literals::operator""s;
  if (coming_.valid() && coming_.wait_for(0s) == std::future_status::ready) trial_ = coming_.get();
  if (coming_.valid()) {
    ImGui::TextDisabled("Simulates presses on a wall, %s ...", tried_.c_str());
    return;
  }
  const double named = tip_.wall(p.kind).stiffness;
  if (!(named > 0)) return;
  if (ImGui::Button(fmt::format("Try a wall of {:.0f} N/m###try", named).c_str())) {
    const Eigen::VectorXd pose =
        Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
    tried_ = info(p.kind).label;
    coming_ = std::async(std::launch::async, [this, arm, pose, p, named] {
      return try_wall(arm, pose, p, named, &stop_);
    });
  }
  tooltip(
      "Simulates a hand that taps this wall and presses it slowly, in three grips. The wall is the "
      "stiffest that theory allows the chosen coupling here. The device does not move.");
  if (trial_.named <= 0) return;
  const std::string held = trial_.held > 0 ? fmt::format("{:.0f}", trial_.held) : "none";
  read_out("held in simulation", fmt::format("{} of {:.0f} N/m, {}", held, trial_.named, tried_),
           trial_.fault.empty() ? "" : "Not held: " + trial_.fault + ".",
           "The simulated hand felt this wall as stiff as it is, and the tip did not tremble");
}

void AnalysisPanel::draw_felt(const Parameters& p, double band) const {
  const Palette& colours = current_palette();
  const auto curve = [&](CouplingKind kind, auto part) {
    return over_frequency([&](double f) { return part(felt_at_tip(kind, p, tip_, f)); });
  };
  const auto mass = [](const FeltAtTip& felt) { return kGram * felt.mass; };
  const auto damping = [](const FeltAtTip& felt) { return felt.damping; };
  const double natural = kGram * tip_.felt.m, wanted = p.eta * natural;
  const double least = tip_.felt.least_damping(p.eta, p.band);
  const auto draw_all = [&](const Chart& chart, auto part) {
    for (const CouplingKind kind : laws_told(p.kind)) {
      if (kind != p.kind) chart.line(curve(kind, part), colour(law_colour(colours, kind, p)));
    }
    chart.line(curve(p.kind, part), colour(colours.text), 2.4f);
  };
  const ChartAxis frequency{kSlowest, kFastest, true};
  {
    const Chart chart("inertia felt [g at tip] against frequency [Hz]", frequency,
                      {0, 1.25 * std::max(natural, wanted)}, 120);
    chart.dashes(over_frequency([&](double) { return wanted; }), colour(colours.muted));
    draw_all(chart, mass);
  }
  tooltip(fmt::format("Each coupling at \xCE\xB7 {:.3g} in free motion. Thick line: {}. Dashed "
                      "line: \xCE\xB7 times the arm's own inertia of {:.3g} g. The lines come from "
                      "theory, without the encoder's steps.",
                      p.eta, info(p.kind).key, natural)
              .c_str());
  {
    const double own = tip_.felt.b_d + tip_.felt.b_v;
    const Chart chart("damping felt [N s/m] against frequency [Hz]", frequency,
                      {0, 1.6 * std::max(own, least)}, 100);
    if (least > 0) {
      chart.dashes(over_frequency([&](double) { return least; }), colour(colours.muted));
    }
    draw_all(chart, damping);
  }
  tooltip(fmt::format("Dashed line: {:.2g} N s/m. A passive law must make the hand feel at least "
                      "this damping at low frequency to render this inertia up to {:.3g} Hz.",
                      least, p.band)
              .c_str());
  if (info(p.kind).solves_together) {
    if (const std::string less = less_added_text(tip_, p); !less.empty()) {
      read_out("\xCE\xB7", less, {},
               "An added mass that moves fast acts as a damper. If the torque comes late, this "
               "damper would add energy (model.delay_most is the largest delay). If the proxy is "
               "heavy (proxy.inertia_ratio), an added mass as great as the device's mass would "
               "make device and proxy swing.");
    }
  }
  const FeltAtTip now = felt_at_tip(p.kind, p, tip_, band);
  read_out(fmt::format("felt at {:.3g} Hz", band).c_str(),
           fmt::format("{:.3g} g, {:.2g} N s/m", kGram * now.mass, now.damping), {},
           "Inertia and damping at the tip at the human's bandwidth");
}

void AnalysisPanel::draw_observed(const Parameters& p, double& band) {
  draw_nyquist(p);
  auto hertz = static_cast<float>(band);
  ImGui::SetNextItemWidth(-1);
  if (ImGui::SliderFloat("##band", &hertz, 0.5f, 100, "human below %.1f Hz",
                         ImGuiSliderFlags_Logarithmic)) {
    band = hertz;
    due_ = 0;
  }
  note_number_item();
  tooltip("The human's bandwidth. Only frequencies below this bandwidth count for \xCE\xB7_min.");
  const auto limit = [&](const char* label, double value, const char* help) {
    read_out(label, fmt::format("{:.3f}", value), {}, help);
  };
  limit("\xCE\xB7_min, all frequencies", analysis_.eta_min,
        "Limit by equation (25), for the mode with the highest limit at this pose");
  limit("\xCE\xB7_min in the band", analysis_.eta_min_band.value_or(0),
        "Smallest passive \xCE\xB7 if Re H_L >= 0 is required only below the human's bandwidth");
  limit("\xCE\xB7_min in this grip", analysis_.eta_min_grip,
        "Routh's limit: above this \xCE\xB7 the loop is stable in this grip");
  std::string modes;
  for (const LockedMode& mode : analysis_.modes) {
    modes += fmt::format("{}{:.2f}", modes.empty() ? "" : ", ", 1e4 * mode.m);
  }
  read_out("modes of M_L",
           "(" + modes +
               ")\xC2\xB7"
               "10\xE2\x81\xBB\xE2\x81\xB4 kg m\xC2\xB2",
           {}, "Eigenvalues of M1 + M2 at this pose");
  std::complex<double> worst(-1e300, 0);
  for (const auto& pole : poles_) worst = pole.real() > worst.real() ? pole : worst;
  read_out("slowest pole in this grip", pole_text(worst),
           worst.real() > 0 ? "The loop is unstable while a hand holds the arm, because a pole "
                              "lies in the right half plane."
                            : "",
           "For the locked system (hand, device and avatar move as one body) held by the grip, in "
           "continuous time");
}

void AnalysisPanel::draw_nyquist(const Parameters& p) const {
  const Palette& colours = current_palette();
  double left = -0.1, right = 0.1, low = -0.1;
  std::vector<std::vector<std::complex<double>>> curves;
  for (const LockedMode& mode : analysis_.modes) {
    curves.push_back(nyquist(mode, p.eta));
    for (const auto& h : curves.back()) {
      left = std::min(left, h.real());
      right = std::max(right, h.real());
      low = std::min(low, h.imag());
    }
  }
  const double margin = 0.08 * (right - left);
  const bool passive = p.eta >= analysis_.eta_min;
  {
    const Chart chart(fmt::format("b H_L(j\xCF\x89) at \xCE\xB7 {:.3f}: {}", p.eta,
                                  passive ? "passive" : "not passive"),
                      {left - margin, right + margin}, {1.1 * low, -0.15 * low}, 150);
    ImGui::GetWindowDrawList()->AddRectFilled(
        chart.inside().min, {chart.place({0, 0}).x, chart.inside().max.y},
        colour(passive ? colours.muted : colours.broken, 0.14f));
    for (std::size_t i = 0; i < curves.size(); ++i) {
      std::vector<ChartPoint> points;
      for (const auto& h : curves[i]) points.push_back({h.real(), h.imag()});
      chart.line(points, colour(ink(colours, Ink::proxy, 0.4f - 0.4f * static_cast<float>(i))));
    }
    const ImVec2 corner = chart.inside().max;
    chart.text({corner.x, corner.y}, "Re", colour(colours.muted), true);
    chart.text(chart.inside().min, "Im", colour(colours.muted));
  }
  tooltip(
      "H_L(jw) of equation (24), with one curve per mode of the inertia at the present pose. The "
      "coupling is positive real, and therefore passive, if all curves stay to the right of the "
      "shaded half.");
}

}  // namespace limpid
