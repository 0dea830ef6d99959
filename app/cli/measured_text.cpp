#include "app/cli/measured_text.h"

#include <fmt/format.h>

namespace limpid {
namespace {

nlohmann::ordered_json bounded_json(const Bounded& of) {
  return {{"value", of.value}, {"bound", of.bound}};
}

}  // namespace

void print_measured(const MeasuredHand& hand) {
  const std::string unknown = unknown_text(hand.grip);
  fmt::print("the grip, measured         {}\n",
             unknown.empty() ? "known; the bounds are right for 95 of 100 grips" : unknown);
  for (const GripLine& line : grip_lines(hand)) {
    fmt::print("{:<26} {}\n", line.label, line.value);
  }
  if (!hand.grip.measured) return;
  fmt::print("{:<26} {:.3g} mJ by the measuring force; the tip moved up to {:.1f} mm\n",
             "given to the hand", 1e3 * hand.grip.work, 1e3 * hand.grip.moved);
}

nlohmann::ordered_json measured_json(const MeasuredHand& hand) {
  const Grip& grip = hand.grip;
  nlohmann::ordered_json json{{"known", grip.known()}, {"why_not", nullptr}};
  if (!grip.known()) json["why_not"] = grip.unknown;
  for (const char* key : {"stiffness", "damping", "mass", "eta_min"}) json[key] = nullptr;
  if (grip.measured) {
    json["stiffness"] = bounded_json(grip.stiffness);
    json["damping"] = bounded_json(grip.damping);
    json["mass"] = bounded_json(grip.mass);
  }
  if (hand.eta_min) {
    json["eta_min"] = {
        {"value", hand.eta_min->value}, {"least", hand.eta_min->low}, {"most", hand.eta_min->high}};
  }
  json["moved"] = grip.moved;
  json["touched"] = grip.touched;
  json["work"] = grip.work;
  return json;
}

nlohmann::ordered_json measured_units() {
  nlohmann::ordered_json units{{"measured_grip.moved", "m"}, {"measured_grip.work", "J"}};
  for (const char* part : {"value", "bound"}) {
    units[fmt::format("measured_grip.stiffness.{}", part)] = "N/m";
    units[fmt::format("measured_grip.damping.{}", part)] = "N s/m";
    units[fmt::format("measured_grip.mass.{}", part)] = "kg";
  }
  return units;
}

}  // namespace limpid
