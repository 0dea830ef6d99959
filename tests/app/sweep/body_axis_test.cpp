#include "app/sweep/body_axis.h"

#include <gmock/gmock.h>

#include "devices/files/text_file.h"
#include "tests/app/sweep/plans.h"

namespace limpid {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// A scene of two bodies; one has dots in its name, and a joint.
const std::string kScene = R"(title = "Two"
about = "Two bodies."

[[body]]
name = "die"
box = [0.03, 0.03, 0.03]
mass = 0.05
inertia = [1e-5, 2e-5, 2.5e-5]
position = [0.3, 0, 0]
stiffness = 2000

[[body]]
name = "lid.joint"
sphere = 0.01
density = 500
position = [0.3, 0.1, 0]
stiffness = 1000

[body.joint]
kind = "slider"
axis = [0, 0, 1]

[[body]]
name = "bob"
sphere = 0.01
mass = 0.05
position = [0.3, 0.2, 0]
stiffness = 1000

[body.joint]
kind = "ball"
point = [0, 0, 0.1]
)";

class BodyAxes : public testing::Test {
 protected:
  BodyAxes() { std::ofstream(dir_ / "two.toml") << kScene; }
  std::string plan(const std::string& key, const std::string& values) const {
    return "scene = \"two.toml\"\nhand = { at = [0.19, 0, 0] }\nseconds = 0.01\nmeasure = "
           "[\"energy\"]\naxis = [ { key = \"" +
           key + "\", values = " + values + " } ]\n";
  }
  std::string refusal(const std::string& text) const {
    try {
      test::sweep_plan(dir_, text);
    } catch (const FileError& e) {
      return e.what();
    }
    return "taken";
  }
  Object made(const std::string& key, const std::string& value, const std::string& name) const {
    const SweepPlan plan_ = test::sweep_plan(dir_, plan(key, "[" + value + "]"));
    for (const Object& object : run_of(plan_, 0).document.scene.objects) {
      if (object.name == name) return object;
    }
    return {};
  }
  test::TempDir dir_;
};

TEST_F(BodyAxes, SetWhatTheyName) {
  EXPECT_EQ(made("scene.body.die.mass", "0.2", "die").body->mass, 0.2);
  EXPECT_EQ(made("scene.body.die.stiffness", "300", "die").material.stiffness, 300);
  EXPECT_EQ(made("scene.body.die.stiffness", "300", "lid.joint").material.stiffness, 1000);
  const Material both = made("scene.body.die.friction", "0.3", "die").material;
  EXPECT_EQ(both.friction_static, 0.3);
  EXPECT_EQ(both.friction_kinetic, 0.3);
  EXPECT_EQ(made("scene.body.die.friction_kinetic", "0.3", "die").material.friction_static, 0);
  EXPECT_EQ(made("scene.body.die.contact_stiffness", "9000", "die").body->contact_stiffness, 9000);
  EXPECT_EQ(made("scene.body.die.restitution", "0.5", "die").body->restitution, 0.5);
  const auto lid = [&](const std::string& property, const std::string& value) {
    return *made("scene.body.lid.joint.joint." + property, value, "lid.joint").body->joint;
  };
  EXPECT_EQ(lid("damping", "0.3").damping, 0.3);
  EXPECT_EQ(lid("friction", "0.4").friction, 0.4);
  EXPECT_EQ(lid("spring", "70").force.spring, 70);
  EXPECT_EQ(lid("detent.force", "0.2").force.detent_force, 0.2);
  EXPECT_EQ(lid("detent.period", "0.004").force.detent_period, 0.004);
  EXPECT_EQ(lid("rest", "0.002").force.rest, 0.002);
  EXPECT_EQ(lid("stop_stiffness", "5000").stop_stiffness, 5000);
  EXPECT_EQ(lid("stop_restitution", "0.25").stop_restitution, 0.25);
  EXPECT_EQ(made("scene.body.die.damping", "3", "die").material.damping, 3);
  // The key is the body's mass: the body's name begins like a joint's key.
  EXPECT_EQ(made("scene.body.lid.joint.mass", "0.1", "lid.joint").body->mass, 0.1);
}

// Given moments scale with the mass, as the shape stays; a given density no longer holds.
TEST_F(BodyAxes, MakeABodyHeavierInAllThatItWeighs) {
  const Object die = made("scene.body.die.mass", "0.1", "die");
  EXPECT_LT((*die.body->inertia - Vec3(2e-5, 4e-5, 5e-5)).norm(), 1e-18);
  const SweepPlan two = test::sweep_plan(dir_, plan("scene.body.lid.joint.mass", "[0.1]"));
  EXPECT_TRUE(run_of(two, 0).document.densities.empty());
}

TEST_F(BodyAxes, AreCalledByTheirLastWordAndHaveUnits) {
  const SweepPlan mass = test::sweep_plan(dir_, plan("scene.body.die.mass", "[0.1, 0.2]"));
  EXPECT_EQ(mass.axes[0].name, "mass");
  EXPECT_EQ(mass.axes[0].unit, "kg");
  EXPECT_EQ(test::sweep_plan(dir_, plan("scene.body.die.friction", "[0.1]")).axes[0].unit, "-");
}

TEST_F(BodyAxes, SayWhatIsWrongAndWhatIsAllowed) {
  EXPECT_THAT(refusal(plan("scene.body.dye.mass", "[1]")),
              AllOf(HasSubstr("scene.body.dye.mass"), HasSubstr("two.toml"), HasSubstr("'dye'"),
                    HasSubstr("die, lid.joint")));
  EXPECT_THAT(refusal(plan("scene.body.die.weight", "[1]")),
              AllOf(HasSubstr("scene.body.die.weight"), HasSubstr("mass, friction, stiffness")));
  EXPECT_THAT(refusal(plan("scene.body.mass", "[1]")), HasSubstr("scene.body.NAME"));
  EXPECT_THAT(refusal(plan("scene.body.die.mass", "[0]")),
              AllOf(HasSubstr("numbers from 1e-06 to 100 kg"), HasSubstr("values")));
  EXPECT_THAT(refusal(plan("scene.body.die.stiffness", "[0]")), HasSubstr("numbers above 0"));
  EXPECT_THAT(
      refusal(plan("scene.body.die.joint.spring", "[1]")),
      AllOf(HasSubstr("'die' is on no joint; allowed: mass, "), Not(HasSubstr("joint.damping"))));
  EXPECT_THAT(refusal(plan("scene.body.bob.joint.spring", "[1]")),
              AllOf(HasSubstr("'bob' is on a ball joint; allowed: mass, "),
                    HasSubstr("joint.damping, joint.friction"), Not(HasSubstr("joint.spring, "))));
  EXPECT_THAT(refusal("hand = { tap = 2 }\nmeasure = [\"energy\"]\naxis = [ { key = "
                      "\"scene.body.die.mass\", values = [1] } ]"),
              HasSubstr("a tap test has its own wall"));
  EXPECT_THAT(refusal("measure = [\"energy\"]\naxis = [ { key = \"scene.body.die.mass\", values = "
                      "[1] } ]"),
              AllOf(HasSubstr("table.toml"), HasSubstr("nothing moves in this scene")));
}

// Boundaries can be searched along bodies' keys, too.
TEST_F(BodyAxes, MayBeSearchedAlong) {
  const std::string boundary = R"(scene = "two.toml"
hand = { at = [0.19, 0, 0] }
seconds = 0.01
[boundary]
measure = "bodies_moved"
above = 1e-4
tolerance = 0.01
axis = { key = "scene.body.%.mass", from = 0.01, to = 1, count = 2 }
)";
  const auto named = [&](const std::string& name) {
    std::string text = boundary;
    return text.replace(text.find('%'), 1, name);
  };
  EXPECT_EQ(refusal(named("die")), "taken");
  EXPECT_THAT(refusal(named("dye")), HasSubstr("no body is called 'dye'"));
}

}  // namespace
}  // namespace limpid
