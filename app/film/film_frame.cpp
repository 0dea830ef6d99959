#include "app/film/film_frame.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/desktop/base/picture_signs.h"
#include "app/plot/plot_frame.h"
#include "app/plot/plot_row.h"
#include "app/style/picture_legend.h"

namespace limpid {
namespace {

constexpr double kLeastScale = 0.75;  // below, text cannot be read
constexpr float kPlotsShare = 0.33f;  // of the height
constexpr float kPlotsHeight = 190;   // at least [px at scale 1]
constexpr float kPlotWidth = 300;

float scale_of(const FilmLook& look) {
  const double fitting = std::min(look.width / 1280.0, look.height / 720.0);
  return static_cast<float>(look.text_scale > 0 ? look.text_scale : std::max(kLeastScale, fitting));
}

}  // namespace

FilmFrame::FilmFrame(const FilmLook& look)
    : look_(look), scale_(scale_of(look)), context_(look.width, look.height) {
  ImGuiGl::set_up(look.theme, scale_);
  ImGui::GetIO().DisplaySize = {static_cast<float>(look.width), static_cast<float>(look.height)};
}

FilmFrame::Places FilmFrame::lay_out() const {
  const auto width = static_cast<float>(look_.width), height = static_cast<float>(look_.height);
  const float caption = std::round(1.7f * text_size(Face::regular, "0").y);
  const float wanted = std::round(std::max(kPlotsShare * height, kPlotsHeight * scale_));
  const float plots = look_.plots && 2 * wanted <= height ? wanted : 0;
  return {.caption = {{0, 0}, {width, caption}},
          .picture = {{0, caption}, {width, height - plots}},
          .plots = {{0, height - plots}, {width, height}}};
}

ImVec2 FilmFrame::viewport(bool twin) const {
  const ScreenRect picture = lay_out().picture;
  return twin && !look_.overlaid ? half_of(picture, false).size() : picture.size();
}

std::vector<unsigned char> FilmFrame::draw(Stage& stage, ViewState view, const Camera& camera,
                                           const FilmCaption& caption, double elapsed,
                                           std::optional<ViewState> beside) {
  ImGui::GetIO().DeltaTime = static_cast<float>(elapsed);
  ImGuiGl::begin_frame();
  ImGui::NewFrame();
  const Places at = lay_out();
  view.theme = look_.theme;
  if (beside) beside->theme = look_.theme;
  const bool overlaid = beside && look_.overlaid;
  if (overlaid) lay_over(view, *std::exchange(beside, std::nullopt));
  stage.draw_at(0);  // there is time
  stage.picture.set_pixel_scale(scale_);
  draw_picture(at.picture, stage, view, camera, beside ? &*beside : nullptr);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  draw_legend(at.picture, overlaid ? stage.names() : RunNames());
  draw_caption(at.caption, caption);
  draw_told(caption.told, at.picture, list);
  draw_sign(caption.sign, at.picture, beside.has_value(), list);
  if (at.plots.height() > 0) draw_plots(at.plots, stage);
  ImGuiGl::render();
  return read_rgba(look_.width, look_.height);
}

void FilmFrame::draw_picture(const ScreenRect& rect, Stage& stage, const ViewState& view,
                             const Camera& camera, const ViewState* beside) const {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto paint = [&](const ViewState& state, const ScreenRect& part, SceneView::Sheet sheet) {
    stage.picture.draw(state, camera, static_cast<int>(part.min.x),
                       look_.height - static_cast<int>(part.max.y), static_cast<int>(part.width()),
                       static_cast<int>(part.height()), sheet);
  };
  if (beside == nullptr) {
    paint(view, rect, SceneView::Sheet::main);
    if (!view.twin) return;
    Camera shown = camera;
    shown.resize(rect.width(), rect.height());
    list.PushClipRect(rect.min, rect.max);
    draw_gap(view, shown, {rect}, list, stage.names());
    return list.PopClipRect();
  }
  const auto half = [&](const ViewState& state, bool right, const std::string& name) {
    const ScreenRect part = half_of(rect, right);
    paint(state, part, right ? SceneView::Sheet::beside : SceneView::Sheet::main);
    Camera shown = camera;
    shown.resize(part.width(), part.height());
    list.PushClipRect(part.min, part.max);
    draw_gap(state, shown, {part}, list);
    draw_run_name(name, part, list);
    list.PopClipRect();
  };
  half(view, false, stage.names().first);
  half(*beside, true, stage.names().second);
}

void FilmFrame::draw_legend(const ScreenRect& rect, const RunNames& overlaid) const {
  const float em = font(Face::small)->FontSize;
  if (rect.height() < 10 * em) return;
  draw_picture_legend(*ImGui::GetBackgroundDrawList(), rect.min, rect.max,
                      {.first = overlaid.first, .second = overlaid.second});
}

void FilmFrame::draw_caption(const ScreenRect& rect, const FilmCaption& caption) const {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const Palette& colours = current_palette();
  list.AddRectFilled(rect.min, rect.max, colour(colours.panel));
  const float gap = std::round(12 * scale_);
  const float top = rect.min.y + 0.5f * (rect.height() - text_size(Face::regular, "0").y);
  float left = rect.min.x + gap, right = rect.max.x - gap;
  const auto put = [&](Face face, Rgb rgb, const std::string& text) {
    left += draw_clipped_text(list, face, {left, top}, rgb, text, right - left) + 2 * gap;
  };
  put(Face::semibold, colours.text, caption.time);
  put(Face::regular, colours.text, caption.text);
  const float aside = text_size(Face::regular, caption.aside).x;
  if (right - aside < left) return;
  draw_text(list, Face::regular, {right - aside, top}, colours.muted, caption.aside);
}

void FilmFrame::draw_plots(const ScreenRect& rect, Stage& stage) const {
  ImGui::SetNextWindowPos(rect.min);
  ImGui::SetNextWindowSize(rect.size());
  ImGui::Begin("plots", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs);
  stage.group.begin_frame(stage.history, stage.history.end_time());
  const auto fitting =
      static_cast<std::size_t>(std::max(1.0f, rect.width() / (kPlotWidth * scale_)));
  std::vector<PlotKind> kinds;
  for (const Plot& plot : stage.plots) kinds.push_back(plot.spec().kind);
  kinds.resize(std::min(kinds.size(), fitting));
  const ImVec2 origin = ImGui::GetCursorPos(), room = ImGui::GetContentRegionAvail();
  const PlotPlaces at = place_plots(kinds, room, ImGui::GetStyle().ItemSpacing.x, scale_);
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const ScreenRect& place = at.places[i];
    ImGui::SetCursorPos({origin.x + place.min.x, origin.y + place.min.y});
    // Nobody can click on the legend to have them back.
    std::erase_if(stage.plots[i].spec().curves, [](const Curve& c) { return !c.visible; });
    stage.plots[i].draw(stage.history, stage.group, place.size());
  }
  ImGui::End();
}

}  // namespace limpid
