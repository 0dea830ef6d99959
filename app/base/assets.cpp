#include "app/base/assets.h"

#include <stdexcept>

namespace limpid {

namespace fs = std::filesystem;

fs::path data_dir() {
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  for (fs::path folder = program; folder.has_relative_path();) {
    folder = folder.parent_path();
    const fs::path data = folder / "share/limpid";
    if (fs::exists(data / "assets/devices/omni.urdf", none)) return fs::canonical(data);
  }
  throw std::runtime_error("limpid's assets are in no folder share/limpid above " +
                           program.string() + "; install it again");
}

fs::path beside_or_own(const fs::path& folder, const std::string& kind, const std::string& name) {
  fs::path beside = folder / name;
  if (fs::exists(beside)) return beside;
  fs::path own = data_dir() / "assets" / kind / name;
  return fs::exists(own) ? own : beside;
}

}  // namespace limpid
