#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/desktop/panels.h"
#include "app/desktop/selection_outline.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "core/dynamics/inverse_kinematics.h"

namespace limpid {
namespace {

constexpr double kDepthStep = 0.004;  // of one wheel notch while dragging [m]

ImVec2 at(const ScreenRect& rect, const Eigen::Vector2d& pixel) {
  return {rect.min.x + static_cast<float>(pixel.x()), rect.min.y + static_cast<float>(pixel.y())};
}

// Held where the arm can follow.
Vec3 within_reach(const ArmDescription& arm, const Vec3& point) {
  const Vec3 base = arm.joints.front().origin.translation();
  const double limit = 0.985 * reach(arm);
  const Vec3 out = point - base;
  return out.norm() > limit ? Vec3(base + out.normalized() * limit) : point;
}

}  // namespace

void ViewPanel::draw(Workbench& bench, const Window& window, const ScreenRect& rect) {
  const ImVec2 size = rect.size();
  if (size.x < 8 || size.y < 8) return;
  bench.camera.resize(size.x, size.y);
  handle_mouse(bench, rect);

  Stage& stage = bench.shown();
  const std::span<const double> row = bench.row();
  const RowLayout& layout = stage.channels().layout();
  ViewState view = stage.rows().view(layout, row);
  if (bench.playing_back()) {
    if (const auto again = bench.playback->rerun_row(); !again.empty()) {
      view.rerun = stage.rows().pose(layout.in(again, Column::proxy_position));
    }
  }
  stage.memory.update(view, stage.rows().contacts(layout, row), layout.in(row, Column::time)[0]);
  const Settings& s = bench.settings;
  view.show_ghost = s.show_ghost;
  view.show_trail = s.show_trail;
  view.show_forces = s.show_forces;
  view.show_grid = s.show_grid;
  view.theme = s.theme;

  int points_x = 0, points_y = 0, pixels_x = 0, pixels_y = 0;
  window.size(points_x, points_y);
  window.framebuffer_size(pixels_x, pixels_y);
  const double scale = points_x > 0 ? static_cast<double>(pixels_x) / points_x : 1;
  const auto pixels = [&](float points) { return static_cast<int>(std::lround(points * scale)); };
  stage.picture.set_pixel_scale(scale * static_cast<double>(current_scale()));
  stage.draw_at(bench.quality_level());
  stage.picture.draw(view, bench.camera, pixels(rect.min.x), pixels_y - pixels(rect.max.y),
                     pixels(size.x), pixels(size.y));
  if (const auto ref = bench.editor.selected(); ref && !bench.playing_back()) {
    draw_outline(object_of(bench.editor.scene(), *ref), bench.camera, rect,
                 *ImGui::GetBackgroundDrawList());
  }
  draw_labels(bench, rect);
}

void ViewPanel::handle_mouse(Workbench& bench, const ScreenRect& rect) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool over = rect.contains(io.MousePos) && !io.WantCaptureMouse;
  const Eigen::Vector2d pixel(io.MousePos.x - rect.min.x, io.MousePos.y - rect.min.y);
  Camera& camera = bench.camera;
  const bool orbiting = io.KeyAlt;

  if (over && ImGui::IsMouseClicked(ImGuiMouseButton_Left) && !orbiting && !bench.playing_back()) {
    dragging_ = true;
    const RowLayout& layout = bench.live.layout();
    anchor_ = bench.controls.grab
                  ? bench.controls.goal
                  : bench.stage->rows().tip(layout.in(bench.row(), Column::device_position));
    offset_ = anchor_ - camera.plane_drag(pixel, anchor_);
    bench.settings.hint_seen = true;
  }
  if (dragging_ && !ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    dragging_ = false;
    if (!bench.settings.hold_on_release) bench.controls.grab = false;
  }
  if (dragging_) drag_hand(bench, pixel);

  const bool pan = ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 0) ||
                   (ImGui::IsMouseDragging(ImGuiMouseButton_Right, 0) && io.KeyShift);
  const bool orbit = ImGui::IsMouseDragging(ImGuiMouseButton_Right, 0) ||
                     (orbiting && ImGui::IsMouseDragging(ImGuiMouseButton_Left, 0));
  if (!io.WantCaptureMouse && pan) {
    camera.pan(io.MouseDelta.x, io.MouseDelta.y);
  } else if (!io.WantCaptureMouse && orbit) {
    camera.orbit(io.MouseDelta.x, io.MouseDelta.y);
  }
  if (over && !dragging_ && io.MouseWheel != 0) camera.zoom(io.MouseWheel, pixel);
}

// The target moves in the plane through it that is parallel to the picture; the wheel moves that
// plane.
void ViewPanel::drag_hand(Workbench& bench, const Eigen::Vector2d& pixel) {
  const Camera& camera = bench.camera;
  anchor_ += kDepthStep * static_cast<double>(ImGui::GetIO().MouseWheel) * camera.forward();
  const Vec3 goal = camera.plane_drag(pixel, anchor_ - offset_) + offset_;
  bench.controls.goal = within_reach(bench.stage->arm(), goal);
  bench.controls.grab = true;
}

// Scale of the grid, the legend of the arms, and the hint.
void ViewPanel::draw_labels(Workbench& bench, const ScreenRect& rect) const {
  const Palette& colours = palette(current_theme());
  ImDrawList* draw = ImGui::GetBackgroundDrawList();
  draw->PushClipRect(rect.min, rect.max);
  Stage& stage = bench.shown();
  ImFont* small = font(Face::small);
  const float em = small->FontSize;
  if (bench.settings.show_grid) {
    const Bounds& grid = stage.picture.grid();
    for (int cm = -30; cm <= 30; cm += 10) {
      const Vec3 point(cm / 100.0, grid.max().y(), grid.max().z());
      if (point.x() < grid.min().x() || point.x() > grid.max().x()) continue;
      if (const auto pixel = bench.camera.project(point)) {
        draw->AddText(small, em, at(rect, *pixel), colour(colours.muted, 0.9f),
                      fmt::format("{} cm", cm).c_str());
      }
    }
  }

  // The legend names what is where.
  struct Entry {
    const char* text;
    Ink ink;
  };
  float y = rect.min.y + 0.8f * em;
  for (const Entry& entry :
       {Entry{"device (ghost)", Ink::device}, Entry{"proxy", Ink::proxy}, Entry{"hand", Ink::hand},
        Entry{"contact force, 1 N = 2 cm", Ink::contact}}) {
    const float x = rect.min.x + 0.9f * em;
    draw->AddCircleFilled({x + em * 0.3f, y + em * 0.55f}, em * 0.3f,
                          colour(ink(colours, entry.ink)));
    draw->AddText(small, em, {x + em, y}, colour(colours.text, 0.85f), entry.text);
    y += 1.35f * em;
  }

  if (!bench.settings.hint_seen && !bench.playing_back()) {
    ImFont* face = font(Face::semibold);
    const float size = face->FontSize * 1.15f;
    const char* lines[] = {"Drag with the left button: your hand pulls the arm onto the table.",
                           "Wheel while dragging: nearer and farther.",
                           "C switches between the standard and the proposed coupling."};
    float line_y = rect.max.y - 5.2f * size;
    for (const char* line : lines) {
      const ImVec2 extent = face->CalcTextSizeA(size, 1e9f, 0, line);
      const ImVec2 place((rect.min.x + rect.max.x - extent.x) / 2, line_y);
      draw->AddRectFilled({place.x - 8, place.y - 2},
                          {place.x + extent.x + 8, place.y + extent.y + 2},
                          colour(colours.backdrop, 0.72f), 4);
      draw->AddText(face, size, place, colour(colours.text), line);
      line_y += 1.5f * size;
    }
  }
  draw->PopClipRect();
}

}  // namespace limpid
