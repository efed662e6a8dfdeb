// SPDX-License-Identifier: MIT
// Beats, registers and learned weights that the driver of the morphological engine writes, compared
// with docs/reference/registers.md and docs/reference/morphological/learned_weights.md by hand, and
// the inputs that it rejects.
#include "rtl_model/platform/morphological_driver.h"

#include "spec/morphological/registers.h"
#include "tb/unit/platform/fakes.h"

namespace deburr::tb::morphological_driver_test {
namespace {

using platform::MorphologicalDriver;
using platform::PixelFrame;
using spec::morphological::Parameters;
using spec::morphological::PixelBeat;
using spec::morphological::Rgba8;
using testing::ElementsAre;
using testing::HasSubstr;
namespace reg = spec::morphological::reg;

// ---- Beats -------------------------------------------------------------------------------------

TEST(PixelBeats, RowsAreSplitIntoBeatsOfLanes) {
  std::vector<Rgba8> pixels;
  std::vector<std::uint32_t> depth;
  for (std::uint8_t i = 0; i < 10; ++i) {
    pixels.push_back({i, 0, 0, 255});
    depth.push_back(100u + i);
  }
  const PixelFrame frame = {5, 2, pixels, depth};
  const std::vector<PixelBeat> beats = platform::beats_of(frame, 4);
  ASSERT_EQ(beats.size(), 4u);
  EXPECT_EQ(platform::beats_a_row(5, 4), 2u);
  EXPECT_EQ(platform::beats_a_row(4, 4), 1u);
  EXPECT_TRUE(beats[0].start_of_frame);
  EXPECT_FALSE(beats[0].end_of_row);
  EXPECT_EQ(beats[0].count, 4);
  EXPECT_EQ(beats[0].pixel[3], (Rgba8{3, 0, 0, 255}));
  EXPECT_EQ(beats[0].depth[3], 103u);
  EXPECT_FALSE(beats[1].start_of_frame);
  EXPECT_TRUE(beats[1].end_of_row);
  EXPECT_EQ(beats[1].count, 1);
  EXPECT_EQ(beats[1].pixel[0], (Rgba8{4, 0, 0, 255}));
  EXPECT_EQ(beats[1].pixel[1], Rgba8{});
  EXPECT_FALSE(beats[2].start_of_frame);
  EXPECT_EQ(beats[2].pixel[0], (Rgba8{5, 0, 0, 255}));
  EXPECT_TRUE(beats[3].end_of_row);
  EXPECT_EQ(beats[3].depth[0], 109u);
  EXPECT_EQ(platform::pixel_beat({5, 2, pixels, {}}, 0, 1, 4).depth[0], 0u);
}

TEST(FrameBytes, RowsBeginAtMultiplesOf64) {
  EXPECT_EQ(platform::frame_bytes(16, 3), 192u);
  EXPECT_EQ(platform::frame_bytes(17, 3), 384u);
  EXPECT_EQ(platform::frame_bytes(8192, 8192), 1u << 28);
}

// ---- Registers ---------------------------------------------------------------------------------

// Every configuration field 0.
Parameters nothing() {
  Parameters p;
  p.edge_source = spec::morphological::EdgeSource::kLuma;
  p.threshold_mode = spec::morphological::ThresholdMode::kFixed;
  p.dynamic_luma = {};
  p.local_contrast = spec::morphological::LocalContrast::kOff;
  p.predictor = spec::morphological::Predictor::kNone;
  p.steps = 0;
  p.contiguous = p.safe = p.linear_light = p.trim = p.diagonals = p.round_corners = false;
  p.ends = {};
  p.area = spec::morphological::AreaSource::kAnalytic;
  p.blend = {};
  p.bypass = {};
  p.search_steps = p.diagonal_steps = p.corner_rounding = 0;
  return p;
}

struct Bed {
  explicit Bed(const Parameters& p = nothing()) : driver(registers, p, &memory) {
    registers.values[reg::kId] = 0xDEB00105;
    registers.values[reg::kStatus] = 1;
  }
  FakeRegisters registers;
  FakeMemory memory{1 << 16};
  MorphologicalDriver driver;
};
using Write = std::pair<std::uint32_t, std::uint32_t>;

// One field after the other, at the bits that docs/reference/registers.md gives.
TEST(MorphologicalDriver, WritesEachConfigurationField) {
  Bed b;
  const auto with = [&](auto&& change) {
    Parameters p = nothing();
    change(p);
    b.driver.set_configuration(p);
    return b.registers.values[reg::kConfiguration];
  };
  using namespace spec::morphological;  // NOLINT: the choices
  EXPECT_EQ(with([](Parameters&) {}), 0u);
  EXPECT_EQ(with([](Parameters& p) { p.edge_source = static_cast<EdgeSource>(3); }), 3u);
  EXPECT_EQ(with([](Parameters& p) { p.threshold_mode = ThresholdMode::kDynamic; }), 1u << 2);
  EXPECT_EQ(with([](Parameters& p) { p.dynamic_luma = static_cast<DynamicLuma>(1); }), 1u << 3);
  EXPECT_EQ(with([](Parameters& p) { p.dynamic_luma = static_cast<DynamicLuma>(2); }), 2u << 3);
  EXPECT_EQ(with([](Parameters& p) { p.local_contrast = static_cast<LocalContrast>(3); }), 3u << 5);
  EXPECT_EQ(with([](Parameters& p) { p.predictor = static_cast<Predictor>(2); }), 2u << 7);
  EXPECT_EQ(with([](Parameters& p) { p.steps = 31; }), 31u << 9);
  EXPECT_EQ(with([](Parameters& p) { p.contiguous = true; }), 1u << 14);
  EXPECT_EQ(with([](Parameters& p) { p.safe = true; }), 1u << 15);
  EXPECT_EQ(with([](Parameters& p) { p.linear_light = true; }), 1u << 16);
  EXPECT_EQ(with([](Parameters& p) { p.trim = true; }), 1u << 17);
  EXPECT_EQ(with([](Parameters& p) { p.ends = Ends::kCrossings; }), 1u << 18);
  for (const AreaSource table :
       {AreaSource::kTableFull, AreaSource::kTableMerged, AreaSource::kTableMinimal})
    EXPECT_EQ(with([table](Parameters& p) { p.area = table; }), 1u << 19);
  EXPECT_EQ(with([](Parameters& p) { p.diagonals = true; }), 1u << 20);
  EXPECT_EQ(with([](Parameters& p) { p.round_corners = true; }), 1u << 21);
  EXPECT_EQ(with([](Parameters& p) { p.blend = BlendRule::kStrongest; }), 1u << 22);
  EXPECT_EQ(with([](Parameters& p) { p.bypass = static_cast<Bypass>(3); }), 3u << 24);
  EXPECT_EQ(with([](Parameters& p) { p.bypass = static_cast<Bypass>(4); }), 4u << 24);
  EXPECT_EQ(with([](Parameters& p) { p.area = AreaSource::kLearned; }), 1u << 23);
  EXPECT_EQ(with([](Parameters& p) { p.text_guard = true; }), 1u << 28);
}

TEST(MorphologicalDriver, WritesConfigurationAndThresholds) {
  Bed b;
  Parameters p = nothing();
  p.trim = true;
  p.threshold = 1;
  p.threshold_on_depth_edge = 2;
  p.threshold_off_depth_edge = 3;
  p.alpha = 4;
  p.floor = 5;
  p.depth_threshold = 6;
  p.search_steps = 0x70;
  p.diagonal_steps = 0x1F;
  p.corner_rounding = 0x100;
  b.driver.set_configuration(p);
  EXPECT_THAT(b.registers.written,
              ElementsAre(Write{0x10, 1u << 17}, Write{0x14, 1}, Write{0x18, 2}, Write{0x1C, 3},
                          Write{0x20, 4}, Write{0x24, 5}, Write{0x28, 6}, Write{0x30, 0x1001F70}));
}

TEST(MorphologicalDriver, WritesAddressesAndSize) {
  Bed b;
  b.driver.identify();
  b.driver.place(0x1000);
  b.driver.set_size(61, 45);
  EXPECT_THAT(b.registers.written, ElementsAre(Write{0x2C, 0x1000}, Write{0x0C, 61 | 45 << 16}));
}

TEST(MorphologicalDriver, ReadsEngineState) {
  Bed b;
  b.registers.values[reg::kPixels] = 100;
  b.registers.values[reg::kDiagonals] = 7;
  b.registers.values[reg::kBypassedPixels] = 9;
  b.registers.values[reg::kFrameCycles] = 1234;
  b.registers.values[reg::kMemoryErrors] = 2;
  EXPECT_EQ(b.driver.work().pixels, 100u);
  EXPECT_EQ(b.driver.work().diagonal_pixels, 7u);
  EXPECT_EQ(b.driver.work().bypassed_pixels, 9u);
  EXPECT_EQ(b.driver.frame_cycles(), 1234u);
  EXPECT_EQ(b.driver.memory_errors(), 2u);
}

TEST(MorphologicalDriver, LoadsLearnedWeightsAndChecksTheirSum) {
  EXPECT_EQ(platform::kWeightEntries, 2304u);
  EXPECT_EQ(platform::weights_sum(std::vector<std::int8_t>{1, -1, 2}), 1u + 2 * 255 + 3 * 2);
  Parameters p = nothing();
  p.area = spec::morphological::AreaSource::kLearned;
  Bed b(p);
  std::vector<std::int8_t> weights(2304, 1);
  weights.back() = -1;
  b.registers.values[reg::kWeightsSum] = 2303u * 2304 / 2 + 2304 * 255;
  b.driver.load_weights(weights);
  ASSERT_EQ(b.registers.written.size(), 2305u);
  EXPECT_EQ(b.registers.written.front(), (Write{0x80, 0}));
  EXPECT_EQ(b.registers.written[1], (Write{0x84, 1}));
  EXPECT_EQ(b.registers.written.back(), (Write{0x84, 255}));
  b.registers.values[reg::kWeightsSum] = 5;
  EXPECT_THAT(error_of<spec::SimulationError>([&] { b.driver.load_weights(weights); }),
              HasSubstr("WEIGHTS_SUM reads 0x5"));
  weights.pop_back();
  EXPECT_THAT(error_of<spec::ConfigError>([&] { b.driver.load_weights(weights); }),
              HasSubstr("2303 learned weights, expected 2304"));
  Bed without;
  EXPECT_THAT(error_of<spec::ConfigError>(
                  [&] { without.driver.load_weights(std::vector<std::int8_t>(2304)); }),
              HasSubstr("built without learned weights"));
}

// ---- Misuse ------------------------------------------------------------------------------------

TEST(MorphologicalDriver, WritesNothingToBusyEngine) {
  Parameters p = nothing();
  p.area = spec::morphological::AreaSource::kLearned;
  Bed b(p);
  b.registers.values[reg::kStatus] = 0;
  const auto busy = [&](auto&& action) { return error_of<spec::SimulationError>(action); };
  EXPECT_EQ(busy([&] { b.driver.set_size(8, 8); }),
            "driver of the morphological engine: SIZE while it is busy: wait until STATUS says "
            "idle");
  EXPECT_THAT(busy([&] { b.driver.place(0); }), HasSubstr("PIXEL_BASE while it is busy"));
  EXPECT_THAT(busy([&] { b.driver.set_configuration(p); }),
              HasSubstr("a new configuration while it is busy"));
  EXPECT_THAT(busy([&] { b.driver.load_weights(std::vector<std::int8_t>(2304)); }),
              HasSubstr("learned weights while it is busy"));
  EXPECT_TRUE(b.registers.written.empty());
}

TEST(MorphologicalDriver, RejectsSizesOutOfRange) {
  Parameters p = nothing();
  p.line_pixels = 100;
  Bed b(p);
  const auto size = [&](int width, int height) {
    return error_of<spec::ConfigError>([&] { b.driver.set_size(width, height); });
  };
  EXPECT_EQ(size(0, 5),
            "driver of the morphological engine: width of the frame: expected 1..8192, got 0");
  EXPECT_THAT(size(-5, 5), HasSubstr("width of the frame"));
  EXPECT_THAT(size(5, 8193), HasSubstr("height of the frame: expected 1..8192, got 8193"));
  EXPECT_THAT(size(101, 5), HasSubstr("a frame of 101 pixels does not fit into line_pixels = 100"));
  EXPECT_TRUE(b.registers.written.empty());
  EXPECT_EQ(size(100, 8192), "") << "memory is not used with line buffers";
}

TEST(MorphologicalDriver, RejectsFrameLargerThanMemory) {
  Parameters p = nothing();
  p.storage = spec::morphological::Storage::kMemory;
  Bed b(p);
  const auto size = [&](int width, int height) {
    return error_of<spec::ConfigError>([&] { b.driver.set_size(width, height); });
  };
  EXPECT_EQ(size(16, 1024), "");
  EXPECT_EQ(size(16, 1025),
            "driver of the morphological engine: region pixels (0x0 to 0x1003f) ends past the "
            "memory of 65536 bytes: make it larger, or the input smaller");
  b.driver.place(64);
  EXPECT_THAT(size(16, 1024), HasSubstr("region pixels (0x40 to 0x1003f)"));
  EXPECT_EQ(size(16, 1023), "");
  EXPECT_THAT(error_of<spec::ConfigError>([&] { b.driver.place(32); }),
              HasSubstr("frame base 0x20 is not a multiple of 64"));
  MorphologicalDriver without(b.registers, p);
  EXPECT_NO_THROW(without.set_size(16, 1025));
}

}  // namespace
}  // namespace deburr::tb::morphological_driver_test
