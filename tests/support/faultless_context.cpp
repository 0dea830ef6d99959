// By itself: the headers of Epoxy and of GLFW do not go together.
#include "tests/support/faultless_context.h"

#include <epoxy/gl.h>
#include <gtest/gtest.h>

namespace limpid::test {

FaultlessContext::~FaultlessContext() {
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR}) << "of OpenGL";
}

}  // namespace limpid::test
