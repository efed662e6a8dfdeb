// SPDX-License-Identifier: MIT
// Predicts the cycles of the texture unit from the addresses of its requests: address unit, groups,
// tags, miss queue, BlockFetcher, memory, latency FIFO, data banks, BlockDecoder.
//
// Written from docs/reference/texture/hardware.md, cache.md, width.md and compressed.md, for every
// width. It assumes that quads are always available and colours always accepted. Memory has a fixed
// latency.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "golden/texture/cache_predictor.h"
#include "golden/texture/texture_golden.h"
#include "spec/texture/parameters.h"

namespace deburr::golden::texture {

struct MemoryTiming {
  std::int32_t latency = 100;         // cycles, at least 1
  std::int32_t bytes_per_cycle = 64;  // 0: no limit
  std::int32_t outstanding = 256;     // transactions in flight
};

// Slots of the GroupFormer by cause (width.md, "Slots"); all 0 at width 1. The cause `output` does
// not occur.
struct Slots {
  std::uint64_t requests = 0;
  std::uint64_t lookups = 0, banks = 0, set = 0, decoders = 0;
  std::uint64_t partial_quad = 0, starved = 0;
  std::uint64_t allocate = 0, miss_queue = 0;
  std::uint64_t wait_fill = 0, write_fill = 0, bank_pass = 0;
  std::uint64_t all() const {
    return requests + lookups + banks + set + decoders + partial_quad + starved + allocate +
           miss_queue + wait_fill + write_fill + bank_pass;
  }
  friend bool operator==(const Slots&, const Slots&) = default;
};

struct CyclePrediction {
  // From the cycle that pops the first quad to the first one that can pop the last colour.
  std::uint64_t cycles = 0;
  std::uint64_t requests = 0, groups = 0, fills = 0, memory_lines = 0;
  Slots slots;
};

// Ring buffer; grows when it is full.
template <class T>
class Ring {
 public:
  std::size_t size() const { return static_cast<std::size_t>(end_ - begin_); }
  bool empty() const { return begin_ == end_; }
  void push(const T& value) {
    if (size() == items_.size()) grow();
    items_[end_++ & (items_.size() - 1)] = value;
  }
  void pop(std::size_t n = 1) { begin_ += n; }
  T& operator[](std::size_t i) { return items_[(begin_ + i) & (items_.size() - 1)]; }
  T& front() { return (*this)[0]; }

 private:
  void grow() {
    std::vector<T> larger(items_.size() * 2);
    for (std::size_t i = 0, n = size(); i < n; ++i) larger[i] = (*this)[i];
    end_ = size();
    begin_ = 0;
    items_ = std::move(larger);
  }
  std::vector<T> items_ = std::vector<T>(8);
  std::uint64_t begin_ = 0, end_ = 0;
};

class CyclePredictor {
 public:
  // Resolves cache.fifo_depth, cache.outstanding and cache.decoders = 0. Throws ConfigError if the
  // unit cannot be built.
  CyclePredictor(const spec::texture::Parameters& parameters, const MemoryTiming& memory);

  // The requests of the next quad, from TextureGolden::process(); none if no lane is covered.
  void add(std::span<const CacheRequest> quad);
  CyclePrediction finish();  // after the last quad

 private:
  using Count = std::uint32_t;  // requests of a token; 0: none
  using Cycle = std::uint64_t;

  // A link. Consumers act before producers, so a token that is seen was pushed in an earlier cycle;
  // a slot that is freed in a cycle is filled in a later one.
  template <class T>
  struct Link {
    std::size_t depth = 2;
    Ring<T> tokens{};
    Cycle popped = ~Cycle{0};  // cycle of the latest pop
    bool can_push(Cycle cycle) const { return tokens.size() + (popped == cycle) < depth; }
    bool can_pop() const { return !tokens.empty(); }
    void push(const T& token) { tokens.push(token); }
    T pop(Cycle cycle) {
      const T token = tokens.front();
      tokens.pop();
      popped = cycle;
      return token;
    }
  };
  // Registers between the stages of a unit, which move together; a unit of latency k has k - 1.
  struct Registers {
    explicit Registers(int latency, int cycles_per_token = 1)
        : stage(static_cast<std::size_t>(latency + cycles_per_token - 2)),
          interval(cycles_per_token) {}
    std::vector<Count> stage;
    std::size_t next = 0;  // of the ring: the last stage, and then the first one
    int interval, busy = 0;
  };
  struct Waiting : CacheRequest {
    bool partial = false;
  };
  struct Group {  // in the LatencyFifo
    std::uint32_t passes = 0, lines = 0;
    Count decoding = 1;  // cycles in the BlockDecoder
  };
  struct Fill {  // a missed line
    std::uint32_t line_bank = 0;
    CachePredictor::Fetch fetch{};
    Cycle arrived = ~Cycle{0};  // cycle in which the MissQueue writes its last beat
  };
  struct Response {
    std::uint64_t fill = 0;  // number of the fill that requested it
    Cycle popped = 0;        // by the BlockFetcher
  };
  struct CompressedLine {
    Cycle written = ~Cycle{0};
    std::uint32_t blocks = 0;  // that wait for the decoder
  };
  // Where a texel, or the first word of its block, is in the cache.
  struct Place {
    std::uint32_t line = 0, word = 0;  // word of the line
    std::uint32_t words = 1;           // that the texel reads
    bool turned = false;
  };
  enum class TagStall : std::uint8_t { kNone, kAllocate, kMissQueue, kFifo };
  enum class DataStall : std::uint8_t { kNone, kWaitFill, kWriteFill, kBankPass, kDownstream };
  using Cause = std::uint64_t Slots::*;

  void step();
  void block_decoder();
  DataStall data_stage();
  void latency_fifo();
  void memory_port();
  void block_fetcher();
  bool fetch_next(std::uint32_t leaving);
  void miss_queue();
  TagStall tag_stage();
  Group look_up(Count count);
  void group_former();
  Count longest_group(Cause& limit);
  Cause blocked_by() const;
  void sample_walker();
  void derivative_unit();
  void advance(Registers& unit, Link<Count>& in, Link<Count>& out);
  bool idle() const;
  Place place(const CacheRequest& request, std::size_t texel) const;
  // Number of the bank of word `word` of a line.
  std::size_t bank_of(std::uint32_t line, std::uint32_t word, bool turned) const;
  Fill& fill(std::uint64_t number) { return fills_[number - used_]; }

  spec::texture::Parameters parameters_;
  MemoryTiming memory_;
  Count width_;
  CachePredictor cache_;
  // By number of a line that is not a decoded block; only those of present lines are read.
  std::vector<bool> turned_;

  Cycle cycle_ = 0, last_left_ = 0;
  std::uint64_t requests_ = 0, groups_ = 0, lines_ = 0, memory_lines_ = 0;
  Ring<Waiting> waiting_;  // all requests before the TagStage; tokens are numbers of them

  Ring<Count> source_;
  Registers derivative_, axis_, log2_, level_, addresser_;
  Link<Count> derivatives_, footprints_, logs_, levels_, samples_, texels_;
  std::vector<Count> before_walking_;  // stages of the SampleWalker, which move one by one
  Ring<Count> walking_;

  Count buffered_ = 0, grouped_ = 0;  // requests in the buffer, and after it in group_link_
  Link<Count> group_link_;
  Slots slots_, since_group_;

  bool looking_up_ = false;
  Group looked_up_;
  std::uint32_t to_allocate_ = 0;
  Link<std::uint32_t> misses_;
  Link<Group> latency_link_, fifo_;
  std::array<TagStall, 2> tag_stalls_{};    // by cycle mod 2
  std::array<DataStall, 4> data_stalls_{};  // by cycle mod 4

  std::uint64_t queued_ = 0, sent_ = 0, used_ = 0, used_before_ = 0;  // fills
  Link<std::uint64_t> memory_requests_;                               // numbers of fills
  Ring<Fill> fills_;                                                  // not used yet
  std::array<Cycle, spec::texture::kMostFillWrites> bank_used_{};     // by bank of the FillBuffer
  Cycle transfer_ = 0, beats_ = 1;
  Cycle first_byte_ = 0, last_beat_ = 0, port_free_ = 0;
  Ring<Cycle> responses_;  // of the transactions in flight

  // The BlockFetcher of decode = before. The decoder's registers hold numbers of fills + 1.
  Link<std::uint64_t> fetches_;
  Ring<Response> arriving_;
  std::vector<CompressedLine> compressed_lines_;
  Ring<std::uint64_t> waiting_blocks_;
  std::array<std::uint64_t, 3> decoding_{};

  Count read_ = 0;  // stage 2 of the DataStage, only with a BlockDecoder: its cycles of the token
  Link<Count> blocks_;
  Cycle decoder_free_ = 0;  // cycle in which the last blocks of its token have left stage 1
};

}  // namespace deburr::golden::texture
