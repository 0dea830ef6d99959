// The datasets of one run in a session file: rows, what changed while they were made, and sums that
// tell what was really written.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "devices/files/session/hdf5_handles.h"
#include "devices/files/session/session.h"

namespace limpid {

// Rows go straight behind those that are there, in blocks, without a filter, so that nothing that
// was written is ever written again.
//
// The list of where a column's chunks lie grows in blocks, which outgrow a page of memory from
// chunk 8176 on. A chunk therefore holds eight seconds of ticks, sixteen times what is written at
// once: a recording may last 18 hours.
//
// Errors of all but the constructor: FileError naming `path`.
class SessionLane {
 public:
  // Nothing is created yet.
  SessionLane(std::filesystem::path path, const SessionInfo& info);

  void create(hid_t group);  // of the file: its root, or a group below
  // Takes rows in; true once a block is full, which has to be flushed before more come. `rows` is
  // left with those that had no room.
  bool take(std::span<const double>& rows);
  void append(SettingChange change) { changes_.push_back(std::move(change)); }
  void flush();
  void close();    // after a flush
  void abandon();  // without one
  std::uint64_t rows() const { return flushed_rows_ + pending_rows(); }

 private:
  std::uint64_t pending_rows() const;
  void create_device(hid_t group);
  void create_column(hid_t group, const ColumnInfo& column);
  void create_events(hid_t group);
  void create_check(hid_t group);
  void sort_columns(std::uint64_t count);
  void write_column(const ColumnInfo& column, std::uint64_t count);
  void write_changes();
  void write_check();

  std::filesystem::path path_;
  RowLayout layout_;
  std::uint64_t block_rows_;  // that are written at once
  std::uint64_t flushed_rows_ = 0;
  std::uint64_t flushed_changes_ = 0;
  std::uint64_t flushed_sums_ = 0;
  std::vector<double> pending_;         // rows of the block that is not full yet
  std::vector<SettingChange> changes_;  // not written yet
  std::vector<double> by_column_;       // that block, a column behind the other
  std::vector<std::uint8_t> bytes_;
  std::array<hdf5::Dataset, kColumns> columns_;
  hdf5::Dataset event_row_;
  hdf5::Dataset event_setting_;
  hdf5::Dataset sums_;
};

}  // namespace limpid
