// Window of the operating system with OpenGL and ImGui in it.
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

// Calls `leave` when the display is lost, once, on the thread that used the display. X11's library
// then ends the program: `leave` has to keep unsaved work, without drawing. Does nothing if the
// window is not X11's. Precondition: the window is there.
void when_display_is_lost(std::function<void()> leave);

// Returns the window's name for the desktop's portals; empty if it has none, as on Wayland.
std::string window_for_portals();

inline constexpr int kLeastWidth = 900, kLeastHeight = 560;  // of a window

// Area of the screen without the desktop's bars, where windows may be.
struct WorkArea {
  int x = 0, y = 0, width = kLeastWidth, height = kLeastHeight;
  float scale = 1;    // of the screen
  float density = 1;  // pixels per unit of the window
};

// Returns the area of the primary screen.
WorkArea work_area();

// Moves the window into the area, with the frame that the desktop drew round it.
void move_into(const WorkArea& area, GLFWwindow* window);

// Outcome of saving a picture.
struct SavedPicture {
  std::filesystem::path file;
  std::string error;  // empty: it was saved
};

// Input that frames took so far: presses of keys without modifiers, presses and releases of the
// mouse's buttons.
struct InputTaken {
  long keys = 0, buttons = 0;
};

class Window {
 public:
  struct Options {
    int width = 1440, height = 900;
    double ui_scale = 0;  // 0: the screen's scale
    double text_size = 1;
    Theme theme = Theme::dark;
  };

  // Opens a window of this size, but no larger than the screen has room for. Errors:
  // std::runtime_error without a display or OpenGL 3.3.
  explicit Window(const Options& options);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  // Begins a turn of the program: waits for the display, or for the next sixtieth of a second, and
  // collects input. Returns false once the user closes the window.
  bool wait();
  // Returns whether a frame has to be drawn in this turn: after a touch, or because numbers are
  // old.
  bool due() const;
  // Returns whether some input was not taken by a frame yet.
  bool input_waits() const;
  InputTaken input_taken() const;
  // Gives the input to the owner of the `focus`, and begins ImGui's frame.
  void begin_frame(const Focus& focus);
  // Draws ImGui over the picture and shows the frame.
  void end_frame();

  // Sets the theme, and the size of text and controls in that of the screen's scale, from the next
  // frame on. To be called between two frames.
  void set_look(Theme theme, double text_size);

  void close();
  void keep_open();  // after wait() returned false
  void toggle_full_screen();
  bool full_screen() const;
  bool focused() const;
  // Returns the keys pressed in this frame, without those held since another focus.
  const std::vector<KeyPress>& keys() const;
  // Returns the labels of the present keyboard.
  const KeyLabels& key_labels() const;
  // Returns the files dropped on the window in this frame.
  const std::vector<std::filesystem::path>& dropped() const;
  void size(int& width, int& height) const;              // in ImGui's coordinates
  void asked_size(int& width, int& height) const;        // Options that would give this size
  void framebuffer_size(int& width, int& height) const;  // in pixels
  const std::string& renderer() const;                   // OpenGL's name of itself
  double frame_time() const;  // work of the last frame, without waiting [s]
  // Saves the part between two corners [ImGui's coordinates] once the frame is drawn, or all
  // without corners. saved() has the outcome after end_frame().
  void save_picture(const std::filesystem::path& png);
  void save_picture(const std::filesystem::path& png, double left, double top, double right,
                    double bottom);
  // Notes a touch; for the system's callbacks.
  static void touched(GLFWwindow* window);
  // Returns the pictures that the last end_frame() wrote, or could not write.
  const std::vector<SavedPicture>& saved() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace limpid
