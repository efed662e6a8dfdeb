// SPDX-License-Identifier: MIT
// Textures in memory and scenes as the unit receives them: the position of each texel, the
// registers, and reading back by the golden model.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "golden/texture/sampling.h"
#include "spec/error.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/parameters.h"
#include "spec/texture/registers.h"
#include "tb/engines/texture/texture_levels.h"
#include "tb/engines/texture/texture_scene.h"
#include "tb/scene/block_encoder.h"
#include "tb/scene/compressed_file.h"
#include "tb/scene/quality.h"
#include "tb/scene/reference.h"
#include "tb/scene/textures.h"
#include "tb/stimuli/compressed_files.h"

namespace deburr::tb::scene_test {
namespace {

TEST(TextureMemory, TexelsFollowFormatAndLayout) {
  const Image image = noise(37, 21, 3);
  const std::vector<Image> levels = mip_chain(image);
  for (const spec::texture::Layout layout :
       {spec::texture::Layout::kLinear, spec::texture::Layout::kTiled}) {
    for (std::size_t f = 0; f < spec::texture::kFormatNames.size(); ++f) {
      spec::texture::Descriptor sampler;
      sampler.format = static_cast<spec::texture::Format>(f);
      if (spec::texture::is_compressed(sampler.format)) continue;
      sampler.layout = layout;
      platform::TextureMemory memory;
      const int handle = memory.add(levels_of(levels), sampler);
      const spec::texture::Descriptor& d =
          memory.descriptors().at(static_cast<std::size_t>(handle));
      EXPECT_EQ(d.levels, levels.size());
      const std::size_t bytes = spec::texture::kFormatBytes[f];
      for (std::size_t k = 0; k < levels.size(); ++k) {
        EXPECT_EQ(d.base[k] % 64, 0u);
        std::map<std::uint32_t, int> used;
        for (int y = 0; y < levels[k].height; ++y)
          for (int x = 0; x < levels[k].width; ++x) {
            const std::uint32_t a = golden::texture::texel_address(d, static_cast<int>(k), x, y);
            EXPECT_EQ(used[a]++, 0) << "two texels in one place";
            std::uint32_t value = 0;
            for (std::size_t i = 0; i < bytes; ++i)
              value |= static_cast<std::uint32_t>(memory.bytes().at(a + i)) << (8 * i);
            EXPECT_EQ(value, platform::encode_texel(d.format, levels[k].at(x, y)));
          }
        EXPECT_TRUE(k == 0 || used.begin()->first > d.base[k - 1]) << "levels overlap";
      }
    }
  }
}

// Every level, so that its base and the padding before it count too.
void expect_in_memory(const platform::TextureMemory& memory, const CompressedTexture& texture) {
  const spec::texture::Descriptor& d = memory.descriptors().at(0);
  const std::size_t bytes =
      spec::texture::kFormatBlockBytes[static_cast<std::size_t>(texture.format)];
  ASSERT_EQ(d.levels, texture.levels.size());
  for (std::size_t k = 0; k < texture.levels.size(); ++k) {
    const CompressedTexture::Level& level = texture.levels[k];
    const std::uint8_t* block = level.blocks.data();
    for (int y = 0; y < level.height; y += 4)
      for (int x = 0; x < level.width; x += 4, block += bytes) {
        const std::uint32_t a = golden::texture::texel_address(d, static_cast<int>(k), x, y);
        ASSERT_LE(a + bytes, memory.bytes().size());
        EXPECT_TRUE(std::equal(block, block + bytes, memory.bytes().begin() + a))
            << "level " << k << ", texel " << x << ", " << y;
      }
  }
}

TEST(TextureMemory, RejectsUnsupportedTextures) {
  platform::TextureMemory memory;
  const auto add = [&](const std::vector<Image>& levels) {
    return memory.add(levels_of(levels), {});
  };
  const std::vector<Image> one = {Image(1, 1)};
  EXPECT_THROW(add({}), spec::ConfigError);
  EXPECT_THROW(add({Image(4097, 1)}), spec::ConfigError);
  EXPECT_THROW(add({Image(0, 0)}), spec::ConfigError);
  EXPECT_THROW(add({Image(4, 4), Image(3, 2)}), spec::ConfigError);
  EXPECT_THROW(add({Image(1, 1), Image(1, 1)}), spec::ConfigError);
  const std::vector<platform::Texel> few(3);
  const platform::TextureLevel torn[] = {{2, 2, few}};
  EXPECT_THROW(memory.add(torn, {}), spec::ConfigError);
  for (int i = 0; i < spec::texture::kMaxTextures; ++i) EXPECT_EQ(add(one), i);
  EXPECT_THROW(add(one), spec::ConfigError);
}

TEST(DescriptorRegisters, HoldEachFieldAtItsPosition) {
  namespace reg = spec::texture::reg;
  spec::texture::Descriptor d;
  d.width = 0x123;
  d.height = 0x456;
  d.levels = 11;
  d.format = spec::texture::Format::kSrgb8A8;
  d.srgb = true;
  d.layout = spec::texture::Layout::kTiled;
  d.wrap_s = spec::texture::Wrap::kMirroredRepeat;
  d.wrap_t = spec::texture::Wrap::kClampToEdge;
  d.min_filter = spec::texture::MinFilter::kLinearMipmapLinear;
  d.mag_filter = spec::texture::MagFilter::kLinear;
  d.max_anisotropy_log2 = 4;
  d.lod_bias = -256;
  d.min_lod = 0x0102;
  d.max_lod = 0x0A0B;
  for (std::size_t k = 0; k < d.base.size(); ++k) d.base[k] = static_cast<std::uint32_t>(64 * k);
  const auto writes = platform::descriptor_registers(3, d);
  const std::map<std::uint32_t, std::uint32_t> at(writes.begin(), writes.end());
  ASSERT_EQ(at.size(), 4u + spec::texture::kMaxLevels);
  const std::uint32_t start = reg::kTextureBase + 3 * reg::kTextureStride;
  EXPECT_EQ(at.at(start + reg::kSize), 0x04560123u);
  EXPECT_EQ(at.at(start + reg::kMode), 4u | 1u << 4 | 1u << 5 | 1u << 8 | 2u << 10 | 5u << 12 |
                                           1u << 16 | 11u << 20 | 4u << 24);
  EXPECT_EQ(at.at(start + reg::kLodBias), 0xFF00u);
  EXPECT_EQ(at.at(start + reg::kLodClamp), 0x0A0B0102u);
  EXPECT_EQ(at.at(start + reg::kLevelBase + 4 * 12), 64u * 12);
}

SceneParameters small(const char* source) {
  SceneParameters p;
  p.source = source;
  p.width = p.height = 32;
  p.texture_size = 32;
  return p;
}

TEST(TextureScene, ConfiguresTheSampler) {
  SamplerParameters sampler;
  sampler.mode = spec::texture::MinFilter::kNearestMipmapLinear;
  sampler.wrap = WrapChoice::kClampToEdge;
  sampler.levels = 3;
  sampler.lod_bias = -5;
  sampler.anisotropy = 2;
  const TextureScene scene(small("plane"), sampler, 1);
  ASSERT_EQ(scene.memory().descriptors().size(), scene.scene().mesh.textures.size());
  for (const spec::texture::Descriptor& d : scene.memory().descriptors()) {
    EXPECT_EQ(d.min_filter, spec::texture::MinFilter::kNearestMipmapLinear);
    EXPECT_EQ(d.wrap_s, spec::texture::Wrap::kClampToEdge);
    EXPECT_EQ(d.levels, 3);
    EXPECT_EQ(d.lod_bias, -5);
    EXPECT_EQ(d.max_anisotropy_log2, 2);
  }
  EXPECT_TRUE(scene.inputs().empty()) << "made by formula";
}

// Fragments, hardware and reference must use the same wrap mode, or an image is compared with the
// wrong reference.
TEST(TextureScene, WrapModeAppliesToFragmentsAndReference) {
  SceneParameters p = small("plane");
  p.texture = "gradient";
  const auto picture = [&](WrapChoice wrap, bool reference) {
    SamplerParameters sampler;
    sampler.wrap = wrap;
    const TextureScene scene(p, sampler, 1);
    RenderOptions options;
    options.width = options.height = 32;
    options.samples = 8;
    return reference ? render(scene.scene(), options)
                     : golden_frame(scene, spec::texture::Parameters{}).image;
  };
  const std::vector<WrapChoice> choices = {WrapChoice::kRepeat, WrapChoice::kMirroredRepeat,
                                           WrapChoice::kClampToEdge};
  for (const WrapChoice wrap : choices)
    for (const WrapChoice other : choices) {
      const double db = psnr(picture(wrap, false), picture(other, true));
      if (wrap == other)
        EXPECT_GT(db, 25) << static_cast<int>(wrap);
      else
        EXPECT_LT(db, 20) << static_cast<int>(wrap) << ' ' << static_cast<int>(other);
    }
}

SceneParameters textured(const std::string& texture) {
  SceneParameters p = small("quad");
  p.texture = texture;
  return p;
}
SamplerParameters sampled(spec::texture::Format format) {
  SamplerParameters sampler;
  sampler.format = format;
  return sampler;
}

TEST(TextureScene, EncodesEveryLevel) {
  for (const spec::texture::Layout layout :
       {spec::texture::Layout::kLinear, spec::texture::Layout::kTiled})
    for (const spec::texture::Format format :
         {spec::texture::Format::kBc1, spec::texture::Format::kBc5,
          spec::texture::Format::kEtc2Rgba8}) {
      SamplerParameters sampler = sampled(format);
      sampler.layout = layout;
      const TextureScene scene(textured("brick"), sampler, 1);
      expect_in_memory(scene.memory(),
                       stimuli::compressed(make_texture("brick", 32, 32, 1), format, 6));
      EXPECT_THAT(scene.scene().mesh.notes,
                  ::testing::ElementsAre(::testing::ContainsRegex("texture 'brick' as .* dB")));
    }
}

TEST(TextureScene, SrgbBlocksAreAveragedInLinearLight) {
  SamplerParameters sampler = sampled(spec::texture::Format::kBc1);
  sampler.srgb = true;
  const TextureScene scene(textured("checker"), sampler, 1);
  EXPECT_TRUE(scene.memory().descriptors()[0].srgb);
  CompressedTexture wanted{sampler.format, true, {}};
  for (const Image& level : mip_chain(make_texture("checker", 32, 32), MipSpace::kSrgb))
    wanted.levels.push_back({level.width, level.height, encode_blocks(level, sampler.format)});
  expect_in_memory(scene.memory(), wanted);
  EXPECT_NE(wanted.levels.back().blocks,
            encode_blocks(mip_chain(make_texture("checker", 32, 32)).back(), sampler.format));
}

TEST(TextureScene, BlocksOfAFileAreTakenAsTheyAre) {
  const std::string file = testing::TempDir() + "/blocks.ktx";
  // Levels of another image, so that a chain made of level 0 would differ.
  CompressedTexture texture =
      stimuli::compressed(make_texture("noise", 20, 12), spec::texture::Format::kBc3, 3);
  texture.levels[1] =
      stimuli::compressed(make_texture("brick", 10, 6), spec::texture::Format::kBc3, 1).levels[0];
  std::ofstream(file, std::ios::binary) << stimuli::ktx1_file(texture);

  const TextureScene same(textured(file), sampled(spec::texture::Format::kBc3), 1);
  expect_in_memory(same.memory(), texture);
  EXPECT_THAT(same.scene().mesh.notes,
              ::testing::ElementsAre(::testing::HasSubstr("bc3 blocks and 3 levels of the file")));
  EXPECT_EQ(same.inputs().size(), 1u);
  SamplerParameters coded = sampled(spec::texture::Format::kBc3);
  coded.srgb = true;
  EXPECT_THAT(TextureScene(textured(file), coded, 1).scene().mesh.notes,
              ::testing::ElementsAre(::testing::EndsWith(
                  "of the file; the file says linear: set sampler.srgb = false to read it so")));

  SamplerParameters fewer = sampled(spec::texture::Format::kBc3);
  fewer.levels = 2;
  CompressedTexture two = texture;
  two.levels.pop_back();
  expect_in_memory(TextureScene(textured(file), fewer, 1).memory(), two);

  const Image image = decoded(texture.levels[0], texture.format);
  const TextureScene other(textured(file), sampled(spec::texture::Format::kEtc2Rgb), 1);
  expect_in_memory(other.memory(), stimuli::compressed(image, spec::texture::Format::kEtc2Rgb, 5));
  const TextureScene texels(textured(file), sampled(spec::texture::Format::kRgba8), 1);
  platform::TextureMemory wanted;
  wanted.add(levels_of(mip_chain(image)), texels.memory().descriptors()[0]);
  EXPECT_EQ(texels.memory().bytes(), wanted.bytes());
  EXPECT_TRUE(texels.scene().mesh.notes.empty());
}

TEST(TextureScene, SameSeedGivesSameTextures) {
  SceneParameters p = small("plane");
  p.texture = "noise";
  const auto bytes = [&](std::uint32_t seed) {
    return TextureScene(p, SamplerParameters{}, seed).memory().bytes();
  };
  EXPECT_EQ(bytes(1), bytes(1));
  EXPECT_NE(bytes(1), bytes(2));
}

TEST(TextureScene, RejectsInvalidCameras) {
  for (const auto& [eye, target] : {std::pair{"1,2", ""},
                                    {"1,2,3,4", ""},
                                    {"a,b,c", ""},
                                    {"1,2,inf", ""},
                                    {"1,2,3 ", ""},
                                    {"", "1;2;3"},
                                    {"1,2,3", "1,2,3"}}) {
    SceneParameters p = small("plane");
    p.eye = eye;
    p.target = target;
    EXPECT_THROW(TextureScene(p, SamplerParameters{}, 1), spec::ConfigError)
        << eye << " " << target;
  }
}

TEST(GoldenFrame, CoversEveryFragmentOnce) {
  const TextureScene scene(small("object"), SamplerParameters{}, 1);
  const GoldenFrame frame = golden_frame(scene, spec::texture::Parameters{});
  EXPECT_EQ(frame.work.fragments, scene.stream().counts.fragments);
  EXPECT_EQ(frame.rgba.size(), 4 * scene.stream().counts.fragments);
  EXPECT_EQ(frame.image.width, 32);
}

}  // namespace
}  // namespace deburr::tb::scene_test
