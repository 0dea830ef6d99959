// Whether a file may be expanded by the program xacro.
#pragma once

#include <filesystem>

namespace limpid {

// While `open`. True once it may, which clears `open`.
bool draw_xacro_question(bool& open, const std::filesystem::path& file);

}  // namespace limpid
