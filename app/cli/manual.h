// Manual pages, from what the commands say of themselves.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace limpid {

// The page of a command, or of the app itself, as man(7) has it.
std::string manual_page(const CLI::App& app, const CLI::App& command);

}  // namespace limpid
