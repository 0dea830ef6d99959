// Whether this is a build with AddressSanitizer or ThreadSanitizer.
#pragma once

#if defined(__has_feature)  // of Clang
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define LIMPID_SANITIZED true
#endif
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LIMPID_SANITIZED true
#endif

namespace limpid {

// Sanitizers take addresses and system calls of their own. They do not lock memory but report
// success.
#ifdef LIMPID_SANITIZED
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace limpid
