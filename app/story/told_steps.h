// What a session keeps of the story that it tells: title and steps, to be shown with it again.
#pragma once

#include <string>
#include <vector>

#include "app/story/story.h"

namespace limpid {

struct ToldSteps {
  std::string title;
  std::vector<StoryStep> steps;  // none: the session tells no story
};

// As TOML, and back. Errors: FileError "WHERE: ..." as of a story's script, also for steps that are
// not one after the other.
std::string told_text(const ToldSteps& told);
ToldSteps read_told(const std::string& text, const std::string& where);

// Of a session's file. Errors: as attached_story() and read_told().
ToldSteps told_in(const std::filesystem::path& session);

}  // namespace limpid
