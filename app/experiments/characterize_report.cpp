#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/base/markup.h"
#include "app/experiments/characterize.h"
#include "app/run/provenance.h"

namespace limpid {
namespace {

using nlohmann::ordered_json;

std::string html_cell(const std::string& text, const char* kind) {
  return fmt::format("<td class=\"{}\">{}</td>", kind, escaped(typeset(text)));
}
std::string number_cell(const std::string& text) { return html_cell(text, "number"); }

std::string table_of(const std::string& title, const std::string& about, const std::string& head,
                     const std::string& rows) {
  return fmt::format(
      "<section><header><h2>{}</h2></header><p class=\"soft\">{}</p>\n"
      "<table><thead><tr>{}</tr></thead><tbody>\n{}</tbody></table></section>\n",
      title, about, head, rows);
}

std::string numbers_section(const Characterized& subject) {
  std::string rows;
  for (const KnownNumber& number : subject.numbers) {
    rows += "<tr>" + html_cell(number.what, "") +
            number_cell(fmt::format("{:.4g} {}", number.value, number.unit)) +
            html_cell((number.assumed ? "assumed: " : "") + number.from,
                      number.assumed ? "failed" : "") +
            "</tr>\n";
  }
  return table_of("Numbers behind this report",
                  "No device was pushed for this report: all runs use the virtual arm with these "
                  "numbers. If an assumed number is wrong, the results are wrong too.",
                  "<th>Number</th><th class=\"number\">Value</th><th>From</th>", rows);
}

std::string walls_section(const Characterization& found) {
  std::string rows;
  for (const LawRendered& law : found.laws) {
    const auto [least, most] = law.felt();
    rows += "<tr>" + html_cell(info(law.kind).key, "") + number_cell(wall_text(law.wall)) +
            number_cell(fmt::format("{:.0f}", law.named)) + html_cell(law.bound, "soft") +
            number_cell(most > 0 ? fmt::format("{:.0f} to {:.0f}", least, most) : "none") +
            number_cell(given_text(law)) + "</tr>\n";
  }
  return table_of(
      "Walls",
      fmt::format(
          "Stiffest wall: the stiffest wall that feels as stiff as it is set and does not "
          "vibrate. Computed by analyze: the stiffest wall that `limpid analyze` computes. "
          "Felt and Given to a hand: four hands with different grips touch a wall of {} "
          "N/m. Felt is the stiffness that these hands feel. Given to a hand is the largest "
          "energy that one of these hands gets.",
          kCommonWall),
      "<th>Law</th><th class=\"number\">Stiffest wall [N/m]</th><th class=\"number\">Computed by "
      "analyze [N/m]</th><th>bounded by</th><th class=\"number\">Felt [N/m]</th><th "
      "class=\"number\">Given to a hand [mJ]</th>",
      rows);
}

std::string felt_cell(const std::vector<FeltMotion>& felt, double f) {
  const FeltMotion* const m = at_frequency(felt, f);
  if (m == nullptr) return number_cell("unstable");
  return number_cell(fmt::format("{:.1f} g, {:.2f} N s/m", 1e3 * m->inertia, m->damping));
}

std::string free_section(const Characterization& found) {
  std::string head = "<th>Law</th><th></th>", rows;
  for (const double f : kFreeTold) head += fmt::format("<th class=\"number\">{} Hz</th>", f);
  for (const LawRendered& law : found.laws) {
    for (const bool measured : {true, false}) {
      rows += "<tr>" + html_cell(measured ? info(law.kind).key : "", "") +
              html_cell(measured ? "measured" : "analyze", "soft");
      for (const double f : kFreeTold) rows += felt_cell(measured ? law.free : law.free_named, f);
      rows += "</tr>\n";
    }
  }
  return table_of("Free motion",
                  "Mass and damping felt at the tip. Friction is felt as damping; the numbers of "
                  "`limpid analyze` do not include it. A tip that sticks when it changes direction "
                  "feels like a spring; a spring counts as a negative mass.",
                  head, rows);
}

ordered_json felt_json(const std::vector<FeltMotion>& felt) {
  ordered_json all = ordered_json::array();
  for (const double f : kFreeTold) {
    const FeltMotion* const m = at_frequency(felt, f);
    if (m == nullptr) continue;
    all.push_back({{"frequency_hz", f}, {"mass_kg", m->inertia}, {"damping_ns_per_m", m->damping}});
  }
  return all;
}

ordered_json law_json(const LawRendered& law) {
  ordered_json taps = ordered_json::array();
  for (std::size_t i = 0; i < law.taps.size(); ++i) {
    const Came& came = law.taps[i];
    const bool stable = std::isfinite(came.total);
    taps.push_back({{"grip_n_per_m", kHands[i].stiffness},
                    {"grip_damping_ns_per_m", kHands[i].damping},
                    {"stable", stable},
                    {"felt_n_per_m", kCommonWall * came.felt},
                    {"given_j", stable ? ordered_json(came.port) : ordered_json(nullptr)}});
  }
  return {{"law", info(law.kind).key},
          {"stiffest_n_per_m", law.wall},
          {"analyze_n_per_m", law.named},
          {"analyze_bound", law.bound},
          {"taps", taps},
          {"free_stable", !law.free.empty()},
          {"free", felt_json(law.free)},
          {"free_by_analyze", felt_json(law.free_named)}};
}

std::string characterization_json(const Characterized& subject, const Characterization& found) {
  ordered_json numbers = ordered_json::array(), laws = ordered_json::array();
  for (const KnownNumber& number : subject.numbers) {
    numbers.push_back({{"key", number.key},
                       {"what", number.what},
                       {"value", number.value},
                       {"unit", number.unit},
                       {"from", number.from},
                       {"assumed", number.assumed}});
  }
  for (const LawRendered& law : found.laws) laws.push_back(law_json(law));
  return ordered_json{{"arm", subject.at.arm.name},
                      {"device", subject.name},
                      {"wall_n_per_m", kCommonWall},
                      {"numbers", numbers},
                      {"laws", laws}}
      .dump();
}

}  // namespace

std::string wall_text(double wall) {
  if (wall <= kLeastWall) return fmt::format("below {:.0f}", kLeastWall);
  if (wall >= 0.95 * kMostWall) return fmt::format("{:.0f} or more", wall);
  return fmt::format("{:.0f}", wall);
}

std::string given_text(const LawRendered& law) {
  const double given = law.most_given();
  return std::isfinite(given) ? fmt::format("{:.2f}", 1e3 * given) : "unstable";
}

const FeltMotion* at_frequency(const std::vector<FeltMotion>& felt, double f) {
  for (const FeltMotion& m : felt) {
    if (std::abs(m.f - f) < 1e-9) return &m;
  }
  return nullptr;
}

void write_characterization(const Characterized& subject, const Characterization& found,
                            const std::filesystem::path& dir) {
  write_outcome(kCharacterize, found.outcome, dir, characterization_json(subject, found));
  write_page(dir / "report.html", found.outcome.figure.title,
             "Measured on the virtual arm; no device was pushed.",
             numbers_section(subject) + walls_section(found) + free_section(found) +
                 report_section(kCharacterize,
                                "the same results as a figure, and checks with their bounds", dir));
}

}  // namespace limpid
