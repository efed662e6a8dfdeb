// SPDX-License-Identifier: MIT
// Images survive writing to a file and reading back, and every invalid file is named.
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tb/base/atomic_file.h"
#include "tb/scene/image_io.h"
#include "tb/scene/textures.h"
#include "tb/unit/full_disk.h"
#include "tb/unit/scene/fixtures.h"

// OpenImageIO's PNG reader creates its error text inside a libpng callback that exits by longjmp.
extern "C" const char* __lsan_default_suppressions() {  // NOLINT: the sanitizer's name
  return "leak:ImageInput::geterror";
}

namespace deburr::tb::image_test {
namespace {

namespace fs = std::filesystem;

using test::file_error;
using test::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;

// Writes values of any type and channel count, as other programs would.
template <class Value>
void write_with_oiio(const std::filesystem::path& path, int width, int height, int channels,
                     const std::vector<Value>& values, const char* colour_space = nullptr) {
  auto output = OIIO::ImageOutput::create(path.string());
  ASSERT_TRUE(output) << OIIO::geterror();
  OIIO::ImageSpec spec(width, height, channels, OIIO::BaseTypeFromC<Value>::value);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  if (colour_space != nullptr) spec.attribute("oiio:ColorSpace", colour_space);
  ASSERT_TRUE(output->open(path.string(), spec)) << output->geterror();
  ASSERT_TRUE(output->write_image(spec.format, values.data())) << output->geterror();
  ASSERT_TRUE(output->close()) << output->geterror();
}

std::uint32_t crc32(std::string_view bytes) {
  std::uint32_t crc = 0xFFFFFFFFu;
  for (const char c : bytes) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int k = 0; k < 8; ++k) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xEDB88320u : 0u);
  }
  return ~crc;
}

void put_big_endian(std::string& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (24 - 8 * i));
}

// A PNG whose header declares another size, with a valid checksum.
std::string png_of_size(std::string png, std::uint32_t width, std::uint32_t height) {
  put_big_endian(png, 16, width);
  put_big_endian(png, 20, height);
  put_big_endian(png, 29, crc32(std::string_view(png).substr(12, 17)));
  return png;
}

TEST(ImageIo, PngKeepsEveryBitWithAndWithoutAlpha) {
  const TemporaryFolder folder;
  Image image = noise(37, 21, 5);
  write_image(folder / "opaque.png", image);
  EXPECT_EQ(read_image(folder / "opaque.png"), image);
  image.pixels[5][3] = 254;  // alpha is kept although the pixel is almost opaque
  write_image(folder / "nearly.png", image);
  EXPECT_EQ(read_image(folder / "nearly.png"), image);
  // Transparent pixels keep their colour: colours are not premultiplied.
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i][3] = static_cast<std::uint8_t>(i % 256);
  write_image(folder / "alpha.png", image);
  EXPECT_EQ(read_image(folder / "alpha.png"), image);
  EXPECT_EQ(folder.files(), 3u);
}

TEST(ImageIo, OtherReadersReadPngOfEveryShape) {
  const TemporaryFolder folder;
  const fs::path path = folder / "shape.png";
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 300}, {300, 1}, {2, 3}, {kMaxImageSide, 2}}) {
    for (const Image& image : {noise(width, height, 9), gradient(width, height),
                               Image(width, height, {7, 200, 255, 255}), Image(width, height)}) {
      write_image(path, image);
      EXPECT_EQ(read_image(path), image) << width << " x " << height;
    }
  }
}

TEST(ImageIo, ConversionsAreReported) {
  const TemporaryFolder folder;
  ReadReport report;
  write_with_oiio<std::uint16_t>(folder / "deep.png", 3, 1, 1, {0, 128, 65535});
  const Image deep = read_image(folder / "deep.png", &report);
  EXPECT_EQ(deep.pixels,
            (std::vector<Rgba8>{{0, 0, 0, 255}, {0, 0, 0, 255}, {255, 255, 255, 255}}));
  EXPECT_EQ(report.format, "uint16");
  EXPECT_EQ(report.channels, 1);
  EXPECT_THAT(report.conversions, ::testing::Contains(HasSubstr("grey copied")));

  write_with_oiio<std::uint16_t>(folder / "tie.png", 2, 1, 1,
                                 {128, 129});  // 0.498 and 0.502 of 255
  EXPECT_EQ(read_image(folder / "tie.png").pixels[0][0], 0);
  EXPECT_EQ(read_image(folder / "tie.png").pixels[1][0], 1);

  write_with_oiio<std::uint8_t>(folder / "grey_alpha.png", 1, 1, 2, {77, 33});
  EXPECT_EQ(read_image(folder / "grey_alpha.png").pixels[0], (Rgba8{77, 77, 77, 33}));

  const float nan = std::numeric_limits<float>::quiet_NaN();
  write_with_oiio<float>(folder / "linear.exr", 4, 1, 3,
                         {0, 0, 0, 0.5f, 0.5f, 0.5f, 7, -1, 1, nan, 1, 1});
  const Image linear = read_image(folder / "linear.exr", &report);
  EXPECT_EQ(linear.pixels[0], (Rgba8{0, 0, 0, 255}));
  EXPECT_EQ(linear.pixels[1], (Rgba8{188, 188, 188, 255}));  // the sRGB curve at one half
  EXPECT_EQ(linear.pixels[2], (Rgba8{255, 0, 255, 255}));
  EXPECT_EQ(linear.pixels[3], (Rgba8{0, 255, 255, 255}));
  EXPECT_THAT(report.conversions, ::testing::Contains(HasSubstr("sRGB curve")));
  EXPECT_THAT(report.conversions,
              ::testing::IsSupersetOf({"2 of 12 values clamped to [0, 1], the first at (2, 0)",
                                       "1 of 12 values NaN replaced by 0, the first at (3, 0)"}));

  // HDR declares linear values too; a float TIFF declares nothing, so it holds codes. Alpha is a
  // fraction in both.
  write_with_oiio<float>(folder / "linear.hdr", 1, 1, 3, {0.5f, 0.25f, 1.0f});
  EXPECT_EQ(read_image(folder / "linear.hdr", &report).pixels[0], (Rgba8{188, 137, 255, 255}));
  for (const std::string& conversion : report.conversions)
    EXPECT_THAT(conversion, ::testing::Not(::testing::ContainsRegex("clamped|NaN")));
  write_with_oiio<float>(folder / "alpha.exr", 1, 1, 4, {0.5f, 0.5f, 0.5f, 0.5f});
  EXPECT_EQ(read_image(folder / "alpha.exr").pixels[0][3], 128);
  write_with_oiio<float>(folder / "codes.tif", 2, 1, 4, {0.5f, 0.25f, nan, 0.5f, 7, -1, 1, 1});
  EXPECT_EQ(read_image(folder / "codes.tif", &report).pixels,
            (std::vector<Rgba8>{{128, 64, 0, 128}, {255, 0, 255, 255}}));
  EXPECT_THAT(report.conversions, ::testing::Contains(HasSubstr("read as sRGB-encoded")));
  // Integers are codes even if the file declares otherwise.
  write_with_oiio<std::uint16_t>(folder / "linear.png", 1, 1, 1, {32768}, "Linear");
  EXPECT_EQ(read_image(folder / "linear.png").pixels[0][0], 128);

  write_with_oiio<std::uint8_t>(folder / "palette.gif", 2, 1, 3, {255, 0, 0, 0, 0, 255});
  EXPECT_EQ(read_image(folder / "palette.gif").pixels,
            (std::vector<Rgba8>{{255, 0, 0, 255}, {0, 0, 255, 255}}));

  write_with_oiio<std::uint8_t>(folder / "many.tif", 1, 1, 6, {1, 2, 3, 4, 5, 6});
  EXPECT_EQ(read_image(folder / "many.tif", &report).pixels[0], (Rgba8{1, 2, 3, 4}));
  EXPECT_THAT(report.conversions, ::testing::Contains(HasSubstr("channels 5 to 6")));
}

TEST(ImageIo, DepthIs24BitsOrOneFloat) {
  const TemporaryFolder folder;
  DepthImage depth(4, 1);
  depth.pixels = {0.0f, 1.0f, 1.0f / 16777215.0f, 0.25f};
  write_depth24(folder / "d.png", depth);
  EXPECT_EQ(read_image(folder / "d.png").pixels[2], (Rgba8{0, 0, 1, 255}));
  EXPECT_EQ(read_depth(folder / "d.png").pixels[1], 1.0f);
  EXPECT_NEAR(read_depth(folder / "d.png").pixels[3], 0.25f, 1e-7);
  write_with_oiio<float>(folder / "d.exr", 2, 1, 1, {3.5f, 90.0f});
  ReadReport report;
  EXPECT_EQ(read_depth(folder / "d.exr", &report).pixels, (std::vector<float>{3.5f, 90.0f}));
  EXPECT_THAT(
      report.conversions,
      ::testing::ElementsAre(HasSubstr("2 of 2 values lie outside [0, 1], the first at (0, 0)")));
  const float inf = std::numeric_limits<float>::infinity(), nan = std::nanf("");
  write_with_oiio<float>(folder / "i.exr", 2, 2, 1, {0.5f, 1, 0, -inf});
  EXPECT_EQ(read_depth(folder / "i.exr", &report).pixels[3], -inf);
  EXPECT_THAT(report.conversions, ::testing::ElementsAre(HasSubstr("1 of 4 values lie outside")));
  read_depth(folder / "d.png", &report);
  EXPECT_THAT(report.conversions, ::testing::IsEmpty());
  write_with_oiio<float>(folder / "n.exr", 2, 2, 1, {0.5f, 1, nan, nan});
  EXPECT_THAT(file_error([&] { read_depth(folder / "n.exr"); }),
              AllOf(HasSubstr("n.exr"), HasSubstr("2 of 4 values are NaN"),
                    HasSubstr("the first at (0, 1)"), HasSubstr("write 0")));
}

TEST(ImageIo, ErrorNamesInvalidFile) {
  const TemporaryFolder folder;
  write_image(folder / "good.png", noise(64, 64));
  const std::string good = test::read_bytes(folder / "good.png");
  auto error_of = [&](const fs::path& path) { return file_error([&] { read_image(path); }); };

  EXPECT_THAT(error_of(folder / "none.png"),
              AllOf(HasSubstr("none.png"), HasSubstr("no such file")));
  EXPECT_THAT(error_of(folder.path()), HasSubstr("not a regular file"));
  EXPECT_THAT(error_of(folder.write("empty.png", "")), HasSubstr("empty (0 bytes)"));
  EXPECT_THAT(error_of(folder.write("text.png", "hello, I am no picture")),
              HasSubstr("OpenImageIO cannot read it"));
  for (const std::size_t size : {std::size_t{20}, good.size() / 2, good.size() - 30})
    EXPECT_NE(error_of(folder.write("cut.png", good.substr(0, size))), "") << size;
  std::string corrupt = good;
  for (std::size_t i = corrupt.size() / 2; i < corrupt.size() / 2 + 40; ++i)
    corrupt[i] = static_cast<char>(corrupt[i] ^ 0x5A);
  EXPECT_THAT(error_of(folder.write("corrupt.png", corrupt)), HasSubstr("truncated or corrupt"));
  // Rejected by the header, before memory of the declared size is allocated.
  EXPECT_THAT(error_of(folder.write("huge.png", png_of_size(good, 100000, 100000))),
              HasSubstr("the limit is 8192"));
  EXPECT_THAT(error_of(folder.write("wide.png", png_of_size(good, 8193, 1))),
              HasSubstr("the limit is 8192"));

  write_image(folder / "good.jpg", gradient(64, 64));
  EXPECT_EQ(read_image(folder / "good.jpg").width, 64);
  const std::string jpeg = test::read_bytes(folder / "good.jpg");
  EXPECT_THAT(error_of(folder.write("cut.jpg", jpeg.substr(0, jpeg.size() / 2))),
              HasSubstr("truncated"));
  EXPECT_THAT(file_error([&] { read_image_memory("inside", good.substr(0, good.size() / 2)); }),
              HasSubstr("inside"));
  EXPECT_THAT(file_error([&] { read_image_memory("inside", "hello, I am no picture"); }),
              AllOf(HasSubstr("inside"), HasSubstr("use PNG or JPEG")));
}

TEST(ImageIo, ErrorNamesInvalidTargetAndLeavesNoFile) {
  const TemporaryFolder folder;
  const Image image = noise(8, 8);
  EXPECT_THAT(file_error([&] { write_image(folder / "x.nonsense", image); }),
              HasSubstr("not a writable image format"));
  EXPECT_THAT(file_error([&] { write_image(folder / "no/such/folder/x.png", image); }),
              HasSubstr("No such file or directory"));
  EXPECT_THAT(file_error([&] { write_image("/dev/full", image); }),
              HasSubstr("not a writable image"));
  EXPECT_THAT(file_error([&] { write_file_atomically("/dev/full", "x"); }),
              HasSubstr("not a regular file"));
  EXPECT_THAT(file_error([&] { write_image(folder / "empty.png", Image()); }), HasSubstr("0 x 0"));
  EXPECT_EQ(folder.files(), 0u);
}

TEST(ImageIo, FullDiskIsReportedAndOldFileRemains) {
  const TemporaryFolder folder;
  const Image old = gradient(16, 16);
  write_image(folder / "out.png", old);
  {
    const FullDisk full(4096);
    EXPECT_THAT(file_error([&] { write_image(folder / "out.png", noise(128, 128)); }),
                AllOf(HasSubstr("out.png"), HasSubstr("cannot write")));
    EXPECT_NE(
        file_error([&] { write_file_atomically(folder / "big.json", std::string(10000, ' ')); }),
        "");
  }
  EXPECT_EQ(read_image(folder / "out.png"), old);
  EXPECT_EQ(folder.files(), 1u);
}

TEST(ImageIo, RelatedFilesAreReplacedTogetherOrNotAtAll) {
  const TemporaryFolder folder;
  write_files_atomically({{folder / "a.json", "old"}, {folder / "b.html", "older"}});
  const std::string big(10000, ' ');
  {
    const FullDisk full(4096);
    EXPECT_THAT(file_error([&] {
                  write_files_atomically({{folder / "a.json", "new"}, {folder / "b.html", big}});
                }),
                AllOf(HasSubstr("b.html"), HasSubstr("cannot write")));
  }
  EXPECT_EQ(test::read_bytes(folder / "a.json"), "old");
  EXPECT_EQ(folder.files(), 2u);
  write_files_atomically({{folder / "a.json", "new"}, {folder / "b.html", big}});
  EXPECT_EQ(test::read_bytes(folder / "a.json"), "new");
  EXPECT_EQ(test::read_bytes(folder / "b.html"), big);
}

}  // namespace
}  // namespace deburr::tb::image_test
