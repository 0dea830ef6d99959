// A loop of your own with a simulated device: a slide of 100 g in a hand, and a wall.
//
// The device is the program's: its mass, its integration, its period of 0.25 ms. Limpid reads its
// position and returns its force.
#include <limpid/limpid.h>

#include <cmath>
#include <cstdio>

namespace {

constexpr double kPeriod = 0.00025;  // [s]
constexpr double kMass = 0.1;        // [kg]
constexpr double kDamping = 0.5;     // [N s/m]

std::string arm() {
  limpid::ArmJoint joint;
  joint.name = "slide";
  joint.slides = true;
  joint.axis = {1, 0, 0};
  joint.lower = -0.1;
  joint.upper = 0.1;
  joint.effort = 8;
  joint.damping = kDamping;
  joint.mass = kMass;
  limpid::ArmModel model;
  model.joints = {joint};
  return limpid::urdf_text(model);
}

}  // namespace

int main() {
  limpid::SurfaceMaterial wall;
  wall.stiffness = 1500;
  limpid::LoopOptions options;
  options.arm_text = arm();
  options.scene_text = limpid::SceneBuilder().plane("wall", {0, 0, 0}, {-1, 0, 0}, wall).text();
  options.settings = {"coupling.kind=predictive", "coupling.eta=0.5"};
  options.period = kPeriod;
  options.motors = limpid::Motors::simulated;

  double x = -0.02, v = 0;  // [m, m/s]
  limpid::DeviceLoop loop(options, {&x, 1});
  double deepest = x;
  for (int k = 0; k < 8000; ++k) {
    limpid::DeviceLoop::Reading reading;
    reading.position = {&x, 1};
    const double motor = loop.tick(reading)[0];
    // The hand pulls towards a place 2 cm behind the wall.
    const double goal = -0.02 + 0.04 * std::fmin(1, k * kPeriod);
    const double hand = 300 * (goal - x) - 3 * v;
    v += kPeriod * (motor + hand - kDamping * v) / kMass;
    x += kPeriod * v;
    deepest = std::fmax(deepest, x);
  }
  const double wanted = 300 * 0.02 / (300 + wall.stiffness);  // two springs in a row
  std::printf(
      "deepest point %.2f mm, at rest %.2f mm (theory of two springs: %.2f mm), E_c %.2f mJ\n",
      1e3 * deepest, 1e3 * x, 1e3 * wanted, 1e3 * loop.energy().controller);
  return std::fabs(x - wanted) < 0.1 * wanted ? 0 : 1;
}
