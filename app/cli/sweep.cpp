#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "app/base/interrupt.h"
#include "app/cli/commands.h"
#include "app/cli/options.h"
#include "app/cli/out_folder.h"
#include "app/cli/progress.h"
#include "app/run/provenance.h"
#include "app/sweep/record_point.h"
#include "app/sweep/slurm.h"
#include "app/sweep/sweep_figure.h"
#include "app/sweep/sweep_plan.h"
#include "app/sweep/sweep_work.h"

namespace limpid {

void check_point(const SweepPlan& plan, std::uint64_t index) {
  if (plan.boundary) {
    throw UsageError(
        "--open: not for a plan with a boundary: each point of a boundary consists of many runs");
  }
  if (index < plan.points()) return;
  throw UsageError(fmt::format("--open {}: is not allowed; allowed: the number of a point, 0 to {}",
                               index, plan.points() - 1));
}

int open_point(const SweepPlan& plan, std::uint64_t index, const std::filesystem::path& out) {
  const std::filesystem::path file = point_file(out, index, {});
  const auto recorded = record_point(plan, index, {}, file, interrupted);
  if (!recorded) return 1;
  fmt::print("{}recorded in {}\n", recorded->summary.text(), file.string());
  std::fflush(stdout);
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return 0;
  ::execl("/proc/self/exe", "limpid", "play", file.c_str(), nullptr);
  return 0;
}

namespace {

namespace fs = std::filesystem;

constexpr unsigned kMostThreads = 1024;
constexpr std::chrono::milliseconds kBetweenLooks{50};
constexpr int kLooksATurn = 40;  // waits between two questions to Slurm's queue

struct SweepOptions {
  std::string plan, out, shard;
  std::optional<unsigned> threads;
  std::optional<std::uint64_t> open;
  bool gather = false, mpi = false, slurm = false, csv = false, xacro = false, force = false;
  SlurmOptions array;
};

// Reads "3/8" as the third of eight shares.
SweepShare share_in(const std::string& text) {
  unsigned long i = 0, n = 0;
  int read = 0;
  const bool two = std::sscanf(text.c_str(), "%5lu/%5lu%n", &i, &n, &read) == 2;
  if (!two || read != static_cast<int>(text.size()) || i < 1 || i > n) {
    throw UsageError(fmt::format(
        "--shard: \"{}\" is not allowed; allowed: I/N with I from 1 to N, N up to 99999", text));
  }
  return {.shard = i - 1, .shards = n};
}

SweepShare share_of(const SweepOptions& options) {
  SweepShare share;
  if (!options.shard.empty()) share = share_in(options.shard);
  if (options.mpi) {
    const auto rank = own_rank();
    if (!rank) {
      throw UsageError(
          "--mpi: this process is not one of many with a rank; start the command as mpirun -n 8 "
          "limpid sweep ... --mpi");
    }
    share = {.shard = rank->rank, .shards = rank->size, .helps = true, .threads = 1};
  }
  if (options.threads) share.threads = *options.threads;
  return share;
}

// A call of the command.
class Sweeping {
 public:
  Sweeping(const SweepOptions& options, const SweepShare& share, const SweepPlan& plan,
           const SweepFolder& folder)
      : options_(options),
        share_(share),
        plan_(plan),
        folder_(folder),
        book_(plan, folder, options.csv) {}

  int carry_out() {
    if (options_.slurm) return on_slurm();
    // A share among several writes no table, which others may be writing.
    const bool alone = share_.shards == 1, first = options_.mpi && share_.shard == 0;
    if (!options_.gather) {
      const bool finished = work(alone);
      if (!finished && alone) book_.write();
      if (!finished) return stopped("the same command continues from here");
    }
    if (!alone && !first && !options_.gather) {
      if (!options_.mpi) say_what_is_there();
      return 0;
    }
    book_.gather();
    return finish();
  }

 private:
  Progress::Words words(double points) const {
    return {.title = plan_.title, .whole = points, .unit = "", .rate = "points per second"};
  }

  // Works until done; false if stopped.
  bool work(bool alone) {
    TimedTable keeper(book_);
    std::atomic<std::uint64_t> done{0};
    const TakeBlock take = [&](std::uint64_t block, const auto& values) {
      book_.take(block, values);
      if (alone) keeper.write_if_time();
    };
    Progress progress(
        words(static_cast<double>(plan_.points()) / static_cast<double>(share_.shards)));
    const std::jthread watch([&](const std::stop_token& over) {
      while (!over.stop_requested()) {
        progress.at(static_cast<double>(done.load()));
        std::this_thread::sleep_for(kBetweenLooks);
      }
    });
    return work_off(plan_, folder_, share_, interrupted, done, take);
  }

  int on_slurm() {
    SlurmArray array(plan_, folder_, options_.array);
    TimedTable keeper(book_);
    {
      Progress progress(words(static_cast<double>(plan_.points())));
      while (!interrupted) {
        array.turn(book_);
        progress.at(static_cast<double>(book_.table().count()));
        keeper.write_if_time();
        if (book_.complete()) break;
        for (int i = 0; i < kLooksATurn && !interrupted; ++i) {
          std::this_thread::sleep_for(kBetweenLooks);
        }
      }
    }
    if (book_.complete()) return finish();
    book_.write();
    return stopped(
        fmt::format("the tasks continue, and the same command collects the results; scancel -n {} "
                    "ends the tasks",
                    array.name()));
  }

  // Tells how far all shares together have come.
  void say_what_is_there() const {
    std::uint64_t there = 0;
    for (std::uint64_t i = 0; i < blocks_of(plan_); ++i) {
      const SweepBlock block = block_of(plan_, i);
      if (folder_.there(block)) there += block.size;
    }
    fmt::print(
        "part {} is done; {} of {} points are in {}; `limpid sweep {} --out {} --gather` makes "
        "the table of them\n",
        options_.shard, there, plan_.points(), options_.out, options_.plan, options_.out);
  }

  int stopped(const std::string& advice) {
    fmt::print(stderr, "limpid: stopped; {}\n", advice);
    return 1;
  }

  int finish() {
    book_.write();
    const SweepTable& table = book_.table();
    fmt::print("{} of {} points in {}\n", table.count(), table.points(), folder_.table().string());
    std::fflush(stdout);
    if (table.count() > 0) draw(table);
    return book_.complete() ? 0 : 1;
  }

  // Draws the figure if possible; nodes of a cluster may have no gnuplot.
  void draw(const SweepTable& table) {
    try {
      Figure figure = sweep_figure(plan_, table);
      // No date in it: the figure is the same however often the table is gathered.
      figure.made_by = provenance(hex(plan_.key).substr(0, 8), plan_.seed, "");
      draw_figure(figure, folder_.path(), "figure");
    } catch (const std::runtime_error& e) {
      fmt::print(stderr, "limpid: no figure: {}\n", e.what());
    }
  }

  const SweepOptions& options_;
  const SweepShare& share_;
  const SweepPlan& plan_;
  const SweepFolder& folder_;
  SweepBook book_;
};

int sweep(const SweepOptions& options) {
  const SweepShare share = share_of(options);
  const SweepPlan plan =
      read_sweep_plan(options.plan, options.xacro ? Xacro::expand : Xacro::refuse);
  if (options.open) check_point(plan, *options.open);
  if (!options.gather) prepare_out(options.out);
  if (!options.open && !is_sweep_folder(options.out)) {
    refuse_foreign({options.out, "limpid sweep", {"table", "figure"}, options.force});
  }
  catch_interrupts();
  if (options.open) check_plan_of(plan, options.out);
  if (options.open) return open_point(plan, *options.open, options.out);
  const SweepFolder folder(plan, options.out);
  try {
    return Sweeping(options, share, plan, folder).carry_out();
  } catch (const FileError& e) {  // of the results, not of the input
    throw std::runtime_error(fmt::format("{}; the same command continues from here", e.what()));
  }
}

std::string measure_help() {
  std::string text = "Measures:\n";
  for (const MeasureInfo& m : measure_table()) {
    text += fmt::format("  {:<17} {:<11} {}\n", m.name, m.unit, m.what);
  }
  return text;
}

}  // namespace

Command declare_sweep(CLI::App& app) {
  auto* command =
      app.add_subcommand("sweep", "runs all combinations of a plan's values and writes one table");
  auto options = std::make_shared<SweepOptions>();
  command->add_option("PLAN.toml", options->plan, "the plan: what is varied and what is measured")
      ->transform(or_shipped({"sweeps"}), "", "")
      ->required()
      ->type_name("");
  command->add_option("--out", options->out, "the folder for the results")
      ->required()
      ->type_name("DIR");
  auto* threads =
      command->add_option("--threads", options->threads, "default: one per core; under mpirun: one")
          ->type_name("N")
          ->check(CLI::Range(1u, kMostThreads));
  auto* shard = command->add_option("--shard", options->shard, "run only the I-th of N parts")
                    ->type_name("I/N");
  auto* gather = command->add_flag("--gather", options->gather,
                                   "run nothing; only collect the existing results; exit status 1 "
                                   "if points are missing");
  auto* mpi = command->add_flag("--mpi", options->mpi,
                                "run only the part of this process (its rank), under mpirun");
  auto* slurm = command->add_flag("--slurm", options->slurm, "run as an array job of Slurm");
  for (auto* one : {shard, gather, mpi, slurm}) {
    for (auto* other : {shard, gather, mpi, slurm}) {
      if (one != other) one->excludes(other);
    }
  }
  command
      ->add_option("--tasks", options->array.tasks, "with --slurm: tasks of the array; default 100")
      ->type_name("N")
      ->check(CLI::Range(1u, 100000u))
      ->needs(slurm);
  command
      ->add_option("--sbatch", options->array.options,
                   "with --slurm: an option of sbatch, for example --sbatch=--time=60; repeatable")
      ->type_name("OPTION")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->needs(slurm);
  auto* open =
      command
          ->add_option("--open", options->open,
                       "run this point again, record the run in DIR/points and play the recording")
          ->type_name("POINT");
  require_whole_number(open);
  auto* csv = command->add_flag("--csv", options->csv, "write DIR/table.csv as well");
  for (auto* other : {shard, gather, mpi, slurm, threads, csv}) open->excludes(other);
  add_force(*command, options->force);
  command->add_flag(
      "--allow-xacro", options->xacro,
      "expand the xacro files of arms that the plan names: this runs code in these files");
  command->footer(
      "How to write a plan: the chapter *Sweeps* of `limpid manual`. The command writes "
      "DIR/table.h5, and parts of "
      "the table while\nthe sweep runs. Called again, the command continues where the sweep was "
      "stopped or killed.\n\n" +
      measure_help());
  return [options] { return sweep(*options); };
}

}  // namespace limpid
