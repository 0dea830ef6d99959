// A drive of the proxy that leaves it alone.
#pragma once

#include "core/touch/proxy.h"

namespace limpid::test {

// A drive without torque and damping on any of n joints.
inline ProxyDrive<kAnyDof> no_drive(int n) {
  return {Vec<kAnyDof>::Zero(n), Vec<kAnyDof>::Zero(n)};
}

}  // namespace limpid::test
