// SPDX-License-Identifier: MIT
// Memories: read latency, port rules, implementation cost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/fabric/fifo.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/memory_port.h"
#include "tb/unit/fabric/support.h"

namespace deburr::tb::memory_shape_test {
namespace {

using rtl::BankOrder;
using rtl::Cycle;
using rtl::Memory;
using rtl::MemoryBase;
using rtl::MemoryKind;
using rtl::MemoryShape;
using rtl::ReadDuringWrite;
using rtl::ReadPort;
using rtl::SharedPort;
using rtl::WritePort;
using testing::AllOf;
using testing::HasSubstr;

template <class F>
std::string rejection(F&& action) {
  return text_of<spec::CheckFailed>(action);
}

struct Ported {
  Memory<int> memory;
  WritePort<int> write{memory, "writer"};
  ReadPort<int> read{memory, "reader"};
  explicit Ported(std::uint32_t latency, ReadDuringWrite rule = ReadDuringWrite::kOldWord,
                  MemoryKind kind = MemoryKind::kSram)
      : memory("memory", {.words = 16,
                          .word_bits = 8,
                          .kind = kind,
                          .latency = latency,
                          .read_during_write = rule}) {
    for (int a = 0; a < 16; ++a) memory.backdoor(static_cast<std::uint64_t>(a)) = 100 + a;
  }
};

class MemoryLatency : public testing::TestWithParam<std::uint32_t> {};

TEST_P(MemoryLatency, WordArrivesExactlyWhenDue) {
  const std::uint32_t latency = GetParam();
  Ported p(latency);
  EXPECT_THAT(rejection([&] { p.read.word(9); }), HasSubstr("no read was issued"));
  p.read.read(10, 3);
  for (Cycle c = 10; c < 10 + latency; ++c) {
    EXPECT_FALSE(p.read.arrives(c));
    EXPECT_THAT(
        rejection([&] { p.read.word(c); }),
        AllOf(HasSubstr("memory: cycle " + std::to_string(c)), HasSubstr("read port reader"),
              HasSubstr("address 3 is used, expected from cycle " + std::to_string(10 + latency))));
  }
  EXPECT_TRUE(p.read.arrives(10 + latency));
  EXPECT_EQ(p.read.word(10 + latency), 103);
  EXPECT_FALSE(p.read.arrives(11 + latency));
}

TEST_P(MemoryLatency, WordStaysUntilNextRead) {
  const std::uint32_t latency = GetParam();
  Ported p(latency);
  p.read.read(10, 3);
  p.read.read(20, 4);
  p.write.write(15, 3, -1);  // the output register keeps the word as it was read
  EXPECT_EQ(p.read.word(19 + latency), 103);
  EXPECT_EQ(p.read.at(19 + latency, 3), 103);
  EXPECT_EQ(p.read.word(20 + latency), 104);
  EXPECT_THAT(rejection([&] { p.read.at(20 + latency, 3); }),
              HasSubstr("output register holds that of address 4"));
}

// The word of the previous access is still there: only the address tells them apart.
TEST_P(MemoryLatency, StaleWordUsedEarlyIsRejected) {
  const std::uint32_t latency = GetParam();
  Ported p(latency);
  p.read.read(10, 3);
  p.read.read(20, 4);
  const Cycle early = 20 + latency - 1;
  EXPECT_THAT(rejection([&] { p.read.at(early, 4); }),
              AllOf(HasSubstr("cycle " + std::to_string(early)),
                    HasSubstr("arrives in cycle " + std::to_string(20 + latency)),
                    HasSubstr("that of address 3")));
  EXPECT_EQ(p.read.at(20 + latency, 4), 104);
}

TEST_P(MemoryLatency, AcceptsOneAccessPerCycle) {
  const std::uint32_t latency = GetParam();
  Ported p(latency);
  for (Cycle c = 0; c < 200; ++c) {
    p.read.read(c, c % 16);
    if (c < latency) continue;
    EXPECT_TRUE(p.read.arrives(c));
    EXPECT_EQ(p.read.at(c, (c - latency) % 16), 100 + static_cast<int>((c - latency) % 16));
  }
  EXPECT_EQ(p.memory.reads(), 200U);
}

INSTANTIATE_TEST_SUITE_P(Cycles, MemoryLatency, testing::Values(1, 2, 3, 7));

// The unit issues the read in the cycle in which it needs the word: one cycle too late.
TEST(Memory, ReadIssuedTooLateIsRejected) {
  Ported p(2);
  p.read.read(9, 7);  // needed in cycle 10
  EXPECT_THAT(rejection([&] { p.read.at(10, 7); }), HasSubstr("expected from cycle 11 on"));
}

TEST(Memory, FlipFlopsReturnOldWordInSameCycle) {
  Ported p(0, ReadDuringWrite::kOldWord, MemoryKind::kFlops);
  p.write.write(4, 5, 55);
  EXPECT_EQ(p.read.now(4, 5), 105);  // whichever unit is ticked first
  EXPECT_EQ(p.read.now(5, 5), 55);
  p.write.write(5, 5, 56);
  EXPECT_EQ(p.read.word(5), 55);
  EXPECT_EQ(p.read.now(6, 5), 56);
  p.memory.clear(9);
  EXPECT_EQ(p.read.now(7, 0), 9);
}

TEST(Memory, RejectsClearExceptForFlipFlops) {
  Ported p(1);
  EXPECT_THAT(rejection([&] { p.memory.clear(9); }), HasSubstr("memory: only flip-flops"));
  EXPECT_EQ(p.memory.backdoor(3), 103);
}

TEST(Memory, ReadDuringWriteHoldsInAnyOrder) {
  for (const bool read_first : {true, false}) {
    const auto both = [&](Ported& p, Cycle c, int word) {
      if (read_first) p.read.read(c, 5);
      p.write.write(c, 5, word);
      if (!read_first) p.read.read(c, 5);
      return p.read.at(c + 2, 5);
    };
    Ported old_word(2);
    EXPECT_EQ(both(old_word, 10, 1), 105);
    EXPECT_EQ(both(old_word, 11, 2), 1);
    Ported new_word(2, ReadDuringWrite::kNewWord);
    EXPECT_EQ(both(new_word, 10, 1), 1);
    EXPECT_EQ(both(new_word, 11, 2), 2);
    Ported forbidden(2, ReadDuringWrite::kForbidden);
    EXPECT_THAT(rejection([&] { both(forbidden, 10, 1); }),
                AllOf(HasSubstr("memory"), HasSubstr("cycle 10"), HasSubstr("address 5"),
                      HasSubstr("forbidden")));
    forbidden.read.read(12, 5);
    EXPECT_NO_THROW(forbidden.write.write(12, 6, 1));
  }
}

TEST(Memory, ReadDuringWriteHoldsForEachWord) {
  for (const bool read_first : {true, false})
    for (const ReadDuringWrite rule :
         {ReadDuringWrite::kOldWord, ReadDuringWrite::kNewWord, ReadDuringWrite::kForbidden}) {
      Memory<int> memory("memory", {.words = 16,
                                    .word_bits = 8,
                                    .latency = 2,
                                    .read_during_write = rule,
                                    .banks = 4,
                                    .span = 3});
      ReadPort<int> read(memory, "read");
      WritePort<int> write(memory, "write");
      for (int a = 0; a < 16; ++a) memory.backdoor(static_cast<std::uint64_t>(a)) = 100 + a;
      const auto both = [&](Cycle c, std::uint64_t read_at, std::uint64_t write_at) {
        if (read_first) read.read(c, read_at, 3);
        write.write(c, write_at, std::array{1, 2});
        if (!read_first) read.read(c, read_at, 3);
      };
      const auto seen = [&](Cycle c, std::uint64_t from) {
        return std::array{read.at(c, from), read.at(c, from + 1), read.at(c, from + 2)};
      };
      both(10, 4, 7);  // adjacent words
      EXPECT_EQ(seen(12, 4), (std::array{104, 105, 106}));
      both(13, 4, 2);
      EXPECT_EQ(seen(15, 4), (std::array{104, 105, 106}));
      if (rule == ReadDuringWrite::kForbidden) {
        EXPECT_THAT(rejection([&] { both(16, 4, 6); }), HasSubstr("forbidden"));
        EXPECT_THAT(rejection([&] { both(17, 6, 5); }), HasSubstr("forbidden"));
        continue;
      }
      const bool fresh = rule == ReadDuringWrite::kNewWord;
      both(16, 4, 6);
      EXPECT_EQ(seen(18, 4), (std::array{104, 105, fresh ? 1 : 106}));
      both(19, 9, 8);
      EXPECT_EQ(seen(21, 9), (std::array{fresh ? 2 : 109, 110, 111}));
    }
}

// Each port has its own output register, which keeps the word from before a write.
TEST(Memory, PortsDoNotShareOutputWords) {
  Memory<int> memory("memory", {.words = 16,
                                .word_bits = 8,
                                .kind = MemoryKind::kFlops,
                                .read_ports = 2,
                                .write_ports = 2,
                                .latency = 1});
  for (int a = 0; a < 16; ++a) memory.backdoor(static_cast<std::uint64_t>(a)) = 100 + a;
  ReadPort<int> a(memory, "a"), b(memory, "b");
  WritePort<int> first(memory, "first"), second(memory, "second");
  a.read(0, 3);
  b.read(0, 9);
  EXPECT_EQ(a.at(1, 3), 103);
  EXPECT_EQ(b.at(1, 9), 109);
  first.write(2, 3, 1);
  second.write(2, 9, 2);
  a.read(2, 3);
  b.read(2, 9);
  EXPECT_EQ(a.at(3, 3), 103);
  EXPECT_EQ(b.at(3, 9), 109);
  a.read(3, 9);
  b.read(3, 3);
  EXPECT_EQ(a.at(4, 9), 2);
  EXPECT_EQ(b.at(4, 3), 1);
}

// A plain array without ports or timing, and the values that a port of the memory must show.
class PlainArray {
 public:
  PlainArray(std::size_t words, std::uint32_t latency, bool new_word)
      : latency_(latency), new_word_(new_word), words_(words) {}
  int& operator[](std::size_t address) { return words_[address]; }

  struct Access {
    std::size_t port = 0;
    bool write = false;
    std::uint64_t address = 0;
    std::vector<int> words;  // words to write; for a read, its size gives the number of words
    bool meets(const Access& other) const {
      return address < other.address + other.words.size() && other.address < address + words.size();
    }
  };
  struct Shown {
    Cycle issued, due;
    std::uint64_t address;
    std::vector<int> words;
  };
  void clock(Cycle cycle, const std::vector<Access>& accesses) {
    std::vector<int> after = words_;
    for (const Access& a : accesses)
      if (a.write) std::copy(a.words.begin(), a.words.end(), after.begin() + offset(a));
    for (const Access& a : accesses) {
      if (a.write) continue;
      const auto from = (new_word_ ? after : words_).begin() + offset(a);
      shown_.resize(std::max(shown_.size(), a.port + 1));
      shown_[a.port].push_back(
          {cycle, cycle + latency_, a.address,
           std::vector<int>(from, from + static_cast<std::ptrdiff_t>(a.words.size()))});
    }
    words_ = std::move(after);
  }
  // nullptr: no word yet.
  const Shown* shown(std::size_t port, Cycle cycle) const {
    const Shown* newest = nullptr;
    if (port < shown_.size())
      for (const Shown& one : shown_[port])
        if (one.due <= cycle) newest = &one;
    return newest;
  }

 private:
  static std::ptrdiff_t offset(const Access& a) { return static_cast<std::ptrdiff_t>(a.address); }
  Cycle latency_;
  bool new_word_;
  std::vector<int> words_;
  std::vector<std::deque<Shown>> shown_;
};

// For any ports, span, latency and order of accesses within a cycle.
TEST(Memory, MatchesPlainArrayReference) {
  constexpr std::uint64_t kWords = 13;
  std::uint64_t compared = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Random random(seed, "memory");
    const std::uint32_t latency = random.below(5), span = 1 + random.below(3);
    const std::uint32_t reads = 1 + random.below(3), writes = 1 + random.below(3),
                        shared = random.below(3);
    const bool new_word = latency > 0 && random.chance(500);
    Memory<int> memory(
        "memory",
        {.words = kWords,
         .word_bits = 32,
         .read_ports = reads,
         .write_ports = writes,
         .shared_ports = shared,
         .latency = latency,
         .read_during_write = new_word ? ReadDuringWrite::kNewWord : ReadDuringWrite::kOldWord,
         .banks = span,
         .span = span,
         .not_implementable = "any ports, so that their numbers are compared"});
    std::deque<ReadPort<int>> read_ports;
    std::deque<WritePort<int>> write_ports;
    std::deque<SharedPort<int>> shared_ports;
    for (std::uint32_t i = 0; i < reads; ++i) read_ports.emplace_back(memory, "read");
    for (std::uint32_t i = 0; i < writes; ++i) write_ports.emplace_back(memory, "write");
    for (std::uint32_t i = 0; i < shared; ++i) shared_ports.emplace_back(memory, "shared");
    // Shared ports are in both lists.
    std::vector<rtl::ReadAccess<int>*> readers;
    std::vector<rtl::WriteAccess<int>*> writers;
    for (ReadPort<int>& port : read_ports) readers.push_back(&port);
    for (WritePort<int>& port : write_ports) writers.push_back(&port);
    for (SharedPort<int>& port : shared_ports) {
      readers.push_back(&port);
      writers.push_back(&port);
    }
    PlainArray array(kWords, latency, new_word);
    for (std::uint64_t a = 0; a < kWords; ++a)
      memory.backdoor(a) = array[a] = 1'000'000 + static_cast<int>(a);
    int next = 0;
    for (Cycle cycle = 0; cycle < 120; ++cycle) {
      std::vector<PlainArray::Access> accesses;
      const auto access = [&](std::size_t port, bool write) {
        PlainArray::Access a{port, write, 0, std::vector<int>(1 + random.below(span))};
        a.address = random.below(static_cast<std::uint32_t>(kWords - a.words.size() + 1));
        for (int& word : a.words) word = ++next;
        for (const PlainArray::Access& other : accesses)
          if (write && other.write && a.meets(other)) return;
        accesses.push_back(std::move(a));
      };
      for (std::size_t i = 0; i < reads; ++i)
        if (random.chance(600)) access(i, false);
      for (std::size_t i = 0; i < writes; ++i)
        if (random.chance(500)) access(i, true);
      for (std::size_t i = 0; i < shared; ++i)
        if (const bool write = random.chance(400); random.chance(700))
          access((write ? writes : reads) + i, write);
      for (std::size_t i = accesses.size(); i > 1; --i)
        std::swap(accesses[i - 1], accesses[random.below(static_cast<std::uint32_t>(i))]);
      for (const PlainArray::Access& a : accesses)
        if (a.write)
          writers[a.port]->write(cycle, a.address, std::span<const int>(a.words));
        else
          readers[a.port]->read(cycle, a.address, a.words.size());
      array.clock(cycle, accesses);
      for (std::size_t port = 0; port < readers.size(); ++port) {
        const PlainArray::Shown* const shown = array.shown(port, cycle);
        ASSERT_EQ(readers[port]->arrives(cycle), shown && shown->due == cycle);
        if (!shown) continue;
        ASSERT_EQ(readers[port]->word(cycle), shown->words[0]) << "seed " << seed;
        for (std::size_t i = 0; i < shown->words.size(); ++i, ++compared)
          ASSERT_EQ(readers[port]->at(cycle, shown->address + i, shown->issued), shown->words[i])
              << "seed " << seed << ", port " << port << ", cycle " << cycle;
      }
    }
    for (std::uint64_t a = 0; a < kWords; ++a) ASSERT_EQ(memory.backdoor(a), array[a]);
  }
  EXPECT_GT(compared, 100'000U);
}

// When an address is read again, it does not tell whether the new word has arrived; the access
// number does.
TEST(Memory, RepeatedReadIsIdentifiedByItsAccess) {
  Ported p(2);
  p.read.read(10, 3);
  p.write.write(11, 3, 7);
  p.read.read(12, 3);
  EXPECT_EQ(p.read.at(13, 3), 103);  // one cycle early: by its address it may be the right word
  EXPECT_THAT(rejection([&] { p.read.at(13, 3, 12); }),
              AllOf(HasSubstr("cycle 13: read port reader: the word of address 3"),
                    HasSubstr("as it was read in cycle 12"), HasSubstr("holds that of cycle 10")));
  EXPECT_EQ(p.read.at(13, 3, 10), 103);
  EXPECT_EQ(p.read.at(14, 3, 12), 7);
  EXPECT_THROW(p.read.at(14, 3, 10), spec::CheckFailed);
  EXPECT_THROW(p.read.at(14, 4, 12), spec::CheckFailed);
  Memory<void> checked("checked", {.words = 8, .word_bits = 4});
  ReadPort<void> read(checked, "read");
  read.read(4, 5);
  EXPECT_NO_THROW(read.check(5, 5, 4));
  EXPECT_THROW(read.check(5, 5, 5), spec::CheckFailed);
}

TEST(Memory, WriteAfterReadDoesNotReachIt) {
  Ported p(3, ReadDuringWrite::kNewWord);
  p.read.read(10, 5);
  p.write.write(11, 5, 1);
  EXPECT_EQ(p.read.at(13, 5), 105);
}

TEST(Memory, ExtraAccessIsRejected) {
  Ported p(1);
  p.read.read(4, 1);
  EXPECT_THAT(rejection([&] { p.read.read(4, 2); }),
              AllOf(HasSubstr("memory: cycle 4: read port reader"), HasSubstr("address 2"),
                    HasSubstr("second access"), HasSubstr("1R1W")));
  p.write.write(4, 1, 0);
  EXPECT_THAT(rejection([&] { p.write.write(4, 2, 0); }), HasSubstr("write port writer"));
  EXPECT_NO_THROW(p.read.read(5, 2));
}

TEST(Memory, RejectsAddressesOutOfRange) {
  Ported p(1);
  EXPECT_THAT(rejection([&] { p.read.read(0, 16); }), HasSubstr("16 words"));
  EXPECT_THAT(rejection([&] { p.write.write(0, ~std::uint64_t{0}, 1); }), HasSubstr("16 words"));
  EXPECT_THAT(rejection([&] { p.write.write(1, 16, 1); }), HasSubstr("16 words"));
  EXPECT_THAT(rejection([&] { p.read.read(1, 3, 2); }), HasSubstr("at most 1"));
  EXPECT_THAT(rejection([&] { p.read.read(2, 3, 0); }), HasSubstr("0 words from address 3"));
  EXPECT_THAT(rejection([&] { p.write.write(2, 3, std::span<const int>{}); }),
              HasSubstr("0 words from address 3"));
}

TEST(Memory, PortsMatchTheShape) {
  Memory<int> memory("memory", {.words = 16, .word_bits = 8, .read_ports = 2});
  ReadPort<int> first(memory, "first");
  EXPECT_THAT(rejection([&] { memory.check_ports(); }), HasSubstr("2R1W is unused"));
  ReadPort<int> second(memory, "second");
  EXPECT_THAT(rejection([&] { ReadPort<int> third(memory, "third"); }),
              AllOf(HasSubstr("third"), HasSubstr("2R1W")));
  WritePort<int> write(memory, "write");
  EXPECT_NO_THROW(memory.check_ports());
  first.read(3, 1);
  EXPECT_NO_THROW(second.read(3, 2));
  ReadPort<int> shares = second;  // a second user of the same port
  EXPECT_THAT(rejection([&] { shares.read(3, 3); }), HasSubstr("second access"));
  shares.read(4, 3);
  EXPECT_NO_THROW(second.at(5, 3));
}

TEST(Memory, SharedPortReadsOrWrites) {
  Memory<int> memory(
      "memory", {.words = 8, .word_bits = 8, .read_ports = 0, .write_ports = 0, .shared_ports = 1});
  SharedPort<int> port(memory, "port");
  port.write(0, 3, 33);
  EXPECT_THAT(rejection([&] { port.read(0, 3); }), HasSubstr("shared port port"));
  port.read(1, 3);
  EXPECT_THROW(port.write(1, 3, 34), spec::CheckFailed);
  port.write(2, 3, 34);
  EXPECT_EQ(port.at(2, 3), 33);
  EXPECT_EQ(memory.built_as(), "1RW");
  EXPECT_EQ(memory.ports(), "1RW");
  const MemoryBase mixed("mixed", {.words = 8,
                                   .word_bits = 8,
                                   .read_ports = 2,
                                   .write_ports = 1,
                                   .shared_ports = 3,
                                   .not_implementable = "three kinds of ports"});
  EXPECT_EQ(mixed.ports(), "2R1W3RW");
}

// The only read port uses a bank twice if an access has more words than there are banks.
TEST(Memory, NotImplementableAccessConflictsWithItself) {
  Memory<int> memory("memory", {.words = 12,
                                .word_bits = 4,
                                .banks = 2,
                                .span = 3,
                                .separate_banks = true,
                                .not_implementable = "more words an access than banks"});
  ReadPort<int> read(memory, "read");
  WritePort<int> write(memory, "write");
  read.read(0, 4, 2);
  EXPECT_THAT(rejection([&] { read.read(1, 4, 3); }), HasSubstr("bank"));
  write.write(2, 5, std::array{1, 2});
  EXPECT_THAT(rejection([&] { write.write(3, 5, std::array{1, 2, 3}); }), HasSubstr("bank"));
}

TEST(Memory, OneAccessReadsAdjacentWordsInDifferentBanks) {
  Memory<int> memory("memory", {.words = 10,
                                .word_bits = 4,
                                .read_during_write = ReadDuringWrite::kOldWord,
                                .banks = 4,
                                .span = 3});
  ReadPort<int> read(memory, "read");
  WritePort<int> write(memory, "write");
  write.write(0, 5, std::array{50, 60, 70});
  read.read(0, 6, 2);
  EXPECT_EQ(read.at(1, 6), 0);  // old words
  read.read(1, 5, 3);
  EXPECT_EQ(read.at(2, 5), 50);
  EXPECT_EQ(read.at(2, 7), 70);
  EXPECT_EQ(memory.ports(), "1R1W of 3 words");
  EXPECT_THAT(rejection([&] { read.at(2, 8); }), HasSubstr("address 8"));
  EXPECT_THROW(read.read(3, 8, 3), spec::CheckFailed);
  EXPECT_THROW(read.read(4, 0, 4), spec::CheckFailed);
}

TEST(Memory, SeparateBanksAreChecked) {
  Memory<int> rows("rows", {.words = 40,
                            .word_bits = 4,
                            .read_ports = 3,
                            .banks = 4,
                            .order = BankOrder::kBlocks,
                            .separate_banks = true});
  EXPECT_EQ(rows.built_as(), "1R1W, 4 banks");
  EXPECT_EQ(rows.physical_bits(), 160U);
  ReadPort<int> above(rows, "above"), centre(rows, "centre"), below(rows, "below");
  WritePort<int> write(rows, "write");
  above.read(0, 3);
  centre.read(0, 13);
  below.read(0, 23);
  write.write(0, 5, 1);
  above.read(1, 10);
  EXPECT_THAT(rejection([&] { centre.read(1, 19); }),
              AllOf(HasSubstr("read port centre"), HasSubstr("bank 1")));
  EXPECT_NO_THROW(below.read(1, 20));
}

// Words whose distance is a multiple of the number of banks share a bank; others do not.
TEST(Memory, AdjacentWordsLieInDifferentBanks) {
  for (const std::uint32_t banks : {2u, 3u, 4u, 8u}) {
    Memory<int> memory(
        "memory",
        {.words = 64, .word_bits = 4, .read_ports = 2, .banks = banks, .separate_banks = true});
    ReadPort<int> first(memory, "first"), second(memory, "second");
    Cycle cycle = 0;
    for (const std::uint64_t other : {16u, 17u})
      for (std::uint64_t a = 0; a < 32; ++a) {
        first.read(++cycle, other);
        if (a % banks == other % banks)
          EXPECT_THROW(second.read(cycle, a), spec::CheckFailed) << a << " in " << banks;
        else
          EXPECT_NO_THROW(second.read(cycle, a)) << a << " in " << banks;
      }
  }
}

// 41 words in 4 banks of 11; the last bank holds 8.
TEST(Memory, BlockSizeIsRoundedUp) {
  Memory<int> memory("memory", {.words = 41,
                                .word_bits = 4,
                                .read_ports = 2,
                                .banks = 4,
                                .order = BankOrder::kBlocks,
                                .separate_banks = true});
  ReadPort<int> first(memory, "first"), second(memory, "second");
  Cycle cycle = 0;
  for (std::uint64_t a = 0; a < 41; ++a)
    for (std::uint64_t b = 0; b < 41; ++b) {
      first.read(++cycle, a);
      if (a / 11 == b / 11)
        EXPECT_THROW(second.read(cycle, b), spec::CheckFailed) << a << ' ' << b;
      else
        EXPECT_NO_THROW(second.read(cycle, b)) << a << ' ' << b;
    }
}

// Each word of an access uses its own bank.
TEST(Memory, EveryWordOfAccessUsesItsBank) {
  for (const std::uint64_t count : {1u, 2u, 3u}) {
    Memory<int> memory("memory", {.words = 64,
                                  .word_bits = 4,
                                  .read_ports = 2,
                                  .banks = 4,
                                  .span = 3,
                                  .separate_banks = true});
    ReadPort<int> first(memory, "first"), second(memory, "second");
    Cycle cycle = 0;
    for (std::uint64_t a = 0; a < 8; ++a) {
      first.read(++cycle, 16, count);
      if (a % 4 < count)
        EXPECT_THROW(second.read(cycle, a), spec::CheckFailed) << a << " next to " << count;
      else
        EXPECT_NO_THROW(second.read(cycle, a)) << a << " next to " << count;
    }
  }
}

// Both rules together: a read and a write of one bank do not touch the same word.
TEST(Memory, SeparateBanksFollowReadDuringWriteRule) {
  Memory<int> memory("memory", {.words = 16,
                                .word_bits = 4,
                                .read_during_write = ReadDuringWrite::kForbidden,
                                .banks = 4,
                                .separate_banks = true});
  ReadPort<int> read(memory, "read");
  WritePort<int> write(memory, "write");
  write.write(1, 5, 1);
  EXPECT_THAT(rejection([&] { read.read(1, 5); }), HasSubstr("forbidden"));
  write.write(2, 5, 1);
  EXPECT_NO_THROW(read.read(2, 9));
}

TEST(Memory, SeparateBanksOfSharedPortsHaveOnePort) {
  Memory<int> memory("memory", {.words = 8,
                                .word_bits = 4,
                                .read_ports = 0,
                                .write_ports = 0,
                                .shared_ports = 2,
                                .banks = 2,
                                .separate_banks = true});
  EXPECT_EQ(memory.built_as(), "1RW, 2 banks");
  SharedPort<int> a(memory, "a"), b(memory, "b");
  a.write(0, 2, 1);
  EXPECT_THROW(b.read(0, 4), spec::CheckFailed);
  EXPECT_NO_THROW(b.read(1, 4));
  EXPECT_NO_THROW(a.write(1, 3, 1));
}

TEST(Memory, RejectsSeveralWritersOfOneWord) {
  Memory<int> memory(
      "memory",
      {.words = 8, .word_bits = 4, .kind = MemoryKind::kFlops, .write_ports = 2, .latency = 0});
  ReadPort<int> read(memory, "read");
  WritePort<int> a(memory, "a"), b(memory, "b");
  a.write(0, 1, 11);
  b.write(0, 2, 22);
  EXPECT_EQ(read.now(0, 2), 0);
  EXPECT_EQ(read.now(1, 2), 22);
  a.write(2, 1, 12);
  EXPECT_THAT(rejection([&] { b.write(2, 1, 13); }), HasSubstr("write port b"));
}

TEST(Memory, PartialWordNeedsWriteMask) {
  Memory<std::array<int, 2>> memory("memory", {.words = 8,
                                               .word_bits = 16,
                                               .read_during_write = ReadDuringWrite::kOldWord,
                                               .mask_bits = 8});
  ReadPort<std::array<int, 2>> read(memory, "read");
  WritePort<std::array<int, 2>> write(memory, "write");
  write.write(0, 1, {10, 20});
  write.change(1, 1, [](std::array<int, 2>& word) { word[1] = 21; });
  read.read(1, 1);
  EXPECT_EQ(read.at(2, 1), (std::array{10, 20}));
  read.read(2, 1);
  EXPECT_EQ(read.at(3, 1), (std::array{10, 21}));
  EXPECT_EQ(memory.built_as(), "1R1W, old word, write mask of 8 bits");
  Ported p(1);
  EXPECT_THAT(rejection([&] { p.write.change(0, 1, [](int& word) { word = 1; }); }),
              HasSubstr("mask_bits"));
}

TEST(Memory, ChecksRemainWithoutStoredWords) {
  Memory<void> memory("memory", {.words = 8, .word_bits = 4, .latency = 2});
  ReadPort<void> read(memory, "read");
  WritePort<void> write(memory, "write");
  read.read(0, 5);
  EXPECT_THROW(read.check(1), spec::CheckFailed);
  read.read(1, 6);
  EXPECT_NO_THROW(read.check(2, 5));
  EXPECT_THROW(read.check(2, 6), spec::CheckFailed);
  EXPECT_NO_THROW(read.check(3, 6));
  EXPECT_THROW(read.read(1, 6), spec::CheckFailed);
  EXPECT_THAT(rejection([&] { write.write(3, 8); }), HasSubstr("1 words from address 8 on"));
  EXPECT_NO_THROW(write.write(4, 7));
}

// A table that is loaded while no unit reads it: the read ports also serve for loading.
TEST(Memory, LoadedTableHasContentAndNoWritePort) {
  constexpr std::array<std::int8_t, 4> kTable = {-128, -1, 0, 127};
  const auto build = [&](std::uint32_t reads, std::uint32_t writes, MemoryKind kind) {
    return Memory<std::int8_t>("loaded",
                               {.words = 4,
                                .word_bits = 8,
                                .kind = kind,
                                .read_ports = reads,
                                .write_ports = writes,
                                .loaded = true},
                               kTable);
  };
  Memory<std::int8_t> table = build(4, 0, MemoryKind::kSram);
  EXPECT_EQ(table.built_as(), "2 copies of 2RW");
  EXPECT_EQ(table.physical_bits(), 2u * 4 * 8);
  EXPECT_EQ(table.ports(), "4R");
  EXPECT_EQ(build(1, 0, MemoryKind::kSram).built_as(), "1RW");
  EXPECT_EQ(build(3, 0, MemoryKind::kSram).built_as(), "2 copies of 2RW");
  ReadPort<std::int8_t> read(table, "read");
  read.read(0, 0);
  EXPECT_EQ(read.at(1, 0), -128);
  table.backdoor(0) = 5;
  read.read(1, 0);
  EXPECT_EQ(read.at(2, 0), 5);
  EXPECT_THAT(text_of<spec::ConfigError>([&] { build(2, 1, MemoryKind::kSram); }),
              HasSubstr("cannot have write ports"));
  EXPECT_THAT(
      text_of<spec::ConfigError>([] {
        MemoryBase(
            "loaded",
            {.words = 4, .word_bits = 8, .write_ports = 1, .shared_ports = 1, .loaded = true});
      }),
      HasSubstr("cannot have write ports"));
  EXPECT_THAT(text_of<spec::ConfigError>([&] { build(2, 0, MemoryKind::kRom); }),
              HasSubstr("only sram can be loaded"));
  EXPECT_THAT(text_of<spec::ConfigError>([&] { build(2, 0, MemoryKind::kFlops); }),
              HasSubstr("only sram can be loaded"));
}

TEST(Memory, RomHasItsContent) {
  constexpr std::array<std::uint16_t, 5> kTable = {1, 4, 9, 16, 25};
  Memory<std::uint16_t> rom(
      "rom", {.words = 5, .word_bits = 5, .kind = MemoryKind::kRom, .write_ports = 0}, kTable);
  ReadPort<std::uint16_t> read(rom, "read");
  read.read(0, 3);
  EXPECT_EQ(read.at(1, 3), 16);
  EXPECT_EQ(rom.ports(), "1R");
  const auto build = [&](std::uint64_t words, std::uint32_t bits, MemoryKind kind) {
    return Memory<std::uint16_t>("table",
                                 {.words = words,
                                  .word_bits = bits,
                                  .kind = kind,
                                  .write_ports = kind == MemoryKind::kRom ? 0U : 1U},
                                 kTable);
  };
  EXPECT_THAT(rejection([&] { build(4, 5, MemoryKind::kRom); }), HasSubstr("5 words of content"));
  EXPECT_THAT(rejection([&] { build(6, 5, MemoryKind::kRom); }), HasSubstr("need all words"));
  EXPECT_THAT(rejection([&] { build(5, 4, MemoryKind::kRom); }),
              HasSubstr("0x10 at address 3 has more than 4 bits"));
  EXPECT_THAT(rejection([&] { build(5, 5, MemoryKind::kSram); }), HasSubstr("sram has none"));
  EXPECT_THAT(rejection([&] { build(4, 5, MemoryKind::kFlops); }), HasSubstr("5 words of content"));
  EXPECT_NO_THROW(build(5, 5, MemoryKind::kFlops));
  EXPECT_NO_THROW(build(6, 5, MemoryKind::kFlops));
  EXPECT_THAT(rejection([&] {
                Memory<int>(
                    "bare",
                    {.words = 4, .word_bits = 5, .kind = MemoryKind::kRom, .write_ports = 0});
              }),
              HasSubstr("0 words of content"));
}

TEST(Memory, SignedContentFitsItsBits) {
  const auto build = [](int word) {
    const std::array<std::int16_t, 1> content = {static_cast<std::int16_t>(word)};
    Memory<std::int16_t>(
        "rom", {.words = 1, .word_bits = 5, .kind = MemoryKind::kRom, .write_ports = 0}, content);
  };
  for (const int word : {-16, -1, 0, 15, 31}) EXPECT_NO_THROW(build(word)) << word;
  for (const int word : {-17, 32}) EXPECT_THROW(build(word), spec::CheckFailed) << word;
}

TEST(Memory, WideContentFitsItsBits) {
  const auto build = [](std::uint32_t bits, std::uint64_t word) {
    const std::array<std::uint64_t, 1> content = {word};
    Memory<std::uint64_t>(
        "rom", {.words = 1, .word_bits = bits, .kind = MemoryKind::kRom, .write_ports = 0},
        content);
  };
  EXPECT_NO_THROW(build(64, ~std::uint64_t{0}));
  EXPECT_NO_THROW(build(63, ~std::uint64_t{0} >> 1));
  EXPECT_THROW(build(63, std::uint64_t{1} << 63), spec::CheckFailed);
}

TEST(Memory, ResetClearsBookkeepingAndKeepsWords) {
  Ported p(1);
  p.read.read(5, 3);
  p.memory.reset();
  EXPECT_THROW(p.read.word(6), spec::CheckFailed);
  EXPECT_NO_THROW(p.read.read(5, 3));
  EXPECT_EQ(p.read.at(6, 3), 103);
  EXPECT_EQ(p.memory.reads(), 1U);
}

TEST(Memory, WriteBeforeResetDoesNotCountAfterIt) {
  Ported p(1);
  p.write.write(5, 3, 7);
  p.memory.reset();
  EXPECT_NO_THROW(p.write.write(5, 3, 8));
  EXPECT_EQ(p.memory.writes(), 1U);
}

// A domain resets memories inside units and next to them.
class Holder final : public rtl::Unit {
 public:
  Ported inside{1};
  Holder(const sc_core::sc_module_name& name, rtl::ClockDomain& clock) : Unit(name, clock) {}
  rtl::Activity tick(Cycle cycle) override {
    inside.read.read(cycle, cycle % 16);
    return rtl::kBusy;
  }
  void reset() override {}
};

TEST(Memory, DomainResetsMemory) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  Holder holder("holder", clock);
  Ported outside(1);
  clock.run(5);
  outside.read.read(clock.cycle(), 3);
  EXPECT_EQ(holder.inside.memory.reads(), 5U);
  EXPECT_EQ(outside.memory.reads(), 1U);
  clock.set_reset_n(false);
  clock.run(1);
  for (Ported* p : {&holder.inside, &outside}) {
    EXPECT_EQ(p->memory.reads(), 0U);
    EXPECT_THROW(p->read.word(clock.cycle() + 1), spec::CheckFailed);
    EXPECT_EQ(p->memory.backdoor(7), 107);
  }
}

TEST(Memory, DomainRejectsUnusedPort) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  Memory<int> memory("memory", {.words = 16, .word_bits = 8});
  const ReadPort<int> read(memory, "read");
  EXPECT_THAT(rejection([&] { clock.run(1); }), HasSubstr("memory: one of its ports 1R1W"));
}

// ---- Implementation cost -----------------------------------------------------------------------

struct Cost {
  MemoryShape shape;
  std::uint64_t logical, physical;
  std::uint32_t copies;
  std::string built_as;
};

TEST(MemoryCost, MatchesRealMemories) {
  const std::vector<Cost> costs = {
      {{.words = 1920, .word_bits = 24}, 46'080, 46'080, 1, "1R1W"},
      {{.words = 1920, .word_bits = 24, .read_ports = 3}, 46'080, 138'240, 3, "3 copies of 1R1W"},
      // 1 000 words in 16 banks of 63
      {{.words = 1000, .word_bits = 10, .read_ports = 2, .banks = 16},
       10'000,
       20'160,
       2,
       "2 copies of 1R1W, 16 banks"},
      {{.words = 512, .word_bits = 32, .read_ports = 0, .write_ports = 0, .shared_ports = 2},
       16'384,
       16'384,
       1,
       "2RW"},
      {{.words = 512, .word_bits = 32, .read_ports = 3, .write_ports = 0, .shared_ports = 1},
       16'384,
       49'152,
       3,
       "3 copies of 2RW"},
      {{.words = 512, .word_bits = 32, .read_ports = 0, .write_ports = 1, .shared_ports = 1},
       16'384,
       16'384,
       1,
       "2RW"},
      {{.words = 256, .word_bits = 12, .kind = MemoryKind::kRom, .read_ports = 5, .write_ports = 0},
       3072,
       9216,
       3,
       "3 copies of 2R"},
      {{.words = 256, .word_bits = 12, .kind = MemoryKind::kRom, .write_ports = 0},
       3072,
       3072,
       1,
       "1R"},
      {{.words = 256, .word_bits = 12, .kind = MemoryKind::kRom, .read_ports = 2, .write_ports = 0},
       3072,
       3072,
       1,
       "2R"},
      {{.words = 512,
        .word_bits = 32,
        .kind = MemoryKind::kFlops,
        .read_ports = 4,
        .write_ports = 4,
        .latency = 0},
       16'384,
       16'384,
       1,
       "flip-flops"},
      {{.words = 16, .word_bits = 27, .write_ports = 4, .banks = 4, .separate_banks = true},
       432,
       432,
       1,
       "1R1W, 4 banks"}};
  for (const Cost& cost : costs) {
    const MemoryBase memory("memory", cost.shape);
    EXPECT_EQ(memory.logical_bits(), cost.logical) << cost.built_as;
    EXPECT_EQ(memory.physical_bits(), cost.physical) << cost.built_as;
    EXPECT_EQ(memory.copies(), cost.copies) << cost.built_as;
    EXPECT_EQ(memory.built_as(), cost.built_as);
    EXPECT_TRUE(memory.not_implementable().empty());
  }
}

TEST(MemoryCost, UnavailableMemoryIsRejectedWithAlternative) {
  const auto rejected = [](const MemoryShape& shape) {
    return text_of<spec::ConfigError>([&] { MemoryBase("memory", shape); });
  };
  EXPECT_THAT(rejected({.words = 513, .word_bits = 32, .kind = MemoryKind::kFlops, .latency = 0}),
              AllOf(HasSubstr("memory: 16416 bits as flops 1R1W"), HasSubstr("16384"),
                    HasSubstr("use sram")));
  EXPECT_THAT(rejected({.words = 8, .word_bits = 8, .kind = MemoryKind::kFlops, .latency = 2}),
              HasSubstr("latency of 0 or 1"));
  EXPECT_THAT(rejected({.words = 8, .word_bits = 8, .latency = 0}),
              HasSubstr("latency of at least 1"));
  EXPECT_THAT(rejected({.words = 8, .word_bits = 8, .write_ports = 2}),
              AllOf(HasSubstr("sram 1R2W"), HasSubstr("separate banks")));
  EXPECT_THAT(
      rejected({.words = 8, .word_bits = 8, .read_ports = 1, .write_ports = 0, .shared_ports = 2}),
      HasSubstr("no write ports"));
  EXPECT_THAT(
      rejected({.words = 8, .word_bits = 8, .read_ports = 1, .write_ports = 1, .shared_ports = 1}),
      HasSubstr("no read port is left"));
  EXPECT_THAT(
      rejected({.words = 8, .word_bits = 8, .read_ports = 0, .write_ports = 1, .shared_ports = 2}),
      HasSubstr("no write ports"));
  EXPECT_THAT(rejected({.words = 8, .word_bits = 8, .write_ports = 0}), HasSubstr("use rom"));
  EXPECT_THAT(rejected({.words = 8, .word_bits = 8, .read_ports = 0}), HasSubstr("no read port"));
  EXPECT_THAT(rejected({.words = 8, .word_bits = 8, .kind = MemoryKind::kRom}),
              HasSubstr("cannot have write ports"));
  EXPECT_THAT(rejected({.words = 8, .word_bits = 8, .span = 2}), HasSubstr("interleaved banks"));
  EXPECT_THAT(
      rejected({.words = 8, .word_bits = 8, .banks = 2, .order = BankOrder::kBlocks, .span = 2}),
      HasSubstr("interleaved banks"));
  // SRAM or ROM in name, registers in fact: a row of 24 576 words that are all used at once.
  for (const MemoryKind kind : {MemoryKind::kSram, MemoryKind::kRom}) {
    const std::uint32_t writes = kind == MemoryKind::kSram ? 1 : 0;
    const auto banked = [&](std::uint64_t words, std::uint32_t banks) {
      return MemoryShape{.words = words,
                         .word_bits = 2,
                         .kind = kind,
                         .write_ports = writes,
                         .banks = banks,
                         .span = banks};
    };
    EXPECT_THAT(rejected(banked(24'576, 24'576)),
                AllOf(HasSubstr("24576 banks of fewer than 16 words"), HasSubstr("use flops")));
    EXPECT_THAT(rejected(banked(65 * 16 - 1, 65)), HasSubstr("use flops"));
    EXPECT_NO_THROW(MemoryBase("memory", banked(65 * 16, 65)));
    EXPECT_NO_THROW(MemoryBase("memory", banked(64, 64)));
  }
  EXPECT_THAT(
      rejected({.words = 64, .word_bits = 8, .read_ports = 3, .banks = 2, .separate_banks = true}),
      AllOf(HasSubstr("3 accesses of a kind"), HasSubstr("2 separate banks")));
  EXPECT_THAT(rejected({.words = 64,
                        .word_bits = 8,
                        .kind = MemoryKind::kFlops,
                        .write_ports = 5,
                        .banks = 4,
                        .separate_banks = true}),
              HasSubstr("use 5 banks"));
  EXPECT_THAT(rejection([] {
                MemoryBase("memory", {.words = 8,
                                      .word_bits = 8,
                                      .kind = MemoryKind::kFlops,
                                      .latency = 0,
                                      .read_during_write = ReadDuringWrite::kNewWord});
              }),
              HasSubstr("need a latency of at least 1"));
  EXPECT_THAT(
      rejection([] { MemoryBase("memory", {.words = 8, .word_bits = 16, .mask_bits = 5}); }),
      HasSubstr("a write mask of 5 bits does not divide words of 16"));
}

// Each field alone is invalid, the others are valid.
TEST(MemoryCost, RejectsInvalidShape) {
  const auto make = [](MemoryShape shape) { const MemoryBase memory("memory", shape); };
  const MemoryShape right{.words = 16, .word_bits = 8, .kind = MemoryKind::kFlops, .banks = 16};
  EXPECT_NO_THROW(make(right));
  const std::function<void(MemoryShape&)> wrongs[] = {
      [](MemoryShape& s) { s.words = 0; },
      [](MemoryShape& s) { s.word_bits = 0; },
      [](MemoryShape& s) { s.banks = 0; },
      [](MemoryShape& s) { s.banks = 17; },
      [](MemoryShape& s) { s.span = 0; },
      [](MemoryShape& s) { s.latency = 8; },
      [](MemoryShape& s) { s.content = "two\nlines"; }};
  for (const auto& wrong : wrongs) {
    MemoryShape shape = right;
    wrong(shape);
    EXPECT_THROW(make(shape), spec::CheckFailed) << (&wrong - wrongs);
  }
}

TEST(MemoryCost, NotImplementableSaysSoAndWhy) {
  const MemoryBase wide("wide", {.words = 1920,
                                 .word_bits = 288,
                                 .read_ports = 13,
                                 .write_ports = 2,
                                 .not_implementable = "shows what unlimited ports would give"});
  EXPECT_EQ(wide.not_implementable(), "shows what unlimited ports would give");
  EXPECT_EQ(wide.built_as(), "not implementable 13R2W");
  const MemoryBase small("small", {.words = 16, .word_bits = 8, .not_implementable = "not needed"});
  EXPECT_TRUE(small.not_implementable().empty());
}

TEST(MemoryCost, NamesTwoWordPorts) {
  const MemoryBase pairs("pairs", {.words = 64, .word_bits = 4, .banks = 2, .span = 2});
  EXPECT_EQ(pairs.ports(), "1R1W of 2 words");
}

TEST(MemoryCost, RomRejectsWritePortsOfBothKinds) {
  EXPECT_THAT(text_of<spec::ConfigError>([] {
                MemoryBase("rom", {.words = 4,
                                   .word_bits = 8,
                                   .kind = MemoryKind::kRom,
                                   .write_ports = 1,
                                   .shared_ports = 1});
              }),
              HasSubstr("a rom cannot have write ports"));
}

TEST(MemoryCost, ScalesWithFrameWidth) {
  // Two rows of one entry per pair of columns.
  const MemoryBase pairs("pairs", {.words = 2048, .word_bits = 100, .columns = 2048});
  EXPECT_TRUE(pairs.follows_width());
  EXPECT_EQ(pairs.bits_at(1920), 192'000U);
  EXPECT_EQ(pairs.bits_at(1), 100U);
  // Rounds up to full words: with 3 words for 8 columns, 3 columns need 9 / 8.
  const MemoryBase three("three", {.words = 3, .word_bits = 10, .columns = 8});
  EXPECT_EQ(three.bits_at(3), 20U);
  EXPECT_EQ(three.bits_at(8), 30U);
  const MemoryBase fixed("fixed", {.words = 2048, .word_bits = 100});
  EXPECT_EQ(fixed.bits_at(640), 204'800U);
  EXPECT_FALSE(fixed.follows_width());
  EXPECT_TRUE(MemoryBase("column", {.words = 2, .word_bits = 1, .columns = 1}).follows_width());
}

TEST(MemoryCost, MemoryPortBuffersAllOutstandingResponses) {
  rtl::ClockDomain clock("clock", sc_core::sc_time(10, sc_core::SC_NS));
  const rtl::MemoryPort few("few", clock, {.outstanding = 16}),
      many("many", clock, {.outstanding = 64, .max_burst_lines = 2, .line_bytes = 32});
  EXPECT_EQ(few.response_buffer.logical_bits(), 16U * 514);
  EXPECT_EQ(few.response_buffer.memory_kind(), MemoryKind::kFlops);
  EXPECT_EQ(many.response_buffer.logical_bits(), 128U * 258);
  EXPECT_EQ(many.response_buffer.memory_kind(), MemoryKind::kSram);
  EXPECT_EQ(many.response_buffer.shape().latency, 1u);
  EXPECT_EQ(many.gather_buffer, nullptr);
  const rtl::MemoryPort bursts("bursts", clock, {.max_burst_lines = 8, .max_write_lines = 4});
  ASSERT_NE(bursts.gather_buffer, nullptr);
  EXPECT_EQ(bursts.gather_buffer->logical_bits(), 4U * 512);
  EXPECT_EQ(bursts.gather_buffer->memory_kind(), MemoryKind::kFlops);
  EXPECT_EQ(bursts.gather_buffer->shape().latency, 1u);
  EXPECT_THROW(rtl::MemoryPort("wrong", clock, {.max_burst_lines = 2, .max_write_lines = 4}),
               spec::CheckFailed);
}

// Flip-flops hold at most 16 384 bits.
TEST(MemoryCost, FlipFlopsHaveExactLimit) {
  const auto flops = [](std::uint64_t words, std::uint32_t bits) {
    const MemoryBase memory("memory",
                            {.words = words, .word_bits = bits, .kind = MemoryKind::kFlops});
    return memory.logical_bits();
  };
  EXPECT_EQ(flops(128, 128), 16'384U);
  EXPECT_THAT(text_of<spec::ConfigError>([&] { flops(113, 145); }),
              AllOf(HasSubstr("16385 bits as flops"), HasSubstr("at most 16384 bits")));
  EXPECT_EQ(MemoryBase::kind_for(16'384), MemoryKind::kFlops);
  EXPECT_EQ(MemoryBase::kind_for(16'385), MemoryKind::kSram);
}

TEST(MemoryCost, DeepFifoIsSram) {
  const rtl::Fifo<std::uint32_t> shallow("shallow", 32), deep("deep", 33);
  EXPECT_EQ(shallow.memory_kind(), MemoryKind::kFlops);
  EXPECT_EQ(shallow.logical_bits(), 1024U);
  EXPECT_EQ(shallow.register_bits(), 0U);
  EXPECT_EQ(deep.memory_kind(), MemoryKind::kSram);
  EXPECT_EQ(deep.built_as(), "1R1W");
  EXPECT_EQ(deep.physical_bits(), 33U * 32);
  EXPECT_EQ(deep.register_bits(), 2U * 32);  // its output registers
}

TEST(MemoryCost, WideFifoIsSram) {
  const rtl::Fifo<rtl::MemoryRequest> narrow("narrow", 24), wide("wide", 25);
  EXPECT_EQ(narrow.logical_bits(), 24U * 680);
  EXPECT_EQ(narrow.memory_kind(), MemoryKind::kFlops);
  EXPECT_EQ(wide.memory_kind(), MemoryKind::kSram);
  EXPECT_EQ(wide.register_bits(), 2U * 680);
}

// By hand: per write port a written word and its mask, per read one bit for a match, all of it for
// the latency of a read.
TEST(MemoryCost, NewWordOfSramCostsBypass) {
  const auto bits = [](MemoryShape shape, ReadDuringWrite rule) {
    shape.read_during_write = rule;
    return MemoryBase("memory", shape).register_bits();
  };
  const MemoryShape plain{.words = 64, .word_bits = 27, .read_ports = 2};
  EXPECT_EQ(bits(plain, ReadDuringWrite::kNewWord), 27U + 2);
  EXPECT_EQ(bits(plain, ReadDuringWrite::kOldWord), 0U);
  EXPECT_EQ(bits(plain, ReadDuringWrite::kForbidden), 0U);
  const MemoryShape masked{.words = 64, .word_bits = 24, .latency = 2, .mask_bits = 8};
  EXPECT_EQ(bits(masked, ReadDuringWrite::kNewWord), 2U * (24 + 3 + 1));
  const MemoryShape wide{.words = 64, .word_bits = 8, .banks = 4, .span = 3};
  EXPECT_EQ(bits(wide, ReadDuringWrite::kNewWord), 3U * (8 + 1));
  const MemoryShape either{
      .words = 64, .word_bits = 8, .read_ports = 0, .write_ports = 0, .shared_ports = 2};
  EXPECT_EQ(bits(either, ReadDuringWrite::kNewWord), 2U * (8 + 1));
  const MemoryShape flops{
      .words = 64, .word_bits = 8, .kind = MemoryKind::kFlops, .register_bits = 5};
  EXPECT_EQ(bits(flops, ReadDuringWrite::kNewWord), 5U) << "a choice before the register";
  MemoryShape fresh = flops;
  fresh.read_during_write = ReadDuringWrite::kNewWord;
  EXPECT_EQ(MemoryBase("memory", fresh).built_as(), "flip-flops, new word");
  fresh.read_during_write = ReadDuringWrite::kOldWord;
  EXPECT_EQ(MemoryBase("memory", fresh).built_as(), "flip-flops");
}

TEST(Memory, SramRejectsUndeclaredReadDuringWrite) {
  Memory<int> sram("sram", {.words = 8, .word_bits = 4});
  ReadPort<int> read(sram, "read");
  WritePort<int> write(sram, "write");
  write.write(0, 5, 1);
  read.read(0, 4);
  EXPECT_THAT(rejection([&] {
                write.write(1, 6, 1);
                read.read(1, 6);
              }),
              HasSubstr("forbidden"));
  EXPECT_THAT(rejection([&] {
                read.read(2, 6);
                write.write(2, 6, 1);
              }),
              HasSubstr("forbidden"));
  Memory<int> flops("flops", {.words = 8, .word_bits = 4, .kind = MemoryKind::kFlops});
  ReadPort<int> now(flops, "read");
  WritePort<int> later(flops, "write");
  later.write(0, 5, 7);
  now.read(0, 5);
  EXPECT_EQ(now.at(1, 5), 0) << "the old word by themselves";
}

}  // namespace
}  // namespace deburr::tb::memory_shape_test
