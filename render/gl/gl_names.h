// OpenGL objects that are deleted when they go out of scope; Eigen's types as GLM's.
#pragma once

#include <epoxy/gl.h>

#include <glm/glm.hpp>
#include <utility>

#include "core/math/sizes.h"

namespace limpid {

inline glm::vec3 to_glm(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

inline glm::mat4 to_glm(const Eigen::Matrix4d& m) {
  glm::mat4 out;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) out[column][row] = static_cast<float>(m(row, column));
  return out;
}

inline glm::mat4 to_glm(const Pose& pose) { return to_glm(Eigen::Matrix4d(pose.matrix())); }

// `Kind` gives create() and destroy() of one sort of object.
template <class Kind>
class GlName {
 public:
  GlName() : id_(Kind::create()) {}
  ~GlName() {
    if (id_ != 0) Kind::destroy(id_);
  }
  GlName(GlName&& other) noexcept : id_(std::exchange(other.id_, 0u)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  operator GLuint() const { return id_; }

 private:
  GLuint id_;
};

struct BufferKind {
  static GLuint create() {
    GLuint id = 0;
    glGenBuffers(1, &id);
    return id;
  }
  static void destroy(GLuint id) { glDeleteBuffers(1, &id); }
};
struct VertexArrayKind {
  static GLuint create() {
    GLuint id = 0;
    glGenVertexArrays(1, &id);
    return id;
  }
  static void destroy(GLuint id) { glDeleteVertexArrays(1, &id); }
};
struct TextureKind {
  static GLuint create() {
    GLuint id = 0;
    glGenTextures(1, &id);
    return id;
  }
  static void destroy(GLuint id) { glDeleteTextures(1, &id); }
};
struct FramebufferKind {
  static GLuint create() {
    GLuint id = 0;
    glGenFramebuffers(1, &id);
    return id;
  }
  static void destroy(GLuint id) { glDeleteFramebuffers(1, &id); }
};
struct RenderbufferKind {
  static GLuint create() {
    GLuint id = 0;
    glGenRenderbuffers(1, &id);
    return id;
  }
  static void destroy(GLuint id) { glDeleteRenderbuffers(1, &id); }
};

using GlBuffer = GlName<BufferKind>;
using GlVertexArray = GlName<VertexArrayKind>;
using GlTexture = GlName<TextureKind>;
using GlFramebuffer = GlName<FramebufferKind>;
using GlRenderbuffer = GlName<RenderbufferKind>;

}  // namespace limpid
