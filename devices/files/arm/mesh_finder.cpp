#include "devices/files/arm/mesh_finder.h"

#include <algorithm>
#include <fstream>

#include "devices/files/arm/search_path.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr int kMostFolders = 4000;                 // that are looked into for one package
constexpr int kDeepestFolder = 6;                  // below a folder of ROS_PACKAGE_PATH
constexpr std::size_t kLongestManifest = 1 << 20;  // [bytes]

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

// What a package.xml calls its package; empty if there is none.
std::string package_name(const fs::path& folder) {
  const fs::path manifest = folder / "package.xml";
  if (!is_file(manifest)) return {};
  std::ifstream file(manifest, std::ios::binary);
  std::string text(kLongestManifest, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  const auto from = text.find("<name>"), to = text.find("</name>");
  if (from == std::string::npos || to == std::string::npos || to < from) return {};
  const std::string name = text.substr(from + 6, to - from - 6);
  const auto first = name.find_first_not_of(" \t\r\n"), last = name.find_last_not_of(" \t\r\n");
  return first == std::string::npos ? "" : name.substr(first, last - first + 1);
}

std::vector<fs::path> folders_in(const fs::path& folder) {
  std::vector<fs::path> all;
  std::error_code error;
  for (fs::directory_iterator each(folder, error), end; !error && each != end;
       each.increment(error)) {
    if (all.size() >= kMostFolders) break;
    if (each->path().filename().string().starts_with('.')) continue;
    if (each->is_directory(error)) all.push_back(each->path());
  }
  std::ranges::sort(all);  // the same everywhere
  return all;
}

// As ROS crawls: a package has no packages inside.
void crawl(const fs::path& folder, const std::string& name, int depth, int& left,
           std::vector<fs::path>& found) {
  if (--left < 0 || depth > kDeepestFolder) return;
  if (const std::string own = package_name(folder); !own.empty()) {
    if (own == name) found.push_back(folder);
    return;
  }
  for (const fs::path& each : folders_in(folder)) crawl(each, name, depth + 1, left, found);
}

}  // namespace

const std::vector<fs::path>& MeshFinder::packages(const std::string& name) {
  const auto [place, fresh] = packages_.try_emplace(name);
  std::vector<fs::path>& found = place->second;
  if (!fresh) return found;
  if (!folder_.empty()) {
    int left = kMostFolders;
    for (fs::path at = fs::absolute(folder_).lexically_normal();; at = at.parent_path()) {
      if (at.filename() == name || package_name(at) == name) found.push_back(at);
      if (is_folder(at / name)) found.push_back(at / name);
      if (at == at.parent_path()) break;
      for (const fs::path& each : folders_in(at)) {
        if (--left > 0 && package_name(each) == name) found.push_back(each);
      }
    }
  }
  for (const fs::path& path : search_path("ROS_PACKAGE_PATH")) {
    if (is_folder(path / name)) found.push_back(path / name);
    int left = kMostFolders;
    crawl(path, name, 0, left, found);
  }
  for (const fs::path& path : search_path("AMENT_PREFIX_PATH")) {
    found.push_back(path / "share" / name);
  }
  return found;
}

fs::path MeshFinder::find(const std::string& name) {
  const auto present = [](const fs::path& path) {
    return is_file(path) ? fs::absolute(path).lexically_normal() : fs::path();
  };
  const std::size_t scheme = name.find("://");
  if (scheme == std::string::npos) {
    const fs::path file = name;
    if (file.is_relative() && folder_.empty()) return {};
    return present(folder_ / file);
  }
  const std::string kind = name.substr(0, scheme), rest = name.substr(scheme + 3);
  if (kind == "file") return present("/" + rest.substr(std::min(rest.find('/') + 1, rest.size())));
  if (kind != "package" && kind != "model") return {};
  const std::size_t slash = rest.find('/');
  if (slash == std::string::npos || slash == 0) return {};
  const fs::path inside = rest.substr(slash + 1);
  for (const fs::path& package : packages(rest.substr(0, slash))) {
    if (const fs::path file = present(package / inside); !file.empty()) return file;
  }
  return {};
}

}  // namespace limpid
