#include "app/desktop/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <utility>

#include "app/style/theme.h"
#include "render/offscreen.h"
#include "render/scene_view.h"

namespace limpid {
namespace {

using SteadyClock = std::chrono::steady_clock;
constexpr auto kFrame = std::chrono::microseconds(16667);

}  // namespace

struct Window::Impl {
  GLFWwindow* glfw = nullptr;
  std::string renderer;
  std::vector<KeyPress> keys;
  std::vector<std::filesystem::path> dropped;
  SteadyClock::time_point due = SteadyClock::now();
  SteadyClock::time_point began = due;
  double frame_time = 0;
  std::filesystem::path picture;
  double left = 0, top = 0, right = 0, bottom = 0;  // of the picture; nothing: all
  int x = 0, y = 0, width = 0, height = 0;          // before full screen

  static Impl& of(GLFWwindow* window) {
    return *static_cast<Impl*>(glfwGetWindowUserPointer(window));
  }

  void save() {
    const std::filesystem::path file = std::exchange(picture, {});
    int pixels_x = 0, pixels_y = 0, points_x = 0, points_y = 0;
    glfwGetFramebufferSize(glfw, &pixels_x, &pixels_y);
    glfwGetWindowSize(glfw, &points_x, &points_y);
    const double scale = static_cast<double>(pixels_x) / points_x;
    const std::vector<unsigned char> all = read_rgba(pixels_x, pixels_y);
    if (right <= left || bottom <= top) return write_png(file, pixels_x, pixels_y, all);
    const auto pixel = [&](double at, int most) {
      return std::clamp(static_cast<int>(std::lround(at * scale)), 0, most);
    };
    const int x0 = pixel(left, pixels_x), x1 = pixel(right, pixels_x);
    const int y0 = pixel(top, pixels_y), y1 = pixel(bottom, pixels_y);
    std::vector<unsigned char> part;
    for (int line = y0; line < y1; ++line) {
      const auto row = all.begin() + 4 * (static_cast<std::ptrdiff_t>(line) * pixels_x);
      part.insert(part.end(), row + 4 * x0, row + 4 * x1);
    }
    write_png(file, x1 - x0, y1 - y0, part);
  }
};

Window::Window(const Options& options) : impl_(std::make_unique<Impl>()) {
  if (glfwInit() == GLFW_FALSE) {
    const char* why = nullptr;
    glfwGetError(&why);
    throw std::runtime_error(std::string("no display to open a window on (") +
                             (why != nullptr ? why : "glfwInit failed") +
                             "); `limpid run` works without one");
  }
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  impl_->glfw = glfwCreateWindow(options.width, options.height, "Limpid", nullptr, nullptr);
  if (impl_->glfw == nullptr) {
    glfwTerminate();
    throw std::runtime_error("the display gives no OpenGL 3.3; `limpid run` works without");
  }
  glfwMakeContextCurrent(impl_->glfw);
  glfwSetWindowSizeLimits(impl_->glfw, 900, 560, GLFW_DONT_CARE, GLFW_DONT_CARE);
  glfwSwapInterval(0);
  const auto ask =
      reinterpret_cast<const unsigned char* (*)(unsigned)>(glfwGetProcAddress("glGetString"));
  constexpr unsigned kRenderer = 0x1F01;  // GL_RENDERER
  if (const unsigned char* name = ask != nullptr ? ask(kRenderer) : nullptr) {
    impl_->renderer = reinterpret_cast<const char*>(name);
  }
  glfwSetWindowUserPointer(impl_->glfw, impl_.get());
  glfwSetKeyCallback(impl_->glfw, [](GLFWwindow* w, int key, int, int action, int modifiers) {
    if (action != GLFW_RELEASE) Impl::of(w).keys.push_back({key, modifiers});
  });
  glfwSetDropCallback(impl_->glfw, [](GLFWwindow* w, int count, const char** paths) {
    for (int i = 0; i < count; ++i) Impl::of(w).dropped.emplace_back(paths[i]);
  });

  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui_ImplGlfw_InitForOpenGL(impl_->glfw, true);
  ImGui_ImplOpenGL3_Init("#version 330 core");
  float scale_x = 1, scale_y = 1;
  glfwGetWindowContentScale(impl_->glfw, &scale_x, &scale_y);
  const double scale = options.ui_scale > 0 ? options.ui_scale : scale_x;
  load_fonts(static_cast<float>(scale));
  apply_theme(options.theme, static_cast<float>(scale));
}

Window::~Window() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(impl_->glfw);
  glfwTerminate();
}

bool Window::begin_frame() {
  std::this_thread::sleep_until(impl_->due);
  // A frame that took too long does not hurry the next ones.
  impl_->due = std::max(impl_->due + kFrame, SteadyClock::now());
  impl_->began = SteadyClock::now();
  impl_->keys.clear();
  impl_->dropped.clear();
  glfwPollEvents();
  if (glfwWindowShouldClose(impl_->glfw)) return false;
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  if (ImGui::GetIO().WantTextInput) {
    std::erase_if(impl_->keys, [](const KeyPress& k) { return k.key != GLFW_KEY_ESCAPE; });
  }
  return true;
}

void Window::end_frame() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  if (!impl_->picture.empty()) impl_->save();
  glfwSwapBuffers(impl_->glfw);
  const std::chrono::duration<double> took = SteadyClock::now() - impl_->began;
  impl_->frame_time = took.count();
}

void Window::close() { glfwSetWindowShouldClose(impl_->glfw, GLFW_TRUE); }

void Window::keep_open() { glfwSetWindowShouldClose(impl_->glfw, GLFW_FALSE); }

bool Window::full_screen() const { return glfwGetWindowMonitor(impl_->glfw) != nullptr; }

void Window::toggle_full_screen() {
  Impl& w = *impl_;
  if (full_screen()) {
    glfwSetWindowMonitor(w.glfw, nullptr, w.x, w.y, w.width, w.height, 0);
    return;
  }
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (monitor == nullptr) return;
  glfwGetWindowPos(w.glfw, &w.x, &w.y);
  glfwGetWindowSize(w.glfw, &w.width, &w.height);
  const GLFWvidmode* mode = glfwGetVideoMode(monitor);
  glfwSetWindowMonitor(w.glfw, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

const std::vector<KeyPress>& Window::keys() const { return impl_->keys; }
const std::vector<std::filesystem::path>& Window::dropped() const { return impl_->dropped; }
void Window::size(int& width, int& height) const {
  glfwGetWindowSize(impl_->glfw, &width, &height);
}
void Window::framebuffer_size(int& width, int& height) const {
  glfwGetFramebufferSize(impl_->glfw, &width, &height);
}
const std::string& Window::renderer() const { return impl_->renderer; }
double Window::frame_time() const { return impl_->frame_time; }

void Window::save_picture(const std::filesystem::path& png) { save_picture(png, 0, 0, 0, 0); }

void Window::save_picture(const std::filesystem::path& png, double left, double top, double right,
                          double bottom) {
  impl_->picture = png;
  impl_->left = left;
  impl_->top = top;
  impl_->right = right;
  impl_->bottom = bottom;
}

}  // namespace limpid
