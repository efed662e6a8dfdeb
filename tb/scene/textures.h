// SPDX-License-Identifier: MIT
// Procedural textures and mip chains. Integer arithmetic or IEEE + - * / only, so that the same
// name, size and seed give the same bytes on every machine.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "spec/texture/descriptor.h"
#include "tb/scene/image.h"

namespace deburr::tb {

// `cells` x `cells` squares over the whole texture, the first (top left) in `a`.
Image checkerboard(int width, int height, int cells = 8, const Rgba8& a = {255, 255, 255, 255},
                   const Rgba8& b = {0, 0, 0, 255});
// Asphalt grain, solid lane borders, a dashed centre line along t, as in paper 004, Fig. 5.
Image road(int width, int height, std::uint32_t seed = 1);
Image brick(int width, int height, std::uint32_t seed = 1);  // running bond, eight courses
// Properties of ground photographs: stones with edges in every direction, shades from 1/f noise,
// grain down to the texel. Tiles if both sides are multiples of 128.
Image stones(int width, int height, std::uint32_t seed = 1);
// Rings of cos(pi r^2 / size): the frequency reaches Nyquist at the middle of each border.
Image zone_plate(int width, int height);
Image gradient(int width, int height);                       // R = s, G = t, B = 255 - s
Image noise(int width, int height, std::uint32_t seed = 1);  // white noise in R, G, B

// The names accepted by make_texture: "checker", "road", "brick", "stones", "zone_plate",
// "gradient", "noise".
std::span<const std::string_view> texture_names();
// Throws ConfigError for an unknown name (listing the known) or a side
// outside 1..spec::texture::kMaxTextureSize.
Image make_texture(std::string_view name, int width, int height, std::uint32_t seed = 1);

// Which values are averaged: those stored, or the linear light that sRGB bytes encode.
enum class MipSpace { kStored, kSrgb };

// Levels of size max(1, w >> k), max(1, h >> k), down to 1 x 1. A texel is the exact area average
// (box) of the level above, rounded half up; an odd size averages three source texels. Every second
// mean of two is a half, so those of a texture one texel wide or high are rounded half to even.
// Alpha is always averaged as stored.
std::vector<Image> mip_chain(const Image& base, MipSpace space = MipSpace::kStored);

// sRGB transfer curve (IEC 61966-2-1) between stored [0, 1] and linear light [0, 1].
double srgb_to_linear(double stored);
double linear_to_srgb(double linear);

}  // namespace deburr::tb
