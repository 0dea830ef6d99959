#pragma once

namespace limpid::test {

// Sanitizers let no memory be locked and say that it was.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kOnlyPretendsToLock = true;
#else
inline constexpr bool kOnlyPretendsToLock = false;
#endif

}  // namespace limpid::test
