// The window of the operating system with OpenGL and ImGui in it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/desktop/shell/input.h"
#include "render/theme.h"

struct GLFWwindow;

namespace limpid {

// The display that goes while the program runs.

// X11's library ends the program when its display is gone, where `leave` is called first, once, on
// the thread that used the display: what is to be kept is kept there, without drawing anything.
// Does nothing where the window is not X11's. After the window is there.
void when_display_is_lost(std::function<void()> leave);

// The program's window as it is named to the desktop's portals; empty where it has no name for
// them, as on Wayland.
std::string window_for_portals();

// Where windows may be on the screen.

inline constexpr int kLeastWidth = 900, kLeastHeight = 560;  // of a window

// The screen without the desktop's bars.
struct WorkArea {
  int x = 0, y = 0, width = kLeastWidth, height = kLeastHeight;
  float scale = 1;    // of the screen
  float density = 1;  // pixels for each of the window's units
};

// Of the first screen.
WorkArea work_area();

// Inside of the area with the frame that the desktop drew round the window.
void move_into(const WorkArea& area, GLFWwindow* window);

// What became of a picture that was to be saved.
struct SavedPicture {
  std::filesystem::path file;
  std::string error;  // empty: it is there
};

// How much of what was done to the window frames took so far: presses of keys without modifiers,
// presses and releases of the mouse's buttons.
struct InputTaken {
  long keys = 0, buttons = 0;
};

class Window {
 public:
  struct Options {
    int width = 1440, height = 900;
    double ui_scale = 0;  // 0: the screen's
    Theme theme = Theme::dark;
  };

  // As large as asked for, but no larger than the screen has room for. Throws std::runtime_error
  // where there is no display or no OpenGL 3.3.
  explicit Window(const Options& options);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  // A turn of the program: waits until the display, or else the next sixtieth of a second, is there
  // and collects input. False once the user closes the window.
  bool wait();
  // Somebody touched the window, or its numbers are old: a frame has to be drawn in this turn.
  bool due() const;
  // Of what was done there is more than the frames up to now took.
  bool input_waits() const;
  InputTaken input_taken() const;
  // Deals the input to who has the `focus` and begins ImGui's frame.
  void begin_frame(const Focus& focus);
  // Draws ImGui over the picture and shows the frame.
  void end_frame();

  void close();
  void keep_open();  // after begin_frame() returned false
  void toggle_full_screen();
  bool full_screen() const;
  bool focused() const;
  // Keys pressed in this frame, without those held since somebody else had the focus.
  const std::vector<KeyPress>& keys() const;
  // Labels of the keyboard that is chosen now.
  const KeyLabels& key_labels() const;
  // Files dropped on the window in this frame.
  const std::vector<std::filesystem::path>& dropped() const;
  void size(int& width, int& height) const;              // in ImGui's coordinates
  void asked_size(int& width, int& height) const;        // Options that would give this size
  void framebuffer_size(int& width, int& height) const;  // in pixels
  const std::string& renderer() const;                   // what OpenGL calls itself
  double frame_time() const;  // work of the last frame, without waiting [s]
  // Saves what is between two corners [ImGui's coordinates] once the frame is drawn; without
  // corners all of it. What became of it is in saved() after end_frame().
  void save_picture(const std::filesystem::path& png);
  void save_picture(const std::filesystem::path& png, double left, double top, double right,
                    double bottom);
  // For the system's calls: somebody did something to it.
  static void touched(GLFWwindow* window);
  // Pictures that the last end_frame() wrote, or could not write.
  const std::vector<SavedPicture>& saved() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace limpid
