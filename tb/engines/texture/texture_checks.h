// SPDX-License-Identifier: MIT
// What the texture unit does against its golden model: colours and line fills in order as they
// come, the registers at the end.
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

  // Scene, setup and the quads that were sent must outlive it. Without `golden` nothing is
  // compared.
  TextureChecks(const TextureScene& scene, const TextureSetup& setup, const SentQuads& sent,
                bool golden);
  TextureChecks(const TextureChecks&) = delete;
  TextureChecks& operator=(const TextureChecks&) = delete;

  // Before the first quad; `blank` is a picture without any fragment.
  void begin(const Image& blank);
  // What the golden model makes of the quad that is sent as number `number`; with `history` it is
  // one that covers the pixel which that follows.
  void expect(const traces::TracedQuad& quad, std::uint64_t number,
              TextureHistory* history = nullptr);
  // True if the colour is as expected, so that its tag and lane are those of a quad.
  bool got(const spec::texture::Colour& colour, rtl::Cycle cycle);
  // What memory has recorded since the last call, which it forgets then if it may.
  void check_traffic(platform::MemoryModel& memory, rtl::Cycle cycle, bool forget);
  // All begins again (after a reset): begin() comes next.
  void restart();
  // All quads are done: how much must have been compared, and the counters.
  void finish(std::uint64_t fragments, const platform::MemoryModel& memory,
              platform::RegisterBus& registers);
  // The same of counters that are not registers.
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
  // Of the lines that memory still knows.
  std::size_t fills_checked_ = 0;
};

}  // namespace deburr::tb
