// Facts and warnings about a model before it is touched.
#include "app/run/model_report.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <fstream>

#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

// Triangles of a box between the origin and (1, 1, 1), seen from outside.
using Corner = std::array<int, 3>;
constexpr std::array<std::array<Corner, 3>, 12> kFaces{{
    {{{0, 0, 0}, {0, 1, 0}, {1, 1, 0}}},
    {{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}}},
    {{{0, 0, 1}, {1, 0, 1}, {1, 1, 1}}},
    {{{0, 0, 1}, {1, 1, 1}, {0, 1, 1}}},
    {{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}}},
    {{{0, 0, 0}, {1, 0, 1}, {0, 0, 1}}},
    {{{0, 1, 0}, {0, 1, 1}, {1, 1, 1}}},
    {{{0, 1, 0}, {1, 1, 1}, {1, 1, 0}}},
    {{{0, 0, 0}, {0, 0, 1}, {0, 1, 1}}},
    {{{0, 0, 0}, {0, 1, 1}, {0, 1, 0}}},
    {{{1, 0, 0}, {1, 1, 0}, {1, 1, 1}}},
    {{{1, 0, 0}, {1, 1, 1}, {1, 0, 1}}},
}};

class AModelsReport : public testing::Test {
 protected:
  // An STL of a box with these edges; `turned`: seen from inside.
  std::filesystem::path stl(const Vec3& size, bool turned = false, std::size_t faces = 12) const {
    const std::filesystem::path file = dir_ / "box.stl";
    std::ofstream out(file);
    out << "solid box\n";
    for (std::size_t i = 0; i < faces; ++i) {
      out << "facet normal 0 0 0\nouter loop\n";
      for (const std::size_t k :
           turned ? std::array<std::size_t, 3>{0, 2, 1} : std::array<std::size_t, 3>{0, 1, 2}) {
        const Corner& c = kFaces[i][k];
        out << fmt::format("vertex {} {} {}\n", c[0] * size.x(), c[1] * size.y(), c[2] * size.z());
      }
      out << "endloop\nendfacet\n";
    }
    out << "endsolid box\n";
    return file;
  }
  // An OBJ of a box of 1 m, each half of its faces of a material.
  std::filesystem::path obj() const {
    const std::filesystem::path file = dir_ / "box.obj";
    std::ofstream(dir_ / "box.mtl") << "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n";
    std::ofstream out(file);
    out << "mtllib box.mtl\n";
    int at = 0;
    for (std::size_t i = 0; i < 12; ++i) {
      for (const Corner& c : kFaces[i]) out << fmt::format("v {} {} {}\n", c[0], c[1], c[2]);
      out << (i < 6 ? "usemtl red\n" : "usemtl blue\n");
      out << fmt::format("f {} {} {}\n", at + 1, at + 2, at + 3);
      at += 3;
    }
    return file;
  }
  const test::TempDir dir_;
};

TEST_F(AModelsReport, HasItsFacts) {
  const ModelReport report = report_on_model(stl({20, 30, 40}));
  EXPECT_THAT(report.facts, ElementsAre("triangles    12", "size         20 x 30 x 40 mm",
                                        "read as      in mm, z up (guessed)", "surface      closed",
                                        "materials    1", "textures     0 pictures"));
  EXPECT_THAT(report.warnings, IsEmpty());
}

TEST_F(AModelsReport, CountsMaterialsAndTakesAnObjForMetres) {
  const ModelReport report = report_on_model(obj());
  EXPECT_THAT(report.facts, Contains("size         1 x 1 x 1 m"));
  EXPECT_THAT(report.facts, Contains("read as      in m, y up (guessed)"));
  EXPECT_THAT(report.facts, Contains("materials    2"));
}

// A file in millimetres would hold nothing below one.
TEST_F(AModelsReport, TakesASmallStlForMetres) {
  const ModelReport report = report_on_model(stl({0.2, 0.3, 0.4}));
  EXPECT_THAT(report.facts, Contains("size         200 x 300 x 400 mm"));
  EXPECT_THAT(report.facts, Contains("read as      in m, z up (guessed)"));
}

TEST_F(AModelsReport, WarnsOfSizesThatNobodyTouches) {
  EXPECT_THAT(
      report_on_model(stl({20000, 10, 10})).warnings,
      Contains(HasSubstr("read as in mm, z up (guessed), the model is 20 m long, more than 10 m")));
  EXPECT_THAT(report_on_model(stl({0.0005, 0.0002, 0.0002})).warnings,
              Contains(HasSubstr("the model is 0.5 mm long, less than 1 mm")));
  Model model;
  model.vertices.resize(2);
  model.vertices[1].position = Eigen::Vector3f(1, 0, 0);
  for (const double unit : {1e-3, 1.0, 10.0}) EXPECT_EQ(size_warning(model, unit), "") << unit;
  for (const double unit : {0.99e-3, 10.1}) EXPECT_NE(size_warning(model, unit), "") << unit;
}

TEST_F(AModelsReport, WarnsOfFacesThatLookInwards) {
  EXPECT_THAT(report_on_model(stl({20, 30, 40}, true)).warnings,
              ElementsAre(StartsWith("the faces point inwards")));
}

// Four of a plate's twelve triangles are its two large faces.
TEST_F(AModelsReport, WarnsOfThinWalls) {
  EXPECT_THAT(report_on_model(stl({100, 100, 0.4})).warnings,
              ElementsAre(StartsWith("33 % of the model's surface is a wall thinner than 0.5 %")));
  EXPECT_THAT(report_on_model(stl({100, 100, 0.6})).warnings, IsEmpty());
}

TEST_F(AModelsReport, SaysThatASurfaceIsOpen) {
  const ModelReport report = report_on_model(stl({20, 30, 40}, false, 10));
  EXPECT_THAT(report.facts, Contains("surface      open"));
  EXPECT_EQ(report.warnings.size(), 1u);
}

}  // namespace
}  // namespace limpid
