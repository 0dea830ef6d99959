#include "app/desktop/playback/video_dialog.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "app/desktop/base/settings.h"
#include "app/desktop/widgets/modal.h"
#include "app/style/imgui_input.h"
#include "app/style/words.h"

namespace limpid {
namespace {

using Kind = VideoRequest::Kind;

constexpr std::array kKinds{"MP4 video", "GIF, for a web page or slides",
                            "PNG pictures in a folder"};
constexpr std::array kSizes{std::pair{640, 360}, std::pair{854, 480}, std::pair{1280, 720},
                            std::pair{1920, 1080}, std::pair{1080, 1080}};
constexpr std::array kRates{10, 15, 24, 25, 30, 50, 60};
constexpr std::array kSpeeds{0.1, 0.2, 0.5, 1.0, 2.0, 5.0};
constexpr int kOfVideo = 30, kOfGif = 15;  // usual pictures per second
constexpr int kMostOfGif = 50;
constexpr double kShortest = 0.1;  // shortest video [s]
constexpr float kLabels = 10;      // width of the labels [text sizes]

// Draws a list of values with their texts; returns the one chosen.
template <class T, std::size_t n, class Text>
T choose(const char* label, T value, const std::array<T, n>& among, const Text& text) {
  ImGui::SetNextItemWidth(-kLabels * ImGui::GetFontSize());
  if (ImGui::BeginCombo(label, text(value).c_str())) {
    for (const T& each : among) {
      if (ImGui::Selectable(text(each).c_str(), each == value)) value = each;
    }
    ImGui::EndCombo();
  }
  return value;
}

}  // namespace

void VideoDialog::draw_choices(const PlayedSession& session) {
  int kind = static_cast<int>(request_.kind);
  ImGui::SetNextItemWidth(-kLabels * ImGui::GetFontSize());
  if (ImGui::Combo("format", &kind, kKinds.data(), static_cast<int>(kKinds.size()))) {
    request_.kind = static_cast<Kind>(kind);
    request_.fps.reset();
  }
  std::tie(request_.width, request_.height) = choose(
      "size", std::pair{request_.width, request_.height}, kSizes,
      [](std::pair<int, int> size) { return fmt::format("{} x {}", size.first, size.second); });
  request_.fps = choose("pictures per second",
                        request_.fps.value_or(request_.kind == Kind::gif ? kOfGif : kOfVideo),
                        kRates, [](int rate) { return fmt::format("{}", rate); });
  if (request_.kind == Kind::gif) request_.fps = std::min(*request_.fps, kMostOfGif);
  request_.speed = choose("speed", request_.speed, kSpeeds, [](double speed) {
    return speed == 1 ? std::string("as it was") : fmt::format("x{:g}", speed);
  });
  ImGui::Checkbox("with the plots", &request_.plots);
  const bool several = session.player().session().lanes() > 1 && !session.has_rerun();
  if (!several || request_.overlaid) {
    ImGui::SameLine();
    ImGui::Checkbox("with the lens", &request_.lens);
  }
  if (several) ImGui::Checkbox("all runs in one picture", &request_.overlaid);
  if (session.has_rerun()) {
    ImGui::Checkbox("with the re-run", &rerun_);
    note_place("with the re-run");
  }
}

void VideoDialog::draw_span(const PlayedSession& session) {
  const double whole = session.player().duration();
  const auto time = [&](const char* label, const char* here, const char* help, double& value) {
    ImGui::PushID(label);
    const float button = ImGui::CalcTextSize("here").x + 2 * ImGui::GetStyle().FramePadding.x;
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    ImGui::SetNextItemWidth(-kLabels * ImGui::GetFontSize() - button - gap);
    ImGui::InputDouble("##time", &value, 0.1, 1, "%.2f s");
    note_number_item();
    ImGui::SameLine();
    if (ImGui::Button(here)) value = session.player().time();
    tooltip(help);
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    ImGui::TextUnformatted(label);
    ImGui::PopID();
  };
  time("from", "here", "The present time of the playback", request_.from);
  time("to", "here", "The present time of the playback", to_);
  if (!std::isfinite(request_.from)) request_.from = 0;
  if (!std::isfinite(to_)) to_ = whole;
  request_.from = std::clamp(request_.from, 0.0, std::max(0.0, whole - kShortest));
  to_ = std::clamp(to_, std::min(request_.from + kShortest, whole), whole);
}

std::optional<VideoRequest> VideoDialog::draw(bool& open, const Playback& playback, bool overlaid,
                                              bool lens) {
  const PlayedSession* session = playback.shown();
  if (session == nullptr) open = false;
  const float em = ImGui::GetFontSize();
  const bool shown = begin_modal(
      "Write a video", open, {std::min(34 * em, 0.94f * ImGui::GetMainViewport()->WorkSize.x), 0});
  if (shown && !was_shown_) {
    request_.from = 0;
    to_ = session->player().duration();
    request_.overlaid = overlaid;
    request_.lens = lens;
    rerun_ = true;
  }
  was_shown_ = shown;
  if (!shown) return std::nullopt;
  draw_choices(*session);
  draw_span(*session);
  ImGui::Spacing();
  const std::filesystem::path out = video_of(session->file(), request_.kind, sessions_dir());
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyle().Colors[ImGuiCol_TextDisabled]);
  ImGui::TextWrapped("%.1f s, %.0f pictures, drawn at full quality in the background. File: %s",
                     length(), std::max(1.0, std::round(length() * *request_.fps)), out.c_str());
  ImGui::PopStyleColor();
  ImGui::Spacing();
  std::optional<VideoRequest> asked;
  if (ImGui::Button("Write (Enter)") || accepted()) {
    asked = request_;
    asked->overlaid = request_.overlaid && session->player().session().lanes() > 1;
    asked->rerun = rerun_ ? session->changes_of_rerun() : std::vector<std::string>();
    if (to_ < session->player().duration()) asked->to = to_;
  }
  ImGui::SameLine();
  close_button("Cancel (Esc)", open);
  if (asked) open = false;
  ImGui::EndPopup();
  return asked;
}

}  // namespace limpid
