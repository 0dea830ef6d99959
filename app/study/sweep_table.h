// What a sweep has found so far, and its files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/study/measure_point.h"
#include "devices/files/session/hdf5_reading.h"

namespace limpid {

// HDF5 files made in memory and put in their place whole.

class FileImage {
 public:
  // Errors of all: FileError naming `file`, whose place it will take.
  explicit FileImage(std::filesystem::path file);

  hid_t root() const { return file_.get(); }
  // Rows x width, or a list where the width is 1; without times, so that equal contents are equal
  // bytes. Protected by a checksum.
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
  std::vector<double> values;      // points x columns; not a number where they are not

  std::uint64_t points() const { return done.size(); }
  std::uint64_t count() const;  // done
  bool complete() const { return count() == points(); }
  double at(std::uint64_t point, std::size_t column) const {
    return values[point * columns.size() + column];
  }
  // Puts the values of consecutive points in their place.
  void take(std::uint64_t first, const std::vector<double>& found);
};

// The file as it stands for the plan and what is done of it: the same bytes from whoever writes it.
//   /axis/NAME     points, float64: attributes unit, key, spread, scale, words (of 0, 1, ...)
//   /measure/NAME  points, float64: attributes unit, what
//   /repeat, /done points, uint32 and uint8
// Root attributes: format kSweepFormat, version 1, title, plan (TOML), key (of the plan and the
// files that it names), points, done, app_version, build. Errors: FileError.
inline constexpr const char* kSweepFormat = "limpid-sweep";
inline constexpr std::uint64_t kSweepVersion = 1;
void write_table(const SweepPlan& plan, const SweepTable& table, const std::filesystem::path& file);
// The same as text: a header of names, a row for each point that is done.
void write_table_csv(const SweepPlan& plan, const SweepTable& table,
                     const std::filesystem::path& file);

// Stands for this program on this kind of processor: what differs in it may differ in the last bit.
std::uint64_t build_digest();
std::string hex(std::uint64_t digest);

// A sweep's table, taken from its file together with the plan in it.
struct OpenedSweep {
  std::filesystem::path file;             // the table
  std::shared_ptr<const SweepPlan> plan;  // without worlds where these could not be had
  SweepTable table;
  std::string build;       // of who made it, as hex(build_digest())
  std::string why_no_run;  // what keeps its points from being run again; empty: nothing does
  // Of each column over all points that are done.
  std::vector<std::pair<double, double>> ranges;
};

// DIR/table.h5 of a folder that holds one, and a file that says that it is one; else nothing. Of
// recordings, which may be large, it reads the beginning.
std::optional<std::filesystem::path> sweep_table_at(const std::filesystem::path& path);

// `before`: the same table as it was earlier, whose plan is then not read again. Errors: FileError
// for what is no table, or a damaged one.
std::shared_ptr<const OpenedSweep> open_table(const std::filesystem::path& file,
                                              const OpenedSweep* before = nullptr);

}  // namespace limpid
