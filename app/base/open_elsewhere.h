// Hands files to the desktop's other programs.
#pragma once

#include <filesystem>

namespace limpid {

// Opens a file with the desktop's program for it (xdg-open). Returns false without xdg-open.
bool open_elsewhere(const std::filesystem::path& file);
// Shows a file in the desktop's file manager: selected over D-Bus (org.freedesktop.FileManager1),
// else by opening its folder. May take seconds: not for the window's thread. Returns false if
// neither is there.
bool show_in_folder(const std::filesystem::path& file);

}  // namespace limpid
