// Name of this build of Limpid, with the kind of processor it runs on.
#pragma once

#include <string>

namespace limpid {

// Returns "limpid 0.2.0+1234.g10594ec, GCC 12.2.0, build 3f2a94d10c5b7e68; x86_64 AVX2 FMA":
// version, compiler and digest of this very program; then the kind of processor, by which the
// libraries choose their arithmetic. Runs of equal text give the same rows, bit for bit.
const std::string& program_build();

// Warns of rows made by the build of that name that this one makes again; empty if they will be the
// same. `where` names the recording.
std::string other_build(const std::string& recorded_by, const std::string& where);

}  // namespace limpid
