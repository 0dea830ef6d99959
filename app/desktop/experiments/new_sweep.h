// Dialog that starts a sweep: what is varied, by whose hand, and what is measured.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/desktop/experiments/sweep_controller.h"
#include "app/sweep/sweep_draft.h"

namespace limpid {

// State of the window that a sweep takes over.
struct SweepBasis {
  std::string device, scene;        // files; empty: the default
  std::string why_not_scene;        // why the scene cannot be swept; empty: it can
  std::filesystem::path recording;  // the one that is shown, if any
  const Parameters& parameters;
};

class NewSweepDialog {
 public:
  // Draws the dialog while `open`, which closing it clears. Starts the sweep when asked to.
  void draw(bool& open, const SweepBasis& basis, SweepController& controller);

 private:
  struct Hand {
    std::string label, file;  // file empty: a tap
  };
  struct Axis {
    const FieldInfo* field = nullptr;  // null: none
    DraftAxis draft = {};
    std::vector<char> wanted = {};  // of each word of a choice
  };
  void begin(const SweepBasis& basis);
  void choose_field(Axis& axis, const char* id, bool may_be_none);
  void draw_values(Axis& axis, const char* id);
  void draw_measure();
  void draw_hand();
  void draw_end(const SweepBasis& basis, SweepController& controller);
  // Returns the plan that is asked for; sets complaint_.
  SweepDraft draft(const SweepBasis& basis);
  std::uint64_t points() const;

  bool shown_ = false;  // in the frame before
  std::vector<Hand> hands_;
  std::size_t hand_ = 0, measure_ = 0;
  double seconds_ = 0;
  Axis first_, second_;
  std::string checked_, complaint_;  // text of the plan that was checked, and what is wrong with it
  std::string started_;              // text of the plan that was started last
};

}  // namespace limpid
