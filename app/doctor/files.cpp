#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "app/base/folders.h"
#include "app/doctor/doctor.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using State = Finding::State;

constexpr const char* kFilesArea = "files";
constexpr const char* kAgain =
    "sudo apt install --reinstall limpid; or `cmake --install` again; or, in its "
    "sources, ./run";
constexpr std::uintmax_t kMega = 1'000'000;
constexpr std::uintmax_t kLittle = 1000 * kMega, kTooLittle = 50 * kMega;  // [bytes]

Finding assets() {
  try {
    const fs::path data = data_dir();
    if (fs::exists(data / "shaders")) {
      return {kFilesArea, "assets", State::fine, data.string(), {}, {}};
    }
    return {kFilesArea,    "assets", State::broken, (data / "shaders").string() + " is missing",
            "no pictures", kAgain};
  } catch (const std::exception& error) {
    return {kFilesArea,
            "assets",
            State::broken,
            error.what(),
            "Limpid cannot start; only this report works",
            kAgain};
  }
}

Finding program(const char* name, const char* cost) {
  std::error_code none;
  const fs::path file = fs::read_symlink("/proc/self/exe", none).replace_filename(name);
  if (access(file.c_str(), X_OK) == 0)
    return {kFilesArea, name, State::fine, file.string(), {}, {}};
  return {kFilesArea, name, State::broken, file.string() + " is missing", cost, kAgain};
}

// Looks for a program in PATH, as the shell does.
Finding tool(const std::string& name, const char* cost, const std::string& package) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path file = fs::path(folder) / name;
    if (access(file.c_str(), X_OK) == 0)
      return {kFilesArea, name, State::fine, file.string(), {}, {}};
  }
  return {kFilesArea, name, State::better, "not installed", cost, "sudo apt install " + package};
}

// The folder, or the nearest one above that exists.
fs::path nearest(fs::path folder) {
  std::error_code none;
  while (!fs::exists(folder, none) && folder.has_relative_path()) folder = folder.parent_path();
  return folder;
}

Finding writable(const char* what, const fs::path& folder, const char* cost) {
  const fs::path there = nearest(folder);
  std::error_code none;
  if (fs::is_directory(there, none) && access(there.c_str(), W_OK | X_OK) == 0) {
    return {kFilesArea, what, State::fine, folder.string(), {}, {}};
  }
  return {kFilesArea,
          what,
          State::broken,
          fmt::format("{} cannot be written", folder.string()),
          cost,
          fs::is_directory(there, none)
              ? fmt::format("sudo chown -R \"$USER\" {}", there.string())
              : fmt::format("rm {}    # it is not a folder", there.string())};
}

Finding room() {
  const fs::path there = nearest(user_data_dir());
  std::error_code failed;
  const std::uintmax_t left = fs::space(there, failed).available;
  if (failed)
    return {kFilesArea,
            "disk",
            State::better,
            failed.message(),
            "the free space on the disk is not known",
            "df -h"};
  const std::string found =
      fmt::format("{:.1f} GB left at {}", static_cast<double>(left) / 1e9, there.string());
  if (left >= kLittle) return {kFilesArea, "disk", State::fine, found, {}, {}};
  return {kFilesArea,
          "disk",
          left < kTooLittle ? State::broken : State::better,
          found,
          "recordings and videos will soon stop, as the disk is nearly full",
          "sudo apt clean; du -xh ~ | sort -h | tail"};
}

}  // namespace

DoctorFindings look_at_files() {
  return {
      assets(),
      program("limpid-session", "recordings and tables of sweeps are not read"),
      program("limpid-model", "models other than glTF are not read"),
      program("limpid-video", "no videos"),
      program("limpid-vendor", "devices whose makers have their own library are not found"),
      tool("gnuplot", "experiments and sweeps draw no figures", "gnuplot-nox"),
      writable("settings", user_config_dir(), "devices, layouts and presets are not remembered"),
      writable("data", user_data_dir(), "nothing is stored for the next start"),
      writable("cache", user_cache_dir(),
               "thumbnails are not stored, so they are drawn again each time"),
      room(),
  };
}

}  // namespace limpid
