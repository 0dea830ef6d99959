#include "app/stage/picture_signs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

constexpr double kLeastGap = 1e-5;    // least gap that is shown [m]
constexpr double kLeastForce = 0.05;  // least force that is written [N]
constexpr double kLeastDrop = 0.004;  // least height above something that is shown [m]
constexpr float kBetween = 2;         // between the pictures of runs side by side [px]

bool overlap(ScreenRect a, ScreenRect b) {
  return a.min.x < b.max.x && b.min.x < a.max.x && a.min.y < b.max.y && b.min.y < a.max.y;
}

// Draws the gap beside the middle of the tips, `lines` below it or, if negative, above.
void draw_gap_between(const Vec3& a, const Vec3& b, const std::string& run, float lines,
                      const Camera& camera, const GapPlace& at, ImDrawList& list) {
  const ScreenRect& picture = at.picture;
  const auto pixel = camera.project(0.5 * (a + b));
  std::string text = gap_text((a - b).norm());
  if (text.empty() || !pixel) return;
  if (!run.empty()) text = run + ": " + text;
  ImFont* face = font(Face::small);
  const float em = face->FontSize, pad = 0.35f * em;
  const ImVec2 size = face->CalcTextSizeA(em, 1e9f, 0, text.c_str());
  const ImVec2 tips = in_window(picture, *pixel);
  const float edge = picture.max.x - 1.6f * em;  // a panel's tab may be to the right of it
  const float top = tips.y + lines * em;
  const auto box_at = [&](float left) {
    return ScreenRect{{left - pad, top - 0.5f * pad},
                      {left + size.x + pad, top + size.y + 0.5f * pad}};
  };
  ScreenRect box = box_at(std::min(tips.x + 1.6f * em, edge - size.x - pad));
  if (at.lens && overlap(box, *at.lens)) box = box_at(tips.x - 1.6f * em - size.x);
  const ImVec2 place(box.min.x + pad, top);
  const Palette& colours = current_palette();
  list.AddRectFilled(box.min, box.max, colour(colours.backdrop, 0.75f), 3);
  list.AddText(face, em, place, colour(colours.text), text.c_str());
}

void draw_ring(const Vec3& around, float radius, float thick, Rgb tint, const Camera& camera,
               ScreenRect picture, ImDrawList& list) {
  const auto pixel = camera.project(around);
  if (!pixel) return;
  const ImVec2 middle = in_window(picture, *pixel);
  list.AddCircle(middle, radius, colour(current_palette().backdrop, 0.75f), 0, thick + 2);
  list.AddCircle(middle, radius, colour(tint), 0, thick);
}

// Draws a force below a point that is held: left of it, or right where the picture's edge leaves no
// room. Near the foot, or where the point is out of the picture, it stays within.
void draw_newtons(double force, const Vec3& at, const Camera& camera, ScreenRect picture,
                  ImDrawList& list) {
  const auto pixel = camera.project(at);
  if (!pixel || !(force >= kLeastForce)) return;
  const std::string text = fmt::format("{:.1f} N", force);
  ImFont* face = font(Face::small);
  const float em = face->FontSize, pad = 0.3f * em;
  const ImVec2 size = face->CalcTextSizeA(em, 1e9f, 0, text.c_str());
  const ImVec2 middle = in_window(picture, *pixel);
  const ImVec2 beyond(pad, 0.5f * pad);
  const auto within = [&](float left) {
    const float x = std::min(left, picture.max.x - size.x - beyond.x);
    const float y = std::min(middle.y + 0.9f * em, picture.max.y - size.y - beyond.y);
    return ImVec2(std::max(x, picture.min.x + beyond.x), std::max(y, picture.min.y + beyond.y));
  };
  const float apart = 1.8f * em;
  ImVec2 place = within(middle.x - apart - size.x);
  const bool over = place.x + size.x + beyond.x > middle.x - em && place.x < middle.x + em;
  if (over) place = within(middle.x + apart);
  list.AddRectFilled({place.x - beyond.x, place.y - beyond.y},
                     {place.x + size.x + beyond.x, place.y + size.y + beyond.y},
                     colour(current_palette().backdrop, 0.75f), 3);
  list.AddText(face, em, place, colour(ink(current_palette(), Ink::hand)), text.c_str());
}

}  // namespace

ImVec2 in_window(ScreenRect picture, const Eigen::Vector2d& pixel) {
  return {picture.min.x + static_cast<float>(pixel.x()),
          picture.min.y + static_cast<float>(pixel.y())};
}

std::string gap_text(double meters) {
  const double mm = 1000 * meters;
  if (!(meters >= kLeastGap)) return "";
  return mm < 9.95 ? fmt::format("gap {:.2f} mm", mm) : fmt::format("gap {:.1f} mm", mm);
}

void draw_gap(const ViewState& view, const Camera& camera, const GapPlace& at, ImDrawList& list,
              const RunNames& names) {
  if (view.device.links.empty() || view.proxy.links.empty()) return;
  draw_gap_between(view.device.tip, view.proxy.tip, names.name(kMainLane), -2.2f, camera, at, list);
  for (std::size_t i = 0; i < view.beside.size(); ++i) {
    const OtherRun& run = view.beside[i];
    draw_gap_between(run.device.tip, run.proxy.tip, names.name(i + 1),
                     1.2f + 1.6f * static_cast<float>(i), camera, at, list);
  }
}

void keep_acted_on_free(const ViewState& view, const Camera& camera, ScreenRect picture,
                        Crowd& crowd) {
  const float around = 2.2f * font(Face::small)->FontSize;
  const auto keep = [&](const Vec3& point) {
    const auto pixel = point.allFinite() ? camera.project(point) : std::nullopt;
    if (!pixel) return;
    const ImVec2 at = in_window(picture, *pixel);
    crowd.kept_free.push_back({{at.x - around, at.y - around}, {at.x + around, at.y + around}});
  };
  for (const ArmPose* arm : {&view.device, &view.proxy}) {
    if (!arm->links.empty()) keep(arm->tip);
  }
  if (!view.pull) return;
  for (const Vec3& end : *view.pull) keep(end);
}

void draw_pull(const ViewState& view, double force, const Camera& camera, ScreenRect picture,
               ImDrawList& list) {
  if (!view.pull) return;
  const float em = font(Face::small)->FontSize;
  const Rgb hand = ink(current_palette(), Ink::hand);
  const auto& [point, target] = *view.pull;
  const auto from = camera.project(point), to = camera.project(target);
  if (from && to) {
    const ImVec2 a = in_window(picture, *from), b = in_window(picture, *to);
    list.AddLine(a, b, colour(current_palette().backdrop, 0.75f), 0.15f * em + 2);
    list.AddLine(a, b, colour(hand), 0.15f * em);
  }
  draw_ring(point, 0.3f * em, 0.3f * em, hand, camera, picture, list);
  draw_ring(target, 0.6f * em, 0.15f * em, hand, camera, picture, list);
  draw_newtons(force, target, camera, picture, list);
}

void draw_drop(const ViewState& view, double below, const Camera& camera, ScreenRect picture,
               ImDrawList& list) {
  if (view.device.links.empty() || below < kLeastDrop) return;
  const Vec3 foot = view.device.tip - below * Vec3::UnitZ();
  const auto from = camera.project(view.device.tip), to = camera.project(foot);
  if (!from || !to) return;
  const float em = font(Face::small)->FontSize;
  const ImVec2 a = in_window(picture, *from), b = in_window(picture, *to);
  list.AddLine(a, b, colour(current_palette().backdrop, 0.75f), 0.1f * em + 2);
  list.AddLine(a, b, colour(ink(current_palette(), Ink::hand), 0.8f), 0.1f * em);
  draw_ring(foot, 0.3f * em, 0.15f * em, ink(current_palette(), Ink::hand), camera, picture, list);
}

void draw_magnet(const ViewState& view, const Camera& camera, ScreenRect picture,
                 ImDrawList& list) {
  if (!view.magnet || view.proxy.links.empty()) return;
  const float em = font(Face::small)->FontSize, thick = (view.magnet_holds ? 0.25f : 0.12f) * em;
  draw_ring(view.proxy.tip, em, thick, current_palette().accent, camera, picture, list);
}

void draw_grasp(const ViewState& view, const Camera& camera, ScreenRect picture, ImDrawList& list) {
  if (view.device.links.empty()) return;
  const float em = font(Face::small)->FontSize;
  draw_ring(view.device.tip, 1.3f * em, 0.15f * em, ink(current_palette(), Ink::hand), camera,
            picture, list);
  if (view.hand_grips) {
    draw_newtons(view.hand_force.norm(), view.device.tip, camera, picture, list);
  }
}

float run_name_room() { return 2.2f * font(Face::semibold)->FontSize; }

void draw_run_name(const RunNames& names, std::size_t run, ScreenRect part, ImDrawList& list) {
  const Palette& colours = current_palette();
  const std::string name = names.name(run);
  const int law = names.law(run);
  ImFont* face = font(Face::semibold);
  const float em = face->FontSize, pad = 0.4f * em;
  const float sample = law < 0 ? 0 : 1.5f * em;
  const ImVec2 size = face->CalcTextSizeA(em, 1e9f, 0, name.c_str());
  const ImVec2 at(std::round((part.min.x + part.max.x - size.x - sample) / 2),
                  part.min.y + 2 * pad);
  list.AddRectFilled({at.x - pad, at.y - pad / 2},
                     {at.x + sample + size.x + pad, at.y + size.y + pad / 2},
                     colour(colours.backdrop, 0.72f), 4);
  list.AddText(face, em, {at.x + sample, at.y}, colour(colours.text), name.c_str());
  if (law < 0) return;
  const float y = std::round(at.y + 0.5f * size.y), scale = em / 16;
  const ImU32 rgba = colour(law_ink(colours, law));
  list.AddRectFilled({at.x, y - 1.5f * scale}, {at.x + 1.2f * em, y + 1.5f * scale}, rgba);
  draw_run_sign(list, {at.x + 0.6f * em, y}, sign_of_lane(run), rgba, colour(colours.backdrop),
                1.2f * scale);
}

void draw_sign(const std::string& sign, ScreenRect picture, bool below_names, ImDrawList& list) {
  if (sign.empty()) return;
  const Palette& colours = current_palette();
  ImFont* face = font(Face::semibold);
  const ImVec2 size = face->CalcTextSizeA(face->FontSize, 1e9f, 0, sign.c_str());
  const float pad = 0.5f * face->FontSize;
  const ImVec2 at(std::round((picture.min.x + picture.max.x - size.x) / 2),
                  std::round(picture.min.y + 2 * pad + (below_names ? 2.2f * size.y : 0)));
  list.AddRectFilled({at.x - 2 * pad, at.y - pad}, {at.x + size.x + 2 * pad, at.y + size.y + pad},
                     colour(colours.accent), 4);
  list.AddText(face, face->FontSize, at, colour(colours.panel), sign.c_str());
}

void draw_told(const std::string& told, ScreenRect picture, ImDrawList& list) {
  if (told.empty()) return;
  ImFont* face = font(Face::semibold);
  const float size = std::round(1.2f * face->FontSize), pad = 0.6f * size;
  const float room = 0.86f * picture.width();
  std::vector<std::string> lines;
  for (const char *at = told.c_str(), *end = at + told.size(); at < end;) {
    const char* stop = face->CalcWordWrapPositionA(size / face->FontSize, at, end, room);
    if (stop == at) ++stop;  // a word that is wider than the picture
    lines.emplace_back(at, stop);
    at = stop;
    while (at < end && *at == ' ') ++at;
  }
  const float line = 1.25f * size;
  float y = picture.max.y - pad - line * static_cast<float>(lines.size());
  const Palette& colours = current_palette();
  list.AddRectFilled({picture.min.x, y - pad}, picture.max, colour(colours.backdrop, 0.72f));
  for (const std::string& text : lines) {
    const float width = face->CalcTextSizeA(size, 1e9f, 0, text.c_str()).x;
    const ImVec2 at(std::round((picture.min.x + picture.max.x - width) / 2), std::round(y));
    list.AddText(face, size, at, colour(colours.text), text.c_str());
    y += line;
  }
}

ScreenRect part_of(ScreenRect picture, std::size_t run, std::size_t runs) {
  const auto edge = [&](std::size_t i) {
    const float part = static_cast<float>(i) / static_cast<float>(runs);
    return std::round(picture.min.x + part * picture.width());
  };
  const float left = run == 0 ? picture.min.x : edge(run) + kBetween / 2;
  const float right = run + 1 == runs ? picture.max.x : edge(run + 1) - kBetween / 2;
  return {{left, picture.min.y}, {right, picture.max.y}};
}

}  // namespace limpid
