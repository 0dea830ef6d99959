// What the window does with files that are dropped on it, or opened otherwise, and with what comes
// of them.
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "app/desktop/base/thumbnails.h"
#include "app/desktop/shell/desktop.h"
#include "app/desktop/sweep/sweep_desk.h"
#include "core/dynamics/arm.h"
#include "devices/files/scene/model_units.h"
#include "render/model/model_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

// Earlier ones change what later ones go into.
enum class DropKind : std::uint8_t { arm, scene, model, session, sweep, hand, unknown };

DropKind drop_kind(const fs::path& file) {
  std::error_code none;
  const std::string suffix = small_suffix(file);
  if (sweep_table_at(file)) return DropKind::sweep;
  if (fs::is_directory(file, none)) return DropKind::unknown;
  if (suffix == ".urdf" || suffix == ".xacro") return DropKind::arm;
  if (suffix == ".toml") return DropKind::scene;
  if (is_model_file(file)) return DropKind::model;
  if (suffix == ".h5") return DropKind::session;
  if (suffix == ".csv") return DropKind::hand;
  return DropKind::unknown;
}

std::string why_not_opened(const std::vector<fs::path>& files) {
  std::vector<std::string> names;
  names.reserve(files.size());
  for (const fs::path& file : files) names.push_back(file.filename().string());
  constexpr std::size_t kMost = 4;
  std::string text = fmt::format(
      "{}",
      fmt::join(names.begin(),
                names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), kMost)), ", "));
  if (names.size() > kMost) text += fmt::format(" and {} more", names.size() - kMost);
  return fmt::format(
      "{}: not opened. Drop models ({}), scenes (.toml), recordings (.h5), a sweep's folder or "
      "table, a hand's path (.csv) or an arm (.urdf) here.",
      text, kModelSuffixes);
}

}  // namespace

void Desktop::open_files(const std::vector<fs::path>& files) {
  std::vector<fs::path> sorted = files, unknown;
  std::ranges::stable_sort(sorted, {}, drop_kind);
  for (const fs::path& file : sorted) {
    try {
      switch (drop_kind(file)) {
        case DropKind::arm: open_arm(file); break;
        case DropKind::scene: open_scene(file); break;
        case DropKind::model: add_model(file); break;
        case DropKind::session: playback_.open(file); break;
        case DropKind::sweep: open_sweep(*sweep_table_at(file)); break;
        case DropKind::hand: run_hand(file); break;
        case DropKind::unknown: unknown.push_back(file); break;
      }
    } catch (const std::exception& e) {
      notices_.say(e.what(), true);
    }
  }
  if (!unknown.empty()) notices_.say(why_not_opened(unknown), true);
}

void Desktop::open_sweep(const fs::path& table) {
  std::error_code none;
  sweep_->open(fs::weakly_canonical(table, none));
  open_dialog(Dialog::sweep);
}

// What is known of the settings at the row that is shown.
void Desktop::follow_recorded(bool another) {
  PlayedSession* session = playback_.shown();
  if (session == nullptr || another) recorded_analysed_.reset();
  if (session == nullptr) return;
  const Parameters& now = session->settings();
  if (recorded_analysed_ && *recorded_analysed_ == now) return;
  recorded_analysed_ = now;
  const ArmDescription& arm = session->stage().arm();
  recorded_analysis_ = analyze(arm, rest_pose(arm), now, std::nullopt);
}

// What has been asked for and is there now: a recording, a point of a sweep, a sweep.
void Desktop::follow_playback(double dt) {
  if (sweep_->update()) remember_recent(settings_, sweep_->sweep()->file.string());
  const bool another = playback_.update(dt);
  follow_recorded(another);
  if (!another) return;
  end_break();
  const PlayedSession& opened = *playback_.shown();
  const std::size_t k = opened.row_to_show();
  const Session& session = opened.player().session();
  make_thumbnail(opened.file(), shown(), session.row(k),
                 session.twin ? session.twin->row(k) : std::span<const double>(), settings_.theme);
  camera_.frame(shown().picture.bounds());
  step_ = nullptr;
  if (playback_.last() != sweep_->last_point()) {
    remember_recent(settings_, playback_.last().string());
  } else if (dialog_ == Dialog::sweep) {
    close_dialog();  // over what has come of its point
  }
}

// Along the path as fast as it goes, in the present world; the window plays what came of it.
void Desktop::run_hand(const fs::path& file) {
  RunPlan plan;
  plan.arm = desk_.stage().arm();
  plan.document = document_.editor().document();
  plan.document.toml = document_.toml();
  plan.models = document_.editor().models();
  plan.parameters = settings_.parameters;
  playback_.run_hand(file, std::move(plan));
}

}  // namespace limpid
