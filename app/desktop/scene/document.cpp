#include "app/desktop/scene/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "app/base/folders.h"
#include "app/desktop/base/passivity_break.h"
#include "app/run/lane_settings.h"
#include "core/touch/triangle_mesh.h"
#include "devices/files/atomic_file.h"
#include "devices/files/scene/body_file.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/scene/scene_writer.h"
#include "devices/files/text_file.h"

namespace limpid {

namespace {

namespace fs = std::filesystem;

// 69451 -> "69,451".
std::string with_commas(std::size_t number) {
  std::string text = std::to_string(number);
  for (int at = static_cast<int>(text.size()) - 3; at > 0; at -= 3) {
    text.insert(static_cast<std::size_t>(at), ",");
  }
  return text;
}

// A scene for an Omni is out of a joystick's reach, and the other way round.
bool share_a_workspace(const ArmDescription& a, const ArmDescription& b) {
  return (a.dof() == 2) == (b.dof() == 2);
}

std::string text_of(const SceneDocument& scene, const ArmDescription& arm,
                    const std::string& file) {
  return scene.toml.empty() ? scene_text(scene, arm, fs::path(file).parent_path()) : scene.toml;
}

std::string text_there(const fs::path& file) {
  std::error_code none;
  return fs::is_regular_file(file, none) ? read_text(file, scene_limits::kLargestModel)
                                         : std::string();
}

// Returns the comments of a TOML text.
std::vector<std::string> comments_in(const std::string& text) {
  std::vector<std::string> all;
  char quote = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') quote = 0;  // good enough: a part of a long string may count as a comment
    if (quote != 0) {
      if (c == '\\' && quote == '"') ++i;
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '#') {
      const std::size_t end = std::min(text.find('\n', i), text.size());
      all.push_back(text.substr(i, end - i));
      i = end - 1;
    }
  }
  return all;
}

// Keeps the text `before` of a file that was written anew, if comments of it are gone. Returns the
// file of that text, or nothing. Errors: std::runtime_error if the text cannot be kept; the file
// then has it again.
fs::path keep_comments(const std::string& before, const fs::path& file) {
  const std::vector<std::string> comments = comments_in(before);
  const std::string now = text_there(file);
  const auto stays = [&](const std::string& each) { return now.find(each) != std::string::npos; };
  if (std::ranges::all_of(comments, stays)) return {};
  fs::path kept = file.string() + "~";
  if (const std::string wrong = try_write_atomically(kept, before); !wrong.empty()) {
    try_write_atomically(file, before);
    throw std::runtime_error(wrong);
  }
  return kept;
}

}  // namespace

void Document::open(const ArmDescription& arm, SceneDocument document, MeshModels models,
                    bool saved) {
  arm_ = arm;
  editor_.open(std::move(document), std::move(models), saved);
  known_.scene = editor_.version();
  // Steps of other scenes cannot be undone in this one.
  history_.rewrite([&](EditState& state) { state.scene = known_.scene; },
                   [](const EditState& a, const EditState& b) { return a.lanes == b.lanes; });
}

std::string Document::why_fixed() const {
  std::string why = why_fixed_();
  if (why.empty() && loader_.opening_scene()) {
    why = "Wait until the scene is loaded, or cancel the loading.";
  }
  return why;
}

bool Document::may_edit() {
  const std::string why = why_fixed();
  if (!why.empty()) notices_.say(why, true);
  return why.empty();
}

void Document::add_object(Object object, const Workplace& at) {
  if (!may_edit()) return;
  const auto table = table_height(scene(), at.rest);
  const Bounds box = bounds_of(object, nullptr);
  if (!box.isEmpty()) {
    const Vec3 place = find_place(box.sizes(), table, at);
    object.pose.translation() = place;
  } else if (has_shape<Plane>(object)) {
    object.pose.translation() = at.rest - Vec3(0, 0, table ? 0.02 : 0.04);
  }
  try {
    editor_.add(std::move(object));
  } catch (const std::exception& e) {
    notices_.say(e.what(), true);
  }
}

void Document::add_model(LoadedModel loaded, const Workplace& at) {
  const Bounds bounds = loaded.model->bounds();
  place_mesh(loaded.mesh, bounds, scene(), at);
  const Mesh& mesh = std::get<Mesh>(loaded.mesh.shape);
  const double scale = mesh.scale;
  const std::size_t triangles = mesh.triangles->triangles();
  const double centimetres = 100 * mesh.size() * bounds.sizes().maxCoeff();
  editor_.add(std::move(loaded.mesh), std::move(loaded.file), loaded.model);
  std::string text = fmt::format(
      "Added {}: {} triangles, {}, largest size {:.3g} cm{}. Ctrl+Z removes the object.",
      editor_.selected_object()->name, with_commas(triangles), text_of(loaded.axes), centimetres,
      scale == 1 ? "" : fmt::format(", scaled by {:.3g}", scale));
  for (const std::string& warning : loaded.warnings) text += "\n" + warning;
  notices_.say(text);
}

void Document::add_spring(BodySpring spring) {
  try {
    editor_.add_spring(std::move(spring));
  } catch (const std::exception& e) {
    notices_.say(e.what(), true);
  }
}

void Document::remove_selected() {
  if (!editor_.selected() || !may_edit()) return;
  const std::string name = editor_.selected_object()->name;
  const std::string also = editor_.remove(*editor_.selected());
  const bool moving = std::ranges::any_of(
      scene().objects, [](const Object& object) { return object.body.has_value(); });
  notices_.say(fmt::format("Removed {}. {}Ctrl+Z brings the object back.{}", name, also,
                           moving ? " Objects that move are back at their start positions." : ""));
}

void Document::duplicate_selected() {
  if (!editor_.selected() || !may_edit()) return;
  try {
    editor_.duplicate(*editor_.selected());
  } catch (const std::exception& e) {
    notices_.say(e.what(), true);
  }
}

Bounds Document::selected_bounds() const {
  const Object* const object = editor_.selected_object();
  return object ? bounds_of(*object, editor_.models()[*editor_.selected()].get()) : Bounds();
}

// Returns the settings as undo sees them. The world that lanes share is no setting of further ones,
// and breaking passivity is no step.
Document::EditState Document::present() const {
  EditState now{settings_.lanes.parameters, editor_.version()};
  if (const auto& before = settings_.before_break) now.lanes = before->parameters;
  share_world(now.lanes);
  return now;
}

void Document::note_changes() {
  const EditState now = present();
  const bool scene = now.scene.world != known_.scene.world;
  const auto changed = std::ranges::mismatch(now.lanes, known_.lanes);
  const bool settings = changed.in1 != now.lanes.end();
  std::string what = scene ? editor_.last_change() : "";
  if (settings) {
    for (const ParameterInfo* info : differing(*changed.in1, *changed.in2)) {
      what = scene ? "" : info->key;
    }
  }
  if (settings || scene) history_.changed(known_, what, std::chrono::steady_clock::now());
  known_ = now;
}

bool Document::may_go_to(const EditState* state, const char* otherwise) {
  if (state == nullptr) {
    notices_.say(otherwise);
    return false;
  }
  return state->scene.world == known_.scene.world || may_edit();
}

void Document::go_to(const std::optional<EditState>& state) {
  if (!state) return;
  settings_.lanes.parameters = state->lanes;
  editor_.restore(state->scene);
  known_ = *state;
}

bool Document::end_break() {
  if (!passivity_broken(settings_)) return false;
  end_passivity_break(settings_);
  notices_.say(kBreakEnded);
  return true;
}

void Document::undo() {
  if (end_break()) return;
  note_changes();
  if (may_go_to(history_.next_undo(), "Nothing to undo.")) go_to(history_.undo(known_));
}

void Document::redo() {
  end_break();
  note_changes();
  if (may_go_to(history_.next_redo(), "Nothing to redo.")) go_to(history_.redo(known_));
}

void Document::give_up(const SceneEditor::Version& before) {
  note_changes();
  editor_.restore(before);
  const bool forgot = history_.forget_since(
      [&](const EditState& state) { return state.scene.world == before.world; },
      [&](const EditState& state) { return state.lanes == known_.lanes; });
  forgot ? void(known_ = present()) : note_changes();
}

std::string Document::toml() const { return text_of(editor_.document(), arm_, file_); }

fs::path Document::own_file() const {
  const fs::path file = fs::absolute(file_).lexically_normal();
  const fs::path inside = file.lexically_relative(data_dir().lexically_normal());
  const bool shipped = !inside.empty() && *inside.begin() != "..";
  return shipped ? fs::path() : file;
}

bool Document::save_as(const fs::path& file) {
  if (!may_edit()) return false;
  try {
    const std::string before = text_there(file);
    const SceneDocument saved = save_scene(editor_.document(), arm_, file);
    const fs::path kept = keep_comments(before, file);
    editor_.saved(saved);
    // Saving changes only names of files: it is no step for undo.
    known_.scene = editor_.version();
    remember_file(fs::absolute(file).lexically_normal().string());
    notices_.say(
        kept.empty()
            ? fmt::format("Saved {}", file_)
            : fmt::format("Saved {}. Comments are not kept. The old file with comments is {}",
                          file_, kept.string()));
    return true;
  } catch (const std::exception& e) {
    notices_.say(e.what(), true);
    return false;
  }
}

void Document::leave(std::function<void()> then) {
  if (!editor_.dirty()) return then();
  after_question_ = std::move(then);
}

void Document::leave_now() { std::exchange(after_question_, nullptr)(); }

void Document::discard_and_leave() {
  editor_.saved(editor_.document());
  leave_now();
}

std::optional<SceneEditor::World> Document::scene_for(const ArmDescription& arm) const {
  return scene_for(arm, to_set_aside());
}

// Reads the scene's text anew for `arm`; shapes and pictures of meshes stay, as they are the same
// for every arm.
std::optional<SceneEditor::World> Document::scene_for(const ArmDescription& arm,
                                                      const SetAside& waiting) {
  const auto& [present, models] = *waiting.world;
  if (arm.urdf == waiting.arm.urdf) return *waiting.world;
  if (!share_a_workspace(arm, waiting.arm)) return std::nullopt;
  try {
    SceneDocument document =
        parse_scene(text_of(present, waiting.arm, waiting.file), waiting.file,
                    fs::path(waiting.file).parent_path(), arm, files_of(present));
    document.models = present.models;
    for (std::size_t i = 0; i < document.scene.objects.size(); ++i) {
      if (auto* mesh = std::get_if<Mesh>(&document.scene.objects[i].shape)) {
        mesh->triangles = std::get<Mesh>(present.scene.objects.at(i).shape).triangles;
      }
    }
    settle_masses(document);
    return SceneEditor::World{std::move(document), models};
  } catch (const std::exception&) {  // it names joints or links that this arm does not have
    return std::nullopt;
  }
}

}  // namespace limpid
