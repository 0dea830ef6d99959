#include "app/desktop/shell/window.h"

#include <backends/imgui_impl_glfw.h>
#include <dlfcn.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "app/base/window_system.h"
#include "app/desktop/shell/input.h"
#include "app/desktop/shell/pacing.h"
#include "app/style/icon.h"
#include "app/style/imgui_gl.h"
#include "app/style/imgui_input.h"
#include "app/style/palette.h"
#include "render/gl/offscreen.h"
#include "render/scene_view.h"

namespace limpid {

namespace {

// Returns the action of leave_once(), as X11's handler gets no data but the display.
std::function<void()>& what_to_do() {
  static std::function<void()> leave;
  return leave;
}

int leave_once(void*) {
  if (const auto leave = std::exchange(what_to_do(), nullptr)) leave();
  return 0;
}

constexpr auto kFrame = std::chrono::microseconds(16667);

KeyLabels labels_now() {
  return KeyLabels([](int place) -> const char* {
    return glfwGetKeyScancode(place) > 0 ? glfwGetKeyName(place, 0) : nullptr;
  });
}

// Creates the window. Errors: std::runtime_error if there is none to be had.
GLFWwindow* create_window(const Window::Options& options, const WorkArea& area) {
  hint_window();
  const auto fitting = [&](int asked, int least, int most) {
    const double scaled = static_cast<double>(area.scale) * asked;
    return static_cast<int>(std::clamp<double>(scaled, std::min(least, most), most));
  };
  GLFWwindow* window = glfwCreateWindow(fitting(options.width, kLeastWidth, area.width),
                                        fitting(options.height, kLeastHeight, area.height),
                                        "Limpid", nullptr, nullptr);
  if (window == nullptr) {
    glfwTerminate();
    throw std::runtime_error(
        "the display does not offer OpenGL 3.3; `limpid run` works without it");
  }
  glfwMakeContextCurrent(window);
  glfwSetWindowSizeLimits(window, std::min(kLeastWidth, area.width),
                          std::min(kLeastHeight, area.height), GLFW_DONT_CARE, GLFW_DONT_CARE);
  move_into(area, window);
  if (!on_wayland()) set_icon(window);
  return window;
}

// Watches touches; ImGui calls these callbacks from its own.
void watch_touches(GLFWwindow* window) {
  glfwSetScrollCallback(window, [](GLFWwindow* w, double, double) { Window::touched(w); });
  glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int) { Window::touched(w); });
  glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { Window::touched(w); });
  glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { Window::touched(w); });
}

}  // namespace

void when_display_is_lost(std::function<void()> leave) {
  // The function is looked up in GLFW's libraries: Wayland has none.
  using Handler = int (*)(void*);
  using Set = Handler (*)(Handler);
  const auto set = reinterpret_cast<Set>(dlsym(RTLD_DEFAULT, "XSetIOErrorHandler"));
  if (set == nullptr) return;
  what_to_do() = std::move(leave);
  set(leave_once);
}

std::string window_for_portals() {
  GLFWwindow* window = glfwGetCurrentContext();
  if (window == nullptr || on_wayland()) return {};
  // GLFW for Wayland alone does not have this function.
  using Number = unsigned long (*)(GLFWwindow*);
  const auto number = reinterpret_cast<Number>(dlsym(RTLD_DEFAULT, "glfwGetX11Window"));
  return number != nullptr ? fmt::format("x11:{:x}", number(window)) : "";
}

WorkArea work_area() {
  WorkArea area;
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (monitor == nullptr) return area;
  glfwGetMonitorWorkarea(monitor, &area.x, &area.y, &area.width, &area.height);
  float scale = 1, vertical = 1;
  glfwGetMonitorContentScale(monitor, &scale, &vertical);
  (on_wayland() ? area.density : area.scale) = scale;  // Wayland enlarges windows itself
  return area;
}

void move_into(const WorkArea& area, GLFWwindow* window) {
  int left = 0, top = 0, right = 0, bottom = 0, x = 0, y = 0, width = 0, height = 0;
  glfwGetWindowFrameSize(window, &left, &top, &right, &bottom);
  if (!on_wayland()) glfwGetWindowPos(window, &x, &y);
  glfwGetWindowSize(window, &width, &height);
  const int fit_width = std::min(width, area.width - left - right);
  const int fit_height = std::min(height, area.height - top - bottom);
  if (fit_width != width || fit_height != height) glfwSetWindowSize(window, fit_width, fit_height);
  if (on_wayland()) return;
  const auto held = [](int at, int low, int high) {
    return std::clamp(at, low, std::max(low, high));
  };
  const int fit_x = held(x, area.x + left, area.x + area.width - right - fit_width);
  const int fit_y = held(y, area.y + top, area.y + area.height - bottom - fit_height);
  if (fit_x != x || fit_y != y) glfwSetWindowPos(window, fit_x, fit_y);
}

struct Window::Impl {
  GLFWwindow* glfw = nullptr;
  std::optional<ImGuiGl> imgui;
  std::string renderer;
  KeyInput keys;
  MouseInput mouse;
  std::vector<std::filesystem::path> dropped;
  SteadyClock::time_point due = SteadyClock::now();
  SteadyClock::time_point began = due;
  double frame_time = 0;
  Liveliness liveliness;
  double refresh = 0;      // of the display, if exchanging buffers waits for it; else 0 [s]
  bool exchanged = false;  // buffers were exchanged in the last turn
  struct Picture {
    std::filesystem::path file;
    double left, top, right, bottom;  // all 0: the whole window
  };
  std::vector<Picture> pictures;  // to be saved
  std::vector<SavedPicture> saved;
  int x = 0, y = 0, width = 0, height = 0;  // before full screen
  float screen_scale = 1;
  double ui_scale = 1;
  float density = 1;
  Theme theme = Theme::dark;
  double text_size = 1;

  static Impl& of(GLFWwindow* window) {
    return *static_cast<Impl*>(glfwGetWindowUserPointer(window));
  }

  // Replaces ImGui's callbacks: keys and characters go to their owner, and nothing between two
  // frames is lost.
  void listen() const {
    glfwSetCursorPosCallback(glfw, [](GLFWwindow* w, double right, double down) {
      Window::touched(w);
      Impl::of(w).mouse.move(static_cast<float>(right), static_cast<float>(down));
    });
    glfwSetCursorEnterCallback(glfw, [](GLFWwindow* w, int over) {
      Window::touched(w);
      Impl::of(w).mouse.enter(over == GLFW_TRUE);
    });
    glfwSetMouseButtonCallback(glfw, [](GLFWwindow* w, int button, int action, int modifiers) {
      Window::touched(w);
      Impl::of(w).mouse.button(button, action == GLFW_PRESS, modifiers);
    });
    glfwSetKeyCallback(glfw, [](GLFWwindow* w, int place, int, int action, int modifiers) {
      Window::touched(w);
      KeyInput& input = Impl::of(w).keys;
      if (action == GLFW_PRESS) input.set_labels(labels_now());  // the keyboard may have changed
      input.key(place, action, modifiers);
    });
    glfwSetCharCallback(glfw, [](GLFWwindow* w, unsigned character) {
      Window::touched(w);
      Impl::of(w).keys.character(character);
    });
  }

  // Returns the place of the mouse; nowhere if it is not over the window, and the window not in
  // front.
  ImVec2 mouse_place() const {
    constexpr float kNowhere = -std::numeric_limits<float>::max();
    if (!mouse.over() && glfwGetWindowAttrib(glfw, GLFW_FOCUSED) == GLFW_FALSE)
      return {kNowhere, kNowhere};
    double right = 0, down = 0;
    glfwGetCursorPos(glfw, &right, &down);
    return {static_cast<float>(right), static_cast<float>(down)};
  }

  void save(const Picture& wanted) const {
    const auto& [file, left, top, right, bottom] = wanted;
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

void Window::touched(GLFWwindow* window) { Impl::of(window).liveliness.touch(SteadyClock::now()); }

Window::Window(const Options& options) : impl_(std::make_unique<Impl>()) {
  if (!start_glfw()) {
    const char* why = nullptr;
    glfwGetError(&why);
    throw std::runtime_error(
        std::string("there is no display for a window (") +
        (why != nullptr ? why : "glfwInit failed") +
        "); `limpid run` works without one, and so does `limpid play SESSION.h5 --video OUT.mp4`");
  }
  const WorkArea area = work_area();
  impl_->screen_scale = area.scale;
  impl_->glfw = create_window(options, area);
  const Rgb backdrop = palette(options.theme).backdrop;
  const unsigned colour =
      static_cast<unsigned>(backdrop.r) << 16 | static_cast<unsigned>(backdrop.g) << 8 | backdrop.b;
  impl_->refresh = pacing_refresh(impl_->glfw, [colour] { fill(colour); });
  impl_->renderer = renderer_name();
  glfwSetWindowUserPointer(impl_->glfw, impl_.get());
  watch_touches(impl_->glfw);
  glfwSetDropCallback(impl_->glfw, [](GLFWwindow* w, int count, const char** paths) {
    Window::touched(w);
    for (int i = 0; i < count; ++i) Impl::of(w).dropped.emplace_back(paths[i]);
  });

  impl_->imgui.emplace();
  ImGui_ImplGlfw_InitForOpenGL(impl_->glfw, true);
  begin_imgui_input();
  impl_->keys.set_labels(labels_now());
  impl_->listen();
  float scale_x = 1, scale_y = 1;
  glfwGetWindowContentScale(impl_->glfw, &scale_x, &scale_y);
  impl_->ui_scale = options.ui_scale > 0 ? options.ui_scale : on_wayland() ? 1 : scale_x;
  impl_->density = area.density;
  impl_->theme = options.theme;
  impl_->text_size = options.text_size;
  ImGuiGl::set_up(options.theme, static_cast<float>(impl_->ui_scale * options.text_size),
                  area.density);
}

Window::~Window() {
  ImGui_ImplGlfw_Shutdown();
  impl_->imgui.reset();
  glfwDestroyWindow(impl_->glfw);
  glfwTerminate();
}

bool Window::wait() {
  Impl& w = *impl_;
  // The display has waited already, unless it has stopped doing so.
  const bool paced = w.refresh > 0 && std::exchange(w.exchanged, false);
  const std::chrono::duration<double> least(0.5 * w.refresh);
  std::this_thread::sleep_until(
      paced ? w.began + std::chrono::duration_cast<SteadyClock::duration>(least) : w.due);
  // Frames after a slow one are not hurried.
  w.due = std::max(w.due + kFrame, SteadyClock::now());
  w.began = SteadyClock::now();
  w.keys.forget_pressed();
  w.dropped.clear();
  w.mouse.ask(w.began);
  glfwPollEvents();
  return glfwWindowShouldClose(w.glfw) == GLFW_FALSE;
}

bool Window::due() const { return input_waits() || impl_->liveliness.due(SteadyClock::now()); }

bool Window::input_waits() const { return impl_->keys.waiting() || impl_->mouse.waiting(); }

InputTaken Window::input_taken() const { return {impl_->keys.taken(), impl_->mouse.taken()}; }

void Window::begin_frame(const Focus& focus) {
  impl_->keys.deal(focus);
  ImGuiGl::begin_frame();
  ImGui_ImplGlfw_NewFrame();
  impl_->mouse.deal(impl_->mouse_place());
  ImGui::NewFrame();
}

void Window::end_frame() {
  ImGuiGl::render();
  impl_->saved.clear();
  for (const Impl::Picture& picture : std::exchange(impl_->pictures, {})) {
    SavedPicture& result = impl_->saved.emplace_back(SavedPicture{picture.file, ""});
    try {
      impl_->save(picture);
    } catch (const std::exception& e) {
      result.error = e.what();
    }
  }
  glfwSwapBuffers(impl_->glfw);
  impl_->exchanged = true;
  impl_->liveliness.drawn(SteadyClock::now());
  const std::chrono::duration<double> took = SteadyClock::now() - impl_->began;
  impl_->frame_time = took.count();
}

void Window::set_look(Theme theme, double text_size) {
  Impl& w = *impl_;
  if (theme == w.theme && text_size == w.text_size) return;
  w.theme = theme;
  w.text_size = text_size;
  ImGuiGl::change(theme, static_cast<float>(w.ui_scale * text_size), w.density);
}

void Window::close() { glfwSetWindowShouldClose(impl_->glfw, GLFW_TRUE); }

void Window::keep_open() { glfwSetWindowShouldClose(impl_->glfw, GLFW_FALSE); }

bool Window::focused() const { return glfwGetWindowAttrib(impl_->glfw, GLFW_FOCUSED) == GLFW_TRUE; }
bool Window::full_screen() const { return glfwGetWindowMonitor(impl_->glfw) != nullptr; }

void Window::toggle_full_screen() {
  Impl& w = *impl_;
  if (full_screen()) {
    glfwSetWindowMonitor(w.glfw, nullptr, w.x, w.y, w.width, w.height, 0);
    return;
  }
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (monitor == nullptr) return;
  if (!on_wayland()) glfwGetWindowPos(w.glfw, &w.x, &w.y);
  glfwGetWindowSize(w.glfw, &w.width, &w.height);
  const GLFWvidmode* mode = glfwGetVideoMode(monitor);
  glfwSetWindowMonitor(w.glfw, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

const std::vector<KeyPress>& Window::keys() const { return impl_->keys.pressed(); }
const KeyLabels& Window::key_labels() const { return impl_->keys.labels(); }
const std::vector<std::filesystem::path>& Window::dropped() const { return impl_->dropped; }
void Window::size(int& width, int& height) const {
  glfwGetWindowSize(impl_->glfw, &width, &height);
}
void Window::framebuffer_size(int& width, int& height) const {
  glfwGetFramebufferSize(impl_->glfw, &width, &height);
}
void Window::asked_size(int& width, int& height) const {
  size(width, height);
  width = static_cast<int>(std::lround(static_cast<float>(width) / impl_->screen_scale));
  height = static_cast<int>(std::lround(static_cast<float>(height) / impl_->screen_scale));
}
const std::string& Window::renderer() const { return impl_->renderer; }
double Window::frame_time() const { return impl_->frame_time; }

void Window::save_picture(const std::filesystem::path& png) { save_picture(png, 0, 0, 0, 0); }

void Window::save_picture(const std::filesystem::path& png, double left, double top, double right,
                          double bottom) {
  impl_->pictures.push_back({png, left, top, right, bottom});
}

const std::vector<SavedPicture>& Window::saved() const { return impl_->saved; }

}  // namespace limpid
