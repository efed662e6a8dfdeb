// SPDX-License-Identifier: MIT
// The decoder of blocks equals Mesa's softpipe, to the bit: BC with bc = truncated, and ETC2 with
// its modes drawn evenly. Skipped if Mesa is absent. llvmpipe is no oracle: a tenth of its BC
// texels is off by 1.
#include <GLES3/gl3.h>
#include <gmock/gmock.h>

#include <cstdio>

#include "tb/oracle/blocks.h"
#include "tb/oracle/mesa_context.h"

namespace deburr::tb::texture::mesa_blocks_test {
namespace {

using spec::texture::BlockRule;
using spec::texture::Format;

constexpr const char* kVertexShader = R"(#version 300 es
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
})";
constexpr const char* kFragmentShader = R"(#version 300 es
precision highp float;
precision highp sampler2D;
uniform sampler2D image;
out vec4 colour;
void main() { colour = texelFetch(image, ivec2(gl_FragCoord.xy), 0); })";

// GL_COMPRESSED_RGBA_S3TC_DXT1_EXT and so on, of the header of extensions.
constexpr GLenum gl_format(Format format) {
  switch (format) {
    case Format::kBc1:
      return 0x83F1;
    case Format::kBc3:
      return 0x83F3;
    case Format::kBc4:
      return 0x8DBB;
    case Format::kBc5:
      return 0x8DBD;
    case Format::kEtc2Rgb:
      return GL_COMPRESSED_RGB8_ETC2;
    case Format::kEtc2RgbA1:
      return GL_COMPRESSED_RGB8_PUNCHTHROUGH_ALPHA1_ETC2;
    default:
      return GL_COMPRESSED_RGBA8_ETC2_EAC;
  }
}

class SoftpipeBlocks : public testing::TestWithParam<Format> {
 protected:
  void SetUp() override {
    std::string why;
    context_ = MesaContext::open("softpipe", "", why);
    if (context_ == nullptr) GTEST_SKIP() << "Mesa is absent: " << why;
  }

  static std::vector<std::uint8_t> decompress(const BlockPicture& picture) {
    const auto side = static_cast<GLsizei>(picture.texels_per_side());
    std::array<GLuint, 2> textures{};
    glGenTextures(2, textures.data());
    glBindTexture(GL_TEXTURE_2D, textures[1]);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, side, side);
    GLuint target = 0, vertices = 0;
    glGenFramebuffers(1, &target);
    glBindFramebuffer(GL_FRAMEBUFFER, target);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, textures[1], 0);
    glBindTexture(GL_TEXTURE_2D, textures[0]);
    glCompressedTexImage2D(GL_TEXTURE_2D, 0, gl_format(picture.format), side, side, 0,
                           static_cast<GLsizei>(picture.blocks.size()), picture.blocks.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glDisable(GL_DITHER);
    glViewport(0, 0, side, side);
    glUseProgram(gl_program(kVertexShader, kFragmentShader));
    glGenVertexArrays(1, &vertices);
    glBindVertexArray(vertices);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    std::vector<std::uint8_t> texels(picture.texels_per_side() * picture.texels_per_side() * 4);
    glReadPixels(0, 0, side, side, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    return texels;
  }

  std::unique_ptr<MesaContext> context_;
};

TEST_P(SoftpipeBlocks, AllModesDecodeEqually) {
  const BlockPicture picture(GetParam(), 256, 1);
  std::vector<std::uint64_t> blocks(picture.modes());
  for (std::size_t i = 0; i < picture.side * picture.side; ++i) ++blocks[picture.mode(i)];
  EXPECT_THAT(blocks, testing::Each(testing::Ge(8192u)));
  const auto texels = decompress(picture);
  EXPECT_THAT(wrong_texels(picture, BlockRule::kTruncated, texels, 4), testing::Each(0u));
}

TEST_P(SoftpipeBlocks, SwappedSelectorsAreFound) {
  const BlockPicture picture(GetParam(), 16, 1);
  EXPECT_THAT(
      wrong_texels(picture, BlockRule::kTruncated, decompress(picture), 4, swapped_selectors),
      testing::Each(testing::Gt(0u)));
}

INSTANTIATE_TEST_SUITE_P(Blocks, SoftpipeBlocks,
                         testing::Values(Format::kBc1, Format::kBc3, Format::kBc4, Format::kBc5,
                                         Format::kEtc2Rgb, Format::kEtc2RgbA1, Format::kEtc2Rgba8),
                         [](const auto& suite) { return std::string(format_name(suite.param)); });

}  // namespace
}  // namespace deburr::tb::texture::mesa_blocks_test
