// Where the program's own files are: assets/ and shaders/.
#pragma once

#include <filesystem>
#include <string>

namespace limpid {

// The folder that holds assets/ and shaders/: share/limpid beside one of the folders that this
// program is in, PREFIX/share/limpid where it is installed; in a build folder a link to the source
// tree. Throws std::runtime_error if it is not there.
std::filesystem::path data_dir();

inline std::filesystem::path default_device() { return data_dir() / "assets/devices/omni.urdf"; }
inline std::filesystem::path default_scene() { return data_dir() / "assets/scenes/table.toml"; }
inline std::filesystem::path default_hand() { return data_dir() / "assets/hands/touch.csv"; }

// `name` beside a script in `folder`, else among the program's own in assets/`kind`.
std::filesystem::path beside_or_own(const std::filesystem::path& folder, const std::string& kind,
                                    const std::string& name);

// Where the user's own files of Limpid are.
std::filesystem::path user_config_dir();  // $XDG_CONFIG_HOME/limpid, or ~/.config/limpid
std::filesystem::path user_data_dir();    // $XDG_DATA_HOME/limpid, or ~/.local/share/limpid
std::filesystem::path user_cache_dir();   // $XDG_CACHE_HOME/limpid, or ~/.cache/limpid

// Something's name as part of a file's: what is neither letter nor digit becomes "-".
std::string as_file_name(std::string name);

}  // namespace limpid
