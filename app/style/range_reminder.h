// Reminder of the numbers that a field allows.
#pragma once

#include <imgui.h>

#include <string>

namespace limpid {

// Says for a while which numbers are allowed, after something else was typed.
class RangeReminder {
 public:
  // `id`: of the field, in the open window.
  explicit RangeReminder(ImGuiID id) : memory_(*ImGui::GetStateStorage()), since_(id + 3) {}

  void speak() { memory_.SetFloat(since_, static_cast<float>(ImGui::GetTime())); }
  void fall_silent() { memory_.SetFloat(since_, kNever); }
  bool speaks() const {
    const float since = memory_.GetFloat(since_, kNever);
    return since != kNever && static_cast<float>(ImGui::GetTime()) - since < kSpeaks;
  }

 private:
  static constexpr float kNever = -1, kSpeaks = 4;  // [s]

  ImGuiStorage& memory_;
  ImGuiID since_;
};

// Returns whether a new number of ImGui's own field `id` counts: it does if it is `allowed`. Draws
// the range below the field for a while if it is not.
bool counts(ImGuiID id, bool changed, bool allowed, const std::string& range);

}  // namespace limpid
