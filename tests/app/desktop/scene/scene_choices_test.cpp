// Lists, menus and boxes of the scene's panel: what they offer, and what a choice changes.
#include "app/desktop/scene/object_signs.h"
#include "app/desktop/scene/scene_panel.h"
#include "app/desktop/widgets/modal.h"
#include "tests/app/desktop/widgets/read_panel.h"
#include "tests/support/built_in.h"

namespace limpid {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class SceneChoices : public ReadPanel {
 protected:
  void open(std::vector<Object> objects, std::vector<BodySpring> springs = {}) {
    SceneDocument scene;
    const std::size_t count = objects.size();
    for (Object& object : objects) scene.scene.add(std::move(object));
    scene.scene.springs = std::move(springs);
    document_.open(arm_, std::move(scene), MeshModels(count), true);
    show([this] {
      panel_.draw(
          document_, arm_, false, [this](std::string_view id) { asked_.emplace_back(id); },
          [this](const Object& object) { added_.push_back(object); });
      document_.note_changes();
    });
  }
  void select(const std::string& name) {
    for (std::size_t i = 0; i < document_.scene().objects.size(); ++i) {
      if (document_.scene().objects[i].name == name) document_.editor().select(i);
    }
    away();
  }
  const Object& object(const std::string& name) const {
    return *std::ranges::find(document_.scene().objects, name, &Object::name);
  }
  // Opens the list beside a caption; returns what it offers.
  std::vector<std::string> offered(const std::string& caption) {
    const auto at = find(caption);
    EXPECT_TRUE(at) << caption << " is not in:\n" << words();
    if (at) click(ImVec2{0.7f * kWidth, at->middle().y});
    std::vector<std::string> all;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.window.starts_with("##Combo")) all.push_back(each.text);
    }
    return all;
  }
  void take(const std::string& word) { click(word, "##Combo"); }
  void type_into(const char* label, const char* text) {
    const auto place = noted_place("panel", label);
    ASSERT_TRUE(place) << label << " is not in:\n" << words();
    type(*place, text);
  }
  static Object thing(const char* name, bool moves, double x) {
    Object object;
    object.name = name;
    object.shape = Box{{0.02, 0.03, 0.04}};
    object.pose = pose_at({x, 0.02, 0.03});
    if (moves) object.body = Body{};
    return object;
  }

  const ArmDescription arm_ = test::omni();
  Settings settings_;
  Notices notices_;
  Document document_{settings_, notices_, [] { return std::string(); }};
  ScenePanel panel_;
  std::vector<std::string> asked_;
  std::vector<Object> added_;
};

// A spring joins two bodies, or one and the world; a fixed object is neither.
TEST_F(SceneChoices, OfASpringsEndsAreWhatMovesAndTheWorld) {
  open({thing("post", false, 0.3), thing("it", true, 0.1), thing("other", true, 0.2),
        thing("third", true, 0.25)},
       {BodySpring{.between = {"it", ""}, .points = {Vec3::Zero(), Vec3(0.1, 0, 0.2)}}});
  const auto ends = [&] { return document_.scene().springs.front().between; };
  click("it to the world");
  EXPECT_THAT(hint("From"), HasSubstr("first end of the spring"));
  EXPECT_THAT(hint("To"), HasSubstr("or the world, at the second end"));
  EXPECT_THAT(offered("From"), ElementsAre("it", "other", "third"));
  take("third");
  EXPECT_THAT(ends(), ElementsAre("third", ""));
  EXPECT_TRUE(find("third to the world")) << words();
  EXPECT_THAT(offered("To"), ElementsAre("the world", "it", "other"));
  take("other");
  EXPECT_THAT(ends(), ElementsAre("third", "other"));
  EXPECT_TRUE(find("third to other")) << words();
  EXPECT_THAT(offered("From"), ElementsAre("it", "third"));
  take("it");
  EXPECT_THAT(ends(), ElementsAre("it", "other"));
  offered("To");
  take("the world");
  EXPECT_THAT(ends(), ElementsAre("it", ""));
  document_.undo();
  EXPECT_THAT(ends(), ElementsAre("it", "other"));
}

// Values along a joint begin anew with its kind, as metres are no radians; its place stays.
TEST_F(SceneChoices, OfAJointAreItsKindAndWhatItHangsOn) {
  open({thing("it", true, 0.1), thing("other", true, 0.2)});
  select("it");
  const auto joint = [&] { return object("it").body->joint; };
  EXPECT_THAT(offered("Hangs on"),
              ElementsAre("nothing, it is free", "a slider", "a hinge", "a ball joint"));
  take("a slider");
  ASSERT_TRUE(joint());
  EXPECT_EQ(joint()->kind, BodyJoint::Kind::slider);
  EXPECT_EQ(joint()->to, "");
  EXPECT_THAT(offered("of"), ElementsAre("the world", "other"));
  take("other");
  EXPECT_EQ(joint()->to, "other");
  type_into("Axis x, y, z", "0.7");
  type_into("Dry friction", "0.75");
  EXPECT_EQ(joint()->friction, 0.75);
  const Vec3 axis = joint()->axis;
  EXPECT_GT(axis.y(), 0.1);
  offered("Hangs on");
  take("a hinge");
  EXPECT_EQ(joint()->kind, BodyJoint::Kind::hinge);
  EXPECT_EQ(joint()->to, "other");
  EXPECT_LT((joint()->axis - axis).norm(), 1e-12);
  EXPECT_EQ(joint()->friction, BodyJoint{}.friction) << "of another unit";
  type_into("Joint at x, y, z [mm]", "5");
  offered("Hangs on");
  take("a ball joint");
  EXPECT_EQ(joint()->kind, BodyJoint::Kind::ball);
  EXPECT_NEAR(joint()->point.y(), 0.005, 1e-12);
  select("other");
  offered("Hangs on");
  take("a slider");
  EXPECT_THAT(offered("of"), ElementsAre("the world")) << "not itself, nor what hangs on it";
  take("the world");
  select("it");
  offered("Hangs on");
  take("nothing, it is free");
  EXPECT_FALSE(joint());
  EXPECT_TRUE(object("other").body->joint);
}

TEST_F(SceneChoices, OfAStopAreTheArmsJointsAndItsSide) {
  Object stop;
  stop.name = "stop";
  stop.shape = JointStop{1, 0.7, -1};
  open({stop});
  select("stop");
  const auto now = [&] { return std::get<JointStop>(object("stop").shape); };
  click(arm_.joints[1].name);
  for (const Joint& joint : arm_.joints) {
    EXPECT_TRUE(find(joint.name, "##Combo")) << joint.name;
  }
  take(arm_.joints[2].name);
  EXPECT_EQ(now().joint, 2);
  EXPECT_EQ(now().angle, 0.7);
  EXPECT_TRUE(find(arm_.joints[2].name)) << "its name is shown";
  EXPECT_FALSE(find(arm_.joints[1].name));
  EXPECT_THAT(hint("stops motion above"), HasSubstr("Off: stops motion below the angle."));
  click("stops motion above");
  EXPECT_EQ(now().direction, 1);
  click("stops motion above");
  EXPECT_EQ(now().direction, -1);
}

TEST_F(SceneChoices, OfAPartAreFourShapes) {
  open({thing("it", true, 0.1)});
  select("it");
  click("Add part");
  click("1: ball");
  const auto shape = [&] { return object("it").parts.at(0).shape; };
  EXPECT_THAT(offered("Shape"), ElementsAre("ball", "box", "cylinder", "capsule"));
  take("box");
  EXPECT_EQ(shape(), Shape(Box{Vec3::Constant(0.02)})) << "2 cm";
  EXPECT_TRUE(find("1: box"));
  offered("Shape");
  take("cylinder");
  EXPECT_EQ(shape(), Shape(Cylinder{0.01, 0.02}));
  offered("Shape");
  take("capsule");
  EXPECT_EQ(shape(), Shape(Capsule{0.01, 0.02}));
  offered("Shape");
  take("capsule");
  EXPECT_EQ(shape(), Shape(Capsule{0.01, 0.02})) << "it is one already";
  EXPECT_THAT(hint("Shape"), HasSubstr("begins with a size of 2 cm"));
  EXPECT_THAT(hint("Remove part"), HasSubstr("Ctrl+Z brings the part back."));
}

TEST_F(SceneChoices, OfTheMenuAreAModelAndEachNewObject) {
  open({thing("it", true, 0.1)});
  click("Add");
  // Lines are as far apart as each other, but for those that move, which a line sets apart.
  float before = find("Model...")->min.y, pitch = 0;
  for (const NewObject& each : new_objects()) {
    const auto at = find(each.label);
    ASSERT_TRUE(at) << each.label;
    if (pitch == 0) pitch = at->min.y - before;
    EXPECT_GT(pitch, 5);
    const float further = at->min.y - before - pitch;
    if (each.first_that_moves) {
      EXPECT_GT(further, 2) << each.label;
    } else {
      EXPECT_NEAR(further, 0, 1) << each.label;
    }
    before = at->min.y;
  }
  click("Model...");
  EXPECT_THAT(asked_, ElementsAre("scene.add_model"));
  for (const NewObject& each : new_objects()) {
    click("Add");
    click(each.label);
    ASSERT_FALSE(added_.empty()) << each.label;
    EXPECT_EQ(added_.back().name, each.object.name);
    EXPECT_EQ(added_.back().shape, each.object.shape) << each.label;
    EXPECT_EQ(added_.back().body.has_value(), each.object.body.has_value());
  }
  EXPECT_EQ(added_.size(), new_objects().size());
  EXPECT_EQ(asked_.size(), 1u);
}

TEST_F(SceneChoices, GiveTheSelectedObjectAnotherName) {
  open({thing("first", false, 0.1), thing("second", false, 0.2)});
  select("second");
  const auto field = noted_place("panel", "name");
  ASSERT_TRUE(field);
  show_mouse(*field);
  frames();
  std::string said;
  for (const test::DrawnText& each : test::drawn_texts()) {
    if (each.window.starts_with("##Tooltip")) said += each.text;
  }
  EXPECT_EQ(said, "Its name");
  type_into("name", "lid");
  EXPECT_EQ(document_.scene().objects[1].name, "lid");
  EXPECT_EQ(document_.scene().objects[0].name, "first");
  EXPECT_TRUE(find("lid", "objects")) << "in the list";
  type_into("name", "first");
  EXPECT_EQ(document_.scene().objects[1].name, "first 2") << "the name is taken";
}

TEST_F(SceneChoices, MixAColour) {
  Object ball = thing("it", false, 0.1);
  ball.shape = Sphere{0.02};
  open({ball});
  select("it");
  EXPECT_THAT(hint("a colour of its own"), HasSubstr("the object has the default colour"));
  click("a colour of its own");
  ASSERT_TRUE(object("it").color);
  EXPECT_EQ(*object("it").color, Vec3(Vec3::Constant(0.6)));
  const auto part = [&](const char* letter) -> std::optional<test::DrawnText> {
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.text.starts_with(letter)) return each;
    }
    return std::nullopt;
  };
  ASSERT_TRUE(part("R:") && part("G:") && part("B:")) << words();
  type(part("G:")->middle(), "255");
  EXPECT_LT((*object("it").color - Vec3(0.6, 1, 0.6)).norm(), 1e-12);
  type(part("B:")->middle(), "51");
  EXPECT_LT((*object("it").color - Vec3(0.6, 1, 0.2)).norm(), 1e-12);
}

// Lines of the list: the icon before the name, one below the other, and at most six at once.
TEST_F(SceneChoices, ListObjectsInTheirOrder) {
  std::vector<Object> many;
  for (const char* name : {"a1", "b2", "c3", "d4", "e5", "f6", "g7", "h8"}) {
    many.push_back(thing(name, false, 0.1));
  }
  open(many);
  const auto first = find("a1", "objects"), second = find("b2", "objects");
  ASSERT_TRUE(first && second);
  EXPECT_NEAR(first->min.x, second->min.x, 1);
  EXPECT_GT(second->min.y, first->max.y - 1);
  int shown = 0;
  for (const test::DrawnText& each : test::drawn_texts()) {
    shown += each.window.find("objects") != std::string::npos && each.whole();
  }
  EXPECT_NEAR(shown, 6, 1);
  EXPECT_THAT(hint("b2", "objects"), "b2, box. Double click to look at it.");
  select("h8");
  EXPECT_TRUE(find("h8", "objects")) << "the list scrolls to what is selected";
  EXPECT_THAT(asked_, IsEmpty());
}

}  // namespace
}  // namespace limpid
