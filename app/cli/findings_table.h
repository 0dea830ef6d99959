// What was found of a device, as tables.
#pragma once

#include "app/study/identification.h"

namespace limpid {

void print(const Identification& identification);
// What is other than the last time.
void print_drift(const Findings& last, const Identification& now);

}  // namespace limpid
