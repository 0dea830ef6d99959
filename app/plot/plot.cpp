#include "app/plot/plot.h"

#include <imgui_internal.h>

#include <cmath>
#include <utility>

#include "app/style/ticks.h"

namespace limpid {
namespace {

constexpr double kNoticeTime = 4;  // [s]
constexpr double kWheelStep = 1.18;
constexpr float kLeastHeight = 84;     // of curves and time axis under the legend [px]
constexpr float kDash = 6;             // [px] at scale 1
constexpr float kGrip = 5;             // how close to the playback line a drag takes it [px]
constexpr int kFramesToCloseMenu = 2;  // so that the menu is not in the picture

}  // namespace

void Plot::fit_values() {
  values_follow_ = true;
  autoscale_.reset();
}

PlotEvents Plot::draw(const History& history, PlotGroup& group, ImVec2 size,
                      const PlotSaving& saving) {
  PlotEvents events;
  ImGui::PushID(this);
  follow_data(history, group);
  choose_unit();
  const PlotFrame frame = lay_out(history, group, size);
  // Also keeps the wheel from scrolling the window around.
  ImGui::InvisibleButton("plot", size, ImGuiButtonFlags_MouseButtonLeft);
  ImGui::SetItemUsingMouseWheel();
  hovered_ = ImGui::IsItemHovered();
  handle_mouse(frame, group, events);
  handle_menu(frame, history, group, saving, events);

  const ImVec2 mouse = hovered_ ? ImGui::GetMousePos() : ImVec2{-1e6f, -1e6f};
  draw_axes(frame, spec_, history.offset());
  // A curve on the axis is seen whole.
  const float rim = 2 * frame.scale;
  frame.list.PushClipRect(frame.area.min, {frame.area.max.x, frame.area.max.y + rim}, true);
  draw_bands(frame, spec_, history, rows_);
  draw_marks(frame, history, mouse);
  draw_curves(frame, history);
  draw_thresholds(frame, spec_);
  if (group.playback()) draw_playback(frame, *group.playback(), drag_ == Drag::playback);
  frame.list.PopClipRect();
  legend_.draw(frame, spec_, hovered_curve_);
  const bool menu_or_png = frames_until_png_ > 0 || ImGui::IsPopupOpen("menu");
  if (group.hovered() && !menu_or_png) {
    draw_read_out(frame, spec_, history, *group.hovered(), hovered_ ? mouse : frame.area.min);
  }
  if (frames_until_png_ > 0) {
    save_png_when_due(frame, saving);
  } else {
    draw_latest_notice(frame);
  }
  ImGui::PopID();
  return events;
}

PlotFrame Plot::lay_out(const History& history, const PlotGroup& group, ImVec2 size) {
  const float scale = current_scale();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 min = ImGui::GetCursorScreenPos();
  const ScreenRect outer{min, {min.x + size.x, min.y + size.y}};
  const float title_end = draw_title(list, outer, scale);
  const float title_bottom = min.y + text_size(Face::semibold, spec_.title).y + 4 * scale;
  const float legend =
      legend_.place(outer, title_end, title_bottom, kLeastHeight * scale, spec_, scale);
  const ImVec2 label = text_size(Face::small, "\u221200.00");
  ScreenRect area{
      {std::round(min.x + label.x + 8 * scale), std::round(title_bottom + legend + 5 * scale)},
      {std::round(outer.max.x - 6 * scale), std::round(outer.max.y - label.y - 6 * scale)}};
  area.max.x = std::max(area.max.x, area.min.x + 8);
  area.max.y = std::max(area.max.y, area.min.y + 8);
  const PixelWindow window =
      pixel_window(group.stop(), group.length(), static_cast<int>(area.width()));
  pixel_rows(history, window, rows_);
  return {list, current_palette(), scale, outer, area, window, y_};
}

void Plot::follow_data(const History& history, const PlotGroup& group) {
  if (std::exchange(run_start_, history.run_start()) != run_start_) fit_values();
  if (!values_follow_) return;
  // What was before the newest run is left behind, unless it is looked at.
  const double from =
      group.following() ? std::max(group.start(), history.run_start()) : group.start();
  Extent data;
  for (const Curve& curve : spec_.curves) {
    if (!curve.visible) continue;
    data.include(history.extent_between(curve.channel, from, group.stop()));
  }
  if (data.empty() && history.empty()) autoscale_.reset();
  if (spec_.zero_line || data.empty()) data.include(0);
  for (const Threshold& each : spec_.thresholds) {
    if (each.always_in_view) data.include(static_cast<float>(each.value));
  }
  y_ = autoscale_.update({data.low, data.high}, spec_.smallest_span,
                         static_cast<double>(ImGui::GetIO().DeltaTime));
}

void Plot::choose_unit() {
  const double largest = std::max(std::abs(y_.low), std::abs(y_.high));
  for (const PlotUnit& unit : spec_.units) {
    spec_.unit = unit.name;
    spec_.factor = unit.factor;
    if (largest <= unit.most) return;
  }
}

void Plot::handle_mouse(const PlotFrame& frame, PlotGroup& group, PlotEvents& events) {
  const ImVec2 mouse = ImGui::GetMousePos();
  hovered_curve_ = hovered_ ? legend_.curve_at(mouse) : -1;
  if (hovered_ && hovered_curve_ >= 0 && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
    Curve& curve = spec_.curves[static_cast<std::size_t>(hovered_curve_)];
    curve.visible = !curve.visible;
    return;
  }
  handle_drag(frame, group, events);
  if (!hovered_) return;
  if (hovered_curve_ < 0 && frame.area.contains(mouse)) group.hover(frame.time_at(mouse.x));
  handle_wheel(frame, group);
  if (hovered_curve_ < 0 && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
    group.fit();
    fit_values();
    drag_ = Drag::none;
  }
}

void Plot::handle_wheel(const PlotFrame& frame, PlotGroup& group) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.MouseWheel == 0) return;
  const double factor = std::pow(kWheelStep, -static_cast<double>(io.MouseWheel));
  if (io.KeyCtrl || io.MousePos.x < frame.area.min.x) {
    zoom_values(factor, frame.value_at(io.MousePos.y));
  } else {
    group.zoom(factor, frame.time_at(io.MousePos.x));
  }
}

void Plot::zoom_values(double factor, double around) {
  const Limits wanted{around + (y_.low - around) * factor, around + (y_.high - around) * factor};
  // Beyond that, single precision runs out.
  const double finest = 1e-6 * std::max({std::abs(wanted.low), std::abs(wanted.high), 1e-12});
  if (wanted.span() < finest || wanted.span() > 1e12) return;
  values_follow_ = false;
  y_ = wanted;
}

void Plot::handle_drag(const PlotFrame& frame, PlotGroup& group, PlotEvents& events) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool near_playback =
      group.playback() && frame.area.contains(io.MousePos) &&
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
  if (drag_ == Drag::playback) events.playback = frame.time_at(io.MousePos.x);
  if (!ImGui::IsMouseDragging(ImGuiMouseButton_Left, 2)) return;
  if (drag_ == Drag::pan && io.MouseDelta.x != 0) {
    group.pan(-io.MouseDelta.x * frame.window.per_pixel);
  }
  const bool move_values = drag_ == Drag::values || (drag_ == Drag::pan && !values_follow_);
  if (move_values && io.MouseDelta.y != 0) {
    const double by = io.MouseDelta.y / frame.area.height() * y_.span();
    y_ = {y_.low + by, y_.high + by};
    values_follow_ = false;
  }
}

void Plot::draw_curves(const PlotFrame& frame, const History& history) {
  traces_.resize(spec_.curves.size());
  for (std::size_t i = 0; i < spec_.curves.size(); ++i) {
    const Curve& curve = spec_.curves[i];
    if (!curve.visible) {
      traces_[i].clear();
      continue;
    }
    make_trace(history, curve, frame.window, rows_, kDash * frame.scale, traces_[i]);
    const bool pointed_at = hovered_curve_ == static_cast<int>(i);
    draw_trace(frame, traces_[i], ink(frame.palette, curve.ink, curve.shade),
               hovered_curve_ < 0 ? 1.0f
               : pointed_at       ? 1.5f
                                  : 0.3f);
  }
  if (history.empty()) {
    const std::string text = "no data yet";
    const ImVec2 size = text_size(Face::small, text);
    draw_text(frame.list, Face::small,
              {frame.area.min.x + 0.5f * (frame.area.width() - size.x),
               frame.area.min.y + 0.5f * (frame.area.height() - size.y)},
              frame.palette.muted, text);
  }
}

float Plot::draw_title(ImDrawList& list, const ScreenRect& outer, float scale) const {
  const Palette& p = current_palette();
  const ImVec2 at{outer.min.x + 2 * scale, outer.min.y + 2 * scale};
  const float right = outer.max.x - 6 * scale;
  const std::string scaling =
      exponent_text(common_exponent(y_.low * spec_.factor, y_.high * spec_.factor));
  const std::string unit = scaling.empty() ? spec_.unit : scaling + " " + spec_.unit;
  // The title is shortened before the unit is left out.
  const float gap = 7 * scale;
  const float room = right - gap - text_size(Face::regular, unit).x;
  const float end =
      at.x + draw_clipped_text(list, Face::semibold, at, p.text, spec_.title, room - at.x);
  draw_text(list, Face::regular, {end + gap, at.y}, p.muted, unit);
  return end + gap + text_size(Face::regular, unit).x;
}

void Plot::handle_menu(const PlotFrame& frame, const History& history, PlotGroup& group,
                       const PlotSaving& saving, PlotEvents& events) {
  if (hovered_ && ImGui::IsMouseReleased(ImGuiMouseButton_Right)) ImGui::OpenPopup("menu");
  if (!ImGui::BeginPopup("menu")) return;
  const PlotWish wish = plot_menu_items(static_cast<bool>(saving.save_png));
  ImGui::EndPopup();
  if (wish == PlotWish::none) return;
  if (wish == PlotWish::fit) {
    group.fit();
    fit_values();
  } else if (wish == PlotWish::save_png) {
    frames_until_png_ = kFramesToCloseMenu;
  } else {
    const PlotPicture picture{frame.window.start(), frame.window.stop(), y_};
    if (auto notice = fulfil(wish, spec_, history, picture, saving)) tell(*notice, events);
  }
}

void Plot::save_png_when_due(const PlotFrame& frame, const PlotSaving& saving) {
  if (--frames_until_png_ > 0) return;
  try {
    const auto file = free_file(saving.folder, spec_.file_name, "png");
    if (saving.save_png) saving.save_png(frame.outer, file);
  } catch (const std::exception& e) {
    notice_ = PlotNotice{e.what(), true};
    notice_until_ = ImGui::GetTime() + kNoticeTime;
  }
}

void Plot::tell(PlotNotice notice, PlotEvents& events) {
  events.notice = notice;
  notice_ = std::move(notice);
  notice_until_ = ImGui::GetTime() + kNoticeTime;
}

void Plot::draw_latest_notice(const PlotFrame& frame) {
  const double left = notice_until_ - ImGui::GetTime();
  if (!notice_ || left <= 0) return;
  draw_notice(frame, notice_->text, notice_->bad, static_cast<float>(std::min(1.0, 2 * left)));
}

}  // namespace limpid
