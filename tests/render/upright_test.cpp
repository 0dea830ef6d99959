// Pictures of links in glTF, with y up as the format says, or with z up as some makers write them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "render/arm_look.h"
#include "tests/render/model/gltf_builder.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using Box = Eigen::AlignedBox3d;

enum class Up { y, z };

// Writes a box, as eight corners and two of its faces, in the link's axes; `up` is the file's up
// axis.
void write_box(const std::filesystem::path& file, const Box& box, Up up) {
  std::vector<float> xyz;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p = box.corner(static_cast<Box::CornerType>(i));
    // With y up the link's z is y.
    const Vec3 in_file = up == Up::z ? p : Vec3(p.x(), p.z(), -p.y());
    for (const double x : in_file) xyz.push_back(static_cast<float>(x));
  }
  GltfBuilder gltf;
  gltf.positions(xyz);
  const std::vector<std::uint16_t> corners = {0, 1, 2, 1, 3, 2, 4, 6, 5, 5, 6, 7};
  gltf.primitive =
      R"(,"indices":)" + std::to_string(gltf.accessor(gltf.view(corners), 5123, "SCALAR", 12));
  const Bytes bytes = gltf.binary();
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

Visual picture(int link, const std::filesystem::path& file) {
  Visual visual;
  visual.link = link;
  visual.mesh = file.string();
  return visual;
}

// A collision shape that differs a little from the picture's box.
Visual shape(int link, const Box& box) {
  Visual visual;
  visual.link = link;
  visual.shape = Visual::Shape::box;
  visual.size = 1.02 * box.sizes();
  visual.origin.translation() = box.center();
  return visual;
}

// An arm whose links lie along x, then z, then x ...; tips at their ends.
ArmDescription bent_arm(int joints) {
  ArmDescription arm;
  for (int i = 0; i < joints; ++i) {
    Joint joint;
    if (i > 0)
      joint.origin.translation() = (i % 2 ? 0.4 : 0.2) * (i % 2 ? Vec3::UnitZ() : Vec3::UnitX());
    arm.joints.push_back(joint);
    arm.links.emplace_back();
    arm.frames.push_back({"link" + std::to_string(i), i, Pose::Identity()});
  }
  arm.tip.translation() = (joints % 2 ? 0.4 : 0.2) * (joints % 2 ? Vec3::UnitZ() : Vec3::UnitX());
  return arm;
}

// A box around link i from its origin to its end.
Box body(const ArmDescription& arm, int i) {
  Box box(Vec3{Vec3::Zero()});
  box.extend(end_of(arm, static_cast<std::size_t>(i)));
  return {box.min() - Vec3(0.03, 0.04, 0.05), box.max() + Vec3(0.03, 0.04, 0.05)};
}

void expect_in_place(const ArmDescription& arm) {
  for (const Visual& visual : arm.visuals) {
    const Box drawn = visual.model->bounds(), wanted = body(arm, visual.link);
    EXPECT_LT((drawn.min() - wanted.min()).norm() + (drawn.max() - wanted.max()).norm(), 1e-6)
        << visual.mesh;
  }
}

struct Written {
  explicit Written(const std::vector<Up>& ups) : arm(bent_arm(static_cast<int>(ups.size()))) {
    for (int i = 0; i < arm.dof(); ++i) {
      const auto file = dir / ("link" + std::to_string(i) + ".glb").c_str();
      write_box(file, body(arm, i), ups[static_cast<std::size_t>(i)]);
      arm.visuals.push_back(picture(i, file));
      shapes.push_back(shape(i, body(arm, i)));
    }
  }

  test::TempDir dir;
  ArmDescription arm;
  std::vector<Visual> shapes;
};

TEST(Upright, TurnsPicturesThatAreAsTheFormatHasThem) {
  for (const bool shapes : {true, false}) {
    Written w({Up::y, Up::y, Up::y});
    load_visuals(w.arm, shapes ? w.shapes : std::vector<Visual>{});
    expect_in_place(w.arm);
    EXPECT_THAT(w.arm.warnings, IsEmpty());
  }
}

TEST(Upright, LeavesPicturesWithZUpWhereTheyAreAndSaysSo) {
  for (const bool shapes : {true, false}) {
    Written w({Up::z, Up::z, Up::z, Up::z});
    load_visuals(w.arm, shapes ? w.shapes : std::vector<Visual>{});
    expect_in_place(w.arm);
    ASSERT_EQ(w.arm.warnings.size(), 1u) << "collision shapes: " << shapes;
    EXPECT_THAT(w.arm.warnings[0], AllOf(HasSubstr("link0.glb"), HasSubstr("1 more"),
                                         HasSubstr("z up"), HasSubstr("y up")));
  }
}

// A single link with its ends on its axis: only the collision shape decides.
TEST(Upright, GoesByTheCollisionShapeWhereThereIsOne) {
  for (const Up up : {Up::y, Up::z}) {
    const test::TempDir dir;
    ArmDescription arm = bent_arm(1);
    arm.tip.translation().setZero();
    const Box flag(Vec3(-0.02, -0.3, 0), Vec3(0.02, 0.1, 0.05));
    write_box(dir / "flag.glb", flag, up);
    arm.visuals = {picture(0, dir / "flag.glb")};
    load_visuals(arm, std::vector{shape(0, flag)});
    EXPECT_LT((arm.visuals[0].model->bounds().min() - flag.min()).norm(), 1e-6);
    EXPECT_EQ(arm.warnings.size(), up == Up::z ? 1u : 0u);
  }
}

// A gripper of another maker lies in the same folder.
TEST(Upright, TakesEachFileByItselfWhereItsShapeIsBeyondDoubt) {
  Written w({Up::y, Up::y, Up::z, Up::y});
  load_visuals(w.arm, w.shapes);
  expect_in_place(w.arm);
  ASSERT_EQ(w.arm.warnings.size(), 1u);
  EXPECT_THAT(w.arm.warnings[0], HasSubstr("link2.glb has z up"));
}

// A cube around the axis fits both ways: its neighbours decide.
TEST(Upright, TurnsAsItsFolderDoesWhatFitsBothWays) {
  Written w({Up::z, Up::z, Up::z, Up::z});
  const Box cube(Vec3(-0.05, -0.05, -0.05), Vec3(0.05, 0.05, 0.05));
  w.arm.frames.push_back({"cube", -1, Pose::Identity()});
  write_box(w.dir / "cube.glb", cube, Up::z);
  w.arm.visuals.push_back(picture(-1, w.dir / "cube.glb"));
  w.shapes.push_back(shape(-1, cube));
  load_visuals(w.arm, w.shapes);
  EXPECT_THAT(w.arm.warnings, testing::ElementsAre(HasSubstr("and 2 more")));
}

// Shapes that are placed, turned and scaled count at their places.
TEST(Upright, SeesPicturesWhereTheFilePutsThem) {
  Written w({Up::z, Up::z, Up::z});
  const Pose moved = Eigen::Translation3d(0.2, -0.1, 0.3) *
                     Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()) * Pose::Identity();
  for (Visual& visual : w.arm.visuals) {
    visual.size.setConstant(1e-3);
    visual.origin = moved;
  }
  w.shapes.clear();
  for (int i = 0; i < 3; ++i) {
    Visual same = shape(i, body(w.arm, i));
    same.size *= 1e-3;
    same.origin.translation() *= 1e-3;
    same.origin = moved * same.origin;
    w.shapes.push_back(same);
  }
  load_visuals(w.arm, w.shapes);
  EXPECT_EQ(w.arm.warnings.size(), 1u);
  expect_in_place(w.arm);  // the models themselves are neither scaled nor moved
}

}  // namespace
}  // namespace limpid
