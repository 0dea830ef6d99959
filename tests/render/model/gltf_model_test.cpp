#include "render/model/gltf_model.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "render/model/model_building.h"
#include "tests/render/model/gltf_builder.h"

namespace limpid {
namespace {

void append(Bytes& bytes, const void* data, std::size_t size) {
  if (size == 0) return;
  bytes.resize(bytes.size() + size);
  std::memcpy(bytes.data() + bytes.size() - size, data, size);
}

// A triangle in the xy plane: 36 bytes of positions, then three 16-bit indices.
Bytes triangle_data(std::uint16_t last_index = 2) {
  const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::uint16_t indices[] = {0, 1, last_index};
  Bytes bytes;
  append(bytes, positions, sizeof positions);
  append(bytes, indices, sizeof indices);
  return bytes;
}

std::string triangle_json(const std::string& node = R"("mesh":0)", int count = 3,
                          int index_accessor = 1) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{)" + node +
         R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":)" +
         std::to_string(index_accessor) +
         R"(,"material":0}]}],"materials":[{"pbrMetallicRoughness":{)"
         R"("baseColorFactor":[0.1,0.2,0.3,1],"metallicFactor":0.25,"roughnessFactor":0.75}}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":)" +
         std::to_string(count) +
         R"(,"type":"VEC3"},{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],)"
         R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},)"
         R"({"buffer":0,"byteOffset":36,"byteLength":6}],"buffers":[{"byteLength":42}]})";
}

void expect_refusal(const Bytes& bytes, const std::string& reason) {
  const std::string message = refusal(bytes);
  EXPECT_EQ(message.find("part.glb: "), 0u) << message;
  EXPECT_NE(message.find(reason), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

TEST(GltfModel, ReadsATriangleWithItsMaterial) {
  const Model model = parse_gltf(glb(triangle_json(), triangle_data()), "part.glb");
  ASSERT_EQ(model.vertices.size(), 3u);
  EXPECT_EQ(model.indices, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(model.vertices[1].position, Eigen::Vector3f(1, 0, 0));
  EXPECT_TRUE(model.vertices[0].color.isApprox(Eigen::Vector3f(0.1f, 0.2f, 0.3f)));
  EXPECT_TRUE(model.vertices[0].surface.isApprox(Eigen::Vector2f(0.25f, 0.75f)));
}

TEST(GltfModel, MakesNormalsWhereTheFileHasNone) {
  const Model model = parse_gltf(glb(triangle_json(), triangle_data()), "part.glb");
  for (const Vertex& v : model.vertices) EXPECT_TRUE(v.normal.isApprox(Eigen::Vector3f::UnitZ()));
}

TEST(GltfModel, MakesNormalsOfTrianglesOfAnySize) {
  std::vector<Vertex> corners(3);
  for (const float size : {1e-3f, 0.2f, 50.0f}) {
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = {size * Eigen::Vector3f::Unit(static_cast<Eigen::Index>(i)),
                    Eigen::Vector3f::Zero()};
    }
    fill_normals(corners, std::array<std::uint32_t, 3>{0, 1, 2});
    for (const Vertex& v : corners) {
      EXPECT_LT((v.normal - Eigen::Vector3f::Ones().normalized()).norm(), 1e-6f) << size;
    }
  }
}

TEST(GltfModel, AppliesTheTransformsOfNodes) {
  // A quarter turn about z, twice as large, then one metre up.
  const std::string node = R"("mesh":0,"translation":[0,0,1],"scale":[2,2,2],)"
                           R"("rotation":[0,0,0.70710678118,0.70710678118])";
  const Model model = parse_gltf(glb(triangle_json(node), triangle_data()), "part.glb");
  EXPECT_TRUE(model.vertices[1].position.isApprox(Eigen::Vector3f(0, 2, 1), 1e-6f));
}

TEST(GltfModel, TurnsTheTrianglesOfAMirroredNodeOutwards) {
  const std::string node = R"("mesh":0,"scale":[-1,1,1])";
  const Model model = parse_gltf(glb(triangle_json(node), triangle_data()), "part.glb");
  const auto at = [&](std::size_t i) { return model.vertices[model.indices[i]].position; };
  EXPECT_GT((at(1) - at(0)).cross(at(2) - at(0)).z(), 0);
}

TEST(GltfModel, RefusesWhatDoesNotBeginLikeGltf) {
  Bytes bytes = glb(triangle_json(), triangle_data());
  bytes[0] = 'x';
  expect_refusal(bytes, "is not a glTF file");
  expect_refusal({}, "too short");
}

TEST(GltfModel, RefusesEveryTruncation) {
  const Bytes whole = glb(triangle_json(), triangle_data());
  for (std::size_t size = 0; size < whole.size(); size += 7)
    EXPECT_NE(refusal(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))), "");
}

TEST(GltfModel, RefusesAnotherVersion) {
  Bytes bytes = glb(triangle_json(), triangle_data());
  bytes[4] = 1;
  expect_refusal(bytes, "is glTF 1.0");
  bytes[4] = 3;
  expect_refusal(bytes, "is glTF 3, not 2");
}

TEST(GltfModel, RefusesAnIndexOutsideOfTheMesh) {
  expect_refusal(glb(triangle_json(), triangle_data(3)), "index 3 is outside");
}

TEST(GltfModel, RefusesAnAccessorOutsideOfItsBuffer) {
  expect_refusal(glb(triangle_json(R"("mesh":0)", 4), triangle_data()), "outside its buffer");
}

TEST(GltfModel, RefusesReferencesToNothing) {
  EXPECT_NE(refusal(glb(triangle_json(R"("mesh":0)", 3, 9), triangle_data())), "");
  expect_refusal(glb(triangle_json(R"("mesh":7)"), triangle_data()), "mesh 7");
}

TEST(GltfModel, RefusesNodesInACircle) {
  expect_refusal(glb(triangle_json(R"("children":[0])"), triangle_data()), "its own parent");
}

TEST(GltfModel, RefusesPositionsThatAreNotFinite) {
  Bytes data = triangle_data();
  const float bad = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(data.data() + 12, &bad, 4);
  expect_refusal(glb(triangle_json(), data), "not finite");
}

TEST(GltfModel, RefusesToReadOtherFiles) {
  const std::string json =
      R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":"secret.bin"}]})";
  EXPECT_NE(refusal(Bytes(json.begin(), json.end())), "");
}

TEST(GltfModel, NamesTheFileThatIsMissing) {
  try {
    load_gltf("/nowhere/arm.glb");
    FAIL() << "a missing file was read";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "/nowhere/arm.glb: cannot be read");
  }
}

}  // namespace
}  // namespace limpid
