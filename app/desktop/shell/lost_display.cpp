#include "app/desktop/shell/lost_display.h"

#include <dlfcn.h>

#include <utility>

namespace limpid {
namespace {

// X11's handler is told of nothing but the display.
std::function<void()>& what_to_do() {
  static std::function<void()> leave;
  return leave;
}

int leave_once(void*) {
  if (const auto leave = std::exchange(what_to_do(), nullptr)) leave();
  return 0;
}

}  // namespace

void when_display_is_lost(std::function<void()> leave) {
  // Looked up in what GLFW has loaded: Wayland's has none of it.
  using Handler = int (*)(void*);
  using Set = Handler (*)(Handler);
  const auto set = reinterpret_cast<Set>(dlsym(RTLD_DEFAULT, "XSetIOErrorHandler"));
  if (set == nullptr) return;
  what_to_do() = std::move(leave);
  set(leave_once);
}

}  // namespace limpid
