// A sweep's folder: consecutive points as files of their own, each whole or not there.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/sweep/sweep_rows.h"

namespace limpid {

class SweepFolder {
 public:
  // Creates it, or takes up what is there. Errors: FileError for a folder of another plan or build,
  // and for one that cannot be written.
  SweepFolder(const SweepPlan& plan, std::filesystem::path dir);

  const std::filesystem::path& path() const { return dir_; }
  std::filesystem::path table() const { return dir_ / "table.h5"; }
  std::filesystem::path file(const SweepBlock& block) const;
  bool there(const SweepBlock& block) const;
  // Its values, row by row; nothing if it is not there or damaged. Errors: FileError for one of
  // another plan or build.
  std::optional<std::vector<double>> read(const SweepBlock& block) const;
  // Whole, or as if never begun. Errors: FileError.
  void write(const SweepBlock& block, const std::vector<double>& rows) const;

 private:
  const SweepPlan& plan_;
  std::filesystem::path dir_;
  std::size_t columns_;
};

// Where the plan of a sweep's folder came from, as a name at least: beside it are the files that it
// names. In the folder itself, if that place is not known or gone. Errors: FileError.
std::filesystem::path plan_behind(const std::filesystem::path& dir);

}  // namespace limpid
