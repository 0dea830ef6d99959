// The menu bar, with what is going on at its end.
#pragma once

#include "app/desktop/shell/desktop.h"
#include "app/desktop/shell/recent_menu.h"

namespace limpid {

void draw_menu_bar(Desktop& desktop, RecentMenu& recent);

}  // namespace limpid
