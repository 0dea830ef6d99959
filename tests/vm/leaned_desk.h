// A raw device whose strong hand leans it through the side of its gate.
#pragma once

#include "tests/support/built_in.h"
#include "tests/vm/simulated_desk.h"

namespace limpid::test {

class LeanedDesk : public SimulatedDesk<RawDeviceModel> {
 public:
  // Takes the arm that the loop has, and the torque of the device's motors [N m].
  LeanedDesk(const ArmDescription& arm, double torque)
      : SimulatedDesk(arm, bare_gate(arm),
                      std::make_unique<RawDeviceModel>(RawDeviceLayout{
                          .joints = 2, .torque_limit = torque, .physics = stick_axis(1)}),
                      stiff_spring()) {
    AxisPhysics hand = stick_axis(0);
    hand.stiffness = 30;
    hand.damping = 0.5;
    hand.path = lean_right;
    model->hand().axis(0) = hand;
  }

 private:
  static Scene bare_gate(const ArmDescription& arm) {
    Scene gate = read_scene(assets_dir() / "devices/joystick.toml", arm).scene;
    std::erase_if(gate.objects, has_shape<Sphere>);
    return gate;
  }
  static Parameters stiff_spring() {
    Parameters p;
    p.kind = CouplingKind::standard;
    p.k_vc = 30;
    return p;
  }
};

}  // namespace limpid::test
