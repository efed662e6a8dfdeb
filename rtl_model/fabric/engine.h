// SPDX-License-Identifier: MIT
// Base of every engine: its registers, its memory socket if it has one, and what reports find in
// it.
//
//   class Smoother final : public Engine {
//    public:
//     Smoother(const sc_core::sc_module_name& name, ClockDomain& clock, const Parameters& p)
//         : Engine(name, clock, kSmootherRegisters, kLayout),
//           parameters_(check_build(p)), ... {  // spec/check_build.h
//       control.show(kPixels, blender_.pixels);
//     }
//     bool idle() const override { return ...; }
//
// A clear command (CONTROL) resets every Counter below the engine, whether a register shows it or
// not, and nothing else: the account of cycles and the histograms are instruments of the model and
// go on. A reset gives every register its reset value, and lowers the interrupt.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <systemc>
#include <tlm>
#include <vector>

#include "rtl_model/fabric/clock_domain.h"
#include "rtl_model/fabric/control_registers.h"
#include "rtl_model/fabric/histogram.h"
#include "rtl_model/fabric/link.h"
#include "rtl_model/fabric/memory.h"
#include "rtl_model/fabric/memory_port.h"
#include "rtl_model/fabric/unit.h"
#include "spec/registers.h"

namespace deburr::rtl {

class Engine : public sc_core::sc_module {
 public:
  ~Engine() override;
  const char* kind() const override { return "deburr_engine"; }

  ControlRegisters control;

  // --- Sockets, to be bound from outside ---
  tlm_utils::simple_target_socket<RegisterBlock>& registers = control.registers.bus;
  // nullptr: built without memory, and there is no such socket.
  tlm::tlm_initiator_socket<>* memory() const { return port_ ? &port_->memory : nullptr; }
  // High while a sticky bit of STATUS is set: a frame is done, or something went wrong. Software
  // lowers it with a write of ones to those bits. It follows in the delta cycle after the edge, or
  // after the write; sc_in<bool> ports bind to it, or nothing does.
  sc_core::sc_export<sc_core::sc_signal_in_if<bool>> interrupt{"interrupt"};
  // For a target that does not accept every end of a response. Before the first request.
  void end_responses(ResponseEnd how) {
    if (port_) port_->response_end = how;
  }

  // Nothing is inside and nothing waits in front. Between edges.
  virtual bool idle() const = 0;
  void clear_counters();

  // For reports: everything below this module, in the order of declaration. Of a unit that is
  // replaced there are the counters alone that are counted for it.
  std::vector<const Unit*> units() const;
  std::vector<const Counter*> counters() const;
  std::vector<const MemoryBase*> memories() const;
  std::vector<const Histogram*> histograms() const;
  std::vector<const LinkBase*> links() const;

 protected:
  Engine(const sc_core::sc_module_name& name, ClockDomain& clock,
         std::span<const spec::RegisterInfo> table, const ControlLayout& layout);
  // The one port through which the engine reaches memory.
  void uses(MemoryPort& port) { port_ = &port; }

 private:
  SC_HAS_PROCESS(Engine);
  void drive_interrupt() { interrupt_level_.write(control.interrupt()); }

  MemoryPort* port_ = nullptr;
  sc_core::sc_signal<bool> interrupt_level_{"interrupt_level"};
  sc_core::sc_event interrupt_changed_;
};

}  // namespace deburr::rtl
