#include "app/run/run_notes.h"

#include <fmt/format.h>

#include "app/run/analysis.h"

namespace limpid {

std::vector<std::string> notes_on(const Parameters& p) {
  std::vector<std::string> notes;
  const LawInfo& law = info(p.kind);
  if (p.linked() && !law.knows_link()) {
    notes.push_back(fmt::format("link.* does nothing here: {}", law.through_link));
  }
  if (law.promise == Promise::ledger && p.tick > kTriedTick) {
    notes.push_back(fmt::format(
        "loop.tick {:.4g} ms: the energy account of the law {} was tested only at ticks of up to 1 "
        "ms; at longer ticks the hand may be given more energy than ledger.energy",
        1e3 * p.tick, law.key));
  }
  return notes;
}

}  // namespace limpid
