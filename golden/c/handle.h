// SPDX-License-Identifier: MIT
// Handles of the C interface (docs/reference/c_interface.md), and the conversion of a call to a
// status: one thread at a time, no exception leaves, and errors have a text.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "golden/c/deburr_golden.h"

namespace deburr::golden::c {

// An invalid argument of a call.
class ArgumentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Throws ArgumentError if the condition is false.
void require(bool condition, std::string_view text);
// Throws ArgumentError for a null pointer; `what`: name of the argument.
void require_pointer(const void* pointer, std::string_view what);
void require_below(std::uint64_t value, std::uint64_t limit, std::string_view what);

// The elements of an array argument.
template <class Element>
std::span<Element> array_of(Element* elements, std::size_t size, std::string_view what) {
  if (size != 0) require_pointer(elements, what);
  return {elements, size};
}

// Copies a text with its terminating zero; ArgumentError if it does not fit.
void put_text(std::string_view from, char* text, std::size_t size);

// Elements per row; `width` if the stride is 0. Throws ArgumentError if rows overlap or exceed the
// array.
std::size_t row_distance(std::string_view what, std::size_t size, std::uint64_t width,
                         std::uint64_t height, std::uint32_t stride);

struct Counter {
  std::string name;
  std::uint64_t value;
};

// Memory lines with an error response; empty: none.
using ErrorLines = std::function<bool(std::uint32_t)>;
ErrorLines error_lines_of(std::span<const std::uint32_t> lines);

}  // namespace deburr::golden::c

// A model with its parameters. Functions throw; call() converts exceptions to a status.
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
  virtual void set_error_lines(deburr::golden::c::ErrorLines lines) = 0;

  // Set while a thread is in a call; members below belong to that thread.
  std::atomic<bool> busy{false};
  // Text of the last call that failed, except with DEBURR_BUSY.
  std::string error;
};

namespace deburr::golden::c {

// Exclusive use of a handle by a thread; false if another thread has it.
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

// Status of the current exception; stores its text, prefixed with the name of the function.
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

// For functions of one kind of handle, which is passed to `work`.
template <class Kind, class Work>
int call_of(deburr_golden* golden, const char* function, Work&& work) noexcept {
  return call(golden, function, [&](deburr_golden& any) {
    auto* const own = dynamic_cast<Kind*>(&any);
    if (!own) reject_kind(any.engine(), Kind::kWanted);
    work(*own);
  });
}

// Creates a handle; NULL if out of memory.
template <class Kind>
deburr_golden* new_handle() noexcept {
  try {
    return new Kind;
  } catch (...) {
    return nullptr;
  }
}

}  // namespace deburr::golden::c
