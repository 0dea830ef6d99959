#include "render/gl/frame_target.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace limpid {

FrameTarget::FrameTarget(const std::filesystem::path& shaders)
    : plain_(shaders, "backdrop", "finish"), smooth_(shaders, "backdrop", "finish", "SMOOTH 1") {}

void FrameTarget::allocate() {
  Buffers& b = buffers_.emplace();
  const int samples = samples_ > 1 ? samples_ : 0;
  glBindTexture(GL_TEXTURE_2D, b.picture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_, height_, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glBindTexture(GL_TEXTURE_2D, 0);

  glBindFramebuffer(GL_FRAMEBUFFER, b.resolved);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, b.picture, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, b.drawn);
  if (samples > 0) {
    glBindRenderbuffer(GL_RENDERBUFFER, b.color);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, width_, height_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, b.color);
  } else {
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, b.picture, 0);
  }
  glBindRenderbuffer(GL_RENDERBUFFER, b.depth);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH24_STENCIL8, width_, height_);
  glBindRenderbuffer(GL_RENDERBUFFER, 0);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, b.depth);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("OpenGL gives no picture of " + std::to_string(width_) + " x " +
                             std::to_string(height_) + " pixels with " + std::to_string(samples_) +
                             " samples");
}

void FrameTarget::begin(int width, int height, int samples) {
  GLint most = 1;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  samples = std::clamp(samples, 1, std::max(1, most));
  if (!buffers_ || width != width_ || height != height_ || samples != samples_) {
    width_ = width, height_ = height, samples_ = samples;
    allocate();
  }
  glBindFramebuffer(GL_FRAMEBUFFER, buffers_->drawn);
  glViewport(0, 0, width_, height_);
  glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);  // the backdrop covers every colour
}

void FrameTarget::finish(GLuint framebuffer, int x, int y, int width, int height) {
  if (samples_ > 1) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, buffers_->drawn);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, buffers_->resolved);
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(x, y, width, height);
  glDisable(GL_DEPTH_TEST);
  const ShaderProgram& program = samples_ > 1 ? plain_ : smooth_;
  program.use();
  program.set("picture", 0);
  program.set("place", glm::vec4(x, y, width, height));
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, buffers_->picture);
  glBindVertexArray(no_vertices_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace limpid
