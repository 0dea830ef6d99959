#include "app/desktop/shell/dialogs.h"

#include "app/base/folders.h"
#include "app/desktop/base/window_layout.h"
#include "app/desktop/panels/sweep_panel.h"
#include "app/desktop/panels/unsaved_question.h"
#include "app/desktop/panels/xacro_question.h"
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

void Dialogs::draw_sweep() {
  SweepDesk& sweep = desktop_.sweep();
  const MapWish wish = draw(Dialog::sweep, [&](bool& open) {
    return draw_sweep_panel(sweep, desktop_.playback(), open);
  });
  if (wish.point) sweep.play(*wish.point, wish.at, desktop_.playback());
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
  if (desktop_.tips()) {
    const TipsToChoose& choice = *desktop_.tips();
    const std::string tip =
        draw(Dialog::arm_tip, [&](bool& open) { return tip_.draw(open, choice); });
    if (!tip.empty()) desktop_.open_arm(choice.file, tip);
  }
  if (desktop_.xacro()) {
    const fs::path file = desktop_.xacro()->file;
    if (draw(Dialog::expand_xacro, [&](bool& open) { return draw_xacro_question(open, file); })) {
      desktop_.expand_xacro();
    }
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
  if (!session.empty()) desktop_.open_files({session});
  Playback& playback = desktop_.playback();
  const auto video = draw(Dialog::video, [&](bool& open) {
    return video_.draw(open, playback, desktop_.settings().twin_overlaid);
  });
  if (video) playback.export_video(*video);
}

// A plot that shows nothing in the end is not kept.
void Dialogs::draw_plot_chooser(ScreenRect room) {
  std::vector<PlotChoice>& plots = desktop_.settings().plot_choices;
  const std::size_t plot = desktop_.chosen_plot();
  if (desktop_.dialog() == Dialog::plot && plot >= plots.size()) desktop_.close_dialog();
  PlotChoice none;
  PlotChoice& choice = plot < plots.size() ? plots[plot] : none;
  const bool was_open = chooser_.is_open();
  const bool remove = draw(Dialog::plot, [&](bool& open) {
    return chooser_.draw(open, choice, desktop_.shown().channels(), room);
  });
  const bool closed = was_open && desktop_.dialog() != Dialog::plot;
  if (remove || (closed && choice.channels.empty())) desktop_.remove_plot(plot);
}

void Dialogs::draw_list(Dialog which, NamedDialog& dialog, NamedTexts& texts) {
  const NamedDialog::Asked asked =
      draw(which, [&](bool& open) { return dialog.draw(open, texts); });
  if (asked.wish == NamedDialog::Wish::none) return;
  const bool layout = which == Dialog::layouts;
  if (asked.wish == NamedDialog::Wish::use) {
    layout ? desktop_.use_layout(asked.name) : desktop_.use_preset(asked.name);
  } else {
    const std::string now =
        layout ? layout_text(desktop_.settings()) : preset_text(desktop_.edited());
    dialog.complain(texts.keep(asked.name, now));
  }
}

void Dialogs::draw_identify() {
  const Down down = desktop_.settings().parameters.down;
  draw(Dialog::identify, [&](bool& open) {
    identify_.draw(open, desktop_.identify(), down, desktop_.desk().stage().arm());
    return open;
  });
}

void Dialogs::draw_named() {
  draw_list(Dialog::layouts, layouts_, desktop_.layouts());
  draw_list(Dialog::presets, presets_, desktop_.presets());
}

}  // namespace limpid
