// SPDX-License-Identifier: MIT
// An OpenGL ES 3 context of one of Mesa's software rasterisers, without a window (EGL surfaceless),
// and programs that draw over a whole target.
#pragma once

#include <memory>
#include <string>

namespace deburr::tb {

class MesaContext {
 public:
  // driver: "llvmpipe" or "softpipe". Null where EGL, the surfaceless platform or the driver is
  // missing; `why` then says what. Mesa reads the driver's name and `accuracy`, what of llvmpipe's
  // arithmetic is not made faster (GALLIVM_PERF), once a process.
  static std::unique_ptr<MesaContext> open(const std::string& driver, const std::string& accuracy,
                                           std::string& why);
  ~MesaContext();
  MesaContext(const MesaContext&) = delete;
  MesaContext& operator=(const MesaContext&) = delete;

  std::string name() const;  // GL_RENDERER and GL_VERSION

 private:
  MesaContext() = default;
  // EGLDisplay and EGLContext: this header is read without EGL's.
  void* display_ = nullptr;
  void* context_ = nullptr;
};

// A GL program. Throws SimulationError with Mesa's words for text that it rejects.
unsigned int gl_program(const std::string& vertex_shader, const std::string& fragment_shader);

}  // namespace deburr::tb
