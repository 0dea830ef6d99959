#include "render/gl/offscreen.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <stb/stb_image_write.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <stdexcept>

#include "core/base/png_chunk.h"
#include "render/gl/gl_names.h"

namespace limpid {
namespace {

// Mesa's surfaceless platform needs neither a display server nor a device node. The core entry
// point eglGetPlatformDisplay aborts inside libepoxy, so the extension's is used.
EGLDisplay surfaceless_display() {
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base") ||
      !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
    throw std::runtime_error(
        "no offscreen picture: EGL has no surfaceless platform on this computer");
  return eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
}

struct Frame {
  GlFramebuffer framebuffer;
  GlRenderbuffer color, depth;

  void bind(int width, int height) const {
    glBindRenderbuffer(GL_RENDERBUFFER, color);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
    glBindRenderbuffer(GL_RENDERBUFFER, depth);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, width, height);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, depth);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw std::runtime_error("no offscreen picture: OpenGL refuses " + std::to_string(width) +
                               " x " + std::to_string(height) + " pixels");
    glViewport(0, 0, width, height);
  }
};

}  // namespace

struct OffscreenContext::Impl {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  std::optional<Frame> frame;

  ~Impl() {
    frame.reset();
    if (display == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    eglTerminate(display);
  }
};

OffscreenContext::OffscreenContext(int width, int height) : impl_(std::make_unique<Impl>()) {
  if (width < 1 || height < 1)
    throw std::runtime_error("no offscreen picture: its size must be at least 1 x 1");
  impl_->display = surfaceless_display();
  if (impl_->display == EGL_NO_DISPLAY || !eglInitialize(impl_->display, nullptr, nullptr))
    throw std::runtime_error("no offscreen picture: EGL does not start");
  const EGLint any[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  const EGLint core33[] = {EGL_CONTEXT_MAJOR_VERSION,
                           3,
                           EGL_CONTEXT_MINOR_VERSION,
                           3,
                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                           EGL_NONE};
  if (eglBindAPI(EGL_OPENGL_API) && eglChooseConfig(impl_->display, any, &config, 1, &count) &&
      count > 0)
    impl_->context = eglCreateContext(impl_->display, config, EGL_NO_CONTEXT, core33);
  if (impl_->context == EGL_NO_CONTEXT ||
      !eglMakeCurrent(impl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, impl_->context))
    throw std::runtime_error("no offscreen picture: EGL gives no OpenGL 3.3 core context");

  impl_->frame.emplace().bind(width, height);
}

OffscreenContext::~OffscreenContext() = default;

void fill(unsigned colour) {
  const auto part = [colour](int shift) {
    return static_cast<float>((colour >> shift) & 0xff) / 255.0f;
  };
  glClearColor(part(16), part(8), part(0), 1);
  glClear(GL_COLOR_BUFFER_BIT);
}

std::string renderer_name() {
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return name != nullptr ? name : "";
}

std::vector<unsigned char> read_rgba(int width, int height) {
  const std::size_t row = 4 * static_cast<std::size_t>(width);
  std::vector<unsigned char> rgba(row * static_cast<std::size_t>(height));
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  auto top = rgba.begin();
  auto bottom = rgba.end();
  const auto step = static_cast<std::ptrdiff_t>(row);
  for (int y = 0; y < height / 2; ++y, top += step) {
    bottom -= step;
    std::swap_ranges(top, top + step, bottom);
  }
  for (std::size_t i = 3; i < rgba.size(); i += 4) rgba[i] = 255;
  return rgba;
}

std::vector<unsigned char> drawn_rgba(int width, int height, const std::function<void()>& draw) {
  GLint before = 0, viewport[4] = {};
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &before);
  glGetIntegerv(GL_VIEWPORT, viewport);
  std::vector<unsigned char> rgba;
  {
    const Frame frame;
    frame.bind(width, height);
    draw();
    rgba = read_rgba(width, height);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(before));
  glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
  return rgba;
}

std::vector<unsigned char> png_of(int width, int height, const std::vector<unsigned char>& rgba,
                                  unsigned per_metre, const std::string& about) {
  if (width < 1 || height < 1 ||
      rgba.size() != 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    throw std::invalid_argument("the size of a picture does not match the number of its pixels");
  std::vector<unsigned char> png;
  const auto append = [](void* to, void* data, int size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    static_cast<std::vector<unsigned char>*>(to)->insert(
        static_cast<std::vector<unsigned char>*>(to)->end(), bytes, bytes + size);
  };
  if (stbi_write_png_to_func(append, &png, width, height, 4, rgba.data(), 4 * width) == 0)
    throw std::runtime_error("the picture cannot be written");
  std::string chunks = per_metre == 0 ? "" : png_density(per_metre);
  if (!about.empty()) chunks += png_description(about);
  png.insert(png.begin() + kPngHeader, chunks.begin(), chunks.end());
  return png;
}

void write_png(const std::filesystem::path& path, int width, int height,
               const std::vector<unsigned char>& rgba) {
  // The picture goes through memory: stb's own writing to files does not notice a full disk.
  const std::vector<unsigned char> png = png_of(width, height, rgba);
  errno = 0;
  std::FILE* file = std::fopen(path.string().c_str(), "wb");
  const bool whole = file != nullptr && std::fwrite(png.data(), 1, png.size(), file) == png.size();
  const bool closed = file != nullptr && std::fclose(file) == 0;
  if (!whole || !closed)
    throw std::runtime_error(path.string() +
                             ": the picture cannot be written: " + std::strerror(errno));
}

}  // namespace limpid
