// SPDX-License-Identifier: MIT
// What is behind a handle of the C interface (docs/reference/c_interface.md), and how a call of it
// becomes a status: one thread at a time, no exception, a text that says what was wrong.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "golden/c/deburr_golden.h"

namespace deburr::golden::c {

// An argument of a call that cannot be meant.
class ArgumentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// ArgumentError unless the condition holds.
void require(bool condition, std::string_view text);
// ArgumentError for a null pointer; `what` is the argument's name.
void require_pointer(const void* pointer, std::string_view what);
void require_below(std::uint64_t value, std::uint64_t limit, std::string_view what);

// The elements of an array that a caller gave.
template <class Element>
std::span<Element> array_of(Element* elements, std::size_t size, std::string_view what) {
  if (size != 0) require_pointer(elements, what);
  return {elements, size};
}

// Copies a text with its zero; ArgumentError if it does not fit.
void put_text(std::string_view from, char* text, std::size_t size);

// Elements from row to row, `width` for a stride of 0. ArgumentError if rows overlap or do not fit
// the array.
std::size_t row_distance(std::string_view what, std::size_t size, std::uint64_t width,
                         std::uint64_t height, std::uint32_t stride);

struct Counter {
  std::string name;
  std::uint64_t value;
};

}  // namespace deburr::golden::c

// A model with its parameters. Functions throw; call() turns what they throw into a status.
struct deburr_golden {
  deburr_golden() = default;
  virtual ~deburr_golden() = default;
  deburr_golden(const deburr_golden&) = delete;
  deburr_golden& operator=(const deburr_golden&) = delete;

  virtual const char* engine() const = 0;
  virtual void set(std::string_view name, std::string_view text) = 0;
  virtual std::string get(std::string_view name) const = 0;
  virtual void check() const = 0;
  virtual std::span<const std::string> parameter_names() const = 0;
  virtual std::span<const deburr::golden::c::Counter> counters() = 0;
  virtual void reset() = 0;

  // Set while a thread is in a call; what follows belongs to that thread.
  std::atomic<bool> busy{false};
  // Of the last call that failed, but for DEBURR_BUSY.
  std::string error;
};

namespace deburr::golden::c {

// The thread's turn with a handle, or none.
class Turn {
 public:
  explicit Turn(deburr_golden& golden)
      : golden_(golden), taken_(!golden.busy.exchange(true, std::memory_order_acquire)) {}
  ~Turn() {
    if (taken_) golden_.busy.store(false, std::memory_order_release);
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
  explicit operator bool() const { return taken_; }

 private:
  deburr_golden& golden_;
  bool taken_;
};

// The status of the exception in hand, whose text is kept behind the function's name.
int status_of_exception(deburr_golden& golden, const char* function) noexcept;

[[noreturn]] void reject_kind(const char* given, const char* wanted);

// Runs `work` for a function of the interface.
template <class Work>
int call(deburr_golden* golden, const char* function, Work&& work) noexcept {
  if (!golden) return DEBURR_ARGUMENT;
  const Turn turn(*golden);
  if (!turn) return DEBURR_BUSY;
  try {
    work(*golden);
    return DEBURR_OK;
  } catch (...) {
    return status_of_exception(*golden, function);
  }
}

// The same for functions of one kind of handle: `work` gets that.
template <class Kind, class Work>
int call_of(deburr_golden* golden, const char* function, Work&& work) noexcept {
  return call(golden, function, [&](deburr_golden& any) {
    auto* const own = dynamic_cast<Kind*>(&any);
    if (!own) reject_kind(any.engine(), Kind::kWanted);
    work(*own);
  });
}

// A handle of the kind, or NULL without memory.
template <class Kind>
deburr_golden* new_handle() noexcept {
  try {
    return new Kind;
  } catch (...) {
    return nullptr;
  }
}

}  // namespace deburr::golden::c
