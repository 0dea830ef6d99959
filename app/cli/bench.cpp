#include "app/bench/bench.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <future>

#include "app/base/interrupt.h"
#include "app/cli/commands.h"
#include "app/cli/options.h"
#include "app/cli/progress.h"

namespace limpid {
namespace {

struct BenchOptions {
  bench::Wishes wishes;
  bool json = false;
};

int run_bench(const BenchOptions& options) {
  catch_interrupts();
  bench::Wishes wishes = options.wishes;
  std::stop_source stop;
  wishes.stop = stop.get_token();
  Progress progress({.title = "bench", .whole = 100, .unit = "", .rate = "% a second"});
  std::future<bench::Report> measured = std::async(std::launch::async, [&] {
    return bench::measure(wishes,
                          [&](double share, const std::string&) { progress.at(100 * share); });
  });
  while (measured.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
    if (interrupted) stop.request_stop();
  }
  const bench::Report report = measured.get();
  fmt::print("{}", options.json ? json_of(report) : text_of(report));
  if (interrupted) fmt::print(stderr, "limpid: interrupted; what was measured is above\n");
  return interrupted ? 1 : 0;
}

}  // namespace

Command declare_bench(CLI::App& app) {
  auto* command = app.add_subcommand("bench", "how fast Limpid is here, beside what it stands on");
  auto options = std::make_shared<BenchOptions>();
  command->add_flag("--json", options->json, "one JSON object on standard output");
  command->add_option("--ticks", options->wishes.ticks, "how many of each kind of tick")
      ->capture_default_str()
      ->check(CLI::Range(1000, 10'000'000));
  command->add_option("--only", options->wishes.only,
                      "one thing, or one kind: tick, tick/3, tick/3/proposed, arm, mesh, run");
  command->footer(
      "Takes about half a minute. Times are this machine's and of this moment; ratios are to what "
      "is "
      "measured\nbeside them and hold longer; instructions, where they can be counted, hold best.");
  return [options] {
    try {
      return run_bench(*options);
    } catch (const std::invalid_argument& e) {
      throw UsageError(fmt::format("--only {}", e.what()));
    }
  };
}

}  // namespace limpid
