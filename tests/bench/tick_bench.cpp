// The controller and the virtual arm beside MuJoCo's step of the same arm, timed as limpid_bench
// does; or only their ticks, for counting instructions.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include "tests/bench/bench.h"
#include "tests/bench/mesh_stroke.h"
#include "tests/bench/mujoco_step.h"
#include "tests/bench/pressed.h"

namespace limpid::bench {
namespace {

constexpr int kTicks = 20000;

constexpr const char* kHelp =
    "usage: tick_bench [--callgrind LAW [TICKS]] [--callgrind-mesh TRIANGLES [TICKS]]\n"
    "\n"
    "Prints a table of times. With --callgrind it only runs TICKS (1000) ticks of the controller\n"
    "under a law and of the virtual arm, n = 3, in contact, for counting instructions; with\n"
    "--callgrind-mesh a tip of 5 mm strokes over a body of about so many triangles:\n"
    "\n"
    "  valgrind --tool=callgrind --toggle-collect='limpid::Tick<3>::run(*' \\\n"
    "      tick_bench --callgrind proposed\n"
    "  valgrind --tool=callgrind --toggle-collect='limpid::VirtualArm<3>::live(*' \\\n"
    "      tick_bench --callgrind proposed\n"
    "\n"
    "and divide what it collected by TICKS.\n";

// Prints the times of limpid_bench for a chain, over MuJoCo's step.
void print_chain(int joints) {
  const ArmDescription arm = chain(joints);
  const Eigen::VectorXd x = bent(arm);
  const std::string n = fmt::format("n = {}: ", joints);
  const auto steps = mujoco_steps(arm, plane_over(tip_of(arm, x)), x, kTicks);
  const Line mujoco = steps ? line_of("mj_step", n + "mj_step", *steps) : Line{};
  if (steps) fmt::print("{}", table_line(mujoco));
  const std::string ids[] = {fmt::format("tick/{}", joints), fmt::format("arm/{}", joints)};
  for (const std::string& id : ids) {
    const Report report = measure({.ticks = kTicks, .only = id}, [](double, const std::string&) {});
    for (Line line : report.lines) {
      if (line.id == "yardstick") continue;
      line.ratio = steps ? std::optional(line.median / mujoco.median) : std::nullopt;
      fmt::print("{}", table_line(line));
    }
  }
}

int count(std::string_view law, int ticks) {
  for (const CouplingKind kind :
       {CouplingKind::standard, CouplingKind::proposed, CouplingKind::predictive}) {
    if (info(kind).key != law) continue;
    Pressed<3> pressed(chain(3), kind);
    for (int k = 0; k < ticks; ++k) pressed.live(pressed.control());
    fmt::print("{} ticks, {}touching at the end\n", ticks, pressed.touches() ? "" : "not ");
    return pressed.touches() ? 0 : 1;
  }
  fmt::print(stderr, "{}: no law\n", law);
  return 2;
}

int count_on_mesh(std::size_t triangles, int ticks) {
  const StrokePlace place;
  Stroke stroke(place, 0.005, place.on_mesh(bumpy_body(triangles), 0.005, false));
  for (int k = 0; k < ticks; ++k) {
    stroke.move();
    stroke.control();
  }
  fmt::print("{} ticks, {}touching at the end\n", ticks, stroke.touches() ? "" : "not ");
  return stroke.touches() ? 0 : 1;
}

int main_of(int argc, char** argv) {
  const std::string_view option = argc > 1 ? argv[1] : "";
  const int ticks = argc > 3 ? std::max(1, std::atoi(argv[3])) : 1000;
  if (argc == 1) {
    fmt::print("{}", table_head());
    for (const int joints : {3, 7, 15, 30}) print_chain(joints);
    return 0;
  }
  if (option == "--callgrind" && argc > 2) return count(argv[2], ticks);
  if (option == "--callgrind-mesh" && argc > 2) {
    return count_on_mesh(static_cast<std::size_t>(std::max(8, std::atoi(argv[2]))), ticks);
  }
  fmt::print("{}", kHelp);
  return option == "--help" ? 0 : 2;
}

}  // namespace
}  // namespace limpid::bench

int main(int argc, char** argv) { return limpid::bench::main_of(argc, argv); }
