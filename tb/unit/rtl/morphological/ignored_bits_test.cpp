// SPDX-License-Identifier: MIT
// Inputs that the morphological engine must ignore: depths when edges do not use depth, alphas
// without a bypass, lanes after the last pixel of a row, bytes between the rows of a frame in
// memory, and unused register bits. Random values there must not change pixels, probes, work or
// cycles. As a control, noise in used bits must change them.
#include <algorithm>
#include <bit>
#include <functional>
#include <string>
#include <vector>

#include "tb/base/random.h"
#include "tb/harness/engine_state.h"
#include "tb/unit/rtl/morphological/support.h"
#include "tb/unit/rtl/morphological/vectors.h"

namespace deburr::tb::morphological_rtl::ignored_bits_test {
namespace {

using spec::morphological::Bypass;
using spec::morphological::EdgeSource;
using spec::morphological::PixelBeat;
namespace reg = spec::morphological::reg;

struct Build {
  spec::morphological::Preset preset;
  const char* settings;
};
void PrintTo(const Build& b, std::ostream* out) {
  *out << spec::morphological::kPresetNames[static_cast<std::size_t>(b.preset)] << ' '
       << b.settings;
}

// The result of a frame, without alpha, which passes unchanged.
struct Trail {
  std::vector<std::array<int, 7>> pixels;  // R, G, B, and the blend probe
  std::vector<Cycle> cycles;               // of the beats
  std::vector<std::string> state;
};

class IgnoredBits : public ::testing::TestWithParam<Build> {
 protected:
  static constexpr int kWidth = 29, kHeight = 21;  // multiples of neither beats nor lines of memory
  static Parameters parameters() {
    Parameters p = preset(GetParam().preset, 8, 20);
    p.line_pixels = 64;
    apply_settings(p, "diagonal_steps=4 steps=4");
    apply_settings(p, GetParam().settings);
    return p;
  }
  // Stairs that are nearer where they are brighter; every seventh pixel is marked.
  static Frame stairs() {
    const auto above = [](int x, int y) { return (x + 3 * y) / 7 % 2; };
    Frame frame = draw(kWidth, kHeight, [&](int x, int y) {
      Rgba8 pixel = grey(above(x, y) * 200 + 20);
      pixel[3] = (x + 5 * y) % 7 == 0 ? 254 : 255;
      return pixel;
    });
    for (int i = 0; i < kWidth * kHeight; ++i)
      frame.depth[static_cast<std::size_t>(i)] =
          4'000'000 + 9'000'000 * static_cast<std::uint32_t>(above(i % kWidth, i / kWidth));
    return frame;
  }
  // Runs a frame whose beats are modified by `change`; calls `written` after its registers have
  // been written.
  Trail run(
      const std::function<void(PixelBeat&)>& change,
      const std::function<void()>& each_cycle = [] {},
      const std::function<void()>& written = [] {}) {
    reset_by(bench.clock, 40);
    const Cycle begin = bench.clock.cycle();
    auto beats = beats_of(stairs(), lanes_of(p));
    for (PixelBeat& beat : beats) change(beat);
    bench.driver.send([&](std::uint64_t i, PixelBeat& beat) {
      if (i >= beats.size()) return false;
      beat = beats[i];
      return true;
    });
    bench.software.set_size(kWidth, kHeight);
    written();
    bench.bench->run(
        [&] {
          each_cycle();
          return bench.sink.received() == beats.size() && bench.engine.idle();
        },
        100'000);
    Trail trail;
    for (const spec::morphological::BlendedBeat& beat : bench.sink.beats())
      for (std::size_t i = 0; i < beat.count; ++i)
        trail.pixels.push_back({beat.pixel[i][0], beat.pixel[i][1], beat.pixel[i][2],
                                beat.probe[i].horizontal, beat.probe[i].first, beat.probe[i].second,
                                beat.probe[i].edges});
    for (const Cycle cycle : bench.sink.cycles()) trail.cycles.push_back(cycle - begin);
    trail.state = engine_state(bench.engine, bench.bus);
    return trail;
  }
  static std::string difference(const Trail& a, const Trail& b) {
    if (a.pixels != b.pixels) return "pixels";
    if (a.cycles != b.cycles) return "cycles";
    return state_difference(a.state, b.state);
  }

  const Parameters p = parameters();
  EngineBench bench{p};
  Random random{1, "noise"};
};

TEST_P(IgnoredBits, InputNoiseChangesNothing) {
  const Trail fresh = run([](PixelBeat&) {});
  ASSERT_GT(bench.engine.work().blended_pixels, 50u);
  const bool depth_counts =
      p.edge_source == EdgeSource::kDepth || p.edge_source == EdgeSource::kPredicated;
  const auto depths = [&](std::uint32_t bits) {
    return run([&, bits](PixelBeat& beat) {
      for (std::uint32_t& depth : beat.depth) depth ^= random.word() & bits;
    });
  };
  // Only 24 bits are used, and only by edges from depth.
  EXPECT_EQ(difference(fresh, depths(0xFF000000)), "");
  EXPECT_EQ(!difference(fresh, depths(0xFFFFFFFF)).empty(), depth_counts);
  const auto alphas = [&](std::uint32_t bits) {
    return run([&, bits](PixelBeat& beat) {
      for (Rgba8& pixel : beat.pixel)
        pixel[3] = static_cast<std::uint8_t>(pixel[3] ^ (random.word() & bits));
    });
  };
  // The mark is bit 0, if the bypass uses it.
  EXPECT_EQ(difference(fresh, alphas(0xFE)), "");
  EXPECT_EQ(!difference(fresh, alphas(0xFF)).empty(), p.bypass != Bypass::kNone);
  // Lanes after the last pixel of a row.
  const auto lanes = [&](bool used) {
    return run([&, used](PixelBeat& beat) {
      for (std::size_t i = used ? 0 : beat.count; i < beat.pixel.size(); ++i) {
        for (std::uint8_t& channel : beat.pixel[i])
          channel = static_cast<std::uint8_t>(random.word());
        beat.depth[i] = random.word();
      }
    });
  };
  EXPECT_EQ(difference(fresh, lanes(false)), "");
  EXPECT_NE(difference(fresh, lanes(true)), "");
}

// Writes noise to the unused bits of every register.
TEST_P(IgnoredBits, RegisterNoiseChangesNothing) {
  const Trail fresh = run([](PixelBeat&) {});
  std::uint64_t ignored = 0;
  for (int round = 0; round < 3; ++round) {
    const auto noisy = [&](const spec::RegisterInfo& info) {
      const std::uint32_t noise = (round == 0 ? ~0u : random.word()) & ~info.mask();
      const bool is_state = info.written() != 0;
      bench.bus.write(info.offset, noise | (is_state ? bench.bus.read(info.offset) : 0));
      return static_cast<std::uint64_t>(std::popcount(noise));
    };
    const auto written = [&] {
      for (const spec::RegisterInfo& info : spec::morphological::kRegisters)
        if (info.writable() != 0) ignored += noisy(info);
      bench.bus.write(reg::kWeightsAddress, 0);  // writing an entry has incremented the address
    };
    // CONTROL is also written while a frame is inside. These writes are not counted: their number
    // would hide that no other register was written.
    const auto each_cycle = [&] {
      noisy(*spec::register_named(spec::morphological::kRegisters, "CONTROL"));
    };
    EXPECT_EQ(difference(fresh, run([](PixelBeat&) {}, each_cycle, written)), "");
  }
  EXPECT_GT(ignored, 100u);
}

INSTANTIATE_TEST_SUITE_P(
    Builds, IgnoredBits,
    ::testing::Values(
        Build{spec::morphological::Preset::kMlaa, "lanes=4"},
        Build{spec::morphological::Preset::kMlaaSlope, "edges.source=depth lanes=2"},
        Build{spec::morphological::Preset::kDeburrLine,
              "edges.source=predicated edges.threshold_off_depth_edge=16777215 bypass=half"},
        Build{spec::morphological::Preset::kSmaa, "lanes=2 bypass=marked"},
        Build{spec::morphological::Preset::kSmaaDynamic, "lanes=4 bypass=beside"},
        Build{spec::morphological::Preset::kDeburr, "lanes=4 storage=memory bypass=masked"},
        Build{spec::morphological::Preset::kDeburr, "lanes=2 text_guard=true"}));

// Padding is written as 0 and read back with its line.
class Padding : public IgnoredBits {};
TEST_P(Padding, RowPaddingIsIgnored) {
  constexpr std::uint32_t kStride = 128;
  const Trail fresh = run([](PixelBeat&) {});
  // In every cycle, so that every line is read with noise.
  const auto noise = [&](std::uint32_t from, std::uint32_t to) {
    return run([](PixelBeat&) {},
               [&, from, to] {
                 std::vector<std::uint8_t> bytes(to - from);
                 for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.word());
                 for (std::uint32_t y = 0; y < kHeight; ++y)
                   bench.memory->preload(y * kStride + from, bytes);
               });
  };
  EXPECT_EQ(difference(fresh, noise(4 * kWidth, kStride)), "");
  EXPECT_NE(difference(fresh, noise(4 * kWidth - 4, kStride)), "");
}

INSTANTIATE_TEST_SUITE_P(
    Builds, Padding,
    ::testing::Values(Build{spec::morphological::Preset::kMlaa, "storage=memory"},
                      Build{spec::morphological::Preset::kMlaa, "storage=memory lanes=2"},
                      Build{spec::morphological::Preset::kDeburr,
                            "storage=memory lanes=4 bypass=masked"}));

}  // namespace
}  // namespace deburr::tb::morphological_rtl::ignored_bits_test
