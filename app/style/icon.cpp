#include "app/style/icon.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/style/palette.h"

namespace limpid {
namespace {

struct Point {
  double x, y;  // from the upper left corner, 0 to 1
};

struct Stroke {
  std::array<Point, 3> points;
  double radius;
  Rgb rgb;
};

double distance(Point p, Point a, Point b) {
  const double x = b.x - a.x, y = b.y - a.y;
  const double along = std::clamp(((p.x - a.x) * x + (p.y - a.y) * y) / (x * x + y * y), 0.0, 1.0);
  return std::hypot(p.x - a.x - along * x, p.y - a.y - along * y);
}

// The device is a little below its proxy, as in a contact.
const std::array kStrokes{
    Stroke{{{{0.22, 0.80}, {0.56, 0.36}, {0.84, 0.88}}}, 0.075, ink(kDarkPalette, Ink::device)},
    Stroke{{{{0.22, 0.80}, {0.48, 0.22}, {0.84, 0.68}}}, 0.09, ink(kDarkPalette, Ink::proxy)},
};

}  // namespace

std::vector<std::uint8_t> icon(int size) {
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const Point p{(x + 0.5) / size, (y + 0.5) / size};
      Rgb rgb;
      double opacity = 0;
      for (const Stroke& stroke : kStrokes) {
        const double away = std::min(distance(p, stroke.points[0], stroke.points[1]),
                                     distance(p, stroke.points[1], stroke.points[2]));
        // The edge is one pixel wide.
        const double cover = std::clamp((stroke.radius - away) * size + 0.5, 0.0, 1.0);
        if (cover <= 0) continue;
        rgb = mix(stroke.rgb, rgb, opacity > 0 ? static_cast<float>(1 - cover) : 0);
        opacity += (1 - opacity) * cover;
      }
      pixels.insert(pixels.end(),
                    {rgb.r, rgb.g, rgb.b, static_cast<std::uint8_t>(std::lround(255 * opacity))});
    }
  }
  return pixels;
}

std::string icon_svg() {
  std::string text =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 100 100\" fill=\"none\" "
      "stroke-linecap=\"round\" stroke-linejoin=\"round\">\n";
  for (const Stroke& stroke : kStrokes) {
    text += fmt::format("<path stroke=\"#{:02x}{:02x}{:02x}\" stroke-width=\"{:g}\" d=\"",
                        stroke.rgb.r, stroke.rgb.g, stroke.rgb.b, 200 * stroke.radius);
    char how = 'M';
    for (const Point& p : stroke.points) {
      text += fmt::format("{}{:g} {:g}", how, 100 * p.x, 100 * p.y);
      how = 'L';
    }
    text += "\"/>\n";
  }
  return text + "</svg>\n";
}

void set_icon(GLFWwindow* window) {
  std::array<std::vector<std::uint8_t>, 3> pixels;
  std::array<GLFWimage, 3> images{};
  int size = 16;
  for (std::size_t i = 0; i < pixels.size(); ++i, size *= 2) {
    pixels[i] = icon(size);
    images[i] = {size, size, pixels[i].data()};
  }
  glfwSetWindowIcon(window, static_cast<int>(images.size()), images.data());
}

}  // namespace limpid
