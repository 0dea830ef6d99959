// Datasets of one run in a session file: rows, changed settings, and sums that show what was really
// written.
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

namespace limpid {
namespace hdf5 {

// Dimension scales of a file, by which HDF5 names rows and columns: /joint, the names of the
// joints; /axis, x, y, z; /quaternion, w, x, y, z; /contact_axis, x, y, z of each contact. With
// bodies also /object, their names; /pose and /motion, the parts of their poses and velocities.
// Invalid in a file whose arm is not known.
struct Scales {
  Dataset joint, axis, quaternion, contact, object, pose, motion;
};
// Errors: FileError naming `file`.
Scales create_scales(hid_t root, const ArmDescription& arm, const std::vector<std::string>& bodies,
                     const std::filesystem::path& file);

void make_scale(const Dataset& dataset, const char* name, const std::filesystem::path& file);
// Makes `scale` name the dataset's rows (0), its columns (1), or parts of these (2).
void attach_scale(const Dataset& dataset, const Dataset& scale, unsigned dimension,
                  const std::filesystem::path& file);

// Shape of a dataset's row: one number (rank 1), `width` numbers (rank 2), or `each_body` numbers
// for each of `width` bodies (rank 3).
struct RowShape {
  int rank = 1;
  hsize_t width = 1;
  hsize_t each_body = 1;  // of rank 3
};

// Layout of rows in a file.
struct Chunks {
  hsize_t rows = 1;     // in one chunk
  bool packed = false;  // by deflate, after shuffling their bytes
};

// Creates a list or table of such rows; invalid if that fails. `fill`: value of rows that are
// announced and never written; nothing: undefined.
Dataset create_growing(hid_t file, const char* path, hid_t type, RowShape row, Chunks chunks,
                       std::optional<double> fill = std::nullopt);

// Appends `count` rows behind the first `from` and flushes them; without data they have the fill
// value. Errors: FileError naming `file`, checked at once, as closing any handle makes HDF5 forget
// them.
void append_to(const Dataset& dataset, hsize_t from, hsize_t count, RowShape row, hid_t type,
               const void* data, const std::filesystem::path& file);

}  // namespace hdf5

// Purpose of a session's file: `safe` may be killed at any moment while it is written, `packed`
// takes little room once it is closed.
enum class Storage { safe, packed };

// Appends rows of one run in blocks, without a filter, so that nothing written is written again. A
// block is a power of two of rows, 512 at 1 kHz: its data then begin and end at pages of memory,
// which halves the kernel's work. Blocks handed over together are written together, but at most as
// many as are there already. A disk that becomes full meanwhile thus keeps at least half of the
// recording.
//
// HDF5's list of a column's chunks grows in blocks, which outgrow a page of memory from chunk 8176
// on. A chunk therefore holds eight seconds of ticks, 16 blocks: a recording may last 18 hours.
//
// A packed lane has blocks of at least 4096 rows, each a whole chunk, so that each is packed once.
//
// Errors of all but the constructor: FileError naming `path`.
class SessionLane {
 public:
  // Creates nothing yet.
  SessionLane(std::filesystem::path path, const SessionInfo& info, Storage storage);

  void create(hid_t group);  // the file's root, or a group below
  // Attaches to each dataset the scales of its rows and columns.
  void attach(const hdf5::Scales& scales) const;
  // Takes in rows. True once they are whole blocks, which have to be flushed before more come.
  // Leaves in `rows` those that were not taken.
  bool take(std::span<const double>& rows);
  void append(SettingChange change) { changes_.push_back(std::move(change)); }
  void append_world(std::span<const double> world);  // written at once
  void flush();
  void close();    // after a flush
  void abandon();  // without a flush
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
  std::uint64_t sum_rows_;    // rows of each sum
  std::uint64_t block_rows_;  // rows of a block, a multiple of sum_rows_
  std::uint64_t most_rows_;   // most rows written at once: whole blocks
  std::uint64_t flushed_rows_ = 0;
  std::uint64_t pending_rows_ = 0;
  std::uint64_t flushed_changes_ = 0;
  std::uint64_t flushed_sums_ = 0;
  std::unique_ptr<double[]> pending_;  // room for most_rows_, column by column
  SessionUnits units_;
  std::vector<std::int8_t> rounding_;        // of pending rows, for each their scaled numbers
  std::unique_ptr<DerivedColumns> deriver_;  // null if the arm is not known
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
