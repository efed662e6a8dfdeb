// SPDX-License-Identifier: MIT
// A TextureCache between a queue of requests and a sink, with a memory whose words hold their own
// addresses. Cycles are counted from the push of a request by its producer: pushed in c, taken in c
// + 1.
#pragma once

#include <array>
#include <cstdint>
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

}  // namespace deburr::tb::texture_rtl
