// Panel of a recording's own settings, which cannot be changed.
#pragma once

#include <string>
#include <vector>

#include "app/desktop/playback/played_session.h"

namespace limpid {

// Setting as text, with the second run's value if that differs.
struct RecordedSetting {
  std::string name, value;
  std::string of_twin = {};
  std::string help = {};
};
// Returns law and its sliders, the grip, and all unusual settings, of both runs.
std::vector<RecordedSetting> recorded_settings(const Parameters& first, const Parameters* twin);

// Draws into the open ImGui window.
void draw_recorded(PlayedSession& session);

}  // namespace limpid
