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

// Sums over each column for every block of rows written at once. They tell recorded rows from rows
// that a killed program had only announced, and from damaged ones.
//
// /check/sums, uint64, M x C: entry (b, c) is over rows [b * R, (b + 1) * R) of column c. R is the
// attribute "rows"; the attribute "columns" holds the paths of the C columns, a line each: all
// columns of the file but those of the timing, in which equal runs differ. The sums are over the
// file's values. Sessions of other programs, and of the first edition, have none.
inline constexpr const char* kCheckPath = "/check/sums";
inline constexpr const char* kCheckRows = "rows";
inline constexpr const char* kCheckColumns = "columns";

// Values of a column: `width` in each row, `step` from a row to the next.
struct ColumnValues {
  const double* first;
  int width, step;
};
using AllColumns = std::array<ColumnValues, kColumns>;
// The columns of rows in memory.
AllColumns columns_of(const RowLayout& layout, std::span<const double> rows);

// The sums of all columns over `count` rows from row `from` on: h <- (h ^ bits) * odd, and a shift,
// for each value. Each step can be undone, so a single changed value always changes the sum. The
// columns go side by side, as each step waits for the one before: in turn they would take several
// times as long.
std::array<std::uint64_t, kColumns> column_sums(const AllColumns& columns, std::uint64_t from,
                                                std::uint64_t count);

// Returns whether recordings of this version have sums of a column.
inline bool summed(const RowLayout& layout, const ColumnInfo& column) {
  return layout.has(column.column) && !std::string_view(column.path).starts_with("/timing/");
}
// Number of the summed columns; their paths in the order of the sums, a line each.
std::size_t count_summed(const RowLayout& layout);
std::string check_columns(const RowLayout& layout);

// A dataset with its shape checked: rows, rows x width, or rows x bodies x numbers of each.
struct Source {
  hdf5::Dataset dataset;
  std::string path;
  hsize_t rows = 0;
  hsize_t width = 1;      // numbers in a row
  hsize_t each_body = 0;  // numbers of each body; 0: rank 1 or 2
};

// Numbers of each body in a column; 0 if the column is not made of bodies.
constexpr hsize_t of_each_body(const ColumnInfo& column) {
  switch (column.width) {
    case ColumnWidth::poses: return kPoseNumbers;
    case ColumnWidth::velocities: return kVelocityNumbers;
    default: return 0;
  }
}

// Returns whether a file is a recording that is running or was killed.
inline bool is_leftover(const std::filesystem::path& file) { return file.extension() == ".part"; }

// Throws FileError "FILE: WHY".
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why);

// Open a dataset. `root` is the file's, or a further lane's group; paths begin with "/" either way.
// Datasets of bodies, with `each_body` numbers of each, have rank 3. Errors: FileError for what
// open_dataset() refuses, or has another shape (or, for a column, type).
Source open_source(hid_t root, const char* path, hsize_t width, const std::filesystem::path& file,
                   hsize_t each_body = 0);
Source open_column(hid_t root, const ColumnInfo& column, const RowLayout& layout,
                   const std::filesystem::path& file);

// Read `count` rows from row `from` on. False if the file does not give them.
bool read_block(const Source& source, hsize_t from, hsize_t count, double* out);
bool read_block(const Source& source, hsize_t from, hsize_t count, std::int8_t* out);
// Reads one row of whole numbers.
bool read_row(const Source& source, hsize_t row, std::uint64_t* out);

// Compares the sums of a run with its rows, block by block.
class CheckSums {
 public:
  // Opens the sums; nothing if the file has none. Errors: FileError for sums that are not laid out
  // as described at kCheckPath.
  static std::optional<CheckSums> open(hid_t root, const std::filesystem::path& file);

  std::size_t block() const { return block_; }  // rows of a sum
  // Number of rows that are as recorded, and why the next one is not.
  struct Checked {
    std::size_t rows = 0;
    std::string why;  // empty if all are as recorded
  };
  // Checks rows in the file's units; the first is row `from` of the file, a multiple of block().
  Checked check(const RowLayout& layout, std::span<const double> rows, std::size_t from) const;

 private:
  hid_t root_ = H5I_INVALID_HID;
  std::filesystem::path file_;
  Source source_;
  std::size_t block_ = 0;
  std::vector<std::optional<Column>> columns_;  // nothing: unknown to this program
};

// Read a whole list beside the rows: numbers of rows, or texts of at most `most` bytes. Errors:
// FileError for lists of another kind.
std::vector<std::uint64_t> read_row_numbers(const Source& source,
                                            const std::filesystem::path& file);
std::vector<std::string> read_texts(const Source& source, std::size_t most,
                                    const std::filesystem::path& file);

}  // namespace limpid
