#include "devices/files/scene/scene_writer.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "devices/files/rpy.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/urdf_file.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/objects.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using test::refusal;
using testing::HasSubstr;

void expect_same(const Pose& a, const Pose& b) { EXPECT_EQ(a.matrix(), b.matrix()); }

// Compares bit for bit, apart from paths moved by `files`.
void expect_same(const SceneDocument& first, const SceneDocument& second) {
  EXPECT_EQ(first.title, second.title);
  EXPECT_EQ(first.about, second.about);
  const Scene &a = first.scene, &b = second.scene;
  EXPECT_EQ(a.tip_radius, b.tip_radius);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (std::size_t i = 0; i < a.objects.size(); ++i) {
    Object object = b.objects[i];
    if (auto* mesh = std::get_if<Mesh>(&object.shape)) {
      const std::string model = std::get<Mesh>(a.objects[i].shape).model;
      EXPECT_EQ(*first.models.at(model).bytes, *second.models.at(mesh->model).bytes);
      mesh->model = model;
    }
    test::expect_same(a.objects[i], object);
  }
  ASSERT_EQ(a.probes.size(), b.probes.size());
  for (std::size_t i = 0; i < a.probes.size(); ++i) {
    EXPECT_EQ(a.probes[i].name, b.probes[i].name);
    EXPECT_EQ(a.probes[i].link, b.probes[i].link);
    EXPECT_EQ(a.probes[i].from, b.probes[i].from);
    EXPECT_EQ(a.probes[i].to, b.probes[i].to);
    EXPECT_EQ(a.probes[i].radius, b.probes[i].radius);
  }
  ASSERT_EQ(first.visuals.size(), second.visuals.size());
  for (std::size_t i = 0; i < first.visuals.size(); ++i) {
    expect_same(first.visuals[i].pose, second.visuals[i].pose);
    EXPECT_EQ(first.visuals[i].scale, second.visuals[i].scale);
  }
}

ModelBytes bytes(const std::string& text) {
  return std::make_shared<const std::vector<unsigned char>>(text.begin(), text.end());
}

std::string odd_name(test::Random& random) {
  const std::string letters = "aZ 09\"\\'#=[]{}\n\t\x01\x7f";
  std::string name;
  const int length = static_cast<int>(random.between(1, 12));
  for (int i = 0; i < length; ++i) {
    name += letters[static_cast<std::size_t>(random.between(0, 17.999))];
  }
  return name + "\xCE\xB7";
}

Pose far_pose(test::Random& random) {
  Pose pose = Pose::Identity();
  pose.translation() = random.point(1);
  pose.linear() = rotation((random.point(3) * 1e9).array().round() / 1e9);
  return pose;
}

Material random_material(test::Random& random) {
  Material out{.stiffness = std::exp(random.between(-3, 9))};
  if (random.between(0, 1) < 0.5) out.damping = random.between(0, 100);
  if (random.between(0, 1) < 0.5) out.friction_static = random.between(0, 1);
  if (random.between(0, 1) < 0.5) out.friction_kinetic = random.between(0, 1);
  return out;
}

// A random scene with values that a file can give: normalized normals, rotations from written
// angles.
SceneDocument random_scene(const ArmDescription& arm, unsigned seed) {
  test::Random random(seed);
  const auto count = [&] { return static_cast<int>(random.between(0, 4)); };
  SceneDocument out;
  out.title = odd_name(random);
  out.about = odd_name(random);
  Scene& scene = out.scene;
  scene.tip_radius = random.between(0, 0.01);
  for (int i = count(); i > 0; --i) {
    scene.add({odd_name(random), pose_at(random.point(1)), Plane{random.point(1).normalized()},
               random_material(random)});
  }
  for (int i = count(); i > 0; --i) {
    scene.add({odd_name(random), pose_at(random.point(1)), Sphere{random.between(1e-4, 1)},
               random_material(random)});
  }
  for (int i = count(); i > 0; --i) {
    scene.add({odd_name(random), far_pose(random), Box{Vec3::Constant(1.2) + random.point(1)},
               random_material(random)});
  }
  for (int i = count(); i > 0; --i) {
    Object object{odd_name(random), far_pose(random), Mesh{}, random_material(random)};
    Mesh& mesh = std::get<Mesh>(object.shape);
    // STL is read in millimetres unless it says otherwise, other formats in metres.
    mesh.model = "models/" + std::to_string(i) + " \"of\" \xCE\xB7" +
                 (random.between(0, 1) < 0.5 ? ".stl" : ".glb");
    mesh.unit = std::array{1.0, 0.01, 0.001, 0.0254,
                           0.3048}[static_cast<std::size_t>(random.between(0, 4.999))];
    mesh.y_up = random.between(0, 1) < 0.5;
    mesh.scale = random.between(1e-3, 5);
    out.models[mesh.model].bytes = bytes("model " + std::to_string(i));
    scene.add(object);
  }
  for (int i = count(); i > 0; --i) {
    scene.add({.name = odd_name(random),
               .shape = JointStop{static_cast<int>(random.between(0, arm.dof() - 0.001)),
                                  random.between(-3, 3), i % 2 == 0 ? 1.0 : -1.0},
               .material = {std::exp(random.between(-3, 9))}});
  }
  for (int i = count(); i > 0; --i) {
    const Vec3 from = random.point(0.2);
    scene.probes.push_back({odd_name(random),
                            static_cast<int>(random.between(0, arm.dof() - 0.001)), from,
                            i % 2 == 0 ? from : random.point(0.2), random.between(0, 0.02)});
  }
  return out;
}

TEST(SceneText, GivesEveryShippedSceneBack) {
  const ArmDescription arm = read_urdf((test::assets() / "devices/omni.urdf").string());
  int count = 0;
  for (const auto& entry : fs::directory_iterator(test::assets() / "scenes")) {
    if (entry.path().extension() != ".toml") continue;
    SCOPED_TRACE(entry.path());
    const SceneDocument scene = read_scene(entry.path(), arm);
    const fs::path folder = entry.path().parent_path();
    const std::string text = scene_text(scene, arm, folder);
    const SceneDocument again = parse_scene(text, "again", folder, arm);
    expect_same(scene, again);
    for (std::size_t i = 0; i < scene.visuals.size(); ++i) {
      EXPECT_EQ(scene.visuals[i].file, again.visuals[i].file);
    }
    EXPECT_EQ(text, scene_text(again, arm, folder));
    ++count;
  }
  EXPECT_GE(count, 4);
}

TEST(SceneText, GivesAnySceneBackToTheLastBit) {
  for (unsigned seed = 0; seed < 1000; ++seed) {
    SCOPED_TRACE(seed);
    const ArmDescription arm = test::random_arm(1 + static_cast<int>(seed) % 5, seed);
    const SceneDocument scene = random_scene(arm, seed);
    expect_same(scene, parse_scene(scene_text(scene, arm), "again", "", arm, files_of(scene)));
    if (HasFailure()) return;
  }
}

TEST(SceneText, WritesAnglesAsAPersonWould) {
  const Vec3 simple[] = {{0, 0, 0.4}, {0.1, -0.2, 3}, {1.25, 0, 0}, {0, 0.7, -0.003}};
  for (const Vec3& rpy : simple) EXPECT_EQ(rpy_of(rotation(rpy)), rpy);
}

TEST(SceneText, SettlesAnyRotationOnOneThatAnglesGiveBack) {
  test::Random random(5);
  for (int i = 0; i < 1000; ++i) {
    Vec3 rpy = random.point(3.1);
    if (i % 5 == 0) rpy.y() = (i % 2 == 0 ? 0.5 : -0.5) * std::numbers::pi;
    const Mat3 R = rotation(rpy);
    EXPECT_LT((rotation(rpy_of(R)) - R).norm(), 1e-14) << rpy.transpose();
    const Mat3 fixed = settled(R);
    EXPECT_LT((fixed - R).norm(), 5e-9) << rpy.transpose();
    EXPECT_EQ(rotation(rpy_of(fixed)), fixed) << rpy.transpose();
    EXPECT_EQ(settled(fixed), fixed) << rpy.transpose();
  }
}

TEST(SceneText, NamesTheSecondOfTwoJointsOfOneNameByItsNumber) {
  ArmDescription arm = test::random_arm(2, 1);
  arm.joints[1].name = arm.joints[0].name = "turn";
  SceneDocument document;
  document.scene.add({.name = "stop", .shape = JointStop{1, 0.5, 1}, .material = {20}});
  const Scene again = parse_scene(scene_text(document, arm), "again", "", arm).scene;
  EXPECT_EQ(test::shape<JointStop>(again).joint, 1);
}

class SavedScene : public testing::Test {
 protected:
  SavedScene() {
    fs::create_directories(elsewhere_ / "deep");
    fs::create_directories(folder_ / "parts");
  }

  // A scene with one mesh from a file at `model`.
  SceneDocument with_mesh(const fs::path& model, const std::string& content) {
    test::write_file(model, content);
    SceneDocument document;
    document.scene.add({.name = "gear", .shape = Mesh{.model = model.string()}});
    document.models[model.string()] = {model.string(), bytes(content)};
    return document;
  }
  // Path of the first mesh's model when the scene is read again.
  std::string path_read_again() {
    const SceneDocument again = read_scene(file_, arm_);
    return again.models.at(test::shape<Mesh>(again.scene).model).path;
  }

  test::TempDir dir_;
  fs::path folder_ = dir_ / "here", elsewhere_ = dir_ / "there";
  fs::path file_ = folder_ / "scene.toml";
  ArmDescription arm_ = test::random_arm(2, 3);
};

TEST_F(SavedScene, IsReadBackAsItWas) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const SceneDocument scene = random_scene(arm_, seed);
    const SceneDocument saved = save_scene(scene, arm_, file_);
    expect_same(scene, read_scene(file_, arm_));
    expect_same(scene, saved);
    EXPECT_EQ(saved.toml, test::file_bytes(file_));
  }
}

TEST_F(SavedScene, NamesModelsOfItsFolderRelativeToIt) {
  const fs::path model = folder_ / "parts/gear.glb";
  const SceneDocument saved = save_scene(with_mesh(model, "gear"), arm_, file_);
  EXPECT_EQ(test::shape<Mesh>(saved.scene).model, "parts/gear.glb");
  EXPECT_EQ(path_read_again(), model.string());
}

TEST_F(SavedScene, TakesModelsFromElsewhereAlong) {
  const SceneDocument scene = with_mesh(elsewhere_ / "gear.glb", "gear");
  save_scene(scene, arm_, file_);
  fs::remove(elsewhere_ / "gear.glb");
  EXPECT_EQ(path_read_again(), (folder_ / "gear.glb").string());
  EXPECT_EQ(test::file_bytes(folder_ / "gear.glb"), "gear");
}

TEST_F(SavedScene, CopiesAModelOnceHoweverOftenItIsThere) {
  SceneDocument scene = with_mesh(elsewhere_ / "gear.glb", "gear");
  scene.scene.add(scene.scene.objects[0]);
  save_scene(scene, arm_, file_);
  save_scene(scene, arm_, folder_ / "again.toml");
  const auto models = std::count_if(
      fs::directory_iterator(folder_), {},
      [](const fs::directory_entry& entry) { return entry.path().extension() == ".glb"; });
  EXPECT_EQ(models, 1);
}

TEST_F(SavedScene, NeverOverwritesAnotherModel) {
  test::write_file(folder_ / "gear.glb", "somebody else's");
  test::write_file(folder_ / "gear-2.glb", "and this, too");
  const SceneDocument saved = save_scene(with_mesh(elsewhere_ / "gear.glb", "gear"), arm_, file_);
  EXPECT_EQ(test::shape<Mesh>(saved.scene).model, "gear-3.glb");
  EXPECT_EQ(test::file_bytes(folder_ / "gear.glb"), "somebody else's");
  EXPECT_EQ(test::file_bytes(folder_ / "gear-2.glb"), "and this, too");
  EXPECT_EQ(test::file_bytes(folder_ / "gear-3.glb"), "gear");
}

TEST_F(SavedScene, TellsModelsOfOneNameApart) {
  SceneDocument scene = with_mesh(elsewhere_ / "gear.glb", "gear");
  const SceneDocument other = with_mesh(elsewhere_ / "deep/gear.glb", "another");
  scene.scene.add(other.scene.objects[0]);
  scene.models.insert(other.models.begin(), other.models.end());
  save_scene(scene, arm_, file_);
  const SceneDocument again = read_scene(file_, arm_);
  const auto bytes_of = [&](std::size_t i) {
    return *again.models.at(test::shape<Mesh>(again.scene, i).model).bytes;
  };
  EXPECT_EQ(bytes_of(0), *bytes("gear"));
  EXPECT_EQ(bytes_of(1), *bytes("another"));
}

TEST_F(SavedScene, LeavesOutModelsThatNoMeshHas) {
  SceneDocument scene = with_mesh(elsewhere_ / "gear.glb", "gear");
  const SceneDocument other = with_mesh(elsewhere_ / "wheel.glb", "wheel");
  scene.models.insert(other.models.begin(), other.models.end());
  EXPECT_EQ(files_of(scene).size(), 1u);
  const SceneDocument saved = save_scene(scene, arm_, file_);
  ASSERT_EQ(saved.models.size(), 1u);
  EXPECT_EQ(saved.models.at("gear.glb").path, (folder_ / "gear.glb").string());
  EXPECT_FALSE(fs::exists(folder_ / "wheel.glb"));
}

TEST_F(SavedScene, LeavesModelsOfSeveralFilesWhereTheyAre) {
  const fs::path model = elsewhere_ / "gear.gltf";
  const SceneDocument saved = save_scene(with_mesh(model, "{}"), arm_, file_);
  EXPECT_EQ(test::shape<Mesh>(saved.scene).model, model.string());
  EXPECT_FALSE(fs::exists(folder_ / "gear.gltf"));
}

TEST_F(SavedScene, TakesAnObjAlongWithItsMaterialsAndPictures) {
  const std::string obj = "mtllib gear.mtl none.mtl\nv 0 0 0\n";
  fs::create_directory(elsewhere_ / "maps");
  test::write_file(elsewhere_ / "gear.mtl",
                   "newmtl a\nmap_Kd -s 1 1 1 maps\\red.png\nbump two words.png\n"
                   "map_Ks ../key\nmap_Ka linked.png\n");
  test::write_file(elsewhere_ / "maps/red.png", "red");
  test::write_file(elsewhere_ / "two words.png", "two");
  test::write_file(dir_ / "key", "secret");
  fs::create_symlink(dir_ / "key", elsewhere_ / "linked.png");
  const SceneDocument scene = with_mesh(elsewhere_ / "gear.obj", obj);
  const SceneDocument saved = save_scene(scene, arm_, file_);
  EXPECT_EQ(test::shape<Mesh>(saved.scene).model, "gear/gear.obj");
  EXPECT_EQ(test::file_bytes(folder_ / "gear/gear.obj"), obj);
  EXPECT_EQ(test::file_bytes(folder_ / "gear/gear.mtl"), test::file_bytes(elsewhere_ / "gear.mtl"));
  EXPECT_EQ(test::file_bytes(folder_ / "gear/maps/red.png"), "red");
  EXPECT_EQ(test::file_bytes(folder_ / "gear/two words.png"), "two");
  EXPECT_FALSE(fs::exists(folder_ / "gear/linked.png"));
  EXPECT_FALSE(fs::exists(folder_ / "key"));
  // The same file is there already and is used; another one of its name is not.
  EXPECT_EQ(test::shape<Mesh>(save_scene(scene, arm_, file_).scene).model, "gear/gear.obj");
  test::write_file(folder_ / "gear/gear.mtl", "somebody else's");
  EXPECT_EQ(test::shape<Mesh>(save_scene(scene, arm_, file_).scene).model, "gear-2/gear.obj");
  fs::remove_all(elsewhere_);
  EXPECT_EQ(path_read_again(), (folder_ / "gear-2/gear.obj").string());
}

TEST_F(SavedScene, TakesAnObjAlongThatStandsAlone) {
  const SceneDocument saved =
      save_scene(with_mesh(elsewhere_ / "gear.OBJ", "v 0 0 0\n"), arm_, file_);
  EXPECT_EQ(test::shape<Mesh>(saved.scene).model, "gear.OBJ");
  EXPECT_EQ(test::file_bytes(folder_ / "gear.OBJ"), "v 0 0 0\n");
}

TEST_F(SavedScene, LeavesNoPartOfAnObjBehindWhereItCannotBeWritten) {
  test::write_file(elsewhere_ / "gear.mtl", "newmtl a\n");
  SceneDocument scene = with_mesh(elsewhere_ / "gear.obj", "mtllib gear.mtl\n");
  scene.scene.add({"", pose_at(Vec3(11, 0, 0)), Plane{}});  // beyond the limit of a file
  EXPECT_THAT(refusal([&] { save_scene(scene, arm_, file_); }), HasSubstr("plane.point"));
  EXPECT_FALSE(fs::exists(folder_ / "gear"));
}

TEST_F(SavedScene, WritesModelsOutOfASessionBesideIt) {
  SceneDocument scene = with_mesh(elsewhere_ / "gear.glb", "gear");
  test::shape<Mesh>(scene.scene).model = "parts/wheel.glb";
  scene.models = {{"parts/wheel.glb", {"", bytes("gear")}}};
  EXPECT_EQ(test::shape<Mesh>(save_scene(scene, arm_, file_).scene).model, "wheel.glb");
  EXPECT_EQ(test::file_bytes(folder_ / "wheel.glb"), "gear");
}

TEST_F(SavedScene, LeavesEverythingAsItWasWhereItCannotBeWritten) {
  SceneDocument scene = with_mesh(elsewhere_ / "gear.glb", "gear");
  EXPECT_THAT(refusal([&] { save_scene(scene, arm_, dir_ / "nowhere/scene.toml"); }),
              HasSubstr("there is no folder"));
  EXPECT_THAT(refusal([&] { save_scene(scene, arm_, folder_ / "parts"); }),
              HasSubstr("is a folder"));

  test::write_file(file_, "title = \"before\"\n");
  scene.scene.add({"", pose_at(Vec3(11, 0, 0)), Plane{}});  // beyond the limit of a file
  EXPECT_THAT(refusal([&] { save_scene(scene, arm_, file_); }), HasSubstr("plane.point"));
  EXPECT_EQ(test::file_bytes(file_), "title = \"before\"\n");
  EXPECT_FALSE(fs::exists(folder_ / "gear.glb"));
  for (const auto& entry : fs::directory_iterator(folder_)) {
    EXPECT_NE(entry.path().extension(), ".new");
  }
}

}  // namespace
}  // namespace limpid
