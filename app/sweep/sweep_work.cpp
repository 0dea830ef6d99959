#include "app/sweep/sweep_work.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>

namespace limpid {
namespace {

// Blocks that threads take one after the other.
class Team {
 public:
  Team(const SweepPlan& plan, const SweepFolder& folder, const std::atomic<bool>& stop,
       std::atomic<std::uint64_t>& done, const TakeBlock& take)
      : plan_(plan), folder_(folder), stop_(stop), done_(done), take_(take) {}

  // False if stopped.
  bool work(const std::vector<std::uint64_t>& blocks, unsigned threads) {
    next_ = 0;
    {
      std::vector<std::jthread> all;
      const auto count = std::min<std::size_t>(threads, blocks.size());
      for (std::size_t i = 0; i < count; ++i) all.emplace_back([&] { work_on(blocks); });
    }
    if (failure_) std::rethrow_exception(failure_);
    return !stop_.load();
  }

 private:
  void work_on(const std::vector<std::uint64_t>& blocks) {
    try {
      for (std::size_t i = next_++; i < blocks.size(); i = next_++) {
        if (!do_block(blocks[i])) return;
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
      over_ = true;
    }
  }

  bool do_block(std::uint64_t block) {
    std::vector<double> rows;
    if (auto found = folder_.read(block)) {
      rows = *std::move(found);
      done_ += folder_.size(block);
    } else {
      const std::uint64_t first = folder_.first(block);
      for (std::uint64_t i = 0; i < folder_.size(block); ++i) {
        if (over_) return false;
        const auto values = measure_point(plan_, first + i, stop_);
        if (!values) return false;
        rows.insert(rows.end(), values->begin(), values->end());
        ++done_;
      }
      folder_.write(block, rows);
    }
    const std::lock_guard lock(mutex_);
    if (take_) take_(block, rows);
    return true;
  }

  const SweepPlan& plan_;
  const SweepFolder& folder_;
  const std::atomic<bool>& stop_;
  std::atomic<std::uint64_t>& done_;
  const TakeBlock& take_;
  std::atomic<std::size_t> next_{0};
  std::atomic<bool> over_{false};
  std::mutex mutex_;
  std::exception_ptr failure_;
};

}  // namespace

bool work_off(const SweepPlan& plan, const SweepFolder& folder, const SweepShare& share,
              const std::atomic<bool>& stop, std::atomic<std::uint64_t>& done,
              const TakeBlock& take) {
  const unsigned threads =
      share.threads > 0 ? share.threads : std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::uint64_t> own, others;
  // Each begins elsewhere with what others may be doing, too.
  const std::uint64_t from = folder.blocks() * share.shard / share.shards;
  for (std::uint64_t b = 0; b < folder.blocks(); ++b) {
    if (b % share.shards == share.shard) own.push_back(b);
    const std::uint64_t turned = (b + from) % folder.blocks();
    if (turned % share.shards != share.shard) others.push_back(turned);
  }
  Team team(plan, folder, stop, done, take);
  return team.work(own, threads) && (!share.helps || team.work(others, threads));
}

std::uint64_t SweepBook::missing() const {
  return static_cast<std::uint64_t>(std::ranges::count(taken_, false));
}

void SweepBook::take(std::uint64_t block, const std::vector<double>& rows) {
  table_.take(folder_.first(block), rows);
  taken_[block] = true;
  if (told_) told_(block, rows);
}

std::uint64_t SweepBook::gather() {
  std::uint64_t found = 0;
  for (std::uint64_t b = 0; b < folder_.blocks(); ++b) {
    if (taken_[b]) continue;
    const auto rows = folder_.read(b);
    if (!rows) continue;
    take(b, *rows);
    found += folder_.size(b);
  }
  return found;
}

void SweepBook::write() const {
  write_table(plan_, table_, folder_.table());
  if (csv_) write_table_csv(plan_, table_, folder_.path() / "table.csv");
}

}  // namespace limpid
