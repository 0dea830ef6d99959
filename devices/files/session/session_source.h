// The datasets of a session file, opened with distrust.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/tick/row.h"
#include "devices/files/session/hdf5_handles.h"

namespace limpid {

// One dataset with its shape checked: rows, or rows x width.
struct Source {
  hdf5::Dataset dataset;
  std::string path;
  hsize_t rows = 0;
  hsize_t width = 1;
};

// A recording that is running or was killed.
inline bool is_leftover(const std::filesystem::path& file) { return file.extension() == ".part"; }

// Throws FileError "FILE: WHY".
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why);

// `root`: the file's, or a twin's group. Paths begin with "/" either way.
// Errors: FileError for what open_dataset() refuses, or is of another shape (or, for a column,
// type).
Source open_source(hid_t root, const char* path, hsize_t width, const std::filesystem::path& file);
Source open_column(hid_t root, const ColumnInfo& column, const RowLayout& layout,
                   const std::filesystem::path& file);

// `count` rows from row `from` as doubles. False if the file does not give them.
bool read_block(const Source& source, hsize_t from, hsize_t count, double* out);
bool read_block(const Source& source, hsize_t from, hsize_t count, std::int8_t* out);
// One row of whole numbers.
bool read_row(const Source& source, hsize_t row, std::uint64_t* out);

}  // namespace limpid
