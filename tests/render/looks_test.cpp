// Looks of materials in a picture, and what of a model is drawn. Skipped where EGL gives no
// context.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <map>

#include "render/gl/gpu_model.h"
#include "render/palette.h"
#include "tests/render/side_view.h"

namespace limpid {
namespace {

using test::apart;
using test::Colour;

// Looks of a mesh's material.
class Looks : public test::SideView {
 protected:
  // The middle of a plate that faces the eye, with this change of its model.
  Colour plate(const std::function<void(Model&)>& change) {
    put({{block(Vec3(0.1, 0.01, 0.1), {{0.5f, 0.5f, 0.5f}}, change), pose_at(kMiddle)}});
    return seen(nothing(), kMiddle + Vec3(0, -0.005, 0));
  }
  static Image one_pixel(std::array<std::uint8_t, 4> rgba, bool srgb = true) {
    return {1, 1, {rgba.begin(), rgba.end()}, srgb};
  }
  static Finish& finish(Model& m) { return m.parts[0].material; }
  const Vec3 kMiddle{0.1, 0, 0.15};
};

TEST_F(Looks, HaveAGlowOfTheirOwnByAPicture) {
  const auto black = [](Model& m) {
    for (Vertex& v : m.vertices) v.color.setZero();
  };
  const Colour dark = plate([&](Model& m) {
    black(m);
    finish(m).two_sided = true;
  });
  const Colour green = plate([&](Model& m) {
    black(m);
    finish(m).glow = {0, 1, 0};
  });
  EXPECT_GT(green.y(), dark.y() + 80);
  EXPECT_LE(std::abs(green.x() - dark.x()), 2);
  const Colour red = plate([&](Model& m) {
    black(m);
    finish(m).glow = {1, 1, 1};
    m.images = {one_pixel({255, 0, 0, 255})};
    finish(m).emission = 0;
  });
  EXPECT_GT(red.x(), dark.x() + 80);
  EXPECT_LE(std::abs(red.y() - dark.y()), 2);
}

TEST_F(Looks, AreColouredByThePictureOfTheirColour) {
  const Colour blue = plate([](Model& m) {
    m.images = {one_pixel({255, 255, 255, 255}), one_pixel({0, 0, 255, 255})};
    finish(m).color = 1;
  });
  EXPECT_GT(blue.z(), blue.x() + 60);
  const Colour white = plate([](Model& m) {
    m.images = {one_pixel({0, 0, 255, 255}), one_pixel({255, 255, 255, 255})};
    finish(m).color = 1;
  });
  EXPECT_LT(white.z(), white.x() + 40);
}

// Blue says how much it is a metal, which has no colour of its own but what it mirrors.
TEST_F(Looks, AreMetalByThePictureOfTheirSurface) {
  const auto surface = [&](std::uint8_t metal) {
    return plate([&](Model& m) {
      for (Vertex& v : m.vertices) {
        v.surface = {1, 1};
        v.color = {0.5f, 0.5f, 0.5f};
      }
      m.images = {one_pixel({0, 255, metal, 255}, false)};
      finish(m).surface = 0;
    });
  };
  EXPECT_GT(apart(surface(0), surface(255)), 20);
}

TEST_F(Looks, AreBentByThePictureOfTheirBumps) {
  const auto bent = [&](std::array<std::uint8_t, 4> normal, float bump) {
    return plate([&](Model& m) {
      for (Vertex& v : m.vertices) v.uv = {v.position.x() * 10, -v.position.z() * 10};
      m.images = {one_pixel(normal, false)};
      finish(m).normal = 0;
      finish(m).bump = bump;
    });
  };
  const Colour plain = bent({128, 128, 255, 255}, 1), up = bent({128, 230, 200, 255}, 1),
               down = bent({128, 26, 200, 255}, 1);
  EXPECT_GT(up.sum(), plain.sum() + 20) << "the light comes from above";
  EXPECT_LT(down.sum(), plain.sum() - 20);
  EXPECT_LE(apart(bent({128, 230, 200, 255}, 0), plain), 3) << "of no height";
}

TEST_F(Looks, AreSeenThroughWhereTheyBlend) {
  put({});
  const Colour empty = seen(nothing(), kMiddle);
  const auto clear = [&](float opacity) {
    return plate([&](Model& m) {
      for (Vertex& v : m.vertices) v.opacity = opacity;
      finish(m).alpha = Finish::Alpha::blend;
    });
  };
  const Colour whole = clear(1), half = clear(0.5f);
  EXPECT_GT(apart(whole, empty), 60);
  // The back is culled: one layer of half the strength.
  EXPECT_LE(apart(2 * half, whole + empty), 6);
  EXPECT_LE(apart(clear(0), empty), 2);
}

TEST_F(Looks, AreCutOutByTheirCutoff) {
  put({});
  const Colour empty = seen(nothing(), kMiddle);
  const auto cut = [&](float opacity, Finish::Alpha alpha) {
    return plate([&](Model& m) {
      for (Vertex& v : m.vertices) v.opacity = opacity;
      finish(m).alpha = alpha;
      finish(m).cutoff = 0.7f;
      finish(m).two_sided = true;
    });
  };
  EXPECT_LE(apart(cut(0.65f, Finish::Alpha::mask), empty), 2);
  EXPECT_GT(apart(cut(0.75f, Finish::Alpha::mask), empty), 60);
  EXPECT_GT(apart(cut(0.65f, Finish::Alpha::opaque), empty), 60) << "only masks are cut out";
}

// A single triangle that looks away from the eye, as a sheet has on its back.
Model sheet(bool two_sided) {
  Model model;
  for (const Eigen::Vector3f& p : {Eigen::Vector3f(-0.05f, 0, -0.05f), Eigen::Vector3f(0, 0, 0.05f),
                                   Eigen::Vector3f(0.05f, 0, -0.05f)}) {
    Vertex v{p, Eigen::Vector3f::UnitY()};
    model.vertices.push_back(v);
  }
  model.indices = {0, 1, 2};
  model.parts = {{0, 3, {.two_sided = two_sided}}};
  return model;
}

TEST_F(Looks, HaveABackOnlyWhereTheyHaveTwoSides) {
  put({});
  const Vec3 other(0.3, 0, 0.15);
  const Colour empty = seen(nothing(), kMiddle), there = seen(nothing(), other);
  const auto back = std::make_shared<const Model>(sheet(false));
  const auto both = std::make_shared<const Model>(sheet(true));
  put({{back, pose_at(kMiddle)}});
  EXPECT_LE(apart(seen(nothing(), kMiddle), empty), 2);
  put({{both, pose_at(kMiddle)}, {back, pose_at(other)}});
  EXPECT_GT(apart(seen(nothing(), kMiddle), empty), 15);
  EXPECT_LE(apart(seen(nothing(), other), there), 2) << "the next one has one side again";
  Model glowing = sheet(false);
  glowing.parts[0].material.glow = {1, 1, 1};  // drawn after it, as it is
  put({{both, pose_at(kMiddle)}, {std::make_shared<const Model>(glowing), pose_at(other)}});
  EXPECT_LE(apart(seen(nothing(), other), there), 2);
}

// With too many triangles in sight the coarse version is drawn: here of the upper and lower side
// alone, which the eye does not see.
TEST_F(Looks, AreCoarseWhereThereIsTooMuchToDraw) {
  const auto lids = [](Model& m) {
    m.coarse.assign(m.indices.end() - 12, m.indices.end());
    m.coarse_parts = {{0, 12}};
  };
  put({});
  const Colour empty = seen(nothing(), kMiddle);
  EXPECT_GT(apart(plate(lids), empty), 60);
  view_->set_quality({.msaa = 4, .shadow_size = 0, .soft = false, .triangles = 1});
  EXPECT_LE(apart(plate(lids), empty), 2);
  EXPECT_GT(apart(plate({}), empty), 60) << "what has no coarse version stays";
  const auto same = [](Model& m) {
    m.coarse = m.indices;
    m.coarse_parts = m.parts;
  };
  EXPECT_GT(apart(plate(same), empty), 60) << "a coarse version that the eye sees";
}

// The picture goes on beyond its edge as its finish says.
TEST_F(Looks, RepeatMirrorOrClampTheirPicture) {
  const std::map<Image::Wrap, std::pair<bool, bool>> red_behind{
      {Image::Wrap::repeat, {true, false}},
      {Image::Wrap::mirror, {false, true}},
      {Image::Wrap::clamp, {false, false}}};
  for (const bool across : {true, false}) {
    for (const auto& each : red_behind) {
      const Image::Wrap wrap = each.first;
      const auto& red = each.second;
      const auto at = [&](float place) {
        return plate([&](Model& m) {
          for (Vertex& v : m.vertices)
            v.uv = across ? Eigen::Vector2f(place, 0.25f) : Eigen::Vector2f(0.25f, place);
          Image image{across ? 2 : 1, across ? 1 : 2, {255, 0, 0, 255, 0, 0, 255, 255}};
          (across ? image.wrap_u : image.wrap_v) = wrap;
          m.images = {image};
          finish(m).color = 0;
        });
      };
      const auto is_red = [](const Colour& c) { return c.x() > c.z(); };
      EXPECT_TRUE(is_red(at(0.25f)));
      EXPECT_FALSE(is_red(at(0.75f)));
      EXPECT_EQ(is_red(at(1.25f)), red.first) << across;
      EXPECT_EQ(is_red(at(1.75f)), red.second) << across;
    }
  }
}

// Objects to be touched have the theme's tint, but for those with a colour of their own.
TEST_F(Looks, OfObjectsAreTintedUnlessTheyHaveAColour) {
  const auto ball = [&](std::optional<Vec3> colour) {
    Scene scene;
    scene.add({.pose = pose_at(kMiddle), .shape = Sphere{0.04}, .color = colour});
    show(scene);
    return seen(nothing(), kMiddle);
  };
  const Colour red = ball(Vec3(1, 0, 0)), plain = ball(std::nullopt);
  EXPECT_GT(red.x(), red.y() + 60);
  EXPECT_LE(std::abs(red.y() - red.z()), 6);
  EXPECT_LE(plain.maxCoeff() - plain.minCoeff(), 60) << "no colour";
  EXPECT_LT(plain.x(), red.x());
}

// A model on the card has the box of what is drawn of it, and pieces of at most 16384 triangles,
// each with its own box.
TEST_F(Looks, AreOfPiecesThatKnowTheirBoxes) {
  Model sheet;
  constexpr std::uint32_t kTriangles = 20'000;
  for (std::uint32_t i = 0; i < kTriangles; ++i) {
    const auto x = static_cast<float>(i);
    for (const Eigen::Vector3f& corner :
         {Eigen::Vector3f(x, 0, 0), Eigen::Vector3f(x + 1, 0, 0), Eigen::Vector3f(x, 2, 3)}) {
      sheet.indices.push_back(static_cast<std::uint32_t>(sheet.vertices.size()));
      sheet.vertices.push_back({corner, Eigen::Vector3f::UnitZ()});
    }
  }
  sheet.vertices.push_back({Eigen::Vector3f(0, 0, 900), Eigen::Vector3f::UnitZ()});  // not drawn
  sheet.parts = {{0, 3 * kTriangles}};
  const GpuModel model(sheet);
  EXPECT_EQ(model.box().min(), Eigen::Vector3f(0, 0, 0));
  EXPECT_EQ(model.box().max(), Eigen::Vector3f(kTriangles, 2, 3));
  ASSERT_EQ(model.pieces(false).size(), 2u);
  const GpuModel::Piece &first = model.pieces(false)[0], &second = model.pieces(false)[1];
  EXPECT_EQ(first.first, 0u);
  EXPECT_EQ(first.count, 3u * 16384);
  EXPECT_EQ(second.first, first.count);
  EXPECT_EQ(first.count + second.count, 3 * kTriangles);
  EXPECT_EQ(first.box.max().x(), 16384);
  EXPECT_EQ(second.box.min().x(), 16384);
  EXPECT_EQ(second.box.max().x(), kTriangles);
  EXPECT_EQ(model.pieces(true).size(), 2u) << "without a coarse version the same is drawn";
}

}  // namespace
}  // namespace limpid
