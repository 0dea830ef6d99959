// Folders of the program's own files and of the user's.
#pragma once

#include <filesystem>
#include <string>

namespace limpid {

// Returns the folder that holds assets/ and shaders/. It is share/limpid beside one of the folders
// that this program, or Limpid's library, is in: PREFIX/share/limpid if installed, a link to the
// source tree in a build folder. Throws std::runtime_error if it is not there.
std::filesystem::path data_dir();

inline std::filesystem::path default_device() { return data_dir() / "assets/devices/omni.urdf"; }
inline std::filesystem::path default_scene() { return data_dir() / "assets/scenes/table.toml"; }
inline std::filesystem::path default_hand() { return data_dir() / "assets/hands/touch.csv"; }

// Returns the manual, a page for browsers; empty if it is not there.
std::filesystem::path manual_file();

// Returns `name` beside a script in `folder`, else among the program's own in assets/`kind`.
std::filesystem::path beside_or_own(const std::filesystem::path& folder, const std::string& kind,
                                    const std::string& name);

// Folders of the user's own files of Limpid.
std::filesystem::path user_config_dir();  // $XDG_CONFIG_HOME/limpid, or ~/.config/limpid
std::filesystem::path user_data_dir();    // $XDG_DATA_HOME/limpid, or ~/.local/share/limpid
std::filesystem::path user_cache_dir();   // $XDG_CACHE_HOME/limpid, or ~/.cache/limpid

// Makes something's name part of a file's: characters that are neither letter nor digit become "-".
std::string as_file_name(std::string name);

}  // namespace limpid
