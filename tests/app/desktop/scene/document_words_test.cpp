// Words of an edited scene on each step, and its question before it is left.
#include <fmt/format.h>

#include <functional>

#include "app/base/folders.h"
#include "app/desktop/scene/document.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/built_in.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class WordsOfAScene : public testing::Test {
 protected:
  static Object thing(const char* name, bool moves, double x = 0.1) {
    Object object;
    object.name = name;
    object.shape = Sphere{0.02};
    object.pose = pose_at({x, 0, 0.05});
    if (moves) object.body = Body{};
    return object;
  }
  void open(std::vector<Object> objects, std::vector<BodySpring> springs = {}) {
    SceneDocument scene;
    const std::size_t count = objects.size();
    for (Object& object : objects) scene.scene.add(std::move(object));
    scene.scene.springs = std::move(springs);
    document_.open(arm_, std::move(scene), MeshModels(count), true);
  }
  void select(const char* name) {
    for (std::size_t i = 0; i < document_.scene().objects.size(); ++i) {
      if (document_.scene().objects[i].name == name) document_.editor().select(i);
    }
  }
  // Removes an object; returns what is said.
  std::string removed(const char* name) {
    select(name);
    document_.remove_selected();
    document_.note_changes();
    return said();
  }
  std::string said() const {
    return notices_.past().empty() ? std::string() : notices_.past().back().text;
  }
  bool complained() const { return !notices_.past().empty() && notices_.past().back().bad; }
  std::size_t objects() const { return document_.scene().objects.size(); }
  Workplace desk() const {
    Workplace at;
    at.base = Vec3(0, 0, 0.05);
    at.reach = 0.27;
    at.rest = Vec3(0.2, 0, 0);
    at.tips = {at.rest};
    return at;
  }

  const test::TempDir dir_;
  const ArmDescription arm_ = test::omni();
  std::string why_fixed_;
  Settings settings_;
  Notices notices_;
  Document document_{settings_, notices_, [this] { return why_fixed_; }};
};

TEST_F(WordsOfAScene, SayThatThereIsNothingToUndo) {
  open({thing("ball", false)});
  document_.undo();
  EXPECT_EQ(said(), "Nothing to undo.");
  document_.redo();
  EXPECT_EQ(said(), "Nothing to redo.");
  removed("ball");
  document_.undo();
  EXPECT_EQ(objects(), 1u);
  document_.redo();
  EXPECT_EQ(objects(), 0u);
  document_.redo();
  EXPECT_EQ(objects(), 0u);
  EXPECT_EQ(said(), "Nothing to redo.");
}

// While a scene is fixed, only settings can be taken back.
TEST_F(WordsOfAScene, SayWhyTheSceneCannotBeChanged) {
  open({thing("ball", false), thing("block", false, 0.2)});
  removed("ball");
  settings_.parameters().eta = 0.77;
  document_.note_changes();
  why_fixed_ = "Not while it rains.";
  document_.undo();
  EXPECT_NE(settings_.parameters().eta, 0.77) << "a setting";
  document_.undo();
  EXPECT_EQ(said(), "Not while it rains.");
  EXPECT_TRUE(complained());
  EXPECT_EQ(objects(), 1u);
  const std::size_t told = notices_.past().size();
  const auto tries = {
      std::function<void()>([this] { removed("block"); }),
      std::function<void()>([this] { document_.duplicate_selected(); }),
      std::function<void()>([this] { document_.add_object(thing("new", false), desk()); }),
      std::function<void()>([this] { document_.save_as(dir_ / "scene.toml"); })};
  for (const auto& each : tries) each();
  EXPECT_EQ(notices_.past().size(), told + tries.size());
  EXPECT_EQ(objects(), 1u);
  EXPECT_FALSE(fs::exists(dir_ / "scene.toml"));
  why_fixed_.clear();
  EXPECT_TRUE(document_.may_edit());
  document_.undo();
  EXPECT_EQ(objects(), 2u);
}

TEST_F(WordsOfAScene, SayWhatIsRemovedWithAnObject) {
  open({thing("ball", false)});
  EXPECT_EQ(removed("ball"), "Removed ball. Ctrl+Z brings the object back.");
  const std::size_t told = notices_.past().size();
  document_.remove_selected();
  EXPECT_EQ(notices_.past().size(), told) << "nothing is selected";

  Object lid = thing("lid", true, 0.2), cap = thing("cap", true, 0.3);
  lid.body->joint = BodyJoint{};
  lid.body->joint->to = "box";
  const BodySpring to_box{.between = {"lid", "box"}, .points = {}};
  const BodySpring to_world{.between = {"box", ""}, .points = {}};
  const BodySpring other{.between = {"cap", ""}, .points = {}};
  const std::string back =
      "Ctrl+Z brings the object back. Objects that move are back at their "
      "start positions.";
  open({thing("box", true), lid, cap, thing("post", false)}, {to_box, other});
  EXPECT_EQ(removed("post"), "Removed post. " + back);
  EXPECT_EQ(removed("box"),
            "Removed box. The joint of lid now connects to the world. The object's spring was "
            "removed, too. " +
                back);
  EXPECT_EQ(document_.scene().springs.size(), 1u);
  EXPECT_EQ(document_.scene().springs[0].between[0], "cap");
  EXPECT_EQ(removed("cap"), "Removed cap. The object's spring was removed, too. " + back);
  EXPECT_EQ(removed("lid"), "Removed lid. Ctrl+Z brings the object back.") << "the last that moved";
  open({thing("box", true), lid}, {to_box, to_world});
  EXPECT_THAT(removed("box"), HasSubstr("The object's 2 springs were removed, too. "));
  document_.undo();
  EXPECT_EQ(objects(), 2u);
  EXPECT_EQ(document_.scene().springs.size(), 2u);
}

// A model of 1234 triangles, ten to a row, whose longest row is `size` [mm].
class AddedModel : public WordsOfAScene {
 protected:
  void add(double size) {
    std::string text = "solid part\n";
    const double wide = size / 10;
    for (int i = 0; i < 1234; ++i) {
      const double x = wide * (i % 10), y = 0.5 * size * (i / 10) / 124;
      text += fmt::format(
          "facet normal 0 0 1\nouter loop\nvertex {} {} 0\nvertex {} {} 0\nvertex {} {} "
          "0\nendloop\nendfacet\n",
          x, y, x + wide, y, x, y + 0.5 * size / 124);
    }
    test::write_file(dir_ / "part.stl", text + "endsolid\n");
    document_.add_model(load_model(dir_ / "part.stl"), desk());
    document_.note_changes();
  }
};

TEST_F(AddedModel, IsToldOfWithItsTrianglesAndSize) {
  open({thing("ball", false)});
  add(100);
  EXPECT_THAT(said(), AllOf(StartsWith("Added part: 1,234 triangles, "),
                            HasSubstr(", largest size 10 cm. Ctrl+Z removes the object."),
                            Not(HasSubstr("scaled by"))));
  EXPECT_EQ(document_.editor().selected_object()->name, "part");
  const Bounds box = document_.selected_bounds();
  EXPECT_NEAR(box.sizes().maxCoeff(), 0.1, 1e-6);
  EXPECT_LT((box.center() - desk().base).norm(), desk().reach) << "within reach";
  document_.undo();
  EXPECT_EQ(objects(), 1u);
  EXPECT_TRUE(document_.selected_bounds().isEmpty()) << "nothing is selected";
  add(1000);
  EXPECT_THAT(said(), HasSubstr(", largest size 8 cm, scaled by 0.08. Ctrl+Z removes the object."));
  EXPECT_NEAR(document_.selected_bounds().sizes().maxCoeff(), 0.08, 1e-6);
}

TEST_F(WordsOfAScene, PutNewObjectsOnTheTable) {
  Object table;
  table.name = "top";
  table.shape = Plane{};
  table.pose = pose_at({0.2, 0, -0.04});
  const auto height = [&] { return document_.editor().selected_object()->pose.translation().z(); };
  open({table});
  document_.add_object(thing("ball", false), desk());
  EXPECT_NEAR(height(), -0.04 + 0.02, 1e-9) << "it stands";
  Object plane;
  plane.name = "shelf";
  plane.shape = Plane{};
  document_.add_object(plane, desk());
  EXPECT_LT((document_.editor().selected_object()->pose.translation() - Vec3(0.2, 0, -0.02)).norm(),
            1e-9)
      << "between tip and table";
  open({});
  document_.add_object(plane, desk());
  EXPECT_LT((document_.editor().selected_object()->pose.translation() - Vec3(0.2, 0, -0.04)).norm(),
            1e-9);
  open({});
  document_.add_object(thing("ball", false), desk());
  EXPECT_NEAR(height(), desk().rest.z(), 1e-9) << "at the tip's height";
}

TEST_F(WordsOfAScene, SayThatASceneIsFull) {
  std::vector<Object> many;
  for (int i = 0; i < 64; ++i) many.push_back(thing(fmt::format("{}", i).c_str(), false));
  open(many);
  document_.add_object(thing("one more", false), desk());
  EXPECT_EQ(said(), "A scene holds at most 64 objects; remove an object first.");
  EXPECT_TRUE(complained());
  EXPECT_EQ(objects(), 64u);
  document_.editor().select(3);
  notices_.say("between");
  document_.duplicate_selected();
  EXPECT_EQ(said(), "A scene holds at most 64 objects; remove an object first.");
  EXPECT_EQ(objects(), 64u);
}

TEST_F(WordsOfAScene, SayWhereTheyAreSavedAndWhyNot) {
  open({thing("ball", false)});
  removed("ball");
  EXPECT_TRUE(document_.editor().dirty());
  const fs::path file = dir_ / "mine.toml";
  EXPECT_TRUE(document_.save_as(file));
  EXPECT_EQ(said(), "Saved " + file.string());
  EXPECT_FALSE(complained());
  EXPECT_FALSE(document_.editor().dirty());
  EXPECT_EQ(settings_.scene, file.string()) << "it is opened at the next start";
  EXPECT_EQ(document_.file(), file.string());
  EXPECT_EQ(document_.own_file(), file);
  document_.undo();
  EXPECT_EQ(objects(), 1u) << "saving is no step";
  EXPECT_FALSE(document_.save_as(dir_ / "none/mine.toml"));
  EXPECT_TRUE(complained());
  EXPECT_THAT(said(), HasSubstr("none"));
  EXPECT_EQ(document_.file(), file.string());
  document_.set_file((data_dir() / "assets/scenes/table.toml").string());
  EXPECT_EQ(document_.own_file(), fs::path()) << "what came along is not written over";
}

TEST_F(WordsOfAScene, AskBeforeChangesAreLost) {
  open({thing("ball", false)});
  int left = 0;
  const auto leave = [&] { document_.leave([&] { ++left; }); };
  leave();
  EXPECT_EQ(left, 1) << "nothing would be lost";
  EXPECT_FALSE(document_.asking());
  removed("ball");
  leave();
  EXPECT_EQ(left, 1);
  EXPECT_TRUE(document_.asking());
  document_.stay();
  EXPECT_FALSE(document_.asking());
  EXPECT_EQ(left, 1);
  leave();
  document_.leave_now();
  EXPECT_EQ(left, 2);
  EXPECT_FALSE(document_.asking());
  EXPECT_TRUE(document_.editor().dirty());
  leave();
  document_.discard_and_leave();
  EXPECT_EQ(left, 3);
  EXPECT_FALSE(document_.asking());
  EXPECT_FALSE(document_.editor().dirty());
}

}  // namespace
}  // namespace limpid
