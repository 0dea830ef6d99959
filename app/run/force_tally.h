// How much of a recording was without force, and why.
#pragma once

#include <string>

#include "devices/files/session/session.h"

namespace limpid {

// In lines for people, one for each reason.
std::string force_tally(const Session& session);

}  // namespace limpid
