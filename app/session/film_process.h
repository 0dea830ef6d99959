// A session's video made beside a window, by a process of its own.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

namespace limpid {

// Runs `limpid play SESSION --video OUT` with these `options` at low priority and waits for it:
// ImGui serves one thread of a program only, and the loop keeps its processor. `part` is set to
// what is done, 0 to 1. Returns false once `stop` is true and the process has cleared up. Errors:
// std::runtime_error with what the process said.
bool film_beside(const std::filesystem::path& session, const std::filesystem::path& out,
                 const std::vector<std::string>& options, const std::atomic<bool>& stop,
                 std::atomic<double>& part);

}  // namespace limpid
