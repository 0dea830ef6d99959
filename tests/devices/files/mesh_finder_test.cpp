#include <cstdlib>

#include "devices/files/urdf_visuals.h"
#include "tests/devices/files/test_files.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

class MeshNames : public testing::Test {
 protected:
  MeshNames() {
    unsetenv("ROS_PACKAGE_PATH");
    unsetenv("AMENT_PREFIX_PATH");
  }
  ~MeshNames() override {
    unsetenv("ROS_PACKAGE_PATH");
    unsetenv("AMENT_PREFIX_PATH");
  }

  fs::path put(const std::string& name) {
    const fs::path file = dir_ / name.c_str();
    fs::create_directories(file.parent_path());
    test::write_file(file, "x");
    return file;
  }
  void package(const std::string& folder, const std::string& name) {
    fs::create_directories(dir_ / folder.c_str());
    test::write_file(dir_ / folder.c_str() / "package.xml",
                     "<package format='2'>\n  <name> " + name + " </name>\n</package>");
  }

  const test::TempDir dir_;
};

TEST_F(MeshNames, AreFilesFromTheFolderOfTheUrdf) {
  const fs::path mesh = put("arm/meshes/a.stl");
  MeshFinder finder(dir_ / "arm");
  EXPECT_EQ(finder.find("meshes/a.stl"), mesh);
  EXPECT_EQ(finder.find("../arm/meshes/a.stl"), mesh);
  EXPECT_EQ(finder.find(mesh.string()), mesh);
  EXPECT_EQ(finder.find("file://" + mesh.string()), mesh);
  EXPECT_EQ(finder.find("file://localhost" + mesh.string()), mesh);
  EXPECT_EQ(finder.find("meshes"), "") << "a folder";
  EXPECT_EQ(finder.find("b.stl"), "");
  EXPECT_EQ(finder.find("http://localhost/a.stl"), "");
  EXPECT_EQ(MeshFinder("").find("meshes/a.stl"), "");
  EXPECT_EQ(MeshFinder("").find(mesh.string()), mesh);
}

TEST_F(MeshNames, OfPackagesAreFoundOnTheWayUp) {
  const fs::path own = put("src/ur/meshes/a.stl"), other = put("src/parts/b.stl");
  fs::create_directories(dir_ / "src/ur/urdf");
  MeshFinder finder(dir_ / "src/ur/urdf");
  EXPECT_EQ(finder.find("package://ur/meshes/a.stl"), own);
  EXPECT_EQ(finder.find("model://ur/meshes/a.stl"), own);
  EXPECT_EQ(finder.find("package://parts/b.stl"), other) << "a folder beside it";
  EXPECT_EQ(finder.find("package://parts/c.stl"), "");
  EXPECT_EQ(finder.find("package://nobody/b.stl"), "");
  EXPECT_EQ(finder.find("package://parts"), "");
  EXPECT_EQ(finder.find("package:///b.stl"), "");
}

TEST_F(MeshNames, OfPackagesAreFoundByWhatTheirManifestSays) {
  package("checkout-1.2", "ur_description");
  const fs::path own = put("checkout-1.2/meshes/a.stl");
  package("elsewhere", "parts");
  const fs::path other = put("elsewhere/b.stl");
  MeshFinder finder(dir_ / "checkout-1.2/urdf/deeper");
  EXPECT_EQ(finder.find("package://ur_description/meshes/a.stl"), own);
  EXPECT_EQ(finder.find("package://parts/b.stl"), other);
}

TEST_F(MeshNames, OfPackagesAreFoundAsRosFindsThem) {
  const fs::path direct = put("ros/one/a.stl");
  package("workspace/src/group/two-repository", "two");
  const fs::path crawled = put("workspace/src/group/two-repository/b.stl");
  package("workspace/src/group/two-repository/inner", "hidden");
  put("workspace/src/group/two-repository/inner/c.stl");
  const fs::path installed = put("install/share/three/d.stl");
  const test::TempDir far;
  MeshFinder before(far / "");
  EXPECT_EQ(before.find("package://one/a.stl"), "");
  setenv("ROS_PACKAGE_PATH",
         (dir_ / "ros").string().append(":").append((dir_ / "workspace").string()).c_str(), 1);
  setenv("AMENT_PREFIX_PATH", (dir_ / "install").c_str(), 1);
  MeshFinder finder(far / "");
  EXPECT_EQ(finder.find("package://one/a.stl"), direct);
  EXPECT_EQ(finder.find("package://two/b.stl"), crawled);
  EXPECT_EQ(finder.find("package://hidden/c.stl"), "") << "packages have none inside";
  EXPECT_EQ(finder.find("package://three/d.stl"), installed);
}

// A nearer package wins only if it has the file.
TEST_F(MeshNames, AreLookedForInEveryPackageOfTheName) {
  put("near/arm/other.stl");
  const fs::path there = put("install/share/arm/a.stl");
  fs::create_directories(dir_ / "near/urdf");
  setenv("AMENT_PREFIX_PATH", (dir_ / "install").c_str(), 1);
  EXPECT_EQ(MeshFinder(dir_ / "near/urdf").find("package://arm/a.stl"), there);
}

}  // namespace
}  // namespace limpid
