// Version of Limpid.
#pragma once

namespace limpid {

// Describes the tree that it was built of, as git does: "0.1.0" for a release,
// "0.2.0+1234.g10594ec" for the 1234th commit since, with ".changed" if files differ from it;
// "0.1.0" without git.
const char* program_version();

}  // namespace limpid
