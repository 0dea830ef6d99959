// How long one tick takes with the tip pressed against a mesh, beside the same tick on a plane.
// Medians and p99 are the program's, p99.9 and longest the machine's.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string_view>

#include "core/dynamics/inverse_kinematics.h"
#include "core/tick/tick.h"
#include "core/touch/triangle_mesh.h"
#include "tests/bench/bench_arm.h"
#include "tests/bench/sample_times.h"

namespace limpid::bench {
namespace {

constexpr int kTicks = 20000;
constexpr double kSize = 0.05;  // of the body, its radius [m]
constexpr double kDepth = 0.0015;

constexpr const char* kHelp =
    "usage: mesh_bench [--callgrind TRIANGLES [TICKS]]\n"
    "\n"
    "Prints a table of times. With --callgrind it only runs TICKS (1000) ticks of the controller\n"
    "with a tip of 5 mm on a body of about TRIANGLES triangles, for counting instructions:\n"
    "\n"
    "  valgrind --tool=callgrind --toggle-collect='limpid::Tick<3>::run(*' \\\n"
    "      mesh_bench --callgrind 100000\n"
    "\n"
    "and divide what it collected by TICKS.\n";

// A body with bumps of a centimetre and ripples of a millimetre.
double radius_at(const Vec3& direction) {
  const Vec3 p = direction;
  return kSize * (1 + 0.1 * std::sin(7 * p.x()) * std::sin(8 * p.y() + 1) +
                  0.01 * std::sin(40 * p.x() + 2) * std::sin(50 * p.z()));
}

std::shared_ptr<const TriangleMesh> body(std::size_t triangles) {
  const int rows = static_cast<int>(std::lround(std::sqrt(static_cast<double>(triangles) / 4)));
  const int columns = 2 * rows;
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::uint32_t> indices;
  const auto add = [&](double a, double b) {
    const Vec3 d(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
    vertices.push_back(Vec3(radius_at(d) * d).cast<float>());
  };
  add(0, 0);
  for (int i = 1; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      add(std::numbers::pi * i / rows, 2 * std::numbers::pi * j / columns);
    }
  }
  add(std::numbers::pi, 0);
  const auto at = [&](int i, int j) {
    if (i == 0) return 0u;
    if (i == rows) return static_cast<std::uint32_t>(vertices.size() - 1);
    return static_cast<std::uint32_t>(1 + (i - 1) * columns + j % columns);
  };
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      if (i < rows - 1) indices.insert(indices.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      if (i > 0) indices.insert(indices.end(), {at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return std::make_shared<const TriangleMesh>(vertices, indices);
}

// The tip is led over the surface of the body, pressed in, and the controller's tick is timed.
class Stroke {
 public:
  Stroke(const ArmDescription& arm, const Vec3& middle, double tip_radius, const Scene& scene)
      : middle_(middle),
        reach_(tip_radius - kDepth),
        arm_(arm),
        tick_(arm, scene),
        row_(static_cast<std::size_t>(tick_.layout().stride())) {
    const auto x = inverse_kinematics(arm, target(0), bent(arm));
    if (!x) throw std::runtime_error("out of reach");
    x_ = *x;
    tick_.start(p_, Start<3>::at_rest(x_));
  }

  // Where the tip is led to: figures of 3 cm over the front, at 0.05 to 0.15 m/s, in from outside.
  Vec3 target(int k) const {
    const double t = 1e-3 * k;
    const Vec3 d = Vec3(-1, 0.5 * std::sin(3 * t), 0.5 * std::sin(4.1 * t + 1)).normalized();
    const double lift = std::max(0.0, 0.005 * (1 - t / 0.2));
    return middle_ + (radius_at(d) + reach_ + lift) * d;
  }
  // The device's tip goes to the target; the encoders are exact.
  void move() {
    const auto x = inverse_kinematics(arm_, target(++k_), x_);
    if (x) x_ = *x;
  }
  void control() { tick_.run(p_, {x_, x_, Vec<3>::Zero()}, ForceWish::as_it_is, row_); }
  bool touches() const { return !tick_.proxy().f().isZero(0); }
  bool diverged() const { return tick_.diverged(); }

 private:
  Parameters p_;
  Vec3 middle_;
  double reach_;
  ArmDescription arm_;
  Tick<3> tick_;
  std::vector<double> row_;
  Vec<3> x_;
  int k_ = 0;
};

struct Place {
  ArmDescription arm = chain(3);
  Vec3 middle = tip_of(arm, bent(arm)) * 0.75 + Vec3(kSize, 0, 0);

  Scene with(double tip_radius, bool capsule) const {
    Scene scene;
    scene.tip_radius = tip_radius;
    if (capsule) {  // the last link, but for what the tip reaches in with
      scene.probes.push_back({"link", 2, Vec3::Zero(), 0.85 * arm.tip.translation(), 0.006});
    }
    return scene;
  }
  Scene on_mesh(std::shared_ptr<const TriangleMesh> shape, double tip_radius, bool capsule) const {
    Scene scene = with(tip_radius, capsule);
    MeshObstacle mesh;
    mesh.pose.translation() = middle;
    mesh.shape = std::move(shape);
    scene.meshes.push_back(mesh);
    return scene;
  }
  Scene on_plane(double tip_radius, bool capsule) const {
    Scene scene = with(tip_radius, capsule);
    scene.planes.push_back({"", middle - Vec3(1.1 * kSize, 0, 0), -Vec3::UnitX(), 600});
    return scene;
  }
};

SampleTimes time_stroke(const Place& place, double tip_radius, const Scene& scene) {
  Stroke stroke(place.arm, place.middle, tip_radius, scene);
  SampleTimes times(kTicks);
  int touching = 0;
  for (int k = 0; k < kTicks; ++k) {
    stroke.move();
    times.time([&] { stroke.control(); });
    touching += stroke.touches();
  }
  if (touching < kTicks * 9 / 10 || stroke.diverged()) {
    fmt::print("  (touched in {:.0f} % of the ticks{})\n", 100.0 * touching / kTicks,
               stroke.diverged() ? ", went unstable" : "");
  }
  return times;
}

void print_table() {
  const Place place;
  fmt::print("{}", table_head());
  std::vector<std::shared_ptr<const TriangleMesh>> bodies;
  for (const std::size_t n : {1'000u, 10'000u, 100'000u, 1'000'000u}) bodies.push_back(body(n));
  for (const bool capsule : {false, true}) {
    for (const double tip_radius : {0.001, 0.005}) {
      const std::string tip =
          fmt::format("{:.0f} mm tip{}: ", 1e3 * tip_radius, capsule ? ", capsule" : "");
      const SampleTimes plane = time_stroke(place, tip_radius, place.on_plane(tip_radius, capsule));
      fmt::print("{}", table_line(tip + "plane", plane, nullptr));
      for (const auto& shape : bodies) {
        const SampleTimes times =
            time_stroke(place, tip_radius, place.on_mesh(shape, tip_radius, capsule));
        fmt::print(
            "{}", table_line(tip + fmt::format("{} triangles", shape->triangles()), times, &plane));
      }
    }
  }
  for (const auto& shape : bodies) {
    fmt::print("{:>8} triangles: {:>7.1f} MB, built in {:>7.1f} ms\n", shape->triangles(),
               1e-6 * static_cast<double>(shape->bytes()), 1e3 * shape->build_seconds());
  }
}

int count(std::size_t triangles, int ticks) {
  const Place place;
  Stroke stroke(place.arm, place.middle, 0.005, place.on_mesh(body(triangles), 0.005, false));
  for (int k = 0; k < ticks; ++k) {
    stroke.move();
    stroke.control();
  }
  fmt::print("{} ticks, {}touching at the end\n", ticks, stroke.touches() ? "" : "not ");
  return 0;
}

int main_of(int argc, char** argv) {
  if (argc == 1) {
    print_table();
    return 0;
  }
  const std::string_view option = argv[1];
  if (option == "--callgrind" && argc > 2) {
    return count(static_cast<std::size_t>(std::max(8, std::atoi(argv[2]))),
                 argc > 3 ? std::max(1, std::atoi(argv[3])) : 1000);
  }
  fmt::print("{}", kHelp);
  return option == "--help" ? 0 : 2;
}

}  // namespace
}  // namespace limpid::bench

int main(int argc, char** argv) { return limpid::bench::main_of(argc, argv); }
