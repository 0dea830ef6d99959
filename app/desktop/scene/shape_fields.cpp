#include "app/desktop/scene/shape_fields.h"

#include <fmt/format.h>
#include <imgui.h>

#include <array>
#include <cmath>
#include <numbers>

#include "app/desktop/scene/scene_panel.h"
#include "app/desktop/widgets/modal.h"
#include "app/style/sliders.h"
#include "app/style/words.h"
#include "devices/files/rpy.h"

namespace limpid {
namespace {

const Vec3 kFirstColor = Vec3::Constant(0.6);

// A unit in which people write the numbers of another.
struct ShownUnit {
  std::string_view unit;
  double of_one;  // shown number for one of `unit`
  const char* format;
  double pace;   // least change per pixel of a drag, as shown
  double least;  // where 0 is not allowed, as shown
};
constexpr std::array kShownUnits{
    ShownUnit{"m", 1e3, "%.2f mm", kMillimetreSpeed, 0.1},
    ShownUnit{"kg", 1e3, "%.4g g", 0.01, 1e-3},
    ShownUnit{"rad", 180 / std::numbers::pi, "%.1f\xC2\xB0", kDegreeSpeed, 0.1}};

std::string_view unit_of(const FieldInfo& field, bool turns) {
  constexpr std::string_view kOr = " or ";
  const std::string_view unit = field.unit;
  const std::size_t at = unit.find(kOr);
  if (at == unit.npos) return unit;
  return turns ? unit.substr(at + kOr.size()) : unit.substr(0, at);
}

bool drag_value(const FieldInfo& field, double& value, bool turns) {
  const std::string_view unit = unit_of(field, turns);
  const auto* known = std::ranges::find(kShownUnits, unit, &ShownUnit::unit);
  const std::string plain = fmt::format("%.6g {}", unit);
  const ShownUnit as =
      known == kShownUnits.end() ? ShownUnit{unit, 1, plain.c_str(), 0.01, 1e-6} : *known;
  const double of_one = as.of_one;
  std::string format = as.format;
  // A number without an upper end may be left out, which is shown as 0.
  const bool endless = std::isinf(field.maximum);
  double shown = endless && std::isinf(value) ? 0 : of_one * value;
  if (endless && shown == 0) format = "never";
  const double pace = std::max(as.pace, 0.005 * std::abs(shown));
  const double least =
      field.exclusive_minimum ? of_one * field.minimum + as.least : of_one * field.minimum;
  if (!drag_number(field.caption, shown, pace, endless ? 0 : least,
                   of_one * std::min(field.maximum, 1e9), format.c_str(), field.meaning)) {
    return false;
  }
  value = endless && shown == 0 ? field.maximum : shown / of_one;
  return true;
}

}  // namespace

bool edit_value(const FieldInfo& field, double& value, double usual, bool turns) {
  if (field.kind == FieldInfo::Kind::flag) {
    bool on = value != 0;
    const bool changed = ImGui::Checkbox(field.caption, &on);
    tooltip(field.meaning);
    value = on ? 1 : 0;
    return changed;
  }
  if (field.slider_maximum > field.slider_minimum) return value_slider(field, value, usual);
  return drag_value(field, value, turns);
}

std::string_view edit_size(Shape& shape) {
  if (std::holds_alternative<Mesh>(shape)) return {};
  if (auto* box = std::get_if<Box>(&shape)) {
    Vec3 size = 1e3 * box->size;
    if (!drag3("Size x, y, z [mm]", size, kMillimetreSpeed, 0.1, 1e4, "%.1f", "Full edges")) {
      return {};
    }
    box->size = 1e-3 * size;
    return "size";
  }
  return std::visit([](auto& s) { return edit_fields(fields_of(s), s); }, shape);
}

bool edit_color(std::optional<Vec3>& color, const char* otherwise) {
  bool own = color.has_value();
  bool changed = ImGui::Checkbox("a colour of its own", &own);
  note_place("a colour of its own");
  tooltip(otherwise);
  if (changed) color = own ? std::optional(kFirstColor) : std::nullopt;
  if (!color) return changed;
  std::array<float, 3> parts{};
  for (std::size_t i = 0; i < 3; ++i) {
    parts[i] = static_cast<float>((*color)[static_cast<int>(i)]);
  }
  ImGui::SetNextItemWidth(-1);
  if (ImGui::ColorEdit3("##color", parts.data())) {
    for (std::size_t i = 0; i < 3; ++i) {  // no more digits than people write
      (*color)[static_cast<int>(i)] = std::round(1e3 * static_cast<double>(parts[i])) / 1e3;
    }
    changed = true;
  }
  tooltip("Red, green and blue, 0 to 255. A click on the square opens a choice.");
  return changed;
}

bool RotationField::edit(Pose& pose) {
  if (pose.linear() != turned_) {
    turned_ = pose.linear();
    degrees_ =
        (rpy_of(turned_) * (180 / std::numbers::pi) * 1e6).array().round() / 1e6 + 0.0;  // not -0
  }
  if (!drag3("Rotation roll, pitch, yaw [\xC2\xB0]", degrees_, kDegreeSpeed, -360, 360, "%.1f",
             "Turned about the fixed axes x, y and z, in this order.")) {
    return false;
  }
  turned_ = settled(rotation(degrees_ * (std::numbers::pi / 180)));
  pose.linear() = turned_;
  return true;
}

}  // namespace limpid
