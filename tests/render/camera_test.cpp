#include "render/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace limpid {
namespace {

Camera general_camera() {
  Camera camera;
  camera.resize(1280, 720);
  camera.frame(Bounds(Vec3(-0.1, -0.2, -0.04), Vec3(0.3, 0.25, 0.2)));
  camera.finish();
  camera.orbit(-37, 21);
  camera.pan(13, -8);
  return camera;
}

TEST(Camera, ProjectsAPointOfARayBackToItsPixel) {
  const Camera camera = general_camera();
  for (const Eigen::Vector2d& pixel :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(913.5, 207.25), Eigen::Vector2d(1280, 720)}) {
    const Ray ray = camera.ray(pixel);
    EXPECT_NEAR(ray.direction.norm(), 1, 1e-12);
    const auto back = camera.project(ray.origin + 0.37 * ray.direction);
    ASSERT_TRUE(back);
    EXPECT_NEAR((*back - pixel).norm(), 0, 1e-8);
  }
}

TEST(Camera, ShowsItsTargetInTheMiddle) {
  const Camera camera = general_camera();
  EXPECT_NEAR((*camera.project(camera.target()) - Eigen::Vector2d(640, 360)).norm(), 0, 1e-9);
}

TEST(Camera, ProjectsNothingBehindTheEye) {
  const Camera camera = general_camera();
  EXPECT_FALSE(camera.project(camera.eye() - 0.1 * camera.forward()));
}

TEST(Camera, DragsInThePlaneParallelToTheImageThroughThePoint) {
  const Camera camera = general_camera();
  const Vec3 through(0.17, -0.05, 0.03);
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(5, 9), Eigen::Vector2d(700, 650)}) {
    const Vec3 hit = camera.plane_drag(pixel, through);
    EXPECT_NEAR((hit - through).dot(camera.forward()), 0, 1e-12);
    EXPECT_NEAR((*camera.project(hit) - pixel).norm(), 0, 1e-8);
  }
  EXPECT_NEAR((camera.plane_drag(*camera.project(through), through) - through).norm(), 0, 1e-12);
}

TEST(Camera, KeepsWhatIsUnderTheCursorWhenZooming) {
  Camera camera = general_camera();
  const Eigen::Vector2d cursor(300, 500);
  const Vec3 under = camera.plane_drag(cursor, camera.target());
  const double before = camera.distance();
  camera.zoom(3, cursor);
  EXPECT_LT(camera.distance(), before);
  EXPECT_NEAR((*camera.project(under) - cursor).norm(), 0, 1e-7);
}

TEST(Camera, FollowsTheMouseByWholePixelsWhenPanning) {
  Camera camera = general_camera();
  const Vec3 point = camera.target();
  camera.pan(40, -25);
  EXPECT_NEAR((*camera.project(point) - Eigen::Vector2d(680, 335)).norm(), 0, 1e-8);
}

TEST(Camera, FramesEveryCornerInWideAndTallViewports) {
  const Bounds bounds(Vec3(-0.2, -0.3, -0.1), Vec3(0.4, 0.1, 0.3));
  for (const Eigen::Vector2d& size : {Eigen::Vector2d(1600, 400), Eigen::Vector2d(300, 900)}) {
    Camera camera;
    camera.resize(size.x(), size.y());
    for (const auto view :
         {Camera::View::iso, Camera::View::top, Camera::View::front, Camera::View::side}) {
      camera.look(view);
      camera.frame(bounds);
      camera.finish();
      for (int i = 0; i < 8; ++i) {
        const auto p = camera.project(bounds.corner(static_cast<Bounds::CornerType>(i)));
        ASSERT_TRUE(p);
        EXPECT_GE(p->minCoeff(), -1e-6);
        EXPECT_LE(p->x(), size.x() + 1e-6);
        EXPECT_LE(p->y(), size.y() + 1e-6);
      }
    }
  }
}

TEST(Camera, LooksAlongTheAxesInItsStandardViews) {
  Camera camera;
  camera.look(Camera::View::side);
  camera.finish();
  EXPECT_NEAR((camera.forward() - Vec3::UnitY()).norm(), 0, 1e-9);
  EXPECT_NEAR((camera.right() - Vec3::UnitX()).norm(), 0, 1e-9);
  camera.look(Camera::View::front);
  camera.finish();
  EXPECT_NEAR((camera.forward() + Vec3::UnitX()).norm(), 0, 1e-9);
  camera.look(Camera::View::top);
  camera.finish();
  EXPECT_NEAR((camera.forward() + Vec3::UnitZ()).norm(), 0, 2e-3);
  EXPECT_NEAR((camera.right() - Vec3::UnitX()).norm(), 0, 1e-9);
}

TEST(Camera, ArrivesAtTheGoalOfASmoothMoveWhateverTheSteps) {
  Camera fine = general_camera(), coarse = general_camera(), at_once = general_camera();
  for (Camera* camera : {&fine, &coarse, &at_once}) camera->look(Camera::View::top);
  at_once.finish();
  EXPECT_GT((fine.eye() - at_once.eye()).norm(), 0.1);
  for (int i = 0; i < 200; ++i) fine.advance(0.01);
  coarse.advance(5);
  EXPECT_NEAR((fine.eye() - at_once.eye()).norm(), 0, 1e-9);
  EXPECT_NEAR((coarse.eye() - at_once.eye()).norm(), 0, 1e-9);
}

TEST(Camera, HasOrthonormalAxesAndAMatchingViewMatrix) {
  const Camera camera = general_camera();
  const Mat3 rotation = camera.view().block<3, 3>(0, 0);
  EXPECT_NEAR((rotation * rotation.transpose() - Mat3::Identity()).norm(), 0, 1e-12);
  EXPECT_NEAR(rotation.determinant(), 1, 1e-12);
  EXPECT_NEAR((camera.view() * camera.eye().homogeneous() - Eigen::Vector4d(0, 0, 0, 1)).norm(), 0,
              1e-12);
}

// After any number of turns the camera takes the short way, without undoing them.
TEST(Camera, GoesToAViewTheShortWay) {
  using std::numbers::pi;
  for (const double begin : {0.7, 2.8, 3.5, 6.0, 15.0, -2.9, -9.0}) {
    Camera camera;
    camera.look(Camera::View::front);  // the eye at azimuth 0
    camera.finish();
    camera.orbit(-begin / 0.006, 0);  // 6 mrad a pixel
    const auto azimuth = [&] {
      const Vec3 back = -camera.forward();
      return std::atan2(back.y(), back.x());
    };
    const double way = std::remainder(begin, 2 * pi);
    ASSERT_NEAR(azimuth(), way, 1e-9);
    camera.look(Camera::View::front);
    double last = azimuth();
    for (int i = 0; i < 100; ++i) {
      camera.advance(0.005);
      const double now = azimuth();
      EXPECT_LE(std::abs(now), std::abs(last) + 1e-12) << "from " << begin << ", step " << i;
      EXPECT_GE(now * way, -1e-12) << "never past it";
      last = now;
    }
    EXPECT_NEAR(last, 0, 1e-9);
  }
}

// On the way all parts are halfway at half of the time; of the distance it is the geometric mean,
// as of all that is zoomed.
TEST(Camera, IsHalfwayAtHalfOfTheTime) {
  Camera camera;
  camera.resize(1000, 800);
  camera.frame(Bounds(Vec3(-0.1, -0.1, -0.1), Vec3(0.1, 0.1, 0.1)));
  camera.finish();
  const double near = camera.distance();
  const Vec3 from = camera.target();
  camera.frame(Bounds(Vec3(0.6, -0.4, -0.4), Vec3(1.4, 0.4, 0.4)));
  Camera there = camera;
  there.finish();
  double took = 0;  // until it is there
  for (Camera test = camera; (test.eye() - there.eye()).norm() > 1e-12; took += 0.0025) {
    test.advance(0.0025);
    ASSERT_LT(took, 5);
  }
  camera.advance(took / 2);
  EXPECT_NEAR(camera.distance(), std::sqrt(near * there.distance()), 0.01 * there.distance());
  EXPECT_NEAR((camera.target() - (from + there.target()) / 2).norm(), 0, 0.01);
  // The move begins and ends at rest: a tenth of the time is much less than a tenth of the way.
  Camera begins = there;
  begins.frame(Bounds(Vec3(-0.1, -0.1, -0.1), Vec3(0.1, 0.1, 0.1)));
  begins.advance(took / 10);
  EXPECT_LT((begins.target() - there.target()).norm(), 0.05 * (from - there.target()).norm());
}

}  // namespace
}  // namespace limpid
