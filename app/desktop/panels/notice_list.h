// What the window tells its user, over the view.
#pragma once

#include "app/desktop/base/notices.h"
#include "app/plot/plot_frame.h"

namespace limpid {

void draw_notices(const Notices& notices, ScreenRect view, ScreenRect legend);

}  // namespace limpid
