// Files that are too large, broken, or name files they must not read.
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>

#include "render/model/gltf_model.h"
#include "tests/render/model/gltf_builder.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

void expect_part_refused(const Bytes& bytes, const std::string& reason,
                         const std::filesystem::path& folder = {}) {
  try {
    parse_gltf(bytes, "part.gltf", folder);
    ADD_FAILURE() << "was read, though: " << reason;
  } catch (const std::runtime_error& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_NE(message.find(reason), std::string::npos) << message;
  }
}

GltfBuilder triangle() {
  GltfBuilder file;
  file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  return file;
}

class GltfFolder : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_ / "parts"); }
  static void write(const std::filesystem::path& path, const Bytes& bytes) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  const test::TempDir dir_;
  const std::filesystem::path folder_ = dir_ / "";
};

TEST_F(GltfFolder, ReadsBuffersAndImagesBesideTheFile) {
  GltfBuilder file = triangle();
  file.uri = "parts/my%20data.bin";
  file.primitive = R"(,"material":0)";
  file.more = R"(,"images":[{"uri":"parts/red.png"}],"textures":[{"source":0}],"materials":[{)"
              R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
  write(folder_ / "part.gltf", file.text());
  write(folder_ / "parts/my data.bin", file.data);
  write(folder_ / "parts/red.png", kRedPng);
  const Model model = load_gltf(folder_ / "part.gltf");
  EXPECT_EQ(model.indices.size(), 3u);
  ASSERT_EQ(model.images.size(), 1u);
  EXPECT_EQ(model.images[0].rgba, (Bytes{255, 0, 0, 255}));
}

// Names that were never encoded are files of exactly that name.
TEST_F(GltfFolder, TakesTheFileOfExactlyThatNameBeforeTheOneThatItEncodes) {
  GltfBuilder file = triangle();
  for (const char* name : {"100%25.bin", "a%2Fb.bin", "%41.bin", "a+b.bin", "50%.bin"}) {
    file.uri = name;
    write(folder_ / name, file.data);
    EXPECT_EQ(parse_gltf(file.text(), "part.gltf", folder_).indices.size(), 3u) << name;
  }
  write(folder_ / "A.bin", {1});
  file.uri = "%41.bin";
  EXPECT_EQ(parse_gltf(file.text(), "part.gltf", folder_).indices.size(), 3u);
  std::filesystem::remove(folder_ / "%41.bin");
  write(folder_ / "A.bin", file.data);
  EXPECT_EQ(parse_gltf(file.text(), "part.gltf", folder_).indices.size(), 3u);
}

TEST_F(GltfFolder, NamesAMissingImageAsItIsWritten) {
  GltfBuilder file = triangle();
  file.primitive = R"(,"material":0)";
  file.more = R"(,"images":[{"uri":"no+100%25.png"}],"textures":[{"source":0}],"materials":[{)"
              R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
  const Model model = parse_gltf(file.binary(), "part.glb", folder_);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_NE(model.warnings[0].find("\"no+100%25.png\") is missing"), std::string::npos);
}

TEST_F(GltfFolder, NamesABufferThatIsMissing) {
  GltfBuilder file = triangle();
  file.uri = "nowhere.bin";
  expect_part_refused(file.text(), "nowhere.bin", folder_);
}

TEST_F(GltfFolder, DrawsWithoutAnImageThatIsMissing) {
  GltfBuilder file = triangle();
  file.primitive = R"(,"material":0)";
  file.more = R"(,"images":[{"uri":"nowhere.png"}],"textures":[{"source":0}],"materials":[{)"
              R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])";
  const Model model = parse_gltf(file.binary(), "part.glb", folder_);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_NE(model.warnings[0].find("\"nowhere.png\") is missing"), std::string::npos);
}

TEST_F(GltfFolder, RefusesFilesOutsideOfItsFolder) {
  GltfBuilder file = triangle();
  write(folder_ / "outside.bin", file.data);
  std::filesystem::create_symlink(folder_ / "outside.bin", folder_ / "parts/link.bin");
  for (const char* uri :
       {"../outside.bin", "/etc/passwd", "file:///etc/passwd", "%2e%2e/outside.bin",
        "http://example.org/a.bin", "a/../../outside.bin", "C:\\\\a.bin", "link.bin"}) {
    file.uri = uri;
    expect_part_refused(file.text(), "own folder", folder_ / "parts");
  }
}

TEST_F(GltfFolder, RefusesWhatIsNoFile) {
  GltfBuilder file = triangle();
  file.uri = "parts";
  expect_part_refused(file.text(), "cannot be read", folder_);
  EXPECT_THROW(load_gltf(folder_), std::runtime_error);
}

TEST(GltfLimits, RefusesOtherFilesWithoutAFolder) {
  GltfBuilder file = triangle();
  file.uri = "part.bin";
  expect_part_refused(file.text(), "must contain everything itself");
}

TEST(GltfLimits, NamesAnExtensionThatIsRequiredAndUnknown) {
  for (const char* name : {"EXT_mesh_gpu_instancing", "ACME_shape"}) {
    GltfBuilder file = triangle();
    file.more = R"(,"extensionsRequired":[")" + std::string(name) + "\"]";
    expect_part_refused(file.binary(), name);
  }
}

TEST(GltfLimits, RefusesANodeWithTwoParents) {
  GltfBuilder file = triangle();
  file.nodes = R"({"children":[1,1]},{"mesh":0})";
  expect_part_refused(file.binary(), "node 1 has two parents or is its own parent");
}

TEST(GltfLimits, RefusesDeepNesting) {
  GltfBuilder file = triangle();
  file.nodes.clear();
  for (int i = 1; i <= 300; ++i) file.nodes += R"({"children":[)" + std::to_string(i) + "]},";
  file.nodes += R"({"mesh":0})";
  expect_part_refused(file.binary(), "nested deeper than 256");
  const std::string brackets = R"({"asset":)" + std::string(100'000, '[');
  expect_part_refused(Bytes(brackets.begin(), brackets.end()), "nested deeper than 64");
}

// A small file may ask for a lot: here 20 copies of half a million triangles.
TEST(GltfLimits, CountsTrianglesOverAllNodes) {
  GltfBuilder file = triangle();
  const std::vector<std::uint8_t> corners(3 * 500'000, 0);
  file.primitive = R"(,"indices":)" + std::to_string(file.accessor(file.view(corners), 5121,
                                                                   "SCALAR", corners.size()));
  file.nodes.clear();
  for (int i = 0; i < 20; ++i) {
    file.nodes += std::string(i > 0 ? "," : "") + R"({"mesh":0})";
    if (i > 0) file.roots += "," + std::to_string(i);
  }
  expect_part_refused(file.binary(), "more than 6 million triangles in all nodes together");
}

// An accessor without a view is zeros, which take memory that the file does not have.
TEST(GltfLimits, RefusesZerosThatTakeHalfAGibibyte) {
  GltfBuilder file;
  file.view(std::vector<float>(4));     // the file's own data
  const std::size_t many = 50'000'000;  // of 12 bytes
  file.attribute("POSITION", file.accessor(-1, 5126, "VEC3", many));
  expect_part_refused(file.binary(), "more than 512 MiB in compressed, sparse or empty accessors");
}

TEST(GltfLimits, RefusesSeveralBuffersForOneBinaryChunk) {
  GltfBuilder file = triangle();
  std::string json = file.json();
  for (const std::string& list : {std::string(R"("buffers":[)"), std::string(R"("bufferViews":[)")})
    json.replace(json.find(list), list.size(),
                 list + (list.find("Views") == list.npos ? R"({"byteLength":4},)"
                                                         : R"({"buffer":1,"byteLength":4},)"));
  expect_part_refused(glb(json, file.data), "more than one buffer without a uri");
}

TEST(GltfLimits, RefusesASmallFileThatWouldMakeAMillionMaterials) {
  std::string json = R"({"asset":{"version":"2.0"},"materials":[{})";
  for (int i = 0; i < 1'100'000; ++i) json += ",{}";
  json += "]}";
  expect_part_refused(Bytes(json.begin(), json.end()), "more than 1 million JSON objects");
}

TEST(GltfLimits, RefusesVerticesOutOfThisWorld) {
  GltfBuilder file;
  file.positions({0, 0, 0, 1e30f, 0, 0, 0, 1, 0});
  expect_part_refused(file.binary(), "more than 1e6 m");
}

TEST(GltfLimits, RefusesADegenerateModel) {
  GltfBuilder file = triangle();
  file.primitive = R"(,"indices":)" +
                   std::to_string(file.accessor(file.view(Bytes{1, 1, 1}), 5121, "SCALAR", 3));
  expect_part_refused(file.binary(), "contains no triangles");
}

// A percent sign, or Draco's name, has the JSON read once more before the usual reader.
TEST(GltfLimits, RefusesJsonThatIsNoObjectAsEveryOtherModel) {
  for (const std::string json :
       {"55 ", "[\"%\"]", "\"%\"", "{\"meshes\":[{\"primitives\":[5,\"%\"]}]}", "{\"%",
        "{\"meshes\":[{\"primitives\":[\"KHR_draco_mesh_compression\"]}]}"}) {
    const Bytes text(json.begin(), json.end());
    EXPECT_THROW(parse_gltf(text, "part.gltf"), std::runtime_error) << json;
    EXPECT_THROW(
        parse_gltf(glb(json + std::string((4 - json.size() % 4) % 4, ' '), {}), "part.glb"),
        std::runtime_error)
        << json;
  }
}

TEST(GltfLimits, SaysWhereTheJsonBreaks) {
  const std::string json = R"({"asset":{"version":"2.0"},)";
  expect_part_refused(Bytes(json.begin(), json.end()), "is not valid JSON at its byte");
}

TEST(GltfLimits, ReportsProgressAndStopsWhenAsked) {
  const Bytes bytes = triangle().binary();
  std::atomic<double> part{0};
  std::atomic<bool> cancel{false};
  parse_gltf(bytes, "part.glb", {}, {.part = &part, .cancel = &cancel});
  EXPECT_EQ(part.load(), 1);
  cancel = true;
  EXPECT_THROW(parse_gltf(bytes, "part.glb", {}, {.part = &part, .cancel = &cancel}),
               LoadCancelled);
}

TEST(GltfLimits, ReadsNoMeshOfAFileThatIsNotWantedAnyMore) {
  GltfBuilder file = triangle();
  file.nodes = R"({"mesh":0},{"mesh":0},{"mesh":0},{"mesh":0})";
  file.roots = "0,1,2,3";
  std::atomic<double> part{0};
  const std::atomic<bool> cancel{true};
  EXPECT_THROW(parse_gltf(file.binary(), "part.glb", {}, {.part = &part, .cancel = &cancel}),
               LoadCancelled);
  EXPECT_LT(part.load(), 0.5);  // three of the four would be three quarters
}

TEST(GltfViews, AreRefusedWhereTheyReachOutsideOfTheirBuffer) {
  for (const char* view : {R"({"buffer":0,"byteOffset":0,"byteLength":1000})",
                           R"({"buffer":0,"byteOffset":900,"byteLength":36})"}) {
    GltfBuilder file;
    file.view(std::vector<float>(9, 0.5f));
    file.views = view;
    file.attribute("POSITION", file.accessor(0, 5126, "VEC3", 3));
    expect_part_refused(file.binary(), "extends outside its buffer");
  }
}

}  // namespace
}  // namespace limpid
