// Speed of ticks, meshes, bodies and runs here, beside yardsticks: a table, or one JSON object.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <stdexcept>

#include "app/base/interrupt.h"
#include "tests/bench/bench.h"

namespace limpid::bench {
namespace {

constexpr const char* kMore =
    "Takes about half a minute. Times are this machine's and of this moment; ratios are to what "
    "is\n"
    "measured beside them and hold longer; instructions, where they can be counted, hold best.";

// Rewrites one line on a terminal; prints nothing elsewhere.
void say_progress(double share, const std::string& next) {
  if (isatty(STDERR_FILENO) == 0) return;
  fmt::print(stderr, "\r\033[K{}",
             next.empty() ? "" : fmt::format("{:.0f} %, {}", 100 * share, next));
}

int main_of(int argc, char** argv) {
  CLI::App app{"How fast Limpid is here, beside what it stands on.", "limpid_bench"};
  app.footer(kMore);
  Wishes wishes;
  bool json = false;
  app.add_flag("--json", json, "one JSON object on standard output");
  app.add_option("--ticks", wishes.ticks, "how many of each kind of tick")
      ->capture_default_str()
      ->check(CLI::Range(1000, 10'000'000));
  app.add_option("--only", wishes.only,
                 "one thing, or one kind: tick, tick/3, tick/3/proposed, arm, mesh, run");
  try {
    app.parse(argc, argv);
    catch_interrupts();
    const Report report = measure(wishes, say_progress);
    fmt::print("{}", json ? json_of(report) : text_of(report));
    if (interrupted) fmt::print(stderr, "limpid_bench: interrupted; what was measured is above\n");
    return interrupted ? 1 : 0;
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  } catch (const std::invalid_argument& e) {
    fmt::print(stderr, "limpid_bench: --only {}\n", e.what());
    return 2;
  } catch (const std::exception& e) {
    fmt::print(stderr, "limpid_bench: {}\n", e.what());
    return 1;
  }
}

}  // namespace
}  // namespace limpid::bench

int main(int argc, char** argv) { return limpid::bench::main_of(argc, argv); }
