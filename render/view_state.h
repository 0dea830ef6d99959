// Everything one frame of the 3D view shows, as plain data in the device base frame, SI.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/math/sizes.h"
#include "render/theme.h"

namespace limpid {

// A model that is only looked at. Its vertex v appears at pose * (scale * v).
struct VisualPicture {
  std::filesystem::path file;  // a model
  Pose pose = Pose::Identity();
  double scale = 1;
};

// An arm's links, tip and trail in one frame.
struct ArmPose {
  std::vector<Pose> links;  // one for each moving link, base first; empty: not drawn
  Vec3 tip = Vec3::Zero();  // [m]
  std::vector<Vec3> trail;  // places of the tip in the last second, oldest first [m]
};

struct ContactMark {
  Vec3 position = Vec3::Zero();  // [m]
  Vec3 force = Vec3::Zero();     // on the proxy [N]
  double age = 1;                // since it began [s]; the flash lasts a quarter of a second
  Vec3 normal = Vec3::Zero();    // of the surface, outwards; zero: along the force
  double friction = 0;           // static [-]; 0: no cone
  bool slips = false;            // it slips along the surface, else it sticks
};

// Shade that the proxy's tip casts on a near surface.
struct ContactShade {
  Vec3 position = Vec3::Zero();  // on the surface [m]
  Vec3 normal = Vec3::UnitZ();   // of the surface
  double height = 0;             // of the tip above the surface [m]
};

// A further run on the same hand in the same picture: in tints of the first one's colours.
struct OtherRun {
  ArmPose device, proxy;           // both drawn as translucent ghosts
  Vec3 hand_force = Vec3::Zero();  // on the device tip [N]
  std::vector<ContactMark> contacts;
  std::vector<Pose> bodies;  // as ViewState's: ghosts where they are apart from those
};

struct ViewState {
  ArmPose device;                   // drawn as a translucent ghost
  ArmPose proxy;                    // drawn solid
  std::optional<ArmPose> rerun;     // a second proxy in a colour of its own
  std::vector<OtherRun> beside;     // at most kMostLanes - 1
  Vec3 hand_target = Vec3::Zero();  // [m]
  bool show_hand = false;
  bool hand_grips = false;         // draws the line from the target to the device tip
  Vec3 hand_force = Vec3::Zero();  // on the device tip [N]
  bool magnet = false;             // at the proxy's tip: picks up bodies that it may
  bool magnet_holds = false;       // holds something
  // A point of a body, and where it is pulled to [m].
  std::optional<std::array<Vec3, 2>> pull;
  std::size_t pulled = 0;  // number of that body
  std::vector<ContactMark> contacts;
  std::optional<ContactShade> shade;
  // Frames of the scene's moving objects, in their order. An object whose frame is missing or not
  // finite stands where the scene has it.
  std::vector<Pose> bodies;
  std::vector<Pose> rerun_bodies;  // ghosts where they are apart
  // Orientation of the tool in the hand, drawn as a pen at the tips of device and proxy: x along it
  // towards what it touches, z up. Nothing: not known, not drawn.
  std::optional<Mat3> tool;

  bool show_ghost = true;
  bool show_error = true;  // the two tips and the line between them
  bool show_trail = true;
  bool show_joints = false;  // the proxy's axes, each in its joint's colour
  bool show_forces = true;
  bool show_grid = true;
  Theme theme = Theme::dark;
};

}  // namespace limpid
