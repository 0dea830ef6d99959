// Keeps Mesa's drivers loaded for LeakSanitizer, which looks for references after they are
// unloaded. Suppresses reports of ThreadSanitizer where it cannot see: Mesa's software renderer is
// not built for it, and D-Bus' library takes its two locks in either order while connecting.
extern "C" [[gnu::visibility("default")]] int dlclose(void*) noexcept { return 0; }
extern "C" [[gnu::visibility("default")]] const char* __tsan_default_suppressions() {
  return "race:swrast_dri.so\ndeadlock:libdbus-1.so\n";
}
