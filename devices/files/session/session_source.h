// The datasets of a session file, opened with distrust.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/tick/row.h"
#include "devices/files/session/hdf5_reading.h"
#include "devices/files/session/session.h"

namespace limpid {

// What tells rows that were recorded from rows that a killed program had only announced, or that
// were damaged since: a sum over each column, for every block of rows that is written at once.
//
// /check/sums, uint64, M x C: entry (b, c) is over rows [b * R, (b + 1) * R) of column c. R is the
// attribute "rows"; the attribute "columns" holds the paths of the C columns, a line each: all that
// the file has but those of the timing, in which equal runs differ. The sums are over what the file
// holds. Sessions of other programs, and of the first edition, have none.

inline constexpr const char* kCheckPath = "/check/sums";
inline constexpr const char* kCheckRows = "rows";
inline constexpr const char* kCheckColumns = "columns";

// The values of a column: `width` in each row, and from a row to the next `step`.
struct ColumnValues {
  const double* first;
  int width, step;
};
using AllColumns = std::array<ColumnValues, kColumns>;
// In rows as they are in memory.
AllColumns columns_of(const RowLayout& layout, std::span<const double> rows);

// Of all columns, in their order, over the values of `count` rows from row `from` on: h <- (h ^
// bits) * odd, and a shift. Each step can be undone, so a single value that changes always changes
// the sum. They go side by side: each sum waits for the step before, so that one column after the
// other takes several times as long.
std::array<std::uint64_t, kColumns> column_sums(const AllColumns& columns, std::uint64_t from,
                                                std::uint64_t count);

// Whether a recording that is written now has sums of it.
inline bool summed(const RowLayout& layout, const ColumnInfo& column) {
  return layout.has(column.column) && !std::string_view(column.path).starts_with("/timing/");
}
// How many those are, and their paths in the order of their sums, a line each.
std::size_t count_summed(const RowLayout& layout);
std::string check_columns(const RowLayout& layout);

// One dataset with its shape checked: rows, rows x width, or rows x bodies x what each has.
struct Source {
  hdf5::Dataset dataset;
  std::string path;
  hsize_t rows = 0;
  hsize_t width = 1;      // numbers in a row
  hsize_t each_body = 0;  // and of each body; 0: rank 1 or 2
};

// How many numbers of each body a column has; 0 of one that is not made of bodies.
constexpr hsize_t of_each_body(const ColumnInfo& column) {
  switch (column.width) {
    case ColumnWidth::poses: return kPoseNumbers;
    case ColumnWidth::velocities: return kVelocityNumbers;
    default: return 0;
  }
}

// A recording that is running or was killed.
inline bool is_leftover(const std::filesystem::path& file) { return file.extension() == ".part"; }

// Throws FileError "FILE: WHY".
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why);

// `root`: the file's, or a twin's group. Paths begin with "/" either way. What is said of bodies,
// `each_body` numbers of each, is of rank 3.
// Errors: FileError for what open_dataset() refuses, or is of another shape (or, for a column,
// type).
Source open_source(hid_t root, const char* path, hsize_t width, const std::filesystem::path& file,
                   hsize_t each_body = 0);
Source open_column(hid_t root, const ColumnInfo& column, const RowLayout& layout,
                   const std::filesystem::path& file);

// `count` rows from row `from` as doubles. False if the file does not give them.
bool read_block(const Source& source, hsize_t from, hsize_t count, double* out);
bool read_block(const Source& source, hsize_t from, hsize_t count, std::int8_t* out);
// One row of whole numbers.
bool read_row(const Source& source, hsize_t row, std::uint64_t* out);

// The sums of a run, held against its rows block by block.
class CheckSums {
 public:
  // Nothing where the file has none. Errors: FileError for sums that are not laid out as above.
  static std::optional<CheckSums> open(hid_t root, const std::filesystem::path& file);

  std::size_t block() const { return block_; }  // rows of a sum
  // How many of the rows, of which the first is row `from` of the file, a multiple of block(), are
  // as they were recorded, and why the next one is not. They are still in the file's units.
  struct Checked {
    std::size_t rows = 0;
    std::string why;  // empty if all are
  };
  Checked check(const RowLayout& layout, std::span<const double> rows, std::size_t from) const;

 private:
  hid_t root_ = H5I_INVALID_HID;
  std::filesystem::path file_;
  Source source_;
  std::size_t block_ = 0;
  std::vector<std::optional<Column>> columns_;  // none: one that this program does not know
};

// The whole of a list beside the rows: numbers of rows, or texts of at most so many bytes. Errors:
// FileError for lists of another kind.
std::vector<std::uint64_t> read_row_numbers(const Source& source,
                                            const std::filesystem::path& file);
std::vector<std::string> read_texts(const Source& source, std::size_t most,
                                    const std::filesystem::path& file);

}  // namespace limpid
