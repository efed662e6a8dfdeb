// SPDX-License-Identifier: MIT
#include "golden/c/handle.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <unordered_set>
#include <utility>

#include "spec/error.h"

namespace deburr::golden::c {
namespace {

constexpr std::string_view kNoHandle =
    "the handle is NULL: make one with a deburr_..._new function";
constexpr std::string_view kBusy =
    "the handle is in use by another thread: use one handle per thread, or serialise the calls";
constexpr std::string_view kNoMemory = "out of memory";

// Truncates the text to the size; never throws.
void put_cut(std::string_view from, char* text, std::size_t size) {
  const std::size_t length = std::min(from.size(), size - 1);
  std::memcpy(text, from.data(), length);
  text[length] = '\0';
}

}  // namespace

void require(bool condition, std::string_view text) {
  if (!condition) throw ArgumentError(std::string(text));
}

// Takes a name, not a text: the text is only built on an error, since calls are frequent.
void require_pointer(const void* pointer, std::string_view what) {
  if (!pointer) throw ArgumentError(std::string(what) + " is NULL");
}

void require_below(std::uint64_t value, std::uint64_t limit, std::string_view what) {
  if (value < limit) return;
  throw ArgumentError(std::string(what) + " " + std::to_string(value) + " is outside 0.." +
                      std::to_string(limit - 1));
}

void reject_kind(const char* given, const char* wanted) {
  throw ArgumentError(std::string("the handle belongs to the engine ") + given + "; expected " +
                      wanted);
}

void put_text(std::string_view from, char* text, std::size_t size) {
  require_pointer(text, "text");
  require(from.size() < size, "the text needs " + std::to_string(from.size() + 1) +
                                  " bytes; text_size is " + std::to_string(size));
  put_cut(from, text, size);
}

std::size_t row_distance(std::string_view what, std::size_t size, std::uint64_t width,
                         std::uint64_t height, std::uint32_t stride) {
  const std::string name(what);
  require(stride == 0 || stride >= width, "stride " + std::to_string(stride) +
                                              " is shorter than a row of " + name + ", " +
                                              std::to_string(width) + "; 0: rows without gaps");
  // At most 2^13 rows of fewer than 2^32 elements each: no overflow.
  const std::uint64_t distance = stride == 0 ? width : stride;
  const std::uint64_t needed = (height - 1) * distance + width;
  require(size >= needed, name + "_size is " + std::to_string(size) + "; " +
                              std::to_string(height) + " rows need " + std::to_string(needed));
  return static_cast<std::size_t>(distance);
}

ErrorLines error_lines_of(std::span<const std::uint32_t> lines) {
  if (lines.empty()) return nullptr;
  auto known = std::make_shared<std::unordered_set<std::uint32_t>>(lines.begin(), lines.end());
  return [known](std::uint32_t line) { return known->contains(line); };
}

int status_of_exception(deburr_golden& golden, const char* function) noexcept {
  const auto keep = [&](int status, std::string_view text) {
    golden.error = function;
    golden.error += ": ";
    golden.error += text;
    return status;
  };
  try {
    try {
      throw;
    } catch (const ArgumentError& error) {
      return keep(DEBURR_ARGUMENT, error.what());
    } catch (const spec::ConfigError& error) {
      return keep(DEBURR_CONFIGURATION, error.what());
    } catch (const std::bad_alloc&) {
      return keep(DEBURR_MEMORY, kNoMemory);
    } catch (const std::length_error&) {
      return keep(DEBURR_MEMORY, kNoMemory);
    } catch (const std::exception& error) {
      return keep(DEBURR_INTERNAL, error.what());
    } catch (...) {
      return keep(DEBURR_INTERNAL, "an unknown exception");
    }
  } catch (...) {  // out of memory for the text as well
    golden.error.clear();
    return DEBURR_MEMORY;
  }
}

}  // namespace deburr::golden::c

using deburr::golden::c::call;
using deburr::golden::c::put_text;
using deburr::golden::c::require;
using deburr::golden::c::require_below;
using deburr::golden::c::require_pointer;

extern "C" {

const char* deburr_version(void) { return DEBURR_VERSION; }

int deburr_close(deburr_golden* golden) {
  if (!golden) return DEBURR_OK;
  // `busy` is never cleared, since the handle is deleted.
  if (golden->busy.exchange(true, std::memory_order_acquire)) return DEBURR_BUSY;
  delete golden;
  return DEBURR_OK;
}

const char* deburr_engine(const deburr_golden* golden) { return golden ? golden->engine() : ""; }

int deburr_error(deburr_golden* golden, int status, char* text, size_t text_size) {
  namespace c = deburr::golden::c;
  if (!text || text_size == 0) return DEBURR_ARGUMENT;
  text[0] = '\0';
  if (status == DEBURR_OK) return DEBURR_OK;
  if (status == DEBURR_BUSY) {
    c::put_cut(c::kBusy, text, text_size);
    return DEBURR_OK;
  }
  if (!golden) {
    c::put_cut(c::kNoHandle, text, text_size);
    return DEBURR_OK;
  }
  const c::Turn turn(*golden);
  if (!turn) {
    c::put_cut(c::kBusy, text, text_size);
    return DEBURR_BUSY;
  }
  const bool no_memory = status == DEBURR_MEMORY && golden->error.empty();
  c::put_cut(no_memory ? c::kNoMemory : std::string_view(golden->error), text, text_size);
  return DEBURR_OK;
}

int deburr_set(deburr_golden* golden, const char* name, const char* text) {
  return call(golden, __func__, [&](deburr_golden& g) {
    require_pointer(name, "name");
    require_pointer(text, "text");
    g.set(name, text);
  });
}

int deburr_get(deburr_golden* golden, const char* name, char* text, size_t text_size) {
  return call(golden, __func__, [&](deburr_golden& g) {
    require_pointer(name, "name");
    put_text(g.get(name), text, text_size);
  });
}

int deburr_check(deburr_golden* golden) {
  return call(golden, __func__, [](deburr_golden& g) { g.check(); });
}

int deburr_parameter_count(deburr_golden* golden, uint32_t* count) {
  return call(golden, __func__, [&](deburr_golden& g) {
    require_pointer(count, "count");
    *count = static_cast<uint32_t>(g.parameter_names().size());
  });
}

int deburr_parameter_name(deburr_golden* golden, uint32_t index, char* text, size_t text_size) {
  return call(golden, __func__, [&](deburr_golden& g) {
    const auto names = g.parameter_names();
    require_below(index, names.size(), "index");
    put_text(names[index], text, text_size);
  });
}

int deburr_counter(deburr_golden* golden, const char* name, uint64_t* value) {
  return call(golden, __func__, [&](deburr_golden& g) {
    require_pointer(name, "name");
    require_pointer(value, "value");
    std::string known;
    for (const auto& counter : g.counters()) {
      if (counter.name == name) {
        *value = counter.value;
        return;
      }
      known += (known.empty() ? "" : ", ") + counter.name;
    }
    require(false, "unknown counter '" + std::string(name) + "'; known: " + known);
  });
}

int deburr_counter_count(deburr_golden* golden, uint32_t* count) {
  return call(golden, __func__, [&](deburr_golden& g) {
    require_pointer(count, "count");
    *count = static_cast<uint32_t>(g.counters().size());
  });
}

int deburr_counter_name(deburr_golden* golden, uint32_t index, char* text, size_t text_size) {
  return call(golden, __func__, [&](deburr_golden& g) {
    const auto counters = g.counters();
    require_below(index, counters.size(), "index");
    put_text(counters[index].name, text, text_size);
  });
}

int deburr_error_lines(deburr_golden* golden, const uint32_t* lines, size_t lines_size) {
  namespace c = deburr::golden::c;
  return call(golden, __func__, [&](deburr_golden& g) {
    g.set_error_lines(c::error_lines_of(c::array_of(lines, lines_size, "lines")));
  });
}

int deburr_reset(deburr_golden* golden) {
  return call(golden, __func__, [](deburr_golden& g) { g.reset(); });
}

}  // extern "C"
