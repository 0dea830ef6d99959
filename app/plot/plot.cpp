#include "app/plot/plot.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/plot/axis.h"
#include "app/plot/plot_frame.h"
#include "app/style/ticks.h"
#include "app/style/words.h"
#include "core/coupling/laws.h"

namespace limpid {

namespace {

constexpr double kShortestTicks = 8;
constexpr double kPlaybackPlace = 0.75;  // part of the window at which playback runs when zoomed in

constexpr double kNoticeTime = 4;        // [s]
constexpr float kLeastHeight = 84;       // of curves and time axis under the legend [px]
constexpr float kMostMargin = 0.3f;      // part of the width, for values at the curves' ends
constexpr int kFramesToCloseMenu = 2;    // the menu must not be in the picture
constexpr double kBetweenSpectra = 0.1;  // [s]
constexpr double kNoValue = -9;          // decimal logarithm that stands for an amplitude of 0
constexpr double kDecades = 5;           // of a spectrum, shown below its peak

constexpr double kWheelStep = 1.18;
constexpr float kGrip = 5;  // distance at which a drag takes the playback line [px]

constexpr float kReach = 30;  // from the mouse to what it points at [px]

struct Line {
  std::string label;
  std::string value;
  Rgb rgb;
  ImVec2 at;  // on the screen
};

// Writes as many digits as the screen can show, not as many as the number has.
std::string number_text(const PlotAxis& axis, const AxisMap& map, double value) {
  if (map.log) return three_digits(value * axis.factor);
  const double resolution = std::abs(axis.factor) * map.limits.span() / 1000;
  const int exponent = common_exponent(map.limits.low * axis.factor, map.limits.high * axis.factor);
  const double unit = std::pow(10.0, exponent);
  const std::string text = fixed_text(value * axis.factor / unit, decimals_of(resolution / unit));
  return exponent != 0 ? text + exponent_text(exponent) : text;
}

// Writes three digits, with the typographic minus.
std::string short_text(double value) {
  return (value < 0 ? "\u2212" : "") + three_digits(std::abs(value));
}

// Writes a value for the margin, in a unit of the axis: with the decimals that the screen can show
// and that there is room for.
std::string end_text(const AxisMap& map, double unit, double value) {
  const auto fits = [](const std::string& text) {
    return text_size(Face::small, text).x <= end_label_width() - 6 * current_scale();
  };
  const double shown = value / unit;
  if (!map.log) {
    const double resolution = map.limits.span() / std::abs(unit) / 1000;
    if (std::abs(shown) < resolution / 2) return "0";
    for (int decimals = decimals_of(resolution); decimals >= 0; --decimals) {
      if (std::string text = fixed_text(shown, decimals); fits(text)) return text;
    }
  }
  std::string text = short_text(shown);
  for (int digits = 2; digits > 0 && !fits(text); --digits) {
    text = fmt::format("{}{:.{}g}", shown < 0 ? "\u2212" : "", std::abs(shown), digits);
  }
  return text;
}

std::string value_text(const PlotAxis& axis, const AxisMap& map, double value) {
  return number_text(axis, map, value) + " " + axis.unit;
}

// Returns the curve's name in this row: of a part that another law made, both laws.
std::string label_at(const History& history, const Curve& curve, SampleIndex row) {
  const int law = law_at(history, curve, row);
  if (curve.law < 0 || law < 0 || law == curve.law) return curve.label;
  return fmt::format("{}, here {}", curve.label,
                     info(CouplingKind{static_cast<std::uint8_t>(law)}).key);
}

std::vector<Line> visible_lines(const PlotFrame& frame, const PlotSpec& spec,
                                const History& history, SampleIndex row) {
  std::vector<Line> lines;
  for (const Curve& curve : spec.curves) {
    if (!curve.visible) continue;
    const double value = history.value(curve.channel, row);
    if (!std::isfinite(value)) continue;
    std::string text = value_text(spec.y, frame.y, value);
    float x = frame.x_of(history.time(row));
    if (curve.across >= 0) {
      const double across = history.value(curve.across, row);
      if (!std::isfinite(across)) continue;
      x = frame.x_of(across);
      text += ", " + value_text(spec.x, frame.x, across);
    }
    lines.push_back({label_at(history, curve, row),
                     std::move(text),
                     colour_of(frame.palette, curve, law_at(history, curve, row)),
                     {x, frame.y_of(value)}});
  }
  return lines;
}

void draw_dots(const PlotFrame& frame, const std::vector<Line>& lines) {
  for (const Line& line : lines) {
    if (line.at.y < frame.area.min.y || line.at.y > frame.area.max.y) continue;
    if (line.at.x < frame.area.min.x || line.at.x > frame.area.max.x) continue;
    frame.list.AddCircleFilled(line.at, 4 * frame.scale, colour(frame.palette.panel));
    frame.list.AddCircleFilled(line.at, 2.8f * frame.scale, colour(line.rgb));
  }
}

void draw_line_at(const PlotFrame& frame, float x) {
  frame.list.AddRectFilled({x, frame.area.min.y}, {x + 1, frame.area.max.y},
                           colour(frame.palette.text, 0.45f));
}

void draw_box(const PlotFrame& frame, const std::string& title, const std::vector<Line>& lines,
              float line_x, ImVec2 near_to) {
  const float s = frame.scale;
  const float height = text_size(Face::small, "0").y + s;
  const float swatch = 10 * s;
  float labels = 0;
  float values = 0;
  for (const Line& line : lines) {
    labels = std::max(labels, text_size(Face::small, line.label).x);
    values = std::max(values, text_size(Face::small, line.value).x);
  }
  const float width =
      std::max(text_size(Face::small, title).x, swatch + 6 * s + labels + 12 * s + values) + 14 * s;
  const float tall = height * static_cast<float>(lines.size() + 1) + 10 * s;
  float left = line_x + 10 * s;
  if (left + width > frame.area.max.x) left = line_x - 10 * s - width;
  // The box of a narrow plot goes over its neighbour rather than being cut off.
  left = std::min(std::max(left, frame.outer.min.x), frame.list.GetClipRectMax().x - width);
  const float top = std::clamp(near_to.y - 0.5f * tall, frame.area.min.y,
                               std::max(frame.area.min.y, frame.area.max.y - tall));
  frame.list.AddRectFilled({left, top}, {left + width, top + tall},
                           colour(frame.palette.raised, 0.94f), 4 * s);
  frame.list.AddRect({left, top}, {left + width, top + tall}, colour(frame.palette.border), 4 * s);
  float y = top + 5 * s;
  draw_text(frame.list, Face::small, {left + 7 * s, y}, frame.palette.muted, title);
  for (const Line& line : lines) {
    y += height;
    const float middle = std::round(y + 0.5f * height);
    frame.list.AddRectFilled({left + 7 * s, middle - 1.5f * s},
                             {left + 7 * s + swatch, middle + 0.5f * s}, colour(line.rgb));
    draw_text(frame.list, Face::small, {left + 13 * s + swatch, y}, frame.palette.text, line.label);
    draw_text(frame.list, Face::small,
              {left + width - 7 * s - text_size(Face::small, line.value).x, y}, frame.palette.text,
              line.value);
  }
}

// Drops lines until there is room for the rest: first those that say what a neighbour says.
void leave_room(std::vector<Line>& lines, float most) {
  while (static_cast<float>(lines.size()) > most) {
    auto closest = lines.begin() + 1;
    for (auto line = closest; line != lines.end(); ++line) {
      const auto apart = [](auto at) { return at->at.y - (at - 1)->at.y; };
      if (apart(line) < apart(closest)) closest = line;
    }
    lines.erase(closest);
  }
}

}  // namespace

void PlotGroup::begin_frame(const History& history, std::optional<double> playback) {
  data_start_ = history.start_time();
  data_stop_ = history.end_time();
  shortest_ = kShortestTicks * history.tick();
  playback_ = playback;
  hovered_ = std::exchange(hovering_, std::nullopt);
  hovered_frequency_ = std::exchange(hovering_frequency_, std::nullopt);
  if (range_ && (history.empty() || range_->stop < data_start_ || range_->start > data_stop_)) {
    range_.reset();
  }
  const double earliest_stop = data_start_ + length_;
  if (following_ && playback_) {
    const double wanted = *playback_ + (1 - kPlaybackPlace) * length_;
    stop_ = std::max(earliest_stop, std::min(wanted, data_stop_));
  } else if (following_) {
    stop_ = std::max(earliest_stop, data_stop_);
  } else {
    // Some data stays in view, also while the oldest is being forgotten.
    const double some = 0.1 * length_;
    stop_ = std::clamp(stop_, data_start_ + some, data_stop_ + length_ - some);
  }
}

void PlotGroup::pan(double seconds) {
  stop_ += seconds;
  following_ = !playback_ && seconds > 0 && stop_ >= data_stop_ && stop_ >= data_start_ + length_;
}

void PlotGroup::zoom(double factor, double around) {
  const double longest =
      std::max({2 * fitted_length_, 1.2 * (data_stop_ - data_start_), shortest_});
  const double length = std::clamp(length_ * factor, shortest_, longest);
  if (!following_) stop_ = around + (stop_ - around) * length / length_;
  length_ = length;
}

void PlotGroup::fit() {
  length_ = fitted_length_;
  following_ = true;
}

void Plot::ValueAxis::fit() {
  follows = true;
  autoscale.reset();
}

void Plot::fit_values() {
  x_.fit();
  y_.fit();
}

PlotPicture Plot::picture(const PlotGroup& group) const {
  return {group.start(), group.stop(), {x_.limits, spec_.x.log}, {y_.limits, spec_.y.log}};
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
  // The button also keeps the wheel from scrolling the window around.
  ImGui::InvisibleButton("plot", size, ImGuiButtonFlags_MouseButtonLeft);
  ImGui::SetItemUsingMouseWheel();
  hovered_ = ImGui::IsItemHovered();
  handle_mouse(frame, history, group, events);
  handle_menu(frame, history, group, saving, events);

  const ImVec2 mouse = hovered_ ? ImGui::GetMousePos() : ImVec2{-1e6f, -1e6f};
  draw_axes(frame, spec_, history.offset());
  draw_inside(frame, history, group, mouse);
  if (over_time() && spec_.end_labels) {
    const double present = group.playback().value_or(frame.window.stop());
    draw_end_labels(frame, spec_, history, group.hovered().value_or(present));
  }
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
  area_ = area;
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
  // Rows before the newest run do not count, unless they are looked at.
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

// Computes spectra again if the stretch has changed, but not in every frame.
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
  // The clip leaves a rim, so that a curve on the axis is seen whole.
  const float rim = 2 * frame.scale;
  frame.list.PushClipRect(frame.area.min, {frame.area.max.x, frame.area.max.y + rim}, true);
  if (over_time()) {
    draw_bands(frame, spec_, history, rows_);
    draw_mark_lines(frame, history);
    if (group.range()) draw_range(frame, group.range()->start, group.range()->stop);
  }
  draw_curves(frame, history);
  LabelRoom room(frame.area.box());
  if (over_time()) draw_band_names(frame, spec_, history, rows_, room);
  draw_thresholds(frame, spec_, room);
  if (over_time()) draw_mark_labels(frame, spec_, history, rows_, traces_, mouse, room);
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
    const float emphasis = hovered_curve_ < 0 ? 1.0f : pointed_at ? 1.5f : 0.3f;
    draw_trace(frame, traces_[i], curve, emphasis);
    draw_run_signs(frame, traces_[i], curve, emphasis);
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
  } else if (wish == PlotWish::choose || wish == PlotWish::add || wish == PlotWish::remove ||
             wish == PlotWish::export_as) {
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

void Plot::ValueAxis::zoom(double factor, double part) {
  const double around = limits.low + part * limits.span();
  const Limits wanted{around + (limits.low - around) * factor,
                      around + (limits.high - around) * factor};
  // Single precision runs out beyond these limits.
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
  if (hovered_curve_ >= 0) {
    const Curve& curve = spec_.curves[static_cast<std::size_t>(hovered_curve_)];
    begin_tooltip(mouse, mouse);
    ImGui::TextUnformatted(
        fmt::format("{}: {}. A click hides or shows this curve.", curve.label, curve.help).c_str());
    end_tooltip();
  }
  if (hovered_ && hovered_curve_ >= 0 && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
    Curve& curve = spec_.curves[static_cast<std::size_t>(hovered_curve_)];
    curve.visible = !curve.visible;
    return;
  }
  handle_drag(frame, history, group, events);
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

void Plot::handle_drag(const PlotFrame& frame, const History& history, PlotGroup& group,
                       PlotEvents& events) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool near_playback =
      over_time() && group.playback() && frame.area.contains(io.MousePos) &&
      std::abs(frame.x_of(*group.playback()) - io.MousePos.x) < kGrip * frame.scale;
  if (hovered_ && near_playback) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  if (ImGui::IsItemActivated()) {
    const bool selects = io.KeyShift && over_time() && frame.area.contains(io.MousePos);
    range_from_ = frame.x_at(io.MousePos.x);
    drag_ = selects                                                     ? Drag::range
            : near_playback                                             ? Drag::playback
            : io.MousePos.x < frame.area.min.x                          ? Drag::values
            : hovered_curve_ < 0 && !menu_button_.contains(io.MousePos) ? Drag::pan
                                                                        : Drag::none;
    if (drag_ == Drag::pan && over_time() && group.playback()) {
      events.playback = note_near(frame, history, io.MousePos);
      if (events.playback) drag_ = Drag::none;
    }
  }
  if (!ImGui::IsItemActive()) {
    const bool clicked = !ImGui::IsMouseDragPastThreshold(ImGuiMouseButton_Left, 2);
    events.unselect = drag_ == Drag::range && clicked;
    if (drag_ == Drag::pan && clicked && over_time() && group.playback()) {
      events.playback = frame.x_at(io.MousePos.x);
    }
    drag_ = Drag::none;
    return;
  }
  if (drag_ == Drag::playback) events.playback = frame.x_at(io.MousePos.x);
  if (!ImGui::IsMouseDragging(ImGuiMouseButton_Left, 2)) return;
  if (drag_ == Drag::range) {
    const double to = frame.x_at(std::clamp(io.MousePos.x, frame.area.min.x, frame.area.max.x));
    const auto [start, stop] = std::minmax(range_from_, to);
    events.range = PlotRange{start, stop};
  }
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

void draw_read_out(const PlotFrame& frame, const PlotSpec& spec, const History& history,
                   double time, ImVec2 near_to) {
  const bool over_time = spec.kind == PlotKind::time;
  const bool outside = time < frame.window.start() || time > frame.window.stop();
  if (outside || history.empty()) return;
  const SampleIndex row = history.nearest(time);
  const double distance = std::abs(history.time(row) - time);
  const bool in_gap = distance > std::max(1.5 * history.tick(), frame.window.per_pixel);
  std::vector<Line> lines = in_gap ? std::vector<Line>{} : visible_lines(frame, spec, history, row);
  float x = std::round(frame.x_of(time));
  if (over_time) {
    draw_line_at(frame, x);
    for (Line& line : lines) line.at.x = x + 0.5f;
  } else {
    if (lines.empty()) return;
    x = lines.front().at.x;
  }
  draw_dots(frame, lines);
  const double shown = (in_gap ? time : history.time(row)) - history.offset();
  const double step = std::max(history.tick(), frame.window.per_pixel / 10);
  std::string title = time_text(shown, step, std::abs(shown) >= 60);
  if (lines.empty()) title += "   no data";
  draw_box(frame, title, lines, x, near_to);
}

void draw_spectrum_read_out(const PlotFrame& frame, const PlotSpec& spec,
                            const std::vector<AmplitudeSpectrum>& spectra, double frequency,
                            ImVec2 near_to) {
  const float x = std::round(frame.x_of(frequency));
  if (x < frame.area.min.x || x > frame.area.max.x) return;
  // The value is that of the pixel: the highest of its frequencies, or the nearest one.
  const double low = frame.x_at(x - 0.5f), high = frame.x_at(x + 0.5f);
  std::vector<Line> lines;
  double at = frequency;
  for (std::size_t i = 0; i < spectra.size() && i < spec.curves.size(); ++i) {
    const AmplitudeSpectrum& s = spectra[i];
    if (!spec.curves[i].visible || s.amplitude.size() < 2) continue;
    const auto bin = [&](double f) {
      return std::clamp<std::size_t>(static_cast<std::size_t>(std::round(f / s.step)), 1,
                                     s.amplitude.size() - 1);
    };
    std::size_t best = bin(frequency);
    for (std::size_t k = bin(low); k <= bin(high); ++k) {
      if (s.amplitude[k] > s.amplitude[best]) best = k;
    }
    at = static_cast<double>(best) * s.step;
    lines.push_back({spec.curves[i].label,
                     value_text(spec.y, frame.y, s.amplitude[best]),
                     colour_of(frame.palette, spec.curves[i]),
                     {x + 0.5f, frame.y_of(s.amplitude[best])}});
  }
  if (lines.empty()) return;
  draw_line_at(frame, x);
  draw_dots(frame, lines);
  draw_box(frame, three_digits(at) + " Hz", lines, x, near_to);
}

void draw_present(const PlotFrame& frame, const PlotSpec& spec, const History& history,
                  double time) {
  if (history.empty()) return;
  draw_dots(frame, visible_lines(frame, spec, history, history.nearest(time)));
}

std::optional<double> time_near(const PlotFrame& frame, const PlotSpec& spec,
                                const History& history, ImVec2 mouse) {
  double nearest = std::pow(static_cast<double>(kReach * frame.scale), 2);
  std::optional<double> found;
  for (const Curve& curve : spec.curves) {
    if (!curve.visible) continue;
    const SampleIndex to = history.lower_bound(frame.window.stop());
    for (SampleIndex row = history.lower_bound(frame.window.start()); row < to; ++row) {
      const double x = frame.x_of(static_cast<double>(history.value(curve.across, row)));
      const double y = frame.y_of(static_cast<double>(history.value(curve.channel, row)));
      const double apart = std::pow(x - static_cast<double>(mouse.x), 2) +
                           std::pow(y - static_cast<double>(mouse.y), 2);
      if (apart >= nearest) continue;  // nor where one is not a number
      nearest = apart;
      found = history.time(row);
    }
  }
  return found;
}

float end_label_width() { return text_size(Face::small, "\u22120.000").x + 6 * current_scale(); }

void draw_end_labels(const PlotFrame& frame, const PlotSpec& spec, const History& history,
                     double time) {
  const float room = frame.outer.max.x - frame.area.max.x;
  if (history.empty() || room < end_label_width()) return;
  const SampleIndex row = history.nearest(std::min(time, frame.window.stop()));
  const int exponent =
      common_exponent(frame.y.low() * spec.y.factor, frame.y.high() * spec.y.factor);
  const float height = text_size(Face::small, "0").y;
  std::vector<Line> lines;
  for (const Curve& curve : spec.curves) {
    const auto value = static_cast<double>(history.value(curve.channel, row));
    if (!curve.visible || !std::isfinite(value)) continue;
    lines.push_back({"",
                     end_text(frame.y, std::pow(10.0, exponent) / spec.y.factor, value),
                     colour_of(frame.palette, curve, law_at(history, curve, row)),
                     {0, frame.y_of(value)}});
  }
  std::ranges::sort(lines, {}, [](const Line& line) { return line.at.y; });
  leave_room(lines, std::max(1.0f, std::floor(frame.area.height() / height)));
  // Lines are pushed apart: downwards from the top, then upwards from the bottom.
  float free = frame.area.min.y;
  for (Line& line : lines) {
    line.at.y = std::max(line.at.y - 0.5f * height, free);
    free = line.at.y + height;
  }
  free = frame.area.max.y;
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    line->at.y = std::min(line->at.y, free - height);
    free = line->at.y;
  }
  for (const Line& line : lines) {
    draw_text(frame.list, Face::small, {frame.area.max.x + 5 * frame.scale, line.at.y}, line.rgb,
              line.value);
  }
}

}  // namespace limpid
