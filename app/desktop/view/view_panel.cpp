#include "app/desktop/view/view_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "app/desktop/base/first_steps.h"
#include "app/desktop/device/pad_hand.h"
#include "app/desktop/scene/object_signs.h"
#include "app/desktop/scene/picking.h"
#include "app/stage/picture_signs.h"
#include "app/style/palette.h"
#include "app/style/picture_legend.h"
#include "app/style/theme.h"
#include "render/near_surface.h"

namespace limpid {
namespace {

constexpr double kDepthStep = 0.004;  // depth of one wheel notch while dragging [m]
constexpr double kPullReach = 40;     // reach of the mouse around the tips, at scale 1 [px]
constexpr double kFarthestPull = 5;   // largest distance of a target from the origin [m]
constexpr double kClickReach = 4;     // largest motion of a click [px]
constexpr double kAimReach = 28;  // reach of the mouse around what is dragged onto, at scale 1 [px]
constexpr double kLeastDrag = 8;  // motion before the hand is dragged onto something [px]
constexpr double kToDepth = 0.08;    // time constant of a change of depth [s]
constexpr double kBeforeName = 0.5;  // rest of the mouse before a name is shown [s]

// Returns the least distance of a place from the arm's links, drawn as lines between joints [px].
float apart_from(const ArmPose& arm, const Camera& camera, ScreenRect rect, ImVec2 place) {
  float nearest = 1e9f;
  std::optional<ImVec2> last;
  const auto reach = [&](const Vec3& joint) {
    const auto pixel = camera.project(joint);
    if (!pixel) return;
    const ImVec2 end = in_window(rect, *pixel), start = last.value_or(end);
    last = end;
    const float x = end.x - start.x, y = end.y - start.y;
    const float along = (place.x - start.x) * x + (place.y - start.y) * y;
    const float part = std::clamp(along / std::max(1.0f, x * x + y * y), 0.0f, 1.0f);
    nearest =
        std::min(nearest, std::hypot(place.x - start.x - part * x, place.y - start.y - part * y));
  };
  for (const Pose& link : arm.links) reach(link.translation());
  if (last) reach(arm.tip);
  return nearest;
}

// Draws lengths along the far edge, unless something covers them. Words lie over the whole picture,
// and would seem to be in front of an object that hides them.
void draw_grid_labels(const Scene& objects, const Bounds& grid, const ViewState& view,
                      const Camera& camera, ScreenRect rect, const std::optional<ScreenRect>& lens,
                      ImDrawList& list) {
  ImFont* small = font(Face::small);
  const float em = small->FontSize;
  const Palette& colours = current_palette();
  const float edge = rect.max.x - 1.6f * em;  // a panel's tab may be to the right of it
  ImVec2 last(-1e6f, -1e6f);
  for (int cm = -30; cm <= 30; cm += 10) {
    const Vec3 point(cm / 100.0, grid.max().y(), grid.max().z());
    if (point.x() < grid.min().x() || point.x() > grid.max().x()) continue;
    const auto pixel = camera.project(point);
    if (!pixel) continue;
    const ImVec2 place = in_window(rect, *pixel);
    const auto hidden = [&](float along) {
      return lens && lens->contains({place.x + along, place.y + 0.5f * em});
    };
    const bool crowded = std::hypot(place.x - last.x, place.y - last.y) < 4.5f * em;
    const std::string text = fmt::format("{}{} cm", cm < 0 ? "\u2212" : "", std::abs(cm));
    const float wide = small->CalcTextSizeA(em, 1e9f, 0, text.c_str()).x;
    const bool cut = place.x + wide > edge || legend_box(rect).contains(place);
    const ImVec2 middle(place.x + 0.5f * wide, place.y + 0.5f * em);
    const bool over = std::min(apart_from(view.device, camera, rect, middle),
                               apart_from(view.proxy, camera, rect, middle)) < 0.5f * wide + em;
    const auto behind = [&](float along) {
      const Ray ray = camera.ray({pixel->x() + along, pixel->y() + 0.5 * em});
      const double far = (point - ray.origin).norm();
      return covered(ray, 0.99 * far, objects, view.bodies);
    };
    if (crowded || cut || over || hidden(0) || hidden(3 * em)) continue;
    if (behind(0) || behind(wide)) continue;
    list.AddText(small, em, place, colour(colours.text, 0.9f), text.c_str());
    last = place;
  }
}

// Returns the legend with the friction cone at a contact, preferably one that slips.
PictureLegend legend_of(const ViewState& view, const ViewScene& scene) {
  PictureLegend legend{.beside = scene.rerun.empty() ? nullptr : "proxy of the re-run (ghost)"};
  if (!view.beside.empty()) legend.runs = scene.names.names;
  if (!view.show_forces) return legend;
  for (const ContactMark& contact : view.contacts) {
    if (!(contact.friction > 0) || legend.slips) continue;
    legend.slips = contact.slips;
    legend.cone = contact.slips ? "friction cone: slips" : "friction cone: sticks";
  }
  return legend;
}

// Returns what to do in the scene, and how to take hold of what moves in it.
std::string task_of(const SceneDocument& document) {
  const std::vector<Object>& objects = document.scene.objects;
  const auto moves = [](const Object& object) { return object.body.has_value(); };
  const auto magnetic = [](const Object& object) { return object.body && object.body->magnet; };
  std::string task = document.about;
  const auto add = [&](const char* sentence) {
    task += (task.empty() ? "" : " ") + std::string(sentence);
  };
  if (std::ranges::any_of(objects, magnetic)) add("H switches the magnet at the tip.");
  if (std::ranges::any_of(objects, moves)) add("Ctrl+drag pulls an object.");
  return task;
}

// Returns the scene's task, and below it the hint of a first start that comes next: each until its
// step was done once.
std::vector<std::string> hints(const std::string& task, const std::string& pad,
                               const Settings& settings) {
  const std::pair<FirstStep, std::string> all[] = {
      {FirstStep::pull, pad.empty()
                            ? "Drag the tip of the arm onto a surface. To press, drag further."
                            : "Left stick of " + pad + ": your hand pulls the arm onto a surface."},
      {FirstStep::push,
       pad.empty() ? "Turn the wheel while you drag: nearer and farther."
                   : "Its triggers: nearer and farther. A lets go, B switches the force off."},
      {FirstStep::law,
       "C switches the coupling. With the standard coupling, hand and world move apart."}};
  std::vector<std::string> lines;
  if (!task.empty()) lines.push_back(task);
  for (const auto& [step, line] : all) {
    // A task may say already how the tip is led. Whoever has reached something has no need to lead
    // it nearer or farther.
    const bool said = step == FirstStep::pull && pad.empty() && task.starts_with("Drag the tip");
    const bool needless = said || (step == FirstStep::push && done(settings, FirstStep::press));
    if (done(settings, step) || needless) continue;
    lines.push_back(line);
    break;
  }
  return lines;
}

// Returns the place of a body in the picture: of the ball around it.
std::optional<ScreenRect> seen_place(const Object& object, const Camera& camera, ScreenRect rect) {
  const auto ball = ball_around(object);
  const auto pixel = ball ? camera.project(ball->middle) : std::nullopt;
  if (!pixel) return std::nullopt;
  const auto radius = static_cast<float>(ball->radius / camera.meters_per_pixel(ball->middle));
  const ImVec2 at = in_window(rect, *pixel);
  return ScreenRect{{at.x - radius, at.y - radius}, {at.x + radius, at.y + radius}};
}

// Returns whether nothing moves, so that nothing slips, however near it is to slipping.
bool at_rest(const RowLayout& layout, std::span<const double> row) {
  constexpr double kRests = 5e-4;  // of the proxy's joints [rad/s]
  const auto moves = [](double v) { return std::abs(v) > kRests; };
  return std::ranges::none_of(layout.in(row, Column::proxy_velocity), moves) &&
         (layout.bodies() == 0 || layout.in(row, Column::objects_awake)[0] == 0);
}

// Returns the view of a row, of either run.
ViewState view_of(Stage& stage, std::span<const double> row, ViewMemory& memory,
                  const Settings& settings) {
  const RowLayout& layout = stage.channels().layout();
  ViewState view = stage.rows().view(layout, row);
  memory.update(view, stage.rows().contacts(layout, row), layout.in(row, Column::time)[0]);
  add_surfaces(stage.document().scene, view);
  if (at_rest(layout, row)) {
    for (ContactMark& contact : view.contacts) contact.slips = false;
  }
  view.show_ghost = settings.show_ghost;
  view.show_trail = settings.show_trail;
  view.show_forces = settings.show_forces;
  view.show_grid = settings.show_grid;
  view.show_joints = settings.show_joints;
  view.theme = settings.theme;
  return view;
}

}  // namespace

ScreenRect legend_box(ScreenRect view) {
  const ImVec2 size = picture_legend_size(view.min, view.max);
  return {view.min, {view.min.x + size.x, view.min.y + size.y}};
}

ViewState ViewPanel::state_of(const ViewScene& scene, const Settings& settings) {
  Stage& stage = scene.stage;
  ViewState view = view_of(stage, scene.row, stage.memory[kMainLane], settings);
  if (!scene.rerun.empty()) {
    const RowLayout& layout = stage.channels().layout();
    view.rerun = stage.rows().pose(layout.in(scene.rerun, Column::proxy_position));
    view.rerun_bodies = stage.rows().bodies(layout, scene.rerun);
  }
  for (std::size_t i = 1; scene.overlaid && i <= scene.beside.size(); ++i) {
    lay_over(view, state_beside(scene, i, settings));
  }
  return view;
}

ViewState ViewPanel::state_beside(const ViewScene& scene, std::size_t run,
                                  const Settings& settings) {
  return view_of(scene.stage, scene.beside[run - 1], scene.stage.memory[run], settings);
}

ViewRequest ViewPanel::draw(const ViewScene& scene, Camera& camera, Controls& controls,
                            Settings& settings, ScreenRect rect, bool taken) {
  const std::size_t pictures = scene.pictures();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  for (std::size_t i = 0; i < pictures && !ImGui::IsAnyMouseDown(); ++i) {
    if (i == 0 || part_of(rect, i, pictures).contains(mouse)) under_mouse_ = i;
  }
  const ScreenRect under = part_of(rect, std::min(under_mouse_, pictures - 1), pictures);
  const ImVec2 size = under.size();
  if (size.x < 8 || size.y < 8) return {};
  camera.resize(size.x, size.y);
  ViewRequest asked = handle_mouse(scene, camera, controls, settings, under, taken);
  scene.stage.picture.set_pixel_scale(scene.pixel_scale * static_cast<double>(current_scale()));
  scene.stage.draw_at(scene.quality);
  drawn_ = part_of(rect, 0, pictures);
  draw_pictures(scene, camera, settings, rect);
  return asked;
}

// Draws the pictures of all runs with one camera.
void ViewPanel::draw_pictures(const ViewScene& scene, const Camera& camera,
                              const Settings& settings, ScreenRect rect) {
  SceneView& picture = scene.stage.picture;
  const double scale = scene.pixel_scale;
  const auto pixels = [&](float points) {
    return static_cast<int>(std::lround(static_cast<double>(points) * scale));
  };
  const auto paint = [&](const ViewState& view, ScreenRect part, std::size_t run) {
    picture.draw(view, camera, pixels(part.min.x), scene.pixel_height - pixels(part.max.y),
                 pixels(part.width()), pixels(part.height()), SceneView::sheet_of(run));
  };
  const ViewState view = state_of(scene, settings);
  std::vector<ViewState> beside;  // in pictures of their own
  for (std::size_t run = 1; run < scene.pictures(); ++run) {
    beside.push_back(state_beside(scene, run, settings));
  }
  see_crowd(scene, view, beside, camera, rect);
  paint(view, *drawn_, kMainLane);
  if (settings.show_lens && !scene.split()) {
    magnifier_.draw(picture, view, camera, {rect, scale, scene.pixel_height, scene.words},
                    crowd_with_hints());
  } else {
    magnifier_.hide();
  }
  follow_task(scene, view);
  if (!scene.blind) draw_signs(scene, view, camera, settings, *drawn_);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  float below_names = 0;
  for (std::size_t run = 1; run < scene.pictures(); ++run) {
    const ScreenRect part = part_of(rect, run, scene.pictures());
    const ViewState& other = beside[run - 1];
    paint(other, part, run);
    list.PushClipRect(part.min, part.max);
    if (!scene.blind) draw_gap(other, camera, {part}, list);
    list.PopClipRect();
    const ScreenRect before = part_of(rect, run - 1, scene.pictures());
    list.AddRectFilled({before.max.x, rect.min.y}, {part.min.x, rect.max.y},
                       colour(current_palette().border));
  }
  for (std::size_t run = 0; scene.split() && run < scene.pictures(); ++run) {
    draw_run_name(scene.names, run, part_of(rect, run, scene.pictures()), list);
    below_names = run_name_room();
  }
  if (scene.blind) return;
  PictureLegend legend = legend_of(view, scene);
  legend.compact = scene.split();  // each picture is narrow: full lines would cover its arm
  draw_picture_legend(list, {rect.min.x, rect.min.y + below_names}, rect.max, legend);
  draw_told(scene.told, rect, list);
}

// Notes where tips are and what is acted on, in all pictures.
void ViewPanel::see_crowd(const ViewScene& scene, const ViewState& view,
                          std::span<const ViewState> beside, const Camera& camera,
                          ScreenRect rect) {
  crowd_ = {};
  const std::size_t pictures = 1 + beside.size();
  keep_acted_on_free(view, camera, part_of(rect, 0, pictures), crowd_);
  for (std::size_t run = 1; run < pictures; ++run) {
    keep_acted_on_free(beside[run - 1], camera, part_of(rect, run, pictures), crowd_);
  }
  const ScreenRect first = part_of(rect, 0, pictures);
  if (scene.selected) {
    if (const auto place = seen_place(*scene.selected, camera, first)) {
      crowd_.kept_free.push_back(*place);
    }
  }
  const SceneDocument& document = scene.stage.document();
  for (std::size_t i = 0; i < document.scene.objects.size(); ++i) {
    if (!document.scene.objects[i].body) continue;
    const Object now = placed_now(document.scene, i, view.bodies);
    if (const auto place = seen_place(now, camera, first)) {
      crowd_.better_free.push_back(*place);
    }
  }
  crowd_.kept_free.push_back(legend_box(rect));
  around_ = crowd_;
  around_.kept_free.insert(around_.kept_free.end(), scene.cards.begin(), scene.cards.end());
}

Crowd ViewPanel::crowd_with_hints() const {
  Crowd crowd = around_;
  if (hinted_) crowd.kept_free.push_back(*hinted_);
  return crowd;
}

Crowd ViewPanel::crowd_with_signs() const {
  Crowd crowd = crowd_with_hints();
  if (magnifier_.rect()) crowd.kept_free.push_back(*magnifier_.rect());
  return crowd;
}

// Draws hints at the foot of the picture, or at its top if the tip is at the foot.
void ViewPanel::draw_hints(const ViewScene& scene, const Camera& camera, const Settings& settings,
                           ScreenRect rect, ImDrawList& list) {
  const Palette& colours = current_palette();
  ImFont* face = font(Face::semibold);
  hinted_.reset();
  auto lines = hints(task_done_ ? std::string() : task_, scene.pad, settings);
  if (magnet_on_) {
    lines.insert(lines.begin(), magnet_broke_
                                    ? "The magnet lost its object, because the pull was too "
                                      "strong. Press H twice to pick the object up again."
                                    : "The magnet is on. H lets go.");
  }
  if (lines.empty()) return;
  const float size = face->FontSize * 1.15f, wrap = rect.width() - 3 * face->FontSize;
  const auto extent_of = [&](const std::string& line) {
    return face->CalcTextSizeA(size, 1e9f, wrap, line.c_str());
  };
  constexpr float kMostHigh = 0.4f;  // part of the picture; later lines wait for earlier ones
  float widest = 0, high = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const ImVec2 extent = extent_of(lines[i]);
    if (i > 0 && high + extent.y > kMostHigh * rect.height()) {
      lines.resize(i);
      break;
    }
    widest = std::max(widest, extent.x);
    high += extent.y + 0.5f * size;
  }
  const float middle = (rect.min.x + rect.max.x) / 2;
  const auto at = [&](float top) {
    return ScreenRect{{middle - widest / 2 - 8, top}, {middle + widest / 2 + 8, top + high}};
  };
  // The tab that folds the plots is at the foot.
  const float foot = rect.max.y - 20 * current_scale() - high + 0.5f * size;
  const std::array places{at(foot),
                          at(std::max(rect.min.y + scene.words, legend_box(rect).max.y) + size)};
  const std::pair size_now(rect.width(), rect.height());
  const Eigen::Matrix4d looks = camera.projection() * camera.view();
  if (hinted_in_ != size_now || hinted_by_ != looks) hint_place_.forget();
  hinted_in_ = size_now;
  hinted_by_ = looks;
  hinted_ = hint_place_.choose(places, around_);
  float line_y = hinted_->min.y;
  for (const std::string& line : lines) {
    const ImVec2 extent = extent_of(line);
    const ImVec2 place(middle - extent.x / 2, line_y);
    list.AddRectFilled({place.x - 8, place.y - 2}, {place.x + extent.x + 8, place.y + extent.y + 2},
                       colour(colours.backdrop, 0.72f), 4);
    list.AddText(face, size, place, colour(colours.text), line.c_str(), nullptr, wrap);
    line_y += extent.y + 0.5f * size;
  }
}

// Notes when the scene's task was begun: then it is not told any more.
void ViewPanel::follow_task(const ViewScene& scene, const ViewState& view) {
  if (std::string task = task_of(scene.stage.document()); task != task_) {
    task_ = std::move(task);
    task_done_ = false;
    hint_place_.forget();
  }
  task_done_ = task_done_ || !view.contacts.empty() || pulling_;
  magnet_broke_ = view.magnet && !view.magnet_holds && (magnet_broke_ || magnet_holds_);
  magnet_on_ = view.magnet;
  magnet_holds_ = view.magnet_holds;
}

// Draws over the picture: the selected object's outline, words and numbers.
void ViewPanel::draw_signs(const ViewScene& scene, const ViewState& view, const Camera& camera,
                           const Settings& settings, ScreenRect rect) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  if (scene.selected) draw_outline(*scene.selected, camera, rect, list);
  list.PushClipRect(rect.min, rect.max);
  if (settings.show_grid) {
    draw_grid_labels(scene.stage.document().scene, scene.stage.picture.grid(), view, camera, rect,
                     magnifier_.rect(), list);
  }
  draw_gap(view, camera, {rect, magnifier_.rect()}, list, scene.split() ? RunNames() : scene.names);
  if (view.pull) {
    draw_pull(view, pull_on(scene.stage.document().scene, view.pulled, *view.pull), camera, rect,
              list);
  }
  draw_magnet(view, camera, rect, list);
  if (pulls_) draw_grasp(view, camera, rect, list);
  if (const auto below = dragging_ && scene.drop ? scene.drop(view.device.tip) : std::nullopt) {
    draw_drop(view, *below, camera, rect, list);
  }
  magnifier_.draw_frame(view, camera, list);
  if (!scene.recorded && scene.beside.empty() && !settings.your_turn && !scene.asked) {
    draw_hints(scene, camera, settings, rect, list);
  } else {
    hinted_.reset();
  }
  list.PopClipRect();
}

bool ViewPanel::differs(const ViewScene& scene, const Camera& camera, const Settings& settings) {
  if (!drawn_) return true;
  Camera shown = camera;
  const auto pixels = [&](float points) {
    return std::round(static_cast<double>(points) * scene.pixel_scale);
  };
  shown.resize(pixels(drawn_->size().x), pixels(drawn_->size().y));
  const SceneView& picture = scene.stage.picture;
  if (picture.differs(state_of(scene, settings), shown)) return true;
  for (std::size_t run = 1; run < scene.pictures(); ++run) {
    const ViewState other = state_beside(scene, run, settings);
    if (picture.differs(other, shown, SceneView::sheet_of(run))) return true;
  }
  return false;
}

bool ViewPanel::near_tip(const ViewScene& scene, const Camera& camera,
                         const Eigen::Vector2d& pixel) {
  if (scene.recorded) return false;
  const Stage& stage = scene.stage;
  const RowLayout& layout = stage.channels().layout();
  const auto near = [&](Column c) {
    const auto tip = camera.project(stage.rows().tip(layout.in(scene.row, c)));
    return tip && (*tip - pixel).norm() < kPullReach * static_cast<double>(current_scale());
  };
  return near(Column::device_position) || near(Column::proxy_position);
}

// Lets the mouse hold this point from now on.
void ViewPanel::hold(const Camera& camera, ScreenRect rect, const Vec3& point,
                     const Eigen::Vector2d& pixel) {
  anchor_ = point;
  offset_ = anchor_ - camera.plane_drag(pixel, anchor_);
  looked_ = camera.projection() * camera.view();
  corner_ = rect.min;
}

ViewRequest ViewPanel::handle_mouse(const ViewScene& scene, Camera& camera, Controls& controls,
                                    Settings& settings, ScreenRect rect, bool taken) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool over = rect.contains(io.MousePos) && !io.WantCaptureMouse && !taken;
  const Eigen::Vector2d pixel(io.MousePos.x - rect.min.x, io.MousePos.y - rect.min.y);
  const RowLayout& layout = scene.stage.channels().layout();
  const bool free = !ImGui::IsAnyMouseDown() || ImGui::IsMouseClicked(ImGuiMouseButton_Left);
  const bool on_body = pull_body(scene, camera, controls, rect, pixel, over);
  if (free) {
    pulls_ = over && !io.KeyAlt && !io.KeyCtrl && near_tip(scene, camera, pixel);
  }
  if (pulls_) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);

  if (pulls_ && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
    dragging_ = true;
    hold(camera, rect,
         controls.grab ? controls.goal
                       : scene.stage.rows().tip(layout.in(scene.row, Column::device_position)),
         pixel);
    aimed_at_.reset();
    to_depth_ = 0;
    began_at_ = pixel;
    settings.hint_seen = true;
    note_done(settings, FirstStep::pull);
  }
  if (std::exchange(pushed_, false)) note_done(settings, FirstStep::push);
  const bool dragged = dragging_;
  if (dragging_ && !ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
    dragging_ = false;
    if (!settings.hold_on_release) controls.grab = false;
  }
  if (dragging_) drag_hand(scene, camera, controls, rect, pixel);
  if (over && !dragging_ && !on_body) name_what_is_there(scene, camera, pixel);

  ViewRequest asked;
  for (const int button : {ImGuiMouseButton_Left, ImGuiMouseButton_Right}) {
    const auto i = static_cast<std::size_t>(button);
    if (over && !on_body && ImGui::IsMouseClicked(button)) {
      pressed_[i] = pixel;
      moved_[i] = false;
    }
    if (!pressed_[i]) continue;
    moved_[i] = moved_[i] || (pixel - *pressed_[i]).norm() > kClickReach;
    if (ImGui::IsMouseDown(button)) continue;
    const auto at = std::exchange(pressed_[i], std::nullopt);
    if (moved_[i] || scene.recorded) continue;
    (button == ImGuiMouseButton_Left ? asked.clicked : asked.asked) = camera.ray(*at);
  }
  const bool left = pressed_[0] && moved_[0] && !dragged, right = pressed_[1] && moved_[1];
  const bool pan = ImGui::IsMouseDragging(ImGuiMouseButton_Middle, 0) || (right && io.KeyShift);
  const bool moved = !io.WantCaptureMouse && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0);
  if (moved && pan) {
    camera.pan(io.MouseDelta.x, io.MouseDelta.y);
  } else if (moved && (left || right)) {
    camera.orbit(io.MouseDelta.x, io.MouseDelta.y);
  }
  const bool zoom = over && !dragging_ && !on_body && io.MouseWheel != 0;
  if (zoom) camera.zoom(io.MouseWheel, pixel);
  asked.turned = zoom || (moved && (pan || left || right));
  return asked;
}

// Moves the target in the plane through it that is parallel to the picture. The wheel moves that
// plane, and so does an object that the mouse comes to. If the camera has moved since the last
// frame, the target stays in the world.
void ViewPanel::drag_hand(const ViewScene& scene, const Camera& camera, Controls& controls,
                          ScreenRect rect, const Eigen::Vector2d& pixel) {
  stay(camera, rect, controls.grab ? controls.goal : anchor_, pixel);
  if (ImGui::GetIO().MouseWheel != 0) {
    pushed_ = true;
    to_depth_ = 0;
  }
  aim_at(scene, camera, pixel);
  controls.goal = within_reach(scene.stage.arm(), dragged_to(camera, pixel));
  controls.grab = true;
}

// Returns the place to aim at under the mouse, or else the nearest to it.
std::optional<Aim> ViewPanel::aim_near(const ViewScene& scene, const Camera& camera,
                                       const Eigen::Vector2d& pixel) const {
  if (!scene.aim) return std::nullopt;
  if (auto aim = scene.aim(camera.ray(pixel))) return aim;
  const double reach = kAimReach * static_cast<double>(current_scale());
  for (const double radius : {reach / 2, reach}) {
    for (int i = 0; i < 8; ++i) {
      const double angle = 0.25 * std::numbers::pi * i;
      const Eigen::Vector2d there =
          pixel + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      if (auto aim = scene.aim(camera.ray(there))) return aim;
    }
  }
  return std::nullopt;
}

// Takes the depth of an object when the mouse comes to it, once: what is pushed away is not
// followed. With Shift the depth stays.
void ViewPanel::aim_at(const ViewScene& scene, const Camera& camera, const Eigen::Vector2d& pixel) {
  // Something behind the tip is not dragged onto before the mouse has moved.
  if (ImGui::GetIO().KeyShift) {
    to_depth_ = 0;
    return;
  }
  const double still = kLeastDrag * static_cast<double>(current_scale());
  if (began_at_ && (pixel - *began_at_).norm() < still) return;
  began_at_.reset();
  const auto aim = aim_near(scene, camera, pixel);
  const auto object = aim ? std::optional(aim->object) : std::nullopt;
  if (object && object != aimed_at_) to_depth_ = (aim->point - anchor_).dot(camera.forward());
  if (object != aimed_at_) aimed_at_ = object;
  const double part = 1 - std::exp(-static_cast<double>(ImGui::GetIO().DeltaTime) / kToDepth);
  anchor_ += part * to_depth_ * camera.forward();
  to_depth_ -= part * to_depth_;
}

// Shows an object's name, and how to pick it up, where the mouse rests on it.
void ViewPanel::name_what_is_there(const ViewScene& scene, const Camera& camera,
                                   const Eigen::Vector2d& pixel) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool moves = io.MouseDelta.x != 0 || io.MouseDelta.y != 0 || ImGui::IsAnyMouseDown();
  if (moves) rests_since_ = ImGui::GetTime();
  if (ImGui::GetTime() < rests_since_ + kBeforeName || !scene.aim || scene.blind) return;
  const auto aim = scene.aim(camera.ray(pixel));
  const Scene& objects = scene.stage.document().scene;
  if (!aim || aim->object >= objects.objects.size()) return;
  const Object& object = objects.objects[aim->object];
  if (object.name.empty()) return;
  std::string text = object.name;
  const std::string mass = object.body ? fmt::format("{:.3g} g", 1e3 * object.body->mass) : "";
  if (!mass.empty() && mass != object.name) text += ", " + mass;
  if (object.body && object.body->magnet) text += "\nPress H to pick it up with the tip";
  ImGui::SetTooltip("%s", text.c_str());
}

void ViewPanel::stay(const Camera& camera, ScreenRect rect, const Vec3& point,
                     const Eigen::Vector2d& pixel) {
  const Eigen::Matrix4d looks = camera.projection() * camera.view();
  if (looks != looked_ || rect.min.x != corner_.x || rect.min.y != corner_.y) {
    hold(camera, rect, point, pixel);
  }
}

Vec3 ViewPanel::dragged_to(const Camera& camera, const Eigen::Vector2d& pixel) {
  anchor_ += kDepthStep * static_cast<double>(ImGui::GetIO().MouseWheel) * camera.forward();
  return camera.plane_drag(pixel, anchor_ - offset_) + offset_;
}

// Pulls the body under the mouse with Ctrl and the left button. Returns whether the mouse is used
// for that.
bool ViewPanel::pull_body(const ViewScene& scene, const Camera& camera, Controls& controls,
                          ScreenRect rect, const Eigen::Vector2d& pixel, bool over) {
  if (pulling_) {
    pulling_ =
        !scene.recorded && controls.pull.body >= 0 && ImGui::IsMouseDown(ImGuiMouseButton_Left);
    if (!pulling_) controls.pull = {};
  } else if (over && ImGui::GetIO().KeyCtrl && !scene.recorded && scene.grasp) {
    const bool clicked = ImGui::IsMouseClicked(ImGuiMouseButton_Left);
    if (ImGui::IsAnyMouseDown() && !clicked) return false;
    const auto pull = scene.grasp(camera.ray(pixel));
    if (!pull) return false;
    if (clicked) {
      controls.pull = *pull;
      pulling_ = true;
      hold(camera, rect, pull->target, pixel);
    } else {
      ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    }
  }
  if (!pulling_) return false;
  ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
  stay(camera, rect, controls.pull.target, pixel);
  const Vec3 target = dragged_to(camera, pixel);
  if (target.norm() < kFarthestPull) controls.pull.target = target;
  return true;
}

}  // namespace limpid
