// A sweep's folder: consecutive points as files of their own, each whole or not there.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/study/sweep_table.h"

namespace limpid {

// Consecutive points that are written, and lost, together.
struct SweepBlock {
  std::uint64_t number = 0, first = 0, size = 0;
};
std::uint64_t blocks_of(const SweepPlan& plan);  // how many
SweepBlock block_of(const SweepPlan& plan, std::uint64_t number);

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

// Works a sweep's points off, and puts its table together.
struct SweepShare {
  std::uint64_t shard = 0, shards = 1;  // every shards-th block, from `shard` on
  bool helps = false;                   // does what is missing of the others', too
  unsigned threads = 0;                 // 0: one a core
};

// Called for a block that is there now, from any thread, one at a time.
using TakeBlock = std::function<void(std::uint64_t block, const std::vector<double>& rows)>;

// Does what of a share is not there yet. False if `stop` was set meanwhile; blocks that were not
// finished are lost. `done` counts points. Errors: FileError, std::runtime_error; what was finished
// stays.
bool work_off(const SweepPlan& plan, const SweepFolder& folder, const SweepShare& share,
              const std::atomic<bool>& stop, std::atomic<std::uint64_t>& done,
              const TakeBlock& take);

// The table while it fills.
class SweepBook {
 public:
  SweepBook(const SweepPlan& plan, const SweepFolder& folder, bool csv)
      : plan_(plan), folder_(folder), csv_(csv), table_(plan), taken_(blocks_of(plan), false) {}

  const SweepTable& table() const { return table_; }
  bool complete() const { return table_.complete(); }
  bool has(std::uint64_t block) const { return taken_[block]; }

  void take(std::uint64_t block, const std::vector<double>& rows);
  // Takes what blocks there are now; returns how many points were new. Errors: FileError.
  std::uint64_t gather();
  // Writes DIR/table.h5 (and .csv), atomically.
  void write() const;

 private:
  const SweepPlan& plan_;
  const SweepFolder& folder_;
  bool csv_;
  SweepTable table_;
  std::vector<bool> taken_;  // of each block
};

}  // namespace limpid
