// Everything one frame of the 3D view shows, as plain data in the device base frame, SI.
#pragma once

#include <optional>
#include <vector>

#include "core/math/sizes.h"
#include "render/theme.h"

namespace limpid {

struct ArmPose {
  std::vector<Pose> links;  // one a moving link, base first; empty: the arm is not drawn
  Vec3 tip = Vec3::Zero();  // [m]
  std::vector<Vec3> trail;  // where the tip was in the last second, oldest first [m]
};

struct ContactMark {
  Vec3 position = Vec3::Zero();  // [m]
  Vec3 force = Vec3::Zero();     // on the proxy [N]
  double age = 1;                // since it began [s]; the flash lasts a quarter of a second
  Vec3 normal = Vec3::Zero();    // of the surface, out of what is touched; zero: along the force
};

struct ViewState {
  ArmPose device;                   // drawn as a translucent ghost
  ArmPose proxy;                    // drawn solid
  std::optional<ArmPose> rerun;     // a second proxy in another tint
  Vec3 hand_target = Vec3::Zero();  // [m]
  bool show_hand = false;
  bool hand_grips = false;         // draws the line from the target to the device tip
  Vec3 hand_force = Vec3::Zero();  // on the device tip [N]
  std::vector<ContactMark> contacts;

  bool show_ghost = true;
  bool show_error = true;  // the line between the two tips
  bool show_trail = true;
  bool show_forces = true;
  bool show_grid = true;
  Theme theme = Theme::dark;
};

}  // namespace limpid
