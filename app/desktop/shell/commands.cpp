#include "app/desktop/shell/commands.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/base/dated_file.h"
#include "app/base/folders.h"
#include "app/base/open_elsewhere.h"
#include "app/desktop/base/passivity_break.h"
#include "app/desktop/shell/desktop.h"
#include "app/style/sliders.h"
#include "app/style/theme.h"
#include "devices/files/urdf_file.h"

namespace limpid {
namespace {

template <bool Settings::*kShown>
bool is_shown(const Desktop& d) {
  return d.settings.*kShown;
}

template <bool Settings::*kShown>
void show_or_hide(Desktop& d) {
  d.settings.*kShown = !(d.settings.*kShown);
}

// Changes a setting by a step of its slider.
void step_setting(Desktop& d, const char* key, int direction) {
  Parameters& p = d.tuning.edited();
  const ParameterInfo& info = *find_parameter(key);
  const double usual = parameter_number(Parameters{}, info);
  set_parameter_number(p, info, slider_step(info, parameter_number(p, info), usual, direction));
  const LawInfo& law = limpid::info(p.kind);
  const bool of_law = std::string_view(key).starts_with("coupling.") ||
                      std::string_view(key).starts_with("observer.");
  if (of_law && !law.has(key)) {
    d.notices.say_once(fmt::format("{} is {:.3g} now. The law {} does not use this setting.",
                                   info.caption, parameter_number(p, info), law.label),
                       false);
  }
}

void show_or_close(Desktop& d, const char* dialog) {
  d.dialog.name() == dialog ? d.dialog.close() : d.dialog.open(dialog);
}

void show_sweep(Desktop& d) {
  const bool there = d.sweep.sweep() != nullptr || d.sweep.loading();
  if (!there) d.tuning.end_break();  // its settings are not the present ones of a sweep
  show_or_close(d, there ? "sweep" : "new sweep");
}

template <Theme kTheme>
void choose_theme(Desktop& d) {
  d.settings.theme = kTheme;
}

template <Theme kTheme>
bool has_theme(const Desktop& d) {
  return d.settings.theme == kTheme;
}

template <std::size_t kSize>
void choose_text_size(Desktop& d) {
  d.settings.text_size = kTextSizes[kSize];
}

template <std::size_t kSize>
bool has_text_size(const Desktop& d) {
  return d.settings.text_size == kTextSizes[kSize];
}

void larger_text(Desktop& d) {
  const auto* next = std::ranges::upper_bound(kTextSizes, d.settings.text_size);
  if (next != kTextSizes.end()) d.settings.text_size = *next;
}

void smaller_text(Desktop& d) {
  const auto* present = std::ranges::lower_bound(kTextSizes, d.settings.text_size);
  if (present != kTextSizes.begin()) d.settings.text_size = *(present - 1);
}

void freeze_plots(Desktop& d) {
  PlotGroup& group = d.shown.stage().group;
  group.set_following(!group.following());
}

// Goes on to the next panel, and behind the last one back to the view; Frame passes over those that
// are not shown.
void lead_panel(Desktop& d) {
  const auto next = static_cast<int>(d.led_panel) + 1;
  d.led_panel =
      next > static_cast<int>(LedPanel::right) ? LedPanel::none : static_cast<LedPanel>(next);
}

Command::Label force_label(const Desktop& d) {
  return d.live.force_armed() ? Command::Label{"Force off", "Esc"}
                              : Command::Label{"Force on", nullptr};
}

Command::Label record_label(const Desktop& d) {
  return {d.live.recording() ? "Stop recording" : "Record", nullptr};
}

Player& player(Desktop& d) { return d.playback.shown()->player(); }

// Saves the scene, or asks for a name if it has no file of the user's own: shipped scenes stay as
// they are.
void save_scene_here(Desktop& d) {
  const std::filesystem::path own = d.document.own_file();
  own.empty() ? d.dialog.open("save scene") : void(d.document.save_as(own));
}

void save_and_leave(Desktop& d) {
  const std::filesystem::path own = d.document.own_file();
  if (own.empty()) {
    // Leaving is up to the user then, who may give up the dialog.
    d.document.stay();
    d.dialog.open("save scene");
  } else if (d.document.save_as(own)) {
    d.document.leave_now();
  }
}

void look_at_selected(Desktop& d) {
  const Bounds box = d.document.selected_bounds();
  d.shown.keep_view();
  d.shown.camera.frame(box.isEmpty() ? d.live.stage().picture.bounds() : box);
}

void play_or_pause(Desktop& d) {
  if (d.playback.on()) {
    d.playback.toggle_playing();
  } else if (!d.playback.last().empty()) {
    d.playback.open(d.playback.last());
  } else {
    d.dialog.open("open session");
  }
}

void end_recording_and_quit(Desktop& d) {
  d.live.stop_recording();
  d.recording_may_end = d.asked.close = true;
}

// A step that is the present arm's goes with it.
void open_ideal(Desktop& d) {
  double& step = d.settings.parameters().encoder_step;
  if (step == d.live.stage().arm().encoder_step) step = 0;
  d.world.open_arm(default_device());
}

void open_touch(Desktop& d) {
  const std::filesystem::path file = data_dir() / "assets/devices/touch.urdf";
  d.settings.parameters().encoder_step = read_urdf(file).encoder_step;
  d.world.open_arm(file);
  d.notices.say("A Touch has 52 g at the tip, friction of 0.26 N and encoder steps of 0.42 mrad.");
}

void open_manual(Desktop& d) {
  const std::filesystem::path file = manual_file();
  if (file.empty()) return d.notices.say("The manual was not found. Install Limpid again.", true);
  if (open_elsewhere(file)) return d.notices.say("Opening the manual in the browser");
  d.notices.say(
      fmt::format("No program on this computer opens web pages. The manual is the file {}",
                  file.string()),
      true);
}

// Exports the plot under the mouse, or the one exported last.
void begin_export(Desktop& d) {
  const std::vector<Plot>& plots = d.shown.stage().plots;
  const ImVec2 mouse = ImGui::GetMousePos();
  const auto under =
      std::ranges::find_if(plots, [&](const Plot& plot) { return plot.area().contains(mouse); });
  d.exporter.begin(under != plots.end() ? static_cast<std::size_t>(under - plots.begin())
                                        : d.exporter.plot());
}

std::string no_live_recording(const Desktop& d) {
  return d.live.recording() ? "" : "Nothing is being recorded.";
}

void play_story(Desktop& d) {
  d.settings.hint_seen = true;
  d.playback.open_story();
}

void toggle_your_turn(Desktop& d) {
  d.playback.close();
  d.settings.your_turn = !d.settings.your_turn;
}

std::string no_recording(const Desktop& d) {
  return d.playback.on() ? "" : "Open a recording first (Ctrl+O).";
}

std::string no_table(const Desktop& d) {
  if (!d.playback.on()) return no_recording(d);
  return d.playback.exporting() ? "The last table is still being written." : "";
}

std::string no_video(const Desktop& d) {
  if (!d.playback.on()) return no_recording(d);
  return d.playback.video().busy() ? "The last video is still being made." : "";
}

std::string in_playback(const Desktop& d) {
  return d.playback.on() ? "Go back to live first (Backspace)." : "";
}

std::string no_question(const Desktop& d) {
  return d.document.asking() ? ""
                             : "This command answers the question about unsaved changes. That "
                               "question is not open now.";
}

std::string nothing_kept(const Desktop& d) {
  return d.kept.any() ? "" : "There is no automatically saved scene.";
}

std::string nothing_written(const Desktop& d) {
  return d.exporter.written().empty() ? "Nothing was exported recently." : "";
}

std::string nothing_recovered(const Desktop& d) {
  return d.playback.recovered().empty() ? "Nothing was recovered." : "";
}

std::string nothing_selected(const Desktop& d) {
  return d.document.editor().selected() ? "" : "Select an object of the scene first (Tab).";
}

std::string selection_fixed(const Desktop& d) {
  const std::string why = nothing_selected(d);
  return why.empty() ? d.document.why_fixed() : why;
}

template <TransformKind kKind>
void begin_transform(Desktop& d) {
  d.transform.begin(kKind);
}

template <TransformKind kKind>
std::string cannot(const Desktop& d) {
  std::string why = selection_fixed(d);
  if (why.empty() && d.settings.lanes.count > 1 && !d.settings.overlaid) {
    return "Runs are shown side by side. To change objects in the picture, show the runs in one "
           "picture (menu View), or end the second run (B).";
  }
  if (!why.empty() || can(kKind, *d.document.editor().selected_object())) return why;
  return "This object cannot be changed in that way.";
}

std::string why_no_more_runs(const Desktop& d) {
  const std::string why = d.live.why_lanes_are_fixed();
  return why.empty() && d.settings.lanes.count == kMostLanes
             ? "At most three runs are possible at the same time. Ctrl+Shift+B ends one of them."
             : why;
}

std::string why_no_fewer_runs(const Desktop& d) {
  const std::string why = d.live.why_lanes_are_fixed();
  return why.empty() && d.settings.lanes.count == 1
             ? "There is only one run, and it cannot be ended. B starts a second run."
             : why;
}

std::string no_virtual_arm(const Desktop& d) {
  return d.live.loop().device_in_place()
             ? "A real device is used instead of the virtual arm. Choose the virtual arm first."
             : "";
}

std::string no_magnet(const Desktop& d) {
  const std::string playback = in_playback(d);
  return playback.empty() ? d.live.why_no_magnet() : playback;
}

std::string time_fixed(const Desktop& d) {
  const std::string playback = in_playback(d);
  return playback.empty() ? d.live.why_time_is_fixed() : playback;
}

std::string not_paused(const Desktop& d) {
  return d.live.paused() ? "" : "Pause the simulation first (K).";
}

std::string not_broken(const Desktop& d) {
  return passivity_broken(d.settings) ? "" : "Passivity is not broken.";
}

std::string no_chatter(const Desktop& d) {
  return d.chatter.found() ? "" : "The loop does not chatter.";
}

std::string may_not_break(const Desktop& d) {
  const std::string why = no_virtual_arm(d);
  return why.empty() ? in_playback(d) : why;
}

constexpr Command row(const char* id, const char* text, const char* menu, const char* keys,
                      const char* help, void (*run)(Desktop&), Command::How how = {}) {
  return {id, text, menu, keys, help, run, how};
}

// Columns: id, text, menu, keys, help. Commands that may be needed at once come first; a menu has
// its commands in this order.
constexpr std::array kCommands{
    row("force.cut", "Force off at once", nullptr, "Space",
        "switches the force off at once; in playback without a real device: play or pause",
        [](Desktop& d) { d.cut_or_play(); }, {.reach = Reach::all_but_text, .blind = true}),
    row("window.escape", "Close what is open, or force off", nullptr, "Esc",
        "closes what is open, then cancels the selection, then ends the playback; if nothing is "
        "open, and always with a real device, switches the force off",
        [](Desktop& d) { d.escape(); }, {.reach = Reach::all, .blind = true}),
    row("arm.open", "Open arm (URDF)...", "Device", nullptr, nullptr,
        [](Desktop& d) { d.dialog.open("open arm"); }, {.why_not = no_virtual_arm}),
    row("arm.built_in", "Built-in arm, ideal", "Device", nullptr, nullptr, open_ideal,
        {.checked = [](const Desktop& d) { return d.world.built_in_arm(); }}),
    row("arm.touch", "As real as a Touch", "Device", nullptr, nullptr, open_touch,
        {.why_not = no_virtual_arm}),
    row("device.identify", "Identify...", "Device", "F7",
        "identify the device: its motors move it, and Limpid finds inertia, friction and delay",
        [](Desktop& d) { show_or_close(d, "identify"); }),
    row("device.force", "Force on or off", "Device", "F", "force on or off",
        [](Desktop& d) { d.toggle_force(); }, {.apart = true, .now = force_label, .blind = true}),
    row("hand.magnet", "Magnet at the tip", "Device", "H",
        "magnet at the tip: picks up an object that the tip touches, or lets it go",
        [](Desktop& d) { d.live.toggle_magnet(); },
        {.why_not = no_magnet,
         .checked = [](const Desktop& d) { return d.live.controls().magnet; },
         .blind = true}),
    row("device.start_over", "Start over", "Device", "Backspace", "start over",
        [](Desktop& d) { d.live.start_over(); }, {.why_not = in_playback}),
    row("coupling.next", "Next coupling law", nullptr, "C", "the next coupling law",
        [](Desktop& d) { d.tuning.next_law(); }),
    row("coupling.smaller_eta", "Smaller impedance scaling, eta", nullptr, "[",
        "smaller or larger impedance scaling, eta",
        [](Desktop& d) { step_setting(d, "coupling.eta", -1); }, {.repeats = true}),
    row("coupling.larger_eta", "Larger impedance scaling, eta", nullptr, "]", "",
        [](Desktop& d) { step_setting(d, "coupling.eta", 1); }, {.repeats = true}),
    row("observer.smaller_alpha", "Smaller observer gain, alpha", nullptr, "Shift+[",
        "smaller or larger observer gain, alpha",
        [](Desktop& d) { step_setting(d, "observer.alpha", -1); }, {.repeats = true}),
    row("observer.larger_alpha", "Larger observer gain, alpha", nullptr, "Shift+]", "",
        [](Desktop& d) { step_setting(d, "observer.alpha", 1); }, {.repeats = true}),
    row("coupling.softer", "Softer coupling spring, k_vc", nullptr, "Ctrl+[",
        "softer or stiffer coupling spring, k_vc",
        [](Desktop& d) { step_setting(d, "coupling.k_vc", -1); }, {.repeats = true}),
    row("coupling.stiffer", "Stiffer coupling spring, k_vc", nullptr, "Ctrl+]", "",
        [](Desktop& d) { step_setting(d, "coupling.k_vc", 1); }, {.repeats = true}),
    row("hand.softer", "Softer grip", nullptr, "Alt+[", "softer or stiffer grip",
        [](Desktop& d) { step_setting(d, "hand.stiffness", -1); }, {.repeats = true}),
    row("hand.stiffer", "Stiffer grip", nullptr, "Alt+]", "",
        [](Desktop& d) { step_setting(d, "hand.stiffness", 1); }, {.repeats = true}),
    row("coupling.break_passivity", "Break passivity", nullptr, nullptr, nullptr,
        [](Desktop& d) { d.tuning.break_passivity(); }, {.why_not = may_not_break}),
    row("coupling.end_break", "End broken passivity", nullptr, nullptr, nullptr,
        [](Desktop& d) { d.tuning.end_break(); }, {.why_not = not_broken}),
    row("coupling.mend_chatter", "Take the predictive law against chatter", nullptr, nullptr,
        nullptr, [](Desktop& d) { d.chatter.take_predictive(); }, {.why_not = no_chatter}),
    row("coupling.forget_chatter", "Hide the message about chatter", nullptr, nullptr, nullptr,
        [](Desktop& d) { d.chatter.forget(); }, {.why_not = no_chatter}),
    row("scene.soften_wall", "Soften the wall so that it does not chatter", nullptr, nullptr,
        nullptr, [](Desktop& d) { d.chatter.soften_wall(); }, {.why_not = no_chatter}),
    row("scene.new", "New scene", "File", "Ctrl+N", "a new scene; open one",
        [](Desktop& d) { d.world.new_scene(); }),
    row("scene.open", "Open scene...", "File", "Ctrl+Shift+O", "",
        [](Desktop& d) { d.dialog.open("open scene"); }),
    row("session.open", "Open session or sweep...", "File", "Ctrl+O", "open a recording or a sweep",
        [](Desktop& d) { d.dialog.open("open session"); }),
    row("scene.add_model", "Add model...", "File", "Ctrl+M",
        "add a model, or drop a model file here", [](Desktop& d) { d.dialog.open("add model"); }),
    row("scene.save", "Save scene", "File", "Ctrl+S", "save the scene; under another name",
        save_scene_here),
    row("scene.save_as", "Save scene as...", "File", "Ctrl+Shift+S", "",
        [](Desktop& d) { d.dialog.open("save scene"); }),
    row("export.begin", "Export...", "File", "Ctrl+E",
        "export a plot, a table, a picture or a video", begin_export, {.apart = true}),
    row("export.open", "Open the exported file", nullptr, nullptr, nullptr,
        [](Desktop& d) { d.exporter.open_written(); }, {.why_not = nothing_written}),
    row("export.show", "Show the exported file in its folder", nullptr, nullptr, nullptr,
        [](Desktop& d) { d.exporter.show_written(); }, {.why_not = nothing_written}),
    row("session.forget_recovered", "Hide the line about the recovery", nullptr, nullptr, nullptr,
        [](Desktop& d) { d.playback.forget_recovered(); }, {.why_not = nothing_recovered}),
    row("export.forget", "Hide the line about the export", nullptr, nullptr, nullptr,
        [](Desktop& d) { d.exporter.forget(); }, {.why_not = nothing_written}),
    row("window.save_picture", "Save picture", "File", "F12", "save a picture of the window",
        [](Desktop& d) { d.asked.picture = dated_file(sessions_dir(), "limpid", "png"); }),
    row("edit.undo", "Undo", "Edit", "Ctrl+Z", "undo",
        [](Desktop& d) { d.marking.can_undo() ? d.marking.undo() : d.document.undo(); },
        {.repeats = true}),
    row("edit.redo", "Redo", "Edit", "Ctrl+Y, Ctrl+Shift+Z", "redo",
        [](Desktop& d) { d.marking.can_redo() ? d.marking.redo() : d.document.redo(); },
        {.repeats = true}),
    row("object.move", "Move", "Edit", "G",
        "selected object: move, turn or scale it with the mouse, or by a number, for example G X 2 "
        "5 Enter",
        begin_transform<TransformKind::move>,
        {.apart = true, .reach = Reach::selection, .why_not = cannot<TransformKind::move>}),
    row("object.turn", "Turn", "Edit", "R", "", begin_transform<TransformKind::turn>,
        {.reach = Reach::selection, .why_not = cannot<TransformKind::turn>}),
    row("object.scale", "Scale", "Edit", "S", "", begin_transform<TransformKind::scale>,
        {.reach = Reach::selection, .why_not = cannot<TransformKind::scale>}),
    row("object.along_x", "Along x alone", nullptr, "X",
        "during such a change: only along one axis; Ctrl: in whole steps; click or Enter accepts "
        "the change, Esc cancels it",
        [](Desktop& d) { d.transform.lock(0); }, {.reach = Reach::transform}),
    row("object.along_y", "Along y alone", nullptr, "Y", "",
        [](Desktop& d) { d.transform.lock(1); }, {.reach = Reach::transform}),
    row("object.along_z", "Along z alone", nullptr, "Z", "",
        [](Desktop& d) { d.transform.lock(2); }, {.reach = Reach::transform}),
    row("object.accept", "Keep the object as it is now", nullptr, "Enter, Keypad Enter", "",
        [](Desktop& d) { d.transform.accept(); }, {.reach = Reach::transform}),
    row("scene.copy", "Copy selected object", "Edit", "Ctrl+D",
        "copy or remove the selected object", [](Desktop& d) { d.document.duplicate_selected(); },
        {.apart = true, .why_not = selection_fixed}),
    row("scene.remove", "Remove selected object", "Edit", "Delete", "",
        [](Desktop& d) { d.document.remove_selected(); }, {.why_not = selection_fixed}),
    row("settings.reset", "Reset the settings of the loop", "Edit", nullptr, nullptr,
        [](Desktop& d) { d.tuning.reset(); }),
    row("settings.presets", "Save, rename...", "Edit/Presets of settings", "Ctrl+P",
        "presets of settings", [](Desktop& d) { d.dialog.open("presets"); }, {.apart = true}),
    row("window.quit", "Quit", "File", "Ctrl+Q", "quit", [](Desktop& d) { d.asked.close = true; },
        {.apart = true}),
    row("window.end_recording_and_quit", "End the recording and quit", nullptr, nullptr, nullptr,
        end_recording_and_quit, {.why_not = no_live_recording, .blind = true}),
    row("view.left_panel", "Coupling panel", "View", "F2", "coupling panel, device panel, plots",
        show_or_hide<&Settings::show_left>, {.checked = is_shown<&Settings::show_left>}),
    row("view.right_panel", "Device panel", "View", "F3", "", show_or_hide<&Settings::show_right>,
        {.checked = is_shown<&Settings::show_right>}),
    row("view.plots", "Plots", "View", "F4", "", show_or_hide<&Settings::show_plots>,
        {.checked = is_shown<&Settings::show_plots>}),
    row("view.everything", "All settings and figures", "View", "F8",
        "all settings and figures, or only what a beginner needs",
        [](Desktop& d) { show_everything(d.settings, !d.settings.everything); },
        {.checked = is_shown<&Settings::everything>}),
    row("plots.add", "Add a plot...", "View/Plots of", "N",
        "a new plot of any channel: against time, against another channel, or its spectrum",
        [](Desktop& d) { d.plots.add(); }, {.apart = true}),
    row("plots.layouts", "Save, rename...", "View/Layouts", "Ctrl+L", "layouts of plots and panels",
        [](Desktop& d) { d.dialog.open("layouts"); }, {.apart = true}),
    row("plots.freeze", "Freeze or follow the plots", nullptr, "X", "stop or continue the plots",
        freeze_plots),
    row("view.ghost", "Ghost of the device", "View", "G", "ghost of the device, lens at the tip",
        show_or_hide<&Settings::show_ghost>,
        {.apart = true, .checked = is_shown<&Settings::show_ghost>}),
    row("view.lens", "Lens at the tip, x5", "View", "M", "", show_or_hide<&Settings::show_lens>,
        {.checked = is_shown<&Settings::show_lens>}),
    row("view.trail", "Trail", "View", nullptr, nullptr, show_or_hide<&Settings::show_trail>,
        {.checked = is_shown<&Settings::show_trail>}),
    row("view.forces", "Forces", "View", nullptr, nullptr, show_or_hide<&Settings::show_forces>,
        {.checked = is_shown<&Settings::show_forces>}),
    row("view.grid", "Floor grid", "View", nullptr, nullptr, show_or_hide<&Settings::show_grid>,
        {.checked = is_shown<&Settings::show_grid>}),
    row("view.joints", "Axes of the joints", "View", nullptr, nullptr,
        show_or_hide<&Settings::show_joints>, {.checked = is_shown<&Settings::show_joints>}),
    row("view.overlay", "All runs in one picture", "View", "Shift+B",
        "several couplings in one picture", show_or_hide<&Settings::overlaid>,
        {.checked = is_shown<&Settings::overlaid>}),
    row("view.front", "Front", "View", "1", "front, side, top view; reset the camera",
        [](Desktop& d) { d.shown.look(Camera::View::front); }, {.apart = true, .blind = true}),
    row("view.side", "Side", "View", "2", "", [](Desktop& d) { d.shown.look(Camera::View::side); },
        {.blind = true}),
    row("view.top", "Top", "View", "3", "", [](Desktop& d) { d.shown.look(Camera::View::top); },
        {.blind = true}),
    row("view.reset", "Reset camera", "View", "0, Home", "",
        [](Desktop& d) { d.shown.reset_view(); }, {.blind = true}),
    row("view.dark", "dark", "View/Theme", nullptr, nullptr, choose_theme<Theme::dark>,
        {.checked = has_theme<Theme::dark>, .blind = true}),
    row("view.light", "light", "View/Theme", nullptr, nullptr, choose_theme<Theme::light>,
        {.checked = has_theme<Theme::light>, .blind = true}),
    row("view.contrast", "high contrast", "View/Theme", nullptr, nullptr,
        choose_theme<Theme::contrast>, {.checked = has_theme<Theme::contrast>, .blind = true}),
    row("view.text.larger", "Larger", "View/Text size", "Ctrl++, Ctrl+=, Ctrl+Keypad +",
        "larger text, smaller text, usual text", larger_text, {.blind = true}),
    row("view.text.smaller", "Smaller", "View/Text size", "Ctrl+-, Ctrl+Keypad -", "", smaller_text,
        {.blind = true}),
    row("view.text.usual", "100 %", "View/Text size", "Ctrl+0", "", choose_text_size<0>,
        {.apart = true, .checked = has_text_size<0>, .blind = true}),
    row("view.text.large", "125 %", "View/Text size", nullptr, nullptr, choose_text_size<1>,
        {.checked = has_text_size<1>, .blind = true}),
    row("view.text.very_large", "150 %", "View/Text size", nullptr, nullptr, choose_text_size<2>,
        {.checked = has_text_size<2>, .blind = true}),
    row("view.text.largest", "200 %", "View/Text size", nullptr, nullptr, choose_text_size<3>,
        {.checked = has_text_size<3>, .blind = true}),
    row("view.own_file_dialogs", "Limpid's own file dialogs", "View", nullptr, nullptr,
        show_or_hide<&Settings::own_file_dialogs>,
        {.checked = is_shown<&Settings::own_file_dialogs>}),
    row("view.quality.automatic", "automatic", "View/Picture quality", nullptr, nullptr,
        [](Desktop& d) { d.settings.picture_quality = "automatic"; },
        {.checked = [](const Desktop& d) { return d.settings.picture_quality == "automatic"; }}),
    row("view.quality.high", "high", "View/Picture quality", nullptr, nullptr,
        [](Desktop& d) { d.settings.picture_quality = "high"; },
        {.checked = [](const Desktop& d) { return d.settings.picture_quality == "high"; }}),
    row("view.quality.medium", "medium", "View/Picture quality", nullptr, nullptr,
        [](Desktop& d) { d.settings.picture_quality = "medium"; },
        {.checked = [](const Desktop& d) { return d.settings.picture_quality == "medium"; }}),
    row("view.quality.low", "low", "View/Picture quality", nullptr, nullptr,
        [](Desktop& d) { d.settings.picture_quality = "low"; },
        {.checked = [](const Desktop& d) { return d.settings.picture_quality == "low"; }}),
    row("window.menu", "Menus", nullptr, "F10", "the menus: arrows, Enter, Esc",
        [](Desktop& d) { d.asked.menu = true; }),
    row("window.panels", "Keys in the panels", nullptr, "Ctrl+Tab",
        "go to a panel by keyboard (arrows, Enter, Esc); press again for the next panel",
        lead_panel, {.reach = Reach::panel}),
    row("window.full_screen", "Full screen", "View", "F11", "full screen",
        [](Desktop& d) { d.asked.toggle_full_screen = true; },
        {.checked = [](const Desktop& d) { return d.full_screen; }, .blind = true}),
    row("session.record", "Record", "Session", "R, Ctrl+R", "record, stop recording",
        [](Desktop& d) { d.world.toggle_recording(); }, {.now = record_label}),
    row("session.play", "Play or pause", "Session", "P", "play, pause", play_or_pause),
    row("session.mark", "Set a mark...", "Session", "T",
        "set a mark under the mouse in a plot, or at the present time; in playback: go to the "
        "previous or the next mark",
        [](Desktop& d) { d.marking.begin(); }),
    row("session.mark_before", "Go to the previous mark", nullptr, "Ctrl+Left", "",
        [](Desktop& d) { d.marking.go(-1); },
        {.reach = Reach::playback, .repeats = true, .why_not = no_recording}),
    row("session.mark_after", "Go to the next mark", nullptr, "Ctrl+Right", "",
        [](Desktop& d) { d.marking.go(1); },
        {.reach = Reach::playback, .repeats = true, .why_not = no_recording}),
    row("session.twin", "Twin: two couplings on one hand", "Session", "B",
        "twin: a second coupling runs beside the first, moved by the same hand",
        [](Desktop& d) { d.tuning.toggle_twin(); },
        {.why_not = [](const Desktop& d) { return d.live.why_lanes_are_fixed(); },
         .checked = [](const Desktop& d) { return d.settings.lanes.count > 1; }}),
    row("session.add_run", "One more run with the same hand", "Session", "Ctrl+B",
        "one more coupling on the same hand, at most three in all",
        [](Desktop& d) { d.tuning.add_lane(); }, {.why_not = why_no_more_runs}),
    row("session.drop_run", "One run less", "Session", "Ctrl+Shift+B",
        "end the last of several runs on the same hand", [](Desktop& d) { d.tuning.drop_lane(); },
        {.why_not = why_no_fewer_runs}),
    row("loop.pause", "Pause the simulation", "Session", "K",
        "pauses the simulation; while paused: steps by one tick, by ten ticks",
        [](Desktop& d) { d.live.pause(!d.live.paused()); },
        {.why_not = time_fixed, .checked = [](const Desktop& d) { return d.live.paused(); }}),
    row("loop.step", "Forward by a tick", nullptr, "Right", "", [](Desktop& d) { d.live.step(1); },
        {.repeats = true, .why_not = not_paused}),
    row("loop.step_ten", "Forward by ten ticks", nullptr, "Shift+Right", "",
        [](Desktop& d) { d.live.step(10); }, {.repeats = true, .why_not = not_paused}),
    row("session.tick_back", "Step back by a tick", nullptr, "Left", "in playback: step by a tick",
        [](Desktop& d) { player(d).step(-1); },
        {.reach = Reach::playback, .repeats = true, .why_not = no_recording}),
    row("session.tick_on", "Step forward by one tick", nullptr, "Right", "",
        [](Desktop& d) { player(d).step(1); },
        {.reach = Reach::playback, .repeats = true, .why_not = no_recording}),
    row("session.step_back", "Step back by 0.1 s", nullptr, "Shift+Left",
        "in playback: step by 0.1 s", [](Desktop& d) { player(d).step(-100); },
        {.reach = Reach::playback, .repeats = true, .why_not = no_recording}),
    row("session.step_on", "Step forward by 0.1 s", nullptr, "Shift+Right", "",
        [](Desktop& d) { player(d).step(100); },
        {.reach = Reach::playback, .repeats = true, .why_not = no_recording}),
    row("session.to_the_beginning", "To the beginning", nullptr, "Home",
        "in playback: to the beginning, loop, re-run, write a video",
        [](Desktop& d) { player(d).seek(0); }, {.reach = Reach::playback, .why_not = no_recording}),
    row("session.loop", "Begin again at the end", nullptr, "L", "",
        [](Desktop& d) { player(d).loop = !player(d).loop; },
        {.reach = Reach::playback, .why_not = no_recording}),
    row("session.rerun", "Re-run under present settings", "Session", "E", "",
        [](Desktop& d) { d.playback.start_rerun(d.tuning.edited()); },
        {.reach = Reach::playback, .why_not = no_recording}),
    row("session.write_table", "Write as table (CSV)", "Session", nullptr, nullptr,
        [](Desktop& d) { d.playback.export_csv(); }, {.why_not = no_table}),
    row("session.write_video", "Write as video...", "Session", "V", "",
        [](Desktop& d) { d.dialog.open("video"); },
        {.reach = Reach::playback, .why_not = no_video}),
    row("session.back_to_live", "Back to live", "Session", "Backspace", "in playback: back to live",
        [](Desktop& d) { d.playback.close(); },
        {.reach = Reach::playback, .why_not = no_recording}),
    row("experiments.show", "Experiments of the paper...", "Session", "F5",
        "the paper's experiments; the map of the sweep, or a new sweep",
        [](Desktop& d) { show_or_close(d, "experiments"); }, {.apart = true}),
    row("sweep.show", "Map of the sweep", "Session", "F6", "", show_sweep),
    row("sweep.begin", "New sweep...", "Session", nullptr, nullptr,
        [](Desktop& d) { d.dialog.open("new sweep"); }),
    row("scene.gallery", "Gallery...", "Scene", "Ctrl+G", "gallery of scenes",
        [](Desktop& d) { d.dialog.open("gallery"); }),
    row("scene.select_next", "Select the next object", nullptr, "Tab",
        "select the next or the previous object of the scene",
        [](Desktop& d) { d.document.editor().select_next(1); }, {.repeats = true}),
    row("scene.select_previous", "Select the object before", nullptr, "Shift+Tab", "",
        [](Desktop& d) { d.document.editor().select_next(-1); }, {.repeats = true}),
    row("scene.look", "Look at the selected object", "View", ".", nullptr, look_at_selected,
        {.why_not = nothing_selected}),
    row("scene.save_and_leave", "Save the changes and go on", nullptr, "Enter, Keypad Enter",
        nullptr, save_and_leave, {.reach = Reach::question, .why_not = no_question}),
    row("scene.discard_and_leave", "Discard the changes and go on", nullptr, "D", nullptr,
        [](Desktop& d) { d.document.discard_and_leave(); },
        {.reach = Reach::question, .why_not = no_question, .blind = true}),
    row("scene.open_kept", "Open the automatically saved scene", nullptr, nullptr, nullptr,
        [](Desktop& d) { d.world.open_scene(d.kept.take()); }, {.why_not = nothing_kept}),
    row("scene.leave_kept", "Leave the automatically saved scene in the gallery", nullptr, nullptr,
        nullptr, [](Desktop& d) { d.kept.leave(); }, {.why_not = nothing_kept}),
    row("scene.discard_kept", "Discard the automatically saved scene", nullptr, nullptr, nullptr,
        [](Desktop& d) { d.kept.discard(); }, {.why_not = nothing_kept}),
    row("help.manual", "Manual", "Help", nullptr, nullptr, open_manual),
    row("help.story", "Play the story", "Help", nullptr, nullptr, play_story),
    row("help.your_turn", "Your turn: what to try", "Help", nullptr, nullptr, toggle_your_turn,
        {.checked = is_shown<&Settings::your_turn>}),
    row("help.keys", "Keys and mouse", "Help", "?, F1", "this list",
        [](Desktop& d) { show_or_close(d, "help"); }),
    row("help.messages", "Messages so far", "Help", nullptr, nullptr,
        [](Desktop& d) { show_or_close(d, "messages"); }),
    row("help.about", "About Limpid", "Help", nullptr, nullptr,
        [](Desktop& d) { d.dialog.open("about"); }),
};

}  // namespace

std::span<const Command> commands() { return kCommands; }

const Command* find_command(std::string_view id) {
  const auto* found = std::ranges::find(kCommands, id, &Command::id);
  return found == kCommands.end() ? nullptr : found;
}

std::string why_not(const Command& command, const Desktop& desktop, Asker who) {
  if (desktop.blind && who == Asker::person && !command.how.blind) {
    return "A program that is connected to Limpid hides law, settings and plots. They come back at "
           "the latest when that program ends.";
  }
  return command.how.why_not != nullptr ? command.how.why_not(desktop) : std::string();
}

std::string run_command(std::string_view id, Desktop& desktop, Asker who) {
  const Command* command = find_command(id);
  if (command == nullptr) return fmt::format("There is no command \"{}\".", id);
  std::string why = why_not(*command, desktop, who);
  if (why.empty()) command->run(desktop);
  return why;
}

void run_or_say(std::string_view id, Desktop& desktop) {
  const std::string why = run_command(id, desktop);
  if (!why.empty()) desktop.notices.say_once(why, true);
}

}  // namespace limpid
