#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "app/assets.h"
#include "app/desktop/keys.h"
#include "app/desktop/panels.h"
#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

bool begin_dialog(const char* title, bool& open, float width) {
  if (!open) return false;
  ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({width * ImGui::GetFontSize(), 0});
  return ImGui::Begin(title, &open,
                      ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                          ImGuiWindowFlags_AlwaysAutoResize);
}

void draw_open(Workbench& bench) {
  if (begin_dialog("Open session", bench.show_open, 34)) {
    const auto list = [&](const char* name, const fs::path& dir) {
      heading(name);
      std::vector<fs::path> files;
      std::error_code none;
      for (const auto& entry : fs::directory_iterator(dir, none)) {
        if (entry.path().extension() == ".h5") files.push_back(entry.path());
      }
      std::ranges::sort(files, std::greater{});
      if (files.empty()) ImGui::TextDisabled("none yet");
      for (const fs::path& file : files) {
        const double mib = static_cast<double>(fs::file_size(file, none)) / (1 << 20);
        if (ImGui::Selectable(
                fmt::format("{}   {:.1f} MiB", file.filename().string(), mib).c_str())) {
          bench.open_session(file);
          bench.show_open = false;
        }
      }
    };
    list("Yours", sessions_dir());
    list("Shipped with Limpid", data_dir() / "assets/sessions");
    ImGui::Spacing();
    ImGui::SetNextItemWidth(-1);
    if (ImGui::InputTextWithHint("##path",
                                 "or type a path and press Enter; dropping a file works too",
                                 &bench.typed_path, ImGuiInputTextFlags_EnterReturnsTrue)) {
      bench.open_session(bench.typed_path);
      bench.show_open = false;
    }
  }
  ImGui::End();
}

void draw_help(Workbench& bench) {
  if (begin_dialog("Keys and mouse", bench.show_help, 46)) {
    if (ImGui::BeginTable("keys", 2)) {
      ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthFixed, 13 * ImGui::GetFontSize());
      for (const Shortcut& shortcut : shortcuts()) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(shortcut.keys);
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(shortcut.what);
      }
      ImGui::EndTable();
    }
  }
  ImGui::End();
}

void draw_about(Workbench& bench) {
  if (begin_dialog("About Limpid", bench.show_about, 34)) {
    ImGui::PushFont(font(Face::semibold));
    ImGui::TextUnformatted("Limpid " LIMPID_VERSION);
    ImGui::PopFont();
    ImGui::TextWrapped(
        "Touch a virtual world through a haptic device and see, tick by tick, how transparent the "
        "coupling between hand and world is.");
    ImGui::Spacing();
    ImGui::TextWrapped(
        "The proposed coupling is that of \"Improving transparency of virtual coupling for haptic "
        "interaction with human force observer\"; numbers in parentheses are its equations. Please "
        "cite the paper when you publish what you measured here.");
    ImGui::Spacing();
    ImGui::TextWrapped(
        "Built on GLFW, Dear ImGui, Eigen, GLM, tinygltf, HDF5, urdfdom and fmt. Text "
        "is set in Inter (SIL Open Font License).");
  }
  ImGui::End();
}

}  // namespace

void draw_dialogs(Workbench& bench) {
  if (bench.show_open) draw_open(bench);
  if (bench.show_help) draw_help(bench);
  if (bench.show_about) draw_about(bench);
}

void draw_notices(Workbench& bench, const ScreenRect& view) {
  const Palette& colours = palette(current_theme());
  ImDrawList* draw = ImGui::GetForegroundDrawList();
  float y = view.min.y + 0.7f * ImGui::GetFontSize();
  for (const Notice& notice : bench.notices) {
    const float wrap = 0.7f * view.size().x;
    const ImVec2 size = ImGui::CalcTextSize(notice.text.c_str(), nullptr, false, wrap);
    const float pad = 0.5f * ImGui::GetFontSize();
    const ImVec2 at((view.min.x + view.max.x - size.x) / 2, y + pad);
    const ImVec2 from(at.x - pad, at.y - pad), to(at.x + size.x + pad, at.y + size.y + pad);
    draw->AddRectFilled(from, to, colour(colours.raised, 0.95f), 4);
    draw->AddRect(from, to, colour(notice.bad ? colours.broken : colours.border), 4);
    draw->AddText(ImGui::GetFont(), ImGui::GetFontSize(), at, colour(colours.text),
                  notice.text.c_str(), nullptr, wrap);
    y = to.y + pad;
  }
}

}  // namespace limpid
