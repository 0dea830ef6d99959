// Length of a tick in most tests.
#pragma once

namespace limpid::test {

inline constexpr double T = 1e-3;  // [s]

}  // namespace limpid::test
