// Bodies and springs in a scene's file:
//
//     gravity = [0.0, 0.0, -9.81]  # m/s^2, optional
//
//     [[body]]
//     name = "die"                 # of one body only
//     box = [0.03, 0.03, 0.03]     # or sphere = 0.02 (radius), cylinder = [0.02, 0.05] (radius,
//                                  # length), capsule = [0.02, 0.05], or file = "x.glb" with scale,
//                                  # unit and up as of a mesh
//     mass = 0.05                  # kg; or density = 800.0, in kg/m^3
//     center = [0.0, 0.0, 0.0]     # of mass, in its frame; optional, as all below
//     inertia = [1e-5, 1e-5, 1e-5] # kg m^2, about the centre
//     position = [0.2, 0.0, 0.0]   # at the start
//     rotation = [0.0, 0.0, 0.5]   # roll, pitch, yaw as in URDF
//     stiffness = 2000.0           # and all of a material: for the tip
//     contact_stiffness = 20000.0  # N/m, among bodies and with what stands still
//     restitution = 0.0
//     magnet = false               # may be picked up
//     color = [0.8, 0.2, 0.1]      # red, green, blue, 0 to 1; a file has its own
//     [[body.part]]                # any number: a shape, in the body's frame
//     sphere = 0.01
//     position = [0.0, 0.0, 0.02]
//     rotation = [0.0, 0.0, 0.0]
//     color = [0.9, 0.9, 0.9]      # else the body's
//     [body.joint]
//     kind = "slider"              # or "hinge", "ball"
//     to = "another body"          # else the world
//     axis = [0.0, 0.0, -1.0]      # at the start, in the world; not of a ball
//     point = [0.0, 0.0, 0.0]      # in the body's frame; not of a slider
//     damping = 0.0                # N s/m or N m s/rad
//     friction = 0.0               # N or N m
//     limits = [0.0, 0.01]         # m or rad from the start; this and all below not of a ball
//     stop_stiffness = 20000.0     # N/m or N m/rad
//     stop_restitution = 0.0
//     spring = 200.0               # N/m or N m/rad towards
//     rest = 0.0                   # m or rad
//     detent = { force = 0.4, period = 0.008 }
//     travel = [[0.0, 0.5], [0.002, 0.9]]  # force over travel
//
//     [[spring]]
//     between = ["die", "lid"]     # the second may be missing: the world
//     points = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]  # in their frames, optional
//     length = 0.0
//     stiffness = 100.0
//     damping = 0.0
//     breaks_at = 20.0             # N; never without it
#pragma once

#include <filesystem>

#include "devices/files/scene/scene_document.h"
#include "devices/files/scene/scene_text.h"
#include "devices/files/toml_reader.h"

namespace limpid {

// Reads the tables [[body]] and [[spring]] and the key gravity of a whole file. Errors: as
// read_scene().
void read_bodies(const TomlTable& file, const std::filesystem::path& base_dir,
                 const SceneFiles& files, SceneDocument& out);

void put_gravity(SceneText& text, const Scene& scene);
// Writes all bodies with their parts and joints, and all springs.
void put_bodies(SceneText& text, const SceneDocument& document);

// Sets the mass of bodies with a density and a mesh, once the mesh is built. Errors: FileError.
void settle_masses(SceneDocument& document);

// Holds the values of a body or a spring within what a file may say.
void hold_body(Object& object);
void hold(BodySpring& spring);

// Returns whether joints lead from the body at `place` back to itself.
bool joint_leads_round(const Scene& scene, std::size_t place);

}  // namespace limpid
