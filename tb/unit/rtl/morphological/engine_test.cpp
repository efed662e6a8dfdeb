// SPDX-License-Identifier: MIT
// The whole morphological engine: sizes, symmetry, accounts, waves, bad parameters, and faults that
// the checks must catch.
#include <fstream>
#include <sstream>

#include "tb/unit/rtl/morphological/placed_engine.h"
#include "tb/unit/rtl/morphological/vectors.h"

namespace deburr::tb::morphological_rtl::engine_test {
namespace {

namespace reg = spec::morphological::reg;
using spec::morphological::Preset;

// ---- sizes --------------------------------------------------------------------------------------

struct Size {
  int width, height;
};
void PrintTo(const Size& s, std::ostream* out) { *out << s.width << 'x' << s.height; }
class Sizes : public ::testing::TestWithParam<Size> {};

// Frames of any size, one after the other, through each kind of engine: the same pixels.
TEST_P(Sizes, GiveTheSamePixelsInEveryEngine) {
  const Size size = GetParam();
  ClockDomain clock("clock", period());
  const Frame frame = noise(size.width, size.height);
  struct Kind {
    int lanes_code;
    spec::morphological::Storage storage;
  };
  const Kind kinds[] = {{0, spec::morphological::Storage::kLineBuffers},
                        {1, spec::morphological::Storage::kMemory},
                        {2, spec::morphological::Storage::kLineBuffers}};
  std::vector<std::unique_ptr<PlacedEngine>> engines;
  std::uint64_t wanted = 0;
  for (const Kind& kind : kinds) {
    Parameters p = preset(Preset::kMlaaSlope, 6, 9);
    p.lanes = static_cast<spec::morphological::Lanes>(kind.lanes_code);
    p.storage = kind.storage;
    p.line_pixels = size.width;
    engines.push_back(
        std::make_unique<PlacedEngine>("k" + std::to_string(kind.lanes_code), clock, p));
  }
  for (auto& one : engines) {
    one->software.set_size(size.width, size.height);
    const auto beats = beats_of(frame, lanes_of(one->engine.parameters()));
    wanted += 2 * beats.size();
    one->driver.send(beats);
    one->driver.send(beats);
  }
  ASSERT_TRUE(clock.run_until(
      [&] {
        std::uint64_t received = 0;
        for (auto& one : engines) received += one->sink.received();
        return received == wanted;
      },
      4'000'000));
  std::vector<std::vector<Rgba8>> pixels;
  for (auto& one : engines) {
    std::vector<Rgba8>& all = pixels.emplace_back();
    for (const spec::morphological::BlendedBeat& beat : one->sink.beats()) {
      for (std::size_t i = 0; i < beat.count; ++i) all.push_back(beat.pixel[i]);
      EXPECT_EQ(beat.end_of_row, all.size() % static_cast<std::size_t>(size.width) == 0);
    }
    ASSERT_EQ(all.size(), 2 * frame.pixel.size());
    EXPECT_TRUE(std::equal(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2),
                           all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2)))
        << "the second frame is the first one again";
  }
  EXPECT_EQ(pixels[1], pixels[0]);
  EXPECT_EQ(pixels[2], pixels[0]);
}

INSTANTIATE_TEST_SUITE_P(Any, Sizes,
                         ::testing::Values(Size{1, 1}, Size{1, 2}, Size{2, 1}, Size{1, 70},
                                           Size{70, 1}, Size{2, 2}, Size{3, 5}, Size{4, 4},
                                           Size{5, 3}, Size{6, 40}, Size{7, 7}, Size{16, 16},
                                           Size{17, 9}, Size{63, 20}, Size{64, 20}, Size{65, 20},
                                           Size{127, 11}, Size{1000, 3}, Size{8192, 2}));

// A frame of one row or one column has no corner with a crossing: it passes unchanged.
TEST(SizesBlock, OneColumnPassesUnchanged) {
  EngineBench bench(deburr_line());
  const Frame column = noise(1, 50);
  EXPECT_EQ(hash(bench.run(column)), hash(column));
  const Frame line_of_noise = noise(200, 1);
  EXPECT_EQ(hash(bench.run(line_of_noise)), hash(line_of_noise));
  const Frame flat = draw(40, 40, [](int, int) { return grey(200); });
  EXPECT_EQ(hash(bench.run(flat)), hash(flat));
  EXPECT_EQ(bench.engine.blender.blended_pixels.value(), 0u);
}

TEST(Pixels, AlphaPassesAndAnIsolatedStepBlendsAsTheContractsTableSays) {
  EngineBench bench(preset(Preset::kMlaa));
  // A Z of three pixels: boundary on row 6 for x < 5, on row 7 from 8 on; between on row 6 / 7 ..
  Frame frame = draw(13, 12, [](int x, int y) {
    const int boundary = x < 5 ? 5 : x < 8 ? 6 : 7;
    Rgba8 p = grey(y >= boundary ? 255 : 0);
    p[3] = static_cast<std::uint8_t>(x + y);
    return p;
  });
  const Frame out = bench.run(frame);
  // Weights of the run of three on top edges of row 6: b85 b11/a11 a85.
  const auto probe = [&](int x, int y) {
    return bench.sink.beats()[static_cast<std::size_t>(y * 13 + x)].probe[0];
  };
  // Before: the start's crossing is north, so the upper pixels (row 5) take from below.
  EXPECT_EQ(probe(5, 5).second, 85);
  EXPECT_EQ(probe(6, 5).second, 11);
  EXPECT_EQ(probe(6, 6).first, 11);
  EXPECT_EQ(probe(7, 6).first, 85);
  EXPECT_EQ(probe(6, 6).edges, 2);
  EXPECT_EQ(probe(6, 3), spec::morphological::BlendProbe{});
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 13; ++x) EXPECT_EQ(out.at(x, y)[3], x + y);
}

// ---- pixels that are left -----------------------------------------------------------------------

struct Leaving {
  const char* name;
  Parameters (*configuration)();
  int lanes_code;
  bool in_memory;
};
void PrintTo(const Leaving& leaving, std::ostream* out) { *out << leaving.name; }
class LeftPixels : public ::testing::TestWithParam<Leaving> {};

// Of the frame that no rule leaves alone: what is left is as it came, everything else is the same.
TEST_P(LeftPixels, AreAsTheyCameAndNothingElseChanges) {
  constexpr std::uint32_t kBeside = 2;
  Parameters p = GetParam().configuration();
  p.lanes = static_cast<spec::morphological::Lanes>(GetParam().lanes_code);
  if (GetParam().in_memory) p.storage = spec::morphological::Storage::kMemory;
  EngineBench bench(p);
  const int lanes = lanes_of(p), w = 83, h = 47;
  Frame frame = blocks(w, h);
  stimuli::Sequence random;
  for (Rgba8& pixel : frame.pixel) pixel[3] = static_cast<std::uint8_t>(random.next() >> 16 | 1);
  for (std::size_t i = 0; i < frame.pixel.size(); ++i)
    if ((random.next() >> 16) % 12 == 0) frame.pixel[i][3] &= 0xFE;
  const auto run = [&](std::uint32_t bypass) {
    bench.bus.write(reg::kConfiguration,
                    (bench.bus.read(reg::kConfiguration) & ~(7u << 24)) | bypass << 24);
    bench.bus.write(reg::kControl, reg::kControlEnable | reg::kControlClearCounters);
    const std::size_t before = bench.sink.beats().size();
    bench.run(frame);
    return std::vector<spec::morphological::BlendedBeat>(
        bench.sink.beats().begin() + static_cast<std::ptrdiff_t>(before), bench.sink.beats().end());
  };
  const auto whole = run(0);
  const spec::morphological::Work work = bench.engine.work();
  ASSERT_GT(work.blended_pixels, 300u);
  ASSERT_EQ(work.bypassed_pixels, 0u);
  const auto marked = [&](int x, int y) {
    return x >= 0 && x < w && y >= 0 && y < h && frame.at(x, y)[3] % 2 == 0;
  };
  for (const std::uint32_t bypass : {1u, kBeside, 3u}) {
    const auto beats = run(bypass);
    const auto beats_a_row = static_cast<std::size_t>((w + lanes - 1) / lanes);
    spec::morphological::Work expected = work;
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        const std::size_t beat = static_cast<std::size_t>(y) * beats_a_row +
                                 static_cast<std::size_t>(x / lanes),
                          lane = static_cast<std::size_t>(x % lanes);
        const bool left =
            marked(x, y) || (bypass == kBeside && (marked(x, y - 1) || marked(x - 1, y) ||
                                                   marked(x + 1, y) || marked(x, y + 1)));
        spec::morphological::BlendProbe probe = whole[beat].probe[lane];
        Rgba8 pixel = whole[beat].pixel[lane];
        if (left) {
          const bool took = probe.first != 0 || probe.second != 0;
          expected.bypassed_pixels += took;
          expected.blended_pixels -= took;
          probe.first = probe.second = 0;
          probe.horizontal = false;
          pixel = frame.at(x, y);
        }
        pixel[3] = frame.at(x, y)[3] | 1;
        // Halved weights are the Blender's test; here they leave the rest alone.
        if (bypass == 3 && !left && (probe.first != 0 || probe.second != 0)) {
          const int dx = probe.horizontal, dy = !probe.horizontal;
          const bool first = probe.first != 0 && marked(x - dx, y - dy),
                     second = probe.second != 0 && marked(x + dx, y + dy);
          if (first || second) {
            const spec::morphological::BlendProbe& half = beats[beat].probe[lane];
            ASSERT_EQ(beats[beat].pixel[lane][3], pixel[3]);
            const bool takes = half.first != 0 || half.second != 0;
            expected.bypassed_pixels += !takes;
            expected.blended_pixels -= !takes;
            ASSERT_EQ(half.horizontal, probe.horizontal && takes);
            if (p.blend == spec::morphological::BlendRule::kLongest) {
              ASSERT_EQ(half.first, probe.first >> first);
              ASSERT_EQ(half.second, probe.second >> second);
            }
            continue;
          }
        }
        ASSERT_EQ(beats[beat].probe[lane], probe) << x << ' ' << y;
        ASSERT_EQ(beats[beat].pixel[lane], pixel) << x << ' ' << y;
      }
    EXPECT_EQ(bench.engine.work(), expected);
    EXPECT_GT(expected.bypassed_pixels, 10u);
    EXPECT_EQ(bench.bus.read(reg::kBypassedPixels), expected.bypassed_pixels);
  }
}
INSTANTIATE_TEST_SUITE_P(
    Any, LeftPixels,
    ::testing::Values(
        Leaving{"deburr_line_1", [] { return deburr_line(); }, 0, false},
        Leaving{"deburr_line_4", [] { return deburr_line(); }, 2, false},
        Leaving{"mlaa_2", [] { return preset(Preset::kMlaa); }, 1, false},
        Leaving{"mlaa_memory_4", [] { return preset(Preset::kMlaa); }, 2, true},
        Leaving{"slope_memory_1", [] { return preset(Preset::kMlaaSlope); }, 0, true},
        Leaving{"smaa_1", [] { return smaa(); }, 0, false},
        Leaving{"smaa_2", [] { return smaa(spec::morphological::Quality::kMedium); }, 1, false},
        Leaving{"smaa_dynamic_4",
                [] { return smaa(spec::morphological::Quality::kUltra, Preset::kSmaaDynamic); }, 2,
                false}),
    [](const auto& row) { return std::string(row.param.name); });

// Mirroring the frame mirrors the output, whatever its size.
TEST(Symmetry, MirroredFramesGiveMirroredOutput) {
  Parameters p = preset(Preset::kDeburrLine, 9, 9);
  p.lanes = spec::morphological::Lanes::kTwo;
  p.steps = 5;
  EngineBench bench(p);
  const Frame frame = blocks(91, 60);
  const int w = frame.width, h = frame.height;
  const Frame out = bench.run(frame);
  const Frame across = bench.run(draw(w, h, [&](int x, int y) { return frame.at(w - 1 - x, y); }));
  const Frame upright = bench.run(draw(w, h, [&](int x, int y) { return frame.at(x, h - 1 - y); }));
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      ASSERT_EQ(across.at(w - 1 - x, y), out.at(x, y)) << x << ' ' << y;
      ASSERT_EQ(upright.at(x, h - 1 - y), out.at(x, y)) << x << ' ' << y;
    }
}

TEST(Symmetry, InvertedCodesGiveInvertedOutput) {
  Parameters p = deburr_line();
  p.linear_light = false;
  EngineBench bench(p);
  const Frame frame = blocks();
  const auto inverse = [](Rgba8 c) {
    for (std::size_t i = 0; i < 3; ++i) c[i] = static_cast<std::uint8_t>(255 - c[i]);
    return c;
  };
  const Frame out = bench.run(frame);
  const Frame inverted = bench.run(
      draw(frame.width, frame.height, [&](int x, int y) { return inverse(frame.at(x, y)); }));
  for (std::size_t i = 0; i < out.pixel.size(); ++i)
    ASSERT_EQ(inverted.pixel[i], inverse(out.pixel[i])) << i;
}

// Records carry fifteen bits of their slot's number: two rows of 8192 beats, exactly.
TEST(SlotNumbers, WrapInTheWidestRows) {
  constexpr int kWidth = spec::morphological::kMaxFrameSize, kPart = 90, kHeight = 12;
  Parameters p = preset(Preset::kDeburrLine, 9);
  p.steps = 7;
  p.line_pixels = kWidth;
  EngineBench bench(p);
  const Frame pattern = noise(kPart, kHeight);
  // The same pixels at both ends of a row, so that records are found in its first and last slots.
  const Frame in = draw(kWidth, kHeight, [&](int x, int y) {
    return x < kPart             ? pattern.at(x, y)
           : x >= kWidth - kPart ? pattern.at(x - (kWidth - kPart), y)
                                 : grey(0);
  });
  const Frame out = bench.run(in);
  EXPECT_EQ(bench.engine.area.descriptors.value(), bench.engine.extractor.descriptors_sent.value());
  EXPECT_GT(bench.engine.area.descriptors.value(), 400u);
  EXPECT_EQ(bench.engine.extractor.descriptor_stalls.value(), 0u);
  int blended = 0;
  // Extensions reach seven steps of at most a few pixels; the middle of the part sees no border.
  for (int y = 0; y < kHeight; ++y)
    for (int x = 40; x < 50; ++x) {
      ASSERT_EQ(out.at(x, y), out.at(x + kWidth - kPart, y)) << x << ' ' << y;
      blended += out.at(x, y) != in.at(x, y);
    }
  EXPECT_GT(blended, 20);
}

// ---- accounts, waves, memories ------------------------------------------------------------------

TEST(Accounts, EveryUnitHasItsNameAndEveryClockItsClass) {
  EngineBench bench(deburr_line());
  bench.run(blocks());
  std::vector<std::string> names;
  for (const rtl::Unit* unit : bench.engine.units()) {
    names.emplace_back(unit->basename());
    EXPECT_EQ(unit->busy_cycles() + unit->stalled_cycles() + unit->idle_cycles(),
              bench.clock.cycle());
  }
  EXPECT_THAT(names, ::testing::UnorderedElementsAre(
                         "slot_sequencer", "luma_unit", "edge_detector", "run_extractor",
                         "endpoint_predictor_h", "endpoint_predictor_v", "line_unit_h",
                         "line_unit_v", "area_unit", "pixel_store", "blender"));
  // Every slot is a busy clock of the pipe.
  EXPECT_EQ(bench.engine.sequencer.busy_cycles(), (80u + 37u) * 90u);
  EXPECT_EQ(bench.engine.blender.busy_cycles(), 80u * 90u + 5u);
  EXPECT_EQ(bench.engine.beat_latency.count(), 80u * 90u);
}

TEST(Accounts, MemoriesAreThoseOfTheContract) {
  Parameters p = deburr_line();
  p.line_pixels = 1920;
  p.edge_source = spec::morphological::EdgeSource::kPredicated;
  EngineBench bench(p);
  std::map<std::string, std::uint64_t> bits;
  std::map<std::string, std::string> ports;
  for (const rtl::MemoryBase* memory : bench.engine.memories()) {
    bits[memory->basename()] = memory->logical_bits();
    ports[memory->basename()] = memory->ports();
    EXPECT_EQ(memory->not_implementable(), "") << memory->name();
  }
  EXPECT_EQ(bits["luma_lines"], 144'000u);
  EXPECT_EQ(ports["luma_lines"], "1R1W of 2 words");  // a beat's column and the one beside it
  EXPECT_EQ(ports["depth_lines"], "1R1W");
  EXPECT_EQ(bits["depth_lines"], 92'160u);
  for (const char* const lines : {"pixel_lines0", "pixel_lines1", "pixel_lines2", "pixel_lines3"})
    EXPECT_EQ(bits[lines], 614'400u);
  EXPECT_EQ(bits["weight_lines"], 92'160u);
  EXPECT_EQ(bits["row_marks"], 1920u * 26u);
  EXPECT_EQ(bits["row_descriptors"], 1920u * 95u);
  EXPECT_EQ(bits["column_marks"], 1920u * 21u);
  EXPECT_EQ(bits["column_descriptors"], 1920u * 95u);
  EXPECT_EQ(bits["linear_rom"], 256u * 12u);
  EXPECT_EQ(bits["encode_rom"], 4096u * 8u);
  EXPECT_EQ(bits["inverse_rom"], 68u * 27u);
  EXPECT_EQ(bits["edge_window"], 257'280u);
  EXPECT_EQ(bits["edge_rows_even"] + bits["edge_rows_odd"], 138'240u);
  EXPECT_EQ(bits["descriptor_fifo_h0"], 256u * 60u);
  EXPECT_EQ(bench.engine.window.memory.bits_at(960), 257'280u / 2);
}

TEST(Accounts, LearnedSharesAddThreeTablesAndABitARecord) {
  Parameters p = deburr();
  p.line_pixels = 1920;
  p.lanes = spec::morphological::Lanes::kTwo;
  EngineBench bench(p);
  std::map<std::string, const rtl::MemoryBase*> all;
  for (const rtl::MemoryBase* memory : bench.engine.memories()) {
    all[memory->basename()] = memory;
    EXPECT_EQ(memory->not_implementable(), "") << memory->name();
  }
  EXPECT_EQ(all.count("depth_lines"), 0u);
  EXPECT_EQ(all["row_descriptors"]->logical_bits(), 1920u * 96u);
  EXPECT_EQ(all["column_descriptors"]->logical_bits(), 1920u * 96u);
  EXPECT_EQ(all["descriptor_fifo_h0"]->logical_bits(), 256u * 60u);
  struct Table {
    const char* name;
    std::uint64_t words;
    const char* built_as;
  };
  for (const Table& table :
       {Table{"weights_a", 1024, "4 copies of 2RW"}, Table{"weights_b", 640, "4 copies of 2RW"},
        Table{"weights_c", 640, "4 copies of 2RW"}, Table{"weight_rom", 256, "4 copies of 2R"}}) {
    EXPECT_EQ(all[table.name]->logical_bits(), 8 * table.words) << table.name;
    EXPECT_EQ(all[table.name]->ports(), "8R");
    EXPECT_EQ(all[table.name]->built_as(), table.built_as);
    EXPECT_EQ(all[table.name]->physical_bits(), 4 * 8 * table.words);
  }
}

TEST(Accounts, TheTextGuardAddsLinesOfHashesAndItsBits) {
  Parameters p = deburr();
  p.line_pixels = 1920;
  p.text_guard = true;
  EngineBench bench(p);
  std::map<std::string, const rtl::MemoryBase*> all;
  for (const rtl::MemoryBase* memory : bench.engine.memories()) {
    all[memory->basename()] = memory;
    EXPECT_EQ(memory->not_implementable(), "") << memory->name();
  }
  EXPECT_EQ(all["guard_row"]->logical_bits(), 1920u * 6u);
  EXPECT_EQ(all["guard_columns"]->logical_bits(), 1920u * (10u * 6u + 13u + 10u));
  EXPECT_EQ(all["guard_colours"]->logical_bits(), 1920u * 3u);
  EXPECT_EQ(all["guards"]->logical_bits(), 29u * 1920u + 32u);
  for (const char* const lines : {"guard_row", "guard_columns", "guard_colours"}) {
    EXPECT_EQ(all[lines]->ports(), "1R1W");
    EXPECT_EQ(all[lines]->bits_at(960), all[lines]->logical_bits() / 2);
  }
}

TEST(Accounts, WithoutTheTextGuardNothingOfItIsBuilt) {
  EngineBench bench(deburr());
  EXPECT_EQ(bench.engine.text_guard, nullptr);
  for (const rtl::MemoryBase* memory : bench.engine.memories())
    EXPECT_FALSE(std::string(memory->basename()).starts_with("guard")) << memory->name();
  for (const rtl::LinkBase* link : bench.engine.links())
    EXPECT_EQ(std::string(link->name()).find("guard"), std::string::npos) << link->name();
}

// A row of one pixel still has a column beside it.
TEST(Memories, OfTheNarrowestRowsHaveTheirBanks) {
  Parameters p;
  p.line_pixels = 1;
  EngineBench bench(p);
  for (const rtl::MemoryBase* memory : bench.engine.memories())
    if (std::string(memory->basename()) == "luma_lines") {
      EXPECT_EQ(memory->words(), 2u);
    }
}

// Every memory that there is, also where the model keeps something else.
TEST(Memories, OfStorageInMemoryAreAllReported) {
  Parameters p = in_memory();
  p.line_pixels = 1920;
  p.memory_outstanding = 32;
  p.descriptor_fifo = 256;
  EngineBench bench(p);
  std::map<std::string, std::uint64_t> bits;
  for (const rtl::MemoryBase* memory : bench.engine.memories())
    bits[memory->basename()] = memory->logical_bits();
  for (const char* const lines : {"pixel_lines0", "pixel_lines1", "pixel_lines2", "pixel_lines3"})
    EXPECT_EQ(bits[lines], 61'440u);
  EXPECT_EQ(bits["gather_line"], 512u);
  EXPECT_EQ(bits["writes_in_flight"], 32u);
  EXPECT_EQ(bits["reads_in_flight"], 32u);
  // A place for each line that may come back, read or written: its 512 bits and two of status.
  EXPECT_EQ(bits["response_buffer"], 2u * 32u * 514u);
  EXPECT_EQ(bits["descriptor_fifo_h0"], 256u * 60u);
}

TEST(Waves, ShowTheLinksOfTheEngine) {
  const std::string file = ::testing::TempDir() + "morphological_rtl.vcd";
  {
    EngineBench::Options options;
    options.bench.trace = rtl::TraceOptions{};
    options.bench.trace->file = file;
    options.bench.trace->scopes = {"engine*"};
    EngineBench bench(deburr_line(), options);
    EXPECT_EQ(hash(bench.run(blocks())), vector_hash("blocks_deburr_line_default"));
  }
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  EXPECT_THAT(text.str(), ::testing::HasSubstr("edge_bits"));
  EXPECT_THAT(text.str(), ::testing::HasSubstr("extractor"));
  std::remove(file.c_str());
}

TEST(Observers, SeeEveryRunAndEveryLine) {
  EngineBench bench(deburr_line());
  std::uint64_t runs = 0, lines = 0;
  bench.engine.observe_runs([&](const spec::morphological::RunDescriptor&) { ++runs; });
  bench.engine.observe_lines([&](const spec::morphological::LineDescriptor& line) {
    ++lines;
    EXPECT_LE(line.slope, 1u << 23);
  });
  bench.run(blocks());
  EXPECT_EQ(runs, 1198u);
  EXPECT_EQ(lines, bench.engine.work().divides);
}

// ---- parameters ---------------------------------------------------------------------------------

struct BadParameter {
  const char* says;
  void (*change)(Parameters&);
};
void PrintTo(const BadParameter& b, std::ostream* out) { *out << b.says; }
class BadParameters : public ::testing::TestWithParam<BadParameter> {};
TEST_P(BadParameters, AreNamed) {
  ClockDomain clock("clock", period());
  Parameters p = deburr_line();
  GetParam().change(p);
  try {
    rtl::morphological::MorphologicalEngine engine("engine", clock, p);
    FAIL() << "no error";
  } catch (const spec::ConfigError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr(GetParam().says));
  }
}
INSTANTIATE_TEST_SUITE_P(
    Bad, BadParameters,
    ::testing::Values(
        BadParameter{"window_rows", [](auto& p) { p.window_rows = 67; }},
        BadParameter{"window_rows", [](auto& p) { p.window_rows = 8; }},
        BadParameter{"steps = 8 with window_rows = 18", [](auto& p) { p.window_rows = 18; }},
        BadParameter{"search_columns", [](auto& p) { p.search_columns = 3; }},
        BadParameter{"predicated",
                     [](auto& p) {
                       p.edge_source = spec::morphological::EdgeSource::kPredicated;
                       p.threshold_mode = spec::morphological::ThresholdMode::kDynamic;
                     }},
        BadParameter{"diagonal_steps = 10 with window_rows = 20",
                     [](auto& p) {
                       p.window_rows = 20;
                       p.diagonals = true;
                       p.diagonal_steps = 10;
                     }},
        BadParameter{"threshold", [](auto& p) { p.threshold = 0; }},
        BadParameter{"edges.threshold", [](auto& p) { p.threshold = 1 << 24; }},
        BadParameter{"edges.alpha", [](auto& p) { p.alpha = -1; }},
        BadParameter{"edges.alpha", [](auto& p) { p.alpha = 1 << 24; }},
        BadParameter{"edges.floor", [](auto& p) { p.floor = 0; }},
        BadParameter{"edges.floor", [](auto& p) { p.floor = 1 << 24; }},
        BadParameter{"search_steps", [](auto& p) { p.search_steps = 0; }},
        BadParameter{"1..112", [](auto& p) { p.search_steps = 113; }},
        BadParameter{"diagonal_steps", [](auto& p) { p.diagonal_steps = 0; }},
        BadParameter{"1..16", [](auto& p) { p.diagonal_steps = 17; }},
        BadParameter{"corner_rounding", [](auto& p) { p.corner_rounding = -1; }},
        BadParameter{"0..256", [](auto& p) { p.corner_rounding = 257; }},
        BadParameter{"divider.latency = 13 is outside 14..64",
                     [](auto& p) { p.divider_latency = 13; }},
        BadParameter{"area = learned with diagonals = true",
                     [](auto& p) {
                       p.area = spec::morphological::AreaSource::kLearned;
                       p.diagonals = true;
                     }},
        BadParameter{"area = learned with round_corners = true",
                     [](auto& p) {
                       p.area = spec::morphological::AreaSource::kLearned;
                       p.round_corners = true;
                     }},
        BadParameter{"threshold_mode = dynamic with edges.source = colour",
                     [](auto& p) {
                       p.edge_source = spec::morphological::EdgeSource::kColour;
                       p.threshold_mode = spec::morphological::ThresholdMode::kDynamic;
                     }},
        BadParameter{"border = clamp with ends = gaps",
                     [](auto& p) {
                       p.border = spec::morphological::Border::kClamp;
                       p.area = spec::morphological::AreaSource::kTableFull;
                     }},
        BadParameter{"border = clamp with area = analytic",
                     [](auto& p) {
                       p.border = spec::morphological::Border::kClamp;
                       p.ends = spec::morphological::Ends::kCrossings;
                     }},
        BadParameter{"divider.latency = 1 is outside 14..64",
                     [](auto& p) { p.divider_latency = 1; }},
        BadParameter{"give window_rows of at least 20", [](auto& p) { p.window_rows = 18; }},
        BadParameter{"line_pixels", [](auto& p) { p.line_pixels = 8193; }}));

// What the rejected ones would be with a row, a clock or a rule changed.
class GoodParameters : public ::testing::TestWithParam<BadParameter> {};
TEST_P(GoodParameters, AreBuilt) {
  ClockDomain clock("clock", period());
  Parameters p = deburr_line();
  GetParam().change(p);
  EXPECT_NO_THROW(rtl::morphological::MorphologicalEngine("engine", clock, p));
}
INSTANTIATE_TEST_SUITE_P(
    AtTheirLimits, GoodParameters,
    ::testing::Values(
        BadParameter{"steps", [](auto& p) { p.window_rows = 20; }},
        BadParameter{"divider", [](auto& p) { p.divider_latency = 14; }},
        BadParameter{"predicated, fixed",
                     [](auto& p) { p.edge_source = spec::morphological::EdgeSource::kPredicated; }},
        BadParameter{
            "luma, dynamic",
            [](auto& p) { p.threshold_mode = spec::morphological::ThresholdMode::kDynamic; }},
        BadParameter{"colour, fixed",
                     [](auto& p) { p.edge_source = spec::morphological::EdgeSource::kColour; }},
        BadParameter{"corners, not learned", [](auto& p) { p.round_corners = true; }},
        BadParameter{"diagonal steps that are not built", [](auto& p) {
                       p.window_rows = 20;
                       p.diagonal_steps = 10;
                     }}));

// One row less would not do.
TEST(DiagonalParameters, ReachAsFarAsTheWindow) {
  Parameters p = smaa();
  p.diagonal_steps = spec::morphological::kMaxDiagonalSteps;
  p.window_rows = 2 * p.diagonal_steps + 2;
  EXPECT_NO_THROW(EngineBench bench(p));
}

TEST(BadFrames, AreNamed) {
  EngineBench bench(deburr_line());
  EXPECT_THROW(bench.software.set_size(0, 5), spec::ConfigError);
  EXPECT_THROW(bench.software.set_size(5, 8193), spec::ConfigError);
  EXPECT_THROW(bench.software.set_size(257, 5), spec::ConfigError);
  EXPECT_THROW(bench.software.set_size(5, 0), spec::ConfigError);
  EXPECT_NO_THROW(bench.software.set_size(256, 5));
  EXPECT_NO_THROW(bench.software.set_size(1, 1));
  EXPECT_NO_THROW(bench.software.set_size(256, 8192));
  EXPECT_EQ(bench.bus.read(reg::kSize), 256u | 8192u << 16);
}

// ---- faults -------------------------------------------------------------------------------------

struct Injected {
  const char* fault;
};
void PrintTo(const Injected& p, std::ostream* out) { *out << p.fault; }
class Faults : public ::testing::TestWithParam<Injected> {};

// Each of these must be noticed: by the hash, a check, or the watchdog.
TEST_P(Faults, AreCaught) {
  EngineBench::Options options;
  options.bench.faults = {GetParam().fault};
  options.bench.check_links = false;
  options.bench.patience = 5'000;
  EngineBench bench(preset(Preset::kMlaaSlope), options);
  bool caught = false;
  try {
    caught = hash(bench.run(noise(), 100'000)) != vector_hash("noise_slope") ||
             bench.engine.work().probes != 9200u;
  } catch (const spec::SimulationError& error) {
    // A injected fault that was never reached is no catch.
    caught = std::string(error.what()).find("never") == std::string::npos;
  } catch (const std::exception&) {
    caught = true;
  }
  EXPECT_TRUE(caught);
}
INSTANTIATE_TEST_SUITE_P(
    Injected, Faults,
    ::testing::Values(Injected{"flip:engine.slots:2000:pixel.0.g.7"},
                      Injected{"flip:engine.lumas:3000:luma.0.23"},
                      Injected{"flip:engine.edge_bits:2500:left"},
                      Injected{"drop:engine.edge_bits:2500"},        // a slot is lost
                      Injected{"duplicate:engine.area_slots:4500"},  // a slot comes twice
                      Injected{"flip:engine.sums_h0:200:last.3"},    // position of the last corner
                      Injected{"drop:engine.lines_v0:50"},           // a record is lost
                      Injected{"drop:engine.finished:20"},           // a record never ends
                      Injected{"flip:engine.pixels:3000:centre.0.g.7"},
                      Injected{"drop:engine.weights:3000"},   // a slot is lost
                      Injected{"drop:engine.frames_done:0"},  // the frame never ends
                      Injected{"stuck_ready:engine.beats:3000"}));

// ---- links of memory ----------------------------------------------------------------------------

// A frame may lie anywhere in 32 bits of address, and every answer finds its request.
TEST(MemoryLinks, CarryWholeAddressesAndTags) {
  Parameters p = preset(Preset::kDeburrLine);
  p.storage = spec::morphological::Storage::kMemory;
  const EngineBench bench(p);
  std::size_t found = 0;
  rtl::for_each<rtl::LinkBase>([&](const rtl::LinkBase& link) {
    const std::string name = link.name();
    if (!name.ends_with(".requests") && !name.ends_with(".responses")) return;
    ++found;
    EXPECT_EQ(link.payload().find("address")->bits, 32u) << name;
    EXPECT_EQ(link.payload().find("tag")->bits, rtl::morphological::PixelStore::kTagBits) << name;
  });
  EXPECT_EQ(found, 2u);
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::engine_test
