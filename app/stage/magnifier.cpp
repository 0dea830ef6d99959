#include "app/stage/magnifier.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/stage/picture_signs.h"
#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

constexpr double kTellable = 0.3, kLargest = 40;    // gaps that are magnified [points]
constexpr double kMoment = 0.7;                     // time that a lens stays without need [s]
constexpr float kShare = 0.42f, kMostWide = 0.36f;  // parts of the view's height and width
constexpr float kLeast = 64;                        // least edge of a lens, at scale 1 [points]

bool seen(const ViewState& state) {
  return !state.device.links.empty() && !state.proxy.links.empty() &&
         state.device.tip.allFinite() && state.proxy.tip.allFinite();
}

Vec3 middle(const ViewState& state) { return 0.5 * (state.device.tip + state.proxy.tip); }

}  // namespace

std::vector<ScreenRect> lens_corners(ScreenRect view, float words) {
  const ImVec2 size = view.size();
  const float edge = std::floor(std::min(kShare * size.y, kMostWide * size.x));
  const float gap = 0.6f * ImGui::GetFontSize();
  if (edge < kLeast * current_scale()) return {};
  const float left = std::floor(view.min.x + gap), right = std::floor(view.max.x - gap - edge);
  const float low = std::floor(view.max.y - gap - edge);
  const float top = std::floor(view.min.y + words + gap);
  std::vector<ScreenRect> corners;
  for (const ImVec2 at : {ImVec2(right, low), {right, top}, {left, low}, {left, top}}) {
    if (at.y + edge < view.max.y) corners.push_back({at, {at.x + edge, at.y + edge}});
  }
  return corners;
}

bool worth_magnifying(const ViewState& state, const Camera& camera) {
  if (!seen(state)) return false;
  const double gap =
      (state.device.tip - state.proxy.tip).norm() / camera.meters_per_pixel(middle(state));
  return gap < kLargest && (gap > kTellable || !state.contacts.empty());
}

void Magnifier::draw(SceneView& picture, const ViewState& state, const Camera& camera,
                     const LensPlace& place, const Crowd& crowd) {
  const double now = ImGui::GetTime();
  if (worth_magnifying(state, camera)) until_ = now + kMoment;
  const bool shown = seen(state) && camera.project(middle(state)) && now <= until_;
  if (!shown) corner_.forget();
  rect_ = shown ? corner_.choose(lens_corners(place.view, place.words), crowd) : std::nullopt;
  view_ = place.view;
  if (!rect_) return;
  const auto pixels = [&](float points) {
    return static_cast<int>(std::lround(static_cast<double>(points) * place.pixel_scale));
  };
  const int edge = pixels(rect_->size().x);
  const Camera lens =
      camera.magnified(middle(state), kMagnified, static_cast<double>(rect_->size().x),
                       static_cast<double>(rect_->size().y));
  picture.draw(state, lens, pixels(rect_->min.x), place.pixel_height - pixels(rect_->max.y), edge,
               edge, SceneView::Sheet::lens);
}

void Magnifier::draw_frame(const ViewState& state, const Camera& camera, ImDrawList& list) const {
  if (!rect_) return;
  const Palette& colours = current_palette();
  const ImU32 line = colour(colours.text, 0.55f);
  const float scale = current_scale();
  list.AddRect(rect_->min, rect_->max, line, 0, 0, 1.2f * scale);
  if (const auto tips = camera.project(middle(state))) {
    const ImVec2 m = in_window(view_, *tips);
    const float half = 0.5f * rect_->size().x / static_cast<float>(kMagnified);
    list.AddRect({m.x - half, m.y - half}, {m.x + half, m.y + half}, colour(colours.text, 0.35f), 0,
                 0, scale);
  }
  // The bar is a round number of millimetres long.
  const double point = camera.meters_per_pixel(middle(state)) / kMagnified;
  const double most = 0.4 * static_cast<double>(rect_->size().x) * point;
  double bar = 1e-4;
  for (const double next : {2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2, 5e-2})
    if (next < most) bar = next;
  ImFont* small = font(Face::small);
  const float em = small->FontSize, pad = 0.5f * em;
  const auto length = static_cast<float>(bar / point);
  const std::string text = fmt::format("x{:g}   {:g} mm", kMagnified, 1000 * bar);
  const float width = small->CalcTextSizeA(em, 1e9f, 0, text.c_str()).x;
  const ImVec2 from(rect_->min.x, rect_->min.y);
  list.AddRectFilled({from.x + 1, from.y + 1},
                     {from.x + std::max(width, length) + 3 * pad, from.y + 1.9f * em},
                     colour(colours.backdrop, 0.75f));
  list.AddText(small, em, {from.x + pad, from.y + 0.2f * em}, colour(colours.text), text.c_str());
  list.AddLine({from.x + pad, from.y + 1.55f * em}, {from.x + pad + length, from.y + 1.55f * em},
               colour(colours.text), 2 * scale);
}

}  // namespace limpid
