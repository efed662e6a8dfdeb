// SPDX-License-Identifier: MIT
// The program of the platform's processor, a loosely timed thread: it runs ahead of simulated time
// by up to a quantum and accesses memory and registers by b_transport. Register and field names are
// those of the installed C header.
#pragma once

#include <tlm_utils/simple_initiator_socket.h>
#include <tlm_utils/tlm_quantumkeeper.h>

#include <cstdint>
#include <functional>
#include <systemc>

namespace platform {

class Software final : public sc_core::sc_module {
 public:
  tlm_utils::simple_initiator_socket<Software> bus{"bus"};
  sc_core::sc_in<bool> texture_interrupt{"texture_interrupt"};
  sc_core::sc_in<bool> smoother_interrupt{"smoother_interrupt"};
  sc_core::sc_out<bool> core_reset_n{"core_reset_n"}, pixel_reset_n{"pixel_reset_n"};
  std::function<void()> on_end;  // of the program

  explicit Software(const sc_core::sc_module_name& name);

  std::uint32_t frame_cycles() const { return frame_cycles_; }
  std::uint32_t blended_pixels() const { return blended_pixels_; }
  std::uint32_t bilinears() const { return bilinears_; }
  bool texture_failed() const { return texture_failed_; }

 private:
  SC_HAS_PROCESS(Software);
  void program();
  void reset_core_in_mid_frame();
  void reset_pixels_in_mid_frame();
  void set_up_texture();
  void set_up_smoother();
  void wait_for_frame();
  void look_at_memory();

  void access(tlm::tlm_command command, std::uint64_t address, void* data, unsigned bytes);
  std::uint32_t read(std::uint64_t address);
  void write(std::uint64_t address, std::uint32_t value);
  void require(bool holds, const char* what) const;
  void expect(std::uint64_t address, std::uint32_t value);

  tlm_utils::tlm_quantumkeeper time_;
  std::uint32_t frame_cycles_ = 0, blended_pixels_ = 0, bilinears_ = 0;
  bool texture_failed_ = false;
};

}  // namespace platform
