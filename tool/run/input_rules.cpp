// SPDX-License-Identifier: MIT
#include "tool/run/input_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>
#include <vector>

#include "spec/error.h"

namespace deburr::tool {
namespace {

constexpr const char* kLook =
    "check the camera (scene.eye, scene.target, scene.fov) and the size of the mesh";

bool shows_something(const tb::DepthImage& depth) {
  return std::any_of(depth.pixels.begin(), depth.pixels.end(), [](float d) { return d > 0; });
}

}  // namespace

void reject_empty_picture(const tb::Scene& scene, int width, int height) {
  const tb::Mesh& mesh = scene.mesh;
  const tb::Bounds box = bounds(mesh);
  throw spec::ConfigError(
      fmt::format("the scene '{}' draws nothing: none of its {} triangles, from ({:g}, {:g}, {:g}) "
                  "to ({:g}, {:g}, {:g}), covers the centre of any of {} x {} pixels: {}",
                  scene.name, mesh.triangles.size(), box.low.x, box.low.y, box.low.z, box.high.x,
                  box.high.y, box.high.z, width, height, kLook));
}

void reject_nothing_drawn(const tb::Scene& scene, const tb::DepthImage& depth) {
  if (!shows_something(depth)) reject_empty_picture(scene, depth.width, depth.height);
}

void reject_nothing_drawn(const tb::DepthImage& depth, std::string_view source) {
  if (shows_something(depth)) return;
  throw spec::ConfigError(
      fmt::format("the scene '{}' draws nothing: none of its triangles covers the centre of any of "
                  "{} x {} pixels: check the size of the mesh",
                  source, depth.width, depth.height));
}

void reject_slow_memory(const tb::ParameterSet& set, std::string_view prefix,
                        const tb::MemoryParameters& memory) {
  const std::string patience = set.find("run.watchdog_cycles")->text();
  std::int64_t cycles = 0;
  std::from_chars(patience.data(), patience.data() + patience.size(), cycles);
  const bool drawn = memory.latency_max > memory.latency;
  std::int64_t slowest = std::max(memory.latency, memory.latency_max);
  if (!memory.latency_file.empty()) {
    const std::vector<std::uint32_t> listed = tb::read_latencies(memory.latency_file);
    slowest = *std::max_element(listed.begin(), listed.end());
  }
  if (slowest + memory.bank_busy >= cycles)
    throw spec::ConfigError(fmt::format(
        "{0}.{1} = {2}{3} is not below run.watchdog_cycles = {4}, after which a run without "
        "progress counts as a deadlock: raise it (--set run.watchdog_cycles={5}), or make the "
        "memory faster",
        prefix,
        !memory.latency_file.empty() ? "latency_file"
        : drawn                      ? "latency_max"
                                     : "latency",
        slowest,
        memory.bank_busy > 0 ? fmt::format(" and {}.bank_busy = {}", prefix, memory.bank_busy) : "",
        cycles, 2 * (slowest + memory.bank_busy)));
}

void reject_unused_memory(const tb::ParameterSet& set, std::string_view prefix,
                          const tb::MemoryParameters& memory) {
  const auto reject = [&](std::string_view name, std::string_view why) {
    set.reject(fmt::format("{}.{}", prefix, name), why);
  };
  if (!memory.latency_file.empty())
    reject("latency_max", fmt::format("{}.latency_file gives the latencies", prefix));
  else if (memory.latency_max > 0 && memory.latency_max <= memory.latency)
    reject("latency_max", fmt::format("it is not above {}.latency = {}", prefix, memory.latency));
  if (memory.banks == 1) reject("interleave_bytes", fmt::format("{}.banks = 1", prefix));
  if (memory.error_address < 0)
    reject("error_bytes", fmt::format("{}.error_address is not set", prefix));
}

std::string with_changes(std::string label, const tb::ParameterSet& set, std::string_view prefix) {
  bool first = true;
  for (const tb::Parameter* p : set.changed()) {
    if (!p->name.starts_with(prefix)) continue;
    label += first ? ", changed: " : ", ";
    label += p->name.substr(prefix.size());
    first = false;
  }
  return label;
}

}  // namespace deburr::tool
