// Datasets of HDF5 that rows are appended to.
#pragma once

#include <filesystem>
#include <optional>

#include "devices/files/session/hdf5_handles.h"

namespace limpid::hdf5 {

// A list of rank 1, or a table of rank 2 with rows of `width`; invalid if it cannot be created.
// `fill`: what rows read as that are announced and never written; none: as anything.
Dataset create_growing(hid_t file, const char* path, hid_t type, int rank, hsize_t width,
                       hsize_t chunk, std::optional<double> fill = std::nullopt);

// Appends `count` rows behind the first `from` and flushes them; without data they are what the
// dataset is filled with. Errors: FileError naming `file`; asked for at once, as closing any handle
// makes HDF5 forget them.
void append_to(const Dataset& dataset, hsize_t from, hsize_t count, hsize_t width, hid_t type,
               const void* data, const std::filesystem::path& file);

}  // namespace limpid::hdf5
