// Works a sweep's points off, and puts its table together.
#pragma once

#include <functional>
#include <vector>

#include "app/sweep/blocks.h"
#include "app/sweep/sweep_table.h"

namespace limpid {

struct SweepShare {
  std::uint64_t shard = 0, shards = 1;  // every shards-th block, from `shard` on
  bool helps = false;                   // does what is missing of the others', too
  unsigned threads = 0;                 // 0: one a core
};

// Called for a block that is there now, from any thread, one at a time.
using TakeBlock = std::function<void(std::uint64_t block, const std::vector<double>& rows)>;

// Does what of a share is not there yet, of the last round that is known. False if `stop` was set
// meanwhile; blocks that were not finished are lost. `done` counts points. Errors: FileError,
// std::runtime_error; what was finished stays.
bool work_off(const SweepPlan& plan, const SweepRows& rows, const SweepFolder& folder,
              const SweepShare& share, const std::atomic<bool>& stop,
              std::atomic<std::uint64_t>& done, const TakeBlock& take);

// The table while it fills.
class SweepBook {
 public:
  // `told` hears of each block that comes in.
  SweepBook(const SweepPlan& plan, const SweepFolder& folder, bool csv, TakeBlock told = {})
      : plan_(plan),
        folder_(folder),
        csv_(csv),
        told_(std::move(told)),
        table_(plan),
        taken_(table_.rows.blocks(), false) {}

  const SweepTable& table() const { return table_; }
  bool complete() const { return table_.complete(); }
  std::uint64_t missing() const;  // blocks of the rounds that are known
  bool has(std::uint64_t block) const { return taken_[block]; }

  void take(std::uint64_t block, const std::vector<double>& rows);
  // Takes what blocks there are now, and goes on to the next round where one is complete; returns
  // how many points were new. Errors: FileError.
  std::uint64_t gather();
  // Writes DIR/table.h5 (and .csv), atomically.
  void write() const;

 private:
  const SweepPlan& plan_;
  const SweepFolder& folder_;
  bool csv_;
  TakeBlock told_;
  SweepTable table_;
  std::vector<bool> taken_;  // of each block
};

}  // namespace limpid
