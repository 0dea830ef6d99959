// Questions in a terminal before something moves or pushes.
#pragma once

#include <functional>
#include <string>

namespace limpid {

// Says the prompt and waits for Enter; what was typed before is no answer to it. `meanwhile` is
// called all along and takes the time between two looks. False once that says false. Errors:
// UsageError at the end of what can be typed.
bool await_enter(const std::string& prompt, const std::function<bool()>& meanwhile);

}  // namespace limpid
