// Epoxy's header and GLFW's do not go together, so this is a source by itself.
#include "tests/support/faultless_context.h"

#include <epoxy/gl.h>
#include <gtest/gtest.h>

namespace limpid::test {

void expect_no_gl_error() { EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR}) << "of OpenGL"; }

FaultlessContext::~FaultlessContext() { expect_no_gl_error(); }

}  // namespace limpid::test
