#include "app/run/shipped_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "app/base/folders.h"
#include "devices/files/toml_reader.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEndings[] = {".toml", ".urdf", ".csv", ".h5", ".glb"};

bool is_of(std::string_view kind, const fs::path& file) {
  const std::string ending = file.extension().string();
  // A file of keys beside an arm is the program's.
  if (kind == "devices") return ending == ".urdf";
  return std::ranges::find(kEndings, ending) != std::end(kEndings);
}

}  // namespace

std::vector<std::string> shipped_names(const char* kind) {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(data_dir() / "assets" / kind, none)) {
    if (!entry.is_regular_file() || !is_of(kind, entry.path())) continue;
    names.push_back(entry.path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

std::optional<fs::path> shipped_file(const std::string& named, const Kinds& kinds) {
  if (named.empty() || named.find('/') != std::string::npos) return std::nullopt;
  for (const char* kind : kinds) {
    const fs::path own = data_dir() / "assets" / kind / named;
    if (fs::is_regular_file(own)) return own;
  }
  return std::nullopt;
}

std::string shipped_hint(const std::string& named, const Kinds& kinds) {
  if (named.find('/') != std::string::npos) return {};
  // Names are compared by their stems, as endings make them alike; those of the same ending come
  // first. A name of another kind is meant only if its stem is right.
  const fs::path wanted = named;
  std::vector<std::string> stems, names;
  for (const bool same_ending : {true, false}) {
    for (const char* kind : kinds) {
      for (const std::string& name : shipped_names(kind)) {
        const fs::path file = name;
        if ((file.extension() == wanted.extension()) != same_ending) continue;
        if (!same_ending && wanted.has_extension() && file.stem() != wanted.stem()) continue;
        stems.push_back(file.stem().string());
        names.push_back(name);
      }
    }
  }
  const auto meant = nearest(wanted.stem().string(), stems);
  if (!meant) return {};
  const auto at = std::ranges::find(stems, *meant) - stems.begin();
  return fmt::format("; did you mean {}?", names[static_cast<std::size_t>(at)]);
}

}  // namespace limpid
