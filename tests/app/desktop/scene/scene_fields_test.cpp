// Fields of the scene's panel: each changes its own number, in its unit and within its range, and
// says what it is.
#include "devices/files/scene/scene_fields.h"

#include <functional>
#include <numbers>

#include "app/desktop/scene/scene_panel.h"
#include "app/desktop/widgets/modal.h"
#include "core/touch/mass_properties.h"
#include "tests/app/desktop/widgets/read_panel.h"
#include "tests/support/built_in.h"
#include "tests/support/meshes.h"

namespace limpid {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

constexpr double kDegree = std::numbers::pi / 180;

class SceneFields : public ReadPanel {
 protected:
  void open(std::vector<Object> objects, std::vector<BodySpring> springs = {}) {
    SceneDocument scene;
    scene.title = "A scene";
    scene.about = "What it is for.";
    const std::size_t count = objects.size();
    for (Object& object : objects) scene.scene.add(std::move(object));
    scene.scene.springs = std::move(springs);
    document_.open(arm_, std::move(scene), MeshModels(count), true);
    if (count > 0) document_.editor().select(0);
    show([this] {
      panel_.draw(
          document_, arm_, fixed_, [this](std::string_view id) { asked_.emplace_back(id); },
          [this](const Object& object) { added_.push_back(object); });
      document_.note_changes();
    });
  }
  void type_into(const char* label, const char* text) {
    const auto place = noted_place("panel", label);
    ASSERT_TRUE(place) << label << " is not in:\n" << words();
    type(*place, text);
  }
  const Object& object() const { return document_.scene().objects.front(); }

  ArmDescription arm_ = test::omni();
  Settings settings_;
  Notices notices_;
  Document document_{settings_, notices_, [] { return std::string(); }};
  ScenePanel panel_;
  bool fixed_ = false;
  std::vector<std::string> asked_;
  std::vector<Object> added_;
};

Object body_of(Shape shape) {
  Object body;
  body.name = "it";
  body.shape = std::move(shape);
  body.pose = pose_at({0.1, 0.02, 0.03});
  body.body = Body{};
  return body;
}

Object on_a_joint(BodyJoint::Kind kind) {
  Object body = body_of(Box{{0.02, 0.03, 0.04}});
  BodyJoint joint;
  joint.kind = kind;
  joint.low = kind == BodyJoint::Kind::slider ? -0.01 : -1;
  joint.high = kind == BodyJoint::Kind::slider ? 0.01 : 1;
  body.body->joint = joint;
  return body;
}

struct Field {
  const char* label;
  const char* typed;
  double value;  // then, in SI
  double (*of)(const Object&);
};

const BodyJoint& joint(const Object& o) { return *o.body->joint; }

// Types into each field, and looks at all of them.
void expect_own_numbers(std::span<const Field> fields, const std::function<void()>& anew,
                        const std::function<void(const Field&)>& typed,
                        const std::function<const Object&()>& now) {
  for (const Field& field : fields) {
    anew();
    std::vector<double> before;
    for (const Field& each : fields) before.push_back(each.of(now()));
    typed(field);
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const bool own = fields[i].of == field.of;
      const double value = fields[i].of(now());
      EXPECT_NEAR(value, own ? field.value : before[i], 1e-9 * std::max(1.0, std::abs(value)))
          << "typed into " << field.label << ", looked at " << fields[i].label;
    }
  }
}

// The middle one of three fields is typed into.
constexpr Field kOfBody[] = {
    {"Mass", "5", 0.005, [](const Object& o) { return o.body->mass; }},
    {"Contact stiffness", "1234", 1234, [](const Object& o) { return o.body->contact_stiffness; }},
    {"Position x, y, z [mm]", "-7", -0.007,
     [](const Object& o) { return o.pose.translation().y(); }},
    {"Size x, y, z [mm]", "12", 0.012,
     [](const Object& o) { return std::get<Box>(o.shape).size.y(); }},
};
// Fields of both kinds of joints that have an axis.
constexpr Field kOfJoint[] = {
    {"Damping", "0.25", 0.25, [](const Object& o) { return joint(o).damping; }},
    {"Dry friction", "0.75", 0.75, [](const Object& o) { return joint(o).friction; }},
    {"Stops' stiffness", "321", 321, [](const Object& o) { return joint(o).stop_stiffness; }},
    {"Spring", "2.5", 2.5, [](const Object& o) { return joint(o).force.spring; }},
    {"Detent", "0.3", 0.3, [](const Object& o) { return joint(o).force.detent_force; }},
};
constexpr Field kOfSlider[] = {
    {"From", "-4", -0.004, [](const Object& o) { return joint(o).low; }},
    {"To", "6", 0.006, [](const Object& o) { return joint(o).high; }},
    {"Rest", "3", 0.003, [](const Object& o) { return joint(o).force.rest; }},
    {"Detent's period", "8", 0.008, [](const Object& o) { return joint(o).force.detent_period; }},
};
constexpr Field kOfHinge[] = {
    {"From", "-20", -20 * kDegree, [](const Object& o) { return joint(o).low; }},
    {"To", "30", 30 * kDegree, [](const Object& o) { return joint(o).high; }},
    {"Rest", "10", 10 * kDegree, [](const Object& o) { return joint(o).force.rest; }},
    {"Detent's period", "15", 15 * kDegree,
     [](const Object& o) { return joint(o).force.detent_period; }},
    {"Joint at x, y, z [mm]", "9", 0.009, [](const Object& o) { return joint(o).point.y(); }},
};

TEST_F(SceneFields, OfABodyChangeTheirOwnNumberInItsUnit) {
  expect_own_numbers(
      kOfBody,
      [this] {
        open({body_of(Box{{0.02, 0.03, 0.04}})});
      },
      [this](const Field& field) { type_into(field.label, field.typed); },
      [this]() -> const Object& { return object(); });
}

TEST_F(SceneFields, OfAJointChangeTheirOwnNumberInItsUnit) {
  for (const auto& [kind, own] :
       {std::pair(BodyJoint::Kind::slider, std::span<const Field>(kOfSlider)),
        std::pair(BodyJoint::Kind::hinge, std::span<const Field>(kOfHinge))}) {
    std::vector<Field> fields(std::begin(kOfJoint), std::end(kOfJoint));
    fields.insert(fields.end(), own.begin(), own.end());
    expect_own_numbers(
        fields, [this, kind = kind] { open({on_a_joint(kind)}); },
        [this](const Field& field) { type_into(field.label, field.typed); },
        [this]() -> const Object& { return object(); });
  }
}

TEST_F(SceneFields, OfAJointsAxisKeepItOneLong) {
  open({on_a_joint(BodyJoint::Kind::hinge)});
  type_into("Axis x, y, z", "0.5");
  EXPECT_NEAR(joint(object()).axis.norm(), 1, 1e-12);
  EXPECT_GT(joint(object()).axis.y(), 0.4);
  EXPECT_EQ(joint(object()).axis.x(), 0);
}

TEST_F(SceneFields, OfEachKindOfJointAreThoseThatItHas) {
  using enum BodyJoint::Kind;
  for (const auto kind : {slider, hinge, ball}) {
    open({on_a_joint(kind)});
    EXPECT_EQ(find("Axis x, y, z").has_value(), kind != ball);
    EXPECT_EQ(find("Joint at x, y, z [mm]").has_value(), kind != slider);
    EXPECT_EQ(find("Detent").has_value(), kind != ball);
    EXPECT_EQ(find("has stops").has_value(), kind != ball);
    EXPECT_TRUE(find("Dry friction"));
  }
  open({body_of(Sphere{0.01})});
  EXPECT_FALSE(find("Dry friction")) << "it is free";
}

TEST_F(SceneFields, TakeNothingBeyondWhatAFileMayHold) {
  open({on_a_joint(BodyJoint::Kind::slider)});
  struct Tried {
    const char *label, *most, *beyond, *below;
    std::function<double()> value;
    double limit;
  };
  const std::vector<Tried> all{
      {"Mass", "100000", "1e9", "0", [&] { return object().body->mass; }, 100},
      {"Contact stiffness", "1000000", "1e9", "0", [&] { return object().body->contact_stiffness; },
       1e6},
      {"Position x, y, z [mm]", "10000", "1e9", "-1e9",
       [&] { return object().pose.translation().y(); }, 10},
      {"Damping", "0", "nan", "-1", [&] { return joint(object()).damping; }, 0},
  };
  for (const Tried& each : all) {
    const double before = each.value();
    type_into(each.label, each.beyond);
    EXPECT_EQ(each.value(), before) << each.label;
    type_into(each.label, each.most);
    EXPECT_EQ(each.value(), each.limit) << each.label;
    type_into(each.label, each.below);
    EXPECT_EQ(each.value(), each.limit) << each.label;
  }
  type_into("Axis x, y, z", "7");
  EXPECT_LE(joint(object()).axis.y(), 1);
  type_into("From", "500");
  EXPECT_LT(joint(object()).low, joint(object()).high) << "the stops stay in their order";
  type_into("To", "-500");
  EXPECT_LT(joint(object()).low, joint(object()).high);
}

TEST_F(SceneFields, OfStopsComeWithARoomOfTheirOwn) {
  for (const auto& [kind, room] :
       {std::pair(BodyJoint::Kind::slider, 0.01), std::pair(BodyJoint::Kind::hinge, 0.5)}) {
    Object free = on_a_joint(kind);
    free.body->joint->low = -std::numeric_limits<double>::infinity();
    free.body->joint->high = std::numeric_limits<double>::infinity();
    open({free});
    EXPECT_FALSE(find("Stops' stiffness"));
    click("has stops");
    EXPECT_EQ(joint(object()).low, -room);
    EXPECT_EQ(joint(object()).high, room);
    EXPECT_TRUE(find("Stops' stiffness"));
    click("has stops");
    EXPECT_TRUE(std::isinf(joint(object()).low) && std::isinf(joint(object()).high));
  }
}

TEST_F(SceneFields, OfSizesAreThoseOfTheShape) {
  open({body_of(Cylinder{0.01, 0.05})});
  type_into("Radius", "7");
  type_into("Length", "33");
  EXPECT_EQ(std::get<Cylinder>(object().shape), (Cylinder{0.007, 0.033}));
  open({body_of(Capsule{0.01, 0.05})});
  type_into("Radius", "7");
  type_into("Length", "33");
  EXPECT_EQ(std::get<Capsule>(object().shape), (Capsule{0.007, 0.033}));
  type_into("Radius", "0");
  EXPECT_EQ(std::get<Capsule>(object().shape).radius, 0.007) << "not taken";
  type_into("Radius", "0.1");
  EXPECT_NEAR(std::get<Capsule>(object().shape).radius, 1e-4, 1e-12);
}

TEST_F(SceneFields, SayWhatTheyAre) {
  open({on_a_joint(BodyJoint::Kind::hinge)});
  for (const char* label : {"Material",
                            "Position x, y, z [mm]",
                            "Size x, y, z [mm]",
                            "a colour of its own",
                            "moves",
                            "Mass",
                            "a magnet picks it up",
                            "Bounce",
                            "Contact stiffness",
                            "a centre of mass of its own",
                            "moments of inertia of its own",
                            "Hangs on",
                            "of",
                            "Axis x, y, z",
                            "Joint at x, y, z [mm]",
                            "Damping",
                            "Dry friction",
                            "has stops",
                            "From",
                            "To",
                            "Stops' stiffness",
                            "Stops' bounce",
                            "Spring",
                            "Rest",
                            "Detent",
                            "Detent's period",
                            "Add part",
                            "Add spring",
                            "Tip radius",
                            "Save scene",
                            "Gallery...",
                            "A scene",
                            "Add",
                            "Copy",
                            "Remove",
                            "Look",
                            "Gravity x, y, z [m/s?]"}) {
    const auto at = find(label) ? label : std::string(label).substr(0, 15);
    EXPECT_TRUE(!find(at) || hint(at) != "") << label;
    EXPECT_THAT(words(), HasSubstr(std::string(label).substr(0, 15)));
  }
  EXPECT_EQ(hint("A scene"), "What it is for.");
  EXPECT_THAT(hint("Mass"), HasSubstr("Mass of the object, up to 100 kg."));
}

TEST_F(SceneFields, OfWhatMovesBeginWithTheMassOfWood) {
  Object cube = body_of(Box{{0.1, 0.1, 0.1}});
  cube.body.reset();
  open({cube});
  EXPECT_FALSE(find("Mass"));
  EXPECT_FALSE(find("Springs"));
  click("moves");
  ASSERT_TRUE(object().body);
  EXPECT_NEAR(object().body->mass, 0.6, 1e-9) << "a litre at 600 kg/m^3";
  EXPECT_TRUE(find("Mass"));
  EXPECT_TRUE(find("Springs"));
  click("a magnet picks it up");
  EXPECT_TRUE(object().body->magnet);
  click("moves");
  EXPECT_FALSE(object().body);
}

TEST_F(SceneFields, OfASpringChangeTheirOwnNumber) {
  const auto anew = [this] {
    open({body_of(Sphere{0.01})},
         {BodySpring{.between = {"it", ""}, .points = {Vec3::Zero(), Vec3(0.1, 0, 0.2)}}});
    document_.editor().select(std::nullopt);
    away();
    if (!find("Length")) click("it to the world");
  };
  struct OfSpring {
    const char* label;
    const char* typed;
    double value;
    double (*of)(const BodySpring&);
  };
  constexpr OfSpring kFields[] = {
      {"First end x, y, z [mm]", "11", 0.011, [](const BodySpring& s) { return s.points[0].y(); }},
      {"Second end x, y, z [mm]", "22", 0.022, [](const BodySpring& s) { return s.points[1].y(); }},
      {"Length", "33", 0.033, [](const BodySpring& s) { return s.length; }},
      {"Stiffness", "44", 44, [](const BodySpring& s) { return s.stiffness; }},
      {"Damping", "5.5", 5.5, [](const BodySpring& s) { return s.damping; }},
  };
  for (const OfSpring& field : kFields) {
    anew();
    const BodySpring before = document_.scene().springs.front();
    EXPECT_NE(hint(field.label), "") << field.label;
    type_into(field.label, field.typed);
    for (const OfSpring& each : kFields) {
      const double wanted = each.of == field.of ? field.value : each.of(before);
      EXPECT_NEAR(each.of(document_.scene().springs.front()), wanted, 1e-9)
          << field.label << ", " << each.label;
    }
  }
  anew();
  type_into("Breaks at", "6");
  EXPECT_EQ(document_.scene().springs.front().breaks_at, 6);
  type_into("Breaks at", "0");
  EXPECT_TRUE(std::isinf(document_.scene().springs.front().breaks_at)) << "never";
  click("Remove spring");
  EXPECT_THAT(document_.scene().springs, IsEmpty());
  document_.undo();
  EXPECT_EQ(document_.scene().springs.size(), 1u);
}

TEST_F(SceneFields, AddASpringFromTheSelectedBodyToWhereItIs) {
  Object other = body_of(Sphere{0.01});
  other.name = "other";
  other.pose = pose_at({0.2, 0, 0});
  open({body_of(Sphere{0.01}), other});
  document_.editor().select(1);
  away();
  click("Add spring");
  ASSERT_EQ(document_.scene().springs.size(), 1u);
  EXPECT_THAT(document_.scene().springs[0].between, ElementsAre("other", ""));
  EXPECT_EQ(document_.scene().springs[0].points[1], Vec3(0.2, 0, 0));
  document_.editor().select(std::nullopt);
  away();
  click("Add spring");
  EXPECT_EQ(document_.scene().springs[1].between[0], "it") << "the first that moves";
}

TEST_F(SceneFields, OfTheTipAndGravityAreTheScenes) {
  open({body_of(Sphere{0.01})});
  type_into("Tip radius", "4");
  EXPECT_NEAR(document_.scene().tip_radius, 0.004, 1e-12);
  type_into("Gravity x, y, z [m/s\xC2\xB2]", "1.62");
  EXPECT_EQ(document_.scene().gravity, Vec3(0, 1.62, -9.81));
  EXPECT_TRUE(find("changed"));
  EXPECT_THAT(hint("changed"), HasSubstr("not saved"));
}

TEST_F(SceneFields, ListObjectsAndActOnTheSelectedOne) {
  Object other = body_of(Box{{0.01, 0.01, 0.01}});
  other.name = "other";
  other.body.reset();
  open({body_of(Sphere{0.01}), other});
  const auto line = [&](const char* name) {
    frames(20);  // clicks before are over
    click(name, "objects");
  };
  EXPECT_THAT(hint("it", "objects"), StartsWith("it, "));
  EXPECT_THAT(hint("it", "objects"), HasSubstr(" that moves. Double click to look at it."));
  EXPECT_THAT(hint("other", "objects"), Not(HasSubstr("that moves")));
  const std::size_t place = document_.scene().objects[0].name == "other" ? 0 : 1;
  document_.editor().select(std::nullopt);
  line("other");
  EXPECT_EQ(document_.editor().selected(), place);
  line("other");
  EXPECT_EQ(document_.editor().selected(), std::nullopt);
  for (const char* button : {"Copy", "Remove", "Look"}) click(button);
  EXPECT_THAT(asked_, IsEmpty()) << "nothing is selected";
  line("other");
  for (const char* button : {"Copy", "Remove", "Look", "Save scene", "Gallery..."}) click(button);
  EXPECT_THAT(asked_, ElementsAre("scene.copy", "scene.remove", "scene.look", "scene.save",
                                  "scene.gallery"));
}

// A double click leaves its object selected, whether or not it was so before.
TEST_F(SceneFields, LookAtAnObjectThatIsClickedTwice) {
  open({body_of(Sphere{0.01})});
  document_.editor().select(std::nullopt);
  const auto twice = [&] {
    const auto at = find("it", "objects");
    ASSERT_TRUE(at) << words();
    show_mouse(at->middle());
    frames(20);  // clicks before are over
    for (const bool down : {true, false, true, false}) {
      show_mouse_button(0, down);
      frames(1);
    }
    away();
  };
  twice();
  EXPECT_EQ(document_.editor().selected(), 0u);
  EXPECT_THAT(asked_, ElementsAre("scene.look"));
  twice();
  EXPECT_EQ(document_.editor().selected(), 0u);
  EXPECT_THAT(asked_, ElementsAre("scene.look", "scene.look"));
}

TEST_F(SceneFields, CannotBeChangedWhileRecording) {
  fixed_ = true;
  open({body_of(Sphere{0.01})});
  EXPECT_THAT(words(), HasSubstr("Cannot be changed while recording."));
  const auto place = noted_place("panel", "Mass");
  ASSERT_TRUE(place);
  type(*place, "5");
  EXPECT_EQ(object().body->mass, Body{}.mass);
  click("Save scene");
  EXPECT_THAT(asked_, IsEmpty());
}

TEST_F(SceneFields, OfARecordingOnlyShowIt) {
  SceneDocument scene;
  scene.scene.add(body_of(Sphere{0.01}));
  show([&] { ScenePanel::draw_recorded(scene); });
  EXPECT_THAT(words(), StartsWith("untitled\n"));
  EXPECT_THAT(words(), HasSubstr("The scene of the recording. This scene cannot be"));
  EXPECT_TRUE(find("it"));
  EXPECT_FALSE(find("Add"));
}

TEST_F(SceneFields, OfAnEmptySceneSayHowItIsFilled) {
  open({});
  EXPECT_TRUE(find("Nothing to touch. Drop a model here."));
  click("Add");
  away();
  EXPECT_TRUE(find("Model..."));
}

// A panel that is only looked at changes nothing, whatever it shows.
TEST_F(SceneFields, OfEveryShapeChangeNothingByThemselves) {
  for (const Shape& shape :
       {Shape(Plane{}), Shape(Sphere{0.02}), Shape(Box{{0.02, 0.03, 0.04}}),
        Shape(Cylinder{0.01, 0.05}), Shape(Capsule{0.01, 0.05}), Shape(JointStop{1, 0.7, -1})}) {
    Object one;
    one.shape = shape;
    one.pose = pose_at({0.1, 0.02, 0.03});
    one.name = "it";
    open({one});
    frames();
    EXPECT_FALSE(document_.editor().dirty()) << shape.index();
    EXPECT_EQ(object().shape, shape) << shape.index();
  }
}

TEST_F(SceneFields, OfAStopTurnIt) {
  Object stop;
  stop.shape = JointStop{1, 0.7, -1};
  stop.name = "it";
  open({stop});
  type_into("Angle", "-30");
  const auto& now = std::get<JointStop>(object().shape);
  EXPECT_NEAR(now.angle, -std::numbers::pi / 6, 1e-12);
  EXPECT_EQ(now.joint, 1);
  EXPECT_EQ(now.direction, -1);
  document_.undo();
  EXPECT_EQ(std::get<JointStop>(object().shape).angle, 0.7);
}

TEST_F(SceneFields, OfAPlaneMoveAPointOfIt) {
  Object plane;
  plane.shape = Plane{};
  plane.name = "it";
  open({plane});
  type_into("Point on the plane x, y, z [mm]", "12");
  EXPECT_EQ(object().pose.translation(), Vec3(0, 0.012, 0));
}

TEST_F(SceneFields, OfANameTakeItWholeWhenItIsLeft) {
  open({body_of(Sphere{0.02})});
  const auto place = noted_place("panel", "name");
  ASSERT_TRUE(place);
  click(*place);
  for (const char* letters : {"m", "ar", "ble"}) {
    EXPECT_EQ(object().name, "it");
    ImGui::GetIO().AddInputCharactersUTF8(letters);
    frames(2);
  }
  click(ImVec2{200, kHeight - 10});
  EXPECT_THAT(object().name, HasSubstr("marble"));
  document_.undo();
  EXPECT_EQ(object().name, "it");
}

TEST_F(SceneFields, OfABallMoveItsCentreAndSize) {
  Object ball;
  ball.shape = Sphere{0.02};
  ball.name = "it";
  open({ball});
  type_into("Centre x, y, z [mm]", "-5");
  type_into("Radius", "7");
  EXPECT_EQ(object().pose.translation(), Vec3(0, -0.005, 0));
  EXPECT_NEAR(std::get<Sphere>(object().shape).radius, 0.007, 1e-12);
}

// A square whose edges are 1 in its file, and the fields about that file.
class ModelFields : public SceneFields {
 protected:
  void open_model() {
    const test::Triangles square = test::grid(1, 1);
    auto model = std::make_shared<Model>();
    for (const Eigen::Vector3f& v : square.vertices) model->vertices.push_back({v, v});
    model->indices = square.indices;
    model->parts = {{0, static_cast<std::uint32_t>(square.indices.size())}};
    Object object = test::obstacle(square);
    object.name = "it";
    test::mesh_of(object).model = "square.stl";
    SceneDocument scene;
    scene.scene.add(object);
    document_.open(arm_, std::move(scene), MeshModels{model}, true);
    document_.editor().select(0);
    show([this] {
      panel_.draw(
          document_, arm_, fixed_, [](std::string_view) {}, [](const Object&) {});
      document_.note_changes();
    });
  }
  const Mesh& mesh() const { return test::mesh_of(object()); }
  // Opens a list by its caption, and clicks one of its words.
  void choose(const char* caption, const char* word) {
    const auto at = find(caption);
    ASSERT_TRUE(at) << words();
    click(ImVec2{0.7f * kWidth, at->middle().y});
    click(word, "##Combo");
  }
};

TEST_F(ModelFields, SetItsScaleOrItsLargestExtent) {
  open_model();
  type_into("Scale", "2.5");
  EXPECT_NEAR(mesh().scale, 2.5, 1e-12);
  type_into("Largest extent", "50");
  EXPECT_NEAR(mesh().size() * 1, 0.05, 1e-12) << "of a square whose edge is 1";
  EXPECT_THAT(hint("Scale"), HasSubstr("the size in the model's file"));
}

TEST_F(ModelFields, SetTheUnitAndTheAxesOfItsFile) {
  open_model();
  choose("Unit of the file", "mm");
  EXPECT_EQ(mesh().unit, 0.001);
  EXPECT_EQ(mesh().scale, 1);
  choose("Unit of the file", "in");
  EXPECT_EQ(mesh().unit, 0.0254);
  EXPECT_FALSE(mesh().y_up);
  choose("Axis up", "y");
  EXPECT_TRUE(mesh().y_up);
  choose("Axis up", "z");
  EXPECT_FALSE(mesh().y_up);
  EXPECT_THAT(hint("Unit of the file"), HasSubstr("Unit of the coordinates in the file"));
  EXPECT_THAT(hint("Axis up"), HasSubstr("points up"));
}

TEST_F(ModelFields, SayWhatItIsMadeOf) {
  open_model();
  EXPECT_EQ(value("triangles"), "2");
  EXPECT_THAT(hint("triangles"), HasSubstr("square.stl"));
  const std::string health = mesh().triangles->health().text();
  ASSERT_NE(health, "") << "a square is open";
  EXPECT_THAT(sentences(), HasSubstr(health.substr(0, health.find(' '))));
  EXPECT_FALSE(find("A closed surface."));
}

TEST_F(SceneFields, OfAMaterialAreThoseOfAUsualOne) {
  open({body_of(Sphere{0.02})});
  for (const UsualMaterial& usual : std::span(kUsualMaterials).first(4)) {
    const auto at = find("Material");
    ASSERT_TRUE(at) << words();
    click(ImVec2{0.7f * kWidth, at->middle().y});
    click(usual.name, "##Combo");
    EXPECT_EQ(usual_material(object().material), &usual) << usual.name;
    EXPECT_TRUE(find(usual.name)) << "its name is shown";
  }
  type_into("Mass", "5");
  EXPECT_EQ(usual_material(object().material), &kUsualMaterials[3]) << "only the mass changed";
}

}  // namespace
}  // namespace limpid
