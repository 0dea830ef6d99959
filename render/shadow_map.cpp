#include "render/shadow_map.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "render/gl/glm_door.h"

namespace limpid {

ShadowMap::ShadowMap(int size) : size_(std::max(0, size)) {
  allocate(still_);
  allocate(all_);
}

void ShadowMap::allocate(const Layer& layer) const {
  const GLsizei edge = std::max(1, size_);
  glBindTexture(GL_TEXTURE_2D, layer.depth);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, edge, edge, 0, GL_DEPTH_COMPONENT,
               GL_UNSIGNED_INT, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  // Outside of the map everything is lit.
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  const float lit[] = {1, 1, 1, 1};
  glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, lit);
  glBindTexture(GL_TEXTURE_2D, 0);

  GLint before = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &before);
  glBindFramebuffer(GL_FRAMEBUFFER, layer.framebuffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, layer.depth, 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(before));
}

void ShadowMap::aim(const Bounds& box, const glm::vec3& to_light) {
  const glm::vec3 center = to_glm(Vec3(box.center()));
  const float radius = 0.5f * static_cast<float>(box.diagonal().norm());
  const glm::mat4 view = glm::lookAt(center + 2.0f * radius * to_light, center, glm::vec3(0, 1, 0));
  clip_ = glm::ortho(-radius, radius, -radius, radius, 0.5f * radius, 3.5f * radius) * view;
  texel_ = 2 * radius / static_cast<float>(std::max(1, size_));
}

void ShadowMap::begin_still() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, still_.framebuffer);
  glViewport(0, 0, std::max(1, size_), std::max(1, size_));
  glClear(GL_DEPTH_BUFFER_BIT);
}

void ShadowMap::begin_moving(const PixelArea& area) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, still_.framebuffer);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, all_.framebuffer);
  glViewport(0, 0, std::max(1, size_), std::max(1, size_));
  const Eigen::Vector2i from = area.min(), to = area.max();
  glBlitFramebuffer(from.x(), from.y(), to.x(), to.y(), from.x(), from.y(), to.x(), to.y(),
                    GL_DEPTH_BUFFER_BIT, GL_NEAREST);
}

void ShadowMap::bind(GLuint unit) const {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D, all_.depth);
  glActiveTexture(GL_TEXTURE0);
}

glm::mat4 ShadowMap::lookup() const {
  return glm::translate(glm::mat4(1), glm::vec3(0.5f)) * glm::scale(glm::mat4(1), glm::vec3(0.5f)) *
         clip_;
}

}  // namespace limpid
