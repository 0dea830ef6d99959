// Which plots and panels the window shows, as text: for layouts that have a name.
#pragma once

#include <string>
#include <vector>

#include "app/desktop/base/settings.h"

namespace limpid {

// TOML of the layout that these settings have.
std::string layout_text(const Settings& settings);
// The layout of a text; other settings stay. Errors: FileError naming `where`, key and what is
// allowed; nothing has changed then.
void apply_layout(Settings& settings, const std::string& text, const std::string& where);

// The settings that a preset has: those of coupling, observer and ledger.
std::string preset_text(const Parameters& p);
// The preset of a text; what it does not name of these settings gets the paper's value, all others
// stay. Errors: as apply_config_text().
void apply_preset(Parameters& p, const std::string& text, const std::string& where);

}  // namespace limpid
