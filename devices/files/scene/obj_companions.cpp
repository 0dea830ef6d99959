#include "devices/files/scene/obj_companions.h"

#include <unistd.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "devices/files/scene/scene_limits.h"
#include "devices/files/text_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostCompanions = 1000;

// What a line says that begins with one of the words that name files; empty: nothing.
std::string_view named_in(std::string_view line, bool materials) {
  line = trimmed(line);
  const std::size_t end = std::min(line.find_first_of(kBlanks), line.size());
  const std::string_view word = line.substr(0, end);
  const bool names = materials ? word.starts_with("map_") || word == "bump" || word == "disp" ||
                                     word == "decal" || word == "norm" || word == "refl"
                               : word == "mtllib";
  return names ? trimmed(line.substr(end)) : std::string_view();
}

class Companions {
 public:
  explicit Companions(const fs::path& obj)
      : folder_(fs::canonical(obj.parent_path().empty() ? "." : obj.parent_path())) {}

  void look_into(const fs::path& file, bool materials) {
    const std::string text = read_text(file, scene_limits::kLargestModel);
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      take(named_in(std::string_view(text).substr(at, end - at), materials), materials);
      at = end + 1;
    }
  }
  std::vector<fs::path> all() && { return std::move(all_); }

 private:
  // A name may hold blanks; else it is the last word behind a picture's options, or one of several.
  void take(std::string_view words, bool pictures) {
    if (words.empty() || take_file(std::string(words), pictures)) return;
    while (!words.empty()) {
      const std::size_t blank = words.find_last_of(kBlanks);
      const std::size_t from = blank == words.npos ? 0 : blank + 1;
      take_file(std::string(words.substr(from)), pictures);
      words =
          pictures || blank == words.npos ? std::string_view() : trimmed(words.substr(0, blank));
    }
  }

  bool take_file(std::string name, bool pictures) {
    std::replace(name.begin(), name.end(), '\\', '/');
    const fs::path relative = fs::path(name).lexically_normal();
    std::error_code error;
    const fs::path file = fs::canonical(folder_ / relative, error);
    const fs::path inside = error ? fs::path() : file.lexically_relative(folder_);
    if (inside.empty() || *inside.begin() == ".." || relative.is_absolute() ||
        *relative.begin() == ".." || !fs::is_regular_file(file, error) ||
        ::access(file.c_str(), R_OK) != 0) {
      return false;
    }
    if (all_.size() >= kMostCompanions || std::ranges::find(all_, relative) != all_.end()) {
      return true;
    }
    all_.push_back(relative);
    if (!pictures) look_into(file, true);
    return true;
  }

  fs::path folder_;
  std::vector<fs::path> all_;
};

}  // namespace

std::vector<fs::path> obj_companions(const fs::path& obj) {
  Companions companions(obj);
  companions.look_into(obj, false);
  return std::move(companions).all();
}

}  // namespace limpid
