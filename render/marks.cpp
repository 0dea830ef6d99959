#include "render/marks.h"

#include <algorithm>
#include <cmath>

#include "render/gl/gl_names.h"
#include "render/palette.h"

namespace limpid {
namespace {

constexpr double kLeastForce = 0.02;    // smaller forces have no arrow [N]
constexpr double kLeastError = 0.0001;  // [m]
constexpr double kShadeHeight = 0.06;   // a tip above leaves no shade [m]
constexpr double kFlashTime = 0.25;     // [s]

glm::vec4 with_alpha(const palette::Rgb& c, float alpha) { return {c[0], c[1], c[2], alpha}; }

palette::Rgb lighter(const palette::Rgb& c, float by) { return palette::mix(c, {1, 1, 1}, by); }

// Places a unit shape along z at `at`: scaled across and along, its z turned to `direction`.
glm::mat4 place(const Vec3& at, const Vec3& direction, double across, double along) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.block<3, 3>(0, 0) =
      Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), direction).toRotationMatrix() *
      Vec3(across, across, along).asDiagonal();
  m.block<3, 1>(0, 3) = at;
  return to_glm(m);
}

// Radius of a contact's patch [m]: seen at once, larger for a harder touch, though never
// everything.
double patch_radius(double force) { return 0.016 + 0.026 * (1 - std::exp(-force / 4)); }

void add_arrow(const Vec3& from, const Vec3& force, const palette::Rgb& color, double size,
               std::vector<SolidMark>& out) {
  if (!from.allFinite() || !(force.norm() > kLeastForce) || !force.allFinite()) return;
  const double length = kMetersPerNewton * force.norm();
  const double head = std::min(0.019 * size, 0.6 * length), radius = 0.36 * head;
  const Vec3 direction = force.normalized();
  out.push_back(
      {SolidMark::Shape::tube, place(from, direction, 0.36 * radius, length - head), color});
  out.push_back({SolidMark::Shape::cone,
                 place(from + (length - head) * direction, direction, radius, head), color});
}

// Adds a pen with its point at the tip, and a button on its upper side, which shows how it is
// turned about itself.
void add_pen(const ArmPose& arm, const Mat3& tool, const palette::Rgb& color,
             std::vector<SolidMark>& out) {
  constexpr double kPoint = 0.022, kRadius = 0.0045;  // [m]
  constexpr double kButton = 0.040;                   // from the point on [m]
  if (arm.links.empty() || !arm.tip.allFinite() || !tool.allFinite()) return;
  const Vec3 along = tool.col(0), up = tool.col(2);
  const Vec3 neck = arm.tip - kPoint * along;
  out.push_back({SolidMark::Shape::cone, place(neck, along, kRadius, kPoint), color});
  out.push_back({SolidMark::Shape::tube, place(neck, -along, kRadius, kPenLength - kPoint), color});
  out.push_back({SolidMark::Shape::ball,
                 place(arm.tip - kButton * along + kRadius * up, up, 0.5 * kRadius, 0.5 * kRadius),
                 lighter(color, 0.5f)});
}

void add_trail(const std::vector<Vec3>& trail, const palette::Rgb& color, LineBatch& lines) {
  const auto alpha = [&](std::size_t i) {
    const float t = static_cast<float>(i) / static_cast<float>(trail.size() - 1);
    return 0.85f * t * t;
  };
  for (std::size_t i = 1; i < trail.size(); ++i)
    if (trail[i - 1].allFinite() && trail[i].allFinite())
      lines.add(to_glm(trail[i - 1]), to_glm(trail[i]), 2.2f, with_alpha(color, alpha(i - 1)),
                with_alpha(color, alpha(i)), LineBatch::Ends::flat);
}

// Adds friction's cone, as long as the normal force's arrow would be. The arrow of the whole force
// ends in its base, on the rim where it slips.
void add_cone(const ContactMark& contact, std::vector<SolidMark>& out) {
  const double along = kMetersPerNewton * contact.force.dot(contact.normal);
  if (!(contact.friction > 0) || !(along > 0) || !std::isfinite(along)) return;
  out.push_back({SolidMark::Shape::cone,
                 place(contact.position + along * contact.normal, -contact.normal,
                       contact.friction * along, along),
                 contact.slips ? palette::kSlips : palette::kSticks});
}

void add_shade(const ContactShade& shade, double size, std::vector<glm::mat4>& out) {
  const double near = 1 - shade.height / kShadeHeight;
  if (!shade.position.allFinite() || !shade.normal.allFinite() || !(near > 0)) return;
  const double radius = 0.020 * size * (1 + 0.6 * (1 - near));
  out.push_back(place(shade.position, shade.normal, radius, std::min(1.0, near)));
}

void add_contacts(const ViewState& state, const std::vector<ContactMark>& contacts,
                  const palette::Rgb& color, double size, Marks& marks) {
  for (const ContactMark& contact : contacts) {
    if (!contact.position.allFinite() || !(contact.force.norm() > 0)) continue;
    if (state.show_forces) {
      add_arrow(contact.position, contact.force, color, size, marks.solids);
      add_cone(contact, marks.glass);
    }
    const double age = std::clamp(contact.age / kFlashTime, 0.0, 1.0);
    const double radius = patch_radius(contact.force.norm()) * size;
    const Vec3 out = contact.normal.norm() > 0.5 ? contact.normal : contact.force;
    if (!out.allFinite()) continue;
    marks.flashes.push_back({place(contact.position, out.normalized(), radius, radius),
                             glm::vec2(1 - age, 0.30 + 0.65 * age)});
  }
}

struct TipColors {
  palette::Rgb device, proxy;
};

// Adds the two tips, each in the colour of its arm, and the line between them.
void add_error(const ArmPose& device, const ArmPose& proxy, const TipColors& colors, bool dark,
               LineBatch& lines) {
  const glm::vec4 core = dark ? glm::vec4(1, 1, 1, 1) : glm::vec4(0.05, 0.05, 0.06, 1);
  const glm::vec4 edge = dark ? glm::vec4(0, 0, 0, 0.7) : glm::vec4(1, 1, 1, 0.8);
  const glm::vec3 from = to_glm(device.tip), to = to_glm(proxy.tip);
  const bool both = !device.links.empty() && !proxy.links.empty();
  if (both && (device.tip - proxy.tip).norm() > kLeastError) {
    lines.add(from, to, 6.5f, edge, edge);
    lines.add(from, to, 3.5f, core, core);
  }
  // The device's dot is the wider: a ring where the two agree.
  const auto dot = [&](const glm::vec3& at, const palette::Rgb& color, float width) {
    lines.add(at, at, width + 3, edge, edge);
    lines.add(at, at, width, with_alpha(color, 1), with_alpha(color, 1));
  };
  if (!device.links.empty()) dot(from, colors.device, 10);
  if (!proxy.links.empty()) dot(to, colors.proxy, 6);
}

}  // namespace

Marks collect_marks(const ViewState& state, const Camera& camera, double pixel_scale) {
  Marks marks;
  const double size = 1200 * pixel_scale * camera.meters_per_pixel(camera.target());
  if (state.show_hand && state.hand_target.allFinite())
    marks.solids.push_back({SolidMark::Shape::ball,
                            place(state.hand_target, Vec3::UnitZ(), 0.0085 * size, 0.0085 * size),
                            palette::kHand});
  if (state.tool) {
    add_pen(state.proxy, *state.tool, palette::kProxy, marks.solids);
    if (state.show_ghost) add_pen(state.device, *state.tool, palette::kDevice, marks.solids);
  }
  add_contacts(state, state.contacts, palette::kContact, size, marks);
  for (std::size_t i = 0; i < state.beside.size(); ++i) {
    const OtherRun& run = state.beside[i];
    const auto tint = [&](const palette::Rgb& c) {
      return palette::of_lane(c, i + 1, state.theme);
    };
    add_contacts(state, run.contacts, tint(palette::kContact), size, marks);
    if (state.show_forces) {
      add_arrow(run.device.tip, run.hand_force, tint(palette::kHand), size, marks.solids);
    }
  }
  if (state.shade) add_shade(*state.shade, size, marks.shades);
  if (state.show_forces)
    add_arrow(state.device.tip, state.hand_force, palette::kHand, size, marks.solids);
  return marks;
}

void add_trails(const ViewState& state, LineBatch& lines) {
  const float lift = is_dark(state.theme) ? 0.45f : 0.0f;
  if (state.show_ghost) add_trail(state.device.trail, palette::kDevice, lines);
  add_trail(state.proxy.trail, lighter(palette::kProxy, lift), lines);
  if (state.rerun) add_trail(state.rerun->trail, palette::kRerun, lines);
  for (std::size_t i = 0; i < state.beside.size(); ++i) {
    const OtherRun& run = state.beside[i];
    const auto tint = [&](const palette::Rgb& c) {
      return palette::of_lane(c, i + 1, state.theme);
    };
    if (state.show_ghost) add_trail(run.device.trail, tint(palette::kDevice), lines);
    add_trail(run.proxy.trail, tint(palette::kProxy), lines);
  }
}

void add_lines_on_top(const ViewState& state, LineBatch& lines) {
  if (state.show_hand && state.hand_grips && state.hand_target.allFinite())
    lines.add(to_glm(state.hand_target), to_glm(state.device.tip), 2.5f,
              with_alpha(palette::kHand, 1), with_alpha(palette::kHand, 1));
  if (!state.show_error) return;
  const bool dark = is_dark(state.theme);
  const TipColors first{palette::kDevice, lighter(palette::kProxy, dark ? 0.25f : 0.0f)};
  for (std::size_t i = 0; i < state.beside.size(); ++i) {
    const OtherRun& run = state.beside[i];
    const auto tint = [&](const palette::Rgb& c) {
      return palette::of_lane(c, i + 1, state.theme);
    };
    add_error(run.device, run.proxy, {tint(first.device), tint(first.proxy)}, dark, lines);
  }
  add_error(state.device, state.proxy, first, dark, lines);
}

void add_joints(const ArmDescription& arm, const ArmPose& pose, Theme theme, LineBatch& lines) {
  constexpr double kHalf = 0.022;  // half the length of a joint's axis [m]
  const auto colors = joint_colours(theme);
  const glm::vec4 edge = is_dark(theme) ? glm::vec4(0, 0, 0, 0.7) : glm::vec4(1, 1, 1, 0.8);
  for (std::size_t i = 0; i < std::min({arm.joints.size(), pose.links.size(), colors.size()});
       ++i) {
    const Vec3 at = pose.links[i].translation();
    const Vec3 along = kHalf * (pose.links[i].linear() * arm.joints[i].axis).normalized();
    if (!at.allFinite() || !along.allFinite()) continue;
    const glm::vec3 from = to_glm(Vec3(at - along)), to = to_glm(Vec3(at + along));
    const glm::vec4 color = with_alpha(palette::from_hex(colors[i]), 1);
    lines.add(from, to, 6.0f, edge, edge);
    lines.add(from, to, 3.5f, color, color);
  }
}

void add_grid(const Bounds& area, Theme theme, LineBatch& lines) {
  constexpr double kStep = 0.05;
  constexpr double kLift = 0.0003;  // over the floor, so that it is not half hidden by it [m]
  constexpr int kMost = 60;         // lines each way
  const float ink = is_dark(theme) ? 1.0f : 0.0f;
  const Vec3 middle = area.center(), half = 0.5 * area.sizes();
  const auto color = [&](const Vec3& p, bool strong) {
    const Vec3 off = (p - middle).cwiseAbs();
    const double edge = std::min((half.x() - off.x()) / half.x(), (half.y() - off.y()) / half.y());
    const double fade = std::clamp(2.5 * edge + 0.15, 0.0, 1.0);
    return glm::vec4(ink, ink, ink, fade * (strong ? 0.20 : 0.085));
  };
  for (int axis = 0; axis < 2; ++axis) {
    const int other = 1 - axis;
    const auto first = static_cast<int>(std::ceil(area.min()[axis] / kStep));
    const auto last = static_cast<int>(std::floor(area.max()[axis] / kStep));
    for (int line = first; line <= std::min(last, first + kMost); ++line) {
      // Lines are cut into pieces, as the fading is linear along a piece.
      constexpr int kPieces = 10;
      for (int piece = 0; piece < kPieces; ++piece) {
        const auto point = [&](int k) {
          Vec3 p = middle + kLift * Vec3::UnitZ();
          p[axis] = line * kStep;
          p[other] = area.min()[other] + 2 * half[other] * k / kPieces;
          return p;
        };
        const Vec3 a = point(piece), b = point(piece + 1);
        const bool strong = line % 2 == 0;
        lines.add(to_glm(a), to_glm(b), 1.2f, color(a, strong), color(b, strong),
                  LineBatch::Ends::flat);
      }
    }
  }
}

}  // namespace limpid
