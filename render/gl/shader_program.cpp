#include "render/gl/shader_program.h"

#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace limpid {
namespace {

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf()))
    throw std::runtime_error(path.string() + ": the shader cannot be read");
  return text.str();
}

// Drivers write "1:12(5): error: ..." (Mesa) or "1(12) : error ..." (NVIDIA): source, then line.
std::string readable(const std::string& log, const std::filesystem::path& own,
                     const std::filesystem::path& common) {
  std::smatch found;
  if (!std::regex_search(log, found, std::regex(R"((\d+)[:(](\d+)[^\n]*)")))
    return own.string() + ": " + log.substr(0, log.find('\n'));
  const auto& file = found[1] == "1" ? common : own;
  return file.string() + ":" + found[2].str() + ": " + found[0].str();
}

GLuint compile(GLenum kind, const std::filesystem::path& path, const std::string& defines) {
  const auto common_path = path.parent_path() / "common.glsl";
  std::string head = "#version 330 core\n";
  std::istringstream lines(defines);
  for (std::string line; std::getline(lines, line);) head += "#define " + line + "\n";
  const std::string common = "#line 1 1\n" + read_text(common_path);
  const std::string own = "\n#line 1 0\n" + read_text(path);
  const char* sources[] = {head.c_str(), common.c_str(), own.c_str()};
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 3, sources, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good) return shader;
  std::vector<char> log(4096, '\0');
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()) - 1, nullptr, log.data());
  glDeleteShader(shader);
  throw std::runtime_error(readable(log.data(), path, common_path));
}

}  // namespace

ShaderProgram::ShaderProgram(const std::filesystem::path& directory, const std::string& vertex,
                             const std::string& fragment, const std::string& defines)
    : id_(0) {
  const auto fragment_path = directory / (fragment + ".frag");
  const GLuint first = compile(GL_VERTEX_SHADER, directory / (vertex + ".vert"), defines);
  GLuint second = 0;
  try {
    second = compile(GL_FRAGMENT_SHADER, fragment_path, defines);
  } catch (...) {
    glDeleteShader(first);
    throw;
  }
  id_ = glCreateProgram();
  glAttachShader(id_, first);
  glAttachShader(id_, second);
  glLinkProgram(id_);
  glDeleteShader(first);
  glDeleteShader(second);
  GLint good = 0;
  glGetProgramiv(id_, GL_LINK_STATUS, &good);
  if (!good) {
    std::vector<char> log(4096, '\0');
    glGetProgramInfoLog(id_, static_cast<GLsizei>(log.size()) - 1, nullptr, log.data());
    glDeleteProgram(id_);
    throw std::runtime_error(fragment_path.string() + ": does not link with " + vertex +
                             ".vert: " + log.data());
  }
  const GLuint block = glGetUniformBlockIndex(id_, "Frame");
  if (block != GL_INVALID_INDEX) glUniformBlockBinding(id_, block, 0);
}

}  // namespace limpid
