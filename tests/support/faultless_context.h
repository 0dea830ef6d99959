// An offscreen context for pictures that OpenGL draws without an error.
#pragma once

#include "render/gl/offscreen.h"

namespace limpid::test {

// Fails the test that runs where OpenGL has reported an error in the present context.
void expect_no_gl_error();

// Fails its test where OpenGL has reported an error by the end of the context's life.
class FaultlessContext : public OffscreenContext {
 public:
  using OffscreenContext::OffscreenContext;
  ~FaultlessContext();
};

}  // namespace limpid::test
