#include "app/base/assets.h"

#include <stdexcept>

namespace limpid {

namespace fs = std::filesystem;

fs::path data_dir() {
  std::error_code none;
  const fs::path installed =
      fs::read_symlink("/proc/self/exe", none).parent_path().parent_path() / "share/limpid";
  for (const fs::path& dir : {installed, fs::path(LIMPID_SOURCE_DIR)}) {
    if (fs::exists(dir / "assets/devices/omni.urdf", none)) return dir;
  }
  throw std::runtime_error("limpid's assets are neither in " + installed.string() + " nor in " +
                           LIMPID_SOURCE_DIR + "; run `cmake --install` again");
}

fs::path beside_or_own(const fs::path& folder, const std::string& kind, const std::string& name) {
  fs::path beside = folder / name;
  if (fs::exists(beside)) return beside;
  fs::path own = data_dir() / "assets" / kind / name;
  return fs::exists(own) ? own : beside;
}

}  // namespace limpid
