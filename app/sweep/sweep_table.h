// A sweep's table: the values found so far, and its files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/sweep/measure_point.h"
#include "devices/files/session/hdf5_reading.h"
#include "devices/files/session/session.h"

namespace limpid {

// An HDF5 file made in memory and written whole.
class FileImage {
 public:
  // Errors of all functions: FileError naming `file`, which it will replace.
  explicit FileImage(std::filesystem::path file);

  hid_t root() const { return file_.get(); }
  // Adds an array of rows x width, or a list if the width is 1. Keeps no times, so that equal
  // contents are equal bytes; a checksum protects it.
  hdf5::Dataset add(const std::string& path, hid_t stored_as, hid_t held_as, hsize_t rows,
                    hsize_t width, const void* data);
  void number(hid_t object, const char* name, std::uint64_t value);
  void text(hid_t object, const char* name, const std::string& value);
  void write();

 private:
  hdf5::Quiet quiet_;
  std::filesystem::path path_;
  hdf5::File file_;
};

// A value for every measured column of every point.
struct SweepTable {
  explicit SweepTable(const SweepPlan& plan)
      : columns(measured_columns(plan)),
        done(plan.points(), 0),
        values(done.size() * columns.size()) {}

  std::vector<SweepColumn> columns;
  std::vector<std::uint8_t> done;  // of each point: 1 if its values are there
  std::vector<double> values;      // points x columns; NaN where not done

  std::uint64_t points() const { return done.size(); }
  std::uint64_t count() const;  // points done
  bool complete() const { return count() == points(); }
  double at(std::uint64_t point, std::size_t column) const {
    return values[point * columns.size() + column];
  }
  // Sets the values of consecutive points.
  void take(std::uint64_t first, const std::vector<double>& found);
};

// Returns the number of points whose runs diverged; 0 if that is not measured.
std::uint64_t diverged_points(const SweepTable& table);

// Writes the table; the same plan and points done give the same bytes, whoever writes it.
//   /axis/NAME     points, float64: attributes unit, key, spread, scale, words (of 0, 1, ...)
//   /measure/NAME  points, float64: attributes unit, what
//   /repeat, /done points, uint32 and uint8
// Root attributes: format kSweepFormat, version 1, title, plan (TOML), key (of the plan and the
// files that it names), points, done, app_version, build. Errors: FileError.
inline constexpr std::uint64_t kSweepVersion = 1;
void write_table(const SweepPlan& plan, const SweepTable& table, const std::filesystem::path& file);
// Writes the table as text: a header of names, a row for each point done.
void write_table_csv(const SweepPlan& plan, const SweepTable& table,
                     const std::filesystem::path& file);

// Digest of this program and this kind of processor; another one may change results in the last
// bit.
std::uint64_t build_digest();
std::string hex(std::uint64_t digest);

// A sweep's table, taken from its file together with the plan in it.
struct OpenedSweep {
  std::filesystem::path file;             // the table
  std::shared_ptr<const SweepPlan> plan;  // without worlds if their files are missing
  SweepTable table;
  std::string build;       // of the program that made it, as hex(build_digest())
  std::string why_no_run;  // why its points cannot be run again; empty: they can
  // Lowest and highest value of each column over all points done.
  std::vector<std::pair<double, double>> ranges;
};

// The table of a sweep: DIR/table.h5 of a folder, or `path` if its file is a table; else nothing.
// Reads only the beginning of recordings, which may be large.
std::optional<std::filesystem::path> sweep_table_at(const std::filesystem::path& path);

// Opens a table. `before`: the same table earlier; its plan is not read again. Errors: FileError if
// the file is no table, or damaged.
std::shared_ptr<const OpenedSweep> open_table(const std::filesystem::path& file,
                                              const OpenedSweep* before = nullptr);

}  // namespace limpid
