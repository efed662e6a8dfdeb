// SPDX-License-Identifier: MIT
// docs/reference/parameters.md, statistics.md, registers.md, coverage.md and datasheets.md,
// generated from the declarations that the program uses.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "rtl_model/fabric/register_section.h"
#include "tool/run/engine.h"

namespace deburr::tool {

// GitHub's anchor for a heading, if no earlier heading has the same text.
std::string anchor_of(std::string_view heading);
std::string parameters_page(const std::vector<std::unique_ptr<Engine>>& engines);
// Elaborates the model of every engine. Call it at most once per process, and not in a process that
// simulates.
std::string statistics_page(const std::vector<std::unique_ptr<Engine>>& engines);
// Registers of all engines that have registers, by module name.
std::vector<rtl::RegisterSection> register_sections(
    const std::vector<std::unique_ptr<Engine>>& engines);
std::string registers_page(const std::vector<std::unique_ptr<Engine>>& engines);
// All engines' registers as macros, for software in C or C++.
std::string registers_header(const std::vector<std::unique_ptr<Engine>>& engines);
// The same registers as SystemRDL.
std::string registers_systemrdl(const std::vector<std::unique_ptr<Engine>>& engines);
std::string registers_uvm(const std::vector<std::unique_ptr<Engine>>& engines);
std::string coverage_page(const std::vector<std::unique_ptr<Engine>>& engines);
std::string datasheets_page(const std::vector<std::unique_ptr<Engine>>& engines);
// Names of the faults that an engine's environment can inject, as accepted by --fault. Elaborates
// the model, as statistics_page() does.
std::vector<std::string> fault_names(Engine& engine);
// Names of all bins that runs of an engine may have.
std::set<std::string> coverage_bins(const std::string& engine);

}  // namespace deburr::tool
