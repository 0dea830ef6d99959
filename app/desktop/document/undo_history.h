// What was done, in order of time, whatever it was done to.
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace limpid {

// Steps between states. Changes of the same name in quick succession, or while the mouse is held
// down, are one step: a drag is undone at once.
template <class State>
class UndoHistory {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::size_t kMost = 200;
  static constexpr std::chrono::milliseconds kPause{500};

  // Once a frame.
  void hold(bool held) {
    if (held_ && !held) open_.clear();
    held_ = held;
  }

  // Something became different from `before`. `what` names it; without a name it is a step of its
  // own.
  void changed(const State& before, const std::string& what, Time now) {
    const bool same = !what.empty() && what == open_ && (held_ || now - last_ < kPause);
    last_ = now;
    open_ = what;
    redo_.clear();
    if (same) return;
    undo_.push_back(before);
    if (undo_.size() > kMost) undo_.erase(undo_.begin());
  }

  // The state to go back, or forward, to; nothing where there is none.
  std::optional<State> undo(const State& now) { return go(undo_, redo_, now); }
  std::optional<State> redo(const State& now) { return go(redo_, undo_, now); }
  const State* next_undo() const { return undo_.empty() ? nullptr : &undo_.back(); }
  const State* next_redo() const { return redo_.empty() ? nullptr : &redo_.back(); }

  // Rewrites what is remembered; steps between equal states are forgotten then.
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
  std::string open_;  // the step that may still grow
  Time last_;
  bool held_ = false;
};

}  // namespace limpid
