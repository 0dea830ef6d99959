// Reading of xacro files, with a program in xacro's place that prints the arm.
#include <sys/stat.h>

#include <cstdlib>

#include "tests/devices/files/test_files.h"
#include "tests/devices/files/urdf_pieces.h"

namespace limpid {
namespace {

using test::joint;
using test::link;
using test::refusal;
using testing::AllOf;
using testing::HasSubstr;

class XacroFile : public testing::Test {
 protected:
  XacroFile() : path_(getenv("PATH")) {
    test::write_file(dir_ / "arm.xacro", "<robot name='r'><xacro:link name='a'/></robot>");
    test::write_file(dir_ / "arm.txt", test::robot(link("a") + joint("a", "b") + link("b")));
  }
  ~XacroFile() override { setenv("PATH", path_.c_str(), 1); }

  void install(const std::string& script) {
    test::write_file(dir_ / "xacro", "#!/bin/sh\n" + script);
    chmod((dir_ / "xacro").c_str(), 0755);
    setenv("PATH", ((dir_ / "").string() + ":" + path_).c_str(), 1);
  }

  const test::TempDir dir_;
  const std::string path_;
};

TEST_F(XacroFile, IsExpandedByTheProgramOfThatName) {
  install("cat \"$(dirname \"$1\")/arm.txt\"\n");
  const ArmDescription arm = read_urdf(dir_ / "arm.xacro", {}, Xacro::expand);
  EXPECT_EQ(arm.dof(), 1);
  EXPECT_EQ(arm.urdf, test::file_bytes(dir_ / "arm.txt"));
}

TEST_F(XacroFile, IsKnownByItsMacrosToo) {
  install("cat \"$(dirname \"$1\")/arm.txt\"\n");
  std::filesystem::rename(dir_ / "arm.xacro", dir_ / "arm.urdf");
  EXPECT_EQ(read_urdf(dir_ / "arm.urdf", {}, Xacro::expand).dof(), 1);
}

// Expanding runs code in the file: without permission the program is not even started.
TEST_F(XacroFile, IsNotExpandedUnlessSomebodySaysSo) {
  install("touch \"$(dirname \"$1\")/started\"\ncat \"$(dirname \"$1\")/arm.txt\"\n");
  EXPECT_THAT(refusal<XacroToExpand>([&] { read_urdf(dir_ / "arm.xacro"); }),
              AllOf(HasSubstr("arm.xacro"), HasSubstr("run code"), HasSubstr("--allow-xacro")));
  EXPECT_FALSE(std::filesystem::exists(dir_ / "started"));
  read_urdf(dir_ / "arm.xacro", {}, Xacro::expand);
  EXPECT_TRUE(std::filesystem::exists(dir_ / "started"));
}

TEST_F(XacroFile, ThatFailsSaysWhy) {
  install("echo warming up >&2; echo 'undefined property x' >&2; exit 3\n");
  EXPECT_THAT(refusal([&] { read_urdf(dir_ / "arm.xacro", {}, Xacro::expand); }),
              AllOf(HasSubstr("arm.xacro"), HasSubstr("undefined property x")));
}

TEST_F(XacroFile, ThatPrintsWithoutEndIsStopped) {
  install("exec yes\n");
  EXPECT_THAT(refusal([&] { read_urdf(dir_ / "arm.xacro", {}, Xacro::expand); }), HasSubstr("end"));
}

TEST_F(XacroFile, IsRefusedWithoutTheProgramAndSaysHowToExpandIt) {
  setenv("PATH", "/nowhere", 1);
  EXPECT_THAT(refusal([&] { read_urdf(dir_ / "arm.xacro", {}, Xacro::expand); }),
              AllOf(HasSubstr("arm.xacro"), HasSubstr("xacro arm.xacro > arm.urdf")));
}

TEST_F(XacroFile, IsNotWhatAnExpandedFileSaysOfWhereItCameFrom) {
  setenv("PATH", "/nowhere", 1);
  test::write_file(
      dir_ / "arm.urdf",
      "<robot name='r' xmlns:xacro='http://ros.org/wiki/xacro'><!-- <xacro:macro/> -->" +
          link("a") + joint("a", "b") + link("b") + "</robot>");
  EXPECT_EQ(read_urdf(dir_ / "arm.urdf").dof(), 1);
}

}  // namespace
}  // namespace limpid
