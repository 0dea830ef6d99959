// Treatment of subnormal numbers, which processors handle many times more slowly.
#pragma once

#include <cstdint>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace limpid {

// While one lives, its thread takes numbers below 1e-307 for zero. All that comes to rest fades
// through them: without this a tick at rest would take several times as long as one in motion.
class NoSubnormals {
 public:
  NoSubnormals() : before_(control()) { set_control(before_ | kZeros); }
  ~NoSubnormals() { set_control(before_); }
  NoSubnormals(const NoSubnormals&) = delete;
  NoSubnormals& operator=(const NoSubnormals&) = delete;

 private:
#if defined(__SSE2__)
  static constexpr std::uint64_t kZeros = 0x8040;  // for results, for operands
  static std::uint64_t control() { return _mm_getcsr(); }
  static void set_control(std::uint64_t control) { _mm_setcsr(static_cast<unsigned>(control)); }
#elif defined(__aarch64__)
  static constexpr std::uint64_t kZeros = 1 << 24;
  static std::uint64_t control() {
    std::uint64_t control = 0;
    asm volatile("mrs %0, fpcr" : "=r"(control));
    return control;
  }
  static void set_control(std::uint64_t control) {
    asm volatile("msr fpcr, %0" : : "r"(control) : "memory");
  }
#else
  static constexpr std::uint64_t kZeros = 0;
  static std::uint64_t control() { return 0; }
  static void set_control(std::uint64_t) {}
#endif

  std::uint64_t before_;
};

}  // namespace limpid
