#include "app/desktop/scene/transform_tool.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

#include "app/desktop/scene/picking.h"
#include "app/stage/picture_signs.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

constexpr double kHandleLength = 64;  // length of a handle at scale 1 [px]
constexpr float kHandleReach = 9;     // largest distance of the mouse from it [px]
constexpr std::array kAxisInks{Ink::contact, Ink::hand, Ink::proxy};

// Returns the distance of a place from a line on the screen [px].
float apart_from(ImVec2 place, ImVec2 a, ImVec2 b) {
  const float x = b.x - a.x, y = b.y - a.y;
  const float part = std::clamp(
      ((place.x - a.x) * x + (place.y - a.y) * y) / std::max(1.0f, x * x + y * y), 0.0f, 1.0f);
  return std::hypot(place.x - a.x - part * x, place.y - a.y - part * y);
}

}  // namespace

void TransformTool::begin(TransformKind kind) { wanted_ = kind; }

void TransformTool::lock(int axis) { axis_ = axis_ == axis ? std::nullopt : std::optional(axis); }

bool TransformTool::type(unsigned character) {
  if (!transform_ || character > '~') return false;
  const char c = character == ',' ? '.' : static_cast<char>(character);
  constexpr std::size_t kLongest = 9;
  const bool fits = c == '-'   ? typed_.empty()
                    : c == '.' ? typed_.find('.') == std::string::npos
                               : c >= '0' && c <= '9';
  if (fits && typed_.size() < kLongest) typed_ += c;
  return fits;
}

bool TransformTool::untype() {
  if (typed_.empty()) return false;
  typed_.pop_back();
  return true;
}

void TransformTool::give_up(Document& document) {
  wanted_.reset();
  if (!std::exchange(transform_, std::nullopt)) return;
  if (document.editor().version().world != before_.world) document.give_up(before_);
}

bool TransformTool::draw(Document& document, std::span<const Pose> bodies, const Camera& camera,
                         ScreenRect view, bool on_tip) {
  const auto selected = document.editor().selected();
  if (transform_ && selected != place_) transform_.reset();
  const ImGuiIO& io = ImGui::GetIO();
  if (!selected || !document.why_fixed().empty()) {
    if (wanted_ && selected) document.may_edit();  // shows a notice with the reason
    wanted_.reset();
    return over_ = false;
  }
  const Eigen::Vector2d mouse(io.MousePos.x - view.min.x, io.MousePos.y - view.min.y);
  const Object now = placed_now(document.scene(), *selected, bodies);
  if (wanted_) {
    kind_ = *std::exchange(wanted_, std::nullopt);
    axis_.reset();
    by_key_ = true;
    if (can(kind_, now)) start(document, now, mouse);
  }
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.PushClipRect(view.min, view.max);
  if (!transform_ && can(kind_, now)) {
    const Transform shown(kind_, now, document.editor().models()[*selected].get());
    const Handle nearest = draw_handles(shown, camera, view, list);
    const bool free = view.contains(io.MousePos) && !io.WantCaptureMouse && !io.KeyAlt && !on_tip;
    over_ = free && nearest.apart < kHandleReach * current_scale();
    hot_ = nearest.axis;
    if (over_) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeAll);
    if (over_ && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
      by_key_ = false;
      axis_ = hot_;
      start(document, now, mouse);
    }
  }
  const bool followed = transform_.has_value();  // even if a click ends it in this frame
  if (transform_) follow(document, camera, mouse, list);
  list.PopClipRect();
  return followed || (over_ && !ImGui::IsMouseDown(ImGuiMouseButton_Right));
}

void TransformTool::start(Document& document, const Object& now, const Eigen::Vector2d& mouse) {
  place_ = *document.editor().selected();
  before_ = document.editor().version();
  begin_ = mouse;
  typed_.clear();
  transform_.emplace(kind_, now, document.editor().models()[place_].get());
}

void TransformTool::follow(Document& document, const Camera& camera, const Eigen::Vector2d& mouse,
                           ImDrawList& list) {
  // Ending changes nothing more: that would be another step of undo.
  if (by_key_ && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) return give_up(document);
  const bool done = by_key_ ? ImGui::IsMouseClicked(ImGuiMouseButton_Left)
                            : !ImGui::IsMouseDown(ImGuiMouseButton_Left);
  if (done) return accept();
  transform_->axis = axis_;
  double amount = 0;
  const char* const end = typed_.data() + typed_.size();
  const bool typed = std::from_chars(typed_.data(), end, amount).ec == std::errc();
  const auto [object, text] = typed ? transform_->by(camera, amount)
                                    : transform_->to(camera, begin_, mouse, ImGui::GetIO().KeyCtrl);
  const Object& present = document.scene().objects[place_];
  const bool same = object.pose.isApprox(present.pose, 1e-12) && object.shape == present.shape;
  if (!same && (typed || mouse != begin_))
    document.editor().set(place_, object, transform_->what());
  const ImVec2 at = ImGui::GetIO().MousePos;
  ImFont* face = font(Face::small);
  const float em = face->FontSize;
  const ImVec2 size = face->CalcTextSizeA(em, 1e9f, 0, text.c_str());
  const ImVec2 corner(at.x + 1.4f * em, at.y + 1.2f * em);
  const Palette& colours = current_palette();
  list.AddRectFilled({corner.x - 0.3f * em, corner.y - 0.2f * em},
                     {corner.x + size.x + 0.3f * em, corner.y + size.y + 0.2f * em},
                     colour(colours.backdrop, 0.8f), 3);
  list.AddText(face, em, corner, colour(colours.text), text.c_str());
}

// Returns the handle nearest to the mouse.
TransformTool::Handle TransformTool::draw_handles(const Transform& shown, const Camera& camera,
                                                  ScreenRect view, ImDrawList& list) const {
  Handle nearest;
  const auto middle = camera.project(shown.pivot);
  if (!middle) return nearest;
  const ImVec2 mouse = ImGui::GetIO().MousePos, centre = in_window(view, *middle);
  const float scale = current_scale();
  const double length =
      kHandleLength * static_cast<double>(scale) * camera.meters_per_pixel(shown.pivot);
  const auto note = [&](std::optional<int> axis, float apart) {
    if (apart < nearest.apart) nearest = {axis, apart};
  };
  const auto thick = [&](std::optional<int> axis) {
    return (over_ && hot_ == axis ? 4.0f : 2.5f) * scale;
  };
  const ImU32 rim = colour(current_palette().backdrop, 0.6f);
  for (int i = 0; i < 3; ++i) {
    const Vec3 line = shown.direction(i);
    const ImU32 tint = colour(ink(current_palette(), kAxisInks[static_cast<std::size_t>(i)]));
    if (kind_ == TransformKind::turn) {
      const Vec3 u = line.unitOrthogonal(), v = line.cross(u);
      std::optional<ImVec2> last;
      constexpr int kCorners = 48;
      for (int k = 0; k <= kCorners; ++k) {
        const double angle = 2 * std::numbers::pi * k / kCorners;
        const auto pixel =
            camera.project(shown.pivot + length * (std::cos(angle) * u + std::sin(angle) * v));
        if (!pixel) break;
        const ImVec2 next = in_window(view, *pixel);
        if (last) {
          list.AddLine(*last, next, tint, thick(i));
          note(i, apart_from(mouse, *last, next));
        }
        last = next;
      }
      continue;
    }
    const auto pixel = camera.project(shown.pivot + length * line);
    if (!pixel) continue;
    const ImVec2 end = in_window(view, *pixel);
    const float r = 5 * scale;
    list.AddLine(centre, end, rim, thick(i) + 2);
    list.AddLine(centre, end, tint, thick(i));
    if (kind_ == TransformKind::move) {
      list.AddCircleFilled(end, r, tint);
    } else {
      list.AddRectFilled({end.x - r, end.y - r}, {end.x + r, end.y + r}, tint);
    }
    ImFont* face = font(Face::small);
    list.AddText(face, face->FontSize, {end.x + 1.4f * r, end.y - 1.4f * r}, tint,
                 kAxisNames[static_cast<std::size_t>(i)]);
    note(i, apart_from(mouse, centre, end));
  }
  // The free handle is in the middle.
  if (kind_ != TransformKind::turn) {
    const float r = 6 * scale;
    list.AddCircleFilled(centre, r, colour(current_palette().accent));
    list.AddCircle(centre, r, rim, 0, 1.5f * scale);
    if (std::hypot(mouse.x - centre.x, mouse.y - centre.y) < 1.5f * r) nearest = {std::nullopt, 0};
  }
  return nearest;
}

}  // namespace limpid
