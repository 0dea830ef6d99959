#include "app/base/user_dirs.h"

#include <cctype>
#include <cstdlib>

namespace limpid {
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
