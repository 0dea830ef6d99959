// Stories run, measured step by step, and kept in sessions.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "app/story/story.h"

namespace limpid {

// Title and steps that a session keeps of the story that it tells, to be shown with it again.
struct ToldSteps {
  std::string title;
  std::vector<StoryStep> steps;  // none: the session tells no story
};

// Write steps as TOML, and read them. Errors: FileError "WHERE: ..." as for a story's script, also
// for steps that are not one after the other.
std::string told_text(const ToldSteps& told);
ToldSteps read_told(const std::string& text, const std::string& where);

// Returns the steps that a session tells; `file`: from which it was read. Errors: as read_told().
ToldSteps told_in(const Session& session, const std::filesystem::path& file);

// Figures of one run in one step.
struct StepNumbers {
  double largest_error = 0;    // |x_E| [rad]
  double rms_human = 0;        // |f1| [N m]
  double largest_contact = 0;  // |f2| [N m]
  double energy_given = 0;     // most that E_c rose above its value at the step's beginning [J]
};

struct StoryRun {
  Session session;  // all runs, in memory
  RunEnd end;
};

// Runs a story. The same story gives the same rows, bit for bit, but for the time that each tick
// took. Tells `at` the seconds that are done.
StoryRun run_story(const Story& story, const std::atomic<bool>& stop,
                   const std::function<void(double)>& at);

// Measures each of the runs in each of the steps.
std::vector<std::vector<StepNumbers>> measure(const std::vector<StoryStep>& steps,
                                              const Session& session);

// Writes a session with the story that it tells, which is told again when it is opened. Errors: as
// SessionWriter.
void write_session(const Session& session, const ToldSteps& told, const std::filesystem::path& out,
                   bool force);

}  // namespace limpid
