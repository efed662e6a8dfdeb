// SPDX-License-Identifier: MIT
// OpenImageIO is loaded only when it is needed.
#include "tb/scene/image_codec.h"

#include <gtest/gtest.h>

#include "tb/scene/image_io.h"
#include "tb/scene/reference.h"
#include "tb/scene/textures.h"
#include "tb/unit/scene/fixtures.h"

namespace deburr::tb::image_codec_test {
namespace {

bool openimageio_is_loaded() {
  return test::read_bytes("/proc/self/maps").find("libOpenImageIO") != std::string::npos;
}

TEST(ImageCodec, RenderingAndWritingPngDoNotLoadIt) {
  const test::TemporaryFolder folder;
  write_image(folder / "picture.png", render(make_scene("quad", {.texture_size = 16}), {16, 16}));
  EXPECT_EQ(folder.files(), 1u);
  EXPECT_FALSE(openimageio_is_loaded());
}

TEST(ImageCodec, ReadingAndOtherFormatsLoadIt) {
  const test::TemporaryFolder folder;
  const Image image = noise(5, 4);
  write_image(folder / "picture.png", image);
  ASSERT_FALSE(openimageio_is_loaded());
  EXPECT_EQ(read_image(folder / "picture.png"), image);
  EXPECT_TRUE(openimageio_is_loaded());
  write_image(folder / "picture.tif", image);
  EXPECT_EQ(read_image(folder / "picture.tif"), image);
}

}  // namespace
}  // namespace deburr::tb::image_codec_test
