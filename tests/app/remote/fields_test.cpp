// Fields of every table: their keys, ranges and readers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "app/device/device_store.h"
#include "app/remote/remote_settings.h"
#include "devices/files/config_file.h"
#include "devices/files/field_file.h"
#include "devices/files/scene/scene_fields.h"
#include "devices/files/scene/scene_text.h"

namespace limpid {
namespace {

using nlohmann::json;
using testing::HasSubstr;

BodyJoint hinge() {
  BodyJoint joint;
  joint.kind = BodyJoint::Kind::hinge;
  return joint;
}

// Calls use(name, fields, owner) for every table, with an owner that has all of its fields.
template <class Use>
void each_table(const Use& use) {
  use("settings", parameter_table(), Parameters{});
  use("limits", kSafetyLimits, SafetyLimits{});
  use("material", kMaterialFields, Material{});
  use("joint's stop", std::array{kStopStiffness}, Material{});
  use("mass", std::array{kBodyMass}, Body{});
  use("body", kBodyFields, Body{});
  use("joint", kJointFields, hinge());
  use("stops", kStopFields, hinge());
  use("force", kForceFields, JointForce{});
  use("detent", kDetentFields, JointForce{});
  const BodySpring spring;
  use("spring", kSpringFields, spring);
  use("sphere", kSphereFields, Sphere{});
  use("box", kBoxFields, Box{});
  use("cylinder", kCylinderFields, Cylinder{});
  use("capsule", kCapsuleFields, Capsule{});
  use("mesh", kMeshFields, Mesh{});
  use("joint contact", kJointStopFields, JointStop{});
  use("device", kNotesFields, DeviceNotes{});
  use("joystick", kPidFields, PidSettings{});
  use("axis", kAxisFields, AxisAdjustment{});
  use("compensation", kOwnForcesFields, OwnForces{});
}

// Calls use(table, field, owner) for every field of every table.
template <class Use>
void each_field(const Use& use) {
  each_table([&](const char* table, const auto& fields, const auto& owner) {
    for (const auto& field : fields) {
      SCOPED_TRACE(std::string(table) + ": " + field.key);
      use(fields, field, owner);
    }
  });
}

// A number in the field's range that is not `usual`, with digits that no short text has.
double other_number(const FieldInfo& field, double usual) {
  const double most = std::isinf(field.maximum) ? field.minimum + 100 : field.maximum;
  const double third = field.minimum + (most - field.minimum) / 3;
  const double other = third == usual ? third + (most - third) / 7 : third;
  return field.kind == FieldInfo::Kind::whole ? std::round(other) : other;
}

// A value that the field allows and the owner does not have.
template <class Owner>
FieldValue other_value(const Field<Owner>& field, const Owner& owner) {
  const double usual = number_of(field, owner);
  switch (field.kind) {
    case FieldInfo::Kind::number: return other_number(field, usual);
    case FieldInfo::Kind::whole: return static_cast<std::int64_t>(other_number(field, usual));
    case FieldInfo::Kind::flag: return usual == 0;
    case FieldInfo::Kind::text: return std::string("a \"b\" \\ c\n");
    case FieldInfo::Kind::choice: return std::string(field.words[usual == 0 ? 1 : 0]);
    default: break;
  }
  const double third = other_number(field, 0);
  return Vec3(third, third / 3 + field.minimum * 2 / 3, third);
}

template <class Table, class Owner>
Owner through_text(const Table& fields, const Owner& written, Owner read) {
  SceneText text;
  put_fields(text, fields, written);
  const toml::table table = parse_toml(text.text(), "x.toml");
  const TomlTable t(table, "x.toml", "");
  std::vector<const char*> keys;
  add_keys(fields, written, keys);
  t.allow_only(keys);
  read_fields(t, fields, read);
  return read;
}
Parameters through_text(std::span<const ParameterInfo>, const Parameters& written,
                        Parameters read) {
  apply_config_text(read, config_text(written), "x.toml");
  return read;
}

template <class Table, class Owner>
Owner through_table(const Table& fields, const Owner& written, Owner read) {
  toml::table table;
  insert_fields(table, fields, written);
  read_fields(TomlTable(table, "x.toml", ""), fields, read, false);
  return read;
}

template <class Table, class Owner>
void expect_same(const Table& fields, const Owner& a, const Owner& b) {
  for (const auto& field : fields) EXPECT_EQ(value_of(field, a), value_of(field, b)) << field.key;
}

TEST(Fields, HaveAKeyOfTheirOwnACaptionAndAUnit) {
  each_table([](const char* table, const auto& fields, const auto&) {
    std::set<std::string> keys;
    for (const FieldInfo& field : fields) {
      SCOPED_TRACE(std::string(table) + ": " + field.key);
      EXPECT_TRUE(keys.insert(field.key).second);
      EXPECT_NE(std::string(field.key), "");
      EXPECT_NE(std::string(field.caption), "");
      EXPECT_NE(std::string(field.unit), "");
    }
  });
}

TEST(Fields, HaveSlidersWithinWhatIsAllowed) {
  each_field([](const auto&, const auto& field, const auto&) {
    if (field.is_number()) {
      EXPECT_LT(field.minimum, field.maximum);
    }
    if (field.slider_minimum == field.slider_maximum) return;
    EXPECT_LT(field.slider_minimum, field.slider_maximum);
    EXPECT_TRUE(field.holds(field.slider_minimum) ||
                (field.exclusive_minimum && field.slider_minimum == field.minimum));
    EXPECT_TRUE(field.holds(field.slider_maximum));
    EXPECT_TRUE(!field.logarithmic || field.slider_minimum > 0);
  });
}

TEST(Fields, AllowTheirUsualValue) {
  each_field([]<class Owner>(const auto&, const Field<Owner>& field, const Owner& owner) {
    Owner again = owner;
    if (const auto value = value_of(field, owner)) {
      EXPECT_NO_THROW(set_value(field, again, *value));
      EXPECT_EQ(value_of(field, again), value);
    }
  });
}

TEST(Fields, ComeBackFromTomlToTheLastBit) {
  each_field([]<class Owner>(const auto& fields, const Field<Owner>& field, const Owner& owner) {
    Owner changed = owner;
    const FieldValue value = other_value(field, owner);
    set_value(field, changed, value);
    ASSERT_EQ(value_of(field, changed), value);
    ASSERT_NE(value_of(field, changed), value_of(field, owner)) << "it is off its usual value";
    expect_same(fields, through_text(fields, changed, owner), changed);
    if (!std::holds_alternative<Vec3>(value)) {
      EXPECT_EQ(value_of(field, through_table(fields, changed, owner)), value);
    }
  });
}

TEST(Fields, ComeBackFromJsonToTheLastBit) {
  each_field([]<class Owner>(const auto& fields, const Field<Owner>& field, const Owner& owner) {
    Owner changed = owner, again = owner;
    set_value(field, changed, other_value(field, owner));
    const json sent = json::parse(json_of(value_of(field, changed)).dump());
    set_value(field, again, field_value(field.key, sent));
    expect_same(fields, again, changed);
  });
}

TEST(Fields, ComeBackAsTheNumbersOfAnAxis) {
  each_field([]<class Owner>(const auto& fields, const Field<Owner>& field, const Owner& owner) {
    Owner changed = owner, again = owner;
    set_value(field, changed, other_value(field, owner));
    if (std::isnan(number_of(field, changed))) return;  // a text or a vector
    set_number(field, again, number_of(field, changed));
    expect_same(fields, again, changed);
  });
}

TEST(Fields, SayWhichWordWasMeant) {
  each_field([]<class Owner>(const auto& fields, const Field<Owner>& field, const Owner& owner) {
    if (field.words.empty()) return;
    const std::string word = field.words.back();
    if (word.size() < 3) return;  // another one is as near
    const auto said = [](const auto& read) -> std::string {
      try {
        read();
      } catch (const std::exception& error) {
        return error.what();
      }
      return "nothing";
    };
    Owner changed = owner;
    EXPECT_THAT(said([&] { set_value(field, changed, word + "x"); }),
                HasSubstr("; did you mean " + word + "?"));
    const toml::table table{{field.key, word + "x"}};
    const TomlTable t(table, "x.toml", "");
    EXPECT_THAT(said([&] { read_fields(t, fields, changed, false); }),
                HasSubstr("; did you mean " + word + "?"));
  });
}

TEST(Fields, RefuseWhatIsOutOfRangeNamingKeyAndFound) {
  each_field([]<class Owner>(const auto& fields, const Field<Owner>& field, const Owner& owner) {
    Owner changed = owner;
    for (const double wrong : {field.minimum - 1, field.maximum + 1, std::nan("")}) {
      if (field.holds(wrong) || !field.is_number()) continue;
      try {
        set_value(field, changed, wrong);
        ADD_FAILURE() << wrong << " was taken";
      } catch (const FieldError& error) {
        EXPECT_NE(std::string(error.what()).find(field.key), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("allowed"), std::string::npos);
      }
      expect_same(fields, changed, owner);
    }
  });
}

TEST(Fields, AreHeldWithinTheirRange) {
  each_field([]<class Owner>(const auto& fields, const Field<Owner>& field, const Owner& owner) {
    if (field.kind != FieldInfo::Kind::number) return;
    const auto* member = std::get_if<double Owner::*>(&field.member);
    for (const double wrong : {field.minimum - 1, 2 * field.maximum + 1, std::nan("")}) {
      Owner held = owner;
      held.** member = wrong;
      hold_fields(fields, held);
      const double now = number_of(field, held);
      EXPECT_TRUE(field.holds(now) || std::isnan(number_of(field, owner))) << wrong << ": " << now;
    }
  });
}

// A slider has no point that it hangs on, a ball joint no stops.
TEST(Fields, OfOtherKindsOfOwnersAreNeitherReadNorWrittenNorKept) {
  BodyJoint ball = hinge();
  ball.kind = BodyJoint::Kind::ball;
  ball.stop_stiffness = 7;
  SceneText text;
  put_fields(text, kStopFields, ball);
  EXPECT_EQ(text.text(), "");
  const toml::table table = toml::parse("stop_stiffness = 9.0");
  read_fields(TomlTable(table, "x.toml", ""), kStopFields, ball);
  EXPECT_EQ(ball.stop_stiffness, 7);
  hold_fields(kStopFields, ball);
  EXPECT_EQ(ball.stop_stiffness, BodyJoint{}.stop_stiffness);
}

}  // namespace
}  // namespace limpid
