// SPDX-License-Identifier: MIT
// Reads the four texels of a request from the data banks, and writes the fills that the request
// ordered when it reaches the head of the LatencyFifo.
//
// Where: tail of the TextureCache. A bank holds one 32-bit word of each line (16 banks for lines of
// 64 bytes), so a fill is written whole in one clock as it came, and texels of one line never meet
// in a bank. A row of a `linear` texture follows the one above it at the same place in its lines:
// the banks of odd rows are turned by half a tile. Texels that hit are read before a fill of the
// same request can overwrite them (the banks are read-first; fills begin in the clock of the last
// pass that reads a hit); texels that missed are taken from the fill as it passes. Stalls, stage by
// stage: `wait_fill` (a line has not arrived), `write_fill` (more lines to write), `bank_conflict`
// (more passes to read), `downstream`. `line_used_out`, a register, is high in the clock after each
// line that is written.
#pragma once

#include <array>
#include <cstdint>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/texture/fill_buffer.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class DataStage final : public Unit {
 public:
  In<CacheToken> requests_in{"requests_in"};
  Out<TexelQuadToken> texels_out{"texels_out"};
  WireOut<bool> line_used_out{"line_used_out"};

  DataStage(const sc_core::sc_module_name& name, ClockDomain& clock,
            const spec::texture::Parameters& parameters, const FillBuffer::Reader& fills);
  Activity tick(Cycle cycle) override {
    const Activity activity = work(cycle);
    fills_.read_ahead(cycle);
    if (line_used_out.driven() && line_used_ != cycle) line_used_out.drive(cycle, false);
    return activity;
  }
  void reset() override;

  Counter lines_written{"lines_written", "lines", "fills written into the data banks"};
  Counter conflicts{"conflicts", "requests", "requests with two words in one bank"};

  static Datasheet datasheet();

 private:
  // In which clock of its request a texel that hits is read, and through which port.
  struct Schedule {
    int passes;                 // 0..4: those that read a texel that hits
    std::array<int, 4> pass;    // of texel i; -1: it missed
    std::array<bool, 4> again;  // its word is that of an earlier texel
  };
  Schedule schedule(const CacheToken& request) const;
  Activity work(Cycle cycle);
  Activity advance(Cycle cycle, const CacheToken& request);
  bool read_at_once(Cycle cycle, const CacheToken& request);
  void read(Cycle cycle, const CacheToken& request, int pass);
  void issue(Cycle cycle, std::size_t port, std::uint64_t word);
  void write_fill(Cycle cycle, const CacheToken& request);
  void finish(Cycle cycle, const CacheToken& request);

  FillBuffer::Reader fills_;
  std::uint32_t line_log2_, words_a_line_, turn_;
  Memory<void> banks_;
  std::array<ReadPort<void>, 4> reads_{
      ReadPort<void>{banks_, "texel_0"}, ReadPort<void>{banks_, "texel_1"},
      ReadPort<void>{banks_, "texel_2"}, ReadPort<void>{banks_, "texel_3"}};
  WritePort<void> write_{banks_, "fill"};
  std::vector<std::uint8_t> bytes_;  // of the banks, word by word
  Activity wait_fill_, write_fill_, bank_conflict_;
  // Registers of the request in stage 1.
  bool started_ = false;
  Schedule schedule_{};
  int passes_done_ = 0, fills_done_ = 0;
  Cycle line_used_ = kNever;  // the last clock in which a line was written
  // One of the words that were asked for last, and when: for the check, no hardware.
  const ReadPort<void>* issued_ = nullptr;
  std::uint64_t issued_word_ = 0;
  Cycle issued_at_ = 0;
  // The request in stage 2.
  bool waits_ = false;
  TexelQuadToken waiting_{};
};

}  // namespace deburr::rtl::texture
