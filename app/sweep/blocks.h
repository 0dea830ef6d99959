// A sweep's folder: consecutive points as files of their own, each whole or not there.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/sweep/sweep_plan.h"

namespace limpid {

class SweepFolder {
 public:
  // Creates it, or takes up what is there. Errors: FileError for a folder of another plan or build,
  // and for one that cannot be written.
  SweepFolder(const SweepPlan& plan, std::filesystem::path dir);

  const std::filesystem::path& path() const { return dir_; }
  std::filesystem::path table() const { return dir_ / "table.h5"; }
  std::uint64_t blocks() const;
  std::uint64_t first(std::uint64_t block) const { return block * plan_.block; }
  std::uint64_t size(std::uint64_t block) const;  // points

  std::filesystem::path file(std::uint64_t block) const;
  bool there(std::uint64_t block) const;
  // Its values, row by row; nothing if it is not there or damaged. Errors: FileError for one of
  // another plan or build.
  std::optional<std::vector<double>> read(std::uint64_t block) const;
  // Whole, or as if never begun. Errors: FileError.
  void write(std::uint64_t block, const std::vector<double>& rows) const;

 private:
  const SweepPlan& plan_;
  std::filesystem::path dir_;
  std::size_t columns_;
};

}  // namespace limpid
