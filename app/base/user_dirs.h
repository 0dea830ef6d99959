// Where the user's own files of Limpid are.
#pragma once

#include <filesystem>
#include <string>

namespace limpid {

std::filesystem::path user_config_dir();  // $XDG_CONFIG_HOME/limpid, or ~/.config/limpid
std::filesystem::path user_data_dir();    // $XDG_DATA_HOME/limpid, or ~/.local/share/limpid
std::filesystem::path user_cache_dir();   // $XDG_CACHE_HOME/limpid, or ~/.cache/limpid

// Something's name as part of a file's: what is neither letter nor digit becomes "-".
std::string as_file_name(std::string name);

}  // namespace limpid
