#include "app/cli/video_options.h"

#include <CLI/CLI.hpp>

namespace limpid {

void VideoOptions::add(CLI::App& command) {
  auto* video =
      command
          .add_option("--video", out,
                      "no window: write the session as OUT.mp4, OUT.gif, or a folder of PNG files")
          ->type_name("OUT");
  const auto of_video = [&](CLI::Option* option) { option->needs(video); };
  of_video(command
               .add_option("--size", size,
                           "size of the video in pixels, even numbers; default: 1280x720")
               ->type_name("WxH"));
  of_video(command.add_option("--fps", fps, "pictures per second; default: 30, in a GIF 15")
               ->type_name("N"));
  of_video(command.add_option("--from", from, "begin here in the session; default: 0")
               ->type_name("SECONDS"));
  of_video(
      command.add_option("--to", to, "end here; default: the session's end")->type_name("SECONDS"));
  auto* rate =
      command.add_option("--speed", speed, "speed of the video; 0.5 is slow motion; default: 1")
          ->type_name("0.01..100");
  rate->check(CLI::Range(0.01, 100.0).description(""));
  of_video(rate);
  of_video(command.add_flag("--plots,!--no-plots", plots, "show the plots, or hide the plots"));
  of_video(command.add_flag("--overlaid", overlaid,
                            "show two runs in one picture; default: one picture beside the other"));
  of_video(
      command.add_flag("--lens", lens, "show the lens at the tip, while gap or contact is small"));
  of_video(command
               .add_option("--rerun", rerun,
                           "show a re-run of the hand as well, with this setting changed; may be "
                           "given several times")
               ->type_name("KEY=VALUE"));
  of_video(command.add_flag("--force", force, "replace OUT if it exists"));
  of_video(command.add_flag("--print-progress", print_progress,
                            "print the part that is done, 0 to 1, line by line"));
}

}  // namespace limpid
