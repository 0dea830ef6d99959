// Whether two states of the view can be told apart in a picture.
#pragma once

#include "render/view_state.h"

namespace limpid {

// Nothing is further off than `tolerance` [m], forces as long as their arrows.
bool same_picture(const ViewState& a, const ViewState& b, double tolerance);

}  // namespace limpid
