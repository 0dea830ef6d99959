#include "render/gl/line_batch.h"

namespace limpid {

LineBatch::LineBatch() {
  glBindVertexArray(array_);
  glBindBuffer(GL_ARRAY_BUFFER, buffer_);
  for (GLuint i = 0; i < 4; ++i) {
    glVertexAttribPointer(i, 4, GL_FLOAT, GL_FALSE, sizeof(Line),
                          reinterpret_cast<const void*>(i * sizeof(glm::vec4)));
    glVertexAttribDivisor(i, 1);
    glEnableVertexAttribArray(i);
  }
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void LineBatch::add(const glm::vec3& from, const glm::vec3& to, float width,
                    const glm::vec4& color_from, const glm::vec4& color_to, Ends ends) {
  lines_.push_back({from, width, to, ends == Ends::round ? 1.0f : 0.0f, color_from, color_to});
}

void LineBatch::draw() {
  if (lines_.empty()) return;
  glBindVertexArray(array_);
  glBindBuffer(GL_ARRAY_BUFFER, buffer_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(lines_.size() * sizeof(Line)),
               lines_.data(), GL_STREAM_DRAW);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(lines_.size()));
  glBindBuffer(GL_ARRAY_BUFFER, 0);
}

}  // namespace limpid
