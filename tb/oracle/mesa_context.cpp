// SPDX-License-Identifier: MIT
#include "tb/oracle/mesa_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>

#include <array>
#include <cstdlib>

#include "spec/error.h"

namespace deburr::tb {
namespace {

std::string log_of(GLuint object, decltype(&glGetShaderInfoLog) read) {
  std::array<char, 1024> log{};
  read(object, static_cast<GLsizei>(log.size()), nullptr, log.data());
  return log.data();
}

GLuint compile(GLenum kind, const std::string& source) {
  const GLuint shader = glCreateShader(kind);
  const char* const text = source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint ok = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok == 0)
    throw spec::SimulationError("Mesa rejected a shader: " + log_of(shader, glGetShaderInfoLog));
  return shader;
}

}  // namespace

unsigned int gl_program(const std::string& vertex_shader, const std::string& fragment_shader) {
  const GLuint program = glCreateProgram();
  for (const GLuint shader :
       {compile(GL_VERTEX_SHADER, vertex_shader), compile(GL_FRAGMENT_SHADER, fragment_shader)}) {
    glAttachShader(program, shader);
    glDeleteShader(shader);  // deleted with the program
  }
  glLinkProgram(program);
  GLint ok = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok == 0)
    throw spec::SimulationError("Mesa rejected a program: " + log_of(program, glGetProgramInfoLog));
  return program;
}

std::unique_ptr<MesaContext> MesaContext::open(const std::string& driver,
                                               const std::string& accuracy, std::string& why) {
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  setenv("GALLIUM_DRIVER", driver.c_str(), 1);
  setenv("GALLIVM_PERF", accuracy.c_str(), 1);
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (extensions == nullptr ||
      std::string(extensions).find("EGL_MESA_platform_surfaceless") == std::string::npos) {
    why = "EGL has no surfaceless platform: install libegl1 and libgl1-mesa-dri";
    return nullptr;
  }
  const auto get_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      eglGetProcAddress("eglGetPlatformDisplayEXT"));
  std::unique_ptr<MesaContext> context(new MesaContext);
  EGLDisplay display = get_display == nullptr ? EGL_NO_DISPLAY
                                              : get_display(EGL_PLATFORM_SURFACELESS_MESA,
                                                            EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE) {
    why = "EGL found no software device: install libgl1-mesa-dri";
    return nullptr;
  }
  context->display_ = display;
  eglBindAPI(EGL_OPENGL_ES_API);
  constexpr std::array<EGLint, 3> kVersion = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
  context->context_ = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, kVersion.data());
  if (context->context_ == EGL_NO_CONTEXT ||
      eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context->context_) == EGL_FALSE) {
    why = "EGL did not create an OpenGL ES 3 context";
    return nullptr;
  }
  if (context->name().find(driver) == std::string::npos) {
    why = "Mesa offers " + context->name() + " instead of " + driver;
    return nullptr;
  }
  return context;
}

MesaContext::~MesaContext() {
  if (display_ == EGL_NO_DISPLAY) return;
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  // The display is kept: terminating it unloads Mesa's driver, which leaks memory.
  if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
}

std::string MesaContext::name() const {
  const auto text = [](GLenum what) {
    return std::string(reinterpret_cast<const char*>(glGetString(what)));
  };
  return text(GL_RENDERER) + ", " + text(GL_VERSION);
}

}  // namespace deburr::tb
