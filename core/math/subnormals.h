// Numbers too small for full precision, which processors handle many times more slowly.
#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace limpid {

// While one lives, its thread takes numbers below 1e-307 for zero. Whatever comes to rest fades
// through them: without this a tick at rest would take several times as long as one in motion.
class NoSubnormals {
 public:
#if defined(__SSE2__)
  NoSubnormals() : before_(_mm_getcsr()) {
    constexpr unsigned kFlushResults = 0x8000, kZeroOperands = 0x0040;
    _mm_setcsr(before_ | kFlushResults | kZeroOperands);
  }
  ~NoSubnormals() { _mm_setcsr(before_); }
#else
  NoSubnormals() {}
  ~NoSubnormals() {}
#endif
  NoSubnormals(const NoSubnormals&) = delete;
  NoSubnormals& operator=(const NoSubnormals&) = delete;

 private:
#if defined(__SSE2__)
  unsigned before_;
#endif
};

}  // namespace limpid
