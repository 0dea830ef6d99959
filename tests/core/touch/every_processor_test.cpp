// Answers of meshes on every kind of processor: Embree takes the widest vectors it finds, which
// must not show.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/touch/embree.h"
#include "core/touch/triangle_mesh.h"
#include "tests/support/meshes.h"

namespace limpid {
namespace {

std::string& kind_of_processor() {
  static std::string isa;
  return isa;
}

using test::Random;
using test::Triangles;
constexpr double kAnywhere = std::numeric_limits<double>::max();

// The bits of all answers.
class Answers {
 public:
  void add(bool found, const MeshPoint& at) {
    all_.push_back(found);
    if (!found) return;
    for (const double x : {at.point.x(), at.point.y(), at.point.z(), at.normal.x(), at.normal.y(),
                           at.normal.z(), at.distance}) {
      all_.push_back(std::bit_cast<std::uint64_t>(x));
    }
    all_.push_back(at.triangle);
  }
  void add(bool yes) { all_.push_back(yes); }
  bool operator==(const Answers&) const = default;

 private:
  std::vector<std::uint64_t> all_;
};

// Asks at random, and where several triangles are equally near or far: over corners and edges, and
// along ways that lead through them.
Answers answers(const Triangles& triangles) {
  const auto mesh = triangles.mesh();
  Answers all;
  MeshPoint found;
  const auto ask_nearest = [&](const Vec3& p) {
    all.add(mesh->nearest(p, kAnywhere, MeshPoint::kNone, found), found);
    all.add(mesh->behind(p));
  };
  const auto ask_crossing = [&](const Vec3& from, const Vec3& to) {
    all.add(mesh->crossing(from, to, found), found);
  };
  Random random(901);
  const double size = mesh->radius();
  for (int round = 0; round < 500; ++round) {
    const Vec3 p = random.point(1.5 * size);
    ask_nearest(p);
    ask_crossing(p, random.point(1.5 * size));
    ask_crossing(p, p + random.point(0.1 * size));
  }
  for (std::size_t t = 0; t < triangles.count(); ++t) {
    const Vec3 a = triangles.corner(t, 0) - mesh->middle();
    const Vec3 b = triangles.corner(t, 1) - mesh->middle();
    for (const Vec3& on : {a, b, Vec3((a + b) / 2), Vec3(0.3 * a + 0.7 * b)}) {
      ask_nearest(on + 0.1 * size * Vec3::UnitZ());
      ask_nearest(1.25 * on);
      ask_crossing(on + 0.1 * size * Vec3::UnitZ(), on - 0.1 * size * Vec3::UnitZ());
      ask_crossing(0.75 * on, 1.25 * on);
    }
  }
  ask_nearest(Vec3::Zero());
  return all;
}

TEST(TriangleMesh, AnswersAlikeOnEveryKindOfProcessor) {
  Random random(902);
  for (const Triangles& triangles : {test::sheet(9, 0.1), test::bumpy_body(2, 0),
                                     test::bumpy_body(3, 0.3), test::soup(400, 1, random)}) {
    const Answers here = answers(triangles);
    int tried = 0;
    for (const char* isa : {",isa=sse2", ",isa=sse4.2", ",isa=avx", ",isa=avx2"}) {
      kind_of_processor() = isa;
      try {
        EXPECT_TRUE(answers(triangles) == here) << isa;
        ++tried;
      } catch (const std::runtime_error&) {  // this processor lacks it
      }
      kind_of_processor().clear();
    }
    EXPECT_GT(tried, 0);
  }
}

}  // namespace
}  // namespace limpid

// Replaces Embree's function and calls it: the program's functions take precedence over a
// library's.
extern "C" RTCDevice rtcNewDevice(const char* config) {
  using Make = RTCDevice (*)(const char*);
  static const auto make = reinterpret_cast<Make>(dlsym(RTLD_NEXT, "rtcNewDevice"));
  return make((std::string(config == nullptr ? "" : config) + limpid::kind_of_processor()).c_str());
}
