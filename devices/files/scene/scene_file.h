// Scenes as TOML files, read and written. Lengths in metres, angles in radians, in the device base
// frame.
//
//     title = "A table"
//     about = "One sentence for people."
//     tip_radius = 0.0             # the tip is always a probe; 0 a point
//
//     [[plane]]                    # any number of each of these
//     name = "table top"
//     point = [0.2, 0.0, -0.04]    # on the surface
//     normal = [0.0, 0.0, 1.0]     # out of the material, any length
//     stiffness = 600.0            # N/m
//     damping = 0.0                # N s/m, optional; as the next two, in all but joint contacts
//     friction_static = 0.0        # tangential by normal force up to which it sticks
//     friction_kinetic = 0.0       # the same while it slips
//
//     [[sphere]]
//     name = "ball"
//     center = [0.2, 0.0, 0.0]
//     radius = 0.02
//     stiffness = 600.0
//     color = [0.8, 0.2, 0.1]      # red, green, blue, 0 to 1; optional, also of the next three
//
//     [[box]]
//     name = "block"
//     center = [0.2, 0.0, 0.0]
//     size = [0.04, 0.04, 0.02]    # full edges
//     rpy = [0.0, 0.0, 0.5]        # optional; roll, pitch, yaw as in URDF
//     stiffness = 600.0
//
//     [[cylinder]]                 # around its z axis; a [[capsule]] has the same keys
//     name = "post"
//     radius = 0.02
//     length = 0.05                # from face to face; of a capsule between its ends' centres
//     position = [0.2, 0.0, 0.0]   # of its middle
//     rotation = [0.0, 0.0, 0.5]   # optional; as rpy
//     stiffness = 600.0
//
//     [[mesh]]                     # a model of triangles
//     name = "gear"
//     file = "gear.glb"            # or .gltf, .stl, .obj, .ply, .dae; from the scene file's folder
//     position = [0.2, 0.0, 0.0]   # optional, as rpy and scale
//     rpy = [0.0, 0.0, 0.5]
//     scale = 1.0
//     unit = "m"                   # of the file's coordinates: "m", "cm", "mm", "in" or "ft";
//                                  # optional: else "mm" of .stl, "m" of all others
//     up = "z"                     # the file's axis that points up: "y" or "z" (optional)
//     stiffness = 600.0
//
//     [[joint_contact]]
//     name = "stop"
//     joint = "shoulder"           # URDF name, or 1 for the first
//     angle = -0.9
//     side = "below"               # touched when the joint goes below the angle; or "above"
//     stiffness = 20.0             # N m/rad
//
//     [[body]]                     # what moves, and [[spring]] between two of them: body_file.h
//
//     [[probe]]                    # a part of the arm that touches, besides the tip
//     name = "forearm"
//     link = "forearm"             # URDF name of a link that moves
//     from = [0.0, 0.0, 0.0]       # in that link's frame
//     to = [0.1, 0.0, 0.0]         # optional: a sphere without it
//     radius = 0.01
//
//     [[visual]]                   # to look at only
//     file = "table.glb"           # as of a mesh; in its usual unit, z up
//     position = [0.0, 0.0, 0.0]   # optional, as rpy and scale
//     rpy = [0.0, 0.0, 0.0]
//     scale = 1.0
#pragma once

#include <filesystem>
#include <string>

#include "core/dynamics/arm_description.h"
#include "devices/files/scene/scene_document.h"

namespace limpid {

// Reads a scene. Errors: FileError "FILE:LINE: KEY: found; allowed", also for unknown keys. A file
// without any contact is free space. Pairs of a contact and a probe, tip included, are at most 64 x
// 64.
SceneDocument read_scene(const std::filesystem::path& file, const ArmDescription& arm);

// Reads a scene from text; `where` names it in messages. If `base_dir` is empty (text without a
// folder, as inside a session), visuals that do not exist are left out. Meshes come from `files` if
// they are there, else from the folder; their shapes are still to be built.
SceneDocument parse_scene(const std::string& text, const std::string& where,
                          const std::filesystem::path& base_dir, const ArmDescription& arm,
                          const SceneFiles& files = {});

// Text from which parse_scene() makes this scene again, to the last bit (rotations that no angles
// give exactly: to round-off). Meshes keep their names; visuals inside of `folder` are named
// relative to it. Comments of a text that the scene came from are lost.
std::string scene_text(const SceneDocument& document, const ArmDescription& arm,
                       const std::filesystem::path& folder = {});

// Holds an object within what a file may say, and its rotation at one that a file says exactly.
void hold(Object& object);

}  // namespace limpid
