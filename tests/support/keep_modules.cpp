// Mesa unloads its drivers before LeakSanitizer looks for who holds what: keep them. Its software
// renderer is not built for ThreadSanitizer, which therefore misses how its threads agree.
extern "C" int dlclose(void*) noexcept { return 0; }
extern "C" const char* __tsan_default_suppressions() { return "race:swrast_dri.so\n"; }
