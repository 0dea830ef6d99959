// HDF5 on a file that is open already, under any name or none: one that is locked and no link, one
// without a name, or one in a sandbox that opens no files for writing.
#pragma once

#include "devices/files/session/hdf5_reading.h"

namespace limpid::hdf5 {

// Replaces a file that was opened by access_by() with the null device. HDF5 cannot drop what it has
// not written: closing writes, and fails for ever on a full disk.
void write_nowhere(const File& file);

// Properties by which H5Fcreate() and H5Fopen() use the file of `descriptor`, whatever name they
// are given. HDF5 locks nothing there. Errors: FileError naming `file`.
Properties access_by(int descriptor, const std::filesystem::path& file);

}  // namespace limpid::hdf5
