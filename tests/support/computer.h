// What this computer can do, asked without the program's own code: whoever left a test out because
// the program says that something is not there would leave out its faults.
#pragma once

#include <dlfcn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
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

// All memory of a process, whatever it comes to need: by a capability, or without a limit.
inline bool may_lock_memory() {
  constexpr unsigned kIpcLock = 14;  // CAP_IPC_LOCK
  unsigned long long capabilities = 0;
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "CapEff:") status >> std::hex >> capabilities;
  }
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  if ((capabilities >> kIpcLock & 1) == 0 && limit.rlim_max != RLIM_INFINITY) return false;
  const pid_t child = fork();
  if (child == 0) {
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_MEMLOCK, &limit);
    _exit(mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0 ? 0 : 1);
  }
  int left = 1;
  waitpid(child, &left, 0);
  return left == 0;
}

// The font that Debian's package fonts-inter brings.
inline bool has_inter() {
  return std::filesystem::exists("/usr/share/fonts/opentype/inter/Inter-Regular.otf");
}

}  // namespace limpid::test
