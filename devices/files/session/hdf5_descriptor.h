// HDF5 on a file that is open already, by whatever name or none: one that is locked and no link,
// one without a name, or one of a program in a sandbox, which opens none for writing.
#pragma once

#include "devices/files/session/hdf5_reading.h"

namespace limpid::hdf5 {

// HDF5 cannot forget what it has not written yet: closing writes, and fails for ever on a full
// disk. So a file that was opened by access_by() gets the null device in its place, and HDF5 may
// write there what it likes.
void write_nowhere(const File& file);

// How H5Fcreate() and H5Fopen() take the file of `descriptor`, whatever name they are given. HDF5
// locks nothing there. Errors: FileError naming `file`.
Properties access_by(int descriptor, const std::filesystem::path& file);

}  // namespace limpid::hdf5
