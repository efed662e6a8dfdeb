// SPDX-License-Identifier: MIT
// Requests of a memory port as trace records: the cycle of the request, one record per line of a
// burst, the enabled bytes; lookups of a cache with the cycle of each.
#include "tb/traces/line_trace.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/platform/memory_model.h"
#include "spec/error.h"
#include "tb/harness/driver.h"
#include "tb/unit/rtl/texture/cache_bench.h"

namespace deburr::tb::traces::line_trace_test {
namespace {

namespace fs = std::filesystem;
using rtl::MemoryRequest;

const sc_core::sc_time kPeriod(10, sc_core::SC_NS);

class Lines : public testing::Test {
 protected:
  Lines() : file_(fs::temp_directory_path() / ("deburr_lines_" + std::to_string(::getpid()))) {}
  ~Lines() override { fs::remove(file_); }
  std::string bytes() const {
    std::ifstream in(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  fs::path file_;
};

struct Bench {
  rtl::ClockDomain clock{"clock", kPeriod};
  Driver<MemoryRequest> driver{"driver", clock};
  rtl::MemoryPort port;
  Sink<rtl::MemoryResponse> sink{"sink", clock};
  rtl::Link<MemoryRequest> requests;
  rtl::Link<rtl::MemoryResponse> responses;
  platform::MemoryModel memory{"memory", kPeriod};

  explicit Bench(const rtl::MemoryPortParameters& p)
      : port("port", clock, p),
        requests("requests", 2, rtl::request_shape(p, 64, 32)),
        responses("responses", 2, rtl::response_shape(p, 64, 32)) {
    driver.beats_out(requests);
    port.requests_in(requests);
    port.responses_out(responses);
    sink.beats_in(responses);
    port.memory.bind(memory.ports);
  }
};

rtl::MemoryPortParameters bursts() {
  rtl::MemoryPortParameters p;
  p.max_burst_lines = 2;
  return p;
}

void send(Bench& bench) {
  MemoryRequest read;
  read.address = 0x1000;
  read.lines = 2;
  MemoryRequest write;
  write.address = 0x40;
  write.write = true;
  write.byte_mask = 0xFF;
  bench.driver.send(read);
  bench.driver.send(write);
}

TEST_F(Lines, RecordsHaveCycleOfTheirRequest) {
  Bench bench(bursts());
  send(bench);
  LineTrace trace(file_, {"some_unit", 148.5, TraceFormat::kText, false});
  bench.clock.run(100);
  trace.finish();
  EXPECT_EQ(trace.records(), 3u);
  // Pushed in 0 and 1, so sent in 1 and 2.
  EXPECT_EQ(bytes(),
            "# deburr-lines 1\n# engine some_unit\n# clock_mhz 148.5\n# port 0 memory 64 port\n"
            "# clock event address bytes port\n"
            "1 read 0x00001000 64 0\n1 read 0x00001040 64 0\n2 write 0x00000040 8 0\n# end 3\n");
}

TEST_F(Lines, BytesMatchDocumentation) {
  Bench bench(bursts());
  send(bench);
  {
    LineTrace trace(file_, {"some_unit", 148.5, TraceFormat::kBinary, false});
    bench.clock.run(100);
    trace.finish();
  }
  const std::string all = bytes();
  ASSERT_EQ(all.size(), 64u + 64u + 3 * 24u);
  EXPECT_EQ(all.substr(0, 8), "DEBURRLT");
  const auto u32 = [&](std::size_t at) { return get_little_endian<std::uint32_t>(all, at); };
  EXPECT_EQ(u32(8), 1u);
  EXPECT_EQ(u32(12), 128u);
  EXPECT_EQ(u32(16), 24u);
  EXPECT_EQ(u32(20), 1u);
  EXPECT_EQ(get_little_endian<std::uint64_t>(all, 24), 3u);
  EXPECT_EQ(get_double(all, 32), 148.5);
  EXPECT_STREQ(all.substr(40, 24).c_str(), "some_unit");
  EXPECT_EQ(u32(64), 64u);
  EXPECT_EQ(u32(68), 0u);
  EXPECT_STREQ(all.substr(72, 56).c_str(), "port");
  const std::size_t last = 128 + 2 * 24;
  EXPECT_EQ(get_little_endian<std::uint64_t>(all, last), 2u);
  EXPECT_EQ(get_little_endian<std::uint64_t>(all, last + 8), 0x40u);
  EXPECT_EQ(u32(last + 16), 8u);
  EXPECT_EQ(all[last + 20], 1);
  EXPECT_EQ(all.substr(last + 21), std::string(3, '\0'));
}

TEST_F(Lines, LookupsHaveCycleOfTheirLookup) {
  texture_rtl::CacheBench bench;
  LineTrace trace(file_, {"some_unit", 148.5, TraceFormat::kText, true});
  bench.ends.source.add(texture_rtl::in_line(3));
  bench.ends.source.add(texture_rtl::in_line(3));
  bench.clock.run(100);
  bench.ends.source.add(texture_rtl::in_line(3));
  bench.clock.run(10);
  trace.finish();
  // Pushed in 0, 1 and 100; the sets are read one cycle later and looked up in the next. The miss
  // queue takes the miss in 3 and requests the line in 4.
  EXPECT_EQ(bytes(),
            "# deburr-lines 1\n# engine some_unit\n# clock_mhz 148.5\n"
            "# port 0 memory 64 cache.memory_port\n# port 1 lookups 64 cache.tag_stage\n"
            "# clock event address bytes port\n2 miss 0x000000c0 64 1\n"
            "3 merged 0x000000c0 64 1\n5 read 0x000000c0 64 0\n"
            "102 hit 0x000000c0 64 1\n# end 4\n");
}

// With several ports each record has its port number and line; within a cycle they are ordered by
// number, whichever came first.
TEST_F(Lines, RecordsOfTwoPortsAreOrdered) {
  struct One {
    Driver<MemoryRequest> driver;
    rtl::MemoryPort port;
    Sink<rtl::MemoryResponse> sink;
    rtl::Link<MemoryRequest> requests;
    rtl::Link<rtl::MemoryResponse> responses;
    platform::MemoryModel memory;
    One(const std::string& name, rtl::ClockDomain& clock, const rtl::MemoryPortParameters& p)
        : driver((name + "_driver").c_str(), clock),
          port((name + "_port").c_str(), clock, p),
          sink((name + "_sink").c_str(), clock),
          requests((name + "_requests").c_str(), 2, rtl::request_shape(p, 64, 32)),
          responses((name + "_responses").c_str(), 2, rtl::response_shape(p, 64, 32)),
          memory((name + "_memory").c_str(), kPeriod) {
      driver.beats_out(requests);
      port.requests_in(requests);
      port.responses_out(responses);
      sink.beats_in(responses);
      port.memory.bind(memory.ports);
    }
    void ask(std::uint64_t address, bool write = false) {
      MemoryRequest request;
      request.address = address;
      request.write = write;
      request.byte_mask = write ? ~std::uint64_t{0} : 0;
      driver.send(request);
    }
  };
  rtl::ClockDomain clock("clock", kPeriod);
  One a("a", clock, {}), b("b", clock, {});
  clock.shuffle(3);
  a.ask(0x40);
  a.ask(0x80, true);
  b.ask(0x100);
  b.ask(0x140);
  b.ask(0x180);
  LineTrace trace(file_, {"two", 100, TraceFormat::kText, false});
  clock.run(100);
  trace.finish();
  EXPECT_EQ(trace.records(), 5u);
  EXPECT_EQ(bytes(),
            "# deburr-lines 1\n# engine two\n# clock_mhz 100\n# port 0 memory 64 a_port\n"
            "# port 1 memory 64 b_port\n# clock event address bytes port\n"
            "1 read 0x00000040 64 0\n1 read 0x00000100 64 1\n2 write 0x00000080 64 0\n"
            "2 read 0x00000140 64 1\n3 read 0x00000180 64 1\n# end 5\n");
}

TEST_F(Lines, RejectsPortsOfTwoClockDomains) {
  rtl::ClockDomain one("one", kPeriod), two("two", 2 * kPeriod);
  const rtl::MemoryPort first("first", one), second("second", two);
  EXPECT_THAT(([&] { LineTrace(file_, {}); }),
              testing::ThrowsMessage<spec::ConfigError>(
                  testing::HasSubstr("first belongs to one and second to two")));
}

TEST_F(Lines, RejectsTraceWithoutMemoryPort) {
  EXPECT_THROW(LineTrace(file_, {}), spec::ConfigError);
  EXPECT_FALSE(fs::exists(file_));
  Bench bench(bursts());
  EXPECT_THROW(LineTrace(file_, {"some_unit", 100, TraceFormat::kText, true}), spec::ConfigError)
      << "no cache";
  send(bench);
  { const LineTrace dropped(file_, {}); }
  bench.clock.run(100);
  EXPECT_FALSE(fs::exists(file_));
}

// Other targets remain: a run that only checks writes to the null device.
TEST(TraceOutput, RemovesOnlyRegularFiles) {
  const fs::path pipe = fs::temp_directory_path() / ("deburr_pipe_" + std::to_string(::getpid()));
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  { const TraceOutput output(pipe); }
  EXPECT_TRUE(fs::exists(pipe));
  ::close(reader);
  fs::remove(pipe);
}

}  // namespace
}  // namespace deburr::tb::traces::line_trace_test
