// Models that a scene names: reading, refusals and warnings.
#include "app/run/scene_meshes.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "core/touch/triangle_mesh.h"
#include "devices/files/text_file.h"
#include "tests/support/objects.h"

namespace limpid {
namespace {

constexpr std::uint32_t kSide = 230;  // just above twice the triangles of a coarse model

// A bumpy sheet of 2 side^2 triangles as a binary STL.
std::vector<unsigned char> sheet(std::uint32_t side) {
  const std::uint32_t count = 2 * side * side;
  std::vector<unsigned char> bytes(84 + 50 * std::size_t{count});
  std::memcpy(bytes.data() + 80, &count, 4);
  unsigned char* at = bytes.data() + 84;
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x)
      for (const auto& corners : {std::array{0, 0, 1, 0, 0, 1}, {1, 0, 1, 1, 0, 1}}) {
        std::array<float, 12> facet{};  // a normal that nobody reads, three corners
        for (std::size_t k = 0; k < 3; ++k) {
          const auto u = static_cast<float>(x) + static_cast<float>(corners[2 * k]);
          const auto v = static_cast<float>(y) + static_cast<float>(corners[2 * k + 1]);
          facet[3 + 3 * k] = u;
          facet[4 + 3 * k] = v;
          facet[5 + 3 * k] = 3 * std::sin(0.07f * u) * std::cos(0.05f * v);
        }
        std::memcpy(at, facet.data(), sizeof facet);
        at += 50;
      }
  return bytes;
}

SceneDocument with_sheets(std::uint32_t side, const std::vector<std::string>& names) {
  SceneDocument document;
  for (const std::string& name : names) {
    document.scene.add({.shape = Mesh{.model = name}});
    document.models[name] = {"/nowhere/sheet.stl",
                             std::make_shared<const std::vector<unsigned char>>(sheet(side))};
  }
  return document;
}

TEST(SceneMeshes, CanBeTouchedAndDrawnCoarsely) {
  SceneDocument document = with_sheets(kSide, {"sheet.stl"});
  const MeshModels models = build_meshes(document);
  ASSERT_EQ(models.size(), 1u);
  EXPECT_EQ(models[0]->indices.size() / 3, 2 * kSide * kSide);
  EXPECT_GT(models[0]->coarse.size() / 3, 10'000u);
  EXPECT_LT(models[0]->coarse.size() / 3, 100'000u);
  const auto shape = test::shape<Mesh>(document.scene).triangles;
  ASSERT_TRUE(shape);
  EXPECT_EQ(shape->triangles(), 2 * kSide * kSide);
}

TEST(SceneMeshes, AreAtThePlacesOfTheirObjects) {
  SceneDocument document = with_sheets(3, {"a.stl"});
  document.scene.add({.shape = JointStop{}});
  document.scene.add({.shape = Sphere{}});
  const MeshModels models = build_meshes(document);
  ASSERT_EQ(models.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(models[i] != nullptr, has_shape<Mesh>(document.scene.objects[i])) << i;
  }
  EXPECT_TRUE(test::shape<Mesh>(document.scene).triangles);
}

TEST(SceneMeshes, ShareWhatIsOfOneFile) {
  SceneDocument document = with_sheets(3, {"a.stl", "b.stl"});
  const MeshModels models = build_meshes(document);
  EXPECT_EQ(models[0], models[1]);
  EXPECT_EQ(test::shape<Mesh>(document.scene, 0).triangles,
            test::shape<Mesh>(document.scene, 1).triangles);
}

// A sheet of 3 units, at its size in the scene.
TEST(SceneMeshes, WarnOfSizesThatNoHandTouches) {
  SceneDocument document = with_sheets(3, {"sheet.stl"});
  const MeshModels models = build_meshes(document);
  Mesh& mesh = test::shape<Mesh>(document.scene);
  document.scene.objects[0].name = "sheet";
  const auto size_lines = [&](double unit, double scale) {
    mesh.unit = unit;
    mesh.scale = scale;
    std::vector<std::string> lines = mesh_warnings(document.scene, models);
    std::erase_if(
        lines, [](const std::string& line) { return line.find(" long, ") == std::string::npos; });
    return lines;
  };
  EXPECT_TRUE(size_lines(1, 1).empty());
  EXPECT_TRUE(size_lines(1, 3.3).empty()) << "9.9 m";
  EXPECT_TRUE(size_lines(0.001, 0.34).empty()) << "1.02 mm";
  const auto large = size_lines(1, 100), small = size_lines(0.001, 0.1);
  ASSERT_EQ(large.size(), 1u);
  ASSERT_EQ(small.size(), 1u);
  EXPECT_NE(large[0].find("sheet: the model is 300 m long"), std::string::npos) << large[0];
  EXPECT_NE(small[0].find("sheet: the model is 0.3 mm long"), std::string::npos) << small[0];
  for (const std::string& line : {large[0], small[0]}) {
    EXPECT_NE(line.find("unit (m, cm, mm, in or ft)"), std::string::npos) << line;
  }
}

TEST(SceneMeshes, GiveUpWhenAskedToAndSayWhatCannotBeTouched) {
  SceneDocument document = with_sheets(kSide, {"sheet.stl"});
  std::atomic<bool> cancel{true};
  EXPECT_THROW(build_meshes(document, {.cancel = &cancel}), LoadCancelled);

  std::vector<unsigned char> flat = sheet(1);
  std::fill(flat.begin() + 84, flat.end(), static_cast<unsigned char>(0));
  document.models["sheet.stl"].bytes =
      std::make_shared<const std::vector<unsigned char>>(std::move(flat));
  try {
    build_meshes(document);
    FAIL();
  } catch (const FileError& e) {
    EXPECT_NE(std::string(e.what()).find("/nowhere/sheet.stl"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace limpid
