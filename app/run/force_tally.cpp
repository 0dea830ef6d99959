#include "app/run/force_tally.h"

#include <fmt/format.h>

#include <map>

#include "core/tick/force_text.h"

namespace limpid {

std::string force_tally(const Session& session) {
  std::map<int, std::size_t> ticks;  // of each state
  std::size_t without = 0;
  for (std::size_t k = 0; k < session.size(); ++k) {
    const auto state = static_cast<int>(session.at(k, Column::force_state)[0]);
    if (state == static_cast<int>(ForceState::on)) continue;
    ++ticks[state];
    ++without;
  }
  if (without == 0) return "force                    on all the time\n";
  const auto seconds = [&](std::size_t count) {
    return static_cast<double>(count) * session.info.tick;
  };
  std::string text = fmt::format("without full force       {:.3f} s of {:.3f} s\n",
                                 seconds(without), seconds(session.size()));
  for (const auto& [state, count] : ticks) {
    text += fmt::format("  for {:8.3f} s         {}\n", seconds(count),
                        force_text(static_cast<ForceState>(state)));
  }
  return text;
}

}  // namespace limpid
