// Panel of a recording's own settings, which cannot be changed.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/desktop/playback/played_session.h"

namespace limpid {

// Setting as text.
struct RecordedSetting {
  std::string name;
  std::vector<std::string> values;  // of each lane
  std::string help = {};
};
// Returns law and its sliders, the grip, and all unusual settings, of all lanes; without
// `everything` the law and what is unusual.
std::vector<RecordedSetting> recorded_settings(std::span<const Parameters> lanes,
                                               bool everything = true);

// Draws into the open ImGui window.
void draw_recorded(PlayedSession& session, bool everything);

}  // namespace limpid
