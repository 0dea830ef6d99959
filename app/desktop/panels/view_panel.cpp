#include "app/desktop/panels/view_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/desktop/panels/selection_outline.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "core/dynamics/inverse_kinematics.h"
#include "render/near_surface.h"

namespace limpid {
namespace {

constexpr double kDepthStep = 0.004;  // of one wheel notch while dragging [m]

ImVec2 at(ScreenRect rect, const Eigen::Vector2d& pixel) {
  return {rect.min.x + static_cast<float>(pixel.x()), rect.min.y + static_cast<float>(pixel.y())};
}

// Held where the arm can follow.
Vec3 within_reach(const ArmDescription& arm, const Vec3& point) {
  const Vec3 base = arm.joints.front().origin.translation();
  const double limit = 0.985 * reach(arm);
  const Vec3 out = point - base;
  return out.norm() > limit ? Vec3(base + out.normalized() * limit) : point;
}

void draw_grid_labels(const Bounds& grid, const Camera& camera, ScreenRect rect,
                      const std::optional<ScreenRect>& lens, ImDrawList& list) {
  ImFont* small = font(Face::small);
  const float em = small->FontSize;
  const Palette& colours = current_palette();
  for (int cm = -30; cm <= 30; cm += 10) {
    const Vec3 point(cm / 100.0, grid.max().y(), grid.max().z());
    if (point.x() < grid.min().x() || point.x() > grid.max().x()) continue;
    const auto pixel = camera.project(point);
    const auto hidden = [&](float along) {
      const ImVec2 place = at(rect, *pixel);
      return lens && lens->contains({place.x + along, place.y + 0.5f * em});
    };
    if (pixel && !hidden(0) && !hidden(3 * em)) {
      list.AddText(small, em, at(rect, *pixel), colour(colours.muted, 0.9f),
                   fmt::format("{} cm", cm).c_str());
    }
  }
}

// At the two tips: how far apart they are.
void draw_gap(const ViewState& view, const Camera& camera, ScreenRect rect, ImDrawList& list) {
  if (view.device.links.empty() || view.proxy.links.empty()) return;
  const std::string text = gap_text((view.device.tip - view.proxy.tip).norm());
  const auto pixel = camera.project(0.5 * (view.device.tip + view.proxy.tip));
  if (text.empty() || !pixel) return;
  ImFont* face = font(Face::small);
  const float em = face->FontSize, pad = 0.35f * em;
  const ImVec2 size = face->CalcTextSizeA(em, 1e9f, 0, text.c_str());
  const ImVec2 tips = at(rect, *pixel);
  const float left = std::min(tips.x + 1.6f * em, rect.max.x - size.x - 2 * pad);
  const ImVec2 place(left, tips.y - 2.2f * em);
  const Palette& colours = current_palette();
  list.AddRectFilled({place.x - pad, place.y - 0.5f * pad},
                     {place.x + size.x + pad, place.y + size.y + 0.5f * pad},
                     colour(colours.backdrop, 0.75f), 3);
  list.AddText(face, em, place, colour(colours.text), text.c_str());
}

// What the cone at a contact says; nothing where there is none.
const char* cone_text(const ViewState& view) {
  const char* text = nullptr;
  for (const ContactMark& contact : view.contacts) {
    if (!(contact.friction > 0)) continue;
    if (contact.slips) return "friction cone: slips";
    text = "friction cone: sticks";
  }
  return text;
}

void draw_legend(ScreenRect rect, const char* cone, ImDrawList& list) {
  ImFont* small = font(Face::small);
  const float em = small->FontSize;
  const Palette& colours = current_palette();
  struct Entry {
    const char* text;
    Ink ink;
  };
  float y = rect.min.y + 0.8f * em;
  for (const Entry& entry :
       {Entry{"device (ghost)", Ink::device}, Entry{"proxy", Ink::proxy}, Entry{"hand", Ink::hand},
        Entry{"contact force, 1 N = 2 cm", Ink::contact}}) {
    const float x = rect.min.x + 0.9f * em;
    list.AddCircleFilled({x + em * 0.3f, y + em * 0.55f}, em * 0.3f,
                         colour(ink(colours, entry.ink)));
    list.AddText(small, em, {x + em, y}, colour(colours.text, 0.85f), entry.text);
    y += 1.35f * em;
  }
  if (cone == nullptr) return;
  const float x = rect.min.x + 0.9f * em;
  const bool slips = std::string_view(cone).ends_with("slips");
  const Rgb tint = slips ? Rgb{0xF0, 0xE4, 0x42} : Rgb{0xCC, 0x79, 0xA7};  // as in the picture
  list.AddCircleFilled({x + em * 0.3f, y + em * 0.55f}, em * 0.3f, colour(tint));
  list.AddText(small, em, {x + em, y}, colour(colours.text, 0.85f), cone);
}

// Of a first start: what to do.
void draw_hint(ScreenRect rect, ImDrawList& list) {
  const Palette& colours = current_palette();
  ImFont* face = font(Face::semibold);
  const float size = face->FontSize * 1.15f;
  const char* lines[] = {"Drag with the left button: your hand pulls the arm onto the table.",
                         "Wheel while dragging: nearer and farther.",
                         "C switches between the coupling laws."};
  float line_y = rect.max.y - 5.2f * size;
  for (const char* line : lines) {
    const ImVec2 extent = face->CalcTextSizeA(size, 1e9f, 0, line);
    const ImVec2 place((rect.min.x + rect.max.x - extent.x) / 2, line_y);
    list.AddRectFilled({place.x - 8, place.y - 2}, {place.x + extent.x + 8, place.y + extent.y + 2},
                       colour(colours.backdrop, 0.72f), 4);
    list.AddText(face, size, place, colour(colours.text), line);
    line_y += 1.5f * size;
  }
}

}  // namespace

ViewState ViewPanel::state_of(const ViewScene& scene, const Settings& settings) {
  Stage& stage = scene.stage;
  const RowLayout& layout = stage.channels().layout();
  ViewState view = stage.rows().view(layout, scene.row);
  if (!scene.rerun.empty()) {
    view.rerun = stage.rows().pose(layout.in(scene.rerun, Column::proxy_position));
  }
  stage.memory.update(view, stage.rows().contacts(layout, scene.row),
                      layout.in(scene.row, Column::time)[0]);
  const auto law = static_cast<CouplingKind>(layout.in(scene.row, Column::kind)[0]);
  // Of the laws the predictive one alone renders friction.
  add_surfaces(stage.document().scene, law == CouplingKind::predictive, view);
  view.show_ghost = settings.show_ghost;
  view.show_trail = settings.show_trail;
  view.show_forces = settings.show_forces;
  view.show_grid = settings.show_grid;
  view.theme = settings.theme;
  return view;
}

void ViewPanel::draw(const ViewScene& scene, Camera& camera, Controls& controls, Settings& settings,
                     ScreenRect rect) {
  const ImVec2 size = rect.size();
  if (size.x < 8 || size.y < 8) return;
  camera.resize(size.x, size.y);
  handle_mouse(scene, camera, controls, settings, rect);

  const double scale = scene.pixel_scale;
  const auto pixels = [&](float points) {
    return static_cast<int>(std::lround(static_cast<double>(points) * scale));
  };
  const ViewState view = state_of(scene, settings);
  SceneView& picture = scene.stage.picture;
  picture.set_pixel_scale(scale * static_cast<double>(current_scale()));
  scene.stage.draw_at(scene.quality);
  picture.draw(view, camera, pixels(rect.min.x), scene.pixel_height - pixels(rect.max.y),
               pixels(size.x), pixels(size.y));
  drawn_ = rect;
  if (settings.show_lens) {
    magnifier_.draw(picture, view, camera, {rect, scale, scene.pixel_height});
  } else {
    magnifier_.hide();
  }
  draw_signs(scene, view, camera, settings, rect);
}

// Over the picture: what is selected, words and numbers.
void ViewPanel::draw_signs(const ViewScene& scene, const ViewState& view, const Camera& camera,
                           const Settings& settings, ScreenRect rect) const {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  if (scene.selected) draw_outline(*scene.selected, camera, rect, list);
  list.PushClipRect(rect.min, rect.max);
  if (settings.show_grid) {
    draw_grid_labels(scene.stage.picture.grid(), camera, rect, magnifier_.rect(), list);
  }
  draw_gap(view, camera, rect, list);
  magnifier_.draw_frame(view, camera, list);
  draw_legend(rect, view.show_forces ? cone_text(view) : nullptr, list);
  if (!settings.hint_seen && !scene.recorded) draw_hint(rect, list);
  list.PopClipRect();
}

bool ViewPanel::differs(const ViewScene& scene, const Camera& camera, const Settings& settings) {
  if (!drawn_) return true;
  Camera shown = camera;
  const auto pixels = [&](float points) {
    return std::round(static_cast<double>(points) * scene.pixel_scale);
  };
  shown.resize(pixels(drawn_->size().x), pixels(drawn_->size().y));
  return scene.stage.picture.differs(state_of(scene, settings), shown);
}

void ViewPanel::handle_mouse(const ViewScene& scene, Camera& camera, Controls& controls,
                             Settings& settings, ScreenRect rect) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool over = rect.contains(io.MousePos) && !io.WantCaptureMouse;
  const Eigen::Vector2d pixel(io.MousePos.x - rect.min.x, io.MousePos.y - rect.min.y);
  const bool orbiting = io.KeyAlt;

  if (over && ImGui::IsMouseClicked(ImGuiMouseButton_Left) && !orbiting && !scene.recorded) {
    dragging_ = true;
    const Stage& stage = scene.stage;
    const RowLayout& layout = stage.channels().layout();
    anchor_ = controls.grab ? controls.goal
                            : stage.rows().tip(layout.in(scene.row, Column::device_position));
    offset_ = anchor_ - camera.plane_drag(pixel, anchor_);
    settings.hint_seen = true;
  }
  if (dragging_ && !ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    dragging_ = false;
    if (!settings.hold_on_release) controls.grab = false;
  }
  if (dragging_) drag_hand(scene.stage.arm(), camera, controls, pixel);

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
void ViewPanel::drag_hand(const ArmDescription& arm, const Camera& camera, Controls& controls,
                          const Eigen::Vector2d& pixel) {
  anchor_ += kDepthStep * static_cast<double>(ImGui::GetIO().MouseWheel) * camera.forward();
  const Vec3 goal = camera.plane_drag(pixel, anchor_ - offset_) + offset_;
  controls.goal = within_reach(arm, goal);
  controls.grab = true;
}

}  // namespace limpid
