// Hands a file to the desktop's other programs.
#pragma once

#include <filesystem>

namespace limpid {

// With the program that the desktop has for it (xdg-open). False where that is not there.
bool open_elsewhere(const std::filesystem::path& file);
// In the desktop's file manager, selected where that can be asked over D-Bus
// (org.freedesktop.FileManager1), else its folder. May take seconds: not for the window's thread.
// False where neither is there.
bool show_in_folder(const std::filesystem::path& file);

}  // namespace limpid
