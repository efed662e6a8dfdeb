// SPDX-License-Identifier: MIT
// Random register accesses on the morphological engine while pixels come: nothing crashes, and
// after a reset, which leaves loaded tables alone, a frame is what it is on a new engine.
#include "tb/harness/register_noise.h"

#include "tb/unit/rtl/morphological/support.h"

namespace deburr::tb::morphological_rtl::register_noise_test {
namespace {

namespace reg = spec::morphological::reg;

class Kit {
 public:
  static constexpr std::uint32_t kMostOffset = 0x200, kClocks = 80;
  static constexpr int kAccesses = 60;
  static std::span<const spec::RegisterInfo> registers() { return spec::morphological::kRegisters; }
  explicit Kit(Random& random) : p_(drawn(random)), bench_(p_) {
    bench_.driver.send([this](std::uint64_t i, spec::morphological::PixelBeat& beat) {
      beat = beats_[i % beats_.size()];
      return i < frames_ * beats_.size();
    });
  }
  ClockDomain& clock() { return bench_.clock; }
  platform::RegisterHost& bus() { return bench_.bus; }

  std::string job() {
    frames_ = 1;
    reset_engine();
    bench_.software.set_size(frame_.width, frame_.height);
    bench_.bench->run(
        [&] { return bench_.sink.received() == beats_.size() && bench_.engine.idle(); }, 100'000);
    std::string pixels;
    for (const Rgba8& pixel : bench_.last(frame_.width, frame_.height).pixel)
      for (const std::uint8_t channel : pixel) pixels += std::to_string(channel) + " ";
    return pixels;
  }
  void begin() {
    // Of learned shares: the noise may load others.
    if (p_.area == spec::morphological::AreaSource::kLearned)
      for (std::uint32_t entry = 0; entry < rtl::morphological::SharesRom::kEntries; ++entry) {
        bench_.bus.write(reg::kSharesAddress, entry);
        tables_.push_back(static_cast<std::int8_t>(bench_.bus.read(reg::kSharesData)));
      }
    frames_ = 1'000'000;
    reset_engine();
  }
  void disturb(Random&) {}
  std::string end() { return ""; }
  void reset() {
    reset_engine();
    if (!tables_.empty()) bench_.software.load_shares(tables_);
  }

 private:
  static Parameters drawn(Random& random) {
    Parameters p = preset(random.chance(500) ? spec::morphological::Preset::kDeburr
                                             : spec::morphological::Preset::kMlaaSlope,
                          4, 6);
    p.window_rows = 10;
    p.steps = 3;
    p.line_pixels = 64;
    p.lanes = static_cast<spec::morphological::Lanes>(random.below(3));
    p.storage = static_cast<spec::morphological::Storage>(random.below(2));
    p.record_fifo = random.between(2, 9);
    p.text_guard = random.chance(500);
    return p;
  }
  // What memory still answers goes by meanwhile.
  void reset_engine() {
    bench_.clock.set_reset_n(false);
    bench_.clock.run(2000);
    bench_.clock.set_reset_n(true);
  }

  const Parameters p_;
  EngineBench bench_;
  const Frame frame_ = noise(29, 12);
  const std::vector<spec::morphological::PixelBeat> beats_ = beats_of(frame_, lanes_of(p_));
  std::uint64_t frames_ = 1;
  std::vector<std::int8_t> tables_;
};

TEST(RegisterNoise, LeavesNothingAfterAReset) {
  EXPECT_EQ(first_complaint(60, left_by_noise<Kit>), "");
}

}  // namespace
}  // namespace deburr::tb::morphological_rtl::register_noise_test
