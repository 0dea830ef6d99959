// Which of many like processes this one is, as mpirun or srun tell by the environment: what needs
// no messages needs no MPI.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/study/sweep_work.h"

namespace limpid {

struct Rank {
  std::uint64_t rank = 0, size = 1;
};
std::optional<Rank> own_rank();

// A sweep as an array job of Slurm, whose tasks share a file system with whoever gathers.
struct SlurmOptions {
  std::uint64_t tasks = 100;         // at most: no more than there are blocks
  std::vector<std::string> options;  // of sbatch, as they are
};

// "1-3,7": numbers as sbatch --array has them.
std::string array_text(const std::set<std::uint64_t>& numbers);
// In single quotes for a shell.
std::string shell_quoted(const std::string& text);

// Submits what is missing, gathers what comes, submits again what was lost; tasks of an earlier
// call that still wait or run are left to it. Knows its tasks by the job's name alone.
class SlurmArray {
 public:
  SlurmArray(const SweepPlan& plan, const SweepFolder& folder, const SlurmOptions& options);

  const std::string& name() const { return name_; }
  // Once: submits tasks whose blocks are missing and that are not in the queue. Returns how many
  // points' blocks came since the last call. Errors: std::runtime_error where Slurm refuses, or
  // where a task brought nothing kMostTries times; FileError.
  std::uint64_t turn(SweepBook& book);

  static constexpr int kMostTries = 3;

 private:
  struct Try {
    int count = 0;
    std::uint64_t missing = 0;  // when it was last submitted
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
