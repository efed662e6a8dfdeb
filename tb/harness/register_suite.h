// SPDX-License-Identifier: MIT
// Checks the registers of an engine against its exported SystemRDL file, in every build of a Kit
// (engine_kit.h). A parser reads the file, and a host on the bus checks access, reset value and
// side effects of each field. Neither uses the tables in spec/ from which the file and the hardware
// are made.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <tlm>
#include <utility>
#include <vector>

#include "rtl_model/fabric/register_section.h"
#include "tb/harness/engine_kit.h"
#include "tb/harness/in_child.h"

namespace deburr::tb {

// The registers of the hardware, as software sees them and as the engine's units see them.
struct RegisterHardware {
  std::function<std::uint32_t(std::uint32_t offset)> read;  // throws SimulationError if rejected
  std::function<tlm::tlm_response_status(std::uint32_t offset, std::uint32_t value)> write;
  // A write of `bytes` bytes, with or without byte enables.
  std::function<tlm::tlm_response_status(std::uint32_t offset, unsigned bytes, bool enables)>
      write_bytes;
  std::function<void()> reset;
  std::function<void()> begin_job;
  std::function<bool(const std::function<bool()>& done)> run_until;
  std::function<void()> provoke;  // sets every sticky bit and advances every counter
  std::function<void(std::uint32_t bits)> set_sticky;       // in STATUS
  std::function<std::uint32_t(std::uint32_t offset)> seen;  // value seen by units after a write
  std::function<bool()> interrupt;
};

// Describes what the hardware has and the file has not, and the reverse; empty if they agree. Also
// counts the checked fields.
std::vector<std::string> register_differences(const std::string& systemrdl,
                                              const RegisterHardware& hardware, int& fields);
// Mutants of the file, each with the changed line. A mutant has one error in the line of a field:
// wrong bits, access, side effects or reset value, or the line is removed. Unobservable mutants are
// omitted.
std::vector<std::pair<std::string, std::string>> wrong_files(const std::string& systemrdl);
// Mutants of the hardware, each with a description. A mutant has one error at its bus.
std::vector<std::pair<std::string, RegisterHardware>> wrong_hardware(const std::string& systemrdl,
                                                                     const RegisterHardware& right);

template <class Kit>
class RegisterSuite {
 public:
  explicit RegisterSuite(const typename Kit::Build& build) : kit_(build) {}

  void every_field_is_as_the_exported_file_says() {
    int fields = 0;
    EXPECT_EQ(difference(file(), hardware(), &fields), "");
    EXPECT_GE(fields, 9);
  }
  // Checks that every mutant of the file and of the hardware is detected. Each mutant is tried on a
  // new engine in its own process.
  void a_wrong_file_is_seen() {
    EXPECT_EQ(in_child([&] { return difference(file(), hardware()); }), "");
    const auto files = wrong_files(file());
    EXPECT_GE(files.size(), 20u);
    for (const auto& wrong : files) {
      const std::string text = in_child([&] { return difference(wrong.second, hardware()); });
      EXPECT_FALSE(text.empty() || text.starts_with("exception")) << text << wrong.first;
    }
  }
  void wrong_hardware_is_seen() {
    for (const auto& wrong : wrong_hardware(file(), hardware()))
      EXPECT_NE(in_child([&] { return difference(file(), wrong.second); }), "") << wrong.first;
  }

 private:
  std::string file() const {
    const std::array sections = {kit_.section()};
    return rtl::register_systemrdl(sections);
  }
  static std::string difference(const std::string& file, const RegisterHardware& hardware,
                                int* fields = nullptr) {
    int tried = 0;
    std::string text;
    for (const std::string& line : register_differences(file, hardware, tried)) text += line + "\n";
    if (fields) *fields = tried;
    return text;
  }
  RegisterHardware hardware();

  Kit kit_;
};

// One write of `bytes` bytes over the host's socket.
tlm::tlm_response_status write_bytes(platform::RegisterHost& host, std::uint32_t offset,
                                     unsigned bytes, bool enables);

template <class Kit>
RegisterHardware RegisterSuite<Kit>::hardware() {
  rtl::ControlRegisters& control = kit_.engine().control;
  return {
      .read = [this](std::uint32_t offset) { return kit_.bus().read(offset); },
      .write = [this](std::uint32_t offset,
                      std::uint32_t value) { return kit_.bus().try_write(offset, value); },
      .write_bytes = [this](
                         std::uint32_t offset, unsigned bytes,
                         bool enables) { return write_bytes(kit_.bus(), offset, bytes, enables); },
      .reset = [this] { kit_.reset(kit_.long_reset()); },
      .begin_job = [this] { kit_.start(Job::kBroken); },
      .run_until =
          [this](const std::function<bool()>& done) { return kit_.clock().run_until(done, 1000); },
      .provoke = [this] { kit_.spoil(); },
      .set_sticky = [&control](std::uint32_t bits) { control.set_sticky(bits); },
      .seen = [&control](std::uint32_t offset) { return control.value(offset); },
      .interrupt = [&control] { return control.interrupt(); }};
}

}  // namespace deburr::tb
