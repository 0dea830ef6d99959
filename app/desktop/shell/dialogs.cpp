#include "app/desktop/shell/dialogs.h"

#include "app/base/assets.h"
#include "app/desktop/panels/unsaved_question.h"
#include "app/desktop/shell/reading.h"

namespace limpid {

namespace fs = std::filesystem;

template <class Draw>
auto Dialogs::draw(Dialog which, Draw&& draw_it) {
  const bool was_open = desktop_.dialog() == which;
  bool open = was_open;
  auto chosen = draw_it(open);
  if (was_open && !open) desktop_.close_dialog();
  return chosen;
}

void Dialogs::draw_reading() {
  const auto read = [this](Dialog which, void (*draw_it)(bool&)) {
    draw(which, [&](bool& open) {
      draw_it(open);
      return open;
    });
  };
  read(Dialog::help, draw_help);
  read(Dialog::about, draw_about);
}

void Dialogs::draw_experiments() {
  const fs::path trial =
      draw(Dialog::experiments, [this](bool& open) { return experiments_.draw(open); });
  if (trial.empty()) return;
  desktop_.playback().open(trial);
  desktop_.close_dialog();
}

void Dialogs::draw_scenes(const Act& act) {
  Document& document = desktop_.document();
  if (document.asking() && modal(desktop_.dialog())) desktop_.close_dialog();
  const fs::path chosen = draw(Dialog::gallery, [this](bool& open) { return gallery_.draw(open); });
  if (!chosen.empty()) desktop_.open_files({chosen});
  draw_paths();
  bool asking = document.asking();
  // An answer may throw; it is carried out once the dialog is drawn.
  const Action answer = draw_unsaved_question(asking, !document.own_file().empty());
  if (!asking) document.stay();
  act(answer);
}

void Dialogs::draw_paths() {
  if (last_folder_.empty()) last_folder_ = data_dir() / "assets/scenes";
  const fs::path model =
      draw(Dialog::add_model, [this](bool& open) { return add_.draw(open, last_folder_ / ""); });
  if (!model.empty()) {
    last_folder_ = model.parent_path();
    desktop_.add_model(model);
  }
  const fs::path arm =
      draw(Dialog::open_arm, [this](bool& open) { return arm_.draw(open, last_folder_ / ""); });
  if (!arm.empty()) {
    last_folder_ = arm.parent_path();
    desktop_.open_arm(arm);
  }
  Document& document = desktop_.document();
  fs::path first = document.own_file();
  if (first.empty()) first = scenes_dir() / fs::path(document.file()).filename();
  const fs::path file =
      draw(Dialog::save_scene, [&](bool& open) { return save_.draw(open, first); });
  if (!file.empty()) document.save_as(file);
}

void Dialogs::draw_sessions() {
  const fs::path session =
      draw(Dialog::open_session, [this](bool& open) { return session_.draw(open); });
  if (!session.empty()) desktop_.playback().open(session);
  Playback& playback = desktop_.playback();
  const auto video = draw(Dialog::video, [&](bool& open) {
    return video_.draw(open, playback, desktop_.settings().twin_overlaid);
  });
  if (video) playback.export_video(*video);
}

}  // namespace limpid
