// A GLSL program from two files of the shader directory.
#pragma once

#include <epoxy/gl.h>

#include <filesystem>
#include <glm/glm.hpp>
#include <string>

namespace limpid {

class ShaderProgram {
 public:
  // Reads DIR/VERTEX.vert and DIR/FRAGMENT.frag; DIR/common.glsl comes before both, after
  // `defines`, one "NAME VALUE" a line. Throws std::runtime_error naming file and line.
  ShaderProgram(const std::filesystem::path& directory, const std::string& vertex,
                const std::string& fragment, const std::string& defines = "");
  ~ShaderProgram() { glDeleteProgram(id_); }
  ShaderProgram(const ShaderProgram&) = delete;
  ShaderProgram& operator=(const ShaderProgram&) = delete;

  void use() const { glUseProgram(id_); }
  GLint at(const char* uniform) const { return glGetUniformLocation(id_, uniform); }
  void set(const char* uniform, float v) const { glUniform1f(at(uniform), v); }
  void set(const char* uniform, int v) const { glUniform1i(at(uniform), v); }
  void set(const char* uniform, const glm::vec2& v) const { glUniform2fv(at(uniform), 1, &v[0]); }
  void set(const char* uniform, const glm::vec4& v) const { glUniform4fv(at(uniform), 1, &v[0]); }
  void set(const char* uniform, const glm::mat4& v) const {
    glUniformMatrix4fv(at(uniform), 1, GL_FALSE, &v[0][0]);
  }

 private:
  GLuint id_;
};

}  // namespace limpid
