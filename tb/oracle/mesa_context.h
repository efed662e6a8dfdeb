// SPDX-License-Identifier: MIT
// An OpenGL ES 3 context on one of Mesa's software rasterisers, without a window (EGL surfaceless),
// and programs that draw a full-target quad.
#pragma once

#include <memory>
#include <string>

namespace deburr::tb {

class MesaContext {
 public:
  // driver: "llvmpipe" or "softpipe". Null if EGL, the surfaceless platform or the driver is
  // missing; `why` then holds the reason. Mesa reads the driver's name and `accuracy` (llvmpipe's
  // shortcuts to disable, GALLIVM_PERF) once per process.
  static std::unique_ptr<MesaContext> open(const std::string& driver, const std::string& accuracy,
                                           std::string& why);
  ~MesaContext();
  MesaContext(const MesaContext&) = delete;
  MesaContext& operator=(const MesaContext&) = delete;

  std::string name() const;  // GL_RENDERER and GL_VERSION

 private:
  MesaContext() = default;
  // EGLDisplay and EGLContext as void*, so that this header does not include EGL's.
  void* display_ = nullptr;
  void* context_ = nullptr;
};

// A GL program. Throws SimulationError with Mesa's message if a shader does not compile.
unsigned int gl_program(const std::string& vertex_shader, const std::string& fragment_shader);

}  // namespace deburr::tb
