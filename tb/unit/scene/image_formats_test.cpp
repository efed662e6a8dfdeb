// SPDX-License-Identifier: MIT
// An image has the same pixels in every file format: colours that are not premultiplied by alpha,
// and part images in their position. Files that OpenImageIO cannot write, or writes only as it
// would read them, are built from bytes here or written by Pillow.
#include <OpenImageIO/imageio.h>
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include "tb/scene/depth_codes.h"
#include "tb/scene/image_io.h"
#include "tb/unit/scene/fixtures.h"

namespace deburr::tb::image_formats_test {
namespace {

namespace fs = std::filesystem;
using test::file_error;
using test::TemporaryFolder;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Bytes = std::vector<std::uint8_t>;
using Pixels = std::vector<Rgba8>;

// Nearly transparent, opaque, transparent with a colour, half transparent.
const Pixels kStraight = {
    {204, 199, 230, 10}, {204, 199, 230, 255}, {9, 8, 7, 0}, {255, 128, 1, 128}};
// The same with colours premultiplied by alpha and rounded, and the result of the division: 8 * 255
// / 10 = 204, 9 * 255 / 10 = 229.5, 64 * 255 / 128 = 127.5, 1 * 255 / 128 = 1.99. With alpha 0
// colours are not divided.
const Pixels kMultiplied = {{8, 8, 9, 10}, {204, 199, 230, 255}, {9, 8, 7, 0}, {128, 64, 1, 128}};
const Pixels kDivided = {
    {204, 204, 230, 10}, {204, 199, 230, 255}, {9, 8, 7, 0}, {255, 128, 2, 128}};

Bytes values_of(const Pixels& pixels) {
  Bytes values;
  for (const Rgba8& pixel : pixels) values.insert(values.end(), pixel.begin(), pixel.end());
  return values;
}

// Properties of a written file other than its values.
struct Written {
  int width = 4, height = 1, channels = 4;
  int x = 0, y = 0, full_width = 0, full_height = 0, full_x = 0, full_y = 0;
  std::vector<std::string> names = {};
};

template <class Value>
fs::path write(const fs::path& path, const Written& what, const std::vector<Value>& values) {
  const auto output = OIIO::ImageOutput::create(path.string());
  if (!output) {
    ADD_FAILURE() << OIIO::geterror();
    return path;
  }
  OIIO::ImageSpec spec(what.width, what.height, what.channels, OIIO::BaseTypeFromC<Value>::value);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.x = what.x;
  spec.y = what.y;
  spec.full_x = what.full_x;
  spec.full_y = what.full_y;
  if (what.full_width > 0) spec.full_width = what.full_width;
  if (what.full_height > 0) spec.full_height = what.full_height;
  if (!what.names.empty()) spec.channelnames = what.names;
  EXPECT_TRUE(output->open(path.string(), spec)) << output->geterror();
  EXPECT_TRUE(output->write_image(spec.format, values.data())) << output->geterror();
  EXPECT_TRUE(output->close()) << output->geterror();
  return path;
}

std::string of_hex(std::string_view hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
  return bytes;
}

std::string little(std::uint64_t value, std::size_t bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i));
  return text;
}
std::string big(std::uint64_t value, std::size_t bytes) {
  std::string text = little(value, bytes);
  return {text.rbegin(), text.rend()};
}
std::string of_pixels(const Pixels& pixels, std::array<std::size_t, 4> order) {
  std::string bytes;
  for (const Rgba8& pixel : pixels)
    for (const std::size_t c : order) bytes += static_cast<char>(pixel[c]);
  return bytes;
}

// A TIFF of one row. `extra` is the value of ExtraSamples; a negative value omits the tag.
std::string tiff(int extra, int samples, int bits, const std::vector<unsigned>& values,
                 unsigned colours = 2) {
  const auto bytes = static_cast<unsigned>(bits) / 8;
  const std::size_t width = values.size() / static_cast<std::size_t>(samples);
  const auto wide = static_cast<unsigned>(samples);
  std::vector<std::array<unsigned, 3>> tags = {
      {256, static_cast<unsigned>(width), 1},
      {257, 1, 1},
      {258, 0, wide},
      {259, 1, 1},
      {262, samples < 3 ? 1u : colours, 1},
      {273, 0, 1},
      {277, wide, 1},
      {278, 1, 1},
      {279, static_cast<unsigned>(values.size()) * bytes, 1},
      {284, 1, 1}};
  if (extra >= 0) tags.push_back({338, static_cast<unsigned>(extra), 1});
  const auto bits_at = static_cast<unsigned>(8 + 2 + 12 * tags.size() + 4);
  std::string file = "II*" + std::string(1, '\0') + little(8, 4) + little(tags.size(), 2);
  for (auto [tag, value, count] : tags) {
    if (tag == 258) value = count > 2 ? bits_at : static_cast<unsigned>(bits | bits << 16);
    if (tag == 273) value = bits_at + 2 * wide;
    file += little(tag, 2) + little(3, 2) + little(count, 4) + little(value, 4);
  }
  file += little(0, 4);
  for (unsigned i = 0; i < wide; ++i) file += little(static_cast<unsigned>(bits), 2);
  for (const unsigned value : values) file += little(value, bytes);
  return file;
}
std::string tiff(int extra, const Pixels& pixels) {
  const Bytes values = values_of(pixels);
  return tiff(extra, 4, 8, {values.begin(), values.end()});
}

// Attribute 0: a file of the first version, which does not specify its alpha.
std::string targa(int attribute, const Pixels& pixels) {
  std::string file = little(0, 2) + little(2, 1) + std::string(9, '\0') + little(pixels.size(), 2) +
                     little(1, 2) + little(32, 1) + little(attribute == 0 ? 0 : 8, 1) +
                     of_pixels(pixels, {2, 1, 0, 3});
  if (attribute == 0) return file;
  const std::size_t extension = file.size();
  file += little(495, 2) + std::string(492, '\0') + little(static_cast<unsigned>(attribute), 1);
  return file + little(extension, 4) + little(0, 4) + "TRUEVISION-XFILE." + std::string(1, '\0');
}

std::string dds_header(unsigned size, std::string_view code, unsigned flags) {
  std::string file = "DDS " + little(124, 4) + little(0x1007, 4) + little(size == 1 ? 1 : size, 4) +
                     little(4, 4) + std::string(56, '\0') + little(32, 4) + little(flags, 4);
  file += code.empty() ? little(0, 4) : std::string(code);
  for (const std::uint64_t word : {32ull, 0xFFull, 0xFF00ull, 0xFF0000ull, 0xFF000000ull})
    file += little(word, 4);
  return file + little(0x1000, 4) + std::string(16, '\0');
}
std::string raw_dds(const Pixels& pixels) {
  return dds_header(1, "", 0x41) + of_pixels(pixels, {0, 1, 2, 3});
}
// 4 x 4 pixels of one colour, red 10 of 31, with an alpha of 0..15.
std::string block_dds(std::string_view code, unsigned alpha) {
  const bool explicit_alpha = code == "DXT2" || code == "DXT3";
  return dds_header(4, code, 4) +
         std::string(explicit_alpha ? 8 : 2, static_cast<char>(17 * alpha)) +
         std::string(explicit_alpha ? 0 : 6, '\0') + little(10 << 11, 2) + little(0, 6);
}
// 4 x 4 pixels of (102, 50, 20, 204), as a block of BC7 in mode 6; `mode` is the alpha mode.
std::string dx10_dds(unsigned mode) {
  std::string block(16, '\0');
  std::size_t bit = 0;
  const auto put = [&](unsigned value, std::size_t bits) {
    for (std::size_t i = 0; i < bits; ++i, ++bit)
      block[bit / 8] = static_cast<char>(block[bit / 8] | (value >> i & 1) << (bit % 8));
  };
  put(1 << 6, 7);
  for (const unsigned colour : {51u, 25u, 10u, 102u})
    for (int end = 0; end < 2; ++end) put(colour, 7);
  return dds_header(4, "DX10", 4) + little(98, 4) + little(3, 4) + little(0, 4) + little(1, 4) +
         little(mode, 4) + block;
}

// Lossless file written by Pillow, with a box that declares the alpha: 1 opacity, 2 premultiplied.
std::string jpeg2000(unsigned opacity) {
  std::string file = of_hex(
      "0000000c6a5020200d0a870a00000014667479706a703220000000006a7032200000002d6a7032680000001669"
      "68647200000001000000040004070700000000000f636f6c7201000000000010000000aa6a703263ff4fff5100"
      "32000000000004000000010000000000000000000000040000000100000000000000000004070101070101070101"
      "070101ff52000c00000001000004040001ff5c00044040ff640025000143726561746564206279204f70656e4a"
      "5045472076657273696f6e20322e352e30ff90000a00000000002f0001ff93cfb41401d41e15cbcfb41401c0c0"
      "9782cfb41401e3e31b3fdf80300e19e37e763fffd9");
  std::string box = big(34, 4) + "cdef" + big(4, 2);
  for (unsigned c = 0; c < 4; ++c)
    box += big(c, 2) + big(c < 3 ? 0 : opacity, 2) + big(c < 3 ? c + 1 : 0, 2);
  const std::size_t header = file.find("jp2h") - 4;
  file.replace(header, 4, big(45 + 34, 4));
  return file.insert(header + 45, box);
}

// Layers declare the fourth channel as transparency; the merged image shows them on white.
std::string photoshop(const Pixels& pixels) {
  std::string layer = big(0, 8) + big(1, 4) + big(1, 4) + big(4, 2);
  for (const unsigned channel : {0u, 1u, 2u, 0xFFFFu}) layer += big(channel, 2) + big(3, 4);
  layer += "8BIMnorm" + little(255, 4) + big(12, 4) + std::string(12, '\0');
  std::string layers = big(0xFFFF, 2) + layer + std::string(12, '\0');
  layers.resize((layers.size() + 1) / 2 * 2);
  std::string file = "8BPS" + big(1, 2) + std::string(6, '\0') + big(4, 2) + big(1, 4) +
                     big(pixels.size(), 4) + big(8, 2) + big(3, 2) + big(0, 8);
  file += big(layers.size() + 8, 4) + big(layers.size(), 4) + layers + big(0, 4) + big(0, 2);
  for (std::size_t c = 0; c < 4; ++c)
    for (const Rgba8& pixel : pixels) file += static_cast<char>(pixel[c]);
  return file;
}

std::string softimage(const Pixels& pixels) {
  std::string file = big(0x5380F634, 4) + std::string(84, '\0') + "PICT" + big(pixels.size(), 2) +
                     big(1, 2) + big(0x3F800000, 4) + big(3, 2) + big(0, 2);
  file += big(0x010802E0, 4) + big(0x00080210, 4) + little(pixels.size() - 1, 1);
  for (const Rgba8& pixel : pixels) file.append(pixel.begin(), pixel.begin() + 3);
  file += little(pixels.size() - 1, 1);
  for (const Rgba8& pixel : pixels) file += static_cast<char>(pixel[3]);
  return file;
}

std::string webp() {
  return of_hex(
      "524946463a000000574542505650384c2d0000002f030000101f20242053a2672e111210aaffbbdc91850484e6ff"
      "482724210161baecaf1e2abf55c0a85344ff0300");
}
// 8 x 8 pixels, first red, then green; the first frame fills an image of 8 x `height`.
std::string animated_webp(unsigned height) {
  std::string file = of_hex(
      "524946468400000057454250565038580a00000012000000070000070000414e494d06000000000000000000414e"
      "4d4628000000000000000000070000070000640000025650384c0f0000002f07c001000710fd8ffe0722a2ff0100"
      "414e4d4628000000000000000000070000070000640000025650384c0f0000002f07c0011007d0ff88020622a2ff"
      "0100");
  return file.replace(27, 3, little(height - 1, 3));
}

// ---- Colour and alpha --------------------------------------------------------------------------

TEST(ImageFormats, ColoursAreStraightInEveryFormatWithAlpha) {
  const TemporaryFolder folder;
  for (const char* const extension :
       {"bmp", "dpx", "ico", "iff", "png", "rla", "sgi", "tga", "tif"})
    EXPECT_EQ(read_image(write(folder / (std::string("of.") + extension), {}, values_of(kStraight)))
                  .pixels,
              kStraight)
        << extension;
  const std::map<std::string, std::string> files = {
      {"of.psd", photoshop({{0, 51, 255, 255}, {255, 191, 127, 128}})},
      {"of.pic", softimage(kStraight)},
      {"of.webp", webp()},
      {"of.dds", raw_dds(kStraight)},
      {"of.jp2", jpeg2000(1)}};
  for (const auto& [name, bytes] : files) {
    const Image image = read_image(folder.write(name, bytes));
    if (name != "of.psd") {
      EXPECT_EQ(image.pixels, kStraight) << name;
      continue;
    }
    // 191 = 127 of white and 64 = 127.5 * 128 / 255 of the colour.
    EXPECT_EQ(image.pixels[0], (Rgba8{0, 51, 255, 255}));
    EXPECT_NEAR(image.pixels[1][1], 128, 1);
    EXPECT_NEAR(image.pixels[1][2], 0, 1);
    EXPECT_EQ(image.pixels[1][3], 128);
  }
  // GIF has only transparent and opaque pixels. HEIF and AVIF change pixels by compression.
  EXPECT_EQ(
      read_image(write(folder / "of.gif", {2}, Bytes{204, 199, 230, 255, 255, 128, 1, 255})).pixels,
      (Pixels{{204, 199, 230, 255}, {255, 128, 1, 255}}));
  // 64 pixels: OpenImageIO copies rows of the length that libheif allocates.
  for (const char* const extension : {"heic", "avif"}) {
    const Rgba8 colour = {200, 100, 50, 40};
    const Image image = read_image(write(folder / (std::string("of.") + extension), {64, 64},
                                         values_of(Pixels(4096, colour))));
    for (std::size_t c = 0; c < 4; ++c)
      EXPECT_NEAR(image.pixels[100][c], colour[c], 4) << extension;
  }
  // EXR: linear light premultiplied by alpha; 0.5 is 188 on the sRGB curve.
  EXPECT_EQ(
      read_image(write(folder / "of.exr", {},
                       std::vector<float>{0.02f, 0.01f, 0.04f, 0.04f, 0.5f, 0, 1, 1, 0.5f, 0, 2, 0,
                                          3, 0.5f, -1, 0.5f}))
          .pixels,
      (Pixels{{188, 137, 255, 10}, {188, 0, 255, 255}, {188, 0, 255, 0}, {255, 255, 0, 128}}));
}

TEST(ImageFormats, PremultipliedColoursAreDividedByAlpha) {
  const TemporaryFolder folder;
  const auto pixels = [&](const std::string& name, const std::string& bytes) {
    return read_image(folder.write(name, bytes)).pixels;
  };
  EXPECT_EQ(pixels("associated.tif", tiff(1, kMultiplied)), kDivided);
  EXPECT_EQ(pixels("unassociated.tif", tiff(2, kStraight)), kStraight);
  EXPECT_EQ(pixels("unspecified.tif", tiff(0, kStraight)), kStraight);
  EXPECT_EQ(pixels("silent.tif", tiff(-1, kStraight)), kStraight);
  // 255 * 33 / 66 = 127.5; in 16 bits 255 * 100 / 200, and 255 * 30000 / 40000 = 191.25.
  EXPECT_EQ(pixels("grey.tif", tiff(1, 2, 8, {33, 66, 90, 66})),
            (Pixels{{128, 128, 128, 66}, {255, 255, 255, 66}}));
  EXPECT_EQ(pixels("deep.tif", tiff(1, 4, 16, {100, 30, 0, 200, 30000, 40000, 50000, 40000})),
            (Pixels{{128, 38, 0, 1}, {191, 255, 255, 156}}));
  EXPECT_EQ(pixels("deep_straight.tif", tiff(2, 4, 16, {257 * 100, 257 * 30, 0, 257 * 10})),
            (Pixels{{100, 30, 0, 10}}));

  EXPECT_EQ(pixels("multiplied.tga", targa(4, kMultiplied)), kDivided);
  for (const int attribute : {0, 2, 3})
    EXPECT_EQ(pixels("straight.tga", targa(attribute, kStraight)), kStraight) << attribute;

  // 10 of 31 is 82, and 82 * 255 / 136 = 153.75. Colours greater than alpha are clamped.
  for (const char* const code : {"DXT2", "DXT4"}) {
    EXPECT_EQ(pixels("block.dds", block_dds(code, 8))[0], (Rgba8{154, 0, 0, 136})) << code;
    EXPECT_EQ(pixels("block.dds", block_dds(code, 4))[0], (Rgba8{255, 0, 0, 68})) << code;
    EXPECT_EQ(pixels("block.dds", block_dds(code, 0))[0], (Rgba8{82, 0, 0, 0})) << code;
  }
  for (const char* const code : {"DXT3", "DXT5"})
    EXPECT_EQ(pixels("block.dds", block_dds(code, 8))[0], (Rgba8{82, 0, 0, 136})) << code;
  EXPECT_EQ(pixels("dx10.dds", dx10_dds(1))[5], (Rgba8{102, 50, 20, 204}));
  EXPECT_EQ(pixels("dx10.dds", dx10_dds(2))[5], (Rgba8{128, 63, 25, 204}));  // 127.5, 62.5, 25

  EXPECT_EQ(pixels("multiplied.jp2", jpeg2000(2))[3], (Rgba8{255, 255, 2, 128}));

  ReadReport report;
  read_image(folder / "associated.tif", &report);
  EXPECT_THAT(report.conversions, ElementsAre(HasSubstr("divided by alpha")));
  read_image(folder / "unassociated.tif", &report);
  EXPECT_THAT(report.conversions, ElementsAre());
  read_image(folder / "unspecified.tif", &report);
  EXPECT_THAT(report.conversions, ElementsAre(HasSubstr("does not declare the type of channel 4")));
}

TEST(ImageFormats, FormatsWithoutAlphaKeepTheirColours) {
  const TemporaryFolder folder;
  const Bytes colours = {204, 199, 230, 9, 8, 7};
  const Pixels pixels = {{204, 199, 230, 255}, {9, 8, 7, 255}};
  for (const char* const extension : {"ppm", "bmp", "png", "tga", "tif", "sgi", "dpx", "rla"}) {
    const Image image =
        read_image(write(folder / (std::string("of.") + extension), {2, 1, 3}, colours));
    EXPECT_EQ(image.pixels, pixels) << extension;
  }
  for (const char* const extension : {"fits", "pgm"})
    EXPECT_EQ(
        read_image(write(folder / (std::string("grey.") + extension), {2, 1, 1}, Bytes{77, 9}))
            .pixels,
        (Pixels{{77, 77, 77, 255}, {9, 9, 9, 255}}))
        << extension;
  const Image jpeg = read_image(write(folder / "of.jpg", {16, 16, 3}, [] {
    Bytes flat;
    for (int i = 0; i < 256; ++i) flat.insert(flat.end(), {204, 199, 230});
    return flat;
  }()));
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(jpeg.pixels[0][c], pixels[0][c], 2);
}

// Another release of OpenImageIO may read more formats.
TEST(ImageFormats, EveryFormatIsCoveredHereOrOnThePage) {
#if OIIO_VERSION < 20500
  const std::string covered =
      " openexr tiff bmp dds dpx gif heif ico iff jpeg2000 png psd rla sgi softimage targa webp"
      " jpeg hdr pnm fits ";
  // Formats without alpha, or of films, which store it separately.
  const std::string others = " cineon dicom ffmpeg null openvdb raw zfile ";
  std::istringstream list(OIIO::get_string_attribute("input_format_list"));
  for (std::string format; std::getline(list, format, ',');)
    EXPECT_THAT(covered + others, HasSubstr(" " + format + " "));
#endif
}

TEST(ImageFormats, ExrChannelsAreSelectedByName) {
  const TemporaryFolder folder;
  const auto path = folder / "of.exr";
  const auto pixel = [&](const std::vector<std::string>& names, const std::vector<float>& values) {
    Written what{1, 1, static_cast<int>(names.size())};
    what.names = names;
    return read_image(write(path, what, values)).pixels[0];
  };
  EXPECT_EQ(pixel({"R", "G", "B", "Z"}, {1, 0.5f, 0, 0.1f}), (Rgba8{255, 188, 0, 255}));
  EXPECT_EQ(pixel({"Y"}, {0.5f}), (Rgba8{188, 188, 188, 255}));
  EXPECT_EQ(pixel({"Y", "A"}, {0.25f, 0.5f}), (Rgba8{188, 188, 188, 128}));
  EXPECT_EQ(pixel({"Y", "Z"}, {0.5f, 90}), (Rgba8{188, 188, 188, 255}));
  EXPECT_EQ(pixel({"a.R", "a.G", "a.B", "a.A", "b.R"}, {0.25f, 0, 0.5f, 0.5f, 1}),
            (Rgba8{188, 0, 255, 128}));
  EXPECT_EQ(pixel({"R", "G", "B", "mask.A"}, {0.5f, 0, 0.5f, 0.25f}), (Rgba8{188, 0, 188, 255}));
  EXPECT_EQ(pixel({"a.Y", "b.R", "b.G"}, {0.5f, 0, 1}), (Rgba8{188, 188, 188, 255}));
  ReadReport report;
  read_image(path, &report);
  EXPECT_THAT(report.conversions,
              Contains("only the first layer is read; 2 channels of other layers ignored"));
  EXPECT_EQ(pixel({"A", "B", "G", "R", "Z"}, {0.5f, 0, 0.25f, 0.5f, 7}), (Rgba8{255, 188, 0, 128}));
  EXPECT_EQ(pixel({"Blue", "Green", "Red"}, {0, 0.5f, 1}), (Rgba8{255, 188, 0, 255}));
  EXPECT_EQ(pixel({"R", "G", "B", "N"}, {0.5f, 0, 1, 1}), (Rgba8{188, 0, 255, 255}));
}

TEST(ImageFormats, ErrorNamesExrChannelsThatAreNotColours) {
  const TemporaryFolder folder;
  const auto error = [&](const std::vector<std::string>& names) {
    Written what{1, 1, static_cast<int>(names.size())};
    what.names = names;
    const auto path = write(folder / "of.exr", what, std::vector<float>(names.size(), 0.5f));
    return file_error([&] { read_image(path); });
  };
  EXPECT_THAT(error({"Y", "RY", "BY"}),
              HasSubstr("it has the channels Y, BY, RY; an image needs R, G and B, or only Y"));
  EXPECT_THAT(error({"u", "v", "w"}), HasSubstr("it has the channels u, v, w;"));
  EXPECT_THAT(error({"R", "AR", "AG", "AB"}), HasSubstr("it has the channels R, AR, AG;"));
  EXPECT_THAT(error({"R", "G", "A"}), HasSubstr("it has the channels R, G;"));
  for (const char* const name : {"A", "Z", "depth.Z", "mask"})
    EXPECT_THAT(error({name}), HasSubstr(fmt::format("it has the channels {};", name)));
}

TEST(ImageFormats, PaletteAndAnimationsGiveStraightColours) {
  const TemporaryFolder folder;
  EXPECT_EQ(
      read_image(
          folder.write("palette.png",
                       of_hex("89504e470d0a1a0a0000000d49484452000000030000000108030000002c3ee486"
                              "00000009504c54450a141ec86432070809a63ce24b00000003"
                              "74524e53ff0a00be0118b90000000c49444154789c63606064020000080004"
                              "36e0b0a60000000049454e44ae426082")))
          .pixels,
      (Pixels{{10, 20, 30, 255}, {200, 100, 50, 10}, {7, 8, 9, 0}}));
  ReadReport report;
  EXPECT_EQ(read_image(folder.write("film.webp", animated_webp(8)), &report).pixels,
            Pixels(64, Rgba8{255, 0, 0, 255}));
  EXPECT_THAT(report.conversions, Contains("only the first of several images is read"));
  EXPECT_THAT(file_error([&] { read_image(folder.write("part.webp", animated_webp(9))); }),
              HasSubstr("the first frame of the animation does not fill the picture"));
  EXPECT_EQ(read_image_memory("inside", webp()).pixels, kStraight);
  EXPECT_EQ(read_image_memory("inside", raw_dds(kStraight)).pixels, kStraight);
  EXPECT_EQ(read_image_memory("inside", tiff(1, kMultiplied)).pixels, kDivided);
  EXPECT_EQ(read_image_memory("inside", block_dds("DXT2", 8)).pixels[0], (Rgba8{154, 0, 0, 136}));
}

TEST(ImageFormats, ErrorNamesColourModelsOtherThanRgb) {
  const TemporaryFolder folder;
  ReadReport report;
  const std::string cmyk = tiff(-1, 4, 8, {10, 20, 30, 40}, 5);
  // (255 - 10) (255 - 40) / 255 = 206.6, 198.1, 189.7
  EXPECT_EQ(read_image(folder.write("cmyk.tif", cmyk), &report).pixels,
            (Pixels{{207, 198, 190, 255}}));
  EXPECT_THAT(report.conversions, Contains(HasSubstr("CMYK converted to RGB")));
  EXPECT_THAT(file_error([&] { read_depth(folder / "cmyk.tif"); }), HasSubstr("changed by"));
  EXPECT_THAT(file_error([&] {
                read_image(folder.write("lab.tif", tiff(-1, 3, 8, {50, 9, 9}, 8)));
              }),
              HasSubstr("its colour type 'CIELAB' is not supported"));
}

TEST(ImageFormats, ErrorNamesTruncatedFiles) {
  const TemporaryFolder folder;
  const std::string iff =
      test::read_bytes(write(folder / "of.iff", {64, 64, 3}, Bytes(std::size_t{64} * 64 * 3, 200)));
  for (const auto& file :
       std::map<std::string, std::string>{{"cut.dds", raw_dds(kStraight)},
                                          {"cut_blocks.dds", block_dds("DXT2", 8)},
                                          {"cut.webp", webp()},
                                          {"cut.iff", iff},
                                          {"cut.tga", targa(0, kStraight)}})
    EXPECT_THAT(file_error([&] {
                  const std::string& bytes = file.second;
                  read_image(folder.write(file.first, bytes.substr(0, bytes.size() - 4)));
                }),
                AllOf(HasSubstr(file.first), testing::ContainsRegex("truncated|damaged")));
}

TEST(ImageFormats, RejectsWritingWhatFormatCannotStore) {
  const TemporaryFolder folder;
  Image image(4, 1);
  image.pixels = kStraight;
  write_image(folder / "of.tif", image);
  EXPECT_EQ(read_image(folder / "of.tif"), image);
  for (const char* const extension : {"webp", "jpg", "exr"})
    EXPECT_THAT(file_error([&] { write_image(folder / (std::string("of.") + extension), image); }),
                HasSubstr("cannot store these pixels"));
}

// ---- Part images -------------------------------------------------------------------------------

// Pixels of red 10, 20, ... row by row.
Bytes numbered(int pixels) {
  Bytes values;
  for (int i = 1; i <= pixels; ++i)
    values.insert(values.end(), {static_cast<std::uint8_t>(10 * i), 0, 0, 255});
  return values;
}
std::vector<int> reds(const Image& image) {
  std::vector<int> all;
  for (const Rgba8& pixel : image.pixels) all.push_back(pixel[0]);
  return all;
}

TEST(ImageFormats, PartImageLiesAtItsPosition) {
  const TemporaryFolder folder;
  // EXR holds light: 1 is 255.
  const std::vector<float> light = {1, 0, 0, 1, 0.5f, 0, 0, 1};
  ReadReport report;
  Image image = read_image(write(folder / "inside.exr", {2, 1, 4, 1, 1, 4, 3}, light), &report);
  EXPECT_EQ(image.width, 4);
  EXPECT_EQ(image.height, 3);
  EXPECT_EQ(reds(image), (std::vector<int>{0, 0, 0, 0, 0, 255, 188, 0, 0, 0, 0, 0}));
  EXPECT_EQ(image.pixels[0], (Rgba8{0, 0, 0, 0}));
  EXPECT_EQ(image.pixels[5], (Rgba8{255, 0, 0, 255}));
  EXPECT_THAT(report.conversions,
              Contains(HasSubstr("2 x 1 stored pixels placed at (1, 1) in an image of 4 x 3")));
  // Overscan is cropped; origins may be negative.
  EXPECT_EQ(reds(read_image(write(folder / "over.exr", {2, 1, 4, -1, 0, 1, 1}, light))),
            (std::vector<int>{188}));
  EXPECT_EQ(reds(read_image(write(folder / "moved.exr", {2, 1, 4, -5, -7, 3, 1, -6, -7}, light))),
            (std::vector<int>{0, 255, 188}));
  EXPECT_EQ(reds(read_image(write(folder / "away.exr", {2, 1, 4, 9, 9, 2, 2}, light))),
            (std::vector<int>{0, 0, 0, 0}));
  // Three channels: missing pixels are transparent all the same.
  EXPECT_EQ(
      read_image(write(folder / "rgb.exr", {1, 1, 3, 1, 0, 2, 1}, std::vector<float>{1, 1, 1}))
          .pixels,
      (Pixels{{0, 0, 0, 0}, {255, 255, 255, 255}}));
  for (const char* const name : {"inside.tif", "inside.dpx"})
    EXPECT_EQ(reds(read_image(write(folder / name, {2, 2, 4, 1, 0, 4, 2}, numbered(4)))),
              (std::vector<int>{0, 10, 20, 0, 0, 30, 40, 0}))
        << name;
  EXPECT_EQ(reds(read_image(write(folder / "over.tif", {3, 1, 4, 0, 0, 2, 1}, numbered(3)))),
            (std::vector<int>{10, 20}));
  // An offset on a page does not make a part image.
  for (const char* const name : {"page.tif", "page.png"})
    EXPECT_EQ(reds(read_image(write(folder / name, {2, 1, 4, 3, 2}, numbered(2)))),
              (std::vector<int>{10, 20}))
        << name;
  for (const char* const name : {"part.rla", "part.iff"})
    EXPECT_THAT(file_error([&] {
                  read_image(write(folder / name, {2, 1, 4, 1, 1, 4, 3}, numbered(2)));
                }),
                HasSubstr("a part of an image, which OpenImageIO misplaces"))
        << name;
  EXPECT_THAT(file_error([&] {
                read_image(write(folder / "large.exr", {2, 1, 4, 0, 0, 9000, 2}, light));
              }),
              HasSubstr("9000 x 2 pixels, the limit is 8192"));
}

TEST(ImageFormats, DepthIsInfiniteOutsideDataWindow) {
  const TemporaryFolder folder;
  ReadReport report;
  const DepthImage depth = read_depth(
      write(folder / "depth.exr", {2, 1, 1, 1, 0, 4, 1}, std::vector<float>{0.5f, 0.75f}), &report);
  EXPECT_EQ(depth.width, 4);
  EXPECT_EQ(depth.pixels, (std::vector<float>{0, 0.5f, 0.75f, 0}));
  EXPECT_THAT(report.conversions, ElementsAre(HasSubstr("the rest is infinitely far")));
  // A cropped NaN is not an error.
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(
      read_depth(write(folder / "cut.exr", {2, 1, 1, -1, 0, 1, 1}, std::vector<float>{nan, 0.25f}))
          .pixels,
      (std::vector<float>{0.25f}));
  EXPECT_THAT(
      file_error([&] {
        read_depth(write(folder / "nan.exr", {2, 1, 1, 1, 1, 4, 3}, std::vector<float>{0, nan}));
      }),
      HasSubstr("1 of 12 values are NaN, the first at (2, 1)"));
  EXPECT_EQ(
      read_depth(write(folder / "over.exr", {3, 1, 1, -1, 0, 1, 1}, std::vector<float>{1, 0.5f, 1}))
          .pixels,
      (std::vector<float>{0.5f}));
}

// ---- Depth -------------------------------------------------------------------------------------

TEST(ImageFormats, Grey16BitDepthIsScaledExactly) {
  const TemporaryFolder folder;
  ReadReport report;
  // (2^24 - 1) v / 65535 = 256 v + v / 257, rounded half up.
  const std::vector<std::uint16_t> values = {0, 1, 128, 129, 257, 32768, 65534, 65535};
  for (const char* const name : {"depth.png", "depth.tif"}) {
    const DepthImage depth = read_depth(write(folder / name, {8, 1, 1}, values), &report);
    EXPECT_THAT(depth_codes(depth),
                ElementsAre(0, 256, 32768, 33025, 65793, 8388736, 16776959, 16777215));
    EXPECT_THAT(report.conversions, ElementsAre(HasSubstr("65535 at the near plane")));
  }
}

TEST(ImageFormats, ErrorNamesImagesThatAreNotDepth) {
  const TemporaryFolder folder;
  const auto error = [&](const fs::path& path) { return file_error([&] { read_depth(path); }); };
  EXPECT_THAT(error(write(folder / "grey.png", {1, 1, 1}, Bytes{9})),
              AllOf(HasSubstr("16-bit grey"), HasSubstr("this one has 1 channel of uint8")));
  EXPECT_THAT(error(write(folder / "colour.png", {1, 1, 3}, std::vector<std::uint16_t>{1, 2, 3})),
              HasSubstr("this one has 3 channels of uint16"));
  EXPECT_THAT(error(write(folder / "colour.tif", {1, 1, 3}, std::vector<float>{0, 0, 0})),
              HasSubstr("this one has 3 channels of float"));
  EXPECT_THAT(error(write(folder / "grey_alpha.png", {1, 1, 2}, std::vector<std::uint16_t>{1, 2})),
              HasSubstr("this one has 2 channels of uint16"));
  EXPECT_THAT(error(folder.write("multiplied.tif", tiff(1, kMultiplied))),
              HasSubstr("4 channels of uint8, premultiplied by alpha"));
  EXPECT_THAT(error(write(folder / "lossy.jpg", {1, 1, 3}, Bytes{1, 2, 3})),
              HasSubstr("3 channels of uint8, changed by compression or conversion"));
  EXPECT_THAT(error(write(folder / "of.gif", {1, 1, 3}, Bytes{1, 2, 3})), HasSubstr("changed by"));
  EXPECT_THAT(error(folder.write("block.dds", block_dds("DXT5", 15))), HasSubstr("changed by"));
  EXPECT_EQ(read_depth(folder.write("raw.dds", raw_dds(kStraight))).pixels[2],
            static_cast<float>((9 * 65536 + 8 * 256 + 7) / 16777215.0));
  for (const std::string& head :
       {std::string(), "VP8X" + little(10, 4) + little(0, 4) + little(3, 3) + little(3, 3)}) {
    std::string lossy = of_hex(
        "52494646340000005745425056503820280000009001009d012a0400040002c04c25a00274ba00039800fede12"
        "7ff0415cccbd9e1fe379bcd6884000");
    lossy.insert(12, head);
    lossy.replace(4, 4, little(lossy.size() - 8, 4));
    EXPECT_EQ(read_image(folder.write("lossy.webp", lossy)).width, 4);
    EXPECT_THAT(error(folder / "lossy.webp"), HasSubstr("changed by"));
  }
  EXPECT_EQ(read_depth(folder.write("of.webp", webp())).pixels[0],
            static_cast<float>((204 * 65536 + 199 * 256 + 230) / 16777215.0));
}

TEST(ImageFormats, ExrDepthChannelIsSelectedByName) {
  const TemporaryFolder folder;
  const auto path = folder / "of.exr";
  ReadReport report;
  const auto made = [&](const std::vector<std::string>& names) {
    Written what{1, 1, static_cast<int>(names.size())};
    what.names = names;
    std::vector<float> values;  // 1/8, 2/8, ... in order of names
    for (std::size_t i = 1; i <= names.size(); ++i) values.push_back(static_cast<float>(i) / 8);
    return write(path, what, values);
  };
  const auto depth = [&](const std::vector<std::string>& names) {
    return read_depth(made(names), &report).pixels;
  };
  EXPECT_THAT(depth({"AO.V", "Depth.Z"}), ElementsAre(0.25f));
  EXPECT_THAT(report.conversions, ElementsAre("channel Depth.Z of 2 read as depth"));
  EXPECT_THAT(depth({"R", "G", "B", "Z"}), ElementsAre(0.5f));
  EXPECT_EQ(report.channels, 1);  // not 24 bits in R, G and B
  EXPECT_THAT(depth({"R", "G", "B", "depth"}), ElementsAre(0.5f));
  EXPECT_THAT(depth({"Z", "ZBack"}), ElementsAre(0.125f));
  EXPECT_THAT(depth({"depth.Z", "normal.X", "normal.Y", "normal.Z"}), ElementsAre(0.125f));
  EXPECT_THAT(depth({"V"}), ElementsAre(0.125f));
  EXPECT_THAT(report.conversions, ElementsAre());
  const std::vector<std::pair<std::vector<std::string>, std::string>> rejected = {
      {{"AO.V", "Depth.V"},
       "it has the channels AO.V, Depth.V, but needs exactly one channel named as depth"},
      {{"a.Z", "b.Z"}, "channels a.Z, b.Z,"},
      {{"R", "G", "B"}, "channels R, G, B,"},
      {{"normal.X", "normal.Y", "normal.Z"}, "channels normal.X, normal.Y, normal.Z,"}};
  for (const auto& [channels, words] : rejected) {
    const std::vector<std::string>& names = channels;
    EXPECT_THAT(file_error([&] { read_depth(made(names)); }), HasSubstr(words));
  }
}

TEST(ImageFormats, MultipartExrDepthMustBeFirstPart) {
  const TemporaryFolder folder;
  const auto path = (folder / "of.exr").string();
  ReadReport report;
  const auto depth = [&](const std::string& first, const std::string& second) {
    std::vector<OIIO::ImageSpec> specs(2, OIIO::ImageSpec(1, 1, 1, OIIO::TypeFloat));
    specs[0].channelnames = {first};
    specs[1].channelnames = {second};
    const auto output = OIIO::ImageOutput::create(path);
    EXPECT_TRUE(output->open(path, 2, specs.data())) << output->geterror();
    const float values[] = {0.25f, 0.5f};
    EXPECT_TRUE(output->write_image(OIIO::TypeFloat, &values[0])) << output->geterror();
    EXPECT_TRUE(output->open(path, specs[1], OIIO::ImageOutput::AppendSubimage));
    EXPECT_TRUE(output->write_image(OIIO::TypeFloat, &values[1])) << output->geterror();
    EXPECT_TRUE(output->close()) << output->geterror();
    return read_depth(path, &report).pixels;
  };
  EXPECT_THAT(depth("Z", "V"), ElementsAre(0.25f));
  EXPECT_THAT(report.conversions, ElementsAre("only the first of several images is read"));
  EXPECT_THAT(file_error([&] { depth("V", "Z"); }),
              HasSubstr("it has several images, the first with V, but needs exactly one channel"));
}

TEST(ImageFormats, WhiteIsZeroGreyIsInvertedOrNamed) {
  const TemporaryFolder folder;
  const auto grey = [&](int extra, int samples, int bits) {
    std::string bytes = tiff(extra, samples, bits, std::vector<unsigned>(2, 10));
    const std::size_t tag = bytes.find(little(262, 2) + little(3, 2));
    return folder.write("white.tif", bytes.replace(tag + 8, 1, 1, '\0'));
  };
  EXPECT_EQ(read_image(grey(-1, 1, 8)).pixels[0], (Rgba8{245, 245, 245, 255}));
  EXPECT_THAT(file_error([&] { read_image(grey(-1, 1, 16)); }), HasSubstr("white is 0"));
  EXPECT_THAT(file_error([&] { read_depth(grey(-1, 1, 16)); }), HasSubstr("white is 0"));
  EXPECT_THAT(file_error([&] { read_image(grey(2, 2, 8)); }), HasSubstr("white is 0"));
}

TEST(ImageFormats, ReportCountsChangedValuesAndFirstPosition) {
  const TemporaryFolder folder;
  ReadReport report;
  // The first of three stored pixels is cropped, and the third is at (1, 2).
  read_image(write(folder / "of.exr", {3, 1, 3, -1, 2, 2, 4},
                   std::vector<float>{7, 7, 7, 0, 0, 0, 0, 2, std::nanf("")}),
             &report);
  EXPECT_THAT(report.conversions,
              AllOf(Contains("1 of 6 values clamped to [0, 1], the first at (1, 2)"),
                    Contains("1 of 6 values NaN replaced by 0, the first at (1, 2)")));
}

}  // namespace
}  // namespace deburr::tb::image_formats_test
