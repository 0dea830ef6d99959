// Differences of a build with sanitizers.
#pragma once

namespace limpid::test {

// Sanitizers do not lock memory but report success.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kOnlyPretendsToLock = true;
#else
inline constexpr bool kOnlyPretendsToLock = false;
#endif

}  // namespace limpid::test
