// SPDX-License-Identifier: MIT
#include "tb/oracle/mesa_device.h"

#include <GLES3/gl3.h>

#include <array>
#include <utility>

#include "spec/error.h"
#include "tb/oracle/mesa_context.h"

namespace deburr::tb::texture {
namespace {

constexpr GLenum kMaxAnisotropy = 0x84FE;  // GL_TEXTURE_MAX_ANISOTROPY_EXT

constexpr const char* kVertexShader = R"(#version 300 es
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
})";

constexpr const char* kFragmentShader = R"(#version 300 es
precision highp float;
precision highp sampler2D;
uniform sampler2D coordinates;
uniform sampler2D image;
out vec4 colour;
void main() {
  vec2 st = texelFetch(coordinates, ivec2(gl_FragCoord.xy), 0).xy;
  colour = texture(image, st);
})";

// A separate program: softpipe's anisotropic filter fails with any bias, even 0.
constexpr const char* kBiasedFragmentShader = R"(#version 300 es
precision highp float;
precision highp sampler2D;
uniform sampler2D coordinates;
uniform sampler2D image;
uniform float bias;
out vec4 colour;
void main() {
  vec2 st = texelFetch(coordinates, ivec2(gl_FragCoord.xy), 0).xy;
  colour = texture(image, st, bias);
})";

struct GlFormat {
  GLenum internal, format, type;
};

GlFormat gl_format(spec::texture::Format format) {
  switch (format) {
    case spec::texture::Format::kRgba8:
      return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
    case spec::texture::Format::kSrgb8A8:
      return {GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE};
    case spec::texture::Format::kRgb565:
      return {GL_RGB565, GL_RGB, GL_UNSIGNED_SHORT_5_6_5};
    case spec::texture::Format::kRgba4444:
      return {GL_RGBA4, GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4};
    case spec::texture::Format::kL8:
      return {GL_R8, GL_RED, GL_UNSIGNED_BYTE};
    default:
      break;  // has blocks
  }
  return {};
}

GLint gl_filter(spec::texture::MinFilter filter) {
  constexpr std::array<GLint, 6> kFilters = {GL_NEAREST,
                                             GL_LINEAR,
                                             GL_NEAREST_MIPMAP_NEAREST,
                                             GL_LINEAR_MIPMAP_NEAREST,
                                             GL_NEAREST_MIPMAP_LINEAR,
                                             GL_LINEAR_MIPMAP_LINEAR};
  return kFilters[static_cast<std::size_t>(filter)];
}

GLint gl_wrap(spec::texture::Wrap wrap) {
  constexpr std::array<GLint, 3> kWraps = {GL_REPEAT, GL_MIRRORED_REPEAT, GL_CLAMP_TO_EDGE};
  return kWraps[static_cast<std::size_t>(wrap)];
}

void upload(const EncodedTexture& texture) {
  const GlFormat gl = gl_format(texture.format);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  for (std::size_t k = 0; k < texture.levels.size(); ++k) {
    const EncodedLevel& level = texture.levels[k];
    std::vector<std::uint8_t> bytes;
    const int texel_bytes = spec::texture::kFormatBytes[static_cast<std::size_t>(texture.format)];
    for (const std::uint32_t code : level.codes)
      for (int b = 0; b < texel_bytes; ++b)
        bytes.push_back(static_cast<std::uint8_t>(code >> (8 * b) & 0xFFu));
    glTexImage2D(GL_TEXTURE_2D, static_cast<GLint>(k), static_cast<GLint>(gl.internal), level.width,
                 level.height, 0, gl.format, gl.type, bytes.data());
  }
  if (texture.format == spec::texture::Format::kL8) {
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_G, GL_RED);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_SWIZZLE_B, GL_RED);
  }
}

}  // namespace

struct MesaDevice::State {
  std::unique_ptr<MesaContext> context;
  GLuint program = 0, biased_program = 0, vertices = 0;
};

MesaDevice::MesaDevice() : state_(std::make_unique<State>()) {}
MesaDevice::~MesaDevice() = default;

std::unique_ptr<MesaDevice> MesaDevice::open(const std::string& driver, std::string& why) {
  // llvmpipe's default trades accuracy of the level of detail for speed.
  auto context = MesaContext::open(driver, "no_brilinear,no_rho_approx,no_quad_lod", why);
  if (context == nullptr) return nullptr;
  std::unique_ptr<MesaDevice> device(new MesaDevice);
  State& s = *device->state_;
  s.context = std::move(context);
  s.program = gl_program(kVertexShader, kFragmentShader);
  s.biased_program = gl_program(kVertexShader, kBiasedFragmentShader);
  glGenVertexArrays(1, &s.vertices);
  return device;
}

std::string MesaDevice::name() const { return state_->context->name(); }

Pixels MesaDevice::draw(const CoordinateImage& image, const EncodedTexture& texture,
                        const spec::texture::Descriptor& state) {
  std::array<GLuint, 3> textures{};
  glGenTextures(3, textures.data());

  // Coordinates: one pair of floats per pixel. Row 0 of the image is row 0 of the target.
  std::vector<float> coordinates;
  for (std::size_t i = 0; i < image.s.size(); ++i) {
    coordinates.push_back(static_cast<float>(image.s[i]) * 0x1p-24f);
    coordinates.push_back(static_cast<float>(image.t[i]) * 0x1p-24f);
  }
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, textures[0]);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RG32F, image.width, image.height, 0, GL_RG, GL_FLOAT,
               coordinates.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);

  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, textures[1]);
  upload(texture);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, gl_filter(state.min_filter));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER,
                  state.mag_filter == spec::texture::MagFilter::kLinear ? GL_LINEAR : GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, gl_wrap(state.wrap_s));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, gl_wrap(state.wrap_t));
  glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_MIN_LOD, static_cast<float>(state.min_lod) / 256.0f);
  glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_MAX_LOD, static_cast<float>(state.max_lod) / 256.0f);
  if (state.max_anisotropy_log2 > 0)
    glTexParameterf(GL_TEXTURE_2D, kMaxAnisotropy,
                    static_cast<float>(1 << state.max_anisotropy_log2));

  glActiveTexture(GL_TEXTURE2);
  glBindTexture(GL_TEXTURE_2D, textures[2]);
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, image.width, image.height);
  GLuint target = 0;
  glGenFramebuffers(1, &target);
  glBindFramebuffer(GL_FRAMEBUFFER, target);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, textures[2], 0);
  glBindTexture(GL_TEXTURE_2D, 0);

  glDisable(GL_DITHER);
  glViewport(0, 0, image.width, image.height);
  const GLuint program = state.lod_bias == 0 ? state_->program : state_->biased_program;
  glUseProgram(program);
  glUniform1i(glGetUniformLocation(program, "coordinates"), 0);
  glUniform1i(glGetUniformLocation(program, "image"), 1);
  glUniform1f(glGetUniformLocation(program, "bias"), static_cast<float>(state.lod_bias) / 256.0f);
  glBindVertexArray(state_->vertices);
  glDrawArrays(GL_TRIANGLES, 0, 3);

  Pixels pixels(image.s.size());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  const GLenum error = glGetError();
  glDeleteFramebuffers(1, &target);
  glDeleteTextures(3, textures.data());
  if (error != GL_NO_ERROR)
    throw spec::SimulationError("Mesa reports GL error " + std::to_string(error) +
                                " while drawing a " + std::to_string(texture.width()) + " x " +
                                std::to_string(texture.height()) + " texture");
  return pixels;
}

}  // namespace deburr::tb::texture
