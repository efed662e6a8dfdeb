// SPDX-License-Identifier: MIT
// Compares the texture unit with its golden model: colours and line fills in order as they appear,
// registers at the end.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "golden/texture/texture_golden.h"
#include "rtl_model/platform/host.h"
#include "rtl_model/platform/memory_model.h"
#include "rtl_model/texture/texture_unit.h"
#include "spec/texture/packets.h"
#include "tb/engines/texture/sent_quads.h"
#include "tb/engines/texture/texture_scene.h"
#include "tb/engines/texture/texture_setup.h"
#include "tb/env/environment.h"
#include "tb/traces/fragment_trace.h"

namespace deburr::tb {

class TextureHistory;

class TextureChecks {
 public:
  struct Fill {
    std::uint64_t address;
    friend bool operator==(const Fill&, const Fill&) = default;
  };

  // `scene`, `setup` and `sent` must outlive it. Without `golden` nothing is compared.
  TextureChecks(const TextureScene& scene, const TextureSetup& setup, const SentQuads& sent,
                bool golden);
  TextureChecks(const TextureChecks&) = delete;
  TextureChecks& operator=(const TextureChecks&) = delete;

  // Call before the first quad; `blank` is the picture without fragments.
  void begin(const Image& blank);
  // Expects the golden model's output for quad number `number`. `history`: not null if the quad
  // covers the pixel whose history is recorded.
  void expect(const traces::TracedQuad& quad, std::uint64_t number,
              TextureHistory* history = nullptr);
  // Returns whether the colour is as expected, so its tag and lane can be trusted.
  bool got(const spec::texture::Colour& colour, rtl::Cycle cycle);
  // Checks accesses that memory has recorded since the last call; `forget` clears the record.
  void check_traffic(platform::MemoryModel& memory, rtl::Cycle cycle, bool forget);
  // Restarts after a reset; begin() must follow.
  void restart();
  // After all quads: sets the required number of comparisons and checks the counters.
  void finish(std::uint64_t fragments, const platform::MemoryModel& memory,
              platform::RegisterBus& registers);
  // Checks counters that are not registers.
  void check_figures(const rtl::texture::TextureUnit& unit, const platform::MemoryModel& memory);

  const golden::texture::TextureGolden& golden_model() const { return golden_; }
  const golden::texture::TextureWork& work() const {
    return setup_.expectation ? setup_.expectation->work : golden_.work();
  }
  // The golden model's picture of the quads so far.
  const Image& golden_frame() const { return golden_frame_; }

  Scoreboard<spec::texture::Colour> colours;
  Scoreboard<Fill> fills;
  RegisterScoreboard registers;
  FigureScoreboard figures;

 private:
  golden::texture::TextureGolden make_model() const;
  void listen();
  void expect_line(std::uint32_t line);
  std::string place(const spec::texture::Colour& colour) const;

  const TextureScene& scene_;
  const TextureSetup& setup_;
  const SentQuads& sent_;
  bool used_;
  golden::texture::TextureGolden golden_;
  Image golden_frame_;
  // among the lines that memory still has on record
  std::size_t fills_checked_ = 0;
};

}  // namespace deburr::tb
