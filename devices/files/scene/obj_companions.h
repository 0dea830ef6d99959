// The files that an OBJ model refers to: its materials, and the pictures that these name.
#pragma once

#include <filesystem>
#include <vector>

namespace limpid {

// Those that are there, relative to the model's folder, each once. What lies outside of that
// folder, also through a symbolic link, is none of them. Errors: FileError for a model or materials
// that cannot be read.
std::vector<std::filesystem::path> obj_companions(const std::filesystem::path& obj);

}  // namespace limpid
