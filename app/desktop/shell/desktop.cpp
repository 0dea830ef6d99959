#include "app/desktop/shell/desktop.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "app/base/folders.h"
#include "app/desktop/base/first_steps.h"
#include "app/desktop/base/passivity_break.h"
#include "app/desktop/base/thumbnails.h"
#include "app/desktop/base/window_layout.h"
#include "app/desktop/device/pad_hand.h"
#include "app/desktop/shell/commands.h"
#include "core/tick/arming.h"

namespace limpid {

std::span<const double> Shown::row() const {
  return playback_.on() ? playback_.shown()->player().row() : live_.row();
}

std::vector<std::span<const double>> Shown::rows() const {
  return playback_.on() ? playback_.shown()->rows() : live_.rows();
}

void Shown::look(Camera::View view) {
  automatic_ = false;
  camera.look(view);
}

void Shown::reset_view() {
  automatic_ = true;
  camera.reset(stage().picture.bounds());
}

void Shown::follow_story() {
  const StoryStep* step = playback_.on() ? playback_.shown()->step() : nullptr;
  if (step == step_) return;
  step_ = step;
  if (step == nullptr) return reset_view();
  PlayedSession& played = *playback_.shown();
  if (!played.has_rerun()) played.stage().name_runs(played.names_in(*step));
  const StoryCamera aim = camera_in(playback_.shown()->steps(), *step);
  reset_view();
  if (!aim.of && aim.view == Camera::View::iso) return;
  look(aim.view);
  camera.frame(aim.of.value_or(stage().picture.bounds()));
}

int Shown::quality_level() const {
  if (settings_.picture_quality == "high") return 0;
  if (settings_.picture_quality == "medium") return 2;
  if (settings_.picture_quality == "low") return Quality::kLowest;
  return automatic_quality.level();
}

PlotLayout::PlotLayout(Settings& settings, Notices& notices, OpenDialog& dialog)
    : layouts(data_dir() / "assets/layouts.toml", user_config_dir() / "layouts.toml"),
      settings_(settings),
      notices_(notices),
      dialog_(dialog) {}

void PlotLayout::add() {
  std::vector<PlotChoice>& plots = settings_.plot_choices;
  if (plots.empty() || !plots.back().channels.empty()) plots.emplace_back();
  choose(plots.size() - 1);
}

void PlotLayout::choose(std::size_t plot) {
  chosen_ = plot;
  settings_.show_plots = true;
  dialog_.open("plot");
}

void PlotLayout::remove(std::size_t plot) {
  std::vector<PlotChoice>& plots = settings_.plot_choices;
  if (plot < plots.size()) plots.erase(plots.begin() + static_cast<std::ptrdiff_t>(plot));
  if (dialog_.name() == "plot") dialog_.close();
}

void PlotLayout::show_in(std::size_t plot, const std::string& channel) {
  std::vector<PlotChoice>& plots = settings_.plot_choices;
  if (plot >= plots.size()) return;
  std::vector<std::string>& shown = plots[plot].channels;
  if (std::ranges::find(shown, channel) == shown.end()) shown.push_back(channel);
}

void PlotLayout::use(const std::string& name) {
  const NamedTexts::Entry* layout = layouts.find(name);
  if (layout == nullptr) return;
  if (dialog_.name() == "plot") dialog_.close();
  apply_layout(settings_, layout->text, name);
  notices_.say(fmt::format("Layout: {}.", name));
}

namespace {

namespace fs = std::filesystem;

Banner force_banner(const std::string& text, const std::string& why, bool bad) {
  return {.id = "banner of the force", .text = text + ": " + why + ".", .bad = bad};
}

// Returns the banner on a recording's force at the player's time.
std::optional<Banner> recorded_force(const PlayedSession& session) {
  const Player& player = session.player();
  const double state = player.session().layout.in(player.row(), Column::force_state)[0];
  const std::string text = force_text(static_cast<ForceState>(state));
  if (text.empty()) return std::nullopt;
  return force_banner("In this recording", text, false);
}

std::optional<Banner> live_force(const LiveStage& live) {
  const Snapshot& now = live.loop().snapshot();
  const std::string why = explain(now.force_state);
  if (now.arming == Arming::waiting) {
    return force_banner("Force waits for the hand, then fades in", why, false);
  }
  if (now.armed()) return std::nullopt;
  const bool recording = live.loop().recording();
  Banner banner = force_banner(recording ? "Recording without force" : "Force is off", why,
                               recording || now.arming == Arming::tripped);
  if (live.loop().device_in_place() && !now.connected) return banner;
  banner.text += " Key F switches the force on.";
  banner.buttons = {{"Force on (F)", "device.force"}};
  return banner;
}

// Says what passivity broken on purpose does: nothing until force is on and a hand holds the arm.
Banner break_banner(bool force, bool hand) {
  const char* const now =
      !force ? "Energy will grow as soon as the force is on."
      : hand ? "A stiff hand holds the arm, and energy grows."
             : "Energy will grow as soon as a hand holds the arm. To hold the arm, drag its tip.";
  return {.id = "banner of the break",
          .text = fmt::format("Passivity is broken on purpose. {} At the end all settings get "
                              "their earlier values again.",
                              now),
          .bad = true,
          .buttons = {{"Repair (C)", "coupling.end_break"}}};
}

Banner chatter_banner(const ChatterWatch& chatter) {
  Banner banner{.id = "banner of the chatter", .text = chatter.text(), .bad = true};
  const ChatterWatch::Found& found = *chatter.found();
  if (found.parameters.kind != CouplingKind::predictive) {
    banner.buttons.push_back({info(CouplingKind::predictive).label, "coupling.mend_chatter"});
  }
  if (found.wall) {
    banner.buttons.push_back(
        {fmt::format("Soften the wall to {:.4g} N/m", found.wall->softer), "scene.soften_wall"});
  }
  banner.buttons.push_back({"Close", "coupling.forget_chatter"});
  return banner;
}

// Returns when the file was written, as "23 November, 14:32".
std::string when(const fs::path& file) {
  std::error_code none;
  const auto written = fs::last_write_time(file, none);
  const auto ago = std::chrono::duration_cast<std::chrono::system_clock::duration>(
      fs::file_time_type::clock::now() - written);
  const auto at = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now() - ago);
  return fmt::format("{:%d %B, %H:%M}", fmt::localtime(at));
}

// Returns the banner of a sweep's point: its place, its measures, and the way back.
Banner point_of_sweep(const PlayedSession& session) {
  constexpr std::size_t kMost = 3;  // measures shown: all are in the panel
  const auto line = [](std::span<const Fact> facts) {
    std::string text;
    for (const Fact& fact : facts) {
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", fact.name, fact.value);
    }
    return text;
  };
  const std::span<const Fact> measured = session.verdict();
  std::string text = line(session.facts());
  if (!measured.empty()) {
    text += ": " + line(measured.first(std::min(kMost, measured.size())));
  }
  return {.id = "banner of the sweep",
          .text = text + ".",
          .buttons = {{"Back to map (F6)", "sweep.show"}}};
}

}  // namespace

const KeyLabels Desktop::kUsKeyboard;

Desktop::Desktop(Settings first, const AskForPriority& ask)
    : settings(std::move(first)),
      document(settings, notices, [this] { return world.why_fixed(); }),
      live(notices, ask),
      devices(
          live, notices, ask,
          {.open = [this](std::unique_ptr<Device> device) { world.open_device(std::move(device)); },
           .close = [this](const std::function<void()>& then) { world.close_device(then); },
           .first_button = [this] { pick_up_or_next_law(); },
           .second_button = [this] { toggle_force(); },
           .open_arm = [this] { return world.arm_file(); }}),
      identify(live, devices, notices),
      playback(notices),
      sweep(notices),
      shown(settings, playback, live),
      tuning(settings, notices, live, devices, playback),
      plots(settings, notices, dialog),
      pads(settings, notices, live),
      kept(notices),
      world(*this) {
  live.controls().parameters() = settings.parameters();
}

void Desktop::drop_pictures() {
  playback.drop_pictures();
  live.drop_pictures();
}

// Puts the hand a little aside while passivity is broken, so that energy grows by itself. If the
// user takes the tip or lets it go, the hand is the user's.
void Desktop::follow_break() {
  constexpr double kAside = 0.01;  // [m]
  Controls& controls = live.controls();
  const bool broken = passivity_broken(settings);
  if (std::exchange(was_broken_, broken) == broken) {
    break_holds_ = break_holds_ && controls.grab;
    return;
  }
  if (broken && !controls.grab && !live.loop().device_in_place()) {
    const Stage& stage = live.stage();
    const RowLayout& layout = live.loop().layout();
    const Vec3 tip = stage.rows().tip(layout.in(live.row(), Column::device_position));
    controls.goal = within_reach(stage.arm(), tip + Vec3(0, kAside, 0));
    controls.grab = break_holds_ = true;
  } else if (!broken && std::exchange(break_holds_, false)) {
    controls.grab = false;
  }
}

// Notes first steps, and leaves a story that has come to its end to let the user take the arm.
void Desktop::follow_first_steps() {
  PlayedSession* played = playback.shown();
  if (played != nullptr) {
    const Player& player = played->player();
    const bool over = player.time() >= player.duration() - 2 * player.session().info.tick;
    const bool told = std::exchange(told_, player.playing());
    if (played->step() == nullptr) {
      if (player.playing()) note_done(settings, FirstStep::play);
    } else if (over && told && !player.playing()) {  // not while the user looks at its end
      playback.close();
      settings.your_turn = !all_done(settings);
      if (!settings.your_turn) notices.say("The story has ended. You can move the arm now.");
    }
    law_.reset();
    return;
  }
  // Settings that a program or the break chose do not count as steps.
  if (passivity_broken(settings) || lead.on()) return law_.reset();
  if (settings.lanes.count > 1) note_done(settings, FirstStep::twin);
  const Parameters& p = settings.parameters();
  const auto now = std::pair(p.kind, p.eta);
  const auto before = std::exchange(law_, now);
  if (before && before->first != now.first) note_done(settings, FirstStep::law);
  if (before && before->second != now.second) note_done(settings, FirstStep::eta);
  if (!live.controls().grab || break_holds_) return;
  const RowLayout& layout = live.loop().layout();
  double contact = 0;
  for (const double f : layout.in(live.row(), Column::contact_torque)) contact += f * f;
  if (contact > 1e-4) note_done(settings, FirstStep::press);  // more than 10 mN m
}

void Desktop::update(double dt) {
  if (end_break_by_law(settings)) notices.say(kBreakEnded);
  document.note_changes();
  tuning.update();
  follow_break();
  shown.stage().choose_plots(settings.plot_choices);
  world.hand_over(false);
  live.update(std::span(settings.lanes.parameters).first(settings.lanes.count));
  chatter.follow();
  if (const auto recorded = live.take_recorded()) {
    playback.set_last(*recorded);
    make_thumbnail(*recorded, live.stage(), live.rows(), settings.theme);
    remember_recent(settings, recorded->string());
  }
  follow_playback(dt);
  follow_first_steps();
  exporter.update();
  if (const auto file = playback.take_written(); !file.empty()) exporter.wrote(file);
  shown.follow_story();
  world.take_loaded();
  devices.update();
  identify.update();
  if (!lead.on()) tuning.note_compensation();
  shown.camera.advance(dt);
  if (live.became_unstable()) {
    cut_force();
    notices.say(
        "The loop became unstable, so the force is off. Choose a larger \xCE\xB7 or a smaller "
        "\xCE\xB1, start over (Backspace), then press F to arm the force.",
        true);
  }
  notices.forget_old();
}

// Takes over loaded recordings and sweeps, and the session of a sweep's point.
void Desktop::follow_playback(double dt) {
  if (sweep.update()) remember_recent(settings, sweep.sweep()->file.string());
  const bool another = playback.update(dt);
  tuning.follow_recorded(another);
  if (PlayedSession* played = playback.shown()) {
    if (const auto names = played->names_now()) played->stage().name_runs(*names);
  }
  if (!another) return;
  if (live.loop().device_in_place()) live.loop().cut();  // the device's world is not on the screen
  tuning.end_break();
  const PlayedSession& opened = *playback.shown();
  const std::size_t k = opened.row_to_show();
  const Session& session = opened.player().session();
  std::vector<std::span<const double>> rows;
  for (std::size_t i = 0; i < session.lanes(); ++i) rows.push_back(session.lane(i).row(k));
  make_thumbnail(opened.file(), shown.stage(), rows, settings.theme);
  shown.camera.frame(shown.stage().picture.bounds());
  shown.leave_story();
  if (opened.file() == playback.last()) remember_recent(settings, opened.file().string());
  if (opened.file() == sweep.last_point() && dialog.name() == "sweep") {
    dialog.close();  // it would cover the point's session
  }
}

void Desktop::follow_pads(std::vector<Pad> plugged, bool focused, double dt) {
  const Focus who = focus();
  const bool asked_beside = dialog.name() == "ask" && question.beside();
  const bool listens = focused && !playback.on() && !who.question && (!who.modal || asked_beside);
  const auto asked_for = pads.follow(
      std::move(plugged), {.device = !devices.hub().in_use().empty(), .listens = listens},
      shown.camera, dt);
  if (asked_for.cut) cut_force();
  if (asked_for.next_law && !blind) tuning.next_law();
  if (asked_for.magnet) run_or_say("hand.magnet", *this);
}

void Desktop::pick_up_or_next_law() {
  if (live.why_no_magnet().empty()) {
    live.toggle_magnet();
  } else if (!blind) {
    tuning.next_law();
  }
}

Focus Desktop::focus() const {
  return {.text = typing(),
          .popup = popup_open(),
          .question = document.asking(),
          .dialog = dialog.name(),
          .asked = question.number(),
          .modal = dialog.modal(),
          .panel = led_panel != LedPanel::none,
          .playback = playback.on(),
          .selection = document.editor().selected().has_value(),
          .transform = transform.follows()};
}

void Desktop::toggle_force() {
  if (!live.force_armed() && playback.on() && live.loop().device_in_place()) {
    return notices.say(
        "The window shows a recording, not the scene in which the device would give force. Go back "
        "to live (Backspace), then arm the force.",
        true);
  }
  if (live.loop().toggle_force()) return;
  notices.say(
      "The force switched itself off a moment ago. Wait a second, then press F to arm the force.",
      true);
}

void Desktop::cut_force() {
  live.loop().cut();
  devices.cancel_check();
  if (identify.moving()) identify.stop();  // only a motion stops: results stay
}

// Returns whether keys may be a player's: a recording is shown, and no real device may move.
bool Desktop::only_plays() const {
  const Focus now = focus();
  const bool nothing_before = !now.popup && !now.question && !now.modal;
  return playback.on() && nothing_before && !may_move();
}

// Returns whether a real device has force, or is about to.
bool Desktop::may_move() const {
  const bool armed = live.loop().device_in_place() && live.force_armed();
  return armed || devices.check() != nullptr || identify.moving();
}

void Desktop::cut_or_play() {
  if (only_plays()) return playback.toggle_playing();
  cut_force();
}

void Desktop::escape() {
  const bool plays = only_plays();
  const bool closed = close_one();
  if (!closed && plays) return playback.close();
  if (!closed || may_move()) cut_force();
}

// Closes one thing. A moving device stops, and its dialog says so. Then come a menu, typing outside
// of dialogs (which ImGui ends), the question, a run beside the window, the dialog.
bool Desktop::close_one() {
  const Focus now = focus();
  if (identify.moving()) {
    identify.stop();
  } else if (now.popup) {
    // Lists inside of a dialog close, the dialog stays.
    const int level = ImGui::GetTopMostPopupModal() != nullptr ? 1 : 0;
    ImGui::ClosePopupToLevel(level, true);
  } else if (now.question) {
    document.stay();
  } else if (owner_of(now) == KeyOwner::panel) {
    led_panel = LedPanel::none;
  } else if (owner_of(now) == KeyOwner::transform) {
    transform.give_up(document);
  } else if (playback.loading_part() > 0 && playback.loading()) {
    playback.cancel_loading();
  } else if (dialog.kind() == nullptr && !now.text && shown.stage().group.range()) {
    shown.stage().group.select(std::nullopt);
  } else if (dialog.kind() == nullptr && !now.text && !playback.on() &&
             document.editor().selected()) {
    document.editor().select(std::nullopt);
  } else if (dialog.kind() == nullptr) {
    return now.text;
  } else if (!now.text || dialog.kind()->keys != DialogKind::Keys::view) {
    dialog.close();
  }
  return true;
}

std::vector<Banner> Desktop::banners() const {
  if (dialog.name() == "sweep") return {};  // banners would cover the map
  std::vector<Banner> all;
  const auto force = playback.on() ? recorded_force(*playback.shown()) : live_force(live);
  if (force) all.push_back(*force);
  if (playback.on() && playback.shown()->file() == sweep.last_point()) {
    all.push_back(point_of_sweep(*playback.shown()));
  }
  if (passivity_broken(settings)) {
    all.push_back(break_banner(!force, live.controls().grab));
  }
  if (chatter.found() && !playback.on()) all.push_back(chatter_banner(chatter));
  if (!playback.recovered().empty()) {
    all.push_back(
        {.id = "banner of the recovered",
         .text = playback.recovered(),
         .buttons = {{"Play (P)", "session.play"}, {"Close", "session.forget_recovered"}}});
  }
  if (!exporter.written().empty()) {
    all.push_back({.id = "banner of the export",
                   .text = fmt::format("{} is in {}.", exporter.written().filename().string(),
                                       exporter.written().parent_path().string()),
                   .buttons = {{"Open", "export.open"},
                               {"Show in folder", "export.show"},
                               {"Close", "export.forget"}}});
  }
  if (!experiments_under_way.empty() && dialog.name() != "experiments") {
    all.push_back({.id = "banner of the experiments",
                   .text = "Experiments are running: " + experiments_under_way + ".",
                   .buttons = {{"Show (F5)", "experiments.show"}}});
  }
  if (sweep.runner().busy()) {
    all.push_back({.id = "banner of the sweep's work",
                   .text = "The sweep is running: " + sweep.runner().under_way() + ".",
                   .buttons = {{"Show (F6)", "sweep.show"}}});
  }
  if (kept.any()) {
    all.push_back(
        {.id = "banner of what was kept",
         .text = fmt::format(
             "Limpid ended while a scene had unsaved changes. The changes were saved on {} in {}.",
             when(kept.newest()), kept.newest().filename().string()),
         .buttons = {{"Open", "scene.open_kept"},
                     {"Later", "scene.leave_kept"},
                     {"Discard", "scene.discard_kept"}}});
  }
  return all;
}

}  // namespace limpid
