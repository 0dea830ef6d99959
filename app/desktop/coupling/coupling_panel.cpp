#include "app/desktop/coupling/coupling_panel.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <vector>

#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/widgets.h"
#include "app/run/fitted_gains.h"
#include "app/run/lane_settings.h"
#include "app/style/palette.h"
#include "app/style/sliders.h"
#include "app/style/theme.h"
#include "app/style/words.h"

namespace limpid {
namespace {

// Returns the violated condition, by how much, and a remedy; empty if it holds. So do all
// ..._broken().
std::string eta_broken(const Parameters& p, const Analysis& a) {
  if (!info(p.kind).observes || a.above_eta_min) return {};
  return fmt::format(
      "\xCE\xB7 {:.3g} is below \xCE\xB7_min {:.3f} of equation (25), so the locked system is not "
      "passive.\nRaise \xCE\xB7 by {:.3f}, lower \xCE\xB1, or raise b_v.",
      p.eta, a.eta_min, a.eta_min - p.eta);
}

// Adds the delays that tighten condition (3): of the device's answer, and of the link.
std::string with_delays(const Analysis& a, std::string text) {
  if (a.delay > 0) text += fmt::format(", delay {:.1f} ms", 1e3 * a.delay);
  if (a.link > 0) text += fmt::format(", link {:.4g} ms", 1e3 * a.link);
  return text;
}
std::string device_needs(const Parameters& p, const Analysis& a) {
  const char* const link = a.link > 0 ? " + link" : "";
  const std::string b_vc =
      p.link_jitter > 0 ? fmt::format("{:.3g} b_vc", 2 + 0.5 * p.link_jitter) : "2 b_vc";
  if (a.delay > 0) return with_delays(a, fmt::format("{} + k_vc (T + 3/2 delay{})", b_vc, link));
  if (a.link > 0) return with_delays(a, b_vc + " + k_vc (T + link)");
  return b_vc + " + k_vc T";
}
std::string proxy_needs(const Parameters& p, const Analysis& a) {
  const std::string b_vc =
      p.link_jitter > 0 ? fmt::format("{:.3g} b_vc + ", 0.5 * p.link_jitter) : "";
  if (a.link > 0) {
    return with_delays(
        a, fmt::format("{}k_vc ({} / 2 + link)", b_vc, a.delay > 0 ? "(T + delay)" : "T"));
  }
  return a.delay > 0 ? with_delays(a, "k_vc (T + delay) / 2") : "k_vc T / 2";
}

std::string device_broken(const Parameters& p, const Analysis& a) {
  if (!a.condition3.known) {
    return "Condition (3) of the paper cannot be checked: no limit is known if packets are lost "
           "(link loss). Each side then uses the last packet that it received, and this packet can "
           "be of any age.\nThe tank law stays passive if packets are lost.";
  }
  if (a.condition3.holds || a.condition3.device_margin >= 0) return {};
  return fmt::format(
      "Condition (3) is broken: b_d is {:.4g} N m s/rad smaller than {}.\nLower k_vc or b_vc.",
      -a.condition3.device_margin, device_needs(p, a));
}

std::string proxy_broken(const Parameters& p, const Analysis& a) {
  if (a.condition3.holds || a.condition3.proxy_margin >= 0) return {};
  return fmt::format(
      "Condition (3) is broken: b_v is {:.4g} N m s/rad smaller than {}.\nRaise b_v or lower k_vc.",
      -a.condition3.proxy_margin, proxy_needs(p, a));
}

// `limit`: a value that is marked in red, beside the usual one; NaN: none.
void slider(Parameters& p, const char* key, const std::string& broken = {},
            double limit = std::numeric_limits<double>::quiet_NaN()) {
  const ParameterInfo& info = *find_parameter(key);
  Parameters shown = p;
  if (std::isnan(shown.felt_damping)) shown.felt_damping = p.damping_share(p.eta);
  if (parameter_slider(info, shown, parameter_number(Parameters{}, info),
                       broken.empty() ? nullptr : broken.c_str(), limit)) {
    set_parameter_number(p, info, parameter_number(shown, info));
  }
  note_place(key);
}

// Marks the least eta where the law has one.
void eta_slider(Parameters& p, const Analysis& a) {
  const bool least = info(p.kind).promise == Promise::eta_min;
  slider(p, "coupling.eta", eta_broken(p, a),
         least ? a.eta_min : std::numeric_limits<double>::quiet_NaN());
}

void muted(const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(palette(current_theme()).muted));
  ImGui::TextWrapped("%s", text.c_str());
  ImGui::PopStyleColor();
}

void push_chosen(Rgb law) {
  ImGui::PushStyleColor(ImGuiCol_Button, colour_vector(law));
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered, colour_vector(law));
  ImGui::PushStyleColor(ImGuiCol_FrameBg, colour_vector(law));
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(text_on(law)));
}

// Draws a button for each law but those for comparison.
void kind_buttons(Parameters& p) {
  const Palette& colours = palette(current_theme());
  std::vector<CouplingKind> laws;
  for (std::uint8_t i = 0; i < kLaws; ++i) {
    if (!info(CouplingKind{i}).for_comparison) laws.push_back(CouplingKind{i});
  }
  const auto count = static_cast<float>(laws.size());
  const float gap = ImGui::GetStyle().ItemSpacing.x, whole = ImGui::GetContentRegionAvail().x;
  // Buttons are as wide as their words, with the rest of the width shared; two of them fit side by
  // side into the narrowest panel.
  float left = whole - gap * (count - 1);
  for (const CouplingKind kind : laws) left -= ImGui::CalcTextSize(info(kind).label).x;
  const bool pairs = left < 0;
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, ImGui::GetStyle().FramePadding.y});
  for (const CouplingKind& kind : laws) {
    const bool chosen = p.kind == kind;
    const Rgb law = law_ink(colours, static_cast<int>(kind));
    const bool begins = kind == laws.front() || (pairs && &kind - laws.data() == 2);
    if (!begins) ImGui::SameLine();
    if (chosen) push_chosen(law);
    const float words = ImGui::CalcTextSize(info(kind).label).x;
    const ImVec2 size(pairs ? (whole - gap) / 2 : words + left / count,
                      ImGui::GetFrameHeight() * 1.2f);
    if (ImGui::Button(info(kind).label, size)) p.kind = kind;
    if (chosen) ImGui::PopStyleColor(4);
    underline_button(law);
    tooltip(fmt::format("{}: {} C switches.", info(kind).label, info(kind).meaning).c_str());
  }
  ImGui::PopStyleVar();
}

// Draws the list of the laws for comparison: the field's own, beside those with buttons.
void comparison_list(Parameters& p) {
  const Palette& colours = palette(current_theme());
  const LawInfo& now = info(p.kind);
  ImGui::SetNextItemWidth(-1);
  if (now.for_comparison) push_chosen(law_ink(colours, static_cast<int>(p.kind)));
  const bool open =
      ImGui::BeginCombo("##comparison", now.for_comparison ? now.label : "For comparison",
                        ImGuiComboFlags_HeightLarge);
  if (now.for_comparison) ImGui::PopStyleColor(4);
  if (!open) {
    tooltip("Laws of other programs and papers, for comparison. They run live with the same hand.");
    return;
  }
  for (std::uint8_t i = 0; i < kLaws; ++i) {
    const auto kind = static_cast<CouplingKind>(i);
    if (!info(kind).for_comparison) continue;
    if (ImGui::Selectable(info(kind).label, p.kind == kind)) p.kind = kind;
    tooltip(fmt::format("{}: {}", info(kind).label, info(kind).meaning).c_str());
    ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(colours.muted));
    ImGui::TextUnformatted(info(kind).verdict);
    ImGui::PopStyleColor();
  }
  ImGui::EndCombo();
}

void law_choice(Parameters& p, bool for_comparison) {
  kind_buttons(p);
  if (for_comparison || info(p.kind).for_comparison) comparison_list(p);
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(palette(current_theme()).muted));
  // The verdict has the same height for every law, so that nothing below it moves.
  const float below = ImGui::GetCursorPosY() + 2 * ImGui::GetTextLineHeightWithSpacing();
  ImGui::TextWrapped("%s", info(p.kind).verdict);
  ImGui::SetCursorPosY(below);
  ImGui::PopStyleColor();
}

// Returns whether few people change the parameter: those that tie device and proxy, and its energy.
bool advanced(std::string_view key) {
  return key == "coupling.k_vc" || key == "coupling.b_vc" || key == "coupling.b_v" ||
         key == "coupling.per_joint" || key == "coupling.band" || key == "ledger.energy" ||
         key == "tank.energy" || key == "tank.damping";
}
bool of_link(std::string_view key) { return key.starts_with("link."); }

// Draws whether the gains suit the arm, and a button that makes them suit it.
void draw_fit(Parameters& p, const ArmDescription& arm, const Analysis& a) {
  Parameters fit = p;
  const Parameters own = fitted(arm, fit, a.delay, p);
  for (const char* key : kFittedKeys) {
    const ParameterInfo& info = *find_parameter(key);
    set_parameter_number(fit, info, parameter_number(own, info));
  }
  const std::string text = fit_text(own);
  const char* const help =
      "Gains computed from the arm's damping b_d, the arm's delay and the link's delay. With these "
      "k_vc, b_vc and b_v condition (3) of the paper is just met. With this \xCE\xB1 the limit "
      "\xCE\xB7_min equals the paper's limit. If the arm's file gives no damping, Limpid assumes a "
      "damping that suits the arm's inertia.";
  if (fit == p) {
    read_out("Gains for this arm", text.empty() ? "the paper's" : "fitted", {}, help);
    return;
  }
  if (ImGui::Button("Fit gains to this arm", {ImGui::GetContentRegionAvail().x, 0})) p = fit;
  tooltip((std::string(help) + (text.empty() ? "\nThe paper's gains suit this arm." : "\n" + text))
              .c_str());
}

// Draws a delay between device and proxy, as if the world were far away.
void draw_link(Parameters& p) {
  const std::string set = p.linked() ? fmt::format("Link: {} ticks, {:.4g} ms each way###link",
                                                   p.link_delay, 1e3 * p.tick * p.link_delay)
                                     : "Link###link";
  if (!section(set.c_str(), false)) return;
  if (!info(p.kind).knows_link()) {
    muted(fmt::format("This law {}. It has no link.", info(p.kind).on_device
                                                          ? "renders walls on the device itself"
                                                          : "solves device and proxy together"));
    return;
  }
  for (const std::string_view key : info(p.kind).sliders) {
    if (of_link(key)) slider(p, key.data());
  }
  if (p.linked()) read_out("Link", info(p.kind).through_link);
}

// Returns whether the law's passivity is a matter of conditions on its gains.
bool has_conditions(const LawInfo& law) {
  return law.promise == Promise::condition3 || law.promise == Promise::eta_min;
}

void draw_sliders(Parameters& p, const Analysis& a, const ArmDescription& arm) {
  // Condition (3) does not apply to the tanks, nor to laws that solve both sides together, unless
  // linked.
  const LawInfo& law = info(p.kind);
  const bool asked = has_conditions(law) || (law.solves_together && !p.linked());
  const std::string device = asked ? device_broken(p, a) : "";
  const std::string proxy = asked ? proxy_broken(p, a) : "";
  const Eigen::VectorXd b_d = device_damping(arm, p);
  const bool all_alike = b_d.minCoeff() == b_d.maxCoeff();
  const auto draw = [&](bool which) {
    for (const std::string_view key : info(p.kind).sliders) {
      if (advanced(key) != which || of_link(key)) continue;
      if (key == "coupling.per_joint" && all_alike && !p.per_joint) continue;
      const bool of_device = key == "coupling.k_vc" || key == "coupling.b_vc";
      if (key == "coupling.eta") {
        eta_slider(p, a);
        continue;
      }
      slider(p, key.data(), key == "coupling.b_v" ? proxy : of_device ? device : std::string());
    }
  };
  draw(false);
  const bool broken = !device.empty() || !proxy.empty();
  if (!law.on_device &&
      section(broken ? "Advanced: condition (3) broken###advanced" : "Advanced###advanced",
              false)) {
    draw(true);
    draw_fit(p, arm, a);
  }
  draw_link(p);
}

// Draws the observer's bandwidth and the least inertia that is passive and stable with it.
void draw_observer(const Parameters& p, const Analysis& a) {
  const auto [slow, fast] = std::minmax_element(a.w_f.begin(), a.w_f.end());
  read_out("Observer bandwidth \xCF\x89_f", fmt::format("{:.0f} to {:.0f} rad/s", *slow, *fast), {},
           "\xCE\xB1 / m, equation (18), for each mode of the inertia in the rest pose");
  read_out("Least passive \xCE\xB7, \xCE\xB7_min",
           fmt::format("{:.3f}  {}", a.eta_min, a.above_eta_min ? "ok" : "broken"),
           eta_broken(p, a),
           "\xCF\x89_f / (\xCF\x89_c + \xCF\x89_f) with b = b_d + b_v, equation (25)");
  const std::string unstable =
      p.eta < a.eta_min_compliant
          ? fmt::format(
                "\xCE\xB7 {:.3g} is below {:.3f}, the limit of this grip. The loop is unstable "
                "while the hand holds the device. Raise \xCE\xB7 or soften the grip.",
                p.eta, a.eta_min_compliant)
          : std::string();
  read_out("Least stable \xCE\xB7 in this grip", fmt::format("{:.3f}", a.eta_min_compliant),
           unstable,
           "Below this \xCE\xB7 the loop is unstable in a hand of this stiffness and damping "
           "(Routh's limit, with the proxy behind the coupling's spring)");
}

void draw_passivity(const Parameters& p, const Analysis& a, bool real) {
  const std::string device = device_broken(p, a);
  const std::string proxy = proxy_broken(p, a);
  heading("Passivity");
  if (a.measured || real) {
    read_out(
        "These figures are", a.measured ? "measured" : "assumed", {},
        a.measured
            ? "The values below follow from the inertia, damping and delay that `limpid "
              "identify` measured on this device."
            : "The values below follow from the inertia and damping in the arm's file, and from "
              "the delay that is set. `limpid identify` measures inertia, damping and delay.");
  }
  if (info(p.kind).observes) draw_observer(p, a);
  const auto verdict = [](const std::string& broken, double margin) {
    return broken.empty() ? fmt::format("ok  {:+.2g}", std::abs(margin) < 1e-12 ? 0.0 : margin)
                          : fmt::format("broken  {:+.2g}", margin);
  };
  read_out("Condition (3), device", verdict(device, a.condition3.device_margin), device,
           ("b_d minus (" + device_needs(p, a) +
            ") [N m s/rad]. The condition is met while this difference is not negative.")
               .c_str());
  read_out("Condition (3), proxy", verdict(proxy, a.condition3.proxy_margin), proxy,
           ("b_v minus (" + proxy_needs(p, a) +
            ") [N m s/rad]. The condition is met while this difference is not negative.")
               .c_str());
}

// Part of its force or damping that a law renders, 0 to 1, and why it is less than the whole.
struct Share {
  const char* label;
  double part;
  const char* cut;
  const char* meaning;
};

std::vector<Share> shares_of(const CouplingReading& now, const LawInfo& law) {
  if (law.promise == Promise::tanks) {
    return {{"Proxy moves freely", now.contact_governor,
             "The proxy's energy tank is low. A damper keeps the proxy from using more energy than "
             "the tank holds.",
             "The proxy's own damping, divided by the sum of this damping and the damper that the "
             "tank adds"},
            {"Torque rendered", now.torque_governor,
             "The device's energy tank is low. The law renders only as much torque as the tank has "
             "energy for. Moving the device fills the tank.",
             "100 % while the device's tank has enough energy for the next tick"}};
  }
  if (law.keeps_ledger()) {
    return {{"Wall force rendered", now.contact_governor,
             "The reserve is low. The energy account reduces the wall's force, so that the energy "
             "given stays limited. Softer walls, a finer encoder or a known delay (model.delay) "
             "keep the reserve high.",
             "Share of the wall's force: 100 % unless the reserve is low. While the reserve is "
             "low the proxy separates from the device."},
            {"Damping removed", now.damping_governor,
             "The reserve is low. The law cancels a smaller part of the device's damping.",
             "Share of the damping cancellation that the energy account allows"},
            {"Torque rendered", now.torque_governor,
             "The hand has received nearly all the energy that the energy account allows. There is "
             "no torque until the hand has given energy back. Switching the force on again, or "
             "starting the loop again, fills the account. A known delay (model.delay) or a lower "
             "stiffness avoids this loss of torque.",
             "Share of all torque: 100 % unless the hand received nearly 5 mJ more than it gave"}};
  }
  std::vector<Share> all;
  if (law.torque_share != nullptr) {
    all.push_back(
        {"Torque rendered", now.torque_governor,
         "The law reduces the walls' torque. The walls feel softer than the stiffness that is set.",
         law.torque_share});
  }
  if (law.damper_share != nullptr) {
    all.push_back({"Damper not needed", now.damping_governor,
                   "A damper removes energy that the walls gave.", law.damper_share});
  }
  return all;
}

bool whole(const Share& share) { return share.part >= 0.995; }

void draw_share(const Share& share) {
  read_out(share.label, fmt::format("{:.0f} %", 100 * share.part), whole(share) ? "" : share.cut,
           share.meaning);
}

// Draws the energy that the law accounts for, and what it holds back.
void draw_account(const CouplingReading& now, const LawInfo& law) {
  const std::vector<Share> shares = shares_of(now, law);
  if (law.promise == Promise::tanks) {
    heading("Energy tanks");
    read_out("In both tanks", energy_text(now.reserve), {},
             "Energy in the device's tank, in the proxy's tank and on the link between the tanks. "
             "The law may still give this energy.");
  } else if (law.keeps_ledger()) {
    heading("Energy account");
    read_out("Reserve", energy_text(now.reserve), {},
             "Energy that the law may still give the hand. Dissipated energy raises this reserve, "
             "up to 20 mJ.");
  } else if (!shares.empty()) {
    heading(law.label);
  }
  for (const Share& share : shares) draw_share(share);
}

// Tells which settings were changed while recording. The re-run makes these changes as well, but
// for settings that begin otherwise.
void tell_changes(const Parameters& p, const Parameters& recorded,
                  const std::vector<std::string>& on_the_way) {
  std::string again, left_out;
  for (const ParameterInfo& info : parameter_table()) {
    if (std::ranges::find(on_the_way, info.key) == on_the_way.end()) continue;
    std::string& into =
        parameter_text(p, info) == parameter_text(recorded, info) ? again : left_out;
    into += (into.empty() ? "" : ", ") + std::string(info.caption);
  }
  if (!again.empty()) {
    muted(fmt::format(
        "In the recording these settings change after the start: {}. The re-run makes the same "
        "changes. The settings below are those of the start.",
        again));
  }
  if (!left_out.empty()) {
    muted(fmt::format(
        "In the recording, {} changes after the start. The re-run keeps its own value from "
        "the start to the end.",
        left_out));
  }
}

// Draws what a re-run will change, and buttons that take all settings of the recording or the loop.
void draw_differences(Parameters& p, const RecordedCoupling& recording, const Parameters& live) {
  const Parameters& recorded = recording.began;
  const auto shown = [](std::string text) {
    std::erase(text, '"');
    return text.empty() ? "the arm's" : text;
  };
  const std::vector<const ParameterInfo*> changed = differing(recorded, p);
  for (const ParameterInfo* info : changed) {
    read_out(info->caption,
             fmt::format("{} \xE2\x86\x92 {}", shown(parameter_text(recorded, *info)),
                         shown(parameter_text(p, *info))),
             {}, "Left: the value in the recording. Right: the value in the re-run.");
  }
  if (changed.empty()) {
    muted("All settings are as recorded. Change a setting, then press E to see the effect.");
  }
  tell_changes(p, recorded, recording.changed);
  const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  ImGui::BeginDisabled(changed.empty());
  if (ImGui::Button("As recorded", {half, 0})) p = recorded;
  note_place("As recorded");
  ImGui::EndDisabled();
  tooltip("Cancels all changes of settings for the re-run.");
  ImGui::SameLine();
  if (ImGui::Button("Take mine", {half, 0})) p = live;
  note_place("Take mine");
  tooltip("Uses all settings of the live loop for the re-run.");
  ImGui::Spacing();
}

// Draws what came of the re-runs so far, a line each, the recording first.
void draw_tried(std::span<const RunFigures> tried) {
  if (tried.empty() || !ImGui::BeginTable("tried", 4, ImGuiTableFlags_BordersInnerH)) return;
  ImGui::TableSetupColumn("run", ImGuiTableColumnFlags_WidthStretch);
  for (const char* column : {"error", "contact", "E_c"}) {
    ImGui::TableSetupColumn(column, ImGuiTableColumnFlags_WidthFixed);
  }
  const auto cell = [](const std::string& text, const char* help = nullptr) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(text.c_str());
    if (help != nullptr) tooltip(help);
  };
  const RunFigures& first = tried.front();
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  cell("Run");
  cell(fmt::format("error\n{}", first.error_unit),
       "Largest distance between device and proxy, |x_E|");
  cell(fmt::format("contact\n{}", first.contact_unit), "Largest contact force on the proxy, |f2|");
  cell("E_c\nmJ", "Highest controller energy E_c");
  for (const RunFigures& run : tried) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextWrapped("%s", run.name.c_str());
    for (const double value : {run.error, run.contact, 1e3 * run.energy}) {
      cell(fmt::format("{:.3g}", value));
    }
  }
  ImGui::EndTable();
  ImGui::Spacing();
}

// Draws a count of ticks or points in which something was not right, if there were any.
void draw_count(const char* label, double count, const char* why) {
  if (count > 0) read_out(label, fmt::format("{:.0f}", count), why, why);
}

// Draws in how many ticks forces were not found, if there were any.
void draw_unsolved(const CouplingReading& now) {
  draw_count("Ticks without a solution", now.unsettled,
             "In these ticks the solver found no forces that fit both the contacts and the motors "
             "at their limit. Limpid held the proxy still for these ticks, which is passive. To "
             "avoid such ticks, use softer walls, fewer walls at a time, less friction or stronger "
             "motors.");
  draw_count("Contact points left out", now.left_out,
             "Objects touch at more points than the loop can compute. Limpid leaves some of these "
             "points out: there the objects do not push, and they may sink into each other. To "
             "avoid this error, use fewer objects that lie on each other.");
  draw_count("Ticks in which Limpid held objects still", now.stood_still,
             "In these ticks the solver found no forces for a mechanism (objects on joints). "
             "Limpid held these objects still for the tick, which can only remove energy. To avoid "
             "such ticks, use masses that differ less, softer end stops or a shorter tick.");
  draw_count("Ticks in which Limpid slowed objects", now.turned_less,
             "A mechanism moved so fast that one of its bodies would have turned by more than one "
             "radian in a tick. The body turned by one radian and lost the rest of its energy. To "
             "avoid such ticks, use heavier bodies, softer springs or a shorter tick.");
}

// Returns a way out of a coupling that gives energy.
const char* way_out(const Parameters& p) {
  if (info(p.kind).on_device)
    return "Remedy: use a softer wall, a hand with more damping, or the predictive law.";
  if (p.linked())
    return "Remedy: use a shorter link delay, a softer k_vc, more damping, or the tank law.";
  return info(p.kind).observes
             ? "Remedy: raise \xCE\xB7, lower the observer's gain, or use the predictive law."
             : "Remedy: use a softer k_vc, more damping (condition (3)), or the predictive law.";
}

// Returns why the coupling's own part of E_c is a fault; empty if it is none.
std::string own_fault(const CouplingReading& now, const Parameters& p) {
  const double own = now.energy.own();
  // A law with a ledger makes another promise, which the ledger shows; so does one of the port.
  const LawInfo& law = info(p.kind);
  if (law.keeps_ledger() || law.promise == Promise::port || own <= kGivenEnergy) return {};
  return fmt::format(
      "The coupling has given {} more energy than it received. The coupling is not passive in this "
      "grip.\n{}",
      energy_text(own), way_out(p));
}

// Draws the sources of E_c; only the coupling's own part is judged.
void draw_givers(const CouplingReading& now, const Parameters& p) {
  const EnergyAccount& energy = now.energy;
  read_out("The coupling's own", energy_text(energy.own()), own_fault(now, p),
           "The part of E_c that the coupling itself gave. This part stays below zero while the "
           "coupling is passive. Energy from switching laws and from motors at their limit is "
           "counted separately.");
  const auto apart = [](const char* label, double joules, const char* help) {
    if (std::abs(joules) > kGivenEnergy) read_out(label, energy_text(joules), {}, help);
  };
  apart(
      "From switching", energy.by_changes(),
      "The part of E_c from changes of law and settings. A change while the coupling is stretched "
      "adds energy, just as bending a spring stores energy. This is not a fault of the coupling.");
  apart("From the spring at the start", energy.stored(),
        "The part of E_c that the coupling's spring held when this run began. The spring gives "
        "this energy back when the spring relaxes. This is not a fault of the coupling.");
  apart("Before the last change", energy.forgiven(),
        "The part of E_c that the coupling gave with earlier settings.");
  apart("From compensation, grip test", now.compensation,
        "The part of E_c that the motors gave for the device's weight, springs and friction, and "
        "for the test force that measures the grip.");
  apart(
      "Energy by motors at their limit or off", energy.by_limits(),
      "A motor that is at its limit, or off, gives a different torque than the coupling asks for. "
      "This is the part of the energy E_c that comes from these motors. It is not a fault of the "
      "coupling.");
}

// Draws E_c as in the plots, and its sources.
void draw_energy(const CouplingReading& now, const Parameters& p) {
  read_out("Controller energy E_c", energy_text(now.energy_total), {},
           "Energy that the coupling gave since the start, minus the energy that the device's own "
           "damping removed. The plots show the same E_c. The lines below name the sources of this "
           "energy.");
  draw_givers(now, p);
}

void draw_limited(const CouplingReading& now) {
  const std::vector<int>& joints = now.limited;
  if (!now.warm.empty()) ImGui::TextWrapped("%s", now.warm.c_str());
  if (joints.empty()) return;
  std::string text;
  for (const int joint : joints) {
    text += fmt::format("{}joint {}", text.empty() ? "" : ", ", joint + 1);
  }
  read_out("Motor at its limit", text, {},
           "The coupling asks for more torque than the motor can give (section 3.1 of the paper). "
           "Press less hard, or raise Device > Motors' largest torque.");
  if (now.contact > 0 && !now.chatters) {
    constexpr double kApart = 1e-3;  // gap that is seen [m]
    ImGui::TextWrapped("%s", now.gap > kApart
                                 ? "The hand presses harder than the motors can push, so hand and "
                                   "avatar move apart. Press less hard."
                                 : "The hand presses harder than the motors can push, so the hand "
                                   "feels less than the contact force. Press less hard.");
  }
}

void draw_break(bool broken, const Act& act) {
  const char* const label = broken ? "Repair" : "Break passivity";
  const bool pressed = ImGui::Button(label, {ImGui::GetContentRegionAvail().x, 0});
  note_place(label);
  if (pressed) {
    act(broken ? "coupling.end_break" : "coupling.break_passivity");
  }
  tooltip(broken
              ? "Puts all settings back as they were before this change. C, Ctrl+Z and a change "
                "of law, scene, arm or recording do the same."
              : "Sets the proposed law, a stiff grip without damping, and a scaling \xCE\xB7 so "
                "small that the loop gives more and more energy. While a hand holds the arm, the "
                "arm begins to tremble, and E_c rises. The button Repair puts all settings back.");
}

// Draws the inertia felt, of a law that scales it.
void draw_eta(Parameters& p, const Analysis& a) {
  if (info(p.kind).has("coupling.eta")) eta_slider(p, a);
}

// Draws whether the law is passive with these settings, in a word. What was measured outweighs what
// theory says: it has no encoder steps.
void draw_passive(const CouplingReading& now, const Parameters& p, const Analysis& a) {
  const Passivity found = passivity(a, p);
  const std::string theory_too =
      found.passive == true ? fmt::format("\nTheory says yes: {}.", found.by) : std::string();
  if (now.chatters && found.passive != false) {
    return read_out("Passive", "no, the loop chatters",
                    fmt::format("The loop vibrates and gains energy.\n{}", way_out(p)) + theory_too,
                    "");
  }
  const std::string measured = own_fault(now, p);
  if (!measured.empty() && found.passive != false) {
    return read_out("Passive", "no, as measured", measured + theory_too, "");
  }
  if (!found.passive) return read_out("Passive", "not known", {}, found.by.c_str());
  const std::string broken =
      *found.passive ? ""
                     : fmt::format("The coupling can give energy without limit. Reason: {}.\n{}",
                                   found.by, way_out(p));
  read_out("Passive", *found.passive ? "yes" : "no", broken,
           fmt::format("Why: {}.", found.by).c_str());
}

// Draws how far device and proxy are apart, and the scene's push on the proxy.
void draw_apart(const CouplingReading& reading) {
  read_out("Apart at the tip", fmt::format("{:.2f} mm", 1e3 * reading.gap), {},
           "Distance between the tip of your device and the tip of its avatar, the proxy.");
  read_out("Apart in the joints",
           fmt::format("{:.2f} m{}", 1e3 * reading.error, reading.error_unit), {},
           "Coordination error |x_E|: joint angles of the device minus joint angles of the proxy. "
           "The first plot shows |x_E|.");
  read_out("Contact force",
           fmt::format("{:.2f} N{}", reading.contact, reading.carries ? " + magnet" : ""), {},
           "Force with which the scene pushes the proxy. The hand feels less force while a motor "
           "is at its limit, while the force is off, or while the law reduces the torque. If the "
           "magnet holds an object, this value does not include the object's force. The plots "
           "include it in f2.");
}

void draw_show(const char* label, const char* help, const Act& act) {
  if (ImGui::Button(label, {ImGui::GetContentRegionAvail().x, 0})) act("view.everything");
  note_place(label);
  tooltip(help);
}

}  // namespace

void draw_reading(const CouplingReading& reading, const Parameters& p, const Analysis& analysis) {
  draw_apart(reading);
  draw_account(reading, info(p.kind));
  draw_unsolved(reading);
  draw_energy(reading, p);
  draw_passive(reading, p, analysis);
  draw_limited(reading);
}

void draw_simple_reading(const CouplingReading& reading, const Parameters& p,
                         const CouplingSituation& now) {
  draw_apart(reading);
  read_out(
      "Controller energy E_c", energy_text(reading.energy_total), own_fault(reading, p),
      "E_c is the energy that the coupling gave since the start. A passive coupling keeps E_c "
      "below zero. But a change of law, or a motor at its limit, can also add energy. If E_c is "
      "above zero, lines below the buttons name its sources. The second plot shows E_c.");
  draw_passive(reading, p, now.analysis);
}

void draw_simple_notes(const CouplingReading& reading, const Parameters& p) {
  for (const Share& share : shares_of(reading, info(p.kind))) {
    if (!whole(share)) draw_share(share);
  }
  if (reading.energy_total > kGivenEnergy) draw_givers(reading, p);
  draw_unsolved(reading);
  draw_limited(reading);
}

void draw_coupling(Parameters& p, const CouplingSituation& now, const CouplingReading& reading,
                   const Act& act) {
  law_choice(p, now.everything);
  ImGui::Spacing();
  if (!now.everything) {
    draw_eta(p, now.analysis);
    draw_simple_reading(reading, p, now);
    if (!now.real) draw_break(now.broken, act);
    draw_show(
        "Show all",
        "Shows all settings and figures: gains, passivity, energy and analysis. F8 does the same.",
        act);
    draw_simple_notes(reading, p);
    return;
  }
  draw_sliders(p, now.analysis, now.arm);
  if (!now.real) draw_break(now.broken, act);
  if (has_conditions(info(p.kind))) draw_passivity(p, now.analysis, now.real);
  draw_reading(reading, p, now.analysis);
  draw_show("Show less",
            "Shows only what a beginner needs in the first hour. F8 switches between this and all "
            "settings.",
            act);
}

void draw_coupling_of_rerun(Parameters& p, const RecordedCoupling& recording,
                            const Parameters& live, const CouplingSituation& now) {
  draw_differences(p, recording, live);
  draw_tried(recording.tried);
  law_choice(p, now.everything);
  ImGui::Spacing();
  if (!now.everything) return draw_eta(p, now.analysis);
  draw_sliders(p, now.analysis, now.arm);
  if (has_conditions(info(p.kind))) draw_passivity(p, now.analysis, now.real);
}

}  // namespace limpid
