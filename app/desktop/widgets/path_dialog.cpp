#include "app/desktop/widgets/path_dialog.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <utility>

#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "app/style/words.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostPlaces = 10;

// Returns the documents folder of xdg-user-dirs, whose file the desktop writes.
fs::path documents() {
  const char* config = std::getenv("XDG_CONFIG_HOME");
  const fs::path file =
      (config != nullptr && *config != '\0' ? fs::path(config) : expanded("~/.config")) /
      "user-dirs.dirs";
  std::ifstream in(file);
  constexpr std::string_view kKey = "XDG_DOCUMENTS_DIR=\"";
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(kKey) || !line.ends_with('"')) continue;
    std::string folder = line.substr(kKey.size(), line.size() - kKey.size() - 1);
    if (folder.starts_with("$HOME")) folder.replace(0, 5, "~");
    return expanded(folder);
  }
  return expanded("~/Documents");
}

}  // namespace

fs::path expanded(const std::string& text) {
  const char* home = std::getenv("HOME");
  if (home != nullptr && (text == "~" || text.starts_with("~/"))) {
    return fs::path(home) / (text.size() > 2 ? text.substr(2) : "");
  }
  return text;
}
std::vector<PathDialog::Place> PathDialog::places(const std::vector<Place>& own,
                                                  const std::vector<std::string>& recent) {
  std::vector<Place> all;
  const auto add = [&](const std::string& name, const fs::path& folder) {
    std::error_code none;
    const fs::path whole = fs::absolute(folder).lexically_normal();
    const bool known = std::ranges::find(all, whole, &Place::folder) != all.end();
    if (!known && all.size() < kMostPlaces && fs::is_directory(whole, none)) {
      all.push_back({name, whole});
    }
  };
  add("Home", expanded("~"));
  add("Documents", documents());
  for (const Place& place : own) add(place.name, place.folder);
  for (const std::string& file : recent) {
    const fs::path folder = fs::path(file).parent_path();
    add(folder.filename().string(), folder);
  }
  return all;
}

fs::path PathDialog::draw(bool& open, const fs::path& first, const std::vector<Place>& places) {
  const float em = ImGui::GetFontSize();
  const float width = std::min(54 * em, 0.94f * ImGui::GetMainViewport()->WorkSize.x);
  if (!begin_modal(options_.title, open, {width, 0})) {
    was_open_ = false;
    return {};
  }
  const bool appears = !was_open_;
  if (appears && !std::exchange(goes_on_, false)) {
    text_ = first.string();
    listed_.clear();
    complaint_.clear();
    replaced_.clear();
    names_folder_ = false;
  }
  was_open_ = true;
  fs::path chosen;
  if (appears) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1);
  const std::string before = text_;
  const bool entered = ImGui::InputTextWithHint("##path", "path of the file", &text_,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  if (text_ != before) complaint_.clear();
  list_folder();
  const float list = std::min(14 * ImGui::GetTextLineHeightWithSpacing(),
                              0.4f * ImGui::GetMainViewport()->WorkSize.y);
  if (!places.empty()) {
    ImGui::BeginChild("places", {11 * em, list}, true);
    draw_places(places);
    ImGui::EndChild();
    ImGui::SameLine();
  }
  ImGui::BeginChild("folder", {0, list}, true);
  const bool picked = draw_folder();
  ImGui::EndChild();
  const bool pressed = noted_button(replaced_.empty() ? options_.action : "Replace it");
  ImGui::SameLine();
  close_button("Cancel (Esc)", open);
  if (options_.new_file) draw_new_folder();
  const bool naming = names_folder_ && ImGui::IsAnyItemActive() && !entered;
  if (entered || pressed || picked || (accepted() && !naming)) chosen = choose();
  if (!complaint_.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(current_palette().broken));
    ImGui::TextWrapped("%s", complaint_.c_str());
    ImGui::PopStyleColor();
  }
  if (!chosen.empty()) open = false;
  ImGui::EndPopup();
  return chosen;
}

void PathDialog::draw_places(const std::vector<Place>& places) {
  for (const Place& place : places) {
    ImGui::PushID(place.folder.c_str());
    if (ImGui::Selectable(place.name.c_str(), place.folder.string() == listed_)) {
      go_to(place.folder);
    }
    note_place(place.name.c_str());
    tooltip(place.folder.c_str());
    ImGui::PopID();
  }
}

// Makes a folder in the listed one, and shows it.
void PathDialog::draw_new_folder() {
  ImGui::SameLine();
  if (!names_folder_) {
    if (noted_button("New folder")) {
      names_folder_ = true;
      folder_name_.clear();
    }
    return;
  }
  if (folder_name_.empty() && !ImGui::IsAnyItemActive()) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(12 * ImGui::GetFontSize());
  const bool entered = ImGui::InputTextWithHint("##folder", "name; Enter creates it", &folder_name_,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  if (!entered || folder_name_.empty()) return;
  std::error_code error;
  const fs::path folder = fs::path(listed_) / folder_name_;
  if (folder_name_.find('/') != std::string::npos || folder_name_ == "." || folder_name_ == "..") {
    complaint_ = "A folder's name has no / in it.";
  } else if (fs::exists(folder, error)) {
    complaint_ = fmt::format("{} exists already.", folder_name_);
  } else if (!fs::create_directory(folder, error)) {
    complaint_ = fmt::format("{} cannot be created: {}.", folder.string(), error.message());
  } else {
    go_to(folder);
    listed_.clear();
    names_folder_ = false;
  }
}

bool PathDialog::draw_folder() {
  bool picked = false;
  for (const fs::path& folder : folders_) {
    const bool up = folder == "..";
    if (ImGui::Selectable(((up ? std::string("..") : folder.filename().string()) + "/").c_str())) {
      go_to(up ? fs::path(listed_).parent_path() : folder);
      break;
    }
  }
  for (const fs::path& file : files_) {
    const bool is_it = file == expanded(text_);
    if (ImGui::Selectable(file.filename().c_str(), is_it, ImGuiSelectableFlags_AllowDoubleClick)) {
      text_ = file.string();
      complaint_.clear();
      picked = ImGui::IsMouseDoubleClicked(0);
    }
  }
  if (folders_.empty() && files_.empty()) ImGui::TextDisabled("no such folder");
  return picked;
}

void PathDialog::list_folder() {
  std::error_code none;
  const fs::path typed = expanded(text_);
  // A folder typed with / at its end has itself for a parent.
  const bool whole = fs::is_directory(typed, none) && typed.has_filename();
  const fs::path folder = whole ? typed : typed.parent_path();
  if (folder.string() == listed_ && was_open_) return;
  listed_ = folder.string();
  folders_.clear();
  files_.clear();
  if (!fs::is_directory(folder, none)) return;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.path().filename().string().starts_with(".")) continue;
    if (entry.is_directory(none)) {
      folders_.push_back(entry.path());
    } else if (std::ranges::find(options_.extensions,
                                 small_letters(entry.path().extension().string())) !=
               options_.extensions.end()) {
      files_.push_back(entry.path());
    }
  }
  std::ranges::sort(folders_);
  std::ranges::sort(files_);
  if (folder.has_relative_path()) folders_.insert(folders_.begin(), "..");
}

void PathDialog::go_to(const fs::path& folder) {
  const fs::path name = options_.new_file ? expanded(text_).filename() : fs::path();
  text_ = (folder / name).string();
  complaint_.clear();
  replaced_.clear();
}

fs::path PathDialog::take(const fs::path& file) {
  text_ = file.string();
  listed_.clear();
  complaint_.clear();
  names_folder_ = false;
  replaced_ = file;
  const fs::path taken = choose();
  goes_on_ = taken.empty();
  return taken;
}

fs::path PathDialog::choose() {
  std::error_code none;
  fs::path file = expanded(text_);
  if (file.empty()) return {};
  if (fs::is_directory(file, none)) {
    if (text_.back() != '/') text_ += '/';
    return {};
  }
  if (options_.new_file) {
    if (file.extension() != options_.extensions.front()) file += options_.extensions.front();
    if (fs::exists(file, none) && file != replaced_) {
      replaced_ = file;
      complaint_ = fmt::format("{} exists already.", file.filename().string());
      return {};
    }
    if (!fs::is_directory(fs::absolute(file).parent_path(), none)) {
      complaint_ = fmt::format("There is no folder {}.", file.parent_path().string());
      return {};
    }
    return file;
  }
  if (!fs::is_regular_file(file, none)) {
    complaint_ = "There is no such file.";
    return {};
  }
  return file;
}

}  // namespace limpid
