#include "app/desktop/widgets/path_dialog.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "app/desktop/widgets/modal.h"
#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

std::string small_letters(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

fs::path expanded(const std::string& text) {
  const char* home = std::getenv("HOME");
  if (home != nullptr && (text == "~" || text.starts_with("~/"))) {
    return fs::path(home) / (text.size() > 2 ? text.substr(2) : "");
  }
  return text;
}

fs::path PathDialog::draw(bool& open, const fs::path& first) {
  const float em = ImGui::GetFontSize();
  const float width = std::min(44 * em, 0.9f * ImGui::GetMainViewport()->WorkSize.x);
  if (!begin_modal(options_.title, open, {width, 0})) {
    was_open_ = false;
    return {};
  }
  const bool appears = !was_open_;
  if (appears) {
    text_ = first.string();
    listed_.clear();
    complaint_.clear();
    replaced_.clear();
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
  bool picked = false;
  const float list = std::min(14 * ImGui::GetTextLineHeightWithSpacing(),
                              0.4f * ImGui::GetMainViewport()->WorkSize.y);
  ImGui::BeginChild("folder", {0, list}, true);
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
  ImGui::EndChild();
  const bool pressed = ImGui::Button(replaced_.empty() ? options_.action : "Replace it");
  ImGui::SameLine();
  close_button("Cancel (Esc)", open);
  if (entered || pressed || picked || accepted()) chosen = choose();
  if (!complaint_.empty()) {
    ImGui::SameLine();
    ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(current_palette().broken));
    ImGui::TextWrapped("%s", complaint_.c_str());
    ImGui::PopStyleColor();
  }
  if (!chosen.empty()) open = false;
  ImGui::EndPopup();
  return chosen;
}

void PathDialog::list_folder() {
  std::error_code none;
  const fs::path typed = expanded(text_);
  const fs::path folder = fs::is_directory(typed, none) ? typed : typed.parent_path();
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
      complaint_ = fmt::format("{} is there already.", file.filename().string());
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
