#include "app/desktop/scene/scene_editor.h"

#include <numbers>

#include "core/touch/triangle_mesh.h"
#include "devices/files/rpy.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/scene/scene_writer.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/objects.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

Object mesh(const std::string& name) {
  const std::vector<Eigen::Vector3f> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<std::uint32_t> faces{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  return {name, Pose::Identity(),
          Mesh{.model = "/models/" + name + ".glb",
               .triangles = std::make_shared<const TriangleMesh>(corners, faces)}};
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
  editor.add({.name = "top", .shape = Plane{}});
  editor.add({.name = "ball", .shape = Sphere{}});
  editor.add({.name = "block", .shape = Box{}});
  editor.add(mesh("gear"), file("gear"), model());
  editor.add({.name = "stop", .shape = JointStop{}});
  return editor;
}

std::vector<std::string> names(const SceneEditor& editor) {
  std::vector<std::string> all;
  for (const Object& object : editor.scene().objects) all.push_back(object.name);
  return all;
}

// Numbers of the objects in full().
constexpr std::size_t kTop = 0, kBall = 1, kBlock = 2, kGear = 3, kStop = 4;

using testing::ElementsAre;

TEST(SceneEditor, ListsEveryKindOfObject) {
  EXPECT_THAT(names(full()), ElementsAre("top", "ball", "block", "gear", "stop"));
}

// Objects are in the order of a file, so a copy keeps its place when the file is read again.
TEST(SceneEditor, PutsWhatIsNewBehindThoseOfItsShape) {
  SceneEditor editor = full();
  const ArmDescription arm = test::random_arm(3, 2);
  for (std::size_t i = 5; i-- > 0;) editor.duplicate(i);
  EXPECT_THAT(names(editor), ElementsAre("top", "top 2", "ball", "ball 2", "block", "block 2",
                                         "gear", "gear 2", "stop", "stop 2"));
  SceneEditor again;
  again.open(parse_scene(scene_text(editor.document(), arm), "edited", "", arm,
                         files_of(editor.document())),
             editor.models());
  EXPECT_EQ(names(again), names(editor));
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_EQ(editor.models()[i] != nullptr, has_shape<Mesh>(editor.scene().objects[i])) << i;
  }
}

// Every shape goes through a step of undo and back, to the last bit, with its place and model.
TEST(SceneEditor, BringsBackWhatWasRemoved) {
  for (std::size_t place = 0; place < 5; ++place) {
    SceneEditor editor = full();
    const SceneEditor::Version before = editor.version();
    const Object object = editor.scene().objects[place];
    const MeshModels models = editor.models();
    editor.remove(place);
    EXPECT_EQ(editor.scene().objects.size(), 4u);
    EXPECT_EQ(editor.models().size(), 4u);
    editor.restore(before);
    test::expect_same(editor.scene().objects.at(place), object);
    EXPECT_EQ(editor.models(), models);
  }
}

TEST(SceneEditor, SelectsWhatItMade) {
  SceneEditor editor = full();
  EXPECT_EQ(editor.selected_object()->name, "stop");
  editor.duplicate(kGear);
  EXPECT_EQ(editor.selected_object()->name, "gear 2");
  editor.duplicate(*editor.selected());
  EXPECT_EQ(editor.selected_object()->name, "gear 3");
  EXPECT_EQ(editor.models().size(), editor.scene().objects.size());
}

TEST(SceneEditor, PutsACopyBesideTheFirstOne) {
  SceneEditor editor = full();
  editor.duplicate(kGear);
  const auto box = [&](std::size_t i) {
    return bounds_of(editor.scene().objects[kGear + i], editor.models()[kGear + i].get());
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
  editor.remove(1);
  EXPECT_THAT(names(editor), ElementsAre("a", "c"));
  EXPECT_THAT(editor.models(), ElementsAre(first, third));
  EXPECT_FALSE(editor.selected());
}

TEST(SceneEditor, KeepsFilesOfModelsAsLongAsAMeshHasThem) {
  SceneEditor editor = full();
  editor.duplicate(kGear);
  const SceneEditor::Version both = editor.version();
  const auto models = [&] { return editor.document().models; };
  const std::string name = "/models/gear.glb";
  editor.remove(kGear);
  ASSERT_TRUE(models().contains(name)) << "the copy has it";
  EXPECT_EQ(*models().at(name).bytes, *file("gear").bytes);
  editor.remove(kGear);
  EXPECT_TRUE(models().empty());
  editor.restore(both);
  EXPECT_TRUE(models().contains(name)) << "undone";
}

// A recording of both versions must hold both.
TEST(SceneEditor, TellsApartWhatOneFileHeldAtTwoTimes) {
  SceneEditor editor = full();
  const ModelFile later{file("gear").path, file("changed gear").bytes};
  for (int i = 0; i < 2; ++i) editor.add(mesh("gear"), later, model());
  const auto bytes_of = [&](std::size_t i) {
    return *files_of(editor.document()).at(test::shape<Mesh>(editor.scene(), i).model);
  };
  EXPECT_EQ(bytes_of(0), *file("gear").bytes);
  EXPECT_EQ(bytes_of(1), *later.bytes);
  EXPECT_EQ(bytes_of(2), *later.bytes);
  EXPECT_EQ(test::shape<Mesh>(editor.scene(), 1).model, "/models/gear-2.glb");
  EXPECT_EQ(files_of(editor.document()).size(), 2u) << "what is the same is there once";
}

TEST(SceneEditor, NeverHasTwoObjectsOfOneName) {
  SceneEditor editor = full();
  editor.add({.name = "gear", .shape = Sphere{}});
  EXPECT_EQ(editor.selected_object()->name, "gear 2");
  editor.rename(kBlock + 1, "gear");
  EXPECT_EQ(editor.scene().objects[kBlock + 1].name, "gear 3");
  editor.rename(kBlock + 1, "gear 3");
  EXPECT_EQ(editor.scene().objects[kBlock + 1].name, "gear 3") << "its own is free";
  editor.rename(kBlock + 1, "");
  EXPECT_EQ(editor.scene().objects[kBlock + 1].name, "gear 3") << "it needs one";
}

// Names count on from the number that they end in.
TEST(SceneEditor, GivesCopiesTheNextNumber) {
  const auto after = [](std::vector<std::string> there, const std::string& wanted) {
    SceneEditor editor;
    editor.open({}, {});
    for (const std::string& name : there) editor.add({.name = name, .shape = Sphere{}});
    editor.add({.name = wanted, .shape = Sphere{}});
    return editor.selected_object()->name;
  };
  EXPECT_EQ(after({"gear"}, "gear"), "gear 2");
  EXPECT_EQ(after({"gear", "gear 2"}, "gear 2"), "gear 3");
  EXPECT_EQ(after({"gear", "gear 2", "gear 9"}, "gear 9"), "gear 3") << "the first that is free";
  EXPECT_EQ(after({"R2"}, "R2"), "R2 2") << "no number of its own";
  EXPECT_EQ(after({"7"}, "7"), "7 2");
  EXPECT_EQ(after({"a 1 b"}, "a 1 b"), "a 1 b 2");
  EXPECT_EQ(after({}, ""), "object 2") << "it needs a name";
  EXPECT_EQ(after({"object 2"}, ""), "object 3");
}

// Fewer pictures than objects are filled up, as each object has a place for one.
TEST(SceneEditor, HasAPlaceForThePictureOfEachObject) {
  SceneDocument document;
  document.scene.add({.name = "top", .shape = Plane{}});
  document.scene.add({.name = "ball", .shape = Sphere{}});
  SceneEditor editor;
  editor.open(document, {});
  EXPECT_EQ(editor.models().size(), 2u);
  editor.duplicate(1);
  EXPECT_EQ(editor.models().size(), 3u);
  editor.remove(0);
  EXPECT_EQ(editor.models().size(), 2u);
  EXPECT_EQ(editor.selected(), std::nullopt);
}

TEST(SceneEditor, KnowsWhetherThereIsAnythingToSave) {
  SceneEditor editor;
  editor.open({}, {});
  EXPECT_FALSE(editor.dirty());
  const SceneEditor::Version before = editor.version();
  editor.add({.shape = Sphere{}});
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
  Object ball = editor.scene().objects[kBall];
  ball.shape = Sphere{0.5};
  editor.set(kBall, ball, "radius");
  EXPECT_EQ(test::shape<Sphere>(editor.scene()).radius, 0.5);
  EXPECT_EQ(test::shape<Sphere>(before.world->document.scene).radius, Sphere{}.radius);
  editor.restore(before);
  EXPECT_EQ(test::shape<Sphere>(editor.scene()).radius, Sphere{}.radius);
  EXPECT_EQ(editor.selected(), before.selected);
}

TEST(SceneEditor, NamesDragsOfTheSameNumberAlikeAndOthersOtherwise) {
  SceneEditor editor = full();
  const auto set = [&](std::size_t place, const char* what) {
    editor.set(place, editor.scene().objects[place], what);
    return editor.last_change();
  };
  EXPECT_EQ(set(kBlock, "size"), set(kBlock, "size"));
  EXPECT_NE(set(kBlock, "size"), set(kBlock, "place"));
  EXPECT_NE(set(kBlock, "place"), set(kBall, "place"));
  editor.remove(kBlock);
  EXPECT_EQ(editor.last_change(), "");
}

TEST(SceneEditor, HoldsAtMost64Objects) {
  SceneEditor editor;
  editor.open({}, {});
  for (int i = 0; i < 64; ++i) editor.add({.shape = Sphere{}});
  EXPECT_THAT(test::refusal<std::runtime_error>([&] { editor.add({.shape = Sphere{}}); }),
              testing::HasSubstr("64"));
  EXPECT_EQ(editor.scene().objects.size(), 64u);
}

TEST(SceneEditor, StepsThroughAllObjectsInACircle) {
  SceneEditor editor = full();
  editor.select(std::nullopt);
  std::vector<std::string> seen;
  for (int i = 0; i < 6; ++i) {
    editor.select_next(1);
    seen.push_back(editor.selected_object()->name);
  }
  EXPECT_THAT(seen, ElementsAre("top", "ball", "block", "gear", "stop", "top"));
  editor.select_next(-1);
  EXPECT_EQ(editor.selected_object()->name, "stop");
  SceneEditor empty;
  empty.select_next(1);
  EXPECT_FALSE(empty.selected());
}

// After any dragging or typing, a file can hold the scene to the last bit.
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
    editor.set(kTop, {"p", pose(), Plane{vector(1)}, number(600)}, "");
    editor.set(kBall, {"s", pose(), Sphere{number(0.1)}, number(600)}, "");
    editor.set(kBlock, {"b", pose(), Box{vector(0.1)}, number(600)}, "");
    editor.set(kStop, {"j", pose(), JointStop{2, number(1), number(1)}, number(20)}, "");
    Object gear = mesh("gear");
    gear.pose = pose();
    std::get<Mesh>(gear.shape).scale = number(1);
    gear.material = {number(600), number(1), number(0.5), number(0.5)};
    editor.set(kGear, gear, "");
    editor.set_tip_radius(number(0.01));

    const Scene& scene = editor.scene();
    const std::string text = scene_text(editor.document(), arm);
    const Scene again = parse_scene(text, "edited", "", arm, files_of(editor.document())).scene;
    EXPECT_EQ(again.tip_radius, scene.tip_radius);
    ASSERT_EQ(again.objects.size(), scene.objects.size());
    for (std::size_t k = 0; k < scene.objects.size(); ++k) {
      Object object = scene.objects[k];
      if (auto* shape = std::get_if<Mesh>(&object.shape)) shape->triangles = nullptr;
      test::expect_same(again.objects[k], object);
    }
    if (HasFailure()) return;
  }
}

// Compared with many points of their surfaces.
TEST(SceneEditor, KnowsHowMuchRoomCylindersAndCapsulesTake) {
  test::Random random(3);
  for (int round = 0; round < 20; ++round) {
    Object object{.name = "c", .shape = Cylinder{0.02, 0.06}};
    object.pose.linear() = random.rotation();
    object.pose.translation() = random.point(0.3);
    Bounds tube, pill;
    const auto take = [&](Bounds& box, const Vec3& p) { box.extend(Vec3(object.pose * p)); };
    for (int i = 0; i < 720; ++i) {
      const double angle = i * std::numbers::pi / 360;
      const Vec3 rim(0.02 * std::cos(angle), 0.02 * std::sin(angle), 0.03);
      take(tube, rim);
      take(tube, -rim);
    }
    for (int i = 0; i < 20000; ++i) {
      const Vec3 on_ball = 0.02 * random.direction();
      take(pill, on_ball + Vec3(0, 0, on_ball.z() < 0 ? -0.03 : 0.03));
    }
    const auto differ = [](const Bounds& a, const Bounds& b) {
      return std::max((a.min() - b.min()).cwiseAbs().maxCoeff(),
                      (a.max() - b.max()).cwiseAbs().maxCoeff());
    };
    EXPECT_LT(differ(bounds_of(object, nullptr), tube), 1e-6);
    object.shape = Capsule{0.02, 0.06};
    EXPECT_LT(differ(bounds_of(object, nullptr), pill), 1e-4);
  }
}

TEST(SceneEditor, CountsPartsAsRoomTaken) {
  Object object{.name = "c", .shape = Sphere{0.02}, .body = Body{}};
  object.parts.push_back({pose_at(Vec3(0.1, 0, 0)), Sphere{0.01}});
  EXPECT_NEAR(bounds_of(object, nullptr).max().x(), 0.11, 1e-12);
  EXPECT_NEAR(bounds_of(object, nullptr).min().x(), -0.02, 1e-12);
}

Object body(const std::string& name, const std::string& to = "") {
  Object out{.name = name, .shape = Box{}, .body = Body{}};
  out.body->joint = BodyJoint{};
  out.body->joint->to = to;
  return out;
}

// A lid on a pot that stands on the world, with a spring at each.
SceneEditor kitchen() {
  SceneEditor editor = full();
  editor.add(body("pot"));
  editor.add(body("lid", "pot"));
  editor.add_spring({.between = {"pot", ""}});
  editor.add_spring({.between = {"lid", "pot"}});
  return editor;
}
constexpr std::size_t kPot = 5, kLid = 6;

TEST(SceneEditor, LetsGoOfABodyThatIsRemoved) {
  SceneEditor editor = kitchen();
  const SceneEditor::Version before = editor.version();
  const std::string said = editor.remove(kPot);
  EXPECT_THAT(said, testing::HasSubstr("The joint of lid now connects to the world"));
  EXPECT_THAT(said, testing::HasSubstr("2 springs"));
  EXPECT_EQ(editor.scene().objects.at(kPot).body->joint->to, "");
  EXPECT_TRUE(editor.scene().springs.empty());
  editor.restore(before);
  EXPECT_EQ(editor.scene().objects.at(kLid).body->joint->to, "pot");
  EXPECT_EQ(editor.scene().springs.size(), 2u);
  EXPECT_EQ(editor.remove(kBall), "") << "nothing hangs on it";
}

TEST(SceneEditor, RenamesABodyWhereverItIsNamed) {
  SceneEditor editor = kitchen();
  editor.rename(kPot, "pan");
  EXPECT_EQ(editor.scene().objects.at(kLid).body->joint->to, "pan");
  EXPECT_EQ(editor.scene().springs[0].between[0], "pan");
  EXPECT_EQ(editor.scene().springs[1].between[1], "pan");
  EXPECT_EQ(editor.scene().springs[0].between[1], "") << "the world stays the world";
  editor.rename(kBall, "globe");
  EXPECT_EQ(editor.scene().objects.at(kLid).body->joint->to, "pan");
}

TEST(SceneEditor, ACopyHangsOnWhatTheFirstOneHangsOn) {
  SceneEditor editor = kitchen();
  editor.duplicate(kLid);
  EXPECT_EQ(editor.selected_object()->name, "lid 2");
  EXPECT_EQ(editor.selected_object()->body->joint->to, "pot");
  EXPECT_EQ(editor.scene().springs.size(), 2u);
}

// An object that begins to move goes behind all fixed ones, with its model, and comes back.
TEST(SceneEditor, PutsWhatMovesBehindWhatStandsStill) {
  SceneEditor editor = kitchen();
  const SceneEditor::Version before = editor.version();
  const MeshModels models = editor.models();
  Object gear = editor.scene().objects[kGear];
  gear.body = Body{};
  editor.set(kGear, gear, "moves");
  EXPECT_THAT(names(editor), ElementsAre("top", "ball", "block", "stop", "pot", "lid", "gear"));
  EXPECT_EQ(editor.selected_object()->name, "gear");
  EXPECT_EQ(editor.models().back(), models[kGear]);
  Object pot = editor.scene().objects[4];
  pot.body.reset();
  editor.set(4, pot, "moves");
  EXPECT_THAT(names(editor), ElementsAre("top", "ball", "block", "pot", "stop", "lid", "gear"));
  EXPECT_EQ(editor.selected_object()->name, "pot");
  EXPECT_EQ(editor.scene().objects[5].body->joint->to, "") << "of lid";
  EXPECT_TRUE(editor.scene().springs.empty());
  editor.restore(before);
  EXPECT_THAT(names(editor), ElementsAre("top", "ball", "block", "gear", "stop", "pot", "lid"));
}

// Only what moves is made of parts.
TEST(SceneEditor, LeavesThePartsOfABodyThatStandsStill) {
  SceneEditor editor = kitchen();
  Object gear = editor.scene().objects[kGear];
  gear.body = Body{};
  gear.parts.push_back({Pose::Identity(), Sphere{0.01}, {}});
  editor.set(kGear, gear, "moves");
  ASSERT_EQ(editor.selected_object()->name, "gear");
  EXPECT_EQ(editor.selected_object()->parts.size(), 1u);
  gear = *editor.selected_object();
  gear.body.reset();
  editor.set(*editor.selected(), gear, "moves");
  EXPECT_EQ(editor.selected_object()->name, "gear");
  EXPECT_TRUE(editor.selected_object()->parts.empty());
}

TEST(SceneEditor, WhatMovesComesBackFromItsText) {
  SceneEditor editor = kitchen();
  const ArmDescription arm = test::random_arm(3, 2);
  Object lid = editor.scene().objects[kLid];
  lid.body->mass = -1;
  lid.body->joint->axis = Vec3(0, 3, 4);
  editor.set(kLid, lid, "axis");
  EXPECT_EQ(editor.scene().objects[kLid].body->mass, 1e-6) << "held";
  BodySpring spring = editor.scene().springs[0];
  spring.stiffness = -3;
  editor.set_spring(0, spring, "stiffness");
  editor.set_gravity(Vec3(0, 0, -1000));
  const Scene again = parse_scene(scene_text(editor.document(), arm), "edited", "", arm,
                                  files_of(editor.document()))
                          .scene;
  EXPECT_EQ(again.gravity, Vec3(0, 0, -100));
  EXPECT_EQ(again.springs, editor.scene().springs);
  ASSERT_EQ(again.objects.size(), 7u);
  for (std::size_t i : {kPot, kLid}) test::expect_same(again.objects[i], editor.scene().objects[i]);
  editor.remove_spring(0);
  EXPECT_EQ(editor.scene().springs.size(), 1u);
  EXPECT_EQ(editor.last_change(), "") << "a step of its own";
}

// Unedited numbers stay as in the file; edited ones are held, written, and undone at once.
TEST(SceneEditor, PartsMomentsAndColoursComeFromTheTextAndGoBackIntoIt) {
  const ArmDescription arm = test::random_arm(3, 2);
  const std::string text = R"([[body]]
name = "die"
box = [0.03, 0.03, 0.03]
mass = 0.05
center = [0.001, 0, 0]
inertia = [1e-5, 2e-5, 2.5e-5]
position = [0.2, 0, 0]
color = [0.8, 0.2, 0.1]
[[body.part]]
sphere = 0.01
position = [0, 0, 0.02]
[[body.part]]
capsule = [0.004, 0.02]
color = [0.1, 0.2, 0.3]
)";
  const auto parsed = [&](const std::string& from) {
    SceneEditor editor;
    editor.open(parse_scene(from, "x.toml", "", arm, {}), {});
    return editor;
  };
  SceneEditor editor = parsed(text);
  const SceneEditor::Version before = editor.version();
  Object die = editor.scene().objects[0];
  die.parts[1].pose.translation() = Vec3(0, 0.5, 1e9);
  die.parts[1].color.reset();
  die.body->center = Vec3(0, 0, -0.002);
  die.body->inertia = Vec3(1e-5, 2e-5, 0);
  die.color = Vec3(0.5, 2, 0);
  editor.set(0, die, "part 2 place");
  EXPECT_EQ(editor.last_change(), "0 part 2 place");
  const Object back = parsed(scene_text(editor.document(), arm)).scene().objects[0];
  test::expect_same(back, editor.scene().objects[0]);
  ASSERT_EQ(back.parts.size(), 2u);
  EXPECT_EQ(back.parts[0].pose.translation(), Vec3(0, 0, 0.02));
  EXPECT_EQ(back.parts[1].pose.translation().y(), 0.5);
  EXPECT_LE(back.parts[1].pose.translation().z(), scene_limits::kPosition.maximum);
  EXPECT_FALSE(back.parts[1].color);
  EXPECT_EQ(*back.body->center, Vec3(0, 0, -0.002));
  EXPECT_GT(back.body->inertia->z(), 0);
  EXPECT_EQ(*back.color, Vec3(0.5, 1, 0));
  editor.restore(before);
  EXPECT_FALSE(editor.dirty());
  EXPECT_EQ(editor.document().toml, text);
}

TEST(SceneEditor, NothingThatCannotMoveHasABody) {
  SceneEditor editor = full();
  Object top = editor.scene().objects[kTop];
  top.body = Body{};
  editor.set(kTop, top, "moves");
  EXPECT_FALSE(editor.scene().objects[kTop].body);
}

}  // namespace
}  // namespace limpid
