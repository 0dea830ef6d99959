// `limpid run --live`.
#pragma once

#include "app/cli/live_bench.h"

namespace limpid {

inline constexpr double kLiveSeconds = 10;  // without --duration

struct LiveRunOptions {
  LiveOptions live;
  InputOptions input;
  std::string record, picture;
  bool force = false;
};

// Returns the exit status. Errors: as LiveBench.
int run_live(const LiveRunOptions& options);

}  // namespace limpid
