#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <stdexcept>

#include "app/base/file_portal.h"
#include "app/base/session_bus.h"
#include "app/base/window_system.h"
#include "app/doctor/doctor.h"
#include "render/gl/offscreen.h"
#include "render/quality.h"

namespace limpid {
namespace {

using State = Finding::State;

constexpr const char* kPictureArea = "picture";
constexpr int kPatience = 20'000;  // [ms], for a driver that hangs
constexpr const char* kDrivers = "sudo apt install libgl1 libegl1 libgl1-mesa-dri";

struct Answer {
  bool drawn = false;
  std::string text;  // the renderer's name, or why there is none
};

std::string offscreen_renderer() {
  const OffscreenContext context(16, 16);
  return renderer_name();
}

// Renderer of a window that is never shown, with the real one's hints.
std::string window_renderer() {
  const auto refuse = [](const char* otherwise) {
    const char* why = nullptr;
    glfwGetError(&why);
    throw std::runtime_error(why != nullptr ? why : otherwise);
  };
  if (!start_glfw()) refuse("glfwInit failed");
  hint_window();
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  GLFWwindow* window = glfwCreateWindow(16, 16, "Limpid", nullptr, nullptr);
  if (window == nullptr) refuse("OpenGL 3.3 is not there");
  glfwMakeContextCurrent(window);
  std::string name = renderer_name() + (on_wayland() ? ", on Wayland" : ", on X11");
  glfwTerminate();
  return name;
}

[[noreturn]] void answer(int to, const std::function<std::string()>& renderer) {
  setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);  // writes nothing to the disk
  std::string text;
  try {
    text = "+" + renderer();
  } catch (const std::exception& error) {
    text = std::string("-") + error.what();
  }
  _exit(write(to, text.data(), text.size()) < 0 ? 1 : 0);
}

std::string all_of(int from) {
  std::string text;
  pollfd ready{.fd = from, .events = POLLIN, .revents = 0};
  while (poll(&ready, 1, kPatience) > 0) {
    std::array<char, 512> some{};
    const ssize_t count = read(from, some.data(), some.size());
    if (count <= 0) break;
    text.append(some.data(), static_cast<std::size_t>(count));
  }
  return text;
}

// Asks in a process of its own, so that a driver's crash is an answer, too.
Answer ask(const std::function<std::string()>& renderer) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return {false, "a pipe could not be made"};
  const pid_t child = fork();
  if (child < 0) return {false, "a process could not be started"};
  if (child == 0) answer(ends[1], renderer);
  close(ends[1]);
  const std::string text = all_of(ends[0]);
  close(ends[0]);
  kill(child, SIGKILL);  // it has answered, or hangs
  waitpid(child, nullptr, 0);
  if (text.empty()) return {false, "the OpenGL driver crashed, or hangs"};
  return {text.front() == '+', text.substr(1)};
}

Finding offscreen() {
  const Answer it = ask(offscreen_renderer);
  if (it.drawn) return {kPictureArea, "without display", State::fine, it.text, {}, {}};
  return {kPictureArea,
          "without display",
          State::broken,
          it.text,
          "no videos, and no pictures from the command line",
          kDrivers};
}

bool set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

Finding window() {
  const bool wayland = set("WAYLAND_DISPLAY");
  if (!set("DISPLAY") && !(wayland && kKnowsWayland)) {
    return {kPictureArea,
            "window",
            State::better,
            wayland ? "Wayland without Xwayland (DISPLAY is not set)"
                    : "no display (DISPLAY is not set)",
            "the window does not open; all commands that need no window work",
            wayland ? "sudo apt install xwayland    # then log in again"
                    : "start it from a desktop, or over `ssh -X`"};
  }
  const Answer it = ask(window_renderer);
  if (!it.drawn) {
    return {kPictureArea, "window", State::broken, it.text, "the window does not open", kDrivers};
  }
  if (Quality::automatic_level(it.text) == 0)
    return {kPictureArea, "window", State::fine, it.text, {}, {}};
  return {kPictureArea,
          "window",
          State::better,
          it.text,
          "the processor draws the picture: there are few pictures per second, and the loop has "
          "less computing time",
          "sudo apt install libgl1-mesa-dri firmware-linux    # for Intel and AMD; NVIDIA: "
          "nvidia-driver"};
}

// Tells which file dialog opens; either one works.
Finding file_dialog() {
  const auto version = file_portal_version();
  const std::string found =
      version ? fmt::format(
                    "file dialogs of the desktop environment, through its portal (FileChooser {})",
                    *version)
      : has_session_bus() ? "Limpid's own dialog: the desktop has no portal for file dialogs"
                          : "Limpid's own dialog: no session bus connects Limpid to the desktop";
  return {kPictureArea, "file dialog", State::fine, found, {}, {}};
}

}  // namespace

DoctorFindings look_at_picture() { return {offscreen(), window(), file_dialog()}; }

}  // namespace limpid
