// SPDX-License-Identifier: MIT
// DDS and KTX files of blocks: levels as in the file, pictures by the golden decoder, and an error
// that says what to do for each file that cannot be read.
#include "tb/scene/compressed_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tb/scene/block_encoder.h"
#include "tb/scene/image_io.h"
#include "tb/scene/textures.h"
#include "tb/stimuli/compressed_files.h"
#include "tb/unit/scene/fixtures.h"

namespace deburr::tb::compressed_file_test {
namespace {

using spec::texture::Format;
using stimuli::dds_file;
using stimuli::ktx1_file;
using stimuli::ktx2_file;
using test::file_error;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::string error_of(const std::string& bytes) {
  return file_error([&] { read_compressed("a.file", bytes); });
}
std::string with_word(std::string bytes, std::size_t at, std::uint32_t word) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(word >> (8 * i));
  return bytes;
}

const CompressedTexture kBrick = stimuli::compressed(make_texture("brick", 20, 9), Format::kBc1, 3);

void expect_equal(const CompressedTexture& read, const CompressedTexture& written) {
  EXPECT_EQ(read.format, written.format);
  ASSERT_EQ(read.levels.size(), written.levels.size());
  for (std::size_t k = 0; k < read.levels.size(); ++k) {
    EXPECT_EQ(read.levels[k].width, written.levels[k].width);
    EXPECT_EQ(read.levels[k].height, written.levels[k].height);
    EXPECT_EQ(read.levels[k].blocks, written.levels[k].blocks);
  }
}

TEST(CompressedFile, LevelsAreReadAsWritten) {
  const Image image = make_texture("stones", 20, 9);
  for (const Format format : {Format::kBc1, Format::kBc3, Format::kBc4, Format::kBc5,
                              Format::kEtc2Rgb, Format::kEtc2RgbA1, Format::kEtc2Rgba8})
    for (const bool srgb : {false, true}) {
      if (srgb && !spec::texture::may_be_srgb(format)) continue;
      for (const std::size_t levels : {1u, 3u, 5u}) {
        CompressedTexture texture = stimuli::compressed(image, format, levels);
        texture.srgb = srgb;
        std::vector<std::string> files = {ktx1_file(texture), ktx1_file(texture, true),
                                          ktx2_file(texture)};
        if (format < Format::kEtc2Rgb) files.push_back(dds_file(texture));
        for (const std::string& bytes : files) {
          EXPECT_TRUE(
              is_compressed_file(std::string_view(bytes).substr(0, kCompressedHeaderBytes)));
          const CompressedTexture read = read_compressed("a", bytes);
          expect_equal(read, texture);
          EXPECT_EQ(read.srgb, srgb);
        }
      }
    }
}

TEST(CompressedFile, OldCodesOfDdsAreRead) {
  for (const auto& [code, format] :
       {std::pair("DXT1", Format::kBc1), std::pair("DXT5", Format::kBc3),
        std::pair("ATI1", Format::kBc4), std::pair("BC4U", Format::kBc4),
        std::pair("ATI2", Format::kBc5), std::pair("BC5U", Format::kBc5)}) {
    const CompressedTexture texture = stimuli::compressed(make_texture("road", 8, 8), format, 2);
    expect_equal(read_compressed(code, dds_file(texture, code)), texture);
  }
}

TEST(CompressedFile, EveryReaderOfPicturesDecodesLevel0) {
  const test::TemporaryFolder folder;
  const Image image = decoded(kBrick.levels[0], kBrick.format);
  EXPECT_EQ(image.width, 20);
  EXPECT_EQ(image.height, 9);
  for (const auto& [name, bytes] :
       {std::pair("a.dds", dds_file(kBrick)), std::pair("a.ktx", ktx1_file(kBrick)),
        std::pair("a.ktx2", ktx2_file(kBrick)),
        std::pair("without_extension", ktx2_file(kBrick))}) {
    ReadReport report;
    EXPECT_EQ(read_image(folder.write(name, bytes), &report), image) << name;
    ASSERT_TRUE(report.compressed);
    expect_equal(*report.compressed, kBrick);
    report = {};
    EXPECT_EQ(read_image_memory(name, bytes, &report), image);
    ASSERT_TRUE(report.compressed);
    EXPECT_THAT(report.conversions, ::testing::IsEmpty());
    SceneOptions options;
    options.texture = folder.write("b.dds", bytes).string();
    const Scene scene = load_scene("quad", options);
    EXPECT_EQ(scene.mesh.textures[0].image, image);
    ASSERT_TRUE(scene.mesh.textures[0].compressed);
    expect_equal(*scene.mesh.textures[0].compressed, kBrick);
  }
}

// OpenImageIO divides by alpha where a DDS says that its colours are multiplied.
TEST(CompressedFile, OtherDdsFilesAreLeftToOpenImageIo) {
  const auto head = [](const std::string& bytes) {
    return is_compressed_file(std::string_view(bytes).substr(0, kCompressedHeaderBytes));
  };
  EXPECT_FALSE(head(dds_file(kBrick, "DXT2")));
  EXPECT_FALSE(head(dds_file(kBrick, "DXT3")));
  EXPECT_FALSE(head(dds_file(kBrick, "DXT4")));
  EXPECT_FALSE(head(with_word(dds_file(kBrick), 128, 98)));  // BC7
  EXPECT_FALSE(head(with_word(dds_file(kBrick), 144, 2)));   // multiplied by alpha
  EXPECT_FALSE(head("DDS "));
  EXPECT_FALSE(head(""));
}

TEST(CompressedFile, TruncatedFilesAreNamed) {
  EXPECT_THAT(
      error_of(dds_file(kBrick).substr(0, 140)),
      AllOf(HasSubstr("'a.file'"), HasSubstr("has 140 bytes, and the header of its DDS 148"),
            HasSubstr("copy it again")));
  EXPECT_THAT(error_of(dds_file(kBrick).substr(0, 100)), HasSubstr("100 bytes"));
  EXPECT_THAT(error_of(ktx1_file(kBrick).substr(0, 63)), HasSubstr("header of its KTX 64"));
  EXPECT_THAT(error_of(ktx2_file(kBrick).substr(0, 79)), HasSubstr("header of its KTX 2 80"));
  EXPECT_THAT(error_of(ktx2_file(kBrick).substr(0, 120)), HasSubstr("header of its KTX 2 152"));
  for (const std::string& bytes : {dds_file(kBrick), ktx1_file(kBrick)}) {
    EXPECT_THAT(error_of(bytes.substr(0, bytes.size() - 1)),
                AllOf(HasSubstr("level 2 of 5 x 2 texels needs 16 bytes from byte"),
                      HasSubstr("truncated")));
    for (std::size_t size = 12; size < bytes.size(); ++size)
      EXPECT_NE(error_of(bytes.substr(0, size)), "") << size;
  }
  EXPECT_THAT(error_of(ktx1_file(kBrick).substr(0, 64 + 4 + 8 * 15)),
              HasSubstr("level 1 would begin at byte 188"));
  // The first level is the last one in a KTX 2.
  EXPECT_THAT(error_of(ktx2_file(kBrick).substr(0, 300)), HasSubstr("level 0 of 20 x 9 texels"));
}

TEST(CompressedFile, OtherKindsOfTexturesAreNamed) {
  const std::string dds = dds_file(kBrick), ktx = ktx1_file(kBrick), ktx2 = ktx2_file(kBrick);
  for (const std::string& bytes : {with_word(dds, 112, 0xFE00), with_word(dds, 136, 4),
                                   with_word(ktx, 52, 6), with_word(ktx2, 36, 6)})
    EXPECT_THAT(error_of(bytes), HasSubstr("cube map; write one of its faces"));
  for (const std::string& bytes : {with_word(with_word(dds, 112, 0x200000), 24, 7),
                                   with_word(ktx, 44, 7), with_word(ktx2, 28, 7)})
    EXPECT_THAT(error_of(bytes), HasSubstr("volume of 7 slices; write one"));
  for (const std::string& bytes :
       {with_word(dds, 140, 3), with_word(ktx, 48, 3), with_word(ktx2, 32, 3)})
    EXPECT_THAT(error_of(bytes), HasSubstr("array of 3 textures; write one"));
  EXPECT_THAT(error_of(with_word(dds, 132, 2)), HasSubstr("two dimensions"));
  for (const std::string& bytes : {with_word(ktx, 40, 0), with_word(ktx2, 24, 0)})
    EXPECT_THAT(error_of(bytes), HasSubstr("20 x 0 texels"));
}

TEST(CompressedFile, OtherFormatsAreNamed) {
  EXPECT_THAT(
      error_of(with_word(ktx1_file(kBrick), 28, 0x8058)),
      AllOf(HasSubstr("glInternalFormat 0x8058"), HasSubstr("write it as BC1"), HasSubstr("PNG")));
  EXPECT_THAT(error_of(with_word(ktx2_file(kBrick), 12, 37)), HasSubstr("vkFormat 37"));
  // BC4 with signed values.
  EXPECT_THAT(error_of(with_word(ktx2_file(kBrick), 12, 140)), HasSubstr("vkFormat 140"));
  EXPECT_THAT(error_of(with_word(ktx2_file(kBrick), 44, 2)),
              HasSubstr("supercompressed (Zstandard); write it without"));
  EXPECT_THAT(error_of(with_word(ktx2_file(kBrick), 44, 1)), HasSubstr("(Basis LZ)"));
  EXPECT_THAT(error_of(with_word(ktx2_file(kBrick), 44, 9)), HasSubstr("(scheme 9)"));
}

TEST(CompressedFile, DamagedHeadersAreNamed) {
  const std::string dds = dds_file(kBrick), ktx = ktx1_file(kBrick), ktx2 = ktx2_file(kBrick);
  EXPECT_THAT(error_of(with_word(dds, 4, 125)), HasSubstr("DDS header is damaged"));
  EXPECT_THAT(error_of(with_word(dds, 76, 31)), HasSubstr("DDS header is damaged"));
  EXPECT_THAT(error_of(with_word(ktx, 12, 5)), HasSubstr("KTX header is damaged"));
  for (const std::string& bytes :
       {with_word(dds, 16, 9000), with_word(ktx, 36, 9000), with_word(ktx2, 20, 9000)})
    EXPECT_THAT(error_of(bytes), HasSubstr("9000 x 9 texels, the limit is 8192 x 8192"));
  for (const std::string& bytes :
       {with_word(dds, 28, 6), with_word(ktx, 56, 6), with_word(ktx2, 40, 6)})
    EXPECT_THAT(error_of(bytes), HasSubstr("6 levels, and 20 x 9 texels have at most 5"));
  EXPECT_THAT(error_of(with_word(ktx, 64, 100)),
              HasSubstr("level 0 has 100 bytes, but the blocks of its 20 x 9 texels have 120"));
  EXPECT_THAT(error_of(with_word(ktx2, 80 + 24 + 8, 8)),
              HasSubstr("level 1 has 8 bytes, but the blocks of its 10 x 4 texels have 24"));
  EXPECT_THAT(error_of(with_word(ktx2, 80 + 4, 0xFFFFFFFF)), HasSubstr("truncated"));
}

}  // namespace
}  // namespace deburr::tb::compressed_file_test
