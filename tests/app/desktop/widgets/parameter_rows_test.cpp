#include "app/desktop/widgets/parameter_rows.h"

#include <cmath>

#include "tests/app/desktop/widgets/read_panel.h"
#include "tests/support/built_in.h"

namespace limpid {
namespace {

using ParameterRows = ReadPanel;

// A slider shows the arm's value until somebody sets another one.
TEST_F(ParameterRows, ShowTheArmsValuesWhereNothingIsSet) {
  const ArmDescription& arm = test::omni();
  const Joint& joint = arm.joints.front();
  Parameters p;
  const auto rows = [&] {
    show([&] {
      draw_parameters(p, arm, {"device.torque_limit", "device.damping", "device.friction"});
    });
    return words();
  };
  p.torque_limit = p.damping = p.friction = std::nan("");
  const std::string own = rows();
  EXPECT_TRUE(std::isnan(p.torque_limit)) << "looking at it sets nothing";
  p.torque_limit = joint.effort;
  p.damping = joint.damping;
  p.friction = joint.friction;
  EXPECT_EQ(own, rows());
  p.torque_limit = 2 * joint.effort;
  p.damping = 2 * joint.damping;
  EXPECT_NE(own, rows());
}

}  // namespace
}  // namespace limpid
