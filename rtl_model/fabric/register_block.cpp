// SPDX-License-Identifier: MIT
#include "rtl_model/fabric/register_block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "spec/error.h"

namespace deburr::rtl {
namespace {

// Registers are little-endian on the bus, independent of the host.
void store(std::uint8_t* to, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) to[i] = static_cast<std::uint8_t>(value >> (8 * i));
}
std::uint32_t load(const std::uint8_t* from) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value |= std::uint32_t{from[i]} << (8 * i);
  return value;
}

}  // namespace

RegisterBlock::RegisterBlock(const sc_core::sc_module_name& name,
                             std::span<const spec::RegisterInfo> table)
    : sc_module(name),
      table_(table),
      actions_(table.size()),
      debug_actions_(table.size()),
      values_read_(table.size()),
      shown_(table.size()) {
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::uint32_t offset = table[i].offset;
    DEBURR_CHECK(offset % 4 == 0, fmt::format("{}.{}: offset {:#x} is not a multiple of 4",
                                              this->name(), table[i].name, offset));
    if (index_by_word_.size() <= offset / 4) index_by_word_.resize(offset / 4 + 1, -1);
    DEBURR_CHECK(index_by_word_[offset / 4] < 0,
                 fmt::format("{}.{}: offset {:#x} is used by another register", this->name(),
                             table[i].name, offset));
    DEBURR_CHECK(
        !table[i].fields.empty(),
        fmt::format("{}.{}: has no field: use spec::kNumber or spec::number() for a plain number",
                    this->name(), table[i].name));
    index_by_word_[offset / 4] = static_cast<int>(i);
    values_.push_back(table[i].reset());
  }
  bus.register_b_transport(this, &RegisterBlock::b_transport);
  bus.register_transport_dbg(this, &RegisterBlock::transport_dbg);
}

void RegisterBlock::on_write(std::size_t index, std::function<void(std::uint32_t)> action) {
  actions_.at(index) = std::move(action);
}

void RegisterBlock::on_debug_write(std::size_t index, std::function<void(std::uint32_t)> action) {
  debug_actions_.at(index) = std::move(action);
}

void RegisterBlock::on_read(std::size_t index, std::function<std::uint32_t()> value) {
  values_read_.at(index) = std::move(value);
}

void RegisterBlock::show(std::size_t index, const Counter& counter, int shift) {
  DEBURR_CHECK(
      table_[index].bits(spec::Access::kReadOnly) == table_[index].mask(),
      fmt::format("{}.{} shows a counter, so it must be read-only", name(), table_[index].name));
  shown_.at(index) = {&counter, shift};
}

void RegisterBlock::reset() {
  for (std::size_t i = 0; i < values_.size(); ++i) values_[i] = table_[i].reset();
}

std::size_t RegisterBlock::index_of(const std::string& register_name) const {
  for (std::size_t i = 0; i < table_.size(); ++i)
    if (register_name == table_[i].name) return i;
  throw spec::ConfigError(fmt::format("{} has no register {}", name(), register_name));
}

int RegisterBlock::find(std::uint64_t offset) const {
  return offset % 4 == 0 && offset / 4 < index_by_word_.size() ? index_by_word_[offset / 4] : -1;
}

std::uint32_t RegisterBlock::read(std::size_t index) const {
  if (values_read_[index]) return values_read_[index]();
  const Shown& shown = shown_[index];
  return shown.counter ? static_cast<std::uint32_t>(shown.counter->value() >> shown.shift)
                       : values_[index];
}

void RegisterBlock::b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
  if (delay != sc_core::SC_ZERO_TIME &&
      sc_core::sc_get_current_process_handle().proc_kind() == sc_core::SC_THREAD_PROC_)
    wait(std::exchange(delay, sc_core::SC_ZERO_TIME));
  const int found = find(payload.get_address());
  const bool write = payload.is_write();
  const auto reject = [&](tlm::tlm_response_status status) { payload.set_response_status(status); };
  if (!write && !payload.is_read()) {
    // TLM_IGNORE_COMMAND: the base protocol allows a target to do nothing and report OK.
    return reject(tlm::TLM_OK_RESPONSE);
  }
  if (found < 0) return reject(tlm::TLM_ADDRESS_ERROR_RESPONSE);
  if (payload.get_byte_enable_ptr()) return reject(tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
  if (payload.get_data_length() != 4 || payload.get_streaming_width() < 4)
    return reject(tlm::TLM_BURST_ERROR_RESPONSE);
  const auto index = static_cast<std::size_t>(found);
  const spec::RegisterInfo& info = table_[index];
  if ((write ? info.writable() : info.readable()) == 0)
    return reject(tlm::TLM_COMMAND_ERROR_RESPONSE);
  payload.set_response_status(tlm::TLM_OK_RESPONSE);
  if (!write) return store(payload.get_data_ptr(), read(index));
  const std::uint32_t value = load(payload.get_data_ptr());
  const std::uint32_t cleared = info.bits(spec::Access::kWriteOneToClear) & value;
  values_[index] = (values_[index] & ~info.written() & ~cleared) | (value & info.written());
  if (actions_[index]) actions_[index](value);
}

unsigned RegisterBlock::transport_dbg(tlm::tlm_generic_payload& payload) {
  const bool write = payload.is_write();
  unsigned done = 0;
  if (write || payload.is_read())
    for (; done + 4 <= payload.get_data_length(); done += 4) {
      const int found = find(payload.get_address() + done);
      if (found < 0) break;
      const auto index = static_cast<std::size_t>(found);
      if (write) {
        values_[index] = load(payload.get_data_ptr() + done);
        if (debug_actions_[index]) debug_actions_[index](values_[index]);
      } else {
        store(payload.get_data_ptr() + done, read(index));
      }
    }
  payload.set_response_status(done ? tlm::TLM_OK_RESPONSE : tlm::TLM_ADDRESS_ERROR_RESPONSE);
  return done;
}

}  // namespace deburr::rtl
