// Runs a story, and measures what happens in each of its steps.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "app/story/story.h"

namespace limpid {

// What a session keeps of the story that it tells: title and steps, to be shown with it again.

struct ToldSteps {
  std::string title;
  std::vector<StoryStep> steps;  // none: the session tells no story
};

// As TOML, and back. Errors: FileError "WHERE: ..." as of a story's script, also for steps that are
// not one after the other.
std::string told_text(const ToldSteps& told);
ToldSteps read_told(const std::string& text, const std::string& where);

// Steps that a session tells; `file`: where it was read. Errors: as read_told().
ToldSteps told_in(const Session& session, const std::filesystem::path& file);

// What one run did in one step.
struct StepNumbers {
  double largest_error = 0;    // |x_E| [rad]
  double rms_human = 0;        // |f1| [N m]
  double largest_contact = 0;  // |f2| [N m]
  double energy_given = 0;     // the most that E_c rose above where the step found it [J]
};

struct StoryRun {
  Session session;  // both runs, in memory
  RunEnd end;
};

// The same story gives the same rows, bit for bit, but for how long each tick took. `at` is told
// the seconds that have been told.
StoryRun run_story(const Story& story, const std::atomic<bool>& stop,
                   const std::function<void(double)>& at);

// Of both runs, for each step that was told. `session` has a twin.
std::vector<std::array<StepNumbers, 2>> measure(const std::vector<StoryStep>& steps,
                                                const Session& session);

// With what it tells, so that it is told again when it is opened. Errors: as SessionWriter.
void write_session(const Session& session, const ToldSteps& told, const std::filesystem::path& out,
                   bool force);

}  // namespace limpid
