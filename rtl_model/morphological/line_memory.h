// SPDX-License-Identifier: MIT
// Memory of a block that is addressed by the column of the slot in hand, so that its accesses in a
// clock are fixed by construction and `ports` says them. A read sees the words as they were before
// the clock (read-first), hence a block reads before it writes. Cost: columns x column_bits.
// What is read elsewhere counts its accesses in every clock: ReadPorts.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "rtl_model/fabric/clocked.h"
#include "rtl_model/fabric/storage.h"
#include "spec/error.h"

namespace deburr::rtl::morphological {

class ColumnStorage : public Storage {
 public:
  ColumnStorage(const char* name, std::int32_t columns, std::uint32_t column_bits,
                std::string ports)
      : Storage(name, static_cast<std::uint64_t>(columns), column_bits, std::move(ports)) {}
  // Bits that it would have for a frame of this width.
  std::uint64_t bits_at(std::uint64_t width) const { return width * word_bits(); }
  // Contents are kept, as in hardware: slot row 0 of the next frame clears what must be.
  void reset() override {}
};

// A buffer that the model keeps in another form: reported as the hardware has it.
class Buffer final : public Storage {
 public:
  Buffer(const char* name, std::uint64_t words, std::uint32_t word_bits)
      : Storage(name, words, word_bits, "1R1W") {}
  void reset() override {}
};

// The read ports of a memory, counted in every clock: one access too many stops the simulation.
class ReadPorts {
 public:
  ReadPorts(const Storage& memory, int ports) : memory_(memory), ports_(ports) {}
  void use(Cycle cycle) {
    if (cycle != cycle_) {
      cycle_ = cycle;
      used_ = 0;
    }
    if (++used_ > ports_) [[unlikely]]
      fail();
  }
  int used() const { return used_; }  // in the last clock that used any
  int count() const { return ports_; }

 private:
  // Out of line: a check costs its caller one comparison.
  [[noreturn, gnu::cold, gnu::noinline]] void fail() const {
    throw spec::CheckFailed(std::string(memory_.name()) + ": cycle " + std::to_string(cycle_) +
                            ": one read too many for its " + std::to_string(ports_) +
                            " read ports");
  }
  const Storage& memory_;
  const int ports_;
  int used_ = 0;
  Cycle cycle_ = kNever;
};

// `words` is what the model keeps; the hardware's words are columns of `column_bits`.
template <class Word>
class LineMemory final : public ColumnStorage {
 public:
  LineMemory(const char* name, std::int32_t columns, std::uint32_t column_bits, std::string ports,
             std::size_t words)
      : ColumnStorage(name, columns, column_bits, std::move(ports)), words_(words) {}
  Word& operator[](std::size_t i) { return words_[i]; }
  const Word& operator[](std::size_t i) const { return words_[i]; }
  Word* data() { return words_.data(); }

 private:
  std::vector<Word> words_;
};

}  // namespace deburr::rtl::morphological
