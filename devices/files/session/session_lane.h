// The datasets of one run in a session file: rows, what changed while they were made, and sums that
// tell what was really written.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "devices/files/session/derived_columns.h"
#include "devices/files/session/hdf5_reading.h"
#include "devices/files/session/session.h"
#include "devices/files/session/session_units.h"

namespace limpid::hdf5 {

// What the rows and columns of a session's datasets stand for, in HDF5's own way: dimension scales.

// The scales that the whole file has once: /joint, the names of the joints, /axis, x, y, z, and
// /contact_axis, those of each contact. Where bodies move /object has their names, /pose and
// /motion what is said of each. Invalid in a file whose arm is not known.
struct Scales {
  Dataset joint, axis, contact, object, pose, motion;
};
// Errors: FileError naming `file`.
Scales create_scales(hid_t root, const ArmDescription& arm, const std::vector<std::string>& bodies,
                     const std::filesystem::path& file);

void make_scale(const Dataset& dataset, const char* name, const std::filesystem::path& file);
// Says that `scale` numbers the dataset's rows (0), columns (1), or what is within those (2).
void attach_scale(const Dataset& dataset, const Dataset& scale, unsigned dimension,
                  const std::filesystem::path& file);

}  // namespace limpid::hdf5
// Datasets of HDF5 that rows are appended to.

namespace limpid::hdf5 {

// What one row of a dataset is: a single number (rank 1), so many (rank 2), or so many of each of
// some bodies (rank 3).
struct RowShape {
  int rank = 1;
  hsize_t width = 1;
  hsize_t each_body = 1;  // of rank 3; `width` counts bodies then
};

// How rows lie in a file.
struct Chunks {
  hsize_t rows = 1;     // in one
  bool packed = false;  // by deflate, after their bytes were put in another order
};

// A list or table of such rows; invalid if it cannot be created. `fill`: what rows read as that are
// announced and never written; none: as anything.
Dataset create_growing(hid_t file, const char* path, hid_t type, RowShape row, Chunks chunks,
                       std::optional<double> fill = std::nullopt);

// Appends `count` rows behind the first `from` and flushes them; without data they are what the
// dataset is filled with. Errors: FileError naming `file`; asked for at once, as closing any handle
// makes HDF5 forget them.
void append_to(const Dataset& dataset, hsize_t from, hsize_t count, RowShape row, hid_t type,
               const void* data, const std::filesystem::path& file);

}  // namespace limpid::hdf5
namespace limpid {

// Purpose of a session's file: `safe` may be killed at any moment while it is written, `packed`
// takes little room once it is closed.
enum class Storage { safe, packed };

// Rows go straight behind those that are there, in blocks, without a filter, so that nothing that
// was written is ever written again. A block is a power of two of rows, 512 at 1 kHz: what the
// kernel is given then begins and ends where pages of memory do, which is half the work for it.
// Blocks that are handed over together are written together, but never more than there is already:
// a disk that is full in the middle of it keeps half of the recording at least.
//
// The list of where a column's chunks lie grows in blocks, which outgrow a page of memory from
// chunk 8176 on. A chunk therefore holds eight seconds of ticks, 16 blocks: a recording may last
// 18 hours.
//
// A packed lane has blocks of at least 4096 rows, and chunks that a block fills whole: each is
// packed once.
//
// Errors of all but the constructor: FileError naming `path`.
class SessionLane {
 public:
  // Nothing is created yet.
  SessionLane(std::filesystem::path path, const SessionInfo& info, Storage storage);

  void create(hid_t group);  // of the file: its root, or a group below
  // Says of each dataset what its rows and columns stand for.
  void attach(const hdf5::Scales& scales) const;
  // Takes rows in; true once they are whole blocks, which have to be flushed before more come.
  // `rows` is left with those that were not taken.
  bool take(std::span<const double>& rows);
  void append(SettingChange change) { changes_.push_back(std::move(change)); }
  void append_world(std::span<const double> world);  // written at once
  void flush();
  void close();    // after a flush
  void abandon();  // without one
  std::uint64_t rows() const { return flushed_rows_ + pending_rows_; }

 private:
  void create_device(hid_t group);
  void create_column(hid_t group, const ColumnInfo& column);
  void create_derived(hid_t group);
  void create_rounding(hid_t group);
  void create_events(hid_t group);
  void create_world(hid_t group);
  hdf5::RowShape shape(const ColumnInfo& column) const;
  hdf5::Chunks chunks(hdf5::RowShape shape) const;
  void create_check(hid_t group);
  double* pending(Column column) const;
  void sort_in(std::span<const double> rows);
  void derive();
  void convert();
  void write_column(const ColumnInfo& column);
  void write_derived();
  void write_rounding();
  void write_changes();
  void write_check();

  std::filesystem::path path_;
  Storage storage_;
  RowLayout layout_;
  std::vector<std::string> bodies_;
  std::uint64_t sum_rows_;    // that each of the sums is over
  std::uint64_t block_rows_;  // as many of those as are written together
  std::uint64_t most_rows_;   // that are written at once: whole blocks
  std::uint64_t flushed_rows_ = 0;
  std::uint64_t pending_rows_ = 0;
  std::uint64_t flushed_changes_ = 0;
  std::uint64_t flushed_sums_ = 0;
  std::unique_ptr<double[]> pending_;  // not written yet: room for most_rows_, column by column
  SessionUnits units_;
  std::vector<std::int8_t> rounding_;        // of pending rows: of each, all that are scaled
  std::unique_ptr<DerivedColumns> deriver_;  // null: the arm is not known
  std::array<std::vector<double>, kDerived> derived_;  // of pending rows
  std::vector<SettingChange> changes_;                 // not written yet
  std::vector<std::uint8_t> bytes_;
  std::array<hdf5::Dataset, kColumns> columns_;
  std::array<hdf5::Dataset, kDerived> derived_columns_;
  hdf5::Dataset rounding_column_;
  hdf5::Dataset world_;
  hdf5::Dataset event_row_;
  hdf5::Dataset event_setting_;
  hdf5::Dataset sums_;
};

}  // namespace limpid
