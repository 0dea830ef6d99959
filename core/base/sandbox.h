// A process that reads what strangers made takes away from itself, for ever, what reading does not
// need.
#pragma once

#include <filesystem>

namespace limpid {

// Sanitizers take addresses and system calls of their own.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

// From here on this process opens files for reading only, and where the kernel has Landlock only
// `place`, a file or a folder with all below (none, if it is empty); it starts no program and no
// thread, sends nothing anywhere, and changes nothing but what its descriptors 0 to 3 let it write.
// All other descriptors are closed. A sanitized program stays as it is. Throws
// std::runtime_error if the kernel does not let it.
void enter_sandbox(const std::filesystem::path& place);

}  // namespace limpid
