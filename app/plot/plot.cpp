#include "app/plot/plot.h"

#include <imgui_internal.h>

#include <cmath>
#include <utility>

#include "app/plot/axis_places.h"

namespace limpid {
namespace {

constexpr double kNoticeTime = 4;        // [s]
constexpr float kLeastHeight = 84;       // of curves and time axis under the legend [px]
constexpr float kMostMargin = 0.3f;      // of the width, for values at the curves' ends
constexpr int kFramesToCloseMenu = 2;    // so that the menu is not in the picture
constexpr double kBetweenSpectra = 0.1;  // [s]
constexpr double kNoValue = -9;          // decimal logarithm of amplitudes that are none
constexpr double kDecades = 5;           // that a spectrum shows below its peak

}  // namespace

void Plot::ValueAxis::fit() {
  follows = true;
  autoscale.reset();
}

void Plot::fit_values() {
  x_.fit();
  y_.fit();
}

void Plot::show(PlotSpec spec) {
  const bool other = spec.kind != spec_.kind || spec.y.zero_line != spec_.y.zero_line;
  spec_ = std::move(spec);
  spectra_.clear();
  if (other) fit_values();
}

PlotEvents Plot::draw(const History& history, PlotGroup& group, ImVec2 size,
                      const PlotSaving& saving) {
  PlotEvents events;
  ImGui::PushID(this);
  follow_data(history, group);
  const PlotFrame frame = lay_out(history, group, size, saving.arranged);
  // Also keeps the wheel from scrolling the window around.
  ImGui::InvisibleButton("plot", size, ImGuiButtonFlags_MouseButtonLeft);
  ImGui::SetItemUsingMouseWheel();
  hovered_ = ImGui::IsItemHovered();
  handle_mouse(frame, history, group, events);
  handle_menu(frame, history, group, saving, events);

  const ImVec2 mouse = hovered_ ? ImGui::GetMousePos() : ImVec2{-1e6f, -1e6f};
  draw_axes(frame, spec_, history.offset());
  draw_inside(frame, history, group, mouse);
  if (over_time() && spec_.end_labels) draw_end_labels(frame, spec_, history);
  legend_.draw(frame, spec_, hovered_curve_);
  const bool menu_or_png = frames_until_png_ > 0 || ImGui::IsPopupOpen("menu");
  if (!menu_or_png) draw_what_is_pointed_at(frame, history, group, mouse);
  if (frames_until_png_ > 0) {
    save_png_when_due(frame, saving);
  } else {
    draw_latest_notice(frame);
    draw_menu_button(frame, menu_button_, menu_button_.contains(mouse));
  }
  ImGui::PopID();
  return events;
}

PlotFrame Plot::lay_out(const History& history, const PlotGroup& group, ImVec2 size, bool menu) {
  const float scale = current_scale();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 min = ImGui::GetCursorScreenPos();
  const ScreenRect outer{min, {min.x + size.x, min.y + size.y}};
  const float line = text_size(Face::semibold, spec_.title).y + 4 * scale;
  ScreenRect heading = outer;  // the menu's button is at its right
  if (menu) heading.max.x -= line;
  menu_button_ = {{heading.max.x, min.y}, {outer.max.x, menu ? min.y + line : min.y}};
  const float title_end = draw_title(list, heading, scale);
  const float title_bottom = min.y + line;
  const ScreenRect beside{{title_end, min.y}, {heading.max.x, title_bottom}};
  const float legend = legend_.place({outer, beside, kLeastHeight * scale}, spec_, scale);
  const ImVec2 label = text_size(Face::small, "\u221200.00");
  const AxisMap y{y_.limits, spec_.y.log};
  float margin = over_time() && spec_.end_labels ? end_label_width() : 0;
  if (margin > kMostMargin * size.x) margin = 0;
  ScreenRect area{
      {std::round(min.x + label.x + 8 * scale), std::round(title_bottom + legend + 5 * scale)},
      {std::round(outer.max.x - 6 * scale - margin),
       std::round(outer.max.y - label.y - 6 * scale)}};
  area.max.x = std::max(area.max.x, area.min.x + 8);
  area.max.y = std::max(area.max.y, area.min.y + 8);
  const PixelWindow window =
      pixel_window(group.stop(), group.length(), static_cast<int>(area.width()));
  pixel_rows(history, window, rows_);
  const AxisMap x =
      over_time() ? AxisMap{{window.start(), window.stop()}} : AxisMap{x_.limits, spec_.x.log};
  return {list, current_palette(), scale, outer, area, window, x, y};
}

void Plot::follow_data(const History& history, const PlotGroup& group) {
  if (std::exchange(run_start_, history.run_start()) != run_start_) fit_values();
  if (spec_.kind == PlotKind::spectrum) return follow_spectra(history, group);
  // What was before the newest run is left behind, unless it is looked at.
  const double from =
      group.following() ? std::max(group.start(), history.run_start()) : group.start();
  Extent values, across;
  for (const Curve& curve : spec_.curves) {
    if (!curve.visible) continue;
    values.include(history.extent_between(curve.channel, from, group.stop()));
    if (curve.across < 0) continue;
    across.include(history.extent_between(curve.across, from, group.stop()));
  }
  if (values.empty() && history.empty()) fit_values();
  for (const Threshold& each : spec_.thresholds) {
    if (each.always_in_view) values.include(static_cast<float>(each.value));
  }
  follow_values(y_, spec_.y, values);
  if (spec_.kind == PlotKind::cross) follow_values(x_, spec_.x, across);
  const auto largest = [](const Limits& l) { return std::max(std::abs(l.low), std::abs(l.high)); };
  spec_.y.choose_unit(largest(y_.limits));
  spec_.x.choose_unit(largest(x_.limits));
}

void Plot::follow_values(ValueAxis& axis, const PlotAxis& spec, Extent data) {
  if (!axis.follows) return;
  if (spec.zero_line || data.empty()) data.include(0);
  axis.limits = axis.autoscale.update({data.low, data.high}, spec.smallest_span,
                                      static_cast<double>(ImGui::GetIO().DeltaTime));
}

// Anew where the stretch has changed, but not in every frame.
void Plot::follow_spectra(const History& history, const PlotGroup& group) {
  const bool other = spectra_.size() != spec_.curves.size();
  const bool moved = group.start() != spectra_start_ || group.stop() != spectra_stop_;
  if (other || (moved && ImGui::GetTime() >= spectra_due_)) {
    spectra_start_ = group.start();
    spectra_stop_ = group.stop();
    spectra_due_ = ImGui::GetTime() + kBetweenSpectra;
    spectra_.clear();
    for (const Curve& curve : spec_.curves) {
      spectra_.push_back(spectrum_between(history, curve.channel, group.start(), group.stop()));
    }
  }
  Extent values;
  double lowest = 1 / group.length();
  for (std::size_t i = 0; i < spectra_.size(); ++i) {
    if (!spec_.curves[i].visible || spectra_[i].empty()) continue;
    lowest = spectra_[i].step;
    for (std::size_t k = 1; k < spectra_[i].amplitude.size(); ++k) {
      values.include(static_cast<float>(std::log10(std::max(spectra_[i].amplitude[k], 1e-12))));
    }
  }
  if (values.empty() || static_cast<double>(values.high) < kNoValue) values = {-3, 0};
  values.low = std::max(values.low, values.high - static_cast<float>(kDecades));
  follow_values(y_, spec_.y, values);
  if (x_.follows) x_.limits = {std::log10(lowest), std::log10(0.5 / history.tick())};
  spec_.y.choose_unit(std::pow(10, y_.limits.high));
}

void Plot::draw_inside(const PlotFrame& frame, const History& history, const PlotGroup& group,
                       ImVec2 mouse) {
  // A curve on the axis is seen whole.
  const float rim = 2 * frame.scale;
  frame.list.PushClipRect(frame.area.min, {frame.area.max.x, frame.area.max.y + rim}, true);
  if (over_time()) {
    draw_bands(frame, spec_, history, rows_);
    draw_mark_lines(frame, history);
  }
  draw_curves(frame, history);
  if (over_time()) {
    draw_band_names(frame, spec_, history, rows_);
    draw_mark_labels(frame, history, traces_, mouse);
  }
  draw_thresholds(frame, spec_);
  if (over_time() && group.playback()) {
    draw_playback(frame, *group.playback(), drag_ == Drag::playback);
  }
  if (spec_.kind == PlotKind::cross) {
    draw_present(frame, spec_, history, group.playback().value_or(group.stop()));
  }
  frame.list.PopClipRect();
}

void Plot::draw_what_is_pointed_at(const PlotFrame& frame, const History& history,
                                   const PlotGroup& group, ImVec2 mouse) {
  const ImVec2 near_to = hovered_ ? mouse : frame.area.min;
  if (spec_.kind == PlotKind::spectrum) {
    if (group.hovered_frequency()) {
      draw_spectrum_read_out(frame, spec_, spectra_, *group.hovered_frequency(), near_to);
    }
  } else if (group.hovered()) {
    draw_read_out(frame, spec_, history, *group.hovered(), near_to);
  }
}

void Plot::draw_curves(const PlotFrame& frame, const History& history) {
  traces_.resize(spec_.curves.size());
  for (std::size_t i = 0; i < spec_.curves.size(); ++i) {
    const Curve& curve = spec_.curves[i];
    traces_[i].clear();
    if (!curve.visible) continue;
    switch (spec_.kind) {
      case PlotKind::time: make_trace(history, curve, frame.window, rows_, traces_[i]); break;
      case PlotKind::cross:
        make_cross_trace(history, curve, rows_.front(), rows_.back(), frame.trace_area(),
                         traces_[i]);
        break;
      case PlotKind::spectrum:
        make_spectrum_trace(spectra_[i], frame.trace_area(), traces_[i]);
        break;
    }
    const bool pointed_at = hovered_curve_ == static_cast<int>(i);
    draw_trace(frame, traces_[i], ink(frame.palette, curve.ink, curve.shade),
               hovered_curve_ < 0 ? 1.0f
               : pointed_at       ? 1.5f
                                  : 0.3f);
  }
  const bool nothing = history.empty() || spec_.curves.empty();
  if (!nothing) return;
  const std::string text = history.empty() ? "no data yet" : "nothing to show";
  const ImVec2 size = text_size(Face::small, text);
  draw_text(frame.list, Face::small,
            {frame.area.min.x + 0.5f * (frame.area.width() - size.x),
             frame.area.min.y + 0.5f * (frame.area.height() - size.y)},
            frame.palette.muted, text);
}

float Plot::draw_title(ImDrawList& list, const ScreenRect& outer, float scale) const {
  const Palette& p = current_palette();
  const ImVec2 at{outer.min.x + 2 * scale, outer.min.y + 2 * scale};
  const float right = outer.max.x - 6 * scale;
  const std::string unit = unit_text(spec_.y, {y_.limits, spec_.y.log});
  // The title is shortened before the unit is left out.
  const float gap = 7 * scale;
  const float room = right - gap - text_size(Face::regular, unit).x;
  const float end =
      at.x + draw_clipped_text(list, Face::semibold, at, p.text, spec_.title, room - at.x);
  draw_text(list, Face::regular, {end + gap, at.y}, p.muted, unit);
  return end + gap + text_size(Face::regular, unit).x;
}

PlotWish Plot::open_menu(const PlotSaving& saving) {
  const bool button = hovered_ && menu_button_.contains(ImGui::GetMousePos()) &&
                      ImGui::IsMouseReleased(ImGuiMouseButton_Left);
  if (button || (hovered_ && ImGui::IsMouseReleased(ImGuiMouseButton_Right))) {
    ImGui::OpenPopup("menu");
  }
  PlotWish wish = std::exchange(asked_, PlotWish::none);
  if (!ImGui::BeginPopup("menu")) return wish;
  wish = plot_menu_items(static_cast<bool>(saving.save_png), saving.arranged);
  ImGui::EndPopup();
  return wish;
}

void Plot::handle_menu(const PlotFrame& frame, const History& history, PlotGroup& group,
                       const PlotSaving& saving, PlotEvents& events) {
  const PlotWish wish = open_menu(saving);
  if (wish == PlotWish::none) return;
  if (wish == PlotWish::fit) {
    group.fit();
    fit_values();
  } else if (wish == PlotWish::save_png) {
    frames_until_png_ = kFramesToCloseMenu;
  } else if (wish == PlotWish::choose || wish == PlotWish::add || wish == PlotWish::remove) {
    events.wish = wish;
  } else {
    const PlotPicture picture{frame.window.start(), frame.window.stop(), frame.x, frame.y};
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
