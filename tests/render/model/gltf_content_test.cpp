// Contents of glTF files, and their effect on the model.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "render/model/gltf_model.h"
#include "render/model/simplify.h"
#include "tests/render/model/gltf_builder.h"

namespace limpid {
namespace {

// Twice the area of all triangles that face +z.
float area(const Model& model) {
  float sum = 0;
  for (std::size_t i = 0; i < model.indices.size(); i += 3) {
    const auto at = [&](std::size_t k) { return model.vertices[model.indices[i + k]].position; };
    const float z = (at(1) - at(0)).cross(at(2) - at(0)).z();
    EXPECT_GT(z, 0);
    sum += z;
  }
  return sum;
}

TEST(GltfContent, TakesAStripApart) {
  GltfBuilder file;
  file.positions(kSquare);
  file.primitive = R"(,"mode":5)";
  EXPECT_FLOAT_EQ(area(parse_gltf(file.binary(), "part.glb")), 2);
}

TEST(GltfContent, TakesAFanApart) {
  GltfBuilder file;
  file.positions({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  file.primitive = R"(,"mode":6)";
  EXPECT_FLOAT_EQ(area(parse_gltf(file.binary(), "part.glb")), 2);
}

TEST(GltfContent, LeavesPointsAndLinesOutAndSaysSo) {
  GltfBuilder file;
  file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const std::string primitive = R"({"attributes":{"POSITION":0})";
  file.mesh = primitive + R"(,"mode":0},)" + primitive + R"(,"mode":1},)" + primitive + "}";
  const Model model = parse_gltf(file.binary(), "part.glb");
  EXPECT_EQ(model.indices.size(), 3u);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_EQ(model.warnings[0], "points and lines are ignored");
}

TEST(GltfContent, KeepsOnlyTheVerticesThatAPrimitiveUses) {
  GltfBuilder file;
  file.positions({9, 9, 9, 0, 0, 0, 9, 9, 9, 1, 0, 0, 0, 1, 0});
  const int indices =
      file.accessor(file.view(std::vector<std::uint16_t>{1, 3, 4}), 5123, "SCALAR", 3);
  file.primitive = R"(,"indices":)" + std::to_string(indices);
  const Model model = parse_gltf(file.binary(), "part.glb");
  EXPECT_EQ(model.vertices.size(), 3u);
  EXPECT_FLOAT_EQ(area(model), 1);
}

TEST(GltfContent, AppliesTheExceptionsOfASparseAccessor) {
  GltfBuilder file;
  const int positions = file.view(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int which = file.view(std::vector<std::uint8_t>{2});
  const int values = file.view(std::vector<float>{0, 3, 0});
  const std::string sparse =
      R"(,"sparse":{"count":1,"indices":{"bufferView":)" + std::to_string(which) +
      R"(,"componentType":5121},"values":{"bufferView":)" + std::to_string(values) + "}}";
  file.attribute("POSITION", file.accessor(positions, 5126, "VEC3", 3, sparse));
  EXPECT_FLOAT_EQ(area(parse_gltf(file.binary(), "part.glb")), 3);
}

// glTF 2.0, 3.6.2.1: without a buffer view the elements are zeros.
TEST(GltfContent, ReadsZerosWhereThereIsNoData) {
  GltfBuilder file;
  file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  file.attribute("TEXCOORD_0", file.accessor(-1, 5126, "VEC2", 3));
  file.attribute("COLOR_0", file.accessor(-1, 5126, "VEC3", 3));
  const Model model = parse_gltf(file.binary(), "part.glb");
  for (const Vertex& v : model.vertices) EXPECT_TRUE(v.color.isZero(0) && v.uv.isZero(0));
}

// 3.7.2.1: without normals the model is drawn flat.
TEST(GltfContent, IsFlatWithoutNormals) {
  GltfBuilder file;
  file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  EXPECT_TRUE(parse_gltf(file.binary(), "part.glb").parts[0].material.flat);
  file.attribute("NORMAL", file.accessor(file.view(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}),
                                         5126, "VEC3", 3));
  EXPECT_FALSE(parse_gltf(file.binary(), "part.glb").parts[0].material.flat);
}

TEST(GltfContent, SaysWhatGltfOneIs) {
  for (const char* json : {R"({"asset":{"version":"1.0"}})", R"({"meshes":{"a":{}}})"}) {
    const std::string text = json;
    EXPECT_NE(refusal(Bytes(text.begin(), text.end())).find("is glTF 1.0"), std::string::npos);
  }
}

TEST(GltfContent, RefusesASparseAccessorThatChangesWhatIsNotThere) {
  GltfBuilder file;
  const int which = file.view(std::vector<std::uint8_t>{3});
  const int values = file.view(std::vector<float>{0, 3, 0});
  const std::string sparse =
      R"(,"sparse":{"count":1,"indices":{"bufferView":)" + std::to_string(which) +
      R"(,"componentType":5121},"values":{"bufferView":)" + std::to_string(values) + "}}";
  file.attribute("POSITION", file.accessor(-1, 5126, "VEC3", 3, sparse));
  EXPECT_NE(refusal(file.binary()).find("does not exist"), std::string::npos);
}

TEST(GltfContent, ReadsQuantizedPositions) {
  GltfBuilder file;
  const int view = file.view(std::vector<std::int16_t>{0, 0, 0, 0, 32767, 0, 0, 0, 0, -32767, 0, 0},
                             R"(,"byteStride":8)");
  file.attribute("POSITION", file.accessor(view, 5122, "VEC3", 3, R"(,"normalized":true)"));
  file.more = R"(,"extensionsRequired":["KHR_mesh_quantization"])";
  const Model model = parse_gltf(file.binary(), "part.glb");
  EXPECT_TRUE(model.vertices[2].position.isApprox(Eigen::Vector3f(0, -1, 0)));
}

TEST(GltfContent, MultipliesVertexColoursOfEveryKindWithTheMaterial) {
  for (const bool bytes : {true, false}) {
    GltfBuilder file;
    file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int colors =
        bytes ? file.accessor(file.view(Bytes{255, 0, 51, 51, 255, 0, 51, 51, 255, 0, 51, 51}),
                              5121, "VEC4", 3, R"(,"normalized":true)")
              : file.accessor(file.view(std::vector<float>{1, 0, 0.2f, 1, 0, 0.2f, 1, 0, 0.2f}),
                              5126, "VEC3", 3);
    file.attribute("COLOR_0", colors);
    file.primitive = R"(,"material":0)";
    file.more = R"(,"materials":[{"alphaMode":"BLEND",)"
                R"("pbrMetallicRoughness":{"baseColorFactor":[0.5,1,1,0.5]}}])";
    const Model model = parse_gltf(file.binary(), "part.glb");
    EXPECT_TRUE(model.vertices[1].color.isApprox(Eigen::Vector3f(0.5f, 0, 0.2f), 1e-5f));
    EXPECT_NEAR(model.vertices[1].opacity, bytes ? 0.1 : 0.5, 1e-6);
    EXPECT_EQ(model.parts[0].material.alpha, Finish::Alpha::blend);
  }
}

GltfBuilder textured_square() {
  GltfBuilder file;
  file.positions(kSquare);
  file.attribute("TEXCOORD_0", file.accessor(file.view(std::vector<float>{0, 1, 1, 1, 0, 0, 1, 0}),
                                             5126, "VEC2", 4));
  const int picture = file.view(kRedPng);
  file.primitive = R"(,"mode":5,"material":0)";
  file.more = R"(,"images":[{"mimeType":"image/png","bufferView":)" + std::to_string(picture) +
              R"(}],"samplers":[{"wrapS":33071}],"textures":[{"source":0,"sampler":0}])";
  return file;
}

TEST(GltfContent, ReadsAMaterialWithItsTextures) {
  GltfBuilder file = textured_square();
  file.more += R"(,"materials":[{"doubleSided":true,"alphaMode":"MASK","alphaCutoff":0.25,)"
               R"("emissiveFactor":[0.1,0.2,0.3],"emissiveTexture":{"index":0},)"
               R"("normalTexture":{"index":0,"scale":2},"pbrMetallicRoughness":{)"
               R"("baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":0}}}])";
  const Model model = parse_gltf(file.binary(), "part.glb");
  EXPECT_TRUE(model.warnings.empty());
  ASSERT_EQ(model.parts.size(), 1u);
  const Finish& m = model.parts[0].material;
  EXPECT_TRUE(m.two_sided);
  EXPECT_EQ(m.alpha, Finish::Alpha::mask);
  EXPECT_FLOAT_EQ(m.cutoff, 0.25f);
  EXPECT_FLOAT_EQ(m.glow[2], 0.3f);
  EXPECT_FLOAT_EQ(m.bump, 2);
  // The same picture is kept once as colours, once as numbers.
  ASSERT_EQ(model.images.size(), 2u);
  EXPECT_EQ(m.color, m.emission);
  EXPECT_EQ(m.surface, m.normal);
  const Image& colors = model.images[static_cast<std::size_t>(m.color)];
  EXPECT_TRUE(colors.srgb);
  EXPECT_FALSE(model.images[static_cast<std::size_t>(m.normal)].srgb);
  EXPECT_EQ(colors.wrap_u, Image::Wrap::clamp);
  EXPECT_EQ(colors.wrap_v, Image::Wrap::repeat);
  EXPECT_EQ(colors.rgba, (Bytes{255, 0, 0, 255}));
}

// 10497 repeats, 33648 mirrors, 33071 clamps, each way by itself.
TEST(GltfContent, WrapsATextureEachWayByItself) {
  for (const auto& [sampler, u, v] :
       {std::tuple(R"({"wrapS":33071,"wrapT":33648})", Image::Wrap::clamp, Image::Wrap::mirror),
        std::tuple(R"({"wrapS":33648,"wrapT":33071})", Image::Wrap::mirror, Image::Wrap::clamp),
        std::tuple(R"({"wrapS":10497})", Image::Wrap::repeat, Image::Wrap::repeat)}) {
    GltfBuilder file = textured_square();
    const std::string usual = R"({"wrapS":33071})";
    file.more.replace(file.more.find(usual), usual.size(), sampler);
    file.more += R"(,"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
    const Model model = parse_gltf(file.binary(), "part.glb");
    ASSERT_EQ(model.images.size(), 1u);
    EXPECT_EQ(model.images[0].wrap_u, u) << sampler;
    EXPECT_EQ(model.images[0].wrap_v, v) << sampler;
  }
}

// A file may ask for any height; a picture takes ten times the height at most.
TEST(GltfContent, TakesBumpsUpToTenTimesTheirHeight) {
  for (const auto& [asked, taken] :
       {std::pair("9.5", 9.5f), {"15", 10.0f}, {"1e30", 10.0f}, {"-9.5", -9.5f}, {"-15", -10.0f}}) {
    GltfBuilder file = textured_square();
    file.more +=
        R"(,"materials":[{"normalTexture":{"index":0,"scale":)" + std::string(asked) + "}}]";
    EXPECT_FLOAT_EQ(parse_gltf(file.binary(), "part.glb").parts[0].material.bump, taken) << asked;
  }
}

TEST(GltfContent, MovesTextureCoordinates) {
  GltfBuilder file = textured_square();
  file.more += R"(,"extensionsRequired":["KHR_texture_transform"],"materials":[{)"
               R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{)"
               R"("KHR_texture_transform":{"offset":[0.5,0.25],"scale":[2,4],)"
               R"("rotation":1.57079632679}}}}}])";
  const Model model = parse_gltf(file.binary(), "part.glb");
  // (1, 1), scaled to (2, 4), turned counterclockwise with v pointing down, then moved.
  EXPECT_TRUE(model.vertices[1].uv.isApprox(Eigen::Vector2f(4.5f, -1.75f), 1e-5f));
}

TEST(GltfContent, DrawsWithoutAPictureThatCannotBeRead) {
  GltfBuilder file = textured_square();
  const std::string compressed = "IDAT";
  *(std::search(file.data.begin(), file.data.end(), compressed.begin(), compressed.end()) + 4) = 0;
  file.more += R"(,"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
  const Model model = parse_gltf(file.binary(), "part.glb");
  EXPECT_EQ(model.parts[0].material.color, -1);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_NE(model.warnings[0].find("image 0"), std::string::npos);
}

TEST(GltfContent, ReadsAFileWithoutAScene) {
  GltfBuilder file;
  file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  std::string json = file.json();
  const std::string scenes = R"("scenes":[{"nodes":[0]}],)";
  json.replace(json.find(scenes), scenes.size(), "");
  EXPECT_EQ(parse_gltf(glb(json, file.data), "part.glb").indices.size(), 3u);
}

TEST(GltfContent, CanBeDrawnCoarselyWhereItIsLarge) {
  constexpr std::uint32_t kSide = 400;
  std::vector<float> xyz;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t y = 0; y <= kSide; ++y)
    for (std::uint32_t x = 0; x <= kSide; ++x)
      xyz.insert(xyz.end(), {static_cast<float>(x), static_cast<float>(y), 0.0f});
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x) {
      const std::uint32_t a = y * (kSide + 1) + x, b = a + kSide + 1;
      indices.insert(indices.end(), {a, a + 1, b, a + 1, b + 1, b});
    }
  GltfBuilder file;
  file.positions(xyz);
  file.primitive = R"(,"indices":)" + std::to_string(file.accessor(file.view(indices), 5125,
                                                                   "SCALAR", indices.size()));
  Model model = parse_gltf(file.binary(), "part.glb");
  add_coarse(model);
  EXPECT_GT(model.coarse.size() / 3, 10'000u);
  EXPECT_LT(model.coarse.size() / 3, 100'000u);
  // A flat sheet stays one without holes, except for half a cell at its edges.
  model.indices = model.coarse;
  EXPECT_NEAR(area(model) / (2.0f * kSide * kSide), 1, 0.02);
}

// Each primitive numbers its vertices anew, independently of the one before.
TEST(GltfContent, HasPrimitivesThatShareTheirVertices) {
  GltfBuilder file;
  file.positions({0, 0, 0, 1, 0, 0, 0, 2, 0, 3, 3, 1});
  const auto primitive = [&](const std::vector<std::uint16_t>& corners) {
    const int indices = file.accessor(file.view(corners), 5123, "SCALAR", corners.size());
    return R"({"attributes":{"POSITION":0},"indices":)" + std::to_string(indices) + "}";
  };
  file.mesh = primitive({0, 1, 2}) + "," + primitive({2, 1, 3});
  const Model model = parse_gltf(file.binary(), "part.glb");
  ASSERT_EQ(model.indices.size(), 6u);
  const std::vector<Eigen::Vector3f> wanted = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0},
                                               {0, 2, 0}, {1, 0, 0}, {3, 3, 1}};
  for (std::size_t i = 0; i < 6; ++i) {
    ASSERT_LT(model.indices[i], model.vertices.size());
    EXPECT_EQ(model.vertices[model.indices[i]].position, wanted[i]) << i;
  }
}

// Integer colours stand for numbers between 0 and 1, though some files do not say so.
TEST(GltfContent, TakesColoursOfWholeNumbersForParts) {
  GltfBuilder file;
  file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  file.attribute("COLOR_0",
                 file.accessor(file.view(Bytes{255, 0, 51, 0, 255, 0, 51, 0, 255, 0, 51, 0},
                                         R"(,"byteStride":4)"),
                               5121, "VEC3", 3));
  file.primitive = R"(,"material":0)";
  file.more = R"(,"materials":[{}])";
  const Model model = parse_gltf(file.binary(), "part.glb");
  for (const Vertex& v : model.vertices)
    EXPECT_TRUE(v.color.isApprox(Eigen::Vector3f(1, 0, 0.2f), 1e-5f)) << v.color.transpose();
}

// Numbers of things count from zero: indices may be the first accessor of a file.
TEST(GltfContent, ReadsIndicesFromTheFirstAccessor) {
  GltfBuilder file;
  const int indices =
      file.accessor(file.view(std::vector<std::uint16_t>{4, 1, 3}), 5123, "SCALAR", 3);
  ASSERT_EQ(indices, 0);
  file.positions({9, 9, 9, 0, 0, 0, 9, 9, 9, 1, 0, 0, 0, 1, 0});
  file.primitive = R"(,"indices":0)";
  EXPECT_FLOAT_EQ(area(parse_gltf(file.binary(), "part.glb")), 1);
}

// The elements that a sparse accessor leaves alone may lie apart from each other.
TEST(GltfContent, AppliesTheExceptionsOfASparseAccessorWithGaps) {
  GltfBuilder file;
  const int positions = file.view(std::vector<float>{0, 0, 0, 7, 7, 1, 0, 0, 7, 7, 0, 1, 0, 7, 7},
                                  R"(,"byteStride":20)");
  const int which = file.view(std::vector<std::uint16_t>{2});
  const int values = file.view(std::vector<float>{0, 3, 0});
  const std::string sparse =
      R"(,"sparse":{"count":1,"indices":{"bufferView":)" + std::to_string(which) +
      R"(,"componentType":5123},"values":{"bufferView":)" + std::to_string(values) + "}}";
  file.attribute("POSITION", file.accessor(positions, 5126, "VEC3", 3, sparse));
  EXPECT_FLOAT_EQ(area(parse_gltf(file.binary(), "part.glb")), 3);
}

// 3.6.2.2: an accessor may begin within its view, and its elements lie apart.
TEST(GltfContent, ReadsElementsBetweenOthers) {
  GltfBuilder file;
  const int view = file.view(std::vector<float>{7, 7, 0, 0, 0, 7, 7, 1, 0, 0, 7, 7, 0, 1, 0},
                             R"(,"byteStride":20)");
  file.attribute("POSITION", file.accessor(view, 5126, "VEC3", 3, R"(,"byteOffset":8)"));
  EXPECT_FLOAT_EQ(area(parse_gltf(file.binary(), "part.glb")), 1);
}

// 3.7.2.1: integers stand for their part of the largest one; the least is -1, not below.
TEST(GltfContent, ReadsNumbersOfEveryKind) {
  const auto first_colour = [](int view, int kind, GltfBuilder& file) {
    file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
    file.attribute("COLOR_0", file.accessor(view, kind, "VEC4", 3, R"(,"normalized":true)"));
    file.primitive = R"(,"material":0)";
    file.more = R"(,"materials":[{}])";
    return parse_gltf(file.binary(), "part.glb").vertices[0].color;
  };
  const Eigen::Vector3f expected(0, 0.6f, 1);
  GltfBuilder bytes, shorts, signs, signed_shorts;
  EXPECT_TRUE(first_colour(bytes.view(Bytes{0, 153, 255, 255, 0, 0, 0, 0, 0, 0, 0, 0}), 5121, bytes)
                  .isApprox(expected, 1e-5f));
  EXPECT_TRUE(first_colour(shorts.view(std::vector<std::uint16_t>{0, 39321, 65535, 65535, 0, 0, 0,
                                                                  0, 0, 0, 0, 0}),
                           5123, shorts)
                  .isApprox(expected, 1e-5f));
  EXPECT_TRUE(
      first_colour(signs.view(std::vector<std::int8_t>{-128, 76, 127, 127, 0, 0, 0, 0, 0, 0, 0, 0}),
                   5120, signs)
          .isApprox(expected, 5e-3f));
  EXPECT_TRUE(first_colour(signed_shorts.view(std::vector<std::int16_t>{-32768, 19660, 32767, 32767,
                                                                        0, 0, 0, 0, 0, 0, 0, 0}),
                           5122, signed_shorts)
                  .isApprox(expected, 1e-4f));
}

// 3.9.2: a factor beyond its range is taken to the range.
TEST(GltfContent, ReadsTheFactorsOfAMaterial) {
  GltfBuilder file;
  file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  file.primitive = R"(,"material":0)";
  file.more = R"(,"materials":[{"alphaMode":"BLEND","emissiveFactor":[0.1,0.2,0.3],)"
              R"("pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,1.5,0.4],)"
              R"("metallicFactor":0.6,"roughnessFactor":-1}}])";
  const Model model = parse_gltf(file.binary(), "part.glb");
  for (const Vertex& v : model.vertices) {
    EXPECT_TRUE(v.color.isApprox(Eigen::Vector3f(0.1f, 0.2f, 1), 1e-6f));
    EXPECT_TRUE(v.surface.isApprox(Eigen::Vector2f(0.6f, 0), 1e-6f));
    EXPECT_FLOAT_EQ(v.opacity, 0.4f);
  }
  const Finish& finish = model.parts[0].material;
  EXPECT_EQ(finish.glow, (std::array{0.1f, 0.2f, 0.3f}));
  EXPECT_FALSE(finish.two_sided);
  EXPECT_EQ(finish.color, -1);
  EXPECT_EQ(finish.normal, -1);
}

// A texture with coordinates other than the first one's is left out, and one of an unknown kind.
TEST(GltfContent, SaysWhichTexturesAreLeftOut) {
  GltfBuilder file = textured_square();
  file.more += R"(,"materials":[{"normalTexture":{"index":0,"texCoord":1},)"
               R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
  Model model = parse_gltf(file.binary(), "part.glb");
  EXPECT_EQ(model.parts[0].material.normal, -1);
  EXPECT_EQ(model.parts[0].material.color, 0);
  EXPECT_EQ(model.warnings,
            std::vector<std::string>{"a texture that has its own coordinates is ignored"});
  file = textured_square();
  file.more = R"(,"textures":[{"extensions":{"ACME_texture":{}}}],"materials":[{)"
              R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
  model = parse_gltf(file.binary(), "part.glb");
  EXPECT_EQ(model.parts[0].material.color, -1);
  EXPECT_EQ(model.warnings,
            std::vector<std::string>{
                "a texture of a kind that Limpid cannot read is ignored: ACME_texture"});
}

// A node's own transform: turned, then moved, its parent's after it; or a matrix, column by column.
TEST(GltfContent, PlacesNodesInTheirParents) {
  GltfBuilder file;
  file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  file.nodes = R"({"children":[1],"translation":[10,0,0]},)"
               R"({"mesh":0,"translation":[0,2,0],"rotation":[0,0,0.70710678,0.70710678],)"
               R"("scale":[3,1,1]})";
  Model model = parse_gltf(file.binary(), "part.glb");
  EXPECT_TRUE(model.vertices[1].position.isApprox(Eigen::Vector3f(10, 5, 0), 1e-5f));
  EXPECT_TRUE(model.vertices[2].position.isApprox(Eigen::Vector3f(9, 2, 0), 1e-5f));
  file.nodes = R"({"mesh":0,"matrix":[0,3,0,0,-1,0,0,0,0,0,1,0,10,2,0,1]})";
  model = parse_gltf(file.binary(), "part.glb");
  EXPECT_TRUE(model.vertices[1].position.isApprox(Eigen::Vector3f(10, 5, 0), 1e-5f));
  EXPECT_TRUE(model.vertices[2].position.isApprox(Eigen::Vector3f(9, 2, 0), 1e-5f));
}

}  // namespace
}  // namespace limpid
