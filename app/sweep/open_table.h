// A sweep's table, taken from its file together with the plan in it.
#pragma once

#include <memory>

#include "app/sweep/sweep_table.h"

namespace limpid {

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
