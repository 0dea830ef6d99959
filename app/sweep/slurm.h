// Sweeps on many processes: ranks under mpirun or srun, and array jobs of Slurm.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/sweep/sweep_work.h"

namespace limpid {

// Number of this process among `size` alike, from the environment of mpirun or srun; needs no MPI.
struct Rank {
  std::uint64_t rank = 0, size = 1;
};
std::optional<Rank> own_rank();

// A sweep as an array job of Slurm; tasks and the gathering process share a file system.
struct SlurmOptions {
  std::uint64_t tasks = 100;         // most tasks; no more than there are blocks
  std::vector<std::string> options;  // of sbatch, unchanged
};

// "1-3,7": numbers as sbatch --array has them.
std::string array_text(const std::set<std::uint64_t>& numbers);
// Quotes `text` for a shell, in single quotes.
std::string shell_quoted(const std::string& text);

// Submits missing blocks, gathers results, and submits lost tasks again. Tasks of an earlier call
// that still wait or run are left alone. Recognizes its tasks by the job's name alone.
class SlurmArray {
 public:
  SlurmArray(const SweepPlan& plan, const SweepFolder& folder, const SlurmOptions& options);

  const std::string& name() const { return name_; }
  // Submits once each task with missing blocks that is not in the queue. Returns the number of
  // points that came since the last call. Errors: std::runtime_error if Slurm refuses, or if a task
  // brought nothing kMostTries times; FileError.
  std::uint64_t turn(SweepBook& book);

  static constexpr int kMostTries = 3;

 private:
  struct Try {
    int count = 0;
    std::uint64_t missing = 0;  // blocks missing at the last submission
  };
  std::set<std::uint64_t> queued() const;
  void submit(const std::set<std::uint64_t>& tasks) const;
  std::string script() const;

  const SweepPlan& plan_;
  const SweepFolder& folder_;
  SlurmOptions options_;
  std::uint64_t tasks_;
  std::string name_;
  std::map<std::uint64_t, Try> tries_;
};

}  // namespace limpid
