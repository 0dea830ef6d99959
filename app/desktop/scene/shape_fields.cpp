#include "app/desktop/scene/shape_fields.h"

#include <imgui.h>

#include <array>
#include <cmath>
#include <numbers>

#include "app/desktop/scene/scene_panel.h"
#include "app/desktop/widgets/modal.h"
#include "app/style/words.h"
#include "devices/files/rpy.h"

namespace limpid {
namespace {

const Vec3 kFirstColor = Vec3::Constant(0.6);

}  // namespace

bool drag_length(const char* label, double& value, const char* help) {
  double millimetres = 1e3 * value;
  if (!drag_number(label, millimetres, kMillimetreSpeed, 0.1, 1e3, "%.1f mm", help)) return false;
  value = 1e-3 * millimetres;
  return true;
}

std::string_view edit_size(Sphere& sphere) {
  return drag_length("Radius", sphere.radius, "Of the ball") ? "radius" : "";
}

std::string_view edit_size(Box& box) {
  Vec3 size = 1e3 * box.size;
  if (!drag3("Size x, y, z [mm]", size, kMillimetreSpeed, 0.1, 1e4, "%.1f", "Full edges")) {
    return {};
  }
  box.size = 1e-3 * size;
  return "size";
}

std::string_view edit_size(Cylinder& cylinder) {
  std::string_view what;
  if (drag_length("Radius", cylinder.radius, "Of its faces")) what = "radius";
  if (drag_length("Length", cylinder.length, "From face to face")) what = "length";
  return what;
}

std::string_view edit_size(Capsule& capsule) {
  std::string_view what;
  if (drag_length("Radius", capsule.radius, "Of its round ends")) what = "radius";
  if (drag_length("Length", capsule.length, "Between the middles of its ends")) what = "length";
  return what;
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
             "About the fixed axes x, y and z, one after the other.")) {
    return false;
  }
  turned_ = settled(rotation(degrees_ * (std::numbers::pi / 180)));
  pose.linear() = turned_;
  return true;
}

}  // namespace limpid
