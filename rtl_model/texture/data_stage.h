// SPDX-License-Identifier: MIT
// Reads the four texels of a request from the data banks, and writes the fills that the request
// ordered when it reaches the head of the LatencyFifo.
//
// Where: tail of the TextureCache. Latency 1 in the last of max(1, lines to write, bank passes)
// clocks, which is the initiation interval. Texels that hit are read before a fill of the same
// request can overwrite them (the banks are read-first; fills begin in the clock of the last pass
// that reads a hit); texels that missed are taken from the fill as it passes. Stalls: `wait_fill`
// (a line has not arrived), `write_fill` (more lines to write), `bank_conflict` (more passes to
// read), `downstream`. Cost: DataBanks, four texel registers, four 5-to-1 texel multiplexers.
#pragma once

#include <array>
#include <cstdint>
#include <systemc>

#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/data_banks.h"
#include "rtl_model/texture/fill_buffer.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class DataStage final : public Unit {
 public:
  In<CacheToken> requests_in{"requests_in"};
  Out<TexelQuadToken> texels_out{"texels_out"};

  DataStage(const sc_core::sc_module_name& name, ClockDomain& clock,
            const spec::texture::Parameters& parameters, FillBuffer& fills);
  Activity tick(Cycle cycle) override;
  void reset() override;

  Counter lines_written{"lines_written", "lines", "fills written into the data banks"};
  Counter conflicts{"conflicts", "requests", "requests with two texels in one bank"};

 private:
  // How a request that is not a plain hit is spread over clocks.
  struct Schedule {
    int passes;               // 1, 2, 4: bank passes
    int hit_passes;           // 0..4: those that read a texel that hits
    std::array<int, 4> pass;  // in which texel i is read; -1: it missed
  };
  static Schedule schedule(const CacheToken& request);
  Activity tick_slow(Cycle cycle, const CacheToken& request);
  void write_fill(Cycle cycle, const CacheToken& request);

  FillBuffer& fills_;
  DataBanks banks_;
  Activity wait_fill_, write_fill_, bank_conflict_;
  // Registers of the request at the head.
  bool started_ = false;
  Schedule schedule_{};
  int passes_done_ = 0, fills_done_ = 0;
  std::array<std::uint32_t, 4> texel_{};
};

}  // namespace deburr::rtl::texture
