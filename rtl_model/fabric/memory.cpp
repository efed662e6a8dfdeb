// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/memory.h"

#include <fmt/format.h>

#include <bit>
#include <numeric>

namespace deburr::rtl {
namespace {

std::string port_text(const MemoryShape& shape) {
  std::string text;
  if (shape.read_ports) text += fmt::format("{}R", shape.read_ports);
  if (shape.write_ports) text += fmt::format("{}W", shape.write_ports);
  if (shape.shared_ports) text += fmt::format("{}RW", shape.shared_ports);
  if (shape.span > 1) text += fmt::format(" of {} words", shape.span);
  return text;
}

bool forbids(const MemoryShape& shape) {
  return shape.kind == MemoryKind::kSram && shape.read_during_write == ReadDuringWrite::kForbidden;
}

bool overlap(std::uint64_t a, std::uint64_t a_count, std::uint64_t b, std::uint64_t b_count) {
  return b < a + a_count && a < b + b_count;
}

}  // namespace

const char* name_of(MemoryKind kind) {
  switch (kind) {
    case MemoryKind::kFlops:
      return "flops";
    case MemoryKind::kSram:
      return "sram";
    case MemoryKind::kRom:
      return "rom";
  }
  return "?";
}

MemoryBase::MemoryBase(const char* name, MemoryShape shape)
    : sc_object(name), shape_(std::move(shape)), ports_(port_text(shape_)) {
  const MemoryShape& s = shape_;
  DEBURR_CHECK(s.word_bits > 0 && s.banks >= 1 && s.banks <= s.words && s.span >= 1 &&
                   s.latency <= kMostLatency && s.content.find('\n') == std::string::npos,
               fmt::format("{}: {} words in {} banks, span {}, latency {}, content '{}'",
                           this->name(), s.words, s.banks, s.span, s.latency, s.content));
  DEBURR_CHECK(s.latency > 0 || s.read_during_write != ReadDuringWrite::kNewWord,
               fmt::format("{}: new words (kNewWord) need a latency of at least 1", this->name()));
  DEBURR_CHECK(s.mask_bits == 0 || s.word_bits % s.mask_bits == 0,
               fmt::format("{}: a write mask of {} bits does not divide words of {}", this->name(),
                           s.mask_bits, s.word_bits));
  const std::string wrong = find_build();
  if (wrong.empty()) return;
  if (s.not_implementable.empty())
    throw spec::ConfigError(fmt::format("{}: {} bits as {} {}: {}", this->name(), logical_bits(),
                                        name_of(s.kind), ports(), wrong));
  not_implementable_ = s.not_implementable;
  macro_ = "not implementable " + ports();
  copies_ = 1;
}

std::string MemoryBase::find_build() {
  const MemoryShape& s = shape_;
  const auto of_bank = [&](std::uint32_t ports) {
    return s.separate_banks ? std::min(ports, 1U) : ports;
  };
  const std::uint32_t reads = of_bank(s.read_ports), writes = of_bank(s.write_ports),
                      shared = of_bank(s.shared_ports);
  if (reads + shared == 0) return "it has no read port: add one";
  const std::uint32_t most = std::max({s.read_ports, s.write_ports, s.shared_ports});
  if (s.separate_banks && s.banks < most)
    return fmt::format(
        "{} accesses of a kind per cycle cannot lie in {} separate banks: use {} banks, or fewer "
        "ports",
        most, s.banks, most);
  if (s.loaded && s.kind != MemoryKind::kSram) return "only sram can be loaded";
  if (s.kind == MemoryKind::kFlops) {
    if (logical_bits() > kMostFlopBits)
      return fmt::format(
          "flip-flops hold at most {} bits: use sram, whose words arrive a cycle later, or make it "
          "smaller",
          kMostFlopBits);
    if (s.latency > 1) return "flip-flops have a latency of 0 or 1 (one output register)";
    macro_ = "flip-flops";
    return {};
  }
  if (s.banks > kFewBanks && s.words < std::uint64_t{kLeastBankWords} * s.banks)
    return fmt::format(
        "{} banks of fewer than {} words are too small (allowed for up to {} banks): use flops",
        s.banks, kLeastBankWords, kFewBanks);
  if (s.latency == 0) return "sram and rom need a latency of at least 1";
  if (s.span > 1 && (s.order != BankOrder::kInterleaved || s.span > s.banks))
    return fmt::format("one access gives {} neighbours only if they lie in {} interleaved banks",
                       s.span, s.span);
  if (s.kind == MemoryKind::kRom) {
    if (writes + shared != 0) return "a rom cannot have write ports: use sram or flops";
    copies_ = (reads + 1) / 2;
    macro_ = reads == 1 ? "1R" : "2R";
    return {};
  }
  if (s.loaded) {
    if (writes + shared != 0) return "loaded sram cannot have write ports";
    copies_ = (reads + 1) / 2;
    macro_ = reads == 1 ? "1RW" : "2RW";
    return {};
  }
  if (writes + shared == 0) return "it has no write port: use rom";
  if (writes + shared > 2 || writes > 1 || (shared == 2 && reads > 0))
    return fmt::format(
        "sram has 1RW, 1R1W or 2RW, and copies add read ports but no write ports: "
        "share the writes in time, or put simultaneous writes into separate banks");
  if (shared == 0) {
    copies_ = reads;
    macro_ = "1R1W";
  } else if (shared == 2) {
    macro_ = "2RW";
  } else if (writes == 1) {  // one port writes, one reads or writes
    if (reads > 0)
      return "one write port and one shared port use both ports of a 2RW: no read port is left";
    macro_ = "2RW";
  } else if (reads == 0) {
    macro_ = "1RW";
  } else {  // one port reads or writes; its writes go to every copy
    copies_ = reads;
    macro_ = "2RW";
  }
  return {};
}

std::string MemoryBase::inner_name(const char* suffix) const {
  return fmt::format("{}_{}", basename(), suffix);
}

std::uint64_t MemoryBase::physical_bits() const {
  if (shape_.kind == MemoryKind::kFlops) return logical_bits();
  const std::uint64_t bank_words = (words() + shape_.banks - 1) / shape_.banks;
  return bank_words * shape_.banks * copies_ * word_bits();
}

std::uint64_t MemoryBase::bypass_bits() const {
  const MemoryShape& s = shape_;
  if (s.kind != MemoryKind::kSram || s.read_during_write != ReadDuringWrite::kNewWord) return 0;
  const std::uint64_t mask = s.mask_bits == 0 ? 0 : s.word_bits / s.mask_bits;
  const std::uint64_t reads = s.read_ports + s.shared_ports;
  const std::uint64_t writes = s.write_ports + s.shared_ports;
  return s.latency * (writes * s.span * (s.word_bits + mask) + reads * s.span);
}

std::string MemoryBase::built_as() const {
  std::string text = copies_ == 1 ? macro_ : fmt::format("{} copies of {}", copies_, macro_);
  if (shape_.kind != MemoryKind::kFlops && shape_.banks > 1)
    text += fmt::format(", {} banks", shape_.banks);
  // Flip-flops return the old word anyway.
  if (shape_.kind == MemoryKind::kSram && shape_.read_during_write == ReadDuringWrite::kOldWord)
    text += ", old word";
  if (shape_.read_during_write == ReadDuringWrite::kNewWord) text += ", new word";
  if (shape_.mask_bits != 0) text += fmt::format(", write mask of {} bits", shape_.mask_bits);
  return text;
}

std::uint64_t MemoryBase::bits_at(std::uint64_t width) const {
  if (shape_.columns == 0) return logical_bits();
  return (words() * width + shape_.columns - 1) / shape_.columns * word_bits();
}

PortedMemory::PortedMemory(const char* name, MemoryShape shape)
    : MemoryBase(name, std::move(shape)),
      words_(words()),
      span_(this->shape().span),
      latency_(this->shape().latency),
      guarded_(forbids(this->shape())),
      read_banks_(read_banks_used_),
      write_banks_(this->shape().shared_ports ? read_banks_used_ : write_banks_used_) {
  const MemoryShape& s = this->shape();
  const auto add = [&](Side side, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      Port port;
      port.side = side;
      ports_.push_back(std::move(port));
    }
  };
  add(Side::kRead, s.read_ports);
  add(Side::kWrite, s.write_ports);
  add(Side::kShared, s.shared_ports);
  if (s.separate_banks) {
    read_banks_used_.assign(s.banks, kNever);
    write_banks_used_.assign(s.banks, kNever);
  }
  const bool interleaved = s.order == BankOrder::kInterleaved,
             apart = s.span == 1 || (interleaved && s.span <= s.banks);  // words of an access
  for (Port& port : ports_) {
    port.latency = latency_;
    const bool alone =  // no other port uses its banks
        apart && s.shared_ports == 0 &&
        (port.side == Side::kRead ? s.read_ports : s.write_ports) == 1;
    if (port.side != Side::kShared) {
      if (alone || !s.separate_banks)
        (guarded_ ? port.guarded : port.plain) = words_;
      else if (interleaved && std::has_single_bit(s.banks))
        port.one_bank = words_;
    }
    port.bank_mask = s.banks - 1;
    port.banks = read_banks_.data();
    // All reads that can be pending, and the one whose word is on the output register.
    for (std::uint32_t i = 0; i <= latency_; ++i) {
      port.read[i].next = &port.read[i == latency_ ? 0 : i + 1];
      port.read[i].place = (readers_.size() * (latency_ + 1) + i) * span_;
    }
    port.newest = port.read.data();
    port.writer = static_cast<std::uint32_t>(writers_.size());
    if (port.side != Side::kWrite) readers_.push_back(&port);
    if (port.side != Side::kRead) writers_.push_back(&port);
  }
}

void PortedMemory::check_content(std::size_t words) const {
  const MemoryKind kind = shape().kind;
  DEBURR_CHECK(
      kind == MemoryKind::kRom || shape().loaded
          ? words == words_
          : words == 0 || (kind == MemoryKind::kFlops && words <= words_),
      fmt::format("{}: {} words of content for {} of {}: a rom and loaded sram need all words, "
                  "flip-flops may have initial values, other sram has none",
                  name(), words, words_, name_of(kind)));
}

void PortedMemory::check_content(std::size_t address, std::uint64_t word, bool negative) const {
  const std::uint32_t bits = word_bits();
  const bool fits = bits >= 64 || (negative ? ~word >> (bits - 1) == 0 : word >> bits == 0);
  DEBURR_CHECK(fits, fmt::format("{}: content {:#x} at address {} has more than {} bits", name(),
                                 word, address, bits));
}

PortedMemory::Port& PortedMemory::claim(Side side, const std::string& user) {
  for (Port& port : ports_)
    if (port.side == side && port.user.empty()) {
      port.user = user.empty() ? "a unit" : user;
      port.holder = sc_core::sc_get_current_object();
      return port;
    }
  throw spec::CheckFailed(fmt::format(
      "{}: {} needs one port more than {}: declare it, or copy the port of another user to "
      "share it in time",
      name(), user, ports()));
}

void PortedMemory::check_ports() const {
  for (const Port& port : ports_)
    DEBURR_CHECK(!port.user.empty(),
                 fmt::format("{}: one of its ports {} is unused", name(), ports()));
}

std::vector<const sc_core::sc_object*> PortedMemory::port_holders() const {
  std::vector<const sc_core::sc_object*> holders;
  for (const Port& port : ports_)
    if (port.holder) holders.push_back(port.holder);
  return holders;
}

void PortedMemory::reset() {
  for (Port& port : ports_) {
    port.written = kNever;
    port.reads = port.writes = 0;
    for (Read& read : port.read) read.due = kNever;
  }
  std::fill(read_banks_used_.begin(), read_banks_used_.end(), kNever);
  std::fill(write_banks_used_.begin(), write_banks_used_.end(), kNever);
  written_ = read_ = kNever;
}

std::uint64_t PortedMemory::reads() const {
  return std::accumulate(ports_.begin(), ports_.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const Port& port) { return sum + port.reads; });
}

std::uint64_t PortedMemory::writes() const {
  return std::accumulate(ports_.begin(), ports_.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const Port& port) { return sum + port.writes; });
}

const PortedMemory::Read& PortedMemory::arrived_before(const Port& port, Cycle cycle) const {
  const Read* found = nullptr;
  for (const Read* read = port.newest->next; read != port.newest; read = read->next)
    if (read->due <= cycle) found = read;
  if (found == nullptr) fail_early(port, cycle);
  return *found;
}

void PortedMemory::use_banks(std::vector<Cycle>& used, const Port& port, Cycle cycle,
                             std::uint64_t address, std::uint64_t count) const {
  const MemoryShape& s = shape();
  const std::uint64_t block = (words_ + s.banks - 1) / s.banks;
  for (std::uint64_t a = address; a < address + count; ++a) {
    const std::uint64_t bank = s.order == BankOrder::kInterleaved ? a % s.banks : a / block;
    if (used[bank] == cycle) [[unlikely]]
      fail(port, cycle,
           fmt::format("bank {} (address {}) is used twice in a cycle, expected separate banks",
                       bank, a));
    used[bank] = cycle;
  }
}

void PortedMemory::check_read(const Port& port, Cycle cycle, std::uint64_t address,
                              std::uint64_t count) {
  if (port.side == Side::kShared && port.written == cycle) fail_twice(port, cycle, address);
  if (shape().separate_banks) use_banks(read_banks_, port, cycle, address, count);
  if (!guarded_) return;
  for (const Port* writer : writers_)
    if (writer->written == cycle &&
        overlap(address, count, writer->write_address, writer->write_count))
      fail(port, cycle,
           fmt::format("read of address {}, which {} writes in this cycle: forbidden", address,
                       writer->user));
}

void PortedMemory::check_write(const Port& port, Cycle cycle, std::uint64_t address,
                               std::uint64_t count) {
  if (port.side == Side::kShared && port.newest->due == cycle + latency_)
    fail_twice(port, cycle, address);
  if (shape().separate_banks) use_banks(write_banks_, port, cycle, address, count);
  for (const Port* writer : writers_)
    if (writer != &port && writer->written == cycle &&
        overlap(address, count, writer->write_address, writer->write_count))
      fail(port, cycle,
           fmt::format("write of address {}, which {} also writes in this cycle", address,
                       writer->user));
  if (!guarded_) return;
  for (const Port* reader : readers_) {
    const Read& read = *reader->newest;
    if (read.due == cycle + latency_ && overlap(address, count, read.address, read.count))
      fail(port, cycle,
           fmt::format("write of address {}, which {} reads in this cycle: forbidden", address,
                       reader->user));
  }
}

void PortedMemory::fail_twice(const Port& port, Cycle cycle, std::uint64_t address) const {
  fail(port, cycle,
       fmt::format("second access (address {}) in a cycle: expected at most one per "
                   "cycle and port ({})",
                   address, ports()));
}

void PortedMemory::fail_address(const Port& port, Cycle cycle, std::uint64_t address,
                                std::uint64_t count) const {
  fail(port, cycle,
       fmt::format("access to {} words from address {} on, expected at most {} of {} words", count,
                   address, span_, words_));
}

void PortedMemory::fail_early(const Port& port, Cycle cycle) const {
  const Read& newest = *port.newest;
  fail(port, cycle,
       newest.due == kNever
           ? std::string("a word is used, but no read was issued")
           : fmt::format("the word of address {} is used, expected from cycle {} on",
                         newest.address, newest.due));
}

void PortedMemory::fail_stale(const Port& port, Cycle cycle, std::uint64_t wanted,
                              const Read& there) const {
  std::string when = "was not read recently";
  for (const Read& read : port.read)
    if (read.due != kNever && wanted - read.address < read.count)
      when = read.due > cycle ? fmt::format("arrives in cycle {}", read.due)
                              : fmt::format("was available from cycle {} on", read.due);
  fail(port, cycle,
       fmt::format("the word of address {} is used, which {}; the output register holds that of "
                   "address {}, from cycle {} on",
                   wanted, when, there.address, there.due));
}

void PortedMemory::fail_again(const Port& port, Cycle cycle, Cycle issued,
                              const Read& there) const {
  fail(port, cycle,
       fmt::format("the word of address {} as it was read in cycle {} is used; the output "
                   "register holds that of cycle {}",
                   there.address, issued, there.due - latency_));
}

void PortedMemory::fail(const Port& port, Cycle cycle, const std::string& what) const {
  const char* const kind = port.side == Side::kRead    ? "read"
                           : port.side == Side::kWrite ? "write"
                                                       : "shared";
  throw spec::CheckFailed(
      fmt::format("{}: cycle {}: {} port {}: {}", name(), cycle, kind, port.user, what));
}

// Out of line, to keep the code of its users small.
MemoryBase::~MemoryBase() = default;
PortedMemory::~PortedMemory() = default;

}  // namespace deburr::rtl
