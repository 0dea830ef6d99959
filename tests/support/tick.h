// How long a tick of most tests is.
#pragma once

namespace limpid::test {

inline constexpr double T = 1e-3;  // [s]

}  // namespace limpid::test
