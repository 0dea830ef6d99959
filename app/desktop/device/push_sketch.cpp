#include "app/desktop/device/push_sketch.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/style/palette.h"
#include "app/style/theme.h"
#include "app/style/words.h"
#include "core/dynamics/arm.h"

namespace limpid {
namespace {

constexpr double kLeastMotion = 1e-4;  // of the tip for a unit of an axis [m]
constexpr float kArmRoom = 2.5f;       // edge of the square that the arm takes [em]
constexpr float kPushLength = 2;       // [em]

// Places of an arm at rest in the base's frame, base first, and its tip's motion.
struct RestingArm {
  std::vector<Vec3> joints;  // with the base before and the tip behind them [m]
  Vec3 motion;               // of the tip, for a unit of the axis [m]
};
RestingArm resting_arm(const ArmDescription& arm, int axis) {
  using Chain = Arm<kAnyDof>;
  const Chain chain(arm);
  Chain::Frames frames;
  chain.frames(Vec<kAnyDof>(rest_pose(arm)), frames);
  RestingArm at{{Vec3::Zero()}, Vec3::Zero()};
  for (int i = 0; i < arm.dof(); ++i) at.joints.push_back(Chain::point(frames, i, Vec3::Zero()));
  const Vec3 tip = chain.tip(frames);
  at.joints.push_back(tip);
  Jacobian<kAnyDof> J = Jacobian<kAnyDof>::Zero(3, arm.dof());
  chain.point_jacobian(frames, arm.dof() - 1, tip, J);
  at.motion = J.col(axis);
  return at;
}

// Returns a place or direction of the base's frame in the window, in metres.
ImVec2 seen_from(PushView view, const Vec3& v) {
  const bool above = view == PushView::above;
  return {static_cast<float>(above ? -v.y() : v.x()), static_cast<float>(above ? -v.x() : -v.z())};
}

PushView view_of_motion(const Vec3& motion) {
  return std::abs(motion.y()) > std::abs(motion.z()) ? PushView::above : PushView::side;
}

void draw_arrow(ImDrawList& list, ImVec2 from, ImVec2 along, float length, ImU32 rgba) {
  const float em = ImGui::GetFontSize(), head = 0.5f * em;
  const ImVec2 end(from.x + length * along.x, from.y + length * along.y);
  const ImVec2 neck(end.x - head * along.x, end.y - head * along.y);
  const ImVec2 aside(-0.6f * head * along.y, 0.6f * head * along.x);
  list.AddLine(from, neck, rgba, 0.15f * em);
  list.AddTriangleFilled(end, {neck.x + aside.x, neck.y + aside.y},
                         {neck.x - aside.x, neck.y - aside.y}, rgba);
}

// Draws the axes of the base's frame in the lower left corner, or right where y points left.
void draw_base_frame(ImDrawList& list, PushView view, ImVec2 min, ImVec2 max) {
  const Palette& colours = current_palette();
  ImFont* face = font(Face::small);
  const float em = face->FontSize;
  const bool above = view == PushView::above;
  const char* const across = above ? "y left" : "x forward";
  const char* const upward = above ? "x forward" : "z up";
  const ImVec2 size = face->CalcTextSizeA(em, 1e9f, 0, across);
  const float y = max.y - 0.4f * em - 0.5f * size.y, way = 1.4f * em;
  const ImVec2 corner(above ? max.x - 0.8f * em : min.x + 0.8f * em, y);
  const ImU32 line = colour(colours.axis), text = colour(colours.muted);
  draw_arrow(list, corner, {above ? -1.0f : 1.0f, 0}, way, line);
  draw_arrow(list, corner, {0, -1}, way, line);
  const float beside = way + 0.3f * em;
  list.AddText(face, em,
               {above ? corner.x - beside - size.x : corner.x + beside, y - 0.5f * size.y}, text,
               across);
  const ImVec2 up = face->CalcTextSizeA(em, 1e9f, 0, upward);
  list.AddText(face, em,
               {above ? max.x - 0.4f * em - up.x : min.x + 0.4f * em, y - way - 0.2f * em - up.y},
               text, upward);
  list.AddText(face, em, {min.x + 0.4f * em, min.y + 0.2f * em}, text,
               above ? "from above" : "from the side");
}

}  // namespace

std::optional<PushArrow> push_arrow(const ArmDescription& arm, int axis) {
  if (axis < 0 || axis >= arm.dof()) return std::nullopt;
  const Vec3 motion = resting_arm(arm, axis).motion;
  if (!(motion.norm() > kLeastMotion)) return std::nullopt;
  const PushView view = view_of_motion(motion);
  const ImVec2 seen = seen_from(view, motion);
  const float length = std::hypot(seen.x, seen.y);
  return PushArrow{view, {seen.x / length, seen.y / length}};
}

ImVec2 push_sketch_size() {
  const float em = ImGui::GetFontSize();
  return {10 * em, 9 * em};
}

bool draw_push_sketch(const ArmDescription& arm, int axis, AxisStage stage) {
  const auto arrow = push_arrow(arm, axis);
  if (!arrow) return false;
  const Palette& colours = current_palette();
  const float em = ImGui::GetFontSize();
  const ImVec2 min = ImGui::GetCursorScreenPos(), size = push_sketch_size();
  const ImVec2 max(min.x + size.x, min.y + size.y);
  ImGui::Dummy(size);
  tooltip(
      "Shows the arm at rest. A motor with the right sign pushes the tip along the strong arrow "
      "first, then back along the pale arrow. During a push its arrow is coloured.");
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(min, max, colour(colours.backdrop), 0.2f * em);
  draw_base_frame(list, arrow->view, min, max);

  // The arm takes the middle: arrows and words have the room around.
  std::vector<ImVec2> joints;
  for (const Vec3& each : resting_arm(arm, axis).joints) {
    joints.push_back(seen_from(arrow->view, each));
  }
  ImVec2 low = joints.front(), high = low;
  for (const ImVec2& each : joints) {
    low = {std::min(low.x, each.x), std::min(low.y, each.y)};
    high = {std::max(high.x, each.x), std::max(high.y, each.y)};
  }
  constexpr float kLeastWide = 1e-3f;  // of an arm that is seen along itself [m]
  const float scale = kArmRoom * em / std::max({high.x - low.x, high.y - low.y, kLeastWide});
  const ImVec2 middle((min.x + max.x) / 2, (min.y + max.y) / 2 - 0.5f * em);
  for (ImVec2& each : joints) {
    each = {middle.x + scale * (each.x - (low.x + high.x) / 2),
            middle.y + scale * (each.y - (low.y + high.y) / 2)};
  }
  const ImU32 links = colour(ink(colours, Ink::device));
  for (std::size_t i = 1; i < joints.size(); ++i) {
    list.AddLine(joints[i - 1], joints[i], links, 0.2f * em);
    list.AddCircleFilled(joints[i], 0.2f * em, links);
  }
  list.AddRectFilled({joints.front().x - 0.3f * em, joints.front().y - 0.3f * em},
                     {joints.front().x + 0.3f * em, joints.front().y + 0.3f * em}, links);
  const ImVec2 tip = joints.back(), way = arrow->direction;
  const float length = kPushLength * em;
  const bool first = stage == AxisStage::pushing, second = stage == AxisStage::pushing_back;
  draw_arrow(list, tip, {-way.x, -way.y}, length, colour(second ? colours.accent : colours.axis));
  draw_arrow(list, tip, way, length, colour(first ? colours.accent : colours.muted));
  return true;
}

}  // namespace limpid
