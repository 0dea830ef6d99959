// What a sweep has found so far, and its files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/sweep/measure_point.h"

namespace limpid {

// A value for every measured column of every point, row by row.
struct SweepTable {
  explicit SweepTable(const SweepPlan& plan)
      : columns(measured_columns(plan)),
        done(plan.points(), 0),
        values(plan.points() * columns.size()) {}

  std::vector<SweepColumn> columns;
  std::vector<std::uint8_t> done;  // of each point: 1 if its values are there
  std::vector<double> values;      // points x columns; not a number where they are not

  std::uint64_t points() const { return done.size(); }
  std::uint64_t count() const;  // done
  double at(std::uint64_t point, std::size_t column) const {
    return values[point * columns.size() + column];
  }
  // Puts the values of consecutive points in their place.
  void take(std::uint64_t first, const std::vector<double>& rows);
};

// The file as it stands for the plan and what is done of it: the same bytes from whoever writes it.
//   /axis/NAME     points, float64: attributes unit, key, spread, scale, words (of 0, 1, ...)
//   /measure/NAME  points, float64: attributes unit, what
//   /repeat, /done points, uint32 and uint8
// Root attributes: format "limpid-sweep", version 1, title, plan (TOML), points, done, app_version,
// build. Errors: FileError.
void write_table(const SweepPlan& plan, const SweepTable& table, const std::filesystem::path& file);
// The same as text: a header of names, a row for each point that is done.
void write_table_csv(const SweepPlan& plan, const SweepTable& table,
                     const std::filesystem::path& file);

// Stands for this program on this kind of processor: what differs in it may differ in the last bit.
std::uint64_t build_digest();
std::string hex(std::uint64_t digest);

}  // namespace limpid
