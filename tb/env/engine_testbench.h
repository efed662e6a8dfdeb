// SPDX-License-Identifier: MIT
// The testbench's half of an engine's declaration: parameters, input files, registers, coverage,
// statistics and datasheets. It can be used without the command. The command's half
// (tool/run/engine.h) derives from it.
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

// How an engine gets its programmable configuration: by register writes or as reset values.
enum class Program : std::uint8_t { kRegisters, kReset };
inline constexpr std::array<std::string_view, 2> kProgramNames = {"registers", "reset"};

struct ProgramParameters {
  Program program = Program::kRegisters;
};

template <class Visitor>
void describe(ProgramParameters& p, Visitor& v) {
  v.choice("program", p.program, kProgramNames,
           "registers: after each reset the driver programs the configuration into an engine with "
           "other reset values. reset: the engine is built with the configuration as its reset "
           "values. Both give the same results.");
}

// An engine's section of docs/reference/datasheets.md: its units.
struct DatasheetSection {
  std::string module;  // as on its page; empty: the engine has no units of its own
  std::vector<rtl::Datasheet> sheets;
};

// An engine's section of docs/reference/coverage.md: all bins, including bins that only directed
// tests hit.
struct CoverageSection {
  std::string title;  // title of the table; empty: the engine has no bins of its own
  Coverage bins;
  std::span<const CoverageGroup> groups;
};

class EngineTestbench {
 public:
  virtual ~EngineTestbench() = default;
  virtual std::string_view name() const = 0;
  // Clock of rates and times unless run.clock_mhz is given. The default is that of the texture
  // paper.
  virtual double clock_mhz() const { return 166.67; }
  // Also adds the build constraints (ParameterSet::check_build).
  virtual void add_parameters(ParameterSet& set) = 0;
  // Every file that a run opens or tries to open, named by a parameter or by another file. Results
  // are cached under a key of their contents. Call it after Engine::resolve().
  virtual std::vector<std::filesystem::path> input_files(MeshFiles& meshes) const = 0;
  // Build parameters that change the golden result; for example, the size of a cache changes its
  // misses. Runs with the same values of these, the same configuration and the same inputs share
  // one golden result.
  virtual std::vector<std::string_view> built_for_golden() const { return {}; }
  // Every counter, stall cause and fault of a run, for docs/reference/statistics.md. It elaborates
  // the environment, so call it at most once per process and not in a process that runs a
  // simulation.
  virtual void describe_statistics(Result& result) = 0;
  // The hardware that a run with the parameters' current values builds, likewise.
  virtual void describe_build(Result& result) { describe_statistics(result); }
  virtual rtl::RegisterSection registers() const { return {}; }
  virtual CoverageSection coverage() const { return {}; }
  virtual DatasheetSection datasheets() const { return {}; }
};

}  // namespace deburr::tb
