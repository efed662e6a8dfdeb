// SPDX-License-Identifier: MIT
// The morphological engine for the test suites that every engine runs (tb/harness/engine_kit.h).
#pragma once

#include <fmt/format.h>

#include "rtl_model/morphological/register_section.h"
#include "tb/harness/engine_kit.h"
#include "tb/unit/rtl/morphological/support.h"
#include "tb/unit/rtl/token_suite.h"
#include "tb/unit/spec/vectors.h"

namespace deburr::tb::morphological_rtl {

namespace reg = spec::morphological::reg;

class Kit : public EngineKit {
 public:
  struct Build {
    int lanes_code;
    spec::morphological::Storage storage;
    int divider_interval;
    int width;  // of the frame of the job kWhole
    std::uint32_t memory_latency;
    bool smaa = false;          // with all SMAA blocks
    bool learned = false;       // learned weights
    const char* settings = "";  // in addition
  };
  static const std::array<Build, 28> kBuilds;
  static std::string text_of(const Build& build) {
    return fmt::format("{} lanes, {}, interval {}, width {}{}{} {}",
                       spec::morphological::kLaneCount[static_cast<std::size_t>(build.lanes_code)],
                       spec::morphological::kStorageNames[static_cast<std::size_t>(build.storage)],
                       build.divider_interval, build.width, build.smaa ? ", smaa" : "",
                       build.learned ? ", learned" : "", build.settings);
  }
  // Small steps, and an edge longer than the search range. The rows of this frame and of the job
  // kBroken do not end with a line of memory, so lines are padded.
  explicit Kit(const Build& build, const Disturbance& disturbance = {})
      : Kit(parameters(build), build.memory_latency, disturbance,
            draw(build.width, 11, [&](int x, int y) {
              return grey(x < build.width - 2 ? (y + x) / 3 % 2 * 255
                                              : (x - build.width + 2) * 255);
            })) {
    smaa_ = build.smaa;
    no_divides_ = build.learned && build.width <= 4;
  }
  explicit Kit(Random& random) : Kit(drawn(random), 20, {}, noise(29, 12)) {}

  ClockDomain& clock() { return bench_.clock; }
  platform::RegisterHost& bus() { return bench_.bus; }
  rtl::Engine& engine() { return bench_.engine; }
  rtl::RegisterSection section() const {
    return rtl::morphological::register_section(bench_.engine.parameters());
  }
  Bench& bench() { return *bench_.bench; }

  void start(Job job) {
    frame_ = job == Job::kWhole ? &whole_ : &broken_;
    if (!queued_) send(*frame_);
    bench_.software.set_size(frame_->width, frame_->height);
    bench_.wanted += beats();
    runs_.clear();
    lines_.clear();
    begin_ = bench_.clock.cycle();
    if (!queued_) return;
    // Disabled while the frame is inside, so that the next frame waits until its size is set.
    bench_.bus.write(reg::kControl, reg::kControlEnable);
    bench_.clock.run(5);
    EXPECT_EQ(bench_.bus.read(reg::kStatus) & reg::kStatusIdle, 0u);
    bench_.bus.write(reg::kControl, 0);
  }
  bool done() {
    return bench_.sink.received() == bench_.wanted &&
           (bench_.bus.read(reg::kStatus) & reg::kStatusIdle) != 0;
  }
  Outcome outcome() {
    NamedWords beats_out("beats"), cycles("cycles of beats"), work("work");
    for (std::size_t i = bench_.sink.beats().size() - beats(); i < bench_.sink.beats().size();
         ++i) {
      beats_out.add(bench_.sink.beats()[i]);
      cycles.add(bench_.sink.cycles()[i] - begin_);
    }
    const spec::morphological::Work done = bench_.engine.work();
    for (const auto& row : spec::morphological::kWorkCounts) work.add(done.*row.count);
    Outcome outcome = {
        {beats_out, {"runs", runs_}}, {work}, {cycles, {"lines as they are stored", lines_}}};
    if (bench_.memory) {
      outcome.data.emplace_back(
          "memory", bench_.memory->dump(0, static_cast<std::uint64_t>(64 * frame_->height)));
      const auto& store = bench_.engine.pixel_store;
      outcome.counted.emplace_back(
          "lines moved", std::array{store.lines_written.value(), store.lines_read.value()});
    }
    return outcome;
  }
  // With learned weights, narrow steps have no line.
  void expect_enough(Job job) {
    if (job == Job::kWhole) {
      EXPECT_FALSE(lines_.empty());
      EXPECT_EQ(bench_.engine.work().divides == 0, no_divides_);
      EXPECT_GT(bench_.engine.work().long_runs, 0u);
    } else {
      EXPECT_GT(bench_.engine.extractor.descriptor_stalls.value(), 0u);
      EXPECT_EQ(bench_.engine.work().diagonal_pixels != 0, smaa_);
    }
  }
  static constexpr bool kPrograms = true;
  void reset(Cycle cycles) {
    beats_.clear();
    queued_ = endless_ = false;
    bench_.wanted = 0;
    bench_.reset(cycles);
  }

  // --- resets ---
  Cycle long_reset() const { return bench_.memory ? 40 : 1; }
  void queue(std::span<const Job> jobs) {
    for (const Job job : jobs) send(job == Job::kWhole ? whole_ : broken_);
    queued_ = true;
  }
  // A frame of size 0 or one that is too wide: it is not accepted.
  static constexpr int kRejected = 2;
  void reject(int kind, Cycle cycles) {
    start(Job::kBroken);
    bench_.bus.write(reg::kSize, kind == 0 ? 0 : 33u | 12u << 16);
    bench_.clock.run(cycles);
    EXPECT_EQ(bench_.engine.work(), spec::morphological::Work{});
    EXPECT_EQ((bench_.bus.read(reg::kStatus) & reg::kStatusFraming) != 0, cycles > 1);
  }
  // A reset keeps the tables that WEIGHTS_DATA writes.
  static constexpr std::array kKept = {reg::kControl, reg::kWeightsData};
  void spoil() {
    if (bench_.memory)
      bench_.memory->fail_request(bench_.memory->reads() + bench_.memory->writes() + 3);
    bench_.software.set_size(broken_.width, broken_.height);
    send(broken_);
    beats_[40].start_of_frame = true;  // contradicts SIZE
    bench_.clock.run(50);
    bench_.bus.write(reg::kThreshold, 77);  // while a frame is inside
    EXPECT_TRUE(bench_.clock.run_until([&] { return bench_.driver.done() && bench_.engine.idle(); },
                                       50'000));
    EXPECT_EQ(bench_.bus.read(reg::kStatus),
              reg::kStatusIdle | reg::kStatusFrameDone | reg::kStatusFraming |
                  reg::kStatusWrittenWhileBusy | (bench_.memory ? reg::kStatusMemoryError : 0));
    for (const std::uint32_t counter : {reg::kPixels, reg::kEdgePixels, reg::kFrameCycles})
      EXPECT_GT(bench_.bus.read(counter), 0u) << counter;
    EXPECT_GT(bench_.engine.beat_latency.max(), 0u);
    bench_.bus.write(reg::kControl, 0);
    EXPECT_EQ(bench_.bus.read(reg::kControl), 0u);
  }

  // --- register noise, while pixels arrive ---
  static constexpr std::uint32_t kMostOffset = 0x200, kCycles = 80;
  static constexpr int kAccesses = 60;
  static constexpr std::uint64_t kNoiseSeeds = 60;
  void noise_begins() {
    if (bench_.engine.parameters().area == spec::morphological::AreaSource::kLearned)
      for (std::uint32_t entry = 0; entry < rtl::morphological::WeightsRom::kEntries; ++entry) {
        bench_.bus.write(reg::kWeightsAddress, entry);
        tables_.push_back(static_cast<std::int8_t>(bench_.bus.read(reg::kWeightsData)));
      }
    reset(kNoiseReset);
    send(whole_);
    endless_ = true;
  }
  void disturb(Random&) {}
  // Restores the learned weights, which the noise may have overwritten.
  void restore() {
    if (tables_.empty()) return;
    bench_.software.load_weights(tables_);
    bench_.bus.write(reg::kWeightsAddress, 0);
  }

  // --- tokens ---
  using Engine = rtl::morphological::MorphologicalEngine;
  using Tokens =
      TokenList<rtl::morphological::SlotToken, rtl::morphological::BeatToken,
                rtl::morphological::GuardSlotToken, rtl::morphological::GuardToken,
                rtl::morphological::LumaToken, rtl::morphological::EdgeToken,
                rtl::morphological::AreaSlotToken, rtl::morphological::FetchToken,
                rtl::morphological::DiagonalColumnsToken, rtl::morphological::DiagonalWeightsToken,
                rtl::morphological::WeightToken, rtl::morphological::PixelToken,
                rtl::morphological::RunToken, rtl::morphological::SumsToken,
                rtl::morphological::LineToken, rtl::morphological::FinishToken,
                rtl::morphological::FrameDoneToken, rtl::morphological::FrameConfiguration>;
  static constexpr int kFormats = 57;
  static constexpr const char* kTables = "reference/morphological/memories.md";
  static constexpr const char* kHeader = "rtl_model/morphological/morphological_engine.h";
  static constexpr const char* kFigure = "reference/morphological/index.md";
  // The drawn figures cover every build option; learned weights and diagonals exclude each other.
  static std::vector<Drawn<Parameters>> drawn_builds() {
    Parameters memory = in_memory(), guarded = deburr(), learned = deburr(), diagonal = smaa();
    memory.lanes = spec::morphological::Lanes::kFour;
    learned.storage = diagonal.storage = spec::morphological::Storage::kMemory;
    guarded.text_guard = learned.text_guard = diagonal.text_guard = true;
    const std::vector<std::string> units = {"DiagonalUnit", "WeightsLoader", "TextGuard",
                                            "EdgeRows",     "Blender",       "memory_error",
                                            "latched"};
    return {{"deburr-line", deburr_line()},
            {"deburr", deburr()},
            {"smaa", smaa()},
            {"mlaa, 4 lanes, memory", memory, true},
            {"deburr, text guard", guarded},
            {"", learned, false, false, units},
            {"", diagonal, false, false, units}};
  }

 private:
  Kit(const Parameters& p, std::uint32_t latency, const Disturbance& disturbance,
      const Frame& whole)
      : bench_(p, options(latency, disturbance)), whole_(marked(whole)) {
    bench_.engine.observe_runs(
        [this](const spec::morphological::RunDescriptor& run) { runs_.push_back(run); });
    bench_.engine.observe_lines(
        [this](const spec::morphological::LineDescriptor& line) { lines_.push_back(line); });
  }
  static EngineBench::Options options(std::uint32_t latency, const Disturbance& disturbance) {
    EngineBench::Options options;
    options.bench = disturbance.bench;
    options.memory_latency = latency;
    options.memory_scatter = disturbance.scatter;
    options.program = disturbance.program;
    options.period = disturbance.period;
    return options;
  }
  static Parameters parameters(const Build& build) {
    Parameters p = preset(spec::morphological::Preset::kMlaaSlope, 4, 6);
    p.steps = 3;
    p.lanes = static_cast<spec::morphological::Lanes>(build.lanes_code);
    p.storage = build.storage;
    p.divider_interval = build.divider_interval;
    p.divider_latency = 14;
    p.predictor_units = 1;
    p.descriptor_fifo = 2;
    p.line_pixels = 32;
    if (build.learned) {
      p.edge_source = spec::morphological::EdgeSource::kColour;
      p.area = spec::morphological::AreaSource::kLearned;
    }
    if (build.smaa) {
      p.predictor = spec::morphological::Predictor::kNone;
      p.steps = 0;
      p.ends = spec::morphological::Ends::kCrossings;
      p.area = spec::morphological::AreaSource::kTableMerged;
      p.search_steps = 2;
      p.diagonals = true;
      p.diagonal_steps = 4;
      p.round_corners = true;
      p.blend = spec::morphological::BlendRule::kStrongest;
    }
    apply_settings(p, build.settings);
    return p;
  }
  static Parameters drawn(Random& random) {
    Parameters p = preset(random.chance(500) ? spec::morphological::Preset::kDeburr
                                             : spec::morphological::Preset::kMlaaSlope,
                          4, 6);
    p.window_rows = 10;
    p.steps = 3;
    p.line_pixels = 64;
    p.lanes = static_cast<spec::morphological::Lanes>(random.below(3));
    p.storage = static_cast<spec::morphological::Storage>(random.below(2));
    p.descriptor_fifo = random.between(2, 9);
    p.text_guard = random.chance(500);
    return p;
  }
  // Adds a depth to each pixel and, for builds with a bypass, a mark to every fifth pixel.
  static Frame marked(Frame frame) {
    for (std::size_t i = 0; i < frame.pixel.size(); ++i) {
      frame.depth[i] = std::uint32_t{frame.pixel[i][0]} << 16;
      if (i % 5 == 0) frame.pixel[i][3] = 254;
    }
    return frame;
  }
  void send(const Frame& frame) {
    const auto more = beats_of(frame, lanes_of(bench_.engine.parameters()));
    beats_.insert(beats_.end(), more.begin(), more.end());
    bench_.driver.send([this](std::uint64_t i, spec::morphological::PixelBeat& beat) {
      if (i >= beats_.size() && !endless_) return false;
      beat = beats_[i % beats_.size()];
      return true;
    });
  }
  std::size_t beats() const {
    return static_cast<std::size_t>(beats_a_row(*frame_, bench_.engine.parameters()) *
                                    frame_->height);
  }

  EngineBench bench_;
  const Frame whole_, broken_ = marked(noise(29, 12));
  bool smaa_ = false, no_divides_ = false;
  const Frame* frame_ = nullptr;
  std::vector<spec::morphological::PixelBeat> beats_;
  bool queued_ = false, endless_ = false;
  Cycle begin_ = 0;
  std::vector<spec::morphological::RunDescriptor> runs_;
  std::vector<spec::morphological::LineDescriptor> lines_;  // in the order in which they are stored
  std::vector<std::int8_t> tables_;
};

using spec::morphological::Storage;
// In a frame with one beat per row, the first descriptor comes a few cycles after the reset. Where
// a line is answered in the cycle in which another is written, its read waits. The other builds
// cover every configuration of edges, lines and areas, and every duration of a trial.
inline constexpr std::array<Kit::Build, 28> Kit::kBuilds = {{
    {0, Storage::kLineBuffers, 16, 9, 20},
    {1, Storage::kLineBuffers, 8, 9, 20},
    {2, Storage::kLineBuffers, 5, 9, 20},
    {2, Storage::kLineBuffers, 16, 4, 20},
    {0, Storage::kMemory, 4, 9, 20},
    {1, Storage::kMemory, 9, 9, 20},
    {2, Storage::kMemory, 5, 9, 20},
    {2, Storage::kMemory, 5, 9, 21},
    {2, Storage::kMemory, 5, 9, 22},
    {2, Storage::kMemory, 5, 9, 23},
    {0, Storage::kLineBuffers, 16, 9, 20, true},
    {1, Storage::kLineBuffers, 8, 9, 20, true},
    {2, Storage::kLineBuffers, 16, 4, 20, true},
    {1, Storage::kMemory, 9, 9, 20, true},
    {0, Storage::kLineBuffers, 16, 9, 20, false, true},
    {1, Storage::kLineBuffers, 8, 9, 20, false, true},
    {2, Storage::kLineBuffers, 16, 4, 20, false, true},
    {2, Storage::kMemory, 5, 9, 21, false, true},
    {0, Storage::kLineBuffers, 16, 9, 20, false, false, "text_guard=true"},
    {1, Storage::kMemory, 9, 9, 20, false, true, "text_guard=true"},
    {2, Storage::kLineBuffers, 16, 4, 20, true, false, "text_guard=true"},
    {0, Storage::kLineBuffers, 16, 9, 20, false, false,
     "predictor=fit contiguous=true safe=true trim=true edges.local_contrast=symmetric "
     "trial_cycles=1"},
    {1, Storage::kLineBuffers, 16, 31, 20, false, false,
     "edges.source=predicated edges.local_contrast=smaa trial_cycles=2"},
    {2, Storage::kLineBuffers, 16, 9, 20, false, false,
     "edges.source=depth bypass=half trial_cycles=3 predictor_units=2"},
    {0, Storage::kMemory, 16, 31, 20, false, false,
     "edges.threshold_mode=dynamic edges.local_contrast=paper bypass=beside trial_cycles=8 "
     "linear_light=false"},
    {1, Storage::kLineBuffers, 16, 9, 20, true, false,
     "area=table_full edges.threshold_mode=dynamic edges.dynamic_luma=current"},
    {2, Storage::kLineBuffers, 16, 31, 20, true, false, "area=table_minimal bypass=marked"},
    {1, Storage::kLineBuffers, 16, 9, 20, false, true,
     "predictor=fit trim=true bypass=half trial_cycles=5"},
}};

}  // namespace deburr::tb::morphological_rtl
