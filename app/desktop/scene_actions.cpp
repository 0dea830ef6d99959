// The workbench's actions on the scene.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/base/assets.h"
#include "app/desktop/workbench.h"
#include "core/dynamics/arm.h"
#include "core/dynamics/inverse_kinematics.h"
#include "core/touch/triangle_mesh.h"
#include "devices/files/scene/scene_writer.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
constexpr auto kBetweenWorlds = std::chrono::milliseconds(33);

std::string lower_extension(const fs::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

// 69451 -> "69,451".
std::string with_commas(std::size_t number) {
  std::string text = std::to_string(number);
  for (int at = static_cast<int>(text.size()) - 3; at > 0; at -= 3) {
    text.insert(static_cast<std::size_t>(at), ",");
  }
  return text;
}

}  // namespace

bool Workbench::may_edit() {
  if (recording()) {
    say("Stop the recording (R) before changing the scene: it is part of what is recorded.", true);
  } else if (playback) {
    say("This is a recording's scene. Go back to live (Backspace) to change yours.", true);
  } else if (loader.opening_scene()) {
    say("Wait until the scene is there, or cancel its loading.", true);
  } else {
    return true;
  }
  return false;
}

void Workbench::open_scene(const fs::path& file) {
  if (recording()) {
    say("Stop the recording (R) before opening another scene.", true);
    return;
  }
  leave_scene([this, file = fs::absolute(file).lexically_normal()] {
    close_playback();
    loader.cancel();
    loader.open_scene(file, stage->arm());
  });
}

void Workbench::add_model(const fs::path& file) {
  if (may_edit()) loader.add_model(file);
}

void Workbench::open_dropped(const std::vector<fs::path>& files) {
  for (const fs::path& file : files) {
    const std::string extension = lower_extension(file);
    if (extension == ".toml") {
      open_scene(file);
    } else if (extension == ".glb" || extension == ".gltf") {
      add_model(file);
    } else if (extension == ".h5") {
      open_session(file);
    } else {
      say(fmt::format("{}: not opened. Drop models (.glb, .gltf), scenes (.toml) or recordings "
                      "(.h5) here.",
                      file.filename().string()),
          true);
    }
  }
}

void Workbench::take_loaded() {
  if (recording() || playback) return;  // it waits
  try {
    if (auto loaded = loader.take()) {
      std::visit([this](auto& what) { accept(what); }, *loaded);
    }
  } catch (const std::exception& e) {
    say(e.what(), true);
  }
}

void Workbench::accept(LoadedScene& loaded) {
  if (live.device_in_place()) {
    open_beside(std::move(loaded.scene), std::move(loaded.models));
  } else {
    open(stage->arm(), std::move(loaded.scene), std::move(loaded.models));
  }
  // At the start it is the one that was named already.
  if (const std::string file = loaded.file.string(); file != scene_file) {
    scene_file = settings.scene = file;
  }
  const std::string& title = stage->scene().title;
  say(fmt::format("Scene: {}", title.empty() ? loaded.file.filename().string() : title));
  for (const std::string& warning : loaded.warnings) say(warning);
}

void Workbench::accept(LoadedModel& loaded) {
  const Bounds bounds = loaded.model->bounds();
  place_mesh(loaded.mesh, bounds, editor.scene(), workplace());
  const double scale = loaded.mesh.scale;
  const std::size_t triangles = loaded.mesh.shape->triangles();
  const double centimetres = 100 * scale * bounds.sizes().maxCoeff();
  editor.add(std::move(loaded.mesh), loaded.model);
  std::string text =
      fmt::format("Added {}: {} triangles, {:.3g} cm{}. Ctrl+Z removes it.",
                  name_of(editor.scene(), *editor.selected()), with_commas(triangles), centimetres,
                  scale == 1 ? "" : fmt::format(", scaled by {:.3g}", scale));
  for (const std::string& warning : loaded.warnings) text += "\n" + warning;
  say(text);
}

// Where the arm, its tips and other objects are now.
Workplace Workbench::workplace() const {
  const ArmDescription& arm = stage->arm();
  Workplace at;
  at.base = arm.joints.front().origin.translation();
  at.reach = reach(arm);
  const Eigen::VectorXd x = rest_pose(arm);
  at.rest = stage->rows().tip({x.data(), static_cast<std::size_t>(x.size())});
  const RowLayout& layout = live.layout();
  const std::span<const double> now(live.snapshot().row);
  at.tips = {stage->rows().tip(layout.in(now, Column::device_position)),
             stage->rows().tip(layout.in(now, Column::proxy_position))};
  for (const ObjectRef& ref : objects_of(editor.scene())) {
    const Model* model = ref.kind == ObjectKind::mesh ? editor.models()[ref.index].get() : nullptr;
    const Bounds box = bounds_of(object_of(editor.scene(), ref), model);
    if (!box.isEmpty()) at.taken.push_back(box);
  }
  return at;
}

void Workbench::add_object(SceneObject object) {
  if (!may_edit()) return;
  const Workplace at = workplace();
  const auto table = table_height(editor.scene(), at.rest);
  const Bounds box = bounds_of(object, nullptr);
  if (!box.isEmpty()) {
    const Vec3 place = find_place(box.sizes(), table, at);
    if (auto* sphere = std::get_if<Sphere>(&object)) sphere->center = place;
    if (auto* cuboid = std::get_if<Box>(&object)) cuboid->pose.translation() = place;
  }
  if (auto* plane = std::get_if<Plane>(&object)) {
    plane->point = at.rest - Vec3(0, 0, table ? 0.02 : 0.04);
  }
  try {
    editor.add(std::move(object));
  } catch (const std::exception& e) {
    say(e.what(), true);
  }
}

void Workbench::remove_selected() {
  if (!editor.selected() || !may_edit()) return;
  const std::string name = name_of(editor.scene(), *editor.selected());
  editor.remove(*editor.selected());
  say(fmt::format("Removed {}. Ctrl+Z brings it back.", name));
}

void Workbench::duplicate_selected() {
  if (!editor.selected() || !may_edit()) return;
  try {
    editor.duplicate(*editor.selected());
  } catch (const std::exception& e) {
    say(e.what(), true);
  }
}

void Workbench::frame_selected() {
  if (!editor.selected()) return;
  const ObjectRef ref = *editor.selected();
  const Model* model = ref.kind == ObjectKind::mesh ? editor.models()[ref.index].get() : nullptr;
  const Bounds box = bounds_of(object_of(editor.scene(), ref), model);
  camera.frame(box.isEmpty() ? stage->picture.bounds() : box);
}

std::string Workbench::scene_toml() const {
  const Scene& scene = editor.scene();
  if (!scene.toml.empty()) return scene.toml;
  return scene_text(scene, stage->arm(), fs::path(scene_file).parent_path());
}

fs::path Workbench::own_scene_file() const {
  const fs::path file = fs::absolute(scene_file).lexically_normal();
  const fs::path inside = file.lexically_relative(data_dir().lexically_normal());
  const bool shipped = !inside.empty() && *inside.begin() != "..";
  return shipped ? fs::path() : file;
}

void Workbench::save_scene() {
  const fs::path file = own_scene_file();
  if (file.empty()) {
    dialog = Dialog::save_scene;  // those that came with Limpid stay as they are
  } else {
    save_scene_as(file);
  }
}

bool Workbench::save_scene_as(const fs::path& file) {
  if (!may_edit()) return false;
  try {
    editor.saved(limpid::save_scene(editor.scene(), stage->arm(), file));
    // The names of files are other ones, what can be touched is not.
    known_.scene = editor.version();
    scene_file = settings.scene = fs::absolute(file).lexically_normal().string();
    say(fmt::format("Saved {}", scene_file));
    return true;
  } catch (const std::exception& e) {
    say(e.what(), true);
    return false;
  }
}

void Workbench::leave_scene(std::function<void()> then) {
  if (!editor.dirty()) return then();
  after_question = std::move(then);
}

void Workbench::save_and_leave() {
  const fs::path own = own_scene_file();
  if (own.empty()) {
    // Leaving is up to the user then: the dialog may be given up.
    after_question = nullptr;
    dialog = Dialog::save_scene;
  } else if (save_scene_as(own)) {
    std::exchange(after_question, nullptr)();
  }
}

void Workbench::discard_and_leave() {
  editor.saved(editor.scene());
  std::exchange(after_question, nullptr)();
}

void Workbench::show_scene() {
  const SceneEditor::Version& now = editor.version();
  if (now.world == shown_.world && now.selected == shown_.selected) return;
  std::optional<std::size_t> highlighted;
  if (now.selected && now.selected->kind == ObjectKind::mesh) highlighted = now.selected->index;
  try {
    stage->show(now.world->scene, now.world->models, highlighted);
  } catch (const std::exception& e) {
    say(e.what(), true);
  }
  shown_ = now;
}

// The loop takes in what can be touched now, seldom enough not to be kept busy by a drag.
void Workbench::hand_scene_over(bool at_once) {
  const auto now = std::chrono::steady_clock::now();
  if (editor.version().world == touched_ || recording()) return;
  if (!at_once && now - touched_since_ < kBetweenWorlds) return;
  live.exchange(std::make_unique<TouchWorld>(stage->arm(), editor.scene()));
  touched_ = editor.version().world;
  touched_since_ = now;
}

}  // namespace limpid
