#include "app/desktop/shell/dialogs.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <deque>
#include <memory>
#include <stdexcept>
#include <utility>

#include "app/base/folders.h"
#include "app/base/version.h"
#include "app/desktop/base/window_layout.h"
#include "app/desktop/device/identify_dialog.h"
#include "app/desktop/experiments/experiments_panel.h"
#include "app/desktop/experiments/new_sweep.h"
#include "app/desktop/experiments/sweep_panel.h"
#include "app/desktop/playback/mark_dialog.h"
#include "app/desktop/playback/session_dialog.h"
#include "app/desktop/playback/video_dialog.h"
#include "app/desktop/plots/export_dialog.h"
#include "app/desktop/plots/plot_chooser.h"
#include "app/desktop/scene/gallery.h"
#include "app/desktop/shell/command_keys.h"
#include "app/desktop/shell/commands.h"
#include "app/desktop/shell/desktop.h"
#include "app/desktop/shell/file_question.h"
#include "app/desktop/shell/named_dialog.h"
#include "app/desktop/shell/questions.h"
#include "app/desktop/shell/window.h"
#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "core/base/model_kinds.h"

namespace limpid {

namespace {

namespace fs = std::filesystem;

// Begins a text of `width` [em]; `height`: part of the window's, 0: as the text needs. Pairs with
// ImGui::End().
void begin_reading(const char* title, float width, float height, bool& open) {
  const ImVec2 room = ImGui::GetMainViewport()->WorkSize;
  ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {0.96f * room.x, 0.9f * room.y});
  ImGui::SetNextWindowSize(
      {std::min(width * ImGui::GetFontSize(), 0.96f * room.x), height * room.y});
  begin_dialog(title, open, ImGuiWindowFlags_NoResize);
  if (accepted()) open = false;
}

DrawDialog help(Desktop& d) {
  return [&d](bool& open, ScreenRect) { draw_help(open, *d.key_labels); };
}

DrawDialog messages(Desktop& d) {
  return [&d](bool& open, ScreenRect) { draw_messages(open, d.notices); };
}

DrawDialog about(Desktop&) {
  return [](bool& open, ScreenRect) { draw_about(open); };
}

DrawDialog experiments(Desktop& d) {
  return [&d, panel = std::make_shared<ExperimentsPanel>(d.notices)](bool& open, ScreenRect view) {
    const fs::path trial = panel->draw(open, view, d.live.stage().arm());
    d.experiments_under_way = panel->under_way();
    if (trial.empty()) return;
    open = false;
    d.playback.open(trial);
  };
}

DrawDialog sweep_map(Desktop& d) {
  return [&d](bool& open, ScreenRect) {
    const MapRequest request = draw_sweep_panel(d.sweep, d.playback, open);
    if (request.point) d.sweep.play(*request.point, request.at, d.playback);
    if (request.anew) d.dialog.open("new sweep");
  };
}

SweepBasis sweep_basis(Desktop& d) {
  return {.device = d.settings.device,
          .scene = d.document.file(),
          .why_not_scene = d.document.editor().dirty() || d.document.file().empty()
                               ? "The scene has changes that are not saved, but a sweep reads the "
                                 "scene from its file. Save the scene first (Ctrl+S)."
                               : "",
          .recording = d.playback.on() ? d.playback.shown()->file() : fs::path(),
          .parameters = d.tuning.edited()};
}

DrawDialog new_sweep(Desktop& d) {
  return [&d, dialog = std::make_shared<NewSweepDialog>(), started = false](bool& open,
                                                                            ScreenRect) mutable {
    dialog->draw(open, sweep_basis(d), d.sweep);
    // The map comes a frame after the dialog, whose end gives the focus to what was below it.
    if (std::exchange(started, false)) d.dialog.open("sweep");
    if (open && d.sweep.loading()) {
      started = true;
      open = false;
    }
  };
}

// Makes the chooser of a plot. A plot without channels is removed at its end.
DrawDialog plot_chooser(Desktop& d) {
  return [&d, chooser = std::make_shared<PlotChooser>()](bool& open, ScreenRect view) {
    std::vector<PlotChoice>& plots = d.settings.plot_choices;
    const std::size_t plot = d.plots.chosen();
    if (plot >= plots.size()) open = false;
    PlotChoice none;
    PlotChoice& choice = plot < plots.size() ? plots[plot] : none;
    const bool was_open = chooser->is_open();
    const bool remove = chooser->draw(open, choice, d.shown.stage().channels(), view);
    const bool closed = was_open && !open;
    if (remove || (closed && choice.channels.empty())) d.plots.remove(plot);
  };
}

DrawDialog sessions(Desktop& d) {
  return [&d, dialog = std::make_shared<SessionDialog>()](bool& open, ScreenRect) {
    bool elsewhere = false;
    const fs::path file = dialog->draw(open, elsewhere);
    if (elsewhere) d.dialog.open("find session");
    if (!file.empty()) d.world.open_files({file});
  };
}

DrawDialog gallery(Desktop& d) {
  return [&d, dialog = std::make_shared<Gallery>()](bool& open, ScreenRect) {
    if (const fs::path file = dialog->draw(open); !file.empty()) d.world.open_files({file});
  };
}

FileQuestion::Place place_of(const Desktop& d, fs::path first) {
  return {.first = std::move(first),
          .places = PathDialog::places({{"My scenes", scenes_dir()},
                                        {"My recordings", sessions_dir()},
                                        {"Scenes of Limpid", data_dir() / "assets/scenes"}},
                                       d.settings.recent),
          .own = d.settings.own_file_dialogs,
          .parent = window_for_portals()};
}

// Makes a dialog for a model, a scene or an arm, in the folder of the last one.
DrawDialog ask_for_file(Desktop& d, PathDialog::Options options,
                        void (*open_file)(Desktop&, const fs::path&)) {
  return [&d, open_file, question = std::make_shared<FileQuestion>(std::move(options))](
             bool& open, ScreenRect) {
    fs::path& folder = d.dialog.last_folder;
    if (folder.empty()) folder = data_dir() / "assets/scenes";
    const fs::path file = question->draw(open, [&] { return place_of(d, folder / ""); });
    if (file.empty()) return;
    folder = file.parent_path();
    open_file(d, file);
  };
}

DrawDialog add_model(Desktop& d) {
  PathDialog::Options options{.title = "Add model", .action = "Add", .extensions = {}};
  for (const ModelKind& each : kModelKinds) options.extensions.emplace_back(each.suffix);
  return ask_for_file(d, std::move(options), [](Desktop& desktop, const fs::path& file) {
    desktop.world.add_model(file);
  });
}

DrawDialog open_scene(Desktop& d) {
  return ask_for_file(
      d, {.title = "Open scene", .action = "Open", .extensions = {".toml"}},
      [](Desktop& desktop, const fs::path& file) { desktop.world.open_scene(file); });
}

// Makes a dialog for a recording, or a sweep's table.
DrawDialog find_session(Desktop& d) {
  return [&d,
          question = std::make_shared<FileQuestion>(PathDialog::Options{
              .title = "Find session", .action = "Open", .extensions = {".h5"}}),
          folder = sessions_dir()](bool& open, ScreenRect) mutable {
    const fs::path file = question->draw(open, [&] { return place_of(d, folder / ""); });
    if (file.empty()) return;
    folder = file.parent_path();
    d.world.open_files({file});
  };
}

DrawDialog open_arm(Desktop& d) {
  return ask_for_file(d, {.title = "Open arm", .action = "Open", .extensions = {".urdf", ".xacro"}},
                      [](Desktop& desktop, const fs::path& file) { desktop.world.open_arm(file); });
}

DrawDialog device_arm(Desktop& d) {
  return ask_for_file(d, {.title = "The device's arm", .action = "Take", .extensions = {".urdf"}},
                      [](Desktop& desktop, const fs::path& file) {
                        desktop.devices.say_arm({file.string(), ""});
                      });
}

DrawDialog arm_tip(Desktop& d) {
  return [&d, question = std::make_shared<TipQuestion>()](bool& open, ScreenRect) {
    if (!d.world.tips()) return;
    const TipsToChoose& choice = *d.world.tips();
    if (const std::string tip = question->draw(open, choice); !tip.empty()) {
      d.world.open_arm(choice.file, tip);
    }
  };
}

DrawDialog expand_xacro(Desktop& d) {
  return [&d](bool& open, ScreenRect) {
    if (d.world.xacro() && draw_xacro_question(open, d.world.xacro()->file)) d.world.expand_xacro();
  };
}

DrawDialog save_scene_as(Desktop& d) {
  const PathDialog::Options options{
      .title = "Save scene as", .action = "Save", .extensions = {".toml"}, .new_file = true};
  return [&d, question = std::make_shared<FileQuestion>(options)](bool& open, ScreenRect) {
    Document& document = d.document;
    const fs::path file = question->draw(open, [&] {
      const fs::path own = document.own_file();
      const fs::path name = fs::path(document.file()).filename();
      return place_of(d, own.empty() ? scenes_dir() / name : own);
    });
    if (!file.empty()) document.save_as(file);
  };
}

DrawDialog video(Desktop& d) {
  return [&d, dialog = std::make_shared<VideoDialog>()](bool& open, ScreenRect) {
    const auto order = dialog->draw(open, d.playback, d.settings.overlaid, d.settings.show_lens);
    if (order) d.playback.export_video(*order);
  };
}

DrawDialog export_as(Desktop& d) {
  // The plots stand still while it is open: what is exported is what was seen.
  return [&d, dialog = std::make_shared<ExportDialog>(), held = false](bool& open,
                                                                       ScreenRect) mutable {
    Stage& stage = d.shown.stage();
    if (open && stage.group.following()) {
      stage.group.set_following(false);
      held = true;
    } else if (!open && std::exchange(held, false)) {
      stage.group.set_following(true);
    }
    const auto order =
        dialog->draw(open, stage, d.exporter.plot(), sessions_dir(), d.playback.on());
    if (!order) return;
    if (order->what == ExportOrder::What::video) return d.dialog.open("video");
    const fs::path picture = d.exporter.carry_out(*order, stage);
    if (!picture.empty()) d.asked.picture = picture;
  };
}

DrawDialog mark(Desktop& d) {
  return [&d, dialog = std::make_shared<MarkDialog>()](bool& open, ScreenRect) {
    const MarkAnswer answer =
        dialog->draw(open, open ? d.marking.when() : "", d.marking.text(), d.marking.there());
    if (answer.text) d.marking.accept(*answer.text);
    if (answer.remove) d.marking.remove();
  };
}

// Makes a dialog of named texts: `use` takes a text by its name, `now` returns the present one.
DrawDialog named(Desktop& d, NamedTexts& texts, NamedDialog::Options options,
                 void (*use)(Desktop&, const std::string&), std::string (*now)(Desktop&)) {
  return [&d, &texts, use, now, dialog = std::make_shared<NamedDialog>(options)](bool& open,
                                                                                 ScreenRect) {
    const NamedDialog::Asked asked = dialog->draw(open, texts);
    if (asked.request == NamedDialog::Request::use) use(d, asked.name);
    if (asked.request == NamedDialog::Request::keep)
      dialog->complain(texts.keep(asked.name, now(d)));
  };
}

DrawDialog layout_list(Desktop& d) {
  return named(
      d, d.plots.layouts,
      {.title = "Layouts",
       .what = "layout",
       .help = "Each layout has a name and says which plots and panels the window shows."},
      [](Desktop& desktop, const std::string& name) { desktop.plots.use(name); },
      [](Desktop& desktop) { return layout_text(desktop.settings); });
}

DrawDialog preset_list(Desktop& d) {
  return named(
      d, d.tuning.presets,
      {.title = "Presets",
       .what = "preset",
       .help = "Each preset has a name and contains a coupling and its gains. With several runs, "
               "only the run that the sliders set is saved or changed. Ctrl+Z brings back the "
               "earlier settings."},
      [](Desktop& desktop, const std::string& name) { desktop.tuning.use_preset(name); },
      [](Desktop& desktop) { return preset_text(desktop.tuning.edited()); });
}

DrawDialog quit(Desktop& d) {
  return [&d](bool& open, ScreenRect) {
    draw_quit_question(open, [&d](std::string_view id) { run_or_say(id, d); });
  };
}

DrawDialog question(Desktop& d) {
  return [&d](bool& open, ScreenRect view) { d.question.draw(open, view); };
}

DrawDialog identify(Desktop& d) {
  return [&d, dialog = std::make_shared<IdentifyDialog>()](bool& open, ScreenRect) {
    dialog->draw(open, d.identify, d.settings.parameters().down, d.live.stage().arm());
  };
}

constexpr auto kViews = DialogKind::Keys::view;
constexpr auto kModal = DialogKind::Keys::modal;

constexpr std::array kDialogs{
    DialogKind{"help", kViews, help},
    DialogKind{"messages", kViews, messages},
    DialogKind{"about", kViews, about},
    DialogKind{"experiments", kViews, experiments},
    DialogKind{"sweep", kViews, sweep_map},
    DialogKind{"new sweep", kModal, new_sweep},
    DialogKind{"plot", DialogKind::Keys::typed, plot_chooser},
    DialogKind{"open session", kModal, sessions},
    DialogKind{"find session", kModal, find_session},
    DialogKind{"gallery", kModal, gallery},
    DialogKind{"add model", kModal, add_model},
    DialogKind{"open scene", kModal, open_scene},
    DialogKind{"open arm", kModal, open_arm},
    DialogKind{"device arm", kModal, device_arm},
    DialogKind{"arm tip", kModal, arm_tip},
    DialogKind{"expand xacro", kModal, expand_xacro},
    DialogKind{"save scene", kModal, save_scene_as},
    DialogKind{"video", kModal, video},
    DialogKind{"export", kModal, export_as},
    DialogKind{"mark", kModal, mark},
    DialogKind{"layouts", kModal, layout_list},
    DialogKind{"presets", kModal, preset_list},
    DialogKind{"identify", kModal, identify},
    DialogKind{"quit", kModal, quit},
    DialogKind{"ask", kModal, question},
};

}  // namespace

void draw_help(bool& open, const KeyLabels& labels) {
  if (!open) return;
  begin_reading("Keys and mouse", 46, 0.9f, open);
  ImGui::BeginChild("all", {0, -ImGui::GetFrameHeightWithSpacing()});
  if (ImGui::BeginTable("keys", 2)) {
    ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthFixed, 13 * ImGui::GetFontSize());
    std::string_view group;
    for (const Shortcut& shortcut : shortcuts(labels)) {
      if (std::exchange(group, shortcut.group) != shortcut.group) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        heading(std::string(group).c_str());
      }
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextWrapped("%s", shortcut.keys.c_str());
      ImGui::TableNextColumn();
      ImGui::TextWrapped("%s", shortcut.what.c_str());
    }
    ImGui::EndTable();
  }
  ImGui::EndChild();
  close_button("Close (Esc)", open);
  ImGui::End();
}

void draw_messages(bool& open, const Notices& notices) {
  if (!open) return;
  begin_reading("Messages", 46, 0.6f, open);
  ImGui::BeginChild("all", {0, -ImGui::GetFrameHeightWithSpacing()});
  if (notices.past().empty()) ImGui::TextDisabled("no messages since the start");
  std::string all;
  const std::deque<Notice>& past = notices.past();
  for (auto it = past.rbegin(); it != past.rend(); ++it) {
    const Notice& notice = *it;
    const std::time_t at = std::chrono::system_clock::to_time_t(notice.said);
    const std::string line = fmt::format("{:%H:%M:%S}  {}", fmt::localtime(at), notice.text);
    ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(notice.bad ? current_palette().broken
                                                                  : current_palette().text));
    ImGui::TextWrapped("%s", line.c_str());
    ImGui::PopStyleColor();
    all += line + "\n";
  }
  ImGui::EndChild();
  close_button("Close (Esc)", open);
  ImGui::SameLine();
  ImGui::BeginDisabled(all.empty());
  if (noted_button("Copy all")) ImGui::SetClipboardText(all.c_str());
  ImGui::EndDisabled();
  ImGui::End();
}

void draw_about(bool& open) {
  if (!open) return;
  begin_reading("About Limpid", 34, 0, open);
  ImGui::PushFont(font(Face::semibold));
  ImGui::Text("Limpid %s", program_version());
  ImGui::PopFont();
  ImGui::TextWrapped(
      "Touch a virtual world through a haptic device and see, tick by tick, how transparent the "
      "coupling between hand and world is.");
  ImGui::Spacing();
  ImGui::TextWrapped(
      "The proposed coupling comes from the paper \"Improving transparency of virtual coupling for "
      "haptic interaction with human force observer\". Numbers in parentheses are equations of "
      "this paper. Please cite the paper when you publish results that you measured with Limpid.");
  ImGui::Spacing();
  ImGui::TextWrapped(
      "Limpid uses GLFW, Dear ImGui, Eigen, GLM, tinygltf, assimp, Draco, HDF5, urdfdom and fmt. "
      "The font is Inter (SIL Open Font License).");
  close_button("Close (Esc)", open);
  ImGui::End();
}

std::span<const DialogKind> dialog_kinds() { return kDialogs; }

const DialogKind* find_dialog(std::string_view name) {
  const auto* found = std::ranges::find(kDialogs, name, &DialogKind::name);
  return found == kDialogs.end() ? nullptr : found;
}

void OpenDialog::open(std::string_view name) {
  kind_ = find_dialog(name);
  if (kind_ == nullptr) throw std::logic_error(fmt::format("There is no dialog \"{}\".", name));
}

Dialogs::Dialogs(Desktop& desktop) : desktop_(desktop) {
  for (const DialogKind& kind : kDialogs) drawn_.emplace_back(&kind, kind.make(desktop));
}

void Dialogs::draw(bool modal, ScreenRect view) {
  if (modal && desktop_.document.asking() && desktop_.dialog.modal()) desktop_.dialog.close();
  for (const auto& each : drawn_) {
    if (each.first->modal() != modal) continue;
    guard(desktop_.notices, [&] { draw(*each.first, each.second, view); });
  }
  if (modal) guard(desktop_.notices, [this] { draw_question(); });
}

// Closes the dialog even if its work throws, but not if that has opened another one.
void Dialogs::draw(const DialogKind& kind, const DrawDialog& draw_it, ScreenRect view) {
  struct Closing {
    ~Closing() {
      if (was_open && !open && desktop.dialog.kind() == &kind) desktop.dialog.close();
    }
    Desktop& desktop;
    const DialogKind& kind;
    bool was_open, open;
  };
  const bool is_open = desktop_.dialog.kind() == &kind;
  Closing closing{desktop_, kind, is_open, is_open};
  draw_it(closing.open, view);
}

void Dialogs::draw_question() {
  Document& document = desktop_.document;
  bool asking = document.asking();
  draw_unsaved_question(asking, !document.own_file().empty(),
                        [this](std::string_view id) { run_or_say(id, desktop_); });
  if (!asking) document.stay();
}

}  // namespace limpid
