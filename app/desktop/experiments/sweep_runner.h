// Work on a sweep beside the window, as `limpid sweep` does it.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "app/base/tasks.h"

namespace limpid {

class SweepRunner {
 public:
  // Works on the plan.toml of a folder, from where it was stopped. Precondition: not busy().
  void start(const std::filesystem::path& folder);
  // Asks the work to end; finished points stay.
  void stop();

  bool busy() const { return work_.busy(); }
  bool stopping() const { return busy() && stopping_; }
  const std::filesystem::path& folder() const { return folder_; }
  std::uint64_t done() const { return done_; }
  std::uint64_t points() const { return points_; }  // 0 until the plan is read
  // Returns "12 of 64 points, 30 s left"; empty while nothing is under way.
  std::string under_way() const;

  // Returns the table's file once, when it can be opened.
  std::optional<std::filesystem::path> take_table();
  // Returns a sentence on the end of the work, once. Errors: whatever ended it, as FileError for a
  // plan that cannot be run.
  std::optional<std::string> take();

 private:
  std::string carry_out(const std::filesystem::path& folder, const std::atomic<bool>& stop);

  std::filesystem::path folder_;
  bool stopping_ = false;
  std::atomic<bool> table_there_{false};
  std::atomic<std::uint64_t> done_{0}, points_{0}, began_at_{0};  // began_at_: points there before
  Task<std::string> work_;  // last, as it uses the others until its end
};

}  // namespace limpid
