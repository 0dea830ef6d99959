#include "app/desktop/experiments/sweep_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "app/sweep/sweep_work.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

// Returns a number of threads that leaves the rest to the loop and the picture.
unsigned few_threads() { return std::max(1u, std::thread::hardware_concurrency() / 4); }

std::string diverged_text(const SweepTable& table) {
  const std::uint64_t count = diverged_points(table);
  return count == 0 ? "" : fmt::format(" {} of them diverged.", count);
}

}  // namespace

void SweepRunner::start(const fs::path& folder) {
  folder_ = folder;
  stopping_ = false;
  table_there_ = false;
  done_ = points_ = began_at_ = 0;
  work_.start("sweep", [this, folder](TaskProgress& progress) {
    return carry_out(folder, progress.cancel);
  });
}

void SweepRunner::stop() {
  stopping_ = true;
  work_.ask_to_stop();
}

std::string SweepRunner::under_way() const {
  if (!busy()) return {};
  if (points_ == 0) return "reading the plan";
  std::string text = fmt::format("{} of {} points", done(), points());
  const auto made = static_cast<double>(done()) - static_cast<double>(began_at_);
  if (made > 0) {
    const auto left = static_cast<double>(points()) - static_cast<double>(done());
    text += fmt::format(", {:.0f} s left", work_.seconds() * left / made);
  }
  return text;
}

std::optional<fs::path> SweepRunner::take_table() {
  if (!table_there_.exchange(false)) return std::nullopt;
  return folder_ / "table.h5";
}

std::optional<std::string> SweepRunner::take() { return work_.take(); }

std::string SweepRunner::carry_out(const fs::path& folder, const std::atomic<bool>& stop) {
  const SweepPlan plan = read_sweep_plan(folder / "plan.toml");
  const SweepFolder files(plan, folder);
  SweepBook book(plan, files, false);
  began_at_ = book.gather();
  points_ = plan.points();
  book.write();
  table_there_ = true;
  TimedTable keeper(book);
  const TakeBlock take = [&](std::uint64_t block, const std::vector<double>& rows) {
    book.take(block, rows);
    keeper.write_if_time();
  };
  const bool finished = work_off(plan, files, {.threads = few_threads()}, stop, done_, take);
  book.write();
  const SweepTable& table = book.table();
  if (finished) {
    return fmt::format("The sweep is complete: {} points in {}.{}", table.count(), folder.string(),
                       diverged_text(table));
  }
  return fmt::format("The sweep was stopped at {} of {} points, which are kept in {}.{}",
                     table.count(), table.points(), folder.string(), diverged_text(table));
}

}  // namespace limpid
