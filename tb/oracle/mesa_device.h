// SPDX-License-Identifier: MIT
// Mesa's software rasterisers as texture filters: OpenGL ES 3 without a window (EGL surfaceless).
//
// A scene covers the whole target; each pixel fetches its coordinate from a float texture and
// samples the texture under test with implicit derivatives, so that Mesa and the unit under test
// see the same coordinates in the same 2 x 2 quads.
#pragma once

#include <memory>
#include <string>

#include "tb/oracle/conformance.h"
#include "tb/oracle/plane.h"

namespace deburr::tb::texture {

class MesaDevice {
 public:
  // driver: "llvmpipe" or "softpipe". Null if EGL, the surfaceless platform or the driver is
  // missing; `why` then holds the reason. Mesa reads the driver's name once per process.
  static std::unique_ptr<MesaDevice> open(const std::string& driver, std::string& why);
  ~MesaDevice();
  MesaDevice(const MesaDevice&) = delete;
  MesaDevice& operator=(const MesaDevice&) = delete;

  // Filters every pixel of `image` with the descriptor's sampler state; N_max is passed on as
  // GL_TEXTURE_MAX_ANISOTROPY.
  Pixels draw(const CoordinateImage& image, const EncodedTexture& texture,
              const spec::texture::Descriptor& state);

  std::string name() const;  // GL_RENDERER and GL_VERSION

 private:
  MesaDevice();
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deburr::tb::texture
