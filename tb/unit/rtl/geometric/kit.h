// SPDX-License-Identifier: MIT
// The geometric engine for the test suites that every engine runs (tb/harness/engine_kit.h).
#pragma once

#include "rtl_model/geometric/common/frame_configuration.h"
#include "rtl_model/geometric/common/tokens.h"
#include "rtl_model/geometric/register_section.h"
#include "tb/unit/rtl/geometric/trail.h"
#include "tb/unit/rtl/token_suite.h"

namespace deburr::tb::geometric_rtl {

class Kit : public EngineKit {
 public:
  // An engine of the contract's vectors with small buffers, and additional settings.
  struct Build {
    char configuration;
    const char* settings = "";
    int right = 0;  // shifts the frames to the right by this many pixels, which widens them
  };
  static const std::array<Build, 18> kBuilds;
  static std::string text_of(const Build& build) {
    return std::string(1, build.configuration) + " " + build.settings +
           (build.right != 0 ? ", " + std::to_string(build.right) + " pixels to the right" : "");
  }
  static Parameters parameters(const Build& build) {
    Parameters p = configuration(build.configuration).p;
    apply_settings(p,
                   "depth_lines=16 weight_blocks=16 vertex_lines=16 fills=8 latency_fifo=12 "
                   "line_fifo=4");
    apply_settings(p, build.settings);
    return p;
  }
  explicit Kit(const Build& build, const Disturbance& disturbance = {})
      : Kit(parameters(build), disturbance, small_scene(build.right + 37, 26, 30, build.right),
            small_scene(build.right + 41, 37, 60, build.right)) {}
  explicit Kit(Random& random) : Kit(drawn(random), {}, noise_scene(), noise_scene()) {}

  ClockDomain& clock() { return b_.clock; }
  platform::RegisterHost& bus() { return b_.bus; }
  rtl::Engine& engine() { return b_.engine; }
  rtl::RegisterSection section() const { return rtl::geometric::register_section(b_.p); }
  Bench& bench() { return *b_.bench; }

  void start(Job job) {
    b_.load(job == Job::kWhole ? whole_ : broken_);
    b_.forget();
    begin_ = b_.clock.cycle();
    b_.start();
  }
  bool done() const { return b_.engine.idle(); }
  Outcome outcome() {
    Outcome outcome = outcome_of(b_);
    outcome.cycles.emplace_back("cycles", std::array{b_.clock.cycle() - begin_});
    return outcome;
  }
  void expect_enough(Job job) {
    if (job == Job::kBroken) {
      EXPECT_GT(b_.bus.read(reg::kFrameCycles), 500u);
    } else {
      EXPECT_GT(b_.blocks.size(), 10u);
      EXPECT_GT(b_.writes(b_.bases.weights).size(), 5u);
    }
  }
  static constexpr bool kPrograms = true;
  void reset(Cycle cycles) { b_.reset(cycles); }

  // --- resets: long enough that no late write of the previous frame overwrites the next input ---
  static constexpr Cycle kStep = 3;
  static constexpr Cycle short_reset() { return 40; }
  static constexpr Cycle long_reset() { return 40; }
  static constexpr int kRejected = 1;
  void reject(int, Cycle cycles) {
    b_.load(broken_);
    b_.bus.write(reg::kSize, 0);
    b_.start();
    b_.clock.run(cycles);
    if (cycles > 0) {
      EXPECT_EQ(b_.driver.rejection(), spec::geometric::Rejection::kSize);
    }
  }
  static constexpr std::array kKept = {reg::kControl};
  void spoil() {
    Scene scene = broken_;
    scene.edges.front().v0 = 1u << 23;  // no such vertex
    b_.load(scene);
    b_.memory.fail_request(b_.memory.reads() + b_.memory.writes() + 9);
    b_.start();
    b_.clock.run(50);
    b_.bus.write(reg::kSize, 1);  // during a frame
    EXPECT_TRUE(b_.clock.run_until([this] { return done(); }, 50'000));
    b_.bus.write(reg::kSize, 0);
    b_.start();
    b_.clock.run(5);
    EXPECT_EQ(b_.bus.read(reg::kStatus),
              reg::kStatusIdle | reg::kStatusFrameDone | reg::kStatusRejected |
                  reg::kStatusMemoryError | reg::kStatusWrittenWhileBusy | reg::kStatusInvalidEdge);
    for (const std::uint32_t counter : {reg::kEdges, reg::kLines, reg::kBlocks, reg::kMemoryErrors,
                                        reg::kInvalidEdges, reg::kFrameCycles})
      EXPECT_GT(b_.bus.read(counter), 0u) << counter;
    b_.bus.write(reg::kControl, 0);
    EXPECT_EQ(b_.bus.read(reg::kControl), 0u);
  }

  // --- register noise: includes starts with random register values ---
  static constexpr std::uint32_t kMostOffset = 0x200, kCycles = 60;
  static constexpr int kAccesses = 60;
  static constexpr std::uint64_t kNoiseSeeds = 60;
  void disturb(Random& random) {
    if (random.chance(200)) b_.bus.write(reg::kControl, reg::kControlEnable | reg::kControlStart);
  }

  // --- tokens ---
  using Engine = rtl::geometric::GeometricEngine;
  using Tokens =
      TokenList<rtl::geometric::EdgeFields, rtl::geometric::EdgeBeat, rtl::geometric::PairNumber,
                rtl::geometric::KeptEdge, rtl::geometric::VertexFields, rtl::geometric::EdgeEnds,
                rtl::geometric::LineToken, rtl::geometric::GroupToken,
                rtl::geometric::CandidateToken, rtl::geometric::WeightToken,
                rtl::geometric::TouchedBlock, rtl::geometric::BlockToken,
                rtl::geometric::FrameConfiguration>;
  static constexpr int kFormats = 58;
  static constexpr const char* kTables = "reference/geometric/hardware.md";
  static constexpr const char* kHeader = "rtl_model/geometric/geometric_engine.h";
  static constexpr const char* kFigure = "reference/geometric/hardware.md";
  // The last build has every option of the engine.
  static std::vector<Drawn<Parameters>> drawn_builds() {
    Parameters one, split, all;
    one.edge_lanes = one.walkers = spec::geometric::Lanes::kOne;
    split.records = all.records = spec::geometric::RecordsLayout::kSplit;
    split.coarse_lines = spec::geometric::CoarseLines::k64;
    all.coarse_lines = spec::geometric::CoarseLines::k4;
    return {
        {"bits", {}, true},
        {"one lane", one},
        {"split, coarse", split},
        {"",
         all,
         false,
         false,
         {"FrameCopier", "PairFetch", "DepthScreen", "ColourStore", "invalid_edge", "registers"}}};
  }

 private:
  Kit(const Parameters& p, const Disturbance& disturbance, Scene whole, Scene broken)
      : b_(p, {.scatter = disturbance.scatter,
               .bench = disturbance.bench,
               .program = disturbance.program,
               .period = disturbance.period}),
        whole_(std::move(whole)),
        broken_(std::move(broken)) {}
  static Parameters drawn(Random& random) {
    using spec::geometric::CacheLines;
    Parameters p = configuration(static_cast<char>('a' + random.below(4))).p;
    p.depth_lines = p.weight_blocks = p.vertex_lines = CacheLines::k16;
    p.fills = 8;
    p.latency_fifo = random.between(4, 20);
    p.line_fifo = random.between(2, 8);
    p.frame_copy = random.chance(500);
    return p;
  }
  static Scene noise_scene() {
    Scene scene = contract_scene();
    scene.edges.resize(30);
    return scene;
  }

  EngineBench b_;
  const Scene whole_, broken_;
  Cycle begin_ = 0;
};

inline void PrintTo(const Kit::Build& build, std::ostream* out) { *out << Kit::text_of(build); }

// Wide frames have two words of touched blocks per row.
inline constexpr std::array<Kit::Build, 18> Kit::kBuilds = {{
    {'c'},
    {'e'},
    {'h'},
    {'c', "pipelined=false"},
    {'d', "pipelined=false dividers=3 reciprocal_table=8"},
    {'g', "edge_lanes=4 walkers=1 resolve_lanes=4"},
    {'f', "edge_lanes=1 resolve_lanes=1 edge_lines=4 resolve_lines=16"},
    {'c', "", 480},
    {'d', "pipelined=false", 480},
    {'m'},
    {'l', "walkers=2"},
    {'m', "records=split"},
    {'c', "records=split edge_lanes=4"},
    {'m', "coarse_lines=4"},
    {'b', "records=split coarse_lines=8 walkers=2"},
    {'c', "colour_lines=5 write_buffer=3"},
    {'g', "colour_lines=256 write_buffer=64 resolve_lines=16"},
    {'m', "colour_lines=1 write_buffer=1"},
}};

}  // namespace deburr::tb::geometric_rtl
