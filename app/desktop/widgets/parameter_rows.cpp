#include "app/desktop/widgets/parameter_rows.h"

#include <cmath>

#include "app/style/sliders.h"

namespace limpid {

void draw_parameters(Parameters& p, const ArmDescription& arm,
                     std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    const ParameterInfo& info = *find_parameter(key);
    if (!info.live) continue;
    Parameters shown = p;
    if (std::isnan(shown.friction)) shown.friction = arm.joints.front().friction;
    if (std::isnan(shown.damping)) shown.damping = arm.joints.front().damping;
    if (std::isnan(shown.torque_limit)) shown.torque_limit = arm.joints.front().effort;
    const double paper = parameter_number(Parameters{}, info);
    if (parameter_slider(info, shown, paper)) {
      set_parameter_number(p, info, parameter_number(shown, info));
    }
  }
}

}  // namespace limpid
