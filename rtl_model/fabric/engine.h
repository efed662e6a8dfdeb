// SPDX-License-Identifier: MIT
// Base of every engine: its registers, its memory socket if it has one, and access for reports.
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
// not. Cycle accounts and histograms belong to the model's instruments and are not cleared. A reset
// loads the reset value of every register and lowers the interrupt.
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
#include "rtl_model/fabric/datasheet.h"
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

  // --- Sockets, bound from outside ---
  tlm_utils::simple_target_socket<RegisterBlock>& registers = control.registers.bus;
  // nullptr if the engine was built without a memory port.
  tlm::tlm_initiator_socket<>* memory() const { return port_ ? &port_->memory : nullptr; }
  // High while a sticky bit of STATUS is set: a frame is done, or an error occurred. Software
  // lowers it by writing ones to those bits. Changes in the delta cycle after the edge or the
  // write. Binding (sc_in<bool>) is optional.
  sc_core::sc_export<sc_core::sc_signal_in_if<bool>> interrupt{"interrupt"};
  // For a target that does not accept every way of ending a response. Call before the first
  // request.
  void end_responses(ResponseEnd how) {
    if (port_) port_->response_end = how;
  }

  // True if no work is inside or waiting at an input. Call between edges.
  virtual bool idle() const = 0;
  // Of the units that this build has.
  virtual std::vector<Datasheet> datasheets() const { return {}; }
  void clear_counters();

  // For reports: all units or counters below this module, in declaration order. Of a replaced unit,
  // only the counters that its replacement updates.
  std::vector<const Unit*> units() const;
  std::vector<const Counter*> counters() const;
  std::vector<const MemoryBase*> memories() const;
  std::vector<const Histogram*> histograms() const;
  std::vector<const LinkBase*> links() const;

 protected:
  Engine(const sc_core::sc_module_name& name, ClockDomain& clock,
         std::span<const spec::RegisterInfo> table, const ControlLayout& layout);
  // Names the port that connects the engine to memory.
  void uses(MemoryPort& port) { port_ = &port; }

 private:
  SC_HAS_PROCESS(Engine);
  void drive_interrupt() { interrupt_level_.write(control.interrupt()); }

  MemoryPort* port_ = nullptr;
  sc_core::sc_signal<bool> interrupt_level_{"interrupt_level"};
  sc_core::sc_event interrupt_changed_;
};

}  // namespace deburr::rtl
