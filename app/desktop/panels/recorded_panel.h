// What a recording was made with: its own settings, which nobody can move any more.
#pragma once

#include <string>
#include <vector>

#include "app/desktop/playback/played_session.h"

namespace limpid {

// A setting as it is told of; the second run's beside it where it has another value.
struct RecordedSetting {
  std::string name, value;
  std::string of_twin = {};
  std::string help = {};
};
// The law and what its sliders set, the grip, and whatever else is not as usual, of both runs.
std::vector<RecordedSetting> recorded_settings(const Parameters& first, const Parameters* twin);

// Draws into the ImGui window that is open.
void draw_recorded(PlayedSession& session);

}  // namespace limpid
