// What the desktop does with scenes.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/desktop/shell/desktop.h"
#include "core/dynamics/arm.h"
#include "core/dynamics/inverse_kinematics.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
constexpr auto kBetweenWorlds = std::chrono::milliseconds(33);

}  // namespace

std::string Desktop::why_fixed() const {
  if (desk_.recording()) {
    return "Stop the recording (R) before changing the scene: it is part of what is recorded.";
  }
  return playback_.on()
             ? "This is a recording's scene. Go back to live (Backspace) to change yours."
             : "";
}

void Desktop::open_scene(const fs::path& file) {
  if (desk_.recording()) {
    notices_.say("Stop the recording (R) before opening another scene.", true);
    return;
  }
  document_.leave([this, file = fs::absolute(file).lexically_normal()] {
    playback_.close();
    document_.loader().cancel();
    first_scene_.clear();
    document_.loader().open_scene(file, desk_.stage().arm());
  });
}

void Desktop::add_model(const fs::path& file) {
  if (document_.may_edit()) document_.loader().add_model(file);
}

void Desktop::take_loaded() {
  if (desk_.recording()) return;  // it waits
  try {
    if (auto loaded = document_.loader().take()) {
      std::visit([this](auto& what) { accept(what); }, *loaded);
    }
  } catch (const XacroToExpand& arm) {
    ask_about(arm);
  } catch (const TipsToChoose& choice) {
    tips_ = choice;
    open_dialog(Dialog::arm_tip);
  } catch (const std::exception& e) {
    notices_.say(e.what(), true);
  }
}

void Desktop::accept(LoadedScene& loaded) {
  end_break();
  if (desk_.loop().device_in_place()) {
    cut_force();
    desk_.open_beside(std::move(loaded.document), loaded.models, settings_.parameters,
                      settings_.plot_length);
    take_stage(std::move(loaded.models), true);
  } else {
    open(desk_.stage().arm(), std::move(loaded.document), std::move(loaded.models));
  }
  const std::string file = loaded.file.string();
  if (file == std::exchange(first_scene_, "")) {
    document_.set_file(file);
  } else if (file != document_.file()) {
    document_.remember_file(file);
    remember_recent(settings_, file);
  }
  const std::string& title = desk_.stage().document().title;
  notices_.say(fmt::format("Scene: {}", title.empty() ? loaded.file.filename().string() : title));
  for (const std::string& warning : loaded.warnings) notices_.say(warning);
}

void Desktop::accept(LoadedModel& loaded) { document_.add_model(std::move(loaded), workplace()); }

// Where the arm, its tips and other objects are now.
Workplace Desktop::workplace() const {
  const Stage& stage = desk_.stage();
  const ArmDescription& arm = stage.arm();
  Workplace at;
  at.base = arm.joints.front().origin.translation();
  at.reach = reach(arm);
  const Eigen::VectorXd x = rest_pose(arm);
  at.rest = stage.rows().tip({x.data(), static_cast<std::size_t>(x.size())});
  const RowLayout& layout = desk_.loop().layout();
  at.tips = {stage.rows().tip(layout.in(desk_.row(), Column::device_position)),
             stage.rows().tip(layout.in(desk_.row(), Column::proxy_position))};
  const SceneEditor& editor = document_.editor();
  const std::vector<Object>& objects = editor.scene().objects;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Bounds box = bounds_of(objects[i], editor.models()[i].get());
    if (!box.isEmpty()) at.taken.push_back(box);
  }
  return at;
}

void Desktop::add_object(Object object) { document_.add_object(std::move(object), workplace()); }

void Desktop::frame_selected() {
  if (!document_.editor().selected()) return;
  const Bounds box = document_.selected_bounds();
  keep_view();
  camera_.frame(box.isEmpty() ? desk_.stage().picture.bounds() : box);
}

void Desktop::save_scene() {
  const fs::path file = document_.own_file();
  if (file.empty()) {
    open_dialog(Dialog::save_scene);  // those that came with Limpid stay as they are
  } else {
    document_.save_as(file);
  }
}

void Desktop::save_and_leave() {
  const fs::path own = document_.own_file();
  if (own.empty()) {
    // Leaving is up to the user then: the dialog may be given up.
    document_.stay();
    open_dialog(Dialog::save_scene);
  } else if (document_.save_as(own)) {
    document_.leave_now();
  }
}

void Desktop::show_scene() {
  const SceneEditor::Version& now = document_.editor().version();
  if (now.world == shown_.world && now.selected == shown_.selected) return;
  try {
    desk_.stage().show(now.world->document, now.world->models, now.selected);
  } catch (const std::exception& e) {
    notices_.say(e.what(), true);
  }
  shown_ = now;
}

// The loop takes in what can be touched now, seldom enough not to be kept busy by a drag.
void Desktop::hand_scene_over(bool at_once) {
  const auto now = std::chrono::steady_clock::now();
  if (document_.editor().version().world == touched_ || desk_.recording()) return;
  if (!at_once && now - touched_since_ < kBetweenWorlds) return;
  desk_.touch(document_.scene());
  touched_ = document_.editor().version().world;
  touched_since_ = now;
}

}  // namespace limpid
