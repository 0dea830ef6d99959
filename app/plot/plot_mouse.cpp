// What the mouse does in a plot.
#include <imgui_internal.h>

#include <cmath>

#include "app/plot/plot.h"

namespace limpid {
namespace {

constexpr double kWheelStep = 1.18;
constexpr float kGrip = 5;  // how close to the playback line a drag takes it [px]

}  // namespace

void Plot::ValueAxis::zoom(double factor, double part) {
  const double around = limits.low + part * limits.span();
  const Limits wanted{around + (limits.low - around) * factor,
                      around + (limits.high - around) * factor};
  // Beyond that, single precision runs out.
  const double finest = 1e-6 * std::max({std::abs(wanted.low), std::abs(wanted.high), 1e-12});
  if (wanted.span() < finest || wanted.span() > 1e12) return;
  follows = false;
  limits = wanted;
}

void Plot::ValueAxis::pan(double parts) {
  if (parts == 0) return;
  const double by = parts * limits.span();
  limits = {limits.low + by, limits.high + by};
  follows = false;
}

void Plot::handle_mouse(const PlotFrame& frame, const History& history, PlotGroup& group,
                        PlotEvents& events) {
  const ImVec2 mouse = ImGui::GetMousePos();
  hovered_curve_ = hovered_ ? legend_.curve_at(mouse) : -1;
  if (hovered_ && hovered_curve_ >= 0 && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
    Curve& curve = spec_.curves[static_cast<std::size_t>(hovered_curve_)];
    curve.visible = !curve.visible;
    return;
  }
  handle_drag(frame, group, events);
  if (!hovered_) return;
  if (hovered_curve_ < 0 && frame.area.contains(mouse)) point_at(frame, history, group, mouse);
  handle_wheel(frame, group);
  if (hovered_curve_ < 0 && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
    group.fit();
    fit_values();
    drag_ = Drag::none;
  }
}

void Plot::point_at(const PlotFrame& frame, const History& history, PlotGroup& group,
                    ImVec2 mouse) {
  switch (spec_.kind) {
    case PlotKind::time: group.hover(frame.x_at(mouse.x)); break;
    case PlotKind::cross:
      if (const auto time = time_near(frame, spec_, history, mouse)) group.hover(*time);
      break;
    case PlotKind::spectrum: group.hover_frequency(frame.x_at(mouse.x)); break;
  }
}

void Plot::handle_wheel(const PlotFrame& frame, PlotGroup& group) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.MouseWheel == 0) return;
  const double factor = std::pow(kWheelStep, -static_cast<double>(io.MouseWheel));
  const bool on_values = io.KeyCtrl || io.MousePos.x < frame.area.min.x;
  const bool on_across = !on_values && io.MousePos.y > frame.area.max.y;
  if (on_values || (spec_.kind == PlotKind::cross && !on_across)) {
    y_.zoom(factor, (frame.area.max.y - io.MousePos.y) / frame.area.height());
  }
  if (on_values) return;
  if (over_time()) return group.zoom(factor, frame.x_at(io.MousePos.x));
  x_.zoom(factor, (io.MousePos.x - frame.area.min.x) / frame.area.width());
}

void Plot::handle_drag(const PlotFrame& frame, PlotGroup& group, PlotEvents& events) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool near_playback =
      over_time() && group.playback() && frame.area.contains(io.MousePos) &&
      std::abs(frame.x_of(*group.playback()) - io.MousePos.x) < kGrip * frame.scale;
  if (hovered_ && near_playback) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  if (ImGui::IsItemActivated()) {
    drag_ = near_playback                      ? Drag::playback
            : io.MousePos.x < frame.area.min.x ? Drag::values
            : hovered_curve_ < 0               ? Drag::pan
                                               : Drag::none;
  }
  if (!ImGui::IsItemActive()) {
    drag_ = Drag::none;
    return;
  }
  if (drag_ == Drag::playback) events.playback = frame.x_at(io.MousePos.x);
  if (!ImGui::IsMouseDragging(ImGuiMouseButton_Left, 2)) return;
  if (drag_ == Drag::pan) {
    pan(frame, group, io.MouseDelta);
  } else if (drag_ == Drag::values) {
    y_.pan(io.MouseDelta.y / frame.area.height());
  }
}

void Plot::pan(const PlotFrame& frame, PlotGroup& group, ImVec2 by) {
  if (over_time()) {
    if (by.x != 0) group.pan(-by.x * frame.window.per_pixel);
    if (y_.follows) return;
  } else {
    x_.pan(-by.x / frame.area.width());
  }
  if (spec_.kind == PlotKind::spectrum && y_.follows) return;
  y_.pan(by.y / frame.area.height());
}

}  // namespace limpid
