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
  Team(const SweepPlan& plan, const SweepRows& rows, const SweepFolder& folder,
       const std::atomic<bool>& stop, std::atomic<std::uint64_t>& done, const TakeBlock& take)
      : plan_(plan), rows_(rows), folder_(folder), stop_(stop), done_(done), take_(take) {}

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

  bool do_block(std::uint64_t number) {
    const SweepBlock block = rows_.block(number);
    std::vector<double> values;
    if (auto found = folder_.read(block)) {
      values = *std::move(found);
      done_ += block.size;
    } else {
      for (std::uint64_t i = 0; i < block.size; ++i) {
        if (over_) return false;
        const auto one = measure_point(plan_, rows_.point(block.first + i), stop_);
        if (!one) return false;
        values.insert(values.end(), one->begin(), one->end());
        ++done_;
      }
      folder_.write(block, values);
    }
    const std::lock_guard lock(mutex_);
    if (take_) take_(number, values);
    return true;
  }

  const SweepPlan& plan_;
  const SweepRows& rows_;
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

bool work_off(const SweepPlan& plan, const SweepRows& rows, const SweepFolder& folder,
              const SweepShare& share, const std::atomic<bool>& stop,
              std::atomic<std::uint64_t>& done, const TakeBlock& take) {
  const unsigned threads =
      share.threads > 0 ? share.threads : std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::uint64_t> own, others;
  const std::uint64_t begin = rows.first_block(), count = rows.blocks() - begin;
  // Each begins elsewhere with what others may be doing, too.
  const std::uint64_t from = count * share.shard / share.shards;
  for (std::uint64_t b = 0; b < count; ++b) {
    if ((begin + b) % share.shards == share.shard) own.push_back(begin + b);
    const std::uint64_t turned = begin + (b + from) % count;
    if (turned % share.shards != share.shard) others.push_back(turned);
  }
  Team team(plan, rows, folder, stop, done, take);
  return team.work(own, threads) && (!share.helps || team.work(others, threads));
}

std::uint64_t SweepBook::missing() const {
  return static_cast<std::uint64_t>(std::ranges::count(taken_, false));
}

void SweepBook::take(std::uint64_t block, const std::vector<double>& rows) {
  table_.take(table_.rows.block(block).first, rows);
  taken_[block] = true;
  if (told_) told_(block, rows);
}

std::uint64_t SweepBook::gather() {
  std::uint64_t found = 0;
  do {
    taken_.resize(table_.rows.blocks(), false);
    for (std::uint64_t b = 0; b < table_.rows.blocks(); ++b) {
      if (taken_[b]) continue;
      const auto rows = folder_.read(table_.rows.block(b));
      if (!rows) continue;
      take(b, *rows);
      found += table_.rows.block(b).size;
    }
  } while (missing() == 0 && table_.grow());
  return found;
}

void SweepBook::write() const {
  write_table(plan_, table_, folder_.table());
  if (csv_) write_table_csv(plan_, table_, folder_.path() / "table.csv");
}

}  // namespace limpid
