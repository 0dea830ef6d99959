// Recordings stand alone: without the models that they were made with, they run and look the same.
#include <fmt/format.h>

#include <cstring>
#include <functional>

#include "app/run/recorder.h"
#include "app/run/replay.h"
#include "app/stage/row_view.h"
#include "render/gl/offscreen.h"
#include "tests/app/run/recorded.h"
#include "tests/devices/files/test_files.h"
#include "tests/render/model/gltf_builder.h"
#include "tests/support/computer.h"
#include "tests/support/faultless_context.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using test::first_difference;
using test::recorded;
using test::rows_of;

RunPlan rerun_of(const fs::path& file) {
  const Session session = read_session(file);
  return replay(session, file.string(), session_parameters(session, file.string()));
}

void expect_same(const std::vector<Part>& a, const std::vector<Part>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].first, b[i].first);
    EXPECT_EQ(a[i].count, b[i].count);
    EXPECT_TRUE(a[i].material == b[i].material) << i;
  }
}

void expect_same(const Model& a, const Model& b) {
  static_assert(sizeof(Vertex) == 14 * sizeof(float), "without gaps, to be compared as bytes");
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  EXPECT_EQ(std::memcmp(static_cast<const void*>(a.vertices.data()), b.vertices.data(),
                        a.vertices.size() * sizeof(Vertex)),
            0);
  EXPECT_EQ(a.indices, b.indices);
  EXPECT_EQ(a.coarse, b.coarse);
  expect_same(a.parts, b.parts);
  expect_same(a.coarse_parts, b.coarse_parts);
  ASSERT_EQ(a.images.size(), b.images.size());
  for (std::size_t i = 0; i < a.images.size(); ++i) {
    EXPECT_EQ(a.images[i].width, b.images[i].width);
    EXPECT_EQ(a.images[i].height, b.images[i].height);
    EXPECT_EQ(a.images[i].rgba, b.images[i].rgba);
    EXPECT_EQ(a.images[i].srgb, b.images[i].srgb);
    EXPECT_EQ(a.images[i].wrap_u, b.images[i].wrap_u);
    EXPECT_EQ(a.images[i].wrap_v, b.images[i].wrap_v);
  }
}

// A picture of the plan; empty where EGL gives no context.
std::vector<unsigned char> picture_of(const RunPlan& plan) {
  constexpr int kWidth = 160, kHeight = 100;
  if (!test::has_offscreen_pictures()) return {};
  const test::FaultlessContext context(kWidth, kHeight);
  SceneView view(test::assets_dir() / "../shaders", plan.arm, plan.document.scene,
                 visual_pictures(plan.document));
  view.set_meshes(mesh_pictures(plan.document.scene, plan.models));
  ViewState state;
  const RowLayout layout(plan.arm.dof());
  const std::vector<double> row(static_cast<std::size_t>(layout.stride()));
  state = RowView(plan.arm).view(layout, row);
  Camera camera;
  camera.resize(kWidth, kHeight);
  camera.frame(Bounds(Vec3(0.1, -0.1, -0.1), Vec3(0.3, 0.1, 0.1)));
  camera.finish();
  view.draw(state, camera, 0, 0, kWidth, kHeight);
  return read_rgba(kWidth, kHeight);
}

// Records the plan, takes its models away and runs the recording again; then the same with that
// run's recording.
void expect_to_stand_alone(RunPlan plan, const fs::path& folder,
                           const std::function<void()>& take_away) {
  plan.models = build_meshes(plan.document);
  const Session session = recorded(plan, folder / "first.h5");
  ASSERT_EQ(session.size(), plan.rows);
  const auto picture = picture_of(plan);
  take_away();
  const RunPlan again = rerun_of(folder / "first.h5");
  recorded(again, folder / "second.h5");
  for (const RunPlan& rerun : {again, rerun_of(folder / "second.h5")}) {
    EXPECT_EQ(first_difference(rows_of(session), rows_of(rerun)), -1);
    ASSERT_EQ(rerun.models.size(), plan.models.size());
    for (std::size_t i = 0; i < plan.models.size(); ++i) {
      const auto* mesh = std::get_if<Mesh>(&rerun.document.scene.objects[i].shape);
      if (mesh == nullptr) continue;
      EXPECT_EQ(rerun.document.models.at(mesh->model).path, "") << "read from the session";
      expect_same(*plan.models[i], *rerun.models[i]);
    }
    EXPECT_EQ(picture_of(rerun), picture);
  }
  if (picture.empty()) GTEST_SKIP() << "no EGL: all but the pictures was compared";
}

RunPlan plan_in(const fs::path& scene) {
  RunPlan plan = test::plan("free.toml", "touch.csv", 1.5);
  plan.document = read_scene(scene, plan.arm);
  return plan;
}

TEST(RecordedModels, OfTheGalleryStandAlone) {
  int scenes = 0;
  for (const auto& entry : fs::directory_iterator(test::assets_dir() / "scenes")) {
    if (entry.path().extension() != ".toml") continue;
    SCOPED_TRACE(entry.path());
    ++scenes;
    const test::TempDir dir;
    expect_to_stand_alone(plan_in(entry.path()), dir / "", [] {});
  }
  EXPECT_GE(scenes, 7);
}

std::string base64(const Bytes& bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? bytes[i + k] : 0);
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : kDigits[word >> (18 - 6 * k) & 63];
    }
  }
  return text;
}

constexpr const char* kBinary = "data:application/octet-stream;base64,";

// A sheet of 0.2 m with a picture on it; `rest` holds its images and buffers.
struct Sheet {
  Bytes corners, others;

  Sheet() {
    append_values<float>(corners, {0, 0, 0, 0.2f, 0, 0, 0, 0.2f, 0, 0.2f, 0.2f, 0});
    append_values<float>(others, {0, 0, 1, 0, 0, 1, 1, 1});          // places on the picture
    append_values<std::uint16_t>(others, {0, 1, 2, 0, 1, 3, 2, 0});  // two lists of three
  }
  // Two triangles of two materials, from two buffers.
  std::string json(const std::string& first, const std::string& second,
                   const std::string& images) const {
    return fmt::format(
        R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],)"
        R"("meshes":[{{"primitives":[)"
        R"({{"attributes":{{"POSITION":0,"TEXCOORD_0":1}},"indices":2,"material":0}},)"
        R"({{"attributes":{{"POSITION":0,"TEXCOORD_0":1}},"indices":3,"material":1}}]}}],)"
        R"("accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":4}},)"
        R"({{"bufferView":1,"componentType":5126,"type":"VEC2","count":4}},)"
        R"({{"bufferView":2,"componentType":5123,"type":"SCALAR","count":3}},)"
        R"({{"bufferView":2,"byteOffset":8,"componentType":5123,"type":"SCALAR","count":3}}],)"
        R"("bufferViews":[{{"buffer":0,"byteLength":48}},{{"buffer":1,"byteLength":32}},)"
        R"({{"buffer":1,"byteOffset":32,"byteLength":16}}],)"
        R"("materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}},)"
        R"("metallicFactor":0.25}}}},{{"doubleSided":true,"pbrMetallicRoughness":)"
        R"({{"baseColorFactor":[0.1,0.9,0.3,1],"metallicRoughnessTexture":{{"index":1}}}}}}],)"
        R"("samplers":[{{"wrapS":33071}}],)"
        R"("textures":[{{"source":0,"sampler":0}},{{"source":1}}],"images":[{}],)"
        R"("buffers":[{{"byteLength":48{}}},{{"byteLength":48{}}}]}})",
        images, first, second);
  }
};

std::string uri(const std::string& text) { return fmt::format(R"(,"uri":"{}")", text); }

class OddModels : public testing::Test {
 protected:
  OddModels() { fs::create_directories(folder_ / "pictures of it"); }

  void write(const fs::path& name, const Bytes& bytes) {
    test::write_file(folder_ / name, std::string(bytes.begin(), bytes.end()));
  }
  void write_text(const fs::path& name, const std::string& text) {
    test::write_file(folder_ / name, text);
  }
  // Expects that a scene of these models is recorded and runs again without them.
  void expect_to_be_carried(const std::vector<std::string>& files) {
    std::string toml;
    for (std::size_t i = 0; i < files.size(); ++i) {
      toml += fmt::format(
          "[[mesh]]\nname = \"mesh {0}\"\nfile = \"{1}\"\nposition = [0.1, -0.1, {2}]\n"
          "stiffness = 600.0\n",
          i, files[i], -0.04 - 0.01 * static_cast<double>(i));
    }
    write_text("scene.toml", toml);
    expect_to_stand_alone(plan_in(folder_ / "scene.toml"), dir_ / "",
                          [&] { fs::remove_all(folder_); });
  }

  const test::TempDir dir_;
  const fs::path folder_ = dir_ / "a folder, \xCE\xB7";
  const Sheet sheet_;
};

TEST_F(OddModels, OfSeveralMaterialsWithFilesBesideThem) {
  write_text("part.gltf", sheet_.json(uri("corners.bin"), uri("pictures%20of%20it/rest%231.bin"),
                                      R"({"uri":"pictures%20of%20it/red.png"},)"
                                      R"({"uri":"pictures%20of%20it/red.png"})"));
  write("corners.bin", sheet_.corners);
  write("pictures of it/rest#1.bin", sheet_.others);
  write("pictures of it/red.png", kRedPng);
  expect_to_be_carried({"part.gltf"});
}

TEST_F(OddModels, OfDataInTheirTextAndOneFileBesideIt) {
  write_text("part.gltf",
             sheet_.json(uri(kBinary + base64(sheet_.corners)), uri("others.bin"),
                         R"({"uri":"data:image/png;base64,)" + base64(kRedPng) +
                             R"("},{"uri":"red.png","mimeType":"image/png","name":"red"})"));
  write("others.bin", sheet_.others);
  write("red.png", kRedPng);
  expect_to_be_carried({"part.gltf"});
}

TEST_F(OddModels, OfNothingButTheirText) {
  const std::string red = R"({"uri":"data:image/png;base64,)" + base64(kRedPng) + R"("})";
  write_text("part.gltf", sheet_.json(uri(kBinary + base64(sheet_.corners)),
                                      uri(kBinary + base64(sheet_.others)), red + "," + red));
  expect_to_be_carried({"part.gltf"});
}

TEST_F(OddModels, OfABinaryFileWithPicturesAndABufferBesideIt) {
  write("part.glb",
        glb(sheet_.json("", uri("others.bin"), R"({"uri":"red.png"},{"uri":"red.png"})"),
            sheet_.corners));
  write("others.bin", sheet_.others);
  write("red.png", kRedPng);
  expect_to_be_carried({"part.glb"});
}

TEST_F(OddModels, WithAPictureThatIsMissing) {
  write("part.glb",
        glb(sheet_.json("", uri("others.bin"), R"({"uri":"red.png"},{"uri":"none.png"})"),
            sheet_.corners));
  write("others.bin", sheet_.others);
  write("red.png", kRedPng);
  expect_to_be_carried({"part.glb"});
}

TEST_F(OddModels, WithNothingButAPictureThatIsMissing) {
  const std::string none = R"({"uri":"none.png"})";
  write_text("part.gltf", sheet_.json(uri(kBinary + base64(sheet_.corners)),
                                      uri(kBinary + base64(sheet_.others)), none + "," + none));
  expect_to_be_carried({"part.gltf"});
}

TEST_F(OddModels, OfOneFileTwiceAndSuffixesInCapitals) {
  const std::string images = R"({"uri":"red.png"},{"uri":"red.png"})";
  write_text("PART.GLTF", sheet_.json(uri("corners.bin"), uri("others.bin"), images));
  write("OTHER PART.GLB", glb(sheet_.json("", uri("others.bin"), images), sheet_.corners));
  write("corners.bin", sheet_.corners);
  write("others.bin", sheet_.others);
  write("red.png", kRedPng);
  expect_to_be_carried({"PART.GLTF", "OTHER PART.GLB", "PART.GLTF"});
  EXPECT_EQ(read_session(dir_ / "first.h5").info.models.size(), 2u);
}

// Decoration is not carried: it is left out when its file is gone.
TEST_F(OddModels, OfDecorationThatIsGoneDoNotKeepARecordingFromBeingOpened) {
  fs::copy(test::assets_dir() / "scenes/table.glb", folder_ / "table.glb");
  const std::string table = (folder_ / "table.glb").string();
  write_text("scene.toml", "[[visual]]\nfile = \"" + table + "\"\n");
  RunPlan plan = plan_in(folder_ / "scene.toml");
  ASSERT_EQ(plan.document.visuals.size(), 1u);
  std::string urdf = plan.arm.urdf;
  const std::size_t mesh = urdf.find("filename=\"");
  ASSERT_NE(mesh, std::string::npos);
  const std::size_t name = mesh + std::strlen("filename=\"");
  urdf.replace(name, urdf.find('"', name) - name, table);
  plan.arm = parse_urdf(urdf, "arm.urdf", test::assets_dir() / "devices");
  const Session session = recorded(plan, dir_ / "a.h5");
  fs::remove_all(folder_);
  const RunPlan again = rerun_of(dir_ / "a.h5");
  EXPECT_TRUE(again.document.visuals.empty());
  EXPECT_EQ(first_difference(rows_of(session), rows_of(again)), -1);
}

TEST_F(OddModels, WithoutABufferAreRefused) {
  write_text("part.gltf", sheet_.json(uri("none.bin"), uri("others.bin"),
                                      R"({"uri":"red.png"},{"uri":"red.png"})"));
  write("others.bin", sheet_.others);
  write_text("scene.toml", "[[mesh]]\nname = \"m\"\nfile = \"part.gltf\"\nstiffness = 600.0\n");
  RunPlan plan = plan_in(folder_ / "scene.toml");
  EXPECT_THAT(test::refusal([&] { build_meshes(plan.document); }),
              testing::AllOf(testing::HasSubstr("part.gltf"), testing::HasSubstr("none.bin")));
}

}  // namespace
}  // namespace limpid
