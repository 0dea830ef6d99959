#include "app/desktop/scene_dialogs.h"

#include <fmt/format.h>
#include <imgui.h>

#include "app/base/assets.h"
#include "app/desktop/modal.h"
#include "app/desktop/panels.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

void draw_question(Workbench& bench) {
  bool open = bench.after_question != nullptr;
  const bool shown = begin_modal("Save changes?", open, {0, 0});
  if (!open) bench.after_question = nullptr;
  if (!shown) return;
  ImGui::PushTextWrapPos(28 * ImGui::GetFontSize());
  ImGui::TextUnformatted("The scene has changes that are not saved.");
  ImGui::PopTextWrapPos();
  ImGui::Spacing();
  // An answer may throw; it is carried out once the dialog is drawn.
  void (Workbench::*answer)() = nullptr;
  const bool own = !bench.own_scene_file().empty();
  if (ImGui::Button(own ? "Save (Enter)" : "Save as... (Enter)"))
    answer = &Workbench::save_and_leave;
  ImGui::SameLine();
  if (ImGui::Button("Discard (D)")) answer = &Workbench::discard_and_leave;
  ImGui::SameLine();
  if (ImGui::Button("Cancel (Esc)")) bench.after_question = nullptr;
  ImGui::EndPopup();
  if (answer != nullptr) (bench.*answer)();
}

void draw_progress(Workbench& bench, const ScreenRect& view) {
  SceneLoader& loader = bench.loader;
  if (!loader.busy()) return;
  const float em = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({(view.min.x + view.max.x) / 2, view.max.y - em}, ImGuiCond_Always,
                          {0.5f, 1});
  ImGui::Begin("loading", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  std::string text = loader.what();
  const double left = loader.seconds_left();
  if (loader.part() >= 1) {
    text += ", making it touchable";
  } else if (left >= 1) {
    text += fmt::format(", {:.0f} s left", left);
  }
  if (loader.waiting() > 0) text += fmt::format(", {} more after it", loader.waiting());
  ImGui::TextUnformatted(text.c_str());
  progress_bar(loader.part(), 22 * em);
  ImGui::SameLine();
  if (ImGui::Button("Cancel")) loader.cancel();
  ImGui::End();
}

}  // namespace

void SceneDialogs::draw(Workbench& bench, const ScreenRect& view) {
  draw_progress(bench, view);
  if (bench.after_question && modal(bench.dialog)) bench.dialog = Dialog::none;
  gallery_.draw(bench);
  draw_paths(bench);
  draw_question(bench);
}

void SceneDialogs::draw_paths(Workbench& bench) {
  if (last_folder_.empty()) last_folder_ = data_dir() / "assets/scenes";
  const auto ask = [&bench](PathDialog& dialog, Dialog which, const fs::path& first) {
    bool open = bench.dialog == which;
    const bool was_open = open;
    fs::path file = dialog.draw(open, first);
    if (was_open && !open) bench.dialog = Dialog::none;
    return file;
  };
  if (const fs::path model = ask(add_, Dialog::add_model, last_folder_ / ""); !model.empty()) {
    last_folder_ = model.parent_path();
    bench.add_model(model);
  }
  fs::path first = bench.own_scene_file();
  if (first.empty()) first = scenes_dir() / fs::path(bench.scene_file).filename();
  if (const fs::path file = ask(save_, Dialog::save_scene, first); !file.empty()) {
    bench.save_scene_as(file);
  }
}

}  // namespace limpid
