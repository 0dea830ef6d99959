#include "app/desktop/coupling/tick_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "app/desktop/widgets/widgets.h"

namespace limpid {
namespace {

const char* solved_text(double solved) {
  constexpr std::array kTexts{"one after the other", "with motors at their limit", "all at once",
                              "no solution: the proxy stood still"};
  return kTexts[static_cast<std::size_t>(std::clamp(solved, 0.0, 3.0))];
}

std::string millijoules(double joules) { return fmt::format("{:.4f} mJ", 1e3 * joules); }

void draw_contacts(const std::vector<ContactForce>& contacts) {
  if (contacts.empty()) {
    ImGui::TextDisabled("The proxy touches nothing.");
    return;
  }
  constexpr std::array kHeads{"x [mm]", "y [mm]", "z [mm]", "force [N]"};
  if (!ImGui::BeginTable("contacts", static_cast<int>(kHeads.size()),
                         ImGuiTableFlags_BordersInnerH | ImGuiTableFlags_SizingStretchSame)) {
    return;
  }
  for (const char* head : kHeads) ImGui::TableSetupColumn(head);
  ImGui::TableHeadersRow();
  for (const ContactForce& contact : contacts) {
    ImGui::TableNextRow();
    for (const double number : {1e3 * contact.point.x(), 1e3 * contact.point.y(),
                                1e3 * contact.point.z(), contact.force.norm()}) {
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(fmt::format("{:.3f}", number).c_str());
    }
    const Vec3& f = contact.force;
    tooltip(fmt::format("on the proxy: {:.4f}, {:.4f}, {:.4f} N", f.x(), f.y(), f.z()).c_str());
  }
  ImGui::EndTable();
}

}  // namespace

void draw_tick(const Stage& stage, std::span<const double> row) {
  const RowLayout& layout = stage.channels().layout();
  const auto at = [&](Column c) { return layout.in(row, c); };
  const auto one = [&](Column c) { return at(c)[0]; };
  const RowView& rows = stage.rows();
  const auto x1 = at(Column::device_position), x2 = at(Column::proxy_position);
  read_out("t", fmt::format("{:.4f} s", one(Column::time)), {}, "Time at which the tick begins");
  draw_contacts(rows.contacts(layout, row));
  read_out("gap of the tips", fmt::format("{:.4f} mm", 1e3 * (rows.tip(x1) - rows.tip(x2)).norm()),
           {}, "Distance between the tips of device and proxy");
  read_out("force of the motors",
           fmt::format("{:.3f} N", rows.tip_force(x1, at(Column::motor_torque)).norm()), {},
           "Force of the motors on the device's tip, computed from the motors' torques");
  const auto kind = static_cast<CouplingKind>(one(Column::kind));
  if (info(kind).solves_together) {
    read_out("solved", solved_text(one(Column::solved)), {},
             "How the solver found forces that fit contacts, friction and the motors' limits");
    read_out("reserve", millijoules(one(Column::energy_ledger)), {},
             "Energy that the law may still give, according to the energy account");
    read_out("wall force let through", fmt::format("{:.1f} %", 100 * one(Column::governor)));
  }
  if (layout.has(Column::objects_sweeps)) {
    read_out("sweeps", fmt::format("{:.0f}", one(Column::objects_sweeps)), {},
             "How many times the solver went through all contacts until it found the forces on "
             "moving objects");
    read_out("awake", fmt::format("{:.0f} of {}", one(Column::objects_awake), layout.bodies()), {},
             "Number of objects that move, of all movable objects");
    read_out("objects gained", millijoules(one(Column::objects_gain)), {},
             "Energy of the objects, minus their energy at the start and the energy given to the "
             "objects. Below 0: the objects lost energy.");
  }
  read_out("stored in contacts", millijoules(one(Column::contact_potential)));
  read_out("controller, E_c", millijoules(one(Column::energy_total)));
}

}  // namespace limpid
