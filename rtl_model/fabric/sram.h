// SPDX-License-Identifier: MIT
// A synchronous memory whose ports are counted in every cycle.
//
// read(cycle, address) stands for an access in that cycle; the word is on the output register in
// cycle+1, so the caller stores the result in a register and uses it no earlier. A read sees the
// words as they were before this cycle. Reading and writing one address in one cycle is an error
// unless the memory is built read-first. More accesses in a cycle than ports: DEBURR_CHECK fails.
// Latency 1, initiation interval 1 a port, never stalls. Cost: words x word_bits.
#pragma once

#include <cstdint>
#include <string>
#include <systemc>
#include <vector>

#include "rtl_model/fabric/clocked.h"
#include "rtl_model/fabric/storage.h"
#include "spec/error.h"

namespace deburr::rtl {

struct SramPorts {
  int read = 1;             // ports that only read
  int write = 1;            // ports that only write
  int shared = 0;           // ports that do either; with shared > 0, read and write are usually 0
  bool read_first = false;  // a read in the cycle of a write to the same address sees the old word
};

template <class Word>
class Sram final : public Storage {
 public:
  Sram(const char* name, std::uint64_t words, std::uint32_t word_bits, SramPorts ports = {})
      : Storage(name, words, word_bits, describe(ports)), ports_(ports), words_(words) {}

  const Word& read(Cycle cycle, std::uint64_t address) {
    begin(cycle, address);
    ++reads_;
    DEBURR_CHECK(fits(), overuse("read", cycle));
    for (const Access& write : written_)
      if (write.address == address) {
        DEBURR_CHECK(ports_.read_first, collision(cycle, address));
        return write.word;
      }
    if (!ports_.read_first) read_.push_back(address);
    return words_[address];
  }
  void write(Cycle cycle, std::uint64_t address, const Word& word) {
    begin(cycle, address);
    ++writes_;
    DEBURR_CHECK(fits(), overuse("write", cycle));
    for (const std::uint64_t other : read_)
      DEBURR_CHECK(other != address, collision(cycle, address));
    for (const Access& other : written_)
      DEBURR_CHECK(other.address != address, collision(cycle, address));
    written_.push_back({address, words_[address]});
    words_[address] = word;
  }

  // Without a port and without time: for tests, preloads and dumps only.
  Word& backdoor(std::uint64_t address) { return words_.at(address); }
  // Contents are kept, as in hardware; only the bookkeeping of the current cycle is cleared.
  void reset() override { cycle_ = kNever; }

 private:
  struct Access {
    std::uint64_t address;
    Word word;  // before the write
  };
  static std::string describe(const SramPorts& ports) {
    std::string text;
    if (ports.read) text += std::to_string(ports.read) + "R";
    if (ports.write) text += std::to_string(ports.write) + "W";
    if (ports.shared) text += std::to_string(ports.shared) + "RW";
    return text;
  }
  void begin(Cycle cycle, std::uint64_t address) {
    DEBURR_CHECK(address < words_.size(), std::string(name()) + ": cycle " + std::to_string(cycle) +
                                              ": address " + std::to_string(address) + " of " +
                                              std::to_string(words_.size()) + " words");
    if (cycle == cycle_) return;
    cycle_ = cycle;
    reads_ = writes_ = 0;
    read_.clear();
    written_.clear();
  }
  bool fits() const {
    const int over = (reads_ > ports_.read ? reads_ - ports_.read : 0) +
                     (writes_ > ports_.write ? writes_ - ports_.write : 0);
    return over <= ports_.shared;
  }
  std::string overuse(const char* what, Cycle cycle) const {
    return std::string(name()) + ": cycle " + std::to_string(cycle) + ": one " + what +
           " too many for its ports " + ports() + " (" + std::to_string(reads_) + " reads, " +
           std::to_string(writes_) + " writes)";
  }
  std::string collision(Cycle cycle, std::uint64_t address) const {
    return std::string(name()) + ": cycle " + std::to_string(cycle) +
           ": two accesses, one of them a write, to address " + std::to_string(address);
  }

  SramPorts ports_;
  std::vector<Word> words_;
  Cycle cycle_ = kNever;
  int reads_ = 0, writes_ = 0;
  std::vector<std::uint64_t> read_;
  std::vector<Access> written_;
};

}  // namespace deburr::rtl
