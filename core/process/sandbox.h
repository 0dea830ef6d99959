// A process that reads what strangers made takes away from itself, for ever, what reading does not
// need.
#pragma once

#include <filesystem>

namespace limpid {

// From here on this process opens files for reading only, and where the kernel has Landlock only
// `place`, a file or a folder with all below (none, if it is empty); it starts no program and no
// thread, sends nothing anywhere, and changes nothing but what its descriptors 0 to 3 let it write.
// All other descriptors are closed. Throws std::runtime_error if the kernel does not let it.
void enter_sandbox(const std::filesystem::path& place);

}  // namespace limpid
