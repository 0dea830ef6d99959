#include "app/style/sliders.h"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

#include "app/style/range_reminder.h"
#include "app/style/theme.h"
#include "app/style/ticks.h"
#include "app/style/words.h"

namespace limpid {

namespace {

constexpr const char* kSliderId = "##slider";  // below the key, which the caller pushes

double slider_low(const FieldInfo& info) {
  if (!info.logarithmic || info.slider_minimum > 0) return info.slider_minimum;
  return 1e-6 * info.slider_maximum;
}

void draw_track(const ImRect& track, const FieldInfo& info, double value, const SliderMarks& marks,
                bool broken, bool hovered, bool held) {
  const Palette& p = current_palette();
  const float scale = current_scale();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float middle = std::round(track.GetCenter().y);
  const float r = 2 * scale;
  const auto x_of = [&](double v) {
    return track.Min.x + static_cast<float>(slider_place(info, v)) * track.GetWidth();
  };
  list.AddRectFilled({track.Min.x, middle - r}, {track.Max.x, middle + r},
                     colour(hovered ? p.frame_active : p.frame_hovered), r);
  ImGui::RenderFrameBorder({track.Min.x, middle - r}, {track.Max.x, middle + r}, r);
  const auto mark = [&](double at, Rgb rgb) {
    if (std::isnan(at)) return;
    const float x = std::round(x_of(at));
    list.AddRectFilled({x - 0.75f * scale, middle - 6 * scale},
                       {x + 0.75f * scale, middle + 6 * scale}, colour(rgb));
  };
  mark(marks.usual, p.muted);
  mark(marks.limit, p.broken);
  if (std::isnan(value)) return;
  const float x = x_of(value);
  const Rgb main = broken ? p.broken : held ? p.text : p.accent;
  list.AddRectFilled({track.Min.x, middle - r}, {x, middle + r},
                     colour(broken ? p.broken : mix(p.axis, p.accent, 0.35f)), r);
  list.AddCircleFilled({x, middle}, (held ? 6.5f : 5.5f) * scale, colour(p.panel), 24);
  list.AddCircleFilled({x, middle}, (held ? 5.5f : 4.5f) * scale, colour(main), 24);
}

// Draws label and text above the track, the value or what is said in its place; shortens the text
// first if the panel is narrow.
void draw_caption(const ImRect& box, const FieldInfo& info, std::string text, Rgb rgb) {
  const Palette& p = current_palette();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddText(box.Min, colour(p.text), info.caption);
  const float room = box.GetWidth() - ImGui::CalcTextSize(info.caption).x - ImGui::GetFontSize();
  if (ImGui::CalcTextSize(text.c_str()).x > room) text = text.substr(0, text.find(' '));
  const float width = ImGui::CalcTextSize(text.c_str()).x;
  list.AddText({box.Max.x - width, box.Min.y}, colour(rgb), text.c_str());
}

std::string range_text(const FieldInfo& info) {
  return three_digits(info.minimum) + " to " + with_unit(info, info.maximum);
}

// Reads a number with a point or a comma, and nothing else around it.
bool parse_number(std::string text, double& value) {
  std::ranges::replace(text, ',', '.');
  const auto from = text.find_first_not_of(' ');
  const auto to = text.find_last_not_of(' ');
  if (from == std::string::npos) return false;
  const char* end = text.data() + to + 1;
  double parsed = 0;
  const auto result = std::from_chars(text.data() + from, end, parsed);
  if (result.ec != std::errc() || result.ptr != end || !std::isfinite(parsed)) return false;
  value = parsed;
  return true;
}

// Takes a number typed over the slider; returns true while the input is open. The value changes
// when typing is done, not with every key: nobody wants to feel the 0 on the way to 0.6. What is
// not allowed leaves the value as it is.
bool typing(const ImRect& box, ImGuiID id, const FieldInfo& info, bool begin, double& value,
            bool& changed) {
  if (!begin && !ImGui::TempInputIsActive(id)) return false;
  const double from = std::isnan(value) ? slider_value(info, 0.5) : value;
  std::array<char, 32> text{};
  const int length = std::snprintf(text.data(), text.size(), "%.6g", from);
  const std::string before(text.data(), static_cast<std::size_t>(length));
  ImGui::TempInputText(box, id, kSliderId, text.data(), static_cast<int>(text.size()),
                       ImGuiInputTextFlags_AutoSelectAll);
  const bool done = !begin && !ImGui::TempInputIsActive(id);
  if (!done || before == text.data()) return true;
  double typed = 0;
  changed = parse_number(text.data(), typed) && typed >= info.least() && typed <= info.maximum;
  if (changed) {
    value = typed;
    RangeReminder(id).fall_silent();
  } else {
    RangeReminder(id).speak();
  }
  return true;
}

// Place on the track that the mouse wants. A press alone may be the first half of a double click,
// which must leave the value alone. It counts once the mouse is dragged, or when no second press
// has come.
class TrackMouse {
 public:
  explicit TrackMouse(ImGuiID id)
      : memory_(*ImGui::GetStateStorage()), place_(id + 1), since_(id + 2) {}

  void forget() { memory_.SetFloat(since_, kNever); }

  // Returns the wanted place; `held`: the mouse's left button holds the track.
  std::optional<double> wanted(const ImRect& track, bool held) {
    const ImGuiIO& io = ImGui::GetIO();
    const auto now = static_cast<float>(ImGui::GetTime());
    const float place = (io.MousePos.x - track.Min.x) / track.GetWidth();
    if (held && io.MouseClicked[0]) {
      memory_.SetFloat(place_, place);
      memory_.SetFloat(since_, now);
    }
    const float since = memory_.GetFloat(since_, kNever);
    if (held && ImGui::IsMouseDragging(0, kDragStarts * current_scale())) {
      forget();
      const bool moved = io.MouseDelta.x != 0 || since != kNever;
      return moved ? std::optional<double>(place) : std::nullopt;
    }
    if (since == kNever || now - since < io.MouseDoubleClickTime) return std::nullopt;
    forget();
    // A slider that was hidden meanwhile comes back as it was left.
    return now - since < kForgotten ? std::optional<double>(memory_.GetFloat(place_))
                                    : std::nullopt;
  }

 private:
  static constexpr float kNever = -1;
  static constexpr float kForgotten = 3;   // [s]
  static constexpr float kDragStarts = 3;  // [px] at scale 1

  ImGuiStorage& memory_;
  ImGuiID place_, since_;
};

void show_tooltip(const FieldInfo& info, double usual, const char* broken) {
  begin_tooltip(ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  if (broken != nullptr) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(current_palette().broken));
    ImGui::TextUnformatted(broken);
    ImGui::PopStyleColor();
    ImGui::Spacing();
  }
  ImGui::TextUnformatted(with_greek(info.meaning).c_str());
  ImGui::Spacing();
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyle().Colors[ImGuiCol_TextDisabled]);
  if (info.is_number()) {
    ImGui::Text("%s, %s", info.key, range_text(info).c_str());
    ImGui::Text("%s: %s (right click sets it). Double click to type.",
                of_paper(info) ? "Paper" : "Usual", with_unit(info, usual).c_str());
  } else {
    ImGui::Text("%s. Right click sets the default value.", info.key);
  }
  if (!info.live) ImGui::TextUnformatted("Takes effect when the loop starts again.");
  ImGui::PopStyleColor();
  end_tooltip();
}

void draw_choice(const ImRect& box, const char* text, bool chosen, bool hovered) {
  const Palette& p = current_palette();
  const float rounding = ImGui::GetStyle().FrameRounding;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (chosen || hovered) {
    list.AddRectFilled(box.Min, box.Max, colour(chosen ? p.accent : p.frame_active), rounding);
  }
  const ImVec2 size = ImGui::CalcTextSize(text);
  const ImVec2 at{std::round(box.GetCenter().x - 0.5f * size.x),
                  std::round(box.GetCenter().y - 0.5f * size.y)};
  const Rgb rgb = chosen ? p.panel : hovered ? p.text : p.muted;
  list.PushClipRect(box.Min, box.Max, true);
  list.AddText(at, colour(rgb), text);
  // A theme with borders shows by more than a colour what is chosen.
  const float line = 1.5f * current_scale() * ImGui::GetStyle().FrameBorderSize;
  if (chosen) {
    list.AddRectFilled({at.x, at.y + size.y - line}, {at.x + size.x, at.y + size.y}, colour(rgb));
  }
  list.PopClipRect();
}

// Draws radio buttons side by side, of which one is pressed in; `place`: its place.
bool choices(const FieldInfo& info, double& place) {
  ImGui::TextUnformatted(info.caption);
  const int count = static_cast<int>(info.words.size());
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size{ImGui::GetContentRegionAvail().x, ImGui::GetFrameHeight()};
  ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + size.x, at.y + size.y},
                                            colour(current_palette().frame),
                                            ImGui::GetStyle().FrameRounding);
  ImGui::RenderFrameBorder(at, {at.x + size.x, at.y + size.y}, ImGui::GetStyle().FrameRounding);
  bool changed = false;
  for (int i = 0; i < count; ++i) {
    const char* word = info.words[static_cast<std::size_t>(i)];
    const float left = std::round(size.x * static_cast<float>(i) / static_cast<float>(count));
    const float right = std::round(size.x * static_cast<float>(i + 1) / static_cast<float>(count));
    ImGui::SetCursorScreenPos({at.x + left, at.y});
    if (ImGui::InvisibleButton(word, {right - left, size.y})) {
      changed = place != i;
      place = i;
    }
    const ImRect box({at.x + left, at.y}, {at.x + right, at.y + size.y});
    draw_choice(box, word, place == i, ImGui::IsItemHovered());
    ImGui::RenderNavHighlight(box, ImGui::GetItemID());
  }
  return changed;
}

}  // namespace

double slider_place(const FieldInfo& info, double value) {
  const double low = slider_low(info);
  const double high = info.slider_maximum;
  const double inside = std::clamp(value, low, high);
  if (!info.logarithmic) return (inside - low) / (high - low);
  return std::log(inside / low) / std::log(high / low);
}

double slider_value(const FieldInfo& info, double place) {
  const double low = slider_low(info);
  const double high = info.slider_maximum;
  const double at = std::clamp(place, 0.0, 1.0);
  const double value = info.logarithmic ? low * std::pow(high / low, at) : low + (high - low) * at;
  return info.kind == FieldInfo::Kind::whole ? std::round(value) : value;
}

double slider_step(const FieldInfo& info, double value, double usual, int direction) {
  constexpr double kStep = 1.1;
  value = std::clamp(value, slider_low(info), info.slider_maximum);
  // Remains of rounding must not count as a step.
  const auto beyond = [&](double next) { return direction * (next / value - 1) > 1e-9; };
  int place = static_cast<int>(std::lround(std::log(value / usual) / std::log(kStep))) - direction;
  double next = value;
  while (!beyond(next)) {
    const double exact = usual * std::pow(kStep, place);
    const double digit = std::pow(10.0, std::floor(std::log10(exact)) - 1);
    next = place == 0 ? usual : std::stod(three_digits(std::round(exact / digit) * digit));
    place += direction;
  }
  return std::clamp(next, info.slider_minimum, info.slider_maximum);
}

void draw_broken_frame(ImVec2 from, ImVec2 to) {
  const float pad = 3 * current_scale();
  ImRect frame(from, to);
  frame.Expand({pad, 1});
  ImGui::GetWindowDrawList()->AddRect(frame.Min, frame.Max, colour(current_palette().broken),
                                      ImGui::GetStyle().FrameRounding, 0, current_scale());
}

bool number_slider(const FieldInfo& info, double& value, const SliderMarks& marks, bool broken) {
  ImGuiWindow* window = ImGui::GetCurrentWindow();
  const float text = ImGui::GetTextLineHeight();
  const float scale = current_scale();
  const ImVec2 size{ImGui::GetContentRegionAvail().x, text + 16 * scale};
  const ImVec2 at = window->DC.CursorPos;
  const ImRect box(at, {at.x + size.x, at.y + size.y});
  const ImGuiID id = window->GetID(kSliderId);
  ImGui::ItemSize(size);
  if (!ImGui::ItemAdd(box, id, nullptr, ImGuiItemFlags_Inputable)) return false;

  const bool hovered = ImGui::IsItemHovered();
  const ImGuiIO& io = ImGui::GetIO();
  const bool by_keys = ImGui::GetCurrentContext()->NavActivateId == id;
  const bool type =
      by_keys || (hovered && ((io.MouseClicked[0] && io.KeyCtrl) || io.MouseDoubleClicked[0]));
  const float r = 6 * scale;
  const ImRect track({box.Min.x + r, box.Min.y + text + 2 * scale}, {box.Max.x - r, box.Max.y});
  bool changed = false;
  TrackMouse mouse(id);
  if (typing(box, id, info, type, value, changed)) {
    mouse.forget();
    return changed;
  }
  bool over = false;
  bool held = false;
  ImGui::ButtonBehavior(box, id, &over, &held);
  // Dragging is for the track only: a click on the caption leaves the value alone.
  const bool from_track = held && io.MouseClickedPos[0].y >= track.Min.y;
  if (const auto place = mouse.wanted(track, from_track)) {
    const double wanted = slider_value(info, *place);
    changed = wanted != value;
    value = wanted;
  }
  if (over && io.MouseClicked[1]) {
    changed = !(value == marks.usual || (std::isnan(value) && std::isnan(marks.usual)));
    value = marks.usual;
  }
  const Palette& p = current_palette();
  if (RangeReminder(id).speaks()) {
    ImGui::GetWindowDrawList()->AddText(box.Min, colour(p.broken),
                                        ("not accepted; allowed: " + range_text(info)).c_str());
  } else {
    draw_caption(box, info, with_unit(info, value),
                 broken              ? p.broken
                 : std::isnan(value) ? p.muted
                                     : p.text);
  }
  draw_track(track, info, value, marks, broken, over, from_track);
  if (broken) draw_broken_frame(box.Min, box.Max);
  ImGui::RenderNavHighlight(box, id);
  return changed;
}

bool value_slider(const FieldInfo& info, double& value, double usual) {
  ImGui::PushID(info.key);
  const bool changed = number_slider(info, value, {usual}, false);
  if (changed) value = std::clamp(value, info.least(), info.maximum);
  ImGui::PopID();
  tooltip(info.meaning);
  return changed;
}

bool parameter_slider(const ParameterInfo& info, Parameters& parameters, double usual,
                      const char* broken, double limit) {
  ImGui::PushID(info.key);
  ImGui::BeginGroup();
  bool changed = false;
  double value = parameter_number(parameters, info);
  if (info.is_number()) {
    changed = number_slider(info, value, {usual, limit}, broken != nullptr);
  } else if (info.kind == FieldInfo::Kind::choice) {
    changed = choices(info, value);
  } else {
    bool on = value != 0;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {2 * current_scale(), 2 * current_scale()});
    changed = ImGui::Checkbox(info.caption, &on);
    ImGui::PopStyleVar();
    value = on ? 1 : 0;
  }
  ImGui::EndGroup();
  if (!info.is_number() && broken != nullptr) {
    draw_broken_frame(ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
  }
  if (ImGui::IsItemHovered()) {
    if (!info.is_number() && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
      changed = value != usual;
      value = usual;
    }
    const bool busy = ImGui::IsAnyItemActive();
    if (!busy && ImGui::GetCurrentContext()->HoveredIdTimer > 0.5f) {
      show_tooltip(info, usual, broken);
    }
  }
  ImGui::PopID();
  if (changed) set_parameter_number(parameters, info, value);
  return changed;
}

}  // namespace limpid
