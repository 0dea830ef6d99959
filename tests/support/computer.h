// Abilities of this computer, asked without the program's own code: a test that skips because the
// program denies an ability would hide the program's fault.
#pragma once

#include <dlfcn.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace limpid::test {

// EGL starts without a display. It stays started: the program may be using it.
inline bool has_offscreen_pictures() {
  void* const egl = dlopen("libEGL.so.1", RTLD_NOW);
  if (egl == nullptr) return false;
  const auto query = reinterpret_cast<const char* (*)(void*, int)>(dlsym(egl, "eglQueryString"));
  const auto display = reinterpret_cast<void* (*)(unsigned, void*, const std::intptr_t*)>(
      dlsym(egl, "eglGetPlatformDisplay"));
  const auto start = reinterpret_cast<unsigned (*)(void*, int*, int*)>(dlsym(egl, "eglInitialize"));
  if (query == nullptr || display == nullptr || start == nullptr) return false;
  constexpr int kExtensions = 0x3055;
  constexpr unsigned kSurfaceless = 0x31DD;
  const char* const known = query(nullptr, kExtensions);
  if (known == nullptr ||
      std::string_view(known).find("MESA_platform_surfaceless") == std::string_view::npos) {
    return false;
  }
  void* const here = display(kSurfaceless, nullptr, nullptr);
  return here != nullptr && start(here, nullptr, nullptr) != 0;
}

// Whether a process may lock all the memory it will need: no limit, or the right to lock beyond it.
// Asked without a child process, as fork() would make this one's pages fault once more.
inline bool may_lock_memory() {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  if (limit.rlim_max == RLIM_INFINITY) return true;
  const std::size_t beyond = limit.rlim_cur + (std::size_t{1} << 20);
  void* const room = mmap(nullptr, beyond, PROT_READ | PROT_WRITE,
                          MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room == MAP_FAILED) return false;
  const bool may = mlock2(room, beyond, MLOCK_ONFAULT) == 0;
  munmap(room, beyond);
  return may;
}

// Whether the font of Debian's package fonts-inter is installed.
inline bool has_inter() {
  return std::filesystem::exists("/usr/share/fonts/opentype/inter/Inter-Regular.otf");
}

}  // namespace limpid::test
