// Models of other formats than glTF, which a program of its own reads.
#include "render/model/model_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <bit>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "render/model/model_program.h"
#include "tests/render/model/gltf_builder.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using Eigen::Vector3f;

const std::array<Vector3f, 4> kCorners = {Vector3f(0, 0, 0), Vector3f(1, 0, 0), Vector3f(0, 2, 0),
                                          Vector3f(0, 0, 3)};
const std::array<std::array<int, 3>, 4> kFaces = {{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

Bytes binary_stl() {
  Bytes out(80, ' ');
  append_word(out, kFaces.size());
  for (const auto& face : kFaces) {
    append_values<float>(out, {0, 0, 0});
    for (const int i : face) {
      const Vector3f& p = kCorners[static_cast<std::size_t>(i)];
      append_values<float>(out, {p.x(), p.y(), p.z()});
    }
    append_values<std::uint16_t>(out, {0});
  }
  return out;
}

std::string text_stl() {
  std::string out = "solid tetrahedron\n";
  for (const auto& face : kFaces) {
    out += "facet normal 0 0 0\nouter loop\n";
    for (const int i : face) {
      const Vector3f& p = kCorners[static_cast<std::size_t>(i)];
      out += fmt::format("vertex {} {} {}\n", p.x(), p.y(), p.z());
    }
    out += "endloop\nendfacet\n";
  }
  return out + "endsolid tetrahedron\n";
}

std::string obj(const std::string& before = "", const std::string& between = "") {
  std::string out = before;
  for (const Vector3f& p : kCorners) out += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
  for (std::size_t i = 0; i < kFaces.size(); ++i) {
    if (i == 2) out += between;
    out += fmt::format("f {} {} {}\n", kFaces[i][0] + 1, kFaces[i][1] + 1, kFaces[i][2] + 1);
  }
  return out;
}

std::string ply() {
  std::string out =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vector3f& p : kCorners) out += fmt::format("{} {} {} 255 0 0\n", p.x(), p.y(), p.z());
  for (const auto& face : kFaces) out += fmt::format("3 {} {} {}\n", face[0], face[1], face[2]);
  return out;
}

// Six times the volume of a closed body; of the tetrahedron 1 * 2 * 3.
float volume(const Model& model) {
  float sum = 0;
  for (std::size_t i = 0; i < model.indices.size(); i += 3) {
    const auto at = [&](std::size_t k) { return model.vertices[model.indices[i + k]].position; };
    sum += at(0).dot(at(1).cross(at(2)));
  }
  return sum;
}

std::string refusal_of(const Bytes& bytes, const std::string& name) {
  try {
    parse_model(bytes, name);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(ModelFile, ReadsTheSameBodyFromEveryKind) {
  for (const auto& [name, bytes] : std::map<std::string, Bytes>{{"a.stl", binary_stl()},
                                                                {"b.STL", bytes_of(text_stl())},
                                                                {"c.Obj", bytes_of(obj())},
                                                                {"d.ply", bytes_of(ply())}}) {
    const Model model = parse_model(bytes, name);
    EXPECT_EQ(model.indices.size(), 12u) << name;
    EXPECT_EQ(model.vertices.size(), 4u) << name;  // STL's equal corners are joined
    EXPECT_FLOAT_EQ(volume(model), 6) << name;
    EXPECT_TRUE(model.parts[0].material.flat) << name;
    EXPECT_EQ(model.unit, 0) << name;
    EXPECT_EQ(model.up, Model::Up::unsaid) << name;
  }
}

std::string dae(const std::string& encoding = "utf-8") {
  std::string points, corners;
  for (const Vector3f& p : kCorners) points += fmt::format("{} {} {} ", p.x(), p.y(), p.z());
  for (const auto& face : kFaces) corners += fmt::format("{} {} {} ", face[0], face[1], face[2]);
  return "<?xml version=\"1.0\" encoding=\"" + encoding +
         "\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">"
         "<asset><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id=\"g\"><mesh>"
         "<source id=\"p\"><float_array id=\"pa\" count=\"12\">" +
         points +
         "</float_array><technique_common><accessor source=\"#pa\" count=\"4\" stride=\"3\">"
         "<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/>"
         "<param name=\"Z\" type=\"float\"/></accessor></technique_common></source>"
         "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>"
         "<triangles count=\"4\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>" +
         corners +
         "</p></triangles></mesh></geometry></library_geometries><library_visual_scenes>"
         "<visual_scene id=\"s\"><node id=\"n\"><instance_geometry url=\"#g\"/></node>"
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene>"
         "</COLLADA>";
}

// A tetrahedron as PLY, with this first coordinate, and perhaps elements without a meaning here.
Bytes binary_ply(float first, const std::string& element = "", const Bytes& its_data = {}) {
  Bytes out = bytes_of("ply\nformat binary_little_endian 1.0\n" + element +
                       "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                       "element face 4\nproperty list uchar int vertex_indices\nend_header\n");
  out.insert(out.end(), its_data.begin(), its_data.end());
  for (std::size_t i = 0; i < kCorners.size(); ++i) {
    const Vector3f& p = kCorners[i];
    append_values<float>(out, {i == 0 ? first : p.x(), p.y(), p.z()});
  }
  for (const auto& face : kFaces) {
    append_values<std::uint8_t>(out, {3});
    for (const int i : face) append_values<std::int32_t>(out, {i});
  }
  return out;
}

float from_bits(std::uint32_t bits) { return std::bit_cast<float>(bits); }

Bytes wide(const std::string& text, bool big) {
  Bytes out = big ? Bytes{0xFE, 0xFF} : Bytes{0xFF, 0xFE};
  for (const char c : text) {
    if (big) out.push_back(0);
    out.push_back(static_cast<unsigned char>(c));
    if (!big) out.push_back(0);
  }
  return out;
}

// Each of these files is valid, and the library refuses it or crashes.
TEST(ModelFile, ReadsWhatItsLibraryDoesNot) {
  const std::string empty = "solid two\nendsolid two\n";
  std::string small = obj();
  small.replace(small.find("v 0 0 0"), 7, "v .0e-1 -.0\t.0");
  // Some programs write binary STL like this; only its length shows that it is no text.
  const std::string_view title = "solid one\nendsolid one\nsolid two\nendsolid two\n";
  Bytes titled = binary_stl();
  std::ranges::copy(title, titled.begin());
  const std::map<std::string, Bytes> all{
      {"empty solid behind.stl", bytes_of(text_stl() + empty)},
      {"empty solid before.stl", bytes_of(empty + text_stl())},
      {"binary behind the word solid.stl", titled},
      {"no zero before the point.obj", bytes_of(small)},
      {"line end.ply", binary_ply(from_bits(0x3000000a))},
      {"line ends.ply", binary_ply(from_bits(0x300a0d0a))},
      {"no line end.ply", binary_ply(0)},
      {"camera.ply", binary_ply(0, "element camera 2\nproperty uchar a\n", {7, 8})},
      {"little.dae", wide(dae("utf-16"), false)},
      {"big.dae", wide(dae("utf-16"), true)},
      {"blanks.dae", bytes_of(" \r\n\t" + dae())},
      {"plain.dae", bytes_of(dae())},
  };
  for (const auto& [name, bytes] : all) {
    const Model model = parse_model(bytes, name);
    EXPECT_EQ(model.indices.size(), 12u) << name;
    EXPECT_NEAR(volume(model), 6, 1e-5) << name;
    if (name.ends_with(".dae")) {
      EXPECT_EQ(model.up, Model::Up::z) << name;
    }
  }
  const Model model = parse_model(binary_ply(from_bits(0x3000000a)), "a.ply");
  EXPECT_TRUE(std::ranges::any_of(
      model.vertices, [](const Vertex& v) { return v.position.x() == from_bits(0x3000000a); }));
}

TEST(ModelFile, KeepsTheColoursOfVertices) {
  for (const Vertex& v : parse_model(bytes_of(ply()), "a.ply").vertices)
    EXPECT_TRUE(v.color.isApprox(Vector3f(1, 0, 0)));
}

// An OBJ file in a folder with materials and a picture.
class ModelFolder : public testing::Test {
 protected:
  void SetUp() override {
    write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl seen\nKd 0 0 0\nmap_Kd red.png\n");
    write("red.png", std::string(kRedPng.begin(), kRedPng.end()));
    write("a.obj", obj("mtllib a.mtl\nvt 0 0\nusemtl red\n", "usemtl seen\n"));
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  const test::TempDir dir_;
  const std::filesystem::path folder_ = dir_ / "";
};

void expect_red_and_picture(const Model& model) {
  ASSERT_EQ(model.parts.size(), 2u);
  ASSERT_EQ(model.images.size(), 1u);
  for (const Part& part : model.parts) {
    EXPECT_EQ(part.count, 6u);
    const Vertex& v = model.vertices[model.indices[part.first]];
    EXPECT_TRUE(v.color.isApprox(part.material.color >= 0 ? Vector3f(1, 1, 1) : Vector3f(1, 0, 0)));
  }
  EXPECT_TRUE(model.warnings.empty());
}

TEST_F(ModelFolder, HasSeveralMaterialsAndPictures) {
  expect_red_and_picture(load_model_file(folder_ / "a.obj"));
}

TEST_F(ModelFolder, CanBeCarriedAway) {
  const std::string text = obj("mtllib a.mtl\nvt 0 0\nusemtl red\n", "usemtl seen\n");
  std::vector<unsigned char> whole;
  const Model here = parse_model(bytes_of(text), "a.obj", folder_, {}, &whole);
  ASSERT_FALSE(whole.empty());
  const Model there = parse_model(whole, "a.obj");
  expect_red_and_picture(there);
  EXPECT_EQ(there.indices, here.indices);
  for (std::size_t i = 0; i < here.vertices.size(); ++i)
    EXPECT_EQ(there.vertices[i].position, here.vertices[i].position);
}

TEST_F(ModelFolder, IsCarriedAwayWithTheNormalsOfItsSmoothPart) {
  const std::string text =
      "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0.6 0 0.8\nvn 0 0.6 0.8\nvn 0 0 1\n"
      "usemtl red\nf 1//1 2//2 3//3\nusemtl seen\nf 1 2 4\n";
  std::vector<unsigned char> whole;
  const Model here = parse_model(bytes_of(text), "a.obj", folder_, {}, &whole);
  const Model there = parse_model(whole, "a.obj");
  for (const Model* model : {&here, &there}) {
    ASSERT_EQ(model->indices.size(), 6u);
    std::map<std::string, int> seen;
    for (const std::uint32_t i : model->indices) {
      const Vector3f n = model->vertices[i].normal;
      ++seen[fmt::format("{:.1f} {:.1f} {:.1f}", n.x() + 0.0f, std::abs(n.y()), n.z() + 0.0f)];
    }
    EXPECT_EQ(seen,
              (std::map<std::string, int>{
                  {"0.6 0.0 0.8", 1}, {"0.0 0.6 0.8", 1}, {"0.0 0.0 1.0", 1}, {"0.0 1.0 0.0", 3}}))
        << (model == &here ? "as it is read" : "carried away");
  }
}

// An OBJ does not say which side is seen; a density that nobody could see is not meant.
TEST_F(ModelFolder, IsSeenFromBothSidesAndAsDenseAsItsMaterialSays) {
  for (const auto& [dense, opacity] :
       std::map<std::string, float>{{"1", 1.0f}, {"0.5", 0.5f}, {"0.01", 1.0f}}) {
    write("a.mtl", "newmtl red\nKd 1 0 0\nd " + dense + "\n");
    const Model model = parse_model(bytes_of(obj("mtllib a.mtl\nusemtl red\n")), "a.obj", folder_);
    ASSERT_EQ(model.parts.size(), 1u);
    EXPECT_TRUE(model.parts[0].material.two_sided) << dense;
    EXPECT_EQ(model.parts[0].material.alpha,
              opacity < 1 ? Finish::Alpha::blend : Finish::Alpha::opaque)
        << dense;
    EXPECT_FLOAT_EQ(model.vertices[model.indices[0]].opacity, opacity) << dense;
  }
}

// Programs with physically based materials write an anisotropy of highlights.
TEST_F(ModelFolder, MayHaveMaterialsWithAnisotropy) {
  write("a.mtl",
        "newmtl red\nKd 1 0 0\naniso 0.5\nanisor .1\nnewmtl seen\nKd 0 0 0\nmap_Kd red.png\n");
  expect_red_and_picture(load_model_file(folder_ / "a.obj"));
}

TEST_F(ModelFolder, StaysTouchableWithoutItsFiles) {
  std::filesystem::remove(folder_ / "red.png");
  const Model model = load_model_file(folder_ / "a.obj");
  EXPECT_EQ(model.indices.size(), 12u);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_NE(model.warnings[0].find("\"red.png\" is missing"), std::string::npos);
}

TEST_F(ModelFolder, HasNothingFromOutside) {
  write("a.mtl", "newmtl red\nmap_Kd ../../etc/passwd\n");
  const Model model = load_model_file(folder_ / "a.obj");
  ASSERT_FALSE(model.warnings.empty());
  EXPECT_NE(model.warnings[0].find("outside the model's folder"), std::string::npos);
}

TEST(ModelFile, NeedsNoOtherFileOfOneThatStandsAlone) {
  std::vector<unsigned char> whole;
  parse_model(binary_stl(), "a.stl", "/tmp", {}, &whole);
  EXPECT_TRUE(whole.empty());
}

TEST(ModelFile, SaysWhatCannotBeRead) {
  EXPECT_NE(refusal_of({1}, "a.step").find("allowed: .glb, .gltf, .stl"), std::string::npos);
  EXPECT_EQ(refusal_of({}, "a.stl"), "a.stl: is empty");
  EXPECT_EQ(refusal_of(bytes_of("solid a\nfacet normal 0 0 1\nouter loop\nvertex a b c\nendloop\n"
                                "endfacet\nendsolid\n"),
                       "a.stl"),
            "a.stl: there should be a number, but there is \"a b c\"");
  Bytes cut = binary_stl();
  cut.resize(cut.size() - 10);
  EXPECT_NE(refusal_of(cut, "a.stl").find("its length does not match its number of triangles"),
            std::string::npos);
  EXPECT_NE(refusal_of(bytes_of("v 0 0 0\nv 1 0 0\nl 1 2\n"), "a.obj").find("no triangles"),
            std::string::npos);
}

// The result is a model, or an error of one line that names the file.
TEST(ModelFile, OutlivesFilesThatAreCutOffOrChanged) {
  const std::map<std::string, Bytes> all{
      {"a.stl", binary_stl()}, {"a.obj", bytes_of(obj())}, {"a.ply", bytes_of(ply())}};
  for (const auto& [name, bytes] : all) {
    for (std::size_t i = 1; i < 8; ++i) {
      Bytes broken(bytes.begin(), bytes.begin() + static_cast<long>(i * bytes.size() / 8));
      broken[broken.size() / 2] ^= 0x55;
      if (const std::string why = refusal_of(broken, name); !why.empty()) {
        EXPECT_EQ(why.find(name + ": "), 0u) << why;
      }
    }
  }
}

// Without a check of the header first this took seconds.
TEST(ModelFile, SaysThatAPlyIsCutOffInItsHeader) {
  const std::string text = ply();
  EXPECT_EQ(refusal_of(bytes_of(text.substr(0, text.find("end_header"))), "a.ply"),
            "a.ply: is not complete: its header has no end_header");
}

// Forty nodes, each with two references to the one before.
TEST(ModelFile, SaysThatItWouldTakeTooMuch) {
  std::string nodes = "<library_nodes><node id=\"n0\"><instance_geometry url=\"#g\"/></node>";
  for (int i = 1; i < 40; ++i) {
    nodes += fmt::format(
        "<node id=\"n{0}\"><instance_node url=\"#n{1}\"/><instance_node url=\"#n{1}\"/></node>", i,
        i - 1);
  }
  std::string text = dae();
  text.insert(text.find("<library_visual_scenes>"), nodes + "</library_nodes>");
  const std::string one = "<instance_geometry url=\"#g\"/></node></visual_scene>";
  text.replace(text.find(one), one.size(), "<instance_node url=\"#n39\"/></node></visual_scene>");
  const std::string why = refusal_of(bytes_of(text), "a.dae");
  EXPECT_NE(why.find("this is the limit for a model of its size"), std::string::npos) << why;
}

int status_of(void (*end)()) {
  const pid_t child = fork();
  if (child == 0) {
    const rlimit none{0, 0};
    setrlimit(RLIMIT_CORE, &none);
    end();
    _exit(0);
  }
  int status = -1;
  waitpid(child, &status, 0);
  return status;
}

TEST(ModelFile, SaysHowItsReaderEnded) {
  const ReaderLimits limits = reader_limits(1000);
  const auto why = [&](void (*end)()) { return why_ended(status_of(end), limits); };
  EXPECT_EQ(why([] {}), "");
  EXPECT_EQ(why([] { _exit(3); }), "cannot be read: the program limpid-model ended with status 3");
  EXPECT_EQ(why([] { std::abort(); }), "is damaged: the program that reads it crashed (SIGABRT)");
  EXPECT_EQ(why([] { kill(getpid(), SIGSEGV); }),
            "is damaged: the program that reads it crashed (SIGSEGV)");
  EXPECT_EQ(why([] { kill(getpid(), SIGXCPU); }),
            "takes more than 3 s to be read; this is the limit for a model of its size");
}

// The count exceeds any file of this size: no memory for it must be requested.
TEST(ModelFile, OutlivesAPlyOfFourBillionVertices) {
  std::string text = ply();
  text.replace(text.find("vertex 4"), 8, "vertex 4000000000");
  EXPECT_EQ(refusal_of(bytes_of(text), "a.ply"),
            "a.ply: says that it has more data than a file of its size can have");
  text = dae();
  text.replace(text.find("count=\"12\""), 10, "count=\"4000000000\"");
  EXPECT_EQ(refusal_of(bytes_of(text), "a.dae"),
            "a.dae: says that it has more data than a file of its size can have");
}

TEST(ModelFile, GivesUpWhenItIsNotWanted) {
  const std::atomic<bool> cancel = true;
  EXPECT_THROW(parse_model(binary_stl(), "a.stl", {}, {.cancel = &cancel}), LoadCancelled);
}

std::string collada(const std::string& asset) {
  std::string positions, corners;
  for (const Vector3f& p : kCorners) positions += fmt::format("{} {} {} ", p.x(), p.y(), p.z());
  for (const auto& face : kFaces)
    for (const int i : face) corners += fmt::format("{} ", i);
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" )"
         R"(version="1.4.1"><asset><created>2024-01-01</created><modified>2024-01-01</modified>)" +
         asset + R"(</asset><library_geometries><geometry id="g"><mesh><source id="p">)" +
         R"(<float_array id="a" count="12">)" + positions +
         R"(</float_array><technique_common><accessor source="#a" count="4" stride="3">)"
         R"(<param name="X" type="float"/><param name="Y" type="float"/>)"
         R"(<param name="Z" type="float"/></accessor></technique_common></source>)"
         R"(<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>)"
         R"(<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>)" +
         corners +
         R"(</p></triangles></mesh></geometry></library_geometries><library_visual_scenes>)"
         R"(<visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene>)"
         R"(</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

// The axis that is up and the unit of length, in every format that has them.
TEST(ModelFile, KnowsTheUnitAndTheAxisThatAFileSays) {
  GltfBuilder gltf;
  gltf.positions(kSquare);
  gltf.primitive = R"(,"mode":5)";
  const Model binary = parse_model(gltf.binary(), "a.glb");
  EXPECT_EQ(binary.unit, 1);
  EXPECT_EQ(binary.up, Model::Up::y);
  const std::string centimetres = R"(<unit name="centimeter" meter="0.01"/>)";
  const std::map<std::string, Model::Up> axes{{"<up_axis>Z_UP</up_axis>", Model::Up::z},
                                              {"<up_axis>Y_UP</up_axis>", Model::Up::y},
                                              {"", Model::Up::y}};
  for (const auto& [text, up] : axes) {
    const Model model = parse_model(bytes_of(collada(centimetres + text)), "a.dae");
    EXPECT_EQ(model.up, up) << text;
    EXPECT_EQ(model.unit, 1) << "of Collada they are in metres already";
    EXPECT_NEAR(volume(model), 6e-6, 1e-11) << text;
    const Vector3f high = model.bounds().max().cast<float>();
    EXPECT_TRUE(high.isApprox(Vector3f(0.01f, 0.02f, 0.03f), 1e-5f)) << "the file's own axes";
  }
}

// glTF 2.0, 4.4 and 3.6.2.4: chunks fill whole words, and numbers lie at multiples of their size.
TEST_F(ModelFolder, IsConvertedIntoAValidGlb) {
  const std::string text = obj("mtllib a.mtl\nvt 0 0\nusemtl red\n", "usemtl seen\n");
  const ConvertedModel made =
      convert_model(bytes_of(text), *model_kind("a.obj"), "a.obj", folder_, {});
  EXPECT_TRUE(made.outside);
  EXPECT_TRUE(made.warnings.empty());
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, made.glb.data() + at, 4);
    return value;
  };
  ASSERT_GT(made.glb.size(), 28u);
  EXPECT_EQ(word(0), 0x46546C67u);
  EXPECT_EQ(word(4), 2u);
  EXPECT_EQ(word(8), made.glb.size());
  const std::size_t json = word(12), binary = 20 + json;
  EXPECT_EQ(word(16), 0x4E4F534Au);
  EXPECT_EQ(json % 4, 0u);
  EXPECT_EQ(word(binary) % 4, 0u);
  EXPECT_EQ(word(binary + 4), 0x004E4942u);
  EXPECT_EQ(binary + 8 + word(binary), made.glb.size());
  const auto gltf =
      nlohmann::json::parse(made.glb.begin() + 20, made.glb.begin() + 20 + static_cast<long>(json));
  EXPECT_EQ(gltf["asset"]["version"], "2.0");
  EXPECT_LE(gltf["buffers"][0]["byteLength"].get<std::size_t>(), word(binary));
  std::size_t end = 0;
  for (const auto& view : gltf["bufferViews"]) {
    const auto at = view["byteOffset"].get<std::size_t>();
    EXPECT_EQ(at % 4, 0u);
    EXPECT_GE(at, end) << "no two share bytes";
    end = at + view["byteLength"].get<std::size_t>();
    EXPECT_LE(end, gltf["buffers"][0]["byteLength"].get<std::size_t>());
  }
  EXPECT_EQ(gltf["images"][0]["mimeType"], "image/png");
  EXPECT_EQ(gltf["materials"].size(), 2u);
  EXPECT_EQ(gltf["meshes"][0]["primitives"].size(), 2u);
  expect_red_and_picture(parse_model(made.glb, "a.glb"));
}

}  // namespace
}  // namespace limpid
