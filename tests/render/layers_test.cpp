// Order of things in a picture: hidden, shining through, in front; and the state that callers get
// back. Skipped where EGL gives no context.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <map>
#include <optional>

#include "render/palette.h"
#include "tests/render/side_view.h"

namespace limpid {
namespace {

using test::apart;
using test::Colour;
using test::kHeight;
using test::kWidth;

// The arm stretched along x, so far behind the plane of its joints.
ArmPose behind(double y) {
  const Pose a = pose_at(Vec3(0, y, 0)), b = pose_at(Vec3(0.2, y, 0));
  return {{a, b}, Vec3(0.4, y, 0), {}};
}

Colour of(const palette::Rgb& c) {
  return (255 * Eigen::Vector3f(c[0], c[1], c[2])).array().round().cast<int>();
}
Colour of(const glm::vec4& c) { return of(palette::Rgb{c.x, c.y, c.z}); }

class Layers : public test::SideView {
 protected:
  // A wall before kSeenPoint and the arm.
  void put_wall() {
    put({{block(Vec3(0.14, 0.02, 0.14)), pose_at(Vec3(0.1, -0.05, 0.15))},
         {block(Vec3(0.14, 0.02, 0.14)), pose_at(Vec3(0.3, -0.05, 0))}});
  }
};

const Vec3 kSeenPoint(0.1, 0.05, 0.15), kOnArm(0.3, 0.05, 0);

// A part of the picture, the place at which to look for it, and what a wall before it leaves of it.
enum class Left { nothing, less, all };
struct Layer {
  const char* name;
  std::function<void(ViewState&)> add;
  Vec3 where;
  Left left;
};

const std::vector<Layer>& layers() {
  static const Vec3 x = Vec3::UnitX(), z = Vec3::UnitZ();
  static const std::vector<Layer> all{
      {"trail",
       [](ViewState& s) {
         s.proxy.trail = {kSeenPoint - 0.06 * x, kSeenPoint - 0.01 * x, kSeenPoint + 0.01 * x};
       },
       kSeenPoint, Left::nothing},
      {"patch of a contact",
       [](ViewState& s) {
         s.contacts = {{kSeenPoint, -Vec3::UnitY(), 1, -Vec3::UnitY()}};
         s.show_forces = false;
       },
       kSeenPoint, Left::nothing},
      {"cone of friction",
       [](ViewState& s) {
         s.contacts = {{kSeenPoint, 3 * z, 1, z, 0.5}};
       },
       kSeenPoint + 0.05 * z + 0.012 * x, Left::nothing},
      {"proxy", [](ViewState& s) { s.proxy = behind(0.05); }, kOnArm, Left::nothing},
      {"arrow of a force",
       [](ViewState& s) {
         s.contacts = {{kSeenPoint, 3 * z, 1, z}};
       },
       kSeenPoint + 0.012 * z, Left::less},
      {"device", [](ViewState& s) { s.device.links = behind(0.05).links; }, kOnArm, Left::less},
      {"re-run", [](ViewState& s) { s.rerun = behind(0.05); }, kOnArm, Left::less},
      {"line of the hand",
       [](ViewState& s) {
         s.show_hand = s.hand_grips = true;
         s.hand_target = kSeenPoint + 0.06 * x;
         s.device.tip = kSeenPoint - 0.06 * x;
       },
       kSeenPoint, Left::all},
  };
  return all;
}

TEST_F(Layers, AreHiddenByAWallOrShineThroughIt) {
  for (const Layer& layer : layers()) {
    ViewState with = nothing();
    layer.add(with);
    put({});
    const int alone = apart(seen(with, layer.where), seen(nothing(), layer.where));
    EXPECT_GT(alone, 15) << layer.name << " is seen";
    put_wall();
    const int through = apart(seen(with, layer.where), seen(nothing(), layer.where));
    switch (layer.left) {
      case Left::nothing: EXPECT_LE(through, 2) << layer.name; break;
      case Left::less:
        EXPECT_GT(through, 5) << layer.name << " shines through";
        EXPECT_LT(through, alone - 5) << layer.name << " is fainter there";
        break;
      case Left::all: EXPECT_GT(through, 60) << layer.name; break;
    }
  }
}

TEST_F(Layers, AreBeforeWhatIsBehindThem) {
  put({{block(Vec3(0.14, 0.02, 0.14)), pose_at(Vec3(0.1, 0.15, 0.15))},
       {block(Vec3(0.14, 0.02, 0.14)), pose_at(Vec3(0.3, 0.15, 0))}});
  for (const Layer& layer : layers()) {
    ViewState with = nothing();
    layer.add(with);
    EXPECT_GT(apart(seen(with, layer.where), seen(nothing(), layer.where)), 15) << layer.name;
  }
}

// Signs of one kind leave no trace of how they are drawn in those that come after them.
TEST_F(Layers, LookTheSameTogether) {
  put_wall();
  ViewState elsewhere = nothing();
  elsewhere.theme = Theme::dark;
  for (const Layer& one : layers()) {
    for (const Layer& other : layers()) {
      if (one.where == other.where || &one == &other) continue;
      // Places of the arm and of the point are far from each other.
      if ((one.where == kOnArm) == (other.where == kOnArm)) continue;
      ViewState both = elsewhere, alone = elsewhere;
      one.add(alone);
      one.add(both);
      other.add(both);
      const bool arrows = both.show_forces && alone.show_forces;
      if (!arrows) alone.show_forces = both.show_forces = false;
      EXPECT_LE(apart(seen(both, one.where), seen(alone, one.where)), 2)
          << one.name << " with " << other.name;
    }
  }
}

// Clear things hide nothing behind them; an arrow does.
TEST_F(Layers, ThatAreClearShowWhatIsBehindThem) {
  const Vec3 before(0.1, -0.1, 0.15);
  const std::map<std::string, std::pair<std::function<void(ViewState&)>, bool>> screens{
      {"cone of friction",
       {[&](ViewState& s) {
          const Vec3 z = Vec3::UnitZ();
          s.contacts = {{before - 0.05 * z + Vec3(0.012, 0, 0), 3 * z, 1, z, 0.5}};
        },
        true}},
      {"patch of a contact",
       {[&](ViewState& s) {
          s.contacts = {{before, -0.5 * Vec3::UnitY(), 1, -Vec3::UnitY()}};
          s.show_forces = false;
        },
        true}},
      {"arrow",
       {[&](ViewState& s) {
          s.hand_force = 3 * Vec3::UnitZ();
          s.device.tip = before - Vec3(0, 0, 0.012);
        },
        false}},
  };
  for (const auto& [name, screen] : screens) {
    ViewState alone = nothing();
    screen.first(alone);
    ViewState both = alone;
    // So far behind that it is at the same pixel.
    const Vec3 eye = camera_.eye(), far = eye + 1.2 * (before - eye), x = Vec3::UnitX();
    both.proxy.trail = {far - 0.06 * x, far - 0.01 * x, far + 0.01 * x};
    const int through = apart(seen(both, before), seen(alone, before));
    if (screen.second) {
      EXPECT_GT(through, 8) << name;
    } else {
      EXPECT_LE(through, 2) << name;
    }
  }
}

// The backdrop is brightest a little above the middle, and darker to the corners.
TEST_F(Layers, StandBeforeABackdropInTheColoursOfTheTheme) {
  for (const Theme theme : {Theme::dark, Theme::light, Theme::contrast}) {
    ViewState state = nothing();
    state.theme = theme;
    const auto rgba = picture(state);
    const Lighting light = lighting_of(theme);
    EXPECT_LE(apart(at(rgba, kWidth / 2, 9 * kHeight / 20), of(light.top)), 2);
    for (const int x : {0, kWidth - 1}) {
      EXPECT_LE(apart(at(rgba, x, 0), of(light.bottom)), 6);
    }
  }
}

TEST_F(Layers, HaveAGridOnTheFloorOnly) {
  camera_.look(Camera::View::top);
  camera_.frame(view_->grid());
  camera_.finish();
  ViewState with = nothing();
  with.show_grid = true;
  const double floor = view_->grid().min().z();
  // Lines are at multiples of 5 cm, the stronger ones at multiples of 10 cm.
  const auto ink = [&](double x) {
    const Vec3 place(x, 0.025, floor);
    return apart(seen(with, place), seen(nothing(), place));
  };
  EXPECT_GT(ink(0.2), ink(0.25) + 5);
  EXPECT_GT(ink(0.25), 5);
  EXPECT_LE(ink(0.225), 2);
  put({{block(Vec3(0.08, 0.08, 0.05)), pose_at(Vec3(0.2, 0.025, floor + 0.1))}});
  EXPECT_LE(ink(0.2), 2) << "something lies on it";
}

// A highlight surrounds the thing, and does not cover it.
TEST_F(Layers, HaveALineAroundWhatIsHighlighted) {
  const auto cube = block(Vec3::Constant(0.1), {{0.05f, 0.6f, 0.05f}});
  const Vec3 middle(0.1, 0, 0.15), inside = middle + Vec3(0.03, -0.05, 0.03);
  put({{cube, pose_at(middle)}});
  const Colour plain = seen(nothing(), inside);
  put({{cube, pose_at(middle), 1, true}});
  EXPECT_LE(apart(seen(nothing(), inside), plain), 2);
  const Eigen::Vector2i edge = camera_.project(middle + Vec3(-0.05, -0.05, 0)).value().cast<int>();
  const auto rgba = picture(nothing());
  int lit = 0;
  for (int x = edge.x() - 8; x < edge.x() + 4; ++x) lit += at(rgba, x, edge.y()).minCoeff() > 180;
  EXPECT_GE(lit, 1);
  EXPECT_LE(lit, 4) << "two pixels and a half wide";
  // The next thing drawn shows its outside again.
  put({{cube, pose_at(middle), 1, true}, {cube, pose_at(Vec3(0.3, 0, 0.15))}});
  EXPECT_LE(apart(seen(nothing(), inside + Vec3(0.2, 0, 0)), plain), 12);
}

// Seen from above: the shadow of a thing that stands still is beside it on the table.
class StillShadows : public test::SideView {
 protected:
  void SetUp() override {
    SideView::SetUp();
    if (!view_) return;
    Scene table;
    table.add({"table", pose_at(Vec3(0, 0, -0.12)), Plane{Vec3::UnitZ()}});
    show(table);
    view_->set_quality({.msaa = 1, .shadow_size = 2048, .soft = false});
    camera_.look(Camera::View::top);
    camera_.frame(view_->bounds());
    camera_.finish();
  }
  int light(const Vec3& place) { return seen(nothing(), place).sum(); }
  // The light comes from (-0.30, -0.55, 1).
  static Vec3 shadow_of(const Vec3& at) {
    const double fall = at.z() + 0.12;
    return {at.x() + 0.30 * fall, at.y() + 0.55 * fall, -0.12};
  }
  const Vec3 kHere{0.2, -0.15, 0}, kThere{0.1, 0, 0};
};

TEST_F(StillShadows, GoWithTheMeshes) {
  const auto cube = block(Vec3::Constant(0.04));
  const int here = light(shadow_of(kHere)), there = light(shadow_of(kThere));
  put({{cube, pose_at(kHere)}});
  EXPECT_LT(light(shadow_of(kHere)), here - 30);
  EXPECT_NEAR(light(shadow_of(kThere)), there, 12);
  put({{cube, pose_at(kThere)}});
  EXPECT_NEAR(light(shadow_of(kHere)), here, 12);
  EXPECT_LT(light(shadow_of(kThere)), there - 30);
  put({});
  EXPECT_NEAR(light(shadow_of(kThere)), there, 12);
}

TEST_F(StillShadows, GoWithTheScene) {
  const int here = light(shadow_of(kHere));
  Scene scene;
  scene.add({"table", pose_at(Vec3(0, 0, -0.12)), Plane{Vec3::UnitZ()}});
  scene.add({"cube", pose_at(kHere), Box{Vec3::Constant(0.04)}});
  view_->set_scene(scene, {});
  EXPECT_LT(light(shadow_of(kHere)), here - 30);
  scene.objects.pop_back();
  view_->set_scene(scene, {});
  EXPECT_NEAR(light(shadow_of(kHere)), here, 12);
}

TEST_F(StillShadows, ComeBackWithTheQuality) {
  put({{block(Vec3::Constant(0.04)), pose_at(kHere)}});
  const int dark = light(shadow_of(kHere));
  view_->set_quality({.msaa = 1, .shadow_size = 0, .soft = false});
  EXPECT_GT(light(shadow_of(kHere)), dark + 30);
  view_->set_quality({.msaa = 1, .shadow_size = 2048, .soft = false});
  EXPECT_NEAR(light(shadow_of(kHere)), dark, 3);
}

// An open sheet that looks up throws a shadow as well, though the light sees its back or front.
TEST_F(StillShadows, AreOfOpenSheetsOnBothSides) {
  const int here = light(shadow_of(kHere));
  for (const bool up : {true, false}) {
    Model model;
    for (const auto& [x, y] : {std::pair(-0.03f, -0.03f), {0.03f, -0.03f}, {0.0f, 0.04f}}) {
      model.vertices.push_back({{x, y, 0}, Eigen::Vector3f::UnitZ()});
    }
    model.indices = up ? std::vector<std::uint32_t>{0, 1, 2} : std::vector<std::uint32_t>{0, 2, 1};
    model.parts = {{0, 3}};
    put({{std::make_shared<const Model>(model), pose_at(kHere)}});
    EXPECT_LT(light(shadow_of(kHere)), here - 30) << up;
  }
}

// A lit surface without anything above has one brightness: no shadow of itself.
TEST_F(StillShadows, AreNotOfASurfaceOnItself) {
  for (const int texels : {512, 2048}) {
    view_->set_quality({.msaa = 1, .shadow_size = texels, .soft = false});
    int least = 1000, most = 0;
    for (int i = 0; i < 40; ++i) {
      const int here = light(Vec3(0.05 + 0.002 * i, -0.05 + 0.001 * i, -0.12));
      least = std::min(least, here);
      most = std::max(most, here);
    }
    EXPECT_LE(most - least, 12) << texels;
  }
}

// Under everything is a floor, which takes shadows and fades into the backdrop.
TEST_F(StillShadows, FallOnTheFloor) {
  show(Scene{});
  view_->set_quality({.msaa = 1, .shadow_size = 2048, .soft = false});
  ViewState bright = nothing();
  bright.theme = Theme::light;
  const double floor = view_->bounds().min().z();
  const Vec3 here(0.2, -0.05, floor + 0.1), there = here + Vec3(0.03, 0.055, -0.1);
  camera_.frame(Bounds(here - Vec3::Constant(0.3), here + Vec3::Constant(0.3)));
  camera_.finish();
  const int lit = seen(bright, there).sum();
  put({{block(Vec3::Constant(0.04)), pose_at(here)}});
  EXPECT_LT(seen(bright, there).sum(), lit - 30);
  put({});
  camera_.zoom(-12, {kWidth / 2.0, kHeight / 2.0});
  const Eigen::Vector2i middle = camera_.project(there).value().cast<int>();
  const auto rgba = picture(bright);
  const Colour backdrop = of(lighting_of(Theme::light).top);
  EXPECT_GT(apart(at(rgba, middle.x(), middle.y()), backdrop), 25) << "a floor is there";
  EXPECT_LE(apart(at(rgba, 0, kHeight / 2), backdrop), 60) << "and ends softly";
}

// The shade is on the scene, and on nothing that stands before it.
TEST_F(StillShadows, OfTheTipAreOnTheSceneOnly) {
  const Vec3 table(0.2, 0.05, -0.12);
  ViewState with = nothing();
  with.shade = ContactShade{table, Vec3::UnitZ(), 0.01};
  EXPECT_LT(seen(with, table).sum(), light(table) - 60);
  EXPECT_NEAR(seen(with, table + Vec3(0.1, 0, 0)).sum(), light(table + Vec3(0.1, 0, 0)), 3);
  // The proxy's second link is before it.
  ViewState arm = nothing(), both = with;
  arm.proxy = both.proxy = behind(0);
  const Vec3 on_arm(0.3, 0, 0);
  both.shade->position = Vec3(0.3, 0, -0.12);
  EXPECT_NEAR(seen(both, on_arm).sum(), seen(arm, on_arm).sum(), 3);
  // A ghost that is drawn after it stays behind the proxy.
  arm.device.links = both.device.links = behind(0).links;
  both.shade->position = table;
  EXPECT_NEAR(seen(both, on_arm).sum(), seen(arm, on_arm).sum(), 3);
  EXPECT_NEAR(light(table + Vec3(0.1, 0, 0)), seen(nothing(), table + Vec3(0.1, 0, 0)).sum(), 3);
}

// A picture with all signs leaves nothing behind that changes the next one.
TEST_F(Layers, LeaveTheNextPictureAsItWouldBe) {
  put_wall();
  ViewState all = nothing();
  for (const Layer& layer : layers()) layer.add(all);
  all.show_forces = all.show_grid = true;
  for (const Layer& layer : layers()) {
    ViewState next = nothing();
    layer.add(next);
    view_->set_quality({.msaa = 4, .shadow_size = 0, .soft = false});
    const auto fresh = picture(next);
    for (const bool shaded : {false, true}) {
      all.shade.reset();
      if (shaded) all.shade = ContactShade{kSeenPoint, -Vec3::UnitY()};
      picture(all);
      view_->set_quality({.msaa = 4, .shadow_size = 0, .soft = false});
      EXPECT_EQ(picture(next), fresh) << layer.name << ", " << shaded;
    }
    // Nor does the shade change what is drawn after it.
    next.shade = ContactShade{Vec3(0, 0.3, -0.2), Vec3::UnitZ()};
    EXPECT_LE(apart(seen(next, layer.where), in_picture(fresh, layer.where)), 2) << layer.name;
  }
}

// Stops of joints and the arm's probes are of glass: both are seen, and what is behind them.
TEST_F(Layers, HaveStopsAndProbesOfGlass) {
  Scene stop, probe;
  stop.add({.shape = JointStop{.joint = 1, .angle = 0.2, .direction = 1}});
  probe.probes = {{"rod", 1, Vec3(0.05, -0.02, 0), Vec3(0.15, -0.02, 0), 0.02}};
  ViewState state = nothing();
  state.proxy.links = behind(0).links;
  for (const Scene* scene : {&stop, &probe}) {
    const auto drawn = [&](const Scene& of, bool before_a_block) {
      show(of);
      if (before_a_block) {
        put({{block(Vec3(0.6, 0.02, 0.6), {{0.05f, 0.6f, 0.05f}}), pose_at(Vec3(0.2, 0.3, 0))}});
      }
      return picture(state);
    };
    const auto plain = drawn(Scene{}, false), glass = drawn(*scene, false),
               block_alone = drawn(Scene{}, true), through = drawn(*scene, true);
    int seen_as_glass = 0, hidden = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        if (apart(at(plain, x, y), at(glass, x, y)) < 8) continue;
        if (apart(at(plain, x, y), at(block_alone, x, y)) < 20) continue;  // the arm is there
        ++seen_as_glass;
        hidden += apart(at(glass, x, y), at(through, x, y)) < 5;
      }
    }
    EXPECT_GT(seen_as_glass, 30);
    EXPECT_LT(hidden, seen_as_glass / 10);
  }
}

// The outline of a ghost beside the proxy is seen, and through a wall as well, though fainter.
TEST_F(Layers, HaveAnOutlineOfTheGhostThroughAWall) {
  ViewState with = nothing(), without;
  with.device.links = behind(0.05).links;
  with.proxy = behind(0.05);
  for (Pose& link : with.device.links) link.translation().z() += 0.06;
  with.device.tip = Vec3(0.4, 0.05, 0.06);
  const auto orange = [&] {
    int strong = 0, any = 0;
    const auto rgba = picture(with);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const Colour c = at(rgba, x, y);
        strong += apart(c, of(palette::kDevice)) < 40;
        any += c.x() - c.z() > 60;
      }
    }
    return std::pair(strong, any);
  };
  put({});
  const auto [open_strong, open_any] = orange();
  EXPECT_GT(open_strong, 60) << "as strong as its colour";
  put({{block(Vec3(0.6, 0.02, 0.4)), pose_at(Vec3(0.2, -0.05, 0))}});
  const auto [strong, any] = orange();
  EXPECT_GT(any, 60);
  EXPECT_LT(strong, open_strong / 3);
  // At the proxy's place it would surround the proxy: there is none.
  with.device = with.proxy;
  put({});
  EXPECT_LT(orange().first, 10);
}

// A mesh of a body that is not there, or not yet, does no harm.
TEST_F(Layers, HaveNoMeshOfABodyThatIsNotThere) {
  const Bounds before = view_->bounds();
  put({{block(Vec3::Constant(0.1)), pose_at(kSeenPoint), 1, false, 0},
       {block(Vec3::Constant(0.1)), pose_at(kSeenPoint), 1, false, 7}});
  picture(nothing());
  EXPECT_TRUE(view_->bounds().contains(before));
  EXPECT_LT(view_->bounds().diagonal().norm(), 2 * before.diagonal().norm());
}

// The caller's framebuffer and viewport are as they were, and nothing blends, tests, culls or
// clips.
TEST_F(Layers, LeaveOpenGlAsTheyFoundIt) {
  put_wall();
  ViewState all = nothing();
  for (const Layer& layer : layers()) layer.add(all);
  all.show_forces = all.show_grid = true;
  all.shade = ContactShade{kSeenPoint};
  for (const int samples : {1, 4}) {
    view_->set_quality({.msaa = samples, .shadow_size = 256, .soft = false});
    GLint framebuffer = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
    glViewport(3, 5, 70, 90);
    view_->draw(all, camera_, 0, 0, kWidth, kHeight);
    const auto number = [](GLenum name) {
      GLint value = -1;
      glGetIntegerv(name, &value);
      return value;
    };
    EXPECT_EQ(number(GL_DRAW_FRAMEBUFFER_BINDING), framebuffer);
    EXPECT_EQ(number(GL_READ_FRAMEBUFFER_BINDING), framebuffer);
    std::array<GLint, 4> viewport{};
    glGetIntegerv(GL_VIEWPORT, viewport.data());
    EXPECT_EQ(viewport, (std::array<GLint, 4>{3, 5, 70, 90}));
    const std::map<GLenum, const char*> switches{{GL_BLEND, "blends"},
                                                 {GL_DEPTH_TEST, "tests depth"},
                                                 {GL_STENCIL_TEST, "tests the stencil"},
                                                 {GL_CULL_FACE, "culls"},
                                                 {GL_SCISSOR_TEST, "clips"},
                                                 {GL_POLYGON_OFFSET_FILL, "moves in depth"}};
    for (const auto& [name, what] : switches) EXPECT_FALSE(glIsEnabled(name)) << what;
    for (const GLenum name :
         std::initializer_list<GLenum>{GL_CURRENT_PROGRAM, GL_VERTEX_ARRAY_BINDING,
                                       GL_ARRAY_BUFFER_BINDING, GL_RENDERBUFFER_BINDING}) {
      EXPECT_EQ(number(name), 0) << name;
    }
    GLint block = -1;
    glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, 0, &block);
    EXPECT_EQ(block, 0);
    EXPECT_EQ(number(GL_ACTIVE_TEXTURE), GL_TEXTURE0);
    for (const GLenum unit : {0u, 1u, 2u, 3u, 4u}) {
      glActiveTexture(GL_TEXTURE0 + unit);
      EXPECT_EQ(number(GL_TEXTURE_BINDING_2D), 0) << unit;
    }
    glActiveTexture(GL_TEXTURE0);
    EXPECT_EQ(number(GL_DEPTH_WRITEMASK), GL_TRUE);
    EXPECT_EQ(number(GL_CULL_FACE_MODE), GL_BACK);
    std::array<GLboolean, 4> colours{};
    glGetBooleanv(GL_COLOR_WRITEMASK, colours.data());
    for (const GLboolean each : colours) EXPECT_EQ(each, GL_TRUE);
  }
}

TEST_F(Layers, AreTheSameWhateverTheCallerHasSwitchedOn) {
  put_wall();
  ViewState all = nothing();
  for (const Layer& layer : layers()) layer.add(all);
  const auto plain = picture(all);
  for (const GLenum on :
       std::initializer_list<GLenum>{GL_BLEND, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_DEPTH_TEST,
                                     GL_CULL_FACE, GL_FRAMEBUFFER_SRGB}) {
    put_wall();  // so that it is drawn anew
    glEnable(on);
    glScissor(3, 4, 5, 6);
    glStencilFunc(GL_NEVER, 0, 0xff);
    glDepthFunc(GL_NEVER);
    glBlendFunc(GL_ZERO, GL_ONE);
    view_->draw(all, camera_, 0, 0, kWidth, kHeight);
    glDisable(on);
    EXPECT_EQ(read_rgba(kWidth, kHeight), plain) << on;
  }
}

}  // namespace
}  // namespace limpid
