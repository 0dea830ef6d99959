// Leaks of libraries that LeakSanitizer shall not report: HDF5 keeps its pools to the end of the
// process, and urdfdom loses links that refer to each other in a loop.
extern "C" [[gnu::visibility("default")]] const char* __lsan_default_suppressions() {
  return "leak:libhdf5\nleak:liburdfdom\n";
}
