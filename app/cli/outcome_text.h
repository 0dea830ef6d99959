// Verdicts of experiments on standard output.
#pragma once

#include <string>
#include <vector>

#include "app/experiments/experiment.h"

namespace limpid {

void print_outcome(const std::string& name, const Outcome& outcome);

// Adds failed checks in words, with their experiment. An experiment without checks fails.
void note_failures(const std::string& name, const Outcome& outcome,
                   std::vector<std::string>& failed);

// Says where the report is, and what failed. Returns the exit status.
int finish_report(const std::string& out, const std::vector<std::string>& failed);

}  // namespace limpid
