// What stands over the picture as long as it is so: no force, broken passivity, a scene that was
// kept.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>

#include "app/desktop/base/passivity_break.h"
#include "app/desktop/shell/desktop.h"
#include "core/tick/arming.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

Banner force_banner(const std::string& text, const std::string& why, bool bad) {
  return {.id = "banner of the force", .text = text + ": " + why + ".", .bad = bad};
}

// Of a recording, where it is looked at.
std::optional<Banner> recorded_force(const PlayedSession& session) {
  const Player& player = session.player();
  const double state = player.session().layout.in(player.row(), Column::force_state)[0];
  const std::string text = force_text(static_cast<ForceState>(state));
  if (text.empty()) return std::nullopt;
  return force_banner("In this recording", text, false);
}

std::optional<Banner> live_force(const Desk& desk) {
  const Snapshot& now = desk.loop().snapshot();
  const std::string why = explain(now.force_state);
  if (now.arming == Arming::waiting) {
    return force_banner("Force waits, and fades in with the hand", why, false);
  }
  if (now.arming != Arming::off && now.arming != Arming::tripped) return std::nullopt;
  const bool recording = desk.loop().recording();
  Banner banner = force_banner(recording ? "Recording without force" : "Force is off", why,
                               recording || now.arming == Arming::tripped);
  banner.text += " F arms it.";
  banner.buttons = {{"Arm (F)", Action::toggle_force}};
  return banner;
}

// "23 November, 14:32", when the file was written.
std::string when(const fs::path& file) {
  std::error_code none;
  const auto written = fs::last_write_time(file, none);
  const auto ago = std::chrono::duration_cast<std::chrono::system_clock::duration>(
      fs::file_time_type::clock::now() - written);
  const auto at = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now() - ago);
  return fmt::format("{:%d %B, %H:%M}", fmt::localtime(at));
}

}  // namespace

std::vector<Banner> Desktop::banners() const {
  if (dialog_ == Dialog::sweep) return {};  // which they would cover
  std::vector<Banner> all;
  const auto force = playback_.on() ? recorded_force(*playback_.shown()) : live_force(desk_);
  if (force) all.push_back(*force);
  if (passivity_broken(settings_)) {
    all.push_back({.id = "banner of the break",
                   .text = "Passivity is broken on purpose: hold the arm, and energy grows. All "
                           "settings come back when it ends.",
                   .bad = true,
                   .buttons = {{"End it (C)", Action::end_passivity_break}}});
  }
  if (!kept_.empty()) {
    all.push_back({.id = "banner of what was kept",
                   .text = fmt::format("Limpid was ended while a scene had unsaved changes. They "
                                       "were kept on {} in {}.",
                                       when(kept_.back()), kept_.back().filename().string()),
                   .buttons = {{"Open", Action::open_kept},
                               {"Later", Action::leave_kept},
                               {"Discard", Action::discard_kept}}});
  }
  return all;
}

void Desktop::open_kept() {
  if (kept_.empty()) return;
  open_scene(kept_.back());
  kept_.pop_back();
}

void Desktop::leave_kept() {
  if (kept_.empty()) return;
  notices_.say(fmt::format("{} is in the gallery (Ctrl+G).", kept_.back().filename().string()));
  kept_.pop_back();
}

void Desktop::discard_kept() {
  if (kept_.empty()) return;
  std::error_code error;
  fs::remove(kept_.back(), error);
  if (error) {
    notices_.say(fmt::format("{}: {}", kept_.back().string(), error.message()), true);
  } else {
    notices_.say(fmt::format("{} is gone.", kept_.back().filename().string()));
  }
  kept_.pop_back();
}

}  // namespace limpid
