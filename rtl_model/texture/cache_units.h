// SPDX-License-Identifier: MIT
// What the tag stages and the data stages of all widths share: counters, and the tags.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/lookups.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/texture/tag_store.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/descriptor.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

using rtl::LookUp;

// A word, or a block, may be read at the last byte of the last line.
inline constexpr std::size_t kWordPadding = sizeof(Block) - 1;

// Little-endian on every host.
inline std::uint32_t load_word(const std::uint8_t* bytes) {
  if constexpr (std::endian::native == std::endian::little) {
    std::uint32_t word;
    std::memcpy(&word, bytes, sizeof word);
    return word;
  } else {
    return std::uint32_t{bytes[0]} | std::uint32_t{bytes[1]} << 8 | std::uint32_t{bytes[2]} << 16 |
           std::uint32_t{bytes[3]} << 24;
  }
}

// A texel is in the low bits of the word.
inline std::uint32_t texel_mask(const FilterControl& control) {
  static constexpr std::array<std::uint32_t, 5> kMask = {~0u, 0xFFFF, 0xFFFF, 0xFF, ~0u};
  return kMask[control.format];
}

// The words of a block in the banks or in a line; of 8 bytes, the others are 0.
inline Block load_block(const std::uint8_t* bytes, std::uint8_t codec) {
  Block block{};
  for (std::size_t n = 0; n < word_count(codec); ++n) block[n] = load_word(bytes + 4 * n);
  return block;
}

// TagStage, or WideTagStage.
class TagUnit : public Unit, public Lookups {
 public:
  void invalidate() { tags_.invalidate(); }

  // lookups = hits + merged + misses
  Counter requests{"requests", "requests", "bilinear requests looked up"};
  Counter hits{"hits", "lines", "lookups of a line in the data banks"};
  Counter merged{"merged", "lines", "lookups of a line whose fill is in flight"};
  Counter misses{"misses", "lines", "lookups that requested a fill"};
  Counter evictions{"evictions", "lines", "valid lines replaced"};

 protected:
  TagUnit(const sc_core::sc_module_name& name, ClockDomain& clock,
          const spec::texture::Parameters& p)
      : Unit(name, clock),
        Lookups(static_cast<std::uint32_t>(p.cache_line_bytes)),
        tags_("tags", p),
        fill_number_(tags_.slots()),
        miss_queue_full_(
            declare_stall("miss_queue_full", "a line missed and the miss queue is not ready")),
        fifo_full_(declare_stall("fifo_full", "the latency FIFO is full")) {}

  TagStore tags_;
  // Counters only, no hardware: number of the last fill requested for each slot, from 1. The line
  // is in flight until that number of fills has been used.
  std::vector<std::uint64_t> fill_number_;
  std::uint64_t ordered_ = 0, used_ = 0;
  Activity miss_queue_full_, fifo_full_;
};

// DataStage, or WideDataStage.
class DataUnit : public Unit {
 public:
  void reset() override {
    started_ = waits_ = false;
    issued_ = nullptr;
  }

  Counter lines_written{"lines_written", "lines", "fills written to the data banks"};
  Counter conflicts;

 protected:
  DataUnit(const sc_core::sc_module_name& name, ClockDomain& clock, const char* tokens,
           const char* conflicting)
      : Unit(name, clock),
        conflicts("conflicts", tokens, conflicting),
        wait_fill_(declare_stall("wait_fill", "waits for a line of the request")),
        write_fill_(declare_stall("write_fill", "the request has more lines to write")),
        bank_conflict_(declare_stall("bank_conflict", "the request reads more words of one bank")) {
  }

  // Stage 2: passes on what waits. Returns false if it has to wait longer.
  template <class Texels>
  bool push(Cycle cycle, Out<Texels>& texels_out, const Texels& waiting) {
    if (waits_ && !texels_out.can_push(cycle)) return false;
    if (issued_) issued_->check(cycle, issued_word_, issued_at_);
    issued_ = nullptr;
    if (waits_) texels_out.push(cycle, waiting);
    waits_ = false;
    return true;
  }
  // All words of a cycle arrive together, so one of them is enough for the check.
  void issue(Cycle cycle, ReadPort<void>& port, std::uint64_t word) {
    port.read(cycle, word);
    issued_ = &port;
    issued_word_ = word;
    issued_at_ = cycle;
  }

  // The token of stage 2 for the BlockDecoder. A texel is taken from its block.
  static void pass(const TexelQuadToken& texels, BlockRequest& out) {
    out.ticket = texels.ticket;
    out.control = texels.control;
    const bool compressed = texels.ticket.valid && texels.control.codec != 0;
    out.texel = compressed ? Block{} : texels.texel;
    if (!compressed) out.index = {};
  }

  Activity wait_fill_, write_fill_, bank_conflict_;
  bool started_ = false;  // with the request or group in stage 1
  bool waits_ = false;    // texels in stage 2

 private:
  // Check only, no hardware: one of the words read last, and when.
  const ReadPort<void>* issued_ = nullptr;
  std::uint64_t issued_word_ = 0;
  Cycle issued_at_ = 0;
};

}  // namespace deburr::rtl::texture
