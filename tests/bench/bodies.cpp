#include "tests/bench/bodies.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/touch/body_world.h"

namespace limpid::bench {
namespace {

constexpr double kTick = 1e-3;  // [s]
constexpr int kSettling = 200;  // ticks, after which boxes lie still; they sleep after 500
constexpr int kLetAlone = 250;  // measured ticks before the boxes begin anew
constexpr double kSpeed = 0.5;  // of sliding boxes [m/s]

Scene on_a_floor(int count) {
  Scene scene;
  Object floor;
  floor.name = "floor";
  floor.shape = Plane{};
  scene.add(floor);
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  for (int i = 0; i < count; ++i) {
    const int column = i % side, row = i / side;
    Object box;
    box.name = fmt::format("box {}", i);
    box.shape = Box{Vec3::Constant(0.03)};
    box.pose = pose_at({0.04 * column, 0.04 * row, 0.015});
    box.material = {2000, 0, 0.2, 0.2};
    box.body = Body{};
    scene.add(box);
  }
  return scene;
}

void step(BodyWorld& world) {
  world.begin(kTick);
  world.settle();
  world.finish();
}
// A measured step, as a function of its own that valgrind can tell apart.
[[gnu::noinline]] void measured_step(BodyWorld& world) { step(world); }

// State of the world after it has settled, or fallen asleep; sliding if wanted.
std::vector<double> begun(BodyWorld& world, int count, Boxes what) {
  for (int k = 0; k < (what == Boxes::asleep ? 1000 : kSettling); ++k) step(world);
  if (what == Boxes::slide) {
    for (int i = 0; i < count; ++i) world.touch(i);
    world.begin(kTick);
    for (int i = 0; i < count; ++i) {
      world.push(world.end_at(i, world.center(i)), Vec3(0.05 * kSpeed / kTick, 0, 0));
    }
    world.settle();
    world.finish();
  }
  std::vector<double> numbers;
  world.write(numbers);
  return numbers;
}

}  // namespace

std::string id_of(int count, Boxes what) {
  constexpr std::array kIds{"rest", "slide", "asleep"};
  return fmt::format("bodies/{}/{}", count, kIds[static_cast<std::size_t>(what)]);
}

Line boxes(const Wishes& wishes, const Line& unit, int count, Boxes what) {
  BodyWorld world(on_a_floor(count));
  const std::vector<double> start = begun(world, count, what);
  Samples taken(static_cast<std::size_t>(wishes.ticks));
  InstructionCounter counter;
  const auto tick = [&] { measured_step(world); };
  for (int k = 0; k < wishes.ticks; ++k) {
    if (k % kLetAlone == 0) world.read(start);
    k % 2 ? counter.count(tick) : taken.time(tick);
  }
  constexpr std::array kWords{"at rest", "sliding", "asleep"};
  Line line = line_of(id_of(count, what),
                      fmt::format("{} bodies, {}", count, kWords[static_cast<std::size_t>(what)]),
                      taken, &unit);
  if (const auto counted = counter.total()) {
    const int ticks = wishes.ticks / 2;
    line.instructions = static_cast<double>(*counted) / ticks;
  }
  return line;
}

}  // namespace limpid::bench
