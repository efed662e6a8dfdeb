// SPDX-License-Identifier: MIT
// The one memory of the house: words, ports and latency as a technology offers them, and what it
// costs to build.
//
// Where: a member of the unit that owns it; every unit that accesses it holds a port of its own.
// Timing: an access is issued in clock t, its word is on the port's output register in t + latency
// and stays there until the word of that port's next access comes. One access a clock and port,
// pipelined; never stalls. SRAM and ROM have a latency of at least 1, flip-flops of 0 or 1. A read
// sees the words as they were before its clock, or (`kNewWord`) with what is written in it;
// whether the reading or the writing unit is ticked first does not matter. One access too many, an
// address that is not there, a word that has not come, or a collision that the memory forbids stops
// the simulation with the name of memory and port, the clock and what was expected.
// Cost: physical_bits(), from what can be bought: SRAM with 1RW, 1R1W or 2RW, ROM with 1R or 2R (a
// ROM that can be loaded is SRAM with as many RW), flip-flops up to kMostFlopBits with any ports.
// More read ports are copies, `banks` divide the words, and more than kFewBanks of them have
// kLeastBankWords at least: smaller ones are registers under another name. What cannot be had so is
// rejected, unless the shape says that it is idealised and why.
//
//   Memory<Entry> table_{"table", {.words = 512, .word_bits = 37, .content = "edges of two rows"}};
//   ReadPort<Entry> lookup_{table_, "lookup"};
//   WritePort<Entry> update_{table_, "update"};
//
//   lookup_.read(cycle, column);                     // in clock t
//   const Entry& entry = lookup_.at(cycle, column);  // in t + 1
//
// at(cycle, address) tells words apart by their address, so a word that is read again after a write
// passes for its older self, if it is used a clock early; at(cycle, address, t) tells these apart
// too.
//
// A copy of a port is one more handle of the same port: users that share it in time.
//
// Words that the model keeps in a faster form: Memory<void>. Kind, ports, latency and checks stay
// the memory's, the owner keeps the content. Without ports that can be checked (a FIFO, whose link
// does that): MemoryBase.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <systemc>
#include <type_traits>
#include <utility>
#include <vector>

#include "rtl_model/fabric/clocked.h"
#include "spec/error.h"

namespace deburr::rtl {

enum class MemoryKind : std::uint8_t { kFlops, kSram, kRom };
// What a read gives of a word that is written in the same clock. SRAM gives anything, so that such
// a read stops the run, unless the shape says which word it is: the old one (a macro that reads
// first) or the new one (a bypass). Flip-flops give the old one by themselves.
enum class ReadDuringWrite : std::uint8_t { kForbidden, kOldWord, kNewWord };
// Which bank holds a word: neighbours in different banks, or blocks of words (a row of pixels
// each).
enum class BankOrder : std::uint8_t { kInterleaved, kBlocks };

const char* name_of(MemoryKind kind);  // "flops", "sram", "rom"

struct MemoryShape {
  std::uint64_t words = 0;
  std::uint32_t word_bits = 0;
  MemoryKind kind = MemoryKind::kSram;
  std::uint32_t read_ports = 1, write_ports = 1, shared_ports = 0;  // shared: reads or writes
  std::uint32_t latency = 1;                                        // cycles, 0..kMostLatency
  ReadDuringWrite read_during_write = ReadDuringWrite::kForbidden;
  std::uint32_t banks = 1;
  BankOrder order = BankOrder::kInterleaved;
  // Words from the address on that one access may take: they lie in as many banks.
  std::uint32_t span = 1;
  // Bits that a bit of the write mask stands for; 0: words are written whole.
  std::uint32_t mask_bits = 0;
  // The accesses of a clock lie in different banks, reads among themselves and writes among
  // themselves: a bank needs one port of each kind, however many the memory has. Checked.
  bool separate_banks = false;
  std::string content = {};  // one line
  // Columns of a frame that the words are for: bits_at(). 0: they do not go with the frame's width.
  std::uint64_t columns = 0;
  // Of sram: written from outside of time only, while nobody reads, so that its writes go through
  // the ports that read, in every copy. Its words are there from the beginning, as the memories of
  // an FPGA have theirs; elsewhere they are loaded before the first access.
  bool loaded = false;
  // Flip-flops beside the words: of a FIFO its output registers, of a fill store its arrived bits.
  std::uint64_t register_bits = 0;
  // Why the memory may be one that nobody sells; of no account if it can be built.
  std::string not_implementable = {};
};

// What reports see. Find them all with for_each<MemoryBase>.
class MemoryBase : public sc_core::sc_object {
 public:
  static constexpr std::uint64_t kMostFlopBits = 16'384;
  static constexpr std::uint32_t kMostLatency = 7;
  static constexpr std::uint32_t kFewBanks = 64, kLeastBankWords = 16;

  // ConfigError if the shape cannot be built: with what to do about it.
  MemoryBase(const char* name, MemoryShape shape);
  ~MemoryBase() override;
  const char* kind() const override { return "deburr_memory"; }

  const MemoryShape& shape() const { return shape_; }
  std::uint64_t words() const { return shape_.words; }
  std::uint32_t word_bits() const { return shape_.word_bits; }
  const std::string& ports() const { return ports_; }  // "1R1W", "4R1W of 16 words"
  MemoryKind memory_kind() const { return shape_.kind; }
  const std::string& content() const { return shape_.content; }
  std::uint64_t logical_bits() const { return words() * word_bits(); }
  // With copies, and with the words that fill up the last bank.
  std::uint64_t physical_bits() const;
  // Flip-flops beside the words: those of the shape, and the bypass of SRAM that gives new words.
  std::uint64_t register_bits() const { return shape_.register_bits + bypass_bits(); }
  // The words that are written, with their masks, and for each read whether it meets them; all of
  // it as long as a read takes.
  std::uint64_t bypass_bits() const;
  std::uint32_t copies() const { return copies_; }
  std::uint32_t banks() const { return shape_.banks; }
  // "3 copies of 1R1W, 4 banks"
  std::string built_as() const;
  // Empty if it can be built; if not, why it stands here all the same.
  const std::string& not_implementable() const { return not_implementable_; }
  bool follows_width() const { return shape_.columns != 0; }
  // Logical bits that frames of this width need; all, if the words do not go with the width.
  std::uint64_t bits_at(std::uint64_t width) const;

  // Bookkeeping of the clock only. Contents stay, as in hardware.
  virtual void reset() {}
  // Most words in use in a clock since reset, with what leaves in it; of a FIFO alone.
  virtual std::optional<std::uint64_t> high_water() const { return std::nullopt; }
  // Every port that the shape declares is used by somebody; the domain asks at the end of
  // elaboration, since a port that nobody uses is a cost that nobody pays.
  virtual void check_ports() const {}
  // The modules that hold its ports: those that were being constructed when a port was made.
  virtual std::vector<const sc_core::sc_object*> port_holders() const { return {}; }

  // The kind for a small memory that may be either: flip-flops as long as they are allowed.
  static MemoryKind kind_for(std::uint64_t bits) {
    return bits <= kMostFlopBits ? MemoryKind::kFlops : MemoryKind::kSram;
  }

 protected:
  // A name for a part: "<own name>_<suffix>", since a memory is no module and has no children.
  std::string inner_name(const char* suffix) const;

 private:
  // Finds copies_ and macro_. Empty, or what is wrong and what to do.
  std::string find_build();

  MemoryShape shape_;
  std::string ports_;
  std::uint32_t copies_ = 1;
  std::string not_implementable_;
  std::string macro_;  // what a copy of a bank is: "1R1W"
};

// A memory whose ports are checked. What is under way in a port is kept here: a unit's port is only
// a handle.
class PortedMemory : public MemoryBase {
 public:
  PortedMemory(const char* name, MemoryShape shape);
  ~PortedMemory() override;
  void reset() override;
  void check_ports() const override;
  std::vector<const sc_core::sc_object*> port_holders() const override;
  // Accesses since reset, of all ports.
  std::uint64_t reads() const;
  std::uint64_t writes() const;

 protected:
  template <class>
  friend class ReadAccess;
  template <class>
  friend class WriteAccess;
  template <class>
  friend class ReadPort;
  template <class>
  friend class WritePort;
  template <class>
  friend class SharedPort;

  enum class Side : std::uint8_t { kRead, kWrite, kShared };

  struct Read {
    Cycle due = kNever;  // its word is there from this clock on
    std::uint64_t address = 0;
    std::uint64_t count = 0;
    std::size_t place = 0;  // of its words, in what the owner captures
    Read* next = nullptr;   // the one after it, in a ring
  };
  // What an access looks at comes first, copies of the memory's among it.
  struct Port {
    Read* newest = nullptr;  // of the last reads
    // What is to be checked beyond issue(). One of these is the number of words, the others are 0:
    // `plain`, nothing; `guarded`, that no read meets a write; `one_bank`, the same where it is
    // forbidden, and that a read of a word has its bank alone, which the low bits of the address
    // say. Where there is more to it all three are 0.
    std::uint64_t plain = 0, guarded = 0, one_bank = 0, bank_mask = 0;
    Cycle* banks = nullptr;  // by bank, when it was last read
    std::uint32_t latency = 0;
    Side side = Side::kRead;
    std::uint64_t reads = 0, writes = 0;  // since reset
    // The last write, for reads of the same clock.
    Cycle written = kNever;
    std::uint64_t write_address = 0, write_count = 0;
    std::uint32_t writer = 0;  // its number among those that write
    std::array<Read, kMostLatency + 1> read;
    std::string user;                            // of the first handle; empty: nobody yet
    const sc_core::sc_object* holder = nullptr;  // the module that made it
  };

  // Can it hold so many words from the beginning, and does this one of them fit?
  void check_content(std::size_t words) const;
  void check_content(std::size_t address, std::uint64_t word, bool negative) const;
  // The next port of that kind that nobody uses yet.
  Port& claim(Side side, const std::string& user);

  // Everything about an access that does not depend on the words: one access a clock, of words that
  // are there, in banks that nobody else uses.
  void issue(const Port& port, Cycle cycle, std::uint64_t address, std::uint64_t count,
             bool again) const {
    if (again) [[unlikely]]
      fail_twice(port, cycle, address);
    if (count != 1 && (count - 1 >= span_ || address + count > words_)) [[unlikely]]
      fail_address(port, cycle, address, count);
  }
  void issue_read(Port& port, Cycle cycle, std::uint64_t address, std::uint64_t count) {
    const Cycle due = cycle + port.latency;
    issue(port, cycle, address, count, port.newest->due == due);
    Read& read = *port.newest->next;
    port.newest = &read;
    read.due = due;
    read.address = address;
    read.count = count;
    ++port.reads;
    if (address < port.plain) [[likely]]
      return;
    read_ = cycle;
    if (written_ != cycle || !guarded_) [[likely]] {
      if (address < port.guarded) [[likely]]
        return;
      if (address < port.one_bank && count == 1) [[likely]] {
        Cycle& used = port.banks[address & port.bank_mask];
        if (used != cycle) [[likely]] {
          used = cycle;
          return;
        }
      }
    }
    if (address >= words_) [[unlikely]]
      fail_address(port, cycle, address, count);
    check_read(port, cycle, address, count);
  }
  void issue_write(Port& port, Cycle cycle, std::uint64_t address, std::uint64_t count) {
    issue(port, cycle, address, count, port.written == cycle);
    const bool meets = written_ == cycle;
    port.written = written_ = cycle;
    port.write_address = address;
    port.write_count = count;
    ++port.writes;
    if (!meets) [[likely]] {
      if (address < port.plain) [[likely]]
        return;
      if (address < port.guarded && read_ != cycle) [[likely]]
        return;
    }
    if (address >= words_) [[unlikely]]
      fail_address(port, cycle, address, count);
    check_write(port, cycle, address, count);
  }
  static bool arrives(const Port& port, Cycle cycle) {
    return std::any_of(port.read.begin(), port.read.end(),
                       [cycle](const Read& read) { return read.due == cycle; });
  }
  void check_mask(const Port& port, Cycle cycle) const {
    if (shape().mask_bits == 0) [[unlikely]]
      fail(port, cycle, "a part of a word is written, but the shape has no mask_bits");
  }
  // The read whose word is on the output register in `cycle`.
  const Read& arrived(const Port& port, Cycle cycle) const {
    const Read& newest = *port.newest;
    if (newest.due <= cycle) [[likely]]
      return newest;
    return arrived_before(port, cycle);
  }
  // The same, which must have given the word at this address.
  const Read& arrived(const Port& port, Cycle cycle, std::uint64_t address) const {
    const Read& read = arrived(port, cycle);
    if (address - read.address >= read.count) [[unlikely]]
      fail_stale(port, cycle, address, read);
    return read;
  }
  // The same, of the access in clock `issued`.
  const Read& arrived(const Port& port, Cycle cycle, std::uint64_t address, Cycle issued) const {
    const Read& read = arrived(port, cycle, address);
    if (read.due != issued + port.latency) [[unlikely]]
      fail_again(port, cycle, issued, read);
    return read;
  }
  // Words that the owner captures: of every read that a port remembers.
  std::size_t captured_words() const { return readers_.size() * (latency_ + 1) * span_; }

  const std::uint64_t words_;
  const std::uint32_t span_, latency_;
  const bool guarded_;      // no read may meet a write of its clock
  Cycle written_ = kNever;  // the last write through any port
  Cycle read_ = kNever;     // the last read, of a port that is not `plain`
  std::vector<Port> ports_;
  std::vector<Port*> readers_, writers_;  // shared ports are among both

 private:
  const Read& arrived_before(const Port& port, Cycle cycle) const;
  void check_read(const Port& port, Cycle cycle, std::uint64_t address, std::uint64_t count);
  void check_write(const Port& port, Cycle cycle, std::uint64_t address, std::uint64_t count);
  void use_banks(std::vector<Cycle>& used, const Port& port, Cycle cycle, std::uint64_t address,
                 std::uint64_t count) const;
  // Out of line: a check costs its caller a comparison.
  [[noreturn, gnu::cold, gnu::noinline]] void fail_twice(const Port& port, Cycle cycle,
                                                         std::uint64_t address) const;
  [[noreturn, gnu::cold, gnu::noinline]] void fail_address(const Port& port, Cycle cycle,
                                                           std::uint64_t address,
                                                           std::uint64_t count) const;
  [[noreturn, gnu::cold, gnu::noinline]] void fail_early(const Port& port, Cycle cycle) const;
  [[noreturn, gnu::cold, gnu::noinline]] void fail_stale(const Port& port, Cycle cycle,
                                                         std::uint64_t wanted,
                                                         const Read& there) const;
  [[noreturn, gnu::cold, gnu::noinline]] void fail_again(const Port& port, Cycle cycle,
                                                         Cycle issued, const Read& there) const;
  [[noreturn, gnu::cold, gnu::noinline]] void fail(const Port& port, Cycle cycle,
                                                   const std::string& what) const;

  // By bank, when it was last used. Shared ports use one list for both.
  std::vector<Cycle> read_banks_used_, write_banks_used_;
  std::vector<Cycle>&read_banks_, &write_banks_;
};

template <class Word>
class Memory final : public PortedMemory {
 public:
  Memory(const char* name, MemoryShape shape) : Memory(name, std::move(shape), Words{}) {}
  // With content: a ROM or what is `loaded`, all of it, or what flip-flops hold when they are
  // switched on.
  Memory(const char* name, MemoryShape shape, std::span<const Word> content)
      : Memory(name, std::move(shape), Words{content}) {}

  // Without a port and without time: for tests, preloads, dumps and what is `loaded` only.
  Word& backdoor(std::uint64_t address) { return kept_.at(address); }
  const Word& backdoor(std::uint64_t address) const { return kept_.at(address); }
  // Every word at once, as the reset line of flip-flops does.
  void clear(const Word& value = {}) {
    DEBURR_CHECK(memory_kind() == MemoryKind::kFlops,
                 std::string(name()) + ": only flip-flops are cleared at once");
    std::fill(kept_.begin(), kept_.end(), value);
  }

 private:
  template <class>
  friend class ReadAccess;
  template <class>
  friend class WriteAccess;

  struct Words {
    std::span<const Word> content = {};
  };
  Memory(const char* name, MemoryShape shape, Words words)
      : PortedMemory(name, std::move(shape)),
        kept_(words_),
        before_(writers_.size() * span_),
        captured_(captured_words()) {
    check_content(words.content.size());
    if constexpr (std::is_integral_v<Word>)
      for (std::size_t i = 0; i < words.content.size(); ++i)
        check_content(i, static_cast<std::uint64_t>(words.content[i]),
                      std::cmp_less(words.content[i], 0));
    std::copy(words.content.begin(), words.content.end(), kept_.begin());
  }

  const Word& word(const Read& read, std::uint64_t address) const {
    return captured_[read.place + (address - read.address)];
  }
  void read(Port& port, Cycle cycle, std::uint64_t address, std::uint64_t count) {
    issue_read(port, cycle, address, count);
    Word* const to = &captured_[port.newest->place];
    to[0] = kept_[address];
    for (std::uint64_t i = 1; i < count; ++i) to[i] = kept_[address + i];
    if (written_ == cycle && !new_word_) give_old_words(to, cycle, address, count);
  }
  // What has been written in this clock already, as it was before.
  [[gnu::noinline]] void give_old_words(Word* to, Cycle cycle, std::uint64_t address,
                                        std::uint64_t count) {
    for (const Port* writer : writers_) {
      if (writer->written != cycle) continue;
      for (std::uint64_t i = 0; i < writer->write_count; ++i)
        if (writer->write_address + i - address < count)
          to[writer->write_address + i - address] = before_[writer->writer * span_ + i];
    }
  }
  // `put(i, word)` changes word i of the access.
  template <class Put>
  void write(Port& port, Cycle cycle, std::uint64_t address, std::uint64_t count, Put&& put) {
    issue_write(port, cycle, address, count);
    for (std::uint64_t i = 0; i < count; ++i) {
      before_[port.writer * span_ + i] = kept_[address + i];
      put(i, kept_[address + i]);
    }
    if (new_word_) give_new_words(cycle, address, count);
  }
  // To reads that were issued in this clock already.
  [[gnu::noinline]] void give_new_words(Cycle cycle, std::uint64_t address, std::uint64_t count) {
    for (const Port* reader : readers_) {
      const Read& read = *reader->newest;
      if (read.due != cycle + latency_) continue;
      for (std::uint64_t i = 0; i < read.count; ++i)
        if (read.address + i - address < count) captured_[read.place + i] = kept_[read.address + i];
    }
  }

  const bool new_word_ = shape().read_during_write == ReadDuringWrite::kNewWord;
  std::vector<Word> kept_;
  std::vector<Word> before_;    // by port and place in the span: words before their last write
  std::vector<Word> captured_;  // by port, read and place in the span
};

// The owner keeps the content: in a read it gives the words as they were before the clock.
template <>
class Memory<void> final : public PortedMemory {
 public:
  using PortedMemory::PortedMemory;
};

// What ports that read offer to their unit, and ports that write. Not used by themselves.
template <class Word>
class ReadAccess {
 public:
  // Issues the access of this clock, of `count` words from `address` on.
  void read(Cycle cycle, std::uint64_t address, std::uint64_t count = 1) {
    memory_->read(*port_, cycle, address, count);
  }
  // Does the word of an access come in this clock?
  bool arrives(Cycle cycle) const { return PortedMemory::arrives(*port_, cycle); }
  // The (first) word on the output register.
  const Word& word(Cycle cycle) const {
    const PortedMemory::Read& read = memory_->arrived(*port_, cycle);
    return memory_->word(read, read.address);
  }
  // The same, if it is the word of this address: a word that is used a clock early, when an older
  // one is still there, or too late, when a newer one is, is caught.
  const Word& at(Cycle cycle, std::uint64_t address) const {
    return memory_->word(memory_->arrived(*port_, cycle, address), address);
  }
  // The same, if it is the word as the access of clock `issued` read it: of an address that may be
  // read again, an older word is caught too.
  const Word& at(Cycle cycle, std::uint64_t address, Cycle issued) const {
    return memory_->word(memory_->arrived(*port_, cycle, address, issued), address);
  }
  // Both in one clock: of flip-flops without an output register.
  const Word& now(Cycle cycle, std::uint64_t address) {
    read(cycle, address);
    return at(cycle, address);
  }

 protected:
  ReadAccess(Memory<Word>& memory, PortedMemory::Port& port) : memory_(&memory), port_(&port) {}

 private:
  Memory<Word>* memory_;
  PortedMemory::Port* port_;
};

template <class Word>
class WriteAccess {
 public:
  void write(Cycle cycle, std::uint64_t address, const Word& word) {
    memory_->write(*port_, cycle, address, 1, [&](std::uint64_t, Word& kept) { kept = word; });
  }
  // Neighbouring words, at most `span`.
  void write(Cycle cycle, std::uint64_t address, std::span<const Word> words) {
    memory_->write(*port_, cycle, address, words.size(),
                   [&](std::uint64_t i, Word& kept) { kept = words[i]; });
  }
  // Through the write mask: `change(word)` changes some bits, the others stay.
  template <class Change>
  void change(Cycle cycle, std::uint64_t address, Change&& change) {
    memory_->check_mask(*port_, cycle);
    memory_->write(*port_, cycle, address, 1, [&](std::uint64_t, Word& kept) { change(kept); });
  }

 protected:
  WriteAccess(Memory<Word>& memory, PortedMemory::Port& port) : memory_(&memory), port_(&port) {}

 private:
  Memory<Word>* memory_;
  PortedMemory::Port* port_;
};

// Of a memory whose owner keeps the content: the checks are left.
template <>
class ReadAccess<void> {
 public:
  void read(Cycle cycle, std::uint64_t address, std::uint64_t count = 1) {
    memory_->issue_read(*port_, cycle, address, count);
  }
  bool arrives(Cycle cycle) const { return PortedMemory::arrives(*port_, cycle); }
  // CheckFailed unless a word, or the word of this address, or that of this address and access, is
  // on the output register.
  void check(Cycle cycle) const { memory_->arrived(*port_, cycle); }
  void check(Cycle cycle, std::uint64_t address) const { memory_->arrived(*port_, cycle, address); }
  void check(Cycle cycle, std::uint64_t address, Cycle issued) const {
    memory_->arrived(*port_, cycle, address, issued);
  }

 protected:
  ReadAccess(Memory<void>& memory, PortedMemory::Port& port) : memory_(&memory), port_(&port) {}

 private:
  Memory<void>* memory_;
  PortedMemory::Port* port_;
};

template <>
class WriteAccess<void> {
 public:
  void write(Cycle cycle, std::uint64_t address, std::uint64_t count = 1) {
    memory_->issue_write(*port_, cycle, address, count);
  }

 protected:
  WriteAccess(Memory<void>& memory, PortedMemory::Port& port) : memory_(&memory), port_(&port) {}

 private:
  Memory<void>* memory_;
  PortedMemory::Port* port_;
};

// What a unit holds; `user` is the name of the port in error texts.
template <class Word>
class ReadPort : public ReadAccess<Word> {
 public:
  ReadPort(Memory<Word>& memory, const std::string& user)
      : ReadAccess<Word>(memory, memory.claim(PortedMemory::Side::kRead, user)) {}
};

template <class Word>
class WritePort : public WriteAccess<Word> {
 public:
  WritePort(Memory<Word>& memory, const std::string& user)
      : WriteAccess<Word>(memory, memory.claim(PortedMemory::Side::kWrite, user)) {}
};

// Reads or writes, one access a clock.
template <class Word>
class SharedPort : public ReadAccess<Word>, public WriteAccess<Word> {
 public:
  SharedPort(Memory<Word>& memory, const std::string& user)
      : SharedPort(memory, memory.claim(PortedMemory::Side::kShared, user)) {}

 private:
  SharedPort(Memory<Word>& memory, PortedMemory::Port& port)
      : ReadAccess<Word>(memory, port), WriteAccess<Word>(memory, port) {}
};

}  // namespace deburr::rtl
