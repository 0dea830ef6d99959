// Bodies and springs in a scene's file, whose keys devices/files/README.md lists.
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
