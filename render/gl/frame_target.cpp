#include "render/gl/frame_target.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace limpid {
namespace {

void picture_texture(GLuint texture, int width, int height) {
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glBindTexture(GL_TEXTURE_2D, 0);
}

}  // namespace

FrameTarget::FrameTarget(const std::filesystem::path& shaders)
    : smooth_(shaders, "backdrop", "finish"), scaled_(shaders, "backdrop", "finish", "SCALED 1") {}

void FrameTarget::allocate() {
  Buffers& b = buffers_.emplace();
  const int samples = samples_ > 1 ? samples_ : 0;
  picture_texture(b.picture, width_, height_);
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
    throw std::runtime_error("OpenGL cannot make a picture of " + std::to_string(width_) + " x " +
                             std::to_string(height_) + " pixels with " + std::to_string(samples_) +
                             " samples");
}

bool FrameTarget::begin(int width, int height, int samples) {
  GLint most = 1;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  samples = std::clamp(samples, 1, std::max(1, most));
  const bool is_new = !buffers_ || width != width_ || height != height_ || samples != samples_;
  if (is_new) {
    width_ = width, height_ = height, samples_ = samples;
    soft_width_ = soft_height_ = 0;
    allocate();
  }
  glBindFramebuffer(GL_FRAMEBUFFER, buffers_->drawn);
  glViewport(0, 0, width_, height_);
  return is_new;
}

void FrameTarget::clear(const Area& area) {
  glEnable(GL_SCISSOR_TEST);
  glScissor(area.x, area.y, area.width, area.height);
  glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);  // the backdrop covers every colour
}

void FrameTarget::resolve(const Area& changed) const {
  const auto& [x, y, width, height] = changed;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, buffers_->drawn);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, buffers_->resolved);
  glBlitFramebuffer(x, y, x + width, y + height, x, y, x + width, y + height, GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
}

void FrameTarget::soften(const Area& to, const Area& changed) {
  const bool is_new = to.width != soft_width_ || to.height != soft_height_;
  if (is_new) {
    soft_width_ = to.width, soft_height_ = to.height;
    picture_texture(buffers_->soft, to.width, to.height);
    glBindFramebuffer(GL_FRAMEBUFFER, buffers_->softened);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, buffers_->soft, 0);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, buffers_->softened);
  // Pixels around a pixel in which edges are looked for.
  constexpr int kAround = 3;
  const auto scaled = [](int at, int size, int from) {
    return static_cast<int>(static_cast<long long>(at) * size / from);
  };
  const int left = scaled(changed.x - kAround, to.width, width_);
  const int bottom = scaled(changed.y - kAround, to.height, height_);
  const int right = scaled(changed.x + changed.width + kAround, to.width, width_);
  const int top = scaled(changed.y + changed.height + kAround, to.height, height_);
  if (!is_new) {
    glEnable(GL_SCISSOR_TEST);
    glScissor(std::max(0, left), std::max(0, bottom), std::max(0, right - std::max(0, left)),
              std::max(0, top - std::max(0, bottom)));
  }
  show(buffers_->picture, {0, 0, to.width, to.height});
  glDisable(GL_SCISSOR_TEST);
}

void FrameTarget::show(GLuint picture, const Area& to) const {
  glViewport(to.x, to.y, to.width, to.height);
  glDisable(GL_DEPTH_TEST);
  const ShaderProgram& program = to.width == width_ ? smooth_ : scaled_;
  program.use();
  program.set("picture", 0);
  program.set("place", glm::vec4(to.x, to.y, to.width, to.height));
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, picture);
  glBindVertexArray(no_vertices_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void FrameTarget::finish(GLuint framebuffer, const Area& to, const Area& changed) {
  glDisable(GL_SCISSOR_TEST);
  const bool any = changed.width > 0 && changed.height > 0;
  const bool all = changed.width == width_ && changed.height == height_;
  if (samples_ > 1) {
    if (any) resolve(changed);
  } else if (all) {
    // While the camera turns every frame is new: nothing is gained by keeping it.
    soft_width_ = soft_height_ = 0;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    return show(buffers_->picture, to);
  } else if (any || to.width != soft_width_ || to.height != soft_height_) {
    soften(to, changed);
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, samples_ > 1 ? buffers_->resolved : buffers_->softened);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  const int width = samples_ > 1 ? width_ : to.width, height = samples_ > 1 ? height_ : to.height;
  glBlitFramebuffer(0, 0, width, height, to.x, to.y, to.x + to.width, to.y + to.height,
                    GL_COLOR_BUFFER_BIT, width == to.width ? GL_NEAREST : GL_LINEAR);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
}

}  // namespace limpid
