// SPDX-License-Identifier: MIT
// Reset, register noise, stress and tokens of the posteriser, using the common test kit.
#include "rtl_model/platform/register_host.h"
#include "rtl_model/posteriser/posteriser.h"
#include "rtl_model/posteriser/register_section.h"
#include "spec/posteriser/registers.h"
#include "tb/unit/rtl/engine_suites.h"

namespace deburr::tb::posteriser_rtl::kit_test {
namespace {

namespace reg = spec::posteriser::reg;
using spec::posteriser::Tone;

class Kit : public EngineKit {
 public:
  using Build = spec::posteriser::Configuration;
  static constexpr std::array<Build, 3> kBuilds = {{{1, spec::posteriser::Rounding::kTruncate},
                                                    {3, spec::posteriser::Rounding::kNearest},
                                                    {8, spec::posteriser::Rounding::kNearest}}};
  static std::string text_of(const Build& build) { return std::to_string(build.bits) + " bits"; }
  explicit Kit(const Build& build, const Disturbance& disturbance = {})
      : p_{build, {}}, engine_("engine", clock_, p_) {
    engine_.tones_in(ends_.in);
    engine_.tones_out(ends_.out);
    bus_.bus.bind(engine_.registers);
    bench_ = std::make_unique<Bench>(clock_, disturbance.bench);
  }
  explicit Kit(Random& random) : Kit(kBuilds[random.below(3)]) {}

  rtl::ClockDomain& clock() { return clock_; }
  platform::RegisterHost& bus() { return bus_; }
  rtl::Engine& engine() { return engine_; }
  rtl::RegisterSection section() const { return rtl::posteriser::register_section(p_); }
  Bench& bench() { return *bench_; }
  void start(Job job) {
    begin_ = clock_.cycle();
    before_ = ends_.sink.taken.size();
    for (int i = 0; i < (job == Job::kWhole ? 40 : 60); ++i) add(9 * i);
  }
  bool done() const { return ends_.source.done() && engine_.idle() && ends_.out.empty(); }
  Outcome outcome() {
    NamedWords tones("tones"), cycles("cycles of tones");
    for (std::size_t i = before_; i < ends_.sink.taken.size(); ++i) {
      tones.add(ends_.sink.taken[i].token);
      cycles.add(ends_.sink.taken[i].cycle - begin_);
    }
    return {{tones}, {}, {cycles}};
  }
  void expect_enough(Job) { EXPECT_GE(bus_.read(reg::kPixels), 40u); }
  void reset(rtl::Cycle cycles) {
    clock_.set_reset_n(false);
    clock_.run(cycles);
    clock_.set_reset_n(true);
  }

  // --- resets ---
  static constexpr std::array kKept = {reg::kControl};
  void spoil() {
    start(Job::kBroken);
    clock_.run(5);
    bus_.write(reg::kConfiguration, 0);  // while it is busy
    EXPECT_TRUE(clock_.run_until([this] { return done(); }, 200));
    EXPECT_EQ(bus_.read(reg::kStatus),
              reg::status::kIdle.mask() | reg::status::kWrittenWhileBusy.mask());
    EXPECT_GT(bus_.read(reg::kPixels), 0u);
    bus_.write(reg::kControl, 0);
  }

  // --- register noise ---
  static constexpr std::uint32_t kMostOffset = 0x20, kCycles = 20;
  static constexpr rtl::Cycle kNoiseReset = 1;
  static constexpr int kAccesses = 60;
  static constexpr std::uint64_t kNoiseSeeds = 20;
  void disturb(Random& random) {
    for (std::uint32_t more = random.below(30); more > 0; --more)
      add(static_cast<int>(random.below(256)));
  }
  std::string noise_ends() {
    return clock_.run_until([this] { return done(); }, 2000) ? "" : "hangs";
  }

  // --- tokens ---
  using Engine = rtl::posteriser::Posteriser;
  using Tokens = TokenList<Tone>;
  static constexpr int kFormats = 3;
  static constexpr const char* kHeader =
      "tool/tests/system/added_engine/rtl_model/posteriser/posteriser.h";
  static std::vector<Drawn<spec::posteriser::Parameters>> drawn_builds() {
    return {{"", {}, false, false, {"LevelUnit", "registers"}}};
  }

 private:
  void add(int code) {
    const auto c = static_cast<std::uint8_t>(code);
    ends_.source.add(
        {{c, static_cast<std::uint8_t>(c + 77), static_cast<std::uint8_t>(3 * c)}, false});
  }

  const spec::posteriser::Parameters p_;
  rtl::ClockDomain clock_{"clock", unit_bench::period()};
  unit_bench::Ends<Tone, Tone> ends_{clock_};
  rtl::posteriser::Posteriser engine_;
  platform::RegisterHost bus_{"bus"};
  std::unique_ptr<Bench> bench_;
  rtl::Cycle begin_ = 0;
  std::size_t before_ = 0;
};

[[maybe_unused]] const bool kRegistered = register_suites<Kit>();

}  // namespace
}  // namespace deburr::tb::posteriser_rtl::kit_test
