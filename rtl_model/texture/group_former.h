// SPDX-License-Identifier: MIT
// Forms groups of consecutive requests that the ports of a wide cache serve in one pass.
//
// Position  First unit of a wide TextureCache: TexelAddresser -> GroupFormer -> WideTagStage.
// Function  A buffer of 2 W requests. The group is the longest sequence of its oldest requests
//           within the limits of docs/reference/texture/width.md (GroupFormer). The distinct lines
//           of a group are found here, once for all units behind.
// Stalls    downstream  The WideTagStage is not ready.
// Slots     Each of the W slots of a cycle is counted once: as a request, or under the cause that
//           left it empty. `stall_in` names the unit behind that stopped the WideTagStage in the
//           previous cycle.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/unit.h"
#include "rtl_model/fabric/wire.h"
#include "rtl_model/texture/tokens.h"
#include "spec/texture/parameters.h"

namespace deburr::rtl::texture {

class GroupFormer final : public Unit {
 public:
  In<TexelGroup> texels_in{"texels_in"};
  Out<LineGroup> groups_out{"groups_out"};
  WireIn<SlotStall> stall_in{"stall_in"};

  GroupFormer(const sc_core::sc_module_name& name, ClockDomain& clock,
              const spec::texture::Parameters& parameters);
  Activity tick(Cycle cycle) override;
  void reset() override;

  // slots = requests + all others
  Counter slots{"slots", "slots", "W per cycle from the first group to the latest one"};
  Counter requests{"requests", "slots", "slots with a request"};
  Counter lookups{"lookups", "slots", "empty: the next request needs more distinct lines"};
  Counter banks{"banks", "slots", "empty: the next request needs more words of a bank"};
  Counter set{"set", "slots", "empty: the next request needs more lines of a set"};
  const std::unique_ptr<Counter> decoders;  // in a build with them
  Counter partial_quad{"partial_quad", "slots", "empty: the quad had fewer fragments"};
  Counter starved{"starved", "slots", "empty: no further request had come"};
  Counter allocate{"allocate", "slots", "empty: the TagStage allocated lines of a group"};
  Counter miss_queue{"miss_queue", "slots", "empty: the MissQueue was full"};
  Counter wait_fill{"wait_fill", "slots", "empty: the DataStage waited for a line"};
  Counter write_fill{"write_fill", "slots", "empty: the DataStage wrote lines of a group"};
  Counter bank_pass{"bank_pass", "slots", "empty: the DataStage read a group in passes"};
  Counter output{"output", "slots", "empty: the texels were not taken"};

  static Datasheet datasheet(const spec::texture::Parameters& parameters = {});

 private:
  // A request in the buffer. Its distinct lines in the order of first use are found when it enters.
  struct Waiting {
    GroupRequest request;               // `index`: number of the line among `line`
    std::uint32_t lines;                // 1..4; 0: an invalid request
    std::array<std::uint32_t, 4> line;  // U27 (decode = before: U32)
    std::array<std::uint32_t, 4> address;
    std::uint32_t blocks;  // different ones
    std::array<bool, 2> turned;
    bool partial;
  };
  // The limits that a sequence of requests exceeds.
  struct Exceeded {
    bool lookups = false, banks = false, set = false, decoders = false;
    bool any() const { return lookups || banks || set || decoders; }
  };
  // Distinct words of a bank; valid if `group` is the number of the group being formed.
  struct Bank {
    std::uint64_t group;
    std::uint32_t words;
    std::array<std::uint64_t, spec::texture::kMostBankReads> word;
  };
  // The oldest request may be one of four lines that exceeds every limit.
  static constexpr std::size_t kMostLines = spec::texture::kMostLookups + 4;
  struct Lines {
    std::uint32_t count = 0;
    std::array<std::uint32_t, kMostLines> line;
    std::array<bool, kMostLines> turned;
  };
  // Distinct blocks, by address and codec.
  struct Blocks {
    std::uint32_t count = 0;
    std::array<std::uint32_t, spec::texture::kMostDecoders> address;
    std::array<std::uint8_t, spec::texture::kMostDecoders> codec;
  };

  std::uint32_t emit(Cycle cycle);
  bool emit_all(std::uint32_t most, LineGroup& group);
  [[gnu::noinline]] std::uint32_t emit_within(std::uint32_t most, LineGroup& group);
  void add(const Waiting& request, Lines& lines, std::array<std::uint8_t, 4>& index,
           Exceeded& exceeded);
  void add_word(std::uint32_t place, std::uint64_t word, Exceeded& exceeded);
  [[gnu::noinline]] void add_blocks(const Waiting& request, Blocks& blocks, Exceeded& exceeded);
  void take(Cycle cycle);
  void enter(const TexelToken& token, Waiting& waiting) const;
  [[gnu::noinline]] static void enter_blocks(const TexelToken& token, Waiting& waiting);
  void count(std::uint32_t emitted, std::uint32_t buffered, Cycle cycle);

  std::uint32_t width_, lookups_, reads_, ways_, decoders_;
  bool blocks_;  // `decode = before`: lines of decoded blocks
  std::uint32_t line_log2_, turn_, set_mask_, bank_mask_;
  // For emit_all(): low bits of a line number that select a line bank and a set, and the lines that
  // may share them.
  std::uint32_t apart_mask_, alike_;
  Memory<void> memory_;
  std::vector<ReadPort<void>> oldest_;
  std::vector<WritePort<void>> new_;
  std::array<Waiting, 2 * kMostInGroup> buffer_;  // a ring of 2 W entries
  std::uint32_t head_ = 0, buffered_ = 0;         // oldest request and number of requests
  std::vector<Bank> banks_;                       // of words
  std::uint64_t group_ = 0;                       // number of the group
  Counter* cause_ = nullptr;                      // why the latest group has fewer than W requests
  // Counters only: empty slots since the latest group, by cause; counted with the next group.
  bool started_ = false;
  std::uint64_t starved_since_ = 0;
  std::array<std::uint64_t, static_cast<std::size_t>(SlotStall::kOutput) + 1> stopped_since_{};
  bool pending_ = false;
};

}  // namespace deburr::rtl::texture
