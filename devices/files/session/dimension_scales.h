// What the rows and columns of a session's datasets stand for, in HDF5's own way: dimension scales.
#pragma once

#include <filesystem>

#include "core/dynamics/arm_description.h"
#include "devices/files/session/hdf5_handles.h"

namespace limpid::hdf5 {

// The scales that the whole file has once: /joint, the names of the joints, and /axis, x, y, z.
// Invalid in a file whose arm is not known.
struct Scales {
  Dataset joint, axis;
};
// Errors: FileError naming `file`.
Scales create_scales(hid_t root, const ArmDescription& arm, const std::filesystem::path& file);

void make_scale(const Dataset& dataset, const char* name, const std::filesystem::path& file);
// Says that `scale` numbers the dataset's rows (0) or columns (1).
void attach_scale(const Dataset& dataset, const Dataset& scale, unsigned dimension,
                  const std::filesystem::path& file);

}  // namespace limpid::hdf5
