// A scene with objects that move, built by the program, and a simulated hand that pushes one.
#include <limpid/limpid.h>

#include <cmath>
#include <cstdio>

int main() {
  limpid::SurfaceMaterial felt;
  felt.friction = 0.2;
  felt.sticking = 0.25;
  limpid::SceneBuilder scene;
  scene.plane("table top", {0.2, 0, -0.04}, {0, 0, 1}, felt)
      .block("block", {0.2, 0.02, -0.03}, {0.02, 0.02, 0.02}, 0.05, felt)
      .ball("ball", {0.2, -0.03, -0.03}, 0.01, 0.02, felt);
  limpid::LoopOptions options;
  options.scene_text = scene.text();
  options.settings = {"coupling.kind=predictive"};
  limpid::SimulatedLoop loop(options);

  loop.start({0.2, -0.005, -0.03});
  limpid::SimulatedLoop::Hand hand;
  for (int k = 0; k < 1500; ++k) {
    hand.target = {0.2, -0.005 + 0.03 * std::fmin(1, 1e-3 * k), -0.03};
    loop.step(hand);
  }
  const auto pose = loop.row("/objects/pose");  // x, y, z, and a quaternion, of each object
  std::printf("the block moved from y = 20.0 mm to %.1f mm, the ball lies at %.1f mm\n",
              1e3 * pose[1], 1e3 * pose[8]);
  std::printf("given to objects: %.2f mJ\n", 1e3 * loop.row("/energy/to_objects")[0]);
  return pose[1] > 0.025 && std::fabs(pose[8] + 0.03) < 1e-3 ? 0 : 1;
}
