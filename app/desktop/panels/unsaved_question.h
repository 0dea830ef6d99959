// What to do with changes that are not saved.
#pragma once

#include "app/desktop/base/action.h"

namespace limpid {

// While `open`; what was answered, or Action::none. Staying clears `open`. `has_file`: saving needs
// no name.
Action draw_unsaved_question(bool& open, bool has_file);

}  // namespace limpid
