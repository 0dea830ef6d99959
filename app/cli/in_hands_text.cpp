#include "app/cli/in_hands_text.h"

#include <fmt/format.h>

#include <cmath>

namespace limpid {
namespace {

std::string walls_text(const SafeWalls& walls) {
  if (!walls.up_to) return "not known";
  if (std::isinf(*walls.up_to)) return "every wall";
  if (*walls.up_to == 0) return "none";
  return fmt::format("{:.0f} N/m", *walls.up_to);
}

std::string why_text(const SafeWalls& walls) {
  return walls.hand
             ? fmt::format("{}; the hand of {:.4g} N/m sets this limit", walls.why, *walls.hand)
             : walls.why;
}

void print_bound(const NamedBound& bound) {
  const std::string wall = !bound.wall               ? "not known"
                           : std::isinf(*bound.wall) ? "no bound"
                                                     : fmt::format("{:.0f} N/m", *bound.wall);
  fmt::print("{:<26} {:>10}  {}\n{:>39}{}\n", bound.name, wall, bound.rule, "", bound.source);
}

nlohmann::ordered_json finite(std::optional<double> value) {
  if (!value || std::isinf(*value)) return nullptr;
  return *value;
}

// `every_wall` tells a wall without bound from one that is not known.
nlohmann::ordered_json part_json(const SafeWalls& walls) {
  nlohmann::ordered_json json{{"wall", finite(walls.up_to)},
                              {"every_wall", nullptr},
                              {"hand", finite(walls.hand)},
                              {"by", walls.why}};
  if (walls.up_to) json["every_wall"] = std::isinf(*walls.up_to);
  return json;
}

nlohmann::ordered_json part_json(const NamedBound& bound) {
  return {{"wall", finite(bound.wall)}, {"rule", bound.rule}, {"source", bound.source}};
}

nlohmann::ordered_json part_json(const LawInHands& law) {
  nlohmann::ordered_json json{{"stable", part_json(law.in_range)},
                              {"passive", part_json(law.in_any_hand)},
                              {"llewellyn", nullptr},
                              {"llewellyn_by", law.two_port_why}};
  if (law.two_port) {
    json["llewellyn"] = {{"least", finite(law.two_port->least)},
                         {"frequency", law.two_port->frequency},
                         {"fails_from", finite(law.two_port->fails_from)}};
  }
  return json;
}

}  // namespace

void print_in_hands(const InHands& found, std::span<const CouplingKind> told) {
  fmt::print("\nfor hands with {:.4g} to {:.4g} N/m, {:.4g} N s/m and {:.4g} kg\n",
             found.range.from, found.range.to, found.damping, found.mass);
  for (const CouplingKind kind : told) {
    const SafeWalls& walls = found.laws[static_cast<std::size_t>(kind)].in_range;
    fmt::print("stable walls, {:<12} {:>10}  {}\n", name(kind), walls_text(walls), why_text(walls));
  }
  fmt::print(
      "eta, proposed              {:>10.4f}  the smallest eta that is stable in all these hands\n",
      found.eta_min);
  fmt::print("\nin every passive hand\n");
  for (const CouplingKind kind : told) {
    const SafeWalls& walls = found.laws[static_cast<std::size_t>(kind)].in_any_hand;
    fmt::print("passive walls, {:<11} {:>10}  {}\n", name(kind), walls_text(walls),
               why_text(walls));
  }
  print_bound(found.sampled);
  print_bound(found.stepped);
  fmt::print("eta_min, proposed          {:>10.4f}  equation (25)\n", found.eta_min_any);
  fmt::print(
      "\nLlewellyn's criterion for the least damped joint: stable at values of 1 and above, if "
      "hand and contact are passive\n");
  for (const CouplingKind kind : told) {
    const LawInHands& law = found.laws[static_cast<std::size_t>(kind)];
    std::string least;
    if (law.two_port) {
      least = fmt::format(
          "lowest value {:.4g} at {:.4g} Hz: {}", law.two_port->least, law.two_port->frequency,
          law.two_port->fails_from
              ? fmt::format("not fulfilled from {:.4g} Hz upwards; ", *law.two_port->fails_from)
              : "fulfilled; ");
    }
    fmt::print("{:<26} {}{}\n", name(kind), least, law.two_port_why);
  }
}

nlohmann::ordered_json in_hands_json(const InHands& found) {
  nlohmann::ordered_json json{{"from", found.range.from},
                              {"to", found.range.to},
                              {"damping", found.damping},
                              {"mass", found.mass},
                              {"eta_min", found.eta_min},
                              {"colgate_schenkel", part_json(found.sampled)},
                              {"abbott_okamura", part_json(found.stepped)}};
  for (std::uint8_t i = 0; i < kLaws; ++i) json[kLawKeys[i]] = part_json(found.laws[i]);
  return json;
}

nlohmann::ordered_json in_hands_units() {
  return {{"grip.from", "N/m"},
          {"grip.to", "N/m"},
          {"grip.damping", "N s/m"},
          {"grip.mass", "kg"},
          {"grip.colgate_schenkel.wall", "N/m"},
          {"grip.abbott_okamura.wall", "N/m"},
          {"grip.LAW.stable.wall", "N/m"},
          {"grip.LAW.stable.hand", "N/m"},
          {"grip.LAW.passive.wall", "N/m"},
          {"grip.LAW.llewellyn.frequency", "Hz"},
          {"grip.LAW.llewellyn.fails_from", "Hz"}};
}

}  // namespace limpid
