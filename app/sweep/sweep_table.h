// What a sweep has found so far, and its files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/sweep/measure_point.h"
#include "app/sweep/sweep_rows.h"

namespace limpid {

// A value for every measured column of every point, row by row.
struct SweepTable {
  explicit SweepTable(const SweepPlan& plan)  // which has to outlive it
      : rows(plan),
        columns(measured_columns(plan)),
        done(rows.size(), 0),
        values(rows.size() * columns.size()),
        refined_by(plan.refine ? plan.refine->column : 0) {}

  SweepRows rows;
  std::vector<SweepColumn> columns;
  std::vector<std::uint8_t> done;  // of each point: 1 if its values are there
  std::vector<double> values;      // points x columns; not a number where they are not
  std::size_t refined_by;          // a column

  std::uint64_t points() const { return done.size(); }  // that are known of by now
  std::uint64_t count() const;                          // done
  bool complete() const { return rows.complete() && count() == points(); }
  double at(std::uint64_t row, std::size_t column) const {
    return values[row * columns.size() + column];
  }
  // At a place that has no point of its own: from the corners of its cell. Nothing where these are
  // not there, or where there is nothing that is refined.
  std::optional<double> inferred(const std::vector<std::size_t>& place, std::uint64_t repeat,
                                 std::size_t column) const;
  // The points of the next round, if there is one. Precondition: all points so far are done.
  bool grow();
  // Puts the values of consecutive points in their place.
  void take(std::uint64_t first, const std::vector<double>& found);
};

// The file as it stands for the plan and what is done of it: the same bytes from whoever writes it.
//   /axis/NAME     points, float64: attributes unit, key, spread, scale, words (of 0, 1, ...)
//   /measure/NAME  points, float64: attributes unit, what
//   /repeat, /done points, uint32 and uint8
//   /point, /round points, uint64 and uint32, where the plan refines: its number, and the round it
//                  came in; else they are numbered from 0
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

}  // namespace limpid
