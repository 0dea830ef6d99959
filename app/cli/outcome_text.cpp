#include "app/cli/outcome_text.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

namespace limpid {

void print_outcome(const std::string& name, const Outcome& outcome) {
  const bool elsewhere = !outcome.arm.empty();
  fmt::print("{}{}{}: {}\n", name, elsewhere ? ", on " : "", outcome.arm,
             !outcome.passed() ? "FAILED"
             : elsewhere       ? "measured"
                               : "passed");
  const Check* before = nullptr;
  for (const Check& c : outcome.checks) {
    // A value between two bounds has two checks; where no bound is told, one line tells the value.
    const bool told = before != nullptr && !elsewhere && !c.unjudged.empty() &&
                      c.what == before->what && c.value == before->value;
    before = &c;
    if (told) continue;
    const char* verdict = !c.unjudged.empty() ? "----" : c.passed ? "ok  " : "FAIL";
    fmt::print("  {}  {}: {}", verdict, c.what,
               std::isnan(c.value) ? "not measurable" : fmt::format("{:.4g}", c.value));
    if (c.unjudged.empty()) fmt::print(" {} {:.4g}", c.least ? ">=" : "<=", c.bound);
    if (elsewhere && !c.unjudged.empty()) {
      fmt::print(" ({}promised for the built-in arm: {} {:.4g})",
                 std::isnan(c.value) ? ""
                 : c.passed          ? "kept; "
                                     : "missed; ",
                 c.least ? ">=" : "<=", c.bound);
    }
    if (c.against && c.against->expected) {
      fmt::print("; {:.6g} {} for {:.6g}", c.against->measured, c.against->unit,
                 *c.against->expected);
    }
    fmt::print("\n");
  }
  std::fflush(stdout);
}

void note_failures(const std::string& name, const Outcome& outcome,
                   std::vector<std::string>& failed) {
  for (const Check& c : outcome.checks) {
    if (c.failed()) failed.push_back(fmt::format("{}: {}", name, c.what));
  }
  if (outcome.checks.empty()) failed.push_back(fmt::format("{}: no checks", name));
}

int finish_report(const std::string& out, const std::vector<std::string>& failed) {
  fmt::print("report: {}\n", (std::filesystem::path(out) / "report.html").string());
  if (!failed.empty()) {
    fmt::print(stderr, "limpid: {} failed: {}\n", failed.size() == 1 ? "a check" : "checks",
               fmt::join(failed, "; "));
  }
  return failed.empty() ? 0 : 1;
}

}  // namespace limpid
