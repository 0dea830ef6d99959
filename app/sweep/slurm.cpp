#include "app/sweep/slurm.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "app/run/run_key.h"
#include "devices/files/atomic_file.h"

namespace limpid {

namespace {

namespace fs = std::filesystem;

std::optional<std::uint64_t> number_in(const char* variable) {
  const char* text = std::getenv(variable);
  if (text == nullptr) return std::nullopt;
  std::uint64_t n = 0;
  const char* end = text + std::strlen(text);
  const auto result = std::from_chars(text, end, n);
  if (result.ec != std::errc{} || result.ptr != end) return std::nullopt;
  return n;
}

// Output of a shell command. Errors: std::runtime_error with the output.
std::string said_by(const std::string& command) {
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot start a shell for " + command);
  std::string text;
  std::array<char, 4096> block;
  while (const std::size_t count = std::fread(block.data(), 1, block.size(), pipe)) {
    text.append(block.data(), count);
  }
  const int status = ::pclose(pipe);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return text;
  const std::string program = command.substr(0, command.find(' '));
  throw std::runtime_error(fmt::format("{}: {}", program, text.substr(0, text.find('\n'))));
}

}  // namespace

std::optional<Rank> own_rank() {
  struct Variables {
    const char *rank, *size;
  };
  for (const auto& [rank, size] :
       {Variables{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
        Variables{"PMI_RANK", "PMI_SIZE"}, Variables{"SLURM_PROCID", "SLURM_NTASKS"}}) {
    const auto r = number_in(rank), n = number_in(size);
    if (r && n && *r < *n) return Rank{*r, *n};
  }
  return std::nullopt;
}

std::string array_text(const std::set<std::uint64_t>& numbers) {
  std::string text;
  for (auto from = numbers.begin(); from != numbers.end();) {
    auto to = from;
    std::uint64_t last = *from;
    while (++to != numbers.end() && *to == last + 1) last = *to;
    text += (text.empty() ? "" : ",") +
            (last > *from ? fmt::format("{}-{}", *from, last) : fmt::format("{}", *from));
    from = to;
  }
  return text;
}

std::string shell_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + '\'';
}

SlurmArray::SlurmArray(const SweepPlan& plan, const SweepFolder& folder,
                       const SlurmOptions& options)
    : plan_(plan),
      folder_(folder),
      options_(options),
      tasks_(std::min(options.tasks, blocks_of(plan))) {
  // Another folder, plan or number of tasks is another job.
  Digest digest;
  digest.add(fs::weakly_canonical(folder.path()).string());
  digest.add(plan.key);
  digest.add(tasks_);
  name_ = "limpid-" + hex(digest.value());
}

std::uint64_t SlurmArray::turn(SweepBook& book) {
  // The order matters: a task that has left the queue has written its blocks.
  const std::set<std::uint64_t> there = queued();
  const std::uint64_t came = book.gather();
  std::map<std::uint64_t, std::uint64_t> missing;  // blocks of each task
  for (std::uint64_t b = 0; b < blocks_of(plan_); ++b) {
    if (!book.has(b)) ++missing[b % tasks_ + 1];
  }
  std::set<std::uint64_t> lost;
  for (const auto& [task, blocks] : missing) {
    if (there.contains(task)) continue;
    Try& last = tries_[task];
    last.count = blocks == last.missing ? last.count + 1 : 1;
    last.missing = blocks;
    if (last.count > kMostTries) {
      throw std::runtime_error(
          fmt::format("task {} of {} gave no result {} times; its logs are in {}", task, name_,
                      kMostTries, (folder_.path() / "slurm").string()));
    }
    lost.insert(task);
  }
  if (!lost.empty()) submit(lost);
  return came;
}

std::set<std::uint64_t> SlurmArray::queued() const {
  // Lists one line for each task, also of pending ones.
  const std::string text = said_by("squeue -h -r -o %K -n " + name_);
  std::set<std::uint64_t> tasks;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::uint64_t task = 0;
    const auto result = std::from_chars(text.data() + at, text.data() + end, task);
    if (result.ec == std::errc{}) tasks.insert(task);
    at = end + 1;
  }
  return tasks;
}

std::string SlurmArray::script() const {
  const auto quoted = [](const fs::path& path) {
    return shell_quoted(fs::weakly_canonical(path).string());
  };
  return fmt::format(
      "#!/bin/sh\nexec {} sweep {} --out {} --shard \"$SLURM_ARRAY_TASK_ID/{}\" "
      "--threads \"${{SLURM_CPUS_PER_TASK:-1}}\"{}\n",
      quoted("/proc/self/exe"), quoted(plan_.file), quoted(folder_.path()), tasks_,
      plan_.xacro == Xacro::expand ? " --allow-xacro" : "");
}

void SlurmArray::submit(const std::set<std::uint64_t>& tasks) const {
  const fs::path dir = fs::weakly_canonical(folder_.path()) / "slurm";
  fs::create_directories(dir);
  const fs::path file = dir / "job.sh";
  const std::string text = script();
  write_atomically(file, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
  std::string command = fmt::format("sbatch --parsable --job-name={} --array={} --output={}", name_,
                                    array_text(tasks), shell_quoted((dir / "%A_%a.log").string()));
  for (const std::string& option : options_.options) command += ' ' + shell_quoted(option);
  said_by(command + ' ' + shell_quoted(file.string()));
}

}  // namespace limpid
