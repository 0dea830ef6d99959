#include "app/desktop/view/over_view.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/desktop/base/first_steps.h"
#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "app/style/words.h"

namespace limpid {

namespace {

constexpr float kBeside = 26;  // room that a sentence needs beside the legend [em]
constexpr float kFoot = 6;     // room for the sign of loading at the foot of the view [em]

// Returns the size of notices below each other.
ImVec2 size_of_notices(const Notices& notices, float wrap, float pad) {
  ImVec2 all{};
  for (const Notice& notice : notices.all()) {
    const ImVec2 size = ImGui::CalcTextSize(notice.text.c_str(), nullptr, false, wrap);
    all = {std::max(all.x, size.x + 2 * pad), all.y + size.y + 3 * pad};
  }
  return all;
}

// Adds the windows over the picture, such as cards. Tooltips come and go with the mouse.
void keep_windows_free(Crowd& crowd) {
  constexpr ImGuiWindowFlags kPassing = ImGuiWindowFlags_ChildWindow | ImGuiWindowFlags_Tooltip;
  for (const ImGuiWindow* each : ImGui::GetCurrentContext()->Windows) {
    const bool seen = each->Active && !each->Hidden && !each->IsFallbackWindow;
    if (seen && (each->Flags & kPassing) == 0) {
      crowd.kept_free.push_back({each->Pos, each->Rect().Max});
    }
  }
}

float buttons_width(const Banner& banner) {
  const ImGuiStyle& style = ImGui::GetStyle();
  float width = 0;
  for (const Banner::Button& button : banner.buttons) {
    width += style.ItemSpacing.x + 2 * style.FramePadding.x +
             ImGui::CalcTextSize(button.label.c_str()).x;
  }
  return width;
}

// Draws text and buttons in one line, or the buttons below if there is no room.
void draw_contents(const Banner& banner, float room, const Act& act) {
  const Palette& colours = current_palette();
  const bool one_line = ImGui::CalcTextSize(banner.text.c_str()).x + buttons_width(banner) <= room;
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(colours.panel));
  if (one_line) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(banner.text.c_str());
  } else {
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + room);
    ImGui::TextUnformatted(banner.text.c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::PopStyleColor();
  bool first = !one_line;
  for (const Banner::Button& button : banner.buttons) {
    if (!std::exchange(first, false)) ImGui::SameLine();
    if (noted_button(button.label.c_str())) act(button.command);
  }
}

void draw_tick(ImVec2 at, float side, bool done) {
  const Palette& colours = current_palette();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 rgba = colour(done ? colours.accent : colours.axis);
  list.AddRect(at, {at.x + side, at.y + side}, rgba, 0.2f * side);
  if (!done) return;
  const float thick = std::max(1.5f, 0.16f * side);
  list.AddLine({at.x + 0.22f * side, at.y + 0.52f * side},
               {at.x + 0.43f * side, at.y + 0.74f * side}, rgba, thick);
  list.AddLine({at.x + 0.43f * side, at.y + 0.74f * side},
               {at.x + 0.8f * side, at.y + 0.26f * side}, rgba, thick);
}

void draw_next_step(Settings& settings) {
  const Palette& colours = current_palette();
  const auto tried = std::ranges::count_if(
      kFirstSteps, [&](const FirstStepInfo& step) { return done(settings, step.step); });
  const auto* next = std::ranges::find_if(
      kFirstSteps, [&](const FirstStepInfo& step) { return !done(settings, step.step); });
  ImGui::AlignTextToFramePadding();
  ImGui::TextColored(colour_vector(colours.muted), "Your turn, %d of %zu:",
                     static_cast<int>(tried) + (next != kFirstSteps.end() ? 1 : 0),
                     kFirstSteps.size());
  ImGui::SameLine();
  ImGui::TextUnformatted(next != kFirstSteps.end() ? next->what : "all steps are done");
  ImGui::SameLine();
  if (next != kFirstSteps.end()) {
    ImGui::TextColored(colour_vector(colours.muted), "%s", next->how);
    ImGui::SameLine();
  }
  if (noted_button("Close")) settings.your_turn = false;
}

void draw_steps(Settings& settings) {
  heading("Your turn");
  if (ImGui::BeginTable("steps", 2, ImGuiTableFlags_SizingFixedFit)) {
    const Palette& colours = current_palette();
    const float side = 0.75f * ImGui::GetFontSize();
    for (const FirstStepInfo& step : kFirstSteps) {
      const bool ticked = done(settings, step.step);
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      const ImVec2 at = ImGui::GetCursorScreenPos();
      draw_tick({at.x, at.y + 0.5f * (ImGui::GetTextLineHeight() - side)}, side, ticked);
      ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 1.5f * side);
      ImGui::TextColored(colour_vector(ticked ? colours.muted : colours.text), "%s", step.what);
      ImGui::TableNextColumn();
      ImGui::TextColored(colour_vector(colours.muted), "%s", step.how);
    }
    ImGui::EndTable();
  }
  if (noted_button(all_done(settings) ? "Done" : "Close the list")) settings.your_turn = false;
}

}  // namespace

ScreenRect draw_banners(std::span<const Banner> banners, ScreenRect view, ScreenRect signs,
                        const Act& act) {
  if (banners.empty()) return signs;
  const Palette& colours = current_palette();
  const float em = ImGui::GetFontSize(), pad = 0.5f * em;
  const bool beside = view.max.x - signs.max.x > kBeside * em;
  const float left = (beside ? signs.max.x : view.min.x) + pad, right = view.max.x - 2 * em;
  float y = (beside ? view.min.y : signs.max.y) + pad;
  for (const Banner& banner : banners) {
    ImGui::PushStyleColor(ImGuiCol_WindowBg,
                          colour_vector(banner.bad ? colours.broken : colours.accent));
    ImGui::SetNextWindowPos({std::round((left + right) / 2), y}, ImGuiCond_Always, {0.5f, 0});
    ImGui::Begin(banner.id, nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::PopStyleColor();  // current_theme() is read from this colour
    draw_contents(banner, right - left - 2 * ImGui::GetStyle().WindowPadding.x, act);
    y += ImGui::GetWindowHeight() + 0.5f * pad;
    ImGui::End();
  }
  return {signs.min, {view.max.x, std::max(y, signs.max.y)}};
}

void NoticeSigns::draw(const Notices& notices, ScreenRect view, ScreenRect legend,
                       const Crowd& crowd) {
  if (notices.all().empty()) return place_.forget();
  const Palette& colours = palette(current_theme());
  ImDrawList* draw = ImGui::GetForegroundDrawList();
  const float em = ImGui::GetFontSize();
  const float pad = 0.5f * em;
  // Notices stand beside the legend if there is room for a sentence, else below it.
  const bool beside = view.max.x - legend.max.x > kBeside * em;
  const float left = beside ? legend.max.x + em : view.min.x + pad;
  const float right = view.max.x - pad;
  const float widest = std::max(right - left - 2 * pad, 4 * em);
  // `along` and `down`: parts of the room that is left.
  const auto place_at = [&](float wrap, float along, float down) {
    const ImVec2 size = size_of_notices(notices, wrap, pad);
    const float high = (beside ? view.min.y : legend.max.y) + 0.7f * em;
    const float low = std::max(high, view.max.y - kFoot * em - size.y);
    const ImVec2 from(std::floor(left + along * std::max(0.0f, right - size.x - left)),
                      std::floor(high + down * (low - high)));
    return ScreenRect{from, {from.x + size.x, from.y + size.y}};
  };
  ScreenRect place = place_at(widest, 0.5f, 0);
  if (const ImGuiWindow* dialog = ImGui::GetTopMostPopupModal()) {
    // Below a dialog, as far as there is room, notices cover neither its title nor its buttons.
    const float last = ImGui::GetMainViewport()->WorkPos.y + ImGui::GetMainViewport()->WorkSize.y;
    place.min.y = std::min(dialog->Pos.y + dialog->Size.y + pad, last - place.height());
  } else {
    std::vector<ScreenRect> places;
    for (const float wrap : {widest, std::max(widest / 2, 4 * em)}) {
      for (const float down : {0.0f, 1.0f, 0.25f, 0.5f, 0.75f}) {
        for (const float along : {0.5f, 0.0f, 1.0f}) places.push_back(place_at(wrap, along, down));
      }
    }
    Crowd all = crowd;
    keep_windows_free(all);
    place = *place_.choose(places, all);
  }
  float y = place.min.y;
  const float wrap = place.width() - 2 * pad + 1;  // rounding must not break a line anew
  for (const Notice& notice : notices.all()) {
    const ImVec2 size = ImGui::CalcTextSize(notice.text.c_str(), nullptr, false, wrap);
    const ImVec2 at((place.min.x + place.max.x - size.x) / 2, y + pad);
    const ImVec2 from(at.x - pad, at.y - pad), to(at.x + size.x + pad, at.y + size.y + pad);
    draw->AddRectFilled(from, to, colour(colours.raised, 0.95f), 4);
    draw->AddRect(from, to, colour(notice.bad ? colours.broken : colours.border), 4);
    draw->AddText(ImGui::GetFont(), em, at, colour(colours.text), notice.text.c_str(), nullptr,
                  wrap);
    y = to.y + pad;
  }
}

void draw_loading(SceneLoader& loader, bool recording, ScreenRect view) {
  if (!loader.busy()) return;
  const float em = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({(view.min.x + view.max.x) / 2, view.max.y - em}, ImGuiCond_Always,
                          {0.5f, 1});
  ImGui::Begin("loading", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  std::string text = loader.what();
  const double left = loader.seconds_left();
  if (loader.part() >= 1) {
    text += recording ? ": loaded; it is shown when the recording ends (R)"
                      : ", preparing it for touch";
  } else if (left >= 1) {
    text += fmt::format(", {:.0f} s left", left);
  }
  if (loader.waiting() > 0) text += fmt::format(", {} more after it", loader.waiting());
  ImGui::TextUnformatted(text.c_str());
  progress_bar(loader.part(), 22 * em);
  ImGui::SameLine();
  if (ImGui::Button("Cancel")) loader.cancel();
  ImGui::End();
}

void draw_video_bar(Playback& playback, ScreenRect view) {
  if (!playback.video().busy()) return;
  const float em = ImGui::GetFontSize();
  const float below_names = 2.6f * em;  // below the names of runs side by side
  ImGui::SetNextWindowPos({view.max.x - em, view.min.y + below_names}, ImGuiCond_Always, {1, 0});
  ImGui::Begin("video", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  ImGui::TextUnformatted(playback.video().what().c_str());
  progress_bar(playback.video().part(), 14 * em);
  ImGui::SameLine();
  if (ImGui::Button("Cancel")) playback.cancel_video();
  ImGui::End();
}

void YourTurn::draw(Settings& settings, ScreenRect view, const Crowd& crowd) {
  rect_.reset();
  if (!settings.your_turn) return;
  const float em = ImGui::GetFontSize(), edge = 1.6f * em;
  const float right = view.max.x - edge - size_.x, low = view.max.y - em - size_.y;
  const float top = view.min.y + 3 * em;
  std::vector<ScreenRect> places;
  for (const ImVec2 at : {ImVec2(view.min.x + edge, low), {right, low}, {right, top}}) {
    places.push_back({at, {at.x + size_.x, at.y + size_.y}});
  }
  const ImVec2 at = corner_.choose(places, crowd)->min;
  ImGui::SetNextWindowPos({std::round(at.x), std::round(at.y)}, ImGuiCond_Always);
  ImGui::SetNextWindowBgAlpha(0.92f);
  ImGui::Begin("Your turn", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  // If the list would hide the arm, only the next step is shown.
  if (view.height() < 30 * em || view.width() < 50 * em) {
    draw_next_step(settings);
  } else {
    draw_steps(settings);
  }
  size_ = ImGui::GetWindowSize();
  ImGui::End();
  rect_ = ScreenRect{at, {at.x + size_.x, at.y + size_.y}};
}

bool story_asked_for(const Playback& playback, const Settings& settings, ScreenRect view,
                     const std::optional<ScreenRect>& hinted) {
  if (settings.hint_seen || playback.on() || playback.loading()) return false;
  // The tab that folds the plots is at the foot.
  const bool below = hinted && hinted->min.y > (view.min.y + view.max.y) / 2;
  const float foot = below ? hinted->min.y : view.max.y - 1.5f * font(Face::semibold)->FontSize;
  ImGui::SetNextWindowPos({(view.min.x + view.max.x) / 2, foot}, ImGuiCond_Always, {0.5f, 1});
  ImGui::Begin("story", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoFocusOnAppearing |
                   ImGuiWindowFlags_NoNav);
  const bool asked = noted_button("Show me (47 s)");
  tooltip(
      "Plays a story about two couplings in one hand. Drag in the picture or press Backspace to "
      "move the arm yourself at any moment.");
  ImGui::End();
  return asked;
}

bool story_taken_over(const Playback& playback, ScreenRect view) {
  if (!playback.on() || playback.shown()->step() == nullptr) return false;
  const ImGuiIO& io = ImGui::GetIO();
  return ImGui::IsMouseClicked(ImGuiMouseButton_Left) && !io.WantCaptureMouse && !io.KeyAlt &&
         view.contains(io.MousePos);
}

}  // namespace limpid
