// Vertices at rest of glTF files that are made to move.
#include <gtest/gtest.h>

#include "render/model/gltf_model.h"
#include "tests/render/model/gltf_builder.h"

namespace limpid {
namespace {

using Eigen::Vector3f;

// A corner each at the origin, at x = 1 and at y = 1.
GltfBuilder corner() {
  GltfBuilder file;
  file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  return file;
}

std::vector<Vector3f> places(const GltfBuilder& file) {
  std::vector<Vector3f> out;
  for (const Vertex& v : parse_gltf(file.binary(), "part.glb").vertices) out.push_back(v.position);
  return out;
}

// A target that lifts the second vertex by 1, and one that moves all by 10 along x.
GltfBuilder morphed(const std::string& node) {
  GltfBuilder file = corner();
  const int lift =
      file.accessor(file.view(std::vector<float>{0, 0, 0, 0, 0, 1, 0, 0, 0}), 5126, "VEC3", 3);
  const int move =
      file.accessor(file.view(std::vector<float>{10, 0, 0, 10, 0, 0, 10, 0, 0}), 5126, "VEC3", 3);
  file.primitive = R"(,"targets":[{"POSITION":)" + std::to_string(lift) + R"(},{"POSITION":)" +
                   std::to_string(move) + "}]";
  file.nodes = node;
  return file;
}

TEST(GltfRest, AddsMorphTargetsByTheNodesWeights) {
  const auto at = places(morphed(R"({"mesh":0,"weights":[0.5,0.1]})"));
  EXPECT_TRUE(at[0].isApprox(Vector3f(1, 0, 0)));
  EXPECT_TRUE(at[1].isApprox(Vector3f(2, 0, 0.5f)));
}

TEST(GltfRest, LeavesMorphTargetsOutWithoutWeights) {
  EXPECT_TRUE(places(morphed(R"({"mesh":0})"))[1].isApprox(Vector3f(1, 0, 0)));
}

// A target of weight 0 does not count, not even where it holds no places at all.
TEST(GltfRest, LeavesOutAMorphTargetOfWeightZero) {
  GltfBuilder file = corner();
  const int nowhere =
      file.accessor(file.view(std::vector<float>(9, std::nanf(""))), 5126, "VEC3", 3);
  const int shorter = file.accessor(file.view(std::vector<float>(6, 1.0f)), 5126, "VEC3", 2);
  file.primitive = R"(,"targets":[{"POSITION":)" + std::to_string(nowhere) + R"(},{"POSITION":)" +
                   std::to_string(shorter) + "}]";
  file.nodes = R"({"mesh":0,"weights":[0,0]})";
  const auto at = places(file);
  EXPECT_EQ(at[1], Vector3f(1, 0, 0));
  EXPECT_EQ(at[2], Vector3f(0, 1, 0));
}

// JSON has no number for infinity, and a float holds less than a number of JSON may be.
TEST(GltfRest, RefusesAMorphTargetsWeightBeyondAllBounds) {
  for (const char* weight : {"1e999", "-1e999", "1e300"}) {
    EXPECT_THROW(places(morphed(R"({"mesh":0,"weights":[)" + std::string(weight) + "]}")),
                 std::runtime_error)
        << weight;
  }
}

TEST(GltfRest, RefusesAMorphTargetThatDoesNotMatchItsMesh) {
  const auto refusal = [](std::size_t count, const char* type, std::size_t numbers) -> std::string {
    GltfBuilder file = corner();
    const int target =
        file.accessor(file.view(std::vector<float>(numbers, 1.0f)), 5126, type, count);
    file.primitive = R"(,"targets":[{"POSITION":)" + std::to_string(target) + "}]";
    file.nodes = R"({"mesh":0,"weights":[0.5]})";
    try {
      places(file);
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(3, "VEC3", 9), "");
  for (const std::string& said :
       {refusal(2, "VEC3", 6), refusal(4, "VEC3", 12), refusal(3, "VEC2", 6)}) {
    EXPECT_NE(said.find("part.glb"), std::string::npos) << said;
    EXPECT_NE(said.find("a morph target's POSITION does not match its mesh"), std::string::npos)
        << said;
  }
}

// A skin with the first vertex on joint 1, the second on joint 2, the third between the two.
GltfBuilder skinned(const std::string& more_of_skin) {
  GltfBuilder file = corner();
  file.attribute(
      "JOINTS_0",
      file.accessor(file.view(std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}), 5121,
                    "VEC4", 3));
  file.attribute(
      "WEIGHTS_0",
      file.accessor(file.view(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, .5f, .5f, 0, 0}), 5126,
                    "VEC4", 3));
  // The place of the mesh's own node does not count.
  file.nodes = R"({"mesh":0,"skin":0,"translation":[99,99,99]},{"translation":[0,0,2]},)"
               R"({"translation":[0,0,4]})";
  file.roots = "0,1,2";
  file.more = R"(,"skins":[{"joints":[1,2])" + more_of_skin + "}]";
  return file;
}

TEST(GltfRest, HoldsASkinByItsJoints) {
  const auto at = places(skinned(""));
  EXPECT_TRUE(at[0].isApprox(Vector3f(0, 0, 2)));
  EXPECT_TRUE(at[1].isApprox(Vector3f(1, 0, 4)));
  EXPECT_TRUE(at[2].isApprox(Vector3f(0, 1, 3)));
}

TEST(GltfRest, TakesASkinFromWhereItWasBound) {
  GltfBuilder file = skinned(R"(,"inverseBindMatrices":3)");
  std::vector<float> down = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -2, 1};
  std::vector<float> both = down;
  both.insert(both.end(), down.begin(), down.end());
  ASSERT_EQ(file.accessor(file.view(both), 5126, "MAT4", 2), 3);
  const auto at = places(file);
  EXPECT_TRUE(at[0].isApprox(Vector3f(0, 0, 0)));
  EXPECT_TRUE(at[1].isApprox(Vector3f(1, 0, 2)));
}

TEST(GltfRest, RefusesAJointThatDoesNotExist) {
  GltfBuilder file = skinned("");
  file.more = R"(,"skins":[{"joints":[1]}])";
  EXPECT_THROW(parse_gltf(file.binary(), "part.glb"), std::runtime_error);
}

// Each vertex has four joints and four weights; a list that is of another width or length belongs
// to something else.
TEST(GltfRest, RefusesJointsAndWeightsOfAnotherWidthOrLength) {
  using Bytes = std::vector<std::uint8_t>;
  using Floats = std::vector<float>;
  const auto refused = [](const char* type, const Bytes& joints, const char* weight_type,
                          const Floats& weights, std::size_t joint_count,
                          std::size_t weight_count) {
    GltfBuilder file = corner();
    file.attribute("JOINTS_0", file.accessor(file.view(joints), 5121, type, joint_count));
    file.attribute("WEIGHTS_0", file.accessor(file.view(weights), 5126, weight_type, weight_count));
    file.nodes = R"({"mesh":0,"skin":0},{"translation":[0,0,3]})";
    file.roots = "0,1";
    file.more = R"(,"skins":[{"joints":[1]}])";
    try {
      parse_gltf(file.binary(), "part.glb");
      return false;
    } catch (const std::runtime_error& e) {
      return std::string(e.what()).find("do not match POSITION") != std::string::npos;
    }
  };
  const Bytes four(12, 0), two(8, 0);
  const Floats each(12, 0.25f), halves(8, 0.5f);
  EXPECT_FALSE(refused("VEC4", four, "VEC4", each, 3, 3));
  EXPECT_TRUE(refused("VEC2", two, "VEC4", each, 3, 3));
  EXPECT_TRUE(refused("VEC4", four, "VEC2", halves, 3, 3));
  EXPECT_TRUE(refused("VEC4", two, "VEC4", each, 2, 3));
  EXPECT_TRUE(refused("VEC4", four, "VEC4", halves, 3, 2));
}

// Weights of a half on one joint and a quarter on the other become two thirds and one third.
TEST(GltfRest, BringsWeightsToOne) {
  GltfBuilder file = corner();
  file.attribute(
      "JOINTS_0",
      file.accessor(file.view(std::vector<std::uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}), 5121,
                    "VEC4", 3));
  file.attribute("WEIGHTS_0", file.accessor(file.view(std::vector<float>{.5f, .25f, 0, 0, .5f, .25f,
                                                                         0, 0, .5f, .25f, 0, 0}),
                                            5126, "VEC4", 3));
  file.nodes = R"({"mesh":0,"skin":0},{"translation":[0,0,3]},{"translation":[0,0,6]})";
  file.roots = "0,1,2";
  file.more = R"(,"skins":[{"joints":[1,2]}])";
  const auto at = places(file);
  EXPECT_TRUE(at[0].isApprox(Vector3f(0, 0, 4)));
  EXPECT_TRUE(at[1].isApprox(Vector3f(1, 0, 4)));
  EXPECT_TRUE(at[2].isApprox(Vector3f(0, 1, 4)));
}

}  // namespace
}  // namespace limpid
