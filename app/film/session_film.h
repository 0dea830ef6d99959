// Videos of recorded sessions: the 3D picture, the window's plots below it and a caption above.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/film/video_file.h"
#include "app/plot/plot_frame.h"
#include "app/run/rerun.h"
#include "app/stage/magnifier.h"
#include "app/stage/stage.h"
#include "app/story/story.h"
#include "app/style/imgui_gl.h"
#include "app/style/picture_legend.h"
#include "devices/files/session/session.h"
#include "render/camera.h"
#include "render/gl/offscreen.h"

namespace limpid {

struct FilmLook {
  int width = 1280, height = 720;  // [px]
  bool plots = true;               // left out if there is no room for them
  bool overlaid = false;           // all runs in one picture
  bool lens = false;               // at the tip, while gap or contact is small, in one picture
  double text_scale = 0;           // 1 as in the window on an ordinary screen; 0: by the size
  Theme theme = Theme::dark;
};

struct FilmCaption {
  std::string time;       // "12.34 s"
  std::string text;       // the settings in force
  std::string aside;      // at the right, if there is room
  std::string told = {};  // sentence over the picture, in lines as they fit
  std::string sign = {};  // warning over the picture, at the top
};

// Draws pictures of a video without a display, in an OpenGL context of its own: make it before the
// stages it draws, on the thread that draws them. ImGui being what it is, not beside a window in
// the same program.
class FilmFrame {
 public:
  // Errors: std::runtime_error if OpenGL cannot be had.
  explicit FilmFrame(const FilmLook& look);

  // Draws `view` in the stage's picture, and the stage's plots with what its history holds by now
  // and a line at the newest row. `elapsed` since the last picture [s]. With further runs `beside`
  // it, each has a part of the picture and the name that the stage gives it, unless they are
  // overlaid. Returns four bytes a pixel, top row first.
  std::vector<unsigned char> draw(Stage& stage, ViewState view, const Camera& camera,
                                  const FilmCaption& caption, double elapsed,
                                  std::vector<ViewState> beside = {});
  // Returns the viewport that the camera should expect [px], of each of this many runs.
  ImVec2 viewport(std::size_t runs) const;

 private:
  struct Places {
    ScreenRect caption, picture, plots;
  };
  Places lay_out() const;
  void draw_picture(const ScreenRect& rect, Stage& stage, const ViewState& view,
                    const Camera& camera, std::span<const ViewState> beside);
  void draw_legend(const ScreenRect& rect, const PictureLegend& legend) const;
  void draw_caption(const ScreenRect& rect, const FilmCaption& caption) const;
  void draw_plots(const ScreenRect& rect, Stage& stage) const;

  FilmLook look_;
  float scale_;
  OffscreenContext context_;
  ImGuiGl imgui_;
  Magnifier magnifier_;
};

// Order for the video of a recorded session.
struct FilmOrder {
  std::filesystem::path out = {};
  bool force = false;
  FilmLook look = {};
  std::optional<int> fps = {};          // none: the usual one for such a file
  double from = 0;                      // [s] of the session
  std::optional<double> to = {};        // none: its end
  double speed = 1;                     // of the session in the video, 0.01 to 100
  std::string title = {};               // at the right of the caption
  std::vector<StoryStep> steps = {};    // of the recorded story; none: the session is no story's
  std::vector<std::string> rerun = {};  // settings of a re-run beside the first lane; none: none
};

// Moments of a session, one for each picture of its video.
struct FilmCut {
  double from, to;  // [s] of the session, in it, from < to
  double speed;
  int fps;

  double duration() const { return (to - from) / speed; }  // of the video [s]
  std::size_t pictures() const;                            // duration x fps, one at least
  double time(std::size_t picture) const;                  // [s] of the session
};

// Works out the moments that an order means for a session. Errors: FileError for times that are not
// in it, and for a name that is no video's.
FilmCut cut(const FilmOrder& order, const Session& session, const std::string& where);

struct FilmEnd {
  bool stopped = false;  // there is no video then
  double seconds = 0;    // of the video, as far as drawn
};

// Draws a video at full quality, as fast as it goes. Tells `at` the part of the work that is done,
// 0 to 1. `where` names the session in errors: FileError for what is refused before anything is
// written, else std::runtime_error.
FilmEnd film(const Session& session, const std::string& where, const FilmOrder& order,
             const std::atomic<bool>& stop, const std::function<void(double)>& at);

}  // namespace limpid
