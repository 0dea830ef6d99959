// The program `limpid`.
#include "app/make_video.h"
#include "app/program.h"

int main(int argc, char** argv) {
  return limpid::run_program(argc, argv, {limpid::make_video, limpid::make_story_video});
}
