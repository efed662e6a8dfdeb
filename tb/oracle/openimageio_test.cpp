// SPDX-License-Identifier: MIT
// Compares the golden model with OpenImageIO's texture system without mip levels: its closest and
// bilinear lookups use the same texel and wrap conventions. Its trilinear blend differs from GL
// (the fraction between two levels is not logarithmic), so mip modes are left to Mesa and the
// criterion. Its decoder of DDS files equals bc = rounded, to the bit.
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/texture.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "tb/oracle/blocks.h"
#include "tb/oracle/conformance.h"

namespace deburr::tb::texture::openimageio_test {
namespace {

class OpenImageIo : public testing::Test {
 protected:
  ~OpenImageIo() override {
    for (const std::string& file : files_) std::remove(file.c_str());
  }

  std::string write(const EncodedTexture& texture) {
    static int count = 0;  // the texture system caches files by name
    const std::string name = testing::TempDir() + "deburr_oracle_" + std::to_string(getpid()) +
                             "_" + std::to_string(count++) + ".tif";
    const OIIO::ImageSpec spec(texture.width(), texture.height(), 4, OIIO::TypeDesc::UINT8);
    const auto output = OIIO::ImageOutput::create(name);
    EXPECT_TRUE(output && output->open(name, spec) &&
                output->write_image(OIIO::TypeDesc::UINT8,
                                    rgba_bytes(texture.format, texture.levels.front()).data()) &&
                output->close());
    files_.push_back(name);
    return name;
  }

  // Writes the blocks as a DDS file and reads it. A file that it cannot read has no texels.
  std::vector<std::uint8_t> decompress(const BlockPicture& picture) {
    using spec::texture::Format;
    const std::string code = picture.format == Format::kBc1   ? "DXT1"
                             : picture.format == Format::kBc3 ? "DXT5"
                             : picture.format == Format::kBc4 ? "BC4U"
                                                              : "BC5U";
    const auto side = static_cast<std::uint32_t>(picture.texels_per_side());
    std::array<std::uint32_t, 32> header{0x20534444, 124, 0x81007, side, side};  // "DDS "
    header[5] = static_cast<std::uint32_t>(picture.blocks.size());
    header[19] = 32;
    header[20] = 4;
    std::copy(code.begin(), code.end(), reinterpret_cast<char*>(&header[21]));
    header[27] = 0x1000;
    const std::string name = testing::TempDir() + "deburr_blocks_" + std::to_string(getpid()) +
                             "_" + std::to_string(files_.size()) + ".dds";
    std::ofstream(name, std::ios::binary)
        .write(reinterpret_cast<const char*>(header.data()), sizeof header)
        .write(reinterpret_cast<const char*>(picture.blocks.data()),
               static_cast<std::streamsize>(picture.blocks.size()));
    files_.push_back(name);
    const auto input = OIIO::ImageInput::open(name);
    EXPECT_TRUE(input) << OIIO::geterror();
    if (!input) return {};
    channels_ = static_cast<std::size_t>(input->spec().nchannels);
    std::vector<std::uint8_t> texels(picture.texels_per_side() * picture.texels_per_side() *
                                     channels_);
    EXPECT_TRUE(input->read_image(0, 0, 0, -1, OIIO::TypeDesc::UINT8, texels.data()));
    return texels;
  }

  // Fraction of lanes whose four channels agree within one step.
  double agreement(spec::texture::MinFilter filter, spec::texture::Wrap oiio_wrap_shift) {
    constexpr std::array<OIIO::TextureOpt::Wrap, 3> kWraps = {
        OIIO::TextureOpt::WrapPeriodic, OIIO::TextureOpt::WrapMirror, OIIO::TextureOpt::WrapClamp};
    // The shared instance: destroying a private one deletes it with the wrong type (version 2.4).
    OIIO::TextureSystem* const system = OIIO::TextureSystem::create(true);
    double within = 0.0;
    double count = 0.0;
    std::uint32_t seed = 1;
    for (const Size& size : kFilteringSizes) {
      for (std::size_t wrap = 0; wrap < 3; ++wrap, ++seed) {
        // Alpha is never 0, so the result does not depend on how associated alpha is handled.
        const EncodedTexture texture = make_texture(Pattern::kNoise, spec::texture::Format::kRgb565,
                                                    size.width, size.height, seed);
        const OIIO::ustring file(write(texture));
        spec::texture::Descriptor state;
        state.format = texture.format;
        state.min_filter = filter;
        state.mag_filter = filter == spec::texture::MinFilter::kNearest
                               ? spec::texture::MagFilter::kNearest
                               : spec::texture::MagFilter::kLinear;
        state.wrap_s = state.wrap_t = static_cast<spec::texture::Wrap>(wrap);
        OIIO::TextureOpt options;
        options.mipmode = OIIO::TextureOpt::MipModeNoMIP;
        options.interpmode = filter == spec::texture::MinFilter::kNearest
                                 ? OIIO::TextureOpt::InterpClosest
                                 : OIIO::TextureOpt::InterpBilinear;
        options.swrap = options.twrap =
            kWraps[(wrap + static_cast<std::size_t>(oiio_wrap_shift)) % 3];
        const QuadFilter unit = golden_filter({})(texture, state);
        for (const spec::texture::Quad& quad : filtering_quads(size, 256, seed)) {
          const auto colours = unit(quad);
          for (std::size_t lane = 0; lane < 4; ++lane) {
            const golden::ideal::Fragment f = fragment_of(quad, static_cast<int>(lane));
            std::array<float, 4> theirs{};
            const bool found = system->texture(
                file, options, static_cast<float>(f.s), static_cast<float>(f.t),
                static_cast<float>(f.ds_dx), static_cast<float>(f.dt_dx),
                static_cast<float>(f.ds_dy), static_cast<float>(f.dt_dy), 4, theirs.data());
            EXPECT_TRUE(found) << system->geterror();
            double largest = 0.0;
            for (std::size_t c = 0; c < 4; ++c)
              largest = std::max(
                  largest, std::abs(255.0 * static_cast<double>(theirs[c]) - colours[lane][c]));
            within += largest <= 1.0;
            count += 1.0;
          }
        }
      }
    }
    return within / count;
  }

  std::size_t channels_ = 0;  // of the latest file of blocks

 private:
  std::vector<std::string> files_;
};

TEST_F(OpenImageIo, ClosestAndBilinearAgreeWithinOneStep) {
  const double nearest =
      agreement(spec::texture::MinFilter::kNearest, spec::texture::Wrap::kRepeat);
  const double linear = agreement(spec::texture::MinFilter::kLinear, spec::texture::Wrap::kRepeat);
  std::printf("OpenImageIO %s: closest %.4f %%, bilinear %.4f %% within 1\n", OIIO_VERSION_STRING,
              100.0 * nearest, 100.0 * linear);
  EXPECT_GE(nearest, 0.98);
  EXPECT_GE(linear, 0.98);
}

TEST_F(OpenImageIo, WrongWrapIsDetected) {
  EXPECT_LT(agreement(spec::texture::MinFilter::kLinear, spec::texture::Wrap::kMirroredRepeat),
            0.9);
}

class OpenImageIoBlocks : public OpenImageIo,
                          public testing::WithParamInterface<spec::texture::Format> {};

TEST_P(OpenImageIoBlocks, DecodesAMillionBlocksEqually) {
  const BlockPicture picture(GetParam(), 1000, 1);
  const auto texels = decompress(picture);
  ASSERT_FALSE(texels.empty());
  EXPECT_THAT(wrong_texels(picture, spec::texture::BlockRule::kRounded, texels, channels_),
              testing::Each(0u));
}

TEST_P(OpenImageIoBlocks, FindsTheOtherRoundingAndSwappedSelectors) {
  using spec::texture::BlockRule;
  const BlockPicture picture(GetParam(), 16, 1);
  const auto texels = decompress(picture);
  ASSERT_FALSE(texels.empty());
  EXPECT_THAT(wrong_texels(picture, BlockRule::kTruncated, texels, channels_),
              testing::Each(testing::Gt(0u)));
  EXPECT_THAT(wrong_texels(picture, BlockRule::kRounded, texels, channels_, swapped_selectors),
              testing::Each(testing::Gt(0u)));
}

INSTANTIATE_TEST_SUITE_P(Bc, OpenImageIoBlocks,
                         testing::Values(spec::texture::Format::kBc1, spec::texture::Format::kBc3,
                                         spec::texture::Format::kBc4, spec::texture::Format::kBc5),
                         [](const auto& suite) { return std::string(format_name(suite.param)); });

}  // namespace
}  // namespace deburr::tb::texture::openimageio_test
