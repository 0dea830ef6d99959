#include "app/desktop/coupling/grip_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <cmath>

#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

constexpr const char* kAbout =
    "The motors add a small force for 9 s, and Limpid measures how the tip answers. Hold the "
    "device as you will use it, still and away from walls. With the virtual arm, the simulated "
    "hand holds still by itself.\nPress this button to begin. The measurement ends by itself, or "
    "when the force is switched off.";

void wrapped(const std::string& text, Rgb rgb) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(rgb));
  ImGui::TextWrapped("%s", text.c_str());
  ImGui::PopStyleColor();
}

void draw_walls(const InHands& hands, CouplingKind kind) {
  const SafeWalls& walls = hands.laws[static_cast<std::size_t>(kind)].in_range;
  std::string text = "not known";
  if (walls.up_to)
    text = std::isinf(*walls.up_to) ? "all" : fmt::format("up to {:.0f} N/m", *walls.up_to);
  read_out(
      fmt::format("stable walls, {}", info(kind).key).c_str(), text, {},
      fmt::format("Walls that are stable in this hand, for all values within the bounds above: {}.",
                  walls.why)
          .c_str());
}

void draw_found(const MeasuredHand& found, const Parameters& p) {
  const Palette& colours = current_palette();
  if (const std::string unknown = unknown_text(found.grip); !unknown.empty()) {
    wrapped("The grip is " + unknown + ".", colours.broken);
  }
  for (const GripLine& line : grip_lines(found)) {
    read_out(line.label.c_str(), line.value, {},
             "Bounds with 95 % confidence: in 95 of 100 measurements the true value is between "
             "them. The bounds of \xCE\xB7_min are its smallest and its largest value for all "
             "grips within the other bounds.");
  }
  if (!found.hands) return;
  for (std::uint8_t i = 0; i < kLaws; ++i) {
    const auto kind = static_cast<CouplingKind>(i);
    if (kind == p.kind || !info(kind).for_comparison) draw_walls(*found.hands, kind);
  }
}

}  // namespace

void draw_grip(GripMeter& meter, const ArmDescription& arm, const Scene& scene, Parameters& p) {
  if (meter.busy()) {
    progress_bar(
        meter.part(), 0,
        meter.part() < 1 ? fmt::format("hold still: {:.0f} s", meter.time()) : "calculating");
    if (noted_button("Stop measuring")) meter.stop();
    return;
  }
  const std::string why_not = meter.why_not();
  ImGui::BeginDisabled(!why_not.empty());
  if (noted_button("Measure the grip")) meter.begin(arm, scene);
  ImGui::EndDisabled();
  tooltip(why_not.empty() ? kAbout : (why_not + "\n" + kAbout).c_str());
  const MeasuredHand* found = meter.found();
  if (found == nullptr) return;
  if (found->grip.known()) {
    constexpr const char* kTake = "Take as the hand";
    flow(kTake);
    if (noted_button(kTake)) p = with_grip(p, found->grip);
    tooltip(
        "Sets grip stiffness, grip damping and hand mass to these values. The analysis uses them, "
        "and so does the virtual arm's hand.");
  }
  draw_found(*found, p);
}

}  // namespace limpid
