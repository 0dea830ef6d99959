#include "app/desktop/document/scene_editor.h"

#include <numbers>

#include "core/touch/triangle_mesh.h"
#include "devices/files/rpy.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/scene/scene_writer.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

MeshObstacle mesh(const std::string& name) {
  MeshObstacle out;
  out.name = name;
  out.model = "/models/" + name + ".glb";
  const std::vector<Eigen::Vector3f> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<std::uint32_t> faces{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  out.shape = std::make_shared<const TriangleMesh>(corners, faces);
  return out;
}

ModelFile file(const std::string& name) {
  const std::string bytes = "bytes of " + name;
  return {"/models/" + name + ".glb",
          std::make_shared<const std::vector<unsigned char>>(bytes.begin(), bytes.end())};
}

std::shared_ptr<const Model> model() {
  Model out;
  out.vertices.resize(2);
  out.vertices[0].position = Eigen::Vector3f(-1, -2, -3);
  out.vertices[1].position = Eigen::Vector3f(1, 2, 3);
  return std::make_shared<const Model>(std::move(out));
}

SceneEditor full() {
  SceneEditor editor;
  SceneDocument document;
  document.toml = "title = \"by hand\"  # a comment";
  editor.open(document, {});
  editor.add(Plane{.name = "top"});
  editor.add(Sphere{.name = "ball"});
  editor.add(Box{.name = "block"});
  editor.add(mesh("gear"), file("gear"), model());
  editor.add(JointContact{.name = "stop"});
  return editor;
}

std::vector<std::string> names(const SceneEditor& editor) {
  std::vector<std::string> all;
  for (const ObjectRef& ref : objects_of(editor.scene())) {
    all.push_back(name_of(editor.scene(), ref));
  }
  return all;
}

using testing::ElementsAre;

TEST(SceneEditor, ListsEveryKindOfObject) {
  EXPECT_THAT(names(full()), ElementsAre("top", "ball", "block", "gear", "stop"));
}

TEST(SceneEditor, SelectsWhatItMade) {
  SceneEditor editor = full();
  EXPECT_EQ(name_of(editor.scene(), *editor.selected()), "stop");
  editor.duplicate({ObjectKind::mesh, 0});
  EXPECT_EQ(name_of(editor.scene(), *editor.selected()), "gear 2");
  editor.duplicate(*editor.selected());
  EXPECT_EQ(name_of(editor.scene(), *editor.selected()), "gear 3");
  EXPECT_EQ(editor.models().size(), 3u);
}

TEST(SceneEditor, PutsACopyBesideTheFirstOne) {
  SceneEditor editor = full();
  editor.duplicate({ObjectKind::mesh, 0});
  const auto box = [&](std::size_t i) {
    return bounds_of(object_of(editor.scene(), {ObjectKind::mesh, i}), editor.models()[i].get());
  };
  EXPECT_FALSE(box(0).intersects(box(1)));
}

TEST(SceneEditor, KeepsModelsWithTheirMeshes) {
  SceneEditor editor;
  editor.open({}, {});
  const auto first = model(), second = model(), third = model();
  editor.add(mesh("a"), file("a"), first);
  editor.add(mesh("b"), file("b"), second);
  editor.add(mesh("c"), file("c"), third);
  editor.remove({ObjectKind::mesh, 1});
  EXPECT_THAT(names(editor), ElementsAre("a", "c"));
  EXPECT_THAT(editor.models(), ElementsAre(first, third));
  EXPECT_FALSE(editor.selected());
}

TEST(SceneEditor, KeepsFilesOfModelsAsLongAsAMeshHasThem) {
  SceneEditor editor = full();
  editor.duplicate({ObjectKind::mesh, 0});
  const SceneEditor::Version both = editor.version();
  const auto models = [&] { return editor.document().models; };
  const std::string name = "/models/gear.glb";
  editor.remove({ObjectKind::mesh, 0});
  ASSERT_TRUE(models().contains(name)) << "the copy has it";
  EXPECT_EQ(*models().at(name).bytes, *file("gear").bytes);
  editor.remove({ObjectKind::mesh, 0});
  EXPECT_TRUE(models().empty());
  editor.restore(both);
  EXPECT_TRUE(models().contains(name)) << "undone";
}

// A recording of both has to hold both.
TEST(SceneEditor, TellsApartWhatOneFileHeldAtTwoTimes) {
  SceneEditor editor = full();
  const ModelFile later{file("gear").path, file("changed gear").bytes};
  for (int i = 0; i < 2; ++i) editor.add(mesh("gear"), later, model());
  const auto bytes_of = [&](std::size_t i) {
    return *files_of(editor.document()).at(editor.scene().meshes.at(i).model);
  };
  EXPECT_EQ(bytes_of(0), *file("gear").bytes);
  EXPECT_EQ(bytes_of(1), *later.bytes);
  EXPECT_EQ(bytes_of(2), *later.bytes);
  EXPECT_EQ(editor.scene().meshes[1].model, "/models/gear-2.glb");
  EXPECT_EQ(files_of(editor.document()).size(), 2u) << "what is the same is there once";
}

TEST(SceneEditor, NeverHasTwoObjectsOfOneName) {
  SceneEditor editor = full();
  editor.add(Sphere{.name = "gear"});
  EXPECT_EQ(name_of(editor.scene(), *editor.selected()), "gear 2");
  editor.rename({ObjectKind::box, 0}, "gear");
  EXPECT_EQ(name_of(editor.scene(), {ObjectKind::box, 0}), "gear 3");
  editor.rename({ObjectKind::box, 0}, "gear 3");
  EXPECT_EQ(name_of(editor.scene(), {ObjectKind::box, 0}), "gear 3") << "its own is free";
  editor.rename({ObjectKind::box, 0}, "");
  EXPECT_EQ(name_of(editor.scene(), {ObjectKind::box, 0}), "gear 3") << "it needs one";
}

TEST(SceneEditor, KnowsWhetherThereIsAnythingToSave) {
  SceneEditor editor;
  editor.open({}, {});
  EXPECT_FALSE(editor.dirty());
  const SceneEditor::Version before = editor.version();
  editor.add(Sphere{});
  EXPECT_TRUE(editor.dirty());
  const SceneEditor::Version after = editor.version();
  editor.restore(before);
  EXPECT_FALSE(editor.dirty()) << "undone";
  editor.restore(after);
  editor.saved(editor.document());
  EXPECT_FALSE(editor.dirty());
  editor.select(std::nullopt);
  EXPECT_FALSE(editor.dirty()) << "selecting changes nothing";
  editor.restore(before);
  EXPECT_TRUE(editor.dirty()) << "the file has the sphere";
}

TEST(SceneEditor, LeavesEarlierVersionsAsTheyWere) {
  SceneEditor editor = full();
  const SceneEditor::Version before = editor.version();
  Sphere ball = std::get<Sphere>(object_of(editor.scene(), {ObjectKind::sphere, 0}));
  ball.radius = 0.5;
  editor.set({ObjectKind::sphere, 0}, ball, "radius");
  EXPECT_EQ(editor.scene().spheres[0].radius, 0.5);
  EXPECT_EQ(before.world->document.scene.spheres[0].radius, Sphere{}.radius);
  editor.restore(before);
  EXPECT_EQ(editor.scene().spheres[0].radius, Sphere{}.radius);
  EXPECT_EQ(editor.selected(), before.selected);
}

TEST(SceneEditor, NamesDragsOfTheSameNumberAlikeAndOthersOtherwise) {
  SceneEditor editor = full();
  const auto set = [&](ObjectRef ref, const char* what) {
    editor.set(ref, object_of(editor.scene(), ref), what);
    return editor.last_change();
  };
  EXPECT_EQ(set({ObjectKind::box, 0}, "size"), set({ObjectKind::box, 0}, "size"));
  EXPECT_NE(set({ObjectKind::box, 0}, "size"), set({ObjectKind::box, 0}, "place"));
  EXPECT_NE(set({ObjectKind::box, 0}, "place"), set({ObjectKind::sphere, 0}, "place"));
  editor.remove({ObjectKind::box, 0});
  EXPECT_EQ(editor.last_change(), "");
}

TEST(SceneEditor, HoldsAtMost64Objects) {
  SceneEditor editor;
  editor.open({}, {});
  for (int i = 0; i < 64; ++i) editor.add(Sphere{});
  EXPECT_THAT(test::refusal<std::runtime_error>([&] { editor.add(Sphere{}); }),
              testing::HasSubstr("64"));
  EXPECT_EQ(objects_of(editor.scene()).size(), 64u);
}

TEST(SceneEditor, StepsThroughAllObjectsInACircle) {
  SceneEditor editor = full();
  editor.select(std::nullopt);
  std::vector<std::string> seen;
  for (int i = 0; i < 6; ++i) {
    editor.select_next(1);
    seen.push_back(name_of(editor.scene(), *editor.selected()));
  }
  EXPECT_THAT(seen, ElementsAre("top", "ball", "block", "gear", "stop", "top"));
  editor.select_next(-1);
  EXPECT_EQ(name_of(editor.scene(), *editor.selected()), "stop");
  SceneEditor empty;
  empty.select_next(1);
  EXPECT_FALSE(empty.selected());
}

// Whatever is dragged or typed: a scene's file can say it, and says it to the last bit.
TEST(SceneEditor, AlwaysHoldsWhatAFileCanSay) {
  const ArmDescription arm = test::random_arm(3, 2);
  test::Random random(9);
  const double wild[] = {0, -1, 1e300, -1e300, 1e-320, std::nan(""), HUGE_VAL, -HUGE_VAL};
  const auto number = [&](double usual) {
    return random.between(0, 1) < 0.3 ? wild[static_cast<int>(random.between(0, 7.99))]
                                      : usual * random.between(0.1, 10);
  };
  const auto vector = [&](double usual) {
    return Vec3(number(usual), number(-usual), number(usual));
  };
  const auto pose = [&] {
    Pose p = Pose::Identity();
    p.translation() = vector(0.1);
    p.linear() = rotation(random.point(4));
    return p;
  };
  SceneEditor editor = full();
  for (int i = 0; i < 500; ++i) {
    editor.set({ObjectKind::plane, 0}, Plane{"p", vector(0.1), vector(1), number(600)}, "");
    editor.set({ObjectKind::sphere, 0}, Sphere{"s", vector(0.1), number(0.1), number(600)}, "");
    editor.set({ObjectKind::box, 0}, Box{"b", pose(), vector(0.1), number(600)}, "");
    editor.set({ObjectKind::joint_contact, 0},
               JointContact{"j", 2, number(1), number(1), number(20)}, "");
    MeshObstacle gear = mesh("gear");
    gear.pose = pose();
    gear.scale = number(1);
    gear.material.stiffness = number(600);
    editor.set({ObjectKind::mesh, 0}, gear, "");
    editor.set_tip_radius(number(0.01));

    const Scene& scene = editor.scene();
    const std::string text = scene_text(editor.document(), arm);
    const Scene again = parse_scene(text, "edited", "", arm, files_of(editor.document())).scene;
    EXPECT_EQ(again.tip_radius, scene.tip_radius);
    EXPECT_EQ(again.planes[0].point, scene.planes[0].point);
    EXPECT_EQ(again.planes[0].normal, scene.planes[0].normal);
    EXPECT_EQ(again.spheres[0].radius, scene.spheres[0].radius);
    EXPECT_EQ(again.boxes[0].pose.matrix(), scene.boxes[0].pose.matrix());
    EXPECT_EQ(again.meshes[0].pose.matrix(), scene.meshes[0].pose.matrix());
    EXPECT_EQ(again.meshes[0].scale, scene.meshes[0].scale);
    EXPECT_EQ(again.joint_contacts[0].direction, scene.joint_contacts[0].direction);
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace limpid
