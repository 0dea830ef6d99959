// A sweep's folder: blocks of points as files, each complete or absent; and the work on them.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/sweep/sweep_table.h"

namespace limpid {

// Consecutive points that are written, and lost, together.
struct SweepBlock {
  std::uint64_t number = 0, first = 0, size = 0;
};
std::uint64_t blocks_of(const SweepPlan& plan);  // number of blocks
SweepBlock block_of(const SweepPlan& plan, std::uint64_t number);

class SweepFolder {
 public:
  // Creates the folder, or continues one. Errors: FileError for a folder of another plan or build,
  // and for one that cannot be written.
  SweepFolder(const SweepPlan& plan, std::filesystem::path dir);

  const std::filesystem::path& path() const { return dir_; }
  std::filesystem::path table() const { return dir_ / "table.h5"; }
  std::filesystem::path file(const SweepBlock& block) const;
  bool there(const SweepBlock& block) const;
  // Values of a block, row by row; nothing if it is absent or damaged. Errors: FileError for a
  // block of another plan or build.
  std::optional<std::vector<double>> read(const SweepBlock& block) const;
  // Writes a block whole, or leaves no trace of it. Errors: FileError.
  void write(const SweepBlock& block, const std::vector<double>& rows) const;

 private:
  const SweepPlan& plan_;
  std::filesystem::path dir_;
  std::size_t columns_;
};

// Whether a sweep began in that folder.
bool is_sweep_folder(const std::filesystem::path& dir);

// Refuses a folder in which a sweep of another plan began. Errors: FileError.
void check_plan_of(const SweepPlan& plan, const std::filesystem::path& dir);

// Path of the plan behind a sweep's folder, beside the files that the plan names. A path in the
// folder itself if the original is unknown or gone. Errors: FileError.
std::filesystem::path plan_behind(const std::filesystem::path& dir);

// A part of a sweep's work.
struct SweepShare {
  std::uint64_t shard = 0, shards = 1;  // every shards-th block, from `shard` on
  bool helps = false;                   // also does missing blocks of other shares
  unsigned threads = 0;                 // 0: one a core
};

// Called for each block that has come, from any thread, one call at a time.
using TakeBlock = std::function<void(std::uint64_t block, const std::vector<double>& rows)>;

// Does the missing blocks of a share. False if `stop` was set meanwhile; unfinished blocks are
// lost. `done` counts points. Errors: FileError, std::runtime_error; finished blocks stay.
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
  // Takes the blocks that have come. Returns the number of new points. Errors: FileError.
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

// Writes the table now and then during the work, so that it can be read at any moment.
class TimedTable {
 public:
  explicit TimedTable(const SweepBook& book) : book_(book) { wait({}); }
  void write_if_time();

 private:
  using Clock = std::chrono::steady_clock;
  void wait(Clock::duration writing);  // `writing`: how long the last time took

  const SweepBook& book_;
  Clock::time_point next_;
};

}  // namespace limpid
