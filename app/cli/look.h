// `limpid devices look`: reads a device for a while and records it, without any force.
#pragma once

#include "app/cli/commands.h"

namespace limpid {

// Declares it below `devices`.
Command declare_look(CLI::App& devices);

}  // namespace limpid
