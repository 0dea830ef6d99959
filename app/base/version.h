// Which Limpid this is.
#pragma once

namespace limpid {

// As git describes the tree it was built of: "0.1.0" of a release, "0.1.0+1234.g10594ec" of the
// 1234th commit since, with ".changed" where files differ from it; "0.1.0" without git.
const char* program_version();

}  // namespace limpid
