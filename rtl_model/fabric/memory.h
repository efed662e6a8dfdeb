// SPDX-License-Identifier: MIT
// Function  Memory model: words, ports, latency and cost of a technology that can be built.
// Position  A member of the unit that owns it; every unit that accesses it holds its own port.
// Latency   SRAM and ROM 1 or more, flip-flops 0 or 1. An access issued in cycle t puts its word on
//           the port's output register in t + latency; the word stays until the next access of that
//           port arrives.
// Interval  1: one access per cycle and port, pipelined.
// Stalls    None.
// Cost      physical_bits(). SRAM with 1RW, 1R1W or 2RW; ROM with 1R or 2R (a loadable ROM is SRAM
//           with the same number of RW ports); flip-flops up to kMostFlopBits with any ports. More
//           read ports are copies; `banks` divide the words. More than kFewBanks banks need at
//           least kLeastBankWords each: smaller ones would be registers. Other shapes are rejected,
//           unless the shape gives a reason in `not_implementable`.
//
// A read returns the words as they were before its cycle, or (`kNewWord`) including writes of that
// cycle; the order in which units are ticked does not matter. These errors stop the simulation,
// with memory, port, cycle and the expected access: a second access in a cycle, an invalid address,
// a word used before it arrives, or a forbidden collision.
//
//   Memory<Entry> table_{"table", {.words = 512, .word_bits = 37, .content = "edges of two rows"}};
//   ReadPort<Entry> lookup_{table_, "lookup"};
//   WritePort<Entry> update_{table_, "update"};
//
//   lookup_.read(cycle, column);                     // in cycle t
//   const Entry& entry = lookup_.at(cycle, column);  // in t + 1
//
// at(cycle, address) identifies a word by its address only: a word that is read again after a write
// and used a cycle early is mistaken for its old value. at(cycle, address, t) detects this as well.
//
// A copy of a port is another handle of the same port, for users that share it in time.
//
// Memory<void> is for content that the owner keeps in a faster form: kind, ports, latency and
// checks are the memory's. MemoryBase is for memories without checkable ports (a FIFO, whose link
// checks them).
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
// What a read returns when the word is written in the same cycle. SRAM returns an undefined word,
// so the simulation stops, unless the shape declares the result: the old word (a read-first macro)
// or the new one (a bypass). Flip-flops always return the old word by default.
enum class ReadDuringWrite : std::uint8_t { kForbidden, kOldWord, kNewWord };
// Mapping of words to banks: neighbours in different banks, or blocks of consecutive words (a row
// of pixels each).
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
  // Consecutive words that one access may take; they lie in different banks.
  std::uint32_t span = 1;
  // Bits per bit of the write mask; 0: only whole words are written.
  std::uint32_t mask_bits = 0;
  // The reads of a cycle lie in different banks, and so do its writes: a bank needs one port of
  // each kind, however many the memory has. Checked.
  bool separate_banks = false;
  std::string content = {};  // one line
  // Frame columns that the words hold, for bits_at(). 0: independent of the frame's width.
  std::uint64_t columns = 0;
  // SRAM only: written outside simulated time while no read is active, so writes use the read
  // ports, in every copy. Its words are valid from the beginning, like the initialised memories of
  // an FPGA; otherwise they are loaded before the first access.
  bool loaded = false;
  // Flip-flops besides the words: the output registers of a FIFO, the arrived bits of a fill store.
  std::uint64_t register_bits = 0;
  // Reason for a memory that cannot be built; ignored if it can.
  std::string not_implementable = {};
};

// The interface for reports. Find all memories with for_each<MemoryBase>.
class MemoryBase : public sc_core::sc_object {
 public:
  static constexpr std::uint64_t kMostFlopBits = 16'384;
  static constexpr std::uint32_t kMostLatency = 7;
  static constexpr std::uint32_t kFewBanks = 64, kLeastBankWords = 16;

  // Throws ConfigError with a remedy if the shape cannot be built.
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
  // Including copies and the words that fill up the last bank.
  std::uint64_t physical_bits() const;
  // Flip-flops besides the words: those of the shape, and the bypass of kNewWord SRAM.
  std::uint64_t register_bits() const { return shape_.register_bits + bypass_bits(); }
  // The written words with their masks, and for each read whether it hits them, delayed by the
  // latency of a read.
  std::uint64_t bypass_bits() const;
  std::uint32_t copies() const { return copies_; }
  std::uint32_t banks() const { return shape_.banks; }
  // "3 copies of 1R1W, 4 banks"
  std::string built_as() const;
  // Empty if the memory can be built; otherwise the reason for using it.
  const std::string& not_implementable() const { return not_implementable_; }
  bool follows_width() const { return shape_.columns != 0; }
  // Logical bits that frames of this width need; all bits if the words do not depend on the width.
  std::uint64_t bits_at(std::uint64_t width) const;

  // Resets only the bookkeeping of accesses. Contents stay, as in hardware.
  virtual void reset() {}
  // FIFOs only: most words in use in a cycle since reset, including one that leaves in it.
  virtual std::optional<std::uint64_t> high_water() const { return std::nullopt; }
  // Accesses since reset, of all ports. Of a FIFO, the beats popped and pushed.
  virtual std::uint64_t reads() const { return 0; }
  virtual std::uint64_t writes() const { return 0; }
  // Checks that every declared port is used, since an unused port would still be counted in the
  // cost. The domain calls it at the end of elaboration.
  virtual void check_ports() const {}
  // The modules that hold its ports: those under construction when a port was created.
  virtual std::vector<const sc_core::sc_object*> port_holders() const { return {}; }

  // The kind for a small memory: flip-flops if allowed, otherwise SRAM.
  static MemoryKind kind_for(std::uint64_t bits) {
    return bits <= kMostFlopBits ? MemoryKind::kFlops : MemoryKind::kSram;
  }

 protected:
  // A name for a part: "<own name>_<suffix>", since a memory is not a module and has no children.
  std::string inner_name(const char* suffix) const;

 private:
  // Finds copies_ and macro_. Returns an empty string, or the error and its remedy.
  std::string find_build();

  MemoryShape shape_;
  std::string ports_;
  std::uint32_t copies_ = 1;
  std::string not_implementable_;
  std::string macro_;  // macro of a bank's copy: "1R1W"
};

// A memory with checked ports. It keeps the pending accesses; a unit's port is only a handle.
class PortedMemory : public MemoryBase {
 public:
  PortedMemory(const char* name, MemoryShape shape);
  ~PortedMemory() override;
  void reset() override;
  void check_ports() const override;
  std::vector<const sc_core::sc_object*> port_holders() const override;
  std::uint64_t reads() const override;
  std::uint64_t writes() const override;

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
    Cycle due = kNever;  // its word is available from this cycle on
    std::uint64_t address = 0;
    std::uint64_t count = 0;
    std::size_t place = 0;  // index of its words in the captured words of the owner
    Read* next = nullptr;   // next read in the ring
  };
  // Members used by every access come first, including copies of the memory's members.
  struct Port {
    Read* newest = nullptr;  // of the last reads
    // Fast paths of the checks beyond issue(). At most one is the number of words, the others are
    // 0. `plain`: nothing to check. `guarded`: a read must not collide with a write. `one_bank`:
    // the same where forbidden, and a one-word read has its bank, the low bits of the address, for
    // itself. All three are 0 if more must be checked.
    std::uint64_t plain = 0, guarded = 0, one_bank = 0, bank_mask = 0;
    Cycle* banks = nullptr;  // cycle of the last read, by bank
    std::uint32_t latency = 0;
    Side side = Side::kRead;
    std::uint64_t reads = 0, writes = 0;  // since reset
    // The last write, for reads of the same cycle.
    Cycle written = kNever;
    std::uint64_t write_address = 0, write_count = 0;
    std::uint32_t writer = 0;  // index among the writing ports
    std::array<Read, kMostLatency + 1> read;
    std::string user;                            // of the first handle; empty: unused
    const sc_core::sc_object* holder = nullptr;  // the module that created it
  };

  // Check initial content: the number of words, and that a word fits.
  void check_content(std::size_t words) const;
  void check_content(std::size_t address, std::uint64_t word, bool negative) const;
  // Returns the next unused port of that kind.
  Port& claim(Side side, const std::string& user);

  // Checks that do not depend on the content: one access per cycle and port, valid addresses, and
  // at most `span` words.
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
      fail(port, cycle, "partial write of a word, but the shape has no mask_bits");
  }
  // The read whose word is on the output register in `cycle`.
  const Read& arrived(const Port& port, Cycle cycle) const {
    const Read& newest = *port.newest;
    if (newest.due <= cycle) [[likely]]
      return newest;
    return arrived_before(port, cycle);
  }
  // The same; fails unless it includes the word at this address.
  const Read& arrived(const Port& port, Cycle cycle, std::uint64_t address) const {
    const Read& read = arrived(port, cycle);
    if (address - read.address >= read.count) [[unlikely]]
      fail_stale(port, cycle, address, read);
    return read;
  }
  // The same; fails unless the access was issued in cycle `issued`.
  const Read& arrived(const Port& port, Cycle cycle, std::uint64_t address, Cycle issued) const {
    const Read& read = arrived(port, cycle, address);
    if (read.due != issued + port.latency) [[unlikely]]
      fail_again(port, cycle, issued, read);
    return read;
  }
  // Number of words that the owner captures for all remembered reads of all ports.
  std::size_t captured_words() const { return readers_.size() * (latency_ + 1) * span_; }

  const std::uint64_t words_;
  const std::uint32_t span_, latency_;
  const bool guarded_;      // a read must not collide with a write of its cycle
  Cycle written_ = kNever;  // the last write through any port
  Cycle read_ = kNever;     // the last read of a port that is not `plain`
  std::vector<Port> ports_;
  std::vector<Port*> readers_, writers_;  // shared ports are in both

 private:
  const Read& arrived_before(const Port& port, Cycle cycle) const;
  void check_read(const Port& port, Cycle cycle, std::uint64_t address, std::uint64_t count);
  void check_write(const Port& port, Cycle cycle, std::uint64_t address, std::uint64_t count);
  void use_banks(std::vector<Cycle>& used, const Port& port, Cycle cycle, std::uint64_t address,
                 std::uint64_t count) const;
  // Out of line: a check costs its caller one comparison.
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

  // Cycle of the last use, by bank. Shared ports use one list for reads and writes.
  std::vector<Cycle> read_banks_used_, write_banks_used_;
  std::vector<Cycle>&read_banks_, &write_banks_;
};

template <class Word>
class Memory final : public PortedMemory {
 public:
  Memory(const char* name, MemoryShape shape) : Memory(name, std::move(shape), Words{}) {}
  // With initial content: all words of a ROM or `loaded` memory, or the power-up values of
  // flip-flops.
  Memory(const char* name, MemoryShape shape, std::span<const Word> content)
      : Memory(name, std::move(shape), Words{content}) {}

  // Access without a port and without simulated time: only for tests, preloads, dumps and `loaded`
  // content.
  Word& backdoor(std::uint64_t address) { return kept_.at(address); }
  const Word& backdoor(std::uint64_t address) const { return kept_.at(address); }
  // Sets every word at once, like the reset of flip-flops.
  void clear(const Word& value = {}) {
    DEBURR_CHECK(memory_kind() == MemoryKind::kFlops,
                 std::string(name()) + ": only flip-flops can be cleared at once");
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
  // Restores the old value of words that were already written in this cycle.
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
  // Updates reads that were already issued in this cycle.
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
  std::vector<Word> before_;    // by port and index in the span: words before their last write
  std::vector<Word> captured_;  // by port, read and index in the span
};

// The owner keeps the content: it must return the words as they were before the cycle of a read.
template <>
class Memory<void> final : public PortedMemory {
 public:
  using PortedMemory::PortedMemory;
};

// Interface of reading ports, and of writing ports. Not used by themselves.
template <class Word>
class ReadAccess {
 public:
  // Issues this cycle's access to `count` words from `address` on.
  void read(Cycle cycle, std::uint64_t address, std::uint64_t count = 1) {
    memory_->read(*port_, cycle, address, count);
  }
  // True if the word of an access arrives in this cycle.
  bool arrives(Cycle cycle) const { return PortedMemory::arrives(*port_, cycle); }
  // The (first) word on the output register.
  const Word& word(Cycle cycle) const {
    const PortedMemory::Read& read = memory_->arrived(*port_, cycle);
    return memory_->word(read, read.address);
  }
  // The same; fails unless it is the word of this address. Detects a word used a cycle early (an
  // older one is still there) or too late (a newer one is).
  const Word& at(Cycle cycle, std::uint64_t address) const {
    return memory_->word(memory_->arrived(*port_, cycle, address), address);
  }
  // The same; fails unless the access was issued in cycle `issued`. Also detects an older value of
  // an address that is read again.
  const Word& at(Cycle cycle, std::uint64_t address, Cycle issued) const {
    return memory_->word(memory_->arrived(*port_, cycle, address, issued), address);
  }
  // Reads in the same cycle: for flip-flops without an output register.
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
  // Writes at most `span` consecutive words.
  void write(Cycle cycle, std::uint64_t address, std::span<const Word> words) {
    memory_->write(*port_, cycle, address, words.size(),
                   [&](std::uint64_t i, Word& kept) { kept = words[i]; });
  }
  // Writes through the mask: `change(word)` changes some bits, the others stay.
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

// For a memory whose owner keeps the content: checks only.
template <>
class ReadAccess<void> {
 public:
  void read(Cycle cycle, std::uint64_t address, std::uint64_t count = 1) {
    memory_->issue_read(*port_, cycle, address, count);
  }
  bool arrives(Cycle cycle) const { return PortedMemory::arrives(*port_, cycle); }
  // CheckFailed unless a word, or the word of this address, or the word of this address and access,
  // is on the output register.
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

// The port that a unit holds; `user` names it in error messages.
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

// Reads or writes, one access per cycle.
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
