// SPDX-License-Identifier: MIT
#include "tb/oracle/smaa_shader.h"

#include <GLES3/gl3.h>

#include <cstddef>

#include "spec/error.h"
#include "tb/oracle/smaa_files.h"

namespace deburr::tb {
namespace {

// Rows of textures and targets count from the top, as in the published shader: row 0 has texture
// coordinate 0 and is read back first.
constexpr const char* kEdgesVertex = R"(
out vec2 at;
out vec4 around[3];
void main() {
  at = vec2(gl_VertexID == 1 ? 2.0 : 0.0, gl_VertexID == 2 ? 2.0 : 0.0);
  SMAAEdgeDetectionVS(at, around);
  gl_Position = vec4(2.0 * at - 1.0, 0.0, 1.0);
})";
constexpr const char* kEdgesFragment = R"(
uniform sampler2D image;
in vec2 at;
in vec4 around[3];
out vec4 result;
void main() { result = vec4(DETECTION(at, around, image), 0.0, 0.0); })";
constexpr const char* kWeightsVertex = R"(
out vec2 at;
out vec2 pixel;
out vec4 around[3];
void main() {
  at = vec2(gl_VertexID == 1 ? 2.0 : 0.0, gl_VertexID == 2 ? 2.0 : 0.0);
  SMAABlendingWeightCalculationVS(at, pixel, around);
  gl_Position = vec4(2.0 * at - 1.0, 0.0, 1.0);
})";
constexpr const char* kWeightsFragment = R"(
uniform sampler2D image;
uniform sampler2D areas;
uniform sampler2D searches;
uniform float area_row;
in vec2 at;
in vec2 pixel;
in vec4 around[3];
out vec4 result;
void main() {
  result = SMAABlendingWeightCalculationPS(at, pixel, around, image, areas, searches,
                                           vec4(area_row));
})";

std::string with_changes(std::string text, const SmaaShaderRun& run) {
  for (const auto& [from, to] : run.changes) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) reject_smaa_file(smaa_file("SMAA.hlsl"), "has no '" + from + "'");
    text.replace(at, from.size(), to);
  }
  return text;
}

GLuint smaa_program(const std::string& text, const SmaaShaderRun& run, const char* vertex,
                    const char* fragment) {
  const std::string published = with_changes(text, run);
  const auto shader = [&](const char* without, const char* main) {
    return std::string("#version 300 es\nprecision highp float;\nprecision highp int;\n") +
           "precision highp sampler2D;\n#define SMAA_GLSL_3\n#define SMAA_PRESET_" + run.preset +
           "\n#define SMAA_INCLUDE_" + without + " 0\n#define DETECTION SMAA" +
           (run.colour ? "Color" : "Luma") +
           "EdgeDetectionPS\nuniform vec4 metrics;\n#define SMAA_RT_METRICS metrics\n" + published +
           main;
  };
  return gl_program(shader("PS", vertex), shader("VS", fragment));
}

struct TexelFormat {
  GLenum internal, format;
};

// Bound to texture unit `unit`.
GLuint texture_of(GLenum unit, TexelFormat texels, int width, int height, const void* bytes,
                  GLint filter, GLint wrap) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D, texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(texels.internal), width, height, 0,
               texels.format, GL_UNSIGNED_BYTE, bytes);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
  return texture;
}

// Clears a target of the size of `result`, draws over it, and reads it back.
template <class Texel>
void draw_over(GLuint program, GLenum internal, GLenum format, GLenum type,
               ImageOf<Texel>& result) {
  GLuint texture = 0, target = 0, vertices = 0;
  glGenTextures(1, &texture);
  glActiveTexture(GL_TEXTURE7);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexStorage2D(GL_TEXTURE_2D, 1, internal, result.width, result.height);
  glGenFramebuffers(1, &target);
  glBindFramebuffer(GL_FRAMEBUFFER, target);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
  glDisable(GL_DITHER);
  glViewport(0, 0, result.width, result.height);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);

  glUseProgram(program);
  const auto width = static_cast<float>(result.width), height = static_cast<float>(result.height);
  glUniform4f(glGetUniformLocation(program, "metrics"), 1 / width, 1 / height, width, height);
  glUniform1i(glGetUniformLocation(program, "image"), 0);
  glUniform1i(glGetUniformLocation(program, "areas"), 1);
  glUniform1i(glGetUniformLocation(program, "searches"), 2);
  glGenVertexArrays(1, &vertices);
  glBindVertexArray(vertices);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, result.width, result.height, format, type, result.pixels.data());

  glDeleteVertexArrays(1, &vertices);
  glDeleteFramebuffers(1, &target);
  glDeleteTextures(1, &texture);
  glDeleteProgram(program);
  if (const GLenum error = glGetError(); error != GL_NO_ERROR)
    throw spec::SimulationError("Mesa reports GL error " + std::to_string(error) +
                                " while drawing " + std::to_string(result.width) + " x " +
                                std::to_string(result.height) + " pixels");
}

}  // namespace

std::unique_ptr<SmaaShader> SmaaShader::open(std::string& why) {
  // llvmpipe filters 8-bit textures with 8-bit results unless this is disabled.
  auto context = MesaContext::open("llvmpipe", "no_aos_sampling,no_brilinear", why);
  if (context == nullptr) return nullptr;
  const std::string extensions = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
  if (extensions.find("GL_EXT_color_buffer_float") == std::string::npos) {
    why = "Mesa cannot render to float textures: install libegl1 and libgl1-mesa-dri of Debian 12";
    return nullptr;
  }
  std::unique_ptr<SmaaShader> shader(new SmaaShader);
  shader->context_ = std::move(context);
  shader->text_ = smaa_text(smaa_file("SMAA.hlsl"));
  shader->areas_ = smaa_bytes(smaa_file("AreaTex.h"), kSmaaAreaBytes);
  shader->searches_ = smaa_bytes(smaa_file("SearchTex.h"), kSmaaSearchBytes);
  return shader;
}

SmaaShader::~SmaaShader() = default;

SmaaEdgeImage SmaaShader::edges(const Image& image, const SmaaShaderRun& run) {
  const GLuint program = smaa_program(text_, run, kEdgesVertex, kEdgesFragment);
  const GLuint texture = texture_of(0, {GL_RGBA8, GL_RGBA}, image.width, image.height,
                                    image.pixels.data(), GL_NEAREST, GL_CLAMP_TO_EDGE);
  ImageOf<Rgba8> found(image.width, image.height);
  draw_over(program, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, found);
  glDeleteTextures(1, &texture);
  SmaaEdgeImage edges(image.width, image.height);
  for (std::size_t i = 0; i < found.pixels.size(); ++i)
    edges.pixels[i] = {found.pixels[i][0], found.pixels[i][1]};
  return edges;
}

SmaaWeightImage SmaaShader::weights(const SmaaEdgeImage& edges, const SmaaShaderRun& run) {
  const GLuint program = smaa_program(text_, run, kWeightsVertex, kWeightsFragment);
  const std::array<GLuint, 3> textures = {
      texture_of(0, {GL_RG8, GL_RG}, edges.width, edges.height, edges.pixels.data(), GL_LINEAR,
                 run.repeats ? GL_REPEAT : GL_CLAMP_TO_EDGE),
      texture_of(1, {GL_RG8, GL_RG}, kSmaaAreaWidth, kSmaaAreaHeight, areas_.data(), GL_LINEAR,
                 GL_CLAMP_TO_EDGE),
      texture_of(2, {GL_R8, GL_RED}, kSmaaSearchWidth, kSmaaSearchHeight, searches_.data(),
                 GL_LINEAR, GL_CLAMP_TO_EDGE)};
  glUseProgram(program);
  glUniform1f(glGetUniformLocation(program, "area_row"), static_cast<float>(run.area_row));
  SmaaWeightImage weights(edges.width, edges.height);
  draw_over(program, GL_RGBA32F, GL_RGBA, GL_FLOAT, weights);
  glDeleteTextures(3, textures.data());
  return weights;
}

}  // namespace deburr::tb
