// SPDX-License-Identifier: MIT
// The testbench half of an engine's declaration: parameters, input files, registers, coverage,
// statistics and datasheets. Usable without the command, whose half derives from it
// (tool/run/engine.h).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rtl_model/fabric/datasheet.h"
#include "rtl_model/fabric/register_section.h"
#include "tb/harness/coverage.h"
#include "tb/run/parameter_set.h"
#include "tb/run/result.h"
#include "tb/scene/mesh.h"

namespace deburr::tb {

// Of an engine whose rules are registers.
enum class Program : std::uint8_t { kRegisters, kReset };
inline constexpr std::array<std::string_view, 2> kProgramNames = {"registers", "reset"};

struct ProgramParameters {
  Program program = Program::kRegisters;
};

template <class Visitor>
void describe(ProgramParameters& p, Visitor& v) {
  v.choice("program", p.program, kProgramNames,
           "registers: after each reset the driver programs the rules into an engine with other "
           "reset values. reset: the engine is built with the rules as reset values. Must not "
           "change results.");
}

// Of docs/reference/datasheets.md: an engine's units.
struct DatasheetSection {
  std::string module;  // as its page calls it; empty: the engine has no units of its own
  std::vector<rtl::Datasheet> sheets;
};

// Of docs/reference/coverage.md: every bin of an engine, those too that only directed tests meet.
struct CoverageSection {
  std::string title;  // of its table; empty: the engine has no bins of its own
  Coverage bins;
  std::span<const CoverageGroup> groups;
};

class EngineTestbench {
 public:
  virtual ~EngineTestbench() = default;
  virtual std::string_view name() const = 0;
  // The clock of rates and times unless run.clock_mhz is given. Default: the texture paper's.
  virtual double clock_mhz() const { return 166.67; }
  // Includes the rules that say what can be built (ParameterSet::check_build).
  virtual void add_parameters(ParameterSet& set) = 0;
  // Every file that a run opens, or looks for in vain, named by a parameter or by another file: a
  // result is kept under a key of their contents. Called after Engine::resolve().
  virtual std::vector<std::filesystem::path> input_files(MeshFiles& meshes) const = 0;
  // Names of build parameters that change the golden result, as a cache's size changes its misses.
  // Runs that agree in these, in rules and in inputs are checked with one golden result.
  virtual std::vector<std::string_view> built_for_golden() const { return {}; }
  // Every counter, stall cause and fault of a run of this engine, for
  // docs/reference/statistics.md. It elaborates the environment, so it is called at most once per
  // process, and not in a process that runs.
  virtual void describe_statistics(Result& result) = 0;
  virtual rtl::RegisterSection registers() const { return {}; }
  virtual CoverageSection coverage() const { return {}; }
  virtual DatasheetSection datasheets() const { return {}; }
};

}  // namespace deburr::tb
