// SPDX-License-Identifier: MIT
// The TexelAddresser alone. Expected values are worked out by hand from
// docs/reference/texture/formats.md.
#include "rtl_model/texture/texel_addresser.h"

#include "tb/unit/rtl/datasheets.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl::texel_addresser_test {
namespace {

using namespace rtl::texture;
using testing::ElementsAre;
constexpr std::int32_t kOne = spec::texture::kCoordinateOne;

struct AddresserBench {
  AddresserBench() {
    unit.samples_in(ends.in);
    unit.texels_out(ends.out);
  }
  // The request for one sample of the descriptor.
  TexelToken address(const spec::texture::Descriptor& d, std::int64_t s, std::int64_t t,
                     bool linear, std::uint8_t level = 0) {
    write_descriptor(store.bus, 0, d);
    ends.source.add({ticket(), s, t, 256, 1, 0, level, linear, true, true});
    clock.run(9);
    return ends.sink.taken.back().token;
  }
  ClockDomain clock{"clock", period()};
  Store store{clock};
  TexelAddresser unit{"unit", clock, store.descriptors.for_texels};
  Ends<SampleToken, TexelToken> ends{clock};
};

spec::texture::Descriptor texture(int width, int height, spec::texture::Format format,
                                  spec::texture::Layout layout, spec::texture::Wrap wrap) {
  spec::texture::Descriptor d;
  d.width = static_cast<std::uint16_t>(width);
  d.height = static_cast<std::uint16_t>(height);
  d.levels = 1;
  d.format = format;
  d.layout = layout;
  d.wrap_s = d.wrap_t = wrap;
  d.base[0] = 0x1000;
  return d;
}

TEST(TextureRtlAddresser, WrapsByHand) {
  AddresserBench b;
  using W = spec::texture::Wrap;
  // L8, 8 x 8, linear layout: address = 0x1000 + 64 y + x.
  struct Row {
    W wrap;
    std::int64_t s;
    bool linear;
    std::uint32_t x0, x1;
    int fraction;
  };
  const std::int64_t half = kOne / 2, quarter = kOne / 4;
  for (const Row& r : std::vector<Row>{
           {W::kRepeat, 0, true, 7, 0, 128},
           {W::kRepeat, kOne / 16, true, 0, 1, 0},
           {W::kRepeat, -quarter, true, 5, 6, 128},
           {W::kRepeat, 300ll * kOne - 1, true, 7, 0, 128},
           {W::kRepeat, kOne - 1, false, 7, 7, 0},
           {W::kRepeat, kOne, false, 0, 0, 0},
           {W::kMirroredRepeat, kOne + quarter, true, 5, 6, 128},
           {W::kMirroredRepeat, -1, false, 0, 0, 0},
           {W::kMirroredRepeat, kOne, false, 7, 7, 0},
           {W::kMirroredRepeat, 2ll * kOne, true, 0, 0, 128},
           {W::kMirroredRepeat, kOne, true, 7, 7, 128},
           {W::kClampToEdge, -half, true, 0, 0, 128},
           {W::kClampToEdge, 5ll * kOne, true, 7, 7, 128},
           {W::kClampToEdge, -1, false, 0, 0, 0},
           {W::kClampToEdge, half + quarter, false, 6, 6, 0},
           // 1/256 texel is 2^13 of 2^24; half of that rounds up, less does not.
           {W::kClampToEdge, kOne / 16 + 4096, true, 0, 1, 1},
           {W::kClampToEdge, kOne / 16 + 4095, true, 0, 1, 0},
       }) {
    SCOPED_TRACE(testing::Message() << "wrap " << int(r.wrap) << " s " << r.s);
    const TexelToken t =
        b.address(texture(8, 8, spec::texture::Format::kL8, spec::texture::Layout::kLinear, r.wrap),
                  r.s, kOne / 16 + 3 * kOne / 8, r.linear);
    const std::uint32_t row = 0x1000 + 3 * 64, next = r.linear ? row + 64 : row;
    EXPECT_THAT(t.address, ElementsAre(row + r.x0, row + r.x1, next + r.x0, next + r.x1));
    EXPECT_EQ(t.control.fraction_u, r.fraction);
    EXPECT_EQ(t.control.fraction_v, 0);
  }
}

// Five texels: 6710887 x 5 is the first above 2 x 2^24, so the last bit counts.
TEST(TextureRtlAddresser, WrappingKeepsEveryBit) {
  AddresserBench b;
  auto d = texture(5, 5, spec::texture::Format::kL8, spec::texture::Layout::kLinear,
                   spec::texture::Wrap::kRepeat);
  EXPECT_EQ(b.address(d, 6710886 - 3ll * kOne, 0, false).address[0], 0x1001u);
  EXPECT_EQ(b.address(d, 6710887 + 3ll * kOne, 0, false).address[0], 0x1002u);
  d.wrap_s = spec::texture::Wrap::kMirroredRepeat;
  for (const std::int64_t direct : {6710886, 6710887}) {
    const std::uint32_t expected = direct == 6710886 ? 0x1001 : 0x1002;
    EXPECT_EQ(b.address(d, direct, 0, false).address[0], expected);
    EXPECT_EQ(b.address(d, 2ll * kOne - 1 - direct, 0, false).address[0], expected);
    EXPECT_EQ(b.address(d, -1 - direct, 0, false).address[0], expected);
  }
}

TEST(TextureRtlAddresser, LayoutsByHand) {
  AddresserBench b;
  using F = spec::texture::Format;
  using L = spec::texture::Layout;
  const auto nearest = [&](const spec::texture::Descriptor& d, int x, int y) {
    // The middle of the texel.
    const std::int64_t s = (2ll * x + 1) * kOne / (2 * d.width),
                       t = (2ll * y + 1) * kOne / (2 * d.height);
    return b.address(d, s, t, false).address[0] - 0x1000;
  };
  const auto wrap = spec::texture::Wrap::kRepeat;
  // 64 x 32 RGBA8: 16 x 8 tiles; tile (9, 5) = (1001, 101): 35 of the low three bits each, 64
  // above.
  EXPECT_EQ(nearest(texture(64, 32, F::kRgba8, L::kTiled, wrap), 37, 21), 99u * 64 + 16 + 4);
  // 32 x 64 RGBA8: 8 x 16 tiles; tile (5, 9): x = 101, y = 001: 16 + 2 + 1, 64 above.
  EXPECT_EQ(nearest(texture(32, 64, F::kRgba8, L::kTiled, wrap), 21, 37), (19u + 64) * 64 + 16 + 4);
  // 64 x 32 RGB565: tiles of 8 x 4, 8 x 8 of them; tile (4, 5): 16 + 2 + 32; inside (5, 1).
  EXPECT_EQ(nearest(texture(64, 32, F::kRgb565, L::kTiled, wrap), 37, 21), 50u * 64 + 16 + 10);
  // 64 x 32 L8: tiles of 8 x 8, 8 x 4; tile (4, 2): bits 00 and 10 interleave to 8, 16 above; (5,
  // 5).
  EXPECT_EQ(nearest(texture(64, 32, F::kL8, L::kTiled, wrap), 37, 21), 24u * 64 + 40 + 5);
  // 4096 x 4096 RGBA8: the far corner is the last texel of 2^26 bytes.
  EXPECT_EQ(nearest(texture(4096, 4096, F::kRgba8, L::kTiled, wrap), 4095, 4095), (1u << 26) - 4);
  // 5 x 3 RGBA4444, rows of 10 bytes rounded up to 64; 17 x 3 RGBA8, of 68 to 128.
  EXPECT_EQ(nearest(texture(5, 3, F::kRgba4444, L::kLinear, wrap), 3, 2), 128u + 6);
  EXPECT_EQ(nearest(texture(17, 3, F::kSrgb8A8, L::kLinear, wrap), 16, 2), 256u + 64);
  // 100 x 7 RGBA8: 25 x 2 tiles, rounded to 32 x 2; tile (24, 1): bit 1, and 12 above two bits.
  EXPECT_EQ(nearest(texture(100, 7, F::kRgba8, L::kTiled, wrap), 97, 5), (2u + 48) * 64 + 16 + 4);
}

TEST(TextureRtlAddresser, LevelsHaveTheirOwnSizeAndBase) {
  AddresserBench b;
  spec::texture::Descriptor d =
      texture(37, 5, spec::texture::Format::kRgba8, spec::texture::Layout::kLinear,
              spec::texture::Wrap::kClampToEdge);
  d.levels = 6;
  d.base[3] = 0x4000;  // 4 x 1 texels
  const TexelToken t = b.address(d, 100ll * kOne, 100ll * kOne, false, 3);
  EXPECT_EQ(t.address[0], 0x4000u + 3 * 4);
  // Addresses wrap at 2^32.
  d.base[0] = 0xFFFFFFC0;
  const TexelToken wrapped = b.address(d, 100ll * kOne, 0, false, 0);
  EXPECT_EQ(wrapped.address[0], 0xFFFFFFC0u + 36 * 4);
}

// Odd rows of the linear layout alone.
TEST(TextureRtlAddresser, TurnsOddRowsOfLinearTextures) {
  AddresserBench b;
  using L = spec::texture::Layout;
  const auto turned = [&](L layout, int y) {
    const auto d = texture(8, 8, spec::texture::Format::kL8, layout, spec::texture::Wrap::kRepeat);
    return b.address(d, 0, y * kOne / 8, true).turned;  // rows y - 1 and y
  };
  EXPECT_THAT(turned(L::kLinear, 1), ElementsAre(false, true));
  EXPECT_THAT(turned(L::kLinear, 2), ElementsAre(true, false));
  EXPECT_THAT(turned(L::kLinear, 0), ElementsAre(true, false));  // 7 and 0
  EXPECT_THAT(turned(L::kTiled, 1), ElementsAre(false, false));
  EXPECT_THAT(turned(L::kTiled, 2), ElementsAre(false, false));
}

TEST(TextureRtlAddresser, LatencyOfTheDatasheetAndOneAClock) {
  AddresserBench b;
  for (int i = 0; i < 5; ++i) b.ends.source.add({});
  b.ends.sink.hold_from = 9;
  b.ends.sink.hold_to = 12;
  b.clock.run(20);
  const Cycle first = 1 + TexelAddresser::datasheet().latency.clocks;  // pushed in 0, taken in 1
  EXPECT_THAT(clocks_of(b.ends.sink), ElementsAre(first, first + 1, first + 2, 12, 13));
  EXPECT_EQ(b.unit.bilinears.value(), 0u);  // their tickets are not valid
}

}  // namespace
}  // namespace deburr::tb::texture_rtl::texel_addresser_test
