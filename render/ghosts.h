// The translucent arms of a picture: what there is besides the proxy.
#pragma once

#include <vector>

#include "render/lit_pass.h"
#include "render/palette.h"
#include "render/view_state.h"

namespace limpid {

struct Ghost {
  Links links;
  palette::Rgb color;
  std::vector<float> outline;  // of each link: how strong it is, 0 to 1
};

// Where each link is; none of an arm with a pose that is not finite.
Links links_of(const ArmPose& arm);
// In the order in which they are to be drawn. `meters_per_pixel` at the tips.
std::vector<Ghost> ghosts_of(const ViewState& state, double meters_per_pixel);

}  // namespace limpid
