// HDF5 protects all of its bookkeeping with checksums, but for the "global heaps" that hold text
// of variable length. A damaged one sends the library round for ever, so they are walked first.
#pragma once

#include <filesystem>

namespace limpid::hdf5 {

// Errors: FileError for a heap whose objects do not fill it exactly.
void check_heaps(const std::filesystem::path& file);

}  // namespace limpid::hdf5
