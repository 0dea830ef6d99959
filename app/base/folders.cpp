#include "app/base/folders.h"

#include <cctype>
#include <cstdlib>
#include <stdexcept>

#include "core/base/child.h"

namespace limpid {

namespace fs = std::filesystem;

fs::path data_dir() {
  std::error_code none;
  const fs::path program = own_binary();
  for (fs::path folder = program; folder.has_relative_path();) {
    folder = folder.parent_path();
    const fs::path data = folder / "share/limpid";
    if (fs::exists(data / "assets/devices/omni.urdf", none)) return fs::canonical(data);
  }
  throw std::runtime_error("Limpid's data files were not found: no folder share/limpid above " +
                           program.string() +
                           "; install it again, or build it again where its sources are now");
}

// An installed manual is beside the documents, a built one beside all that is to be installed.
fs::path manual_file() {
  std::error_code none;
  for (const fs::path& file : {data_dir().parent_path() / "doc/limpid/manual.html",
                               own_binary().parent_path() / "../made/manual.html"}) {
    if (fs::exists(file, none)) return fs::canonical(file, none);
  }
  return {};
}

fs::path beside_or_own(const fs::path& folder, const std::string& kind, const std::string& name) {
  fs::path beside = folder / name;
  if (fs::exists(beside)) return beside;
  fs::path own = data_dir() / "assets" / kind / name;
  return fs::is_regular_file(own) ? own : beside;
}

namespace {

std::filesystem::path home_dir(const char* variable, const char* below_home) {
  if (const char* dir = std::getenv(variable); dir != nullptr && *dir != '\0') return dir;
  const char* home = std::getenv("HOME");
  return std::filesystem::path(home != nullptr && *home != '\0' ? home : "/tmp") / below_home;
}

}  // namespace

std::filesystem::path user_config_dir() {
  return home_dir("XDG_CONFIG_HOME", ".config") / "limpid";
}
std::filesystem::path user_data_dir() {
  return home_dir("XDG_DATA_HOME", ".local/share") / "limpid";
}
std::filesystem::path user_cache_dir() { return home_dir("XDG_CACHE_HOME", ".cache") / "limpid"; }

std::string as_file_name(std::string name) {
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '-';
  return name;
}

}  // namespace limpid
