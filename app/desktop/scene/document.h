// Document: the scene and the settings that are worked on, their changes with undo, and the scene's
// file.
#pragma once

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/desktop/base/notices.h"
#include "app/desktop/base/settings.h"
#include "app/desktop/scene/placement.h"
#include "app/desktop/scene/scene_editor.h"
#include "app/desktop/scene/scene_loader.h"

namespace limpid {

// Undoable steps between states, in order of time, whatever they change. Changes of the same name
// in quick succession, or while the mouse is held down, are one step: a drag is undone at once.
template <class State>
class UndoHistory {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::size_t kMost = 200;
  static constexpr std::chrono::milliseconds kPause{500};

  // Tells whether the mouse is held down; to be called once a frame.
  void hold(bool held) {
    if (held_ && !held) open_.clear();
    held_ = held;
  }

  // Notes a change from `before`. `what` names it; a change without a name is a step of its own.
  void changed(const State& before, const std::string& what, Time now) {
    const bool same = !what.empty() && what == open_ && (held_ || now - last_ < kPause);
    last_ = now;
    open_ = what;
    redo_.clear();
    if (same) return;
    undo_.push_back(before);
    if (undo_.size() > kMost) undo_.erase(undo_.begin());
  }

  // Returns the state to go back or forward to, if there is one.
  std::optional<State> undo(const State& now) { return go(undo_, redo_, now); }
  std::optional<State> redo(const State& now) { return go(redo_, undo_, now); }
  // Forgets all steps since the last state that `is_before`, which was gone back to. Returns false
  // if there is none, or if a step since then did more than `is_part` says.
  template <class IsBefore, class IsPart>
  bool forget_since(IsBefore is_before, IsPart is_part) {
    for (auto state = undo_.rbegin(); state != undo_.rend() && is_part(*state); ++state) {
      if (!is_before(*state)) continue;
      undo_.erase(std::prev(state.base()), undo_.end());
      open_.clear();
      return true;
    }
    return false;
  }
  const State* next_undo() const { return undo_.empty() ? nullptr : &undo_.back(); }
  const State* next_redo() const { return redo_.empty() ? nullptr : &redo_.back(); }

  // Rewrites the remembered states and merges neighbours that are then equal.
  template <class Rewrite, class Same>
  void rewrite(Rewrite rewrite, Same same) {
    for (auto* list : {&undo_, &redo_}) {
      for (State& state : *list) rewrite(state);
      list->erase(std::unique(list->begin(), list->end(), same), list->end());
    }
    open_.clear();
  }

 private:
  std::optional<State> go(std::vector<State>& from, std::vector<State>& to, const State& now) {
    if (from.empty()) return std::nullopt;
    to.push_back(now);
    State state = std::move(from.back());
    from.pop_back();
    open_.clear();
    return state;
  }

  std::vector<State> undo_, redo_;
  std::string open_;  // name of the step that may still grow
  Time last_;
  bool held_ = false;
};

// A scene that waits until the device which brought its own is gone.
struct SetAside {
  std::string file;
  ArmDescription arm;
  std::shared_ptr<const SceneEditor::World> world;
  bool unsaved = false;
};

class Document {
 public:
  // Returns why the scene cannot be changed now; empty: it may be.
  using WhyFixed = std::function<std::string()>;

  // Works on the settings' parameters, and keeps there which scene was opened last. Keeps
  // references to both.
  Document(Settings& settings, Notices& notices, WhyFixed why_fixed)
      : settings_(settings), notices_(notices), why_fixed_(std::move(why_fixed)) {
    known_ = present();
  }

  // Begins to edit this scene for this arm; not `saved`: no file has it.
  void open(const ArmDescription& arm, SceneDocument document, MeshModels models, bool saved);

  SceneEditor& editor() { return editor_; }
  const SceneEditor& editor() const { return editor_; }
  const Scene& scene() const { return editor_.scene(); }
  SceneLoader& loader() { return loader_; }
  const SceneLoader& loader() const { return loader_; }

  // Returns a sentence on why the scene cannot be changed now; empty: it may be.
  std::string why_fixed() const;
  // Returns whether the scene may be changed; shows a notice if not.
  bool may_edit();
  void add_object(Object object, const Workplace& at);  // finds a place in reach
  void add_model(LoadedModel loaded, const Workplace& at);
  void add_spring(BodySpring spring);
  void remove_selected();
  void duplicate_selected();
  Bounds selected_bounds() const;  // [m]; empty without a selection, or if the object has none

  void undo();  // if passivity is broken, ends that instead
  void redo();
  // Takes the scene back to before the change under way, which leaves no step.
  void give_up(const SceneEditor::Version& before);
  // Notes changes by panels, keys and mouse for undo; to be called once a frame.
  void note_changes();
  void hold(bool mouse_held) { history_.hold(mouse_held); }

  // Returns the file that the scene came from.
  const std::string& file() const { return file_; }
  void set_file(const std::string& file) { file_ = file; }
  // Sets the scene's file, and opens it at the next start, too.
  void remember_file(const std::string& file) { file_ = settings_.scene = file; }
  // Returns the text that a recording keeps of the present scene.
  std::string toml() const;
  // Returns the file that saving writes to; empty for scenes that came with Limpid.
  std::filesystem::path own_file() const;
  // Returns whether it was saved; shows a notice in any case.
  bool save_as(const std::filesystem::path& file);

  // Calls `then` at once, or after the user was asked what to do with unsaved changes.
  void leave(std::function<void()> then);
  bool asking() const { return after_question_ != nullptr; }
  void stay() { after_question_ = nullptr; }  // this and the next two answer the question
  void leave_now();                           // once the scene is saved
  void discard_and_leave();

  // Returns the present scene with all its changes for this arm, or the scene that waits; nothing
  // if the arm cannot have such a scene.
  std::optional<SceneEditor::World> scene_for(const ArmDescription& arm) const;
  static std::optional<SceneEditor::World> scene_for(const ArmDescription& arm,
                                                     const SetAside& waiting);
  // Keeps a scene while a device has its own: to_set_aside() makes it of the present scene,
  // set_aside() keeps the first one, end_waiting() forgets it.
  SetAside to_set_aside() const { return {file_, arm_, editor_.version().world, editor_.dirty()}; }
  void set_aside(SetAside scene) {
    if (!set_aside_) set_aside_ = std::move(scene);
  }
  const SetAside* waiting() const { return set_aside_ ? &*set_aside_ : nullptr; }
  void end_waiting() { set_aside_.reset(); }
  // Returns the scene that waits, if it has changes that no file has.
  const SetAside* unsaved_set_aside() const {
    return set_aside_ && set_aside_->unsaved ? &*set_aside_ : nullptr;
  }

 private:
  // State that undo goes back to.
  struct EditState {
    LaneParameters lanes;
    SceneEditor::Version scene;
  };
  EditState present() const;
  bool end_break();
  bool may_go_to(const EditState* state, const char* otherwise);
  void go_to(const std::optional<EditState>& state);

  Settings& settings_;
  Notices& notices_;
  WhyFixed why_fixed_;
  ArmDescription arm_;
  SceneEditor editor_;
  SceneLoader loader_;
  std::string file_;
  UndoHistory<EditState> history_;
  EditState known_;                       // as of the last frame
  std::function<void()> after_question_;  // waits for the question's answer; none: not asked
  std::optional<SetAside> set_aside_;
};

}  // namespace limpid
