// SPDX-License-Identifier: MIT
// A TextureCache, narrow or wide, between a queue of requests and a sink, with a memory whose words
// hold their own addresses. Cycles are counted from the push of a request by its producer: pushed
// in c, taken in c
// + 1.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "rtl_model/texture/texture_cache.h"
#include "tb/unit/rtl/texture/support.h"

namespace deburr::tb::texture_rtl {

// Cycles from taking a hit to its output: tag check (2), FIFO, data read (2).
inline constexpr Cycle kHit = 5;
// Cycles of a miss of one line, without the memory latency: tag check (2), miss queue, port,
// memory, response, fill buffer (2), data stage (2).
inline constexpr Cycle kMiss = 10;

inline spec::texture::Parameters small_cache() {
  spec::texture::Parameters p;
  p.cache_bytes = 256;  // 2 sets x 2 ways x 64 bytes
  p.cache_ways = 2;
  p.cache_outstanding = 4;
  p.cache_fifo_depth = 16;
  return p;
}

inline rtl::texture::TexelToken request(std::array<std::uint32_t, 4> address,
                                        std::uint32_t tag = 0) {
  rtl::texture::TexelToken t{};
  t.ticket = {tag, 0, true, true, 0};
  t.control = {0,    0,   256, 0, 0, static_cast<std::uint8_t>(spec::texture::Format::kRgba8),
               true, true};
  t.address = address;
  return t;
}
// Four adjacent texels in one line.
inline rtl::texture::TexelToken in_line(std::uint32_t line, std::uint32_t tag = 0) {
  const std::uint32_t a = line * 64;
  return request({a, a + 4, a + 16, a + 20}, tag);
}

// The same with decoders.
inline spec::texture::Parameters with_decoders(spec::texture::Parameters p,
                                               std::int32_t decoders = 0) {
  p.decode = spec::texture::Decode::kAfter;
  p.cache_decoders = decoders;
  return p;
}
// Texels in blocks at these addresses, each at (0, 0).
inline rtl::texture::TexelToken in_blocks(spec::texture::Format format,
                                          std::array<std::uint32_t, 4> address,
                                          std::uint32_t tag = 0) {
  rtl::texture::TexelToken t = request(address, tag);
  t.control.codec = rtl::texture::codec_of(format);
  return t;
}
// Memory of such blocks: of each 8 bytes the first has the number, and the others are 0, so that a
// texel of BC4 is the number, and R and G of BC5 are those of its halves.
inline std::uint32_t number_of(std::uint64_t address) {
  return static_cast<std::uint32_t>((address / 8 * 2654435761u >> 7) % 255 + 1);
}
inline std::vector<std::uint8_t> numbered_blocks() {
  std::vector<std::uint8_t> image(1 << 20);
  for (std::size_t i = 0; i < image.size(); i += 8)
    image[i] = static_cast<std::uint8_t>(number_of(i));
  return image;
}
// The texels of a request from that memory.
inline std::array<std::uint32_t, 4> texels_of(const rtl::texture::TexelToken& asked) {
  std::array<std::uint32_t, 4> texels{};
  for (std::size_t i = 0; i < 4 && asked.ticket.valid; ++i) {
    const std::uint32_t first = number_of(asked.address[i]), byte = asked.address[i] & 7;
    switch (asked.control.codec) {
      case 0:
        texels[i] = byte == 0 ? first : 0;
        break;
      case rtl::texture::codec_of(spec::texture::Format::kBc4):
        texels[i] = 0xFF00'0000 | first * 0x01'0101;
        break;
      default:
        texels[i] = 0xFF00'0000 | number_of(asked.address[i] + 8) << 8 | first;
    }
  }
  return texels;
}

struct CacheBench {
  explicit CacheBench(const spec::texture::Parameters& p = small_cache(),
                      std::uint32_t latency = kMemoryLatency, std::uint32_t scatter = 0,
                      const std::string& prefix = "")
      : clock((prefix + "clock").c_str(), period()),
        store(clock, prefix),
        ends(clock, prefix),
        cache((prefix + "cache").c_str(), clock, p, store.control),
        memory((prefix + "memory").c_str(), period(), memory_parameters(latency, scatter)) {
    cache.texels_in(ends.in);
    cache.texels_out(ends.out);
    cache.memory_port.memory.bind(memory.ports);
    fill_memory(0);
  }
  // Each word of memory holds its own address, scrambled.
  void fill_memory(std::uint32_t flipped) {
    std::vector<std::uint8_t> image(1 << 20);
    for (std::size_t i = 0; i < image.size(); ++i)
      image[i] = static_cast<std::uint8_t>((word(i & ~3ull) ^ flipped) >> (8 * (i & 3)));
    memory.preload(0, image);
  }
  static std::uint32_t word(std::uint64_t address) {
    return static_cast<std::uint32_t>(address * 2654435761u + 12345);
  }
  // The cycle in which a request that is pushed now leaves.
  Cycle time_of(const rtl::texture::TexelToken& t) {
    const std::size_t before = ends.sink.taken.size();
    const Cycle taken = clock.cycle() + 1;
    ends.source.add(t);
    clock.run_until([&] { return ends.sink.taken.size() > before; }, 10000);
    return ends.sink.taken.back().cycle - taken;
  }
  void check_data(const std::vector<rtl::texture::TexelToken>& asked) const {
    ASSERT_EQ(ends.sink.taken.size(), asked.size());
    for (std::size_t i = 0; i < asked.size(); ++i)
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_EQ(ends.sink.taken[i].token.texel[k], word(asked[i].address[k])) << i << " " << k;
  }
  ClockDomain clock;
  Store store;
  Ends<rtl::texture::TexelToken, rtl::texture::TexelQuadToken> ends;
  rtl::texture::TextureCache cache;
  platform::MemoryModel memory;
};

// ---- Decoded blocks in the cache
inline spec::texture::Parameters with_fetcher(spec::texture::Parameters p, std::int32_t lines = 0) {
  p.decode = spec::texture::Decode::kBefore;
  p.cache_compressed_lines = lines;
  return p;
}
inline rtl::Line bytes_of(const std::vector<std::uint64_t>& words) {
  rtl::Line line{};
  for (std::size_t i = 0; i < 8 * words.size(); ++i)
    line[i] = static_cast<std::uint8_t>(words[i / 8] >> 8 * (i % 8));
  return line;
}

// The BlockFetcher alone, with the test at all four sides.
struct FetcherBench {
  explicit FetcherBench(const spec::texture::Parameters& p = with_fetcher(small_cache()),
                        const std::string& prefix = "")
      : clock((prefix + "clock").c_str(), period()),
        control((prefix + "registers").c_str(), rtl::texture::register_table(),
                rtl::texture::control_layout()),
        bus((prefix + "bus").c_str()),
        lines((prefix + "lines").c_str()),
        requests((prefix + "requests").c_str()),
        responses((prefix + "responses").c_str()),
        fills((prefix + "fills").c_str()),
        unit((prefix + "fetcher").c_str(), clock, p, control) {
    bus.bus.bind(control.registers.bus);
    clock.on_reset([this] { control.reset(); });
    unit.lines_in(lines);
    unit.requests_out(requests);
    unit.responses_in(responses);
    unit.fills_out(fills);
  }
  static std::uint32_t number(spec::texture::Format format, std::uint32_t address) {
    rtl::texture::FilterControl control{};
    control.codec = rtl::texture::codec_of(format);
    return rtl::texture::block_line(control, address);
  }
  // In this cycle: a fill of the block at an address, of a line of another texture, and a response.
  void ask(spec::texture::Format format, std::uint32_t address, std::uint32_t entry) {
    push(number(format, address), entry);
  }
  void ask(std::uint32_t address, std::uint32_t entry) { push(address / 64, entry); }
  void answer(std::uint32_t tag, const rtl::Line& data = {},
              rtl::MemoryStatus status = rtl::MemoryStatus::kOk) {
    rtl::MemoryResponse response;
    response.tag = tag;
    response.data = data;
    response.status = status;
    responses.push(clock.cycle(), response);
  }
  // The oldest request, and the oldest fill, when it comes.
  rtl::MemoryRequest asked() {
    ready_at(clock, requests);
    return requests.take(clock.cycle());
  }
  rtl::MemoryResponse filled() {
    ready_at(clock, fills);
    return fills.take(clock.cycle());
  }

  ClockDomain clock;
  rtl::ControlRegisters control;
  platform::RegisterHost bus;
  Link<rtl::MemoryRequest> lines, requests;
  Link<rtl::MemoryResponse> responses, fills;
  rtl::texture::BlockFetcher unit;

 private:
  void push(std::uint32_t line, std::uint32_t entry) {
    rtl::MemoryRequest request;
    request.address = line;
    request.tag = entry;
    lines.push(clock.cycle(), request);
  }
};

// ---- Wide builds
// ---------------------------------------------------------------------------------

// Cycles from taking a group that hits to its output: GroupFormer (2) and as above.
inline constexpr Cycle kWideHit = 2 + kHit, kWideMiss = 2 + kMiss;

// 32 sets x 2 ways x 64 bytes, with the ports of the build `wide`.
inline spec::texture::Parameters wide_cache(std::int32_t width = 4) {
  spec::texture::Parameters p;
  p.cache_bytes = 4096;
  p.cache_outstanding = 32;
  p.cache_fifo_depth = 32;
  p.width = width;
  p.cache_lookups = 8;
  p.cache_line_banks = p.cache_fill_writes = 4;
  p.cache_bank_reads = 2;
  return p;
}

// A token of the TexelAddresser. Bit i of `partial`: request i ends a quad of fewer fragments.
inline rtl::texture::TexelGroup token_of(const std::vector<rtl::texture::TexelToken>& requests,
                                         std::uint8_t partial = 0) {
  rtl::texture::TexelGroup group{};
  group.count = static_cast<std::uint8_t>(requests.size());
  group.partial = partial;
  std::copy(requests.begin(), requests.end(), group.at.begin());
  return group;
}
inline rtl::texture::TexelToken invalid_request() {
  rtl::texture::TexelToken t = request({});
  t.ticket.valid = false;
  return t;
}

struct WideBench {
  explicit WideBench(const spec::texture::Parameters& p = wide_cache(),
                     std::uint32_t latency = kMemoryLatency, std::uint32_t scatter = 0,
                     const std::string& prefix = "")
      : clock((prefix + "clock").c_str(), period()),
        store(clock, prefix),
        ends(clock, prefix),
        cache((prefix + "cache").c_str(), clock, p, store.control),
        memory((prefix + "memory").c_str(), period(), memory_parameters(latency, scatter)),
        width(static_cast<std::size_t>(p.width)) {
    cache.groups_in(ends.in);
    cache.groups_out(ends.out);
    cache.memory_port.memory.bind(memory.ports);
    std::vector<std::uint8_t> image(1 << 20);
    for (std::size_t i = 0; i < image.size(); ++i)
      image[i] = static_cast<std::uint8_t>(CacheBench::word(i & ~3ull) >> (8 * (i & 3)));
    memory.preload(0, has_blocks() ? numbered_blocks() : image);
  }
  void add(const std::vector<rtl::texture::TexelToken>& requests, std::uint8_t partial = 0) {
    ends.source.add(token_of(requests, partial));
    asked.insert(asked.end(), requests.begin(), requests.end());
  }
  // Runs until every request has left.
  void finish(Cycle limit = 100'000) {
    EXPECT_TRUE(clock.run_until([&] { return delivered() == asked.size(); }, limit));
  }
  std::size_t delivered() {
    for (; counted < ends.sink.taken.size(); ++counted)
      left += ends.sink.taken[counted].token.count;
    return left;
  }
  // The requests have left in their order, with the words of memory.
  void check_data() const {
    std::size_t i = 0;
    for (const auto& taken : ends.sink.taken)
      for (std::size_t n = 0; n < taken.token.count; ++n, ++i) {
        ASSERT_LT(i, asked.size());
        const rtl::texture::TexelQuadToken& got = taken.token.at[n];
        EXPECT_EQ(got.ticket.tag, asked[i].ticket.tag) << i;
        if (has_blocks()) {
          EXPECT_EQ(got.texel, texels_of(asked[i])) << i;
          continue;
        }
        for (std::size_t k = 0; k < 4; ++k)
          EXPECT_EQ(got.texel[k],
                    asked[i].ticket.valid ? CacheBench::word(asked[i].address[k]) : 0u)
              << i << " " << k;
      }
    EXPECT_EQ(i, asked.size());
  }
  bool has_blocks() const { return cache.block_decoder || cache.block_fetcher; }
  const rtl::texture::GroupFormer& former() const { return cache.wide->group_former; }

  ClockDomain clock;
  Store store;
  Ends<rtl::texture::TexelGroup, rtl::texture::TexelQuadGroup> ends;
  rtl::texture::TextureCache cache;
  platform::MemoryModel memory;
  std::size_t width;
  std::vector<rtl::texture::TexelToken> asked;

 private:
  std::size_t counted = 0, left = 0;
};

// Slots of the GroupFormer, by cause.
using Slots = std::map<std::string, std::uint64_t>;
inline Slots slots_of(const rtl::texture::GroupFormer& former) {
  Slots slots;
  for (const rtl::Counter* counter :
       {&former.lookups, &former.banks, &former.set, &former.partial_quad, &former.starved,
        &former.allocate, &former.miss_queue, &former.wait_fill, &former.write_fill,
        &former.bank_pass, &former.output, static_cast<const rtl::Counter*>(former.decoders.get())})
    if (counter && counter->value() != 0) slots[counter->basename()] = counter->value();
  return slots;
}
// Each slot is counted exactly once.
inline void check_slots(const rtl::texture::GroupFormer& former) {
  std::uint64_t sum = former.requests.value();
  for (const auto& [cause, slots] : slots_of(former)) sum += slots;
  EXPECT_EQ(former.slots.value(), sum);
}

}  // namespace deburr::tb::texture_rtl
