// [refine] of a sweep's plan.
#pragma once

#include "app/sweep/sweep_plan.h"
#include "devices/files/toml_reader.h"

namespace limpid {

// Last of all that is read: gives the axes the values that lie between. Errors: FileError.
void read_refine(const TomlTable& refine, SweepPlan& plan);

}  // namespace limpid
