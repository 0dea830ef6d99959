// How a part of the window asks for what can be done in it.
#pragma once

#include <functional>
#include <string_view>

namespace limpid {

// Has a command run, by its id in the table of app/desktop/shell/commands.cpp.
using Act = std::function<void(std::string_view id)>;

}  // namespace limpid
