// Mesa unloads its drivers before LeakSanitizer looks for who holds what: keep them. Its software
// renderer is not built for ThreadSanitizer, which therefore misses how its threads agree; nor is
// D-Bus' library, which takes its own two locks in either order while connecting.
extern "C" int dlclose(void*) noexcept { return 0; }
extern "C" const char* __tsan_default_suppressions() {
  return "race:swrast_dri.so\ndeadlock:libdbus-1.so\n";
}
